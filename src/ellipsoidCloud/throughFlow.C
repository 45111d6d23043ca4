/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/
#include "throughFlow.H"
#include "fvMesh.H"
#include "wallPolyPatch.H"

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::throughFlow::throughFlow
(
    const volVectorField& U,
    const surfaceScalarField& phi
)
:
    inflow_(0),
    inletArea_(0),
    meanSpeed_(0)
{
    const fvMesh& mesh = U.mesh();
    const scalar volume = gSum(mesh.V());

    meanSpeed_ = gSum(mag(U.primitiveField())*mesh.V())/volume;

    for (const label patchi : openPatches(mesh.boundaryMesh()))
    {
        const scalar flux = -gSum(phi.boundaryField()[patchi]);

        if (flux > 0 && !isRounding(flux, crossFlux(meanSpeed_, volume)))
        {
            inflow_ += flux;
            inletArea_ += gSum(mesh.magSf().boundaryField()[patchi]);
        }
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::labelList Foam::throughFlow::openPatches(const polyBoundaryMesh& patches)
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
