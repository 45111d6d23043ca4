/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_overlap.c - whether an ellipsoid cuts a wall, against its support function:
    the farthest it reaches along a unit vector n is sqrt(sum (a_i n^_i)^2).
*/
#include "coreTest.h"
#include "wallMesh.h"

static const double um = 1e-6;

static int overlaps(wall_mesh *mesh, const double x[3], const double q[4])
{
    const ellipsoid_options options = test_paper_options();
    const ellipsoid_surroundings around = {.walls = wall_mesh_list,
                                           .walls_context = mesh};
    static ellipsoid_model model;
    int result = -1;

    assert_ok(ellipsoid_model_init(&model, &options));
    assert_ok(ellipsoid_overlaps_walls(&model, &around, x, q, &result));
    return result;
}

/* Over a plane of many facets the height at which it touches is the support along
   the normal: overlap just below, none just above nor there, for any orientation. */
static void test_plane(void **unused)
{
    const double corner[3] = {-20 * um, -20 * um, 0};
    const double u[3] = {40 * um, 0, 0}, v[3] = {0, 40 * um, 0};
    const double a[3] = {0.5 * um, 2 * um, 0.5 * um};
    uint64_t seed = 3;
    wall_mesh mesh;

    (void)unused;
    wall_mesh_init(&mesh);
    wall_mesh_plane(&mesh, corner, u, v, 40, 40, 2, 0);
    wall_mesh_finish(&mesh);

    for (int n = 0; n < 200; n++)
    {
        const double uniform[3] = {test_uniform(&seed), test_uniform(&seed),
                                   test_uniform(&seed)};
        double q[4], r[3][3], x[3] = {0.3 * um, -0.2 * um, 0}, reach = 0;

        ellipsoid_quaternion_from_uniform(uniform, q);
        ellipsoid_rotation(q, r);
        for (int i = 0; i < 3; i++)
        {
            reach += a[i] * a[i] * r[2][i] * r[2][i];
        }
        reach = sqrt(reach);
        x[2] = reach * (1 - 1e-9);
        assert_int_equal(overlaps(&mesh, x, q), 1);
        x[2] = reach * (1 + 1e-9);
        assert_int_equal(overlaps(&mesh, x, q), 0);
        x[2] = reach;
        assert_int_equal(overlaps(&mesh, x, q), 0);
    }
    wall_mesh_free(&mesh);
}

/* Beside the convex edge of a bar, and with a corner of it, as the unit sphere sees
   them: |A^-1 R^T (p - x)| = 1 at the touch of a point p. */
static void test_edge_and_corner(void **unused)
{
    const double low[3] = {0, 0, 0}, high[3] = {5 * um, 5 * um, 5 * um};
    const double upright[4] = {0, 0, 0, 1};
    /* from the edge x1 = x2 = 0 along -(0.5, 2)/sqrt(2), where u = (1, 1)/sqrt(2) */
    const double s = 1 / sqrt(2.0), c = 1 / sqrt(3.0);
    const double scale[2] = {1 - 1e-9, 1 + 1e-9};
    wall_mesh mesh;

    (void)unused;
    wall_mesh_init(&mesh);
    wall_mesh_box(&mesh, low, high, 0, 0, 0);
    wall_mesh_finish(&mesh);

    for (int k = 0; k < 2; k++)
    {
        const double edge[3] = {-0.5 * um * s * scale[k],
                                -2 * um * s * scale[k], 2.5 * um};
        const double corner[3] = {-0.5 * um * c * scale[k],
                                  -2 * um * c * scale[k],
                                  -0.5 * um * c * scale[k]};

        assert_int_equal(overlaps(&mesh, edge, upright), k == 0);
        assert_int_equal(overlaps(&mesh, corner, upright), k == 0);
    }
    wall_mesh_free(&mesh);
}

/* A tip through a wall and out behind it is found too: no bead is near the wall
   there, only the body itself. */
static void test_poking_through(void **unused)
{
    const double corner[3] = {0, -20 * um, -20 * um};
    const double u[3] = {0, 0, 40 * um}, v[3] = {0, 40 * um, 0};
    const double along[3] = {1, 0, 0}, x[3] = {-0.9 * um, 0, 0};
    double q[4];
    wall_mesh mesh;

    (void)unused;
    wall_mesh_init(&mesh);
    wall_mesh_plane(&mesh, corner, u, v, 1, 1, 0, 0);
    wall_mesh_finish(&mesh);
    ellipsoid_quaternion_from_axis(along, 0, q);
    assert_int_equal(overlaps(&mesh, x, q), 1);
    wall_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_plane),
        cmocka_unit_test(test_edge_and_corner),
        cmocka_unit_test(test_poking_through),
    };

    return cmocka_run_group_tests_name("overlap", tests, NULL, NULL);
}
