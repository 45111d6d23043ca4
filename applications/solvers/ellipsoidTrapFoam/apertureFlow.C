/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/

#include "apertureFlow.H"
#include "coupledCorrection.H"
#include "fixedValueFvPatchFields.H"
#include "fvmLaplacian.H"
#include "fvmSup.H"
#include "fvMatrices.H"
#include "sigFpe.H"
#include "zeroGradientFvPatchFields.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::wordList Foam::apertureFlow::conditions(const bool ofU) const
{
    const word fixed(fixedValueFvPatchScalarField::typeName);
    const word free(zeroGradientFvPatchScalarField::typeName);
    const fvBoundaryMesh& boundary = part_.mesh().boundary();

    wordList types(boundary.size(), ofU ? free : fixed);
    forAll(part_.patches(), i)
    {
        const fvPatchVectorField& Up =
            empty_.U.boundaryField()[part_.patches()[i]];

        types[i] =
            polyPatch::constraintType(boundary[i].type()) ? boundary[i].type()
          : Up.fixesValue() == ofU ? fixed
          : free;
    }

    return types;
}


Foam::scalar Foam::apertureFlow::solve
(
    const List<heldBody>& bodies,
    const steadyFlow::flow& outside
)
{
    // The same start whatever was solved before
    U_.primitiveFieldRef() = part_.cellValues(empty_.U);
    p_.primitiveFieldRef() = part_.cellValues(empty_.p);
    phi_ = dimensionedScalar("rest", phi_.dimensions(), Zero);
    forAll(part_.mesh().boundary(), patchi)
    {
        if (U_.boundaryField()[patchi].fixesValue())
        {
            U_.boundaryFieldRef()[patchi] ==
                part_.patchValues(outside.U, patchi);
        }
        if (p_.boundaryField()[patchi].fixesValue())
        {
            p_.boundaryFieldRef()[patchi] ==
                part_.patchValues(outside.p, patchi);
        }
    }
    U_.correctBoundaryConditions();
    p_.correctBoundaryConditions();
    solids_.set(bodies);

    // The first corrections serve the explicit part on non-orthogonal faces
    const scalar relTol = 1e-3;
    const label maxCorrections = 50;

    const sigFpe::ignore noTrap;
    coupledCorrection together(U_, p_, phi_, nu_.value());
    scalar flux = 0;
    scalar change = 1;
    for (label i = 0; mag(change) > tolerance_*mag(flux); ++i)
    {
        const fvVectorMatrix UEqn
        (
            fvm::Sp(solids_.resistance(), U_) - fvm::laplacian(nu_, U_)
        );

        if (i == maxCorrections || together.correct(UEqn, relTol) < 0)
        {
            FatalErrorInFunction
                << "The flow about aperture " << aperture_.name
                << " with held cells is not found: take occupancy/flow solved"
                << exit(FatalError);
        }
        change = aperture_.flux(phi_) - flux;
        flux += change;
    }

    return flux;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::apertureFlow::apertureFlow
(
    const occupancy::aperture& aperture,
    const boundBox& box,
    const steadyFlow::flow& empty,
    const steadyFlow::flow& closed,
    const dimensionedScalar& nu,
    const scalar tolerance
)
:
    aperture_(aperture),
    empty_(empty),
    part_(empty.U.mesh(), box),
    nu_(nu),
    tolerance_(tolerance),
    U_
    (
        IOobject("U", part_.mesh().time().timeName(), part_.mesh()),
        part_.mesh(),
        dimensionedVector("rest", dimVelocity, Zero),
        conditions(true)
    ),
    p_
    (
        IOobject("p", part_.mesh().time().timeName(), part_.mesh()),
        part_.mesh(),
        dimensionedScalar("none", sqr(dimVelocity), Zero),
        conditions(false)
    ),
    phi_
    (
        IOobject("phi", part_.mesh().time().timeName(), part_.mesh()),
        part_.mesh(),
        dimensionedScalar("rest", dimVolume/dimTime, Zero)
    ),
    solids_(part_.mesh(), nu),
    flux_(solve(List<heldBody>(), empty)),
    ofClosed_(solve(List<heldBody>(), closed)/flux_)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::apertureFlow::effect Foam::apertureFlow::of
(
    const List<heldBody>& bodies,
    const scalar ofClosed,
    const scalar density
)
{
    const scalar flux = solve(bodies, empty_);
    const scalar x = flux/flux_;

    effect found
    {
        (x - 1)/(ofClosed - x*(ofClosed_ - 1)), solids_.wrenches(U_, density)
    };
    for (heldWrench& wrench : found.wrenches)
    {
        wrench.force /= flux;
        wrench.torque /= flux;
    }

    return found;
}


// ************************************************************************* //
