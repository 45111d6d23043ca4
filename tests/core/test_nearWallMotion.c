/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    test_nearWallMotion.c - motion with the drag near walls made of facets.
*/
#include "nearWallTest.h"

static ellipsoid_facet_cache cache;

/*
    The paper's cell, weighed down by 2 pN, comes down on a floor in a shear
    flow, touches it and rolls on: with and without inertia the same way.
    Inertia acts for 1e-7 s; 2 nm as in the flow without walls
    (test_inertialess.c).
*/
static void test_coming_down(void **unused)
{
    wall_mesh mesh;
    ellipsoid_state end[2];

    (void)unused;
    wall_mesh_init(&mesh);
    add_floor(&mesh, 0, 1, 1);
    wall_mesh_finish(&mesh);
    for (int n = 0; n < 2; n++)
    {
        test_quadratic flow = {.answer = 0};
        const ellipsoid_surroundings s = around(&mesh, &flow);
        ellipsoid_options o = near_walls();
        ellipsoid_state state = {.x = {0, 0, 3e-6}, .q = {0.3, 0.1, 0.2, 0.9}};
        ellipsoid_controller controller = {0};
        ellipsoid_statistics statistics = {0};
        ellipsoid_model model;
        double t = 0;

        flow.g[1][2] = 20;
        o.motion =
            n ? ELLIPSOID_MOTION_INERTIALESS : ELLIPSOID_MOTION_INERTIAL;
        o.contact = 1;
        o.external_force[2] = -2e-12;
        model = test_model(&o);
        ellipsoid_normalise(state.q);
        ellipsoid_facet_cache_clear(&cache);
        assert_ok(ellipsoid_balance(&model, &s, &state, &cache));
        assert_ok(ellipsoid_advance(
            &(ellipsoid_member){&model, &s, &state, &controller, &cache, NULL,
                                &statistics},
            &t, 0.5, NULL));
        print_message("%ld steps, %ld rejected, deepest %.1e m\n",
                      statistics.accepted, statistics.rejected,
                      statistics.deepest);
        assert_true(statistics.deepest > 0);
        end[n] = state;
    }
    assert_near(test_distance(end[0].x, end[1].x, 3), 0, 2e-9);
    assert_near(test_distance(end[0].q, end[1].q, 4), 0, 1e-3);
    wall_mesh_free(&mesh);
}

/*
    A cell that goes with a shear flow over a floor and past a block, heavier than
    the fluid as bacteria are: over its steps the resistance is kept. Its error,
    against steps at a tolerance of 1e-9, over which it is not, is at most twice
    that without walls.
*/
static void test_kept_resistance(void **unused)
{
    const double low[3] = {-2e-6, 5e-6, 0}, high[3] = {2e-6, 9e-6, 1.5e-6};
    wall_mesh mesh;
    double error[2];

    (void)unused;
    wall_mesh_init(&mesh);
    add_floor(&mesh, 0, 10, 10);
    wall_mesh_box(&mesh, low, high, 0, 3, 0);
    wall_mesh_finish(&mesh);
    for (int n = 0; n < 2; n++)
    {
        static const double tolerance[2] = {1e-9, 1e-5};
        ellipsoid_state end[2];

        for (int k = 0; k < 2; k++)
        {
            test_quadratic flow = {.answer = 0};
            ellipsoid_surroundings s = around(&mesh, &flow);
            ellipsoid_options o = near_walls();
            ellipsoid_controller controller = {0};
            ellipsoid_statistics statistics = {0};
            ellipsoid_model model;
            double t = 0;

            flow.g[1][2] = 200;
            o.tolerance = tolerance[k];
            ellipsoid_set(o.gravity, 0, 0, -9.81);
            o.buoyancy = 1;
            model = test_model(&o);
            end[k] = (ellipsoid_state){.x = {0.3e-6, 0, 4e-6},
                                       .q = {0.3, 0.1, 0.2, 0.9}};
            ellipsoid_normalise(end[k].q);
            s.walls = n ? s.walls : NULL;
            ellipsoid_facet_cache_clear(&cache);
            assert_ok(ellipsoid_balance(&model, &s, &end[k], &cache));
            assert_ok(ellipsoid_advance(
                &(ellipsoid_member){&model, &s, &end[k], &controller, &cache,
                                    NULL, &statistics},
                &t, 20e-3, NULL));
            print_message("%s walls, %.0e: %ld steps, %ld evaluations\n",
                          n ? "with" : "without", tolerance[k],
                          statistics.accepted, statistics.rhs);
        }
        error[n] = test_distance(end[0].x, end[1].x, 3) / 2e-6
                 + test_distance(end[0].q, end[1].q, 4);
        print_message("error %.1e\n", error[n]);
    }
    assert_true(error[1] < 2 * error[0]);
    wall_mesh_free(&mesh);
}

/* Stops after every step. */
static int stop(void *context, const ellipsoid_step *step)
{
    (void)step;
    (void)context;
    return 1;
}

/*
    One that goes past a block, stopped after every step and continued, takes the
    way of one that is not stopped, to the last bit, although its resistance is
    kept over several steps.
*/
static void test_kept_and_stopped(void **unused)
{
    const double low[3] = {-2e-6, 5e-6, 0}, high[3] = {2e-6, 9e-6, 1.5e-6};
    ellipsoid_state end[2];
    wall_mesh mesh;

    (void)unused;
    wall_mesh_init(&mesh);
    add_floor(&mesh, 0, 10, 10);
    wall_mesh_box(&mesh, low, high, 0, 3, 0);
    wall_mesh_finish(&mesh);
    for (int n = 0; n < 2; n++)
    {
        test_quadratic flow = {.answer = 0};
        ellipsoid_surroundings s = around(&mesh, &flow);
        ellipsoid_options o = near_walls();
        ellipsoid_controller controller = {0};
        ellipsoid_statistics statistics = {0};
        ellipsoid_model model;
        ellipsoid_status status;
        double t = 0;

        flow.g[1][2] = 200;
        ellipsoid_set(o.gravity, 0, 0, -9.81);
        o.buoyancy = 1;
        model = test_model(&o);
        end[n] = (ellipsoid_state){.x = {0.3e-6, 0, 4e-6},
                                   .q = {0.3, 0.1, 0.2, 0.9}};
        ellipsoid_normalise(end[n].q);
        ellipsoid_facet_cache_clear(&cache);
        assert_ok(ellipsoid_balance(&model, &s, &end[n], &cache));
        do
        {
            status = ellipsoid_advance(
                &(ellipsoid_member){&model, &s, &end[n], &controller, &cache,
                                    NULL, &statistics},
                &t, 20e-3, n ? stop : NULL);
        } while (status == ELLIPSOID_STOPPED);
        assert_ok(status);
    }
    assert_memory_equal(&end[0], &end[1], sizeof(end[0]));
    wall_mesh_free(&mesh);
}

/*
    Where contact sees no wall within its horizon, how long the resistance is kept
    is a matter of the planes alone: the way, in steps in which the cell goes
    farther than a quarter of the horizon, is that without contact, to the last
    bit.
*/
static void test_kept_beyond_horizon(void **unused)
{
    ellipsoid_state end[2];
    wall_mesh mesh;

    (void)unused;
    wall_mesh_init(&mesh);
    add_floor(&mesh, 0, 10, 10);
    wall_mesh_finish(&mesh);
    for (int n = 0; n < 2; n++)
    {
        test_quadratic flow = {.answer = 0};
        const ellipsoid_surroundings s = around(&mesh, &flow);
        ellipsoid_options o = near_walls();
        ellipsoid_controller controller = {0};
        ellipsoid_statistics statistics = {0};
        ellipsoid_model model;
        double t = 0;

        flow.g[1][2] = 200;
        o.tolerance = 1e-5;
        o.maximum_step = 2e-4;
        o.contact = n;
        model = test_model(&o);
        end[n] = (ellipsoid_state){.x = {0, 0, 4e-6},
                                   .q = {0.3, 0.1, 0.2, 0.9}};
        ellipsoid_normalise(end[n].q);
        ellipsoid_facet_cache_clear(&cache);
        assert_ok(ellipsoid_balance(&model, &s, &end[n], &cache));
        assert_ok(ellipsoid_advance(
            &(ellipsoid_member){&model, &s, &end[n], &controller, &cache, NULL,
                                &statistics},
            &t, 5e-3, NULL));
    }
    assert_memory_equal(&end[0], &end[1], sizeof(end[0]));
    wall_mesh_free(&mesh);
}

/*
    Without a flow walls resist nothing: steps, evaluations and the way down are
    those of wallResistance none, to the last bit.
*/
static void test_without_flow(void **unused)
{
    ellipsoid_state end[2];
    ellipsoid_statistics statistics[2] = {{0}, {0}};
    wall_mesh mesh;

    (void)unused;
    wall_mesh_init(&mesh);
    add_floor(&mesh, 0, 1, 1);
    wall_mesh_finish(&mesh);
    for (int n = 0; n < 2; n++)
    {
        test_quadratic flow = {.answer = 0};
        ellipsoid_surroundings s = around(&mesh, &flow);
        ellipsoid_options o = near_walls();
        ellipsoid_controller controller = {0};
        ellipsoid_model model;
        double t = 0;

        s.flow = NULL;
        o.contact = 1;
        o.wall_resistance =
            n ? o.wall_resistance : ELLIPSOID_WALL_RESISTANCE_NONE;
        o.external_force[2] = -2e-12;
        model = test_model(&o);
        end[n] = (ellipsoid_state){.x = {0, 0, 3e-6}, .q = {1, 0, 0, 0}};
        ellipsoid_facet_cache_clear(&cache);
        assert_ok(ellipsoid_advance(
            &(ellipsoid_member){&model, &s, &end[n], &controller, &cache, NULL,
                                &statistics[n]},
            &t, 1e-5, NULL));
    }
    assert_true(statistics[0].accepted > 1);
    assert_memory_equal(&end[0], &end[1], sizeof(end[0]));
    assert_memory_equal(&statistics[0], &statistics[1], sizeof(statistics[0]));
    wall_mesh_free(&mesh);
}

/* Two cells that overlap by some nanometres near a floor are pushed apart, with
   and without inertia the same way. Those with inertia start
   from rest: 1e-7 s at some mm/s, 1 nm of the 20 nm. */
static void test_two_cells(void **unused)
{
    static ellipsoid_facet_cache caches[2];
    static double memory[200000];
    ellipsoid_state end[2][2];
    wall_mesh mesh;

    (void)unused;
    wall_mesh_init(&mesh);
    add_floor(&mesh, 0, 1, 1);
    wall_mesh_finish(&mesh);
    assert_true(ellipsoid_group_size(2) <= sizeof(memory));
    for (int n = 0; n < 2; n++)
    {
        test_quadratic rest = {.answer = 0};
        ellipsoid_surroundings s[2] = {around(&mesh, &rest),
                                       around(&mesh, &rest)};
        ellipsoid_options o = near_walls();
        ellipsoid_controller controller[2] = {{0}};
        ellipsoid_statistics statistics[2] = {{0}};
        ellipsoid_member members[2];
        ellipsoid_model model;
        double t = 0;
        int which;

        o.motion =
            n ? ELLIPSOID_MOTION_INERTIALESS : ELLIPSOID_MOTION_INERTIAL;
        o.contact = 1;
        model = test_model(&o);
        for (int i = 0; i < 2; i++)
        {
            const ellipsoid_state state = {
                .x = {i * 0.88e-6, i * 0.2e-6, 0.7e-6}, .q = {0, 0, 0, 1}};

            s[i].id = (uint32_t)i;
            end[n][i] = state;
            ellipsoid_facet_cache_clear(&caches[i]);
            members[i] = (ellipsoid_member){
                &model,     &s[i], &end[n][i],    &controller[i],
                &caches[i], NULL,  &statistics[i]};
        }
        assert_ok(ellipsoid_advance_group(2, members, &t, 1e-2, NULL, memory,
                                          &which));
    }
    assert_true(end[0][1].x[0] - end[0][0].x[0] > 0.89e-6);
    for (int i = 0; i < 2; i++)
    {
        assert_near(test_distance(end[0][i].x, end[1][i].x, 3), 0, 1e-9);
        assert_near(test_distance(end[0][i].q, end[1][i].q, 4), 0, 1e-4);
    }
    wall_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_coming_down),
        cmocka_unit_test(test_kept_resistance),
        cmocka_unit_test(test_kept_and_stopped),
        cmocka_unit_test(test_kept_beyond_horizon),
        cmocka_unit_test(test_without_flow),
        cmocka_unit_test(test_two_cells),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
