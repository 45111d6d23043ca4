/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    test_manifoldEnds.c - how the slow manifold is reached and left, and that a
    run can be cut anywhere.
*/
#include "manifoldTest.h"
#include "wallMesh.h"

/* ----------------------------------------------------- there and back */

/* At rest in the flow, at a tolerance that what the decay leaves out exceeds:
   Rosenbrock steps until it has decayed, none after. At a looser one it enters
   at once. */
static void test_from_rest(void **unused)
{
    static run r, tight;
    long jacobians;

    (void)unused;
    begin(&r, ELLIPSOID_INTEGRATOR_SLOW_MANIFOLD, 1e-7, 6e4);
    memset(r.state.u, 0, sizeof(r.state.u));
    tight = r;
    tight.options.integrator = ELLIPSOID_INTEGRATOR_ROSENBROCK;
    tight.options.tolerance = 1e-12;
    tight.model = test_model(&tight.options);
    tight.around.flow_context = &tight.flow;
    assert_ok(go(&r, 1e-5));
    jacobians = r.statistics.jacobians;
    print_message("# from rest: %d Rosenbrock steps, entered by %.1e\n",
                  r.rosenbrock_steps, r.entering);
    assert_true(r.rosenbrock_steps > 3 && r.entered == 1);
    /* the rest of a way of 4e-4, the relaxation time in the flow */
    assert_true(r.entering < 1e-4);
    assert_ok(go(&r, 1e-3));
    assert_int_equal(r.statistics.jacobians, jacobians);
    assert_ok(go(&tight, 1e-3));
    assert_true(distance(&r, &tight) < 3e-6);

    begin(&r, ELLIPSOID_INTEGRATOR_SLOW_MANIFOLD, 1e-4, 6e4);
    memset(r.state.u, 0, sizeof(r.state.u));
    assert_ok(go(&r, 1e-3));
    assert_int_equal(r.statistics.jacobians, 0);
    assert_true(distance(&r, &tight) < 1e-3);
}

/* A tolerance below what the manifold leaves out: Rosenbrock steps. */
static void test_tight_tolerance(void **unused)
{
    static run r, tight;

    (void)unused;
    begin(&r, ELLIPSOID_INTEGRATOR_SLOW_MANIFOLD, 1e-11, 3e5);
    begin(&tight, ELLIPSOID_INTEGRATOR_ROSENBROCK, 1e-12, 3e5);
    assert_ok(go(&r, 1e-3));
    assert_ok(go(&tight, 1e-3));
    print_message("# tolerance 1e-11: %d explicit of %d steps, %.1e\n",
                  r.explicit_steps, r.steps, distance(&r, &tight));
    assert_true(r.explicit_steps < r.steps / 10);
    assert_true(distance(&r, &tight) < 1e-9);
}

/* A floor at x3 = 0 and weight towards it, in shear: it lands and tumbles. */
static void on_floor(run *r, wall_mesh *floor, ellipsoid_integrator integrator)
{
    const double corner[3] = {-1e-3, -1e-3, 0};
    const double u[3] = {2e-3, 0, 0}, v[3] = {0, 2e-3, 0};

    begin(r, integrator, 1e-5, 6e4);
    wall_mesh_init(floor);
    wall_mesh_plane(floor, corner, u, v, 1, 1, 0, 1);
    wall_mesh_finish(floor);
    r->flow.speed = 1e-4;
    r->options.contact = r->options.buoyancy = 1;
    r->options.gravity[2] = -1e5;
    r->model = test_model(&r->options);
    r->around.walls = wall_mesh_list;
    r->around.walls_context = floor;
    ellipsoid_set(r->state.x, 1e-5, 1e-5, 3e-6);
}

/*
    Explicit steps above the floor, Rosenbrock steps on it. The state is handed
    over as it is; where the manifold is entered it may move by less than the
    tolerance. Both ways the cell ends in the same place.
*/
static void test_hand_over(void **unused)
{
    static run r, other;
    wall_mesh floor[2];

    (void)unused;
    on_floor(&r, &floor[0], ELLIPSOID_INTEGRATOR_SLOW_MANIFOLD);
    on_floor(&other, &floor[1], ELLIPSOID_INTEGRATOR_ROSENBROCK);
    assert_ok(go(&r, 0.1));
    assert_ok(go(&other, 0.1));
    print_message("# floor: %d explicit, %d Rosenbrock steps, left %d times, "
                  "entered %d times by %.1e; apart %.1e\n",
                  r.explicit_steps, r.rosenbrock_steps, r.left, r.entered,
                  r.entering, distance(&r, &other));
    assert_true(r.explicit_steps > 4 && r.rosenbrock_steps > 10);
    assert_true(r.left > 0 && r.statistics.deepest > 0);
    assert_true(r.jump == 0);
    assert_true(r.entering < 1e-5);
    assert_true(distance(&r, &other) < 1e-3);
    wall_mesh_free(&floor[0]);
    wall_mesh_free(&floor[1]);
}

/* Cut at any step and begun anew from state and controller, it goes on to the
   same last bit: free, from rest, and on to the floor. */
static void check_cuts(const run *from)
{
    static run whole, cut;
    ellipsoid_status status;
    int cuts = 0;

    whole = cut = *from;
    whole.around.flow_context = &whole.flow;
    cut.around.flow_context = &cut.flow;
    assert_ok(go(&whole, 0.02));
    do
    {
        ellipsoid_facet_cache_clear(&cut.cache);
        cut.stop_after = cut.steps + 1 + cuts % 3;
        status = go(&cut, 0.02);
        cuts++;
    } while (status == ELLIPSOID_STOPPED);
    assert_ok(status);
    print_message("# %d cuts in %d steps, %d of them explicit\n", cuts,
                  whole.steps, whole.explicit_steps);
    assert_true(cuts > 3);
    assert_memory_equal(&cut.state, &whole.state, sizeof(cut.state));
    assert_memory_equal(&cut.controller, &whole.controller,
                        sizeof(cut.controller));
    assert_int_equal(cut.steps, whole.steps);
}

static void test_cuts(void **unused)
{
    static run r;
    wall_mesh floor;

    (void)unused;
    begin(&r, ELLIPSOID_INTEGRATOR_SLOW_MANIFOLD, 1e-6, 6e4);
    check_cuts(&r);
    r.around.piecewise = 1;
    check_cuts(&r);
    begin(&r, ELLIPSOID_INTEGRATOR_SLOW_MANIFOLD, 1e-7, 6e4);
    memset(r.state.u, 0, sizeof(r.state.u));
    check_cuts(&r);
    on_floor(&r, &floor, ELLIPSOID_INTEGRATOR_SLOW_MANIFOLD);
    check_cuts(&r);
    wall_mesh_free(&floor);
}

/* Among small vortices steps are often as long as the manifold allows, or
   shortened to what it allows. */
static void test_cuts_at_the_limit(void **unused)
{
    static run r;

    (void)unused;
    for (int n = 0; n < 24; n++)
    {
        begin(&r, ELLIPSOID_INTEGRATOR_SLOW_MANIFOLD, n % 2 ? 1e-4 : 3e-7,
              1e5 + 2e4 * n);
        check_cuts(&r);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_from_rest),
        cmocka_unit_test(test_tight_tolerance),
        cmocka_unit_test(test_hand_over),
        cmocka_unit_test(test_cuts),
        cmocka_unit_test(test_cuts_at_the_limit),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
