/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_callbacks.c - what a callback finds where it writes its answer: zero,
    so that it sets what is not. Each leaves other numbers behind, which are
    still in that memory if nobody clears it before the next call.
*/
#include "coreTest.h"

#include <stddef.h>

typedef struct calls
{
    long values, derivatives;
} calls;

/* A count of doubles, all found zero. */
static void find_zero(const double *number, size_t bytes)
{
    for (size_t n = 0; n < bytes / sizeof *number; n++)
    {
        assert_true(number[n] == 0);
    }
}

/* Small enough for the cell hardly to move. */
static void leave(double *number, size_t bytes)
{
    for (size_t n = 0; n < bytes / sizeof *number; n++)
    {
        number[n] = 1e-9 * (1 + (double)n);
    }
}

static void count_call(void *context, int derivatives)
{
    calls *counted = context;

    *(derivatives ? &counted->derivatives : &counted->values) += 1;
}

static int flow(void *context, double t, const double x[3], int derivatives,
                ellipsoid_flow_sample *sample)
{
    const size_t bytes = derivatives
                           ? sizeof *sample
                           : offsetof(ellipsoid_flow_sample, velocity_jacobian);

    (void)t;
    (void)x;
    count_call(context, derivatives);
    find_zero(sample->velocity, bytes);
    leave(sample->velocity, bytes);
    return 0;
}

static int velocities(void *context, double t, const double centre[3],
                      int count, double (*points)[3], double (*velocity)[3],
                      double (*jacobian)[3][3])
{
    (void)t;
    (void)centre;
    (void)points;
    count_call(context, jacobian != NULL);
    find_zero(velocity[0], (size_t)count * sizeof *velocity);
    leave(velocity[0], (size_t)count * sizeof *velocity);
    if (jacobian)
    {
        find_zero(jacobian[0][0], (size_t)count * sizeof *jacobian);
        leave(jacobian[0][0], (size_t)count * sizeof *jacobian);
    }
    return 0;
}

static int field(void *context, double t, const double x[3], double e[3],
                 double (*jacobian)[3])
{
    (void)t;
    (void)x;
    count_call(context, jacobian != NULL);
    find_zero(e, 3 * sizeof *e);
    leave(e, 3 * sizeof *e);
    if (jacobian)
    {
        find_zero(jacobian[0], 3 * sizeof *jacobian);
        leave(jacobian[0], 3 * sizeof *jacobian);
    }
    return 0;
}

static int force(void *context, double t, const ellipsoid_state *state,
                 double f[3], double torque[3],
                 ellipsoid_wrench_jacobian *jacobian)
{
    (void)t;
    (void)state;
    count_call(context, jacobian != NULL);
    find_zero(f, 3 * sizeof *f);
    find_zero(torque, 3 * sizeof *torque);
    f[0] = torque[0] = 1e-25;
    if (jacobian)
    {
        find_zero(jacobian->force_x[0], sizeof *jacobian);
        leave(jacobian->force_x[0], sizeof *jacobian);
        memset(jacobian, 0, sizeof *jacobian);
        jacobian->force_x[0][0] = 1e-25;
    }
    return 0;
}

/* Values and derivatives at a state, again and again. */
static void ask(const ellipsoid_options *options,
                const ellipsoid_surroundings *around)
{
    const ellipsoid_model model = test_model(options);
    const ellipsoid_state state = {.q = {0, 0, 0, 1}};

    for (int n = 0; n < 3; n++)
    {
        ellipsoid_state derivative;
        double jacobian[ELLIPSOID_STATE_SIZE][ELLIPSOID_STATE_SIZE];

        assert_int_equal(
            ellipsoid_rhs(&model, around, &state, NULL, &derivative),
            ELLIPSOID_OK);
        assert_int_equal(
            ellipsoid_jacobian(&model, around, &state, NULL, jacobian),
            ELLIPSOID_OK);
    }
}

static void expect_calls(const calls *counted)
{
    assert_true(counted->values >= 3);
    assert_true(counted->derivatives >= 3);
}

/* With and without inertia; at the centre and over the body. */
static void test_zero_when_called(void **unused)
{
    (void)unused;
    for (int kind = 0; kind < 8; kind++)
    {
        ellipsoid_options o = test_free_cell();
        calls of_flow = {0}, of_body = {0}, of_field = {0}, of_force = {0};
        const ellipsoid_surroundings around = {
            .flow = flow,
            .flow_context = &of_flow,
            .velocities = NULL,
            .field = field,
            .field_context = &of_field,
            .force = force,
            .force_context = &of_force,
            .unsteady = kind & 4,
        };
        ellipsoid_surroundings all_points = around;

        o.motion =
            kind & 1 ? ELLIPSOID_MOTION_INERTIALESS : ELLIPSOID_MOTION_INERTIAL;
        o.flow_at = kind & 2 ? ELLIPSOID_FLOW_BODY : ELLIPSOID_FLOW_CENTRE;
        o.charge = 1e-20;
        ask(&o, &around);
        expect_calls(&of_flow);
        expect_calls(&of_field);
        expect_calls(&of_force);
        if (kind & 2)
        {
            all_points.velocities = velocities;
            all_points.flow_context = &of_body;
            ask(&o, &all_points);
            expect_calls(&of_body);
        }
    }
}

/* u = (rate x2, 0, 0) by what of it is not zero. */
static int terse_shear(void *context, double t, const double x[3],
                       int derivatives, ellipsoid_flow_sample *sample)
{
    const double rate = *(const double *)context;

    (void)t;
    sample->velocity[0] = rate * x[1];
    sample->gradient[0][1] = rate;
    if (derivatives)
    {
        sample->velocity_jacobian[0][1] = rate;
    }
    return 0;
}

/* The same steps, to the last bit, as in a flow that sets every number. */
static void test_two_numbers_are_a_shear(void **unused)
{
    const ellipsoid_options o = test_free_cell();
    const ellipsoid_model model = test_model(&o);
    ellipsoid_state moved[2];

    (void)unused;
    for (int n = 0; n < 2; n++)
    {
        double rate = 1000, t = 0;
        test_quadratic shear = test_shear(rate);
        const ellipsoid_surroundings around = {
            .flow = n == 0 ? test_quadratic_flow : terse_shear,
            .flow_context = n == 0 ? (void *)&shear : (void *)&rate};
        ellipsoid_controller controller = {0};
        const ellipsoid_state start = {.x = {0, 1e-6, 0}, .q = {0, 0, 0, 1}};
        const ellipsoid_member cell = {.model = &model,
                                       .surroundings = &around,
                                       .state = &moved[n],
                                       .controller = &controller};

        moved[n] = start;
        assert_int_equal(ellipsoid_advance(&cell, &t, 1e-2, NULL),
                         ELLIPSOID_OK);
    }
    assert_memory_equal(&moved[0], &moved[1], sizeof moved[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_zero_when_called),
        cmocka_unit_test(test_two_numbers_are_a_shear),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
