/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

Application
    ellipsoidCaptureMap

Description
    Where must a cell enter to be caught, and by which sieve? A map over the
    plane of a patch, with its boundaries refined, for given orientations of the
    cell; and the probability that a cell which enters with the flow is caught.

    Each cell is alone in the solved flow of the case.

Usage
    \b ellipsoidCaptureMap

    Entries of system/captureMapDict are described in captureMap.H; the cells
    are those of constant/ellipsoidCloudProperties.

SourceFiles
    ellipsoidCaptureMap.C
    captureMap.C
    captureMapTables.C
    inletPlane.C

\*---------------------------------------------------------------------------*/

#include "argList.H"
#include "Time.H"
#include "fvMesh.H"
#include "columnFvMesh.H"
#include "captureMap.H"
#include "masterGate.H"
#include "checkpoint.H"

using namespace Foam;

// * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * //

int main(int argc, char *argv[])
{
    argList::addNote
    (
        "Map from where cells that enter by a patch end in which sieve."
    );

    #include "setRootCaseLists.H"
    #include "createTime.H"

    // The digits of writePrecision are for files
    Sout.precision(6);
    Pout.precision(6);

    #include "createMesh.H"

    ellipsoidProperties properties(mesh);
    properties.setAlone();

    const IOdictionary dict
    (
        IOobject
        (
            "captureMapDict",
            runTime.system(),
            mesh,
            IOobject::MUST_READ,
            IOobject::NO_WRITE
        )
    );

    const word instance(runTime.findInstance(mesh.dbDir(), "U"));
    const auto field =
        [&](const word& name)
        {
            return IOobject
            (
                name, instance, mesh, IOobject::MUST_READ, IOobject::NO_WRITE
            );
        };

    const bool solved =
        returnReduce
        (
            field("phi").typeHeaderOk<surfaceScalarField>(true)
         && !isFile(checkpoint::unfinishedFlow(runTime.path()/instance)),
            andOp<bool>()
        );
    {
        const masterGate once;

        captureMap::check(dict, mesh.boundaryMesh(), properties.seed());
        ellipsoidProperties::getAbove(runTime.controlDict(), "deltaT", 0);

        if (!solved)
        {
            FatalErrorInFunction
                << "no solved flow in " << runTime.globalPath()/instance
                << ": run ellipsoidTrapFoam -flowOnly first"
                << exit(FatalError);
        }
    }

    undecomposedFlow whole(mesh);
    {
        const volVectorField U(field("U"), mesh);
        const volScalarField p(field("p"), mesh);
        const surfaceScalarField phi(field("phi"), mesh);

        whole.gather(U, p, phi);

        const independentCells cells(properties, mesh, whole);

        captureMap map
        (
            dict, cells, whole, properties.seed(), runTime.deltaTValue()
        );
        map.make();

        if (Pstream::master())
        {
            map.write
            (
                runTime.globalPath()/"postProcessing"/"captureMap"/instance
            );
        }
    }

    Info<< "ClockTime = " << runTime.elapsedClockTime() << " s" << nl
        << "End\n" << endl;

    return 0;
}


// ************************************************************************* //
