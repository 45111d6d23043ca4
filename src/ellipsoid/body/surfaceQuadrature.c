/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    surfaceQuadrature.c - the points at which FLOW_BODY samples the flow.
*/
#include "body/body.h"

static void add_pair(ellipsoid_model *model, const double n[3], double weight)
{
    for (int sign = 1; sign >= -1; sign -= 2)
    {
        const int p = model->flow_points++;

        for (int i = 0; i < 3; i++)
        {
            model->flow_point[p][i] = sign * model->options.semi_axes[i] * n[i];
        }
        model->flow_weight[p] = weight;
    }
}

/*
    The vertices of an icosahedron with a pole on the longest axis, in opposite
    pairs, are exact to degree 5 (Stroud 1971, U3 5-1). With
    three in place of five points in each of its two rings all is as exact but
    the products of three coordinates across the axis and one or more along it,
    which are small for slender bodies.
*/
void ellipsoid_surface_quadrature(ellipsoid_model *model)
{
    const double pi = 3.14159265358979323846, along = sqrt(0.2);
    const double *a = model->options.semi_axes;
    const int k = a[1] > a[0] ? (a[2] > a[1] ? 2 : 1) : (a[2] > a[0] ? 2 : 0);
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const int ring = a[k] >= 2 * fmax(a[i], a[j]) ? 4 : 5;
    double n[3] = {0};

    model->flow_points = 0;
    n[k] = 1;
    add_pair(model, n, 1.0 / 12);
    n[k] = along;
    for (int p = 0; p < ring; p++)
    {
        n[i] = 2 * along * cos(2 * pi * p / ring);
        n[j] = 2 * along * sin(2 * pi * p / ring);
        add_pair(model, n, 5.0 / 12 / ring);
    }
}
