/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    trials.c - the same trajectories by several methods: errors and times.
*/
#define _POSIX_C_SOURCE 200809L

#include "trials.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum
{
    COUNT = BENCHMARK_TRAJECTORIES
};

double benchmark_clock(void)
{
    struct timespec now;

    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int benchmark_repeats(int argc, char **argv)
{
    const int repeats = argc > 1 ? atoi(argv[1]) : 5;

    if (argc > 2 || repeats < 1 || repeats > COUNT)
    {
        fprintf(stderr, "usage: %s [repeats, 1 to %d]\n", argv[0], COUNT);
        exit(2);
    }
    return repeats;
}

/* ------------------------------------------------------------- journeys */

/*
    The paper's cell. Slit: at rest with the flow anywhere within 0.9 of the
    width. Helical: anywhere in one vortex. All orientations alike.
*/
void benchmark_journey_init(benchmark_journey *journey, int which)
{
    const int slit = which == BENCHMARK_SLIT;

    memset(journey, 0, sizeof(*journey));
    journey->name = slit ? "60 ms in a slit of 10 um, 4 mm/s in the middle"
                         : "20 ms in helical vortices of 50 um, 4 mm/s";
    journey->formula = slit ? benchmark_slit_flow : benchmark_helical_flow;
    journey->flow.speed = 4e-3;
    journey->flow.size = slit ? 10e-6 : 50e-6;
    journey->duration = slit ? 60e-3 : 20e-3;
    journey->around.flow = journey->formula;
    journey->around.flow_context = &journey->flow;
    journey->options = ellipsoid_options_default();
    journey->options.contact = 0;
    journey->options.flow_at = ELLIPSOID_FLOW_CENTRE;

    for (int n = 0; n < COUNT; n++)
    {
        ellipsoid_state *s = &journey->start[n];
        ellipsoid_flow_sample sample;
        double uniform[6];

        ellipsoid_random_uniform(1, (uint32_t)n, 0, 0, 6, uniform);
        for (int i = 0; i < 3; i++)
        {
            s->x[i] = journey->flow.size
                    * (slit ? 0.9 * (uniform[i] - 0.5) : uniform[i]);
        }
        ellipsoid_quaternion_from_uniform(uniform + 3, s->q);
        journey->formula(&journey->flow, 0, s->x, 0, &sample);
        memcpy(s->u, sample.velocity, sizeof(s->u));
    }
}

/* ------------------------------------------------------------- the core */

ellipsoid_model benchmark_model(const benchmark_journey *journey,
                                ellipsoid_motion motion, double tolerance)
{
    ellipsoid_options options = journey->options;
    ellipsoid_model model;

    options.motion = motion;
    options.tolerance = tolerance;
    if (ellipsoid_model_init(&model, &options) != ELLIPSOID_OK)
    {
        fprintf(stderr, "the core refuses the options\n");
        exit(1);
    }
    return model;
}

static int core_prepare(void *context, const benchmark_journey *journey,
                        double tolerance)
{
    benchmark_core *core = context;

    core->journey = journey;
    core->model = benchmark_model(journey, core->motion, tolerance);
    return 0;
}

static int core_run(void *context, ellipsoid_state *state, benchmark_cost *cost)
{
    benchmark_core *core = context;
    ellipsoid_controller controller = {0, 0};
    ellipsoid_statistics statistics = {0};
    double t = 0;
    const ellipsoid_member cell = {
        &core->model, &core->journey->around, state, &controller, NULL, NULL,
        &statistics};
    const ellipsoid_status status =
        core->advance(&cell, &t, core->journey->duration, NULL);

    cost->steps = statistics.accepted + statistics.rejected;
    cost->rhs = statistics.rhs;
    return status != ELLIPSOID_OK;
}

benchmark_method benchmark_core_method(const char *name, benchmark_core *core)
{
    return (benchmark_method){name, core_prepare, core_run, core};
}

/* --------------------------------------------------------------- errors */

static int compare(const void *a, const void *b)
{
    const double left = *(const double *)a, right = *(const double *)b;

    return (left > right) - (left < right);
}

/* count <= COUNT */
static double median(const double *value, int count)
{
    double sorted[COUNT];

    memcpy(sorted, value, (size_t)count * sizeof(double));
    qsort(sorted, (size_t)count, sizeof(double), compare);
    return 0.5 * (sorted[(count - 1) / 2] + sorted[count / 2]);
}

/* |a - sign b| */
static double distance(const double *a, const double *b, int count, double sign)
{
    double sum = 0;

    for (int i = 0; i < count; i++)
    {
        const double d = a[i] - sign * b[i];

        sum += d * d;
    }
    return sqrt(sum);
}

void benchmark_distance(const benchmark_journey *journey,
                        const ellipsoid_state a[COUNT],
                        const ellipsoid_state b[COUNT], double *x, double *q)
{
    const double *axes = journey->options.semi_axes;
    const double length = fmax(axes[0], fmax(axes[1], axes[2]));
    double of_x[COUNT], of_q[COUNT];

    for (int n = 0; n < COUNT; n++)
    {
        of_x[n] = distance(a[n].x, b[n].x, 3, 1) / length;
        of_q[n] = fmin(distance(a[n].q, b[n].q, 4, 1),
                       distance(a[n].q, b[n].q, 4, -1));
    }
    *x = median(of_x, COUNT);
    *q = median(of_q, COUNT);
}

void benchmark_reference(const benchmark_method *method,
                         const benchmark_journey *journey, double tolerance,
                         ellipsoid_state end[COUNT])
{
    int failed = method->prepare(method->context, journey, tolerance);

    memcpy(end, journey->start, sizeof(journey->start));
    for (int n = 0; n < COUNT; n++)
    {
        benchmark_cost cost;

        failed = failed || method->run(method->context, &end[n], &cost);
    }
    if (failed)
    {
        fprintf(stderr, "%s gave up at tolerance %g\n", method->name,
                tolerance);
        exit(1);
    }
}

/* ---------------------------------------------------------------- times */

static void measure_point(const benchmark_journey *journey,
                          const benchmark_series *series,
                          benchmark_point *point, int repeat)
{
    const benchmark_method *method = &series->method;
    ellipsoid_state end[COUNT];
    benchmark_cost cost[COUNT];
    double start, steps = 0, rhs = 0;

    if (point->failed
        || method->prepare(method->context, journey, point->tolerance))
    {
        point->failed = 1;
        return;
    }
    memcpy(end, journey->start, sizeof(journey->start));
    start = benchmark_clock();
    for (int n = 0; n < COUNT; n++)
    {
        if (method->run(method->context, &end[n], &cost[n]))
        {
            point->failed = 1;
            return;
        }
    }
    point->sample[repeat] = (benchmark_clock() - start) / COUNT;
    for (int n = 0; n < COUNT; n++)
    {
        steps += (double)cost[n].steps;
        rhs += (double)cost[n].rhs;
    }
    point->steps = steps / COUNT;
    point->rhs = rhs / COUNT;
    benchmark_distance(journey, end, series->reference, &point->x, &point->q);
}

void benchmark_measure(const benchmark_journey *journey,
                       benchmark_series *series, int count, int repeats)
{
    int longest = 0;

    for (int s = 0; s < count; s++)
    {
        benchmark_series *of = &series[s];
        int n = (int)lround(-2 * log10(of->first));

        for (of->count = 0; of->count < BENCHMARK_MAX_POINTS; of->count++, n++)
        {
            const double tolerance = pow(10, -0.5 * n);

            if (tolerance < 0.9 * of->last)
            {
                break;
            }
            of->point[of->count] = (benchmark_point){.tolerance = tolerance};
        }
        longest = of->count > longest ? of->count : longest;
    }
    for (int repeat = 0; repeat < repeats; repeat++)
    {
        for (int n = 0; n < longest; n++)
        {
            for (int s = 0; s < count; s++)
            {
                if (n < series[s].count)
                {
                    measure_point(journey, &series[s], &series[s].point[n],
                                  repeat);
                }
            }
        }
    }
    for (int s = 0; s < count; s++)
    {
        for (int n = 0; n < series[s].count; n++)
        {
            series[s].point[n].seconds =
                median(series[s].point[n].sample, repeats);
        }
    }
}

void benchmark_print_heading(void)
{
    printf("  %-34s %8s %8s %8s %8s %8s %9s\n", "method", "tolerance",
           "error q", "error x", "steps", "rhs", "us");
}

void benchmark_print(const benchmark_series *series)
{
    for (int n = 0; n < series->count; n++)
    {
        const benchmark_point *p = &series->point[n];

        printf("  %-34s %8.1e", series->method.name, p->tolerance);
        if (p->failed)
        {
            printf("  gave up\n");
        }
        else
        {
            printf(" %8.1e %8.1e %8.1f %8.1f %9.1f\n", p->q, p->x, p->steps,
                   p->rhs, 1e6 * p->seconds);
        }
    }
}

typedef double (*quantity)(const benchmark_point *point);

static double seconds_of(const benchmark_point *point)
{
    return point->seconds;
}

static double steps_of(const benchmark_point *point) { return point->steps; }

/* From the loosest pair of neighbours with the error between them. */
static double at_error(const benchmark_series *series, double q, quantity of)
{
    for (int n = 1; n < series->count; n++)
    {
        const benchmark_point *a = &series->point[n - 1];
        const benchmark_point *b = &series->point[n];

        if (!a->failed && !b->failed && a->q >= q && b->q < q)
        {
            const double part = log(a->q / q) / log(a->q / b->q);

            return of(a) * pow(of(b) / of(a), part);
        }
    }
    return NAN;
}

double benchmark_time_at(const benchmark_series *series, double q)
{
    return at_error(series, q, seconds_of);
}

double benchmark_steps_at(const benchmark_series *series, double q)
{
    return at_error(series, q, steps_of);
}
