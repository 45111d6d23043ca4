/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    wallsCreate.c - walls of triangles: images, merging where they are flat,
    facets with their neighbours and stars, and the tree that finds them.
*/
#include "walls/wallSurface.h"

#include <limits.h>
#include <math.h>
#include <string.h>

/* Its facets, stars and tree lie behind it. */
struct ellipsoid_walls
{
    size_t bytes; /* of all */
    int count;
    ptrdiff_t facets; /* [bytes] from here */
    ellipsoid_facet_tree tree;
};

/* So many edges leave all points at most, for one triangle. */
#define STARS 6

size_t ellipsoid_wall_surface_size(size_t points, size_t triangles)
{
    return ellipsoid_piece(points, sizeof(double[3]))
         + ellipsoid_piece(triangles, sizeof(int[3]))
         + 2 * ellipsoid_piece(triangles, sizeof(int));
}

int ellipsoid_wall_surface_take(ellipsoid_arena *arena, size_t points,
                                size_t triangles,
                                ellipsoid_wall_surface *surface)
{
    surface->point_count = surface->count = 0;
    surface->point = ellipsoid_take(arena, points, sizeof *surface->point);
    surface->corner = ellipsoid_take(arena, triangles, sizeof *surface->corner);
    surface->label = ellipsoid_take(arena, triangles, sizeof(int));
    surface->source = ellipsoid_take(arena, triangles, sizeof(int));
    return surface->source != NULL;
}

/* ----------------------------------------------------------------- size */

static size_t result_size(size_t count)
{
    return ellipsoid_piece(1, sizeof(ellipsoid_walls))
         + ellipsoid_piece(count, sizeof(ellipsoid_facet))
         + ellipsoid_flat_parts_size(count)
         + ellipsoid_piece(STARS * count, sizeof(double[3]))
         + ellipsoid_facet_tree_size(count);
}

/* Of what joins facets: lists of the triangles at points, and marks. */
static size_t joining_scratch(size_t points, size_t count)
{
    return 2 * ellipsoid_piece(3 * count, sizeof(int))
         + 2 * ellipsoid_piece(points, sizeof(int))
         + ellipsoid_flat_parts_scratch(count);
}

static size_t largest(size_t a, size_t b) { return a > b ? a : b; }

static int are_complete(const ellipsoid_triangles *t,
                        const ellipsoid_walls_options *options)
{
    return t && options && t->count >= 0 && t->point_count >= 0
        && (t->count == 0 || (t->point && t->corner))
        && options->image_count >= 0 && options->plane_count >= 0
        && (options->image_count == 0 || options->image)
        && (options->plane_count == 0 || options->plane)
        && options->same_point >= 0 && options->longest_edge >= 0
        && options->flat_depth >= 0;
}

/* The first triangle of which a corner is no point, or -1 */
static int find_astray(const ellipsoid_triangles *triangles)
{
    for (int t = 0; t < triangles->count; t++)
    {
        for (int k = 0; k < 3; k++)
        {
            const int corner = triangles->corner[t][k];

            if (corner < 0 || corner >= triangles->point_count)
            {
                return t;
            }
        }
    }
    return -1;
}

size_t ellipsoid_walls_size(const ellipsoid_triangles *triangles,
                            const ellipsoid_walls_options *options)
{
    size_t points, count, scratch;

    if (!are_complete(triangles, options))
    {
        return 0;
    }
    if (find_astray(triangles) >= 0)
    {
        /* which one ellipsoid_walls_create() says */
        return ellipsoid_piece(1, sizeof(ellipsoid_walls));
    }
    ellipsoid_images_count(triangles, options, &points, &count);
    if (3 * count > INT_MAX / 64)
    {
        return 0;
    }
    scratch = ellipsoid_images_scratch(points, triangles->point_count);
    scratch = largest(scratch, ellipsoid_flat_merging_scratch(points, count));
    scratch = largest(scratch, joining_scratch(points, count));
    scratch = largest(scratch, ellipsoid_facet_tree_scratch(count));
    return result_size(count) + ellipsoid_wall_surface_size(points, count)
         + scratch;
}

/* --------------------------------------------------------------- facets */

/* The triangles at each point: corner k of triangle t is node 3 t + k. */
typedef struct point_lists
{
    int *first, *next;
    int *marked;      /* which point a point was last found to be next to */
    int (*across)[3]; /* the facet that an edge leads to, or -1 */
} point_lists;

static void set_lists(const ellipsoid_wall_surface *s, ellipsoid_arena *scratch,
                      point_lists *lists)
{
    lists->next = ellipsoid_take(scratch, 3 * (size_t)s->count, sizeof(int));
    lists->first = ellipsoid_take(scratch, s->point_count, sizeof(int));
    lists->marked = ellipsoid_take(scratch, s->point_count, sizeof(int));
    lists->across = ellipsoid_take(scratch, s->count, sizeof *lists->across);
    for (int p = 0; p < s->point_count; p++)
    {
        lists->first[p] = lists->marked[p] = -1;
    }
    /* from behind, so that the lists ascend */
    for (int node = 3 * s->count - 1; node >= 0; node--)
    {
        int *first = &lists->first[s->corner[node / 3][node % 3]];

        lists->next[node] = *first;
        *first = node;
    }
}

/* Says how the wall turns at each edge of each facet. More than two facets
   share one where baffles join; where the wall ends it stays free. */
static void join_facets(const ellipsoid_wall_surface *s,
                        const point_lists *lists, ellipsoid_facet *facets)
{
    for (int t = 0; t < s->count; t++)
    {
        for (int k = 0; k < 3; k++)
        {
            const int from = s->corner[t][k], to = s->corner[t][(k + 1) % 3];

            lists->across[t][k] = -1;
            for (int node = lists->first[from]; node >= 0;
                 node = lists->next[node])
            {
                const int *other = s->corner[node / 3];

                if (node / 3 != t
                    && (other[0] == to || other[1] == to || other[2] == to)
                    && ellipsoid_facet_join(&facets[t], k, &facets[node / 3]))
                {
                    lists->across[t][k] = node / 3;
                }
            }
        }
    }
}

/* The directions of the edges that leave a point; returns how many. */
static int set_star(const ellipsoid_wall_surface *s, const point_lists *lists,
                    int point, double (*star)[3])
{
    int count = 0;

    for (int node = lists->first[point]; node >= 0; node = lists->next[node])
    {
        for (int k = 0; k < 3; k++)
        {
            const int other = s->corner[node / 3][k];

            if (other != point && lists->marked[other] != point)
            {
                double *r = star[count++], length;

                ellipsoid_difference(s->point[other], s->point[point], r);
                length = ellipsoid_length(r);
                ellipsoid_set(r, r[0] / length, r[1] / length, r[2] / length);
                lists->marked[other] = point;
            }
        }
    }
    return count;
}

/* Returns how many directions all stars have. */
static size_t set_stars(const ellipsoid_wall_surface *s,
                        const point_lists *lists, ellipsoid_facet *facets,
                        double (*stars)[3])
{
    size_t filled = 0;

    for (int point = 0; point < s->point_count; point++)
    {
        const int count = set_star(s, lists, point, &stars[filled]);

        for (int node = lists->first[point]; node >= 0;
             node = lists->next[node])
        {
            ellipsoid_facet *f = &facets[node / 3];

            f->star[node % 3] = (char *)&stars[filled] - (char *)f;
            f->star_count[node % 3] = count;
        }
        filled += count;
    }
    return filled;
}

/* 0 if a triangle has no area: *which, of the surface */
static int set_facets(const ellipsoid_wall_surface *s, int first_mirror,
                      ellipsoid_facet *facets, int *which)
{
    for (int t = 0; t < s->count; t++)
    {
        double vertex[3][3];

        for (int k = 0; k < 3; k++)
        {
            ellipsoid_copy(s->point[s->corner[t][k]], vertex[k]);
        }
        memset(&facets[t], 0, sizeof facets[t]);
        if (!ellipsoid_facet_set(&facets[t], (const double(*)[3])vertex))
        {
            *which = s->source[t];
            return 0;
        }
        facets[t].surface = s->label[t];
        facets[t].mirror = t >= first_mirror;
    }
    return 1;
}

/* --------------------------------------------------------------- create */

/* The surface of walls, then of planes of symmetry, which have no points in
   common with them. Returns how many triangles the walls have. */
static int set_surface(const ellipsoid_triangles *triangles,
                       const ellipsoid_walls_options *options,
                       ellipsoid_arena scratch, ellipsoid_wall_surface *all)
{
    int walls = 0;

    for (int mirror = 0; mirror < 1 + (triangles->mirror != NULL); mirror++)
    {
        ellipsoid_wall_surface part = {.point = all->point + all->point_count,
                                       .corner = all->corner + all->count,
                                       .label = all->label + all->count,
                                       .source = all->source + all->count};

        ellipsoid_images_set(triangles, options, mirror, scratch, &part);
        if (options->longest_edge > 0)
        {
            ellipsoid_flat_merge(options->longest_edge, scratch, &part);
        }
        for (int t = 0; t < part.count; t++)
        {
            for (int k = 0; k < 3; k++)
            {
                part.corner[t][k] += all->point_count;
            }
        }
        all->point_count += part.point_count;
        all->count += part.count;
        walls = mirror ? walls : part.count;
    }
    return walls;
}

/* What is not of the result lies behind the most that this may take. */
static ellipsoid_status fill(ellipsoid_walls *walls, size_t size,
                             const ellipsoid_triangles *triangles,
                             const ellipsoid_walls_options *options, int *which)
{
    size_t points, count;
    ellipsoid_wall_surface surface;
    ellipsoid_arena arena = {(char *)walls, size}, scratch;
    point_lists lists;
    ellipsoid_facet *facets;
    double(*stars)[3], (*planes)[2][3];
    int first_mirror;

    ellipsoid_images_count(triangles, options, &points, &count);
    scratch.next = (char *)walls + result_size(count);
    scratch.left = size - result_size(count);
    ellipsoid_wall_surface_take(&scratch, points, count, &surface);
    first_mirror = set_surface(triangles, options, scratch, &surface);

    ellipsoid_take(&arena, 1, sizeof *walls);
    facets = ellipsoid_take(&arena, surface.count, sizeof *facets);
    if (!set_facets(&surface, first_mirror, facets, which))
    {
        return ELLIPSOID_BAD_TRIANGLE;
    }
    {
        ellipsoid_arena rest = scratch;

        set_lists(&surface, &rest, &lists);
        join_facets(&surface, &lists, facets);
        planes = (double(*)[2][3])arena.next;
        ellipsoid_take(&arena,
                       ellipsoid_flat_parts_set(
                           options->flat_depth, (const int(*)[3])lists.across,
                           surface.count, rest, facets, planes),
                       sizeof *planes);
    }
    stars = (double(*)[3])arena.next;
    ellipsoid_take(&arena, set_stars(&surface, &lists, facets, stars),
                   sizeof *stars);
    ellipsoid_facet_tree_set(&walls->tree, facets, surface.count, &arena,
                             scratch);
    walls->count = surface.count;
    walls->facets = (char *)facets - (char *)walls;
    walls->bytes = arena.next - (char *)walls;
    return ELLIPSOID_OK;
}

ellipsoid_status ellipsoid_walls_create(void *memory, size_t size,
                                        const ellipsoid_triangles *triangles,
                                        const ellipsoid_walls_options *options,
                                        ellipsoid_walls **walls, int *which)
{
    const size_t needed = ellipsoid_walls_size(triangles, options);
    int astray;
    ellipsoid_status status;

    if (!memory || !walls || needed == 0 || size < needed)
    {
        return ELLIPSOID_BAD_ARGUMENT;
    }
    astray = find_astray(triangles);
    status = astray < 0 ? fill(memory, size, triangles, options, &astray)
                        : ELLIPSOID_BAD_TRIANGLE;
    if (which)
    {
        *which = astray;
    }
    if (status == ELLIPSOID_OK)
    {
        *walls = memory;
    }
    return status;
}

/* ------------------------------------------------------------------ ask */

size_t ellipsoid_walls_bytes(const ellipsoid_walls *walls)
{
    return walls->bytes;
}

const ellipsoid_facet *ellipsoid_walls_facets(const ellipsoid_walls *walls,
                                              int *count)
{
    if (count)
    {
        *count = walls->count;
    }
    return (const void *)((const char *)walls + walls->facets);
}

int ellipsoid_walls_search(const ellipsoid_walls *walls, const double centre[3],
                           double reach, double far, int room, int *index,
                           ellipsoid_facet_list *list)
{
    list->facets = ellipsoid_walls_facets(walls, NULL);
    list->index = index;
    list->reach = reach;
    list->count =
        ellipsoid_facet_tree_list(&walls->tree, centre, reach, room, index);
    if (list->count == 0)
    {
        list->reach = fmax(reach, ellipsoid_facet_tree_distance(
                                      &walls->tree, list->facets, centre, far));
    }
    return list->count;
}

int ellipsoid_walls_list(void *context, double t, const double centre[3],
                         double reach, ellipsoid_facet_list *list)
{
    const ellipsoid_walls_context *here = context;

    (void)t;
    return ellipsoid_walls_search(here->walls, centre, reach,
                                  ELLIPSOID_FAR_REACHES * reach, here->room,
                                  here->index, list)
                 > here->room
             ? -1
             : 0;
}

void ellipsoid_box(const double low[3], const double high[3],
                   double point[8][3], int corner[12][3])
{
    for (int p = 0; p < 8; p++)
    {
        for (int i = 0; i < 3; i++)
        {
            point[p][i] = p >> i & 1 ? high[i] : low[i];
        }
    }
    for (int side = 0; side < 6; side++)
    {
        const int axis = side / 2, upper = side % 2;
        const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3;
        /* seen against the axis, counter-clockwise */
        const int at = upper << axis;
        const int round[4] = {at, at + u, at + u + v, at + v};

        for (int half = 0; half < 2; half++)
        {
            int *c = corner[2 * side + half];

            c[0] = round[0];
            c[1] = round[upper ? 2 + half : 1 + half];
            c[2] = round[upper ? 1 + half : 2 + half];
        }
    }
}
