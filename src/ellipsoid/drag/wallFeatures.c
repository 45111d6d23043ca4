/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    wallFeatures.c - where a body would meet a facet near it.

    The body, grown about its centre, meets the walls in points one after the
    other: where y -> y.M y, M = R diag(1/a_i^2) R^T, has a local minimum on the
    wall, y = w - x. The plane through such a point w on which the grown body
    rests has the normal n ~ -M (w - x). On a flat wall it is the wall itself,
    however the body lies; and it cuts the body only if the wall does. The point
    is inside a facet, on a convex edge or at a vertex under the conditions of
    facets.c, with the scalar product by M.
*/
#include "drag/wallResistance.h"

/* Relative rounding that conditions allow, as in facets.c. */
static const double rounding = 1e-9;

/* r: from the point to the centre, body frame */
static int set_feature(ellipsoid_wall_feature *p, int feature, int k,
                       double foot, const double r[3], const double covector[3])
{
    const double length = ellipsoid_length(covector);

    if (!(length > 0))
    {
        return 0;
    }
    p->feature = feature;
    p->k = k;
    p->foot = foot;
    ellipsoid_set(p->normal, covector[0] / length, covector[1] / length,
                  covector[2] / length);
    p->height = ellipsoid_dot(p->normal, r);
    return 1;
}

/* Vectors of a facet in the body frame. */
typedef struct corners
{
    double from[3][3], along[3][3]; /* vertex to centre; edges */
} corners;

static void set_from(const ellipsoid_wall_search *s,
                     const ellipsoid_facet *facet, int k, corners *c)
{
    double line[3];

    ellipsoid_difference(s->x, facet->vertex[k], line);
    ellipsoid_product(s->axis, line, c->from[k]);
}

static int feature_on_edge(const ellipsoid_wall_search *s, const corners *c,
                         int k, double foot, const double normal[3],
                         ellipsoid_wall_feature *p)
{
    double r[3], w[3], inward[3];

    for (int i = 0; i < 3; i++)
    {
        r[i] = c->from[k][i] - foot * c->along[k][i];
    }
    ellipsoid_shrink(s, r, w);
    ellipsoid_product(s->axis, p->facet->edge_inward[k], inward);
    return ellipsoid_dot(w, inward) <= rounding * ellipsoid_length(w)
        && ellipsoid_dot(r, normal) >= -rounding * ellipsoid_length(r)
        && set_feature(p, ELLIPSOID_ON_EDGE, k, foot, r, w);
}

/* bare: the square of the scaled distance to the facet's plane */
static int feature_at_vertex(const ellipsoid_wall_search *s, const corners *c,
                           const double normal[3], double bare,
                           ellipsoid_wall_feature *p)
{
    const ellipsoid_facet *facet = p->facet;
    double nearest = HUGE_VAL, w[3], lab[3];
    int k = 0;

    for (int n = 0; n < 3; n++)
    {
        double squared;

        ellipsoid_shrink(s, c->from[n], w);
        squared = ellipsoid_dot(c->from[n], w);
        if (squared < nearest)
        {
            nearest = squared;
            k = n;
        }
    }
    ellipsoid_shrink(s, c->from[k], w);
    ellipsoid_combination(s->axis, w[0], w[1], w[2], lab);
    return (ellipsoid_facet_owns_vertex(facet, k)
            || bare >= (1 - 2 * rounding) * nearest)
        && ellipsoid_facet_is_apex(facet, k, lab,
                                   rounding * ellipsoid_length(w))
        && ellipsoid_dot(c->from[k], normal)
               >= -rounding * ellipsoid_length(c->from[k])
        && set_feature(p, ELLIPSOID_ON_VERTEX, k, 0, c->from[k], w);
}

/* Where the foot of a vector from an edge's first vertex is along the edge, by
   M; squared: the edge's length by M, squared. */
static double foot_along(const ellipsoid_wall_search *s, const double along[3],
                         const double from[3], double *squared)
{
    double w[3];

    ellipsoid_shrink(s, along, w);
    *squared = ellipsoid_dot(along, w);
    return ellipsoid_dot(from, w) / *squared;
}

/* The point beside the facet's face, over a convex edge. */
static int feature_on_rim(const ellipsoid_wall_search *s,
                          const double normal[3], double bare,
                          const int outside[3], ellipsoid_wall_feature *p)
{
    const ellipsoid_facet *facet = p->facet;
    double best = HUGE_VAL, foot = 0;
    int edge = 0;
    corners c = {.from = {{0}}};

    for (int k = 0; k < 3; k++)
    {
        double line[3], at, past, squared;

        if (!outside[k] || facet->edge[k] != ELLIPSOID_EDGE_CONVEX)
        {
            continue;
        }
        set_from(s, facet, k, &c);
        ellipsoid_difference(facet->vertex[(k + 1) % 3], facet->vertex[k],
                             line);
        ellipsoid_product(s->axis, line, c.along[k]);
        at = foot_along(s, c.along[k], c.from[k], &squared);
        past = fmax(0, fmax(-at, at - 1)) * sqrt(squared);
        if (past < best)
        {
            best = past;
            edge = k;
            foot = at;
        }
    }
    if (best > 0)
    {
        for (int k = 0; k < 3; k++)
        {
            set_from(s, facet, k, &c);
        }
        if (feature_at_vertex(s, &c, normal, bare, p))
        {
            return 1;
        }
    }
    p->over[(edge + 1) % 3] = foot > 1;
    p->over[(edge + 2) % 3] = foot < 0;
    return feature_on_edge(s, &c, edge, foot, normal, p);
}

double ellipsoid_squared_rim_distance(const ellipsoid_facet *facet,
                                      const double x[3])
{
    double least = HUGE_VAL;

    for (int k = 0; k < 3; k++)
    {
        double line[3], squared;

        ellipsoid_difference(x, facet->vertex[k], line);
        squared = ellipsoid_dot(line, line);
        if (facet->edge[k] == ELLIPSOID_EDGE_CONVEX)
        {
            double along[3], of;

            ellipsoid_difference(facet->vertex[(k + 1) % 3], facet->vertex[k],
                                 along);
            of = ellipsoid_dot(line, along);
            squared -= of * of / ellipsoid_dot(along, along);
        }
        least = squared < least ? squared : least;
    }
    return least > 0 ? least : 0; /* in line with an edge: rounding */
}

/* Is the place beside one of these edges, neither before nor behind it? */
static int is_beside(const ellipsoid_wall_search *s,
                     const ellipsoid_facet *facet, const int edges[3],
                     const double place[3])
{
    for (int k = 0; k < 3; k++)
    {
        double line[3], to[3], along[3], at, squared;

        if (!edges[k])
        {
            continue;
        }
        ellipsoid_difference(place, facet->vertex[k], line);
        ellipsoid_product(s->axis, line, to);
        ellipsoid_difference(facet->vertex[(k + 1) % 3], facet->vertex[k],
                             line);
        ellipsoid_product(s->axis, line, along);
        at = foot_along(s, along, to, &squared);
        if (at >= 0 && at <= 1)
        {
            return 1;
        }
    }
    return 0;
}

/* Finds the plane that this facet gives; 0 if there is none. */
int ellipsoid_find_feature(const ellipsoid_wall_search *s,
                           const ellipsoid_facet *facet,
                           ellipsoid_wall_view *view,
                           ellipsoid_wall_feature *p)
{
    /* far more than rounding */
    const double squared_range = s->range * s->range * (1 + 1e-6);
    double from[3], foot[3], aside[3], along[3], height;
    int outside[3], on_rim = 0, across = 0;

    ellipsoid_difference(s->x, facet->middle, from);
    height = ellipsoid_dot(from, facet->normal);
    if (!(height > 0 && height < s->range))
    {
        return 0;
    }
    ellipsoid_look_along(s, facet->normal, view);
    for (int i = 0; i < 3; i++)
    {
        aside[i] = from[i] - view->way[i] * height;
        foot[i] = s->x[i] - view->way[i] * height;
    }
    for (int k = 0; k < 3; k++)
    {
        outside[k] = facet->edge[k] == ELLIPSOID_EDGE_CONVEX
                  && ellipsoid_beyond(facet, foot, k, along) > 0;
        on_rim = on_rim || outside[k];
    }
    if (on_rim)
    {
        const double bare = height / view->support;

        if (ellipsoid_squared_rim_distance(facet, s->x) >= squared_range)
        {
            return 0;
        }
        memset(p, 0, sizeof(*p));
        p->facet = facet;
        return feature_on_rim(s, view->normal, bare * bare, outside, p);
    }

    const double beside =
        ellipsoid_facet_is_extended(facet) ? view->beside : ellipsoid_lap;
    const double wide = facet->radius + beside * height;

    if (height * view->far >= s->range
        || ellipsoid_dot(aside, aside) > wide * wide)
    {
        return 0; /* its plane is too far to count (wallPlanes.c), it has faded,
                     or is another facet's */
    }
    for (int k = 0; k < 3; k++)
    {
        double out;

        if (facet->edge[k] == ELLIPSOID_EDGE_CONVEX)
        {
            continue;
        }
        out = ellipsoid_beyond(facet, foot, k, along);
        outside[k] = out > 0 && facet->edge[k] != ELLIPSOID_EDGE_FLAT;
        across = across
              || (out > 0 && !outside[k]
                  && out > ellipsoid_lap * height * ellipsoid_length(along));
    }
    if (across && !is_beside(s, facet, outside, foot))
    {
        return 0; /* the same plane is that of the facet across */
    }
    memset(p, 0, sizeof(*p));
    p->facet = facet;
    p->feature = ELLIPSOID_ON_FACE;
    memcpy(p->over, outside, sizeof(p->over));
    ellipsoid_copy(foot, p->place);
    ellipsoid_copy(view->normal, p->normal);
    p->height = height;
    return 1;
}
