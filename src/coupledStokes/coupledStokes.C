// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "coupledStokes.H"
#include "clockTime.H"
#include "coupledCorrection.H"
#include "coupledFvPatch.H"
#include "cyclicFvPatch.H"
#include "findRefCell.H"
#include "fvMatrices.H"
#include "fvMesh.H"
#include "processorFvPatch.H"
#include "sigFpe.H"
#include "steadyCriterion.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{

// Can values go over a patch as they are?
static bool exchanges(const fvPatch& patch)
{
    return
        !patch.coupled()
     || (
            refCast<const coupledFvPatch>(patch).parallel()
         && (isA<processorFvPatch>(patch) || isA<cyclicFvPatch>(patch))
        );
}


// Does the velocity of the mesh cells say what flows through?
static bool isOpen(const fvPatchVectorField& Up)
{
    return
        Up.assignable()
     && !Up.coupled()
     && !polyPatch::constraintType(Up.patch().type());
}


// The first boundary condition of a field that is none of these, the type of a
// patch that fixes it apart
template<class Type>
static string unknownCondition
(
    const GeometricField<Type, fvPatchField, volMesh>& field,
    const wordHashSet& known
)
{
    for (const fvPatchField<Type>& pf : field.boundaryField())
    {
        if
        (
            pf.type() != pf.patch().type()
         && !known.found(pf.type())
        )
        {
            return
                "the condition " + pf.type() + " of " + field.name()
              + " at patch " + pf.patch().name();
        }
    }

    return string();
}

} // End namespace Foam


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::autoPtr<Foam::coupledCorrection> Foam::coupledStokes::begin
(
    const bool scaled
)
{
    autoPtr<coupledCorrection> together
    (
        new coupledCorrection(U_, p_, phi_, nu_.value())
    );

    const bool moves = gMax(mag(U_.primitiveField())()) > 0;
    together->setDirections();
    if (scaled && moves)
    {
        together->scale(momentum_);
        iterate(momentum_(), true);
    }

    return together;
}


void Foam::coupledStokes::setReference()
{
    if (p_.needReference())
    {
        const scalar value = getRefCellValue(p_, how_.pRefCell);
        p_ += dimensionedScalar
        (
            "shift", p_.dimensions(), how_.pRefValue - value
        );
    }
}


Foam::scalar Foam::coupledStokes::linearTolerance(const scalar before) const
{
    // Nothing is known before the first correction. What the forces miss after
    // it is due to its convecting flux
    if (!criterion_->sound() || criterion_->excess() <= SMALL)
    {
        return 3e-5;
    }

    // Not farther than the targets ask, with room for what is measured in
    // another way; nor than pays, of what the next convecting flux will change
    // again: a tenth of that
    const scalar ahead = 0.2/criterion_->excess();
    const scalar changing = 0.1*min(criterion_->excess()/before, scalar(1));

    return min(max(max(ahead, changing), scalar(1e-4)), scalar(0.3));
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::coupledStokes::coupledStokes
(
    volVectorField& U,
    volScalarField& p,
    surfaceScalarField& phi,
    const dimensionedScalar& nu,
    const momentumEquation& momentum,
    const settings& how
)
:
    U_(U),
    p_(p),
    phi_(phi),
    nu_(nu),
    momentum_(momentum),
    how_(how),
    criterion_(new steadyCriterion(U, p, phi, nu.value(), how))
{
    U.mesh().setFluxRequired(p.name());
}


Foam::coupledStokes::~coupledStokes() = default;


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::string Foam::coupledStokes::refusal
(
    const volVectorField& U,
    const volScalarField& p
)
{
    bool exchanged = true;
    bool open = false;
    for (const fvPatchVectorField& Up : U.boundaryField())
    {
        exchanged = exchanged && exchanges(Up.patch());
        open = open || isOpen(Up);
    }

    if (!returnReduce(exchanged, andOp<bool>()))
    {
        return
            "coupled patches other than processor, and cyclic ones that do not"
            " turn vectors";
    }
    // Collective, too
    if (p.needReference() && open)
    {
        return
            "an outflow that is adjusted to the inflow because no patch fixes"
            " the pressure";
    }

    // Tried against simpleFoam (tests/cases/conditions.test). Others may need
    // every step of SIMPLE, or follow the flow from iteration to iteration
    const string ofU
    (
        unknownCondition
        (
            U,
            {
                "cylindricalInletVelocity", "fixedGradient", "fixedMean",
                "fixedNormalSlip", "fixedValue", "flowRateInletVelocity",
                "flowRateOutletVelocity", "fluxCorrectedVelocity",
                "inletOutlet", "matchedFlowRateOutletVelocity",
                "movingWallVelocity", "noSlip", "partialSlip",
                "pressureDirectedInletOutletVelocity",
                "pressureDirectedInletVelocity",
                "pressureInletOutletParSlipVelocity",
                "pressureInletOutletVelocity", "pressureInletUniformVelocity",
                "pressureInletVelocity", "pressureNormalInletOutletVelocity",
                "rotatingWallVelocity", "slip", "surfaceNormalFixedValue",
                "swirlFlowRateInletVelocity", "translatingWallVelocity",
                "uniformFixedValue", "uniformNormalFixedValue", "zeroGradient"
            }
        )
    );

    return
        ofU.size()
      ? ofU
      : unknownCondition
        (
            p,
            {
                "fixedGradient", "fixedJump", "fixedMean", "fixedValue",
                "mixed", "outletInlet", "slip", "totalPressure",
                "uniformFixedValue", "uniformTotalPressure", "zeroGradient"
            }
        );
}


bool Foam::coupledStokes::isSteady()
{
    const sigFpe::ignore noTrap;
    const volVectorField U(U_);
    const volScalarField p(p_);
    const surfaceScalarField phi(phi_);

    criterion_->restart();
    iterate(momentum_(), false);
    const bool steady = criterion_->sound() && criterion_->reachedBefore();

    U_ == U;
    p_ == p;
    phi_ == phi;

    return steady;
}


void Foam::coupledStokes::setTolerance(const scalar fluxTolerance)
{
    criterion_->setTolerance(fluxTolerance);
}


Foam::coupledStokes::outcome Foam::coupledStokes::solve(const bool scaled)
{
    // A flow that diverges is reported, not ended by a signal
    const sigFpe::ignore noTrap;

    criterion_->restart();
    const clockTime clock;
    scalar reported = -1;

    // Of the coupled method: iterations of GMRES, and how far the flow had been
    // from the targets before the latest correction
    autoPtr<coupledCorrection> together;
    tmp<fvVectorMatrix> UEqn;
    label nLinear = 0;
    scalar before = GREAT;
    if (how_.coupled)
    {
        together = begin(scaled);
        UEqn = momentum_();
    }

    for (label iteration = 1; iteration <= how_.maxIterations; ++iteration)
    {
        if (how_.coupled)
        {
            const scalar relTol = linearTolerance(before);
            before = iteration > 1 ? criterion_->excess() : GREAT;
            const label n = together->correct(UEqn(), relTol);
            if (n < 0)
            {
                return DIVERGED;
            }
            nLinear += n;
            setReference();
            UEqn = momentum_();
            iterate(tmp<fvVectorMatrix>(UEqn()), true);
        }
        else
        {
            iterate(momentum_(), false);
        }
        if (!criterion_->sound())
        {
            return DIVERGED;
        }

        // About a line a second, and the last one
        const bool reached = criterion_->reached();
        if (reached || clock.elapsedTime() > reported + 1)
        {
            reported = clock.elapsedTime();
            Info<< "flow: iteration " << iteration << ": "
                << measures().c_str() << endl;
        }
        if (reached)
        {
            Info<< "flow: converged in " << iteration << " iterations, ";
            if (how_.coupled)
            {
                Info<< nLinear << " of GMRES, ";
            }
            Info<< word::printf("%.6g", clock.elapsedTime()) << " s" << endl;
            if (criterion_->atRest())
            {
                Info<< "flow: at rest" << endl;
                U_ == dimensionedVector(dimVelocity, Zero);
                phi_ == dimensionedScalar(phi_.dimensions(), Zero);
            }
            return STEADY;
        }
    }

    return UNSTEADY;
}


Foam::string Foam::coupledStokes::measures() const
{
    return criterion_->measures();
}


Foam::string Foam::coupledStokes::shortcomings() const
{
    return criterion_->shortcomings();
}
