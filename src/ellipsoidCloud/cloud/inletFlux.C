// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "inletFlux.H"
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
    magFlux(patches.size()),
    area(patches.size())
{
    const fvMesh& mesh = U.mesh();

    forAll(patches, i)
    {
        const scalarField& phip = phi.boundaryField()[patches[i]];

        flux[i] = gSum(phip);
        magFlux[i] = gSumMag(phip);
        area[i] = gSum(mesh.magSf().boundaryField()[patches[i]]);
    }

    const scalar volume = gSum(mesh.V().field());
    meanSpeed = gSum(mag(U.primitiveField())*mesh.V())/volume;
    crossing = meanSpeed*pow(volume, 2.0/3.0);
    rounding = 1e-9*crossing;

    scalar inletArea = 0;
    forAll(patches, i)
    {
        if (flux[i] < 0 && !isRounding(flux[i]))
        {
            inflow -= flux[i];
            inletArea += area[i];
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


void Foam::inletFlux::checkOpen(const polyMesh& mesh) const
{
    const masterGate once;

    forAll(patches, i)
    {
        if (area[i] > 0 && isRounding(magFlux[i]))
        {
            const polyPatch& pp = mesh.boundaryMesh()[patches[i]];

            FatalErrorInFunction
                << "nothing flows through patch " << pp.name() << " of type "
                << pp.type() << nl
                << "    Cells would leave there. If it is a wall, make it one:"
                << " type wall in " << mesh.meshDir()/"boundary"
                << exit(FatalError);
        }
    }
}
