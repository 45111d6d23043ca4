/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/

#include "flowConvergence.H"
#include "checkedEntries.H"
#include "fvcDiv.H"
#include "fvMesh.H"
#include "masterGate.H"
#include "surfaceFields.H"
#include "volFields.H"

#include <cmath>

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

const Foam::FixedList<const char*, Foam::flowConvergence::nMeasures>
Foam::flowConvergence::measureNames_
{
    "p",
    "U",
    "forces",
    "continuity",
    "flux change"
};


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::scalar Foam::flowConvergence::largestResidual
(
    const SolverPerformance<vector>& UPerf,
    const volVectorField& U
) const
{
    const vector meanSqr
    (
        gSum(cmptMultiply(U.primitiveField(), U.primitiveField())*mesh_.V())
    );
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


Foam::scalarField Foam::flowConvergence::record
(
    const volVectorField& U,
    const surfaceScalarField& phi
)
{
    through_.reset(new inletFlux(U, phi));

    const label nPatches = through_->patches.size();

    scalarField values(through_->flux);
    values.append(through_->meanSpeed);

    scalarField scales(through_->magFlux);
    scales.append(through_->meanSpeed);

    // A flux that is nothing beside the others need not be as exact
    for (label i = 0; i < nPatches; ++i)
    {
        scales[i] = max(scales[i], fluxTolerance_*through_->crossing);
    }

    history_.append(values);

    return scales;
}


Foam::scalar Foam::flowConvergence::range
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


Foam::scalar Foam::flowConvergence::fluxChange(const scalarField& scales) const
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

Foam::flowConvergence::flowConvergence
(
    const fvMesh& mesh,
    const dictionary& dict,
    const label fluxWindow
)
:
    mesh_(mesh),
    fluxTolerance_(),
    fluxWindow_(),
    target_(),
    value_(),
    through_(),
    history_()
{
    const masterGate once;

    const dictionary targets(dict.subOrEmptyDict("residualControl"));

    fluxTolerance_ = checkedNumber(dict, "fluxTolerance", above(0), 1e-4);
    fluxWindow_ = checkedNumber(dict, "fluxWindow", atLeast(1), fluxWindow);

    target_ = fluxTolerance_;
    target_[mPressure] = checkedNumber(targets, "p", above(0), 1e-5);
    target_[mVelocity] = checkedNumber(targets, "U", above(0), 1e-5);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::flowConvergence::begin(const scalar tolerance)
{
    for (scalar& target : target_)
    {
        target *= tolerance/fluxTolerance_;
    }
    fluxTolerance_ = tolerance;
    value_ = scalar(0);
}


void Foam::flowConvergence::restart
(
    const volVectorField& U,
    const surfaceScalarField& phi
)
{
    history_.clear();
    record(U, phi);
}


void Foam::flowConvergence::update
(
    const solverPerformance& pPerf,
    const SolverPerformance<vector>& UPerf,
    const forceRatios& forces,
    const volVectorField& U,
    const surfaceScalarField& phi
)
{
    const scalarField scales(record(U, phi));

    value_[mPressure] =
        forces.pressure > fluxTolerance_ ? pPerf.initialResidual() : 0;
    value_[mVelocity] = largestResidual(UPerf, U);
    value_[mForces] = forces.net;
    value_[mContinuity] =
        gSum(mag(fvc::div(phi)().primitiveField())*mesh_.V())
       /(through_->crossing + VSMALL);
    value_[mFluxChange] = fluxChange(scales);
}


bool Foam::flowConvergence::sound() const
{
    // Beyond this, squares would soon overflow
    const scalar maxSpeed = 1e30;

    for (const scalar value : value_)
    {
        if (!std::isfinite(value))
        {
            return false;
        }
    }

    const scalar meanSpeed = through_->meanSpeed;

    return std::isfinite(meanSpeed) && meanSpeed < maxSpeed;
}


Foam::scalar Foam::flowConvergence::excess() const
{
    scalar largest = SMALL;
    for (label i = 0; i < mFluxChange; ++i)
    {
        largest = max(largest, value_[i]/target_[i]);
    }

    return largest;
}


bool Foam::flowConvergence::reached() const
{
    for (label i = 0; i < nMeasures; ++i)
    {
        if (value_[i] > target_[i])
        {
            return false;
        }
    }

    return history_.size() > 2*fluxWindow_;
}


bool Foam::flowConvergence::reachedBefore() const
{
    // Residuals that ended below their targets may begin a little above
    const scalar slack = 2;

    for (label i = 0; i < nMeasures; ++i)
    {
        if (value_[i] > slack*target_[i])
        {
            return false;
        }
    }

    return true;
}


Foam::string Foam::flowConvergence::measures() const
{
    string line;
    for (label i = 0; i < nMeasures; ++i)
    {
        line +=
            string(i ? ", " : "") + measureNames_[i]
          + word::printf(" %.1e", value_[i]);
    }

    return line;
}


Foam::string Foam::flowConvergence::shortcomings() const
{
    string lines;
    for (label i = 0; i < nMeasures; ++i)
    {
        if (!(value_[i] <= target_[i]))
        {
            lines +=
                string("    ") + measureNames_[i]
              + word::printf(" %.2e", value_[i])
              + word::printf(", target %.2e\n", target_[i]);
        }
    }

    return lines;
}


// ************************************************************************* //
