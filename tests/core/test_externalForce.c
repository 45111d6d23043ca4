/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_externalForce.c - an external force and torque by callback against
    closed forms, and its derivatives against differences.
*/
#include "coreTest.h"

#include <complex.h>

enum
{
    SIZE = ELLIPSOID_STATE_SIZE
};

/*
    F = -stiffness (x - centre) - friction u + push,
    T^ = align (n.e) R^T (n x e) - turning w^ with the long axis n and e = x2.
*/
typedef struct trap
{
    double stiffness, friction, align, turning;
    double centre[3], push[3];
    int answer;
} trap;

static int trap_force(void *context, double t, const ellipsoid_state *state,
                      double force[3], double torque[3],
                      ellipsoid_wrench_jacobian *jacobian)
{
    const trap *p = context;
    const double opposite[4] = {state->q[0], state->q[1], state->q[2],
                                -state->q[3]};
    double axis[3][3], d[4][3][3];

    (void)t;
    ellipsoid_rotation_inline(opposite, axis);
    ellipsoid_axis_derivatives(state->q, d);
    for (int i = 0; i < 3; i++)
    {
        force[i] = p->push[i] - p->stiffness * (state->x[i] - p->centre[i]);
        if (p->friction > 0)
        {
            force[i] -= p->friction * state->u[i];
            torque[i] -= p->turning * state->omega[i];
        }
    }
    /* (0, 1, 0) x (e1, e2, e3), e_i = r_i . e */
    torque[0] += p->align * axis[1][1] * axis[2][1];
    torque[2] -= p->align * axis[1][1] * axis[0][1];
    for (int i = 0; jacobian && i < 3; i++)
    {
        jacobian->force_x[i][i] = -p->stiffness;
        jacobian->force_u[i][i] = -p->friction;
        jacobian->torque_omega[i][i] = -p->turning;
    }
    for (int n = 0; jacobian && n < 4; n++)
    {
        jacobian->torque_q[0][n] =
            p->align * (d[n][1][1] * axis[2][1] + axis[1][1] * d[n][2][1]);
        jacobian->torque_q[2][n] =
            -p->align * (d[n][1][1] * axis[0][1] + axis[1][1] * d[n][0][1]);
    }
    return p->answer;
}

static ellipsoid_options body(ellipsoid_motion motion, double tolerance)
{
    ellipsoid_options o = test_free_cell();

    o.density = 3;
    o.fluid_density = 1;
    o.kinematic_viscosity = 0.5;
    ellipsoid_set(o.semi_axes, 0.8, 1.5, 0.5);
    o.pressure_gradient = ELLIPSOID_PRESSURE_NONE;
    o.bead_radius = 0.2;
    o.motion = motion;
    o.tolerance = tolerance;
    return o;
}

static ellipsoid_surroundings around_of(trap *p, test_quadratic *flow)
{
    return (ellipsoid_surroundings){.flow = flow ? test_quadratic_flow : NULL,
                                    .flow_context = flow,
                                    .force = trap_force,
                                    .force_context = p,
                                    .force_depends_on_velocity =
                                        p->friction > 0};
}

static ellipsoid_status advance(const ellipsoid_model *model,
                                const ellipsoid_surroundings *around,
                                ellipsoid_state *s, double end)
{
    ellipsoid_controller controller = {0};
    ellipsoid_statistics statistics = {0};
    double t = 0;

    return ellipsoid_advance(&(ellipsoid_member){model, around, s, &controller,
                                                 NULL, NULL, &statistics},
                             &t, end, NULL);
}

/* ------------------------------------------------------------ closed forms */

/*
    A harmonic trap in a fluid at rest: along each body axis
    m x'' + mu K x' + k x = 0, or without inertia x' = -k x/(mu K). No torque
    acts, so the orientation stays as it is, here a general one.
*/
static double trapped(const ellipsoid_model *m, int i, double k, double t)
{
    const double z = m->viscosity * m->resistance[i];

    if (m->options.motion == ELLIPSOID_MOTION_INERTIALESS)
    {
        return exp(-k / z * t);
    }

    const double complex root = csqrt(z * z / 4 - m->mass * k) / m->mass;
    const double complex a = -z / (2 * m->mass) + root;
    const double complex b = -z / (2 * m->mass) - root;

    return creal((a * cexp(b * t) - b * cexp(a * t)) / (a - b));
}

static void check_trap(ellipsoid_motion motion, double stiffness)
{
    const ellipsoid_options options = body(motion, 1e-9);
    const ellipsoid_model model = test_model(&options);
    test_quadratic still = {.answer = 0};
    trap p = {.stiffness = stiffness, .centre = {3, -2, 1}};
    const ellipsoid_surroundings around = around_of(&p, &still);
    const double begin[3] = {0.4, -0.7, 0.5}; /* body axes, from the centre */
    uint64_t seed = 4;
    ellipsoid_state s = {.u = {0}};
    double r[3][3], from[3], ends[3];

    test_orientation(&seed, s.q);
    ellipsoid_rotation(s.q, r);
    ellipsoid_product(r, begin, s.x);
    ellipsoid_add(s.x, p.centre);
    assert_ok(advance(&model, &around, &s, 2));
    ellipsoid_difference(s.x, p.centre, from);
    ellipsoid_to_body(r, from, ends);
    for (int i = 0; i < 3; i++)
    {
        /* 1e-9 of 1.5 a step, some hundred steps */
        assert_near(ends[i], begin[i] * trapped(&model, i, stiffness, 2), 1e-7);
    }
}

static void test_trap(void **unused)
{
    (void)unused;
    check_trap(ELLIPSOID_MOTION_INERTIALESS, 3);
    check_trap(ELLIPSOID_MOTION_INERTIALESS, 1e6); /* stiff */
    check_trap(ELLIPSOID_MOTION_INERTIAL, 3);
    check_trap(ELLIPSOID_MOTION_INERTIAL, 300); /* swings */
}

/* Without fluid the trap is a spring: x = cos(w t), and x2 decays by nothing. */
static void test_vacuum(void **unused)
{
    const ellipsoid_options options = body(ELLIPSOID_MOTION_INERTIAL, 1e-9);
    const ellipsoid_model model = test_model(&options);
    trap p = {.stiffness = 4 * model.mass};
    const ellipsoid_surroundings around = around_of(&p, NULL);
    ellipsoid_state s = {.x = {1, 0, 0}, .q = {0, 0, 0, 1}};

    (void)unused;
    assert_ok(advance(&model, &around, &s, 10));
    assert_near(s.x[0], cos(20), 1e-6);
    assert_near(s.u[0], -2 * sin(20), 2e-6);
}

/* An aligning torque -align sin p cos p about x3, p between long axis and x2,
   against mu C: without inertia tan p = tan p_0 exp(-align t/(mu C)). */
static void test_alignment(void **unused)
{
    const ellipsoid_options options = body(ELLIPSOID_MOTION_INERTIALESS, 1e-9);
    const ellipsoid_model model = test_model(&options);
    const double c = model.viscosity * model.rotation_resistance[2];
    test_quadratic still = {.answer = 0};
    trap p = {.align = c};
    const ellipsoid_surroundings around = around_of(&p, &still);
    ellipsoid_state s = {.q = {0, 0, sin(0.6), cos(0.6)}};

    (void)unused;
    for (int n = 1; n <= 3; n++)
    {
        double axis[3];

        assert_ok(advance(&model, &around, &s, 1));
        test_long_axis(&s, axis);
        assert_near(-axis[0] / axis[1], tan(1.2) * exp(-n), 1e-7);
    }
}

/* A force -b u and a torque -c w add to the resistance: of a body in a uniform
   flow and a rotation, without inertia u = z/(z + b) u_f; the third axis. */
static void check_friction(ellipsoid_motion motion)
{
    const ellipsoid_options options = body(motion, 1e-9);
    const ellipsoid_model model = test_model(&options);
    const double z = model.viscosity * model.resistance[2];
    const double c = model.viscosity * model.rotation_resistance[2];
    test_quadratic flow = {.u = {0, 0, 2}};
    trap p = {.friction = 3, .turning = 5};
    const ellipsoid_surroundings around = around_of(&p, &flow);
    ellipsoid_state s = {.q = {0, 0, 0, 1}}, d = s;

    flow.g[0][1] = -0.7;
    flow.g[1][0] = 0.7;
    if (motion == ELLIPSOID_MOTION_INERTIALESS)
    {
        assert_ok(ellipsoid_rhs(&model, &around, &s, NULL, &d));
        assert_near(d.x[2], 2 * z / (z + 3), 1e-10);
        assert_near(d.q[2], 0.35 * c / (c + 5), 1e-10);
    }
    assert_ok(advance(&model, &around, &s, 40)); /* very many relaxations */
    assert_near(s.u[2], 2 * z / (z + 3), 1e-8);
    assert_near(s.omega[2], 0.7 * c / (c + 5), 1e-8);
    d = s;
    assert_ok(ellipsoid_balance(&model, &around, &d, NULL));
    assert_near(d.u[2], 2 * z / (z + 3), 1e-10);
}

static void test_dissipative(void **unused)
{
    (void)unused;
    check_friction(ELLIPSOID_MOTION_INERTIALESS);
    check_friction(ELLIPSOID_MOTION_INERTIAL);
}

/* Two cells, each a single bead, pressed against one another by opposite
   forces: at rest the contact's force is that of either (Hertz). */
static void check_group(ellipsoid_motion motion)
{
    static ellipsoid_contact contact[2];
    ellipsoid_options options = body(motion, 1e-6);
    trap p[2] = {{.push = {0.5, 0, 0}}, {.push = {-0.5, 0, 0}}};
    test_quadratic still = {.answer = 0};
    ellipsoid_surroundings around[2] = {around_of(&p[0], &still),
                                        around_of(&p[1], &still)};
    ellipsoid_state s[2] = {{.x = {-1, 0, 0}, .q = {0, 0, 0, 1}},
                            {.x = {1, 0, 0}, .q = {0, 0, 0, 1}}};
    ellipsoid_controller controller[2] = {{0, 0}};
    ellipsoid_statistics statistics[2] = {{0}};
    ellipsoid_model model;
    ellipsoid_member members[2];
    void *memory = test_malloc(ellipsoid_group_size(2));
    double t = 0;
    int which;

    options.contact = 1;
    ellipsoid_set(options.semi_axes, 0.5, 0.5, 0.5);
    options.bead_count = 1;
    options.bead_radius = 0.4;
    options.contact_modulus = 1e4;
    model = test_model(&options);
    for (int c = 0; c < 2; c++)
    {
        members[c] = (ellipsoid_member){&model,         &around[c], &s[c],
                                        &controller[c], NULL,       &contact[c],
                                        &statistics[c]};
        around[c].id = (uint32_t)c;
    }
    assert_ok(
        ellipsoid_advance_group(2, members, &t, 200, NULL, memory, &which));
    test_free(memory);

    /* r_b/2, E/2; F = 4/3 E sqrt(r) d^(3/2) */
    const double stiffness = 4.0 / 3 * 0.5e4 * sqrt(0.2);
    const double overlap = pow(0.5 / stiffness, 2.0 / 3);

    assert_near(s[1].x[0] - s[0].x[0], 0.8 - overlap, 1e-5);
    assert_near(s[1].x[0] + s[0].x[0], 0, 1e-5);
    assert_near(ellipsoid_length(s[0].u), 0, 1e-5);
}

static void test_group(void **unused)
{
    (void)unused;
    check_group(ELLIPSOID_MOTION_INERTIALESS);
    check_group(ELLIPSOID_MOTION_INERTIAL);
}

/* ------------------------------------------------------------- derivatives */

/* Polynomials of all unknowns: each entry of the Jacobian is of its own. */
static int general_force(void *context, double t, const ellipsoid_state *state,
                         double force[3], double torque[3],
                         ellipsoid_wrench_jacobian *jacobian)
{
    const double *c = context;
    double y[SIZE];
    int next = 0;

    (void)t;
    memcpy(y, state, sizeof(y));
    for (int row = 0; row < 6; row++)
    {
        double *to = row < 3 ? &force[row] : &torque[row - 3];

        for (int n = 0; n < SIZE; n++)
        {
            const double a = c[next++], b = c[next++];

            *to += (a + 0.5 * b * y[n]) * y[n];
            if (jacobian)
            {
                const double slope = a + b * y[n];
                const int i = row % 3;

                *(n < AT_X       ? row < 3 ? &jacobian->force_u[i][n]
                                           : &jacobian->torque_u[i][n]
                        : n < AT_OMEGA ? row < 3 ? &jacobian->force_x[i][n - AT_X]
                                                 : &jacobian->torque_x[i][n - AT_X]
                        : n < AT_Q ? row < 3
                                       ? &jacobian->force_omega[i][n - AT_OMEGA]
                                       : &jacobian->torque_omega[i][n - AT_OMEGA]
                        : row < 3 ? &jacobian->force_q[i][n - AT_Q]
                                 : &jacobian->torque_q[i][n - AT_Q]) = slope;
            }
        }
    }
    return 0;
}

/* Central differences of fourth order; without drag each term is quadratic in
   one unknown, so that they are exact but for rounding over the step. */
static void test_jacobian(void **unused)
{
    uint64_t seed = 6;
    double c[6 * SIZE * 2], y[SIZE], jacobian[SIZE][SIZE];
    const double h = 0.1;
    ellipsoid_options options = body(ELLIPSOID_MOTION_INERTIAL, 1e-6);
    const ellipsoid_surroundings around = {.force = general_force,
                                           .force_context = c,
                                           .force_depends_on_velocity = 1};
    const ellipsoid_model model = test_model(&options);
    ellipsoid_state s;

    (void)unused;
    for (size_t n = 0; n < sizeof(c) / sizeof(c[0]); n++)
    {
        c[n] = test_signed(&seed);
    }
    for (int n = 0; n < SIZE; n++)
    {
        y[n] = test_signed(&seed);
    }
    memcpy(&s, y, sizeof(s));
    assert_ok(ellipsoid_jacobian(&model, &around, &s, NULL, jacobian));
    for (int j = 0; j < SIZE; j++)
    {
        double f[2][SIZE];

        for (int side = 0; side < 2; side++)
        {
            double moved[SIZE];
            ellipsoid_state d;

            memcpy(moved, y, sizeof(y));
            moved[j] += side ? h : -h;
            memcpy(&s, moved, sizeof(s));
            assert_ok(ellipsoid_rhs(&model, &around, &s, NULL, &d));
            memcpy(f[side], &d, sizeof(d));
        }
        for (int i = 0; i < SIZE; i++)
        {
            assert_near(jacobian[i][j], (f[1][i] - f[0][i]) / (2 * h), 1e-13);
        }
    }
}

/* ------------------------------------------------------------------ answers */

static void test_answers(void **unused)
{
    const ellipsoid_options options = body(ELLIPSOID_MOTION_INERTIAL, 1e-6);
    const ellipsoid_model model = test_model(&options);
    test_quadratic still = {.answer = 0};
    trap p = {.stiffness = 1};
    const ellipsoid_surroundings around = around_of(&p, &still);
    ellipsoid_state s = {.x = {1, 0, 0}, .q = {0, 0, 0, 1}}, d;
    const ellipsoid_state before = s;

    (void)unused;
    p.answer = -1;
    assert_int_equal(ellipsoid_rhs(&model, &around, &s, NULL, &d),
                     ELLIPSOID_FORCE_FAILED);
    assert_int_equal(advance(&model, &around, &s, 1), ELLIPSOID_FORCE_FAILED);
    assert_memory_equal(&s, &before, sizeof(s));
    p.answer = 1;
    assert_int_equal(ellipsoid_rhs(&model, &around, &s, NULL, &d),
                     ELLIPSOID_STEP_UNDERFLOW);
    p.answer = 0;
    p.push[0] = NAN;
    assert_int_equal(advance(&model, &around, &s, 1), ELLIPSOID_NON_FINITE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_trap),      cmocka_unit_test(test_vacuum),
        cmocka_unit_test(test_alignment), cmocka_unit_test(test_dissipative),
        cmocka_unit_test(test_group),     cmocka_unit_test(test_jacobian),
        cmocka_unit_test(test_answers),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
