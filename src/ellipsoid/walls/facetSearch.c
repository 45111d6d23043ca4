/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    facetSearch.c - which facets each bead of a cell may come into contact with,
    or the ellipsoid itself in place of beads.
*/
#include "walls/walls.h"

#include <math.h>
#include <string.h>

/* Bead centres, one array for each coordinate so that loops vectorise, and the
   box in the body frame that holds them. */
typedef struct bead_set
{
    int count;
    double x[3][ELLIPSOID_MAX_BEADS];
    double centre[3], rotation[3][3], half_box[3];
    double stretch; /* q.q, the factor of lengths in R(q) */
} bead_set;

static void set_beads(const ellipsoid_model *model, const double x[3],
                      const double q[4], bead_set *beads)
{
    ellipsoid_copy(x, beads->centre);
    ellipsoid_rotation_inline(q, beads->rotation);
    beads->stretch = ellipsoid_square4(q);
    beads->count = model->bead_count;
    memset(beads->half_box, 0, sizeof beads->half_box);
    for (int b = 0; b < model->bead_count; b++)
    {
        for (int i = 0; i < 3; i++)
        {
            beads->x[i][b] =
                x[i] + ellipsoid_dot(beads->rotation[i], model->bead[b]);
            beads->half_box[i] =
                fmax(beads->half_box[i], fabs(model->bead[b][i]));
        }
    }
}

/* Is a point farther than `far` from the box that holds the beads? */
static int beyond_box(const bead_set *beads, const double d[3], double far)
{
    const double squared = beads->stretch * beads->stretch;
    double sum = 0;

    for (int i = 0; i < 3; i++)
    {
        const double along = beads->rotation[0][i] * d[0]
                           + beads->rotation[1][i] * d[1]
                           + beads->rotation[2][i] * d[2];
        const double out = fabs(along) - squared * beads->half_box[i];

        sum += out > 0 ? out * out : 0;
    }
    return sum > squared * far * far;
}

/* Does the box, seen along the normal, lie more than `near` beside a point? */
static int beside_box(const bead_set *beads, const double normal[3],
                      const double d[3], double near)
{
    const double height = ellipsoid_dot(d, normal);
    double across[3], extent = 0;

    for (int i = 0; i < 3; i++)
    {
        across[i] = d[i] - height * normal[i];
    }
    for (int i = 0; i < 3; i++)
    {
        extent += beads->half_box[i]
                * fabs(beads->rotation[0][i] * across[0]
                       + beads->rotation[1][i] * across[1]
                       + beads->rotation[2][i] * across[2]);
    }

    const double squared = ellipsoid_dot(across, across);

    return squared > near * sqrt(squared) + extent;
}

/* Is the plane farther than `far` from the box, on either side of it? */
static int above_box(const bead_set *beads, const double normal[3],
                     const double d[3], double far)
{
    double extent = 0;

    for (int i = 0; i < 3; i++)
    {
        extent += beads->half_box[i]
                * fabs(beads->rotation[0][i] * normal[0]
                       + beads->rotation[1][i] * normal[1]
                       + beads->rotation[2][i] * normal[2]);
    }
    return fabs(ellipsoid_dot(d, normal)) > far + extent;
}

/*
    Excess of the squared distance of beads over the largest at which the facet
    may be nearest: from its ball and, unless an edge is convex, beside it.
    height: above its plane.
*/
static void set_distances(const ellipsoid_facet *facet, const bead_set *beads,
                          double far, double near,
                          double height[ELLIPSOID_MAX_BEADS],
                          double beyond[ELLIPSOID_MAX_BEADS])
{
    const double beside =
        ellipsoid_facet_has_convex_edge(facet) ? far * far : near * near;
    const double *n = facet->normal, *middle = facet->middle;

    for (int b = 0; b < beads->count; b++)
    {
        const double d0 = beads->x[0][b] - middle[0];
        const double d1 = beads->x[1][b] - middle[1];
        const double d2 = beads->x[2][b] - middle[2];
        const double h = d0 * n[0] + d1 * n[1] + d2 * n[2];
        const double squared = d0 * d0 + d1 * d1 + d2 * d2;

        const double out = squared - far * far;
        const double aside = squared - h * h - beside;

        height[b] = h;
        beyond[b] = out > aside ? out : aside;
    }
}

/* Fills the lists of all beads; 0 if there are too many facets. */
static int search_beads(const ellipsoid_facet_list *list, const bead_set *beads,
                        double reach, double margin,
                        ellipsoid_facet_cache *cache)
{
    int found[ELLIPSOID_MAX_PAIRS][2], next[ELLIPSOID_MAX_BEADS];
    int n = 0;

    for (int b = 0; b < beads->count; b++)
    {
        cache->nearest[b] = HUGE_VAL;
        next[b] = 0;
    }
    for (int k = 0; k < list->count; k++)
    {
        const ellipsoid_facet *facet = &list->facets[list->index[k]];
        double d[3], height[ELLIPSOID_MAX_BEADS];
        double beyond[ELLIPSOID_MAX_BEADS], distance;
        ellipsoid_facet_sides sides;
        const double size = facet->radius;
        const double rounding = 1e-6 * (reach + margin);
        const double far = size + reach + margin + rounding;
        const double near = size + 1.5 * margin + rounding;

        ellipsoid_difference(facet->middle, beads->centre, d);
        if (beyond_box(beads, d, far)
            || above_box(beads, facet->normal, d, far - size)
            || (!ellipsoid_facet_has_convex_edge(facet)
                && beside_box(beads, facet->normal, d, near)))
        {
            continue;
        }
        set_distances(facet, beads, far, near, height, beyond);
        ellipsoid_facet_sides_set(facet, &sides);
        for (int b = 0; b < beads->count; b++)
        {
            const double centre[3] = {beads->x[0][b], beads->x[1][b],
                                      beads->x[2][b]};

            if (beyond[b] > 0 || fabs(height[b]) > far - size
                || !ellipsoid_facet_may_be_nearest(facet, &sides, centre,
                                                   reach, margin, &distance))
            {
                continue;
            }
            if (n == ELLIPSOID_MAX_PAIRS)
            {
                return 0;
            }
            if (distance < cache->nearest[b])
            {
                cache->nearest[b] = distance;
            }
            found[n][0] = b;
            found[n][1] = list->index[k];
            n++;
            next[b]++;
        }
    }

    /* from ascending by facet to bead by bead */
    cache->first[0] = 0;
    cache->bead_count = 0;
    cache->nearest_of_all = HUGE_VAL;
    for (int b = 0; b < beads->count; b++)
    {
        if (next[b] > 0)
        {
            cache->bead[cache->bead_count++] = b;
            cache->nearest_of_all =
                fmin(cache->nearest_of_all, cache->nearest[b]);
        }
        cache->first[b + 1] = cache->first[b] + next[b];
        next[b] = cache->first[b];
    }
    for (int k = 0; k < n; k++)
    {
        cache->facet[next[found[k][0]]++] = found[k][1];
    }
    return 1;
}

/* The same for the ellipsoid itself, the first and only bead. */
static int search_ellipsoid(const ellipsoid_facet_list *list,
                            const bead_set *box, const ellipsoid_surface *body,
                            double reach, ellipsoid_facet_cache *cache)
{
    int n = 0;

    for (int k = 0; k < list->count; k++)
    {
        const ellipsoid_facet *facet = &list->facets[list->index[k]];
        double d[3];

        ellipsoid_difference(facet->middle, body->centre, d);
        if (beyond_box(box, d, facet->radius + reach)
            || !ellipsoid_surface_may_reach(facet, body, reach))
        {
            continue;
        }
        if (n == ELLIPSOID_MAX_PAIRS)
        {
            return 0;
        }
        cache->facet[n++] = list->index[k];
    }
    cache->first[0] = 0;
    cache->first[1] = n;
    return 1;
}

int ellipsoid_facet_search(const ellipsoid_model *model,
                           const ellipsoid_facet_list *list, double horizon,
                           double margin, ellipsoid_facet_cache *cache)
{
    const double radius = model->options.bead_radius;
    bead_set beads;
    ellipsoid_surface body;

    set_beads(model, cache->x, cache->q, &beads);
    if (model->options.contact_shape == ELLIPSOID_CONTACT_ELLIPSOID)
    {
        ellipsoid_surface_set(model->options.semi_axes, cache->x, cache->q,
                              &body);
        ellipsoid_copy(body.axes, beads.half_box);
    }
    memcpy(cache->rotation, beads.rotation, sizeof cache->rotation);
    memcpy(cache->half_box, beads.half_box, sizeof cache->half_box);
    return model->options.contact_shape == ELLIPSOID_CONTACT_ELLIPSOID
             ? search_ellipsoid(list, &beads, &body,
                                horizon + margin + 1e-6 * radius, cache)
             : search_beads(list, &beads, radius + horizon, margin, cache);
}
