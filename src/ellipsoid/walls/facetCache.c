/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    facetCache.c - facets near a cell, kept while it moves little.

    The cache holds, for the pose at which it was filled, for each bead every
    facet that it may be in contact with, within the horizon, while no bead has
    moved farther than the margin (facetSearch.c); where there is none, the
    margin is how far the beads may move until there is one. Facets without a
    contact add nothing, and the others come in their own order, so a result does
    not depend, not by a bit, on the pose at which the cache was filled.
*/
#include "walls/walls.h"

#include <limits.h>
#include <stddef.h>
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

/* Where beads rest that have moved farther than this [bead radii], a search
   from there saves looking at many facets in each use. */
static const double rest = 0.125;

/* How much farther than asked for facets are listed for searches to come, in
   bead radii. */
static const double about = 8;

/* Where facets are too many: smaller margins, each by this factor, down to the
   narrowest. */
static const double smaller = 0.5;

/* How far the centre may move before the near ones are listed again, in ranges:
   the less where there are too many, or walls are refused far off. */
static const double near_margins[] = {0.6, 0.1};

/* Clears what is kept of beads. */
static void invalidate(ellipsoid_facet_cache *cache)
{
    cache->valid = 0;
    cache->uses = 0;
    cache->bead_count = 0;
    cache->margin = 0;
    cache->clearance = 0;
    cache->facets = NULL;
    memset(cache->x, 0, sizeof cache->x);
    memset(cache->q, 0, sizeof cache->q);
}

size_t ellipsoid_facet_cache_size(const ellipsoid_model *model)
{
    return model->wall_range == 0 ? offsetof(ellipsoid_facet_cache, near_facet)
                                  : sizeof(ellipsoid_facet_cache);
}

void ellipsoid_facet_cache_clear(ellipsoid_facet_cache *cache)
{
    invalidate(cache);
    cache->near_count = -1;
    cache->about_count = -1;
    cache->about_nearest = 0;
    cache->half_box[0] = -1; /* not known */
    cache->near_facets = NULL;
    memset(cache->near_x, 0, sizeof cache->near_x);
}

/* How far any bead can have moved since the cache was filled, at most: a bead b
   of the box that holds them has moved by d + Rb, R the change of rotation. */
static double farthest_move(const ellipsoid_facet_cache *cache,
                            const double x[3], const double q[4])
{
    const double *half = cache->half_box;
    ellipsoid_pose_change change;
    double r[3][3], squared;

    ellipsoid_rotation_inline(q, r);
    ellipsoid_pose_change_set(cache, x, r, &change);
    squared = ellipsoid_dot(change.x, change.x);
    for (int i = 0; i < 3; i++)
    {
        const double turn = fabs(change.r[i][0]) * half[0]
                          + fabs(change.r[i][1]) * half[1]
                          + fabs(change.r[i][2]) * half[2];
        const double along = change.x[0] * change.r[0][i]
                           + change.x[1] * change.r[1][i]
                           + change.x[2] * change.r[2][i];

        squared += turn * turn + 2 * fabs(along) * half[i];
    }
    return sqrt(squared) * (1 + 1e-12); /* rounded up */
}

static double uses_per_facet(const ellipsoid_facet_cache *cache)
{
    return (double)cache->uses / (cache->listed + 64);
}

/* Does the cache hold all facets that matter in this pose, and not too many? */
static int is_current(const ellipsoid_facet_cache *cache,
                      const ellipsoid_model *model, const double x[3],
                      const double q[4], double *moved)
{
    if (!cache->valid)
    {
        return 0;
    }
    if (cache->clearance > 0)
    {
        const double arm = model->reach - model->options.bead_radius;
        double d[3];

        ellipsoid_difference(x, cache->x, d);

        /* R(q) stretches by q.q, which is near 1 but need not be 1 */
        const double longer =
            ellipsoid_square4(q) - ellipsoid_square4(cache->q);
        /* false with NaN */
        const double left = cache->clearance - arm * (longer <= 0 ? 0 : longer);

        return left > 0 && ellipsoid_dot(d, d) < left * left;
    }
    *moved = farthest_move(cache, x, q);
    return *moved <= cache->margin
        && (cache->bead_count == 0
            || *moved <= rest * model->options.bead_radius
            || uses_per_facet(cache) <= often);
}

/* 0 if a facet is not finite. */
static int set_planes(const ellipsoid_facet_list *list, const double x[3],
                      ellipsoid_facet_planes *planes)
{
    int finite = 1;

    for (int k = 0; k < list->count; k++)
    {
        const ellipsoid_facet *facet = &list->facets[list->index[k]];
        double d[3], height;

        ellipsoid_difference(facet->middle, x, d);
        height = ellipsoid_dot(d, facet->normal);
        finite &= isfinite(height + ellipsoid_dot(d, d) + facet->radius) != 0;
        if (k >= ELLIPSOID_MAX_LISTED)
        {
            continue;
        }
        for (int i = 0; i < 3; i++)
        {
            planes->middle[i][k] = (float)d[i];
            planes->normal[i][k] = (float)facet->normal[i];
        }
        planes->height[k] = (float)height;
        planes->radius[k] = (float)(facet->radius * (1 + 4e-6));
    }
    return finite;
}

/* The nearest that any facet, listed or not, can be to a point, which is relative
   to where the list was looked up. */
static double nearest_facet(const ellipsoid_facet_planes *planes,
                            const ellipsoid_facet_list *list,
                            const double from[3])
{
    const float x[3] = {(float)from[0], (float)from[1], (float)from[2]};
    const float slack =
        ELLIPSOID_PLANES_ROUNDED * (fabsf(x[0]) + fabsf(x[1]) + fabsf(x[2]));
    float height[ELLIPSOID_MAX_LISTED], squared[ELLIPSOID_MAX_LISTED];
    double nearest = list->reach;

    if (list->count > ELLIPSOID_MAX_LISTED)
    {
        return 0;
    }
    for (int k = 0; k < list->count; k++)
    {
        float over = -planes->height[k], sum = 0;

        for (int i = 0; i < 3; i++)
        {
            const float d = planes->middle[i][k] - x[i];

            over += planes->normal[i][k] * x[i];
            sum += d * d;
        }
        height[k] = fabsf(over);
        squared[k] = sum;
    }
    for (int k = 0; k < list->count; k++)
    {
        const double far = nearest + planes->radius[k];

        /* outside its plane and its ball */
        if (height[k] < nearest && squared[k] < far * far)
        {
            nearest = fmax(height[k], sqrt(squared[k]) - planes->radius[k]);
        }
    }
    return (1 - ELLIPSOID_PLANES_ROUNDED) * nearest - slack;
}

ellipsoid_status
ellipsoid_list_facets(const ellipsoid_surroundings *surroundings,
                      const double centre[3], double reach,
                      ellipsoid_facet_list *list)
{
    const int answer = surroundings->walls(
        surroundings->walls_context, surroundings->time, centre, reach, list);

    return answer > 0 ? ELLIPSOID_STEP_UNDERFLOW
         : answer < 0 ? ELLIPSOID_WALLS_FAILED
                      : ELLIPSOID_OK;
}

/*
    Lists the facets within reach, and more, for the searches that follow.
    Walls that do not answer for more, or list too many, are asked for no more.
*/
static ellipsoid_status list_about(ellipsoid_facet_cache *cache,
                                   const ellipsoid_surroundings *surroundings,
                                   const double x[3], double reach, double more,
                                   ellipsoid_facet_list *list)
{
    if (cache->about_count >= 0)
    {
        double d[3];

        ellipsoid_difference(x, cache->about_x, d);
        list->reach = cache->about_reach - (1 + 1e-12) * ellipsoid_length(d);
        if (list->reach >= reach)
        {
            list->facets = cache->about_facets;
            list->index = cache->about;
            list->count = cache->about_count;
            return ELLIPSOID_OK;
        }
    }
    cache->about_count = -1;
    if (ellipsoid_list_facets(surroundings, x, reach + more, list)
            != ELLIPSOID_OK
        || list->count > ELLIPSOID_MAX_LISTED)
    {
        const ellipsoid_status status =
            ellipsoid_list_facets(surroundings, x, reach, list);

        if (status != ELLIPSOID_OK)
        {
            return status;
        }
    }
    ellipsoid_copy(x, cache->about_x);
    if (!set_planes(list, x, &cache->planes))
    {
        return ELLIPSOID_NON_FINITE;
    }
    if (list->count <= ELLIPSOID_MAX_LISTED)
    {
        cache->about_count = list->count;
        cache->about_reach = list->reach;
        cache->about_facets = list->facets;
        if (list->count > 0)
        {
            memcpy(cache->about, list->index,
                   list->count * sizeof *list->index);
        }
    }
    return ELLIPSOID_OK;
}

static double next_margin(const ellipsoid_facet_cache *cache, double radius)
{
    if (!cache->valid || cache->clearance > 0)
    {
        return first_margin * radius;
    }
    if (cache->margin > widest * radius)
    {
        return widest * radius;
    }

    const double per_facet = uses_per_facet(cache);

    return per_facet < seldom ? fmin(2 * cache->margin, widest * radius)
         : per_facet > often  ? fmax(cache->margin / 2, narrowest * radius)
                              : cache->margin;
}

/* Are the listed facets, and all others, so far from the beads that none
   matters while they move by more than the margin? Then that is how far they
   may. reach: as in fill() */
static int keep_free(ellipsoid_facet_cache *cache, const ellipsoid_model *model,
                     const ellipsoid_facet_list *list,
                     const ellipsoid_facet_bounds *bounds, double reach,
                     double horizon, double margin)
{
    const double near = model->options.bead_radius + horizon;

    if (model->options.contact_shape == ELLIPSOID_CONTACT_ELLIPSOID)
    {
        return 0;
    }

    /* an unlisted one is beyond list->reach of the centre */
    const double taken = (1 + 1e-6) * near;
    const double least = taken + margin;
    const double bound = ellipsoid_facet_bound(
        list, bounds, list->reach - reach + near, least, cache);

    /* the search ends early by the same comparison */
    if (!(bound > least))
    {
        return 0;
    }
    cache->margin = bound - taken;
    cache->bead_count = 0;
    cache->nearest_of_all = HUGE_VAL;
    cache->valid = 1;
    return 1;
}

static ellipsoid_status fill(ellipsoid_facet_cache *cache,
                             const ellipsoid_model *model,
                             const ellipsoid_surroundings *surroundings,
                             const double x[3], const double q[4],
                             double horizon)
{
    const double radius = model->options.bead_radius;
    double margin = next_margin(cache, radius), from[3], nearest;
    ellipsoid_facet_bounds bounds;
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
    const double more = fmax(about * radius, reach);

    status = list_about(cache, surroundings, x, reach + margin, more, &list);
    if (status != ELLIPSOID_OK)
    {
        return status;
    }
    ellipsoid_copy(x, cache->x);
    memcpy(cache->q, q, sizeof cache->q);
    cache->facets = list.facets;

    ellipsoid_difference(x, cache->about_x, from);
    nearest = nearest_facet(&cache->planes, &list, from);
    if (nearest - reach >= 0.5 * margin)
    {
        /* Far from all walls. Where the list ends, one from here saves many
           searches; it may fail where the first did not. */
        if (nearest > 0.99 * list.reach && list.reach < reach + more)
        {
            cache->about_count = -1;
            if (list_about(cache, surroundings, x, reach + margin, more, &list)
                == ELLIPSOID_OK)
            {
                ellipsoid_set(from, 0, 0, 0);
                nearest =
                    fmax(nearest, nearest_facet(&cache->planes, &list, from));
            }
        }
        cache->clearance = nearest - reach;
        cache->valid = 1;
        return ELLIPSOID_OK;
    }

    ellipsoid_facet_bounds_set(model, &list, cache, &bounds);
    if (keep_free(cache, model, &list, &bounds, reach, horizon, margin))
    {
        return ELLIPSOID_OK;
    }
    while (
        !ellipsoid_facet_search(model, &list, &bounds, horizon, margin, cache))
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

ellipsoid_status ellipsoid_facet_cache_update(
    ellipsoid_facet_cache *cache, const ellipsoid_model *model,
    const ellipsoid_surroundings *surroundings, const double x[3],
    const double q[4], double horizon, double *moved)
{
    if (is_current(cache, model, x, q, moved))
    {
        cache->uses += cache->uses < INT_MAX;
        return ELLIPSOID_OK;
    }
    *moved = 0;
    return fill(cache, model, surroundings, x, q, horizon);
}

ellipsoid_status
ellipsoid_near_facets(const ellipsoid_surroundings *surroundings,
                      const double x[3], double range, double reach,
                      ellipsoid_facet_cache *cache)
{
    const int tries = sizeof(near_margins) / sizeof(*near_margins);
    ellipsoid_status status = ELLIPSOID_OK;
    double d[3];

    ellipsoid_difference(x, cache->near_x, d);
    if (cache->near_count >= 0
        && ellipsoid_dot(d, d) <= cache->near_margin * cache->near_margin)
    {
        return ELLIPSOID_OK;
    }
    for (int k = 0; k < tries; k++)
    {
        const double margin = near_margins[k] * range;
        ellipsoid_facet_list list;

        cache->near_count = -1;
        status = ellipsoid_list_facets(surroundings, x, reach + margin, &list);
        if (status == ELLIPSOID_STEP_UNDERFLOW)
        {
            continue;
        }
        if (status != ELLIPSOID_OK)
        {
            return status;
        }
        cache->near_facets = list.facets;
        ellipsoid_copy(x, cache->near_x);
        cache->near_count = 0;
        for (int i = 0; i < list.count; i++)
        {
            const ellipsoid_facet *facet = &list.facets[list.index[i]];
            const double *normal,
                height = ellipsoid_height_over(facet, x, &normal);

            if (facet->mirror || !(height > -margin && height < range + margin))
            {
                continue;
            }
            if (cache->near_count == ELLIPSOID_MAX_NEAR)
            {
                status = ELLIPSOID_TOO_MANY_FACETS;
                break;
            }
            cache->near_facet[cache->near_count++] = list.index[i];
        }
        if (status == ELLIPSOID_OK)
        {
            cache->near_margin = list.count == 0 && list.reach > reach + margin
                                   ? list.reach - reach
                                   : margin;
            return ELLIPSOID_OK;
        }
    }
    cache->near_count = -1;
    return status;
}
