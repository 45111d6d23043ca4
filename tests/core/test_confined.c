/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_confined.c - free and diffusing bodies near walls made of facets, with
    the walls' law: against tables and experiments (docs/published.md).
*/
#include "nearWallTest.h"

static ellipsoid_facet_cache cache;

/* A body, of the semi-axes a, b and a, and the walls x3 = 0 and, if above 0,
   x3 = lid. */
typedef struct room
{
    ellipsoid_model model;
    wall_mesh mesh;
} room;

static void room_set(room *r, double a, double b, double lid)
{
    ellipsoid_options o = near_walls();

    ellipsoid_set(o.semi_axes, a, b, a);
    o.wall_range = 1e-4;
    o.lubrication_gap = 1e-4 * a;
    r->model = test_model(&o);
    wall_mesh_init(&r->mesh);
    add_floor(&r->mesh, 0, 1, 1);
    if (lid > 0)
    {
        const double corner[3] = {5e-5, -5e-5, lid}, along[3] = {-1e-4, 0, 0};
        const double across[3] = {0, 1e-4, 0};

        wall_mesh_plane(&r->mesh, corner, along, across, 1, 1, 0, 0);
    }
    wall_mesh_finish(&r->mesh);
    ellipsoid_facet_cache_clear(&cache);
}

/*
    A free sphere in shear at a plane: Goldman, Cox & Brenner, Chem. Eng. Sci.
    22, 653 (1967), tables 1 and 2 of both parts, solved for no force and no
    torque: f_u U - 4/3 t_u a w = h f_s, t_w a w - t_u U = a t_s / 2, of the
    shear rate 1.
*/
static void test_sphere_in_shear(void **unused)
{
    static const char *const source =
        "Goldman, Cox & Brenner, Chem. Eng. Sci. 22, 637 and 653 (1967)";
    const test_row speed = {
        "walls",
        "speed of a free sphere in shear at a plane over the tables'",
        "gaps 0.0032 to 9 radii",
        source,
        "P",
        "0.5 % of resistance and of held force",
        0};
    const test_row spin = {
        "walls",
        "spin of a free sphere in shear at a plane over the tables'",
        "gaps 0.0032 to 9 radii",
        source,
        "P",
        "0.5 % of resistance, 1 % of held torque",
        0};
    const double a = 1e-6;
    room r;

    (void)unused;
    room_set(&r, a, a, 0);
    for (size_t n = 0; n < sizeof(goldman) / sizeof(*goldman); n++)
    {
        const struct goldman *k = &goldman[n];
        const double u = (k->height * k->force_s * k->torque_omega
                          + 2.0 / 3 * k->torque_u * k->torque_s)
                       / (k->force_u * k->torque_omega
                          - 4.0 / 3 * k->torque_u * k->torque_u);
        const double w = (k->torque_s / 2 + k->torque_u * u) / k->torque_omega;
        test_quadratic flow = {.answer = 0};
        const ellipsoid_surroundings s = around(&r.mesh, &flow);
        ellipsoid_state state = {.x = {0, 0, a * k->height}, .q = {0, 0, 0, 1}};

        flow.g[0][2] = 1;
        assert_ok(ellipsoid_balance(&r.model, &s, &state, &cache));
        print_message("# gap %.4f: speed %.4f of %.4f, spin %.4f of %.4f\n",
                      k->height - 1, state.u[0] / (a * k->height),
                      u / k->height, state.omega[1], w);
        assert_row(&speed, state.u[0] / (a * u), 1, 1e-2);
        assert_row(&spin, state.omega[1] / w, 1, 1.5e-2);
    }
    wall_mesh_free(&r.mesh);
}

/* The speeds over the force [m/(N s)] of a body at half height that is pulled
   along x1 and x2, its second axis along x2, in a fluid at rest. */
static void pulled(room *r, double height, double mobility[2])
{
    test_quadratic rest = {.answer = 0};
    const ellipsoid_surroundings s = around(&r->mesh, &rest);

    for (int i = 0; i < 2; i++)
    {
        ellipsoid_options o = r->model.options;
        ellipsoid_model m;
        ellipsoid_state state = {.x = {0, 0, height}, .q = {0, 0, 0, 1}};

        o.external_force[i] = 1e-15;
        m = test_model(&o);
        assert_ok(ellipsoid_balance(&m, &s, &state, &cache));
        mobility[i] = state.u[i] / o.external_force[i];
    }
}

/*
    An ellipsoid of 4.8 x 0.6 x 0.6 um in a cell of 1 um, so thin that it stays
    flat: Han, Alsayed, Nobili, Zhang, Lubensky & Yodh, Science 314, 626 (2006).
    Einstein: diffusivities are as mobilities. Half-way between the plates their
    effects are added; the fluid that a body pushes across so thin a cell,
    which goes about its ends, is not known to that sum.
*/
static void test_ellipsoid_in_a_cell(void **unused)
{
    const test_row row = {
        "walls",
        "diffusivity along over that across, ellipsoid between plates",
        "4.8 x 0.6 x 0.6 um, plates 1 um apart",
        "Han et al., Science 314, 626 (2006): about 4, recalled",
        "E",
        "a quarter, assumed; disagrees: planes are added",
        2.5};
    room r;
    double m[2];

    (void)unused;
    room_set(&r, 0.3e-6, 2.4e-6, 1e-6);
    pulled(&r, 0.5e-6, m);
    print_message("# along %.3f, across %.3f of those far from walls\n",
                  m[1] / r.model.mobility[1], m[0] / r.model.mobility[0]);
    /* confined at all: more than the free body's 1.41 */
    assert_true(m[1] / m[0] > 1.2 * r.model.mobility[1] / r.model.mobility[0]);
    assert_row(&row, m[1] / m[0], 4, 1);
    wall_mesh_free(&r.mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sphere_in_shear),
        cmocka_unit_test(test_ellipsoid_in_a_cell),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
