/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_unsteady.c - surroundings that depend on time: the times at which they
    are asked, closed forms, and the order of both methods.
*/
#include "flowTest.h"

#include <complex.h>

/* A flow times cos(frequency t), and at which times it was asked. */
typedef struct oscillation
{
    test_quadratic flow;    /* at the time 0 */
    test_vortices vortices; /* added */
    double frequency;       /* [rad/s] */
    double first, last;     /* [s] of the times asked */
    long asked_last;        /* how often at `last` */
} oscillation;

static void note_time(oscillation *o, double t)
{
    o->asked_last = t == o->last ? o->asked_last + 1 : 1;
    o->first = fmin(o->first, t);
    o->last = fmax(o->last, t);
}

static void scale(double factor, double *numbers, size_t count)
{
    for (size_t n = 0; n < count; n++)
    {
        numbers[n] *= factor;
    }
}

static int oscillating_flow(void *context, double t, const double x[3],
                            int derivatives, ellipsoid_flow_sample *sample)
{
    oscillation *o = context;
    const double now = cos(o->frequency * t);
    const double rate = -o->frequency * sin(o->frequency * t);
    ellipsoid_flow_sample more = {.velocity = {0}};

    note_time(o, t);
    test_quadratic_flow(&o->flow, t, x, derivatives, sample);
    test_vortex_flow(&o->vortices, t, x, derivatives, &more);
    for (size_t n = 0; n < sizeof(more) / sizeof(double); n++)
    {
        ((double *)sample)[n] += ((double *)&more)[n];
    }
    for (int i = 0; i < 3; i++)
    {
        sample->local_acceleration[i] = rate * sample->velocity[i];
    }
    if (derivatives)
    {
        memcpy(sample->acceleration_jacobian, sample->gradient,
               sizeof(sample->gradient));
        scale(rate, sample->acceleration_jacobian[0], 9);
    }
    scale(now, sample->velocity, 3);
    scale(now, sample->gradient[0], 9);
    scale(now, sample->velocity_jacobian[0], 9);
    scale(now, sample->gradient_jacobian[0][0], 27);
    return 0;
}

static int oscillating_velocities(void *context, double t,
                                  const double centre[3], int count,
                                  double (*points)[3], double (*velocity)[3],
                                  double (*jacobian)[3][3])
{
    (void)centre;
    for (int n = 0; n < count; n++)
    {
        ellipsoid_flow_sample sample = {.velocity = {0}};

        oscillating_flow(context, t, points[n], jacobian != NULL, &sample);
        memcpy(velocity[n], sample.velocity, sizeof(sample.velocity));
        if (jacobian)
        {
            memcpy(jacobian[n], sample.velocity_jacobian,
                   sizeof(sample.velocity_jacobian));
        }
    }
    return 0;
}

/* With this the inertialess motion takes Rosenbrock steps, too. */
static int no_force(void *context, double t, const ellipsoid_state *state,
                    double force[3], double torque[3],
                    ellipsoid_wrench_jacobian *jacobian)
{
    (void)context, (void)t, (void)state;
    (void)force, (void)torque, (void)jacobian;
    return 0;
}

static ellipsoid_surroundings in_flow(oscillation *o)
{
    o->first = HUGE_VAL;
    o->last = -HUGE_VAL;
    return (ellipsoid_surroundings){
        .flow = oscillating_flow, .flow_context = o, .unsteady = 1};
}

/* A body and a fluid of order one, free of torque. */
static ellipsoid_options unit_body(ellipsoid_motion motion, double tolerance)
{
    ellipsoid_options o = test_unit_body().options;

    ellipsoid_set(o.external_torque, 0, 0, 0);
    o.motion = motion;
    o.tolerance = tolerance;
    return o;
}

static ellipsoid_state advance(const ellipsoid_model *model,
                               const ellipsoid_surroundings *around,
                               ellipsoid_state state, double start, double end)
{
    ellipsoid_controller controller = {0};
    ellipsoid_statistics statistics = {0};
    double t = start;

    assert_ok(ellipsoid_advance(&(ellipsoid_member){model, around, &state,
                                                    &controller, NULL, NULL,
                                                    &statistics},
                                &t, end, NULL));
    return state;
}

/* ------------------------------------------------------------ closed forms */

/*
    Along a body axis, in u_f = U cos(w t):
        m du/dt = z (u_f - u) + m_f du_f/dt,  z = mu K,
    so that u = Re(A exp(i w t)) + (u_0 - Re A) exp(-z t/m) with
    A = U (z + i w m_f)/(z + i w m). Centre and surface average give the same.
*/
static void check_uniform(ellipsoid_flow_at at, int with_velocities)
{
    const double w = 3, speed = 0.7, start = 0.4, end = 5;
    ellipsoid_options options = unit_body(ELLIPSOID_MOTION_INERTIAL, 1e-9);
    oscillation flow = {.flow.u = {0, speed, 0}, .frequency = w};
    ellipsoid_surroundings around = in_flow(&flow);
    ellipsoid_state s = {.u = {0, 0.2, 0}, .q = {0, 0, 0, 1}};
    ellipsoid_model model;

    options.flow_at = at;
    model = test_model(&options);
    around.velocities = with_velocities ? oscillating_velocities : NULL;
    s = advance(&model, &around, s, start, end);

    const double z = model.viscosity * model.resistance[1], m = model.mass;
    const double complex a =
        speed * (z + I * w * model.fluid_mass) / (z + I * w * m);
    const double complex from = a * cexp(I * w * start);
    const double complex to = a * cexp(I * w * end);
    const double transient = 0.2 - creal(from);
    const double decay = exp(-z / m * (end - start));

    /* 1e-9 a step, some hundred steps */
    assert_near(s.u[1], creal(to) + transient * decay, 2e-8);
    assert_near(s.x[1],
                creal((to - from) / (I * w)) + transient * (1 - decay) * m / z,
                2e-8);
    assert_true(flow.first == start && flow.last == end);
}

static void test_uniform_flow(void **unused)
{
    (void)unused;
    check_uniform(ELLIPSOID_FLOW_CENTRE, 0);
    check_uniform(ELLIPSOID_FLOW_BODY, 0);
    check_uniform(ELLIPSOID_FLOW_BODY, 1);
}

/*
    Jeffery (1922), eq. 46, for a spheroid whose axis lies in the plane of a
    shear u = g cos(w t) (x2, 0, 0): the angle p from x2 follows the strain that
    has passed, tan p = r tan(r/(r^2 + 1) g sin(w t)/w). The strain is wide
    enough that the axis turns over.
*/
static void check_shear(ellipsoid_force_function force, int cells)
{
    const double w = 0.9, rate = 5, r = 3;
    ellipsoid_options options = unit_body(ELLIPSOID_MOTION_INERTIALESS, 1e-9);
    oscillation flow = {.flow = test_shear(rate), .frequency = w};
    ellipsoid_surroundings around[2] = {in_flow(&flow), in_flow(&flow)};
    ellipsoid_state s[2] = {{.q = {0, 0, 0, 1}},
                            {.x = {0, 0, 50}, .q = {0, 0, 0, 1}}};
    ellipsoid_controller controller[2] = {{0, 0}};
    ellipsoid_statistics statistics[2] = {{0}};
    ellipsoid_model model;
    double t = 0;

    options.semi_axes[0] = options.semi_axes[2] = 0.5;
    options.semi_axes[1] = 0.5 * r;
    options.bead_radius = 0.1;
    model = test_model(&options);
    around[0].force = around[1].force = force;
    for (int n = 1; n <= 8; n++)
    {
        const double strain = rate / w * sin(w * n);
        const double phase = r / (r * r + 1) * strain;
        const double turn = atan2(r * sin(phase), cos(phase));
        double axis[3];

        if (cells == 1)
        {
            assert_ok(ellipsoid_advance(&(ellipsoid_member){&model, around, s,
                                                            controller, NULL,
                                                            NULL, statistics},
                                        &t, n, NULL));
        }
        else
        {
            const ellipsoid_member members[2] = {
                {&model, &around[0], &s[0], &controller[0], NULL, NULL,
                 &statistics[0]},
                {&model, &around[1], &s[1], &controller[1], NULL, NULL,
                 &statistics[1]}};
            void *memory = test_malloc(ellipsoid_group_size(2));
            int which;

            assert_ok(ellipsoid_advance_group(2, members, &t, n, NULL, memory,
                                              &which));
            test_free(memory);
        }
        for (int c = 0; c < cells; c++)
        {
            test_long_axis(&s[c], axis);
            /* 1e-9 a step, some hundred steps that stretch errors r-fold */
            assert_near(axis[0], sin(turn), 2e-7);
            assert_near(axis[1], cos(turn), 2e-7);
        }
    }
}

static void test_shear_flow(void **unused)
{
    (void)unused;
    check_shear(NULL, 1);
    check_shear(no_force, 1);
    check_shear(NULL, 2);
    check_shear(no_force, 2);
}

/* E = E_0 cos(w t) in vacuum: m x'' = charge E_0 cos(w t). */
static int oscillating_field(void *context, double t, const double x[3],
                             double field[3], double (*jacobian)[3])
{
    (void)x, (void)jacobian; /* zero as it comes */
    field[0] = 2 * cos(*(double *)context * t);
    return 0;
}

static void test_field(void **unused)
{
    double w = 3;
    ellipsoid_options options = unit_body(ELLIPSOID_MOTION_INERTIAL, 1e-9);
    const ellipsoid_surroundings around = {
        .field = oscillating_field, .field_context = &w, .unsteady = 1};
    ellipsoid_state s = {.u = {1, 0, 0}, .q = {0, 0, 0, 1}};
    ellipsoid_model model;

    (void)unused;
    options.charge = 1.5;
    model = test_model(&options);
    s = advance(&model, &around, s, 0, 4);

    const double a = 3 / model.mass;

    assert_near(s.u[0], 1 + a / w * sin(4 * w), 1e-7);
    assert_near(s.x[0], 4 + a / (w * w) * (1 - cos(4 * w)), 1e-7);
}

/* ------------------------------------------------------------------ times */

static int timed_walls(void *context, double t, const double centre[3],
                       double reach, ellipsoid_facet_list *list)
{
    static const ellipsoid_facet none;

    (void)centre;
    note_time(context, t);
    *list = (ellipsoid_facet_list){.facets = &none, .reach = reach};
    return 0;
}

/* Nothing is asked outside the time of the run, and its end is asked exactly,
   also where start + h is not the end to the last bit. */
static void check_times(ellipsoid_motion motion, ellipsoid_force_function force)
{
    static ellipsoid_facet_cache cache;
    ellipsoid_options options = unit_body(motion, 1e-6);
    oscillation flow = {.flow = test_shear(2), .frequency = 1};
    oscillation walls = {.first = HUGE_VAL, .last = -HUGE_VAL};
    ellipsoid_surroundings around = in_flow(&flow);
    ellipsoid_state s = {.u = {0.3, 0.2, 0.1}, .q = {0.6, 0, 0, 0.8}};
    ellipsoid_controller controller = {0};
    ellipsoid_statistics statistics = {0};
    ellipsoid_model model;
    double t = 0.1;

    options.contact = 1;
    options.bead_radius = 0.1;
    model = test_model(&options);
    around.force = force;
    around.walls = timed_walls;
    around.walls_context = &walls;
    for (int n = 0; n < 50; n++)
    {
        const double start = t, end = t + 0.1 / 3;

        flow.first = HUGE_VAL;
        flow.last = -HUGE_VAL;
        ellipsoid_facet_cache_clear(&cache);
        assert_ok(ellipsoid_advance(&(ellipsoid_member){&model, &around, &s,
                                                        &controller, &cache,
                                                        NULL, &statistics},
                                    &t, end, NULL));
        assert_true(flow.first == start && flow.last == end);
        assert_true(walls.first >= 0.1 && walls.last <= end);
    }
}

static void test_times(void **unused)
{
    (void)unused;
    check_times(ELLIPSOID_MOTION_INERTIAL, NULL);
    check_times(ELLIPSOID_MOTION_INERTIALESS, NULL);
    check_times(ELLIPSOID_MOTION_INERTIALESS, no_force);
}

/* Functions that are given no time ask at that of the surroundings. */
static void test_given_time(void **unused)
{
    ellipsoid_options options = unit_body(ELLIPSOID_MOTION_INERTIALESS, 1e-6);
    oscillation flow = {.flow.u = {1, 0, 0}, .frequency = 2};
    ellipsoid_surroundings around = in_flow(&flow);
    const ellipsoid_state s = {.q = {0, 0, 0, 1}};
    ellipsoid_state d, balanced = s;
    ellipsoid_model model;

    (void)unused;
    options.pressure_gradient = ELLIPSOID_PRESSURE_NONE;
    model = test_model(&options);
    around.time = 0.7;
    assert_ok(ellipsoid_rhs(&model, &around, &s, NULL, &d));
    assert_near(d.x[0], cos(1.4), 1e-15);
    assert_ok(ellipsoid_balance(&model, &around, &balanced, NULL));
    assert_near(balanced.u[0], cos(1.4), 1e-15);
    assert_true(flow.first == 0.7 && flow.last == 0.7);
}

/* ------------------------------------------------------------------ order */

/* Which method takes a step. */
typedef struct step_kind
{
    ellipsoid_motion motion;
    ellipsoid_force_function force;
} step_kind;

static int stop(void *context, const ellipsoid_step *step)
{
    (void)context;
    (void)step;
    return 1;
}

/* The error in one step of length h from a time when nothing vanishes. */
static test_errors step_error(const step_kind *kind, double h)
{
    const double start = 0.5;
    ellipsoid_options options = unit_body(kind->motion, 0.1);
    ellipsoid_model model = test_model(&options);
    oscillation flow = {
        .flow.u = {0.3, -0.2, 0.5}, .vortices = {1, 1}, .frequency = 2};
    ellipsoid_surroundings around = in_flow(&flow);
    const ellipsoid_state s = test_vortex_state(&model, &flow.vortices);
    ellipsoid_state end = s, exact;
    ellipsoid_controller controller = {.step = h};
    ellipsoid_statistics statistics = {0};
    double t = start;

    around.force = kind->force;
    assert_int_equal(ellipsoid_advance(
                         &(ellipsoid_member){&model, &around, &end, &controller,
                                             NULL, NULL, &statistics},
                         &t, start + h, stop),
                     ELLIPSOID_STOPPED);
    assert_near(t, start + h, 0);
    assert_int_equal(statistics.accepted, 1);
    options.tolerance = 1e-14;
    model = test_model(&options);
    around.force = NULL;
    exact = advance(&model, &around, s, start, start + h);
    return test_difference(&end, &exact);
}

/* The error of a step falls with a power of its length that is one above the
   method's order. Without df/dt a Rosenbrock step has the order one. */
static void check_order(const step_kind *kind, double order)
{
    const test_errors a = step_error(kind, 0.08);
    const test_errors b = step_error(kind, 0.04);

    print_message("# order of a step: x %.2f, q %.2f\n", log2(a.x / b.x),
                  log2(a.q / b.q));
    assert_true(log2(a.x / b.x) >= order + 0.7);
    assert_true(log2(a.q / b.q) >= order + 0.7);
    /* and by no method of a higher order */
    assert_true(log2(a.q / b.q) < order + 1.3);
}

static void test_order(void **unused)
{
    const step_kind kinds[] = {
        {ELLIPSOID_MOTION_INERTIAL, NULL},
        {ELLIPSOID_MOTION_INERTIALESS, NULL},
        {ELLIPSOID_MOTION_INERTIALESS, no_force},
    };
    const double order[] = {4, 4, 4};

    (void)unused;
    for (size_t n = 0; n < sizeof(kinds) / sizeof(kinds[0]); n++)
    {
        check_order(&kinds[n], order[n]);
    }
}

/* The stage times are the row sums of the coefficients: alpha_i and gamma_i of
   Hairer & Wanner II, section IV.7, as y' = 1 and y = t show. */
static void test_stage_times(void **unused)
{
    const ellipsoid_rosenbrock_table *m = &ellipsoid_rosenbrock_set;
    double k[ELLIPSOID_STAGES];

    (void)unused;
    for (int i = 0; i < ELLIPSOID_STAGES; i++)
    {
        double alpha = 0, sum = 1;

        for (int j = 0; j < i; j++)
        {
            alpha += m->a[i][j] * k[j];
            sum += m->c[i][j] * k[j];
        }
        k[i] = m->gamma * sum;
        assert_near(m->alpha[i], alpha, 2e-15);
        assert_near(m->gamma_sum[i], k[i], 2e-15);
        assert_true(i == 0
                    || m->alpha[m->in_time[i]] >= m->alpha[m->in_time[i - 1]]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_uniform_flow), cmocka_unit_test(test_shear_flow),
        cmocka_unit_test(test_field),        cmocka_unit_test(test_times),
        cmocka_unit_test(test_given_time),   cmocka_unit_test(test_order),
        cmocka_unit_test(test_stage_times),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
