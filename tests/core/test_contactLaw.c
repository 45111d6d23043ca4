/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_contactLaw.c - the normal force as a function of the gap, friction and
    damping, and what two unequal cells have between them.
*/
#include "contactTest.h"

#include <stdlib.h>

/* ------------------------------------------------------------ normal force */

/* Central differences of width h: their error is h^2/6 of a third derivative,
   which is below 200 here. */
static void assert_derivatives(const ellipsoid_contact_law *law, double gap)
{
    const double h = 1e-5;
    const ellipsoid_normal_force f = ellipsoid_contact_normal_force(law, gap);
    const ellipsoid_normal_force above =
        ellipsoid_contact_normal_force(law, gap + h);
    const ellipsoid_normal_force below =
        ellipsoid_contact_normal_force(law, gap - h);

    assert_near(f.force, -(above.energy - below.energy) / (2 * h), 1e-8);
    assert_near(f.slope, (above.force - below.force) / (2 * h), 1e-8);
}

static void assert_no_force(const ellipsoid_contact_law *law, double gap)
{
    const ellipsoid_normal_force f = ellipsoid_contact_normal_force(law, gap);

    assert_true(f.force == 0 && f.slope == 0 && f.energy == 0);
}

/* Hertz (1882): F = k d^(3/2), and what follows from it. */
static void test_hertz(void **unused)
{
    const double k = 3;
    const ellipsoid_contact_law law = ellipsoid_hertz_law(k);

    (void)unused;
    assert_true(law.range == 0 && !law.attractive);
    for (double d = 0.05; d < 2; d += 0.05)
    {
        const ellipsoid_normal_force f =
            ellipsoid_contact_normal_force(&law, -d);

        assert_relative(f.force, k * pow(d, 1.5), 1e-15);
        assert_relative(f.slope, -1.5 * k * pow(d, 0.5), 1e-15);
        assert_relative(f.energy, 0.4 * k * pow(d, 2.5), 1e-15);
        assert_relative(f.secant * d, f.force, 1e-15);
        assert_relative(-f.exponent * f.secant, f.slope, 1e-15);
        assert_derivatives(&law, -d);
        assert_no_force(&law, d);
    }
    assert_no_force(&law, 0);
}

/*
    docs/theory/contact.md: in full where surfaces overlap, a smoothstep
    1 - 3 t^2 + 2 t^3 from there to the range. Its integral over the range is
    half of it: the work against the pull from a gap of 0.
*/
static void test_adhesion(void **unused)
{
    const double pull = 0.7, range = 0.5;
    const ellipsoid_options o = {.adhesion = pull, .adhesion_range = range};
    const ellipsoid_contact_law law = ellipsoid_adhesion_at_wall(&o);

    (void)unused;
    assert_true(law.range == range && law.attractive);
    for (double gap = -0.4875; gap < range; gap += 0.025)
    {
        const ellipsoid_normal_force f =
            ellipsoid_contact_normal_force(&law, gap);
        const double t = fmax(0, gap / range);

        assert_near(f.force, -pull * (1 - 3 * t * t + 2 * t * t * t), 1e-15);
        assert_near(f.slope, 6 * pull / range * (t - t * t), 1e-15);
        assert_near(f.energy,
                    -pull * range * (0.5 - t + pow(t, 3) - pow(t, 4) / 2)
                        + pull * fmin(0, gap),
                    1e-15);
        assert_derivatives(&law, gap);
    }
    assert_relative(ellipsoid_contact_normal_force(&law, 0).energy,
                    -0.5 * pull * range, 1e-15);
    assert_no_force(&law, range);
    assert_no_force(&law, 2 * range);
}

/* 4/3 E* sqrt(R), and adhesion only if it is asked for. */
static void test_laws_of_options(void **unused)
{
    ellipsoid_options a = test_paper_options(), b = a;
    ellipsoid_wall_laws laws;

    (void)unused;
    ellipsoid_wall_laws_set(&laws, &a);
    assert_int_equal(laws.count, 1);
    assert_true(laws.range == 0);
    assert_relative(laws.law[0].strength,
                    4.0 / 3 * a.contact_modulus * sqrt(a.bead_radius), 1e-15);

    a.adhesion = 1e-12;
    ellipsoid_wall_laws_set(&laws, &a);
    assert_int_equal(laws.count, 2);
    assert_true(laws.range == a.adhesion_range);
    assert_true(laws.law[1].strength == a.adhesion);

    /* 1/R = 1/r_a + 1/r_b = 4/r_a, 1/E* = 1/E_a + 1/E_b = 5/E_a */
    b.bead_radius = a.bead_radius / 3;
    b.contact_modulus = a.contact_modulus / 4;
    assert_relative(ellipsoid_pair_law(&a, &b).strength,
                    4.0 / 3 * a.contact_modulus / 5 * sqrt(a.bead_radius / 4),
                    1e-15);
}

/* ---------------------------------------------------- friction and damping */

/* Coulomb: at slips far above the slip speed the friction is mu N, against the
   slip; far below it is mu N v/v_s. Hunt & Crossley (1975), eq. 8. */
static void test_limits_of_the_law(void **unused)
{
    const ellipsoid_friction_law law = {0.3, 1e-5, 20};
    const double push[3] = {0, 0, 2}, down[3] = {0, 0, -1e-3};
    const double fast[3] = {3e-3, 4e-3, 0}, slow[3] = {0, 1e-9, 0};
    const double away[3] = {1e-3, 0, 0.1};
    ellipsoid_traction t;

    (void)unused;
    assert_true(ellipsoid_contact_traction(&law, push, fast, 0, &t));
    /* 1 - (v_s/v)^2/2 = 1 - 2e-6 */
    assert_relative(t.force[0], -0.6 * 2 * 0.3, 3e-6);
    assert_relative(t.force[1], -0.8 * 2 * 0.3, 3e-6);
    assert_true(t.force[2] == 2);
    assert_true(ellipsoid_contact_traction(&law, push, slow, 0, &t));
    assert_relative(t.force[1], -2 * 0.3 * 1e-4, 1e-8);
    assert_true(ellipsoid_contact_traction(&law, push, down, 0, &t));
    assert_relative(t.force[2], 2 * (1 + 1.5 * 20 * 1e-3), 1e-15);
    /* a wall does not pull */
    assert_true(ellipsoid_contact_traction(&law, push, away, 0, &t));
    assert_true(ellipsoid_length(t.force) == 0);
}

/* Friction and damping take power, whatever the velocity. */
static void test_the_law_takes_power(void **unused)
{
    uint64_t seed = 11;

    (void)unused;
    for (int n = 0; n < 10000; n++)
    {
        const ellipsoid_friction_law law = {2 * test_uniform(&seed), 0.1,
                                            2 * test_uniform(&seed)};
        double push[3], velocity[3];
        ellipsoid_traction t;

        for (int i = 0; i < 3; i++)
        {
            push[i] = test_signed(&seed);
            velocity[i] = test_signed(&seed);
        }
        assert_true(ellipsoid_contact_traction(&law, push, velocity, 0, &t));
        assert_true(ellipsoid_dot(t.force, velocity)
                    <= ellipsoid_dot(push, velocity) + 1e-15);
    }
}

/*
    Two balls that slide over one another along x2 and part along x1, in vacuum.
    The traction is that of friction.c with the geometric mean of both
    coefficients, the larger slip speed and the mean damping; N by Hertz. Either
    ball comes first; beads, then spheres.
*/
static void test_unequal_cells(void **unused)
{
    const double friction[] = {0.2, 0.8}, slip_speed[] = {0.3, 0.1};
    const double damping[] = {0.5, 0.1}, slip = 0.4, parting = 0.25;
    const double overlap = 0.02;

    (void)unused;
    for (int k = 0; k < 4; k++)
    {
        const int first = k / 2;
        ellipsoid_model model[2];
        ellipsoid_surroundings around[2] = {{.id = 1}, {.id = 2}};
        ellipsoid_statistics statistics = {0};
        ellipsoid_group group;
        ellipsoid_pairs pairs;
        void *memory = malloc(ellipsoid_group_size(2));
        double normal, tangential, mu, speed;

        ellipsoid_group_lay_out(2, memory, &group, &pairs);
        group.inertial = 1;
        for (int n = 0; n < 2; n++)
        {
            const int kind = n == 0 ? first : 1 - first;
            ellipsoid_options o = contact_ball(1, 1);

            o.contact_shape =
                k % 2 ? ELLIPSOID_CONTACT_ELLIPSOID : ELLIPSOID_CONTACT_BEADS;
            o.buoyancy = 0;
            o.contact_modulus = 100;
            o.friction = friction[kind];
            o.slip_speed = slip_speed[kind];
            o.contact_damping = damping[kind];
            model[n] = test_model(&o);
            group.cell[n] = (ellipsoid_cell){.model = &model[n],
                                             .surroundings = around[n],
                                             .statistics = &statistics,
                                             .inertial = 1};
            memset(&group.start[n].state, 0, sizeof(group.start[n].state));
            group.start[n].state.q[3] = 1;
        }
        group.start[1].state.x[0] = overlap - 2;
        group.start[0].state.u[0] = parting;
        group.start[0].state.u[1] = slip;
        assert_ok(ellipsoid_group_evaluate(&group, 0, group.start, 0, 0));

        mu = sqrt(friction[0] * friction[1]);
        speed = fmax(slip_speed[0], slip_speed[1]);
        normal = 4.0 / 3 * 50 * sqrt(0.5) * pow(overlap, 1.5)
               * (1 - 1.5 * 0.5 * (damping[0] + damping[1]) * parting);
        tangential = -mu * normal * slip / sqrt(slip * slip + speed * speed);
        for (int n = 0; n < 2; n++)
        {
            const double sign = n == 0 ? 1 : -1;
            const double *force = group.start[n].contact.cell_force;

            /* the balls' radius is 1 - 1e-12: 1e-10 of the overlap */
            assert_relative(force[0], sign * normal, 1e-9);
            assert_relative(force[1], sign * tangential, 1e-9);
            assert_true(force[2] == 0);
            assert_relative(group.start[n].contact.cell_slip,
                            sqrt(slip * slip + speed * speed), 1e-9);
        }
        free(memory);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hertz),
        cmocka_unit_test(test_adhesion),
        cmocka_unit_test(test_laws_of_options),
        cmocka_unit_test(test_limits_of_the_law),
        cmocka_unit_test(test_the_law_takes_power),
        cmocka_unit_test(test_unequal_cells),
    };

    return cmocka_run_group_tests_name("contactLaw", tests, NULL, NULL);
}
