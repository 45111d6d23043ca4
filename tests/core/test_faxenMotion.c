/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_faxenMotion.c - the flow over the body along its way.
*/
#include "faxenTest.h"

/*
    How far the two models differ, in a slit of 10 um at 4 mm/s on average: the
    cell lies along the stream or stands across it. Across the gap <u> - u is
    a_j^2 u''/6 = -4 mm/s 12/(10 um)^2 a_j^2/6 exactly, a_j the semi-axis there.
*/
static void test_paper_cell_in_a_slit(void **unused)
{
    static const test_row row = {
        "free motion",
        "how far a cell stays behind the flow over the closed form, flow body",
        "E. coli along and across a slit of 10 um, 4 mm/s",
        "Brenner, Chem. Eng. Sci. 19, 703 (1964): a^2 u''/6",
        "A",
        "rounding",
        0};
    const double quarter = sqrt(0.5), height = 10e-6, mean = 4e-3;
    const double pose[2][4] = {{0, 0, 0, 1}, {quarter, 0, 0, quarter}};
    const ellipsoid_model m = body(0.5e-6, 2e-6, 0.5e-6);
    const double reach[2] = {m.options.semi_axes[2], m.options.semi_axes[1]};
    test_quadratic flow = {.u = {0, 1.5 * mean, 0}};

    (void)unused;
    flow.h[1][2][2] = -12 * mean / (height * height);
    for (int n = 0; n < 2; n++)
    {
        const double x[3] = {0, 0, 0};
        double u[3], omega[3];

        free_motion(&m, test_quadratic_flow, &flow, x, pose[n], u, omega);
        print_message(
            "# %s the gap: %.2f %% slower than the flow at its centre\n",
            n ? "across" : "along", 100 * (1 - u[1] / flow.u[1]));
        assert_row(&row,
                   (u[1] - flow.u[1])
                       / (flow.h[1][2][2] * reach[n] * reach[n] / 6),
                   1, 1e-12);
    }
}

/* u_1 = U sin(k x_3) and so on, cyclic (an ABC flow). */
typedef struct vortices
{
    double speed, k;
} vortices;

static int in_vortices(void *context, double t, const double x[3],
                       int derivatives, ellipsoid_flow_sample *f)
{
    const vortices *v = context;

    (void)t;
    (void)derivatives;
    for (int i = 0; i < 3; i++)
    {
        const int j = (i + 2) % 3, k = (i + 1) % 3;

        f->velocity[i] = v->speed * (sin(v->k * x[j]) + cos(v->k * x[k]));
        ellipsoid_set(f->gradient[i], 0, 0, 0);
        f->gradient[i][j] = v->speed * v->k * cos(v->k * x[j]);
        f->gradient[i][k] = -v->speed * v->k * sin(v->k * x[k]);
    }
    memcpy(f->velocity_jacobian, f->gradient, sizeof(f->gradient));
    return 0;
}

static int velocities_in_vortices(void *context, double t,
                                  const double centre[3], int count,
                                  double (*points)[3], double (*velocity)[3],
                                  double (*jacobian)[3][3])
{
    (void)centre;
    for (int p = 0; p < count; p++)
    {
        ellipsoid_flow_sample f;

        in_vortices(context, t, points[p], 1, &f);
        ellipsoid_copy(f.velocity, velocity[p]);
        if (jacobian)
        {
            memcpy(jacobian[p], f.gradient, sizeof(f.gradient));
        }
    }
    return 0;
}

/* How it moves, at which tolerance, and whether it is stopped after each step
   and continued. */
typedef struct passage
{
    int motion;
    double tolerance;
    ellipsoid_observer observer;
} passage;

/* To the end; returns the attempts. */
static long through_vortices(vortices *v, const passage *by, ellipsoid_state *s)
{
    ellipsoid_model m = body(0.5e-6, 2e-6, 0.5e-6);
    ellipsoid_options o = m.options;
    const ellipsoid_surroundings around = {.flow = in_vortices,
                                           .flow_context = v,
                                           .velocities =
                                               velocities_in_vortices};
    ellipsoid_controller controller = {0};
    ellipsoid_statistics statistics = {0};
    const ellipsoid_member member = {&m,   &around, s,          &controller,
                                     NULL, NULL,    &statistics};
    ellipsoid_status status = ELLIPSOID_STOPPED;
    double t = 0;

    o.motion = by->motion;
    o.tolerance = by->tolerance;
    m = test_model(&o);
    *s = (ellipsoid_state){.x = {1e-6, 2e-6, 5e-6}, .q = {0.6, 0, 0, 0.8}};
    while (status == ELLIPSOID_STOPPED)
    {
        status = ellipsoid_advance(&member, &t, 0.03, by->observer);
    }
    assert_ok(status);
    return statistics.accepted + statistics.rejected;
}

/* Steps are of order 4, and their errors are those that the tolerance asks
   for. */
static void test_order(void **unused)
{
    vortices v = {.speed = 1e-3, .k = 4e5};
    passage by = {ELLIPSOID_MOTION_INERTIAL, 1e-11, NULL};
    ellipsoid_state exact;
    double before = 0;
    long previous = 0;

    (void)unused;
    through_vortices(&v, &by, &exact);
    for (int n = 0; n < 4; n++)
    {
        const double tolerance = 1e-5 * pow(10, -n);
        ellipsoid_state s;
        double off[3], error;
        long attempts;

        by.tolerance = tolerance;
        attempts = through_vortices(&v, &by, &s);
        ellipsoid_difference(s.x, exact.x, off);
        error = ellipsoid_length(off) / 2e-6;
        print_message("# %g: %ld attempts, off by %.3g\n", tolerance, attempts,
                      error);
        assert_true(error < 1.2 * tolerance);
        if (n > 0)
        {
            assert_true(log(before / error)
                        > 4 * log((double)attempts / previous));
        }
        before = error;
        previous = attempts;
    }
}

static int stop(void *context, const ellipsoid_step *step)
{
    (void)context;
    (void)step;
    return 1;
}

/* Stopped after each step and continued, a cell takes the way of one that is not
   stopped, to the last bit, however it moves. */
static void test_stopped(void **unused)
{
    static const int motion[2] = {ELLIPSOID_MOTION_INERTIAL,
                                  ELLIPSOID_MOTION_INERTIALESS};
    vortices v = {.speed = 1e-3, .k = 4e5};

    (void)unused;
    for (int n = 0; n < 2; n++)
    {
        passage by = {motion[n], 1e-5, NULL};
        ellipsoid_state whole, stopped;
        const long attempts = through_vortices(&v, &by, &whole);

        by.observer = stop;
        assert_true(attempts > 20);
        assert_int_equal(through_vortices(&v, &by, &stopped), attempts);
        assert_memory_equal(&stopped, &whole, sizeof(whole));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_paper_cell_in_a_slit),
        cmocka_unit_test(test_order),
        cmocka_unit_test(test_stopped),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
