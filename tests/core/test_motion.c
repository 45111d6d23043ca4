/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_motion.c - the motion of a free cell against known solutions.
*/
#include "coreTest.h"

/* ----------------------------------------------------------- Jeffery orbits */

/*
    Jeffery (1922), eqs. 48-49: with a spheroid of aspect ratio r in the shear
    u = (rate x2, 0, 0), its axis at the angle phi from x2 towards x1 follows
    tan(phi) = r tan(rate t/(r + 1/r)), and, out of the plane,
    tan(theta) = C r/sqrt(r^2 cos^2 phi + sin^2 phi): C is constant.
    The angle phi counted through all turns, from an axis and the phase it
    should have.
*/
static double orbit_constant(const double axis[3], double r)
{
    const double across = axis[0] * axis[0] / (r * r) + axis[1] * axis[1];

    return sqrt(across) / fabs(axis[2]);
}

/* A spheroid of the aspect ratio r without the force of the pressure gradient. */
static ellipsoid_model jeffery_body(double r, double density, double tolerance)
{
    ellipsoid_options o = test_free_cell();

    o.semi_axes[1] = r * 0.5e-6;
    o.density = density;
    o.pressure_gradient = ELLIPSOID_PRESSURE_NONE;
    o.tolerance = tolerance;
    return test_model(&o);
}

/* Deviation from Jeffery's axis after `turns` of its period; the shear's rate
   is 1000/s. */
static double jeffery_deviation(double density, double tolerance, double r,
                                double turns, double *constant)
{
    test_quadratic flow = test_shear(1000);
    ellipsoid_state s = {.q = {0, 0, 0, 1}};
    ellipsoid_controller controller = {0};
    ellipsoid_statistics statistics = {0};
    const ellipsoid_model model = jeffery_body(r, density, tolerance);
    const double period = 2 * test_pi * (r + 1 / r) / 1000;
    const double start[3] = {0, 0.8, 0.6};
    const double c = orbit_constant(start, r);
    double t = 0, axis[3], phase, phi, theta, expected[3];

    ellipsoid_quaternion_from_axis(start, 0, s.q);
    assert_ok(test_advance(&model, &flow, &s, &t, turns * period, &controller,
                           &statistics));
    test_long_axis(&s, axis);
    *constant = orbit_constant(axis, r) / c - 1;

    phase = 2 * test_pi * turns;
    phi = atan2(r * sin(phase), cos(phase));
    theta =
        atan2(c * r, sqrt(r * r * cos(phi) * cos(phi) + sin(phi) * sin(phi)));
    expected[0] = sin(theta) * sin(phi);
    expected[1] = sin(theta) * cos(phi);
    expected[2] = cos(theta);
    return sqrt((axis[0] - expected[0]) * (axis[0] - expected[0])
                + (axis[1] - expected[1]) * (axis[1] - expected[1])
                + (axis[2] - expected[2]) * (axis[2] - expected[2]));
}

/*
    As the density goes to zero so does the Stokes number, and the thirteen
    equations follow Jeffery's orbit: at St = 1e-9 to the integrator's
    tolerance, here 1e-10 per step over some thousand steps.
*/
static void test_jeffery_without_inertia(void **unused)
{
    static const test_row axis = {
        "free motion",
        "axis off Jeffery's, in shear",
        "aspect ratios 0.25, 4, 10; 2.15 periods; tolerance 1e-10",
        "Jeffery (1922), eqs. 48, 49",
        "A",
        "1e-10 a step, some thousand steps",
        0};
    static const test_row orbit = {
        "free motion",
        "drift of the orbit constant, over it",
        "aspect ratios 0.25, 4, 10; 2.15 periods; tolerance 1e-10",
        "Jeffery (1922), eq. 49",
        "A",
        "1e-10 a step, some thousand steps",
        0};
    const double ratio[] = {0.25, 4, 10};

    (void)unused;
    for (int n = 0; n < 3; n++)
    {
        double constant;
        const double d =
            jeffery_deviation(1e-3, 1e-10, ratio[n], 2.15, &constant);

        assert_row(&axis, d, 0, 2e-8);
        assert_row(&orbit, constant, 0, 2e-8);
    }
}

/* The deviation due to inertia is proportional to the Stokes number: ten
   times the density, ten times the deviation, to first order in St = 1e-4. */
static void test_jeffery_with_inertia(void **unused)
{
    static const test_row row = {
        "free motion",
        "growth of the deviation from Jeffery's axis by inertia",
        "ten times the density; aspect ratio 4",
        "first order in the Stokes number",
        "A",
        "higher orders, of St = 1e-4, and steps",
        0};
    double constant, d[3];

    (void)unused;
    d[0] = jeffery_deviation(10.4, 1e-11, 4, 1.3, &constant);
    d[1] = jeffery_deviation(104, 1e-11, 4, 1.3, &constant);
    d[2] = jeffery_deviation(1040, 1e-11, 4, 1.3, &constant);
    print_message("# deviation from Jeffery at the cell's density: %.1e\n",
                  d[2]);
    assert_row(&row, d[1] / d[0], 10, 0.2);
    assert_row(&row, d[2] / d[1], 10, 0.2);
}

/* After ten periods the phase is ten turns: what it lacks is the error of the
   period, by 2e-9 an orbit as above. */
static void test_jeffery_period(void **unused)
{
    static const test_row row = {
        "free motion",
        "period in shear over Jeffery's",
        "aspect ratios 2, 4, 10; ten periods; tolerance 1e-10",
        "Jeffery (1922), 2 pi (r + 1/r)/shear",
        "A",
        "1e-10 a step, some thousand steps",
        0};

    (void)unused;
    for (int n = 0; n < 3; n++)
    {
        const double r = (double[]){2, 4, 10}[n];
        const double period = 2 * test_pi * (r + 1 / r) / 1000;
        test_quadratic flow = test_shear(1000);
        ellipsoid_state s = {.q = {0, 0, 0, 1}};
        ellipsoid_controller controller = {0};
        ellipsoid_statistics statistics = {0};
        const ellipsoid_model model = jeffery_body(r, 1e-3, 1e-10);
        double t = 0, axis[3], turned = 0, last = 0;

        for (int part = 1; part <= 400; part++)
        {
            double angle;

            assert_ok(test_advance(&model, &flow, &s, &t, part * period / 40,
                                   &controller, &statistics));
            test_long_axis(&s, axis);
            angle = atan2(axis[0], r * axis[1]);
            turned += remainder(angle - last, 2 * test_pi);
            last = angle;
        }
        assert_row(&row, 20 * test_pi / turned, 1, 2e-9);
    }
}

/* Log-rolling is a fixed point: nothing moves but the spin, shear/2. */
static void test_log_rolling(void **unused)
{
    static const test_row row = {
        "free motion",
        "spin of a cell that rolls about its axis, over half the shear",
        "aspect ratio 4, 60 ms at 1000/s",
        "Jeffery (1922)",
        "A",
        "the tolerance, 1e-6",
        0};
    ellipsoid_options o = test_free_cell();
    ellipsoid_model model;
    test_quadratic flow = test_shear(1000);
    ellipsoid_state s;
    ellipsoid_controller controller = {0};
    ellipsoid_statistics statistics = {0};
    double t = 0, axis[3];

    (void)unused;
    o.tolerance = 1e-6;
    model = test_model(&o);
    memset(&s, 0, sizeof(s));
    ellipsoid_quaternion_from_axis((const double[3]){0, 0, 1}, 0, s.q);
    assert_ok(
        test_advance(&model, &flow, &s, &t, 0.06, &controller, &statistics));
    test_long_axis(&s, axis);
    assert_near(axis[2], 1, 1e-14);
    assert_row(&row, s.omega[1] / 500, -1, 1e-6);
}

/* -------------------------------------------------------------- plane slit */

/* The paper's cell in a slit 10 um high, mean speed 4 mm/s, along x2. */
static const double slit_half = 5e-6, slit_fastest = 6e-3;

static test_quadratic slit_flow(void)
{
    test_quadratic flow = {.answer = 0};

    flow.u[1] = slit_fastest;
    flow.h[1][2][2] = -2 * slit_fastest / (slit_half * slit_half);
    return flow;
}

static ellipsoid_state slit_state(int n)
{
    uint64_t seed = 100 + (uint64_t)n;
    ellipsoid_state s;
    double u;

    memset(&s, 0, sizeof(s));
    test_orientation(&seed, s.q);
    s.x[2] = 0.8 * slit_half * test_signed(&seed);
    u = s.x[2] / slit_half;
    s.u[1] = slit_fastest * (1 - u * u);
    return s;
}

/*
    60 ms in the slit at a tolerance of 1e-6: the stiffness must not govern the
    steps (explicit ones would be 1e6). The mean of 20 cells is 370; with the
    tolerance the error falls in proportion.
*/
static void test_slit_steps(void **unused)
{
    static const test_row fine = {
        "integration",
        "error of the quaternion after 60 ms in a slit",
        "20 cells, 4 mm/s in 10 um, tolerance 1e-6",
        "the same at 1e-9",
        "I",
        "20 tolerances, in proportion",
        0};
    static const test_row coarse = {
        "integration",
        "error of the quaternion after 60 ms in a slit",
        "20 cells, 4 mm/s in 10 um, tolerance 1e-5",
        "the same at 1e-9",
        "I",
        "20 tolerances, in proportion",
        0};
    ellipsoid_options o = test_free_cell();
    test_quadratic flow = slit_flow();
    long steps = 0, rejected = 0;
    double error[2] = {0, 0};

    (void)unused;
    for (int n = 0; n < 20; n++)
    {
        static const double tolerance[] = {1e-9, 1e-6, 1e-5};
        ellipsoid_state s[3];

        for (int k = 0; k < 3; k++)
        {
            ellipsoid_controller controller = {0};
            ellipsoid_statistics statistics = {0};
            ellipsoid_model model;
            double t = 0;

            o.tolerance = tolerance[k];
            model = test_model(&o);
            s[k] = slit_state(n);
            assert_ok(test_advance(&model, &flow, &s[k], &t, 0.06, &controller,
                                   &statistics));
            if (k == 1)
            {
                steps += statistics.accepted;
                rejected += statistics.rejected;
            }
            for (int i = 0; k > 0 && i < 4; i++)
            {
                error[k - 1] = fmax(error[k - 1], fabs(s[k].q[i] - s[0].q[i]));
            }
        }
    }
    print_message("# slit: %.0f steps, %.1f rejected, error of q %.1e (1e-6), "
                  "%.1e (1e-5)\n",
                  steps / 20.0, rejected / 20.0, error[0], error[1]);
    assert_true(steps / 20 < 450);
    assert_true(rejected / 20 < 20);
    assert_row(&fine, error[0], 0, 2e-5);
    assert_row(&coarse, error[1], 0, 2e-4);
}

/* |q| = 1 is kept by every step, at whatever tolerance. */
static int check_length(void *context, const ellipsoid_step *step)
{
    const double *q = step->after.q;

    (void)context;
    assert_near(sqrt(ellipsoid_dot(q, q) + q[3] * q[3]), 1, 1e-15);
    return 0;
}

static void test_length_of_q(void **unused)
{
    ellipsoid_options o = test_free_cell();
    test_quadratic flow = slit_flow();
    const ellipsoid_surroundings around = {.flow = test_quadratic_flow,
                                           .flow_context = &flow};
    ellipsoid_model model;

    (void)unused;
    for (o.tolerance = 1e-9; o.tolerance < 0.2; o.tolerance *= 100)
    {
        ellipsoid_state s = slit_state(3);
        ellipsoid_controller controller = {0};
        ellipsoid_statistics statistics = {0};
        double t = 0;

        model = test_model(&o);
        s.q[0] *= 1.001; /* also a careless start is mended */
        assert_ok(ellipsoid_advance(&(ellipsoid_member){&model, &around, &s,
                                                        &controller, NULL, NULL,
                                                        &statistics},
                                    &t, 1, check_length));
        assert_near(sqrt(ellipsoid_dot(s.q, s.q) + s.q[3] * s.q[3]), 1, 1e-15);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_jeffery_without_inertia),
        cmocka_unit_test(test_jeffery_with_inertia),
        cmocka_unit_test(test_jeffery_period),
        cmocka_unit_test(test_log_rolling),
        cmocka_unit_test(test_slit_steps),
        cmocka_unit_test(test_length_of_q),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
