// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    What a run of the cloud is, in order: begin, move, write, finish.

\*---------------------------------------------------------------------------*/

#include "ellipsoidCloud.H"
#include "atomicWrite.H"
#include "cellPoses.H"
#include "fvMesh.H"
#include "OSspecific.H"
#include "Time.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::ellipsoidCloud::beginTables()
{
    const fileName folder(statistics_->log.name().path());
    const fileName copy(folder + ".part");

    // What a run left that was killed while it wrote them
    if (Pstream::master())
    {
        rmDir(copy, true);
        for (const fileName& within : {folder, fileName(folder/"poses")})
        {
            for (const fileName& file : readDir(within, fileName::FILE))
            {
                if (file.hasExt("part"))
                {
                    rm(within/file);
                }
            }
        }
    }

    // Tables that reach beyond the start are cut there
    const bool goesOn = earlier_.found();
    const bool cut =
        mesh_.time().times().last().value() > mesh_.time().value();

    if (Pstream::master() && isDir(folder) && (cut || !goesOn))
    {
        if
        (
            (goesOn && !cp(folder, copy))
         || !mvBak(folder, "bak")
         || (goesOn && !mv(copy, folder))
        )
        {
            cannotWrite(folder);
        }
        Info<< "ellipsoidCloud: the tables that were in " << folder.c_str()
            << " are kept beside it, as .bak" << endl;
    }

    if (goesOn)
    {
        removeLaterPoses(tracks_->set(), time_);
    }
    statistics_->log.open();
    tracks_->file.open();
    if (occupancy_.valid())
    {
        occupancy_->begin();
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::ellipsoidCloud::track
(
    Time& runTime,
    const label every,
    flowRenewal* occupied
)
{
    beginTables();
    if (occupied)
    {
        occupied->begin();
    }

    while (runTime.loop())
    {
        evolve();
        // Else it adds up rounding, and so do the names of times
        static_cast<dimensionedScalar&>(runTime).value() = time_;
        if (occupied)
        {
            occupied->update();
        }

        if (every ? runTime.timeIndex() % every == 0 : runTime.writeTime())
        {
            writeTime();
        }
    }

    finish();
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
        tracks_->addRows(rows);
    }
    tracks_->flush();

    reportWork();

    if (Pstream::master())
    {
        statistics_->finish(cells_, Info);
        tracks_->writeVTP
        (
            [&](const label id) { return statistics_->sizeOf(id); }
        );
    }
}
