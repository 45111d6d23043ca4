/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    rungeKutta.c - one explicit step of inertialess motion, and dense output.

    Tsitouras, Comput. Math. Appl. 62, 770 (2011): order 5(4), the last stage
    is the first of the next step, with a continuous extension of order 4. Its
    error is half that of Dormand and Prince's method for the same work.
*/
#include "ellipsoidInternal.h"

enum
{
    SIZE = ELLIPSOID_STATE_SIZE,
    STAGES = 7,
    U = ELLIPSOID_U,
    X = ELLIPSOID_X,
    W = ELLIPSOID_OMEGA,
    Q = ELLIPSOID_Q
};

static const double table[STAGES][STAGES - 1] = {
    {0},
    {0.161},
    {-0.008480655492356989, 0.335480655492357},
    {2.8971530571054935, -6.359448489975075, 4.3622954328695815},
    {5.325864828439257, -11.748883564062828, 7.4955393428898365,
     -0.09249506636175525},
    {5.86145544294642, -12.92096931784711, 8.159367898576159,
     -0.071584973281401, -0.028269050394068383},
    {0.09646076681806523, 0.01, 0.4798896504144996, 1.379008574103742,
     -3.290069515436081, 2.324710524099774}};

/* of the result less that of order 4 */
static const double of_error[STAGES] = {-0.00178001105222577714,
                                        -0.0008164344596567469,
                                        0.007880878010261995,
                                        -0.1447110071732629,
                                        0.5823571654525552,
                                        -0.45808210592918697,
                                        1.0 / 66};

/* of the fourth power of time in the continuous extension */
static const double of_dense[STAGES] = {-1.0530884977290216,
                                        0.1017,
                                        2.490627285651253,
                                        -16.548102889244902,
                                        47.37952196281928,
                                        -34.87065786149661,
                                        2.5};

/* The stages' times 0, 0.161, 0.327, 0.9, 0.98, 1, 1 ascend. */
static const int in_time[STAGES] = {0, 1, 2, 3, 4, 5, 6};

/* sum_j<count weight[j] k_j; inlined with a constant count. */
static inline void weighted_sum(double k[][SIZE], const double *weight,
                                int count, double sum[SIZE])
{
    for (int n = X; n < SIZE; n++)
    {
        sum[n] = weight[0] * k[0][n];
    }
    for (int j = 1; j < count; j++)
    {
        for (int n = X; n < SIZE; n++)
        {
            sum[n] += weight[j] * k[j][n];
        }
    }
}

static void stage_sum(double k[][SIZE], int stage, double sum[SIZE])
{
    switch (stage)
    {
        case 1:
            weighted_sum(k, table[1], 1, sum);
            break;
        case 2:
            weighted_sum(k, table[2], 2, sum);
            break;
        case 3:
            weighted_sum(k, table[3], 3, sum);
            break;
        case 4:
            weighted_sum(k, table[4], 4, sum);
            break;
        case 5:
            weighted_sum(k, table[5], 5, sum);
            break;
        default:
            weighted_sum(k, table[6], 6, sum);
    }
}

/* A stage's slopes: of x, and of q; and, for dense output, omega itself in
   the place of its derivative. */
static inline void keep_slopes(const ellipsoid_state *state,
                               const ellipsoid_state *derivative,
                               double k[SIZE])
{
    ellipsoid_copy(derivative->x, k + X);
    ellipsoid_copy(state->omega, k + W);
    memcpy(k + Q, derivative->q, sizeof(derivative->q));
}

ellipsoid_status ellipsoid_explicit_step(const ellipsoid_problem *problem,
                                         const ellipsoid_point *start, double h,
                                         ellipsoid_stages *stages,
                                         ellipsoid_point *next, int *touched)
{
    union
    {
        ellipsoid_state state;
        double y[SIZE];
    } from, at = {{{0}, {0}, {0}, {0}}};

    from.state = start->state;
    stages->order = 5;
    stages->sampled = STAGES;
    stages->in_time = in_time;
    *touched = 0;
    keep_slopes(&start->state, &start->derivative, stages->k[0]);
    if (problem->walls)
    {
        ellipsoid_stages_sample(stages, 0, &start->state, start->contact.gap);
    }

    for (int i = 1; i < STAGES; i++)
    {
        const int last = i == STAGES - 1;
        double change[SIZE];
        ellipsoid_status status;

        stage_sum(stages->k, i, change);
        for (int n = 0; n < 3; n++)
        {
            at.y[X + n] = from.y[X + n] + h * change[X + n];
        }
        for (int n = Q; n < SIZE; n++)
        {
            at.y[n] = from.y[n] + h * change[n];
        }
        if (!ellipsoid_is_pose(at.y + X, at.y + Q))
        {
            return ELLIPSOID_STEP_UNDERFLOW;
        }
        if (last)
        {
            ellipsoid_normalise(at.y + Q);
        }
        status = ellipsoid_problem_evaluate(
            problem, &at.state, 1, &next->derivative, &next->contact, NULL);
        if (status != ELLIPSOID_OK)
        {
            return status;
        }
        if (problem->walls)
        {
            if (next->contact.touching_beads > 0)
            {
                *touched = 1;
                return ELLIPSOID_OK;
            }
            ellipsoid_stages_sample(stages, i, &at.state, next->contact.gap);
        }
        keep_slopes(&at.state, &next->derivative, stages->k[i]);
    }
    weighted_sum(stages->k, of_error, STAGES, stages->error);
    for (int n = 0; n < SIZE; n++)
    {
        const int solved = (n >= X && n < W) || n >= Q;

        stages->error[n] = solved ? h * stages->error[n] : 0;
    }
    memcpy(stages->y, at.y, sizeof(stages->y));
    next->state = at.state;
    next->has_blocks = 0;
    return ELLIPSOID_OK;
}

/*
    With D = y1 - y0 the extension is y0 + s D + s (1-s) (d_0 + s d_1
    + s (1-s) d_2), d_0 = h k_1 - D, d_1 = D - h k_7 - d_0,
    d_2 = h sum_j dense_j k_j. u and omega are slopes: theirs is the derivative
    of the extension of x, and of that of an angle with slopes omega.
*/
void ellipsoid_explicit_dense(ellipsoid_stages *stages,
                              const ellipsoid_step *step,
                              double dense[3][ELLIPSOID_STATE_SIZE])
{
    const double h = step->end - step->start;
    double(*k)[SIZE] = stages->k;
    double before[SIZE], after[SIZE], change[SIZE];

    memcpy(before, &step->before, sizeof(before));
    memcpy(after, &step->after, sizeof(after));
    weighted_sum(k, table[STAGES - 1], STAGES - 1, change);
    weighted_sum(k, of_dense, STAGES, dense[2]);
    for (int n = X; n < SIZE; n++)
    {
        const double d = n >= W && n < Q ? h * change[n] : after[n] - before[n];

        dense[0][n] = h * k[0][n] - d;
        dense[1][n] = d - h * k[STAGES - 1][n] - dense[0][n];
        dense[2][n] *= h;
    }
    for (int n = 0; n < 3; n++)
    {
        const int of[2] = {X + n, W + n}, to[2] = {U + n, W + n};

        for (int i = 0; i < 2; i++)
        {
            const double d1 = dense[1][of[i]], d2 = dense[2][of[i]];

            dense[0][to[i]] = (3 * d1 + 2 * d2) / h;
            dense[1][to[i]] = -4 * d2 / h;
            dense[2][to[i]] = 0;
        }
    }
}

/* At the ends the step's own states. */
void ellipsoid_step_state(const ellipsoid_step *step, double t,
                          ellipsoid_state *state)
{
    const double s = (t - step->start) / (step->end - step->start);
    const double r = 1 - s;
    double before[SIZE], after[SIZE], y[SIZE];

    if (t <= step->start || t >= step->end)
    {
        *state = t <= step->start ? step->before : step->after;
        return;
    }
    memcpy(before, &step->before, sizeof(before));
    memcpy(after, &step->after, sizeof(after));
    for (int n = 0; n < SIZE; n++)
    {
        const double *d[3] = {&step->dense[0][n], &step->dense[1][n],
                              &step->dense[2][n]};
        const double bend = *d[0] + s * (*d[1] + r * *d[2]);

        y[n] = r * before[n] + s * (after[n] + r * bend);
    }
    ellipsoid_normalise(y + Q);
    memcpy(state, y, sizeof(*state));
}
