// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Application
    ellipsoidTrapFoam

Description
    Tracks rigid ellipsoids through a steady incompressible laminar flow.

    First the flow is solved, to residual targets and until it is steady, while
    physical time stands still. A flow that is steady as it was read is not
    solved again. Then the ellipsoids move through the frozen flow over physical
    time.

Usage
    \b ellipsoidTrapFoam [OPTION]

    Options:
      - \par -flowOnly
        Stop after the flow.

      - \par -frozenFlow
        Take the flow as it is read, of whatever solver.

      - \par -dry-run
        Read and check everything, and say what would happen. Solve and write
        nothing.

    Entries are described in flowFields.H, steadyFlow.H (flow) and
    ellipsoidProperties.H (ellipsoids).

SourceFiles
    ellipsoidTrapFoam.C
    flowFields.C
    occupiedFlow.C
    solidBodies.C
    steadyFlow.C

\*---------------------------------------------------------------------------*/

#include "argList.H"
#include "Time.H"
#include "fvMesh.H"
#include "caseFiles.H"
#include "ellipsoidCloud.H"
#include "occupiedFlow.H"
#include "checkpoint.H"
#include "commit.H"
#include "masterGate.H"
#include "checkCells.H"

#include <cerrno>
#include <fcntl.h>
#include <sys/file.h>

using namespace Foam;

//- End the run if another one is at work in the case. The system keeps the lock,
//  of the folder itself, until this process ends, however it does
static void lockCase(const argList& args)
{
    const fileName path(args.rootPath()/args.globalCaseName());
    const masterGate once;

    if (Pstream::master())
    {
        const int folder =
            open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);

        if (flock(folder, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        {
            FatalErrorInFunction
                << "another run of ellipsoidTrapFoam is at work in " << path
                << nl << "    Both would write the same tables: wait for its"
                << " end, or copy the case. One run of mpirun has the option"
                << " -parallel" << exit(FatalError);
        }
    }
}


//- The flow, then the cells
static void runCase(const argList& args, const fvMesh& mesh, Time& runTime)
{
    const bool dryRun = args.found("dry-run");
    const flowFields::solveType solve =
        args.found("frozenFlow") ? flowFields::NO : flowFields::solveOf(mesh);

    if (!dryRun)
    {
        flowFields::finishWriting(runTime);
    }

    // Read before the flow takes its time: bad input ends the run here
    checkCells(mesh);
    autoPtr<ellipsoidCloud> cells;
    if (!args.found("flowOnly"))
    {
        cells.reset(new ellipsoidCloud(mesh, ellipsoidCloud::OWN));
    }

    autoPtr<flowFields> flow
    (
        solve == flowFields::NO
      ? new flowFields(mesh)
      : new steadyFlow(mesh, solve)
    );
    const bool accepted = flow->accept();

    if (!accepted && cells.valid())
    {
        cells->checkInjections(flow->fields());
    }
    if (!accepted && dryRun)
    {
        Info<< "flow: to be solved; when that is done, -dry-run says more"
            << endl;
        return;
    }
    if (!accepted)
    {
        flow->solve();
    }
    flow->checkPatches();
    if (!accepted)
    {
        flow->write();
    }
    flow->report(cells.valid() ? cells->fluidDensity() : 0);

    if (!cells.valid())
    {
        return;
    }

    cells->setFlow(flow->fields(), solve == flowFields::NO);
    if (dryRun)
    {
        return;
    }

    autoPtr<occupiedFlow> occupied;
    if (cells->occupied() && cells->occupied()->changesFlow())
    {
        occupied.reset(new occupiedFlow(*flow, *cells));
    }
    cells->track(runTime, 0, occupied.get());
}


static void addOptions()
{
    argList::addNote
    (
        "Solve the steady incompressible laminar flow, then track rigid"
        " ellipsoids through it. Version " ELLIPSOID_VERSION ", "
        ELLIPSOID_COMMIT
    );
    argList::addBoolOption("flowOnly", "Stop after the flow");
    argList::addBoolOption
    (
        "dry-run",
        "Read and check everything, solve and write nothing"
    );
    argList::addBoolOption
    (
        "frozenFlow",
        "Take the flow as it is read, of whatever solver"
    );
}


int main(int argc, char *argv[])
{
    addOptions();

    caseFiles::checkPath(argc, argv);
    #include "setRootCaseListOptions.H"
    argList args(argc, argv);
    #include "setRootCaseListOutput.H"
    #include "foamDlOpenLibs.H"

    const bool flowOnly = args.found("flowOnly");
    const bool dryRun = args.found("dry-run");

    fileNameList files
    ({
        "constant/transportProperties", "system/fvSchemes", "system/fvSolution"
    });
    if (!flowOnly)
    {
        files.append("constant/ellipsoidCloudProperties");
    }
    caseFiles::checkCase(args, files);
    if (!dryRun)
    {
        lockCase(args);
    }

    const word start
    (
        flowOnly ? word::null : checkpoint::setAsideIncomplete(args, dryRun)
    );

    Info<< "ellipsoidTrapFoam " << ELLIPSOID_VERSION << ", "
        << ELLIPSOID_COMMIT << nl << endl;

    #include "createTime.H"

    // Not that of the last time step of another solver
    if (runTime.isAdjustTimeStep())
    {
        runTime.setDeltaT(runTime.controlDict().get<scalar>("deltaT"), false);
    }

    if (dryRun && !start.empty())
    {
        runTime.setTime(readScalar(start), 0);
    }

    // The digits of writePrecision are for files
    Sout.precision(6);
    Pout.precision(6);

    caseFiles::checkMesh(runTime, !flowOnly);

    // Not createMesh.H, which takes a column of cells for a dry run
    Info<< "Create mesh for time = " << runTime.timeName() << nl << endl;
    const fvMesh mesh
    (
        IOobject
        (
            fvMesh::defaultRegion,
            runTime.timeName(),
            runTime,
            IOobject::MUST_READ
        )
    );

    runCase(args, mesh, runTime);

    if (dryRun)
    {
        Info<< "Nothing was solved or written" << endl;
    }
    Info<< "End\n" << endl;

    return 0;
}
