/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    groupMatrix.c - the linear systems of a Rosenbrock step of a group.

    That of a cell alone is in stageMatrix.c. Of several, x and q of each cell are
    eliminated likewise. What is left has a 6x6 block on the diagonal for each
    cell and two beside it for each pair that touches. It is factorised by Gauss
    without exchange of rows, M = L U by blocks, and absent blocks stay absent but
    for fill-in: contact adds what is nearly positive definite to a diagonal of
    drag and inertia.
*/
#include "motion/motion.h"

/* The block of this row and column, NULL if it is absent. */
static double (*block_at(const ellipsoid_group *g, int row, int column))[6]
{
    const int n = g->pairs->block[row * g->count + column];

    return n < 0 ? NULL : g->pairs->blocks[n];
}

/* The same, made of zeros if it was absent. */
static double (*make_block(const ellipsoid_group *g, int row, int column,
                           int *used))[6]
{
    int *n = &g->pairs->block[row * g->count + column];

    if (*n < 0)
    {
        *n = (*used)++;
        memset(g->pairs->blocks[*n], 0, sizeof(g->pairs->blocks[*n]));
    }
    return g->pairs->blocks[*n];
}

/* m += sign a b */
static void add_product(double sign, double a[6][6], double b[6][6],
                        double m[6][6])
{
    for (int i = 0; i < 6; i++)
    {
        for (int l = 0; l < 6; l++)
        {
            const double factor = sign * a[i][l];

            for (int j = 0; j < 6; j++)
            {
                m[i][j] += factor * b[l][j];
            }
        }
    }
}

/* v += sign m w */
static void add_vector(double sign, double m[6][6], const double w[6],
                       double v[6])
{
    for (int i = 0; i < 6; i++)
    {
        double sum = 0;

        for (int j = 0; j < 6; j++)
        {
            sum += m[i][j] * w[j];
        }
        v[i] += sign * sum;
    }
}

/* Their transpose is a block. */
static void transpose(double rates[6][6], double m[6][6])
{
    for (int i = 0; i < 6; i++)
    {
        for (int j = 0; j < 6; j++)
        {
            m[i][j] = rates[j][i];
        }
    }
}

/* Leaves inverses on the diagonal. */
static int factorise(const ellipsoid_group *g, int *used)
{
    for (int pivot = 0; pivot < g->count; pivot++)
    {
        double(*diagonal)[6] = block_at(g, pivot, pivot);

        if (!ellipsoid_invert6(diagonal))
        {
            return 0;
        }
        for (int row = pivot + 1; row < g->count; row++)
        {
            double(*left)[6] = block_at(g, row, pivot);
            double factor[6][6] = {{0}};

            if (!left)
            {
                continue;
            }
            add_product(1, left, diagonal, factor);
            memcpy(left, factor, sizeof(factor));
            for (int column = pivot + 1; column < g->count; column++)
            {
                double(*above)[6] = block_at(g, pivot, column);

                if (above)
                {
                    add_product(-1, factor, above,
                                make_block(g, row, column, used));
                }
            }
        }
    }
    return 1;
}

int ellipsoid_group_prepare(ellipsoid_group *g,
                            const ellipsoid_evaluation *points, double per_g)
{
    ellipsoid_pairs *pairs = g->pairs;
    int used = 0;

    if (!pairs)
    {
        return ellipsoid_stage_matrix_prepare(
            g->system, points, g->inertial || g->cell[0].fixed, per_g);
    }
    for (int n = 0; n < g->count * g->count; n++)
    {
        pairs->block[n] = -1;
    }
    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_evaluation *at = &points[cell];
        ellipsoid_stage_matrix *s = &g->system[cell];
        double(*diagonal)[6] = make_block(g, cell, cell, &used);
        ellipsoid_reduced reduced;

        ellipsoid_stage_matrix_reduce(&at->blocks, &at->state, per_g, &reduced);
        transpose(reduced.rates, diagonal);
        for (int i = 0; i < 6; i++)
        {
            diagonal[i][i] +=
                g->inertial || g->cell[cell].fixed ? 1 / per_g : 0;
        }
        memcpy(s->to_rates[AT_X], reduced.x, sizeof(reduced.x));
        memcpy(s->to_rates[AT_Q], reduced.q, sizeof(reduced.q));
        ellipsoid_stage_matrix_kinematics(s, &at->state, per_g);
    }
    for (int n = 0; n < pairs->count; n++)
    {
        ellipsoid_coupling *c = &pairs->coupling[n];

        ellipsoid_stage_matrix_reduce(&c->blocks, &points[c->column].state,
                                      per_g, &c->reduced);
        transpose(c->reduced.rates, make_block(g, c->row, c->column, &used));
    }
    return factorise(g, &used);
}

/* Right-hand sides of the rates, with x and q eliminated. */
static void set_rates(const ellipsoid_group *g, int stage)
{
    double(*rates)[6] = g->pairs->rates;

    for (int cell = 0; cell < g->count; cell++)
    {
        const double *r = g->stages[cell].k[stage];
        double(*own)[6] = g->system[cell].to_rates;

        for (int i = 0; i < 6; i++)
        {
            rates[cell][i] = i < 3 ? r[AT_U + i] : r[AT_OMEGA + i - 3];
            for (int n = AT_X; n < UNKNOWNS; n++)
            {
                rates[cell][i] += ellipsoid_is_rate(n) ? 0 : own[n][i] * r[n];
            }
        }
    }
    for (int n = 0; n < g->pairs->count; n++)
    {
        const ellipsoid_coupling *c = &g->pairs->coupling[n];
        const double *r = g->stages[c->column].k[stage];

        for (int i = 0; i < 6; i++)
        {
            for (int l = 0; l < 3; l++)
            {
                rates[c->row][i] += c->reduced.x[l][i] * r[AT_X + l];
            }
            for (int l = 0; l < 4; l++)
            {
                rates[c->row][i] += c->reduced.q[l][i] * r[AT_Q + l];
            }
        }
    }
}

void ellipsoid_pairs_solve(const ellipsoid_group *g, int stage)
{
    double(*rates)[6] = g->pairs->rates;

    set_rates(g, stage);
    for (int row = 0; row < g->count; row++)
    {
        for (int column = 0; column < row; column++)
        {
            double(*m)[6] = block_at(g, row, column);

            if (m)
            {
                add_vector(-1, m, rates[column], rates[row]);
            }
        }
    }
    for (int row = g->count - 1; row >= 0; row--)
    {
        double *k = g->stages[row].k[stage], solution[6] = {0};

        for (int column = row + 1; column < g->count; column++)
        {
            double(*m)[6] = block_at(g, row, column);

            if (m)
            {
                add_vector(-1, m, rates[column], rates[row]);
            }
        }
        add_vector(1, block_at(g, row, row), rates[row], solution);
        memcpy(rates[row], solution, sizeof(solution));
        ellipsoid_stage_matrix_finish(&g->system[row], solution, k);
    }
}
