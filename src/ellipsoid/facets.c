/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    facets.c - a point against one facet: does the distance from the point to
    the wall have a local minimum there?

    It does inside the facet where the point projects into it, on an edge where
    neither of its two facets comes nearer, at a vertex where none of its edges
    does. Each facet answers from what it knows of its neighbours; an edge is
    answered for by both its facets, with the same result. Edges that are not
    marked concave are treated as if they were convex: on a flat one the answer
    is that of the facets beside it, so rounding leaves no gap between them.
*/
#include "ellipsoidInternal.h"

#include <math.h>
#include <string.h>

/* Relative slack of 'not nearer': closes the gaps that rounding would leave. */
static const double slack = 1e-9;

int ellipsoid_facet_answers(const ellipsoid_facet *facet, int k)
{
    return facet->edge[k] == ELLIPSOID_EDGE_CONVEX
        || facet->edge[(k + 2) % 3] == ELLIPSOID_EDGE_CONVEX;
}

int ellipsoid_facet_is_apex(const ellipsoid_facet *facet, int k,
                            const double r[3], double tolerance)
{
    for (int i = 0; i < facet->star_count[k]; i++)
    {
        if (ellipsoid_dot(r, facet->star[k][i]) > tolerance)
        {
            return 0;
        }
    }
    return 1;
}

/* Fills *nearest from r, the vector from an edge or a vertex to the point. */
static int from_rim(const ellipsoid_facet *facet, const double r[3],
                    double length, ellipsoid_nearest *nearest)
{
    if (ellipsoid_dot(r, facet->normal) < -slack * length)
    {
        return 0; /* from behind */
    }

    nearest->height = length;
    for (int i = 0; i < 3; i++)
    {
        nearest->normal[i] = length > 0 ? r[i] / length : facet->normal[i];
    }
    return 1;
}

static int nearest_on_edge(const ellipsoid_facet *facet, int k, double foot,
                           double reach, const double along[3],
                           const double from_vertex[3],
                           ellipsoid_nearest *nearest)
{
    const double size = sqrt(ellipsoid_dot(along, along));
    double r[3], length;

    for (int i = 0; i < 3; i++)
    {
        r[i] = from_vertex[i] - foot * along[i];
        nearest->edge[i] = along[i] / size;
    }
    length = sqrt(ellipsoid_dot(r, r));

    nearest->feature = length > 0 ? ELLIPSOID_ON_EDGE : ELLIPSOID_ON_FACE;
    return length < reach && facet->edge[k] != ELLIPSOID_EDGE_CONCAVE
        && ellipsoid_dot(r, facet->edge_inward[k]) <= slack * length
        && from_rim(facet, r, length, nearest);
}

int ellipsoid_facet_nearest(const ellipsoid_facet *facet,
                            const double centre[3], double reach,
                            ellipsoid_nearest *nearest)
{
    const double *n = facet->normal;
    double from[3][3], along[3][3], squared, length;
    int outside = 0, closest = 0;

    ellipsoid_difference(centre, facet->vertex[0], from[0]);

    const double height = ellipsoid_dot(from[0], n);

    if (!(fabs(height) < reach))
    {
        return 0;
    }
    ellipsoid_difference(centre, facet->vertex[1], from[1]);
    ellipsoid_difference(centre, facet->vertex[2], from[2]);

    for (int k = 0; k < 3; k++)
    {
        double inward[3];

        ellipsoid_difference(facet->vertex[(k + 1) % 3], facet->vertex[k],
                             along[k]);
        ellipsoid_cross(n, along[k], inward);
        if (ellipsoid_dot(inward, from[k]) < 0)
        {
            const double foot = ellipsoid_dot(from[k], along[k])
                              / ellipsoid_dot(along[k], along[k]);

            if (foot >= 0 && foot <= 1)
            {
                return nearest_on_edge(facet, k, foot, reach, along[k],
                                       from[k], nearest);
            }
            outside = 1;
        }
    }
    if (!outside)
    {
        nearest->feature = ELLIPSOID_ON_FACE;
        nearest->height = height;
        ellipsoid_copy(n, nearest->normal);
        return 1;
    }

    squared = ellipsoid_dot(from[0], from[0]);
    for (int k = 1; k < 3; k++)
    {
        const double other = ellipsoid_dot(from[k], from[k]);

        if (other < squared)
        {
            squared = other;
            closest = k;
        }
    }
    length = sqrt(squared);
    nearest->feature = length > 0 ? ELLIPSOID_ON_VERTEX : ELLIPSOID_ON_FACE;
    return length < reach
        && (ellipsoid_facet_answers(facet, closest)
            || fabs(height) >= (1 - slack) * length)
        && ellipsoid_facet_is_apex(facet, closest, from[closest],
                                   slack * length)
        && from_rim(facet, from[closest], length, nearest);
}

/* As nearest_on_edge(), for some point within `margin` of the given one. */
static int edge_concerns(const ellipsoid_facet *facet, int k, double inside,
                         double foot, double size, const double from[3],
                         double reach, double margin)
{
    const double along = foot / size;

    return facet->edge[k] != ELLIPSOID_EDGE_CONCAVE && inside <= margin * size
        && along >= -margin && along <= size + margin
        && ellipsoid_dot(from, from) - along * along <= reach * reach
        && ellipsoid_dot(from, facet->edge_inward[k]) <= margin;
}

int ellipsoid_facet_concerns(const ellipsoid_facet *facet,
                             const double centre[3], double reach,
                             double margin)
{
    /* each condition changes by no more than the point moves */
    const double wide = margin + 2 * slack * (reach + margin);
    const double far = reach + wide;
    int face = 1;

    for (int k = 0; k < 3; k++)
    {
        double from[3], along[3], inward[3];

        ellipsoid_difference(centre, facet->vertex[k], from);
        if (k == 0 && !(fabs(ellipsoid_dot(from, facet->normal)) <= far))
        {
            return 0;
        }
        ellipsoid_difference(facet->vertex[(k + 1) % 3], facet->vertex[k],
                             along);
        ellipsoid_cross(facet->normal, along, inward);

        const double length = sqrt(ellipsoid_dot(along, along));
        const double inside = ellipsoid_dot(inward, from);
        const double foot = ellipsoid_dot(from, along);

        if (edge_concerns(facet, k, inside, foot, length, from, far, wide)
            || (ellipsoid_dot(from, from) <= far * far
                && ellipsoid_facet_is_apex(facet, k, from, wide)))
        {
            return 1;
        }
        face = face && inside >= -wide * length;
    }
    return face;
}

int ellipsoid_facet_set(ellipsoid_facet *facet, const double vertex[3][3])
{
    double sides[2][3], squared = 0;

    memcpy(facet->vertex, vertex, sizeof facet->vertex);
    ellipsoid_difference(vertex[1], vertex[0], sides[0]);
    ellipsoid_difference(vertex[2], vertex[0], sides[1]);
    ellipsoid_cross(sides[0], sides[1], facet->normal);

    const double area = ellipsoid_length(facet->normal);

    for (int i = 0; i < 3; i++)
    {
        facet->normal[i] /= area;
        facet->middle[i] = (vertex[0][i] + vertex[1][i] + vertex[2][i]) / 3;
    }
    for (int k = 0; k < 3; k++)
    {
        double d[3];

        ellipsoid_difference(vertex[k], facet->middle, d);
        squared = fmax(squared, ellipsoid_dot(d, d));

        facet->edge[k] = ELLIPSOID_EDGE_CONVEX;
        memset(facet->edge_inward[k], 0, sizeof facet->edge_inward[k]);
        memcpy(facet->neighbour_normal[k], facet->normal,
               sizeof facet->normal);
    }
    facet->radius = sqrt(squared);
    return area > 0;
}
