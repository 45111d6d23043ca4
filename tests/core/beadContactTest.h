/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    beadContactTest.h - walls that one bead meets. Lengths are in bead radii and
    stiffness is 1: the force is homogeneous in both.
*/
#ifndef TOUCH_TEST_H
#define TOUCH_TEST_H

#include "coreTest.h"
#include "wallMesh.h"

static const double r = 1;

static inline int touch(const wall_mesh *wall, const double x[3],
                        double force[3])
{
    const ellipsoid_facet_list facets = wall_mesh_all(wall);

    return ellipsoid_bead_force(x, r, 1, &facets, force, NULL);
}

static inline double distance(const double a[3], const double b[3])
{
    double d[3];

    ellipsoid_difference(a, b, d);
    return sqrt(ellipsoid_dot(d, d));
}

/* The floor z = 0, |x|, |y| <= size. */
static inline wall_mesh floor_of(double size, int cells, int diagonal)
{
    const double corner[3] = {-size, -size, 0};
    const double u[3] = {2 * size, 0, 0}, v[3] = {0, 2 * size, 0};
    wall_mesh wall;

    wall_mesh_init(&wall);
    wall_mesh_plane(&wall, corner, u, v, cells, cells, diagonal, 0);
    wall_mesh_finish(&wall);
    return wall;
}

static inline wall_mesh box_of(double size, int inwards, int diagonal)
{
    const double low[3] = {-size, -size, -size}, high[3] = {size, size, size};
    wall_mesh wall;

    wall_mesh_init(&wall);
    wall_mesh_box(&wall, low, high, inwards, diagonal, 0);
    wall_mesh_finish(&wall);
    return wall;
}

/* Two planes that meet in the line x = z = 0; their normals lean by `lean` to
   either side of z. lean > 0: a valley; < 0: a ridge. */
static inline wall_mesh wedge_of(double lean, int cells, int diagonal)
{
    const double c = 5 * cos(lean), s = 5 * sin(lean);
    const double left[3] = {-c, -5, s}, right[3] = {0, -5, 0};
    const double down[3] = {c, 0, -s}, up[3] = {c, 0, s}, y[3] = {0, 10, 0};
    wall_mesh wall;

    wall_mesh_init(&wall);
    wall_mesh_plane(&wall, left, down, y, cells, cells, diagonal, 0);
    wall_mesh_plane(&wall, right, up, y, cells, cells, diagonal, 1);
    wall_mesh_finish(&wall);
    return wall;
}

typedef struct terrain
{
    int n;
    double height[41][41], shift[41][41][2];
} terrain;

static inline void on_terrain(const double *uv, double point[3], void *context)
{
    const terrain *t = context;
    const int i = (int)lround(uv[0] * t->n), j = (int)lround(uv[1] * t->n);

    point[0] = i + t->shift[i][j][0];
    point[1] = j + t->shift[i][j][1];
    point[2] = t->height[i][j];
}

static inline wall_mesh terrain_of(double slope, uint64_t *seed)
{
    terrain t = {.n = 40};
    wall_mesh wall;

    for (int i = 0; i <= t.n; i++)
    {
        for (int j = 0; j <= t.n; j++)
        {
            t.height[i][j] = slope * test_signed(seed);
            t.shift[i][j][0] = 0.3 * test_signed(seed);
            t.shift[i][j][1] = 0.3 * test_signed(seed);
        }
    }
    wall_mesh_init(&wall);
    wall_mesh_grid(&wall, t.n, t.n, on_terrain, &t, 2, 0);
    wall_mesh_finish(&wall);
    return wall;
}

#endif
