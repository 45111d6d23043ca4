/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_bounce.c - impacts on a wall in vacuum: energy, duration, restitution.

    In vacuum the step control bounds errors of the velocities against the
    body's own energy, so that it is kept to a few times the tolerance.
*/
#include "contactTest.h"

/* Waits until the body has left the wall x3 = 0. */
static void bounce(contact_run *r)
{
    do
    {
        assert_ok(contact_go(r, r->t + 0.5));
    } while (r->state.u[2] < 0 || contact_now(r).bead_contacts > 0);
}

/* A ball, or a body at any angle that turns, at speed 1 towards the floor. */
static void throw_down(contact_run *r, int is_ball, double modulus,
                       double damping, uint64_t *seed)
{
    ellipsoid_options o = contact_ball(1, 1);

    if (!is_ball)
    {
        ellipsoid_set(o.semi_axes, 0.5, 2, 0.7);
        o.bead_count = 32;
        o.bead_radius = 0.3;
    }
    o.buoyancy = 0;
    o.contact_modulus = modulus;
    o.contact_damping = damping;
    contact_start(r, &o, 1);
    test_orientation(seed, r->state.q);
    ellipsoid_set(r->state.u, test_signed(seed), 0, -1);
    for (int i = 0; i < 3 && !is_ball; i++)
    {
        r->state.omega[i] = test_signed(seed);
    }
    r->state.x[2] = r->model.reach + 0.1;
}

/* Neither gained nor lost beyond ten times the tolerance. */
static void test_energy_is_kept(void **unused)
{
    static const double modulus[] = {1e3, 1e5, 1e7};
    static contact_run r;
    double worst = 0;
    uint64_t seed = 21;

    (void)unused;
    contact_floor(&r, 100);
    for (int n = 0; n < 300; n++)
    {
        double before, change;

        throw_down(&r, n % 2, modulus[n % 3], 0, &seed);
        before = contact_energy(&r.model, &r.state);
        bounce(&r);
        change = contact_energy(&r.model, &r.state) / before - 1;
        worst = fmax(worst, fabs(change) / r.model.options.tolerance);
    }
    print_message("# energy kept to %.2g times the tolerance\n", worst);
    assert_true(worst < 10);
    wall_mesh_free(&r.mesh);
}

static void test_damping_always_loses(void **unused)
{
    static contact_run r;
    uint64_t seed = 22;

    (void)unused;
    contact_floor(&r, 100);
    for (int n = 0; n < 100; n++)
    {
        double before;

        throw_down(&r, n % 2, n % 3 ? 1e3 : 1e5, n % 5 ? 1 : 0.1, &seed);
        before = contact_energy(&r.model, &r.state);
        bounce(&r);
        assert_true(contact_energy(&r.model, &r.state) < 0.999 * before);
    }
    wall_mesh_free(&r.mesh);
}

/* Nor does friction give any; it takes more than a tenth of it. */
static void test_friction_takes_energy(void **unused)
{
    static contact_run r;
    double kept = 0;
    uint64_t seed = 23;

    (void)unused;
    contact_floor(&r, 100);
    for (int n = 0; n < 100; n++)
    {
        double before, after;

        throw_down(&r, n % 2, 1e4, 0, &seed);
        r.model.options.friction = 0.4;
        r.model.options.slip_speed = 1e-3;
        r.model.dissipative = 1;
        before = contact_energy(&r.model, &r.state);
        bounce(&r);
        after = contact_energy(&r.model, &r.state);
        assert_true(after <= before * (1 + 10 * r.model.options.tolerance));
        kept += after / before / 100;
    }
    assert_true(kept < 0.9);
    wall_mesh_free(&r.mesh);
}

/*
    Hunt & Crossley (1975): m v dv/dd = -k d^1.5 (1 + c v), c = 3/2 alpha, from
    v_1 at d = 0 to -e v_1 there again; k cancels:
        c v_1 - ln(1 + c v_1) = -c e v_1 - ln(1 - c e v_1).
*/
static double restitution(double c_v)
{
    const double left = c_v - log1p(c_v);
    double low = 0, high = fmin(1, 1 / c_v);

    for (int n = 0; n < 100; n++)
    {
        const double e = 0.5 * (low + high);

        *(-c_v * e - log1p(-c_v * e) < left ? &low : &high) = e;
    }
    return low;
}

/* The closed form; and for small alpha v it is 1 - alpha v. */
static void test_restitution(void **unused)
{
    static const double damping[] = {1e-3, 0.03, 0.3, 1, 5};
    static contact_run r;
    uint64_t seed = 24;

    (void)unused;
    contact_floor(&r, 100);
    for (int n = 0; n < 5; n++)
    {
        double bounds;

        throw_down(&r, 1, 1e4, damping[n], &seed);
        bounce(&r);
        bounds = 10 * r.model.options.tolerance / r.statistics.deepest;
        assert_near(r.state.u[2], restitution(1.5 * damping[n]), bounds);
    }
    assert_near(restitution(1.5e-3), 1 - 1e-3, 2e-6);
    wall_mesh_free(&r.mesh);
}

/* Johnson, Contact Mechanics (1985), eq. 11.24: a ball of mass m and radius R
   on a wall touches for 2.87 (m^2/(R E*^2 v))^(1/5), 2.943 d/v to more digits. */
static void test_duration(void **unused)
{
    static const double modulus[] = {1e3, 1e5, 1e7};
    static contact_run r;
    uint64_t seed = 25;

    (void)unused;
    contact_floor(&r, 100);
    for (int n = 0; n < 3; n++)
    {
        const double e = modulus[n];
        double start, depth, end;

        throw_down(&r, 1, e, 0, &seed);
        start = r.state.x[2] - 1; /* the speed is 1 */
        depth =
            pow(1.25 * r.model.mass / contact_stiffness(&r.model.options), 0.4);
        bounce(&r);
        end = r.t - (r.state.x[2] - 1) / r.state.u[2];
        assert_relative(end - start,
                        2.87 * pow(r.model.mass * r.model.mass / (e * e), 0.2),
                        1e-3);
        /* integral of 2 dx/sqrt(1 - x^2.5) from 0 to 1; x errs by tolerance L
           in each of the steps of an impact */
        assert_near(end - start, 2.9432751843 * depth, 1e-5);
        assert_relative(r.statistics.deepest, depth, 0.05);
    }
    wall_mesh_free(&r.mesh);
}

/* What lies still has the energy of its contact, and errors count against that:
   steps are long, where those that trembling asks for would be hundreds. */
static void test_lying_still(void **unused)
{
    static contact_run r;
    ellipsoid_options o = contact_ball(1, 1);

    (void)unused;
    o.contact_modulus = 1e5;
    contact_floor(&r, 100);
    for (int n = 0; n < 2; n++)
    {
        double depth, period;

        contact_start(&r, &o, 1);
        depth = pow(r.model.mass * 9.81 / contact_stiffness(&o), 2.0 / 3);
        period = 2 * test_pi * sqrt(depth / 1.5 / 9.81);
        r.state.x[2] = 1 - depth * (1 + (n ? 1e-5 : 1e-7));
        assert_ok(contact_go(&r, 10 * period));
        assert_true(r.statistics.accepted < 20);
        assert_near(r.state.x[2], 1 - depth, 2e-5 * depth);
    }
    wall_mesh_free(&r.mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_energy_is_kept),
        cmocka_unit_test(test_damping_always_loses),
        cmocka_unit_test(test_friction_takes_energy),
        cmocka_unit_test(test_restitution),
        cmocka_unit_test(test_duration),
        cmocka_unit_test(test_lying_still),
    };

    return cmocka_run_group_tests_name("bounce", tests, NULL, NULL);
}
