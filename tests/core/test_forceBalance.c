/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_forceBalance.c - velocities that balance friction and damping as well: of a
    cell, of two, without inertia and over the layer of the noise.
*/
#include "contactTest.h"

#include <stdlib.h>

static const double um = 1e-6;

/* Every test is run for both shapes. */
static ellipsoid_contact_shape shape;

static int by_beads(void **unused)
{
    (void)unused;
    shape = ELLIPSOID_CONTACT_BEADS;
    return 0;
}

static int by_itself(void **unused)
{
    (void)unused;
    shape = ELLIPSOID_CONTACT_ELLIPSOID;
    return 0;
}

static ellipsoid_options rough_cell(ellipsoid_motion motion)
{
    ellipsoid_options o = test_paper_options();

    o.motion = motion;
    o.contact_shape = shape;
    o.friction = 0.4;
    o.contact_damping = 50;
    return o;
}

/*
    At poses that touch, by up to 0.1 um: forces 1e-10 N and more, of which
    rounding leaves 1e-16, cancel to 1e-12 of their sum; what is left is the
    gyroscopic torque, for which no balance asks. What is given as u and
    omega does not matter. Pressed on fast, whole steps of Newton's method go
    too far.
*/
static void test_nothing_is_left(void **unused)
{
    static contact_run r;
    const ellipsoid_options o = rough_cell(ELLIPSOID_MOTION_INERTIAL);
    uint64_t seed = 41;
    int touched = 0;

    (void)unused;
    contact_floor(&r, 100 * um);
    r.flow = test_shear(0);
    r.flow.g[0][2] = 1000;
    contact_start(&r, &o, 0);
    for (int n = 0; n < 3000; n++)
    {
        ellipsoid_state slope, other;
        ellipsoid_contact contact;
        double size;

        r.flow.u[2] = n % 2 ? -1e-3 : -0.1;
        test_orientation(&seed, r.state.q);
        ellipsoid_set(r.state.x, 0, 0, (0.4 + 1.5 * test_uniform(&seed)) * um);
        contact = contact_now(&r);
        if (contact.bead_contacts == 0 || contact.deepest > 0.1 * um)
        {
            continue;
        }
        touched++;
        other = r.state;
        ellipsoid_set(other.u, 1, -2, 3);
        ellipsoid_set(other.omega, 1e5, 1e4, 1e3);
        assert_ok(ellipsoid_balance(&r.model, &r.around, &r.state, &r.cache));
        assert_ok(ellipsoid_balance(&r.model, &r.around, &other, &r.cache));
        assert_memory_equal(&other, &r.state, sizeof(other));
        assert_ok(
            ellipsoid_rhs(&r.model, &r.around, &r.state, &r.cache, &slope));
        contact = contact_now(&r);
        size = ellipsoid_length(contact.force) + 1e-12;
        for (int i = 0; i < 3; i++)
        {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            const double gyroscopic = (r.model.inertia[j] - r.model.inertia[k])
                                    * r.state.omega[j] * r.state.omega[k];

            assert_near(r.model.mass * slope.u[i], 0, 1e-11 * size);
            assert_near(r.model.inertia[i] * slope.omega[i], gyroscopic,
                        1e-11 * size * um);
        }
    }
    assert_true(touched > 100);
    wall_mesh_free(&r.mesh);
}

/* Roll, slide and stick: the cell gets as far with inertia as without. They
   differ by a relaxation time of the start, 1e-7 s at 1 mm/s. */
static void test_with_and_without_inertia(void **unused)
{
    static const double across[] = {1, 0, 0.9};
    static contact_run r;

    (void)unused;
    contact_floor(&r, 400 * um);
    for (int n = 0; n < 3; n++)
    {
        ellipsoid_state end[2];

        r.flow = test_shear(0);
        r.flow.g[0][2] = n == 1 ? 0 : 1000;
        r.flow.u[0] = n == 1 ? 1e-3 : 0;
        for (int k = 0; k < 2; k++)
        {
            const double axis[3] = {sqrt(1 - across[n] * across[n]), across[n],
                                    0};
            ellipsoid_options o = rough_cell(k ? ELLIPSOID_MOTION_INERTIALESS
                                               : ELLIPSOID_MOTION_INERTIAL);

            o.external_force[2] = -2e-11;
            contact_start(&r, &o, 0);
            ellipsoid_quaternion_from_axis(axis, 0.4, r.state.q);
            r.state.x[2] = 0.5 * um;
            assert_ok(contact_go(&r, 0.02));
            end[k] = r.state;
        }
        for (int i = 0; i < 3; i++)
        {
            assert_near(end[1].x[i], end[0].x[i], 2e-3 * um);
        }
        for (int i = 0; i < 4; i++)
        {
            assert_near(end[1].q[i], end[0].q[i], 1e-3);
        }
    }
    wall_mesh_free(&r.mesh);
}

static int note_touch(void *context, const ellipsoid_step *step)
{
    *(int *)context += step->contact.cell_count > 0;
    return 0;
}

/* Two cells that a flow presses together and shears, likewise. */
static void test_two_cells(void **unused)
{
    void *memory = malloc(ellipsoid_group_size(2));
    ellipsoid_state end[2][2];
    test_quadratic flow = test_shear(30);

    (void)unused;
    for (int i = 0; i < 3; i++)
    {
        flow.g[i][i] = i == 1 ? -40 : 20;
    }
    for (int k = 0; k < 2; k++)
    {
        const ellipsoid_options o = rough_cell(k ? ELLIPSOID_MOTION_INERTIALESS
                                                 : ELLIPSOID_MOTION_INERTIAL);
        const ellipsoid_model model = test_model(&o);
        ellipsoid_surroundings around[2];
        ellipsoid_controller controller[2] = {{0}};
        ellipsoid_statistics statistics[2] = {{0}};
        ellipsoid_member members[2];
        double t = 0;
        int which, touching = 0;

        for (int n = 0; n < 2; n++)
        {
            ellipsoid_state *s = &end[k][n];
            const double axis[3] = {0.6, 0, n ? 0.8 : -0.8};

            around[n] = (ellipsoid_surroundings){.flow = test_quadratic_flow,
                                                 .flow_context = &flow,
                                                 .id = (uint32_t)n};
            memset(s, 0, sizeof(*s));
            ellipsoid_quaternion_from_axis(axis, 0.2, s->q);
            ellipsoid_set(s->x, 0.1 * um, (n ? 0.6 : -0.6) * um, 0);
            members[n] = (ellipsoid_member){
                &model,    &around[n],    s, &controller[n], NULL,
                &touching, &statistics[n]};
        }
        assert_ok(ellipsoid_advance_group(2, members, &t, 0.02, note_touch,
                                          memory, &which));
        assert_true(touching > 0);
    }
    for (int n = 0; n < 2; n++)
    {
        for (int i = 0; i < 3; i++)
        {
            assert_near(end[1][n].x[i], end[0][n].x[i], 2e-3 * um);
        }
        for (int i = 0; i < 4; i++)
        {
            assert_near(end[1][n].q[i], end[0][n].q[i], 2e-3);
        }
    }
    free(memory);
}

/*
    Brownian motion of a cell that is pressed to a wall: with inertia the jump
    of the noise is crossed in no time, to velocities that balance friction, too.
    Without inertia there is no layer. The same noise leads to the same places.
*/
static void test_brownian_layer(void **unused)
{
    static contact_run r;
    ellipsoid_state end[2];

    (void)unused;
    contact_floor(&r, 100 * um);
    r.flow = test_shear(0);
    for (int k = 0; k < 2; k++)
    {
        ellipsoid_options o = rough_cell(k ? ELLIPSOID_MOTION_INERTIALESS
                                           : ELLIPSOID_MOTION_INERTIAL);

        o.brownian = 1;
        o.external_force[2] = -5e-12;
        contact_start(&r, &o, 0);
        r.around.seed = 7;
        r.state.q[3] = 1;
        r.state.x[2] = 0.5 * um;
        assert_ok(contact_go(&r, 0.1));
        end[k] = r.state;
        assert_true(r.statistics.accepted < 3000);
        print_message("# %ld steps in 100 intervals, %ld rejected\n",
                      r.statistics.accepted, r.statistics.rejected);
    }
    for (int i = 0; i < 3; i++)
    {
        assert_near(end[1].x[i], end[0].x[i], 2e-3 * um);
    }
    wall_mesh_free(&r.mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_nothing_is_left, by_beads),
        cmocka_unit_test_setup(test_with_and_without_inertia, by_beads),
        cmocka_unit_test_setup(test_two_cells, by_beads),
        cmocka_unit_test_setup(test_brownian_layer, by_beads),
        cmocka_unit_test_setup(test_nothing_is_left, by_itself),
        cmocka_unit_test_setup(test_with_and_without_inertia, by_itself),
        cmocka_unit_test_setup(test_two_cells, by_itself),
        cmocka_unit_test_setup(test_brownian_layer, by_itself),
    };

    return cmocka_run_group_tests_name("balance", tests, NULL, NULL);
}
