/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_wallFit.c - bodies held at a stagnation point before a wall.
*/
#include "nearWallTest.h"

/* It is no part of the library. */
#include "../../tools/planeTable/planePanels.c"
#include "../../tools/planeTable/planeSolver.c"

static ellipsoid_facet_cache cache;

/* Force and torque over mu and the rate of the flow (x z, y z, -z^2) on the held
   spheroid (a, ratio a, a) by the model, in the units of a: Fx, Fz, Ty. */
static void by_model(double ratio, double tilt, double gap, double wrench[3])
{
    const double a = 0.5e-6, rate = 1e9; /* [1/(m s)] */
    const double nu = cos(tilt), s = sin(tilt);
    const double height = a * (sqrt(s * s + ratio * ratio * nu * nu) + gap);
    /* x^2 along (s, 0, nu): a turn about y of x^2 = z */
    const double half = sqrt(0.5), c = cos(0.5 * tilt), d = sin(0.5 * tilt);
    const ellipsoid_state state = {
        .x = {0, 0, height}, .q = {half * c, half * d, -half * d, half * c}};
    ellipsoid_options o = near_walls();
    ellipsoid_state derivative;
    ellipsoid_surroundings around_it;
    test_quadratic flow = {.answer = 0};
    double r[3][3], torque[3];
    ellipsoid_model m;
    wall_mesh mesh;

    ellipsoid_set(o.semi_axes, a, ratio * a, a);
    o.flow_at = ELLIPSOID_FLOW_BODY;
    o.wall_range = 1;
    m = test_model(&o);
    wall_mesh_init(&mesh);
    add_floor(&mesh, 0, 1, 1);
    wall_mesh_finish(&mesh);
    around_it = around(&mesh, &flow);
    flow.h[0][0][2] = flow.h[0][2][0] = rate;
    flow.h[1][1][2] = flow.h[1][2][1] = rate;
    flow.h[2][2][2] = -2 * rate;
    ellipsoid_facet_cache_clear(&cache);
    assert_ok(ellipsoid_rhs(&m, &around_it, &state, &cache, &derivative));
    ellipsoid_rotation(state.q, r);
    assert_near(r[0][1], s, 1e-15);
    assert_near(r[2][1], nu, 1e-15);
    for (int i = 0; i < 3; i++)
    {
        torque[i] = m.inertia[i] * derivative.omega[i];
    }
    wrench[0] = m.mass * derivative.u[0];
    wrench[1] = m.mass * derivative.u[2];
    wrench[2] = ellipsoid_dot(r[1], torque) / a;
    for (int i = 0; i < 3; i++)
    {
        wrench[i] /= m.viscosity * rate * a * a * a;
    }
    wall_mesh_free(&mesh);
}

/*
    Upright, tilted and lying, force, and torque over the length, off by so much of
    their size. What the flow averaged over the body would do is off by 20 to 160 %.
*/
static void test_held_spheroids(void **unused)
{
    static const test_row row = {
        "walls",
        "force and torque on a cell held at a stagnation point, error",
        "4:1, tilts 0 to 90 degrees, gaps 0.1 to 0.8 radii",
        "boundary elements (tools/planeTable)",
        "P",
        "one number of the law is fitted to such flows",
        0};
    static const double degrees[] = {0, 30, 45, 60, 90},
                        gaps[] = {0.1, 0.3, 0.8};
    static const plane_mesh fine = {4, 2, 4, 8};
    const double ratio = 4;

    (void)unused;
    for (int n = 0; n < 15; n++)
    {
        const double tilt = degrees[n / 3] * test_pi / 180, gap = gaps[n % 3];
        const plane_case c = {ratio, tilt, gap};
        double model[3], off = 0, size = 0;
        plane_functions f;

        assert_true(plane_solve(&c, &fine, &f));
        by_model(ratio, tilt, gap, model);
        for (int i = 0; i < 3; i++)
        {
            const double per = i == 2 ? 1 / ratio : 1;

            size += pow(per * f.stagnation[i], 2);
            off += pow(per * (model[i] - f.stagnation[i]), 2);
        }
        print_message("# %g deg, gap %g a: off by %.3f\n", degrees[n / 3], gap,
                      sqrt(off / size));
        assert_row(&row, sqrt(off / size), 0, 0.25);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_held_spheroids),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
