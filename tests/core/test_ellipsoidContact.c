/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_ellipsoidContact.c - the walls' force on the ellipsoid itself: against
    that on a bead where it is a sphere, and against geometry.
    Processor time: 4
*/
#include "exactContactTest.h"
#include "contact/contact.h"
#include "beadContactTest.h"

static double stiffness_of(const ellipsoid_options *o)
{
    return 4.0 / 3 * o->contact_modulus * sqrt(o->bead_radius);
}

/* Contacts of every kind and how many poses have several, by all facets. */
typedef struct kinds
{
    int face, edge, vertex, several;
} kinds;

static void count_kinds(const ellipsoid_model *model, const wall_mesh *mesh,
                        const double x[3], const double q[4], kinds *found)
{
    ellipsoid_surface body;
    int contacts = 0;

    ellipsoid_surface_set(model->options.semi_axes, x, q, &body);
    for (int f = 0; f < mesh->count; f++)
    {
        ellipsoid_surface_contact c;

        if (ellipsoid_surface_nearest(&mesh->facets[f], &body, 0, &c))
        {
            found->face += c.feature == ELLIPSOID_ON_FACE;
            found->edge += c.feature == ELLIPSOID_ON_EDGE;
            found->vertex += c.feature == ELLIPSOID_ON_VERTEX;
            contacts++;
        }
    }
    found->several += contacts > 1;
}

/* A sphere is a bead: on random ground and in a room, all kinds of edges and
   corners, force and derivatives alike. */
static void test_sphere_is_a_bead(void **unused)
{
    uint64_t seed = 5;
    kinds found = {0, 0, 0, 0};
    int touching = 0;

    (void)unused;
    for (int ground = 0; ground < 3; ground++)
    {
        wall_mesh wall = ground == 0 ? terrain_of(0.05, &seed)
                       : ground == 1 ? terrain_of(0.5, &seed)
                                     : box_of(1.5, 1, 0);
        const ellipsoid_surroundings surroundings = inside(&wall);
        const ellipsoid_facet_list facets = wall_mesh_all(&wall);
        ellipsoid_options options = exact_options(r, r, r);
        static ellipsoid_facet_cache cache;

        options.bead_radius = 0.9;
        options.contact_modulus = 0.75 / sqrt(0.9);

        const ellipsoid_model model = test_model(&options);

        ellipsoid_facet_cache_clear(&cache);
        for (int n = 0; n < 3000; n++)
        {
            double x[3], q[4], force[3], force_x[3][3];
            ellipsoid_contact contact;
            ellipsoid_wrench_jacobian jacobian;

            for (int i = 0; i < 3; i++)
            {
                x[i] = ground == 2 ? 1.7 * test_signed(&seed)
                     : i == 2      ? 0.6 + 0.9 * test_uniform(&seed)
                                   : 12 + 16 * test_uniform(&seed);
            }
            test_orientation(&seed, q);
            assert_ok(evaluate_pose(&model, &surroundings, x, q, &cache,
                                    &contact, &jacobian));
            ellipsoid_bead_force(x, r, 1, &facets, force, force_x);
            count_kinds(&model, &wall, x, q, &found);
            touching += contact.bead_contacts;
            for (int i = 0; i < 3; i++)
            {
                /* rounding of depth, by the stiffness of at most 1.5 */
                assert_near(contact.force[i], force[i], 1e-13);
                assert_near(contact.torque[i], 0, 1e-14);
                for (int j = 0; j < 3; j++)
                {
                    /* and of d^0.5 where that is small */
                    assert_near(jacobian.force_x[i][j], force_x[i][j], 1e-10);
                    assert_near(jacobian.torque_x[i][j], 0, 1e-10);
                }
                for (int k = 0; k < 4; k++)
                {
                    assert_near(jacobian.force_q[i][k], 0, 1e-10);
                    assert_near(jacobian.torque_q[i][k], 0, 1e-10);
                }
            }
        }
        wall_mesh_free(&wall);
    }
    assert_true(touching > 4000 && found.several > 1000);
    assert_true(found.face > 1000 && found.edge > 1000 && found.vertex > 200);
}

/*
    On a plane the depth is h - z with the support h = sqrt(sum (a_i n^_i)^2) of
    the body in the plane's normal, and the contact point a_i^2 n^_i/h.
*/
static void test_lying_standing_tilted(void **unused)
{
    const ellipsoid_options options = exact_options(0.5 * um, 2 * um, 0.8 * um);
    const ellipsoid_model model = test_model(&options);
    wall_mesh mesh = room_of(0);
    const ellipsoid_surroundings surroundings = inside(&mesh);
    static ellipsoid_facet_cache cache;
    const double a = 0.5 * um, b = 2 * um, c = 0.8 * um, depth = 3e-9;
    const double pi = test_pi;

    (void)unused;
    ellipsoid_facet_cache_clear(&cache);
    for (int n = 0; n < 42; n++)
    {
        /* the long axis from lying to standing, x^1 or x^3 down */
        const double tilt = pi / 2 * (n % 21) / 20;
        const double axis[3] = {cos(tilt), 0, sin(tilt)};
        const double spin = n > 20 ? pi / 2 : 0;
        double q[4], rotation[3][3];
        ellipsoid_contact contact;

        ellipsoid_quaternion_from_axis(axis, spin, q);
        ellipsoid_rotation(q, rotation);

        const double *up = rotation[2]; /* z in the body frame */
        const double h =
            sqrt(pow(a * up[0], 2) + pow(b * up[1], 2) + pow(c * up[2], 2));
        const double x[3] = {-2 * um, 1 * um, h - depth};
        const double f = stiffness_of(&options) * pow(depth, 1.5);
        const double arm[3] = {-a * a * up[0] / h, -b * b * up[1] / h,
                               -c * c * up[2] / h};
        const double force[3] = {f * up[0], f * up[1], f * up[2]};
        double torque[3];

        ellipsoid_cross(arm, force, torque);
        assert_ok(
            evaluate_pose(&model, &surroundings, x, q, &cache, &contact, NULL));
        assert_int_equal(contact.bead_contacts, 1);
        assert_int_equal(contact.surface_count, 1);
        assert_int_equal(contact.surface[0], 1);
        /* the depth is 1e-3 of the size: 13 digits, times 1.5 */
        assert_relative(contact.deepest, depth, 1e-12);
        assert_relative(contact.force[2], f, 2e-12);
        for (int i = 0; i < 3; i++)
        {
            assert_near(contact.torque[i], torque[i], 1e-11 * f * um);
        }
        if (n == 0 || n == 20 || n == 21 || n == 41)
        {
            /* one of its axes is upright */
            assert_near(h, n == 0 ? c : n == 21 ? a : b, 1e-20);
        }
    }
    wall_mesh_free(&mesh);
}

/* A body that lies on a baffle touches the side that it is on: the other one is
   seen from behind. */
static void test_either_side_of_a_baffle(void **unused)
{
    const double corner[3] = {-5 * um, -5 * um, 0};
    const double x[3] = {10 * um, 0, 0}, y[3] = {0, 10 * um, 0};
    const ellipsoid_options o = exact_options(0.5 * um, 2 * um, 0.8 * um);
    const ellipsoid_model model = test_model(&o);
    static ellipsoid_facet_cache cache;
    wall_mesh mesh;

    (void)unused;
    wall_mesh_init(&mesh);
    wall_mesh_plane(&mesh, corner, x, y, 1, 1, 0, 1);
    wall_mesh_plane(&mesh, corner, y, x, 1, 1, 0, 2);
    wall_mesh_finish(&mesh);
    ellipsoid_facet_cache_clear(&cache);
    for (int n = 0; n < 40; n++)
    {
        const ellipsoid_surroundings surroundings = inside(&mesh);
        const double side = n % 2 ? -1 : 1, depth = 0.01 * (n + 1) * um;
        const double place[3] = {0.3 * um, 0.2 * um, side * (0.8 * um - depth)};
        const double q[4] = {0, 0, 0, 1};
        ellipsoid_contact contact;

        assert_ok(evaluate_pose(&model, &surroundings, place, q, &cache,
                                &contact, NULL));
        assert_int_equal(contact.surface_count, 1);
        assert_int_equal(contact.surface[0], n % 2 ? 2 : 1);
        assert_relative(contact.deepest, depth, 1e-9);
        assert_relative(contact.force[2],
                        side * stiffness_of(&o) * pow(depth, 1.5), 1e-8);
    }
    wall_mesh_free(&mesh);
}

/* A disc tilted about x against the edge of a wedge, upright over its middle and
   clear of it: the normal of the edge's line that is least deep would be at a
   point of that line beyond the disc. */
static void test_no_contact_beyond_the_body(void **unused)
{
    const double tilt = 0.5235987755982988, low = 2, high = 3;
    const double edge[2][3] = {{0.3, 0, low}, {0.3, 0, high}};
    const double back[2][3] = {{9, 1, low}, {9, -1, low}};
    const double x[3] = {0, 0, 0}, q[4] = {sin(tilt / 2), 0, 0, cos(tilt / 2)};
    const ellipsoid_options options = exact_options(5, 5, 0.4);
    const ellipsoid_model model = test_model(&options);
    static ellipsoid_facet_cache cache;
    ellipsoid_contact contact;
    wall_mesh wall;

    (void)unused;
    wall_mesh_init(&wall);
    wall_mesh_triangle(&wall, edge[0], edge[1], back[0], 0);
    wall_mesh_triangle(&wall, edge[1], edge[0], back[1], 0);
    wall_mesh_finish(&wall);

    const ellipsoid_surroundings surroundings = inside(&wall);
    kinds found = {0, 0, 0, 0};

    count_kinds(&model, &wall, x, q, &found);
    assert_int_equal(found.face + found.edge + found.vertex, 0);
    ellipsoid_facet_cache_clear(&cache);
    assert_ok(
        evaluate_pose(&model, &surroundings, x, q, &cache, &contact, NULL));
    assert_int_equal(contact.bead_contacts, 0);
    assert_true(contact.gap > 0);
    wall_mesh_free(&wall);
}

/* All kinds of contacts, alone and mixed. */
static void test_exact_jacobian(void **unused)
{
    const ellipsoid_options options = exact_options(0.5 * um, 2 * um, 0.8 * um);
    const ellipsoid_model model = test_model(&options);
    wall_mesh mesh = room_of(0);
    const ellipsoid_surroundings surroundings = inside(&mesh);
    static ellipsoid_facet_cache cache;
    uint64_t seed = 3;
    kinds found = {0, 0, 0, 0};

    (void)unused;
    ellipsoid_facet_cache_clear(&cache);
    for (int n = 0; n < 20000; n++)
    {
        double y[7];

        random_pose(&seed, y, y + 3);
        for (int i = 3; i < 7; i++)
        {
            y[i] *= 1.01;
        }
        if (assert_jacobian(&model, &surroundings, &cache, y, 1e-6))
        {
            count_kinds(&model, &mesh, y, y + 3, &found);
        }
    }
    assert_true(found.face > 300 && found.edge > 300 && found.vertex > 100
                && found.several > 300);
    wall_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sphere_is_a_bead),
        cmocka_unit_test(test_lying_standing_tilted),
        cmocka_unit_test(test_either_side_of_a_baffle),
        cmocka_unit_test(test_no_contact_beyond_the_body),
        cmocka_unit_test(test_exact_jacobian),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
