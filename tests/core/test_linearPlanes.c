/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    test_linearPlanes.c - planes near a wall, linear in the pose.
*/
#include "nearWallTest.h"
#include "drag/wallResistance.h"

static ellipsoid_facet_cache cache;

/* The drag (F^, T^) at a pose on unit rates, of planes found there; and if asked
   for, these planes with their slopes. */
static void drag_at(const ellipsoid_model *model,
                    const ellipsoid_surroundings *around,
                    const ellipsoid_state *state, double action[6],
                    ellipsoid_linear_planes *linear)
{
    const double rates[6] = {1, 1, 1, 1e6, 1e6, 1e6};
    ellipsoid_planes planes;
    ellipsoid_frame frame;
    double by_q[4][3][3];
    double r[3][3];

    ellipsoid_rotation(state->q, r);
    ellipsoid_axis_derivatives(state->q, by_q);
    frame.by_q = linear ? by_q : NULL;
    for (int i = 0; i < 3; i++)
    {
        ellipsoid_set(frame.axis[i], r[0][i], r[1][i], r[2][i]);
    }
    assert_ok(ellipsoid_find_planes(model, around, state, &frame, &cache,
                                    &planes));
    assert_true(ellipsoid_wall_action(model, &planes, rates, action));
    if (linear)
    {
        ellipsoid_linear_planes_set(&planes, state, rates, linear);
    }
}

/* Planes that are linear in the pose leave out what is of second order in the
   way, beside an edge and a corner of a block. */
static void test_linear_planes(void **unused)
{
    const double low[3] = {-2e-6, -2e-6, -3e-6}, high[3] = {2e-6, 2e-6, 0};
    const ellipsoid_options o = near_walls();
    const ellipsoid_model model = test_model(&o);
    test_quadratic flow = test_shear(1000);
    ellipsoid_surroundings s;
    wall_mesh mesh;

    (void)unused;
    wall_mesh_init(&mesh);
    wall_mesh_box(&mesh, low, high, 0, 3, 0);
    wall_mesh_finish(&mesh);
    s = around(&mesh, &flow);
    ellipsoid_facet_cache_clear(&cache);
    for (int n = 0; n < 2; n++)
    {
        const ellipsoid_state start = {.x = {2.3e-6, n ? 2.2e-6 : 0.2e-6, 2e-6},
                                       .q = {0.1, 0.3, 0.2, 0.927361849549570}};
        const double turn[4] = {0.2, 0.1, -0.1, 0};
        ellipsoid_linear_planes linear;
        double action[6], off[2];

        drag_at(&model, &s, &start, action, &linear);
        assert_true(linear.count > 0);
        for (int k = 0; k < 2; k++)
        {
            const double way = k ? 0.01 : 0.02;
            ellipsoid_state there = start;
            ellipsoid_planes planes;
            double taken[6];

            for (int i = 0; i < 3; i++)
            {
                there.x[i] += way * (i - 0.5) * 1e-6;
            }
            for (int l = 0; l < 4; l++)
            {
                there.q[l] += way * turn[l];
            }
            ellipsoid_normalise(there.q);
            drag_at(&model, &s, &there, action, NULL);
            ellipsoid_linear_planes_at(&linear, &there, &planes);
            assert_true(ellipsoid_wall_action(&model, &planes, linear.rates,
                                              taken));
            off[k] = test_distance(action, taken, 3)
                   / ellipsoid_length(action);
        }
        print_message("# off by %.2g and %.2g\n", off[0], off[1]);
        assert_true(off[0] < 1e-3 && off[1] < 0.3 * off[0]);
    }
    wall_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_linear_planes),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
