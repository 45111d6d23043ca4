/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_rotation.c - quaternions, rotation matrices, Euler angles. All
    tolerances are a few roundings of numbers of order one.
*/
#include "coreTest.h"

static void multiply(double a[3][3], double b[3][3], double c[3][3])
{
    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            c[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
        }
    }
}

/* R = (eta^2 - eps.eps) I + 2 eps eps^T + 2 eta [eps]x, for any |q|. */
static void test_definition(void **unused)
{
    uint64_t seed = 3;

    (void)unused;
    for (int n = 0; n < 100; n++)
    {
        double q[4], r[3][3], square = 0;

        for (int i = 0; i < 4; i++)
        {
            q[i] = test_signed(&seed);
        }
        square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2];
        ellipsoid_rotation(q, r);
        for (int i = 0; i < 3; i++)
        {
            const int j = (i + 1) % 3, k = (i + 2) % 3;

            assert_near(r[i][i], q[3] * q[3] - square + 2 * q[i] * q[i], 2e-15);
            assert_near(r[i][j], 2 * q[i] * q[j] - 2 * q[3] * q[k], 2e-15);
            assert_near(r[j][i], 2 * q[i] * q[j] + 2 * q[3] * q[k], 2e-15);
        }
    }
}

static void test_orthogonal(void **unused)
{
    uint64_t seed = 4;

    (void)unused;
    for (int n = 0; n < 100; n++)
    {
        double q[4], r[3][3];

        test_orientation(&seed, q);
        ellipsoid_rotation(q, r);
        for (int i = 0; i < 3; i++)
        {
            for (int j = 0; j < 3; j++)
            {
                assert_near(ellipsoid_dot(r[i], r[j]), i == j, 2e-15);
            }
        }
    }
}

/* dq/dt = 1/2 Q(w) q turns the body axes at the rate R w x axis. */
static void test_spin(void **unused)
{
    uint64_t seed = 5;
    const double h = 1e-5;

    (void)unused;
    for (int n = 0; n < 100; n++)
    {
        double q[4], w[3], rate[4], lab[3], before[3][3], after[3][3], r[3][3];
        double plus[4], minus[4];

        test_orientation(&seed, q);
        for (int i = 0; i < 3; i++)
        {
            w[i] = test_signed(&seed);
        }
        ellipsoid_spin(w, q, rate);
        for (int i = 0; i < 4; i++)
        {
            plus[i] = q[i] + h * rate[i] / 2;
            minus[i] = q[i] - h * rate[i] / 2;
        }
        ellipsoid_rotation(q, r);
        ellipsoid_rotation(plus, after);
        ellipsoid_rotation(minus, before);
        for (int i = 0; i < 3; i++)
        {
            lab[i] = ellipsoid_dot(r[i], w);
        }
        for (int a = 0; a < 3; a++)
        {
            for (int i = 0; i < 3; i++)
            {
                const int j = (i + 1) % 3, k = (i + 2) % 3;

                /* central differences of a quadratic: rounding over h */
                assert_near((after[i][a] - before[i][a]) / (2 * h),
                            lab[j] * r[k][a] - lab[k] * r[j][a], 1e-10);
            }
        }
    }
}

/* The three turns of the paper's Figure 3B one after the other. */
static void test_euler_is_z_x_z(void **unused)
{
    uint64_t seed = 6;

    (void)unused;
    for (int n = 0; n < 100; n++)
    {
        const double euler[3] = {test_pi * test_signed(&seed),
                                 test_pi * test_uniform(&seed),
                                 test_pi * test_signed(&seed)};
        const double cp = cos(euler[0]), sp = sin(euler[0]);
        const double ct = cos(euler[1]), st = sin(euler[1]);
        const double cs = cos(euler[2]), ss = sin(euler[2]);
        double phi[3][3] = {{cp, -sp, 0}, {sp, cp, 0}, {0, 0, 1}};
        double theta[3][3] = {{1, 0, 0}, {0, ct, -st}, {0, st, ct}};
        double psi[3][3] = {{cs, -ss, 0}, {ss, cs, 0}, {0, 0, 1}};
        double first[3][3], expected[3][3], r[3][3], q[4], back[3];

        multiply(phi, theta, first);
        multiply(first, psi, expected);
        ellipsoid_quaternion_from_euler(euler, q);
        ellipsoid_rotation(q, r);
        for (int i = 0; i < 3; i++)
        {
            for (int j = 0; j < 3; j++)
            {
                assert_near(r[i][j], expected[i][j], 2e-15);
            }
        }
        ellipsoid_euler_from_quaternion(q, back);
        for (int i = 0; i < 3; i++)
        {
            /* the angles lose what sin(theta) does not resolve */
            assert_near(back[i], euler[i], 4e-15 / st);
        }
    }
}

/* Also where phi and psi are not defined one by one, psi is then 0. */
static void test_euler_round_trip(void **unused)
{
    const double special[][4] = {
        {0, 0, 0, 1}, {0, 0, 1, 0},      {1, 0, 0, 0},
        {0, 1, 0, 0}, {0, 0, 0.6, -0.8}, {0.6, 0.8, 0, 0},
    };
    const int count = sizeof(special) / sizeof(*special);
    uint64_t seed = 7;

    (void)unused;
    for (int n = 0; n < 200; n++)
    {
        double q[4], euler[3], back[4], product = 0;

        test_orientation(&seed, q);
        if (n < count)
        {
            memcpy(q, special[n], sizeof(q));
        }
        ellipsoid_euler_from_quaternion(q, euler);
        ellipsoid_quaternion_from_euler(euler, back);
        for (int i = 0; i < 4; i++)
        {
            product += q[i] * back[i];
        }
        assert_near(fabs(product), 1, 2e-15);
        assert_true(euler[0] > -test_pi && euler[0] <= test_pi);
        assert_true(euler[1] >= 0 && euler[1] <= test_pi);
        assert_true(euler[2] > -test_pi && euler[2] <= test_pi);
        if (n < count)
        {
            assert_true(euler[2] == 0);
        }
    }
}

static void check_axis(const double axis[3], double spin)
{
    const double none[3] = {0, spin, 0};
    double q[4], still[4], r[3][3], r0[3][3], length;

    ellipsoid_quaternion_from_axis(axis, spin, q);
    ellipsoid_quaternion_from_axis(axis, 0, still);
    ellipsoid_rotation(q, r);
    ellipsoid_rotation(still, r0);
    length = sqrt(ellipsoid_dot(q, q) + q[3] * q[3]);
    assert_near(length, 1, 1e-15);
    for (int i = 0; i < 3; i++)
    {
        assert_near(r[i][1], axis[i], 2e-15);
        /* the spin turns x^3 towards x^1 about x^2 */
        assert_near(r[i][2], r0[i][2] * cos(none[1]) + r0[i][0] * sin(none[1]),
                    4e-15);
    }
}

static void test_from_axis(void **unused)
{
    uint64_t seed = 8;

    (void)unused;
    for (int n = 0; n < 100; n++)
    {
        double q[4], r[3][3];

        test_orientation(&seed, q);
        ellipsoid_rotation(q, r);
        check_axis(r[0], 10 * test_signed(&seed));
    }
    check_axis((const double[3]){0, 1, 0}, 0.3);
    check_axis((const double[3]){0, -1, 0}, 0.3);
    for (double d = 1; d > 1e-20; d /= 10)
    {
        const double c = sqrt((1 - d) * (1 + d));

        check_axis((const double[3]){d * 0.6, -c, d * 0.8}, 0);
        check_axis((const double[3]){-d * 0.8, c, d * 0.6}, 1);
    }
}

/*
    Shoemake (1992): uniform on the rotations, so <R_ij> = 0 and
    <R_ij R_kl> = delta_ik delta_jl / 3. A grid of midpoints integrates both
    exactly but for the midpoint rule in the first number: 1/(24 n^2).
*/
static void test_uniform_moments(void **unused)
{
    const int n = 24;
    double mean[3][3] = {{0}}, square[3][3] = {{0}};

    (void)unused;
    for (int a = 0; a < n * n * n; a++)
    {
        const double uniform[3] = {(a % n + 0.5) / n, (a / n % n + 0.5) / n,
                                   (a / n / n + 0.5) / n};
        double q[4], r[3][3];

        ellipsoid_quaternion_from_uniform(uniform, q);
        assert_near(ellipsoid_dot(q, q) + q[3] * q[3], 1, 1e-15);
        ellipsoid_rotation(q, r);
        for (int i = 0; i < 3; i++)
        {
            for (int j = 0; j < 3; j++)
            {
                mean[i][j] += r[i][j] / (n * n * n);
                square[i][j] += r[i][j] * r[i][j] / (n * n * n);
            }
        }
    }
    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            assert_near(mean[i][j], 0, 1e-13);
            assert_near(square[i][j], 1.0 / 3, 1.0 / (n * n));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_definition),
        cmocka_unit_test(test_orthogonal),
        cmocka_unit_test(test_spin),
        cmocka_unit_test(test_euler_is_z_x_z),
        cmocka_unit_test(test_euler_round_trip),
        cmocka_unit_test(test_from_axis),
        cmocka_unit_test(test_uniform_moments),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
