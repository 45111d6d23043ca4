/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_landing.c - a cell without inertia whose beads land on a wall one after
    another: steps end where they do; and one that two walls let go.
*/
#include "contactTest.h"

#include "contact/contact.h"

#include <math.h>

/*
    A ball at height h sinks at speed w, and the wall is flat: it is d deep at
    the time (h - r + d)/w. As a bead of an ellipsoid that turns, too, it has
    the speed of its place.
*/
static void test_time_of_landing(void **unused)
{
    const double r = 0.5e-6, w = 3e-4, depth = 1e-10, gap = 0.2e-6;
    ellipsoid_options o = contact_ball(r, 1e3);
    static contact_run run;
    double moved;

    (void)unused;
    contact_floor(&run, 2e-5);
    contact_start(&run, &o, 0);
    run.state.x[0] = 3e-6;
    run.state.x[2] = r + gap;
    run.state.u[0] = 10 * w;
    run.state.u[2] = -w;
    (void)contact_now(&run);
    moved = 0;
    assert_near(
        ellipsoid_landing(&run.model, &run.state, &run.cache, moved, depth, 1),
        (gap + depth) / w, 1e-9 * gap / w);
    /* no later than asked, and never away from the wall */
    assert_true(ellipsoid_landing(&run.model, &run.state, &run.cache, moved,
                                  depth, 1e-5)
                == 1e-5);
    run.state.u[2] = w;
    assert_true(
        ellipsoid_landing(&run.model, &run.state, &run.cache, moved, depth, 1)
        == 1);
    wall_mesh_free(&run.mesh);
}

/* A cell that lies on a floor and rolls about its long axis in a shear: where
   it is after 0.1 s, and the attempts so far. */
static long roll(double tolerance, ellipsoid_state *state)
{
    static contact_run run;
    ellipsoid_options o = test_paper_options();

    memset(&run.flow, 0, sizeof(run.flow));
    run.flow.g[0][2] = 440;
    run.flow.u[0] = -440 * 0.5e-6;
    o.motion = ELLIPSOID_MOTION_INERTIALESS;
    o.tolerance = tolerance;
    o.external_force[2] = -5e-12;
    contact_floor(&run, 4e-4);
    contact_start(&run, &o, 0);
    run.state.x[2] = 0.6e-6;
    assert_ok(contact_go(&run, 0.1));
    wall_mesh_free(&run.mesh);
    *state = run.state;
    return run.statistics.accepted + run.statistics.rejected;
}

/*
    Its beads land in turn. With six tolerances about 1e-3, as one error alone is a
    matter of chance, it takes 4022 attempts, and 5449 if steps do not end there,
    with a mean error of 1.2 and 0.9 nm.
*/
static void test_rolling(void **unused)
{
    ellipsoid_state reference, state;
    long attempts = 0;
    double off[3], error = 0;

    (void)unused;
    (void)roll(1e-8, &reference);
    for (int n = 0; n < 6; n++)
    {
        attempts += roll(3e-3 * pow(0.7, n), &state);
        ellipsoid_difference(state.x, reference.x, off);
        error += ellipsoid_length(off) / 6;
    }
    print_message("# rolling: %ld attempts, mean error %.1e m\n", attempts,
                  error);
    assert_true(attempts < 6 * 780);
    assert_true(error < 1.3e-9);
}

/* A cell askew between two plates, so far from the middle, in a flow that turns
   it away from both. */
static void set_askew(contact_run *run, double half, double turning)
{
    const double tilt = 0.3, axis[3] = {cos(tilt), 0, -sin(tilt)};
    ellipsoid_options o = test_paper_options();

    o.motion = ELLIPSOID_MOTION_INERTIALESS;
    o.tolerance = 1e-3;
    o.buoyancy = 0;
    wall_mesh_init(&run->mesh);
    for (int side = -1; side < 2; side += 2)
    {
        const double corner[3] = {-1e-5, -side * 1e-5, -side * half};
        const double u[3] = {2e-5, 0, 0}, v[3] = {0, side * 2e-5, 0};

        wall_mesh_plane(&run->mesh, corner, u, v, 1, 1, 0, 0);
    }
    wall_mesh_finish(&run->mesh);
    memset(&run->flow, 0, sizeof(run->flow));
    run->flow.g[0][2] = -turning;
    run->flow.g[2][0] = turning;
    contact_start(run, &o, 0);
    ellipsoid_quaternion_from_axis(axis, 0, run->state.q);
}

/*
    Its ends are pressed into the plates: the forces have no sum and do no work,
    the torque does. A long step is that of a contact that pulls, too; it is free
    at once, and turns with the fluid.
*/
static void test_let_go(void **unused)
{
    const double depth = 1e-9, turning = 2, end = 5e-2;
    static contact_run run;
    double half = 1e-6, before[3], after[3], turned;

    (void)unused;
    set_askew(&run, half, turning);
    half -= contact_now(&run).gap + depth;
    wall_mesh_free(&run.mesh);
    set_askew(&run, half, turning);
    run.controller.step = 2 * end;
    assert_near(contact_now(&run).deepest, depth, 1e-3 * depth);
    test_long_axis(&run.state, before);
    assert_ok(contact_go(&run, end));
    test_long_axis(&run.state, after);
    turned = atan2(after[2], after[0]) - atan2(before[2], before[0]);
    print_message("# turned by %.4f of %.4f in %ld + %ld steps\n", turned,
                  turning * end, run.statistics.accepted,
                  run.statistics.rejected);
    assert_near(turned, turning * end, 5e-3);
    wall_mesh_free(&run.mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_time_of_landing),
        cmocka_unit_test(test_rolling),
        cmocka_unit_test(test_let_go),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
