/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    wallPlanes.c - which planes stand for the walls near a cell.

    Each point where the grown body would meet a facet (wallFeatures.c) gives
    one. Over a concave seam a plane does not end at once: facets, and edges
    beyond their ends, go on as if they were larger, and the extent of their
    plane falls to zero while the point moves away by a part of the height
    (lengths by M). So nothing jumps where a wall goes on in other facets. Over
    a flat one the facet across has the same plane. How planes of nearly one
    normal share is told in planeWeights.c.
*/
#include "drag/wallResistance.h"

enum
{
    POSE = ELLIPSOID_POSE_SIZE
};

/* What makes two planes one. */
static const double same = 1e-8;

/* The part of the range within which a wall counts fully. */
static const double full = 0.5;

/* Changes by a component n of the pose, body frame, of a vector from a fixed
   point to the centre, or of a fixed direction. */
static void changed(const ellipsoid_wall_search *s, int n, int is_point,
                    const double lab[3], double change[3])
{
    if (n >= 3)
    {
        ellipsoid_product(s->turned[n - 3], lab, change);
    }
    else if (is_point)
    {
        ellipsoid_set(change, s->axis[0][n], s->axis[1][n], s->axis[2][n]);
    }
    else
    {
        ellipsoid_set(change, 0, 0, 0);
    }
}

/* The point slides along the edge so that the covector stays across it. */
static void slide(const ellipsoid_wall_search *s,
                  const ellipsoid_wall_feature *p,
                  int n, const double along_lab[3], const double w[3],
                  double change[3])
{
    double along[3], shrunk[3], turned[3], slip;

    ellipsoid_product(s->axis, along_lab, along);
    ellipsoid_shrink(s, along, shrunk);
    changed(s, n, 0, along_lab, turned);
    for (int i = 0; i < 3; i++)
    {
        change[i] -= p->foot * turned[i];
    }
    slip = (ellipsoid_dot(change, shrunk) + ellipsoid_dot(w, turned))
         / ellipsoid_dot(along, shrunk);
    for (int i = 0; i < 3; i++)
    {
        change[i] -= slip * along[i];
    }
}

static void rim_slopes(const ellipsoid_wall_search *s,
                       const ellipsoid_wall_feature *p, ellipsoid_plane *plane)
{
    const double *vertex = p->facet->vertex[p->k];
    const double *m = p->normal;
    double line[3], along[3], r[3], w[3], length;

    ellipsoid_difference(s->x, vertex, line);
    ellipsoid_difference(p->facet->vertex[(p->k + 1) % 3], vertex, along);
    for (int i = 0; i < 3; i++)
    {
        const double lab[3] = {line[0] - p->foot * along[0],
                               line[1] - p->foot * along[1],
                               line[2] - p->foot * along[2]};

        r[i] = ellipsoid_dot(s->axis[i], lab);
    }
    ellipsoid_shrink(s, r, w);
    length = ellipsoid_length(w);
    for (int n = 0; n < POSE; n++)
    {
        double change[3], turn[3], along_m;

        changed(s, n, 1, line, change);
        if (p->feature == ELLIPSOID_ON_EDGE)
        {
            slide(s, p, n, along, w, change);
        }
        ellipsoid_shrink(s, change, turn);
        along_m = ellipsoid_dot(m, turn);
        for (int i = 0; i < 3; i++)
        {
            plane->normal_slope[n][i] = (turn[i] - along_m * m[i]) / length;
        }
        plane->height.slope[n] = ellipsoid_dot(plane->normal_slope[n], r)
                               + ellipsoid_dot(m, change);
    }
}

static void face_slopes(const ellipsoid_wall_search *s,
                        const ellipsoid_wall_feature *p, ellipsoid_plane *plane)
{
    for (int n = 0; n < POSE; n++)
    {
        changed(s, n, 0, p->facet->normal, plane->normal_slope[n]);
        plane->height.slope[n] = n < 3 ? p->facet->normal[n] : 0;
    }
}

/* Of what the window depends on, t. */
typedef struct window_way
{
    double b[3], support2, arm, t; /* D n; n.D n; |D n| */
} window_way;

static void set_way(const ellipsoid_wall_search *s, const double m[3],
                    double height, window_way *way)
{
    for (int i = 0; i < 3; i++)
    {
        way->b[i] = s->square[i] * m[i];
    }
    way->support2 = ellipsoid_dot(m, way->b);
    way->arm = ellipsoid_length(way->b);
    way->t = (height * way->arm / (way->support2 * s->range) - full)
           / (1 - full);
}

/* The window's smooth end: 1, and its derivatives 0, at t = 0; 0 at t = 1. */
static void set_window(const ellipsoid_wall_search *s, const window_way *way,
                       ellipsoid_plane *plane)
{
    const double *b = way->b, height = plane->height.value;
    const double support2 = way->support2, arm = way->arm, t = way->t;

    plane->window.value = t <= 0 ? 1
                                 : 1 - t * t * t * (10 + t * (6 * t - 15));
    if (t <= 0 || !s->turned)
    {
        return;
    }
    for (int n = 0; n < POSE; n++)
    {
        const double *by = plane->normal_slope[n];
        const double of_b[3] = {s->square[0] * by[0], s->square[1] * by[1],
                                s->square[2] * by[2]};
        const double distance =
            plane->height.slope[n] * arm / support2
            + height / support2
                  * (ellipsoid_dot(b, of_b) / arm
                     - 2 * arm * ellipsoid_dot(b, by) / support2);

        plane->window.slope[n] = -30 * t * t * (1 - t) * (1 - t) * distance
                               / (s->range * (1 - full));
    }
}

/* How the point's distance from the centre, as seen by the body, changes: r =
   D m h/p^2 */
static void point_slope(const ellipsoid_wall_search *s,
                        const ellipsoid_plane *plane, double support2, int n,
                        double change[3])
{
    const double *m = plane->normal, *by = plane->normal_slope[n];
    double of_support2 = 0;

    for (int i = 0; i < 3; i++)
    {
        of_support2 += 2 * s->square[i] * m[i] * by[i];
    }
    for (int i = 0; i < 3; i++)
    {
        change[i] = s->square[i] / support2
                  * (by[i] * plane->height.value
                     + m[i]
                           * (plane->height.slope[n]
                              - plane->height.value * of_support2 / support2));
    }
}

/*
    Takes from the extent by how far the point lies beside the facet, over edge
    k, or, of a point on an edge, beyond its end at edge k. With y = h/p the
    scaled height and d the scaled distance from the edge, or the end, and
    u = d/(y f), the rest is 1 - u^2 (3 - 2 u).
*/
static void fade(const ellipsoid_wall_search *s,
                 const ellipsoid_wall_feature *p, int k, ellipsoid_plane *plane)
{
    const int from_end = p->feature == ELLIPSOID_ON_EDGE;
    const double *m = plane->normal;
    const double *vertex =
        p->facet->vertex[from_end && k == (p->k + 2) % 3 ? p->k : k];
    double line[3], along[3], zeta[3], epsilon[3], out[3];
    double support2 = 0, d, u, rest, ratio;

    for (int i = 0; i < 3; i++)
    {
        support2 += s->square[i] * m[i] * m[i];
    }
    ellipsoid_difference(s->x, vertex, line);
    ellipsoid_difference(p->facet->vertex[(k + 1) % 3], vertex, along);
    ellipsoid_product(s->axis, line, zeta);
    ellipsoid_product(s->axis, along, epsilon);
    for (int i = 0; i < 3; i++)
    {
        const double a = sqrt(s->square[i]);

        zeta[i] = (zeta[i]
                   - s->square[i] * m[i] * plane->height.value / support2)
                / a;
        epsilon[i] /= a;
    }
    ratio = from_end ? 0
                     : ellipsoid_dot(zeta, epsilon)
                           / ellipsoid_dot(epsilon, epsilon);
    for (int i = 0; i < 3; i++)
    {
        out[i] = zeta[i] - ratio * epsilon[i];
    }
    d = ellipsoid_length(out);
    u = d * sqrt(support2) / (ellipsoid_fading * plane->height.value);
    if (!(u < 1))
    {
        plane->extent.value = 0;
        return;
    }
    rest = 1 - u * u * (3 - 2 * u);
    for (int n = 0; s->turned && n < POSE; n++)
    {
        double moved[3], turned[3], slid[3], of_d = 0, of_support2 = 0;

        changed(s, n, 1, line, moved);
        changed(s, n, 0, along, turned);
        point_slope(s, plane, support2, n, slid);
        for (int i = 0; i < 3; i++)
        {
            of_d += out[i] * (moved[i] - slid[i] - ratio * turned[i])
                  / sqrt(s->square[i]);
            of_support2 += 2 * s->square[i] * m[i] * plane->normal_slope[n][i];
        }
        of_d = d > 0 ? of_d / d : 0;
        plane->extent.slope[n] =
            plane->extent.slope[n] * rest
            - plane->extent.value * 6 * (1 - u)
                  * (u * of_d * sqrt(support2)
                         / (ellipsoid_fading * plane->height.value)
                     + u * u
                           * (0.5 * of_support2 / support2
                              - plane->height.slope[n] / plane->height.value));
    }
    plane->extent.value *= rest;
}

/* ------------------------------------------------------------ all planes */

static int is_same(const ellipsoid_wall_search *s, const ellipsoid_plane *a,
                   const ellipsoid_plane *b)
{
    double d[3];

    ellipsoid_difference(a->normal, b->normal, d);
    return ellipsoid_dot(d, d) < same * same
        && fabs(a->height.value - b->height.value) < same * s->range;
}

/* Is it the same face, edge or vertex? Facets of one plane are one face. */
static int is_one_feature(const ellipsoid_wall_search *s,
                          const ellipsoid_plane *a, const ellipsoid_plane *b)
{
    const size_t size = sizeof(double[3]);

    if (a->feature != b->feature)
    {
        return 0;
    }
    switch (a->feature)
    {
        case ELLIPSOID_ON_FACE:
            return is_same(s, a, b);
        case ELLIPSOID_ON_EDGE:
            return (memcmp(a->vertex[0], b->vertex[0], size) == 0
                    && memcmp(a->vertex[1], b->vertex[1], size) == 0)
                || (memcmp(a->vertex[0], b->vertex[1], size) == 0
                    && memcmp(a->vertex[1], b->vertex[0], size) == 0);
        default:
            return memcmp(a->vertex[0], b->vertex[0], size) == 0;
    }
}

/* Which of all has the feature of the plane behind them; -1: none. Whether
   planes of others are nearly the same must not matter: they fade in
   gradually. */
static int seen(const ellipsoid_wall_search *s, const ellipsoid_planes *all)
{
    for (int i = 0; i < all->count; i++)
    {
        if (is_one_feature(s, &all->at[i], &all->at[all->count]))
        {
            return i;
        }
    }
    return -1;
}

/* Takes the plane behind all; where there are too many the farthest goes. */
static void keep(ellipsoid_planes *all)
{
    const ellipsoid_plane *plane = &all->at[all->count];
    int farthest = 0;

    if (all->count < ELLIPSOID_MAX_PLANES)
    {
        all->count++;
        return;
    }
    for (int i = 1; i < all->count; i++)
    {
        if (all->at[i].height.value > all->at[farthest].height.value)
        {
            farthest = i;
        }
    }
    if (plane->height.value < all->at[farthest].height.value)
    {
        all->at[farthest] = *plane;
    }
}

/* Of features seen twice the one that fades less is kept. */
static void add_plane(const ellipsoid_wall_search *s,
                      const ellipsoid_wall_feature *p, ellipsoid_planes *all)
{
    ellipsoid_plane *plane = &all->at[all->count];
    window_way way;
    int before;

    set_way(s, p->normal, p->height, &way);
    if (way.t >= 1)
    {
        return; /* too far */
    }
    memset(plane, 0, sizeof(*plane));
    ellipsoid_copy(p->normal, plane->normal);
    plane->height.value = p->height;
    plane->extent.value = 1;
    plane->feature = p->feature;
    plane->vertex[0] = p->facet->vertex[p->k];
    plane->vertex[1] = p->facet->vertex[(p->k + 1) % 3];
    before = seen(s, all);
    if (before >= 0 && all->at[before].extent.value == 1)
    {
        return;
    }
    if (s->turned)
    {
        if (p->feature == ELLIPSOID_ON_FACE)
        {
            face_slopes(s, p, plane);
        }
        else
        {
            rim_slopes(s, p, plane);
        }
    }
    set_window(s, &way, plane);
    for (int k = 0; k < 3 && plane->window.value * plane->extent.value > 0; k++)
    {
        if (p->over[k])
        {
            fade(s, p, k, plane);
        }
    }
    if (!(plane->window.value * plane->extent.value > 0))
    {
        return;
    }
    if (before < 0)
    {
        keep(all);
    }
    else if (plane->extent.value > all->at[before].extent.value)
    {
        all->at[before] = *plane;
    }
}

/* What planes that are the same add to the resistance is evaluated once. */
static void join_same(const ellipsoid_wall_search *s, ellipsoid_planes *all)
{
    int count = 0;

    for (int i = 0; i < all->count; i++)
    {
        int k = 0;

        while (k < count && !is_same(s, &all->at[k], &all->at[i]))
        {
            k++;
        }
        if (k == count)
        {
            if (count < i)
            {
                all->at[count] = all->at[i];
            }
            count++;
            continue;
        }
        all->at[k].weight.value += all->at[i].weight.value;
        for (int n = 0; s->turned && n < POSE; n++)
        {
            all->at[k].weight.slope[n] += all->at[i].weight.slope[n];
        }
    }
    all->count = count;
}

/* Adds the planes of facets that may be met, and keeps which are. */
static void look_at(const ellipsoid_wall_search *s, const short which[],
                    int count, ellipsoid_facet_cache *cache,
                    ellipsoid_planes *planes)
{
    ellipsoid_wall_view view = {.along = {0}};
    int met = 0;

    for (int k = 0; k < count; k++)
    {
        const short near = which[k]; /* may be one of those kept */
        ellipsoid_wall_feature found;

        if (ellipsoid_find_feature(
                s, &cache->near_facets[cache->near_facet[near]], &view, &found))
        {
            add_plane(s, &found, planes);
            if (met < ELLIPSOID_MAX_MET)
            {
                cache->met[met] = near;
            }
            met++;
        }
    }
    cache->met_count = met <= ELLIPSOID_MAX_MET ? met : -1;
    ellipsoid_copy(s->x, cache->met_x);
    memcpy(cache->met_axis, s->axis, sizeof(cache->met_axis));
}

/* A pose is often looked at twice, for resistance and for slopes. */
static int is_looked_at(const ellipsoid_wall_search *s,
                        const ellipsoid_facet_cache *cache)
{
    return cache->met_count >= 0
        && memcmp(s->x, cache->met_x, sizeof(cache->met_x)) == 0
        && memcmp(s->axis, cache->met_axis, sizeof(cache->met_axis)) == 0;
}

/* Axes of length one, and their derivatives, from those of any q. */
static void normalise_axes(const double q[4], ellipsoid_frame *frame,
                           double unit[3][3], double turned[4][3][3])
{
    const double per = 1 / ellipsoid_square4(q);

    for (int i = 0; i < 3; i++)
    {
        for (int l = 0; l < 3; l++)
        {
            unit[i][l] = per * frame->axis[i][l];
            for (int n = 0; frame->by_q && n < 4; n++)
            {
                turned[n][i][l] =
                    per * (frame->by_q[n][i][l] - 2 * q[n] * unit[i][l]);
            }
        }
    }
}

ellipsoid_status
ellipsoid_find_planes(const ellipsoid_model *model,
                      const ellipsoid_surroundings *surroundings,
                      const ellipsoid_state *state, ellipsoid_frame *frame,
                      ellipsoid_facet_cache *cache, ellipsoid_planes *planes)
{
    const double *a = model->options.semi_axes;
    const double range = model->options.wall_range;
    const double longest = fmax(a[0], fmax(a[1], a[2]));
    const double shortest = fmin(a[0], fmin(a[1], a[2]));
    const ellipsoid_status status =
        ellipsoid_collect_near(surroundings, state->x, range,
                               longest / shortest, cache);
    double unit[3][3], turned[4][3][3];

    planes->count = 0;
    if (status != ELLIPSOID_OK || cache->near_count == 0)
    {
        return status;
    }
    normalise_axes(state->q, frame, unit, turned);

    const ellipsoid_wall_search s = {
        state->x, {a[0] * a[0], a[1] * a[1], a[2] * a[2]},
        unit,     frame->by_q ? turned : NULL,
        range,    longest, shortest};

    if (is_looked_at(&s, cache))
    {
        look_at(&s, cache->met, cache->met_count, cache, planes);
    }
    else
    {
        const int level = ellipsoid_look_closer(&s, cache);

        look_at(&s, cache->live[level], cache->live_count[level], cache,
                planes);
    }
    ellipsoid_weigh_planes(model, planes, s.turned != NULL);
    join_same(&s, planes);
    return ELLIPSOID_OK;
}
