/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "inletFlux.H"
#include "undecomposedFlow.H"
#include "wallPolyPatch.H"

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::inletFlux::inletFlux
(
    const volVectorField& U,
    const surfaceScalarField& phi
)
:
    patches_(openPatches(U.mesh().boundaryMesh())),
    flux_(patches_.size()),
    magFlux_(patches_.size()),
    area_(patches_.size()),
    inflow_(0),
    inletArea_(0),
    meanSpeed_(0),
    crossing_(0),
    rounding_(0)
{
    const fvMesh& mesh = U.mesh();
    const label n = patches_.size();

    // One message for all sums
    scalarField sums(3*n + 2);

    forAll(patches_, i)
    {
        const scalarField& phip = phi.boundaryField()[patches_[i]];

        sums[i] = sum(phip);
        sums[n + i] = sum(mag(phip));
        sums[2*n + i] = sum(mesh.magSf().boundaryField()[patches_[i]]);
    }
    sums[3*n] = sum(mag(U.primitiveField())*mesh.V());
    sums[3*n + 1] = sum(mesh.V().field());

    Pstream::listCombineGather(sums, plusEqOp<scalar>());
    Pstream::listCombineScatter(sums);

    const scalar volume = sums[3*n + 1];
    meanSpeed_ = sums[3*n]/volume;
    crossing_ = meanSpeed_*pow(volume, 2.0/3.0);
    rounding_ = 1e-9*crossing_;

    forAll(patches_, i)
    {
        flux_[i] = sums[i];
        magFlux_[i] = sums[n + i];
        area_[i] = sums[2*n + i];

        if (flux_[i] < 0 && !isRounding(flux_[i]))
        {
            inflow_ -= flux_[i];
            inletArea_ += area_[i];
        }
    }

    if (!closed())
    {
        crossing_ = inflow_;
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalar Foam::inletFlux::speedOf(const undecomposedFlow& whole)
{
    scalar speed = 0;
    if (Pstream::master())
    {
        const undecomposedFlow::serialScope serial;
        speed = inletFlux(whole.U(), whole.phi()).speed();
    }
    Pstream::scatter(speed);

    return speed;
}


Foam::labelList Foam::inletFlux::openPatches(const polyBoundaryMesh& patches)
{
    DynamicList<label> open(patches.size());

    for (const polyPatch& pp : patches)
    {
        if (!isA<wallPolyPatch>(pp) && !polyPatch::constraintType(pp.type()))
        {
            open.append(pp.index());
        }
    }

    return labelList(std::move(open));
}


// ************************************************************************* //
