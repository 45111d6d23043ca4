/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    wallImages.c - a surface with its images beyond planes of symmetry and
    periods, as far as they may act on a cell. Where the surface meets its image
    they have points in common, so that it goes on without an edge.
*/
#include "walls/wallSurface.h"

#include <math.h>

static const ellipsoid_isometry identity;

static int image_count(const ellipsoid_walls_options *options)
{
    return options->image_count > 0 ? options->image_count : 1;
}

static const ellipsoid_isometry *
image_of(const ellipsoid_walls_options *options, int i)
{
    return options->image_count > 0 ? &options->image[i] : &identity;
}

static void move(const ellipsoid_isometry *by, const double x[3],
                 double moved[3])
{
    for (int i = 0; i < 3; i++)
    {
        moved[i] = x[i] + (ellipsoid_dot(by->A[i], x) + by->b[i]);
    }
}

/* Does it make left of right? */
static int turns_over(const ellipsoid_isometry *by)
{
    double m[3][3], c[3];

    for (int i = 0; i < 3; i++)
    {
        ellipsoid_copy(by->A[i], m[i]);
        m[i][i] += 1;
    }
    ellipsoid_cross(m[1], m[2], c);
    return ellipsoid_dot(m[0], c) < 0;
}

/* Is a triangle a part of a plane of symmetry, as seen from behind? */
static int is_back(double x[3][3], const ellipsoid_walls_options *options,
                   double tolerance)
{
    double a[3], b[3], area[3];

    ellipsoid_difference(x[1], x[0], a);
    ellipsoid_difference(x[2], x[0], b);
    ellipsoid_cross(a, b, area);
    for (int n = 0; n < options->plane_count; n++)
    {
        const ellipsoid_symmetry_plane *plane = &options->plane[n];
        double off[3], farthest = 0;

        for (int k = 0; k < 3; k++)
        {
            ellipsoid_difference(x[k], plane->x, off);
            farthest = fmax(farthest, fabs(ellipsoid_dot(off, plane->n)));
        }
        if (farthest < tolerance && ellipsoid_dot(area, plane->n) > 0)
        {
            return 1;
        }
    }
    return 0;
}

/* The image of a triangle, its corners in the order that keeps its side; 0 if
   it is beside the box. */
static int set_image(const ellipsoid_triangles *triangles, int t,
                     const ellipsoid_walls_options *options,
                     const ellipsoid_isometry *by, int over, double x[3][3])
{
    double low[3], high[3];

    for (int k = 0; k < 3; k++)
    {
        move(by, triangles->point[triangles->corner[t][over ? 2 - k : k]],
             x[k]);
    }
    for (int i = 0; i < 3; i++)
    {
        low[i] = fmin(x[0][i], fmin(x[1][i], x[2][i]));
        high[i] = fmax(x[0][i], fmax(x[1][i], x[2][i]));
    }
    for (int i = 0; i < 3 && options->image_count > 0; i++)
    {
        if (low[i] > options->high[i] || high[i] < options->low[i])
        {
            return 0;
        }
    }
    return 1;
}

void ellipsoid_images_count(const ellipsoid_triangles *triangles,
                            const ellipsoid_walls_options *options,
                            size_t *points, size_t *count)
{
    *count = 0;
    for (int i = 0; i < image_count(options); i++)
    {
        for (int t = 0; t < triangles->count; t++)
        {
            double x[3][3];

            *count +=
                set_image(triangles, t, options, image_of(options, i), 0, x);
        }
    }
    *points = (size_t)image_count(options) * triangles->point_count;
    *points = *points < 3 * *count ? *points : 3 * *count;
    /* walls and planes of symmetry have their own */
    *points = triangles->mirror ? 2 * *points : *points;
}

static double shortest_edge(const ellipsoid_triangles *triangles, int mirror)
{
    double shortest = HUGE_VAL;

    for (int t = 0; t < triangles->count; t++)
    {
        const int *corner = triangles->corner[t];

        if (mirror != (triangles->mirror && triangles->mirror[t]))
        {
            continue;
        }
        for (int k = 0; k < 3; k++)
        {
            double along[3];

            ellipsoid_difference(triangles->point[corner[(k + 1) % 3]],
                                 triangles->point[corner[k]], along);
            shortest = fmin(shortest, ellipsoid_length(along));
        }
    }
    return shortest;
}

/* Lets corners that are no farther apart than that [m] be the first point of
   those. Points that are one have one distance to a common centre. */
static void join_points(double tolerance, ellipsoid_arena scratch,
                        ellipsoid_wall_surface *s)
{
    const int n = s->point_count;
    ellipsoid_sort_key *sorted = ellipsoid_take(&scratch, n, sizeof *sorted);
    double *distance = ellipsoid_take(&scratch, n, sizeof *distance);
    int *same = ellipsoid_take(&scratch, n, sizeof *same);
    double centre[3] = {0, 0, 0}, off[3];

    for (int i = 0; i < n; i++)
    {
        ellipsoid_add(centre, s->point[i]);
    }
    ellipsoid_set(centre, centre[0] / n, centre[1] / n, centre[2] / n);
    for (int i = 0; i < n; i++)
    {
        ellipsoid_difference(s->point[i], centre, off);
        distance[i] = ellipsoid_length(off);
        same[i] = i;
        sorted[i] = (ellipsoid_sort_key){ellipsoid_sort_key_of(distance[i]), i};
    }
    ellipsoid_sort(sorted, n);
    for (int k = 1; k < n; k++)
    {
        const int i = sorted[k].index;
        const double slack = tolerance + 1e-12 * distance[i];
        int j = k - 1, found = -1;

        for (; j >= 0 && found < 0
               && distance[i] - distance[sorted[j].index] <= slack;
             j--)
        {
            ellipsoid_difference(s->point[i], s->point[sorted[j].index], off);
            found = ellipsoid_dot(off, off) <= tolerance * tolerance
                      ? sorted[j].index
                      : -1;
        }
        if (found >= 0)
        {
            ellipsoid_unite(same, i, found);
        }
    }
    for (int t = 0; t < s->count; t++)
    {
        for (int k = 0; k < 3; k++)
        {
            s->corner[t][k] = ellipsoid_lowest(same, s->corner[t][k]);
        }
    }
}

size_t ellipsoid_images_scratch(size_t points, size_t given_points)
{
    return ellipsoid_piece(given_points, sizeof(int))
         + ellipsoid_piece(points, sizeof(ellipsoid_sort_key))
         + ellipsoid_piece(points, sizeof(double))
         + ellipsoid_piece(points, sizeof(int));
}

static void add_triangle(const ellipsoid_triangles *triangles, int t, int over,
                         double x[3][3], int *place, ellipsoid_wall_surface *s)
{
    for (int k = 0; k < 3; k++)
    {
        int *at = &place[triangles->corner[t][over ? 2 - k : k]];

        if (*at < 0)
        {
            *at = s->point_count++;
            ellipsoid_copy(x[k], s->point[*at]);
        }
        s->corner[s->count][k] = *at;
    }
    s->label[s->count] = triangles->label ? triangles->label[t] : 0;
    s->source[s->count++] = t;
}

void ellipsoid_images_set(const ellipsoid_triangles *triangles,
                          const ellipsoid_walls_options *options, int mirror,
                          ellipsoid_arena scratch,
                          ellipsoid_wall_surface *surface)
{
    const int images = options->image_count;
    const double near_edge =
        images > 0 ? 1e-3 * shortest_edge(triangles, mirror) : 0;
    int *place =
        ellipsoid_take(&scratch, triangles->point_count, sizeof *place);

    for (int i = 0; i < image_count(options); i++)
    {
        const ellipsoid_isometry *by = image_of(options, i);
        const int over = turns_over(by);
        double x[3][3];

        for (int p = 0; p < triangles->point_count; p++)
        {
            place[p] = -1;
        }
        for (int t = 0; t < triangles->count; t++)
        {
            if (mirror == (triangles->mirror && triangles->mirror[t])
                && set_image(triangles, t, options, by, over, x)
                && !(images > 0 && is_back(x, options, near_edge)))
            {
                add_triangle(triangles, t, over, x, place, surface);
            }
        }
    }
    if (surface->count > 0 && (images > 0 || options->same_point > 0))
    {
        join_points(fmax(near_edge, options->same_point), scratch, surface);
    }
}
