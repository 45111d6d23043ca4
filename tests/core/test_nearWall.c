/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    test_nearWall.c - resistance near one plane wall, against what is known of
    it from elsewhere.
*/
#include "coreTest.h"
#include "nearWall.h"

/* The whole resistance over mu, columns; the wall's normal is m (body). */
static void resistance(const ellipsoid_model *model, const double m[3],
                       double height, double matrix[6][6])
{
    for (int n = 0; n < 6; n++)
    {
        double rates[6] = {0};

        rates[n] = 1;
        ellipsoid_plane_resistance(model, m, height, rates, matrix[n], NULL);
        matrix[n][n] +=
            n < 3 ? model->resistance[n] : model->rotation_resistance[n - 3];
    }
}

static ellipsoid_model body(double a1, double a2, double a3)
{
    ellipsoid_options o = test_free_cell();

    ellipsoid_set(o.semi_axes, a1, a2, a3);
    o.wall_resistance = ELLIPSOID_WALL_RESISTANCE_PLANE;
    o.wall_range = 1e6;
    o.lubrication_gap = 1e-12;
    return test_model(&o);
}

static const double up[3] = {0, 0, 1};

/*
    A sphere of radius 1: mobilities along the wall, Faxen (1923), and towards
    it, Lorentz (1907), by powers of s = a/h up to s^5 and s^3 in Happel and
    Brenner's book (1965), eqs. 7-4.38 and 7-4.28. The model is exact to s^3
    here: of s^4 and above it may be off by 0.35 s^4 of the free mobility, more
    than its own terms come to.
*/
static void test_sphere_far(void **unused)
{
    const ellipsoid_model m = body(1, 1, 1);
    double worst[2] = {0, 0};

    (void)unused;
    for (double s = 0.02; s <= 0.505; s += 0.02)
    {
        const double s3 = s * s * s;
        const double along = 1 - 9 * s / 16 + s3 / 8 - 45 * s3 * s / 256
                           - s3 * s * s / 16;
        const double towards = 1 - 9 * s / 8 + s3 / 2;
        double a[6][6];

        resistance(&m, up, 1 / s, a);
        assert_near(6 * test_pi / a[0][0], along, 0.35 * s3 * s);
        assert_near(6 * test_pi / a[1][1], along, 0.35 * s3 * s);
        assert_near(6 * test_pi / a[2][2], towards, 0.35 * s3 * s);
        worst[0] = fmax(worst[0], fabs(6 * test_pi / a[0][0] / along - 1));
        worst[1] = fmax(worst[1], fabs(6 * test_pi / a[2][2] / towards - 1));
    }
    print_message("sphere, s <= 0.5: along %.2e, towards %.2e\n", worst[0],
                  worst[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sphere_far),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
