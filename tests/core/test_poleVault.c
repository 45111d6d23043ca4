/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_poleVault.c - cells that tumble beside a wall in shear. Nearer than
    half their length they come down on it with one end and lift themselves over it
    (Stover & Cohen, Rheol. Acta 29, 192 (1990)).

    The wall acts by contact alone here: the drag knows nothing of it.
*/
#include "contactTest.h"

static const double um = 1e-6;
static const double shear = 1000, half_length = 2e-6;

/* Jeffery (1922): the period of the paper's cell, 4:1. */
static double jeffery_period(void) { return 2 * test_pi * (4 + 0.25) / shear; }

/* Along the flow at a height above the floor. */
static void lay_at(contact_run *r, const ellipsoid_options *o, double height)
{
    const double axis[3] = {1, 0, 0};

    r->flow = test_shear(0);
    r->flow.g[0][2] = shear;
    contact_start(r, o, 0);
    ellipsoid_quaternion_from_axis(axis, 0.1, r->state.q);
    r->state.x[2] = height;
}

typedef struct tumble
{
    double angle, last, step; /* turned so far, in the plane of shear */
    double crossed[2];        /* times of half and whole turns */
    int turns, touched;
    double highest;
} tumble;

static void follow(contact_run *r, tumble *way, int half_turns)
{
    while (way->turns < half_turns)
    {
        const double before = way->angle;
        double axis[3], at;

        assert_ok(contact_go(r, r->t + way->step));
        test_long_axis(&r->state, axis);
        at = atan2(-axis[2], axis[0]);
        way->angle += remainder(at - way->last, 2 * test_pi);
        way->last = at;
        way->touched += contact_now(r).bead_contacts > 0;
        way->highest = fmax(way->highest, r->state.x[2]);
        if (way->angle >= (way->turns + 1) * test_pi)
        {
            way->crossed[way->turns] =
                r->t
                - way->step * (way->angle - (way->turns + 1) * test_pi)
                      / (way->angle - before);
            way->turns++;
        }
    }
}

/*
    A cell with a bead at either end only, without friction. While it touches at
    an angle a, x3 = r_b + l sin a, which takes a force N = l cos a a'/M_33 with
    the mobility M, whose torque slows the turning:
        a' (1 + m_r l^2 cos^2 a/M_33) = w_J,
        w_J = shear (r^2 sin^2 a + cos^2 a)/(r^2 + 1).
    From upright on it is free. So half a turn takes longer than Jeffery's by
    the integral of m_r l^2 cos^2 a/(M_33 w_J) from touch to upright.
*/
static double delay(const ellipsoid_model *m, double height)
{
    const double arm = half_length - m->options.bead_radius;
    const double touch = asin((height - m->options.bead_radius) / arm);
    const int parts = 2000;
    const double part = (test_pi / 2 - touch) / parts;
    double sum = 0;

    for (int n = 0; n < parts; n++) /* midpoints */
    {
        const double a = touch + (n + 0.5) * part, s = sin(a), c = cos(a);
        const double up = s * s * m->mobility[1] + c * c * m->mobility[0];
        const double turning = shear * (16 * s * s + c * c) / 17;

        sum +=
            part * m->rotation_mobility[0] * arm * arm * c * c / (up * turning);
    }
    return sum;
}

static void test_lift_on_one_end(void **unused)
{
    static const test_row row = {
        "contact",
        "time of half a turn on one end over the closed form",
        "two beads, heights 0.3 to 0.9 half-lengths",
        "Jeffery (1922) and the lever, by quadrature",
        "A",
        "2e-5 of inertia, depth, errors of x and q",
        0};
    static contact_run r;
    ellipsoid_options o = test_paper_options();

    (void)unused;
    contact_floor(&r, 400 * um);
    o.buoyancy = 0;
    o.bead_count = 2;
    o.contact_modulus = 1e8;
    for (double height = 0.3; height < 1; height += 0.2)
    {
        tumble way = {.step = 2e-5};

        lay_at(&r, &o, height * half_length);
        follow(&r, &way, 2);
        /* 2e-5 of it is inertia, what x and q err by, and the depth */
        assert_row(&row,
                   way.crossed[0]
                       / (jeffery_period() / 2
                          + delay(&r.model, height * half_length)),
                   1, 1e-4);
        /* free by now, and just high enough to pass */
        assert_relative(way.crossed[1] - way.crossed[0], jeffery_period() / 2,
                        1e-4);
        assert_relative(r.state.x[2], half_length, 1e-3);
    }
    wall_mesh_free(&r.mesh);
}

/* The whole cell, with and without friction, from 0.3 to 2 half-lengths. */
static void test_tumbling_beside_a_wall(void **unused)
{
    static const test_row row = {
        "walls",
        "period above a wall over Jeffery's",
        "1.1 to 2 half-lengths above it, contact alone",
        "Jeffery (1922); Stover & Cohen (1990)",
        "A",
        "inertia and tolerance",
        0};
    static const double height[] = {0.3, 0.5, 0.7, 0.9, 1.1, 1.5, 2};
    static contact_run r;
    ellipsoid_options o = test_paper_options();

    (void)unused;
    contact_floor(&r, 400 * um);
    o.buoyancy = 0;
    for (int n = 0; n < 14; n++)
    {
        const double start = height[n / 2] * half_length;
        tumble way = {.step = 1e-4};
        double period;
        long steps;

        o.friction = n % 2 ? 0.3 : 0;
        lay_at(&r, &o, start);
        follow(&r, &way, 2);
        period = way.crossed[1] / jeffery_period();
        lay_at(&r, &o, start);
        assert_ok(contact_go(&r, way.crossed[1]));
        steps = r.statistics.accepted + r.statistics.rejected;
        print_message("# h %.1f friction %.1f: period %.4f of Jeffery's, "
                      "to %.3f half-lengths, %ld steps\n",
                      height[n / 2], o.friction, period,
                      r.state.x[2] / half_length, steps);
        if (height[n / 2] < 1)
        {
            assert_true(way.touched > 0);
            assert_true(r.state.x[2] > start);
            assert_relative(way.highest, half_length, 0.01);
            assert_true(period > 0.99 && period < 1.2);
            /* twice the 174 of a free turn, and some for every bead */
            assert_true(steps < 450);
        }
        else
        {
            assert_int_equal(way.touched, 0);
            assert_row(&row, period, 1, 1e-4);
            assert_relative(r.state.x[2], start, 1e-6);
        }
    }
    wall_mesh_free(&r.mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lift_on_one_end),
        cmocka_unit_test(test_tumbling_beside_a_wall),
    };

    return cmocka_run_group_tests_name("poleVault", tests, NULL, NULL);
}
