/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    stageSystem.c - the linear systems of a Rosenbrock step.

    In a file of its own so that it is compiled once: inlined into the stages it
    makes them slower, as they outgrow the processor's cache for instructions.
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

/* By cofactors; 0 if it is singular. */
static inline int invert3(double m[3][3], double inverse[3][3])
{
    double c[3][3], determinant, per;

    ellipsoid_cross(m[1], m[2], c[0]);
    ellipsoid_cross(m[2], m[0], c[1]);
    ellipsoid_cross(m[0], m[1], c[2]);
    determinant = ellipsoid_dot(m[0], c[0]);
    per = 1 / determinant;
    for (int n = 0; n < 3; n++)
    {
        ellipsoid_set(inverse[n], per * c[0][n], per * c[1][n], per * c[2][n]);
    }
    return isnormal(determinant);
}

/* left right, times sign */
static inline void multiply3(double sign, double left[3][3], double right[3][3],
                             double result[3][3])
{
    for (int n = 0; n < 3; n++)
    {
        ellipsoid_combination(right, sign * left[n][0], sign * left[n][1],
                              sign * left[n][2], result[n]);
    }
}

/*
    In place, by blocks of 3x3: with S the last of the four, a, b, c, and
    M = a - b S^-1 c the inverse is
        (M^-1, -M^-1 b S^-1; -S^-1 c M^-1, S^-1 + S^-1 c M^-1 b S^-1).
    Where a stiff contact couples u and omega, M loses digits, a few of sixteen,
    to the difference (test_rosenbrock.c). 0 if S or M is singular.
*/
static inline int invert(double m[6][6])
{
    double a[3][3], b[3][3], c[3][3], last[3][3];
    double s[3][3], bs[3][3], sc[3][3], bsc[3][3], first[3][3];
    double above[3][3], below[3][3], rest[3][3];
    int regular;

    for (int i = 0; i < 3; i++)
    {
        ellipsoid_copy(m[i], a[i]);
        ellipsoid_copy(m[i] + 3, b[i]);
        ellipsoid_copy(m[i + 3], c[i]);
        ellipsoid_copy(m[i + 3] + 3, last[i]);
    }
    regular = invert3(last, s);
    multiply3(1, b, s, bs);
    multiply3(1, s, c, sc);
    multiply3(1, bs, c, bsc);
    for (int i = 0; i < 3; i++)
    {
        ellipsoid_difference(a[i], bsc[i], a[i]);
    }
    regular = regular && invert3(a, first);
    multiply3(-1, first, bs, above);
    multiply3(-1, sc, first, below);
    multiply3(-1, sc, above, rest);
    for (int i = 0; i < 3; i++)
    {
        ellipsoid_add(s[i], rest[i]);
        ellipsoid_copy(first[i], m[i]);
        ellipsoid_copy(above[i], m[i] + 3);
        ellipsoid_copy(below[i], m[i + 3]);
        ellipsoid_copy(s[i], m[i + 3] + 3);
    }
    return regular;
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
    One row of the 6x6 matrix, as a column of the transposed one.
*/
static inline void eliminate_row(elimination *e, int row, const double of_u[3],
                                 const double of_x[3], const double of_w[3],
                                 const double of_q[4])
{
    const double *q = e->state->q;

    turn(e, -1, of_q, e->q[row]);
    for (int n = 0; n < 3; n++)
    {
        e->x[row][n] = e->per_g * of_x[n];
        e->inverse[n][row] = -(of_u[n] + e->x[row][n]);
    }
    e->inverse[3][row] = coupling(e->q[row], q, 0, 1, 2) - of_w[0];
    e->inverse[4][row] = coupling(e->q[row], q, 1, 2, 0) - of_w[1];
    e->inverse[5][row] = coupling(e->q[row], q, 2, 0, 1) - of_w[2];
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

static void fill_quaternion_part(const elimination *e,
                                 ellipsoid_stage_system *s)
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

int ellipsoid_stage_system_prepare(ellipsoid_stage_system *s,
                                   const ellipsoid_problem *problem,
                                   const ellipsoid_point *start, double h)
{
    static const double none[3] = {0, 0, 0};
    const ellipsoid_blocks *b = &start->blocks;
    const double *w = start->state.omega;
    elimination e;

    e.state = &start->state;
    e.per_g = ellipsoid_rosenbrock_set.gamma * h;
    e.g = 1 / e.per_g;
    e.g_rates = problem->inertial ? e.g : 0;
    e.per_square = 1 / (e.g * e.g + 0.25 * ellipsoid_dot(w, w));

    for (int i = 0; i < 3; i++)
    {
        eliminate_row(&e, i, b->uu[i], b->ux[i], none, b->uq[i]);
        eliminate_row(&e, i + 3, none, b->wx[i], b->ww[i], b->wq[i]);
    }
    if (!invert(e.inverse))
    {
        return 0;
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

void ellipsoid_stage_system_solve(const ellipsoid_stage_system *s,
                                  const double r[SIZE], double k[SIZE])
{
    double a[6], q[4];

    for (int n = 0; n < 6; n++)
    {
        const double(*t)[6] = s->to_rates;

        a[n] = ((t[0][n] * r[0] + t[1][n] * r[1])
                + (t[2][n] * r[2] + t[3][n] * r[3]))
             + ((t[4][n] * r[4] + t[5][n] * r[5])
                + (t[6][n] * r[6] + t[7][n] * r[7]))
             + ((t[8][n] * r[8] + t[9][n] * r[9])
                + (t[10][n] * r[10] + t[11][n] * r[11]))
             + t[12][n] * r[12];
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
