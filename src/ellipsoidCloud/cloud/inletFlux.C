// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "inletFlux.H"
#include "checkedEntries.H"
#include "foamVersions.H"
#include "masterGate.H"
#include "surfaceFields.H"
#include "undecomposedFlow.H"
#include "volFields.H"
#include "wallPolyPatch.H"

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::inletFlux::inletFlux
(
    const volVectorField& U,
    const surfaceScalarField& phi
)
:
    patches(openPatches(U.mesh().boundaryMesh())),
    flux(patches.size()),
    area(patches.size())
{
    const fvMesh& mesh = U.mesh();
    const scalar volume = gSum(mesh.V().field());
    const scalar meanSpeed = gSum(mag(U.primitiveField())*mesh.V())/volume;
    crossing = meanSpeed*pow(volume, 2.0/3.0);

    // Of a velocity along an open patch. A channel through which less flows
    // would be 1e13 times as long as wide
    const scalar rounding = 1e-9*crossing;
    scalar inletArea = 0;

    forAll(patches, i)
    {
        const scalarField& phip = phi.boundaryField()[patches[i]];

        flux[i] = gSum(phip);
        area[i] = gSum(mesh.magSf().boundaryField()[patches[i]]);

        if (gSumMag(phip) < rounding && area[i] > 0 && blocked < 0)
        {
            blocked = patches[i];
        }
        if (flux[i] <= -rounding && flux[i] < 0)
        {
            inflow -= flux[i];
            inletArea += area[i];
        }
    }

    for (const polyPatch& pp : mesh.boundaryMesh())
    {
        if (!isA<wallPolyPatch>(pp))
        {
            continue;
        }
        const scalar out = gSumMag(phi.boundaryField()[pp.index()]);
        const fvPatchVectorField& Up = U.boundaryField()[pp.index()];

        // What a wall that slides along itself leaks is the error of its facets
        if
        (
            leaking < 0
         && out > 1e-3*(inflow > 0 ? inflow : crossing)
         && out > 0.01*gSum(mag(Up)*Up.patch().magSf())
        )
        {
            leaking = pp.index();
            leak = out;
        }
    }

    speed = closed() ? meanSpeed : inflow/inletArea;
    if (!closed())
    {
        crossing = inflow;
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::labelList Foam::inletFlux::openPatches(const polyBoundaryMesh& patches)
{
    DynamicList<label> open(patches.size());

    for (const polyPatch& pp : patches)
    {
        const bool wall = isA<wallPolyPatch>(pp);

        if (!wall && !polyPatch::constraintType(pp.type()))
        {
            open.append(pp.index());
        }
    }

    return labelList(std::move(open));
}


Foam::scalar Foam::inletFlux::speedOf(const undecomposedFlow& undecomposed)
{
    scalar speed = 0;
    if (Pstream::master())
    {
        const undecomposedFlow::serialScope serial;
        speed = inletFlux(undecomposed.U(), undecomposed.phi()).speed;
    }
    broadcast(speed);

    return speed;
}


void Foam::inletFlux::checkWalls
(
    const polyMesh& mesh,
    const bool asItIs
) const
{
    const masterGate once;

    if (leaking >= 0)
    {
        const polyPatch& pp = mesh.boundaryMesh()[leaking];
        const std::string what
        (
            "fluid flows through patch " + pp.name() + " of type " + pp.type()
          + ", " + shortText(leak) + " m3/s\n"
            "    Cells would be held there. If it is an open end, make it one:"
            " type patch in " + mesh.meshDir()/"boundary"
          + "\n    allowed: 1e-3 of the inflow, or a U along the wall"
        );

        if (asItIs)
        {
            Warning << what.c_str() << nl << endl;
            return;
        }
        FatalErrorInFunction << what.c_str() << exit(FatalError);
    }
}


void Foam::inletFlux::checkOpen(const polyMesh& mesh) const
{
    const masterGate once;

    if (blocked >= 0)
    {
        const polyPatch& pp = mesh.boundaryMesh()[blocked];

        FatalErrorInFunction
            << "nothing flows through patch " << pp.name() << " of type "
            << pp.type() << nl
            << "    Cells would leave there. If it is a wall, make it one:"
            << " type wall in " << mesh.meshDir()/"boundary"
            << exit(FatalError);
    }
}
