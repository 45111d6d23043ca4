/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    nearWallTest.h - cells with the drag near walls made of facets.
*/
#ifndef NEAR_WALL_TEST_H
#define NEAR_WALL_TEST_H

#include "coreTest.h"
#include "drag/drag.h"
#include "flowTest.h"
#include "wallMesh.h"

/* A sphere at a plane: Goldman, Cox & Brenner, Chem. Eng. Sci. 22, 637 (1967),
   table 2, one that translates along the plane or turns; 653, table 1, one held
   in a shear. h/a; force and torque by translation, torque by rotation; force
   and torque of the shear, over 6 pi mu a U, 8 pi mu a^2 U, 8 pi mu a^3 omega,
   6 pi mu a h S, 4 pi mu a^3 S. */
static const struct goldman
{
    double height, force_u, torque_u, torque_omega, force_s, torque_s;
} goldman[] = {{10.0677, 1.0591, 8.77e-6, 1.0003, 1.0587, 0.99981},
               {3.7622, 1.1738, 4.21e-4, 1.0059, 1.1671, 0.99711},
               {2.3524, 1.3079, 2.6425e-3, 1.0250, 1.2780, 0.99010},
               {1.5431, 1.5675, 1.4649e-2, 1.0998, 1.4391, 0.97419},
               {1.1276, 2.1514, 7.3718e-2, 1.3877, 1.6160, 0.95374},
               {1.0453, 2.6475, 0.14552, 1.7006, 1.6682, 0.94769},
               {1.005004, 3.7863, 0.34187, 2.5056, 1.6969, 0.94442},
               {1.003202, 4.0223, 0.38494, 2.6793, 1.6982, 0.94427}};

/* Brenner, Chem. Eng. Sci. 16, 242 (1961), eq. 2.19: the drag of a sphere that
   moves towards a plane, over 6 pi mu a. */
static inline double brenner_towards(double height)
{
    const double alpha = acosh(height);
    double sum = 0;

    for (int n = 1; n * alpha < 40; n++)
    {
        const double wide = sinh((n + 0.5) * alpha), odd = 2 * n + 1;

        sum += n * (n + 1.0) / ((2 * n - 1.0) * (2 * n + 3.0))
             * ((2 * sinh(odd * alpha) + odd * sinh(2 * alpha))
                    / (4 * wide * wide - odd * odd * sinh(alpha) * sinh(alpha))
                - 1);
    }
    return 4.0 / 3 * sinh(alpha) * sum;
}

static inline ellipsoid_options near_walls(void)
{
    ellipsoid_options o = test_free_cell();

    o.wall_resistance = ELLIPSOID_WALL_RESISTANCE_PLANE;
    o.wall_range = 4e-6;
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

/* Both actions of a plane over mu on a body which a free one outruns by `rates`, of
   which the last three are the shear. */
static inline void action_of(const ellipsoid_plane_effect *effect,
                             const double rates[9], const double velocity[6],
                             double action[2][6])
{
    ellipsoid_dual motion[9], both[2][6];

    for (int n = 0; n < 9; n++)
    {
        motion[n] = rates[n];
    }
    ellipsoid_plane_action(&effect->by_gap, motion, velocity, both);
    for (int n = 0; n < 12; n++)
    {
        action[n / 6][n % 6] = creal(both[n / 6][n % 6]);
    }
}

/* A plane x3 = height of 100 um, in nu x nv quads. */
static inline void add_floor(wall_mesh *mesh, double height, int nu, int nv)
{
    const double corner[3] = {-5e-5, -5e-5, height};
    const double along[3] = {1e-4, 0, 0}, across[3] = {0, 1e-4, 0};

    wall_mesh_plane(mesh, corner, along, across, nu, nv, 2, 0);
}

/* A tunnel (sign 1) or a post (-1) along x2, touched from within or outside by
   x3 = 0. */
typedef struct arc
{
    double sign, radius;
} arc;

static inline void bend(const double *uv, double point[3], void *context)
{
    const arc *a = context;
    const double angle = 2 * test_pi * (uv[0] - 0.5);
    const double across = fabs(sin(angle)) < 1e-9 ? 0 : sin(angle);

    ellipsoid_set(point, a->radius * across, 6e-5 * (uv[1] - 0.5),
                  a->sign * a->radius * (1 - cos(angle)));
}

#endif
