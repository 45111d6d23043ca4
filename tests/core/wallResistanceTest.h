/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    wallResistanceTest.h - the resistance of a cell among walls, and a landscape
    of them.
*/
#ifndef WALL_RESISTANCE_TEST_H
#define WALL_RESISTANCE_TEST_H

#include "nearWallTest.h"

static ellipsoid_facet_cache cache;

/* The resistance [N s/m, ...] in the lab: what the drag does against velocities
   and angular velocities, one by one, in a fluid at rest. */
static inline void lab_resistance(const ellipsoid_model *m, wall_mesh *mesh,
                                  const double x[3], const double q[4],
                                  double matrix[6][6])
{
    test_quadratic rest = {.answer = 0};
    const ellipsoid_surroundings s = around(mesh, &rest);
    double r[3][3];

    ellipsoid_rotation(q, r);
    for (int n = 0; n < 6; n++)
    {
        ellipsoid_state state = {.u = {0}}, derivative;

        ellipsoid_copy(x, state.x);
        memcpy(state.q, q, sizeof(state.q));
        if (n < 3)
        {
            state.u[n] = 1e-9;
        }
        else
        {
            ellipsoid_copy(r[n - 3], state.omega);
            ellipsoid_set(state.omega, 1e-3 * r[n - 3][0], 1e-3 * r[n - 3][1],
                          1e-3 * r[n - 3][2]);
        }
        assert_ok(ellipsoid_rhs(m, &s, &state, &cache, &derivative));
        for (int i = 0; i < 3; i++)
        {
            matrix[i][n] = -m->mass * derivative.u[i];
            matrix[i + 3][n] = -m->inertia[i] * derivative.omega[i];
        }
    }
}

/* The planes at a pose, in a fluid at rest. */
static inline ellipsoid_planes planes_at(const ellipsoid_model *model,
                                         wall_mesh *mesh,
                                         const ellipsoid_state *state)
{
    test_quadratic still = {.answer = 0};
    const ellipsoid_surroundings s = around(mesh, &still);
    ellipsoid_planes planes;

    ellipsoid_facet_cache_clear(&cache);
    assert_ok(ellipsoid_find_planes(model, &s, state, 0, &cache, &planes));
    return planes;
}

/* The largest relative difference of the columns of two resistances. */
static inline double difference(double a[6][6], double b[6][6])
{
    double worst = 0;

    for (int n = 0; n < 6; n++)
    {
        for (int first = 0; first < 6; first += 3)
        {
            double size = 0, error = 0;

            for (int i = first; i < first + 3; i++)
            {
                size += a[i][n] * a[i][n];
                error += pow(a[i][n] - b[i][n], 2);
            }
            worst = (first == 0) == (n < 3) ? fmax(worst, sqrt(error / size))
                                            : worst;
        }
    }
    return worst;
}

/* A shallow step, a ridge, a corner and a lid: planes, edges and vertices, all
   in range. */
static inline void add_landscape(wall_mesh *mesh)
{
    const double low[3] = {-6e-6, -6e-6, -4e-6}, high[3] = {6e-6, 6e-6, 4e-6};
    const double block[2][3] = {{2e-6, -7e-6, -5e-6}, {7e-6, 0, -2e-6}};

    wall_mesh_box(mesh, low, high, 1, 2, 0);
    wall_mesh_box(mesh, block[0], block[1], 0, 2, 0);
}

#endif
