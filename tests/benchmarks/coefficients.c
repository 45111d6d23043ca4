/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    coefficients.c - sets of Rosenbrock coefficients side by side (README.md).

    Each set is in a copy of the core of its own, whose ellipsoid_advance() and
    table have other names (Makefile).
*/
#include "motion/motion.h"
#include "trials.h"

#include <stdio.h>
#include <stdlib.h>

#define SETS(X) X(rodas4) X(rodas42) X(rodasp) X(rodas4p2)

#define DECLARE(name)                                                          \
    extern const ellipsoid_rosenbrock_table name##_table;                      \
    ellipsoid_status name##_advance(const ellipsoid_member *, double *,        \
                                    double, ellipsoid_observer);
SETS(DECLARE)

#define ENTRY(name)                                                            \
    {#name,                                                                    \
     &name##_table,                                                            \
     {.motion = ELLIPSOID_MOTION_INERTIAL, .advance = name##_advance}},
static struct
{
    const char *name;
    const ellipsoid_rosenbrock_table *table;
    benchmark_core core;
} set[] = {SETS(ENTRY)};

enum
{
    COUNT = sizeof(set) / sizeof(set[0]),
    S = ELLIPSOID_STAGES,
    TREES = 8
};

/* ------------------------------------------------------ order conditions */

/*
    From zero, y_t' = product of the y of the branches of the rooted tree t
    gives y_t = 1/gamma(t) at time 1, and one step of length 1 gives that but
    for what is missing in the order condition of t (Hairer & Wanner II, tables
    IV.7.1): all trees up to order 4.
*/
static const int order[TREES] = {1, 2, 3, 3, 4, 4, 4, 4};
static const double exact[TREES] = {1,       1.0 / 2, 1.0 / 3,  1.0 / 6,
                                    1.0 / 4, 1.0 / 8, 1.0 / 12, 1.0 / 24};

static void grow(const double y[TREES], double rate[TREES])
{
    rate[0] = 1;
    rate[1] = y[0];
    rate[2] = y[0] * y[0];
    rate[3] = y[1];
    rate[4] = y[0] * y[0] * y[0];
    rate[5] = y[0] * y[1];
    rate[6] = y[2];
    rate[7] = y[3];
}

/* The Jacobian at zero has ones at these places. */
static const int jacobian[][2] = {{1, 0}, {3, 1}, {6, 2}, {7, 3}};

/* K_i of one step, (IV.7.25) with h = 1. */
static void step(const ellipsoid_rosenbrock_table *m, double k[S][TREES])
{
    for (int i = 0; i < S; i++)
    {
        double y[TREES] = {0}, right[TREES];

        for (int j = 0; j < i; j++)
        {
            for (int n = 0; n < TREES; n++)
            {
                y[n] += m->a[i][j] * k[j][n];
            }
        }
        grow(y, right);
        for (int j = 0; j < i; j++)
        {
            for (int n = 0; n < TREES; n++)
            {
                right[n] += m->c[i][j] * k[j][n];
            }
        }
        for (int n = 0; n < TREES; n++)
        {
            for (size_t l = 0; l < sizeof(jacobian) / sizeof(jacobian[0]); l++)
            {
                if (jacobian[l][0] == n)
                {
                    right[n] += k[i][jacobian[l][1]];
                }
            }
            k[i][n] = m->gamma * right[n];
        }
    }
}

/* Largest residual of the weights a_6j + last K_6, for trees up to `to`; with
   the continuous extension at s. */
static double residual(const ellipsoid_rosenbrock_table *m, double k[S][TREES],
                       double last, double s, int to)
{
    double worst = 0;

    for (int n = 0; n < TREES && order[n] <= to; n++)
    {
        double y = last * k[S - 1][n], dense = 0;

        for (int j = 0; j < S - 1; j++)
        {
            y += m->a[S - 1][j] * k[j][n];
            dense += (m->dense[0][j] + s * m->dense[1][j]) * k[j][n];
        }
        y = s * (y + (1 - s) * dense);
        worst = fmax(worst, fabs(y - exact[n] * pow(s, order[n])));
    }
    return worst;
}

/* R(z) of y' = z y for real z. */
static double stability(const ellipsoid_rosenbrock_table *m, double z)
{
    double k[S], y = 1;

    for (int i = 0; i < S; i++)
    {
        double at = 1, sum = 0;

        for (int j = 0; j < i; j++)
        {
            at += m->a[i][j] * k[j];
            sum += m->c[i][j] * k[j];
        }
        k[i] = (z * at + sum) / (1 / m->gamma - z);
        y = at + k[i];
    }
    return y;
}

static void check(int n)
{
    const ellipsoid_rosenbrock_table *m = set[n].table;
    double k[S][TREES];

    step(m, k);

    const double fourth = residual(m, k, 1, 1, 4);
    const double embedded = residual(m, k, 0, 1, 3);
    const double dense = residual(m, k, 1, 0.375, 3);
    const double damping = fabs(stability(m, -1e8));

    printf("  %-12s %12.1e %12.1e %12.1e %12.1e\n", set[n].name, fourth,
           embedded, dense, damping);
    if (!(fourth < 1e-12 && embedded < 1e-12 && dense < 1e-12
          && damping < 1e-6))
    {
        fprintf(stderr, "the coefficients of %s are not right\n", set[n].name);
        exit(1);
    }
}

/* ------------------------------------------------------------ comparison */

static void compare_on(int which, int repeats)
{
    static benchmark_journey journey;
    static benchmark_series series[COUNT];
    static ellipsoid_state reference[BENCHMARK_TRAJECTORIES];
    benchmark_core core = {.motion = ELLIPSOID_MOTION_INERTIAL,
                           .advance = ellipsoid_advance};
    const benchmark_method ours = benchmark_core_method("the core", &core);

    benchmark_journey_init(&journey, which);
    benchmark_reference(&ours, &journey, 1e-12, reference);
    for (int n = 0; n < COUNT; n++)
    {
        series[n] = (benchmark_series){
            .method = benchmark_core_method(set[n].name, &set[n].core),
            .reference = reference,
            .first = 1e-1,
            .last = 1e-9};
    }
    benchmark_measure(&journey, series, COUNT, repeats);

    printf("\n%s\n", journey.name);
    benchmark_print_heading();
    for (int n = 0; n < COUNT; n++)
    {
        benchmark_print(&series[n]);
    }
    printf("\n  At equal error: steps and us\n  %-10s", "error q");
    for (int n = 0; n < COUNT; n++)
    {
        printf(" %18s", set[n].name);
    }
    for (double q = 1e-4; q > 0.9e-8; q /= 10)
    {
        printf("\n  %-10.0e", q);
        for (int n = 0; n < COUNT; n++)
        {
            printf(" %9.1f %8.1f", benchmark_steps_at(&series[n], q),
                   1e6 * benchmark_time_at(&series[n], q));
        }
    }
    printf("\n");
}

int main(int argc, char **argv)
{
    const int repeats = benchmark_repeats(argc, argv);

    printf("Sets of coefficients: largest residual of the order conditions,\n"
           "and |R(-1e8)|\n  %-12s %12s %12s %12s %12s\n",
           "", "order 4", "embedded, 3", "dense, 3", "damping");
    for (int n = 0; n < COUNT; n++)
    {
        check(n);
    }
    for (int which = 0; which < BENCHMARK_JOURNEYS; which++)
    {
        compare_on(which, repeats);
    }
    return 0;
}
