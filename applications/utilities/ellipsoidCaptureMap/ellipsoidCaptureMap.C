// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
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
    independentCells.C
    inletPlane.C

\*---------------------------------------------------------------------------*/

#include "argList.H"
#include "Time.H"
#include "fvMesh.H"
#include "columnFvMesh.H"
#include "captureMap.H"
#include "caseFiles.H"
#include "caseProperties.H"
#include "caseSummary.H"
#include "masterGate.H"
#include "ellipsoidCore.H"
#include "flowChecks.H"
#include "surfaceFields.H"
#include "undecomposedFlow.H"
#include "volFields.H"

using namespace Foam;

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

static IOobject fieldOf
(
    const word& name,
    const word& instance,
    const fvMesh& mesh
)
{
    return IOobject
    (
        name, instance, mesh, IOobject::MUST_READ, IOobject::NO_WRITE
    );
}


//- End the run if the dictionary cannot be right or the flow is not solved
static void checkCase
(
    const dictionary& dict,
    const fvMesh& mesh,
    const word& instance
)
{
    const Time& runTime = mesh.time();
    IOobject phi(fieldOf("phi", instance, mesh));
    const bool solved = returnReduce
    (
        phi.typeHeaderOk<surfaceScalarField>(true)
     && !isFile(unfinishedFlow(runTime.path()/instance)),
        andOp<bool>()
    );

    const masterGate once;

    if (Pstream::master())
    {
        refuseRepeated(runTime.globalPath()/runTime.system()/dict.dictName());
    }
    checkedNumber<scalar>(runTime.controlDict(), "deltaT", above(0));

    if (!solved)
    {
        FatalErrorInFunction
            << "no solved flow in " << runTime.globalPath()/instance
            << ": run ellipsoidTrapFoam -flowOnly first" << exit(FatalError);
    }
}


//- Make the map of the flow that the case has, and write it; collective
void makeMap
(
    const dictionary& dict,
    const fvMesh& mesh,
    const ellipsoidProperties& properties,
    const Time& runTime
)
{
    const word instance(caseFiles::flowInstance(mesh));
    checkCase(dict, mesh, instance);
    autoPtr<captureMap::setting> from;
    {
        const masterGate once;
        from.reset
        (
            new captureMap::setting
            (
                dict, mesh.boundaryMesh(), properties.seed()
            )
        );
    }

    undecomposedFlow undecomposed(mesh);
    const volVectorField U(fieldOf("U", instance, mesh), mesh);
    const volScalarField p(fieldOf("p", instance, mesh), mesh);
    const surfaceScalarField phi(fieldOf("phi", instance, mesh), mesh);

    undecomposed.gather({U, p, phi});
    reportInertia(U, properties, longestSemiAxis(properties.options()));

    const independentCells cells(properties, mesh, undecomposed);

    const inletPlane plane(dict, undecomposed);
    captureMap map(*from, plane, cells, runTime.deltaTValue());
    map.make();

    if (Pstream::master())
    {
        map.write(runTime.globalPath()/"postProcessing"/"captureMap"/instance);
    }
}

int main(int argc, char *argv[])
{
    argList::addNote
    (
        "Map from where cells that enter by a patch end in which sieve."
        " Version " ELLIPSOID_VERSION
    );

    caseFiles::checkPath(argc, argv);
    #include "setRootCaseListOptions.H"
    argList args(argc, argv);
    #include "setRootCaseListOutput.H"
    #include "foamDlOpenLibs.H"

    caseFiles::checkCase
    (
        args,
        {
            "constant/transportProperties", "constant/ellipsoidCloudProperties",
            "system/captureMapDict", "system/fvSchemes", "system/fvSolution"
        }
    );

    #include "createTime.H"

    // The digits of writePrecision are for files
    Sout.precision(6);
    Pout.precision(6);

    caseFiles::checkMesh(runTime, true);
    #include "createMesh.H"

    caseProperties properties(mesh);
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

    makeMap(dict, mesh, properties, runTime);

    Info<< "ClockTime = " << runTime.elapsedClockTime() << " s" << nl
        << "End\n" << endl;

    return 0;
}
