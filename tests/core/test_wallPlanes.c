/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_wallPlanes.c - the drag near walls made of facets: in the equations, at a
    stagnation point, in slits.
*/
#include <fenv.h>

#include "wallResistanceTest.h"
#include "drag/drag.h"

enum
{
    SIZE = ELLIPSOID_STATE_SIZE
};

/* --------------------------------------------------------------- Jacobian */

/* Of the fourth order, step 1e-5 of the semi-axis and of q: the block's edge
   and corner bend the planes within 1 um. 1e-6 of the block's size, and what
   rounding of the accelerations leaves. */
static int compare_jacobian(const ellipsoid_model *m,
                            const ellipsoid_surroundings *s,
                            const ellipsoid_state *state)
{
    static const double weight[] = {1.0 / 12, -2.0 / 3, 0, 2.0 / 3, -1.0 / 12};
    double jacobian[SIZE][SIZE];
    int bad = 0;

    assert_ok(ellipsoid_jacobian(m, s, state, &cache, jacobian));
    for (int j = 0; j < SIZE; j++)
    {
        const double step = j < AT_X     ? 1e-3
                          : j < AT_OMEGA ? 2e-11
                          : j < AT_Q     ? 1e3
                                         : 1e-5;
        double slope[SIZE] = {0}, largest[SIZE] = {0};

        for (int p = -2; p <= 2; p++)
        {
            double y[SIZE], f[SIZE];
            ellipsoid_state moved, derivative;

            memcpy(y, state, sizeof(y));
            y[j] += p * step;
            memcpy(&moved, y, sizeof(moved));
            assert_ok(ellipsoid_rhs(m, s, &moved, &cache, &derivative));
            memcpy(f, &derivative, sizeof(f));
            for (int i = 0; i < SIZE; i++)
            {
                slope[i] += weight[p + 2] * f[i] / step;
                largest[i] = fmax(largest[i], fabs(f[i]));
            }
        }
        for (int begin = 0; begin < AT_Q; begin += AT_OMEGA)
        {
            double size = 0, error = 0, rounding = 0;

            for (int i = begin; i < begin + 3; i++)
            {
                size = fmax(size, fabs(jacobian[i][j]));
                error = fmax(error, fabs(slope[i] - jacobian[i][j]));
                rounding = fmax(rounding, 1e-14 * largest[i] / step);
            }
            bad += !(error <= 1e-6 * size + rounding);
        }
    }
    return bad;
}

static void test_jacobian(void **unused)
{
    ellipsoid_options o = near_walls();
    ellipsoid_model model;
    test_quadratic flow = test_shear(1000);
    wall_mesh mesh;
    uint64_t seed = 21;
    int bad = 0, several = 0;

    (void)unused;
    o.wall_range = 10e-6; /* all of the landscape */
    model = test_model(&o);
    flow.h[0][2][2] = 1e8;
    flow.u[1] = 1e-3;
    wall_mesh_init(&mesh);
    add_landscape(&mesh);
    wall_mesh_finish(&mesh);
    ellipsoid_facet_cache_clear(&cache);
    for (int n = 0; n < 400; n++)
    {
        const ellipsoid_surroundings s = around(&mesh, &flow);
        ellipsoid_state state = {.u = {0}};
        ellipsoid_planes planes;

        test_orientation(&seed, state.q);
        for (int i = 0; i < 3; i++)
        {
            state.x[i] = (i == 2 ? 2e-6 : 4e-6) * test_signed(&seed);
            state.u[i] = 1e-3 * test_signed(&seed);
            state.omega[i] = 1e3 * test_signed(&seed);
        }
        if (state.x[0] > 1e-6 && state.x[1] < 1e-6)
        {
            state.x[2] = fabs(state.x[2]);
        }
        assert_ok(
            ellipsoid_find_planes(&model, &s, &state, 0, &cache, &planes));
        several += planes.count >= 6;
        for (int l = 0; l < 4; l++)
        {
            state.q[l] *= 1 + 0.05 * (n % 3 - 1);
        }
        model.options.flow_at =
            n % 2 ? ELLIPSOID_FLOW_CENTRE : ELLIPSOID_FLOW_BODY;
        model = test_model(&model.options);
        bad += compare_jacobian(&model, &s, &state) > 0;
    }
    print_message("%d of 400 states with six planes or more\n", several);
    assert_true(bad == 0);
    assert_true(several > 50);
    wall_mesh_free(&mesh);
}

/* ------------------------------------------------------------------ walls */

/*
    A sphere held in the flow of a stagnation point, (x z, y z, -z^2): the force
    over 6 pi mu a h^2 is known (Goren & O'Neill, Chem. Eng. Sci. 26, 325 (1971):
    3.23 at contact; here by tests/benchmarks/resolvedCell) and stays finite,
    while that on a sphere that moves grows as the inverse of the gap.
*/
static void test_held_at_a_stagnation_point(void **unused)
{
    static const test_row centre = {
        "walls",
        "force on a sphere held at a stagnation point over that known",
        "gaps 0.1, 0.2, 0.6 radii, flow centre",
        "Goren & O'Neill, Chem. Eng. Sci. 26, 325 (1971); boundary elements",
        "P",
        "10 % would be good: the model knows motion and linear shear at a "
        "plane, no flow that bends",
        8};
    static const test_row body = {
        "walls",
        "force on a sphere held at a stagnation point over that known",
        "gaps 0.1, 0.2, 0.6 radii, flow body",
        "Goren & O'Neill, Chem. Eng. Sci. 26, 325 (1971); boundary elements",
        "P",
        "one number of the law is fitted to such flows",
        0};
    static const double known[][2] = {{0.1, 2.94}, {0.2, 2.73}, {0.6, 2.17}};
    const double radius = 0.5e-6;
    ellipsoid_options o = near_walls();
    wall_mesh mesh;

    (void)unused;
    ellipsoid_set(o.semi_axes, radius, radius, radius);
    wall_mesh_init(&mesh);
    add_floor(&mesh, 0, 1, 1);
    wall_mesh_finish(&mesh);
    for (int n = 0; n < 6; n++)
    {
        test_quadratic flow = {.answer = 0};
        const ellipsoid_surroundings s = around(&mesh, &flow);
        const double gap = known[n / 2][0] * radius, height = radius + gap;
        const ellipsoid_state state = {.x = {0, 0, height}, .q = {0, 0, 0, 1}};
        ellipsoid_state derivative;
        ellipsoid_model model;
        double force;

        flow.h[0][0][2] = flow.h[0][2][0] = 1e9;
        flow.h[1][1][2] = flow.h[1][2][1] = 1e9;
        flow.h[2][2][2] = -2e9;
        o.flow_at = n % 2 ? ELLIPSOID_FLOW_BODY : ELLIPSOID_FLOW_CENTRE;
        model = test_model(&o);
        ellipsoid_facet_cache_clear(&cache);
        assert_ok(ellipsoid_rhs(&model, &s, &state, &cache, &derivative));
        force =
            -model.mass * derivative.u[2]
            / (6 * acos(-1) * model.viscosity * radius * 1e9 * height * height);
        print_message("gap %g radii: %.2f, known %.2f\n", known[n / 2][0],
                      force, known[n / 2][1]);
        assert_true(force > 0.9 * known[n / 2][1]);
        assert_row(n % 2 ? &body : &centre, force / known[n / 2][1], 1, 0.1);
    }
    wall_mesh_free(&mesh);
}

/* Nothing is invalid in line with an edge, where programs may trap that: there
   the distance from it is what rounding leaves. */
static void test_in_line_with_an_edge(void **unused)
{
    const ellipsoid_options o = near_walls();
    const ellipsoid_model model = test_model(&o);
    test_quadratic flow = test_shear(1000);

    (void)unused;
    for (int size = 1; size <= 7; size++)
    {
        const double edge = size * 1e-6;
        const double low[3] = {0}, high[3] = {edge, edge, edge};
        wall_mesh mesh;

        wall_mesh_init(&mesh);
        wall_mesh_box(&mesh, low, high, 0, 0, 0);
        wall_mesh_finish(&mesh);
        for (int n = 0; n < 200; n++)
        {
            const ellipsoid_surroundings s = around(&mesh, &flow);
            const ellipsoid_state state = {
                .x = {0, 0, edge + (4 + 0.02 * n) * 1e-6}, .q = {0, 0, 0, 1}};
            ellipsoid_state derivative;

            ellipsoid_facet_cache_clear(&cache);
            feclearexcept(FE_INVALID);
            assert_ok(ellipsoid_rhs(&model, &s, &state, &cache, &derivative));
            assert_false(fetestexcept(FE_INVALID));
        }
        wall_mesh_free(&mesh);
    }
}

/* A slit: two walls add up (Oseen's superposition); a wall out of range, or
   none at all, is no wall. */
static void test_slit(void **unused)
{
    const ellipsoid_options o = near_walls(), free = test_free_cell();
    const ellipsoid_model model = test_model(&o), bare = test_model(&free);
    const double low[3] = {-1e-4, -1e-4, 0}, high[3] = {1e-4, 1e-4, 6e-6};
    const double q[4] = {0.1, 0.2, 0.3, 0.927361849549570};
    const double x[3] = {0, 0, 2.5e-6}, off[3] = {0, 0, 10.1e-6 * 4};
    double one[6][6], other[6][6], both[6][6], none[6][6];
    wall_mesh floor, lid, slit;

    (void)unused;
    wall_mesh_init(&floor);
    wall_mesh_init(&lid);
    wall_mesh_init(&slit);
    add_floor(&floor, 0, 1, 1);
    {
        const double a[3] = {1e-4, -1e-4, 6e-6}, u[3] = {-2e-4, 0, 0};
        const double v[3] = {0, 2e-4, 0};

        wall_mesh_plane(&lid, a, u, v, 1, 1, 0, 0);
    }
    wall_mesh_box(&slit, low, high, 1, 0, 0);
    wall_mesh_finish(&floor);
    wall_mesh_finish(&lid);
    wall_mesh_finish(&slit);
    ellipsoid_facet_cache_clear(&cache);
    lab_resistance(&model, &floor, x, q, one);
    ellipsoid_facet_cache_clear(&cache);
    lab_resistance(&model, &lid, x, q, other);
    ellipsoid_facet_cache_clear(&cache);
    lab_resistance(&model, &slit, x, q, both);
    lab_resistance(&bare, &slit, x, q, none);
    for (int n = 0; n < 6; n++)
    {
        for (int i = 0; i < 6; i++)
        {
            one[i][n] += other[i][n] - none[i][n];
        }
    }
    assert_true(difference(one, both) < 1e-11);
    ellipsoid_facet_cache_clear(&cache);
    lab_resistance(&model, &floor, off, q, both);
    assert_true(difference(none, both) < 1e-13);
    wall_mesh_free(&floor);
    wall_mesh_free(&lid);
    wall_mesh_free(&slit);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_jacobian),
        cmocka_unit_test(test_held_at_a_stagnation_point),
        cmocka_unit_test(test_in_line_with_an_edge),
        cmocka_unit_test(test_slit),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
