/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_ellipsoidSeams.c - the walls' force on the ellipsoid itself does not depend
    on how they are cut and does not jump over seams, edges and corners.

    Lengths are in um and stiffness is 1: the paper's cell of 0.5 x 2 x 0.5.
*/
#include "roomTest.h"
#include "beadContactTest.h"

static ellipsoid_model cell_of(double adhesion)
{
    ellipsoid_options options = test_paper_options();

    options.contact_shape = ELLIPSOID_CONTACT_ELLIPSOID;
    ellipsoid_set(options.semi_axes, 0.5, 2, 0.5);
    options.bead_radius = 0.285;
    options.contact_modulus = 0.75 / sqrt(0.285);
    options.adhesion = adhesion;
    options.adhesion_range = 0.02;
    return test_model(&options);
}

static ellipsoid_facet_cache cache;

static void evaluate(const ellipsoid_model *model, wall_mesh *wall,
                     const double x[3], const double q[4],
                     ellipsoid_contact *contact)
{
    const ellipsoid_surroundings surroundings = {.walls = wall_mesh_list,
                                                 .walls_context = wall};

    assert_ok(evaluate_pose(model, &surroundings, x, q, &cache, contact, NULL));
}

/* Three cuts of one floor, over seams and vertices. */
static void test_flat_wall_however_cut(void **unused)
{
    wall_mesh walls[3] = {floor_of(4, 1, 0), floor_of(4, 1, 1),
                          floor_of(4, 40, 2)};
    uint64_t seed = 1;

    (void)unused;
    for (int adheres = 0; adheres < 2; adheres++)
    {
        const ellipsoid_model model = cell_of(0.001 * adheres);
        int touching = 0;

        for (int n = 0; n < 2000; n++)
        {
            const double tilt = 0.5 * test_pi * test_uniform(&seed);
            const double axis[3] = {cos(tilt), 0, sin(tilt)};
            const double h = hypot(0.5 * cos(tilt), 2 * sin(tilt));
            const double shift = 3.75 * sin(tilt) * cos(tilt) / h;
            double x[3] = {test_signed(&seed), test_signed(&seed),
                           h + 0.04 * test_signed(&seed)};
            double q[4];
            ellipsoid_contact contact[3];

            if (n % 2 == 0) /* its lowest point over an edge of the grid */
            {
                x[0] = 0.2 * floor(x[0] / 0.2) + shift;
            }
            if (n % 4 == 0) /* over a vertex */
            {
                x[1] = 0.2 * floor(x[1] / 0.2);
            }
            if (n % 4 == 1) /* over the diagonals */
            {
                x[1] = n % 8 == 1 ? x[0] - shift : shift - x[0];
            }
            ellipsoid_quaternion_from_axis(axis, test_signed(&seed), q);
            for (int w = 0; w < 3; w++)
            {
                ellipsoid_facet_cache_clear(&cache);
                evaluate(&model, &walls[w], x, q, &contact[w]);
                assert_near(distance(contact[w].force, contact[0].force), 0,
                            1e-12 * 0.01);
                assert_near(distance(contact[w].torque, contact[0].torque), 0,
                            1e-12 * 0.01);
                assert_near(contact[w].gap, contact[0].gap, 1e-15);
            }
            touching += contact[0].bead_contacts;
        }
        assert_true(touching > 500);
    }
    for (int w = 0; w < 3; w++)
    {
        wall_mesh_free(&walls[w]);
    }
}

/* Moves the cell up or down until its deepest overlap is `depth`: by no more
   than the gap, so that it does not fall through. */
static void settle(const ellipsoid_model *model, wall_mesh *wall, double depth,
                   double x[3], const double q[4], ellipsoid_contact *contact)
{
    for (int n = 0; n < 80; n++)
    {
        evaluate(model, wall, x, q, contact);

        const double rise = -depth - contact->gap;

        if (fabs(rise) < 1e-14)
        {
            break;
        }
        x[2] += rise;
    }
    assert_near(contact->gap, -depth, 1e-12);
}

/* The largest change of force and torque between samples of a path along x
   with a turn of the cell, at one deepest overlap. */
static double largest_change(const ellipsoid_model *model, wall_mesh *wall,
                             const double angle[2], const double span[2],
                             double depth, int samples)
{
    ellipsoid_contact contact, before = {.gap = 0};
    double worst = 0, x[3] = {0, 0, 4};

    ellipsoid_facet_cache_clear(&cache);
    for (int s = 0; s <= samples; s++)
    {
        const double t = s / (double)samples;
        const double turn = angle[0] + 0.03 * t, tilt = angle[1] + 0.02 * t;
        const double axis[3] = {cos(turn) * cos(tilt), sin(turn) * cos(tilt),
                                sin(tilt)};
        double q[4];

        x[0] = span[0] + t * (span[1] - span[0]);
        x[1] = 0.3 + 0.03 * t;

        ellipsoid_quaternion_from_axis(axis, 0.05 * t, q);
        settle(model, wall, depth, x, q, &contact);
        if (s > 0)
        {
            worst = fmax(worst, distance(contact.force, before.force)
                                    + distance(contact.torque, before.torque));
        }
        before = contact;
    }
    return worst;
}

/* A slit of 0.8 between two blocks whose top is z = 0. */
static wall_mesh slit_of(void)
{
    const double left[2][3] = {{-5, -5, -3}, {-0.4, 5, 0}};
    const double right[2][3] = {{0.4, -5, -3}, {5, 5, 0}};
    wall_mesh wall;

    wall_mesh_init(&wall);
    wall_mesh_box(&wall, left[0], left[1], 0, 0, 0);
    wall_mesh_box(&wall, right[0], right[1], 0, 1, 0);
    wall_mesh_finish(&wall);
    return wall;
}

static wall_mesh block_of(void)
{
    const double low[3] = {-3, 0.1, -3}, high[3] = {0, 5, 0};
    wall_mesh wall;

    wall_mesh_init(&wall);
    wall_mesh_plane(&wall, (const double[3]){-6, -6, -1},
                    (const double[3]){12, 0, 0}, (const double[3]){0, 12, 0}, 1,
                    1, 0, 0);
    wall_mesh_box(&wall, low, high, 0, 0, 0);
    wall_mesh_finish(&wall);
    return wall;
}

/* What changes between samples becomes smaller with their distance, by the
   factor of four but for what kinks leave; a jump would stay. */
static void test_nothing_jumps(void **unused)
{
    wall_mesh walls[] = {wedge_of(-0.3, 4, 2),
                         wedge_of(-0.02, 4, 2),
                         wedge_of(0.005, 4, 2),
                         wedge_of(0.05, 4, 2),
                         wedge_of(0.3, 4, 2),
                         wedge_of(0.7, 4, 2),
                         slit_of(),
                         block_of()};
    const double span[2] = {-0.2, 0.2};

    (void)unused;
    for (int w = 0; w < 8; w++)
    {
        for (int n = 0; n < 6; n++)
        {
            const ellipsoid_model model = cell_of(n % 2 ? 0.0003 : 0);
            const double angle[2] = {0.5 * (n / 2), n % 4 < 2 ? 0 : 0.4};
            const double depth = n % 3 ? 0.003 : 0.01;
            const double coarse =
                largest_change(&model, &walls[w], angle, span, depth, 500);
            const double fine =
                largest_change(&model, &walls[w], angle, span, depth, 2000);

            assert_true(coarse > 0 && fine < 0.5 * coarse);
        }
        wall_mesh_free(&walls[w]);
    }
}

/* A rod across the slit rests on both edges, each with its own force: within
   what the overlap of 1 nm is of their height above one another's tangent
   planes, 40 nm. */
static void test_both_edges_of_a_slit(void **unused)
{
    const ellipsoid_model model = cell_of(0);
    const double axis[3] = {1, 0, 0}, depth = 0.001;
    const double f = pow(depth, 1.5);
    wall_mesh slit = slit_of();
    ellipsoid_contact contact;
    double q[4], x[3] = {0, 0, 4};

    (void)unused;
    ellipsoid_facet_cache_clear(&cache);
    ellipsoid_quaternion_from_axis(axis, 0, q);
    settle(&model, &slit, depth, x, q, &contact);
    assert_relative(contact.force[2], 2 * f, 0.02);
    assert_near(distance(contact.torque, (const double[3]){0, 0, 0}), 0,
                1e-9 * f);
    wall_mesh_free(&slit);
}

/* With its end through a corner, beyond the faces, a cell meets the face that it
   is least deep behind, whichever comes first in the list. */
static void test_deep_in_a_corner(void **unused)
{
    const ellipsoid_model model = cell_of(0);
    const double axis[3] = {1, 0, 1}, none[3] = {0, 0, 0};
    const double to[3][3] = {{4, 0, 0}, {0, 4, 0}, {0, 0, 4}};
    const double reach = sqrt((2 * 2 + 0.5 * 0.5) / 2);
    double q[4];

    (void)unused;
    ellipsoid_quaternion_from_axis(axis, 0, q);
    for (int n = 0; n < 4; n++)
    {
        const int swapped = n % 2, least = n / 2;
        const double deep[2] = {least ? 0.5 : 0.45, least ? 0.45 : 0.5};
        const double x[3] = {reach - deep[0], 2, reach - deep[1]};
        ellipsoid_contact contact;
        wall_mesh wall;

        wall_mesh_init(&wall);
        for (int k = 0; k < 2; k++)
        {
            const int floor = k == swapped;

            wall_mesh_plane(&wall, none, floor ? to[0] : to[1],
                            floor ? to[1] : to[2], 1, 1, 0, floor);
        }
        wall_mesh_finish(&wall);
        ellipsoid_facet_cache_clear(&cache);
        evaluate(&model, &wall, x, q, &contact);
        assert_near(contact.gap, -0.45, 1e-12);
        assert_int_equal(contact.surface_count, 1);
        assert_int_equal(contact.surface[0], least);
        assert_near(contact.force[least ? 2 : 0], pow(0.45, 1.5), 1e-12);
        assert_near(contact.force[least ? 0 : 2], 0, 1e-12);
        wall_mesh_free(&wall);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_flat_wall_however_cut),
        cmocka_unit_test(test_nothing_jumps),
        cmocka_unit_test(test_both_edges_of_a_slit),
        cmocka_unit_test(test_deep_in_a_corner),
    };

    return cmocka_run_group_tests_name("exactSeams", tests, NULL, NULL);
}
