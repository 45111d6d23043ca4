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


Foam::label Foam::superposedFlow::sieveOf(const heldBody& body) const
{
    forAll(apertures_, s)
    {
        if (apertures_[s].patch == body.patch)
        {
            return s;
        }
    }

    FatalErrorInFunction
        << "flow superposed knows of cells that sieves hold, by the fluxes of"
        << " their apertures: cell " << body.id << " is held by "
        << empty_.U.mesh().boundaryMesh()[body.patch].name()
        << ", which is none of occupancy/apertures" << exit(FatalError);
    return -1;
}


// A body disturbs the flow about it as far as it is long
Foam::boundBox Foam::superposedFlow::boxAbout
(
    const occupancy::aperture& from,
    const List<heldBody>& bodies
) const
{
    const auto grown = [](boundBox box, const scalar by)
    {
        box.min() -= by*vector::one;
        box.max() += by*vector::one;
        return box;
    };
    const auto holdsAll = [&](const boundBox& box)
    {
        for (const heldBody& body : bodies)
        {
            const scalar reach = 2*cmptMax(body.semiAxes);
            const boundBox about(body.centre, body.centre);
            if (!box.contains(grown(about, reach)))
            {
                return false;
            }
        }

        return true;
    };

    scalar by = cmptMin(from.box.span());
    while (!holdsAll(grown(from.box, by)))
    {
        by *= 2;
    }

    return grown(from.box, by);
}


void Foam::superposedFlow::find
(
    const label s,
    const List<heldBody>& bodies,
    const scalar density
)
{
    sieve& of = sieves_[s];
    if (bodies == of.held)
    {
        return;
    }
    of.held = bodies;
    of.effect = {0, {}};
    if (bodies.empty())
    {
        return;
    }

    const occupancy::aperture& aperture = apertures_[s];
    const boundBox box(boxAbout(aperture, bodies));
    if (!of.flow.valid() || box != of.box)
    {
        of.box = box;
        of.flow.reset
        (
            new apertureFlow
            (
                aperture, box, empty_, closed_[s], nu_, tolerance_
            )
        );
    }

    const scalar ofClosed = change_[s][s]/flux_[s];
    of.effect = of.flow->of(bodies, ofClosed, density);
    Info<< "occupancy: " << aperture.name << " with " << bodies.size()
        << " cells takes " << 1 + of.effect.closed*ofClosed
        << " of its flux when empty, if no other sieve holds any" << endl;
}


Foam::scalarField Foam::superposedFlow::parts() const
{
    // c_s - r_s/Q_s0 sum_t c_t change_ts = r_s
    scalarSquareMatrix equations(sieves_.size(), Identity<scalar>());
    scalarField c(sieves_.size(), Zero);

    forAll(c, s)
    {
        // As it alone has this c
        const scalar alone = sieves_[s].effect.closed;
        c[s] = alone/(1 + alone*change_[s][s]/flux_[s]);
        forAll(c, t)
        {
            equations(s, t) -= c[s]/flux_[s]*change_[t][s];
        }
    }
    LUsolve(equations, c);

    return c;
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
    tolerance_(from.tolerance),
    empty_(empty),
    nu_(readViscosity(empty.U.mesh())),
    closed_(apertures_.size()),
    flux_(fluxes(empty.phi)),
    change_(apertures_.size()),
    sieves_(apertures_.size())
{
    const fvMesh& mesh = empty.U.mesh();
    checkReynoldsNumber(empty, nu_);

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
        sieves_.set(t, new sieve());
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::List<Foam::heldWrench> Foam::superposedFlow::superpose
(
    const List<heldBody>& bodies,
    const scalar density,
    steadyFlow& flow
)
{
    List<DynamicList<heldBody>> held(sieves_.size());
    labelList by(bodies.size());
    forAll(bodies, i)
    {
        by[i] = sieveOf(bodies[i]);
        held[by[i]].append(bodies[i]);
    }
    forAll(held, s)
    {
        find(s, held[s], density);
    }

    const scalarField c(parts());
    scalarField through(flux_);
    flow.restore(empty_);
    forAll(c, s)
    {
        if (c[s] != 0)
        {
            flow.add(c[s], closed_[s], empty_);
            through += c[s]*change_[s];
        }
    }

    // In the order of the bodies, which each sieve's are in, too
    List<heldWrench> wrenches(bodies.size());
    labelList next(sieves_.size(), 0);
    forAll(bodies, i)
    {
        const label s = by[i];
        const heldWrench& ofUnit = sieves_[s].effect.wrenches[next[s]++];
        wrenches[i].force = through[s]*ofUnit.force;
        wrenches[i].torque = through[s]*ofUnit.torque;
    }

    return wrenches;
}


// ************************************************************************* //
