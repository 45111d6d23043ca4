/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    roomTest.h - a room for cells to touch, and their force's derivatives.
*/
#ifndef ROOM_TEST_H
#define ROOM_TEST_H

#include "coreTest.h"
#include "wallMesh.h"

static const double um = 1e-6;

/* The contact of a cell at rest. */
static inline ellipsoid_status
evaluate_pose(const ellipsoid_model *model,
              const ellipsoid_surroundings *around_it, const double x[3],
              const double q[4], ellipsoid_facet_cache *cache,
              ellipsoid_contact *contact, ellipsoid_wrench_jacobian *jacobian)
{
    ellipsoid_state state = {.u = {0}};

    memcpy(state.x, x, sizeof(state.x));
    memcpy(state.q, q, sizeof(state.q));
    return ellipsoid_contact_evaluate(model, around_it, &state, cache, contact,
                                      jacobian);
}

/* Walls that count their calls and answer as told. */
typedef struct counted_walls
{
    wall_mesh *mesh;
    int calls, answer;
    double farther; /* [m] reach of the list beyond that asked for */
} counted_walls;

static inline int counted(void *context, double t, const double centre[3],
                          double reach, ellipsoid_facet_list *list)
{
    counted_walls *walls = context;

    walls->calls++;
    wall_mesh_list(walls->mesh, t, centre, reach + walls->farther, list);
    return walls->answer;
}

static inline ellipsoid_surroundings around_counted(counted_walls *walls)
{
    const ellipsoid_surroundings surroundings = {.walls = counted,
                                                 .walls_context = walls};

    return surroundings;
}

/* A box of fluid with a ridge and a step on its floor: all kinds of edges. */
static inline wall_mesh room_of(int diagonal)
{
    const double low[3] = {-6 * um, -6 * um, 0};
    const double high[3] = {6 * um, 6 * um, 12 * um};
    const double ridge_low[3] = {0.5 * um, -4 * um, -1 * um};
    const double ridge_high[3] = {1.5 * um, 4 * um, 2 * um};
    wall_mesh mesh;

    wall_mesh_init(&mesh);
    wall_mesh_box(&mesh, low, high, 1, diagonal, 1);
    wall_mesh_box(&mesh, ridge_low, ridge_high, 0, 1 - diagonal, 2);
    wall_mesh_finish(&mesh);
    return mesh;
}

/* Somewhere near the floor, the ridge, a wall or a corner. */
static inline void random_pose(uint64_t *seed, double x[3], double q[4])
{
    x[0] = 6 * um * test_signed(seed);
    x[1] = 6 * um * test_signed(seed);
    x[2] = (0.4 + 2.5 * test_uniform(seed)) * um;
    test_orientation(seed, q);
}

/*
    Derivatives against differences at a pose, q of any length, each component
    by itself. Returns whether they could be compared: beads that begin to touch
    within the difference have no slope yet.
*/
static inline int assert_jacobian(const ellipsoid_model *model,
                                  const ellipsoid_surroundings *surroundings,
                                  ellipsoid_facet_cache *cache,
                                  const double pose[7], double tolerance)
{
    ellipsoid_contact contact, moved;
    ellipsoid_wrench_jacobian exact;
    double y[7], difference[7][6];
    int smooth;

    memcpy(y, pose, sizeof y);
    assert_ok(
        evaluate_pose(model, surroundings, y, y + 3, cache, &contact, &exact));
    smooth = contact.deepest > 0.002 * um && contact.deepest < 0.2 * um;
    for (int k = 0; k < 7; k++)
    {
        const double h = k < 3 ? 1e-6 * um : 1e-6;
        const double middle = y[k];

        for (int side = -1; side <= 1; side += 2)
        {
            y[k] = middle + side * h;
            assert_ok(evaluate_pose(model, surroundings, y, y + 3, cache,
                                    &moved, NULL));
            smooth = smooth && moved.bead_contacts == contact.bead_contacts;
            for (int i = 0; i < 3; i++)
            {
                const double f = side * moved.force[i] / (2 * h);
                const double t = side * moved.torque[i] / (2 * h);

                difference[k][i] = side < 0 ? f : difference[k][i] + f;
                difference[k][i + 3] = side < 0 ? t : difference[k][i + 3] + t;
            }
        }
        y[k] = middle;
    }
    for (int k = 0; k < 7 && smooth; k++)
    {
        /* stiffness of one bead at this depth, times the arms */
        const double stiffness = 1e6 * sqrt(contact.deepest * 0.3 * um);
        const double arm = k < 3 ? 1 : 4 * um;

        for (int i = 0; i < 3; i++)
        {
            const double f =
                k < 3 ? exact.force_x[i][k] : exact.force_q[i][k - 3];
            const double t =
                k < 3 ? exact.torque_x[i][k] : exact.torque_q[i][k - 3];

            assert_near(f, difference[k][i], tolerance * stiffness * arm);
            assert_near(t, difference[k][i + 3],
                        tolerance * stiffness * arm * 2 * um);
        }
    }
    return smooth;
}

#endif
