/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_equations.c - the right-hand side and its Jacobian.
*/
#include "coreTest.h"
#include "wallMesh.h"

enum
{
    SIZE = ELLIPSOID_STATE_SIZE
};

static double random_about_one(uint64_t *seed)
{
    return pow(10, 0.5 * test_signed(seed));
}

/* A triaxial body of order one in a fluid of order one: every term counts. */
static ellipsoid_model random_body(uint64_t *seed)
{
    ellipsoid_options o = test_free_cell();

    o.buoyancy = 1;
    o.density = random_about_one(seed);
    o.fluid_density = random_about_one(seed);
    o.kinematic_viscosity = random_about_one(seed);
    for (int i = 0; i < 3; i++)
    {
        o.semi_axes[i] = random_about_one(seed);
        o.gravity[i] = test_signed(seed);
        o.external_force[i] = test_signed(seed);
        o.external_torque[i] = test_signed(seed);
        o.dipole[i] = test_signed(seed);
        o.electric_field[i] = test_signed(seed);
    }
    o.charge = test_signed(seed);
    return test_model(&o);
}

static test_quadratic random_flow(uint64_t *seed)
{
    test_quadratic f = {.answer = 0};

    for (int i = 0; i < 3; i++)
    {
        f.u[i] = test_signed(seed);
        f.pressure_gradient[i] = test_signed(seed);
        for (int j = 0; j < 3; j++)
        {
            f.g[i][j] = test_signed(seed);
            f.pressure_jacobian[i][j] = test_signed(seed);
            for (int k = 0; k <= j; k++)
            {
                f.h[i][j][k] = f.h[i][k][j] = test_signed(seed);
            }
        }
    }
    return f;
}

/* q is not of length one: the polynomials must be right there as well. */
static ellipsoid_state random_state(uint64_t *seed)
{
    ellipsoid_state s;
    const double length = 1 + 0.1 * test_signed(seed);

    for (int i = 0; i < 3; i++)
    {
        s.u[i] = test_signed(seed);
        s.x[i] = test_signed(seed);
        s.omega[i] = test_signed(seed);
    }
    test_orientation(seed, s.q);
    for (int n = 0; n < 4; n++)
    {
        s.q[n] *= length;
    }
    return s;
}

/* E = (x2, x1 x2, x3^2) */
static int curved_field(void *context, double t, const double x[3],
                        double field[3], double (*jacobian)[3])
{
    (void)t;
    (void)context;
    ellipsoid_set(field, x[1], x[0] * x[1], x[2] * x[2]);
    if (jacobian)
    {
        ellipsoid_set(jacobian[0], 0, 1, 0);
        ellipsoid_set(jacobian[1], x[1], x[0], 0);
        ellipsoid_set(jacobian[2], 0, 0, 2 * x[2]);
    }
    return 0;
}

static ellipsoid_surroundings without_walls(test_quadratic *flow)
{
    const ellipsoid_surroundings around = {.flow = flow ? test_quadratic_flow
                                                        : NULL,
                                           .flow_context = flow,
                                           .field = curved_field};

    return around;
}

static void rates(const ellipsoid_model *model, test_quadratic *flow,
                  const double y[SIZE], double f[SIZE])
{
    const ellipsoid_surroundings around = without_walls(flow);
    ellipsoid_state state, derivative;

    memcpy(&state, y, sizeof(state));
    assert_ok(ellipsoid_rhs(model, &around, &state, NULL, &derivative));
    memcpy(f, &derivative, sizeof(derivative));
}

/* Eighth-order central differences; each term is of degree eight at most in one
   variable, for which they are exact but for rounding over the step. */
static void compare_jacobian(const ellipsoid_model *model, test_quadratic *flow,
                             const ellipsoid_state *state)
{
    const ellipsoid_surroundings around = without_walls(flow);
    static const int begin[] = {AT_U, AT_X, AT_OMEGA, AT_Q, SIZE};
    double jacobian[SIZE][SIZE], differences[SIZE][SIZE];
    const double h = 0.01;

    assert_ok(ellipsoid_jacobian(model, &around, state, NULL, jacobian));
    for (int j = 0; j < SIZE; j++)
    {
        for (int i = 0; i < SIZE; i++)
        {
            differences[i][j] = 0;
        }
        for (int p = 1; p <= 4; p++)
        {
            static const double weight[] = {0, 4.0 / 5, -1.0 / 5, 4.0 / 105,
                                            -1.0 / 280};
            double y[SIZE], before[SIZE], after[SIZE];

            memcpy(y, state, sizeof(y));
            y[j] -= p * h;
            rates(model, flow, y, before);
            y[j] += 2 * p * h;
            rates(model, flow, y, after);
            for (int i = 0; i < SIZE; i++)
            {
                differences[i][j] += weight[p] * (after[i] - before[i]) / h;
            }
        }
    }

    for (int row = 0; row < 4; row++)
    {
        for (int column = 0; column < 4; column++)
        {
            double size = 0, error = 0;

            for (int i = begin[row]; i < begin[row + 1]; i++)
            {
                for (int j = begin[column]; j < begin[column + 1]; j++)
                {
                    size = fmax(size, fabs(differences[i][j]));
                    error =
                        fmax(error, fabs(differences[i][j] - jacobian[i][j]));
                }
            }
            /* 1e-7 was asked for; rounding allows 1e-10 of a block and of
               the whole row's values over h where the block vanishes */
            assert_true(error <= 1e-10 * size + 1e-10);
        }
    }
}

static void test_jacobian(void **unused)
{
    uint64_t seed = 9;

    (void)unused;
    for (int n = 0; n < 200; n++)
    {
        ellipsoid_model model = random_body(&seed);
        test_quadratic flow = random_flow(&seed);
        const ellipsoid_state state = random_state(&seed);

        compare_jacobian(&model, &flow, &state);
        model.options.flow_at = ELLIPSOID_FLOW_BODY;
        model = test_model(&model.options);
        compare_jacobian(&model, &flow, &state);
        model.options.pressure_gradient = ELLIPSOID_PRESSURE_GRADP;
        compare_jacobian(&model, &flow, &state);
        model.options.pressure_gradient = ELLIPSOID_PRESSURE_NONE;
        compare_jacobian(&model, &flow, &state);
        model.options.drag = 0;
        compare_jacobian(&model, &flow, &state);
        compare_jacobian(&model, NULL, &state);
    }
}

/* The pressure pushes from high to low: m_p du/dt = -V grad p, to rounding. */
static void test_gradp_pushes_down_the_gradient(void **unused)
{
    ellipsoid_options o = test_paper_options();
    test_quadratic flow = {.pressure_gradient = {3e5, -2e5, 1e5}};
    const ellipsoid_surroundings around = {.flow = test_quadratic_flow,
                                           .flow_context = &flow};
    ellipsoid_state state = {.q = {0, 0, 0, 1}}, slope;

    (void)unused;
    o.drag = 0;
    o.buoyancy = 0;
    o.pressure_gradient = ELLIPSOID_PRESSURE_GRADP;

    const ellipsoid_model model = test_model(&o);

    assert_ok(ellipsoid_rhs(&model, &around, &state, NULL, &slope));
    for (int i = 0; i < 3; i++)
    {
        const double expected =
            -model.volume * flow.pressure_gradient[i] / model.mass;

        assert_near(slope.u[i], expected, 1e-14 * fabs(expected));
    }
}

/*
    The paper's cell pressed 5 to 20 nm into a plate in a shear: the contact's
    part is in its place. Steps of 1e-4 nm and 1e-8 of q; Hertz' law is smooth
    there, rounding of the forces over the step leaves some 1e-6: 1e-5.
*/
static void test_jacobian_in_contact(void **unused)
{
    static ellipsoid_facet_cache cache;
    const ellipsoid_options o = test_paper_options();
    const ellipsoid_model model = test_model(&o);
    test_quadratic flow = test_shear(1000);
    const double corner[3] = {-1e-5, -1e-5, 0};
    const double along[3] = {2e-5, 0, 0}, across[3] = {0, 2e-5, 0};
    wall_mesh mesh;
    uint64_t seed = 12;

    (void)unused;
    wall_mesh_init(&mesh);
    wall_mesh_plane(&mesh, corner, along, across, 1, 1, 0, 0);
    wall_mesh_finish(&mesh);
    for (int n = 0; n < 20; n++)
    {
        const ellipsoid_surroundings around = {.flow = test_quadratic_flow,
                                               .flow_context = &flow,
                                               .walls = wall_mesh_list,
                                               .walls_context = &mesh};
        ellipsoid_state s = {.x = {1e-7, 2e-7, 0}};
        double jacobian[SIZE][SIZE], r[3][3], lowest = 0;

        test_orientation(&seed, s.q);
        ellipsoid_rotation(s.q, r);
        for (int b = 0; b < model.bead_count; b++)
        {
            lowest = fmin(lowest, ellipsoid_dot(r[2], model.bead[b]));
        }
        s.x[2] = o.bead_radius - lowest - 5e-9 - 15e-9 * test_uniform(&seed);
        ellipsoid_facet_cache_clear(&cache);
        assert_ok(ellipsoid_jacobian(&model, &around, &s, &cache, jacobian));
        for (int j = AT_X; j < SIZE; j++)
        {
            const double h = j < AT_OMEGA ? 1e-13 : 1e-8;
            double f[2][SIZE], y[SIZE];

            if (j >= AT_OMEGA && j < AT_Q)
            {
                continue;
            }
            for (int p = 0; p < 2; p++)
            {
                ellipsoid_state moved, derivative;

                memcpy(y, &s, sizeof(y));
                y[j] += p ? h : -h;
                memcpy(&moved, y, sizeof(moved));
                assert_ok(ellipsoid_rhs(&model, &around, &moved, &cache,
                                        &derivative));
                memcpy(f[p], &derivative, sizeof(derivative));
            }
            for (int begin = 0; begin < AT_Q; begin += AT_OMEGA)
            {
                double size = 0, error = 0;

                for (int i = begin; i < begin + 3; i++)
                {
                    size = fmax(size, fabs(jacobian[i][j]));
                    error = fmax(error, fabs((f[1][i] - f[0][i]) / (2 * h)
                                             - jacobian[i][j]));
                }
                assert_true(error <= 1e-5 * size);
            }
        }
    }
    wall_mesh_free(&mesh);
}

/*
    docs/theory, the thirteen equations and the hydrodynamic force and torque,
    term by term with matrices: an independent writing of the same. Rounding.
*/
static void test_written_out(void **unused)
{
    uint64_t seed = 10;

    (void)unused;
    for (int n = 0; n < 200; n++)
    {
        const ellipsoid_model m = random_body(&seed);
        const ellipsoid_options *o = &m.options;
        test_quadratic flow = random_flow(&seed);
        ellipsoid_state s = random_state(&seed);
        double y[SIZE], f[SIZE], r[3][3], body[3][3], field[3], in_body[3];
        ellipsoid_flow_sample u;

        ellipsoid_normalise(s.q);
        memcpy(y, &s, sizeof(y));
        rates(&m, &flow, y, f);
        test_quadratic_flow(&flow, 0, s.x, 0, &u);
        curved_field(NULL, 0, s.x, field, NULL);
        ellipsoid_rotation(s.q, r);
        for (int i = 0; i < 3; i++)
        {
            field[i] += o->electric_field[i];
        }
        for (int i = 0; i < 3; i++)
        {
            in_body[i] =
                r[0][i] * field[0] + r[1][i] * field[1] + r[2][i] * field[2];
        }

        for (int i = 0; i < 3; i++)
        {
            double force = (m.mass - m.fluid_mass) * o->gravity[i]
                         + o->external_force[i] + o->charge * field[i];

            for (int j = 0; j < 3; j++)
            {
                double resistance = 0;

                for (int k = 0; k < 3; k++)
                {
                    resistance += r[i][k] * m.resistance[k] * r[j][k];
                }
                force += m.viscosity * resistance * (u.velocity[j] - s.u[j])
                       + m.fluid_mass * u.gradient[i][j] * u.velocity[j];
                body[i][j] = 0;
                for (int k = 0; k < 3; k++)
                {
                    for (int l = 0; l < 3; l++)
                    {
                        body[i][j] += r[k][i] * u.gradient[k][l] * r[l][j];
                    }
                }
            }
            assert_near(f[i], force / m.mass, 1e-12 * (1 + fabs(f[i])));
            assert_true(f[3 + i] == s.u[i]);
        }
        for (int i = 0; i < 3; i++)
        {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            const double aj2 = o->semi_axes[j] * o->semi_axes[j];
            const double ak2 = o->semi_axes[k] * o->semi_axes[k];
            const double c =
                m.viscosity * m.rotation_resistance[i] / (aj2 + ak2);
            const double strain = (body[j][k] + body[k][j]) / 2;
            const double turn = (body[k][j] - body[j][k]) / 2;
            const double torque =
                c * ((aj2 - ak2) * strain + (aj2 + ak2) * (turn - s.omega[i]))
                + m.inertia[j] * s.omega[j] * s.omega[k]
                - m.inertia[k] * s.omega[k] * s.omega[j] + o->external_torque[i]
                + o->dipole[j] * in_body[k] - o->dipole[k] * in_body[j];

            assert_near(f[6 + i], torque / m.inertia[i],
                        1e-12 * (1 + fabs(f[6 + i])));
        }
    }
}

/* A body that moves and turns with a fluid in rigid rotation has no torque
   and no drag. */
static void test_rigid_rotation(void **unused)
{
    uint64_t seed = 11;

    (void)unused;
    for (int n = 0; n < 100; n++)
    {
        ellipsoid_model m = random_body(&seed);
        test_quadratic flow = {.answer = 0};
        ellipsoid_state s = random_state(&seed);
        ellipsoid_flow_sample u;
        double y[SIZE], f[SIZE], r[3][3], w[3];

        m.options.pressure_gradient = ELLIPSOID_PRESSURE_NONE;
        m.electric = 0;
        ellipsoid_normalise(s.q);
        ellipsoid_rotation(s.q, r);
        for (int i = 0; i < 3; i++)
        {
            m.constant_force[i] = m.options.external_torque[i] = 0;
            m.inertia[i] = 1; /* no gyroscopic torque */
            w[i] = test_signed(&seed);
        }
        for (int i = 0; i < 3; i++)
        {
            flow.g[(i + 1) % 3][(i + 2) % 3] = -w[i];
            flow.g[(i + 2) % 3][(i + 1) % 3] = w[i];
            s.omega[i] = r[0][i] * w[0] + r[1][i] * w[1] + r[2][i] * w[2];
        }
        test_quadratic_flow(&flow, 0, s.x, 0, &u);
        memcpy(s.u, u.velocity, sizeof(s.u));
        memcpy(y, &s, sizeof(y));
        rates(&m, &flow, y, f);
        for (int i = 0; i < 3; i++)
        {
            assert_true(f[i] == 0);
            assert_near(f[6 + i], 0,
                        1e-14 * m.viscosity * m.rotation_resistance[i]);
        }
    }
}

/* What the callback answers comes back as a status. */
static void test_statuses(void **unused)
{
    const ellipsoid_options options = test_free_cell();
    const ellipsoid_model model = test_model(&options);
    test_quadratic flow = test_shear(1);
    const ellipsoid_surroundings around = {.flow = test_quadratic_flow,
                                           .flow_context = &flow};
    const ellipsoid_state state = {.q = {0, 0, 0, 1}};
    ellipsoid_state derivative;
    double jacobian[SIZE][SIZE];

    (void)unused;
    flow.answer = 1;
    assert_int_equal(ellipsoid_rhs(&model, &around, &state, NULL, &derivative),
                     ELLIPSOID_STEP_UNDERFLOW);
    flow.answer = -1;
    assert_int_equal(ellipsoid_rhs(&model, &around, &state, NULL, &derivative),
                     ELLIPSOID_FLOW_FAILED);
    assert_int_equal(
        ellipsoid_jacobian(&model, &around, &state, NULL, jacobian),
        ELLIPSOID_FLOW_FAILED);
    flow.answer = 0;
    flow.g[2][0] = NAN;
    assert_int_equal(ellipsoid_rhs(&model, &around, &state, NULL, &derivative),
                     ELLIPSOID_NON_FINITE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_jacobian),
        cmocka_unit_test(test_gradp_pushes_down_the_gradient),
        cmocka_unit_test(test_jacobian_in_contact),
        cmocka_unit_test(test_written_out),
        cmocka_unit_test(test_rigid_rotation),
        cmocka_unit_test(test_statuses),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
