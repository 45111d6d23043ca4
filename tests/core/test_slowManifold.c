/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    test_slowManifold.c - the thirteen equations by explicit steps on their slow
    manifold: against Rosenbrock steps and an integration in 80 bits, the order
    of what the manifold leaves out and of the steps, and what acts on a cell.
*/
#include "manifoldTest.h"

/* --------------------------------------------------------- in 80 bits */

typedef long double wide;

/* The thirteen equations for FLOW_CENTRE without buoyancy, written down again;
   the vortices in x1 and x2 as in flowTest.h. Inputs are u, x, omega, q. */
static void wide_rhs(const run *r, const wide y[13], wide d[13])
{
    const ellipsoid_model *m = &r->model;
    const wide k = r->flow.k, a = r->flow.speed;
    const wide sx = sinl(k * y[3]), cx = cosl(k * y[3]);
    const wide sy = sinl(k * y[4]), cy = cosl(k * y[4]);
    const wide sz = sinl(k * y[5]), cz = cosl(k * y[5]);
    const wide v[3] = {a * (sx * cy + cz), -a * (cx * sy - sz / 2),
                       a * (sx / 2 + 0.3 * cy)};
    const wide g[3][3] = {
        {a * k * cx * cy, -a * k * sx * sy, -a * k * sz},
        {a * k * sx * sy, -a * k * cx * cy, a * k * cz / 2},
        {a * k * cx / 2, -a * (wide)0.3 * k * sy, 0}};
    const wide *q = y + 9, *w = y + 6;
    const wide e[3] = {q[0], q[1], q[2]}, n = q[3];
    const wide ee = e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
    wide rot[3][3], force[3] = {0, 0, 0}, body[3][3];

    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            rot[i][j] = 2 * e[i] * e[j] + (i == j ? n * n - ee : 0);
        }
    }
    for (int i = 0; i < 3; i++)
    {
        const int j = (i + 1) % 3, l = (i + 2) % 3;

        rot[l][j] += 2 * n * e[i];
        rot[j][l] -= 2 * n * e[i];
    }
    for (int i = 0; i < 3; i++)
    {
        wide along = 0;

        for (int s = 0; s < 3; s++)
        {
            along += rot[s][i] * (v[s] - y[s]);
        }
        for (int s = 0; s < 3; s++)
        {
            force[s] += m->viscosity * m->resistance[i] * along * rot[s][i];
        }
        for (int j = 0; j < 3; j++)
        {
            body[i][j] = 0;
            for (int s = 0; s < 3; s++)
            {
                for (int t = 0; t < 3; t++)
                {
                    body[i][j] += rot[s][i] * g[s][t] * rot[t][j];
                }
            }
        }
    }
    for (int i = 0; i < 3; i++)
    {
        const int j = (i + 1) % 3, l = (i + 2) % 3;
        const wide strain = (body[j][l] + body[l][j]) / 2;
        const wide spin = (body[l][j] - body[j][l]) / 2;
        wide push = 0;

        for (int s = 0; s < 3; s++)
        {
            push += g[i][s] * v[s];
        }
        d[i] = (force[i] + m->fluid_mass * push) / m->mass;
        d[3 + i] = y[i];
        d[6 + i] = (m->viscosity * m->rotation_resistance[i]
                        * (m->strain_factor[i] * strain + spin - w[i])
                    + ((wide)m->inertia[j] - m->inertia[l]) * w[j] * w[l])
                 / m->inertia[i];
        d[9 + i] = (n * w[i] + e[j] * w[l] - e[l] * w[j]) / 2;
    }
    d[12] = -(e[0] * w[0] + e[1] * w[1] + e[2] * w[2]) / 2;
}

/* Kutta's classical method; steps far below the shortest relaxation time. */
static void wide_advance(run *r, double end, int steps)
{
    const wide h = (wide)end / steps;
    wide y[13], k[4][13], at[13];

    for (int n = 0; n < 13; n++)
    {
        y[n] = ((const double *)&r->state)[n];
    }
    for (int step = 0; step < steps; step++)
    {
        wide_rhs(r, y, k[0]);
        for (int s = 1; s < 4; s++)
        {
            for (int n = 0; n < 13; n++)
            {
                at[n] = y[n] + (s < 3 ? h / 2 : h) * k[s - 1][n];
            }
            wide_rhs(r, at, k[s]);
        }
        for (int n = 0; n < 13; n++)
        {
            y[n] += h / 6 * (k[0][n] + 2 * k[1][n] + 2 * k[2][n] + k[3][n]);
        }
    }
    for (int n = 0; n < 13; n++)
    {
        ((double *)&r->state)[n] = (double)y[n];
    }
    ellipsoid_normalise(r->state.q);
}

/*
    After 0.5 ms: Rosenbrock steps at 1e-12 agree with the reference to 1e-9
    (the former's error); the manifold at 1e-6 to 1e-6, and to a tenth of what
    inertialess motion leaves out, or it would not be the thirteen equations.
*/
static void test_against_80_bits(void **unused)
{
    static run reference, tight, loose, without;
    const double end = 5e-4;

    (void)unused;
    begin(&reference, ELLIPSOID_INTEGRATOR_ROSENBROCK, 1e-6, 6e4);
    wide_advance(&reference, end, 100000);
    begin(&tight, ELLIPSOID_INTEGRATOR_ROSENBROCK, 1e-12, 6e4);
    assert_ok(go(&tight, end));
    begin(&loose, ELLIPSOID_INTEGRATOR_SLOW_MANIFOLD, 1e-6, 6e4);
    assert_ok(go(&loose, end));
    begin(&without, ELLIPSOID_INTEGRATOR_ROSENBROCK, 1e-12, 6e4);
    without.options.motion = ELLIPSOID_MOTION_INERTIALESS;
    without.model = test_model(&without.options);
    assert_ok(go(&without, end));
    print_message("# from 80 bits: Rosenbrock %.1e, manifold %.1e,"
                  " inertialess %.1e\n",
                  distance(&tight, &reference), distance(&loose, &reference),
                  distance(&without, &reference));
    assert_true(loose.explicit_steps > 0);
    assert_true(distance(&tight, &reference) < 1e-9);
    assert_true(distance(&loose, &reference) < 1e-6);
    assert_true(distance(&loose, &reference)
                < 0.1 * distance(&without, &reference));
}

/* ------------------------------------------------- what it leaves out */

/* u and omega on the manifold, at the pose of a cell that has been on it for
   long, less what they are. */
static test_errors off_manifold(double density)
{
    static run r;
    ellipsoid_evaluation point;
    ellipsoid_cell cell;
    ellipsoid_group g;

    begin(&r, ELLIPSOID_INTEGRATOR_ROSENBROCK, 1e-12, 3e5);
    r.options.density = density;
    r.model = test_model(&r.options);
    assert_ok(go(&r, 2e-4));
    cell = (ellipsoid_cell){.model = &r.model,
                            .surroundings = r.around,
                            .statistics = &r.statistics,
                            .length = length,
                            .rate = 1 / r.model.relaxation_time,
                            .rotation_rate =
                                1 / r.model.rotation_relaxation_time,
                            .inertial = 1};
    g = (ellipsoid_group){.count = 1, .inertial = 1, .cell = &cell};
    point.state = r.state;
    assert_ok(ellipsoid_manifold_evaluate(&g, 0, &point));
    assert_int_equal(g.left_manifold, 0);
    return test_difference(&point.state, &r.state);
}

/* The next order: in proportion to the square of the relaxation time, that is,
   of the density. 3 %: the order after that, and the reference's error. */
static void test_order_of_manifold(void **unused)
{
    const test_errors a = off_manifold(10400), b = off_manifold(1040);

    (void)unused;
    print_message("# off the manifold: u %.2e, %.2e m/s, omega %.2e, %.2e "
                  "rad/s\n",
                  a.u, b.u, a.omega, b.omega);
    assert_relative(a.u / b.u, 100, 0.03);
    assert_relative(a.omega / b.omega, 100, 0.03);
}

/* ------------------------------------------------------------- the steps */

/* Equal steps: the distance from those an eighth as long. */
static double error_of_steps(int piecewise, int count)
{
    static run r[2];

    for (int n = 0; n < 2; n++)
    {
        begin(&r[n], ELLIPSOID_INTEGRATOR_SLOW_MANIFOLD, 0.1, 3e5);
        r[n].around.piecewise = piecewise;
        r[n].options.maximum_step = 4e-3 / (n ? 8 * count : count);
        r[n].options.initial_step = r[n].options.maximum_step;
        r[n].model = test_model(&r[n].options);
        assert_ok(go(&r[n], 4e-3));
        assert_int_equal(r[n].rosenbrock_steps, 0);
    }
    return distance(&r[0], &r[1]);
}

/* Order 5, and 4 where the gradient is said to jump; below errors of 1e-6 the
   course of inertia's part, of order 2, counts. */
static void test_order_of_steps(void **unused)
{
    const double fifth = error_of_steps(0, 10) / error_of_steps(0, 20);
    const double fourth = error_of_steps(1, 20) / error_of_steps(1, 40);
    const double second = error_of_steps(0, 160) / error_of_steps(0, 320);

    (void)unused;
    print_message("# orders %.2f, %.2f; of inertia's course %.2f\n",
                  log2(fifth), log2(fourth), log2(second));
    assert_near(log2(fifth), 5, 0.4);
    assert_near(log2(fourth), 4, 0.6);
    assert_near(log2(second), 2, 0.2);
}

/* The state in the middle of a step against that of a run which ends there. */
typedef struct middle
{
    run own;
    double worst;
} middle;

static int look_inside(void *context, const ellipsoid_step *step)
{
    static run other;
    middle *m = context;
    const double t = 0.5 * (step->start + step->end);
    ellipsoid_state inside;

    begin(&other, ELLIPSOID_INTEGRATOR_SLOW_MANIFOLD, 1e-8, 6e4);
    other.state = step->before;
    other.t = step->start;
    assert_ok(go(&other, t));
    ellipsoid_step_state(step, t, &inside);
    m->worst =
        fmax(m->worst,
             test_distance(inside.x, other.state.x, 3) / length
                 + test_distance(inside.q, other.state.q, 4)
                 /* velocities of order one less: by what they do in a step */
                 + 0.01 * (step->end - step->start)
                       * (test_distance(inside.u, other.state.u, 3) / length
                          + test_distance(inside.omega, other.state.omega, 3)));
    return 0;
}

/* Hermite's cubic of the 3/8 rule is of order 3, one below the step. */
static void check_dense(int piecewise, double allowed)
{
    static middle m;

    m.worst = 0;
    begin(&m.own, ELLIPSOID_INTEGRATOR_SLOW_MANIFOLD, 1e-6, 6e4);
    m.own.around.piecewise = piecewise;
    assert_ok(ellipsoid_advance(
        &(ellipsoid_member){&m.own.model, &m.own.around, &m.own.state,
                            &m.own.controller, &m.own.cache, &m,
                            &m.own.statistics},
        &m.own.t, 5e-3, look_inside));
    print_message("# dense output: %.1e\n", m.worst);
    assert_true(m.worst > 0 && m.worst < allowed);
}

static void test_dense(void **unused)
{
    (void)unused;
    check_dense(0, 1e-5);
    check_dense(1, 1e-5);
}

/* ----------------------------------------------- what acts on the cell */

/* Both ways to the same end, and whether Rosenbrock steps were taken in the
   first one after 1e-5 s. */
static double apart(const run *from, double end, int *rosenbrock)
{
    static run r[2];
    long early;

    for (int n = 0; n < 2; n++)
    {
        r[n] = *from;
        r[n].around.flow_context = &r[n].flow;
        if (n)
        {
            r[n].options.integrator = ELLIPSOID_INTEGRATOR_ROSENBROCK;
            r[n].options.tolerance = 1e-11;
        }
        r[n].model = test_model(&r[n].options);
    }
    assert_ok(go(&r[0], 1e-5));
    early = r[0].statistics.jacobians;
    assert_ok(go(&r[0], end));
    *rosenbrock = r[0].statistics.jacobians > early;
    assert_ok(go(&r[1], end));
    return distance(&r[0], &r[1]);
}

static int field(void *context, double t, const double x[3], double e[3],
                 double (*jacobian)[3])
{
    (void)context, (void)t;
    for (int i = 0; i < 3; i++)
    {
        e[i] = 1e4 * sin(6e4 * x[(i + 1) % 3]);
        if (jacobian)
        {
            jacobian[i][(i + 1) % 3] = 6e8 * cos(6e4 * x[(i + 1) % 3]);
        }
    }
    return 0;
}

/* Whatever has no callback for forces is in the differences: buoyancy, a charge
   in a field, a constant torque, grad p, the flow over the body. */
static void test_forces(void **unused)
{
    static run r;
    int rosenbrock;

    (void)unused;
    begin(&r, ELLIPSOID_INTEGRATOR_SLOW_MANIFOLD, 1e-6, 6e4);
    r.options.buoyancy = 1;
    r.options.charge = 1e-15;
    r.options.external_torque[1] = 1e-19;
    r.around.field = field;
    assert_true(apart(&r, 2e-3, &rosenbrock) < 5e-6 && !rosenbrock);
    r.options.flow_at = ELLIPSOID_FLOW_BODY;
    r.options.pressure_gradient = ELLIPSOID_PRESSURE_GRADP;
    assert_true(apart(&r, 2e-3, &rosenbrock) < 5e-6 && !rosenbrock);
}

/* A dipole is stiff: as without the manifold, to the last bit. */
static void test_stiff_forces(void **unused)
{
    static run r[2];

    (void)unused;
    for (int n = 0; n < 2; n++)
    {
        begin(&r[n],
              n ? ELLIPSOID_INTEGRATOR_ROSENBROCK
                : ELLIPSOID_INTEGRATOR_SLOW_MANIFOLD,
              1e-6, 6e4);
        r[n].options.dipole[1] = 1e-20;
        r[n].options.electric_field[0] = 1e3;
        r[n].model = test_model(&r[n].options);
        assert_ok(go(&r[n], 1e-3));
    }
    assert_memory_equal(&r[0].state, &r[1].state, sizeof(r[0].state));
    assert_int_equal(r[0].statistics.rhs, r[1].statistics.rhs);
}

/* Noise in long intervals and in such as end before velocities have decayed. */
static void test_noise(void **unused)
{
    static run r;
    int rosenbrock;
    double far;

    (void)unused;
    begin(&r, ELLIPSOID_INTEGRATOR_SLOW_MANIFOLD, 1e-5, 6e4);
    r.options.brownian = 1;
    r.options.noise_interval = 1e-3;
    far = apart(&r, 5e-3, &rosenbrock);
    print_message("# intervals of 1e-3 s: %.1e\n", far);
    assert_true(far < 1e-4 && !rosenbrock);
    r.options.noise_interval = 1e-6;
    far = apart(&r, 2e-5, &rosenbrock);
    print_message("# intervals of 1e-6 s: %.1e\n", far);
    assert_true(far < 1e-4 && rosenbrock);
}

/* The vortices times 1 + sin(w t)/2, and when they were asked for. */
typedef struct beating
{
    test_vortices vortices;
    double first, last;
} beating;

static int beating_flow(void *context, double t, const double x[3],
                        int derivatives, ellipsoid_flow_sample *f)
{
    static const double w = 1000;
    beating *b = context;
    const double now = 1 + 0.5 * sin(w * t);

    b->first = fmin(b->first, t);
    b->last = fmax(b->last, t);
    test_vortex_flow(&b->vortices, t, x, derivatives, f);
    for (int i = 0; i < 3; i++)
    {
        f->local_acceleration[i] = 0.5 * w * cos(w * t) * f->velocity[i];
    }
    for (size_t n = 0; n < sizeof(*f) / sizeof(double); n++)
    {
        double *value = (double *)f + n;
        const size_t at = n * sizeof(double);

        if (at < offsetof(ellipsoid_flow_sample, local_acceleration)
            || at >= offsetof(ellipsoid_flow_sample, velocity_jacobian))
        {
            *value *= now;
        }
    }
    return 0;
}

/* Nothing is asked for outside the run, and the flow's own change counts. */
static void test_unsteady_flow(void **unused)
{
    static run r[2];
    beating flow[2];

    (void)unused;
    for (int n = 0; n < 2; n++)
    {
        begin(&r[n],
              n ? ELLIPSOID_INTEGRATOR_ROSENBROCK
                : ELLIPSOID_INTEGRATOR_SLOW_MANIFOLD,
              n ? 1e-10 : 1e-6, 6e4);
        flow[n] = (beating){r[n].flow, HUGE_VAL, -HUGE_VAL};
        r[n].around.flow = beating_flow;
        r[n].around.flow_context = &flow[n];
        r[n].around.unsteady = 1;
        r[n].t = 0.3;
        for (int part = 1; part <= 20; part++)
        {
            flow[n].first = HUGE_VAL;
            flow[n].last = -HUGE_VAL;
            const double start = r[n].t, end = 0.3 + part * 1e-4;

            assert_ok(go(&r[n], end));
            assert_true(flow[n].first == start && flow[n].last == end);
        }
    }
    print_message("# unsteady: %.1e, %d Rosenbrock steps\n",
                  distance(&r[0], &r[1]), r[0].rosenbrock_steps);
    assert_int_equal(r[0].rosenbrock_steps, 0);
    assert_true(distance(&r[0], &r[1]) < 5e-6);
}

/* Two cells in common steps, far apart: each as alone. */
static void test_group(void **unused)
{
    static run r[2], alone;
    void *memory = test_malloc(ellipsoid_group_size(2));
    ellipsoid_member members[2];
    double t = 0;
    int which;

    (void)unused;
    for (int n = 0; n < 2; n++)
    {
        begin(&r[n], ELLIPSOID_INTEGRATOR_SLOW_MANIFOLD, 1e-6, 6e4);
        r[n].options.contact = 1;
        r[n].model = test_model(&r[n].options);
        r[n].state.x[2] += 2e-5 * n;
        members[n] = (ellipsoid_member){&r[n].model,      &r[n].around,
                                        &r[n].state,      &r[n].controller,
                                        &r[n].cache,      NULL,
                                        &r[n].statistics};
    }
    assert_ok(
        ellipsoid_advance_group(2, members, &t, 2e-3, NULL, memory, &which));
    test_free(memory);
    begin(&alone, ELLIPSOID_INTEGRATOR_SLOW_MANIFOLD, 1e-7, 6e4);
    assert_ok(go(&alone, 2e-3));
    assert_int_equal(r[0].statistics.jacobians, 0);
    assert_true(distance(&r[0], &alone) < 5e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_against_80_bits),
        cmocka_unit_test(test_order_of_manifold),
        cmocka_unit_test(test_order_of_steps),
        cmocka_unit_test(test_dense),
        cmocka_unit_test(test_forces),
        cmocka_unit_test(test_stiff_forces),
        cmocka_unit_test(test_noise),
        cmocka_unit_test(test_unsteady_flow),
        cmocka_unit_test(test_group),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
