/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    wallPlanes.c - which planes stand for the walls near a cell.

    Each point where the grown body would meet a facet (wallFeatures.c) gives
    one (featurePlane.c). Over a flat seam the facet across has the same plane.
    How planes of nearly one normal share is told in planeWeights.c.
*/
#include "drag/wallResistance.h"

enum
{
    POSE = ELLIPSOID_POSE_SIZE
};

/* What makes two planes one, and the angle [rad] to a plane that is the mesh's
   rounding, as in facets.c. */
static const double same = 1e-8, in_plane = 1e-6;

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

/* Does edge k of a facet end on the line of edge j of another? */
static int ends_on_line(const ellipsoid_facet *facet, int k,
                        const ellipsoid_facet *other, int j, double nothing)
{
    double along[3];

    for (int end = 0; end < 2; end++)
    {
        const double *vertex = facet->vertex[(k + end) % 3];

        if (fabs(ellipsoid_beyond(other, vertex, j, along))
            <= nothing * ellipsoid_length(along))
        {
            return 1;
        }
    }
    return 0;
}

/* Is there a convex edge of this facet, in the plane, too, that ends at the
   seam over which the face goes on, between that and the plane's point? */
static int is_parted_by(const ellipsoid_wall_search *s,
                        const ellipsoid_wall_feature *p,
                        const ellipsoid_facet *facet)
{
    const ellipsoid_facet *face = p->facet;
    const double nothing = in_plane * s->range;
    double turn[3], away[3], along[3], middle[3];

    ellipsoid_difference(face->normal, facet->normal, turn);
    if (fabs(turn[0]) > in_plane || fabs(turn[1]) > in_plane
        || fabs(turn[2]) > in_plane
        || !ellipsoid_facet_has_convex_edge(facet))
    {
        return 0;
    }
    ellipsoid_difference(face->middle, facet->middle, away);
    if (fabs(ellipsoid_dot(facet->normal, away)) > nothing
        || ellipsoid_squared_rim_distance(facet, s->x) >= s->range * s->range)
    {
        return 0;
    }
    for (int j = 0; j < 3; j++)
    {
        if (!p->over[j])
        {
            continue;
        }
        for (int i = 0; i < 3; i++)
        {
            middle[i] =
                0.5 * (face->vertex[j][i] + face->vertex[(j + 1) % 3][i]);
        }
        for (int k = 0; k < 3; k++)
        {
            if (facet->edge[k] == ELLIPSOID_EDGE_CONVEX
                && ellipsoid_beyond(facet, p->place, k, along) > 0
                && ellipsoid_beyond(facet, middle, k, along) < 0
                && ends_on_line(facet, k, face, j, nothing))
            {
                return 1;
            }
        }
    }
    return 0;
}

/* A face goes on beside its facet no farther than its wall would: where a
   convex edge ends at the seam, that edge goes on, or the face across it. */
static int is_past_wall(const ellipsoid_wall_search *s,
                        const ellipsoid_wall_feature *p, const short which[],
                        int count, const ellipsoid_facet_cache *cache)
{
    if (p->feature != ELLIPSOID_ON_FACE)
    {
        return 0;
    }
    for (int k = 0; k < count; k++)
    {
        if (is_parted_by(s, p,
                         &cache->near_facets[cache->near_facet[which[k]]]))
        {
            return 1;
        }
    }
    return 0;
}

/* Of features seen twice the one that fades less is kept. Returns 0 if there is
   nothing of this one, whatever the others are. */
static int add_plane(const ellipsoid_wall_search *s,
                     const ellipsoid_wall_feature *p, const short which[],
                     int count, const ellipsoid_facet_cache *cache,
                     ellipsoid_planes *all)
{
    ellipsoid_plane *plane = &all->at[all->count];
    int before;

    if (!ellipsoid_begin_plane(s, p, plane))
    {
        return 0; /* too far */
    }
    before = seen(s, all);
    if (before >= 0 && all->at[before].extent.value == 1)
    {
        return 1;
    }
    ellipsoid_complete_plane(s, p, plane);
    if (!(plane->window.value * plane->extent.value > 0)
        || (plane->extent.value < 1 && is_past_wall(s, p, which, count, cache)))
    {
        return 0;
    }
    if (before < 0)
    {
        keep(all);
    }
    else if (plane->extent.value > all->at[before].extent.value)
    {
        all->at[before] = *plane;
    }
    return 1;
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
                s, &cache->near_facets[cache->near_facet[near]], &view, &found)
            && add_plane(s, &found, which, count, cache, planes))
        {
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
