/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    rosenbrock.c - one step of a Rosenbrock method.

    Hairer & Wanner, Solving Ordinary Differential Equations II (1996), section
    IV.7. Without inertia the equations for u and omega become algebraic, with
    index 1, and the method is that of section VI.4: the same with a mass matrix
    that has zeros there.
*/
#include "motion/motion.h"

#include <math.h>
#include <string.h>

static const ellipsoid_rosenbrock_table *const set = &ellipsoid_rosenbrock_set;

INLINED void combine(const double base[UNKNOWNS], double factor,
                     const double *weight, int stage, double k[][UNKNOWNS],
                     double result[restrict UNKNOWNS])
{
    for (int n = 0; n < UNKNOWNS; n++)
    {
        result[n] =
            base[n] + factor * ellipsoid_weighted_sum(k, weight, stage, n);
    }
}

/* With numbers of stages that the compiler knows; not inlined, where it would mix
   them. */
void ellipsoid_combine(const double base[UNKNOWNS], double factor,
                       const double *weight, int stage, double k[][UNKNOWNS],
                       double result[restrict UNKNOWNS])
{
    stage == 1   ? combine(base, factor, weight, 1, k, result)
    : stage == 2 ? combine(base, factor, weight, 2, k, result)
    : stage == 3 ? combine(base, factor, weight, 3, k, result)
    : stage == 4 ? combine(base, factor, weight, 4, k, result)
                 : combine(base, factor, weight, 5, k, result);
}

/*
    df/dt of u and omega at the start, by a forward difference over a small part
    of the step: what it lacks is far below the tolerance. Of inertialess motion
    what the start leaves unbalanced cancels.
*/
static ellipsoid_status set_time_derivatives(ellipsoid_group *g,
                                             const ellipsoid_plan *plan)
{
    const double part = plan->start + 1e-5 * plan->h;
    const double later = part > plan->start ? part : plan->end;

    for (int at = 0; at < 2; at++)
    {
        for (int cell = 0; cell < g->count; cell++)
        {
            g->next[cell].state = g->start[cell].state;
        }

        const ellipsoid_status status = ellipsoid_group_evaluate(
            g, at == 0 ? plan->start : later, g->next, 0, 0);

        if (status != ELLIPSOID_OK)
        {
            return status;
        }
        for (int cell = 0; cell < g->count; cell++)
        {
            double *d = g->stages[cell].time_derivative;

            for (int n = 0; n < UNKNOWNS; n++)
            {
                const double slope = g->next[cell].slope[n];

                d[n] = at == 0 ? slope : (slope - d[n]) / (later - plan->start);
            }
        }
    }
    return ELLIPSOID_OK;
}

static void add_time_derivatives(const ellipsoid_group *g, int stage, double h)
{
    const double factor = set->gamma_sum[stage] * h;

    for (int cell = 0; cell < g->count; cell++)
    {
        ellipsoid_stages *s = &g->stages[cell];

        for (int n = 0; n < UNKNOWNS; n++)
        {
            s->k[stage][n] += factor * s->time_derivative[n];
        }
    }
}

static inline void take_first_stage(ellipsoid_group *g, int count, double h)
{
    for (int cell = 0; cell < count; cell++)
    {
        ellipsoid_stages *s = &g->stages[cell];

        s->sampled = ELLIPSOID_STAGES;
        s->in_time = set->in_time;
        memcpy(s->k[0], g->start[cell].slope, sizeof(s->k[0]));
        ellipsoid_stages_sample(s, 0, &g->start[cell]);
    }
    if (g->unsteady)
    {
        add_time_derivatives(g, 0, h);
    }
    ellipsoid_group_solve(g, 0);
}

/* The right-hand side of a stage, in its k: the slopes and, where there is mass,
   sum c_ij/h K_j. */
static inline ellipsoid_status evaluate_stage(ellipsoid_group *g, int count,
                                              int stage,
                                              const ellipsoid_plan *plan)
{
    const ellipsoid_status status = ellipsoid_group_evaluate(
        g, ellipsoid_stage_time(plan, set->alpha[stage]), g->next, 0, 0);

    for (int cell = 0; status == ELLIPSOID_OK && cell < count; cell++)
    {
        const ellipsoid_evaluation *at = &g->next[cell];
        ellipsoid_stages *s = &g->stages[cell];
        double *k = s->k[stage];

        ellipsoid_stages_sample(s, stage, at);
        ellipsoid_combine(at->slope, 1 / plan->h, set->c[stage], stage, s->k,
                          k);
        if (!g->inertial)
        {
            ellipsoid_copy(at->derivative.u, k + AT_U);
            ellipsoid_copy(at->derivative.omega, k + AT_OMEGA);
        }
    }
    return status;
}

/* All of the step for `count` cells; inlined for one and for several. */
static inline ellipsoid_status take(ellipsoid_group *g, int count,
                                    const ellipsoid_plan *plan)
{
    take_first_stage(g, count, plan->h);
    for (int i = 1; i < ELLIPSOID_STAGES; i++)
    {
        ellipsoid_status status;

        for (int cell = 0; cell < count; cell++)
        {
            ellipsoid_evaluation *at = &g->next[cell];

            ellipsoid_combine(g->start[cell].y, 1, set->a[i], i,
                              g->stages[cell].k, at->y);
            if (!ellipsoid_is_pose(at->state.x, at->state.q))
            {
                return ELLIPSOID_STEP_UNDERFLOW;
            }
        }
        status = evaluate_stage(g, count, i, plan);
        if (status != ELLIPSOID_OK)
        {
            return status;
        }
        if (g->unsteady)
        {
            add_time_derivatives(g, i, plan->h);
        }
        ellipsoid_group_solve(g, i);
    }
    /* the last stage is the error estimate, and leads to the result */
    for (int cell = 0; cell < count; cell++)
    {
        ellipsoid_stages *s = &g->stages[cell];

        for (int n = 0; n < UNKNOWNS; n++)
        {
            s->error[n] = s->k[ELLIPSOID_STAGES - 1][n];
            s->y[n] = g->next[cell].y[n] + s->error[n];
        }
    }
    return ELLIPSOID_OK;
}

ellipsoid_status ellipsoid_rosenbrock_step(ellipsoid_group *g,
                                           const ellipsoid_plan *plan)
{
    ellipsoid_status status = ELLIPSOID_OK;

    if (!ellipsoid_group_prepare(g, g->start, set->gamma * plan->h))
    {
        return ELLIPSOID_NON_FINITE;
    }
    if (g->unsteady)
    {
        status = set_time_derivatives(g, plan);
    }
    if (status == ELLIPSOID_OK)
    {
        ellipsoid_expand_about(g, g->start);
        status = g->count == 1 ? take(g, 1, plan) : take(g, g->count, plan);
        ellipsoid_expand_about(g, NULL);
    }
    return status;
}

void ellipsoid_rosenbrock_dense(const ellipsoid_group *g, int cell,
                                double dense[2][UNKNOWNS])
{
    for (int i = 0; i < 2; i++)
    {
        for (int n = 0; n < UNKNOWNS; n++)
        {
            dense[i][n] = ellipsoid_weighted_sum(
                g->stages[cell].k, set->dense[i], ELLIPSOID_STAGES - 1, n);
        }
    }
}
