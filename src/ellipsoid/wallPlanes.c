/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    wallPlanes.c - which planes stand for the walls near a cell.

    The body, grown about its centre, meets the walls in places one after the
    other: where y -> y.M y, M = R diag(1/a_i^2) R^T, has a local minimum on the
    wall, y = w - x. The plane through such a place w on which the grown body
    rests has the normal n ~ -M (w - x). On a flat wall it is the wall itself,
    however the body lies; and it cuts the body only if the wall does. The place
    is inside a facet, on an edge or at a vertex under the conditions of
    facets.c, with the scalar product by M.
*/
#include "nearWall.h"

#include <math.h>

enum
{
    POSE = ELLIPSOID_POSE_SIZE
};

/* Relative slack of conditions, as in facets.c, and what makes two planes one,
   seen twice. */
static const double slack = 1e-9, same = 1e-8;

/* The part of the range within which a wall counts fully. */
static const double full = 0.5;

/* The part of the height over which a place beside its facet fades. */
static const double fading = 0.25;

/* How far the centre may move before facets are listed again, in ranges. */
static const double margin_part = 0.1;

/* What the search of the planes of one pose needs. */
typedef struct search
{
    const double *x;
    double square[3];     /* [m2] a_i^2 */
    double (*axis)[3];    /* unit */
    double (*turned)[3][3]; /* their derivatives by q, NULL: no slopes */
    double range;
} search;

/* Where a plane was found: on a facet, on edge k or at vertex k of it. */
typedef struct place
{
    const ellipsoid_facet *facet;
    int feature, k;
    int over[3];      /* beside the facet, over these edges: it fades */
    double foot;      /* along the edge, 0 to 1 on it */
    double normal[3]; /* body */
    double height;
} place;

/* ---------------------------------------------------------------- places */

/* diag(1/a_i^2) v */
static void shrink(const search *s, const double v[3], double result[3])
{
    for (int i = 0; i < 3; i++)
    {
        result[i] = v[i] / s->square[i];
    }
}

/* r: from the place to the centre, body frame */
static int set_place(place *p, int feature, int k, double foot,
                     const double r[3], const double covector[3])
{
    const double length = ellipsoid_length(covector);

    if (!(length > 0))
    {
        return 0;
    }
    p->feature = feature;
    p->k = k;
    p->foot = foot;
    ellipsoid_set(p->normal, covector[0] / length, covector[1] / length,
                  covector[2] / length);
    p->height = ellipsoid_dot(p->normal, r);
    return 1;
}

/* Vectors of a facet in the body frame. */
typedef struct corners
{
    double from[3][3], along[3][3]; /* vertex to centre; edges */
} corners;

static int place_on_edge(const search *s, const corners *c, int k, double foot,
                         const double normal[3], place *p)
{
    double r[3], w[3], inward[3];

    for (int i = 0; i < 3; i++)
    {
        r[i] = c->from[k][i] - foot * c->along[k][i];
    }
    shrink(s, r, w);
    ellipsoid_product(s->axis, p->facet->edge_inward[k], inward);
    return ellipsoid_dot(w, inward) <= slack * ellipsoid_length(w)
        && ellipsoid_dot(r, normal) >= -slack * ellipsoid_length(r)
        && set_place(p, ELLIPSOID_ON_EDGE, k, foot, r, w);
}

/* bare: the square of the scaled distance to the facet's plane */
static int place_at_vertex(const search *s, const corners *c,
                           const double normal[3], double bare, place *p)
{
    const ellipsoid_facet *facet = p->facet;
    double nearest = HUGE_VAL, w[3], lab[3];
    int k = 0;

    for (int n = 0; n < 3; n++)
    {
        double squared;

        shrink(s, c->from[n], w);
        squared = ellipsoid_dot(c->from[n], w);
        if (squared < nearest)
        {
            nearest = squared;
            k = n;
        }
    }
    shrink(s, c->from[k], w);
    ellipsoid_combination(s->axis, w[0], w[1], w[2], lab);
    return (ellipsoid_facet_answers(facet, k)
            || bare >= (1 - 2 * slack) * nearest)
        && ellipsoid_facet_is_apex(facet, k, lab, slack * ellipsoid_length(w))
        && ellipsoid_dot(c->from[k], normal)
               >= -slack * ellipsoid_length(c->from[k])
        && set_place(p, ELLIPSOID_ON_VERTEX, k, 0, c->from[k], w);
}

/* The place beside the facet's face, over a convex edge. */
static int place_on_rim(const search *s, const double normal[3], double bare,
                        const int outside[3], place *p)
{
    const ellipsoid_facet *facet = p->facet;
    double best = HUGE_VAL, foot = 0;
    int edge = 0;
    corners c;

    for (int k = 0; k < 3; k++)
    {
        double line[3];

        ellipsoid_difference(s->x, facet->vertex[k], line);
        ellipsoid_product(s->axis, line, c.from[k]);
        ellipsoid_difference(facet->vertex[(k + 1) % 3], facet->vertex[k],
                             line);
        ellipsoid_product(s->axis, line, c.along[k]);
    }
    for (int k = 0; k < 3; k++)
    {
        double w[3], at, past;

        shrink(s, c.along[k], w);
        at = ellipsoid_dot(c.from[k], w) / ellipsoid_dot(c.along[k], w);
        past = fmax(0, fmax(-at, at - 1)) * sqrt(ellipsoid_dot(c.along[k], w));
        if (outside[k] && facet->edge[k] == ELLIPSOID_EDGE_CONVEX
            && past < best)
        {
            best = past;
            edge = k;
            foot = at;
        }
    }
    if (best > 0 && place_at_vertex(s, &c, normal, bare, p))
    {
        return 1;
    }
    p->over[(edge + 1) % 3] = foot > 1;
    p->over[(edge + 2) % 3] = foot < 0;
    return place_on_edge(s, &c, edge, foot, normal, p);
}

/* Finds the plane that this facet gives; 0 if there is none. */
static int find_place(const search *s, const ellipsoid_facet *facet, place *p)
{
    double from[3], normal[3], b[3], foot[3], height, support2;
    int outside[3], on_rim = 0;

    ellipsoid_difference(s->x, facet->vertex[0], from);
    height = ellipsoid_dot(from, facet->normal);
    if (!(height > 0 && height < s->range))
    {
        return 0;
    }
    ellipsoid_product(s->axis, facet->normal, normal);
    for (int i = 0; i < 3; i++)
    {
        b[i] = s->square[i] * normal[i];
    }
    support2 = ellipsoid_dot(normal, b);
    ellipsoid_combination(s->axis, b[0], b[1], b[2], foot);
    for (int i = 0; i < 3; i++)
    {
        foot[i] = s->x[i] - foot[i] * height / support2;
    }
    for (int k = 0; k < 3; k++)
    {
        double along[3], inward[3];

        ellipsoid_difference(facet->vertex[(k + 1) % 3], facet->vertex[k],
                             along);
        ellipsoid_cross(facet->normal, along, inward);
        ellipsoid_difference(foot, facet->vertex[k], from);
        outside[k] = ellipsoid_dot(inward, from) < 0;
        on_rim = on_rim
              || (outside[k] && facet->edge[k] == ELLIPSOID_EDGE_CONVEX);
    }
    memset(p, 0, sizeof(*p));
    p->facet = facet;
    if (on_rim)
    {
        return place_on_rim(s, normal, height * height / support2, outside, p);
    }
    p->feature = ELLIPSOID_ON_FACE;
    memcpy(p->over, outside, sizeof(p->over));
    ellipsoid_copy(normal, p->normal);
    p->height = height;
    return 1;
}

/* ---------------------------------------------------------------- slopes */

/* Changes by a component n of the pose, body frame, of a vector from a fixed
   point to the centre, or of a fixed direction. */
static void changed(const search *s, int n, int is_point, const double lab[3],
                    double change[3])
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

/* The place slides along the edge so that the covector stays across it. */
static void slide(const search *s, const place *p, int n,
                  const double along_lab[3], const double w[3],
                  double change[3])
{
    double along[3], shrunk[3], turned[3], slip;

    ellipsoid_product(s->axis, along_lab, along);
    shrink(s, along, shrunk);
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

static void rim_slopes(const search *s, const place *p, ellipsoid_plane *plane)
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
    shrink(s, r, w);
    length = ellipsoid_length(w);
    for (int n = 0; n < POSE; n++)
    {
        double change[3], turn[3], along_m;

        changed(s, n, 1, line, change);
        if (p->feature == ELLIPSOID_ON_EDGE)
        {
            slide(s, p, n, along, w, change);
        }
        shrink(s, change, turn);
        along_m = ellipsoid_dot(m, turn);
        for (int i = 0; i < 3; i++)
        {
            plane->normal_slope[n][i] = (turn[i] - along_m * m[i]) / length;
        }
        plane->height.slope[n] = ellipsoid_dot(plane->normal_slope[n], r)
                               + ellipsoid_dot(m, change);
    }
}

static void face_slopes(const search *s, const place *p, ellipsoid_plane *plane)
{
    for (int n = 0; n < POSE; n++)
    {
        changed(s, n, 0, p->facet->normal, plane->normal_slope[n]);
        plane->height.slope[n] = n < 3 ? p->facet->normal[n] : 0;
    }
}

/* The window's smooth end: 1, and its derivatives 0, at t = 0; 0 at t = 1. */
static void set_window(const search *s, ellipsoid_plane *plane)
{
    const double *m = plane->normal, height = plane->height.value;
    double b[3], support2, arm, t;

    for (int i = 0; i < 3; i++)
    {
        b[i] = s->square[i] * m[i];
    }
    support2 = ellipsoid_dot(m, b);
    arm = ellipsoid_length(b);
    t = (height * arm / (support2 * s->range) - full) / (1 - full);
    memset(&plane->window, 0, sizeof(plane->window));
    if (t >= 1)
    {
        return;
    }
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

/* How the place's distance from the centre, as seen by the body, changes: r =
   D m h/p^2 */
static void place_slope(const search *s, const ellipsoid_plane *plane,
                        double support2, int n, double change[3])
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
    Takes from the window by how far the place lies beside the facet, over edge
    k. With y = h/p the scaled height and d the scaled distance, u = d/(y f),
    the rest is 1 - u^2 (3 - 2 u).
*/
static void fade(const search *s, const place *p, int k, ellipsoid_plane *plane)
{
    const double *m = plane->normal, *vertex = p->facet->vertex[k];
    double line[3], along[3], lab[3], zeta[3], epsilon[3], out[3];
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
    ratio = ellipsoid_dot(zeta, epsilon) / ellipsoid_dot(epsilon, epsilon);
    for (int i = 0; i < 3; i++)
    {
        out[i] = zeta[i] - ratio * epsilon[i];
    }
    d = ellipsoid_length(out);
    u = d * sqrt(support2) / (fading * plane->height.value);
    if (!(u < 1))
    {
        plane->window.value = 0;
        return;
    }
    rest = 1 - u * u * (3 - 2 * u);
    ellipsoid_copy(along, lab);
    for (int n = 0; s->turned && n < POSE; n++)
    {
        double moved[3], turned[3], slid[3], of_d = 0, of_support2 = 0;

        changed(s, n, 1, line, moved);
        changed(s, n, 0, lab, turned);
        place_slope(s, plane, support2, n, slid);
        for (int i = 0; i < 3; i++)
        {
            of_d += out[i] * (moved[i] - slid[i] - ratio * turned[i])
                  / sqrt(s->square[i]);
            of_support2 += 2 * s->square[i] * m[i] * plane->normal_slope[n][i];
        }
        of_d = d > 0 ? of_d / d : 0;
        plane->window.slope[n] =
            plane->window.slope[n] * rest
            - plane->window.value * 6 * (1 - u)
                  * (u * of_d * sqrt(support2)
                         / (fading * plane->height.value)
                     + u * u
                           * (0.5 * of_support2 / support2
                              - plane->height.slope[n] / plane->height.value));
    }
    plane->window.value *= rest;
}

/* ------------------------------------------------------------ all planes */

static int is_same(const search *s, const ellipsoid_plane *a,
                   const ellipsoid_plane *b)
{
    double d[3];

    ellipsoid_difference(a->normal, b->normal, d);
    return ellipsoid_dot(d, d) < same * same
        && fabs(a->height.value - b->height.value) < same * s->range;
}

/* Of planes seen twice the one that fades less is kept. */
static void keep(const search *s, const ellipsoid_plane *plane,
                 ellipsoid_planes *all)
{
    int farthest = 0;

    for (int i = 0; i < all->count; i++)
    {
        if (is_same(s, &all->at[i], plane))
        {
            if (plane->window.value > all->at[i].window.value)
            {
                all->at[i] = *plane;
            }
            return;
        }
        if (all->at[i].height.value > all->at[farthest].height.value)
        {
            farthest = i;
        }
    }
    if (all->count < ELLIPSOID_MAX_PLANES)
    {
        all->at[all->count++] = *plane;
    }
    else if (plane->height.value < all->at[farthest].height.value)
    {
        all->at[farthest] = *plane;
    }
}

static void add_plane(const search *s, const place *p, ellipsoid_planes *all)
{
    ellipsoid_plane plane;

    memset(&plane, 0, sizeof(plane));
    ellipsoid_copy(p->normal, plane.normal);
    plane.height.value = p->height;
    if (s->turned)
    {
        if (p->feature == ELLIPSOID_ON_FACE)
        {
            face_slopes(s, p, &plane);
        }
        else
        {
            rim_slopes(s, p, &plane);
        }
    }
    set_window(s, &plane);
    for (int k = 0; k < 3 && plane.window.value > 0; k++)
    {
        if (p->over[k])
        {
            fade(s, p, k, &plane);
        }
    }
    if (plane.window.value > 0)
    {
        keep(s, &plane, all);
    }
}

/* Could this facet be met while the centre moves by up to the margin? */
static int may_matter(const ellipsoid_facet *facet, const double x[3],
                      double reach, double margin)
{
    double d[3], height;

    ellipsoid_difference(x, facet->middle, d);
    height = ellipsoid_dot(d, facet->normal);
    return height > -margin && height < reach
        && ellipsoid_length(d) - facet->radius < reach;
}

/* Lists facets anew if the centre has moved too far. */
static ellipsoid_status collect(const ellipsoid_surroundings *surroundings,
                                const double x[3], double range,
                                ellipsoid_contact_cache *cache)
{
    const double margin = margin_part * range;
    ellipsoid_facet_list list;
    double d[3];
    int answer;

    ellipsoid_difference(x, cache->near_x, d);
    if (cache->near_count >= 0
        && ellipsoid_dot(d, d) <= margin * margin)
    {
        return ELLIPSOID_OK;
    }
    cache->near_count = -1;
    answer = surroundings->walls(surroundings->walls_context, x,
                                 range + margin, &list);
    if (answer != 0)
    {
        return answer > 0 ? ELLIPSOID_STEP_UNDERFLOW : ELLIPSOID_WALLS_FAILED;
    }
    cache->near_facets = list.facets;
    ellipsoid_copy(x, cache->near_x);

    int count = 0;

    for (int k = 0; k < list.count; k++)
    {
        if (!may_matter(&list.facets[list.index[k]], x, range + margin, margin))
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
    return ELLIPSOID_OK;
}

/* Axes of length one, and their derivatives, from those of any q. */
static void normalise_axes(const double q[4], double axis[3][3],
                           double derivatives[4][3][3], double unit[3][3],
                           double turned[4][3][3])
{
    const double per = 1 / ellipsoid_square4(q);

    for (int i = 0; i < 3; i++)
    {
        for (int l = 0; l < 3; l++)
        {
            unit[i][l] = per * axis[i][l];
            for (int n = 0; derivatives && n < 4; n++)
            {
                turned[n][i][l] =
                    per * (derivatives[n][i][l] - 2 * q[n] * unit[i][l]);
            }
        }
    }
}

ellipsoid_status
ellipsoid_find_planes(const ellipsoid_model *model,
                      const ellipsoid_surroundings *surroundings,
                      const double x[3], const double q[4],
                      double axis[3][3], double axis_derivatives[4][3][3],
                      ellipsoid_contact_cache *cache,
                      ellipsoid_planes *planes)
{
    const double *a = model->options.semi_axes;
    const double range = model->options.wall_range;
    const ellipsoid_status status = collect(surroundings, x, range, cache);
    double unit[3][3], turned[4][3][3];

    planes->count = 0;
    planes->sloped = axis_derivatives != NULL;
    if (status != ELLIPSOID_OK || cache->near_count == 0)
    {
        return status;
    }
    normalise_axes(q, axis, axis_derivatives, unit, turned);

    const search s = {x,
                      {a[0] * a[0], a[1] * a[1], a[2] * a[2]},
                      unit,
                      axis_derivatives ? turned : NULL,
                      range};

    for (int k = 0; k < cache->near_count; k++)
    {
        place found;

        if (find_place(&s, &cache->near_facets[cache->near_facet[k]], &found))
        {
            add_plane(&s, &found, planes);
        }
    }
    if (planes->count == 1)
    {
        planes->at[0].weight = planes->at[0].window;
    }
    else
    {
        ellipsoid_weigh_planes(model, planes);
    }
    return ELLIPSOID_OK;
}
