/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    wallMesh.h - walls for tests: a soup of triangles becomes facets that know
    their neighbours, and an ellipsoid_walls_function that lists them.
*/
#ifndef WALL_MESH_H
#define WALL_MESH_H

#include "ellipsoid.h"

typedef struct wall_mesh
{
    ellipsoid_facet *facets;
    int *index; /* 0, 1, ...: all of them */
    int count;

    /* implementation */
    int capacity;
    double (*stars)[3];
    int *listed;
} wall_mesh;

/* All facets, for ellipsoid_bead_force(). */
static inline ellipsoid_facet_list wall_mesh_all(const wall_mesh *mesh)
{
    return (ellipsoid_facet_list){
        .facets = mesh->facets, .index = mesh->index, .count = mesh->count};
}

/* A point to a point: a grid point to its place. */
typedef void (*wall_mesh_map)(const double *uv, double point[3], void *context);

void wall_mesh_init(wall_mesh *mesh);
void wall_mesh_free(wall_mesh *mesh);

/* Counter-clockwise seen from the fluid. Corners that shall be one vertex must
   be equal to the last bit. */
void wall_mesh_triangle(wall_mesh *mesh, const double a[3], const double b[3],
                        const double c[3], int surface);

/* Two triangles; diagonal 0: from a to c, 1: from b to d. */
void wall_mesh_quad(wall_mesh *mesh, const double a[3], const double b[3],
                    const double c[3], const double d[3], int diagonal,
                    int surface);

/* Quads of a grid of nu x nv cells on [0,1]^2, mapped; (u, v, fluid) is
   right-handed. diagonal: 0, 1, or 2 for both in turn. */
void wall_mesh_grid(wall_mesh *mesh, int nu, int nv, wall_mesh_map map,
                    void *context, int diagonal, int surface);

/* The parallelogram from corner along u and v. */
void wall_mesh_plane(wall_mesh *mesh, const double corner[3], const double u[3],
                     const double v[3], int nu, int nv, int diagonal,
                     int surface);

/* An axis-parallel box; inwards 1: the fluid is inside, 0: outside. */
void wall_mesh_box(wall_mesh *mesh, const double low[3], const double high[3],
                   int inwards, int diagonal, int surface);

/* Normals, edges and stars; call once, after the last triangle. */
void wall_mesh_finish(wall_mesh *mesh);

/* An ellipsoid_walls_function; context is a wall_mesh. */
int wall_mesh_list(void *context, double t, const double centre[3],
                   double reach, ellipsoid_facet_list *list);

#endif
