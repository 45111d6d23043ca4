/*---------------------------------------------------------------------------*\
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
-------------------------------------------------------------------------------
License
    SPDX-License-Identifier: GPL-3.0-or-later
    See COPYING at the top of the source tree.

\*---------------------------------------------------------------------------*/

#include "superposedFlow.H"
#include "inletFlux.H"
#include "readViscosity.H"
#include "scalarMatrices.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace Foam
{
    //- Of the inlets. The serpentine's fluxes are off by 0.04 % there
    static const scalar largestReynoldsNumber = 1;

    static void checkReynoldsNumber
    (
        const steadyFlow::flow& flow,
        const dimensionedScalar& nu
    )
    {
        const inletFlux through(flow.U, flow.phi);
        const scalar number =
            sqrt(through.inflow*through.speed)/nu.value();

        if (number > largestReynoldsNumber)
        {
            FatalErrorInFunction
                << "occupancy/flow superposed needs a flow without inertia, and"
                << " the Reynolds number of the inlets is " << number << nl
                << "    allowed: up to " << largestReynoldsNumber
                << "; else flow solved" << exit(FatalError);
        }
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::scalarField Foam::superposedFlow::fluxes
(
    const surfaceScalarField& phi
) const
{
    scalarField sums(apertures_.size());
    forAll(sums, s)
    {
        sums[s] = apertures_[s].flux(phi);
    }

    return sums;
}


Foam::scalar Foam::superposedFlow::relativeFlux
(
    const label s,
    const label count
) const
{
    return count ? apertures_[s].relativeFlux[count - 1] : 1;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::superposedFlow::superposedFlow
(
    const occupancy::setting& from,
    const steadyFlow::flow& empty,
    steadyFlow& flow,
    solidBodies& solids
)
:
    apertures_(from.apertures),
    empty_(empty),
    closed_(apertures_.size()),
    flux_(fluxes(empty.phi)),
    change_(apertures_.size())
{
    const fvMesh& mesh = empty.U.mesh();
    checkReynoldsNumber(empty, readViscosity(mesh));

    forAll(apertures_, t)
    {
        if (flux_[t] == 0)
        {
            FatalErrorInFunction
                << "nothing flows through aperture " << apertures_[t].name
                << ": its box must reach across it" << exit(FatalError);
        }
        Info<< "occupancy: " << apertures_[t].name << " closed" << endl;

        DynamicList<label> beside;
        for (const label facei : apertures_[t].faces(mesh))
        {
            beside.append(mesh.owner()[facei]);
            beside.append(mesh.neighbour()[facei]);
        }
        solids.set(beside);
        flow.solveFrom(empty, from.tolerance);
        closed_.set(t, new steadyFlow::flow(flow));
        change_[t] = fluxes(flow.phi()) - flux_;
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::superposedFlow::known(const labelUList& counts) const
{
    forAll(counts, s)
    {
        if (counts[s] > apertures_[s].relativeFlux.size())
        {
            return false;
        }
    }

    return true;
}


void Foam::superposedFlow::superpose
(
    const labelUList& counts,
    steadyFlow& flow
) const
{
    // r_s such that, with s alone, Q_s/Q_s0 is the entry; then
    // c_s - r_s/Q_s0 sum_t c_t change_ts = r_s
    scalarSquareMatrix equations(counts.size(), Identity<scalar>());
    scalarField parts(counts.size(), Zero);

    forAll(parts, s)
    {
        const scalar alone = relativeFlux(s, counts[s]);
        if (alone < 1)
        {
            const scalar r = (alone - 1)/alone*flux_[s]/change_[s][s];
            parts[s] = r;
            forAll(parts, t)
            {
                equations(s, t) -= r/flux_[s]*change_[t][s];
            }
        }
    }
    LUsolve(equations, parts);

    flow.restore(empty_);
    forAll(parts, s)
    {
        if (parts[s] != 0)
        {
            flow.add(parts[s], closed_[s], empty_);
        }
    }
}


void Foam::superposedFlow::report
(
    const labelUList& counts,
    const steadyFlow& flow
) const
{
    DynamicList<label> taken;
    forAll(counts, s)
    {
        if (counts[s])
        {
            taken.append(s);
        }
    }

    const scalarField now(fluxes(flow.phi()));
    scalarSquareMatrix equations(taken.size(), Zero);
    scalarField parts(taken.size());

    forAll(taken, i)
    {
        const label s = taken[i];
        parts[i] = now[s] - flux_[s];
        forAll(taken, k)
        {
            equations(i, k) = change_[taken[k]][s];
        }
    }
    if (taken.size())
    {
        LUsolve(equations, parts);
    }

    forAll(taken, i)
    {
        const label s = taken[i];
        const scalar r = parts[i]*flux_[s]/now[s];

        Info<< "occupancy: " << apertures_[s].name << " with " << counts[s]
            << " cells: relativeFlux " << 1/(1 - r*change_[s][s]/flux_[s])
            << endl;
    }
}


// ************************************************************************* //
