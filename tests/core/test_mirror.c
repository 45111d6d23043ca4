/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_mirror.c - a plane of symmetry acts on a cell that is pushed onto it as
    its mirror image does, the other cell of the whole device.
*/
#include "contact/contact.h"
#include "contactTest.h"

/* The image in x3 = 0 of a body that is its own mirror image along a body axis:
   half a turn about x3 after, and half a turn about that axis before. */
static ellipsoid_state image_of(const ellipsoid_state *state, int axis)
{
    const double e1 = state->q[0], e2 = state->q[1], e3 = state->q[2];
    const double turned[4] = {-e2, e1, state->q[3], -e3};
    double half[3] = {0, 0, 0};
    ellipsoid_state image = *state;

    half[axis] = 1;
    ellipsoid_spin(half, turned, image.q);
    image.x[2] *= -1;
    image.u[2] *= -1;
    for (int i = 0; i < 3; i++)
    {
        image.omega[i] *= i == axis ? 1 : -1;
    }
    return image;
}

/* Puts a cell so that it reaches by so much [m] over x3 = 0. */
static void put_in(const ellipsoid_model *model, double deep,
                   ellipsoid_state *state)
{
    double bead[ELLIPSOID_MAX_BEADS][3], low = HUGE_VAL;
    ellipsoid_body body = {.bead = bead};

    ellipsoid_place_body(&body, model, state->x, state->q);
    for (int n = 0; n < model->bead_count; n++)
    {
        low = fmin(low, bead[n][2] - model->options.bead_radius);
    }
    if (model->options.contact_shape == ELLIPSOID_CONTACT_ELLIPSOID)
    {
        double sum = 0;

        for (int i = 0; i < 3; i++)
        {
            const double reach = model->options.semi_axes[i] * body.r[2][i];

            sum += reach * reach;
        }
        low = -sqrt(sum);
    }
    state->x[2] = -low - deep;
}

/* The wrenches on a cell and on its image by one another. */
static void touch(const ellipsoid_model *model, const ellipsoid_state *cell,
                  const ellipsoid_state *image, ellipsoid_pair_wrench wrench[2])
{
    double bead[2][ELLIPSOID_MAX_BEADS][3];
    ellipsoid_body a = {.bead = bead[0]}, b = {.bead = bead[1]};
    ellipsoid_near_pair near;
    ellipsoid_pair_contact m = {
        .a = &a,
        .b = &b,
        .state_a = cell,
        .state_b = image,
        .normal_law = ellipsoid_pair_law(&model->options, &model->options),
        .law = ellipsoid_friction_law_between(model, model),
        .dissipative = 1,
        .gap = 1e-7,
        .of_a = &wrench[0],
        .of_b = &wrench[1]};

    ellipsoid_place_body(&a, model, cell->x, cell->q);
    ellipsoid_place_body(&b, model, image->x, image->q);
    ellipsoid_list_beads(&a, &b, 1e-7, &near);
    ellipsoid_pair_contact_evaluate(&m, &near);
    assert_true(m.contacts > 0);
}

/* At random poses and velocities, at a plane of symmetry and at a wall. */
static void compare(int shape)
{
    ellipsoid_options options = test_paper_options();
    uint64_t seed = 11;
    contact_run r;

    options.contact_shape = shape;
    options.contact_damping = 300;
    options.friction = 0.3;
    options.adhesion = 5e-12;
    contact_start(&r, &options, 1);
    contact_floor(&r, 1e-4);
    for (int n = 0; n < 200; n++)
    {
        const int axis = ellipsoid_mirror_axis(options.semi_axes);
        ellipsoid_state image;
        ellipsoid_contact at_plane, at_wall;
        ellipsoid_pair_wrench pair[2];
        double largest, apart[3];

        test_orientation(&seed, r.state.q);
        for (int i = 0; i < 3; i++)
        {
            r.state.u[i] = 3e-4 * test_signed(&seed);
            r.state.omega[i] = 100 * test_signed(&seed);
        }
        ellipsoid_set(r.state.x, 0, 0, 0);
        put_in(&r.model, 1e-9, &r.state);
        image = image_of(&r.state, axis);
        touch(&r.model, &r.state, &image, pair);
        for (int i = 0; i < r.mesh.count; i++)
        {
            r.mesh.facets[i].mirror = 0;
        }
        at_wall = contact_now(&r);
        for (int i = 0; i < r.mesh.count; i++)
        {
            r.mesh.facets[i].mirror = 1;
        }
        at_plane = contact_now(&r);

        largest = ellipsoid_length(pair[0].force);
        assert_true(largest > 0);
        for (int i = 0; i < 3; i++)
        {
            const double scale = i == axis ? 1 : -1;

            assert_near(at_plane.force[i], pair[0].force[i], 1e-8 * largest);
            assert_near(at_plane.torque[i], pair[0].torque[i],
                        1e-8 * largest * 2e-6);
            /* and the image likewise, mirrored */
            assert_near(pair[1].force[i], (i == 2 ? -1 : 1) * pair[0].force[i],
                        1e-8 * largest);
            assert_near(pair[1].torque[i], scale * pair[0].torque[i],
                        1e-8 * largest * 2e-6);
        }
        /* A wall has friction and adhesion, and half the damping. */
        ellipsoid_difference(at_wall.force, at_plane.force, apart);
        assert_true(ellipsoid_length(apart) > 1e-3 * largest);
        /* Nor does the plane pull within the range of adhesion. */
        put_in(&r.model, -1e-9, &r.state);
        at_plane = contact_now(&r);
        assert_int_equal(at_plane.bead_contacts, 0);
    }
    wall_mesh_free(&r.mesh);
}

static void test_beads(void **unused)
{
    (void)unused;
    compare(ELLIPSOID_CONTACT_BEADS);
}

static void test_ellipsoid(void **unused)
{
    (void)unused;
    compare(ELLIPSOID_CONTACT_ELLIPSOID);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_beads),
        cmocka_unit_test(test_ellipsoid),
    };

    return cmocka_run_group_tests_name("mirror", tests, NULL, NULL);
}
