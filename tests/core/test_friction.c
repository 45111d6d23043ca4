/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    test_friction.c - bodies that roll, slide, stick and stand with friction,
    and what that costs.
*/
#include "contactTest.h"

static const double um = 1e-6;
static const double g = 9.81;

/* ------------------------------------------------------------- an incline */

/* A ball of 1 cm on a floor, gravity turned by an angle; starts in balance. */
static void on_incline(contact_run *r, double angle, double friction)
{
    ellipsoid_options o = contact_ball(0.01, 1000);
    double weight;

    o.contact_modulus = 1e8;
    o.friction = friction;
    o.slip_speed = 1e-6;
    /* in vacuum the errors of u in the first steps, which are of 1e-6 s and may
       be of 1e-11 times 1 cm over that, last */
    o.tolerance = 1e-11;
    ellipsoid_set(o.gravity, g * sin(angle), 0, -g * cos(angle));
    contact_start(r, &o, 1);
    weight = r->model.mass * g * cos(angle);
    r->state.x[2] = o.bead_radius - pow(weight / contact_stiffness(&o), 2. / 3);
}

/*
    Rolling, with I = 2/5 m r^2: 5/7 g sin, as long as tan <= 7/2 mu; sliding
    above: g (sin - mu cos), and 5/2 mu g cos/r for the spin. Friction yields by
    about a slip speed, 1e-6 m/s, of velocities of 0.07 m/s and more.
*/
static void test_ball_on_an_incline(void **unused)
{
    static const double angle[] = {0.1, 0.5, 1, 0.6, 1, 1.3};
    static const double friction[] = {0.3, 0.3, 0.5, 0.1, 0.1, 0.3};
    static contact_run r;

    (void)unused;
    contact_floor(&r, 10);
    for (int n = 0; n < 6; n++)
    {
        const double s = sin(angle[n]), c = cos(angle[n]);
        const int rolls = s / c < 3.5 * friction[n];
        const double faster =
            rolls ? 5.0 / 7 * g * s : g * (s - friction[n] * c);
        const double turning =
            rolls ? faster / 0.01 : 2.5 * friction[n] * g * c / 0.01;

        assert_int_equal(rolls, n < 3);
        on_incline(&r, angle[n], friction[n]);
        assert_ok(contact_go(&r, 0.1));
        assert_relative(r.state.u[0], 0.1 * faster, 2e-5);
        assert_relative(r.state.omega[1], 0.1 * turning, 2e-5);
    }
    wall_mesh_free(&r.mesh);
}

/* ---------------------------------------------------------- cells in water */

static void lay_cell(contact_run *r, double x, double y)
{
    const double axis[3] = {x, y, 0};

    ellipsoid_quaternion_from_axis(axis, 0.4, r->state.q);
    r->state.x[2] = 0.5 * um;
}

/*
    A cell along the flow, pressed to the floor with a force whose friction can
    hold twice the drag D: mu N v/sqrt(v^2 + v_s^2) = D at v_s/sqrt(3), less the
    1e-3 of the drag that this creep saves. With the default v_s that is below a
    hundredth of the flow's 4 mm/s.
*/
static void test_held_cell_creeps_little(void **unused)
{
    ellipsoid_options o = ellipsoid_options_default();
    static contact_run r;
    double drag;

    (void)unused;
    contact_floor(&r, 100 * um);
    o.buoyancy = 0;
    o.friction = 0.3;
    contact_start(&r, &o, 0);
    drag = r.model.viscosity * r.model.resistance[1] * 4e-3;
    o.external_force[2] = -2 * drag / o.friction;
    contact_start(&r, &o, 0);
    lay_cell(&r, 1, 0);
    memset(&r.flow, 0, sizeof(r.flow));
    r.flow.u[0] = 4e-3;
    assert_ok(contact_go(&r, 0.05));
    assert_true(ellipsoid_length(r.state.omega) < 0.1);
    assert_relative(r.state.u[0], o.slip_speed / sqrt(3), 5e-3);
    assert_true(r.state.u[0] < 0.01 * 4e-3);
    wall_mesh_free(&r.mesh);
}

static double steps_per_ms(contact_run *r, double span)
{
    const long before = r->statistics.accepted + r->statistics.rejected;

    assert_ok(contact_go(r, r->t + span));
    return (r->statistics.accepted + r->statistics.rejected - before)
         / (1e3 * span);
}

/* Steps of a resting cell are thousands of times the 1e-7 s of its contact. */
static void test_rest_costs_nothing(void **unused)
{
    static contact_run r;
    wall_mesh corner;
    const double low[3] = {0, 0, 0}, high[3] = {30 * um, 30 * um, 30 * um};
    ellipsoid_options o = ellipsoid_options_default();

    (void)unused;
    o.friction = 0.3;
    contact_floor(&r, 100 * um);
    contact_start(&r, &o, 0);
    memset(&r.flow, 0, sizeof(r.flow));
    lay_cell(&r, cos(0.3), sin(0.3));
    assert_ok(contact_go(&r, 1));
    assert_true(steps_per_ms(&r, 1) < 0.02);
    wall_mesh_free(&r.mesh);

    /* pushed into a corner by the flow */
    wall_mesh_init(&corner);
    wall_mesh_box(&corner, low, high, 1, 0, 0);
    wall_mesh_finish(&corner);
    r.mesh = corner;
    contact_start(&r, &o, 0);
    ellipsoid_set(r.flow.u, -2e-3, -1e-3, -2e-3);
    lay_cell(&r, cos(0.3), sin(0.3));
    ellipsoid_set(r.state.x, 3 * um, 3 * um, 3 * um);
    assert_ok(contact_go(&r, 0.1));
    assert_true(steps_per_ms(&r, 0.1) < 0.1);
    assert_true(ellipsoid_length(r.state.u) < 1e-9);
    wall_mesh_free(&r.mesh);
}

/*
    A cell that rolls along a wall in shear comes down on the next ring's bead
    about every 0.5 ms; friction may cost a third more steps than sliding does.
    A ball rolls smoothly: at the speed of its surface.
*/
static void test_rolling_does_not_chatter(void **unused)
{
    static contact_run r;
    ellipsoid_options o = ellipsoid_options_default();
    double steps[2];

    (void)unused;
    contact_floor(&r, 400 * um);
    r.flow = (test_quadratic){.answer = 0};
    r.flow.g[0][2] = 1000;
    for (int rough = 0; rough < 2; rough++)
    {
        o.friction = rough ? 0.3 : 0;
        o.external_force[2] = -2e-11;
        contact_start(&r, &o, 0);
        lay_cell(&r, 0, 1);
        assert_ok(contact_go(&r, 0.01));
        steps[rough] = steps_per_ms(&r, 0.05);
    }
    print_message("steps per ms: %.1f sliding, %.1f rolling\n", steps[0],
                  steps[1]);
    assert_true(steps[1] < 1.34 * steps[0]);

    o = contact_ball(0.5 * um, 1040);
    o.friction = 0.3;
    o.external_force[2] = -2e-11;
    o.fluid_density = 997.5;
    contact_start(&r, &o, 0);
    r.state.x[2] = 0.5 * um;
    assert_ok(contact_go(&r, 0.01));
    assert_true(steps_per_ms(&r, 0.05) < 20);
    assert_relative(r.state.omega[1] * 0.5 * um, r.state.u[0], 0.05);
    wall_mesh_free(&r.mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ball_on_an_incline),
        cmocka_unit_test(test_held_cell_creeps_little),
        cmocka_unit_test(test_rest_costs_nothing),
        cmocka_unit_test(test_rolling_does_not_chatter),
    };

    return cmocka_run_group_tests_name("friction", tests, NULL, NULL);
}
