/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    facets.c - a point against one facet: does the distance from the point to
    the wall have a local minimum there?

    It does inside the facet where the point projects into it, on an edge where
    neither of its two facets comes nearer, at a vertex where none of its edges
    does. Each facet decides from its own data on its neighbours; both facets of
    an edge find the same minimum on it. Edges that are not marked concave are
    treated as convex: on a flat one the result is that of the facets beside it,
    so rounding leaves no gap between them.
*/
#include "walls/walls.h"

#include <math.h>
#include <string.h>

/* What "not nearer" allows, relative: closes the gaps that rounding leaves. */
static const double rounding = 1e-9;

/* A smaller angle between facets [rad] is the mesh's rounding. */
static const double flat = 1e-6;

int ellipsoid_facet_owns_vertex(const ellipsoid_facet *facet, int k)
{
    return facet->edge[k] == ELLIPSOID_EDGE_CONVEX
        || facet->edge[(k + 2) % 3] == ELLIPSOID_EDGE_CONVEX;
}

int ellipsoid_facet_ends_at_edge(const ellipsoid_facet *facet, int k)
{
    return !(ellipsoid_dot(facet->edge_inward[k], facet->edge_inward[k]) > 0);
}

int ellipsoid_facet_ends_at_vertex(const ellipsoid_facet *facet, int k)
{
    return ellipsoid_facet_ends_at_edge(facet, k)
        || ellipsoid_facet_ends_at_edge(facet, (k + 2) % 3);
}

int ellipsoid_facet_is_apex(const ellipsoid_facet *facet, int k,
                            const double r[3], double tolerance)
{
    const double *star = (const void *)((const char *)facet + facet->star[k]);

    for (int i = 0; i < facet->star_count[k]; i++)
    {
        if (ellipsoid_dot(r, star + 3 * i) > tolerance)
        {
            return 0;
        }
    }
    return 1;
}

/* Fills *nearest from r, the vector from an edge or a vertex to the point;
   ends: does the wall end there? */
static int set_boundary_nearest(const ellipsoid_facet *facet, const double r[3],
                                double length, int ends,
                                ellipsoid_nearest *nearest)
{
    if (!ends && ellipsoid_dot(r, facet->normal) < -rounding * length)
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

/* Is the vector r from an edge's foot to the point too long, or has the facet
   across the edge something nearer? Errs towards 0: what is left out by
   rounding is decided by what follows. */
static int is_beside_edge(const ellipsoid_facet *facet, int k,
                          const double r[3], double reach)
{
    return facet->edge[k] == ELLIPSOID_EDGE_CONCAVE
        || ellipsoid_dot(r, r) > (1 + 2 * rounding) * reach * reach
        || ellipsoid_dot(r, facet->edge_inward[k]) > 2 * rounding * reach;
}

static int nearest_on_edge(const ellipsoid_facet *facet, int k, double foot,
                           double reach, const double along[3],
                           const double from_vertex[3],
                           ellipsoid_nearest *nearest)
{
    double r[3], size, length;

    for (int i = 0; i < 3; i++)
    {
        r[i] = from_vertex[i] - foot * along[i];
    }
    if (is_beside_edge(facet, k, r, reach))
    {
        return 0;
    }
    size = sqrt(ellipsoid_dot(along, along));
    for (int i = 0; i < 3; i++)
    {
        nearest->edge[i] = along[i] / size;
    }

    /* once more: the rounding of the foot on a long edge exceeds that of r */
    const double rest = ellipsoid_dot(r, nearest->edge);

    for (int i = 0; i < 3; i++)
    {
        r[i] -= rest * nearest->edge[i];
    }
    length = sqrt(ellipsoid_dot(r, r));

    nearest->feature = length > 0 ? ELLIPSOID_ON_EDGE : ELLIPSOID_ON_FACE;
    return length < reach
        && ellipsoid_dot(r, facet->edge_inward[k]) <= rounding * length
        && set_boundary_nearest(facet, r, length,
                                ellipsoid_facet_ends_at_edge(facet, k),
                                nearest);
}

int ellipsoid_boundary_nearest(const ellipsoid_facet *facet,
                               const double centre[3], double reach,
                               ellipsoid_nearest *nearest)
{
    double from[3][3], squared = HUGE_VAL, length;
    int closest = 0;

    for (int k = 0; k < 3; k++)
    {
        ellipsoid_difference(centre, facet->vertex[k], from[k]);
        if (ellipsoid_dot(facet->inward[k], from[k]) < 0)
        {
            double along[3], foot, size;

            ellipsoid_difference(facet->vertex[(k + 1) % 3], facet->vertex[k],
                                 along);
            foot = ellipsoid_dot(from[k], along);
            size = ellipsoid_dot(along, along);
            if (foot >= 0 && foot <= size)
            {
                return nearest_on_edge(facet, k, foot / size, reach, along,
                                       from[k], nearest);
            }
        }
    }
    for (int k = 0; k < 3; k++)
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
        && (ellipsoid_facet_owns_vertex(facet, closest)
            || fabs(ellipsoid_dot(from[0], facet->normal))
                   >= (1 - rounding) * length)
        && ellipsoid_facet_is_apex(facet, closest, from[closest],
                                   rounding * length)
        && set_boundary_nearest(facet, from[closest], length,
                                ellipsoid_facet_ends_at_vertex(facet, closest),
                                nearest);
}

void ellipsoid_facet_sides_set(const ellipsoid_facet *facet,
                               ellipsoid_facet_sides *sides)
{
    for (int k = 0; k < 3; k++)
    {
        double *along = sides->along[k];

        ellipsoid_difference(facet->vertex[(k + 1) % 3], facet->vertex[k],
                             along);
        sides->length[k] = ellipsoid_length(along);
        for (int i = 0; i < 3; i++)
        {
            along[i] /= sides->length[k];
        }
        ellipsoid_cross(facet->normal, along, sides->inward[k]);
    }
}

/* As nearest_on_edge(), for some point within `margin` of one that lies `from`
   the edge's first vertex and so far to the inside. */
static int edge_may_be_nearest(const ellipsoid_facet *facet,
                               const ellipsoid_facet_sides *sides, int k,
                               const double from[3], double inside,
                               double reach, double margin)
{
    const double along = ellipsoid_dot(from, sides->along[k]);

    return facet->edge[k] != ELLIPSOID_EDGE_CONCAVE && inside <= margin
        && along >= -margin && along <= sides->length[k] + margin
        && ellipsoid_dot(from, from) - along * along <= reach * reach
        && ellipsoid_dot(from, facet->edge_inward[k]) <= margin;
}

int ellipsoid_facet_may_be_nearest(const ellipsoid_facet *facet,
                                   const ellipsoid_facet_sides *sides,
                                   const double centre[3], double reach,
                                   double margin, double *distance)
{
    /* each condition changes by no more than the point moves */
    const double wide = margin + 2 * rounding * (reach + margin);
    const double far = reach + wide;
    double from[3][3], inside[3], height, aside = 0, squared;
    int found;

    ellipsoid_difference(centre, facet->vertex[0], from[0]);
    height = ellipsoid_dot(from[0], facet->normal);
    if (!(fabs(height) <= far))
    {
        return 0;
    }
    ellipsoid_difference(centre, facet->vertex[1], from[1]);
    ellipsoid_difference(centre, facet->vertex[2], from[2]);
    for (int k = 0; k < 3; k++)
    {
        inside[k] = ellipsoid_dot(sides->inward[k], from[k]);
        aside = inside[k] < -aside ? -inside[k] : aside;
    }
    squared = height * height + aside * aside;
    if (squared > far * far)
    {
        return 0;
    }
    *distance = sqrt(squared);
    found = aside <= wide;
    for (int k = 0; k < 3 && !found; k++)
    {
        found =
            edge_may_be_nearest(facet, sides, k, from[k], inside[k], far, wide)
            || (ellipsoid_dot(from[k], from[k]) <= far * far
                && ellipsoid_facet_is_apex(facet, k, from[k], wide));
    }
    return found;
}

int ellipsoid_facet_set(ellipsoid_facet *facet, const double vertex[3][3])
{
    double sides[3][3], longest = 0, squared = 0;
    int opposite = 0;

    memcpy(facet->vertex, vertex, sizeof facet->vertex);
    facet->mirror = 0;
    for (int k = 0; k < 3; k++)
    {
        ellipsoid_difference(vertex[(k + 2) % 3], vertex[(k + 1) % 3],
                             sides[k]);

        const double size = ellipsoid_dot(sides[k], sides[k]);

        if (size > longest)
        {
            longest = size;
            opposite = k;
        }
    }
    /* of the two shorter sides: those of slivers differ most in direction */
    ellipsoid_cross(sides[(opposite + 1) % 3], sides[(opposite + 2) % 3],
                    facet->normal);

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

        ellipsoid_difference(vertex[(k + 1) % 3], vertex[k], d);
        ellipsoid_cross(facet->normal, d, facet->inward[k]);
        facet->edge[k] = ELLIPSOID_EDGE_CONVEX;
        memset(facet->edge_inward[k], 0, sizeof facet->edge_inward[k]);
        memcpy(facet->neighbour_normal[k], facet->normal, sizeof facet->normal);
    }
    facet->radius = sqrt(squared);
    facet->plane = 0;
    facet->within = 0;
    return area > 0;
}

static int is_point(const double a[3], const double b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* Does the facet run along the edge from a to b? */
static int runs_along(const ellipsoid_facet *facet, const double a[3],
                      const double b[3])
{
    for (int k = 0; k < 3; k++)
    {
        if (is_point(facet->vertex[k], a)
            && is_point(facet->vertex[(k + 1) % 3], b))
        {
            return 1;
        }
    }
    return 0;
}

/* The turn of the wall [rad] from a facet to one of normal n across an edge of
   direction t: positive where they face each other. */
static double turn_to(const ellipsoid_facet *facet, const double t[3],
                      const double n[3])
{
    double inward[3];

    ellipsoid_cross(facet->normal, t, inward);

    const double along = ellipsoid_dot(facet->normal, n);
    const double facing = ellipsoid_dot(inward, n);

    /* the facet's own back, all the way round */
    return along < 0 && fabs(facing) < flat ? -4 : atan2(facing, along);
}

int ellipsoid_facet_join(ellipsoid_facet *facet, int k,
                         const ellipsoid_facet *other)
{
    const double *from = facet->vertex[k], *to = facet->vertex[(k + 1) % 3];
    double t[3];

    if (!runs_along(other, to, from))
    {
        return 0;
    }
    ellipsoid_difference(to, from, t);

    const double length = ellipsoid_length(t);

    for (int i = 0; i < 3; i++)
    {
        t[i] /= length;
    }

    const double turn = turn_to(facet, t, other->normal);

    if (!ellipsoid_facet_ends_at_edge(facet, k)
        && turn <= turn_to(facet, t, facet->neighbour_normal[k]))
    {
        return 0;
    }
    ellipsoid_cross(t, other->normal, facet->edge_inward[k]);
    ellipsoid_copy(other->normal, facet->neighbour_normal[k]);
    facet->edge[k] = fabs(turn) < flat ? ELLIPSOID_EDGE_FLAT
                   : turn > 0          ? ELLIPSOID_EDGE_CONCAVE
                                       : ELLIPSOID_EDGE_CONVEX;
    facet->within &= ~(1 << k);
    facet->within |= (facet->edge[k] == ELLIPSOID_EDGE_FLAT) << k;
    return 1;
}
