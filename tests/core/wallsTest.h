/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    wallsTest.h - what the tests of walls made of triangles share.
*/
#ifndef WALLS_TEST_H
#define WALLS_TEST_H

#include "coreTest.h"
#include "wallMesh.h"

/* Triangles in memory of the test's, and the walls made of them */
typedef struct made_walls
{
    double (*point)[3];
    int (*corner)[3];
    int *label, *mirror;
    ellipsoid_triangles triangles;
    ellipsoid_walls_options options;
    void *memory;
    ellipsoid_walls *walls;
    const ellipsoid_facet *facets;
    int count, which;
} made_walls;

/* Each triangle of the mesh with three points of its own, as in an STL */
static inline made_walls triangles_of(const wall_mesh *mesh)
{
    made_walls m = {.which = -1};

    m.point = malloc(3 * mesh->count * sizeof *m.point);
    m.corner = malloc(mesh->count * sizeof *m.corner);
    m.label = malloc(mesh->count * sizeof *m.label);
    m.mirror = calloc(mesh->count, sizeof *m.mirror);
    for (int f = 0; f < mesh->count; f++)
    {
        for (int k = 0; k < 3; k++)
        {
            m.corner[f][k] = 3 * f + k;
            memcpy(m.point[3 * f + k], mesh->facets[f].vertex[k],
                   sizeof m.point[0]);
        }
        m.label[f] = mesh->facets[f].surface;
    }
    m.triangles = (ellipsoid_triangles){.point_count = 3 * mesh->count,
                                        .point = (const double(*)[3])m.point,
                                        .count = mesh->count,
                                        .corner = (const int(*)[3])m.corner,
                                        .label = m.label};
    m.options.same_point = 1e-9;
    return m;
}

static inline ellipsoid_status create(made_walls *m)
{
    const size_t size = ellipsoid_walls_size(&m->triangles, &m->options);
    ellipsoid_status status;

    assert_true(size > 0);
    free(m->memory);
    m->memory = malloc(size);
    status = ellipsoid_walls_create(m->memory, size, &m->triangles, &m->options,
                                    &m->walls, &m->which);
    if (status == ELLIPSOID_OK)
    {
        assert_true(ellipsoid_walls_bytes(m->walls) <= size);
        m->facets = ellipsoid_walls_facets(m->walls, &m->count);
    }
    return status;
}

static inline void destroy(made_walls *m)
{
    free(m->point);
    free(m->corner);
    free(m->label);
    free(m->mirror);
    free(m->memory);
}

/* [m2] of all facets of a label */
static inline double area_of(const made_walls *m, int label)
{
    double area = 0;

    for (int f = 0; f < m->count; f++)
    {
        const ellipsoid_facet *a = &m->facets[f];
        double u[3], v[3], w[3];

        ellipsoid_difference(a->vertex[1], a->vertex[0], u);
        ellipsoid_difference(a->vertex[2], a->vertex[0], v);
        ellipsoid_cross(u, v, w);
        area += a->surface == label ? 0.5 * ellipsoid_length(w) : 0;
    }
    return area;
}

#endif
