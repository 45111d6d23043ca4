/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_adhesion.c - cells held at a wall by adhesion, and the rest of a heavy
    ellipsoid on it: Hertz, F = 4/3 E* sqrt(R) d^1.5 (Johnson, Contact Mechanics
    (1985), eq. 4.23) against weight, pull and adhesion.
*/
#include "contactTest.h"
#include "roomTest.h"

static const double pull = 2e-12; /* [N] */

static ellipsoid_options cell_of(ellipsoid_contact_shape shape, double adhesion)
{
    ellipsoid_options options = test_paper_options();

    options.contact_shape = shape;
    options.adhesion = adhesion;
    return options;
}

/* Standing on its pole, so that one bead touches, or lying. */
static void orient(int standing, double q[4])
{
    const double up[3] = {0, 0, 1}, along[3] = {1, 0, 0};

    ellipsoid_quaternion_from_axis(standing ? up : along, 0, q);
}

static ellipsoid_surroundings around(wall_mesh *mesh, test_quadratic *flow)
{
    const ellipsoid_surroundings surroundings = {
        .flow = flow ? test_quadratic_flow : NULL,
        .flow_context = flow,
        .walls = wall_mesh_list,
        .walls_context = mesh};

    return surroundings;
}

static void advance_to(const ellipsoid_model *model,
                       const ellipsoid_surroundings *surroundings,
                       ellipsoid_state *state, double end)
{
    static ellipsoid_facet_cache cache;
    ellipsoid_controller controller = {0, 0};
    ellipsoid_statistics statistics = {0};
    double t = 0;

    ellipsoid_facet_cache_clear(&cache);
    assert_ok(ellipsoid_advance(&(ellipsoid_member){model, surroundings, state,
                                                    &controller, &cache, NULL,
                                                    &statistics},
                                &t, end, NULL));
}

/* Lying under its weight in fluid at rest; slightly tilted at first. */
static void test_rests_at_hertz_depth(void **unused)
{
    ellipsoid_options options = cell_of(ELLIPSOID_CONTACT_ELLIPSOID, 0);
    wall_mesh mesh = room_of(0);
    test_quadratic still = {.answer = 0};
    const ellipsoid_surroundings surroundings = around(&mesh, &still);
    const double axis[3] = {cos(0.02), 0, sin(0.02)};
    ellipsoid_state state = {.x = {-3 * um, 1 * um, 0.52 * um}};

    (void)unused;
    options.density = 5000;
    options.tolerance = 1e-8;
    ellipsoid_quaternion_from_axis(axis, 0.3, state.q);

    const ellipsoid_model model = test_model(&options);
    const double weight = (model.mass - model.fluid_mass) * 9.81;
    const double stiffness =
        4.0 / 3 * options.contact_modulus * sqrt(options.bead_radius);
    const double depth = pow(weight / stiffness, 2.0 / 3);
    double rotation[3][3];

    advance_to(&model, &surroundings, &state, 20);
    ellipsoid_rotation(state.q, rotation);
    /* upright axes are principal: 1e-8 of the depth by second order */
    assert_near(rotation[2][1], 0, 1e-9);
    assert_relative(options.semi_axes[0] - state.x[2], depth, 1e-6);
    wall_mesh_free(&mesh);
}

/* The most that the walls pull with, as the cell is drawn off: the given one,
   at no overlap, and nothing beyond the range. */
static void test_pull_off_force(void **unused)
{
    wall_mesh mesh = room_of(0);
    const ellipsoid_surroundings surroundings = around(&mesh, NULL);
    static ellipsoid_facet_cache cache;

    (void)unused;
    for (int shape = 0; shape < 2; shape++)
    {
        const ellipsoid_options options = cell_of(
            shape ? ELLIPSOID_CONTACT_ELLIPSOID : ELLIPSOID_CONTACT_BEADS,
            pull);
        const ellipsoid_model model = test_model(&options);
        double strongest = 0, work = 0, q[4];

        orient(1, q);
        ellipsoid_facet_cache_clear(&cache);
        for (int n = -2000; n <= 4000; n++)
        {
            const double gap = n * 1e-11;
            const double x[3] = {-3 * um, 1 * um, 2 * um + gap};
            ellipsoid_contact contact;

            assert_ok(evaluate_pose(&model, &surroundings, x, q, &cache,
                                    &contact, NULL));
            assert_near(contact.gap, gap, 1e-20);
            strongest = fmin(strongest, contact.force[2]);
            if (n >= 0)
            {
                work -= contact.force[2] * 1e-11;
            }
            if (fabs(gap - 20e-9) < 1e-15)
            {
                continue; /* either, by rounding */
            }
            assert_int_equal(contact.bead_contacts, gap < 20e-9);
            if (gap > 20e-9)
            {
                assert_true(contact.force[2] == 0);
            }
        }
        assert_relative(strongest, -pull, 1e-9);
        /* integral of (1-t)^2 (1+2t) is 1/2; the first sample counts twice */
        assert_relative(work, pull * (10e-9 + 0.5e-11), 1e-6);
    }
    wall_mesh_free(&mesh);
}

/* Drawn with a little less than the pull-off force a cell stays, with a little
   more it leaves. */
static void test_pulled_off(void **unused)
{
    wall_mesh mesh = room_of(0);
    test_quadratic still = {.answer = 0};
    const ellipsoid_surroundings surroundings = around(&mesh, &still);

    (void)unused;
    for (int n = 0; n < 8; n++)
    {
        ellipsoid_options options = cell_of(n & 1 ? ELLIPSOID_CONTACT_ELLIPSOID
                                                  : ELLIPSOID_CONTACT_BEADS,
                                            pull);
        ellipsoid_state state = {.x = {-3 * um, 1 * um, 1.999 * um}};

        options.motion =
            n & 4 ? ELLIPSOID_MOTION_INERTIALESS : ELLIPSOID_MOTION_INERTIAL;
        options.buoyancy = 0;
        options.tolerance = 1e-6; /* a step's error must not pull it off */
        options.external_force[2] = (n & 2 ? 1.01 : 0.99) * pull;
        orient(1, state.q);

        const ellipsoid_model model = test_model(&options);

        advance_to(&model, &surroundings, &state, 0.3);
        if (n & 2)
        {
            assert_true(state.x[2] > 2.1 * um);
        }
        else
        {
            /* where Hertz bears a hundredth of the pull */
            const double depth =
                pow(0.01 * pull / (4.0 / 3 * 1e6 * sqrt(0.285 * um)), 2.0 / 3);

            assert_relative(2 * um - state.x[2], depth, 1e-4);
        }
    }
    wall_mesh_free(&mesh);
}

/* As without adhesion, with pulling contacts mixed in. */
static void test_adhesion_jacobian(void **unused)
{
    wall_mesh mesh = room_of(0);
    const ellipsoid_surroundings surroundings = around(&mesh, NULL);
    static ellipsoid_facet_cache cache;

    (void)unused;
    for (int shape = 0; shape < 2; shape++)
    {
        ellipsoid_options options = cell_of(shape ? ELLIPSOID_CONTACT_ELLIPSOID
                                                  : ELLIPSOID_CONTACT_BEADS,
                                            1e-8);
        uint64_t seed = 8;
        int checked = 0;

        options.adhesion_range = 0.2 * um;

        const ellipsoid_model model = test_model(&options);

        ellipsoid_facet_cache_clear(&cache);
        for (int n = 0; n < 5000; n++)
        {
            double y[7];

            random_pose(&seed, y, y + 3);
            checked += assert_jacobian(&model, &surroundings, &cache, y, 1e-3);
        }
        assert_true(checked > 300);
    }
    wall_mesh_free(&mesh);
}

/* Thrown at the floor askew, in vacuum: its energy comes back, part of it as
   spin, and the well of the adhesion, a tenth of it, is climbed again. */
static void test_bounce_keeps_energy(void **unused)
{
    wall_mesh mesh = room_of(0);
    const ellipsoid_surroundings surroundings = around(&mesh, NULL);
    static ellipsoid_facet_cache cache;
    double kept = 0;

    (void)unused;
    for (int n = 0; n < 9; n++)
    {
        ellipsoid_options options = cell_of(ELLIPSOID_CONTACT_ELLIPSOID, 1e-11);
        const double axis[3] = {cos(0.7 * (n % 3)), 0, sin(0.7 * (n % 3))};
        ellipsoid_state state = {.u = {0, 0, -0.1},
                                 .x = {-3 * um, 1 * um, 2.3 * um},
                                 .omega = {1e3, 2e3, 3e3}};
        ellipsoid_controller controller = {0, 0};
        ellipsoid_statistics statistics = {0};
        double t = 0;

        options.drag = 0;
        options.buoyancy = 0;
        options.adhesion_range = 0.2 * um;
        options.contact_modulus = 1e4;
        options.tolerance = n < 3 ? 1e-7 : n < 6 ? 1e-8 : 1e-9;
        ellipsoid_quaternion_from_axis(axis, 0.3, state.q);

        const ellipsoid_model model = test_model(&options);
        const double before = contact_energy(&model, &state);

        assert_true(1e-11 * 0.1 * um > 0.05 * before);
        ellipsoid_facet_cache_clear(&cache);
        assert_ok(ellipsoid_advance(
            &(ellipsoid_member){&model, &surroundings, &state, &controller,
                                &cache, NULL, &statistics},
            &t, 40e-6, NULL));
        assert_true(statistics.deepest > 0.02 * um);
        assert_true(state.x[2] > 2.1 * um && state.u[2] > 0);
        kept = fmax(kept, fabs(contact_energy(&model, &state) / before - 1)
                              / options.tolerance);
    }
    print_message("# energy kept to %.2g times the tolerance\n", kept);
    assert_true(kept < 10);
    wall_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rests_at_hertz_depth),
        cmocka_unit_test(test_pull_off_force),
        cmocka_unit_test(test_pulled_off),
        cmocka_unit_test(test_adhesion_jacobian),
        cmocka_unit_test(test_bounce_keeps_energy),
    };

    return cmocka_run_group_tests_name("adhesion", tests, NULL, NULL);
}
