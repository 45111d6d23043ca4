/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    wallPlanes.c - the walls near a body as planes.

    Facets of one plane are one wall; its part of that is computed in wallParts.c.
    Where a wall ends the pressure of squeezing does, too, and so it counts by the
    square of its part s: over a half-plane Reynolds' equation gives 0.29, 0.53
    and 0.84 of the force where s is 0.5, 0.72 and 0.92, and s^2 0.25, 0.52 and
    0.84. Where another wall goes on at a small angle the pressure does, too: it
    counts by s (s + c), c what goes on.
    The functions of the table take the wall to be there across the gap: where
    only s + c of that is, they are those of a gap of 1/((s + c)/g + (1 - s - c)/
    (g + h)), h the height of the centre. (At g itself their matrix is not
    positive without that of squeezing.)
*/
#include "drag/wallParts.h"

/* How far from a body facets are looked for, in ranges; how far the centre may
   move before they are listed again, the less where there are too many. */
static const double looked = 1.25;
static const double margin_parts[] = {0.6, 0.1};

/* What makes two planes one: an angle [rad], a part of the range. */
static const double in_plane = 1e-6;

enum
{
    POSE = ELLIPSOID_POSE_SIZE,
    FAR = ELLIPSOID_PLANE_FAR,
    NEAR = ELLIPSOID_PLANE_NEAR
};

typedef ellipsoid_wall wall;
typedef ellipsoid_wall_view view;

/* A number and its derivatives by the pose. */
typedef struct slopes
{
    double value, by[POSE];
} slopes;

/* The height of a point over the plane of a facet, and its normal. */
static double height_over(const ellipsoid_facet *facet, const double x[3],
                          const double **normal)
{
    const double(*plane)[3] =
        (const double(*)[3])((const char *)facet + facet->plane);
    const int own = facet->plane == 0;
    double d[3];

    *normal = own ? facet->normal : plane[1];
    ellipsoid_difference(x, own ? facet->middle : plane[0], d);
    return ellipsoid_dot(d, *normal);
}

/* Lists facets anew if the centre has moved too far. Where walls are refused
   far off, or too many, those nearer may do. */
static ellipsoid_status collect(const ellipsoid_surroundings *surroundings,
                                const double x[3], double range, double reach,
                                ellipsoid_facet_cache *cache)
{
    const int tries = sizeof(margin_parts) / sizeof(*margin_parts);
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
        const double margin = margin_parts[k] * range;
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
            const double *normal, height = height_over(facet, x, &normal);

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

/* The wall of this plane among those found, or one begun behind them; what of that
   plane was begun there last, and is not seen, serves if it is the same to the last
   bit. away: of its facet [m]. */
static wall *find_wall(view *s, const double normal[3], double height,
                       double away, wall *walls, int count, int begun)
{
    const double same = in_plane * s->model->wall_range;
    wall *last = &walls[count];

    for (int k = 0; k < count; k++)
    {
        double d[3];

        ellipsoid_difference(normal, walls[k].normal, d);
        if (normal == walls[k].normal
            || (ellipsoid_dot(d, d) < in_plane * in_plane
                && fabs(height - walls[k].height) < same))
        {
            walls[k].away = fmin(walls[k].away, away);
            return &walls[k];
        }
    }
    if (!begun || height != last->height
        || memcmp(normal, last->normal, 3 * sizeof(*normal)))
    {
        ellipsoid_wall_begin(s, normal, height, last);
    }
    last->away = away;
    return last;
}

/* Keeps the wall behind those found; of too many the farthest goes. */
static void keep_wall(wall *walls, int *count)
{
    int at = *count;

    if (*count < ELLIPSOID_MAX_PLANES)
    {
        (*count)++;
        return;
    }
    for (int k = 0; k < *count; k++)
    {
        at = walls[k].away > walls[at].away ? k : at;
    }
    walls[at] = walls[*count];
}

/* Axes of length one, and their derivatives, from those of any q. */
static void set_axes(const double q[4], const ellipsoid_frame *frame, view *s)
{
    const double per = 1 / ellipsoid_square4(q);

    for (int i = 0; i < 3; i++)
    {
        for (int l = 0; l < 3; l++)
        {
            s->axis[i][l] = per * frame->axis[i][l];
            for (int n = 0; frame->by_q && n < 4; n++)
            {
                s->turned[n][i][l] =
                    per * (frame->by_q[n][i][l] - 2 * q[n] * s->axis[i][l]);
            }
        }
    }
}

/* Has it nothing of which anything is seen? */
static int is_unseen(const wall *w)
{
    return w->sum[FAR].inside + w->sum[FAR].edges + w->sum[NEAR].inside
             + w->sum[NEAR].edges
        == 0;
}

/* From 0 to 1 with t, at t = 1 smooth to the first derivative. */
static double saturated(double t, double *slope)
{
    const double rest = fmax(1 - t, 0);

    *slope = 2 * rest;
    return 1 - rest * rest;
}

/* s + c of a wall: the other walls' parts, each by the square of the cosine
   between the normals, and less the deeper it lies, as far as they fill the rest
   of the plane. (Parts of a round wall have a sum below 1, as each is seen from
   the foot on its own plane.) */
static void set_whole(const wall *walls, int count, const wall *w, int sloped,
                      slopes *whole)
{
    const double rest = 1 - w->part[NEAR];
    double others = 0, others_by[POSE] = {0}, t, t_slope, filled;

    for (const wall *o = walls; o < walls + count; o++)
    {
        const double cosine = fmax(ellipsoid_dot(w->normal, o->normal), 0);

        if (o == w || !(cosine * o->fade > 0))
        {
            continue;
        }

        const double ratio = w->gap / o->gap, square = ratio * ratio;
        const double part = cosine * cosine * o->part[NEAR];
        double level_slope;
        const double level = saturated(square, &level_slope);

        others += o->fade * level * part;
        for (int n = 0; sloped && n < POSE; n++)
        {
            others_by[n] +=
                o->fade * level * cosine * cosine * o->part_by[NEAR][n]
                + part
                      * (o->fade_by[n] * level
                         + o->fade * level_slope * 2 * square
                               * (w->gap_by[n] / w->gap
                                  - o->gap_by[n] / o->gap));
        }
    }
    /* a part may be below 0 by rounding */
    others = fmax(others, 0);
    t = rest > others ? others / rest : 1;
    filled = saturated(t, &t_slope);
    whole->value = w->part[NEAR] + filled * rest;
    for (int n = 0; sloped && n < POSE; n++)
    {
        whole->by[n] = w->part_by[NEAR][n] * (1 - filled + t_slope * t)
                     + t_slope * others_by[n];
    }
}

/* The plane of a wall; 0 if it does not count. */
static int set_plane(const view *s, const wall *walls, int count, const wall *w,
                     int sloped, ellipsoid_plane *plane)
{
    const double g = w->gap, h = w->height, *s_n = w->part_by[NEAR];
    const double part = w->part[NEAR], near = 1 / g, away = 1 / (g + h);
    double square;
    slopes whole;

    if (w->fade == 0 || (w->part[FAR] == 0 && part == 0))
    {
        return 0;
    }
    set_whole(walls, count, w, sloped, &whole);
    plane->weight[FAR] = w->fade * w->part[FAR];
    plane->weight[NEAR] = w->fade * part * whole.value;
    plane->gap[NEAR] = g;
    plane->gap[FAR] = 1 / (whole.value * near + (1 - whole.value) * away);
    square = plane->gap[FAR] * plane->gap[FAR];
    for (int n = 0; sloped && n < POSE; n++)
    {
        const double h_n = n < 3 ? w->normal[n] : 0;

        ellipsoid_copy(w->normal_by[n], plane->normal_slope[n]);
        plane->weight_slope[FAR][n] =
            w->fade_by[n] * w->part[FAR] + w->fade * w->part_by[FAR][n];
        plane->weight_slope[NEAR][n] =
            w->fade_by[n] * part * whole.value
            + w->fade * (s_n[n] * whole.value + part * whole.by[n]);
        plane->gap_slope[NEAR][n] = w->gap_by[n];
        plane->gap_slope[FAR][n] =
            square
            * (whole.by[n] * (away - near)
               + whole.value * near * near * w->gap_by[n]
               + (1 - whole.value) * away * away * (w->gap_by[n] + h_n));
    }
    ellipsoid_plane_effect_set(&s->model->plane, w->seen[FAR].normal,
                               plane->gap, sloped, &plane->effect);
    ellipsoid_wall_fit_set(s->model, w->seen[FAR].normal, &plane->fit);
    return 1;
}

ellipsoid_status ellipsoid_find_planes(
    const ellipsoid_model *model, const ellipsoid_surroundings *surroundings,
    const ellipsoid_state *state, const ellipsoid_frame *frame,
    ellipsoid_facet_cache *cache, ellipsoid_planes *planes)
{
    const double *a = model->options.semi_axes, *x = state->x;
    const double range = model->wall_range;
    const double longest = ellipsoid_largest(a);
    const ellipsoid_status status =
        collect(surroundings, x, range, looked * range + longest, cache);
    wall walls[ELLIPSOID_MAX_PLANES + 1];
    view s = {.model = model, .x = x};
    int count = 0, begun = 0;

    planes->count = 0;
    if (status != ELLIPSOID_OK || cache->near_count == 0)
    {
        return status;
    }
    set_axes(state->q, frame, &s);
    for (int k = 0; k < cache->near_count; k++)
    {
        const ellipsoid_facet *facet =
            &cache->near_facets[cache->near_facet[k]];
        const double *normal, height = height_over(facet, x, &normal);
        double d[3], square, off, width;
        wall *w;

        if (!(height > 0 && height < range))
        {
            continue;
        }
        /* beyond what both kernels see; without seams it is to hold a foot */
        ellipsoid_difference(x, facet->middle, d);
        square = ellipsoid_dot(d, d);
        off = square - height * height;
        width = (ellipsoid_has_seam(facet) ? ELLIPSOID_WALL_BESIDE * range : 0)
              + longest + facet->radius;
        if (off > width * width * (1 + 1e-9))
        {
            continue;
        }
        w = find_wall(&s, normal, height, sqrt(square) - facet->radius, walls,
                      count, begun);
        ellipsoid_wall_add(&s, facet, w);
        if (w != &walls[count])
        {
            continue;
        }
        /* whose plane it is must not depend on which facets are listed */
        begun = is_unseen(w);
        if (!begun)
        {
            keep_wall(walls, &count);
        }
    }
    for (int k = 0; k < count; k++)
    {
        ellipsoid_wall_end(&s, frame->by_q != NULL, &walls[k]);
    }
    for (int k = 0; k < count; k++)
    {
        planes->count +=
            set_plane(&s, walls, count, &walls[k], frame->by_q != NULL,
                      &planes->at[planes->count]);
    }
    return ELLIPSOID_OK;
}
