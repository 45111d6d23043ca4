/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_farField.c - what a wall far away does to a body that a force drives.

    There the wall acts as the image of a point force does (Blake, Proc. Camb.
    Phil. Soc. 70, 303, 1971): beside a force F along the wall it makes the flow
    -3 F/(32 pi mu h) slower, a third force across twice that, and strains it by
    E_xz = 3 F/(64 pi mu h^2) without turning it, by which a spheroid turns as in
    any flow (Jeffery). Both are exact but for (b/h)^2 of themselves, since the
    force on an ellipsoid is the same fore and aft.
*/
#include "nearWallTest.h"

static const double force = 1e-12; /* [N] */
static ellipsoid_facet_cache cache;

static ellipsoid_options pulled(const double semi_axes[3], int across)
{
    ellipsoid_options o = near_walls();

    ellipsoid_copy(semi_axes, o.semi_axes);
    o.motion = ELLIPSOID_MOTION_INERTIALESS;
    o.contact = 0;
    o.wall_range = 2e-3;
    o.external_force[across ? 2 : 0] = force;
    return o;
}

/* 40 mm of it */
static void add_wide_floor(wall_mesh *mesh)
{
    const double corner[3] = {-2e-2, -2e-2, 0};
    const double along[3] = {4e-2, 0, 0}, beside[3] = {0, 4e-2, 0};

    wall_mesh_init(mesh);
    wall_mesh_plane(mesh, corner, along, beside, 1, 1, 2, 0);
    wall_mesh_finish(mesh);
}

/* The long axis, in the plane of the force and the normal, this far from the
   former. */
static ellipsoid_state tilted(double tilt, double height)
{
    const double axis[3] = {cos(tilt), 0, sin(tilt)};
    ellipsoid_state state = {.x = {0, 0, height}};

    ellipsoid_quaternion_from_axis(axis, 0.3, state.q);
    return state;
}

/* dtheta/dt, by F/(8 pi mu h^2) cos 2 theta */
static double turning_by_force(const double semi_axes[3])
{
    const double r = semi_axes[1] / semi_axes[0];

    return 0.375 * (r * r - 1) / (r * r + 1);
}

/* By how much it is slower, and how it turns. */
static void test_image_of_a_force(void **unused)
{
    static const test_row slower = {
        "walls",
        "velocity that a far wall takes from a body, over the image's",
        "cell, spheroids 8:1 and 1:3 that are pulled, 5 and 10 half-lengths "
        "away",
        "Blake (1971); Brenner, J. Fluid Mech. 12, 35 (1962)",
        "A",
        "the next order, twice the square of half-length over distance",
        0};
    static const test_row turning = {
        "walls",
        "error of the turning by a far wall, over F/(8 pi mu b^2)",
        "cell, spheroids 8:1 and 1:3 that are pulled, 5 and 10 half-lengths "
        "away",
        "Blake (1971), Jeffery (1922)",
        "A",
        "the next order, and 0.001 by the table",
        0};
    static const double bodies[3][3] = {{0.5e-6, 2e-6, 0.5e-6},
                                        {0.25e-6, 2e-6, 0.25e-6},
                                        {2e-6, 2e-6 / 3, 2e-6}};
    static const double tilts[] = {-1.2, -0.4, 0.3, 1.3};
    const double half = 2e-6;
    wall_mesh mesh;

    (void)unused;
    add_wide_floor(&mesh);
    for (int n = 0; n < 3 * 2 * 4 * 2; n++)
    {
        const int across = n % 2, axis = across ? 2 : 0;
        const double *a = bodies[n / 16], tilt = tilts[n / 2 % 4];
        const double far = n / 8 % 2 ? 10 : 5, order = 2 / (far * far);
        const ellipsoid_options o = pulled(a, across);
        const ellipsoid_model m = test_model(&o);
        const double unit = force / (8 * test_pi * m.viscosity * half);
        const double by_image = unit * (across ? 1.5 : 0.75) / far;
        const double turn = across ? 0
                                   : turning_by_force(a) * unit / half
                                         / (far * far) * cos(2 * tilt);
        test_quadratic flow = {.answer = 0};
        ellipsoid_surroundings s = around(&mesh, &flow);
        ellipsoid_state with = tilted(tilt, far * half), without = with;
        double matrix[3][3], spin[3];

        ellipsoid_facet_cache_clear(&cache);
        assert_ok(ellipsoid_balance(&m, &s, &with, &cache));
        s.walls = NULL;
        assert_ok(ellipsoid_balance(&m, &s, &without, NULL));
        assert_row(&slower, (without.u[axis] - with.u[axis]) / by_image, 1,
                   order);
        if (across)
        {
            continue;
        }
        ellipsoid_rotation(with.q, matrix);
        ellipsoid_product(matrix, with.omega, spin);
        assert_row(&turning, (-spin[1] - turn) * half / unit, 0,
                   order * fabs(turn) * half / unit + 1e-3);
    }
    wall_mesh_free(&mesh);
}

static double lowest;

static int note_height(void *context, const ellipsoid_step *step)
{
    (void)context;
    lowest = fmin(lowest, step->after.x[2]);
    return 0;
}

/*
    A cell that settles along a wall, tilted towards it, drifts there and is
    turned away: with its length along the wall in between (glancing), or across
    it (reversing). In the far field dh/dt = F (1/K along - 1/K across) sin 2
    theta/(2 mu) and dtheta/dt = turning cos 2 theta/h^2, so that 1/h - 1/h0 =
    drift/(2 turning) ln(cos 2 theta/cos 2 theta0).
*/
static void test_glancing_and_reversing(void **unused)
{
    static const char *const source =
        "Mitchell & Spagnolie, J. Fluid Mech. 772, 600 (2015)";
    static const char *const why =
        "the next order, the square of half-length over distance";
    const char *const glances = "least distance of a cell that glances off a "
                                "wall, over the far field's";
    const char *const reverses = "least distance of a cell that reverses at a "
                                 "wall, over the far field's";
    const struct
    {
        double start, tilt; /* [m], degrees */
        test_row row;
    } ways[] = {
        {1e-5,
         -10,
         {"walls", glances,
          "settling from 5 half-lengths away, tilted by 10 degrees", source,
          "A", why, 0}},
        {1e-5,
         -80,
         {"walls", reverses,
          "settling from 5 half-lengths away, tilted by 80 degrees", source,
          "A", why, 0}},
        {2e-5,
         -10,
         {"walls", glances,
          "settling from 10 half-lengths away, tilted by 10 degrees", source,
          "A",
          "the next order; so far off the table turns it by a tenth too fast",
          4.5}},
        {2e-5,
         -80,
         {"walls", reverses,
          "settling from 10 half-lengths away, tilted by 80 degrees", source,
          "A", why, 0}}};
    static const double a[3] = {0.5e-6, 2e-6, 0.5e-6};
    const ellipsoid_options o = pulled(a, 0);
    const ellipsoid_model m = test_model(&o);
    wall_mesh mesh;

    (void)unused;
    add_wide_floor(&mesh);
    for (size_t n = 0; n < sizeof(ways) / sizeof(*ways); n++)
    {
        const double start = ways[n].start;
        const double tilt = ways[n].tilt * test_pi / 180;
        const double drift = 1 / m.resistance[1] - 1 / m.resistance[0];
        const double turn = turning_by_force(a) / (8 * test_pi);
        const double least =
            1 / (1 / start - drift / (4 * turn) * log(fabs(cos(2 * tilt))));
        test_quadratic flow = {.answer = 0};
        const ellipsoid_surroundings s = around(&mesh, &flow);
        ellipsoid_controller controller = {0};
        ellipsoid_state state = tilted(tilt, start);
        double t = 0, r[3][3];

        lowest = start;
        ellipsoid_facet_cache_clear(&cache);
        assert_ok(ellipsoid_balance(&m, &s, &state, &cache));
        assert_ok(
            ellipsoid_advance(&(ellipsoid_member){&m, &s, &state, &controller,
                                                  &cache, NULL, NULL},
                              &t, 20, note_height));
        assert_row(&ways[n].row, lowest / least, 1, 4e-12 / (least * least));
        /* it has left, turned by the one way or the other */
        ellipsoid_rotation(state.q, r);
        assert_true(state.x[2] > start && r[2][1] * (n % 2 ? -1 : 1) > 0);
        assert_true(r[0][1] * (n % 2 ? -1 : 1) > 0);
    }
    wall_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_image_of_a_force),
        cmocka_unit_test(test_glancing_and_reversing),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
