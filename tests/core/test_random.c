/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_random.c - random numbers that depend on their key alone.
*/
#include "coreTest.h"

/* Philox4x32-10 of counter 0 and key 0: Random123's file of known answers. */
static void test_known_answer(void **unused)
{
    const uint64_t words[2] = {0x6627e8d5e169c58du, 0xbc57ac4c9b00dbd8u};
    double uniform[2];

    (void)unused;
    ellipsoid_random_uniform(0, 0, 0, 0, 2, uniform);
    for (int i = 0; i < 2; i++)
    {
        assert_true(uniform[i] == ldexp((double)(words[i] >> 11), -53));
    }
}

/* Any part of a longer draw is what a shorter one gives, and each part of the key
   counts, the upper half of the seed too. */
static void test_depends_on_key_alone(void **unused)
{
    const uint64_t seed = 0x123456789abcdefu;
    double five[5], three[3], other[1];

    (void)unused;
    ellipsoid_random_uniform(seed, 7, 1, 2, 5, five);
    ellipsoid_random_uniform(seed, 7, 1, 2, 3, three);
    assert_memory_equal(five, three, sizeof three);
    for (int i = 0; i < 5; i++)
    {
        for (int j = 0; j < i; j++)
        {
            assert_true(five[i] != five[j]);
        }
    }

    ellipsoid_random_uniform(seed ^ ((uint64_t)1 << 40), 7, 1, 2, 1, other);
    assert_true(other[0] != five[0]);
    ellipsoid_random_uniform(seed, 8, 1, 2, 1, other);
    assert_true(other[0] != five[0]);
    ellipsoid_random_uniform(seed, 7, 2, 2, 1, other);
    assert_true(other[0] != five[0]);
    ellipsoid_random_uniform(seed, 7, 1, 3, 1, other);
    assert_true(other[0] != five[0]);
}

/*
    Mean, variance and neighbours' correlation over 1e5 cells of one fixed seed, each
    within 5 standard errors: 1/sqrt(12 N), 1/sqrt(180 N), 1/(12 sqrt(N)).
*/
static void test_uniform_over_cells(void **unused)
{
    enum
    {
        N = 100000
    };
    static const test_row row = {
        "Brownian motion",
        "moments of the uniform numbers, in standard errors",
        "mean, variance, neighbours' product; 1e5 cells",
        "uniform distribution",
        "A",
        "5 sigma of a fixed seed",
        0};
    double sum = 0, squares = 0, products = 0, last = 0.5;

    (void)unused;
    for (uint32_t id = 0; id < N; id++)
    {
        double u;

        ellipsoid_random_uniform(1, id, 0, 0, 1, &u);
        assert_true(u >= 0 && u < 1);
        sum += u - 0.5;
        squares += (u - 0.5) * (u - 0.5) - 1.0 / 12;
        products += (u - 0.5) * (last - 0.5);
        last = u;
    }
    assert_row(&row, sum / sqrt(N / 12.0), 0, 5);
    assert_row(&row, squares / sqrt(N / 180.0), 0, 5);
    assert_row(&row, products * 12 / sqrt((double)N), 0, 5);
}

/*
    Of the normal distribution: mean, variance, fourth moment and the product of
    a pair over 1e5 cells of one fixed seed, each within 5 standard errors:
    1/sqrt(N), sqrt(2/N), sqrt(96/N), 1/sqrt(N) (Kendall & Stuart, The Advanced
    Theory of Statistics, vol. 1: E z^8 = 105). A shorter draw is part of a
    longer one, and those of a noise interval are those of its key.
*/
static void test_normal_over_cells(void **unused)
{
    enum
    {
        N = 100000
    };
    static const test_row row = {
        "Brownian motion",
        "moments of the normal numbers, in standard errors",
        "mean, square, fourth, product of a pair; 1e5 numbers",
        "Kendall & Stuart, vol. 1",
        "A",
        "5 sigma of a fixed seed",
        0};
    double sum = 0, squares = 0, fourths = 0, products = 0;
    double six[6], five[5], interval[6];

    (void)unused;
    for (uint32_t id = 0; id < N / 2; id++)
    {
        double z[2];

        ellipsoid_random_normals(1, id, 2, 0, 2, z);
        for (int i = 0; i < 2; i++)
        {
            sum += z[i];
            squares += z[i] * z[i] - 1;
            fourths += pow(z[i], 4) - 3;
        }
        products += z[0] * z[1];
    }
    assert_row(&row, sum / sqrt((double)N), 0, 5);
    assert_row(&row, squares / sqrt(2.0 * N), 0, 5);
    assert_row(&row, fourths / sqrt(96.0 * N), 0, 5);
    assert_row(&row, products / sqrt(N / 2.0), 0, 5);

    ellipsoid_random_normals(3, 7, 0x80000000u, 9, 6, six);
    ellipsoid_random_normals(3, 7, 0x80000000u, 9, 5, five);
    ellipsoid_random_normal(3, 7, 9, interval);
    assert_memory_equal(six, five, sizeof five);
    assert_memory_equal(six, interval, sizeof interval);
    ellipsoid_random_normals(3, 7, 2, 9, 5, five);
    assert_true(five[0] != six[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_known_answer),
        cmocka_unit_test(test_depends_on_key_alone),
        cmocka_unit_test(test_uniform_over_cells),
        cmocka_unit_test(test_normal_over_cells),
    };

    return cmocka_run_group_tests_name("random", tests, NULL, NULL);
}
