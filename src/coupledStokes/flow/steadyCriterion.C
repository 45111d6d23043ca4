// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

#include "steadyCriterion.H"
#include "fvcSurfaceIntegrate.H"
#include "fvMesh.H"
#include "meshTools.H"
#include "surfaceFields.H"
#include "volFields.H"
#include "wallPolyPatch.H"

#include <cmath>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::scalar Foam::steadyCriterion::largestResidual
(
    const SolverPerformance<vector>& UPerf
) const
{
    const vectorField& U = U_.primitiveField();
    const vector meanSqr(gSum(cmptMultiply(U, U)*U_.mesh().V()));
    const scalar negligible = sqr(fluxTolerance_)*cmptSum(meanSqr);

    scalar largest = 0;
    for (direction cmpt = 0; cmpt < vector::nComponents; ++cmpt)
    {
        if (meanSqr[cmpt] > negligible)
        {
            largest = max(largest, UPerf.initialResidual()[cmpt]);
        }
    }

    return largest;
}


Foam::scalarField Foam::steadyCriterion::record()
{
    const fvMesh& mesh = U_.mesh();

    meanSpeed_ = gSum(mag(U_.primitiveField())*mesh.V())/volume_;
    crossing_ = meanSpeed_*pow(volume_, 2.0/3.0);
    inflow_ = 0;

    // Below this a flux is the rounding of a velocity along an open patch
    const scalar rounding = 1e-9*crossing_;

    scalarField values, scales;
    for (const polyPatch& patch : mesh.boundaryMesh())
    {
        if
        (
            !isA<wallPolyPatch>(patch)
         && !polyPatch::constraintType(patch.type())
        )
        {
            const scalarField& phip = phi_.boundaryField()[patch.index()];
            const scalar flux = gSum(phip);

            values.append(flux);
            scales.append(gSumMag(phip));
            if (flux < 0 && -flux >= rounding)
            {
                inflow_ -= flux;
            }
        }
    }
    if (inflow_ > 0)
    {
        crossing_ = inflow_;
    }

    // A flux that is nothing beside the others need not be as exact
    scales = max(scales, fluxTolerance_*crossing_);

    values.append(meanSpeed_);
    scales.append(meanSpeed_);
    history_.append(values);

    return scales;
}


Foam::scalar Foam::steadyCriterion::range
(
    const label valuei,
    const label ago
) const
{
    const label last = history_.size() - 1 - ago;

    scalar low = history_[last][valuei];
    scalar high = low;
    for (label i = max(last - fluxWindow_, label(0)); i < last; ++i)
    {
        low = min(low, history_[i][valuei]);
        high = max(high, history_[i][valuei]);
    }

    return high - low;
}


Foam::scalar Foam::steadyCriterion::fluxChange(const scalarField& scales) const
{
    // Bounds the rest of the series, so that changes at the level of rounding,
    // which no longer fall, extrapolate to little
    const scalar maxWindows = 1000;

    scalar change = 0;
    forAll(scales, i)
    {
        const scalar now = range(i, 0);
        scalar rest = now;

        if (history_.size() > 2*fluxWindow_)
        {
            const scalar before = range(i, fluxWindow_);
            rest *=
                now < (before - now)*maxWindows
              ? max(now/(before - now), scalar(1))
              : maxWindows;
        }

        change = max(change, rest/(scales[i] + VSMALL));
    }

    return change;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::steadyCriterion::steadyCriterion
(
    const volVectorField& U,
    const volScalarField& p,
    const surfaceScalarField& phi,
    const scalar nu,
    const coupledStokes::settings& how
)
:
    U_(U),
    p_(p),
    phi_(phi),
    nu_(nu),
    volume_(gSum(U.mesh().V().field())),
    fluxTolerance_(how.fluxTolerance),
    fluxWindow_(how.fluxWindow > 0 ? how.fluxWindow : how.coupled ? 1 : 10),
    measures_
    ({
        {"p", how.pResidual, 0},
        {"U", how.UResidual, 0},
        {"forces", fluxTolerance_, 0},
        {"continuity", fluxTolerance_, 0},
        {"flux change", fluxTolerance_, 0}
    })
{
    record();
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::steadyCriterion::setTolerance(const scalar tolerance)
{
    for (measure& m : measures_)
    {
        m.target *= tolerance/fluxTolerance_;
        m.value = 0;
    }
    fluxTolerance_ = tolerance;
}


void Foam::steadyCriterion::restart()
{
    history_.clear();
    record();
}


Foam::steadyCriterion::forceRatios Foam::steadyCriterion::forces
(
    const vectorField& momentum,
    const vectorField& gradP
) const
{
    const fvMesh& mesh = U_.mesh();
    vectorField net(momentum + gradP);
    meshTools::constrainDirection(mesh, mesh.solutionD(), net);

    scalar shear = 0;
    for (const fvPatchVectorField& Up : U_.boundaryField())
    {
        if (!Up.coupled())
        {
            shear += nu_*sum(mag(Up.snGrad())*Up.patch().magSf());
        }
    }
    reduce(shear, sumOp<scalar>());

    const scalar pressure = gSum(mag(gradP)*mesh.V());

    // Where nothing resists, as between walls that slip, both are of rounding
    const scalar least = 1e-3*nu_*meanSpeed_*cbrt(volume_);
    const scalar driving = max(pressure + shear, least) + VSMALL;

    return {gSum(mag(net)*mesh.V())/driving, pressure/driving};
}


void Foam::steadyCriterion::update
(
    const solverPerformance& pPerf,
    const SolverPerformance<vector>& UPerf,
    const forceRatios& forces
)
{
    const scalarField scales(record());

    measures_[PRESSURE].value =
        forces.pressure > fluxTolerance_ ? pPerf.initialResidual() : 0;
    measures_[VELOCITY].value = largestResidual(UPerf);
    measures_[FORCES].value = forces.net;
    measures_[CONTINUITY].value =
        gSum(mag(fvc::surfaceIntegrate(phi_)().primitiveField())*U_.mesh().V())
       /(crossing_ + VSMALL);
    measures_[FLUX_CHANGE].value = fluxChange(scales);

    if (atRest())
    {
        for (measure& m : measures_)
        {
            m.value = 0;
        }
    }
}


bool Foam::steadyCriterion::atRest() const
{
    const scalar rounding = 1e-12*gMax(mag(p_.primitiveField())());

    return meanSpeed_ < rounding*cbrt(volume_)/nu_;
}


bool Foam::steadyCriterion::sound() const
{
    // Beyond this, squares would soon overflow
    const scalar maxSpeed = 1e30;

    for (const measure& m : measures_)
    {
        if (!std::isfinite(m.value))
        {
            return false;
        }
    }

    return std::isfinite(meanSpeed_) && meanSpeed_ < maxSpeed;
}


Foam::scalar Foam::steadyCriterion::excess() const
{
    scalar largest = SMALL;
    for (label i = 0; i < FLUX_CHANGE; ++i)
    {
        largest = max(largest, measures_[i].value/measures_[i].target);
    }

    return largest;
}


bool Foam::steadyCriterion::within(const scalar slack) const
{
    for (const measure& m : measures_)
    {
        if (m.value > slack*m.target)
        {
            return false;
        }
    }

    return true;
}


bool Foam::steadyCriterion::reached() const
{
    return within(1) && history_.size() > 2*fluxWindow_;
}


bool Foam::steadyCriterion::reachedBefore() const
{
    // Residuals that ended below their targets may begin a little above
    return within(2);
}


Foam::string Foam::steadyCriterion::measures() const
{
    string line;
    for (const measure& m : measures_)
    {
        line += m.name + word::printf(" %.1e, ", m.value);
    }

    return
        line
      + (
            inflow_ > 0
          ? word::printf("inflow %.6g m3/s", inflow_)
          : word::printf("mean speed %.6g m/s", meanSpeed_)
        );
}


Foam::string Foam::steadyCriterion::shortcomings() const
{
    string lines;
    for (const measure& m : measures_)
    {
        // Which does not trap where a flow that diverged left no number
        if (!std::islessequal(m.value, m.target))
        {
            lines +=
                string("    ") + m.name
              + word::printf(" %.2e, target ", m.value)
              + word::printf("%.2e\n", m.target);
        }
    }

    return lines;
}
