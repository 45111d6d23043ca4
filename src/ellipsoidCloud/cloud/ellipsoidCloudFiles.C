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
#include "cellPoses.H"
#include "ellipsoidParcel.H"
#include "masterGate.H"
#include "fvMesh.H"
#include "atomicWrite.H"

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

    const tableSet set
    {
        mesh_.boundaryMesh().names(), population_, folder, tables
    };

    statistics_.reset(new captureStatistics(set, criterion_.sieves()));
    tracks_.reset(new cellTracks(set));

    const occupancy::setting from
    (
        properties_.section("occupancy"), mesh_.boundaryMesh()
    );
    if (from.active)
    {
        occupancy_.reset
        (
            new occupancy(from, criterion_, set, earlier_.notes())
        );
    }
}


void Foam::ellipsoidCloud::readCells()
{
    for
    (
        const List<cellState>& some
      : fromAllRanks(ellipsoidParcel::read(mesh_))
    )
    {
        cells_.append(some);
    }
    Foam::sort(cells_);

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
            refuseCells
            (
                "cell " + Foam::name(cell.id) + " has a size for which "
              + complaint
            );
        }
        population_.take(cell.id, cellSize{cell.length, cell.width});
    }
}


void Foam::ellipsoidCloud::refuseCells(const string& complaint) const
{
    FatalErrorInFunction
        << "time " << mesh_.time().timeName() << ": " << complaint.c_str()
        << nl << "    Its folder lagrangian/" << ellipsoidParcel::cloudName
        << " is incomplete or of another run: go on from another time"
        << exit(FatalError);
}


void Foam::ellipsoidCloud::checkPlaces() const
{
    const masterGate once;

    for (const cellState& cell : cells_)
    {
        const point x(cell.centre());
        frozenFlow::probe at{cell.tet, -1};

        if
        (
            cell.tet < 0
         || cell.tet >= domain_->flow.nTets()
         || !(mag(x) < GREAT)
         || domain_->flow.locate(x, at) != frozenFlow::pInside
        )
        {
            refuseCells
            (
                "cell " + Foam::name(cell.id) + " at " + shortText(x)
              + " is outside the mesh"
            );
        }
    }
}


void Foam::ellipsoidCloud::checkCells() const
{
    const masterGate once;

    if (!Pstream::master())
    {
        return;
    }

    labelHashSet missing(statistics_->cellsInside());

    forAll(cells_, i)
    {
        const string its("cell " + Foam::name(cells_[i].id));

        if (i > 0 && cells_[i].id == cells_[i - 1].id)
        {
            refuseCells(its + " is there twice");
        }
        if (!missing.erase(cells_[i].id))
        {
            refuseCells
            (
                its + " is there, but by the log of events not in the device"
            );
        }
    }
    if (!missing.empty())
    {
        refuseCells
        (
            "cell " + Foam::name(missing.sortedToc()[0])
          + " is missing, but by the log of events in the device"
        );
    }
}


void Foam::ellipsoidCloud::writeParcels() const
{
    Cloud<ellipsoidParcel> parcels
    (
        mesh_, ellipsoidParcel::cloudName, IDLList<ellipsoidParcel>()
    );

    for (const cellState& cell : cells_)
    {
        const frozenFlow::probe at{cell.tet, -1};
        const label celli = localCells_[domain_->flow.cell(at)];

        if (celli >= 0)
        {
            parcels.addParticle(new ellipsoidParcel(mesh_, celli, cell));
        }
    }

    // OpenFOAM's number of particles so far
    ellipsoidParcel::particleCount_ = statistics_->size();
    parcels.write();
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
    const List<groupAdvance::account> ranks(gathered(interval_->done()));

    groupAdvance::account sum = {};
    scalar longest = VSMALL;
    OStringStream load;
    load.precision(6);

    for (const groupAdvance::account& rank : ranks)
    {
        const auto steps = rank.steps.accepted + rank.steps.rejected;
        load << ' ' << rank.time << " (" << int64_t(steps) << ')';
        longest = max(longest, rank.time);

        sum.steps.accepted += rank.steps.accepted;
        sum.steps.rejected += rank.steps.rejected;
        sum.nGroups += rank.nGroups;
        sum.largest = max(sum.largest, rank.largest);
        sum.groupTime += rank.groupTime;
        sum.time += rank.time;
    }

    Info<< nl << "tracking: " << returnReduce(trackingTime_, maxOp<scalar>())
        << " s, " << int64_t(sum.steps.accepted) << " steps, "
        << int64_t(sum.steps.rejected) << " rejected" << nl
        << "groups of cells: " << sum.nGroups << " moved, " << sum.largest
        << " cells in the largest, "
        << 100*sum.groupTime/max(sum.time, VSMALL) << " % of the time" << endl;

    if (Pstream::parRun())
    {
        Info<< "load of the ranks, as seconds (steps):" << load.str().c_str()
            << "; evenness " << 100*sum.time/ranks.size()/longest << " %"
            << endl;
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::ellipsoidCloud::write()
{
    const Time& time = mesh_.time();

    checkpoint::begin(time);

    if (!time.write())
    {
        cannotWrite(time.path()/time.timeName()/"uniform"/"time");
    }

    tracks_->flush();
    writeParcels();
    writePoses();

    dictionary tables;
    tables.add("events", statistics_->log.notes());
    tables.add("tracks", tracks_->file.notes());

    dictionary notes;
    notes.add("time", time_);
    notes.add("folder", string(firstTime_));
    notes.add("mesh", meshNotes_);
    if (occupancy_.valid())
    {
        occupancy_->note(notes, tables);
    }
    notes.add("tables", tables);

    checkpoint::end(time, notes);
}


void Foam::ellipsoidCloud::writePoses() const
{
    const masterGate once;

    if (Pstream::master())
    {
        Foam::writePoses(tracks_->set(), cells_, mesh_.time().timeName());
    }
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
