/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_planeSolver.c - the boundary elements that the table of planes is made
    of, against published values. They run where the table is made: what they
    give is compared with the table on any day (test_planeFunctions.c), all of
    this in the full run.
*/
#include "coreTest.h"
#include "nearWallTest.h"

/* It is no part of the library. */
#include "../../tools/planeTable/planePanels.c"
#include "../../tools/planeTable/planeSolver.c"

static const plane_mesh fine = {5, 2, 6, 8};

static plane_functions solve(double ratio, double tilt, double gap)
{
    const plane_case c = {ratio, tilt, gap};
    plane_functions f;

    assert_true(plane_solve(&c, &fine, &f));
    return f;
}

/* It vanishes on the plane, is symmetric (Lorentz), and a force far from the
   plane acts as in free space. */
static void test_green(void **unused)
{
    const double x[3] = {0.3, -0.2, 0.7}, y[3] = {-0.4, 0.5, 1.1};
    const double on[3] = {0.3, -0.2, 0};
    const double high[3] = {0.3, -0.2, 1e6}, near[3] = {1.3, 0.8, 1e6 + 1};
    double g[3][3], back[3][3];

    (void)unused;
    plane_green(on, y, g);
    for (int i = 0; i < 9; i++)
    {
        assert_near(g[i / 3][i % 3], 0, 1e-14);
    }
    plane_green(x, y, g);
    plane_green(y, x, back);
    for (int i = 0; i < 9; i++)
    {
        assert_near(g[i / 3][i % 3], back[i % 3][i / 3], 1e-14);
    }
    plane_green(high, near, g);
    assert_near(g[0][0], (1 + 1.0 / 3) / sqrt(3), 2e-6);
    assert_near(g[0][1], 1.0 / 3 / sqrt(3), 2e-6);
}

/* Spheres: Goldman, Cox & Brenner, Chem. Eng. Sci. 22, 637 and 653 (1967),
   tables 2 and 1: their last digits, and up to 6e-4 of rotation, where they
   interpolate. The axis may point anywhere. */
static void test_sphere(void **unused)
{
    (void)unused;
    for (int n = 0; n < 8; n += (int)test_count(8, 8, 1))
    {
        const struct goldman *k = &goldman[n];
        const plane_functions f = solve(1, 0.6, k->height - 1);
        const double along = k->force_u * 6 * test_pi;
        const double by_turn = k->torque_u * 8 * test_pi;
        const double turn = k->torque_omega * 8 * test_pi;

        assert_relative(f.in[0][0], along, 3e-4);
        assert_relative(f.across[0][0], along, 3e-4);
        assert_near(f.in[0][2], -by_turn, 6e-4 * by_turn + 1e-5 * turn);
        assert_near(f.across[0][1], by_turn, 6e-4 * by_turn + 1e-5 * turn);
        assert_relative(f.in[2][2], turn, 5e-4);
        /* about the plane: z, not z less the height of the centre */
        assert_relative(f.shear_in[0] + k->height * f.in[0][0],
                        6 * test_pi * k->height * k->force_s, 1e-4);
        assert_relative(f.shear_across[0] + k->height * f.across[0][0],
                        6 * test_pi * k->height * k->force_s, 1e-4);
        assert_relative(f.shear_in[2] + k->height * f.in[0][2],
                        4 * test_pi * k->torque_s, 1e-4);
        assert_relative(f.in[1][1], 6 * test_pi * brenner_towards(k->height),
                        1e-3);
    }
}

/* Far away: Jeffery (1922), as the core has it (test_resistance.c); the free
   motion in a shear, too. The plane's part is of the order 1/h. */
static void test_alone(void **unused)
{
    static const double ratios[] = {0.25, 0.5, 2, 4, 10};

    (void)unused;
    for (int n = 3; n < 8; n += (int)test_count(5, 5, 1))
    {
        const double b = ratios[n % 5], axes[3] = {1, b, 1};
        const plane_functions f = solve(b, test_pi / 2, 1e7);
        const double bent = (b * b - 1) / (b * b + 1);
        double k[3], c[3];

        ellipsoid_resistance(axes, k, c);
        assert_relative(f.in[0][0], k[1], 2e-4);
        assert_relative(f.in[1][1], k[0], 2e-4);
        assert_relative(f.in[2][2], c[0], 2e-4);
        assert_relative(f.across[0][0], k[0], 2e-4);
        assert_relative(f.across[1][1], c[1], 2e-4);
        /* lying along the shear it turns by (1 - bent)/2, across it rolls by
           1/2 */
        assert_near(f.shear_in[2] / f.in[2][2], 0.5 * (1 - bent), 2e-4);
        assert_near(f.shear_across[1] / f.across[1][1], -0.5, 1e-3);
    }
}

/* Reciprocity of what should be symmetric, at all shapes and tilts. */
static void test_symmetry(void **unused)
{
    static const struct
    {
        double ratio, tilt, gap, most;
    } cases[] = {
        {4, 0.8, 0.05, 2e-5}, {0.25, 1.2, 0.01, 2e-5}, {10, 1, 0.1, 1e-4}};

    (void)unused;
    for (int n = 0; n < test_count(1, 1, 3); n++)
    {
        const plane_functions f =
            solve(cases[n].ratio, cases[n].tilt, cases[n].gap);

        assert_true(f.asymmetry < cases[n].most);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_green),
        cmocka_unit_test(test_sphere),
        cmocka_unit_test(test_alone),
        cmocka_unit_test(test_symmetry),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
