/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    rosenbrock.c - one step of a Rosenbrock method.

    Hairer & Wanner, Solving Ordinary Differential Equations II (1996), section
    IV.7. Without inertia the equations for u and omega become algebraic, with
    index 1, and the method is that of section VI.4: the same with a mass matrix
    that has zeros there.
*/
#include "ellipsoidInternal.h"

#include <math.h>
#include <string.h>

enum
{
    SIZE = ELLIPSOID_STATE_SIZE,
    U = ELLIPSOID_U,
    X = ELLIPSOID_X,
    W = ELLIPSOID_OMEGA,
    Q = ELLIPSOID_Q
};

ellipsoid_status ellipsoid_problem_evaluate(const ellipsoid_problem *problem,
                                            ellipsoid_state *state,
                                            int balanced,
                                            ellipsoid_state *derivative,
                                            ellipsoid_contact *contact,
                                            ellipsoid_blocks *blocks)
{
    problem->statistics->rhs++;
    problem->statistics->jacobians += blocks != NULL;
    return ellipsoid_evaluate(problem->model, problem->surroundings,
                              problem->noise, state, balanced, problem->cache,
                              derivative, contact, blocks);
}

/* --------------------------------------------------------------- a step */

/* sum_j<count weight[j] k_j; inlined with a constant count. */
static inline void weighted_sum(double k[][SIZE], const double *weight,
                                int count, double sum[SIZE])
{
    for (int n = 0; n < SIZE; n++)
    {
        double s = weight[0] * k[0][n];

        for (int j = 1; j < count; j++)
        {
            s += weight[j] * k[j][n];
        }
        sum[n] = s;
    }
}

static inline void stage_sums(double k[][SIZE], int stage, double a[SIZE],
                              double c[SIZE])
{
    const double *wa = ellipsoid_rosenbrock_set.a[stage];
    const double *wc = ellipsoid_rosenbrock_set.c[stage];

    switch (stage)
    {
        case 1:
            weighted_sum(k, wa, 1, a);
            weighted_sum(k, wc, 1, c);
            break;
        case 2:
            weighted_sum(k, wa, 2, a);
            weighted_sum(k, wc, 2, c);
            break;
        case 3:
            weighted_sum(k, wa, 3, a);
            weighted_sum(k, wc, 3, c);
            break;
        case 4:
            weighted_sum(k, wa, 4, a);
            weighted_sum(k, wc, 4, c);
            break;
        default:
            weighted_sum(k, wa, 5, a);
            weighted_sum(k, wc, 5, c);
    }
}

ellipsoid_status ellipsoid_rosenbrock_step(const ellipsoid_problem *problem,
                                           const ellipsoid_point *start,
                                           double h, ellipsoid_stages *stages)
{
    ellipsoid_stage_system system;
    double y0[SIZE], r[SIZE], mass[SIZE]; /* the latter over h */

    stages->order = 4;
    stages->sampled = ELLIPSOID_ROSENBROCK_STAGES;
    stages->in_time = ellipsoid_rosenbrock_set.in_time;
    if (!ellipsoid_stage_system_prepare(&system, problem, start, h))
    {
        return ELLIPSOID_NON_FINITE;
    }
    for (int n = 0; n < SIZE; n++)
    {
        const int is_rate = n < X || (n >= W && n < Q);

        mass[n] = is_rate && !problem->inertial ? 0 : 1 / h;
    }
    memcpy(y0, &start->state, sizeof(y0));
    memcpy(r, &start->derivative, sizeof(r));
    ellipsoid_stage_system_solve(&system, r, stages->k[0]);
    if (problem->walls)
    {
        ellipsoid_stages_sample(stages, 0, &start->state, start->contact.gap);
    }

    for (int i = 1; i < ELLIPSOID_ROSENBROCK_STAGES; i++)
    {
        union
        {
            ellipsoid_state state;
            double y[SIZE];
        } at, rate;
        ellipsoid_contact contact;
        ellipsoid_status status;
        double change[SIZE];

        stage_sums(stages->k, i, at.y, change);
        for (int n = 0; n < SIZE; n++)
        {
            at.y[n] += y0[n];
        }
        if (!ellipsoid_is_pose(at.y + X, at.y + Q))
        {
            return ELLIPSOID_STEP_UNDERFLOW;
        }
        status = ellipsoid_problem_evaluate(problem, &at.state, 0, &rate.state,
                                            &contact, NULL);
        if (status != ELLIPSOID_OK)
        {
            return status;
        }
        if (problem->walls)
        {
            ellipsoid_stages_sample(stages, i, &at.state, contact.gap);
        }
        for (int n = 0; n < SIZE; n++)
        {
            rate.y[n] += mass[n] * change[n];
        }
        ellipsoid_stage_system_solve(&system, rate.y, stages->k[i]);
        if (i == ELLIPSOID_ROSENBROCK_STAGES - 1)
        {
            for (int n = 0; n < SIZE; n++)
            {
                stages->y[n] = at.y[n] + stages->k[i][n];
                stages->error[n] = stages->k[i][n];
            }
        }
    }
    return ELLIPSOID_OK;
}

void ellipsoid_rosenbrock_dense(ellipsoid_stages *stages,
                                double dense[3][ELLIPSOID_STATE_SIZE])
{
    for (int i = 0; i < 2; i++)
    {
        weighted_sum(stages->k, ellipsoid_rosenbrock_set.dense[i],
                     ELLIPSOID_ROSENBROCK_STAGES - 1, dense[i]);
    }
    memset(dense[2], 0, sizeof(dense[2]));
}
