/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    facetCache.c - facets near a cell, kept while it moves little.

    The cache holds, for the pose at which it was filled, for each bead every
    facet that it may be in contact with, within the horizon, while no bead has
    moved farther than the margin (facetSearch.c). Facets without a contact add
    nothing, and the others come in their own order, so a result does not
    depend, not by a bit, on the pose at which the cache was filled.
*/
#include "walls/walls.h"

#include <limits.h>
#include <math.h>
#include <string.h>

/*
    How far a bead may move before facets are searched again, in bead radii: a
    compromise between few facets in the lists and few searches. It begins with
    the first and is adapted to the cell's motion: doubled if a search was used
    for few poses for each facet searched, halved if for many.
*/
static const double first_margin = 0.5, widest = 1, narrowest = 1.0 / 32;
static const double seldom = 0.06, often = 0.4; /* uses for each facet listed */

/* Where facets are too many: smaller margins, each by this factor, down to the
   narrowest. */
static const double smaller = 0.5;

/* Clears what is kept of beads. */
static void invalidate(ellipsoid_facet_cache *cache)
{
    cache->valid = 0;
    cache->uses = 0;
    cache->margin = 0;
    cache->clearance = 0;
    cache->facets = NULL;
    memset(cache->x, 0, sizeof cache->x);
    memset(cache->q, 0, sizeof cache->q);
}

void ellipsoid_facet_cache_clear(ellipsoid_facet_cache *cache)
{
    invalidate(cache);
    cache->near_count = cache->live_count[0] = -1;
    cache->near_facets = NULL;
    memset(cache->near_x, 0, sizeof cache->near_x);
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

/* Does the cache hold all facets that matter in this pose? */
static int is_current(const ellipsoid_facet_cache *cache,
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
        /* R(q) stretches by q.q, which is near 1 but need not be 1 */
        const double longer =
            ellipsoid_square4(q) - ellipsoid_square4(cache->q);
        /* false with NaN */
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

static double next_margin(const ellipsoid_facet_cache *cache, double radius)
{
    if (!cache->valid || cache->clearance > 0)
    {
        return first_margin * radius;
    }

    const double per_facet = (double)cache->uses / (cache->listed + 64);

    return per_facet < seldom ? fmin(2 * cache->margin, widest * radius)
           : per_facet > often ? fmax(cache->margin / 2, narrowest * radius)
                              : cache->margin;
}

static ellipsoid_status fill(ellipsoid_facet_cache *cache,
                             const ellipsoid_model *model,
                             const ellipsoid_surroundings *surroundings,
                             const double x[3], const double q[4],
                             double horizon)
{
    const double radius = model->options.bead_radius;
    double margin = next_margin(cache, radius);
    ellipsoid_facet_list list;
    ellipsoid_status status;

    invalidate(cache);
    if (!isfinite(x[0] + x[1] + x[2] + ellipsoid_square4(q)))
    {
        return ELLIPSOID_NON_FINITE;
    }

    /* what can matter in this pose lies within */
    const double reach =
        (model->reach - radius) * ellipsoid_square4(q) + radius + horizon;

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
        /* Far from all walls. If they do not say how far, one search of twice
           the reach saves many later ones; it may fail where the first did
           not. */
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

    while (!ellipsoid_facet_search(model, &list, horizon, margin, cache))
    {
        /* it fails at the smallest margin only, whichever was the first */
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
    if (is_current(cache, model, x, q, moved))
    {
        cache->uses += cache->uses < INT_MAX;
        return ELLIPSOID_OK;
    }
    *moved = 0;
    return fill(cache, model, surroundings, x, q, horizon);
}
