/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_inertialess.c - motion without inertia: seven equations, explicit
    where nothing touches, by the Rosenbrock method where something does.
*/
#include "flowTest.h"
#include "wallMesh.h"

static const double rate = 1000; /* [1/s] of the shear */

static ellipsoid_options without_inertia(void)
{
    ellipsoid_options o = test_free_cell();

    o.motion = ELLIPSOID_MOTION_INERTIALESS;
    return o;
}

/* A spheroid of the paper cell's volume, about x^2. */
static ellipsoid_options spheroid(double ratio)
{
    ellipsoid_options o = without_inertia();
    const double a = pow(0.5e-18 / ratio, 1.0 / 3);

    o.semi_axes[0] = o.semi_axes[2] = a;
    o.semi_axes[1] = ratio * a;
    return o;
}

/* ----------------------------------------------------------- Jeffery orbits */

/*
    Jeffery (1922), eqs. 46 to 49, for u = (rate x2, 0, 0): with O the axis,
    vorticity along -x3, tan(phi) = O1/O2 and r the ratio of axes,
        tan(phi) = r tan(rate t r/(r^2+1) + phase),
        T = 2 pi (r + 1/r)/rate,
        C^2 = (r^2 O2^2 + O1^2)/(r^2 O3^2), constant.
*/

/* C/(1+C), which is 1 for a tumbling body and 0 for one that rolls */
static double orbit(const double axis[3], double ratio)
{
    const double c =
        sqrt(ratio * ratio * axis[1] * axis[1] + axis[0] * axis[0]) / ratio;

    return c / (c + fabs(axis[2]));
}

/*
    100 periods at a tolerance of 1e-13: after them the axis is where it was and
    the orbit the same, to 1e-8; and in between the axis is where Jeffery puts
    it. The axis moves by up to rate T per period, 100 periods of r = 10 are 6e4
    strain units: a drift of 1e-8 is 1e-13 of that.
*/
static void check_orbit(double ratio, double height)
{
    ellipsoid_options o = spheroid(ratio);
    const double period = 2 * test_pi * (ratio + 1 / ratio) / rate;
    const double along = sqrt(1 - height * height);
    const double start[3] = {0, along, height};
    const long periods = test_count(10, 100, 100);
    test_quadratic flow = test_shear(rate);
    ellipsoid_state state = {.x = {0, 0, 0}};
    ellipsoid_controller controller = {0};
    ellipsoid_statistics statistics = {0};
    double axis[3], t = 0, worst = 0;
    ellipsoid_model model;

    o.tolerance = 1e-13;
    model = test_model(&o);
    ellipsoid_quaternion_from_axis(start, 0.3, state.q);
    for (long n = 1; n <= 8 * periods; n++)
    {
        const double phase = 2 * test_pi * (double)n / 8;
        double expected[3], length;

        assert_ok(test_advance(&model, &flow, &state, &t,
                               (double)n * period / 8, &controller,
                               &statistics));
        test_long_axis(&state, axis);
        /* the projection on the plane of shear runs on an ellipse */
        ellipsoid_set(expected, ratio * along * sin(phase), along * cos(phase),
                      height);
        length = ellipsoid_length(expected);
        for (int i = 0; i < 3; i++)
        {
            worst = fmax(worst, fabs(axis[i] - expected[i] / length));
        }
        worst = fmax(worst, fabs(orbit(axis, ratio) - orbit(start, ratio)));
    }
    print_message(
        "# r = %g, height %.2f: worst of %ld periods %.1e, %.1f steps "
        "each\n",
        ratio, height, periods, worst,
        (double)statistics.accepted / (double)periods);
    assert_true(worst <= 1e-8);
    assert_int_equal(statistics.jacobians, 0);
    assert_near(ellipsoid_length(state.q) * ellipsoid_length(state.q)
                    + state.q[3] * state.q[3],
                1, 1e-14);
}

static void test_jeffery_orbits(void **unused)
{
    static const double ratios[] = {0.25, 4, 10};

    (void)unused;
    for (int i = 0; i < 3; i++)
    {
        check_orbit(ratios[i], 0);   /* tumbling */
        check_orbit(ratios[i], 0.5); /* kayaking */
        check_orbit(ratios[i], 0.99);
        check_orbit(ratios[i], 1); /* log-rolling */
    }
}

/* --------------------------------------------------- limit of no inertia */

/* The paper's cell after 2 ms among vortices of 10 um, both ways. */
static test_errors distance_between_motions(double density)
{
    ellipsoid_options o = test_free_cell();
    test_vortices flow = {4e-3, 3e5};
    const ellipsoid_surroundings around = {.flow = test_vortex_flow,
                                           .flow_context = &flow};
    ellipsoid_state s[2];

    o.density = density;
    o.tolerance = 1e-12;
    for (int n = 0; n < 2; n++)
    {
        ellipsoid_controller controller = {0};
        ellipsoid_statistics statistics = {0};
        ellipsoid_model model;
        double t = 0;

        o.motion = n ? ELLIPSOID_MOTION_INERTIALESS : ELLIPSOID_MOTION_INERTIAL;
        model = test_model(&o);
        s[n] = test_vortex_state(&model, &flow);
        assert_ok(ellipsoid_balance(&model, &around, &s[n], NULL));
        assert_ok(ellipsoid_advance(&(ellipsoid_member){&model, &around, &s[n],
                                                        &controller, NULL, NULL,
                                                        &statistics},
                                    &t, 2e-3, NULL));
    }
    return test_difference(&s[0], &s[1]);
}

/*
    Expansion in the relaxation time: the thirteen equations differ from the
    seven by a term in proportion to it, thus to the density, and by its
    square. At 104 kg/m3 (relaxation 1e-8 s, flow 1e-3 s) the latter is 1e-5 of
    the former; at a tolerance of 1e-12 the integrators' errors are 1e-3 of the
    smallest difference: 2 % over three decades.
*/
static void test_limit_of_no_inertia(void **unused)
{
    test_errors e[4];

    (void)unused;
    for (int n = 0; n < 4; n++)
    {
        e[n] = distance_between_motions(1040 * pow(10, -n));
        print_message("# density %g kg/m3: x %.2e m, q %.2e, u %.2e m/s, "
                      "omega %.2e rad/s\n",
                      1040 * pow(10, -n), e[n].x, e[n].q, e[n].u, e[n].omega);
    }
    for (int n = 1; n < 4; n++)
    {
        assert_relative(e[n - 1].x / e[n].x, 10, 0.02);
        assert_relative(e[n - 1].q / e[n].q, 10, 0.02);
        assert_relative(e[n - 1].u / e[n].u, 10, 0.02);
        assert_relative(e[n - 1].omega / e[n].omega, 10, 0.02);
    }
}

/* u and omega balance the forces: the accelerations of the thirteen equations
   vanish but for rounding of the drag. */
static void test_forceBalance(void **unused)
{
    ellipsoid_model model = test_unit_body();
    test_vortices flow = {1, 1};
    const ellipsoid_surroundings around = {.flow = test_vortex_flow,
                                           .flow_context = &flow};
    ellipsoid_state s = test_vortex_state(&model, &flow), d;

    (void)unused;
    model.constant_force[0] = 2;
    assert_ok(ellipsoid_balance(&model, &around, &s, NULL));
    for (int i = 0; i < 3; i++)
    {
        model.inertia[i] = 1; /* no gyroscopic torque */
    }
    assert_ok(ellipsoid_rhs(&model, &around, &s, NULL, &d));
    for (int i = 0; i < 3; i++)
    {
        assert_near(d.u[i], 0, 1e-14 * model.viscosity * model.resistance[i]);
        assert_near(d.omega[i], 0,
                    1e-14 * model.viscosity * model.rotation_resistance[i]);
    }
    model.options.motion = ELLIPSOID_MOTION_INERTIALESS;
    memset(s.u, 0, sizeof(s.u));
    assert_ok(ellipsoid_rhs(&model, &around, &s, NULL, &d));
    assert_ok(ellipsoid_balance(&model, &around, &s, NULL));
    assert_memory_equal(d.x, s.u, sizeof(s.u));
}

/* ------------------------------------------------------------------ order */

typedef struct kept_step
{
    int count;
    ellipsoid_step last;
} kept_step;

static int keep_step(void *context, const ellipsoid_step *step)
{
    kept_step *kept = context;

    kept->last = *step;
    kept->count++;
    return 0;
}

/* One explicit step of length h from the same start. */
static ellipsoid_step explicit_step(double h)
{
    ellipsoid_model model = test_unit_body();
    test_vortices flow = {1, 1};
    const ellipsoid_surroundings around = {.flow = test_vortex_flow,
                                           .flow_context = &flow};
    ellipsoid_state s = test_vortex_state(&model, &flow);
    ellipsoid_controller controller = {.step = h};
    ellipsoid_statistics statistics = {0};
    kept_step kept = {0};
    double t = 0;

    model.options.motion = ELLIPSOID_MOTION_INERTIALESS;
    model.options.tolerance = 0.1;
    assert_ok(
        ellipsoid_advance(&(ellipsoid_member){&model, &around, &s, &controller,
                                              NULL, &kept, &statistics},
                          &t, h, keep_step));
    assert_int_equal(kept.count, 1);
    return kept.last;
}

static ellipsoid_state exact_at(double end)
{
    ellipsoid_model model = test_unit_body();
    test_vortices flow = {1, 1};
    const ellipsoid_surroundings around = {.flow = test_vortex_flow,
                                           .flow_context = &flow};
    ellipsoid_state s = test_vortex_state(&model, &flow);
    ellipsoid_controller controller = {.step = 1e-4};
    ellipsoid_statistics statistics = {0};
    double t = 0;

    model.options.motion = ELLIPSOID_MOTION_INERTIALESS;
    model.options.tolerance = 1e-14;
    assert_ok(
        ellipsoid_advance(&(ellipsoid_member){&model, &around, &s, &controller,
                                              NULL, NULL, &statistics},
                          &t, end, NULL));
    return s;
}

/*
    Kutta's 3/8 rule: a step's error falls with the fifth power of its length;
    that of Hermite's cubic with the fourth, and that of its derivative, which u
    and omega are, with the third.
*/
static void test_explicit_order(void **unused)
{
    const double h[2] = {0.08, 0.04};
    test_errors end[2], inside[2];

    (void)unused;
    for (int n = 0; n < 2; n++)
    {
        const ellipsoid_step step = explicit_step(h[n]);
        ellipsoid_state s, exact = exact_at(h[n]);

        end[n] = test_difference(&step.after, &exact);
        exact = exact_at(0.4 * h[n]);
        ellipsoid_step_state(&step, 0.4 * h[n], &s);
        inside[n] = test_difference(&s, &exact);
        ellipsoid_step_state(&step, h[n], &s);
        assert_memory_equal(&s, &step.after, sizeof(s));
    }
    print_message("# order of a step: x %.2f, q %.2f; inside: x %.2f, q %.2f, "
                  "u %.2f, omega %.2f\n",
                  log2(end[0].x / end[1].x), log2(end[0].q / end[1].q),
                  log2(inside[0].x / inside[1].x),
                  log2(inside[0].q / inside[1].q),
                  log2(inside[0].u / inside[1].u),
                  log2(inside[0].omega / inside[1].omega));
    assert_true(log2(end[0].x / end[1].x) >= 4.7);
    assert_true(log2(end[0].q / end[1].q) >= 4.7);
    assert_true(log2(end[0].x / end[1].x) < 5.7);
    assert_true(log2(inside[0].x / inside[1].x) >= 3.7);
    assert_true(log2(inside[0].q / inside[1].q) >= 3.7);
    assert_true(log2(inside[0].u / inside[1].u) >= 2.7);
    assert_true(log2(inside[0].omega / inside[1].omega) >= 2.7);
}

/* ------------------------------------------------------------------- walls */

typedef struct settling
{
    ellipsoid_model model;
    ellipsoid_state state;
    ellipsoid_statistics statistics;
    double ends;
} settling;

/* A heavy cell sinks on a floor beneath a shear and slides along. */
static settling settle(ellipsoid_motion motion, const wall_mesh *floor,
                       double end)
{
    static ellipsoid_facet_cache cache;
    ellipsoid_options o = test_paper_options();
    test_quadratic flow = {.answer = 0};
    const ellipsoid_surroundings around = {.flow = test_quadratic_flow,
                                           .flow_context = &flow,
                                           .walls = wall_mesh_list,
                                           .walls_context = (void *)floor};
    ellipsoid_controller controller = {0};
    settling s = {.ends = 0};

    flow.g[0][2] = 10;
    o.motion = motion;
    o.density = 1e4;
    o.tolerance = 1e-9;
    s.model = test_model(&o);
    s.state.x[2] = 1e-6;
    ellipsoid_quaternion_from_axis((const double[3]){0.9, 0.3, 0.3}, 0.4,
                                   s.state.q);
    ellipsoid_facet_cache_clear(&cache);
    assert_ok(ellipsoid_advance(&(ellipsoid_member){&s.model, &around, &s.state,
                                                    &controller, &cache, NULL,
                                                    &s.statistics},
                                &s.ends, end, NULL));
    return s;
}

/*
    With and without inertia the cell sinks, touches and slides the same way: in
    0.5 s the difference is that of the relaxation time, 1.4e-6 s, over which
    the cell moves 2e-11 m, and what the shear of 10 1/s makes of it.
*/
static void test_on_a_floor(void **unused)
{
    const double corner[3] = {-2e-5, -2e-5, 0};
    const double u[3] = {4e-5, 0, 0}, v[3] = {0, 4e-5, 0};
    wall_mesh floor;
    settling s[2];
    test_errors e;

    (void)unused;
    wall_mesh_init(&floor);
    wall_mesh_plane(&floor, corner, u, v, 2, 2, 0, 0);
    wall_mesh_finish(&floor);
    s[0] = settle(ELLIPSOID_MOTION_INERTIAL, &floor, 0.5);
    s[1] = settle(ELLIPSOID_MOTION_INERTIALESS, &floor, 0.5);
    e = test_difference(&s[0].state, &s[1].state);
    print_message("# floor: x %.1e m, q %.1e; steps %ld and %ld, Jacobians %ld "
                  "and %ld\n",
                  e.x, e.q, s[0].statistics.accepted, s[1].statistics.accepted,
                  s[0].statistics.jacobians, s[1].statistics.jacobians);
    assert_true(s[1].statistics.deepest > 0);
    assert_true(s[1].statistics.jacobians > 0);
    assert_true(s[0].state.x[0] > 1e-6);
    assert_true(e.x < 1e-9);
    assert_true(e.q < 1e-4);
    wall_mesh_free(&floor);
}

/* --------------------------------------------------------------- interface */

/* What is put in for u and omega is not read; on a failure nothing changes. */
static void test_interface(void **unused)
{
    const ellipsoid_options o = without_inertia();
    const ellipsoid_model model = test_model(&o);
    test_quadratic flow = test_shear(rate);
    ellipsoid_controller controller = {0};
    ellipsoid_statistics statistics = {0};
    ellipsoid_state s[2] = {{.q = {0, 0, 0, 1}}, {.q = {0, 0, 0, 1}}}, before;
    double t[2] = {0, 0};

    (void)unused;
    ellipsoid_set(s[1].u, NAN, 1, 2);
    ellipsoid_set(s[1].omega, INFINITY, 1, 2);
    for (int n = 0; n < 2; n++)
    {
        controller.step = controller.previous_error = 0;
        assert_ok(test_advance(&model, &flow, &s[n], &t[n], 1e-3, &controller,
                               &statistics));
    }
    assert_memory_equal(&s[0], &s[1], sizeof(s[0]));

    before = s[0];
    flow.answer = -1;
    assert_int_equal(
        test_advance(&model, &flow, &s[0], &t[0], 1, &controller, &statistics),
        ELLIPSOID_FLOW_FAILED);
    assert_int_equal(
        test_advance(&model, NULL, &s[0], &t[0], 1, &controller, &statistics),
        ELLIPSOID_BAD_OPTION);
    flow.answer = 1;
    assert_int_equal(
        test_advance(&model, &flow, &s[0], &t[0], 1, &controller, &statistics),
        ELLIPSOID_OUTSIDE);
    flow.answer = 0;
    flow.u[0] = NAN;
    assert_int_equal(
        test_advance(&model, &flow, &s[0], &t[0], 1, &controller, &statistics),
        ELLIPSOID_NON_FINITE);
    assert_memory_equal(&s[0], &before, sizeof(before));
    assert_true(t[0] == 1e-3);
}

/* Shear that refuses its derivatives as often as it is told to. */
typedef struct reluctant
{
    test_quadratic flow;
    int refusals;
} reluctant;

static int reluctant_flow(void *context, double t, const double x[3],
                          int derivatives, ellipsoid_flow_sample *sample)
{
    reluctant *r = context;

    if (derivatives && r->refusals > 0)
    {
        r->refusals--;
        return 1;
    }
    return test_quadratic_flow(&r->flow, t, x, derivatives, sample);
}

/* Derivatives that could not be had are asked for again with the next, shorter
   attempt. A dipole makes the steps Rosenbrock's. */
static void test_refused_derivatives(void **unused)
{
    ellipsoid_options o = without_inertia();
    reluctant r = {test_shear(rate), 1};
    const ellipsoid_surroundings around = {.flow = reluctant_flow,
                                           .flow_context = &r};
    ellipsoid_state s = {.q = {0, 0, 0, 1}};
    ellipsoid_controller controller = {0};
    ellipsoid_statistics statistics = {0};
    ellipsoid_model model;
    double t = 0;

    (void)unused;
    o.dipole[0] = 1e-20;
    o.electric_field[1] = 1;
    model = test_model(&o);
    assert_ok(
        ellipsoid_advance(&(ellipsoid_member){&model, &around, &s, &controller,
                                              NULL, NULL, &statistics},
                          &t, 1e-3, NULL));
    assert_int_equal(statistics.rejected, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_jeffery_orbits),
        cmocka_unit_test(test_limit_of_no_inertia),
        cmocka_unit_test(test_forceBalance),
        cmocka_unit_test(test_explicit_order),
        cmocka_unit_test(test_on_a_floor),
        cmocka_unit_test(test_interface),
        cmocka_unit_test(test_refused_derivatives),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
