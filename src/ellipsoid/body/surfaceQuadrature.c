/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    surfaceQuadrature.c - the points at which FLOW_BODY samples the flow.
*/
#include "body/body.h"

/* A class of points: all that arise from one by signs and exchanges. */
typedef struct point_class
{
    double point[3];
    double weight;
} point_class;

/*
    Quadratures on the sphere with octahedral symmetry: Lebedev, USSR Comput.
    Math. Math. Phys. 16, 10 (1976). 6, 14, 26 and 50 points are exact for
    polynomials of degree 3, 5, 7 and 11.
*/
static const struct quadrature
{
    int points, classes;
    point_class class[4];
} quadratures[] = {
    {6, 1, {{{1, 0, 0}, 1.0 / 6}}},
    {14, 2, {{{1, 0, 0}, 1.0 / 15}, {{1, 1, 1}, 3.0 / 40}}},
    {26,
     3,
     {{{1, 0, 0}, 1.0 / 21}, {{1, 1, 0}, 4.0 / 105}, {{1, 1, 1}, 9.0 / 280}}},
    {50,
     4,
     {{{1, 0, 0}, 4.0 / 315},
      {{1, 1, 0}, 64.0 / 2835},
      {{1, 1, 1}, 27.0 / 1280},
      {{1, 1, 3}, 14641.0 / 725760}}},
};

static void add_point(ellipsoid_model *model, const double n[3], double weight)
{
    const double length = ellipsoid_length(n);
    const int p = model->flow_points++;

    for (int i = 0; i < 3; i++)
    {
        model->flow_point[p][i] = model->options.semi_axes[i] * n[i] / length;
    }
    model->flow_weight[p] = weight;
}

/* All signs of the numbers that are not zero; after each point the one
   opposite. */
static void add_signs(ellipsoid_model *model, const double n[3], double weight)
{
    for (int sign = 0; sign < 8; sign++)
    {
        const double s[3] = {sign & 1 ? -1 : 1, sign & 2 ? -1 : 1,
                             sign & 4 ? -1 : 1};
        const double point[3] = {s[0] * n[0], s[1] * n[1], s[2] * n[2]};
        const double opposite[3] = {-point[0], -point[1], -point[2]};
        const double first = n[0] > 0 ? s[0] : n[1] > 0 ? s[1] : s[2];

        if (first > 0 && (n[0] > 0 || s[0] > 0) && (n[1] > 0 || s[1] > 0)
            && (n[2] > 0 || s[2] > 0))
        {
            add_point(model, point, weight);
            add_point(model, opposite, weight);
        }
    }
}

int ellipsoid_surface_quadrature(ellipsoid_model *model)
{
    model->flow_points = 0;
    for (size_t q = 0; q < sizeof quadratures / sizeof *quadratures; q++)
    {
        if (quadratures[q].points != model->options.flow_points)
        {
            continue;
        }
        for (int c = 0; c < quadratures[q].classes; c++)
        {
            const double *n = quadratures[q].class[c].point;
            const double weight = quadratures[q].class[c].weight;

            /* two of the three numbers are always equal */
            add_signs(model, n, weight);
            if (n[0] != n[2])
            {
                add_signs(model, (const double[3]){n[2], n[0], n[1]}, weight);
                add_signs(model, (const double[3]){n[1], n[2], n[0]}, weight);
            }
        }
    }
    return model->flow_points;
}
