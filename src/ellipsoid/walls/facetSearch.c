/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
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
    float from[3][ELLIPSOID_MAX_BEADS]; /* [-] the centre, by the reach */
    double reach;                       /* [m] none is farther from it */
    double centre[3], rotation[3][3], half_box[3];
    double stretch; /* q.q, the factor of lengths in R(q) */
} bead_set;

/* The box, which is kept in the cache, in its pose. */
static void set_box(const ellipsoid_model *model, ellipsoid_facet_cache *cache,
                    bead_set *beads)
{
    ellipsoid_copy(cache->x, beads->centre);
    ellipsoid_rotation_inline(cache->q, beads->rotation);
    beads->stretch = ellipsoid_square4(cache->q);
    if (!(cache->half_box[0] >= 0))
    {
        ellipsoid_set(cache->half_box, 0, 0, 0);
        for (int b = 0; b < model->bead_count; b++)
        {
            for (int i = 0; i < 3; i++)
            {
                cache->half_box[i] =
                    fmax(cache->half_box[i], fabs(model->bead[b][i]));
            }
        }
    }
    ellipsoid_copy(cache->half_box, beads->half_box);
    memcpy(cache->rotation, beads->rotation, sizeof cache->rotation);
}

static void set_beads(const ellipsoid_model *model, bead_set *beads)
{
    beads->count = model->bead_count;
    beads->reach = model->reach * beads->stretch;

    const double per_reach = 1 / beads->reach;

    for (int b = 0; b < model->bead_count; b++)
    {
        for (int i = 0; i < 3; i++)
        {
            const double from =
                ellipsoid_dot(beads->rotation[i], model->bead[b]);

            beads->x[i][b] = beads->centre[i] + from;
            beads->from[i][b] = (float)(from * per_reach);
        }
    }
}

/* The square of how far a point is from the box that holds the beads, or less.
   Where squares of the stretch leave the range of numbers, the distance is that
   from its centre, or zero. */
static inline double squared_from_box(const bead_set *beads, const double d[3])
{
    const double squared = beads->stretch * beads->stretch;
    double sum = 0;

    if (!(squared > 1e-200 && squared < 1e200))
    {
        return beads->stretch < 1 ? ellipsoid_dot(d, d) : 0;
    }
    for (int i = 0; i < 3; i++)
    {
        const double along = beads->rotation[0][i] * d[0]
                           + beads->rotation[1][i] * d[1]
                           + beads->rotation[2][i] * d[2];
        const double out = fabs(along) - squared * beads->half_box[i];

        sum += out > 0 ? out * out : 0;
    }
    return sum / squared;
}

/* Is a point farther than `far` from it? */
static int beyond_box(const bead_set *beads, const double d[3], double far)
{
    return squared_from_box(beads, d) > far * far;
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

/* How far the plane is from the box, on either side of it; below 0 if it cuts
   the box. */
static inline double above_box(const bead_set *beads, const double normal[3],
                               const double d[3])
{
    double extent = 0;

    for (int i = 0; i < 3; i++)
    {
        extent += beads->half_box[i]
                * fabs(beads->rotation[0][i] * normal[0]
                       + beads->rotation[1][i] * normal[1]
                       + beads->rotation[2][i] * normal[2]);
    }
    return fabs(ellipsoid_dot(d, normal)) - extent;
}

/* How far the box is from the facet at least: from its plane, `above`, and
   beside its outermost edge. d: from the box to the facet's middle. */
static double box_distance(const ellipsoid_facet *facet,
                           const ellipsoid_facet_sides *sides,
                           const bead_set *beads, const double d[3],
                           double above)
{
    const double(*r)[3] = beads->rotation;
    double aside = 0;

    for (int k = 0; k < 3; k++)
    {
        const double *in = sides->inward[k];
        double from[3], out;

        ellipsoid_difference(facet->vertex[k], facet->middle, from);
        ellipsoid_add(from, d);
        out = ellipsoid_dot(in, from);
        for (int i = 0; i < 3; i++)
        {
            out -= beads->half_box[i]
                 * fabs(r[0][i] * in[0] + r[1][i] * in[1] + r[2][i] * in[2]);
        }
        aside = out > aside ? out : aside;
    }
    above = above > 0 ? above : 0;
    return sqrt(above * above + aside * aside);
}

/*
    Excess of the squared distance of beads over the largest at which the facet
    may be nearest: from the facet, that is its height above the plane and how
    far it is beside the outermost edge, and, unless an edge is convex, beside
    the facet's ball. In single precision, of which four go into a register, and
    so much wider that what it rounds off leaves no facet out; lengths by the
    beads' reach. d: from the cell's centre to the facet's middle.
*/
static void set_distances(const ellipsoid_facet *facet,
                          const ellipsoid_facet_sides *sides,
                          const bead_set *beads, const double d[3], double far,
                          double near, float beyond[ELLIPSOID_MAX_BEADS])
{
    const double per_reach = 1 / beads->reach;
    const double size =
        per_reach
        * (fabs(d[0]) + fabs(d[1]) + fabs(d[2]) + facet->radius + beads->reach);
    const double wide = per_reach * far + 2e-6 * size;
    const double side = per_reach * near;
    const float farthest = (float)((1 + 1e-6) * wide * wide);
    const float beside =
        ellipsoid_facet_has_convex_edge(facet)
            ? HUGE_VALF
            : (float)((1 + 1e-6) * side * side + 4e-6 * size * size);
    float n[3], middle[3], in[3][3], offset[3];

    for (int k = 0; k < 3; k++)
    {
        double r[3];

        ellipsoid_difference(facet->middle, facet->vertex[k], r);
        offset[k] = (float)(per_reach * ellipsoid_dot(sides->inward[k], r));
        n[k] = (float)facet->normal[k];
        middle[k] = (float)(per_reach * d[k]);
        for (int i = 0; i < 3; i++)
        {
            in[k][i] = (float)sides->inward[k][i];
        }
    }
    for (int b = 0; b < beads->count; b++)
    {
        const float d0 = beads->from[0][b] - middle[0];
        const float d1 = beads->from[1][b] - middle[1];
        const float d2 = beads->from[2][b] - middle[2];
        const float h = d0 * n[0] + d1 * n[1] + d2 * n[2];
        const float squared = d0 * d0 + d1 * d1 + d2 * d2;

        const float aside = squared - h * h - beside;
        float inside = 0, out;

        for (int k = 0; k < 3; k++)
        {
            const float of =
                offset[k] + in[k][0] * d0 + in[k][1] * d1 + in[k][2] * d2;

            inside = of < inside ? of : inside;
        }
        out = h * h + inside * inside - farthest;
        beyond[b] = out > aside ? out : aside;
    }
}

/* Is the facet farther from all beads than `far` less its radius, as the ball
   that holds these tells? */
static int is_beyond(const ellipsoid_facet *facet, const bead_set *beads,
                     const double d[3], double far)
{
    const double ball = beads->reach + far;

    return fabs(ellipsoid_dot(d, facet->normal)) > ball - facet->radius
        || ellipsoid_dot(d, d) > ball * ball;
}

/* One that a bead may be in contact with. */
typedef struct bead_facet
{
    int bead, facet;
    float away; /* [m] at least */
} bead_facet;

/* From ascending by facet to bead by bead; next: how many each has. */
static void set_lists(const bead_set *beads, const bead_facet *found, int n,
                      int *next, ellipsoid_facet_cache *cache)
{
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
        const int at = next[found[k].bead]++;

        cache->facet[at] = found[k].facet;
        cache->away[at] = found[k].away;
    }
}

/* Fills the lists of all beads; 0 if there are too many facets. */
static int search_beads(const ellipsoid_facet_list *list, const bead_set *beads,
                        double reach, double margin,
                        ellipsoid_facet_cache *cache)
{
    bead_facet found[ELLIPSOID_MAX_PAIRS];
    int next[ELLIPSOID_MAX_BEADS], n = 0;

    for (int b = 0; b < beads->count; b++)
    {
        cache->nearest[b] = HUGE_VAL;
        next[b] = 0;
    }
    for (int k = 0; k < list->count; k++)
    {
        const ellipsoid_facet *facet = &list->facets[list->index[k]];
        double d[3], distance, above;
        float beyond[ELLIPSOID_MAX_BEADS];
        ellipsoid_facet_sides sides;
        const double size = facet->radius;
        const double rounding = 1e-6 * (reach + margin);
        const double far = size + reach + margin + rounding;
        const double near = size + 1.5 * margin + rounding;

        ellipsoid_difference(facet->middle, beads->centre, d);
        if (is_beyond(facet, beads, d, far))
        {
            continue;
        }
        above = above_box(beads, facet->normal, d);
        if (above > far - size || beyond_box(beads, d, far)
            || (!ellipsoid_facet_has_convex_edge(facet)
                && beside_box(beads, facet->normal, d, near)))
        {
            continue;
        }
        ellipsoid_facet_sides_set(facet, &sides);
        if (box_distance(facet, &sides, beads, d, above) > far - size)
        {
            continue;
        }
        set_distances(facet, &sides, beads, d, far - size, near, beyond);
        for (int b = 0; b < beads->count; b++)
        {
            double centre[3];

            if (beyond[b] > 0)
            {
                continue;
            }
            ellipsoid_set(centre, beads->x[0][b], beads->x[1][b],
                          beads->x[2][b]);
            if (!ellipsoid_facet_may_be_nearest(facet, &sides, centre, reach,
                                                margin, &distance))
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
            found[n].bead = b;
            found[n].facet = list->index[k];
            found[n].away = (float)distance * (1 - 1e-6F);
            n++;
            next[b]++;
        }
    }

    set_lists(beads, found, n, next, cache);
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

/* How far the box is from a facet at least, or `most` if that is less; reach:
   of bead centres. */
static double bound_of(const ellipsoid_facet *facet, const bead_set *beads,
                       double reach, double most)
{
    ellipsoid_facet_sides sides;
    double d[3], above, far;

    ellipsoid_difference(facet->middle, beads->centre, d);
    if (fabs(ellipsoid_dot(d, facet->normal)) - reach >= most)
    {
        return most;
    }
    above = above_box(beads, facet->normal, d);
    if (above >= most)
    {
        return most;
    }
    far = sqrt(squared_from_box(beads, d)) - facet->radius;
    if (far < most)
    {
        ellipsoid_facet_sides_set(facet, &sides);
        far = fmax(far, box_distance(facet, &sides, beads, d, above));
    }
    return far < most ? far : most;
}

double ellipsoid_facet_bound(const ellipsoid_model *model,
                             const ellipsoid_facet_list *list, double most,
                             double least, ellipsoid_facet_cache *cache)
{
    double bound = most, arm;
    bead_set beads;
    int first;

    set_box(model, cache, &beads);
    arm = (model->reach - model->options.bead_radius) * beads.stretch;
    first = cache->about_nearest < list->count ? cache->about_nearest : 0;
    for (int n = 0; n < list->count && !(bound <= least); n++)
    {
        const int k = n == 0 ? first : n == first ? 0 : n;
        const double of =
            bound_of(&list->facets[list->index[k]], &beads, arm, bound);

        if (of < bound)
        {
            bound = of;
            cache->about_nearest = k;
        }
    }
    return bound;
}

int ellipsoid_facet_search(const ellipsoid_model *model,
                           const ellipsoid_facet_list *list, double horizon,
                           double margin, ellipsoid_facet_cache *cache)
{
    const double radius = model->options.bead_radius;
    bead_set beads;
    ellipsoid_surface body;

    if (model->options.contact_shape == ELLIPSOID_CONTACT_ELLIPSOID)
    {
        ellipsoid_surface_set(model->options.semi_axes, cache->x, cache->q,
                              &body);
        ellipsoid_copy(body.axes, cache->half_box);
        set_box(model, cache, &beads);
        return search_ellipsoid(list, &beads, &body,
                                horizon + margin + 1e-6 * radius, cache);
    }
    set_box(model, cache, &beads);
    set_beads(model, &beads);
    return search_beads(list, &beads, radius + horizon, margin, cache);
}
