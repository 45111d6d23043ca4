/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    flatParts.c - parts of a wall that are flat but for a given depth.

    A curved wall of a fine mesh has a plane for each of its facets, of which a
    body would meet hundreds; and a plane wall of which the points are rounded
    has, too. What walls add to the resistance is that of a few planes.
*/
#include "walls/wallSurface.h"

#include <math.h>

/* Less than this is the cosine between normals of the two sides of a sheet. */
static const double facing = 0.5;

size_t ellipsoid_flat_parts_size(size_t triangles)
{
    return ellipsoid_piece(triangles, sizeof(double[2][3]));
}

size_t ellipsoid_flat_parts_scratch(size_t triangles)
{
    return 2 * ellipsoid_piece(triangles, sizeof(int));
}

static int is_in_plane(const ellipsoid_facet *plane, const ellipsoid_facet *f,
                       double depth)
{
    int in = ellipsoid_dot(plane->normal, f->normal) > facing;

    for (int k = 0; in && k < 3; k++)
    {
        double d[3];

        ellipsoid_difference(f->vertex[k], plane->middle, d);
        in = fabs(ellipsoid_dot(d, plane->normal)) <= depth;
    }
    return in;
}

/* The facet across edge k of t, if the way back leads to t, or -1: where
   sheets meet it may not. */
static int neighbour(const int (*across)[3], int t, int k)
{
    const int other = across[t][k];
    const int *back = other < 0 ? NULL : across[other];

    return back && (back[0] == t || back[1] == t || back[2] == t) ? other : -1;
}

/* The facets of part number `part`, from `first` on, into queue[]; returns how
   many. part_of: of each facet, -1: of none so far */
static int grow(double depth, const int (*across)[3],
                const ellipsoid_facet *facets, int first, int part,
                int *part_of, int *queue)
{
    int count = 1;

    part_of[first] = part;
    queue[0] = first;
    for (int done = 0; done < count; done++)
    {
        const int t = queue[done];

        for (int k = 0; k < 3; k++)
        {
            const int other = neighbour(across, t, k);

            if (other >= 0 && part_of[other] < 0
                && (facets[t].edge[k] == ELLIPSOID_EDGE_FLAT
                    || is_in_plane(&facets[first], &facets[other], depth)))
            {
                part_of[other] = part;
                queue[count++] = other;
            }
        }
    }
    return count;
}

/* The plane of these facets: their centre of area, and its normal. */
static void set_plane(const ellipsoid_facet *facets, const int *of, int count,
                      double plane[2][3])
{
    const double *base = facets[of[0]].middle;
    double normal[3] = {0}, middle[3] = {0}, length, whole = 0;

    for (int n = 0; n < count; n++)
    {
        const ellipsoid_facet *f = &facets[of[n]];
        double side[2][3], across[3], from[3], area;

        ellipsoid_difference(f->vertex[1], f->vertex[0], side[0]);
        ellipsoid_difference(f->vertex[2], f->vertex[0], side[1]);
        ellipsoid_cross(side[0], side[1], across);
        area = ellipsoid_length(across);
        ellipsoid_difference(f->middle, base, from);
        for (int i = 0; i < 3; i++)
        {
            normal[i] += area * f->normal[i];
            middle[i] += area * from[i];
        }
        whole += area;
    }
    length = ellipsoid_length(normal);
    for (int i = 0; i < 3; i++)
    {
        plane[0][i] = base[i] + middle[i] / whole;
        plane[1][i] = normal[i] / length;
    }
}

int ellipsoid_flat_parts_set(double depth, const int (*across)[3], int count,
                             ellipsoid_arena scratch, ellipsoid_facet *facets,
                             double (*planes)[2][3])
{
    int *part_of = ellipsoid_take(&scratch, count, sizeof(int));
    int *queue = ellipsoid_take(&scratch, count, sizeof(int));
    int parts = 0;

    for (int t = 0; t < count; t++)
    {
        part_of[t] = -1;
    }
    for (int t = 0; t < count; t++)
    {
        int grown;

        if (part_of[t] >= 0)
        {
            continue;
        }
        grown = grow(depth, across, facets, t, parts, part_of, queue);
        set_plane(facets, queue, grown, planes[parts]);
        for (int n = 0; n < grown; n++)
        {
            ellipsoid_facet *f = &facets[queue[n]];

            f->plane = (char *)planes[parts] - (char *)f;
            f->within = 0;
            for (int k = 0; k < 3; k++)
            {
                const int other = neighbour(across, queue[n], k);

                f->within |= (other >= 0 && part_of[other] == parts) << k;
            }
        }
        parts++;
    }
    return parts;
}
