/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_brownianPath.c - the numbers behind Brownian motion, and that a path is
    a function of them alone: not of calls, steps, restarts or other cells.
*/
#include "brownianTest.h"

#include <float.h>

/* ----------------------------------------------------- random numbers */

static double normal_distribution(const void *context, double value)
{
    (void)context;
    return 0.5 * erfc(-value / sqrt(2));
}

/*
    The six numbers over 1e5 cells or intervals: of n standard normal numbers
    the mean, variance, third and fourth moment have deviations of sqrt(1, 2,
    15, 96 by n); each within 5. Their distribution by Kolmogorov & Smirnov at a
    significance of 1e-4: c = sqrt(ln(2e4)/2) = 2.225.
*/
static void check_moments(int over_cells)
{
    enum
    {
        N = 100000
    };
    static double value[6 * N];
    static const double expected[4] = {0, 1, 0, 3};
    static const double variance[4] = {1, 2, 15, 96};
    double distance;

    for (int n = 0; n < N; n++)
    {
        ellipsoid_random_normal(11, over_cells ? (uint32_t)n : 5,
                                over_cells ? 5 : n, value + 6 * (ptrdiff_t)n);
    }
    for (int i = 0; i < 6; i++)
    {
        for (int power = 1; power <= 4; power++)
        {
            double sum = 0;

            for (int n = 0; n < N; n++)
            {
                sum += pow(value[6 * n + i], power);
            }
            assert_near(sum / N, expected[power - 1],
                        5 * sqrt(variance[power - 1] / N));
        }
    }
    distance = test_kolmogorov(value, 6 * N, normal_distribution, NULL);
    print_message("# over %s: sqrt(n) D = %.3f, 2.225 allowed\n",
                  over_cells ? "cells" : "intervals", distance);
    assert_true(distance < 2.225);
}

static void test_normal(void **unused)
{
    (void)unused;
    check_moments(1);
    check_moments(0);
}

/*
    Each of the six against each of the six of the same interval, of the next
    interval, the next cell and the next seed; their squares, too, as Box &
    Muller would be wrong there first. The mean of n products of independent
    standard normal numbers has the deviation 1/sqrt(n), that of (a^2 - 1)(b^2 -
    1) 2/sqrt(n). 246 numbers within 5 deviations: by chance one fails with
    2e-4.
*/
static void test_uncorrelated(void **unused)
{
    enum
    {
        N = 100000
    };
    double sum[4][6][6] = {{{0}}}, square[4][6][6] = {{{0}}}, worst = 0;

    (void)unused;
    for (int n = 0; n < N; n++)
    {
        const uint32_t id = (uint32_t)n / 100;
        double a[6], b[4][6];

        ellipsoid_random_normal(12, id, n, a);
        memcpy(b[0], a, sizeof(a));
        ellipsoid_random_normal(12, id, n + 1, b[1]);
        ellipsoid_random_normal(12, id + 1, n, b[2]);
        ellipsoid_random_normal(13, id, n, b[3]);
        for (int k = 0; k < 4; k++)
        {
            for (int i = 0; i < 6; i++)
            {
                for (int j = k ? 0 : i + 1; j < 6; j++)
                {
                    sum[k][i][j] += a[i] * b[k][j];
                    square[k][i][j] +=
                        (a[i] * a[i] - 1) * (b[k][j] * b[k][j] - 1) / 2;
                }
            }
        }
    }
    for (int k = 0; k < 4; k++)
    {
        for (int i = 0; i < 6; i++)
        {
            for (int j = 0; j < 6; j++)
            {
                worst = fmax(worst, fabs(sum[k][i][j]) / sqrt(N));
                worst = fmax(worst, fabs(square[k][i][j]) / sqrt(N));
            }
        }
    }
    print_message("# largest of 246 correlations: %.1f deviations\n", worst);
    assert_true(worst < 5);
}

/* The same in any order, and each part of the key counts, the upper halves of
   seed and interval and an interval before 0 too. */
static void test_function_of_key(void **unused)
{
    static const int64_t interval[] = {0,         1,         -1,
                                       1LL << 31, 1LL << 32, 1LL << 40};
    static const uint64_t seed[] = {0, 1, 1ULL << 32, 1ULL << 63};
    static const uint32_t id[] = {0, 1, 1U << 31};
    double forth[72][6], back[72][6];

    (void)unused;
    for (int n = 0; n < 72; n++)
    {
        const int m = 71 - n;

        ellipsoid_random_normal(seed[n / 18], id[n / 6 % 3], interval[n % 6],
                                forth[n]);
        ellipsoid_random_normal(seed[m / 18], id[m / 6 % 3], interval[m % 6],
                                back[m]);
    }
    assert_memory_equal(forth, back, sizeof(forth));
    for (int n = 0; n < 72; n++)
    {
        for (int m = 0; m < n; m++)
        {
            assert_true(forth[n][0] != forth[m][0]);
        }
    }
}

/* --------------------------------------------------------------- paths */

static const double interval = 1e-3; /* [s] */

enum
{
    INTERVALS = 200
};

static int shear_flow(void *context, double t, const double x[3],
                      int derivatives, ellipsoid_flow_sample *sample)
{
    test_quadratic shear = test_shear(10);

    (void)context;
    return test_quadratic_flow(&shear, t, x, derivatives, sample);
}

static test_walk in_shear(ellipsoid_motion motion, double tolerance,
                          uint32_t id)
{
    ellipsoid_options o = test_brownian(motion, interval);
    test_walk w;

    o.tolerance = tolerance;
    w = test_walk_of(&o, 21, id);
    w.around.flow = shear_flow;
    return w;
}

static void assert_same(const test_walk *a, const test_walk *b)
{
    assert_memory_equal(&a->state, &b->state, sizeof(a->state));
    assert_memory_equal(&a->controller, &b->controller, sizeof(a->controller));
    assert_true(a->t == b->t);
}

/* Distance of two poses in units of the largest semi-axis and in q. */
static double distance(const test_walk *a, const test_walk *b)
{
    double way[3], worst;

    ellipsoid_difference(a->state.x, b->state.x, way);
    worst = ellipsoid_length(way) / 2e-6;
    for (int n = 0; n < 4; n++)
    {
        worst = fmax(worst, fabs(a->state.q[n] - b->state.q[n]));
    }
    return worst;
}

/*
    In one call, or in calls that end where intervals do, singly and in bunches;
    and continued from what a restart has (state, controller, time) with all
    else anew: the same bits, as the steps are the same.
*/
static void check_cut(ellipsoid_motion motion)
{
    test_walk whole = in_shear(motion, 1e-6, 1), cut = whole, restart;

    assert_ok(test_walk_to(&whole, INTERVALS * interval));
    for (int n = 1; n <= INTERVALS; n += n < 100 ? 1 : 33)
    {
        assert_ok(test_walk_to(&cut, n * interval));
        if (n == 77)
        {
            restart = in_shear(motion, 1e-6, 1);
            restart.state = cut.state;
            restart.controller = cut.controller;
            restart.t = cut.t;
        }
    }
    assert_ok(test_walk_to(&cut, INTERVALS * interval));
    assert_ok(test_walk_to(&restart, INTERVALS * interval));
    assert_same(&whole, &cut);
    assert_same(&whole, &restart);
}

/*
    Calls that end anywhere, even within the layer after a jump, which is then
    followed instead of crossed: the same noise, so the paths differ by the
    local errors, at most the tolerance for each step, and by what the crossing
    leaves out: of tau v/a = 5e-7 what the body turns in the time tau, 4e-4.
*/
static void check_cut_anywhere(ellipsoid_motion motion)
{
    const double tolerance = 1e-11;
    test_walk whole = in_shear(motion, tolerance, 2), cut = whole;
    uint64_t seed = 5;
    double away, allowed;

    assert_ok(test_walk_to(&whole, INTERVALS * interval));
    for (int n = 0; n < INTERVALS; n++)
    {
        /* 1e-8 to 1e-3 s after the start of an interval */
        const double part = pow(10, -5 * test_uniform(&seed));

        assert_ok(test_walk_to(&cut, (n + part) * interval));
    }
    assert_ok(test_walk_to(&cut, INTERVALS * interval));
    away = distance(&whole, &cut);
    allowed =
        INTERVALS * 5e-7 * 4e-4
        + tolerance
              * (double)(whole.statistics.accepted + cut.statistics.accepted);
    print_message("# cut anywhere: %.1e, %.1e allowed\n", away, allowed);
    assert_true(away > 0); /* it has been cut */
    assert_true(away <= allowed);
}

/* A step's error is at most the tolerance, and errors add up at most. */
static void check_tolerance(ellipsoid_motion motion)
{
    test_walk tight = in_shear(motion, 1e-10, 3);

    assert_ok(test_walk_to(&tight, INTERVALS * interval));
    for (double tolerance = 1e-8; tolerance < 1e-1; tolerance *= 100)
    {
        test_walk loose = in_shear(motion, tolerance, 3);

        assert_ok(test_walk_to(&loose, INTERVALS * interval));
        print_message("# tolerance %.0e: %ld + %ld steps, %.1e away\n",
                      tolerance, loose.statistics.accepted,
                      loose.statistics.rejected, distance(&loose, &tight));
        assert_true(distance(&loose, &tight)
                    <= (double)loose.statistics.accepted * tolerance);
    }
}

/* Three cells in turn: each as if alone, and no two alike. */
static void check_others(ellipsoid_motion motion)
{
    test_walk cell[3];

    for (int i = 0; i < 3; i++)
    {
        cell[i] = in_shear(motion, 1e-6, (uint32_t)i);
    }
    for (int n = 1; n <= INTERVALS; n++)
    {
        for (int i = 0; i < 3; i++)
        {
            assert_ok(test_walk_to(&cell[i], n * interval));
        }
    }
    for (int i = 0; i < 3; i++)
    {
        test_walk alone = in_shear(motion, 1e-6, (uint32_t)i);

        assert_ok(test_walk_to(&alone, INTERVALS * interval));
        assert_same(&alone, &cell[i]);
        assert_true(distance(&cell[i], &cell[(i + 1) % 3]) > 1e-2);
    }
}

static void test_path(void **unused)
{
    static const ellipsoid_motion motions[2] = {ELLIPSOID_MOTION_INERTIAL,
                                                ELLIPSOID_MOTION_INERTIALESS};

    (void)unused;
    for (int k = 0; k < 2; k++)
    {
        check_cut(motions[k]);
        check_cut_anywhere(motions[k]);
        check_tolerance(motions[k]);
        check_others(motions[k]);
    }
}

/*
    Ends that come near the end of an interval but for rounding, as decimal
    numbers do (0.3 is not 3 x 0.1): no interval is taken twice or left out. The
    paths differ by rounding, 1e-16 for each interval in x, times what the turn
    makes of it.
*/
static void test_rounded_ends(void **unused)
{
    test_walk whole = in_shear(ELLIPSOID_MOTION_INERTIALESS, 1e-10, 4),
              cut = whole;
    double end = 0, away;

    (void)unused;
    assert_ok(test_walk_to(&whole, INTERVALS * interval));
    for (int n = 1; n <= INTERVALS; n++)
    {
        end += interval;
        assert_ok(test_walk_to(&cut, end));
    }
    away = distance(&whole, &cut);
    print_message("# ends summed up: %.1e away\n", away);
    assert_true(end != INTERVALS * interval);
    assert_true(away <= INTERVALS * 1e-14);
}

/* --------------------------------------------------------------- steps */

/*
    Nothing fast is to be followed where an interval is many relaxation times
    long: one step for each (and some for the first), and more only where the
    body turns by a tenth (0.01 s) or a quarter (0.05 s), with few rejected: two
    or four of the fourth order, one or two of the fifth without inertia.
*/
static void test_steps(void **unused)
{
    static const struct
    {
        double interval;
        double most[2]; /* inertial, inertialess */
    } cases[] = {
        {1e-5, {1, 1}}, {1e-3, {1, 1}}, {1e-2, {2.5, 1}}, {5e-2, {4.5, 2}}};

    (void)unused;
    for (int k = 0; k < 8; k++)
    {
        const int inertialess = k % 2;
        const ellipsoid_options o =
            test_brownian(inertialess ? ELLIPSOID_MOTION_INERTIALESS
                                      : ELLIPSOID_MOTION_INERTIAL,
                          cases[k / 2].interval);
        test_walk w = test_walk_of(&o, 22, 1);
        const long count = 2000;
        long tried;

        for (long n = 0; n < count; n++)
        {
            test_walk_on(&w);
        }
        tried = w.statistics.accepted + w.statistics.rejected;
        print_message("# %s, dt = %.0e s: %.3f + %.3f steps an interval\n",
                      test_motion_name(o.motion), o.noise_interval,
                      (double)w.statistics.accepted / count,
                      (double)w.statistics.rejected / count);
        assert_true(tried <= cases[k / 2].most[inertialess] * count + 30);
    }
}

static int flow_of_numbers(void *context, double t, const double x[3],
                           int derivatives, ellipsoid_flow_sample *sample)
{
    assert_true(isfinite(x[0] + x[1] + x[2]));
    return test_still_flow(context, t, x, derivatives, sample);
}

/* So fast that until its velocity has decayed it would drift or turn beyond all
   numbers: the flow is not asked there, and the cell is as it was. */
static void test_beyond_numbers(void **unused)
{
    (void)unused;
    for (int k = 0; k < 2; k++)
    {
        const ellipsoid_options o =
            test_brownian(ELLIPSOID_MOTION_INERTIAL, interval);
        test_walk w = test_walk_of(&o, 21, 1), before;

        w.around.flow = flow_of_numbers;
        w.state.x[0] = k == 0 ? DBL_MAX : 0;
        w.state.u[0] = k == 0 ? 1e308 : 0;
        w.state.u[1] = -w.state.u[0];
        w.state.omega[1] = k == 0 ? 0 : 1e200;
        before = w;
        assert_int_equal(test_walk_to(&w, interval), ELLIPSOID_BAD_STATE);
        assert_same(&w, &before);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_normal),
        cmocka_unit_test(test_uncorrelated),
        cmocka_unit_test(test_function_of_key),
        cmocka_unit_test(test_path),
        cmocka_unit_test(test_rounded_ends),
        cmocka_unit_test(test_steps),
        cmocka_unit_test(test_beyond_numbers),
    };

    return cmocka_run_group_tests_name("brownianPath", tests, NULL, NULL);
}
