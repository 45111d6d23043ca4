// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 the ellipsoidTrapFoam authors

/*---------------------------------------------------------------------------*\
Description
    What the core is told of forces that a case adds, and of the pressure.

\*---------------------------------------------------------------------------*/

#include "cellSurroundings.H"
#include "wildFields.H"

// * * * * * * * * * * * * * * * Local Classes * * * * * * * * * * * * * * * //

namespace Foam
{
    //- A charge and a dipole of the body's in the field, and a force in time
    struct chargeAndDipole : public externalForce
    {
        const vector dipole{1e-18, 2e-18, -3e-18};
        const vector inTime{3e-12, 1e-12, 2e-12};

        virtual bool unsteady() const
        {
            return true;
        }

        virtual void add(const pose& at, vector& force, vector& torque) const
        {
            force += 1e-12*at.E + at.t*inTime;
            torque += (at.R & dipole) ^ at.E;
        }
    };
}


// * * * * * * * * * * * * * * * Shared Functions  * * * * * * * * * * * * * //

void Foam::checkForces(const fvMesh& mesh)
{
    const ellipsoidProperties properties(mesh);
    const cellPopulation population(properties);
    wildFields fields(mesh);
    fields.change();
    cellDomain domain(population, fields.whole, fields.ofE, false);
    domain.flow.renew(fields.whole, 1000);

    const point x(13.62e-6, 10.31e-6, 4.73e-6);
    const scalar t = 0.7, h = 1e-10;
    meshFlow::probe at;
    tetCoordinates c;
    domain.flow.find(x, at);
    domain.flow.reach(x, at, c);
    const vector E(domain.flow.field(c, nullptr));

    externalForces added;
    const chargeAndDipole like;
    added.append(new chargeAndDipole);
    cellSurroundings here(domain, at);
    holds("without forces that are added the flow is steady", !here.unsteady);
    here.setForces(added, population.median().options);
    holds("one that depends on time makes it unsteady", here.unsteady);

    ellipsoid_state state = ellipsoid_state();
    const scalar axis[] = {0.48, 0.6, 0.64};
    ellipsoid_quaternion_from_axis(axis, 0.7, state.q);
    const tensor R(rotationOf(state.q));
    ellipsoid_wrench_jacobian jacobian = ellipsoid_wrench_jacobian();
    const auto pull =
        [&](const point& there, vector& force, vector& torque, const bool all)
        {
            std::copy_n(there.v_, 3, state.x);
            here.force
            (
                here.force_context, t, &state, force.v_, torque.v_,
                all ? &jacobian : nullptr
            );
        };
    vector force, torque;
    pull(x, force, torque, true);
    holds
    (
        "an added force is of the lab and its time, its torque of the body",
        same(force, 1e-12*E + t*like.inTime)
     && mag(torque - (like.dipole ^ (R.T() & E))) < 1e-12*mag(torque)
    );

    bool differences = true;
    for (direction k = 0; k < 3; ++k)
    {
        vector step(Zero), f[2], m[2], ofForce, ofTorque;
        step[k] = h;
        pull(x - step, f[0], m[0], false);
        pull(x + step, f[1], m[1], false);
        for (direction i = 0; i < 3; ++i)
        {
            ofForce[i] = jacobian.force_x[i][k];
            ofTorque[i] = jacobian.torque_x[i][k];
        }
        differences = differences
         && mag((f[1] - f[0])/(2*h) - ofForce) < 1e-5*mag(ofForce)
         && mag((m[1] - m[0])/(2*h) - ofTorque) < 1e-5*mag(ofTorque);
    }
    holds("their derivatives are differences of them", differences);

    ellipsoid_flow_sample sample;
    flowSample own;
    here.flow(here.flow_context, t, x.v_, 1, &sample);
    domain.flow.sample(t, c, true, own);
    holds
    (
        "the core is told the gradient of the pressure as it is",
        same(pointOf(sample.pressure_gradient), own.pressureGradient)
     && mag(own.pressureGradient) > 0
    );
}
