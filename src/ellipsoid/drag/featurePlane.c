/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    featurePlane.c - the plane at a point where the grown body would meet a wall
    (wallFeatures.c), how much of it counts, and its derivatives by the pose.

    All planes fade with the distance of their point from the centre. Over a
    concave seam a plane does not end at once: faces, and edges beyond their
    ends, go on as if they were larger, and the extent of their plane falls to
    zero while the point moves away by a part of the height (lengths by M), so
    that less jumps where a wall goes on in other facets.
*/
#include "drag/wallResistance.h"

enum
{
    POSE = ELLIPSOID_POSE_SIZE
};

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

/* The way from what a plane goes on from to its point, lengths by M. */
typedef struct way_beside
{
    const double *vertex; /* of the edge, or the vertex itself */
    double along[3];      /* of the edge, lab */
    double ratio;         /* along it; 0 from a vertex */
    double out[3], length;
} way_beside;

/* The way from edge k or its nearer end; of a point on another edge, from the
   end at which edge k meets that. */
static void set_beside(const ellipsoid_wall_search *s,
                       const ellipsoid_wall_feature *p,
                       const ellipsoid_plane *plane, double support2, int k,
                       way_beside *way)
{
    const double *m = plane->normal;
    double line[3], epsilon[3];

    way->vertex = p->facet->vertex[k];
    ellipsoid_difference(s->x, way->vertex, line);
    ellipsoid_difference(p->facet->vertex[(k + 1) % 3], way->vertex,
                         way->along);
    ellipsoid_product(s->axis, line, way->out);
    ellipsoid_product(s->axis, way->along, epsilon);
    for (int i = 0; i < 3; i++)
    {
        const double a = sqrt(s->square[i]);

        way->out[i] = (way->out[i]
                       - s->square[i] * m[i] * plane->height.value / support2)
                    / a;
        epsilon[i] /= a;
    }
    way->ratio = ellipsoid_dot(way->out, epsilon)
               / ellipsoid_dot(epsilon, epsilon);
    if (p->feature == ELLIPSOID_ON_EDGE)
    {
        way->ratio = k == (p->k + 2) % 3;
    }
    way->ratio = fmin(fmax(way->ratio, 0), 1);
    for (int i = 0; i < 3; i++)
    {
        way->out[i] -= way->ratio * epsilon[i];
    }
    way->length = ellipsoid_length(way->out);
    if (way->ratio == 1)
    {
        way->vertex = p->facet->vertex[(k + 1) % 3];
        way->ratio = 0;
    }
}

/*
    The extent of a plane whose point lies beside its facet, or on its edge
    beyond an end: with y = h/p the scaled height, d the scaled distance from
    the facet or the end, and u = d/(y f), it is 1 - u^2 (3 - 2 u).
*/
static void fade(const ellipsoid_wall_search *s,
                 const ellipsoid_wall_feature *p, double support2,
                 ellipsoid_plane *plane)
{
    const double *m = plane->normal;
    double line[3], u;
    way_beside way = {.length = HUGE_VAL};

    for (int k = 0; k < 3; k++)
    {
        way_beside other;

        if (p->over[k])
        {
            set_beside(s, p, plane, support2, k, &other);
            way = other.length < way.length ? other : way;
        }
    }
    if (!way.vertex)
    {
        return; /* on its facet */
    }
    u = way.length * sqrt(support2) / (ellipsoid_fading * plane->height.value);
    if (!(u < 1))
    {
        plane->extent.value = 0;
        return;
    }
    plane->extent.value = 1 - u * u * (3 - 2 * u);
    ellipsoid_difference(s->x, way.vertex, line);
    for (int n = 0; s->turned && n < POSE; n++)
    {
        double moved[3], turned[3], slid[3], of_d = 0, of_support2 = 0;

        changed(s, n, 1, line, moved);
        changed(s, n, 0, way.along, turned);
        point_slope(s, plane, support2, n, slid);
        for (int i = 0; i < 3; i++)
        {
            of_d += way.out[i] * (moved[i] - slid[i] - way.ratio * turned[i])
                  / sqrt(s->square[i]);
            of_support2 += 2 * s->square[i] * m[i] * plane->normal_slope[n][i];
        }
        of_d = way.length > 0 ? of_d / way.length : 0;
        plane->extent.slope[n] =
            -6 * (1 - u)
            * (u * of_d * sqrt(support2)
                   / (ellipsoid_fading * plane->height.value)
               + u * u
                     * (0.5 * of_support2 / support2
                        - plane->height.slope[n] / plane->height.value));
    }
}

int ellipsoid_begin_plane(const ellipsoid_wall_search *s,
                          const ellipsoid_wall_feature *p,
                          ellipsoid_plane *plane)
{
    window_way way;

    set_way(s, p->normal, p->height, &way);
    if (way.t >= 1)
    {
        return 0;
    }
    memset(plane, 0, sizeof(*plane));
    ellipsoid_copy(p->normal, plane->normal);
    plane->height.value = p->height;
    plane->extent.value = 1;
    plane->feature = p->feature;
    plane->vertex[0] = p->facet->vertex[p->k];
    plane->vertex[1] = p->facet->vertex[(p->k + 1) % 3];
    return 1;
}

void ellipsoid_complete_plane(const ellipsoid_wall_search *s,
                              const ellipsoid_wall_feature *p,
                              ellipsoid_plane *plane)
{
    window_way way;

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
    set_way(s, p->normal, p->height, &way);
    set_window(s, &way, plane);
    if (plane->window.value > 0)
    {
        fade(s, p, way.support2, plane);
    }
}
