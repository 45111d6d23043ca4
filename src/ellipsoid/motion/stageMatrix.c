/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    stageMatrix.c - the linear systems of a Rosenbrock step.

    (g M - J) k = r with g = 1/(gamma h), M = I but for inertialess motion.
    As dx/dt = u, k_x = (r_x + k_u)/g. As Q^2 = -|omega|^2 I,
        (g I - Q/2)^-1 = (g I + Q/2)/(g^2 + |omega|^2/4)
    gives k_q from k_omega. A dense 6x6 system in (k_u, k_omega) is left. The
    solution is wanted four or six times, hence explicit matrices instead of
    substitutions, in which each number waits for the one before.

    In a file of its own so that it is compiled once: inlined into the stages it
    makes them slower, as they outgrow the processor's cache for instructions.
*/
#include "motion/motion.h"

#include <math.h>
#include <string.h>

/* What is needed on the way there. */
typedef struct elimination
{
    double omega[3], g;
    double per_square; /* 1/(g^2 + |omega|^2/4) */
} elimination;

static inline elimination of_step(const ellipsoid_state *state, double per_g)
{
    const double g = 1 / per_g, *omega = state->omega;
    const double square = g * g + 0.25 * ellipsoid_dot(omega, omega);

    return (elimination){{omega[0], omega[1], omega[2]}, g, 1 / square};
}

/* (g I + sign Q/2) v / (g^2 + |omega|^2/4): the inverse of g I - sign Q/2.
   Q is antisymmetric, so a row is multiplied by it with the sign reversed. */
static inline void turn(const elimination *e, double sign, const double v[4],
                        double result[4])
{
    double turned[4];

    ellipsoid_spin(e->omega, v, turned);
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

/* Columns of the blocks, those of u above those of omega. */
static inline void set_columns(const double of_u[], const double of_omega[],
                               int count, double column[][6])
{
    for (int n = 0; n < count; n++)
    {
        for (int i = 0; i < 3; i++)
        {
            column[n][i] = of_u[count * i + n];
            column[n][i + 3] = of_omega[count * i + n];
        }
    }
}

/* Of each row: blocks / g, blocks (g I - Q/2)^-1, and -J; all transposed, so that
   several rows are one operation. */
void ellipsoid_stage_matrix_reduce(const ellipsoid_jacobian_blocks *b,
                                   const ellipsoid_state *column, double per_g,
                                   ellipsoid_reduced *restrict to)
{
    const elimination e = of_step(column, per_g);
    const double q[4] = {column->q[0], column->q[1], column->q[2],
                         column->q[3]};
    double u[3][6], x[3][6], w[3][6], of_q[4][6];

    set_columns((const double *)b->uu, (const double *)b->wu, 3, u);
    set_columns((const double *)b->ux, (const double *)b->wx, 3, x);
    set_columns((const double *)b->uw, (const double *)b->ww, 3, w);
    set_columns((const double *)b->uq, (const double *)b->wq, 4, of_q);
    for (int row = 0; row < 6; row++)
    {
        const double of_row[4] = {of_q[0][row], of_q[1][row], of_q[2][row],
                                  of_q[3][row]};
        double turned[4];

        turn(&e, -1, of_row, turned);
        for (int n = 0; n < 3; n++)
        {
            x[n][row] *= per_g;
            to->rates[n][row] = -(u[n][row] + x[n][row]);
            to->x[n][row] = x[n][row];
        }
        for (int n = 0; n < 4; n++)
        {
            to->q[n][row] = turned[n];
        }
        to->rates[3][row] = coupling(turned, q, 0, 1, 2) - w[0][row];
        to->rates[4][row] = coupling(turned, q, 1, 2, 0) - w[1][row];
        to->rates[5][row] = coupling(turned, q, 2, 0, 1) - w[2][row];
    }
}

/* result = inverse column; the inverse is transposed. */
static inline void apply_inverse(double inverse[6][6], const double column[6],
                                 double result[6])
{
    for (int n = 0; n < 6; n++)
    {
        double sum = inverse[0][n] * column[0];

        for (int i = 1; i < 6; i++)
        {
            sum += inverse[i][n] * column[i];
        }
        result[n] = sum;
    }
}

void ellipsoid_stage_matrix_kinematics(ellipsoid_stage_matrix *s,
                                       const ellipsoid_state *state,
                                       double per_g)
{
    const elimination e = of_step(state, per_g);
    const double own = e.per_square * e.g;
    const double a = e.per_square * (0.5 * state->omega[0]);
    const double b = e.per_square * (0.5 * state->omega[1]);
    const double c = e.per_square * (0.5 * state->omega[2]);
    const double q[4] = {0.5 * state->q[0], 0.5 * state->q[1],
                         0.5 * state->q[2], 0.5 * state->q[3]};
    const double by_omega[3][4] = {{q[3], q[2], -q[1], -q[0]},
                                   {-q[2], q[3], q[0], -q[1]},
                                   {q[1], -q[0], q[3], -q[2]}};
    const double from_q[4][4] = {
        {own, -c, b, -a}, {c, own, -a, -b}, {-b, a, own, -c}, {a, b, c, own}};

    s->per_g = per_g;
    memcpy(s->q_from_q, from_q, sizeof(from_q));
    turn(&e, 1, by_omega[0], s->q_from_w[0]);
    turn(&e, 1, by_omega[1], s->q_from_w[1]);
    turn(&e, 1, by_omega[2], s->q_from_w[2]);
}

int ellipsoid_stage_matrix_prepare(ellipsoid_stage_matrix *s,
                                   const ellipsoid_evaluation *start,
                                   int inertial, double per_g)
{
    ellipsoid_reduced reduced;

    ellipsoid_stage_matrix_reduce(&start->blocks, &start->state, per_g,
                                  &reduced);
    for (int n = 0; inertial && n < 6; n++)
    {
        reduced.rates[n][n] += 1 / per_g;
    }
    if (!ellipsoid_invert6(reduced.rates))
    {
        return 0;
    }
    memcpy(s->to_rates[AT_U], reduced.rates[0], sizeof(double[3][6]));
    memcpy(s->to_rates[AT_OMEGA], reduced.rates[3], sizeof(double[3][6]));
    for (int n = 0; n < 3; n++)
    {
        apply_inverse(reduced.rates, reduced.x[n], s->to_rates[AT_X + n]);
    }
    for (int n = 0; n < 4; n++)
    {
        apply_inverse(reduced.rates, reduced.q[n], s->to_rates[AT_Q + n]);
    }
    ellipsoid_stage_matrix_kinematics(s, &start->state, per_g);
    return 1;
}

static inline void finish(const ellipsoid_stage_matrix *s, const double a[6],
                          double k[restrict UNKNOWNS])
{
    const double r[4] = {k[AT_Q], k[AT_Q + 1], k[AT_Q + 2], k[AT_Q + 3]};

    for (int n = 0; n < 4; n++)
    {
        k[AT_Q + n] = (s->q_from_q[0][n] * r[0] + s->q_from_q[1][n] * r[1])
                    + (s->q_from_q[2][n] * r[2] + s->q_from_q[3][n] * r[3])
                    + (s->q_from_w[0][n] * a[3] + s->q_from_w[1][n] * a[4]
                       + s->q_from_w[2][n] * a[5]);
    }
    for (int i = 0; i < 3; i++)
    {
        k[AT_U + i] = a[i];
        k[AT_X + i] = s->per_g * (k[AT_X + i] + a[i]);
        k[AT_OMEGA + i] = a[i + 3];
    }
}

void ellipsoid_stage_matrix_solve(const ellipsoid_stage_matrix *s,
                                  double k[restrict UNKNOWNS])
{
    double a[6];

    for (int n = 0; n < 6; n++)
    {
        const double(*t)[6] = s->to_rates;

        a[n] = ((t[0][n] * k[0] + t[1][n] * k[1])
                + (t[2][n] * k[2] + t[3][n] * k[3]))
             + ((t[4][n] * k[4] + t[5][n] * k[5])
                + (t[6][n] * k[6] + t[7][n] * k[7]))
             + ((t[8][n] * k[8] + t[9][n] * k[9])
                + (t[10][n] * k[10] + t[11][n] * k[11]))
             + t[12][n] * k[12];
    }
    finish(s, a, k);
}

void ellipsoid_stage_matrix_finish(const ellipsoid_stage_matrix *s,
                                   const double rates[6],
                                   double k[restrict UNKNOWNS])
{
    finish(s, rates, k);
}
