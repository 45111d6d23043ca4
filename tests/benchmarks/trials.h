/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    trials.h - the same trajectories by several methods: errors and times.
*/
#ifndef BENCHMARK_TRIALS_H
#define BENCHMARK_TRIALS_H

#include "ellipsoid.h"
#include "flows.h"

enum
{
    BENCHMARK_TRAJECTORIES = 100, /* also the largest number of repeats */
    BENCHMARK_MAX_POINTS = 24
};

/* Where the cells travel, and where they begin. */
typedef struct benchmark_journey
{
    const char *name;
    ellipsoid_flow_function formula;
    benchmark_flow flow;
    double duration; /* [s] */
    ellipsoid_surroundings around;
    ellipsoid_options options; /* no walls */
    ellipsoid_state start[BENCHMARK_TRAJECTORIES];
} benchmark_journey;

enum
{
    BENCHMARK_SLIT,
    BENCHMARK_HELICAL,
    BENCHMARK_JOURNEYS
};

/* *journey must stay where it is: around refers to it. */
void benchmark_journey_init(benchmark_journey *journey, int which);

typedef struct benchmark_cost
{
    long steps, rhs; /* attempted steps; evaluations, Jacobians' included */
} benchmark_cost;

/*
    A way to carry a cell from the start of a journey to its end. Both functions
    return 0 or, where the method gives up, something else. What prepare() does
    is not timed.
*/
typedef struct benchmark_method
{
    const char *name;
    int (*prepare)(void *context, const benchmark_journey *journey,
                   double tolerance);
    int (*run)(void *context, ellipsoid_state *state, benchmark_cost *cost);
    void *context;
} benchmark_method;

/* The core itself; advance is ellipsoid_advance() or a variant of it. */
typedef struct benchmark_core
{
    ellipsoid_motion motion;
    ellipsoid_status (*advance)(const ellipsoid_member *, double *, double,
                                ellipsoid_observer);
    const benchmark_journey *journey;
    ellipsoid_model model;
} benchmark_core;

benchmark_method benchmark_core_method(const char *name, benchmark_core *core);

/* The journey's options with another motion and tolerance, as a model; exits
   with a message where they are refused. */
ellipsoid_model benchmark_model(const benchmark_journey *journey,
                                ellipsoid_motion motion, double tolerance);

/* Medians over the trajectories, and over the repeats for the time. */
typedef struct benchmark_point
{
    double tolerance;
    double x; /* [-] distance from the reference by the largest semi-axis */
    double q; /* [-] |q - q_ref| or |q + q_ref|, whichever is less */
    double seconds, steps, rhs; /* per trajectory */
    double sample[BENCHMARK_TRAJECTORIES];
    int failed;
} benchmark_point;

/* One method over a range of tolerances, 10^(-n/2) from first to last. */
typedef struct benchmark_series
{
    benchmark_method method;
    const ellipsoid_state *reference;
    double first, last;
    int count;
    benchmark_point point[BENCHMARK_MAX_POINTS];
} benchmark_series;

/* Fills end[]; exits with a message if the method gives up. */
void benchmark_reference(const benchmark_method *method,
                         const benchmark_journey *journey, double tolerance,
                         ellipsoid_state end[BENCHMARK_TRAJECTORIES]);

/* Median distances of two sets of ends, as in benchmark_point. */
void benchmark_distance(const benchmark_journey *journey,
                        const ellipsoid_state a[BENCHMARK_TRAJECTORIES],
                        const ellipsoid_state b[BENCHMARK_TRAJECTORIES],
                        double *x, double *q);

/* Runs all series in turns, so that a busy machine slows all alike. */
void benchmark_measure(const benchmark_journey *journey,
                       benchmark_series *series, int count, int repeats);

void benchmark_print_heading(void);
void benchmark_print(const benchmark_series *series);

/* Time [s] and steps at a median error of q, by interpolation between the
   logarithms; NaN if it was not reached. */
double benchmark_time_at(const benchmark_series *series, double q);
double benchmark_steps_at(const benchmark_series *series, double q);

/* CPU time of this thread [s]. */
double benchmark_clock(void);

/* Repeats from the command line, 5 unless told. */
int benchmark_repeats(int argc, char **argv);

#endif
