/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_tilts.c - triaxial ellipsoids that turn about a principal axis in simple
    shear: how small tilts of that axis change. The shear is u = (x2, 0, 0)
    [1/s], the viscosity 1.
*/
#include "coreTest.h"

static ellipsoid_model turning_body(const double axes[3])
{
    ellipsoid_options o = test_free_cell();

    ellipsoid_copy(axes, o.semi_axes);
    o.motion = ELLIPSOID_MOTION_INERTIALESS;
    o.density = o.fluid_density = o.kinematic_viscosity = 1;
    o.pressure_gradient = ELLIPSOID_PRESSURE_NONE;
    o.tolerance = 1e-13;
    return test_model(&o);
}

/*
    Half a turn about the third axis, which the vorticity is along but for
    tilts e1 and e2: the map of these by Jeffery's equations to first order,
    with classical Runge-Kutta steps. z is the lab's third axis in the body:
    z' = z x w.
*/
static void tilt_rates(const double a[3], const double y[3], double f[3])
{
    const double s[3] = {a[0] * a[0], a[1] * a[1], a[2] * a[2]};
    const double c2 = cos(2 * y[2]), s2 = sin(2 * y[2]);
    const double w1 =
        -y[0] / 2 + (s[1] - s[2]) / (s[1] + s[2]) * (s2 * y[1] - c2 * y[0]) / 2;
    const double w2 =
        -y[1] / 2 - (s[2] - s[0]) / (s[2] + s[0]) * (s2 * y[0] + c2 * y[1]) / 2;
    const double w3 = -0.5 + (s[0] - s[1]) / (s[0] + s[1]) * c2 / 2;

    ellipsoid_set(f, w3 * y[1] - w2, w1 - w3 * y[0], w3);
}

static double half_trace(const double a[3])
{
    const int steps = 20000;
    const double h = test_pi * (a[0] / a[1] + a[1] / a[0]) / steps;
    double sum = 0;

    for (int j = 0; j < 2; j++)
    {
        double y[3] = {j == 0, j == 1, 0};

        for (int n = 0; n < steps; n++)
        {
            double k[4][3], at[3];

            tilt_rates(a, y, k[0]);
            for (int stage = 1; stage < 4; stage++)
            {
                for (int i = 0; i < 3; i++)
                {
                    at[i] = y[i] + (stage < 3 ? h / 2 : h) * k[stage - 1][i];
                }
                tilt_rates(a, at, k[stage]);
            }
            for (int i = 0; i < 3; i++)
            {
                y[i] += h * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]) / 6;
            }
        }
        assert_near(y[2], -test_pi, 1e-9);
        sum += y[j] / 2;
    }
    return sum;
}

/* The same of the core, with tilts of 1e-5. */
static double own_half_trace(const double a[3])
{
    const double tilt = 1e-5;
    const ellipsoid_model m = turning_body(a);
    double sum = 0;

    for (int j = 0; j < 2; j++)
    {
        test_quadratic flow = test_shear(1);
        ellipsoid_state s = {.q = {j * tilt / 2, (j - 1) * tilt / 2, 0, 1}};
        ellipsoid_controller controller = {0};
        ellipsoid_statistics statistics = {0};
        double r[3][3], t = 0;

        ellipsoid_normalise(s.q);
        assert_ok(test_advance(&m, &flow, &s, &t,
                               test_pi * (a[0] / a[1] + a[1] / a[0]),
                               &controller, &statistics));
        ellipsoid_rotation(s.q, r);
        sum += r[2][j] / tilt / 2;
    }
    return sum;
}

static void test_half_turn(void **unused)
{
    static const test_row row = {
        "free motion",
        "half the trace of the map of tilts in half a turn",
        "axes 4:2:1 and 5:1.5:1, each along the vorticity",
        "Jeffery (1922) to first order, by Runge-Kutta steps",
        "S",
        "1e-13 a step over tilts of 1e-5, some hundred steps",
        0};
    static const double shapes[2][3] = {{4, 2, 1}, {5, 1.5, 1}};

    (void)unused;
    for (int n = 0; n < 6; n++)
    {
        const double *a = shapes[n / 3];
        const double axes[3] = {a[(n + 1) % 3], a[(n + 2) % 3], a[n % 3]};
        const double own = own_half_trace(axes);

        print_message("# %g:%g:%g, turning about the last: %.6f\n", axes[0],
                      axes[1], axes[2], own);
        assert_row(&row, own - half_trace(axes), 0, 1e-6);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_half_turn),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
