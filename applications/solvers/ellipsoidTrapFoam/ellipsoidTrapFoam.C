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
    physical time stands still (see steadyFlow.H for the entries). Then the
    ellipsoids move through the frozen flow over physical time.

Usage
    \b ellipsoidTrapFoam [OPTION]

    Options:
      - \par -flowOnly
        Stop after the flow.

    Reads U, p and (if there) phi from the start time, or from the latest
    earlier time that has them. They are written only if they had to be solved.

SourceFiles
    ellipsoidTrapFoam.C
    steadyFlow.C
    flowConvergence.C

\*---------------------------------------------------------------------------*/

#include "argList.H"
#include "Time.H"
#include "fvMesh.H"
#include "columnFvMesh.H"
#include "steadyFlow.H"

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
    #include "createTime.H"
    #include "createMesh.H"

    steadyFlow flow(mesh);

    if (!flow.converged())
    {
        flow.solve();
        flow.write();
    }

    flow.report();

    Info<< "End\n" << endl;

    return 0;
}


// ************************************************************************* //
