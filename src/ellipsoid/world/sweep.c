/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    sweep.c - the space that a cell sweeps, and how far its points have moved.
*/
#include "world/world.h"

#include <math.h>

/* A step is looked at so often. */
#define PARTS 4

void ellipsoid_sweep_begin(ellipsoid_sweep *sweep, const ellipsoid_state *state)
{
    sweep->start = *state;
    ellipsoid_copy(state->x, sweep->low);
    ellipsoid_copy(state->x, sweep->high);
    ellipsoid_set(sweep->passed, 0, 0, 0);
    sweep->travel = 0;
}

/*
    The rotation since the beginning, in the body frame: v is the vector part of
    q0^-1 q. It moves the end of axis i by 2 sqrt(v.v - v_i^2), hence no point of
    the ellipsoid farther than the root of the sum over i of the squares of that
    times a_i (Cauchy-Schwarz).
*/
void ellipsoid_sweep_add(ellipsoid_sweep *sweep, const ellipsoid_model *model,
                         const ellipsoid_state *state)
{
    const double *a = model->options.semi_axes;
    const double *q = sweep->start.q, *p = state->q;
    double x[3], turn[3], v[3], moved[3], rotated = 0, longest = 0;

    ellipsoid_cross(q, p, turn);
    for (int i = 0; i < 3; i++)
    {
        x[i] = state->x[i] + sweep->passed[i];
        sweep->low[i] = ellipsoid_lesser(sweep->low[i], x[i]);
        sweep->high[i] = ellipsoid_greater(sweep->high[i], x[i]);
        v[i] = q[3] * p[i] - p[3] * q[i] - turn[i];
    }
    for (int i = 0; i < 3; i++)
    {
        rotated += a[i] * a[i]
                 * ellipsoid_greater(ellipsoid_dot(v, v) - v[i] * v[i], 0);
        longest = ellipsoid_greater(longest, a[i]);
    }
    ellipsoid_difference(x, sweep->start.x, moved);

    /* beads may stand out of the ellipsoid */
    const double out = ellipsoid_greater(model->reach - longest, 0);

    sweep->travel = ellipsoid_greater(
        sweep->travel, ellipsoid_length(moved) + 2 * sqrt(rotated)
                           + 2 * out * ellipsoid_length(v));
}

void ellipsoid_sweep_add_step(ellipsoid_sweep *sweep,
                              const ellipsoid_model *model,
                              const ellipsoid_step *step)
{
    for (int i = 1; i < PARTS; i++)
    {
        const double dt = step->end - step->start;
        ellipsoid_state state;

        ellipsoid_step_state(step, step->start + i * dt / PARTS, &state);
        ellipsoid_sweep_add(sweep, model, &state);
    }
    ellipsoid_sweep_add(sweep, model, &step->after);
}

void ellipsoid_sweep_prepend(ellipsoid_sweep *sweep,
                             const ellipsoid_sweep *first)
{
    sweep->start = first->start;
    for (int i = 0; i < 3; i++)
    {
        sweep->low[i] =
            ellipsoid_lesser(sweep->low[i] + first->passed[i], first->low[i]);
        sweep->high[i] = ellipsoid_greater(sweep->high[i] + first->passed[i],
                                           first->high[i]);
        sweep->passed[i] += first->passed[i];
    }
    sweep->travel += first->travel;
}
