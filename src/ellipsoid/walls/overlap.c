/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    overlap.c - whether an ellipsoid cuts a wall, for seeding cells.
*/
#include "walls/walls.h"

/* Least squared distance of the origin from the triangle p, Ericson,
   Real-Time Collision Detection (2005), section 5.1.5. */
static double distance_squared(double p[3][3])
{
    double ab[3], ac[3], nearest[3];

    for (int i = 0; i < 3; ++i)
    {
        ab[i] = p[1][i] - p[0][i];
        ac[i] = p[2][i] - p[0][i];
    }

    const double d1 = -ellipsoid_dot(ab, p[0]), d2 = -ellipsoid_dot(ac, p[0]);
    const double d3 = -ellipsoid_dot(ab, p[1]), d4 = -ellipsoid_dot(ac, p[1]);
    const double d5 = -ellipsoid_dot(ab, p[2]), d6 = -ellipsoid_dot(ac, p[2]);
    const double va = d3 * d6 - d5 * d4;
    const double vb = d5 * d2 - d1 * d6;
    const double vc = d1 * d4 - d3 * d2;
    double v, w; /* nearest = p0 + v ab + w ac */

    if (d1 <= 0 && d2 <= 0)
    {
        v = w = 0;
    }
    else if (d3 >= 0 && d4 <= d3)
    {
        v = 1;
        w = 0;
    }
    else if (d6 >= 0 && d5 <= d6)
    {
        v = 0;
        w = 1;
    }
    else if (vc <= 0 && d1 >= 0 && d3 <= 0)
    {
        v = d1 / (d1 - d3);
        w = 0;
    }
    else if (vb <= 0 && d2 >= 0 && d6 <= 0)
    {
        v = 0;
        w = d2 / (d2 - d6);
    }
    else if (va <= 0 && d4 >= d3 && d5 >= d6)
    {
        w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        v = 1 - w;
    }
    else
    {
        v = vb / (va + vb + vc);
        w = vc / (va + vb + vc);
    }

    for (int i = 0; i < 3; ++i)
    {
        nearest[i] = p[0][i] + v * ab[i] + w * ac[i];
    }

    return ellipsoid_dot(nearest, nearest);
}

int ellipsoid_surface_cuts(const ellipsoid_facet *facet,
                           const ellipsoid_surface *body)
{
    double p[3][3];

    /* Where the ellipsoid is the unit sphere, distances tell */
    for (int k = 0; k < 3; ++k)
    {
        double d[3];

        ellipsoid_difference(facet->vertex[k], body->centre, d);
        ellipsoid_surface_to_body(body, d, p[k]);
        for (int i = 0; i < 3; ++i)
        {
            p[k][i] /= body->axes[i];
        }
    }
    return distance_squared(p) < 1;
}

ellipsoid_status
ellipsoid_overlaps_walls(const ellipsoid_model *model,
                         const ellipsoid_surroundings *surroundings,
                         const double x[3], const double q[4], int *overlaps)
{
    const double *a = model->options.semi_axes;
    const double longest = ellipsoid_largest(a);
    /* To touch is not to cut, whatever rounding says */
    const double inside = 1 - 1e-10;
    const double axes[3] = {inside * a[0], inside * a[1], inside * a[2]};
    ellipsoid_facet_list list;
    ellipsoid_surface body;

    *overlaps = 0;

    if (!surroundings->walls)
    {
        return ELLIPSOID_OK;
    }

    if (surroundings->walls(surroundings->walls_context, surroundings->time, x,
                            (1 + 1e-9) * longest, &list))
    {
        return ELLIPSOID_WALLS_FAILED;
    }

    ellipsoid_surface_set(axes, x, q, &body);

    for (int n = 0; n < list.count && !*overlaps; ++n)
    {
        *overlaps = ellipsoid_surface_cuts(&list.facets[list.index[n]], &body);
    }

    return ELLIPSOID_OK;
}
