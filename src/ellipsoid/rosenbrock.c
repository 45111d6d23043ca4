/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    rosenbrock.c - one step of RODAS4.

    Hairer & Wanner, Solving Ordinary Differential Equations II (1996), section
    IV.7 and code RODAS: six stages, order 4(3), L-stable, stiffly accurate.
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

/* Coefficients of RODAS, first set (METH = 1). */
const ellipsoid_rosenbrock_table ellipsoid_rodas4 = {
    .gamma = 0.25,
    .a = {{0},
          {1.544},
          {0.9466785280815826, 0.2557011698983284},
          {3.314825187068521, 2.896124015972201, 0.9986419139977817},
          {1.221224509226641, 6.019134481288629, 12.53708332932087,
           -0.6878860361058950},
          {1.221224509226641, 6.019134481288629, 12.53708332932087,
           -0.6878860361058950, 1}},
    .c = {{0},
          {-5.6688},
          {-2.430093356833875, -0.2063599157091915},
          {-0.1073529058151375, -9.594562251023355, -20.47028614809616},
          {7.496443313967647, -10.24680431464352, -33.99990352819905,
           11.70890893206160},
          {8.083246795921522, -7.981132988064893, -31.52159432874371,
           16.31930543123136, -6.058818238834054}},
    .dense = {{10.12623508344586, -7.487995877610167, -34.80091861555747,
               -7.992771707568823, 1.025137723295662},
              {-0.6762803392801253, 6.087714651680015, 16.43084320892478,
               24.76722511418386, -6.594389125716872}},
};

ellipsoid_status ellipsoid_problem_evaluate(const ellipsoid_problem *problem,
                                            const ellipsoid_state *state,
                                            ellipsoid_state *derivative,
                                            ellipsoid_contact *contact,
                                            ellipsoid_blocks *blocks)
{
    problem->statistics->rhs++;
    problem->statistics->jacobians += blocks != NULL;
    return ellipsoid_evaluate(problem->model, problem->surroundings, state,
                              problem->cache, derivative, contact, blocks);
}

/* ------------------------------------------------------- linear systems */

/*
    (g I - J) k = r with g = 1/(gamma h). As dx/dt = u, k_x = (r_x + k_u)/g; as
    Q^2 = -|omega|^2 I, (g I - Q/2)^-1 = (g I + Q/2)/(g^2 + |omega|^2/4) gives
    k_q from k_omega. A dense 6x6 system in (k_u, k_omega) is left.
*/
typedef struct stage_system
{
    const ellipsoid_state *state;
    double g, per_g;
    double per_square;         /* 1/(g^2 + |omega|^2/4) */
    double length;             /* scales the rows of omega to those of u */
    double ux[3][3], wx[3][3]; /* blocks / g */
    double uq[3][4], wq[3][4]; /* blocks (g I - Q/2)^-1 */
    double lu[6][6], per_pivot[6];
    int swap[6];
} stage_system;

/* LU with row exchanges; 0 if the matrix is singular. */
static int factor(stage_system *s)
{
    for (int c = 0; c < 6; c++)
    {
        int p = c;

        for (int i = c + 1; i < 6; i++)
        {
            if (fabs(s->lu[i][c]) > fabs(s->lu[p][c]))
            {
                p = i;
            }
        }
        s->swap[c] = p;
        if (p != c)
        {
            double row[6];

            memcpy(row, s->lu[p], sizeof(row));
            memcpy(s->lu[p], s->lu[c], sizeof(row));
            memcpy(s->lu[c], row, sizeof(row));
        }
        if (!(fabs(s->lu[c][c]) > 0))
        {
            return 0;
        }
        s->per_pivot[c] = 1 / s->lu[c][c];
        for (int i = c + 1; i < 6; i++)
        {
            const double f = s->lu[i][c] * s->per_pivot[c];

            s->lu[i][c] = f;
            for (int j = c + 1; j < 6; j++)
            {
                s->lu[i][j] -= f * s->lu[c][j];
            }
        }
    }
    return 1;
}

static void substitute(const stage_system *s, double b[6])
{
    for (int c = 0; c < 6; c++)
    {
        const double swapped = b[s->swap[c]];

        b[s->swap[c]] = b[c];
        b[c] = swapped;
    }
    for (int i = 1; i < 6; i++)
    {
        for (int c = 0; c < i; c++)
        {
            b[i] -= s->lu[i][c] * b[c];
        }
    }
    for (int i = 5; i >= 0; i--)
    {
        for (int c = i + 1; c < 6; c++)
        {
            b[i] -= s->lu[i][c] * b[c];
        }
        b[i] *= s->per_pivot[i];
    }
}

/* row (g I - Q/2)^-1; Q is antisymmetric, hence the sign. */
static void eliminate_quaternion(const stage_system *s, const double row[4],
                                 double result[4])
{
    double turned[4];

    ellipsoid_spin(s->state->omega, row, turned);
    for (int n = 0; n < 4; n++)
    {
        result[n] = s->per_square * (s->g * row[n] - 0.5 * turned[n]);
    }
}

/* -row d(Q(omega) q / 2)/domega */
static void coupling(const double row[4], const double q[4], double result[3])
{
    for (int i = 0; i < 3; i++)
    {
        const int j = (i + 1) % 3, k = (i + 2) % 3;

        result[i] =
            -0.5
            * (row[i] * q[3] + row[j] * q[k] - row[k] * q[j] - row[3] * q[i]);
    }
}

/* Returns 0 if the step is so long that the matrix is singular. */
static int prepare(stage_system *s, const ellipsoid_point *start, double h,
                   double length)
{
    const ellipsoid_blocks *b = &start->blocks;
    const double *w = start->state.omega;

    s->state = &start->state;
    s->per_g = ellipsoid_rodas4.gamma * h;
    s->g = 1 / s->per_g;
    s->per_square = 1 / (s->g * s->g + 0.25 * ellipsoid_dot(w, w));
    s->length = length;

    for (int i = 0; i < 3; i++)
    {
        double *u_row = s->lu[i], *w_row = s->lu[i + 3];

        eliminate_quaternion(s, b->uq[i], s->uq[i]);
        eliminate_quaternion(s, b->wq[i], s->wq[i]);
        coupling(s->uq[i], start->state.q, u_row + 3);
        coupling(s->wq[i], start->state.q, w_row + 3);
        for (int j = 0; j < 3; j++)
        {
            s->ux[i][j] = s->per_g * b->ux[i][j];
            s->wx[i][j] = s->per_g * b->wx[i][j];
            u_row[j] = -b->uu[i][j] - s->ux[i][j];
            w_row[j] = -s->wx[i][j] * length;
            w_row[j + 3] = (w_row[j + 3] - b->ww[i][j]) * length;
        }
        u_row[i] += s->g;
        w_row[i + 3] += s->g * length;
    }
    return factor(s);
}

static void solve(const stage_system *s, const double r[SIZE], double k[SIZE])
{
    double b[6], turned[4], v[4];

    for (int i = 0; i < 3; i++)
    {
        double u = r[U + i], w = r[W + i];

        for (int j = 0; j < 3; j++)
        {
            u += s->ux[i][j] * r[X + j];
            w += s->wx[i][j] * r[X + j];
        }
        for (int n = 0; n < 4; n++)
        {
            u += s->uq[i][n] * r[Q + n];
            w += s->wq[i][n] * r[Q + n];
        }
        b[i] = u;
        b[i + 3] = w * s->length;
    }
    substitute(s, b);
    for (int i = 0; i < 3; i++)
    {
        k[U + i] = b[i];
        k[X + i] = s->per_g * (r[X + i] + b[i]);
        k[W + i] = b[i + 3];
    }
    ellipsoid_spin(k + W, s->state->q, turned);
    for (int n = 0; n < 4; n++)
    {
        v[n] = r[Q + n] + 0.5 * turned[n];
    }
    ellipsoid_spin(s->state->omega, v, turned);
    for (int n = 0; n < 4; n++)
    {
        k[Q + n] = s->per_square * (s->g * v[n] + 0.5 * turned[n]);
    }
}

/* --------------------------------------------------------------- a step */

ellipsoid_status ellipsoid_rosenbrock_step(const ellipsoid_problem *problem,
                                           const ellipsoid_point *start,
                                           double h, ellipsoid_stages *stages)
{
    const ellipsoid_rosenbrock_table *table = &ellipsoid_rodas4;
    const double per_h = 1 / h;
    stage_system system;
    double y0[SIZE], r[SIZE];

    if (!prepare(&system, start, h, problem->length))
    {
        return ELLIPSOID_NON_FINITE;
    }
    memcpy(y0, &start->state, sizeof(y0));
    memcpy(r, &start->derivative, sizeof(r));
    solve(&system, r, stages->k[0]);

    for (int i = 1; i < ELLIPSOID_STAGES; i++)
    {
        ellipsoid_state state, derivative;
        ellipsoid_contact contact;
        ellipsoid_status status;
        double change[SIZE] = {0}, sum = 0;

        memcpy(stages->y, y0, sizeof(y0));
        for (int j = 0; j < i; j++)
        {
            const double aij = table->a[i][j], cij = table->c[i][j] * per_h;

            for (int n = 0; n < SIZE; n++)
            {
                stages->y[n] += aij * stages->k[j][n];
                change[n] += cij * stages->k[j][n];
            }
        }
        for (int n = 0; n < SIZE; n++)
        {
            sum += stages->y[n];
        }
        if (!isfinite(sum))
        {
            return ELLIPSOID_NON_FINITE;
        }
        memcpy(&state, stages->y, sizeof(state));
        status = ellipsoid_problem_evaluate(problem, &state, &derivative,
                                            &contact, NULL);
        if (status != ELLIPSOID_OK)
        {
            return status;
        }
        memcpy(r, &derivative, sizeof(r));
        for (int n = 0; n < SIZE; n++)
        {
            r[n] += change[n];
        }
        solve(&system, r, stages->k[i]);
    }
    for (int n = 0; n < SIZE; n++)
    {
        stages->y[n] += stages->k[ELLIPSOID_STAGES - 1][n];
    }
    return ELLIPSOID_OK;
}

void ellipsoid_rosenbrock_dense(const ellipsoid_stages *stages,
                                double dense[2][ELLIPSOID_STATE_SIZE])
{
    for (int d = 0; d < 2; d++)
    {
        for (int n = 0; n < SIZE; n++)
        {
            double sum = 0;

            for (int j = 0; j < ELLIPSOID_STAGES - 1; j++)
            {
                sum += ellipsoid_rodas4.dense[d][j] * stages->k[j][n];
            }
            dense[d][n] = sum;
        }
    }
}

/* Hairer & Wanner II, the continuous output of code RODAS. */
void ellipsoid_step_state(const ellipsoid_step *step, double t,
                          ellipsoid_state *state)
{
    const double s = (t - step->start) / (step->end - step->start);
    double before[SIZE], after[SIZE], y[SIZE];

    memcpy(before, &step->before, sizeof(before));
    memcpy(after, &step->after, sizeof(after));
    for (int n = 0; n < SIZE; n++)
    {
        y[n] = (1 - s) * before[n]
             + s
                   * (after[n]
                      + (1 - s) * (step->dense[0][n] + s * step->dense[1][n]));
    }
    ellipsoid_normalise(y + Q);
    memcpy(state, y, sizeof(*state));
}
