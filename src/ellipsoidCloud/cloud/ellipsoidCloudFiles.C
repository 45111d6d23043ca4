// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    The files of the cloud: tables, tracks and what a restart needs to go on
    with them; and what it tells the user.

\*---------------------------------------------------------------------------*/

#include "ellipsoidCloud.H"
#include "caseFiles.H"
#include "cellPoses.H"
#include "masterGate.H"
#include "atomicWrite.H"
#include "fvMesh.H"
#include "OSspecific.H"
#include "StringStream.H"
#include "surfaceFields.H"

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

    if (Pstream::master())
    {
        checkLinks(folder);
    }

    const tableSet set
    {
        mesh_.boundaryMesh().names(),
        population_,
        folder,
        domainImages::any(mesh_.boundaryMesh(), properties_.unreached()),
        tables,
        min
        (
            mesh_.time().deltaTValue(),
            cellTracks::setting(properties_.section("tracks")).interval
        )
    };

    statistics_.reset(new captureStatistics(set, criterion_.sieves()));
    tracks_.reset(new cellTracks(set));

    if (blocking_.active)
    {
        occupancy_.reset
        (
            new occupancy(blocking_, criterion_, set, earlier_.notes())
        );
    }
}


void Foam::ellipsoidCloud::noteFlow()
{
    flowTime_ = caseFiles::flowInstance(mesh_);

    const string then(earlier_.notes().getOrDefault("flow", flowTime_));
    if (then != flowTime_)
    {
        Warning
            << "The flow is that of " << flowTime_.c_str() << ", and cells went"
            << " through that of " << then.c_str() << " so far. To go on in"
            << " it, move U, p and phi of " << flowTime_.c_str() << " elsewhere"
            << nl << endl;
    }
}


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
    const bool cut = mesh_.time().times().last().value() > mesh_.time().value();

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


void Foam::ellipsoidCloud::reportApertures(const scalar inflow) const
{
    const masterGate once;

    if (Pstream::master())
    {
        const undecomposedFlow::serialScope serial;
        const surfaceScalarField& phi = undecomposed_->phi();

        for (const occupancy::aperture& a : blocking_.apertures)
        {
            const scalar flux = a.flux(phi);
            Info<< "flow: aperture " << a.name << ": " << flux << " m3/s, "
                << flux/max(inflow, VSMALL) << " of the inflow, "
                << 1e12*a.area(phi.mesh()) << " um2" << endl;
        }
    }
}


void Foam::ellipsoidCloud::report()
{
    const scalar now = mesh_.time().elapsedClockTime();

    if (now < reportTime_ + 1)
    {
        return;
    }

    const scalar end = mesh_.time().endTime().value();
    // The last time step of another solver may end after endTime
    const scalar left =
        trackingTime_*max(end - time_, scalar(0))/max(time_ - start_, VSMALL);

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

void Foam::ellipsoidCloud::writeTime()
{
    const Time& time = mesh_.time();

    // The time of a steady flow of another solver is of our clock alone
    if (flowType_ == STEADY || !time.writeTime())
    {
        writePoses(tracks_->set(), cells_, time.timeName());
        return;
    }

    checkpoint::begin(mesh_);
    if (flowType_ == OWN && !time.write())
    {
        cannotWrite(time.path()/time.timeName()/"uniform"/"time");
    }
    tracks_->flush();
    writeParticles();
    writePoses(tracks_->set(), cells_, time.timeName());

    // Entries of a dictionary are texts, with the digits that it is written with
    const exactDigits exact;
    dictionary tables;
    tables.add("events", statistics_->log.notes());
    tables.add("tracks", tracks_->file.notes());

    dictionary notes;
    notes.add("time", time_);
    notes.add("deltaT", time.deltaTValue());
    notes.add("folder", string(firstTime_));
    notes.add("flow", flowTime_);
    notes.add("mesh", meshText_);
    notes.add("shape", population_.text());
    notes.add("plan", plan_);
    if (occupancy_.valid())
    {
        occupancy_->note(notes, tables);
    }
    notes.add("tables", tables);

    OStringStream os;
    notes.write(os, false);
    os.beginBlock("cells");
    writeStates(cells_, os);
    os.endBlock();
    checkpoint::end(time, os.str());
}
