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

#include <algorithm>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::IOdictionary Foam::ellipsoidCloud::filesDict() const
{
    return IOdictionary
    (
        IOobject
        (
            "ellipsoidCloudFiles",
            mesh_.time().timeName(),
            "uniform",
            mesh_,
            IOobject::READ_IF_PRESENT,
            IOobject::NO_WRITE,
            false
        )
    );
}


void Foam::ellipsoidCloud::openFiles(const scalar inletSpeed)
{
    const IOdictionary earlier(filesDict());
    const scalar eventsSize = earlier.getOrDefault<scalar>("events", 0);
    const scalar tracksSize = earlier.getOrDefault<scalar>("tracks", 0);

    earlier.readIfPresent<fileName>("folder", firstTime_);
    earlier.readIfPresent("time", time_);

    const fileName folder
    (
        mesh_.time().globalPath()/"postProcessing"/"ellipsoidCloud"/firstTime_
    );
    const ellipsoid_options& options = properties_.options();

    statistics_.reset
    (
        new captureStatistics
        (
            captureStatistics::setting
            (
                properties_.section("capture"), mesh_.boundaryMesh()
            ),
            mesh_.boundaryMesh().names(),
            inletSpeed,
            folder,
            eventsSize
        )
    );
    tracks_.reset
    (
        new cellTracks
        (
            cellTracks::setting(properties_.section("tracks")),
            mesh_.boundaryMesh().names(),
            *std::max_element(options.semi_axes, options.semi_axes + 3),
            folder,
            tracksSize
        )
    );
}


void Foam::ellipsoidCloud::checkCells() const
{
    label nInside = statistics_->nInside();
    Pstream::scatter(nInside);

    const label nRead = returnReduce(label(size()), sumOp<label>());

    if (nRead != nInside)
    {
        FatalErrorInFunction
            << "time " << mesh_.time().timeName() << " holds " << nRead
            << " cells, but by the log of events " << nInside
            << " are in the device" << nl
            << "    Its folder lagrangian/" << name()
            << " is incomplete or of another run: go on from another time"
            << exit(FatalError);
    }

    for (const ellipsoidParcel& parcel : *this)
    {
        const label teti = parcel.state().tet;

        if (teti < 0 || teti >= flow_->nTets())
        {
            FatalErrorInFunction
                << "cell " << parcel.state().id << " of time "
                << mesh_.time().timeName() << " is of another mesh"
                << exit(FatalError);
        }
    }
}


void Foam::ellipsoidCloud::writeFiles()
{
    tracks_->flush();

    scalar eventsSize = statistics_->logSize();
    scalar tracksSize = tracks_->fileSize();
    Pstream::scatter(eventsSize);
    Pstream::scatter(tracksSize);

    const fullPrecision digits;

    IOdictionary files(filesDict());
    files.clear();
    files.add("time", time_);
    files.add("folder", string(firstTime_));
    files.add("events", eventsSize);
    files.add("tracks", tracksSize);
    files.regIOobject::write();
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
    Info<< ", about " << label(left + 0.5) << " s to go" << endl;

    reportTime_ = now;
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::ellipsoidCloud::finish()
{
    for (ellipsoidParcel& parcel : *this)
    {
        tracks_->finish(parcel.state());
    }
    tracks_->flush();

    const scalar deepest = returnReduce(totals_.deepest, maxOp<scalar>());
    const scalar longest = returnReduce(trackingTime_, maxOp<scalar>());

    // Counts may pass a label's range
    const int64_t accepted =
        returnReduce(int64_t(totals_.accepted), sumOp<int64_t>());
    const int64_t rejected =
        returnReduce(int64_t(totals_.rejected), sumOp<int64_t>());

    Info<< nl << "tracking: " << longest << " s, " << accepted
        << " steps, " << rejected << " rejected" << nl
        << "deepest overlap of a bead with a wall: " << deepest*1e9 << " nm, "
        << 100*deepest/model_.options.bead_radius << " % of its radius" << nl;

    if (Pstream::master())
    {
        statistics_->write(Info);
        tracks_->writeVTP();
    }
}


// ************************************************************************* //
