/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

Description
    The files of the cloud: tables, tracks and what a restart needs to go on
    with them; and what it tells the user.

\*---------------------------------------------------------------------------*/

#include "ellipsoidCloud.H"
#include "masterGate.H"
#include "plainLists.H"
#include "HashSet.H"
#include "IOPosition.H"
#include "StringStream.H"
#include "atomicWrite.H"

#include <algorithm>
#include <cerrno>
#include <cmath>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::ellipsoidCloud::makeTables()
{
    const masterGate once;
    dictionary tables;

    if (earlier_.found())
    {
        firstTime_ = earlier_.notes().get<string>("folder");
        time_ = earlier_.notes().get<scalar>("time");
        tables = earlier_.notes().subDict("tables");
    }

    const fileName folder
    (
        mesh_.time().globalPath()/"postProcessing"/"ellipsoidCloud"/firstTime_
    );

    statistics_.reset
    (
        new captureStatistics
        (
            captureStatistics::setting
            (
                properties_.section("capture"), mesh_.boundaryMesh()
            ),
            mesh_.boundaryMesh().names(),
            population_,
            folder,
            tables.subOrEmptyDict("events")
        )
    );
    tracks_.reset
    (
        new cellTracks
        (
            cellTracks::setting(properties_.section("tracks")),
            mesh_.boundaryMesh().names(),
            population_,
            folder,
            tables.subOrEmptyDict("tracks")
        )
    );
}


void Foam::ellipsoidCloud::readCells()
{
    IOPosition<Cloud<ellipsoidParcel>> positions
    (
        *this, cloud::geometryType::COORDINATES
    );
    const bool there = positions.headerOk();
    Istream& is = positions.readStream("", there);

    if (there)
    {
        positions.readData(is, *this);
        positions.close();
    }

    ellipsoidParcel::readFields(*this);

    DynamicList<cellState> mine(size());
    for (const ellipsoidParcel& parcel : *this)
    {
        mine.append(parcel.state());
    }

    for (const List<cellState>& some : fromAllRanks(mine))
    {
        cells_.append(some);
    }
    sortCells();

    const masterGate once;
    for (const cellState& cell : cells_)
    {
        const string complaint
        (
            ellipsoidProperties::complaint
            (
                ellipsoid_options_resized
                (
                    &properties_.options(), cell.length, cell.width
                )
            )
        );
        if (!complaint.empty())
        {
            checkedCells
            (
                "cell " + Foam::name(cell.id) + " has a size for which "
              + complaint
            );
        }
        population_.take(cell.id, cellSize{cell.length, cell.width});
    }
}


void Foam::ellipsoidCloud::checkedCells(const string& complaint) const
{
    if (!complaint.empty())
    {
        FatalErrorInFunction
            << "time " << mesh_.time().timeName() << ": " << complaint.c_str()
            << nl << "    Its folder lagrangian/" << name()
            << " is incomplete or of another run: go on from another time"
            << exit(FatalError);
    }
}


void Foam::ellipsoidCloud::checkPlaces() const
{
    // What is wrong on any rank, said once
    List<string> complaints(Pstream::nProcs());

    for (const ellipsoidParcel& parcel : *this)
    {
        const cellState& cell = parcel.state();
        const point x(cell.body.x[0], cell.body.x[1], cell.body.x[2]);

        frozenFlow::probe at{cell.tet, -1};

        if
        (
            cell.tet < 0
         || cell.tet >= flow_->nTets()
         || !(mag(x) < GREAT)
         || flow_->place(x, at) != frozenFlow::pInside
        )
        {
            OStringStream os;
            os.precision(6);
            os << "cell " << cell.id << " at " << x << " is outside the mesh";
            complaints[Pstream::myProcNo()] = os.str();
        }
    }

    Pstream::gatherList(complaints);
    const masterGate once;

    if (Pstream::master())
    {
        for (const string& complaint : complaints)
        {
            checkedCells(complaint);
        }
    }
}


void Foam::ellipsoidCloud::checkCells() const
{
    List<labelList> ids(Pstream::nProcs());
    DynamicList<label> mine(size());

    for (const ellipsoidParcel& parcel : *this)
    {
        mine.append(parcel.state().id);
    }

    ids[Pstream::myProcNo()].transfer(mine);
    Pstream::gatherList(ids);

    const masterGate once;

    if (!Pstream::master())
    {
        return;
    }

    string complaint;
    const auto complain =
        [&](const string& text)
        {
            if (complaint.empty())
            {
                complaint = text;
            }
        };

    labelHashSet read;
    for (const labelList& some : ids)
    {
        for (const label id : some)
        {
            if (!read.insert(id))
            {
                complain("cell " + Foam::name(id) + " is there twice");
            }
            else if (!statistics_->inside(id))
            {
                complain
                (
                    "cell " + Foam::name(id)
                  + " is there, but by the log of events not in the device"
                );
            }
        }
    }
    for (const label id : statistics_->cellsInside())
    {
        if (!read.found(id))
        {
            complain
            (
                "cell " + Foam::name(id)
              + " is missing, but by the log of events in the device"
            );
        }
    }

    checkedCells(complaint);
}


void Foam::ellipsoidCloud::report()
{
    const scalar now = mesh_.time().elapsedClockTime();

    if (now < reportTime_ + 1)
    {
        return;
    }

    const scalar start = mesh_.time().startTime().value();
    const scalar end = mesh_.time().endTime().value();
    const scalar left =
        trackingTime_*(end - time_)/max(time_ - start, VSMALL);

    Info<< "t = " << mesh_.time().timeName() << " s, ";
    statistics_->report(Info);
    Info<< ", about " << std::round(left) << " s to go" << endl;

    reportTime_ = now;
}


void Foam::ellipsoidCloud::reportWork() const
{
    const groupAdvance::account& done = interval_->done();

    // Counts may pass a label's range
    const int64_t accepted =
        returnReduce(int64_t(done.steps.accepted), sumOp<int64_t>());
    const int64_t rejected =
        returnReduce(int64_t(done.steps.rejected), sumOp<int64_t>());
    const int64_t nGroups =
        returnReduce(int64_t(done.nGroups), sumOp<int64_t>());
    const label largest = returnReduce(done.largest, maxOp<label>());
    const scalar inGroups = returnReduce(done.groupTime, sumOp<scalar>());
    const scalar inAll = returnReduce(done.time, sumOp<scalar>());

    Info<< nl << "tracking: " << returnReduce(trackingTime_, maxOp<scalar>())
        << " s, " << accepted << " steps, " << rejected << " rejected" << nl
        << "groups of cells: " << nGroups << " moved, " << largest
        << " cells in the largest, "
        << 100*inGroups/max(inAll, VSMALL) << " % of the time" << endl;

    if (Pstream::parRun())
    {
        reportLoad();
    }
}


void Foam::ellipsoidCloud::reportLoad() const
{
    List<scalar> moving(Pstream::nProcs(), Zero);
    List<int64_t> steps(Pstream::nProcs(), int64_t(0));

    const groupAdvance::account& done = interval_->done();

    moving[Pstream::myProcNo()] = done.time;
    steps[Pstream::myProcNo()] = done.steps.accepted + done.steps.rejected;
    Pstream::gatherList(moving);
    Pstream::gatherList(steps);

    const scalar longest = max(max(moving), VSMALL);

    Info<< "load of the ranks, as seconds (steps):";
    forAll(moving, ranki)
    {
        Info<< ' ' << moving[ranki] << " (" << steps[ranki] << ')';
    }
    Info<< "; evenness " << 100*average(moving)/longest << " %" << endl;
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::ellipsoidCloud::writeFields() const
{
    tracks_->flush();

    const fileName failed
    (
        failedFile([&]() { ellipsoidParcel::writeFields(*this); })
    );
    if (!failed.empty())
    {
        cannotWrite(failed, errno);
    }

    dictionary tables;
    tables.add("events", statistics_->notes());
    tables.add("tracks", tracks_->notes());

    dictionary notes;
    notes.add("time", time_);
    notes.add("folder", string(firstTime_));
    notes.add("mesh", meshNotes_);
    notes.add("tables", tables);

    checkpoint::end(mesh_.time(), notes);
}


void Foam::ellipsoidCloud::finish()
{
    if (Pstream::master())
    {
        DynamicList<cellTracks::row> rows;
        for (cellState& cell : cells_)
        {
            if (cell.fate != cellState::waiting)
            {
                tracks_->finish(cell, rows);
            }
        }
        tracks_->take(rows);
    }
    tracks_->flush();

    reportWork();

    if (Pstream::master())
    {
        statistics_->update(cells_);
        statistics_->reportContact(Info);
        statistics_->write(Info);
        tracks_->writeVTP();
    }
}


// ************************************************************************* //
