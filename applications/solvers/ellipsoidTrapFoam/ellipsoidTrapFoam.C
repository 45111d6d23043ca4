/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

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

    Entries are described in steadyFlow.H, flowConvergence.H (flow) and
    ellipsoidProperties.H (ellipsoids).

SourceFiles
    ellipsoidTrapFoam.C
    steadyFlow.C
    flowConvergence.C

\*---------------------------------------------------------------------------*/

#include "argList.H"
#include "Time.H"
#include "fvMesh.H"
#include "columnFvMesh.H"
#include "ellipsoidCloud.H"
#include "steadyFlow.H"
#include "checkpoint.H"

using namespace Foam;

// * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * //

int main(int argc, char *argv[])
{
    argList::addNote
    (
        "Solve the steady incompressible laminar flow, then track rigid"
        " ellipsoids through it."
    );
    argList::addBoolOption("flowOnly", "Stop after the flow");

    #include "setRootCaseLists.H"

    const bool flowOnly = args.found("flowOnly");

    if (!flowOnly)
    {
        checkpoint::setAsideIncomplete(args);
    }

    #include "createTime.H"

    // The digits of writePrecision are for files
    Sout.precision(6);
    Pout.precision(6);

    #include "createMesh.H"

    // Read before the flow takes its time: bad input ends the run here
    autoPtr<ellipsoidCloud> cells;
    if (!flowOnly)
    {
        cells.reset(new ellipsoidCloud(mesh));
    }

    steadyFlow flow(mesh);

    if (!flow.converged())
    {
        flow.solve();
        flow.write();
    }

    flow.report(flowOnly ? 0 : cells->fluidDensity());

    if (!flowOnly)
    {
        cells->setFlow(flow.U(), flow.p(), flow.phi());

        while (runTime.loop())
        {
            cells->evolve();

            if (runTime.writeTime())
            {
                cells->write();
            }
        }

        cells->finish();
    }

    Info<< "End\n" << endl;

    return 0;
}


// ************************************************************************* //
