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

/* ------------------------------------------------------- linear systems */

/*
    (g M - J) k = r with g = 1/(gamma h), M = I but for inertialess motion. As
   dx/dt = u, k_x = (r_x + k_u)/g; as Q^2 = -|omega|^2 I, (g I - Q/2)^-1 = (g I
   + Q/2)/(g^2 + |omega|^2/4) gives k_q from k_omega. A dense 6x6 system in
   (k_u, k_omega) is left. The solution is wanted six times, hence explicit
   matrices instead of substitutions, in which each number waits for the one
   before.
*/
typedef struct stage_system
{
    double per_g;
    double to_rates[SIZE][6]; /* transposed: (k_u, k_omega) from r */
    double q_from_q[4][4];    /* transposed: k_q from r_q */
    double q_from_w[3][4];    /* transposed: k_q from k_omega */
} stage_system;

/* What is needed on the way there. */
typedef struct elimination
{
    const ellipsoid_state *state;
    double g, per_g;
    double g_rates;       /* g, or 0 without inertia */
    double per_square;    /* 1/(g^2 + |omega|^2/4) */
    double x[6][3];       /* blocks / g, rows u then omega */
    double q[6][4];       /* blocks (g I - Q/2)^-1 */
    double inverse[6][6]; /* transposed */
} elimination;

static inline void swap(double *a, double *b)
{
    const double kept = *a;

    *a = *b;
    *b = kept;
}

/* In place, by Gauss and Jordan with row exchanges; 0 if it is singular. */
static int invert(double m[6][6])
{
    int exchanged[6];

    for (int c = 0; c < 6; c++)
    {
        int p = c;

        for (int i = c + 1; i < 6; i++)
        {
            p = fabs(m[i][c]) > fabs(m[p][c]) ? i : p;
        }
        exchanged[c] = p;
        if (p != c)
        {
            for (int n = 0; n < 6; n++)
            {
                swap(&m[p][n], &m[c][n]);
            }
        }
        if (!(fabs(m[c][c]) > 0))
        {
            return 0;
        }

        const double per_pivot = 1 / m[c][c];

        m[c][c] = 1;
        for (int n = 0; n < 6; n++)
        {
            m[c][n] *= per_pivot;
        }
        for (int i = 0; i < 6; i++)
        {
            const double f = m[i][c];

            if (i == c)
            {
                continue;
            }
            m[i][c] = 0;
            for (int n = 0; n < 6; n++)
            {
                m[i][n] -= f * m[c][n];
            }
        }
    }
    for (int c = 5; c >= 0; c--)
    {
        for (int n = 0; exchanged[c] != c && n < 6; n++)
        {
            swap(&m[n][c], &m[n][exchanged[c]]);
        }
    }
    return 1;
}

/* (g I + sign Q/2) v / (g^2 + |omega|^2/4): the inverse of g I - sign Q/2.
   Q is antisymmetric, so a row is multiplied by it with the sign reversed. */
static inline void turn(const elimination *e, double sign, const double v[4],
                        double result[4])
{
    double turned[4];

    ellipsoid_spin(e->state->omega, v, turned);
    for (int n = 0; n < 4; n++)
    {
        result[n] = e->per_square * (e->g * v[n] + sign * 0.5 * turned[n]);
    }
}

/* -row d(Q(omega) q / 2)/domega_i, i, j, k cyclic */
static inline double coupling(const double row[4], const double q[4], int i,
                              int j, int k)
{
    return -0.5
         * (row[i] * q[3] + row[j] * q[k] - row[k] * q[j] - row[3] * q[i]);
}

/*
    One row of the 6x6 matrix, as a column of the transposed one. In it omega
    is scaled by a length, for the search of pivots.
*/
static inline void eliminate_row(elimination *e, int row, const double of_u[3],
                                 const double of_x[3], const double of_w[3],
                                 const double of_q[4], double scale_u,
                                 double scale_w)
{
    const double *q = e->state->q;

    turn(e, -1, of_q, e->q[row]);
    for (int n = 0; n < 3; n++)
    {
        e->x[row][n] = e->per_g * of_x[n];
        e->inverse[n][row] = -scale_u * (of_u[n] + e->x[row][n]);
    }
    e->inverse[3][row] = scale_w * (coupling(e->q[row], q, 0, 1, 2) - of_w[0]);
    e->inverse[4][row] = scale_w * (coupling(e->q[row], q, 1, 2, 0) - of_w[1]);
    e->inverse[5][row] = scale_w * (coupling(e->q[row], q, 2, 0, 1) - of_w[2]);
    e->inverse[row][row] += e->g_rates;
}

/* result = inverse column, column given as every stride-th number. */
static inline void apply_inverse(const elimination *e, const double *column,
                                 int stride, double result[6])
{
    for (int n = 0; n < 6; n++)
    {
        double sum = e->inverse[0][n] * column[0];

        for (int i = 1; i < 6; i++)
        {
            sum += e->inverse[i][n] * column[i * stride];
        }
        result[n] = sum;
    }
}

static void fill_quaternion_part(const elimination *e, stage_system *s)
{
    const double *q = e->state->q;
    const double spin[3][4] = {
        {0.5 * q[3], 0.5 * q[2], -0.5 * q[1], -0.5 * q[0]},
        {-0.5 * q[2], 0.5 * q[3], 0.5 * q[0], -0.5 * q[1]},
        {0.5 * q[1], -0.5 * q[0], 0.5 * q[3], -0.5 * q[2]}};
    const double *w = e->state->omega;
    const double c = e->per_square, d = c * e->g;
    const double a0 = 0.5 * c * w[0], a1 = 0.5 * c * w[1], a2 = 0.5 * c * w[2];
    const double table[4][4] = {{d, -a2, a1, -a0},
                                {a2, d, -a0, -a1},
                                {-a1, a0, d, -a2},
                                {a0, a1, a2, d}};

    memcpy(s->q_from_q, table, sizeof(table));
    for (int i = 0; i < 3; i++)
    {
        turn(e, 1, spin[i], s->q_from_w[i]);
    }
}

/* Returns 0 if the step is so long that the matrix is singular. */
static int prepare(stage_system *s, const ellipsoid_problem *problem,
                   const ellipsoid_point *start, double h)
{
    static const double none[3] = {0, 0, 0};
    const ellipsoid_blocks *b = &start->blocks;
    const double *w = start->state.omega;
    const double length = problem->length;
    elimination e;

    e.state = &start->state;
    e.per_g = ellipsoid_rodas4.gamma * h;
    e.g = 1 / e.per_g;
    e.g_rates = problem->inertial ? e.g : 0;
    e.per_square = 1 / (e.g * e.g + 0.25 * ellipsoid_dot(w, w));

    for (int i = 0; i < 3; i++)
    {
        eliminate_row(&e, i, b->uu[i], b->ux[i], none, b->uq[i], 1, 1 / length);
        eliminate_row(&e, i + 3, none, b->wx[i], b->ww[i], b->wq[i], length, 1);
    }
    if (!invert(e.inverse))
    {
        return 0;
    }
    for (int i = 0; i < 3; i++)
    {
        for (int n = 3; n < 6; n++)
        {
            e.inverse[i][n] /= length;
            e.inverse[n][i] *= length;
        }
    }

    s->per_g = e.per_g;
    memcpy(s->to_rates[U], e.inverse[0], 3 * sizeof(e.inverse[0]));
    memcpy(s->to_rates[W], e.inverse[3], 3 * sizeof(e.inverse[0]));
    for (int n = 0; n < 3; n++)
    {
        apply_inverse(&e, &e.x[0][n], 3, s->to_rates[X + n]);
    }
    for (int n = 0; n < 4; n++)
    {
        apply_inverse(&e, &e.q[0][n], 4, s->to_rates[Q + n]);
    }
    fill_quaternion_part(&e, s);
    return 1;
}

static inline void solve(const stage_system *s, const double r[SIZE],
                         double k[SIZE])
{
    double a[6], q[4];

    for (int n = 0; n < 6; n++)
    {
        a[n] = s->to_rates[0][n] * r[0];
    }
    for (int i = 1; i < SIZE; i++)
    {
        for (int n = 0; n < 6; n++)
        {
            a[n] += s->to_rates[i][n] * r[i];
        }
    }
    for (int n = 0; n < 4; n++)
    {
        q[n] = (s->q_from_q[0][n] * r[Q] + s->q_from_q[1][n] * r[Q + 1])
             + (s->q_from_q[2][n] * r[Q + 2] + s->q_from_q[3][n] * r[Q + 3])
             + (s->q_from_w[0][n] * a[3] + s->q_from_w[1][n] * a[4]
                + s->q_from_w[2][n] * a[5]);
    }
    for (int i = 0; i < 3; i++)
    {
        k[U + i] = a[i];
        k[X + i] = s->per_g * (r[X + i] + a[i]);
        k[W + i] = a[i + 3];
    }
    memcpy(k + Q, q, sizeof(q));
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
    const double *wa = ellipsoid_rodas4.a[stage];
    const double *wc = ellipsoid_rodas4.c[stage];

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

/* The stages in the order of their times 0, 0.21, 0.386, 0.63, 1, 1. */
static const int in_time[ELLIPSOID_ROSENBROCK_STAGES] = {0, 2, 1, 3, 4, 5};

ellipsoid_status ellipsoid_rosenbrock_step(const ellipsoid_problem *problem,
                                           const ellipsoid_point *start,
                                           double h, ellipsoid_stages *stages)
{
    stage_system system;
    double y0[SIZE], r[SIZE], mass[SIZE]; /* the latter over h */

    stages->order = 4;
    stages->sampled = ELLIPSOID_ROSENBROCK_STAGES;
    stages->in_time = in_time;
    if (!prepare(&system, problem, start, h))
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
    solve(&system, r, stages->k[0]);
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
        solve(&system, rate.y, stages->k[i]);
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
        weighted_sum(stages->k, ellipsoid_rodas4.dense[i],
                     ELLIPSOID_ROSENBROCK_STAGES - 1, dense[i]);
    }
    memset(dense[2], 0, sizeof(dense[2]));
}
