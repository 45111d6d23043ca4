/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    gmres.c - the linear system, which is dense (Saad & Schultz 1986).
*/
#include "resolvedCell.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void apply(const resolved_cell *p, const double *x, double *y)
{
    for (int i = 0; i < p->size; i++)
    {
        const float *row = p->matrix + (size_t)i * (size_t)p->size;
        double sum[4] = {0};
        int j = 0;

        for (; j + 3 < p->size; j += 4)
        {
            for (int k = 0; k < 4; k++)
            {
                sum[k] += (double)row[j + k] * x[j + k];
            }
        }
        for (; j < p->size; j++)
        {
            sum[0] += (double)row[j] * x[j];
        }
        y[i] = sum[0] + sum[1] + sum[2] + sum[3];
    }
}

/* Of the residual, in parts of b. */
static const double tolerance = 2e-5;

/* x with matrix x = b by GMRES, preconditioned by the diagonal from the right. */
int resolved_solve(const resolved_cell *p, const double *b, double *x)
{
    enum
    {
        MOST = 300
    };
    const size_t n = (size_t)p->size;
    double *v = malloc((MOST + 1) * n * sizeof(*v)),
           *z = malloc(n * sizeof(*z));
    static double h[MOST + 1][MOST], c[MOST], s[MOST], g[MOST + 1], y[MOST];
    double norm = 0;
    int k = 0;

    if (!v || !z)
    {
        exit(1);
    }
    for (size_t i = 0; i < n; i++)
    {
        norm += b[i] * b[i];
    }
    norm = sqrt(norm);
    memset(g, 0, sizeof(g));
    g[0] = norm;
    for (size_t i = 0; i < n; i++)
    {
        v[i] = b[i] / norm;
    }
    for (; k < MOST && fabs(g[k]) > tolerance * norm; k++)
    {
        double *w = v + (size_t)(k + 1) * n, length = 0;

        for (size_t i = 0; i < n; i++)
        {
            z[i] = v[(size_t)k * n + i] / (double)p->matrix[i * n + i];
        }
        apply(p, z, w);
        for (int j = 0; j <= k; j++)
        {
            const double *u = v + (size_t)j * n;
            double dot = 0;

            for (size_t i = 0; i < n; i++)
            {
                dot += u[i] * w[i];
            }
            h[j][k] = dot;
            for (size_t i = 0; i < n; i++)
            {
                w[i] -= dot * u[i];
            }
        }
        for (size_t i = 0; i < n; i++)
        {
            length += w[i] * w[i];
        }
        length = sqrt(length);
        for (size_t i = 0; i < n; i++)
        {
            w[i] /= length;
        }
        for (int j = 0; j < k; j++)
        {
            const double t = c[j] * h[j][k] + s[j] * h[j + 1][k];

            h[j + 1][k] = -s[j] * h[j][k] + c[j] * h[j + 1][k];
            h[j][k] = t;
        }
        const double r = hypot(h[k][k], length);

        c[k] = h[k][k] / r;
        s[k] = length / r;
        h[k][k] = r;
        g[k + 1] = -s[k] * g[k];
        g[k] *= c[k];
    }
    for (int i = k - 1; i >= 0; i--)
    {
        y[i] = g[i];
        for (int j = i + 1; j < k; j++)
        {
            y[i] -= h[i][j] * y[j];
        }
        y[i] /= h[i][i];
    }
    for (size_t i = 0; i < n; i++)
    {
        x[i] = 0;
        for (int j = 0; j < k; j++)
        {
            x[i] += y[j] * v[(size_t)j * n + i];
        }
        x[i] /= (double)p->matrix[i * n + i];
    }
    free(v);
    free(z);
    return fabs(g[k]) > tolerance * norm ? -1 : k;
}
