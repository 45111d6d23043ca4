/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    noiseLayer.c - the start of a noise interval.

    There the random force and torque jump, and u and omega relax to new values.
    Where the interval is many relaxation times long the layer is not resolved:
    the state is taken across it by matched asymptotics.
*/
#include "motion/motion.h"

#include <float.h>

/* [relaxation times] from which on an interval is long */
static const double long_interval = 30;

/* Is the layer at t, where the noise of this cell jumps, to be crossed? */
static int is_thin(const ellipsoid_cell *p, double t, double until)
{
    const ellipsoid_noise *noise = p->noise;
    const double slowest =
        fmax(p->model->relaxation_time, p->model->rotation_relaxation_time);

    return noise
        && fabs(t - noise->start) <= 8 * DBL_EPSILON * fmax(fabs(t), until - t)
        && until - t >= long_interval * slowest;
}

/* u and omega decay: x moves by R m (mu K^)^-1 R^T u, and q likewise. */
static void displace(const ellipsoid_model *m, const double u[3],
                     const double omega[3], ellipsoid_state *state)
{
    const double *q = state->q, opposite[4] = {q[0], q[1], q[2], -q[3]};
    double axis[3][3], angle[3], turn[4];

    ellipsoid_rotation_inline(opposite, axis);
    for (int i = 0; i < 3; i++)
    {
        ellipsoid_add_times(
            state->x, m->mass * m->mobility[i] * ellipsoid_dot(axis[i], u),
            axis[i]);
        angle[i] = m->inertia[i] * m->rotation_mobility[i] * omega[i];
    }
    ellipsoid_spin(angle, q, turn);
    for (int n = 0; n < 4; n++)
    {
        state->q[n] += 0.5 * turn[n];
    }
    ellipsoid_normalise(state->q);
}

/*
    Leading order of matched asymptotics. u_b being the balanced velocity,
        m du/dt = mu R K^ R^T (u_b - u)
    leaves x displaced by R m (mu K^)^-1 R^T (u - u_b), and u = u_b; and
    likewise the rotation. A cell that touches is not displaced: a stiff wall
    does not let it drift on.
*/
ellipsoid_status ellipsoid_noise_layer(ellipsoid_group *g, double t,
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
    status = ellipsoid_group_evaluate(g, t, g->next, 1, 0);
    if (g->dissipative && ellipsoid_may_recover(status))
    {
        return ELLIPSOID_OK; /* followed instead */
    }
    for (int cell = 0; status == ELLIPSOID_OK && cell < g->count; cell++)
    {
        ellipsoid_state *before = &g->start[cell].state;
        ellipsoid_state *after = &g->next[cell].state;

        if (!g->cell[cell].fixed
            && (!ellipsoid_has_contact(g, cell)
                || !ellipsoid_in_contact(&g->next[cell].contact)))
        {
            double slip[3], spin[3];

            ellipsoid_difference(before->u, after->u, slip);
            ellipsoid_difference(before->omega, after->omega, spin);
            displace(g->cell[cell].model, slip, spin, after);
        }
        *before = *after;
        /* a cell may be so fast that it overflows */
        if (!ellipsoid_is_pose(after->x, after->q))
        {
            status = ELLIPSOID_BAD_STATE;
            g->failed = cell;
        }
    }
    return status;
}
