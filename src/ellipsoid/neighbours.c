/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    neighbours.c - which facets the beads of a cell may meet.

    The cache holds, for the pose at which it was filled, every pair of a bead
    and a facet that can meet within the horizon while no bead has moved farther
    than the margin. Pairs that do not meet add nothing, and pairs are summed in
    their own order, so a result does not depend, not by a bit, on the pose at
    which they were collected.
*/
#include "ellipsoidInternal.h"

#include <math.h>
#include <string.h>

/* How far a bead may move before pairs are collected again, in bead radii:
   few pairs to look at against few collections. */
static const double pair_margin = 0.5;

/* Where pairs are too many: smaller margins, each by this factor. */
static const double smaller = 0.25;
#define ATTEMPTS 3

void ellipsoid_contact_cache_clear(ellipsoid_contact_cache *cache)
{
    cache->valid = 0;
    cache->pair_count = 0;
    cache->margin = 0;
    cache->clearance = 0;
    cache->facets = NULL;
    memset(cache->x, 0, sizeof cache->x);
    memset(cache->q, 0, sizeof cache->q);
}

static double product(const double p[4], const double q[4])
{
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3];
}

/*
    How far the turn from p to q can move a point at unit distance: with d the
    shorter of q - p and q + p, q r q* - p r p* = d r q* + p r d*, whence
    |d| (|p| + |q|). For unit quaternions and small turns this is the chord.
*/
static double turn_between(const double p[4], const double q[4])
{
    const double sign = product(p, q) < 0 ? -1 : 1;
    double dd = 0;

    for (int i = 0; i < 4; i++)
    {
        const double d = q[i] - sign * p[i];

        dd += d * d;
    }
    return sqrt(dd) * (sqrt(product(p, p)) + sqrt(product(q, q)));
}

static int serves(const ellipsoid_contact_cache *cache,
                  const ellipsoid_model *model, const double x[3],
                  const double q[4])
{
    double d[3];

    if (!cache->valid)
    {
        return 0;
    }
    ellipsoid_difference(x, cache->x, d);

    const double moved = ellipsoid_dot(d, d);
    const double arm = model->reach - model->options.bead_radius;

    if (cache->clearance > 0)
    {
        /* R(q) stretches by q.q, which is near 1 but not bound to be */
        const double longer = product(q, q) - product(cache->q, cache->q);
        const double left = cache->clearance - arm * (longer > 0 ? longer : 0);

        return left > 0 && moved < left * left;
    }
    return sqrt(moved) + arm * turn_between(cache->q, q) <= cache->margin;
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

        ellipsoid_difference(centre, facet->vertex[0], d);

        /* outside its plane and a sphere about vertex 0 which holds it */
        const double height = fabs(ellipsoid_dot(d, facet->normal));
        double sides[2][3];

        ellipsoid_difference(facet->vertex[1], facet->vertex[0], sides[0]);
        ellipsoid_difference(facet->vertex[2], facet->vertex[0], sides[1]);

        const double first = ellipsoid_dot(sides[0], sides[0]);
        const double second = ellipsoid_dot(sides[1], sides[1]);

        if (!isfinite(height + first + second))
        {
            return NAN;
        }
        if (height < nearest)
        {
            const double outside = sqrt(ellipsoid_dot(d, d))
                                 - sqrt(first > second ? first : second);

            nearest = fmin(nearest, fmax(height, outside));
        }
    }
    return nearest;
}

static ellipsoid_status list_facets(const ellipsoid_surroundings *surroundings,
                                    const double centre[3], double reach,
                                    ellipsoid_facet_list *list)
{
    const int answer = surroundings->walls(surroundings->walls_context, centre,
                                           reach, list);

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

/* Middle of a facet, and the radius of the sphere about it that holds it. */
static double bound(const ellipsoid_facet *facet, double middle[3])
{
    double size = 0;

    for (int i = 0; i < 3; i++)
    {
        middle[i] = (facet->vertex[0][i] + facet->vertex[1][i]
                     + facet->vertex[2][i]) / 3;
    }
    for (int k = 0; k < 3; k++)
    {
        double d[3];

        ellipsoid_difference(facet->vertex[k], middle, d);
        size = fmax(size, ellipsoid_dot(d, d));
    }
    return sqrt(size);
}

/* Is a point farther than `far` from the box that holds the beads? Spares most
   facets the look at every bead. */
static int beyond_box(const swarm *beads, const double point[3], double far)
{
    const double squared = beads->stretch * beads->stretch;
    double d[3], sum = 0;

    ellipsoid_difference(point, beads->centre, d);
    for (int i = 0; i < 3; i++)
    {
        const double along = beads->rotation[0][i] * d[0]
                           + beads->rotation[1][i] * d[1]
                           + beads->rotation[2][i] * d[2];
        const double out = fmax(fabs(along) / squared - beads->half_box[i], 0);

        sum += out * out;
    }
    return squared * sum > far * far;
}

/* Fills the pairs; their number, or -1 if they are too many. */
static int collect_pairs(const ellipsoid_facet_list *list, const swarm *beads,
                         double reach, double margin,
                         ellipsoid_contact_cache *cache)
{
    int found[ELLIPSOID_MAX_PAIRS][2], start[ELLIPSOID_MAX_BEADS + 1] = {0};
    int n = 0;

    for (int k = 0; k < list->count; k++)
    {
        const ellipsoid_facet *facet = &list->facets[list->index[k]];
        double middle[3];
        const double size = bound(facet, middle);
        const double far = 1.000001 * (reach + margin) + size;

        if (beyond_box(beads, middle, far))
        {
            continue;
        }
        for (int b = 0; b < beads->count; b++)
        {
            const double centre[3] = {beads->x[0][b], beads->x[1][b],
                                      beads->x[2][b]};
            double d[3];

            ellipsoid_difference(centre, middle, d);
            if (ellipsoid_dot(d, d) > far * far
                || !ellipsoid_facet_concerns(facet, centre, reach, margin))
            {
                continue;
            }
            if (n == ELLIPSOID_MAX_PAIRS)
            {
                return -1;
            }
            found[n][0] = b;
            found[n][1] = list->index[k];
            n++;
            start[b + 1]++;
        }
    }

    /* from ascending by facet to ascending by bead, then facet */
    for (int b = 0; b < beads->count; b++)
    {
        start[b + 1] += start[b];
    }
    for (int k = 0; k < n; k++)
    {
        const int place = start[found[k][0]]++;

        cache->pair[place].bead = found[k][0];
        cache->pair[place].facet = found[k][1];
    }
    return n;
}

static ellipsoid_status fill(ellipsoid_contact_cache *cache,
                             const ellipsoid_model *model,
                             const ellipsoid_surroundings *surroundings,
                             const double x[3], const double q[4],
                             double horizon)
{
    const double radius = model->options.bead_radius;
    double margin = pair_margin * radius;
    ellipsoid_facet_list list;
    ellipsoid_status status;
    swarm beads;

    ellipsoid_contact_cache_clear(cache);
    if (!isfinite(x[0] + x[1] + x[2] + q[0] + q[1] + q[2] + q[3]))
    {
        return ELLIPSOID_NON_FINITE;
    }

    /* what can matter in this pose lies within */
    const double reach =
        (model->reach - radius) * product(q, q) + radius + horizon;

    status = list_facets(surroundings, x, reach + margin, &list);
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
            && list_facets(surroundings, x, 2 * reach, &list) == ELLIPSOID_OK)
        {
            nearest = fmax(nearest, nearest_facet(&list, x));
        }
        cache->clearance = nearest - reach;
        cache->valid = 1;
        return ELLIPSOID_OK;
    }

    place_beads(model, x, q, &beads);
    for (int i = 0; i < ATTEMPTS; i++, margin *= smaller)
    {
        const int pairs = collect_pairs(&list, &beads, radius + horizon,
                                        margin, cache);

        if (pairs >= 0)
        {
            cache->pair_count = pairs;
            cache->margin = margin;
            cache->valid = 1;
            return ELLIPSOID_OK;
        }
    }
    return ELLIPSOID_TOO_MANY_FACETS;
}

ellipsoid_status
ellipsoid_contact_collect(ellipsoid_contact_cache *cache,
                          const ellipsoid_model *model,
                          const ellipsoid_surroundings *surroundings,
                          const double x[3], const double q[4], double horizon)
{
    return serves(cache, model, x, q)
               ? ELLIPSOID_OK
               : fill(cache, model, surroundings, x, q, horizon);
}
