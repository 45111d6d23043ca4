/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_nearWallMotion.c - motion with the drag near walls made of facets.
*/
#include "nearWallTest.h"

static ellipsoid_facet_cache cache;

/* A cell that goes its way in a flow u2 = (shear + bend x2) x3. */
typedef struct journey
{
    wall_mesh *mesh;
    int no_walls; /* as if there were none */
    ellipsoid_options options;
    double shear, bend, end;     /* [1/s], [1/(m s)], [s] */
    ellipsoid_observer observer; /* one that stops is asked again */
    ellipsoid_state state;       /* at the start: x and q; then at the end */
    ellipsoid_statistics statistics;
} journey;

static void go(journey *j)
{
    test_quadratic flow = {.answer = 0};
    ellipsoid_surroundings s = around(j->mesh, &flow);
    ellipsoid_controller controller = {0};
    const ellipsoid_model model = test_model(&j->options);
    ellipsoid_status status;
    double t = 0;

    flow.g[1][2] = j->shear;
    flow.h[1][1][2] = flow.h[1][2][1] = j->bend;
    s.walls = j->no_walls ? NULL : s.walls;
    ellipsoid_normalise(j->state.q);
    ellipsoid_facet_cache_clear(&cache);
    assert_ok(ellipsoid_balance(&model, &s, &j->state, &cache));
    do
    {
        status = ellipsoid_advance(&(ellipsoid_member){&model, &s, &j->state,
                                                       &controller, &cache,
                                                       NULL, &j->statistics},
                                   &t, j->end, j->observer);
    } while (status == ELLIPSOID_STOPPED);
    assert_ok(status);
}

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
        journey j = {.mesh = &mesh,
                     .options = near_walls(),
                     .shear = 20,
                     .end = 0.5,
                     .state = {.x = {0, 0, 3e-6}, .q = {0.3, 0.1, 0.2, 0.9}}};

        j.options.motion =
            n ? ELLIPSOID_MOTION_INERTIALESS : ELLIPSOID_MOTION_INERTIAL;
        j.options.contact = 1;
        j.options.external_force[2] = -2e-12;
        go(&j);
        print_message("%ld steps, %ld rejected, deepest %.1e m\n",
                      j.statistics.accepted, j.statistics.rejected,
                      j.statistics.deepest);
        assert_true(j.statistics.deepest > 0);
        end[n] = j.state;
    }
    assert_near(test_distance(end[0].x, end[1].x, 3), 0, 2e-9);
    assert_near(test_distance(end[0].q, end[1].q, 4), 0, 1e-3);
    wall_mesh_free(&mesh);
}

/* A floor and a block on it; and a cell that goes over the floor and past the
   block, heavier than the fluid as bacteria are. */
static journey past_block(wall_mesh *mesh)
{
    const double low[3] = {-2e-6, 5e-6, 0}, high[3] = {2e-6, 9e-6, 1.5e-6};
    journey j = {.mesh = mesh,
                 .options = near_walls(),
                 .shear = 200,
                 .end = 20e-3,
                 .state = {.x = {0.3e-6, 0, 4e-6}, .q = {0.3, 0.1, 0.2, 0.9}}};

    wall_mesh_init(mesh);
    add_floor(mesh, 0, 10, 10);
    wall_mesh_box(mesh, low, high, 0, 3, 0);
    wall_mesh_finish(mesh);
    ellipsoid_set(j.options.gravity, 0, 0, -9.81);
    j.options.buoyancy = 1;
    return j;
}

static int stop(void *context, const ellipsoid_step *step)
{
    (void)step;
    (void)context;
    return 1;
}

/* Stopped after every step and continued, it takes the way of one that is not
   stopped, to the last bit. */
static void test_stopped(void **unused)
{
    wall_mesh mesh;
    journey whole = past_block(&mesh), stopped = whole;

    (void)unused;
    go(&whole);
    stopped.observer = stop;
    go(&stopped);
    assert_memory_equal(&whole.state, &stopped.state, sizeof(whole.state));
    wall_mesh_free(&mesh);
}

/*
    Stages take the drag near walls from the start of the step, to first order.
    What that makes wrong is in the error of a step: it falls with the tolerance,
    and asks for hardly more steps than the flow does without walls.
*/
static void test_expansion(void **unused)
{
    const double tolerance[3] = {1e-4, 1e-5, 1e-6};
    wall_mesh mesh;
    journey exact = past_block(&mesh), bare = exact;

    (void)unused;
    exact.options.tolerance = 1e-9;
    exact.bend = bare.bend = 2e7;
    go(&exact);
    bare.no_walls = 1;
    bare.options.tolerance = tolerance[1];
    go(&bare);
    for (int n = 0; n < 3; n++)
    {
        journey j = exact;
        double off, turned, most; /* all errors of steps, of one sign */

        j.state = (ellipsoid_state){.x = {0.3e-6, 0, 4e-6},
                                    .q = {0.3, 0.1, 0.2, 0.9}};
        j.statistics = (ellipsoid_statistics){0};
        j.options.tolerance = tolerance[n];
        go(&j);
        off = test_distance(j.state.x, exact.state.x, 3);
        turned = test_distance(j.state.q, exact.state.q, 4);
        most = (double)j.statistics.accepted * tolerance[n];
        print_message("# tolerance %.0e: %ld steps, %ld rejected (%ld without "
                      "walls at 1e-5), off by %.2g nm and %.2g of q\n",
                      tolerance[n], j.statistics.accepted,
                      j.statistics.rejected, bare.statistics.accepted,
                      1e9 * off, turned);
        assert_true(off < 0.3 * most * 2e-6);
        assert_true(turned < 0.08 * most);
        assert_true(j.statistics.accepted < (n == 0 ? 36 : n == 1 ? 55 : 110));
        assert_true(j.statistics.rejected < 5);
    }
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
        assert_ok(ellipsoid_advance(&(ellipsoid_member){&model, &s, &end[n],
                                                        &controller, &cache,
                                                        NULL, &statistics[n]},
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

        o.motion = n ? ELLIPSOID_MOTION_INERTIALESS : ELLIPSOID_MOTION_INERTIAL;
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

/* The default cell in a shear flow over a floor, at its free motion. */
static ellipsoid_state free_cell(double gap, const double axis[3], int along)
{
    ellipsoid_options o = near_walls();
    test_quadratic flow = {.answer = 0};
    ellipsoid_state state = {.x = {0}};
    ellipsoid_model model;
    wall_mesh mesh;

    o.lubrication_gap = 1e-9;
    o.wall_range = 30e-6;
    model = test_model(&o);
    flow.g[along][2] = 100;
    wall_mesh_init(&mesh);
    add_floor(&mesh, 0, 3, 3);
    wall_mesh_finish(&mesh);
    ellipsoid_facet_cache_clear(&cache);
    ellipsoid_quaternion_from_axis(axis, 0.3, state.q);
    state.x[2] =
        hypot(0.5e-6 * hypot(axis[0], axis[1]), 2e-6 * axis[2]) + 0.5e-6 * gap;
    {
        const ellipsoid_surroundings s = around(&mesh, &flow);

        assert_ok(ellipsoid_balance(&model, &s, &state, &cache));
    }
    wall_mesh_free(&mesh);
    return state;
}

/* Speed over that of the flow at the centre, exact (boundary elements, 1e-4):
   lying along y, shear along x and y; upright; tilted by 45 degrees to y. The
   table is within 0.2 %. */
static void test_free_cell_in_shear(void **unused)
{
    static const double root = 0.70710678118654752;
    static const test_row row = {
        "walls",
        "speed of a free cell in shear at a plane over the flow's at its "
        "centre",
        "4:1, lying, upright and tilted, gaps 0.05 to 2 radii",
        "boundary elements, 1e-4 from Goldman, Cox & Brenner",
        "P",
        "the table between its nodes",
        0};
    static const struct
    {
        double gap, axis[3], across, along;
    } known[] = {
        {0.05, {0, 1, 0}, 0.517, 0.558},      {0.1, {0, 1, 0}, 0.605, 0.645},
        {0.5, {0, 1, 0}, 0.845, 0.868},       {1, {0, 1, 0}, 0.926, 0.937},
        {2, {0, 1, 0}, 0.973, 0.977},         {0.05, {0, 0, 1}, 0.972, 0.972},
        {0.05, {0, root, root}, 0.948, 0.800}};

    (void)unused;
    for (size_t n = 0; n < sizeof(known) / sizeof(*known); n++)
    {
        for (int along = 0; along < 2; along++)
        {
            const ellipsoid_state s =
                free_cell(known[n].gap, known[n].axis, along);

            assert_row(&row, s.u[along] / (100 * s.x[2]),
                       along ? known[n].along : known[n].across, 2.5e-3);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_coming_down),
        cmocka_unit_test(test_stopped),
        cmocka_unit_test(test_expansion),
        cmocka_unit_test(test_without_flow),
        cmocka_unit_test(test_two_cells),
        cmocka_unit_test(test_free_cell_in_shear),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
