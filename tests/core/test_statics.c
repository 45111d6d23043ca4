/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_statics.c - bodies that lie, stand and lean under their weight, and how
    they leave their balance.
*/
#include "contactTest.h"

static const double um = 1e-6;
static const double g = 9.81;

/* Hertz (Johnson, Contact Mechanics (1985), eq. 4.23) */
static double depth_under(const ellipsoid_options *o, double force)
{
    return pow(force / contact_stiffness(o), 2.0 / 3);
}

/* A ball falls through still water on the floor and stays where Hertz holds its
   weight, at 1e-7 of its radius: x is known to 1e-9 of that. */
static void test_ball_settles_in_water(void **unused)
{
    static const test_row row = {"contact",
                                 "depth of a ball on a floor over Hertz'",
                                 "0.5 um, in water, by its weight",
                                 "Hertz; Johnson (1985), eq. 4.23",
                                 "A",
                                 "x is known to 1e-9 of the radius",
                                 0};
    static contact_run r;
    ellipsoid_options o = contact_ball(0.5 * um, 1040);
    double weight;

    (void)unused;
    contact_floor(&r, 20 * um);
    memset(&r.flow, 0, sizeof(r.flow));
    o.fluid_density = 997.5;
    contact_start(&r, &o, 0);
    weight = (r.model.mass - r.model.fluid_mass) * g;
    r.state.x[2] = 0.6 * um;
    assert_ok(contact_go(&r, 20));
    assert_row(&row, contact_now(&r).deepest / depth_under(&o, weight), 1,
               1e-6);
    wall_mesh_free(&r.mesh);
}

/*
    In vacuum damping does it: about the balance it is a force
    -3/2 alpha m g v, so that the amplitude falls as exp(-3/4 alpha g t).
*/
static void test_ball_settles_in_vacuum(void **unused)
{
    static const test_row row = {"contact",
                                 "depth of a ball on a floor over Hertz'",
                                 "10 mm, in vacuum, damped",
                                 "Hertz; Johnson (1985), eq. 4.23",
                                 "A",
                                 "amplitude left after 1 s",
                                 0};
    static contact_run r;
    ellipsoid_options o = contact_ball(0.01, 1000);
    double depth;

    (void)unused;
    contact_floor(&r, 1);
    o.contact_damping = 3;
    contact_start(&r, &o, 1);
    depth = depth_under(&o, r.model.mass * g);
    r.state.x[2] = o.bead_radius - 0.9 * depth;
    assert_ok(contact_go(&r, 1));
    assert_row(&row, contact_now(&r).deepest / depth, 1, 1e-6);
    wall_mesh_free(&r.mesh);
}

/* A ball between two walls at right angles, 30 degrees from upright: each bears
   the part of the weight along its normal. */
static void test_ball_in_a_wedge(void **unused)
{
    static const test_row row = {"contact",
                                 "depth of a ball in a wedge over Hertz'",
                                 "walls at 30 and 60 degrees from level",
                                 "balance of forces; Johnson (1985), eq. 4.23",
                                 "A",
                                 "x is known to 1e-9 of the radius",
                                 0};
    const double c = cos(test_pi / 6), s = sin(test_pi / 6);
    const double left[3] = {-5 * c * um, -5 * um, 5 * s * um};
    const double down[3] = {5 * c * um, 0, -5 * s * um};
    const double right[3] = {0, -5 * um, 0};
    const double up[3] = {5 * s * um, 0, 5 * c * um}, y[3] = {0, 10 * um, 0};
    const double normal[2][3] = {{s, 0, c}, {-c, 0, s}};
    static contact_run r;
    ellipsoid_options o = contact_ball(0.5 * um, 1040);
    double weight;

    (void)unused;
    wall_mesh_init(&r.mesh);
    wall_mesh_plane(&r.mesh, left, down, y, 1, 1, 0, 0);
    wall_mesh_plane(&r.mesh, right, up, y, 1, 1, 0, 1);
    wall_mesh_finish(&r.mesh);
    memset(&r.flow, 0, sizeof(r.flow));
    o.fluid_density = 997.5;
    o.density = 3000;
    o.contact_modulus = 1e4;
    contact_start(&r, &o, 0);
    weight = (r.model.mass - r.model.fluid_mass) * g;
    for (int i = 0; i < 3; i++)
    {
        r.state.x[i] = 0.499 * um * (normal[0][i] + normal[1][i]);
    }
    assert_ok(contact_go(&r, 20));
    for (int n = 0; n < 2; n++)
    {
        const double depth =
            o.bead_radius - ellipsoid_dot(r.state.x, normal[n]);

        assert_row(&row, depth / depth_under(&o, weight * normal[n][2]), 1,
                   1e-6);
    }
    assert_int_equal(contact_now(&r).surface_count, 2);
    wall_mesh_free(&r.mesh);
}

/* ------------------------------------------------------- on its two poles */

/* A body of 4 cm with a bead at either end of its long axis only. */
static ellipsoid_options dumbbell(void)
{
    ellipsoid_options o = contact_ball(0.01, 1000);

    o.semi_axes[1] = 0.02;
    o.bead_count = 2;
    o.bead_radius = 0.005;
    o.contact_modulus = 1e9;
    return o;
}

/* Time of the n-th change of sign of x3 less its mean, or of the lean. */
static double zero_crossing(contact_run *r, int lean, double rest, int n,
                            double step)
{
    double before = 0, at = 0;

    for (int found = 0; found < n;)
    {
        double axis[3], value;

        assert_ok(contact_go(r, r->t + step));
        test_long_axis(&r->state, axis);
        value = lean ? axis[2] : r->state.x[2] - rest;
        if (before * value < 0)
        {
            found++;
            at = r->t - step * value / (value - before);
        }
        before = value;
    }
    return at;
}

/*
    Lying on both beads, at distances l from the middle, each with the stiffness
    k' = dF/dd at half the weight: x3 swings with 2 k'/m, and the lean with
    2 k' l^2/I. An amplitude of a of the depth makes the frequencies lower by
    some a^2/100.
*/
static void test_lying_swings_and_rocks(void **unused)
{
    static const test_row row = {"contact",
                                 "frequency of a dumbbell on a floor over "
                                 "sqrt(2 k/m) or sqrt(2 k l^2/I)",
                                 "up and down, and rocking",
                                 "linear oscillator",
                                 "A",
                                 "the amplitude, squared, over 100",
                                 0};
    static contact_run r;
    ellipsoid_options o = dumbbell();

    (void)unused;
    contact_floor(&r, 1);
    o.tolerance = 1e-10;
    for (int lean = 0; lean < 2; lean++)
    {
        double depth, stiffness, frequency, step, first, last, axis[3], arm;

        contact_start(&r, &o, 1);
        arm = o.semi_axes[1] - o.bead_radius;
        depth = depth_under(&o, r.model.mass * g / 2);
        stiffness = 1.5 * contact_stiffness(&o) * sqrt(depth);
        frequency =
            sqrt(2 * stiffness
                 * (lean ? arm * arm / r.model.inertia[0] : 1 / r.model.mass));
        ellipsoid_set(axis, 0, 1, lean ? 0.02 * depth / arm : 0);
        ellipsoid_quaternion_from_axis(axis, 0, r.state.q);
        r.state.x[2] = o.bead_radius - depth * (lean ? 1 : 0.98);
        step = 0.01 / frequency;
        first = zero_crossing(&r, lean, o.bead_radius - depth, 1, step);
        last = zero_crossing(&r, lean, o.bead_radius - depth, 20, step);
        assert_row(&row, 20 * test_pi / (last - first) / frequency, 1, 2e-4);
    }
    wall_mesh_free(&r.mesh);
}

/*
    Standing on one bead of radius r_b, l below the middle, it falls: the lean grows as exp(s t), s^2 = m g l/J, with J = I about the middle where
    the floor is smooth, and I + m (l + r_b)^2 where the bead rolls on it.
*/
static void test_standing_falls(void **unused)
{
    static const test_row row = {"contact",
                                 "lean of a dumbbell that falls over cosh(s t)",
                                 "s t = 6, with and without friction",
                                 "inverted pendulum",
                                 "A",
                                 "the lean, and the depth of contact",
                                 0};
    static contact_run r;
    ellipsoid_options o = dumbbell();

    (void)unused;
    contact_floor(&r, 1);
    o.slip_speed = 1e-9;
    o.tolerance = 1e-10;
    for (o.friction = 0; o.friction < 2; o.friction += 1)
    {
        const double arm = o.semi_axes[1] - o.bead_radius;
        const double height = o.semi_axes[1], lean = 1e-6;
        double axis[3] = {0, lean, 1}, inertia, rate;

        contact_start(&r, &o, 1);
        inertia = r.model.inertia[0]
                + (o.friction > 0 ? r.model.mass * height * height : 0);
        rate = sqrt(r.model.mass * g * arm / inertia);
        ellipsoid_quaternion_from_axis(axis, 0, r.state.q);
        r.state.x[2] = height - depth_under(&o, r.model.mass * g);
        r.t = 0;
        /* from rest: lean cosh(s t) */
        assert_ok(contact_go(&r, 6 / rate));
        test_long_axis(&r.state, axis);
        assert_row(&row, axis[1] / (lean * cosh(6)), 1, 1e-3);
        assert_relative(r.state.u[1],
                        o.friction > 0 ? height * lean * sinh(6) * rate : 0,
                        1e-3);
    }
    wall_mesh_free(&r.mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ball_settles_in_water),
        cmocka_unit_test(test_ball_settles_in_vacuum),
        cmocka_unit_test(test_ball_in_a_wedge),
        cmocka_unit_test(test_lying_swings_and_rocks),
        cmocka_unit_test(test_standing_falls),
    };

    return cmocka_run_group_tests_name("statics", tests, NULL, NULL);
}
