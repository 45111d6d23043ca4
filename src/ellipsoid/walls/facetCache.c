/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    facetCache.c - which facets the beads of a cell, or the ellipsoid itself in
    place of beads, may meet.

    The cache holds, for the pose at which it was filled, for each bead every
    facet that it can meet within the horizon while no bead has moved farther
    than the margin. Facets that are not met add nothing, and those met come in
    their own order, so a result does not depend, not by a bit, on the pose at
    which they were collected.
*/
#include "walls/walls.h"

#include <limits.h>
#include <math.h>
#include <string.h>

/*
    How far a bead may move before facets are collected again, in bead radii:
    few facets to look at against few collections. It begins with the first and
    follows the cell's pace: wider if it served few poses for the facets looked
    through, narrower if many.
*/
static const double first_margin = 0.5, widest = 1, narrowest = 1.0 / 32;
static const double few = 0.06, many = 0.4; /* poses for each facet listed */

/* Where facets are too many: smaller margins, each by this factor, down to the
   narrowest. */
static const double smaller = 0.5;

/* All that is of beads. */
static void forget(ellipsoid_facet_cache *cache)
{
    cache->valid = 0;
    cache->served = 0;
    cache->margin = 0;
    cache->clearance = 0;
    cache->facets = NULL;
    memset(cache->x, 0, sizeof cache->x);
    memset(cache->q, 0, sizeof cache->q);
}

void ellipsoid_facet_cache_clear(ellipsoid_facet_cache *cache)
{
    forget(cache);
    cache->near_count = -1;
    cache->near_facets = NULL;
    memset(cache->near_x, 0, sizeof cache->near_x);
}

static double product(const double p[4], const double q[4])
{
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3];
}

/*
    How far any bead can have moved since the cache was filled. The box that
    holds the beads bounds it: a spin about a long axis moves them little.
*/
static double farthest_move(const ellipsoid_facet_cache *cache,
                            const double shift, const double q[4])
{
    double r[3][3], sum = 0;

    ellipsoid_rotation_inline(q, r);
    for (int i = 0; i < 3; i++)
    {
        const double d = fabs(r[i][0] - cache->rotation[i][0])
                           * cache->half_box[0]
                       + fabs(r[i][1] - cache->rotation[i][1])
                           * cache->half_box[1]
                       + fabs(r[i][2] - cache->rotation[i][2])
                           * cache->half_box[2];

        sum += d * d;
    }
    return shift + sqrt(sum);
}

static int serves(const ellipsoid_facet_cache *cache,
                  const ellipsoid_model *model, const double x[3],
                  const double q[4], double *moved)
{
    double d[3];

    if (!cache->valid)
    {
        return 0;
    }
    ellipsoid_difference(x, cache->x, d);

    const double squared = ellipsoid_dot(d, d);
    const double arm = model->reach - model->options.bead_radius;

    if (cache->clearance > 0)
    {
        /* R(q) stretches by q.q, which is near 1 but not bound to be */
        const double longer = product(q, q) - product(cache->q, cache->q);
        /* NaN is not served */
        const double left = cache->clearance - arm * (longer <= 0 ? 0 : longer);

        return left > 0 && squared < left * left;
    }
    *moved = farthest_move(cache, sqrt(squared), q);
    return *moved <= cache->margin;
}

/* The nearest that any facet, listed or not, can be to the centre; NaN where
   a facet is not finite. */
static double nearest_facet(const ellipsoid_facet_list *list,
                            const double centre[3])
{
    double nearest = list->reach;

    for (int k = 0; k < list->count; k++)
    {
        const ellipsoid_facet *facet = &list->facets[list->index[k]];
        double d[3];

        ellipsoid_difference(centre, facet->middle, d);

        /* outside its plane and its ball */
        const double height = fabs(ellipsoid_dot(d, facet->normal));
        const double outside = ellipsoid_length(d) - facet->radius;
        const double distance = height > outside ? height : outside;

        if (!isfinite(height + outside))
        {
            return NAN;
        }
        nearest = distance < nearest ? distance : nearest;
    }
    return nearest;
}

ellipsoid_status
ellipsoid_list_facets(const ellipsoid_surroundings *surroundings,
                      const double centre[3], double reach,
                      ellipsoid_facet_list *list)
{
    const int answer =
        surroundings->walls(surroundings->walls_context, surroundings->time,
                            centre, reach, list);

    return answer > 0   ? ELLIPSOID_STEP_UNDERFLOW
           : answer < 0 ? ELLIPSOID_WALLS_FAILED
                        : ELLIPSOID_OK;
}

/* Bead centres, one array for each coordinate so that loops vectorise, and the
   box in the body frame that holds them. */
typedef struct swarm
{
    int count;
    double x[3][ELLIPSOID_MAX_BEADS];
    double centre[3], rotation[3][3], half_box[3];
    double stretch; /* q.q, of lengths by rotation */
} swarm;

static void place_beads(const ellipsoid_model *model, const double x[3],
                        const double q[4], swarm *beads)
{
    ellipsoid_copy(x, beads->centre);
    ellipsoid_rotation_inline(q, beads->rotation);
    beads->stretch = product(q, q);
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
static int beyond_box(const swarm *beads, const double d[3], double far)
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
static int beside_box(const swarm *beads, const double normal[3],
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
static int above_box(const swarm *beads, const double normal[3],
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
    How far beads are, squared, beyond what a facet may concern: beyond the
    reach of its ball and, unless an edge is convex, beside it. height: above
    its plane.
*/
static void glance(const ellipsoid_facet *facet, const swarm *beads,
                   double far, double near,
                   double height[ELLIPSOID_MAX_BEADS],
                   double beyond[ELLIPSOID_MAX_BEADS])
{
    const double beside =
        ellipsoid_facet_has_rim(facet) ? far * far : near * near;
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

/* Fills the lists of all beads; 0 if that is too much. */
static int collect(const ellipsoid_facet_list *list, const swarm *beads,
                   double reach, double margin, ellipsoid_facet_cache *cache)
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
        double beyond[ELLIPSOID_MAX_BEADS];
        const double size = facet->radius;
        const double rounding = 1e-6 * (reach + margin);
        const double far = size + reach + margin + rounding;
        const double near = size + 1.5 * margin + rounding;

        ellipsoid_difference(facet->middle, beads->centre, d);
        if (beyond_box(beads, d, far)
            || above_box(beads, facet->normal, d, far - size)
            || (!ellipsoid_facet_has_rim(facet)
                && beside_box(beads, facet->normal, d, near)))
        {
            continue;
        }
        glance(facet, beads, far, near, height, beyond);
        for (int b = 0; b < beads->count; b++)
        {
            const double centre[3] = {beads->x[0][b], beads->x[1][b],
                                      beads->x[2][b]};

            if (beyond[b] > 0 || fabs(height[b]) > far - size
                || !ellipsoid_facet_concerns(facet, centre, reach, margin))
            {
                continue;
            }
            if (n == ELLIPSOID_MAX_PAIRS)
            {
                return 0;
            }
            if (fabs(height[b]) < cache->nearest[b])
            {
                cache->nearest[b] = fabs(height[b]);
            }
            found[n][0] = b;
            found[n][1] = list->index[k];
            n++;
            next[b]++;
        }
    }

    /* from ascending by facet to bead by bead */
    cache->first[0] = 0;
    for (int b = 0; b < beads->count; b++)
    {
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
static int collect_exact(const ellipsoid_facet_list *list, const swarm *box,
                         const ellipsoid_surface *body, double reach,
                         ellipsoid_facet_cache *cache)
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

static double next_margin(const ellipsoid_facet_cache *cache, double radius)
{
    if (!cache->valid || cache->clearance > 0)
    {
        return first_margin * radius;
    }

    const double paid = (double)cache->served / (cache->listed + 64);

    return paid < few    ? fmin(2 * cache->margin, widest * radius)
           : paid > many ? fmax(cache->margin / 2, narrowest * radius)
                         : cache->margin;
}

static ellipsoid_status fill(ellipsoid_facet_cache *cache,
                             const ellipsoid_model *model,
                             const ellipsoid_surroundings *surroundings,
                             const double x[3], const double q[4],
                             double horizon)
{
    const double radius = model->options.bead_radius;
    const int exact =
        model->options.contact_shape == ELLIPSOID_CONTACT_ELLIPSOID;
    double margin = next_margin(cache, radius);
    ellipsoid_surface body;
    ellipsoid_facet_list list;
    ellipsoid_status status;
    swarm beads;

    forget(cache);
    if (!isfinite(x[0] + x[1] + x[2] + product(q, q)))
    {
        return ELLIPSOID_NON_FINITE;
    }

    /* what can matter in this pose lies within */
    const double reach =
        (model->reach - radius) * product(q, q) + radius + horizon;

    status = ellipsoid_list_facets(surroundings, x, reach + margin, &list);
    if (status != ELLIPSOID_OK)
    {
        return status;
    }
    ellipsoid_copy(x, cache->x);
    memcpy(cache->q, q, sizeof cache->q);
    cache->facets = list.facets;

    double nearest = nearest_facet(&list, x);

    if (isnan(nearest))
    {
        return ELLIPSOID_NON_FINITE;
    }
    if (nearest - reach >= 0.5 * margin)
    {
        /* Far from all walls. If they do not say how far, a wider look spares
           many later ones; it may fail where the first did not. */
        if (nearest >= list.reach && list.reach <= reach + margin
            && ellipsoid_list_facets(surroundings, x, 2 * reach, &list)
                   == ELLIPSOID_OK)
        {
            nearest = fmax(nearest, nearest_facet(&list, x));
        }
        cache->clearance = nearest - reach;
        cache->valid = 1;
        return ELLIPSOID_OK;
    }

    place_beads(model, x, q, &beads);
    if (exact)
    {
        ellipsoid_surface_set(model->options.semi_axes, x, q, &body);
        ellipsoid_copy(body.axes, beads.half_box);
    }
    memcpy(cache->rotation, beads.rotation, sizeof cache->rotation);
    memcpy(cache->half_box, beads.half_box, sizeof cache->half_box);
    while (exact ? !collect_exact(&list, &beads, &body,
                                  horizon + margin + 1e-6 * radius, cache)
                 : !collect(&list, &beads, radius + horizon, margin, cache))
    {
        /* the answer is that of the smallest, whichever was the first */
        if (margin <= narrowest * radius)
        {
            return ELLIPSOID_TOO_MANY_FACETS;
        }
        margin = fmax(margin * smaller, narrowest * radius);
    }
    cache->margin = margin;
    cache->listed = list.count;
    cache->valid = 1;
    return ELLIPSOID_OK;
}

ellipsoid_status
ellipsoid_facet_cache_update(ellipsoid_facet_cache *cache,
                          const ellipsoid_model *model,
                          const ellipsoid_surroundings *surroundings,
                          const double x[3], const double q[4], double horizon,
                          double *moved)
{
    if (serves(cache, model, x, q, moved))
    {
        cache->served += cache->served < INT_MAX;
        return ELLIPSOID_OK;
    }
    *moved = 0;
    return fill(cache, model, surroundings, x, q, horizon);
}
