/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    nearFacets.c - which facets the planes near a cell may come from.

    Two lists, the first for a long way of the centre, the second, of the first,
    for a small change of the pose. What they hold never changes a result.
*/
#include "drag/wallResistance.h"

/* How far the centre may move before facets are listed again, in ranges; the
   less where there are too many. */
static const double margin_parts[] = {0.4, 0.1};

/* The same of those that count near a pose, and how far the body may turn: the
   Frobenius norm of the difference of its axes, which moves a unit vector by no
   more than that over the root of two. Facets are listed apart that count
   within parts of both. */
static const double live_part = 0.04, live_turn = 0.08;
static const double live_levels[ELLIPSOID_LIVE_LEVELS] = {0.1, 0.25, 0.5, 1};

/*
    Could this facet be met while the centre moves by up to the margin? A point
    within a face lies in a direction from the centre that makes no larger angle
    with the normal than tangents of the body allow: cos >= 2 a b/(a^2 + b^2)
    with the largest and the smallest semi-axis. Beside the face, over a concave
    edge, it has faded over `fading` times the height, b/a times as long along
    the body. Over a convex edge it is on the facet's rim, which has to be in
    range.
*/
static int may_matter(const ellipsoid_facet *facet, const double x[3],
                      double range, double reach, double margin,
                      double slimness)
{
    const double cosine = 2 * slimness / (1 + slimness * slimness);
    double d[3], height, nearest, beside;

    ellipsoid_difference(x, facet->middle, d);
    height = ellipsoid_dot(d, facet->normal);
    beside = ellipsoid_facet_is_extended(facet)
               ? ellipsoid_fading * slimness * (height + margin)
               : ellipsoid_lap * (height + margin);
    nearest = ellipsoid_length(d) - facet->radius;
    if (!(height > -margin && height < range + margin && nearest < reach))
    {
        return 0;
    }
    if (cosine * (nearest - margin - beside) <= height + margin)
    {
        return 1;
    }
    return ellipsoid_facet_has_convex_edge(facet)
        && ellipsoid_squared_rim_distance(facet, x)
               < (range + margin) * (range + margin) * (1 + 1e-6);
}

/* Lists facets within a margin of what is in range. */
static ellipsoid_status list_near(const ellipsoid_surroundings *surroundings,
                                  const double x[3], double range,
                                  double margin, double slimness,
                                  ellipsoid_facet_cache *cache)
{
    /* a plane's point is up to so far beside its facet, not square to the way
       to it where the body is not a sphere */
    const double wide = range * (1 + ellipsoid_fading * slimness);
    ellipsoid_facet_list list;
    const ellipsoid_status status =
        ellipsoid_list_facets(surroundings, x, wide + margin, &list);

    if (status != ELLIPSOID_OK)
    {
        return status;
    }
    cache->near_facets = list.facets;
    ellipsoid_copy(x, cache->near_x);

    int count = 0;

    for (int k = 0; k < list.count; k++)
    {
        const ellipsoid_facet *facet = &list.facets[list.index[k]];

        if (facet->mirror
            || !may_matter(facet, x, range, wide + margin, margin, slimness))
        {
            continue;
        }
        if (count == ELLIPSOID_MAX_NEAR)
        {
            return ELLIPSOID_TOO_MANY_FACETS;
        }
        cache->near_facet[count++] = list.index[k];
    }
    cache->near_count = count;
    cache->near_margin = list.count == 0 && list.reach > wide + margin
                           ? list.reach - wide
                           : margin;
    return ELLIPSOID_OK;
}

/* Where walls are refused far off, or too many, those nearer may do. */
ellipsoid_status
ellipsoid_collect_near(const ellipsoid_surroundings *surroundings,
                       const double x[3], double range, double slimness,
                       ellipsoid_facet_cache *cache)
{
    const int count = sizeof(margin_parts) / sizeof(*margin_parts);
    ellipsoid_status status = ELLIPSOID_OK;
    double d[3];

    ellipsoid_difference(x, cache->near_x, d);
    if (cache->near_count >= 0
        && ellipsoid_dot(d, d) <= cache->near_margin * cache->near_margin)
    {
        return ELLIPSOID_OK;
    }
    cache->near_count = cache->live_count[0] = cache->met_count = -1;
    for (int k = 0; k < count; k++)
    {
        status = list_near(surroundings, x, range, margin_parts[k] * range,
                           slimness, cache);
        if (status != ELLIPSOID_STEP_UNDERFLOW
            && status != ELLIPSOID_TOO_MANY_FACETS)
        {
            break;
        }
    }
    return status;
}

/* For what idle_part() asks: a move and a turn, a range a little wider than
   that of walls, what follows from these, and of the normal of the last
   facet. */
typedef struct idle_limits
{
    double shift, per_shift, turn, range;
    ellipsoid_wall_view view;
    double extended; /* beside an extended facet, by the height */
    double turned;   /* how far the foot goes by the turn, by the height */
} idle_limits;

/* As fmax(), which is a call of the library. */
static inline double larger(double a, double b)
{
    return a > b ? a : b;
}

static inline double smaller(double a, double b)
{
    return a < b ? a : b;
}

static void look_along(const ellipsoid_wall_search *s, const double normal[3],
                       idle_limits *limits)
{
    double left, slimness;

    ellipsoid_look_along(s, normal, &limits->view);
    left = larger(s->shortest, limits->view.support - s->longest * limits->turn);
    slimness = s->longest / left;
    limits->extended = ellipsoid_fading * slimness;
    limits->turned = limits->turn * (slimness * slimness + limits->view.far);
}

/* The same as idle_part() for the facet's rim: the foot, which goes by up to
   `slip`, has to lie beyond a convex edge, and the rim in range. */
static double rim_part(const ellipsoid_wall_search *s,
                       const ellipsoid_facet *facet, const double foot[3],
                       double slip, const idle_limits *limits)
{
    double least = HUGE_VAL, part;

    for (int k = 0; k < 3; k++)
    {
        if (facet->edge[k] == ELLIPSOID_EDGE_CONVEX)
        {
            double along[3];
            const double out = ellipsoid_beyond(facet, foot, k, along);

            least = smaller(least, -out / ellipsoid_length(along));
        }
    }
    part = least / slip;
    if (part >= 1)
    {
        return part;
    }
    return larger(part, (sqrt(ellipsoid_squared_rim_distance(facet, s->x))
                         - limits->range)
                            * limits->per_shift);
}

/*
    Within which part of a move of the centre by `shift` and a turn of the axes
    by `turn` can ellipsoid_find_feature() find no plane on this facet? But for
    its rim the foot x - r h has to lie near the facet, r = D n/(n.D n)
    and h the height. By n in the body frame r changes by D^(1/2) (I - 2 m m)
    D^(1/2) / (n.D n), m = D^(1/2) n/p a unit vector: by no more than a^2/p^2
    with the largest semi-axis a, and the support p by no more than a. What the
    foot may do is a convex function of the part.
*/
static double idle_part(const ellipsoid_wall_search *s,
                        const ellipsoid_facet *facet, idle_limits *limits)
{
    const ellipsoid_wall_view *view = &limits->view;
    const double *n = facet->normal, shift = limits->shift;
    double d[3], aside[3], foot[3], height, part, off, slip, beside;

    ellipsoid_difference(s->x, facet->middle, d);
    height = ellipsoid_dot(d, n);
    part = larger(-height, height - s->range) * limits->per_shift;
    if (part >= 1)
    {
        return part;
    }
    if (view->along[0] != n[0] || view->along[1] != n[1]
        || view->along[2] != n[2])
    {
        look_along(s, n, limits);
    }
    beside = ellipsoid_facet_is_extended(facet) ? limits->extended
                                                : ellipsoid_lap;
    for (int i = 0; i < 3; i++)
    {
        aside[i] = d[i] - view->way[i] * height;
        foot[i] = s->x[i] - view->way[i] * height;
    }
    height = fabs(height);
    slip = shift * (1 + view->far) + (height + shift) * limits->turned;
    off = (ellipsoid_length(aside) - facet->radius - beside * height)
        / (slip + shift * beside);
    if (off > 0 && ellipsoid_facet_has_convex_edge(facet))
    {
        off = smaller(off, rim_part(s, facet, foot, slip, limits));
    }
    return larger(part, off);
}

int ellipsoid_look_closer(const ellipsoid_wall_search *s,
                          ellipsoid_facet_cache *cache)
{
    /* far more than rounding on either side */
    const double shift = live_part * s->range, wide = 1 + 1e-6;
    idle_limits limits = {
        .shift = wide * shift,
        .per_shift = 1 / (wide * shift),
        .turn = wide * live_turn * 0.70710678118654752,
        .range = wide * s->range};
    double moved = 0, turned = 0, change;

    for (int i = 0; i < 3; i++)
    {
        const double d = s->x[i] - cache->live_x[i];

        moved += d * d;
        for (int l = 0; l < 3; l++)
        {
            const double e = s->axis[i][l] - cache->live_axis[i][l];

            turned += e * e;
        }
    }
    change = sqrt(fmax(moved / (shift * shift),
                       turned / (live_turn * live_turn)));
    if (cache->live_count[0] >= 0 && change <= 1)
    {
        int level = 0;

        while (change > live_levels[level])
        {
            level++;
        }
        return level;
    }
    ellipsoid_copy(s->x, cache->live_x);
    memcpy(cache->live_axis, s->axis, sizeof cache->live_axis);
    memset(cache->live_count, 0, sizeof cache->live_count);
    for (int k = 0; k < cache->near_count; k++)
    {
        const double part =
            idle_part(s, &cache->near_facets[cache->near_facet[k]], &limits);

        for (int l = ELLIPSOID_LIVE_LEVELS - 1;
             l >= 0 && !(part > live_levels[l]); l--)
        {
            cache->live[l][cache->live_count[l]++] = (short)k;
        }
    }
    return 0;
}
