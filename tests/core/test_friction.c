/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_friction.c - bodies that roll, slide, stick and stand with friction,
    and what that costs.
*/
#include "contactTest.h"

static const double um = 1e-6;
static const double g = 9.81;
static const ellipsoid_contact_shape shapes[] = {ELLIPSOID_CONTACT_BEADS,
                                                 ELLIPSOID_CONTACT_ELLIPSOID};

/* ------------------------------------------------------------- an incline */

/* A ball of 1 cm on a floor, gravity turned by an angle; starts in balance. */
static void on_incline(contact_run *r, ellipsoid_contact_shape shape,
                       double angle, double friction)
{
    ellipsoid_options o = contact_ball(0.01, 1000);
    double weight;

    o.contact_shape = shape;
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
    about a slip speed, 1e-6 m/s, of velocities of 0.07 m/s and more. The ball
    is a bead, then a sphere.
*/
static void test_ball_on_an_incline(void **unused)
{
    static const double angle[] = {0.1, 0.5, 1, 0.6, 1, 1.3};
    static const double friction[] = {0.3, 0.3, 0.5, 0.1, 0.1, 0.3};
    static contact_run r;

    (void)unused;
    contact_floor(&r, 10);
    for (int k = 0; k < 12; k++)
    {
        const int n = k / 2;
        const double s = sin(angle[n]), c = cos(angle[n]);
        const int rolls = s / c < 3.5 * friction[n];
        const double faster =
            rolls ? 5.0 / 7 * g * s : g * (s - friction[n] * c);
        const double turning =
            rolls ? faster / 0.01 : 2.5 * friction[n] * g * c / 0.01;
        /* the friction that rolling needs over that of sliding */
        const double part = 2.0 / 7 * s / c / friction[n];

        assert_int_equal(rolls, n < 3);
        on_incline(&r, shapes[k % 2], angle[n], friction[n]);
        assert_ok(contact_go(&r, 0.1));
        assert_relative(r.state.u[0], 0.1 * faster, 2e-5);
        assert_relative(r.state.omega[1], 0.1 * turning, 2e-5);
        assert_relative(contact_now(&r).slip,
                        rolls
                            ? r.model.options.slip_speed / sqrt(1 - part * part)
                            : 0.1 * (faster - 0.01 * turning),
                        1e-4);
    }
    wall_mesh_free(&r.mesh);
}

/*
    An ellipsoid with its long axis down the incline, in water. The contact's
    force points to the centre where it stands: with t the tangent of its tilt
    and alpha the angle between force and normal,
        (b/a)^2 tan(alpha) t^2 - ((b/a)^2 - 1) t + tan(alpha) = 0.
    Below the friction angle the force is opposite to the weight, and it creeps
    at v_s s/sqrt(mu^2 c^2 - s^2). Above, alpha is the friction angle and
        u (K_xx + mu K_zx) = W (s - mu c)/viscosity.
    The slip speed, 1e-9 m/s, is 2e-5 of the speed of sinking: of the weight the
    drag takes no more off the friction, and the speed changes by 9 times that.
*/
static void test_ellipsoid_on_an_incline(void **unused)
{
    static const double angle[] = {0.2, 0.5, 0.2, 0.5};
    static const double friction[] = {0.3, 0.8, 0.1, 0.4};
    static contact_run r;

    (void)unused;
    contact_floor(&r, 1000 * um);
    memset(&r.flow, 0, sizeof(r.flow));
    for (int n = 0; n < 8; n++)
    {
        const double s = sin(angle[n / 2]), c = cos(angle[n / 2]);
        const double mu = friction[n / 2];
        const int stays = s / c < mu;
        const double leaning = stays ? s / c : mu;
        const double tilt =
            (15 - sqrt(225 - 64 * leaning * leaning)) / (32 * leaning);
        const double along[3] = {1, 0, 0};
        ellipsoid_options o = test_paper_options();
        double weight, drag_x, drag_z, speed, axis[3];

        o.contact_shape = ELLIPSOID_CONTACT_ELLIPSOID;
        o.motion =
            n % 2 ? ELLIPSOID_MOTION_INERTIALESS : ELLIPSOID_MOTION_INERTIAL;
        o.friction = mu;
        o.slip_speed = 1e-9;
        ellipsoid_set(o.gravity, 1e4 * s, 0, -1e4 * c);
        contact_start(&r, &o, 0);
        ellipsoid_quaternion_from_axis(along, 0.4, r.state.q);
        r.state.x[2] = 0.5 * um;
        assert_ok(contact_go(&r, 5));

        weight = ellipsoid_length(r.model.constant_force);
        test_long_axis(&r.state, axis);
        assert_relative(fabs(axis[2] / axis[0]), tilt, 1e-3);
        drag_x = r.model.resistance[1] * axis[0] * axis[0]
               + r.model.resistance[0] * axis[2] * axis[2];
        drag_z =
            (r.model.resistance[1] - r.model.resistance[0]) * axis[0] * axis[2];
        speed = stays ? o.slip_speed * s / sqrt(mu * mu * c * c - s * s)
                      : weight * (s - mu * c)
                            / (r.model.viscosity * (drag_x + mu * drag_z));
        assert_relative(r.state.u[0], speed, 1e-3);
        assert_true(ellipsoid_length(r.state.omega) < 1e-3);
        /* 100 to come to rest; 10^5 where errors are above the slip speed */
        assert_true(r.statistics.accepted < 300);
    }
    wall_mesh_free(&r.mesh);
}

/*
    A sphere that adhesion A holds at a floor, without weight, is pulled along
    it by D, and a torque of the friction's size keeps it from rolling: friction
    is of mu A, the push that bears the pull. It slips at
    v_s D/sqrt((mu A)^2 - D^2), of which it creeps 4/7 and spins 3/7, as the
    drags 6 pi r u and 8 pi r^2 (omega r) go; these take 1e-5 of D. Or it slides
    at (D - mu A)/(6 pi mu r), up to the slip speed.
*/
static void test_adhesion_bears_friction(void **unused)
{
    static contact_run r;
    const double adhesion = 1e-11;
    const double resistance = 6 * test_pi * 997.5e-6 * 0.5 * um;

    (void)unused;
    contact_floor(&r, 1000 * um);
    memset(&r.flow, 0, sizeof(r.flow));
    for (int n = 0; n < 8; n++)
    {
        const double held = 0.4 * adhesion;
        const double pull = n / 4 ? 1.5 * held : 0.8 * held;
        ellipsoid_options o = contact_ball(0.5 * um, 1000);

        o.contact_shape = shapes[n % 2];
        o.motion = n / 2 % 2 ? ELLIPSOID_MOTION_INERTIALESS
                             : ELLIPSOID_MOTION_INERTIAL;
        o.fluid_density = 997.5;
        o.buoyancy = 0;
        o.friction = 0.4;
        o.slip_speed = 1e-8;
        o.adhesion = adhesion;
        o.external_force[0] = pull;
        o.external_torque[1] = -fmin(pull, held) * 0.5 * um;
        contact_start(&r, &o, 0);
        r.state.x[2] = 0.5 * um;
        assert_ok(contact_go(&r, 1e-3));
        assert_relative(r.state.u[0],
                        n / 4 ? (pull - held) / resistance
                              : 4.0 / 7 * o.slip_speed * 0.8 / 0.6,
                        1e-3);
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
    ellipsoid_options o = test_paper_options();
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
    ellipsoid_options o = test_paper_options();

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
    ellipsoid_options o = test_paper_options();
    double steps[2];

    (void)unused;
    contact_floor(&r, 400 * um);
    r.flow = (test_quadratic){.answer = 0};
    r.flow.g[0][2] = 1000;
    for (int rough = 0; rough < 2; rough++)
    {
        o.friction = rough ? 0.3 : 0;
        o.external_force[2] = -2e-11;
        o.tolerance = 1e-6;
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

/* Of two balls of different size one spins: the contact point divides the line
   of centres as the radii do, and so do the torques. */
static void test_unequal_balls(void **unused)
{
    const double radius[2] = {1, 0.4}, distance = 1.4 - 1e-3;
    ellipsoid_model model[2];
    ellipsoid_state state[2];
    double bead[2][ELLIPSOID_MAX_BEADS][3], centre[3];
    ellipsoid_body body[2] = {{.bead = bead[0]}, {.bead = bead[1]}};
    ellipsoid_pair_wrench wrench[2];
    ellipsoid_near_pair near;

    (void)unused;
    memset(state, 0, sizeof(state));
    for (int n = 0; n < 2; n++)
    {
        ellipsoid_options o = contact_ball(radius[n], 1);

        o.friction = 0.3;
        o.slip_speed = 1e-6;
        model[n] = test_model(&o);
        state[n].q[3] = 1;
        state[n].x[0] = n * distance;
        ellipsoid_place_body(&body[n], &model[n], state[n].x, state[n].q);
    }
    state[1].omega[2] = 1;

    ellipsoid_pair_contact m = {
        .a = &body[0],
        .b = &body[1],
        .state_a = &state[0],
        .state_b = &state[1],
        .normal_law = ellipsoid_pair_law(&model[0].options, &model[1].options),
        .law = ellipsoid_friction_law_between(&model[0], &model[1]),
        .dissipative = 1,
        .gap = 1e-2,
        .slip = HUGE_VAL,
        .of_a = &wrench[0],
        .of_b = &wrench[1]};

    ellipsoid_list_beads(&body[0], &body[1], 1e-2, &near);
    ellipsoid_pair_contact_evaluate(&m, &near);
    assert_int_equal(m.contacts, 1);
    assert_relative(m.slip, 0.4 * distance / 1.4, 1e-9);
    for (int n = 0; n < 2; n++)
    {
        const double *f = wrench[n].force, arm = radius[n] * distance / 1.4;

        assert_relative(fabs(f[1]), 0.3 * fabs(f[0]), 1e-9);
        ellipsoid_set(centre, n ? -arm : arm, 0, 0);
        assert_relative(wrench[n].torque[2], centre[0] * f[1], 1e-9);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ball_on_an_incline),
        cmocka_unit_test(test_ellipsoid_on_an_incline),
        cmocka_unit_test(test_adhesion_bears_friction),
        cmocka_unit_test(test_held_cell_creeps_little),
        cmocka_unit_test(test_rest_costs_nothing),
        cmocka_unit_test(test_rolling_does_not_chatter),
        cmocka_unit_test(test_unequal_balls),
    };

    return cmocka_run_group_tests_name("friction", tests, NULL, NULL);
}
