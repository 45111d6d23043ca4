/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_contactStatus.c - what contact answers where walls fail, a pose is not
    finite or facets are too many.
*/
#include "roomTest.h"

static void test_failures_have_names(void **unused)
{
    const ellipsoid_options options = test_paper_options();
    const ellipsoid_model model = test_model(&options);
    const double u[3] = {4 * um, 0, 0}, v[3] = {0, 4 * um, 0};
    const double corner[3] = {-2 * um, -2 * um, 0};
    double x[3] = {0, 0, 0.5 * um}, q[4] = {0, 0, 0, 1};
    wall_mesh mesh = room_of(0);
    counted_walls walls = {.mesh = &mesh};
    const ellipsoid_surroundings surroundings = around_counted(&walls);
    const double lying[3] = {cos(0.1), sin(0.1), 0};
    static ellipsoid_facet_cache cache;
    ellipsoid_contact contact;

    (void)unused;
    ellipsoid_facet_cache_clear(&cache);
    walls.answer = 1;
    assert_int_equal(
        evaluate_pose(&model, &surroundings, x, q, &cache, &contact, NULL),
        ELLIPSOID_STEP_UNDERFLOW);
    walls.answer = -1;
    assert_int_equal(
        evaluate_pose(&model, &surroundings, x, q, &cache, &contact, NULL),
        ELLIPSOID_WALLS_FAILED);
    walls.answer = 0;
    x[1] = NAN;
    assert_int_equal(
        evaluate_pose(&model, &surroundings, x, q, &cache, &contact, NULL),
        ELLIPSOID_NON_FINITE);
    x[1] = 0;
    mesh.facets[0].middle[2] = INFINITY;
    walls.farther = 100 * um;
    ellipsoid_facet_cache_clear(&cache);
    assert_int_equal(
        evaluate_pose(&model, &surroundings, x, q, &cache, &contact, NULL),
        ELLIPSOID_NON_FINITE);
    wall_mesh_free(&mesh);

    /* facets of 10 nm: smaller margins, and then too many */
    wall_mesh_init(&mesh);
    wall_mesh_plane(&mesh, corner, u, v, 400, 400, 0, 0);
    wall_mesh_finish(&mesh);
    walls.farther = 0;
    ellipsoid_quaternion_from_axis(lying, 0, q);
    ellipsoid_facet_cache_clear(&cache);
    assert_ok(
        evaluate_pose(&model, &surroundings, x, q, &cache, &contact, NULL));
    /* nor does a cache that holds facets take it for a pose near its own */
    x[1] = NAN;
    assert_int_equal(
        evaluate_pose(&model, &surroundings, x, q, &cache, &contact, NULL),
        ELLIPSOID_NON_FINITE);
    x[1] = 0;
    wall_mesh_free(&mesh);
    wall_mesh_init(&mesh);
    wall_mesh_plane(&mesh, corner, u, v, 4, 40000, 0, 0);
    wall_mesh_finish(&mesh);
    ellipsoid_facet_cache_clear(&cache);
    assert_int_equal(
        evaluate_pose(&model, &surroundings, x, q, &cache, &contact, NULL),
        ELLIPSOID_TOO_MANY_FACETS);
    wall_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_failures_have_names),
    };

    return cmocka_run_group_tests_name("contactStatus", tests, NULL, NULL);
}
