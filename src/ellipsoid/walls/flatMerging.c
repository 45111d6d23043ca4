/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    flatMerging.c - fewer triangles where a surface is flat.

    A mesh cuts a plane wall into many faces, and a cell would have to look at
    each. Here points are taken out, by edge collapse, wherever the surface
    stays what it is: inside planes and along straight creases, within one
    label. Forces of contact do not depend on how a wall is cut.
*/
#include "walls/wallSurface.h"

#include <math.h>

/* A turn smaller than this [rad] is rounding. */
static const double flat_angle = 1e-8;

/* A triangle's height over its longest edge at the least. */
static const double thinnest = 1e-3;

enum
{
    MOST_TRIANGLES = 24, /* more at a point would make a hub */
    MOST_SHARED = 4,     /* at an edge that is merged: both sides of a baffle */
    /* A collapse appends to the queue at most twice the triangles of its point,
       and one. Its target has as many at least as they share. */
    QUEUED_BY_COLLAPSE = 2 * (MOST_TRIANGLES + MOST_SHARED) + 1
};

/* Corner k of triangle t is the node 3 t + k of the list of its point. */
typedef struct merging
{
    ellipsoid_wall_surface *s;
    double longest_edge;
    double (*normal)[3];
    int *first, *last, *degree; /* nodes of a point, in order; -1: none */
    int *next;                  /* of a node */
    int collapses;
    int *changed, *looked; /* how many collapses there had been when the
                              triangles at a point changed, and when it was
                              looked at last */
    int *queue, queued;
    int *around, around_count;  /* points around one that may be moved, and */
    int *targets, target_count; /* where to */
    int *beyond, beyond_count;  /* points around a target */
} merging;

size_t ellipsoid_flat_merging_scratch(size_t points, size_t triangles)
{
    return ellipsoid_piece(triangles, sizeof(double[3]))
         + ellipsoid_piece(3 * triangles, sizeof(int))
         + 8 * ellipsoid_piece(points, sizeof(int))
         + ellipsoid_piece((QUEUED_BY_COLLAPSE + 1) * points, sizeof(int));
}

static int has_corner(const int corner[3], int point)
{
    return corner[0] == point || corner[1] == point || corner[2] == point;
}

static void append_node(merging *m, int point, int node)
{
    if (m->first[point] < 0)
    {
        m->first[point] = node;
    }
    else
    {
        m->next[m->last[point]] = node;
    }
    m->last[point] = node;
    m->next[node] = -1;
    m->degree[point]++;
}

static void remove_triangle(merging *m, int point, int triangle)
{
    int before = -1, node = m->first[point];

    while (node / 3 != triangle)
    {
        before = node;
        node = m->next[node];
    }
    if (before < 0)
    {
        m->first[point] = m->next[node];
    }
    else
    {
        m->next[before] = m->next[node];
    }
    if (m->last[point] == node)
    {
        m->last[point] = before;
    }
    m->degree[point]--;
}

/* Are two triangles part of one plane and label? */
static int are_flat(const merging *m, int a, int b)
{
    double turn[3];

    ellipsoid_cross(m->normal[a], m->normal[b], turn);
    return m->s->label[a] == m->s->label[b]
        && ellipsoid_dot(m->normal[a], m->normal[b]) > 0
        && ellipsoid_dot(turn, turn) < flat_angle * flat_angle;
}

/* Have no triangles of a point or of those around it changed since it was
   looked at? */
static int is_unchanged(const merging *m, int point)
{
    for (int node = m->first[point]; node >= 0; node = m->next[node])
    {
        for (int k = 0; k < 3; k++)
        {
            if (m->changed[m->s->corner[node / 3][k]] > m->looked[point])
            {
                return 0;
            }
        }
    }
    return m->looked[point] >= 0;
}

static int is_listed(const int *list, int count, int point)
{
    for (int n = 0; n < count; n++)
    {
        if (list[n] == point)
        {
            return 1;
        }
    }
    return 0;
}

/* The points that share a triangle with a point; returns how many. */
static int list_around(const merging *m, int point, int *list)
{
    int count = 0;

    for (int node = m->first[point]; node >= 0; node = m->next[node])
    {
        for (int k = 0; k < 3; k++)
        {
            const int other = m->s->corner[node / 3][k];

            if (other != point && !is_listed(list, count, other))
            {
                list[count++] = other;
            }
        }
    }
    return count;
}

static void set_direction(const merging *m, int from, int to, double r[3])
{
    double length;

    ellipsoid_difference(m->s->point[to], m->s->point[from], r);
    length = ellipsoid_length(r);
    ellipsoid_set(r, r[0] / length, r[1] / length, r[2] / length);
}

static int is_straight(const merging *m, int point)
{
    double a[3], b[3], turn[3];

    if (m->target_count != 2)
    {
        return 0;
    }
    set_direction(m, point, m->targets[0], a);
    set_direction(m, point, m->targets[1], b);
    ellipsoid_cross(a, b, turn);
    return ellipsoid_dot(a, b) < 0 && ellipsoid_length(turn) < flat_angle;
}

/* Is the surface flat at the edge from a point to another: is each triangle there
   continued by one other? Both sides of a baffle have two. */
static int is_flat_edge(const merging *m, int point, int other)
{
    int sharing[MOST_SHARED], count = 0;

    for (int node = m->first[point]; node >= 0; node = m->next[node])
    {
        if (has_corner(m->s->corner[node / 3], other))
        {
            if (count == MOST_SHARED)
            {
                return 0;
            }
            sharing[count++] = node / 3;
        }
    }
    /* if all but the last are, and they are even in number, it is, too */
    for (int a = 0; a < count - 1; a++)
    {
        int continuing = 0;

        for (int b = 0; b < count; b++)
        {
            continuing += b != a && are_flat(m, sharing[a], sharing[b]);
        }
        if (continuing != 1)
        {
            return 0;
        }
    }
    return count % 2 == 0;
}

/* The points around a point, and those that it may be moved to by what the
   surface is like around it; none at corners. */
static void set_targets(merging *m, int point)
{
    m->around_count = list_around(m, point, m->around);
    m->target_count = 0;
    for (int n = 0; n < m->around_count; n++)
    {
        if (!is_flat_edge(m, point, m->around[n]))
        {
            m->targets[m->target_count++] = m->around[n];
        }
    }
    if (m->target_count == 0)
    {
        for (int n = 0; n < m->around_count; n++)
        {
            m->targets[n] = m->around[n];
        }
        m->target_count = m->around_count;
    }
    else if (!is_straight(m, point))
    {
        m->target_count = 0;
    }
}

/* Longest edge [m] of a triangle if its point is moved to another; HUGE_VAL if
   it would be too long or thin, not lie in its plane or not be below another. */
static double moved_edge(const merging *m, int triangle, int point, int target,
                         double other)
{
    const double *normal = m->normal[triangle];
    const double *x[3];
    double side[3][3], area[3], turn[3], squared = 0, edge;

    for (int k = 0; k < 3; k++)
    {
        const int corner = m->s->corner[triangle][k];

        x[k] = m->s->point[corner == point ? target : corner];
    }
    ellipsoid_difference(x[1], x[0], side[0]);
    ellipsoid_difference(x[2], x[1], side[1]);
    ellipsoid_difference(x[2], x[0], side[2]);
    for (int k = 0; k < 3; k++)
    {
        const double s = ellipsoid_dot(side[k], side[k]);

        squared = s > squared ? s : squared;
    }
    edge = sqrt(squared);
    if (edge >= other || edge > m->longest_edge)
    {
        return HUGE_VAL;
    }
    ellipsoid_cross(side[0], side[2], area);
    ellipsoid_cross(area, normal, turn);
    return ellipsoid_dot(area, normal) >= thinnest * (edge * edge)
                && ellipsoid_dot(turn, turn)
                       <= flat_angle * flat_angle * ellipsoid_dot(area, area)
             ? edge
             : HUGE_VAL;
}

/* Is there a triangle of these three points? */
static int is_triangle(const merging *m, int point, int second, int third)
{
    for (int node = m->first[point]; node >= 0; node = m->next[node])
    {
        if (has_corner(m->s->corner[node / 3], second)
            && has_corner(m->s->corner[node / 3], third))
        {
            return 1;
        }
    }
    return 0;
}

/* Longest edge [m] if the point is moved to another; HUGE_VAL if the surface
   would not stay what it is or that is not below another cost. */
static double cost_of(merging *m, int point, int target, double other)
{
    double longest = 0;
    int shared = 0;

    for (int node = m->first[point]; node >= 0; node = m->next[node])
    {
        if (has_corner(m->s->corner[node / 3], target))
        {
            shared++;
        }
        else
        {
            const double edge = moved_edge(m, node / 3, point, target, other);

            if (edge == HUGE_VAL)
            {
                return HUGE_VAL;
            }
            longest = edge > longest ? edge : longest;
        }
    }

    /* points next to both are those of the shared triangles, or the surface
       would fold onto itself */
    m->beyond_count = list_around(m, target, m->beyond);
    for (int n = 0; n < m->around_count; n++)
    {
        if (is_listed(m->beyond, m->beyond_count, m->around[n])
            && !is_triangle(m, point, target, m->around[n]))
        {
            return HUGE_VAL;
        }
    }
    return shared > MOST_SHARED
                || m->degree[point] + m->degree[target]
                       > MOST_TRIANGLES + 2 * shared
             ? HUGE_VAL
             : longest;
}

/* Moves a point to another and queues the points around. */
static void collapse(merging *m, int point, int target)
{
    int next;

    m->changed[target] = ++m->collapses;
    for (int node = m->first[point]; node >= 0; node = next)
    {
        int *corner = m->s->corner[node / 3];
        const int shared = has_corner(corner, target);

        next = m->next[node];
        for (int k = 0; k < 3; k++)
        {
            if (corner[k] == point)
            {
                corner[k] = target;
                continue;
            }
            m->queue[m->queued++] = corner[k];
            m->changed[corner[k]] = m->collapses;
            if (shared)
            {
                remove_triangle(m, corner[k], node / 3);
            }
        }
        if (shared)
        {
            corner[0] = -1;
        }
        else
        {
            append_node(m, target, node);
        }
    }
    m->first[point] = m->last[point] = -1;
    m->degree[point] = 0;
    m->queue[m->queued++] = target;
}

/* Moves a point to the best target, if there is one. */
static void look_at(merging *m, int point)
{
    double best = HUGE_VAL;
    int best_target = -1;

    m->looked[point] = m->collapses;
    set_targets(m, point);
    for (int n = 0; n < m->target_count; n++)
    {
        const double cost = cost_of(m, point, m->targets[n], best);

        if (cost < best)
        {
            best = cost;
            best_target = m->targets[n];
        }
    }
    if (best_target >= 0)
    {
        collapse(m, point, best_target);
    }
}

static void set_normal(const ellipsoid_wall_surface *s, int t, double n[3])
{
    double a[3], b[3], length;

    ellipsoid_difference(s->point[s->corner[t][1]], s->point[s->corner[t][0]],
                         a);
    ellipsoid_difference(s->point[s->corner[t][2]], s->point[s->corner[t][0]],
                         b);
    ellipsoid_cross(a, b, n);
    length = ellipsoid_length(n);
    ellipsoid_set(n, n[0] / length, n[1] / length, n[2] / length);
}

/* All points in the order in which the triangles name them. */
static void begin(merging *m)
{
    const ellipsoid_wall_surface *s = m->s;

    for (int p = 0; p < s->point_count; p++)
    {
        m->first[p] = m->last[p] = m->looked[p] = -1;
        m->degree[p] = m->changed[p] = 0;
    }
    for (int t = 0; t < s->count; t++)
    {
        set_normal(s, t, m->normal[t]);
        for (int k = 0; k < 3; k++)
        {
            const int point = s->corner[t][k];

            if (m->first[point] < 0)
            {
                m->queue[m->queued++] = point;
            }
            append_node(m, point, 3 * t + k);
        }
    }
}

void ellipsoid_flat_merge(double longest_edge, ellipsoid_arena scratch,
                          ellipsoid_wall_surface *surface)
{
    const size_t points = surface->point_count;
    merging m = {.s = surface, .longest_edge = longest_edge};
    int kept = 0;

    m.normal = ellipsoid_take(&scratch, surface->count, sizeof *m.normal);
    m.next = ellipsoid_take(&scratch, 3 * (size_t)surface->count, sizeof(int));
    m.first = ellipsoid_take(&scratch, points, sizeof(int));
    m.last = ellipsoid_take(&scratch, points, sizeof(int));
    m.degree = ellipsoid_take(&scratch, points, sizeof(int));
    m.changed = ellipsoid_take(&scratch, points, sizeof(int));
    m.looked = ellipsoid_take(&scratch, points, sizeof(int));
    m.around = ellipsoid_take(&scratch, points, sizeof(int));
    m.targets = ellipsoid_take(&scratch, points, sizeof(int));
    m.beyond = ellipsoid_take(&scratch, points, sizeof(int));
    m.queue = ellipsoid_take(&scratch, (QUEUED_BY_COLLAPSE + 1) * points,
                             sizeof(int));
    begin(&m);
    for (int n = 0; n < m.queued; n++)
    {
        if (!is_unchanged(&m, m.queue[n]))
        {
            look_at(&m, m.queue[n]);
        }
    }
    for (int t = 0; t < surface->count; t++)
    {
        if (surface->corner[t][0] >= 0)
        {
            for (int k = 0; k < 3; k++)
            {
                surface->corner[kept][k] = surface->corner[t][k];
            }
            surface->label[kept] = surface->label[t];
            surface->source[kept++] = surface->source[t];
        }
    }
    surface->count = kept;
}
