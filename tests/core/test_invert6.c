/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_invert6.c - the inverse of a matrix with one stiff direction.
*/
#include "body/body.h"
#include "coreTest.h"

/*
    One direction v held by what is s times stiffer than the drag, as by a
    damped contact: (I + s v v^T)^-1 = I - s v v^T/(1 + s v.v) (Sherman &
    Morrison 1950). Up to an s of 300 cofactors leave 1e-16 s^2, of which a
    hundred times are seen; elimination 1e-16 s. Cofactors alone would leave all
    of it at 1e6. Rows are moved down by `shift`, and so are columns of the
    inverse.
*/
static void check(double stiff, const double v[6], int shift)
{
    double m[6][6], square = 0;

    for (int i = 0; i < 6; i++)
    {
        square += v[i] * v[i];
        for (int j = 0; j < 6; j++)
        {
            m[(i + shift) % 6][j] = (i == j) + stiff * v[i] * v[j];
        }
    }
    assert_true(ellipsoid_invert6(m));
    for (int i = 0; i < 36; i++)
    {
        const int row = i / 6, column = i % 6;
        const double held = stiff * v[row] * v[column] / (1 + stiff * square);

        assert_near(m[row][(column + shift) % 6], (row == column) - held,
                    5e-9 + 1e-15 * stiff);
    }
}

/* Of translation and rotation; of translation alone, which leaves the last
   block well conditioned. */
static void test_stiff_direction(void **unused)
{
    uint64_t seed = 23;

    (void)unused;
    for (int n = 0; n < 2700; n++)
    {
        double v[6];

        for (int i = 0; i < 6; i++)
        {
            v[i] = test_signed(&seed);
            v[i] = n % 2 && i > 2 ? 0 : v[i];
        }
        check(pow(10, 1 + n % 9), v, 0);
    }
}

/* What does not hold the first direction leaves a zero on the diagonal where
   rows are moved. */
static void test_zero_on_the_diagonal(void **unused)
{
    uint64_t seed = 29;

    (void)unused;
    for (int n = 0; n < 500; n++)
    {
        double v[6] = {0};

        for (int i = 1; i < 6; i++)
        {
            v[i] = 0.5 + test_uniform(&seed);
        }
        check(1e7, v, 1 + n % 5);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stiff_direction),
        cmocka_unit_test(test_zero_on_the_diagonal),
    };

    return cmocka_run_group_tests_name("invert6", tests, NULL, NULL);
}
