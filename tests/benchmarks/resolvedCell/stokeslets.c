/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    stokeslets.c - the velocity of a constant layer of Stokeslets on a triangle,
    in places near it, and at its own middle.
*/
#include "resolvedCell.h"

#include <math.h>
#include <string.h>

static void add_stokeslet(const double d[3], double weight, double g[3][3])
{
    const double r2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    const double r = sqrt(r2), w = weight / r;

    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            g[i][j] += w * ((i == j) + d[i] * d[j] / r2);
        }
    }
}

/* Over a triangle that x is not on: halved while it is near. */
static void integrate(const resolved_cell *curved, double v[3][3],
                      const double x[3], int depth, double g[3][3])
{
    double middle[3];
    int edge;
    const double size = resolved_longest(v, &edge);

    resolved_middle(v, middle);
    if (depth < 6 && resolved_distance(middle, x) < 1.7 * size)
    {
        double m[3][3];

        for (int i = 0; i < 3; i++)
        {
            for (int c = 0; c < 3; c++)
            {
                m[i][c] = 0.5 * (v[i][c] + v[(i + 1) % 3][c]);
            }
        }
        for (int i = 0; i < 3; i++)
        {
            double corner[3][3];

            memcpy(corner[0], v[i], sizeof(m[0]));
            memcpy(corner[1], m[i], sizeof(m[0]));
            memcpy(corner[2], m[(i + 2) % 3], sizeof(m[0]));
            integrate(curved, corner, x, depth + 1, g);
        }
        integrate(curved, m, x, depth + 1, g);
        return;
    }
    const double area = resolved_area(v);

    for (int k = 0; k < 3; k++) /* of second degree */
    {
        double d[3], y[3];

        for (int c = 0; c < 3; c++)
        {
            y[c] = (v[0][c] + v[1][c] + v[2][c] + 3 * v[k][c]) / 6;
        }
        if (curved)
        {
            resolved_project(curved, y);
        }
        for (int c = 0; c < 3; c++)
        {
            d[c] = x[c] - y[c];
        }
        add_stokeslet(d, area / 3, g);
    }
}

/* Over the triangle itself, from its middle: in polar coordinates the radius
   is integrated, the angle by Gauss's rule of ten points. */
static void integrate_own(const triangle *t, double g[3][3])
{
    static const double node[5] = {0.1488743389816312, 0.4333953941292472,
                                   0.6794095682990244, 0.8650633666889845,
                                   0.9739065285171717};
    static const double weight[5] = {0.2955242247147529, 0.2692667193099963,
                                     0.2190863625159820, 0.1494513491505806,
                                     0.0666713443086881};

    for (int i = 0; i < 3; i++)
    {
        const double *a = t->v[i], *b = t->v[(i + 1) % 3];
        double along[3], foot[3], length = resolved_distance(a, b), s = 0, h;

        for (int c = 0; c < 3; c++)
        {
            along[c] = (b[c] - a[c]) / length;
            s += along[c] * (t->middle[c] - a[c]);
        }
        for (int c = 0; c < 3; c++)
        {
            foot[c] = a[c] + s * along[c] - t->middle[c];
        }
        h = sqrt(foot[0] * foot[0] + foot[1] * foot[1] + foot[2] * foot[2]);

        const double low = atan2(-s, h), high = atan2(length - s, h);

        for (int k = 0; k < 10; k++)
        {
            const double z = k % 2 ? node[k / 2] : -node[k / 2];
            const double angle = 0.5 * (low + high + z * (high - low));
            const double rho = h / cos(angle);
            const double w = 0.5 * (high - low) * weight[k / 2] * rho;
            double d[3];

            for (int c = 0; c < 3; c++)
            {
                d[c] = cos(angle) * foot[c] / h + sin(angle) * along[c];
            }
            add_stokeslet(d, w, g);
        }
    }
}

static const triangle *panel(const resolved_cell *p, int k)
{
    return k < p->body.count ? &p->body.at[k] : &p->walls.at[k - p->body.count];
}

void resolved_matrix_set(resolved_cell *p)
{
    const int n = p->size / 3;

    for (int row = 0; row < n; row++)
    {
        for (int column = 0; column < n; column++)
        {
            const triangle *of = panel(p, column);
            double g[3][3] = {{0}}, v[3][3];

            if (row == column)
            {
                integrate_own(of, g);
            }
            else
            {
                memcpy(v, of->v, sizeof(v));
                integrate(column < p->body.count ? p : NULL, v,
                          panel(p, row)->at, 0, g);
            }
            for (int i = 0; i < 3; i++)
            {
                for (int j = 0; j < 3; j++)
                {
                    p->matrix[(size_t)(3 * row + i) * (size_t)p->size
                              + (size_t)(3 * column + j)] =
                        (float)(g[i][j] / (8 * 3.14159265358979323846));
                }
            }
        }
    }
}
