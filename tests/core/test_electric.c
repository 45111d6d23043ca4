/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_electric.c - charges and dipoles in electric fields: F_E = charge E,
    T_E = dipole x E.
*/
#include "coreTest.h"

enum
{
    SIZE = ELLIPSOID_STATE_SIZE
};

static test_quadratic still = {.answer = 0};

/* The polynomial that serves as a flow elsewhere, as a field [V/m]. */
static int polynomial_field(void *context, double t, const double x[3],
                            double field[3], double (*jacobian)[3])
{
    ellipsoid_flow_sample sample;
    const int answer = test_quadratic_flow(context, t, x, 0, &sample);

    memcpy(field, sample.velocity, sizeof(sample.velocity));
    if (jacobian)
    {
        memcpy(jacobian, sample.gradient, sizeof(sample.gradient));
    }
    return answer;
}

/* A field may come with a flow or in vacuum (flow NULL). */
static ellipsoid_surroundings around(test_quadratic *field,
                                     test_quadratic *flow)
{
    return (ellipsoid_surroundings){.flow = flow ? test_quadratic_flow : NULL,
                                    .flow_context = flow,
                                    .field = field ? polynomial_field : NULL,
                                    .field_context = field};
}

/* A triaxial body of order one in a fluid of order one; its dipole and the
   uniform field are along the same axis. */
static ellipsoid_options body(ellipsoid_motion motion, double charge, int axis,
                              double dipole, double field)
{
    ellipsoid_options o = test_free_cell();

    o.motion = motion;
    o.semi_axes[0] = 0.7;
    o.semi_axes[1] = 1.3;
    o.semi_axes[2] = 1;
    o.density = 2;
    o.fluid_density = o.kinematic_viscosity = 1;
    o.tolerance = 1e-12;
    o.charge = charge;
    o.dipole[axis] = dipole;
    o.electric_field[axis] = field;
    return o;
}

static ellipsoid_state advance(const ellipsoid_model *m,
                               const ellipsoid_surroundings *surroundings,
                               const ellipsoid_state *begin, double end)
{
    ellipsoid_state s = *begin;
    ellipsoid_controller controller = {0};
    ellipsoid_statistics statistics = {0};
    double t = 0;

    assert_ok(
        ellipsoid_advance(&(ellipsoid_member){m, surroundings, &s, &controller,
                                              NULL, NULL, &statistics},
                          &t, end, NULL));
    return s;
}

/* ------------------------------------------------------------------- force */

/* Stokes (1851): u = charge E/(6 pi mu a) of a sphere in fluid at rest, where E
   is the sum of the uniform field and that of the surroundings. Rounding. */
static void test_sphere(void **unused)
{
    ellipsoid_options o = body(ELLIPSOID_MOTION_INERTIAL, -0.4, 2, 0, 3);
    test_quadratic field = {.u = {1, 0, -5}};
    const ellipsoid_surroundings s = around(&field, &still);
    const double drift = -0.4 / (6 * test_pi * 0.9);
    ellipsoid_state state = {.q = {0.5, -0.5, 0.1, 0.7}};
    ellipsoid_model m;

    (void)unused;
    o.semi_axes[0] = o.semi_axes[1] = o.semi_axes[2] = 0.9;
    m = test_model(&o);
    assert_ok(ellipsoid_balance(&m, &s, &state, NULL));
    assert_relative(state.u[0], drift, 1e-15);
    assert_relative(state.u[2], -2 * drift, 1e-15);
}

/*
    Fluid: from rest u = u_E (1 - exp(-t/tau)), u_E = charge E/(mu K^), and
    x = u_E t at once without inertia. Errors of the tolerance, 1e-12 a step.
    Vacuum: x = u0 t + charge E t^2/(2 m), exact for a method of order four but
    for rounding.
*/
static void test_uniform_field(void **unused)
{
    const ellipsoid_surroundings fluid = around(NULL, &still);
    const ellipsoid_surroundings vacuum = around(NULL, NULL);

    (void)unused;
    for (int i = 0; i < 3; i++)
    {
        ellipsoid_options o = body(ELLIPSOID_MOTION_INERTIAL, 2, i, 0, 3);
        ellipsoid_model m = test_model(&o);
        const double terminal = 6 / m.resistance[i], gain = 6 / m.mass;
        ellipsoid_state begin = {.q = {0, 0, 0, 1}}, end;

        end = advance(&m, &fluid, &begin, terminal / gain);
        assert_near(end.u[i], -terminal * expm1(-1), 1e-11);
        assert_near(end.x[i], terminal * terminal / gain * exp(-1), 1e-11);
        begin.u[i] = -2;
        end = advance(&m, &vacuum, &begin, 3);
        assert_near(end.u[i], -2 + 3 * gain, 1e-13);
        assert_near(end.x[i], -6 + 4.5 * gain, 1e-13);

        o.motion = ELLIPSOID_MOTION_INERTIALESS;
        m = test_model(&o);
        end = advance(&m, &fluid, &begin, 7);
        assert_relative(end.x[i], 7 * terminal, 1e-14);
        assert_relative(end.u[i], terminal, 1e-15);
    }
}

/*
    E = G x along a principal axis: m x'' + mu K^ x' = charge G x. In vacuum
    that is harmonic for charge G < 0 and exponential for charge G > 0, in a
    fluid it is damped, and without inertia x' = charge G/(mu K^) x. Errors of
    the tolerance, 1e-12, for some ten to hundred steps, growing as x does.
*/
static void check_linear_field(ellipsoid_motion motion, int fluid, int i,
                               double charge)
{
    const ellipsoid_options o = body(motion, charge, i, 0, 0);
    const ellipsoid_model m = test_model(&o);
    const double x0 = 0.5, u0 = 0.2, end = 6;
    const double p = fluid ? m.resistance[i] / (2 * m.mass) : 0;
    const double w2 = -2 * charge / m.mass - p * p, w = sqrt(fabs(w2));
    const double c = w2 > 0 ? cos(w * end) : cosh(w * end);
    const double d = w2 > 0 ? sin(w * end) : sinh(w * end);
    const double x = motion == ELLIPSOID_MOTION_INERTIALESS
                       ? x0 * exp(2 * charge / m.resistance[i] * end)
                       : exp(-p * end) * (x0 * c + (u0 + p * x0) / w * d);
    test_quadratic field = {.answer = 0};
    const ellipsoid_surroundings s = around(&field, fluid ? &still : NULL);
    ellipsoid_state state = {.q = {0, 0, 0, 1}};

    field.g[i][i] = 2;
    state.x[i] = x0;
    state.u[i] = u0;
    state = advance(&m, &s, &state, end);
    assert_near(state.x[i], x, 1e-11 * fmax(1, fabs(x)));
}

static void test_linear_field(void **unused)
{
    (void)unused;
    for (int n = 0; n < 6; n++)
    {
        const double c = n < 3 ? -20 : 3;

        check_linear_field(ELLIPSOID_MOTION_INERTIAL, 0, n % 3, c);
        check_linear_field(ELLIPSOID_MOTION_INERTIAL, 1, n % 3, c);
        check_linear_field(ELLIPSOID_MOTION_INERTIALESS, 1, n % 3, c);
    }
}

/*
    The Jacobian in a linear field, against central differences. In vacuum each
    equation is quadratic in each unknown, so that they are exact: rounding.
*/
static void test_jacobian(void **unused)
{
    uint64_t seed = 2;

    (void)unused;
    for (int n = 0; n < 100; n++)
    {
        ellipsoid_options o =
            body(ELLIPSOID_MOTION_INERTIAL, test_signed(&seed), 0, 0, 0);
        test_quadratic field = {.answer = 0};
        const ellipsoid_surroundings s = around(&field, NULL);
        double jacobian[SIZE][SIZE], y[SIZE], f[2][SIZE];
        ellipsoid_state at;
        ellipsoid_model m;

        for (int i = 0; i < 9; i++)
        {
            o.dipole[i % 3] = test_signed(&seed);
            o.electric_field[i % 3] = test_signed(&seed);
            field.u[i % 3] = test_signed(&seed);
            field.g[i % 3][i / 3] = test_signed(&seed);
        }
        m = test_model(&o);
        for (int i = 0; i < SIZE; i++)
        {
            y[i] = test_signed(&seed);
        }
        memcpy(&at, y, sizeof(at));
        assert_ok(ellipsoid_jacobian(&m, &s, &at, NULL, jacobian));
        for (int j = 0; j < SIZE; j++)
        {
            for (int side = 0; side < 2; side++)
            {
                ellipsoid_state rates;

                y[j] += side ? 1 : -0.5;
                memcpy(&at, y, sizeof(at));
                assert_ok(ellipsoid_rhs(&m, &s, &at, NULL, &rates));
                memcpy(f[side], &rates, sizeof(rates));
            }
            y[j] -= 0.5;
            for (int i = 0; i < SIZE; i++)
            {
                assert_near(jacobian[i][j], f[1][i] - f[0][i], 1e-13);
            }
        }
    }
}

/* ------------------------------------------------------------------ dipole */

/* The angle in which the body axis i is turned from the lab axis i to j. */
static double angle_of(const ellipsoid_state *s, int i, int j)
{
    double r[3][3];

    ellipsoid_rotation(s->q, r);
    return atan2(r[j][i], r[i][i]);
}

/*
    Without inertia mu C theta' = -d E sin(theta) for the angle between dipole
    and field, so tan(theta/2) falls exponentially; from next to the opposite
    direction as well. Dipole along each axis, turning about each of the others.
*/
static void test_alignment(void **unused)
{
    static const double start[] = {0.1, -1, 2.5, 3.1};
    const ellipsoid_surroundings s = around(NULL, &still);

    (void)unused;
    for (int n = 0; n < 24; n++)
    {
        const int back = n / 3 % 2; /* the next axis but one */
        const int i = n % 3, j = (i + 1 + back) % 3, k = 3 - i - j;
        const double theta = start[n / 6];
        const ellipsoid_options o =
            body(ELLIPSOID_MOTION_INERTIALESS, 0, i, 4, 5);
        const ellipsoid_model m = test_model(&o);
        ellipsoid_state state = {.q = {0, 0, 0, cos(theta / 2)}};

        state.q[k] = back ? -sin(theta / 2) : sin(theta / 2);
        state = advance(&m, &s, &state, 3 * m.rotation_resistance[k] / 20);
        assert_near(angle_of(&state, i, j), 2 * atan(tan(theta / 2) * exp(-3)),
                    1e-11);
    }
}

/*
    In vacuum I theta'' = -d E sin(theta): a pendulum. Its period is
    4 sqrt(I/(d E)) K(k), k = sin(theta_0/2), K(k) = R_F(0, 1 - k^2, 1);
    2 pi sqrt(I/(d E)) for a small amplitude. After ten periods it is back and
    half a period earlier on the other side: there errors of the time are of
    second order, 1e-11. A quarter later it passes the field's direction.
*/
static void test_pendulum(void **unused)
{
    static const double amplitude[] = {1e-3, 1, 3.1};
    const ellipsoid_surroundings s = around(NULL, NULL);

    (void)unused;
    /* Of few each amplitude and each axis once */
    for (long n = 0; n < 9; n += test_count(4, 1, 1))
    {
        const int i = n % 3, j = (i + 1) % 3, k = 3 - i - j;
        const double theta = amplitude[n / 3], cosine = cos(theta / 2);
        const ellipsoid_options o = body(ELLIPSOID_MOTION_INERTIAL, 0, i, 4, 5);
        const ellipsoid_model m = test_model(&o);
        const double small = sqrt(m.inertia[k] / 20);
        const double period =
            4 * small * ellipsoid_carlson_rf(0, cosine * cosine, 1);
        ellipsoid_state begin = {.q = {0, 0, 0, cosine}}, end;

        assert_true(n >= 3 || fabs(period / (2 * test_pi * small) - 1) < 1e-7);
        begin.q[k] = sin(theta / 2);
        end = advance(&m, &s, &begin, 9.5 * period);
        assert_near(angle_of(&end, i, j), -theta, 1e-11);
        end = advance(&m, &s, &begin, 10 * period);
        assert_near(angle_of(&end, i, j), theta, 1e-11);
        end = advance(&m, &s, &begin, 10.25 * period);
        assert_near(angle_of(&end, i, j), 0, 1e-8);
    }
}

/*
    A sphere with a dipole, in a field along x2 and a shear u = (rate x2, 0, 0):
    phi, from x2 to x1, follows phi' = rate/2 - b sin(phi), b = d E/(mu C),
    C = 8 pi a^3 (Adler's equation). Above the critical field it stands still at
    sin(phi) = rate/(2 b), with inertia or without. Below it turns with the
    period 2 pi/w, w^2 = rate^2/4 - b^2; half of it leads to tan(phi/2) =
    rate/(2 b). Tolerance 1e-12 a step, a hundred steps.
*/
static void test_dipole_in_shear(void **unused)
{
    static const double strength[] = {0.5, 0.9, 1.1, 1.1, 4, 4};
    test_quadratic shear = test_shear(3);
    const ellipsoid_surroundings s = around(NULL, &shear);
    const ellipsoid_state begin = {.q = {0, 0, 0, 1}};

    (void)unused;
    for (int n = 0; n < 6; n++)
    {
        const double b = strength[n] * 1.5, a = 0.8;
        const double half = test_pi / sqrt(fabs(1.5 * 1.5 - b * b));
        const int below = strength[n] < 1;
        ellipsoid_options o = body(below || n % 2 ? ELLIPSOID_MOTION_INERTIALESS
                                                  : ELLIPSOID_MOTION_INERTIAL,
                                   0, 1, 2, b * 4 * test_pi * a * a * a);
        ellipsoid_model m;
        ellipsoid_state end;

        o.semi_axes[0] = o.semi_axes[1] = o.semi_axes[2] = a;
        m = test_model(&o);
        end = advance(&m, &s, &begin, 11 * half);
        assert_near(angle_of(&end, 1, 0),
                    below ? 2 * atan(1.5 / b) : asin(1.5 / b), 1e-10);
        end = advance(&m, &s, &begin, 12 * half);
        assert_near(angle_of(&end, 1, 0), below ? 0 : asin(1.5 / b), 1e-10);
    }
}

/* ---------------------------------------------------------------- statuses */

/* The field ends at x1 = 1. */
static int ending_field(void *context, double t, const double x[3],
                        double field[3], double (*jacobian)[3])
{
    return polynomial_field(context, t, x, field, jacobian) + (x[0] > 1);
}

/* What the callback answers, as for the flow; what it gives must be finite; and
   where it wants shorter steps the body goes to that place and no farther. */
static void test_statuses(void **unused)
{
    const ellipsoid_options o = body(ELLIPSOID_MOTION_INERTIAL, 1, 0, 0, 0);
    const ellipsoid_model m = test_model(&o);
    test_quadratic field = {.u = {1, 0, 0}};
    ellipsoid_surroundings s = around(&field, NULL);
    ellipsoid_state state = {.q = {0, 0, 0, 1}}, derivative;
    ellipsoid_controller controller = {0};
    ellipsoid_statistics statistics = {0};
    double jacobian[SIZE][SIZE], t = 0;

    (void)unused;
    field.answer = 1;
    assert_int_equal(ellipsoid_rhs(&m, &s, &state, NULL, &derivative),
                     ELLIPSOID_STEP_UNDERFLOW);
    field.answer = -1;
    assert_int_equal(ellipsoid_rhs(&m, &s, &state, NULL, &derivative),
                     ELLIPSOID_FLOW_FAILED);
    assert_int_equal(ellipsoid_jacobian(&m, &s, &state, NULL, jacobian),
                     ELLIPSOID_FLOW_FAILED);
    field.answer = 0;
    field.u[1] = NAN;
    assert_int_equal(ellipsoid_rhs(&m, &s, &state, NULL, &derivative),
                     ELLIPSOID_NON_FINITE);

    field.u[1] = 0;
    s.field = ending_field;
    assert_int_equal(
        ellipsoid_advance(&(ellipsoid_member){&m, &s, &state, &controller, NULL,
                                              NULL, &statistics},
                          &t, 1e3, NULL),
        ELLIPSOID_STEP_UNDERFLOW);
    assert_true(state.x[0] <= 1 && state.x[0] > 1 - 1e-12);
    assert_relative(t, sqrt(2 * m.mass), 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sphere),
        cmocka_unit_test(test_uniform_field),
        cmocka_unit_test(test_linear_field),
        cmocka_unit_test(test_jacobian),
        cmocka_unit_test(test_alignment),
        cmocka_unit_test(test_pendulum),
        cmocka_unit_test(test_dipole_in_shear),
        cmocka_unit_test(test_statuses),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
