/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    planeSolver.c - a rigid spheroid above a no-slip plane in Stokes flow.

    A single layer of forces with Blake's tensor gives the velocity of the surface;
    its density is the traction (Pozrikidis 1992, section 4.1). The plane y = 0 is
    one of symmetry: motions in it and across it make two systems of half the size.
    A held body in a flow feels the integral of that flow times the tractions of
    its motions (the reciprocal theorem).
*/
#include "planePanels.h"

#include <math.h>
#include <stdlib.h>

/* The surface's velocity by motion m of those in (0) or across (1) the plane of
   symmetry, the shear flow as the fourth and that of a stagnation point. */
static void velocity(const solver *v, int part, int m, const double x[3],
                     double u[3])
{
    const double r[3] = {x[0] - v->centre[0], x[1] - v->centre[1],
                         x[2] - v->centre[2]};

    u[0] = u[1] = u[2] = 0;
    if (m == 3)
    {
        u[part] = r[2];
    }
    else if (m == 4)
    {
        u[0] = r[0] * x[2];
        u[1] = r[1] * x[2];
        u[2] = -x[2] * x[2];
    }
    else if (part == 0)
    {
        u[0] = m == 0 ? 1 : m == 2 ? r[2] : 0;
        u[2] = m == 1 ? 1 : m == 2 ? -r[0] : 0;
    }
    else
    {
        u[0] = m == 2 ? -r[1] : 0;
        u[1] = m == 0 ? 1 : m == 1 ? -r[2] : r[0];
        u[2] = m == 1 ? r[1] : 0;
    }
}

/* Gauss's elimination with pivots, four columns at a time, of `rights` right
   sides in rows; 0 if singular. */
static int eliminate(double *a, int n, double (*right)[3])
{
    for (int k = 0; k < n; k++)
    {
        int best = k;

        for (int i = k + 1; i < n; i++)
        {
            best = fabs(a[i * n + k]) > fabs(a[best * n + k]) ? i : best;
        }
        if (!isnormal(a[best * n + k]))
        {
            return 0;
        }
        for (int j = 0; best != k && j < n; j++)
        {
            const double kept = a[k * n + j];

            a[k * n + j] = a[best * n + j];
            a[best * n + j] = kept;
        }
        for (int j = 0; best != k && j < 3; j++)
        {
            const double kept = right[k][j];

            right[k][j] = right[best][j];
            right[best][j] = kept;
        }
        /* the columns of a block now, those beyond it once it is complete */
        const int first = k / 32 * 32, last = first + 32 < n ? first + 32 : n;

        for (int i = k + 1; i < n; i++)
        {
            const double factor = a[i * n + k] /= a[k * n + k];

            for (int j = k + 1; j < last; j++)
            {
                a[i * n + j] -= factor * a[k * n + j];
            }
            for (int j = 0; j < 3; j++)
            {
                right[i][j] -= factor * right[k][j];
            }
        }
        if (k + 1 < last)
        {
            continue;
        }
        for (int i = first + 1; i < n; i++)
        {
            const int most = i < last ? i : last;
            double *row = &a[i * n];
            int m = first;

            for (; m + 4 <= most; m += 4)
            {
                const double *r = &a[m * n];
                const double f[4] = {row[m], row[m + 1], row[m + 2],
                                     row[m + 3]};

                for (int j = last; j < n; j++)
                {
                    row[j] -= f[0] * r[j] + f[1] * r[j + n]
                            + f[2] * r[j + 2 * n] + f[3] * r[j + 3 * n];
                }
            }
            for (; m < most; m++)
            {
                for (int j = last; j < n; j++)
                {
                    row[j] -= row[m] * a[m * n + j];
                }
            }
        }
    }
    for (int k = n - 1; k >= 0; k--)
    {
        for (int j = 0; j < 3; j++)
        {
            for (int i = k + 1; i < n; i++)
            {
                right[k][j] -= a[k * n + i] * right[i][j];
            }
            right[k][j] /= a[k * n + k];
        }
    }
    return 1;
}

/* Calls for each node of half the surface: its number and place. */
#define FOR_EACH_NODE(v)                                                       \
    for (int row = 0, n_ = (v)->mesh.nodes; row < (v)->count; row++)           \
        for (int panel = row / (n_ * n_), ring = panel / (v)->mesh.sectors,    \
                 sector = panel % (v)->mesh.sectors, k = row / n_ % n_,        \
                 l = row % n_, once = 1;                                       \
             once; once = 0)

static int solve_part(const solver *v, int part, plane_functions *result)
{
    double(*block)[3] = part ? result->across : result->in;
    double *shear = part ? result->shear_across : result->shear_in;
    double(*right)[3] = malloc(3 * (size_t)v->count * sizeof(*right));
    double sum[5][3] = {{0}};
    int regular;

    if (!right)
    {
        return 0;
    }
    FOR_EACH_NODE(v)
    {
        double s, phi, x[3];

        plane_node_at(v, ring, sector, k, l, &s, &phi);
        plane_place(v, s, phi, x);
        for (int m = 0; m < 3; m++)
        {
            double u[3];

            velocity(v, part, m, x, u);
            for (int i = 0; i < 3; i++)
            {
                right[3 * row + i][m] = u[i];
            }
        }
    }
    regular = eliminate(v->matrix[part], 3 * v->count, right);
    FOR_EACH_NODE(v)
    {
        double s, phi, x[3], weight;

        plane_node_at(v, ring, sector, k, l, &s, &phi);
        weight = 2 * plane_place(v, s, phi, x) * v->weight[k] * v->weight[l]
               * pi / (v->mesh.rings * v->mesh.sectors);
        for (int m = 0; m < 5; m++)
        {
            double u[3];

            velocity(v, part, m, x, u);
            for (int j = 0; j < 3; j++)
            {
                for (int i = 0; i < 3; i++)
                {
                    sum[m][j] += weight * u[i] * right[3 * row + i][j];
                }
            }
        }
    }
    free(right);
    for (int i = 0; i < 3; i++)
    {
        shear[i] = sum[3][i];
        if (part == 0)
        {
            result->stagnation[i] = sum[4][i];
        }
        for (int j = 0; j < 3; j++)
        {
            block[i][j] = 0.5 * (sum[i][j] + sum[j][i]);
            result->asymmetry =
                fmax(result->asymmetry,
                     fabs(sum[i][j] - sum[j][i]) / sqrt(sum[i][i] * sum[j][j]));
        }
    }
    return regular;
}

int plane_solve(const plane_case *c, const plane_mesh *mesh,
                plane_functions *result)
{
    solver v = {.mesh = *mesh};
    size_t size;
    int done = 0;

    plane_set_geometry(&v, c);
    v.count = mesh->rings * mesh->sectors * mesh->nodes * mesh->nodes;
    size = 9 * (size_t)v.count * (size_t)v.count;
    v.matrix[0] = calloc(size, sizeof(double));
    v.matrix[1] = calloc(size, sizeof(double));
    if (v.matrix[0] && v.matrix[1])
    {
        FOR_EACH_NODE(&v)
        {
            double s, phi;

            plane_node_at(&v, ring, sector, k, l, &s, &phi);
            plane_place(&v, s, phi, v.target);
            for (int p = 0; p < mesh->rings * mesh->sectors; p++)
            {
                plane_add_panel(&v, row, p / mesh->sectors, p % mesh->sectors,
                                p == panel, s, phi);
            }
        }
        result->asymmetry = 0;
        done = solve_part(&v, 0, result) && solve_part(&v, 1, result);
    }
    free(v.matrix[0]);
    free(v.matrix[1]);
    return done;
}
