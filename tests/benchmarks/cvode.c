/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    cvode.c - the core beside CVODE at equal error (README.md).
*/
#include "peer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Median errors of q at which times are compared. */
static const double targets[] = {8e-5, 1.7e-6, 1e-7};

enum
{
    TARGETS = sizeof(targets) / sizeof(targets[0]),
    SETUPS = 2 * BENCHMARK_WEIGHTS
};

static const char *const setup_name[SETUPS] = {
    "CVODE, by effect, differences", "CVODE, by effect, exact J",
    "CVODE, by flow, differences",   "CVODE, by flow, exact J",
    "CVODE, relative, differences",  "CVODE, relative, exact J"};

/* What one evaluation of the thirteen derivatives costs [s]. */
static double rhs_seconds(const benchmark_journey *journey)
{
    const ellipsoid_model model =
        benchmark_model(journey, ELLIPSOID_MOTION_INERTIAL, 1e-6);
    const long rounds = 20000;
    double sum = 0, start = benchmark_clock();

    for (long round = 0; round < rounds; round++)
    {
        for (int n = 0; n < BENCHMARK_TRAJECTORIES; n++)
        {
            ellipsoid_state rate;

            ellipsoid_rhs(&model, &journey->around, &journey->start[n], NULL,
                          &rate);
            sum += rate.q[0];
        }
    }
    start =
        (benchmark_clock() - start) / ((double)rounds * BENCHMARK_TRAJECTORIES);
    return isfinite(sum) ? start : NAN;
}

/* References by the core and by CVODE at 1e-12, and how far they agree. */
static void set_reference(const benchmark_journey *journey,
                          ellipsoid_motion motion,
                          ellipsoid_state reference[BENCHMARK_TRAJECTORIES])
{
    static ellipsoid_state other[BENCHMARK_TRAJECTORIES];
    benchmark_core core = {.motion = motion, .advance = ellipsoid_advance};
    benchmark_peer peer = {
        .motion = motion, .weights = BENCHMARK_BY_FLOW, .exact_jacobian = 1};
    const benchmark_method ours = benchmark_core_method("the core", &core);
    const benchmark_method theirs = benchmark_peer_method("CVODE", &peer);
    double x, q;

    benchmark_reference(&ours, journey, 1e-12, reference);
    benchmark_reference(&theirs, journey, 1e-12, other);
    benchmark_peer_free(&peer);
    benchmark_distance(journey, reference, other, &x, &q);
    printf("  %s: core and CVODE at tolerance 1e-12 agree to %.1e in q, "
           "%.1e in x\n",
           motion == ELLIPSOID_MOTION_INERTIAL ? "thirteen equations"
                                               : "inertialess motion",
           q, x);
}

/*
    All ways to set CVODE up, once; returns the one with the least product of
    the times at the targets.
*/
static int best_setup(const benchmark_journey *journey,
                      const ellipsoid_state *reference)
{
    static benchmark_series series[SETUPS];
    benchmark_peer peer[SETUPS];
    double least = HUGE_VAL;
    int best = -1;

    for (int n = 0; n < SETUPS; n++)
    {
        peer[n] = (benchmark_peer){.motion = ELLIPSOID_MOTION_INERTIAL,
                                   .weights = (benchmark_weights)(n / 2),
                                   .exact_jacobian = n % 2};
        series[n] = (benchmark_series){
            .method = benchmark_peer_method(setup_name[n], &peer[n]),
            .reference = reference,
            .first = 1e-3,
            .last = 1e-11};
    }
    benchmark_measure(journey, series, SETUPS, 1);
    printf("\n  Ways to set CVODE up, us at an error of q of");
    for (int t = 0; t < TARGETS; t++)
    {
        printf(" %9.1e", targets[t]);
    }
    printf("\n");
    for (int n = 0; n < SETUPS; n++)
    {
        double product = 1;

        printf("  %-44s", setup_name[n]);
        for (int t = 0; t < TARGETS; t++)
        {
            const double seconds = benchmark_time_at(&series[n], targets[t]);

            product *= seconds;
            printf(" %9.1f", 1e6 * seconds);
        }
        printf("\n");
        if (product < least)
        {
            least = product;
            best = n;
        }
        benchmark_peer_free(&peer[n]);
    }
    if (best < 0)
    {
        fprintf(stderr, "CVODE did not reach the errors asked for\n");
        exit(1);
    }
    return best;
}

enum
{
    CORE_THIRTEEN,
    PEER_THIRTEEN,
    CORE_SEVEN,
    PEER_SEVEN,
    METHODS
};

/* model_error: of q, what inertialess motion neglects at the end. */
static void print_ratios(const benchmark_series series[METHODS],
                         double model_error)
{
    printf("\n  At equal error %9s %9s %11s %7s %9s %11s %7s %13s\n", "error q",
           "CVODE us", "thirteen us", "ratio", "Adams us", "inertialess",
           "ratio", "model error q");
    for (int t = 0; t < TARGETS; t++)
    {
        double us[METHODS];

        for (int m = 0; m < METHODS; m++)
        {
            us[m] = 1e6 * benchmark_time_at(&series[m], targets[t]);
        }
        printf("  %14s %9.1e %9.1f %11.1f %7.1f %9.1f %11.1f %7.1f %13.1e\n",
               "", targets[t], us[PEER_THIRTEEN], us[CORE_THIRTEEN],
               us[PEER_THIRTEEN] / us[CORE_THIRTEEN], us[PEER_SEVEN],
               us[CORE_SEVEN], us[PEER_SEVEN] / us[CORE_SEVEN], model_error);
    }
}

static void compare_on(int which, int repeats)
{
    static benchmark_journey journey;
    static ellipsoid_state inertial[BENCHMARK_TRAJECTORIES];
    static ellipsoid_state inertialess[BENCHMARK_TRAJECTORIES];
    static benchmark_series series[METHODS];
    benchmark_core thirteen = {.motion = ELLIPSOID_MOTION_INERTIAL,
                               .advance = ellipsoid_advance};
    benchmark_core seven = {.motion = ELLIPSOID_MOTION_INERTIALESS,
                            .advance = ellipsoid_advance};
    benchmark_peer bdf = {.motion = ELLIPSOID_MOTION_INERTIAL};
    benchmark_peer adams = {.motion = ELLIPSOID_MOTION_INERTIALESS};
    double x, q;
    int best;

    benchmark_journey_init(&journey, which);
    printf("\n%s\n  one right-hand side: %.1f ns\n", journey.name,
           1e9 * rhs_seconds(&journey));
    set_reference(&journey, ELLIPSOID_MOTION_INERTIAL, inertial);
    set_reference(&journey, ELLIPSOID_MOTION_INERTIALESS, inertialess);
    benchmark_distance(&journey, inertial, inertialess, &x, &q);
    printf("  without inertia the ends differ by %.1e in q, %.1e in x\n", q, x);

    best = best_setup(&journey, inertial);
    bdf.weights = (benchmark_weights)(best / 2);
    bdf.exact_jacobian = best % 2;

    series[CORE_THIRTEEN] = (benchmark_series){
        .method = benchmark_core_method("core, thirteen equations", &thirteen),
        .reference = inertial};
    series[PEER_THIRTEEN] = (benchmark_series){
        .method = benchmark_peer_method(setup_name[best], &bdf),
        .reference = inertial};
    series[CORE_SEVEN] = (benchmark_series){
        .method = benchmark_core_method("core, inertialess", &seven),
        .reference = inertialess};
    series[PEER_SEVEN] = (benchmark_series){
        .method = benchmark_peer_method("CVODE Adams, inertialess", &adams),
        .reference = inertialess};
    for (int m = 0; m < METHODS; m++)
    {
        const int ours = m == CORE_THIRTEEN || m == CORE_SEVEN;

        series[m].first = ours ? 1e-1 : 1e-3;
        series[m].last = ours ? 1e-9 : 1e-11;
    }
    benchmark_measure(&journey, series, METHODS, repeats);

    printf("\n");
    benchmark_print_heading();
    for (int m = 0; m < METHODS; m++)
    {
        benchmark_print(&series[m]);
    }
    print_ratios(series, q);
    benchmark_peer_free(&bdf);
    benchmark_peer_free(&adams);
}

int main(int argc, char **argv)
{
    const int repeats = benchmark_repeats(argc, argv);

    printf("The core and CVODE %s, %d trajectories, one thread; errors are "
           "medians,\nx by the largest semi-axis; times per trajectory, "
           "median of %d repeats\n",
           SUNDIALS_VERSION, BENCHMARK_TRAJECTORIES, repeats);
    for (int which = 0; which < BENCHMARK_JOURNEYS; which++)
    {
        compare_on(which, repeats);
    }
    return 0;
}
