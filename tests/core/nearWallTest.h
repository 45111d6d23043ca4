/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    nearWallTest.h - cells with the drag near walls made of facets.
*/
#ifndef NEAR_WALL_TEST_H
#define NEAR_WALL_TEST_H

#include "coreTest.h"
#include "flowTest.h"
#include "wallMesh.h"

static inline ellipsoid_options near_walls(void)
{
    ellipsoid_options o = test_free_cell();

    o.wall_resistance = ELLIPSOID_WALL_RESISTANCE_PLANE;
    return o;
}

static inline ellipsoid_surroundings around(wall_mesh *mesh,
                                            test_quadratic *flow)
{
    const ellipsoid_surroundings surroundings = {.flow = test_quadratic_flow,
                                                 .flow_context = flow,
                                                 .walls = wall_mesh_list,
                                                 .walls_context = mesh};

    return surroundings;
}

/* A plane x3 = height of 100 um, in nu x nv quads. */
static inline void add_floor(wall_mesh *mesh, double height, int nu, int nv)
{
    const double corner[3] = {-5e-5, -5e-5, height};
    const double along[3] = {1e-4, 0, 0}, across[3] = {0, 1e-4, 0};

    wall_mesh_plane(mesh, corner, along, across, nu, nv, 2, 0);
}

#endif
