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

/* How far from a body facets are looked for, in ranges. */
static const double looked = 1.25;

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
typedef ellipsoid_of_pose of_pose;

/* The wall of this plane among those found, or one begun behind them; away: of its
   facet [m]. */
static wall *find_wall(view *s, const double normal[3], double height,
                       double away, wall *walls, int count)
{
    const double same = in_plane * s->model->wall_range;

    for (int k = 0; k < count; k++)
    {
        double d[3];

        ellipsoid_difference(normal, walls[k].normal, d);
        if (normal == walls[k].normal
            || (ellipsoid_dot(d, d) < in_plane * in_plane
                && fabs(height - walls[k].height.value) < same))
        {
            walls[k].away = fmin(walls[k].away, away);
            return &walls[k];
        }
    }
    ellipsoid_wall_begin(s, normal, height, &walls[count]);
    walls[count].away = away;
    return &walls[count];
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
static void set_axes(const double q[4], view *s)
{
    const double per = 1 / ellipsoid_square4(q);

    ellipsoid_axes(q, s->axis);
    if (s->slopes)
    {
        ellipsoid_axis_derivatives(q, s->turned);
    }
    for (int i = 0; i < 9; i++)
    {
        double *along = &s->axis[i / 3][i % 3];

        *along *= per;
        for (int n = 0; s->slopes && n < 4; n++)
        {
            double *by = &s->turned[n][i / 3][i % 3];

            *by = per * (*by - 2 * q[n] * *along);
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

static of_pose product(const of_pose *a, const of_pose *b)
{
    return ellipsoid_chain(a->value * b->value, b->value, a, a->value, b);
}

/* s + c of a wall: the other walls' parts, each by the square of the cosine
   between the normals, and less the deeper it lies, as far as they fill the rest
   of the plane. (Parts of a round wall have a sum below 1, as each is seen from
   the foot on its own plane.) */
static of_pose whole_of(const wall *walls, int count, const wall *w)
{
    const double own = w->part[NEAR].value, rest = 1 - own;
    of_pose others = {0};
    double t, slope, filled;

    for (const wall *o = walls; o < walls + count; o++)
    {
        const double cosine = fmax(ellipsoid_dot(w->normal, o->normal), 0);
        const double square = pow(w->gap.value / o->gap.value, 2);
        const double level = saturated(square, &slope);
        const double by_ratio = 2 * square * slope * cosine * cosine;

        if (o == w || !(cosine * o->fade.value > 0))
        {
            continue;
        }

        const of_pose seen = product(&o->fade, &o->part[NEAR]);
        const of_pose deep =
            ellipsoid_chain(level * cosine * cosine, by_ratio / w->gap.value,
                            &w->gap, -by_ratio / o->gap.value, &o->gap);
        const of_pose part = product(&seen, &deep);

        others =
            ellipsoid_chain(others.value + part.value, 1, &others, 1, &part);
    }
    /* a part may be below 0 by rounding */
    others.value = fmax(others.value, 0);
    t = rest > others.value ? others.value / rest : 1;
    filled = saturated(t, &slope);
    return ellipsoid_chain(own + filled * rest, 1 - filled + slope * t,
                           &w->part[NEAR], slope, &others);
}

/* The plane of a wall; 0 if it does not count. */
static int set_plane(const view *s, const wall *walls, int count, const wall *w,
                     ellipsoid_plane *plane)
{
    const double g = w->gap.value, wide = g + w->height.value;
    double part, rest, square;
    of_pose whole, seen, beyond, near, far;

    if (w->fade.value == 0
        || (w->part[FAR].value == 0 && w->part[NEAR].value == 0))
    {
        return 0;
    }
    whole = whole_of(walls, count, w);
    seen = product(&w->fade, &w->part[NEAR]);
    plane->weight[FAR] = product(&w->fade, &w->part[FAR]);
    plane->weight[NEAR] = product(&seen, &whole);
    part = whole.value;
    rest = 1 - part;
    beyond = ellipsoid_chain(wide, 1, &w->gap, 1, &w->height);
    near = ellipsoid_chain(part / g, 1 / g, &whole, -part / (g * g), &w->gap);
    far = ellipsoid_chain(rest / wide, -1 / wide, &whole, -rest / (wide * wide),
                          &beyond);
    square = pow(near.value + far.value, -2);
    plane->gap[NEAR] = w->gap;
    plane->gap[FAR] = ellipsoid_chain(1 / (near.value + far.value), -square,
                                      &near, -square, &far);
    memcpy(plane->normal_by, w->normal_by, sizeof(plane->normal_by));
    ellipsoid_plane_effect_set(
        &s->model->plane, w->seen[FAR].normal,
        (double[]){plane->gap[FAR].value, plane->gap[NEAR].value}, s->slopes,
        &plane->effect);
    return 1;
}

ellipsoid_status
ellipsoid_find_planes(const ellipsoid_model *model,
                      const ellipsoid_surroundings *surroundings,
                      const ellipsoid_state *state, int slopes,
                      ellipsoid_facet_cache *cache, ellipsoid_planes *planes)
{
    const double *a = model->options.semi_axes, *x = state->x;
    const double range = model->wall_range;
    const double longest = ellipsoid_largest(a);
    const ellipsoid_status status = ellipsoid_near_facets(
        surroundings, x, range, looked * range + longest, cache);
    wall walls[ELLIPSOID_MAX_PLANES + 1];
    view s = {.model = model, .x = x, .slopes = slopes};
    int count = 0;

    planes->count = 0;
    if (status != ELLIPSOID_OK || cache->near_count == 0)
    {
        return status;
    }
    set_axes(state->q, &s);
    for (int k = 0; k < cache->near_count; k++)
    {
        const ellipsoid_facet *facet =
            &cache->near_facets[cache->near_facet[k]];
        const double *normal, height = ellipsoid_height_over(facet, x, &normal);
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
                      count);
        ellipsoid_wall_add(&s, facet, w);
        /* whose plane it is must not depend on which facets are listed */
        if (w == &walls[count] && !is_unseen(w))
        {
            keep_wall(walls, &count);
        }
    }
    for (int k = 0; k < count; k++)
    {
        ellipsoid_wall_end(&s, &walls[k]);
    }
    for (int k = 0; k < count; k++)
    {
        planes->count +=
            set_plane(&s, walls, count, &walls[k], &planes->at[planes->count]);
    }
    return ELLIPSOID_OK;
}
