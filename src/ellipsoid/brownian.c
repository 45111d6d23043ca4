/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    brownian.c - the random force and torque of the fluid.

    Fluctuation and dissipation: <F F^T> = 2 kT mu K delta(t), and likewise the
    torque with the rotational resistance. Over an interval dt both are constant
    in the body frame, of variance 2 kT mu K^_i/dt and 2 kT mu C_i/dt.

    At the start of an interval they jump, and u and omega relax to new values.
    Where the interval is many relaxation times long nobody wants to follow
    that: the layer is crossed in one go.
*/
#include "integrator.h"

#include <float.h>

/* [J/K], SI 2019 */
static const double boltzmann = 1.380649e-23;

/* Intervals of so many relaxation times are long. */
static const double many = 30;

void ellipsoid_noise_scales(ellipsoid_model *model)
{
    const ellipsoid_options *o = &model->options;
    const double power =
        2 * boltzmann * o->temperature * model->viscosity / o->noise_interval;

    for (int i = 0; i < 3; i++)
    {
        model->noise_force[i] = sqrt(power * model->resistance[i]);
        model->noise_torque[i] = sqrt(power * model->rotation_resistance[i]);
    }
}

ellipsoid_status ellipsoid_noise_at(const ellipsoid_model *model,
                                    const ellipsoid_surroundings *surroundings,
                                    double t, ellipsoid_noise *noise)
{
    const double interval = model->options.noise_interval;
    const double place = t / interval;
    /* a time so close to the end of an interval, in units of it, is that end */
    const double slack = fmax(1e-9, 4 * DBL_EPSILON * fabs(place));
    const double number = floor(place + slack);
    double normal[6];

    noise->start = number * interval;
    noise->end = (number + 1) * interval;
    noise->slack = slack * interval;
    if (!(slack < 0.01))
    {
        return ELLIPSOID_STEP_UNDERFLOW;
    }
    ellipsoid_random_normal(surroundings->seed, surroundings->id,
                            (int64_t)number, normal);
    for (int i = 0; i < 3; i++)
    {
        noise->force[i] = model->noise_force[i] * normal[i];
        noise->torque[i] = model->noise_torque[i] * normal[3 + i];
    }
    return ELLIPSOID_OK;
}

void ellipsoid_add_noise(const ellipsoid_noise *noise, double axis[3][3],
                         double axis_derivatives[4][3][3], double force[3],
                         double torque[3], ellipsoid_blocks *blocks)
{
    const double *f = noise->force;
    double lab[3];

    ellipsoid_combination(axis, f[0], f[1], f[2], lab);
    ellipsoid_add(force, lab);
    ellipsoid_add(torque, noise->torque);
    for (int n = 0; blocks && n < 4; n++)
    {
        ellipsoid_combination(axis_derivatives[n], f[0], f[1], f[2], lab);
        for (int i = 0; i < 3; i++)
        {
            blocks->uq[i][n] += lab[i];
        }
    }
}

/* Is the layer at t, where the noise of this cell jumps, to be crossed? */
static int is_thin(const ellipsoid_problem *p, double t, double until)
{
    const ellipsoid_noise *noise = p->noise;
    const double slowest =
        fmax(p->model->relaxation_time, p->model->rotation_relaxation_time);

    return noise
        && fabs(t - noise->start) <= 8 * DBL_EPSILON * fmax(fabs(t), until - t)
        && until - t >= many * slowest;
}

/* Displaces `after`, which has its balanced u and omega, see below. */
static void displace(const ellipsoid_model *m, const ellipsoid_state *before,
                     ellipsoid_state *after)
{
    const double *q = before->q, opposite[4] = {q[0], q[1], q[2], -q[3]};
    double axis[3][3], slip[3], angle[3], turn[4];

    ellipsoid_rotation_inline(opposite, axis);
    ellipsoid_difference(before->u, after->u, slip);
    for (int i = 0; i < 3; i++)
    {
        const double way =
            m->mass * m->mobility[i] * ellipsoid_dot(axis[i], slip);

        for (int l = 0; l < 3; l++)
        {
            after->x[l] += way * axis[i][l];
        }
        angle[i] = m->inertia[i] * m->rotation_mobility[i]
                 * (before->omega[i] - after->omega[i]);
    }
    ellipsoid_spin(angle, q, turn);
    for (int n = 0; n < 4; n++)
    {
        after->q[n] += 0.5 * turn[n];
    }
    ellipsoid_normalise(after->q);
}

/*
    Leading order of matched asymptotics. u_b being the balanced velocity,
        m du/dt = mu R K^ R^T (u_b - u)
    leaves x displaced by R m (mu K^)^-1 R^T (u - u_b), and u = u_b; and
   likewise the rotation. A cell that touches is not displaced: a stiff wall
   does not let it drift on.
*/
ellipsoid_status ellipsoid_cross_layer(ellipsoid_group *g, double t,
                                       double until)
{
    ellipsoid_status status;
    int crossed = g->inertial;

    for (int cell = 0; cell < g->count; cell++)
    {
        crossed = crossed && is_thin(&g->cell[cell], t, until);
        g->next[cell].state = g->start[cell].state;
    }
    if (!crossed)
    {
        return ELLIPSOID_OK;
    }
    status = ellipsoid_group_evaluate(g, g->next, 1, 0);
    for (int cell = 0; status == ELLIPSOID_OK && cell < g->count; cell++)
    {
        ellipsoid_state *before = &g->start[cell].state;
        ellipsoid_state *after = &g->next[cell].state;

        if (!ellipsoid_group_feels(g, cell)
            || !ellipsoid_touches(&g->next[cell].contact))
        {
            displace(g->cell[cell].model, before, after);
        }
        *before = *after;
    }
    return status;
}
