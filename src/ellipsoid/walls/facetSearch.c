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

/* The box in the cache's pose, as the cache keeps it. */
static void take_box(const ellipsoid_facet_cache *cache, bead_set *beads)
{
    ellipsoid_copy(cache->x, beads->centre);
    ellipsoid_copy(cache->half_box, beads->half_box);
    memcpy(beads->rotation, cache->rotation, sizeof cache->rotation);
    beads->stretch = ellipsoid_square4(cache->q);
}

static void set_box(const ellipsoid_model *model, ellipsoid_facet_cache *cache)
{
    ellipsoid_rotation_inline(cache->q, cache->rotation);
    if (model->options.contact_shape == ELLIPSOID_CONTACT_ELLIPSOID)
    {
        ellipsoid_copy(model->options.semi_axes, cache->half_box);
    }
    else if (!(cache->half_box[0] >= 0))
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

void ellipsoid_facet_bounds_set(const ellipsoid_model *model,
                                const ellipsoid_facet_list *list,
                                ellipsoid_facet_cache *cache,
                                ellipsoid_facet_bounds *bounds)
{
    const ellipsoid_facet_planes *planes = &cache->planes;
    const int count =
        list->count < ELLIPSOID_MAX_LISTED ? list->count : ELLIPSOID_MAX_LISTED;
    float x[3], axis[3][3], half[3], size = 0;
    bead_set box;

    set_box(model, cache);
    take_box(cache, &box);
    if (!(box.stretch > 1e-30 && box.stretch < 1e30))
    {
        memset(bounds, 0, sizeof *bounds);
        return;
    }
    for (int i = 0; i < 3; i++)
    {
        x[i] = (float)(cache->x[i] - cache->about_x[i]);
        half[i] = (float)(box.stretch * box.half_box[i]);
        size += fabsf(x[i]) + half[i];
        for (int j = 0; j < 3; j++)
        {
            axis[i][j] = (float)(box.rotation[j][i] / box.stretch);
        }
    }
    bounds->rounding = ELLIPSOID_PLANES_ROUNDED * size;
    for (int k = 0; k < count; k++)
    {
        float over = -planes->height[k], extent = bounds->rounding, sum = 0;
        float d[3], n[3];

        for (int i = 0; i < 3; i++)
        {
            d[i] = planes->middle[i][k] - x[i];
            n[i] = planes->normal[i][k];
            over += n[i] * x[i];
        }
        for (int i = 0; i < 3; i++)
        {
            const float *a = axis[i];
            const float off =
                fabsf(a[0] * d[0] + a[1] * d[1] + a[2] * d[2]) - half[i];
            const float twice = off + fabsf(off); /* 0 inside */

            sum += twice * twice;
            extent += half[i] * fabsf(a[0] * n[0] + a[1] * n[1] + a[2] * n[2]);
        }
        bounds->above[k] =
            (1 - ELLIPSOID_PLANES_ROUNDED) * fabsf(over) - extent;
        bounds->squared[k] = sum;
    }
}

/* Is facet k of the list farther from the box? 0 if that is not known. */
static inline int is_beyond(const ellipsoid_facet_bounds *bounds, int k,
                            const ellipsoid_facet *facet, double far)
{
    const double twice = (2 + 4 * ELLIPSOID_PLANES_ROUNDED)
                       * (far + facet->radius * (1 + ELLIPSOID_PLANES_ROUNDED)
                          + bounds->rounding);

    return k < ELLIPSOID_MAX_LISTED
        && (bounds->above[k] > far || bounds->squared[k] > twice * twice);
}

/* How far the box is from the facet at least: from its plane and beside its
   outermost edge, *aside. d: from the box to the facet's middle. */
static double box_distance(const ellipsoid_facet *facet,
                           const ellipsoid_facet_sides *sides,
                           const bead_set *beads, const double d[3],
                           double *aside)
{
    const double(*r)[3] = beads->rotation;
    double above = fabs(ellipsoid_dot(d, facet->normal)), out[4];

    for (int k = 0; k < 4; k++)
    {
        const double *n = k < 3 ? sides->inward[k] : facet->normal;

        out[k] = 0;
        for (int i = 0; i < 3; i++)
        {
            out[k] -= beads->half_box[i]
                    * fabs(r[0][i] * n[0] + r[1][i] * n[1] + r[2][i] * n[2]);
        }
    }
    *aside = 0;
    for (int k = 0; k < 3; k++)
    {
        double from[3];

        ellipsoid_difference(facet->vertex[k], facet->middle, from);
        ellipsoid_add(from, d);
        out[k] += ellipsoid_dot(sides->inward[k], from);
        *aside = out[k] > *aside ? out[k] : *aside;
    }
    above += out[3];
    above = above > 0 ? above : 0;
    return sqrt(above * above + *aside * *aside);
}

/*
    Excess of the squared distance of beads over the largest at which the facet
    may be nearest: from the facet, that is its height above the plane and how
    far it is beside the outermost edge, and, unless an edge is convex, beside
    that alone. In single precision, of which four go into a register, and
    so much wider that what it rounds off leaves no facet out; lengths by the
    beads' reach. d: from the cell's centre to the facet's middle. Returns how many
    beads are not beyond, and lists them.
*/
static int find_beads(const ellipsoid_facet *facet,
                      const ellipsoid_facet_sides *sides, const bead_set *beads,
                      const double d[3], double far, double near,
                      int found[ELLIPSOID_MAX_BEADS])
{
    const double per_reach = 1 / beads->reach;
    const double size =
        per_reach
        * (fabs(d[0]) + fabs(d[1]) + fabs(d[2]) + facet->radius + beads->reach);
    const double wide = per_reach * far + 2e-6 * size;
    const double side = per_reach * near + 2e-6 * size;
    const float farthest = (float)((1 + 1e-6) * wide * wide);
    const float beside = ellipsoid_facet_has_convex_edge(facet)
                           ? HUGE_VALF
                           : (float)((1 + 1e-6) * side * side);
    float n[3], middle[3], in[3][3], offset[3], beyond[ELLIPSOID_MAX_BEADS];
    int count = 0;

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
        float inside = 0, aside, out;

        for (int k = 0; k < 3; k++)
        {
            const float of =
                offset[k] + in[k][0] * d0 + in[k][1] * d1 + in[k][2] * d2;

            inside = of < inside ? of : inside;
        }
        inside *= inside;
        aside = inside - beside;
        out = h * h + inside - farthest;
        beyond[b] = out > aside ? out : aside;
    }
    for (int b = 0; b < beads->count; b++)
    {
        found[count] = b;
        count += beyond[b] <= 0;
    }
    return count;
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
static int search_beads(const ellipsoid_facet_list *list,
                        const ellipsoid_facet_bounds *bounds,
                        const bead_set *beads, double reach, double margin,
                        ellipsoid_facet_cache *cache)
{
    bead_facet found[ELLIPSOID_MAX_PAIRS];
    const double rounding = 1e-6 * (reach + margin);
    const double far = reach + margin + rounding;
    const double beside = 1.5 * margin + rounding;
    int next[ELLIPSOID_MAX_BEADS], n = 0;

    for (int b = 0; b < beads->count; b++)
    {
        cache->nearest[b] = HUGE_VAL;
        next[b] = 0;
    }
    for (int k = 0; k < list->count; k++)
    {
        const ellipsoid_facet *facet = &list->facets[list->index[k]];
        double d[3], distance, aside;
        int near[ELLIPSOID_MAX_BEADS], count;
        ellipsoid_facet_sides sides;

        if (is_beyond(bounds, k, facet, far))
        {
            continue;
        }
        ellipsoid_difference(facet->middle, beads->centre, d);
        ellipsoid_facet_sides_set(facet, &sides);
        if (box_distance(facet, &sides, beads, d, &aside) > far
            || (aside > beside && !ellipsoid_facet_has_convex_edge(facet)))
        {
            continue;
        }
        count = find_beads(facet, &sides, beads, d, far, beside, near);
        for (int m = 0; m < count; m++)
        {
            const int b = near[m];
            double centre[3];

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
                            const ellipsoid_facet_bounds *bounds,
                            const ellipsoid_surface *body, double reach,
                            ellipsoid_facet_cache *cache)
{
    int n = 0;

    for (int k = 0; k < list->count; k++)
    {
        const ellipsoid_facet *facet = &list->facets[list->index[k]];

        if (is_beyond(bounds, k, facet, reach)
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

double ellipsoid_facet_bound(const ellipsoid_facet_list *list,
                             const ellipsoid_facet_bounds *bounds, double most,
                             double least, ellipsoid_facet_cache *cache)
{
    bead_set box;
    int first;

    take_box(cache, &box);
    first = cache->about_nearest < list->count ? cache->about_nearest : 0;
    for (int n = 0; n < list->count && !(most <= least); n++)
    {
        const int k = n == 0 ? first : n == first ? 0 : n;
        const ellipsoid_facet *facet = &list->facets[list->index[k]];
        ellipsoid_facet_sides sides;
        double d[3], aside, of;

        if (is_beyond(bounds, k, facet, most))
        {
            continue;
        }
        ellipsoid_difference(facet->middle, box.centre, d);
        ellipsoid_facet_sides_set(facet, &sides);
        of = box_distance(facet, &sides, &box, d, &aside);
        if (of < most)
        {
            most = of;
            cache->about_nearest = k;
        }
    }
    return most;
}

int ellipsoid_facet_search(const ellipsoid_model *model,
                           const ellipsoid_facet_list *list,
                           const ellipsoid_facet_bounds *bounds, double horizon,
                           double margin, ellipsoid_facet_cache *cache)
{
    const double radius = model->options.bead_radius;
    bead_set beads;
    ellipsoid_surface body;

    if (model->options.contact_shape == ELLIPSOID_CONTACT_ELLIPSOID)
    {
        ellipsoid_surface_set(model->options.semi_axes, cache->x, cache->q,
                              &body);
        return search_ellipsoid(list, bounds, &body,
                                horizon + margin + 1e-6 * radius, cache);
    }
    take_box(cache, &beads);
    set_beads(model, &beads);
    return search_beads(list, bounds, &beads, radius + horizon, margin, cache);
}
