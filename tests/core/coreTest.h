/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    coreTest.h - what the tests of the core share.
*/
#ifndef CORE_TEST_H
#define CORE_TEST_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "motion/motion.h"

static const double test_pi = 3.14159265358979323846;

/* |actual - expected| <= tolerance; a NaN fails. */
#define assert_near(actual, expected, tolerance)                               \
    test_near(actual, expected, tolerance, #actual, __FILE__, __LINE__)

static inline void test_near(double actual, double expected, double tolerance,
                             const char *what, const char *file, int line)
{
    if (!(fabs(actual - expected) <= tolerance))
    {
        print_error("%s = %.17g, not %.17g within %g\n", what, actual, expected,
                    tolerance);
        _fail(file, line);
    }
}

#define assert_relative(actual, expected, tolerance)                           \
    test_near(actual, expected, (tolerance)*fabs((double)(expected)), #actual, \
              __FILE__, __LINE__)

#define assert_ok(status) assert_int_equal(status, ELLIPSOID_OK)

/*
    How many samples a test takes: few where it is run to find faults of memory
    and arithmetic (ELLIPSOID_TEST_FEW=1), which a part of them shows as well;
    else those of every day or, with ELLIPSOID_TEST_FULL=1, of the full run.
*/
static inline long test_count(long few, long everyday, long full)
{
    const char *is_few = getenv("ELLIPSOID_TEST_FEW");
    const char *is_full = getenv("ELLIPSOID_TEST_FULL");

    if (is_few && !strcmp(is_few, "1"))
    {
        return few;
    }
    return is_full && !strcmp(is_full, "1") ? full : everyday;
}

/* What a row of the validation table is of: see CONTRIBUTING.md, Tests. */
typedef struct test_row
{
    const char *group, *quantity, *conditions, *source, *kind, *why;
    double disagrees; /* 0, or the error over bound allowed, above 1 */
} test_row;

#define assert_row(row, value, reference, bound)                               \
    test_row_near(row, value, reference, bound, __FILE__, __LINE__)

/* Asserts it, and adds it to the file ELLIPSOID_TEST_ROWS; of rows that are one
   but for their values the table shows the worst. A disagreement that has gone
   fails, too. */
static inline void test_row_near(const test_row *row, double value,
                                 double reference, double bound,
                                 const char *file, int line)
{
    const char *rows = getenv("ELLIPSOID_TEST_ROWS");
    FILE *out = rows && test_count(0, 1, 1) ? fopen(rows, "a") : NULL;

    if (out)
    {
        fprintf(out,
                "%s\t%s\t%s\t%s\t%s\t%s\t%.17g\t%.17g\t%.17g\teveryday\t%g\n",
                row->group, row->quantity, row->conditions, row->source,
                row->kind, row->why, value, reference, bound, row->disagrees);
        fclose(out);
    }
    test_near(value, reference, bound * fmax(1, row->disagrees), row->quantity,
              file, line);
    if (row->disagrees > 1 && fabs(value - reference) <= bound)
    {
        print_error("%s agrees now: %g\n", row->quantity, value);
        _fail(file, line);
    }
}

/* splitmix64: the same numbers everywhere. */
static inline double test_uniform(uint64_t *seed)
{
    uint64_t z = (*seed += 0x9e3779b97f4a7c15u);

    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) / 9007199254740992.0;
}

/* Uniform in (-1, 1). */
static inline double test_signed(uint64_t *seed)
{
    return 2 * test_uniform(seed) - 1;
}

static inline void test_orientation(uint64_t *seed, double q[4])
{
    double uniform[3];

    for (int i = 0; i < 3; i++)
    {
        uniform[i] = test_uniform(seed);
    }
    ellipsoid_quaternion_from_uniform(uniform, q);
}

/* The body axis x^2 in the lab. */
static inline void test_long_axis(const ellipsoid_state *state, double axis[3])
{
    double r[3][3];

    ellipsoid_rotation(state->q, r);
    ellipsoid_set(axis, r[0][1], r[1][1], r[2][1]);
}

/* A flow that is a quadratic polynomial of the position (context). */
typedef struct test_quadratic
{
    double u[3], g[3][3];
    double h[3][3][3]; /* dg_ij/dx_k, symmetric in j and k */
    double pressure_gradient[3], pressure_jacobian[3][3];
    int answer; /* what the callback returns */
} test_quadratic;

static inline int test_quadratic_flow(void *context, double t,
                                      const double x[3], int derivatives,
                                      ellipsoid_flow_sample *sample)
{
    const test_quadratic *f = context;

    (void)t;
    for (int i = 0; i < 3; i++)
    {
        sample->velocity[i] = f->u[i];
        sample->pressure_gradient[i] =
            f->pressure_gradient[i] + ellipsoid_dot(f->pressure_jacobian[i], x);
        for (int j = 0; j < 3; j++)
        {
            double change = 0;

            for (int k = 0; k < 3; k++)
            {
                change += f->h[i][j][k] * x[k];
            }
            sample->gradient[i][j] = f->g[i][j] + change;
            sample->velocity[i] += (f->g[i][j] + change / 2) * x[j];
        }
    }
    if (derivatives)
    {
        memcpy(sample->velocity_jacobian, sample->gradient,
               sizeof(sample->gradient));
        memcpy(sample->gradient_jacobian, f->h, sizeof(f->h));
        memcpy(sample->pressure_jacobian, f->pressure_jacobian,
               sizeof(f->pressure_jacobian));
    }
    return f->answer;
}

/* u = (rate x2, 0, 0) */
static inline test_quadratic test_shear(double rate)
{
    test_quadratic flow = {.answer = 0};

    flow.g[0][1] = rate;
    return flow;
}

/* The paper's model: the flow at the centre, and walls that do not resist. Places
   are compared to nanometres. */
static inline ellipsoid_options test_paper_options(void)
{
    ellipsoid_options options = ellipsoid_options_default();

    options.tolerance = 1e-4;
    options.flow_at = ELLIPSOID_FLOW_CENTRE;
    options.wall_resistance = ELLIPSOID_WALL_RESISTANCE_NONE;
    return options;
}

/* The paper's cell without walls and weight. */
static inline ellipsoid_options test_free_cell(void)
{
    ellipsoid_options options = test_paper_options();

    options.contact = 0;
    options.buoyancy = 0;
    return options;
}

static inline ellipsoid_model test_model(const ellipsoid_options *options)
{
    ellipsoid_model model;

    assert_ok(ellipsoid_model_init(&model, options));
    return model;
}

/* Adds the moment about the origin of what the other cells of its group do to a
   cell. */
static inline void test_add_moment(const ellipsoid_state *state,
                                   const ellipsoid_contact *contact,
                                   double moment[3])
{
    double r[3][3], turned[3], part[3];

    ellipsoid_rotation(state->q, r);
    ellipsoid_product(r, contact->cell_torque, turned);
    ellipsoid_cross(state->x, contact->cell_force, part);
    ellipsoid_add(moment, turned);
    ellipsoid_add(moment, part);
}

/* Advances without walls or observer. */
static inline ellipsoid_status
test_advance(const ellipsoid_model *model, test_quadratic *flow,
             ellipsoid_state *state, double *t, double end,
             ellipsoid_controller *controller, ellipsoid_statistics *statistics)
{
    const ellipsoid_surroundings surroundings = {
        .flow = flow ? test_quadratic_flow : NULL, .flow_context = flow};

    return ellipsoid_advance(&(ellipsoid_member){model, &surroundings, state,
                                                 controller, NULL, NULL,
                                                 statistics},
                             t, end, NULL);
}

#endif
