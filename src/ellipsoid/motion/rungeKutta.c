/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    rungeKutta.c - one explicit step of inertialess motion, and its dense output.

    Kutta's 3/8 rule (1901): order 4, with the weights (1/12, 1/2, 1/4, 0, 1/6)
    of order 3, the last for the slope at the end, which is the first stage of the
    next step, and Hermite's cubic. Its stages lie evenly: where the flow's
    gradient jumps in the step, the error estimate is not below the error.
*/
#include "motion/motion.h"

enum
{
    STAGES = 5, /* the last is the result */
    LAST = STAGES - 1
};

static const double weight[STAGES][LAST] = {
    {0},
    {1.0 / 3},
    {-1.0 / 3, 1},
    {1, -1, 1},
    {1.0 / 8, 3.0 / 8, 3.0 / 8, 1.0 / 8}};
static const double error_weight[STAGES] = {1.0 / 24, -1.0 / 8, 1.0 / 8,
                                            1.0 / 8, -1.0 / 6};
static const double part_of_step[STAGES] = {0, 1.0 / 3, 2.0 / 3, 1, 1};
static const int in_time[STAGES] = {0, 1, 2, 3, 4};

/* A stage's slopes; for dense output omega itself is in that of its derivative. */
static inline void keep_slopes(const ellipsoid_evaluation *at,
                               double k[UNKNOWNS])
{
    memcpy(k, at->slope, sizeof(at->slope));
    ellipsoid_copy(at->state.omega, k + AT_OMEGA);
}

/* Sets the pose of a stage; the last one is the result. */
static inline int set_stage(const ellipsoid_evaluation *start, int stage,
                            double h, int fixed, double k[][UNKNOWNS],
                            ellipsoid_evaluation *at)
{
    ellipsoid_combine(start->y, h, weight[stage], stage, k, at->y);
    ellipsoid_copy(start->state.omega, at->state.omega);
    if (!ellipsoid_is_pose(at->state.x, at->state.q))
    {
        return 0;
    }
    if (stage == LAST && !fixed)
    {
        ellipsoid_normalise(at->state.q);
    }
    return 1;
}

/* All of the step for `count` cells; inlined for one and for several. */
static inline ellipsoid_status take(ellipsoid_group *g, int count,
                                    const ellipsoid_plan *plan, int *touched)
{
    const double h = plan->h;

    *touched = 0;
    for (int cell = 0; cell < count; cell++)
    {
        const ellipsoid_evaluation *start = &g->start[cell];
        ellipsoid_stages *s = &g->stages[cell];

        s->sampled = STAGES;
        s->in_time = in_time;
        keep_slopes(start, s->k[0]);
        ellipsoid_stages_sample(s, 0, start);
    }

    for (int i = 1; i < STAGES; i++)
    {
        ellipsoid_status status;

        for (int cell = 0; cell < count; cell++)
        {
            if (!set_stage(&g->start[cell], i, h, g->cell[cell].fixed,
                           g->stages[cell].k, &g->next[cell]))
            {
                return ELLIPSOID_STEP_UNDERFLOW;
            }
        }
        status = ellipsoid_group_evaluate(
            g, ellipsoid_stage_time(plan, part_of_step[i]), g->next, 1, 0);
        if (status != ELLIPSOID_OK)
        {
            return status;
        }
        for (int cell = 0; cell < count; cell++)
        {
            const ellipsoid_evaluation *at = &g->next[cell];
            ellipsoid_stages *s = &g->stages[cell];

            *touched = *touched || ellipsoid_in_contact(&at->contact);
            ellipsoid_stages_sample(s, i, at);
            keep_slopes(at, s->k[i]);
        }
        if (*touched)
        {
            return ELLIPSOID_OK;
        }
    }
    for (int cell = 0; cell < count; cell++)
    {
        ellipsoid_stages *s = &g->stages[cell];

        for (int n = AT_X; n < UNKNOWNS; n++)
        {
            s->error[n] =
                ellipsoid_weighted_sum(s->k, error_weight, STAGES, n) * h;
        }
        memcpy(s->y, g->next[cell].y, sizeof(s->y));
    }
    return ELLIPSOID_OK;
}

ellipsoid_status ellipsoid_explicit_step(ellipsoid_group *g,
                                         const ellipsoid_plan *plan,
                                         int *touched)
{
    return g->count == 1 ? take(g, 1, plan, touched)
                         : take(g, g->count, plan, touched);
}

/* u and omega are slopes: theirs is the derivative of Hermite's cubic of x, and of
   that of an angle with slopes omega. */
void ellipsoid_explicit_dense(const ellipsoid_group *g, int cell,
                              double dense[2][UNKNOWNS])
{
    const double *before = g->start[cell].y, *after = g->next[cell].y;
    const double h = g->step[cell].end - g->step[cell].start;
    double(*k)[UNKNOWNS] = g->stages[cell].k;

    for (int n = AT_X; n < UNKNOWNS; n++)
    {
        const double change_n =
            ellipsoid_is_rate(n)
                ? h * ellipsoid_weighted_sum(k, weight[LAST], LAST, n)
                : after[n] - before[n];

        dense[0][n] = h * k[0][n] - change_n;
        dense[1][n] = change_n - h * k[LAST][n] - dense[0][n];
    }
    for (int n = 0; n < 3; n++)
    {
        dense[0][AT_U + n] = 3 * dense[1][AT_X + n] / h;
        dense[0][AT_OMEGA + n] = 3 * dense[1][AT_OMEGA + n] / h;
        dense[1][AT_U + n] = dense[1][AT_OMEGA + n] = 0;
    }
}
