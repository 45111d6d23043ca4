/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_contact.c - the walls' force and torque on a cell in one pose, and that
    the cache changes nothing but the cost.
*/
#include "roomTest.h"

static void lay(double q[4], double angle)
{
    const double axis[3] = {cos(angle), sin(angle), 0};

    ellipsoid_quaternion_from_axis(axis, 0, q);
}

/*
    A sphere on a plane under its weight: Hertz, F = 4/3 E* sqrt(R) d^1.5
    (Johnson, Contact Mechanics (1985), eq. 4.23).
*/
static void test_sphere_on_a_plane(void **unused)
{
    ellipsoid_options options = test_paper_options();
    wall_mesh mesh = room_of(0);
    counted_walls walls = {.mesh = &mesh};
    const ellipsoid_surroundings surroundings = around_counted(&walls);
    const double q[4] = {0.1, -0.5, 0.3, sqrt(1 - 0.01 - 0.25 - 0.09)};
    static ellipsoid_facet_cache cache;
    ellipsoid_contact contact;

    (void)unused;
    options.semi_axes[1] = 0.5 * um;
    options.bead_count = 1;
    options.bead_radius = 0.45 * um;

    const ellipsoid_model model = test_model(&options);
    const double weight = (model.mass - model.fluid_mass) * 9.81;
    const double depth =
        pow(weight / (4.0 / 3 * 1e6 * sqrt(0.45 * um)), 2.0 / 3);
    const double x[3] = {-2 * um, 1 * um, 0.45 * um - depth};

    ellipsoid_facet_cache_clear(&cache);
    assert_ok(
        evaluate_pose(&model, &surroundings, x, q, &cache, &contact, NULL));
    /* depth is 4e-7 of the radius, so it is known to 1e-9 of itself */
    assert_relative(contact.force[2], weight, 1e-8);
    assert_relative(contact.deepest, depth, 1e-8);
    assert_relative(contact.gap, -depth, 1e-8);
    assert_true(contact.force[0] == 0 && contact.force[1] == 0);
    assert_true(ellipsoid_dot(contact.torque, contact.torque) == 0);
    assert_int_equal(contact.bead_contacts, 1);
    assert_int_equal(contact.surface_count, 1);
    assert_int_equal(contact.surface[0], 1);
    wall_mesh_free(&mesh);
}

/* Standing on its pole, and lying on it: the envelope's figures. */
static void test_standing_and_lying(void **unused)
{
    const ellipsoid_options options = test_paper_options();
    const ellipsoid_model model = test_model(&options);
    const double up[3] = {0, 0, 1};
    wall_mesh mesh = room_of(0);
    counted_walls walls = {.mesh = &mesh};
    const ellipsoid_surroundings surroundings = around_counted(&walls);
    static ellipsoid_facet_cache cache;
    ellipsoid_contact contact;
    double x[3] = {-2 * um, 1 * um, 1.999 * um}, q[4];
    const double k = 4.0 / 3 * 1e6 * sqrt(0.285 * um);

    (void)unused;
    ellipsoid_facet_cache_clear(&cache);
    ellipsoid_quaternion_from_axis(up, 0.3, q);
    assert_ok(
        evaluate_pose(&model, &surroundings, x, q, &cache, &contact, NULL));
    assert_int_equal(contact.bead_contacts, 1);
    assert_relative(contact.force[2], k * pow(1e-9, 1.5), 1e-6);
    assert_near(contact.torque[0], 0, 1e-9 * contact.force[2] * um);

    lay(q, 0.7);
    x[2] = 0.5 * um;
    assert_ok(
        evaluate_pose(&model, &surroundings, x, q, &cache, &contact, NULL));
    assert_true(contact.gap > -0.03 * um && contact.gap < 0.06 * um);
    wall_mesh_free(&mesh);
}

/* The sum over beads, from each bead's force alone. */
static void assert_sum(const ellipsoid_model *model, const wall_mesh *mesh,
                       const double x[3], const double q[4],
                       const ellipsoid_contact *contact)
{
    const double radius = model->options.bead_radius;
    const double stiffness =
        4.0 / 3 * model->options.contact_modulus * sqrt(radius);
    const ellipsoid_facet_list facets = wall_mesh_all(mesh);
    double rotation[3][3], force[3] = {0, 0, 0}, torque[3] = {0, 0, 0};
    double lab_torque[3];

    ellipsoid_rotation(q, rotation);
    for (int b = 0; b < model->bead_count; b++)
    {
        double arm[3], centre[3], f[3], t[3];

        for (int i = 0; i < 3; i++)
        {
            arm[i] = ellipsoid_dot(rotation[i], model->bead[b]);
            centre[i] = x[i] + arm[i];
        }
        ellipsoid_bead_force(centre, radius, stiffness, &facets, f, NULL);
        ellipsoid_cross(arm, f, t);
        for (int i = 0; i < 3; i++)
        {
            force[i] += f[i];
            torque[i] += t[i];
        }
    }
    for (int i = 0; i < 3; i++)
    {
        lab_torque[i] = ellipsoid_dot(rotation[i], contact->torque);
        assert_near(contact->force[i], force[i], 1e-20);
        assert_near(lab_torque[i], torque[i], 1e-26);
    }
}

static void test_sum_over_beads(void **unused)
{
    const long count = test_count(200, 2000, 2000);
    const ellipsoid_options options = test_paper_options();
    const ellipsoid_model model = test_model(&options);
    wall_mesh mesh = room_of(1);
    counted_walls walls = {.mesh = &mesh};
    const ellipsoid_surroundings surroundings = around_counted(&walls);
    static ellipsoid_facet_cache cache;
    uint64_t seed = 1;
    int touched = 0;

    (void)unused;
    ellipsoid_facet_cache_clear(&cache);
    for (long n = 0; n < count; n++)
    {
        ellipsoid_contact contact;
        double x[3], q[4];

        random_pose(&seed, x, q);
        assert_ok(
            evaluate_pose(&model, &surroundings, x, q, &cache, &contact, NULL));
        assert_sum(&model, &mesh, x, q, &contact);
        touched += contact.bead_contacts > 0;
    }
    assert_true(touched > count / 4);
    wall_mesh_free(&mesh);
}

/*
    A cell wanders; one cache goes along, another is emptied every time. All
    results are the same bits, the Jacobian's and the gap's too.
*/
static void test_cache_changes_nothing(void **unused)
{
    const long walks = test_count(10, 100, 100);
    ellipsoid_options options = test_paper_options();
    wall_mesh mesh = room_of(0);
    counted_walls walls = {.mesh = &mesh}, empty = {.mesh = &mesh};
    const ellipsoid_surroundings surroundings = around_counted(&walls);
    const ellipsoid_surroundings emptied = around_counted(&empty);
    static ellipsoid_facet_cache kept, fresh;
    uint64_t seed = 2;
    int touched = 0;

    (void)unused;
    for (int run = 0; run < 3; run++)
    {
        options.bead_count = run == 1 ? 128 : 32;
        options.contact_shape =
            run == 2 ? ELLIPSOID_CONTACT_ELLIPSOID : ELLIPSOID_CONTACT_BEADS;

        const ellipsoid_model model = test_model(&options);

        ellipsoid_facet_cache_clear(&kept);
        walls.calls = empty.calls = 0;
        for (long walk = 0; walk < walks; walk++)
        {
            double x[3], q[4];

            random_pose(&seed, x, q);
            walls.farther = 3 * um * test_uniform(&seed);
            for (int n = 0; n < 100; n++)
            {
                ellipsoid_contact a, b;
                ellipsoid_wrench_jacobian ja, jb;

                for (int i = 0; i < 3; i++)
                {
                    x[i] += 0.02 * um * test_signed(&seed);
                }
                for (int i = 0; i < 4; i++)
                {
                    q[i] += 0.005 * test_signed(&seed);
                }
                ellipsoid_facet_cache_clear(&fresh);
                assert_ok(
                    evaluate_pose(&model, &surroundings, x, q, &kept, &a, &ja));
                assert_ok(
                    evaluate_pose(&model, &emptied, x, q, &fresh, &b, &jb));
                assert_memory_equal(&a, &b, sizeof a);
                assert_memory_equal(&ja, &jb, sizeof ja);
                touched += a.bead_contacts > 0;
            }
        }
        assert_true(touched > 20 * walks);
        assert_true(walls.calls < empty.calls);
    }
    wall_mesh_free(&mesh);
}

/* So is the gap of a cell that comes down, lying, from where no facet matters. */
static void test_comes_down(void **unused)
{
    const double corner[3] = {-10 * um, -10 * um, 0};
    const double along[3] = {20 * um, 0, 0}, across[3] = {0, 20 * um, 0};
    const double q[4] = {0, 0, 0, 1};
    const ellipsoid_options options = ellipsoid_options_default();
    const ellipsoid_model model = test_model(&options);
    static ellipsoid_facet_cache kept, fresh;
    wall_mesh mesh;
    counted_walls walls = {.mesh = &mesh};
    const ellipsoid_surroundings surroundings = around_counted(&walls);

    (void)unused;
    wall_mesh_init(&mesh);
    wall_mesh_plane(&mesh, corner, along, across, 1, 1, 2, 0);
    wall_mesh_finish(&mesh);
    ellipsoid_facet_cache_clear(&kept);
    for (int n = 0; n < 2; n++)
    {
        const double x[3] = {0, 0, (n == 0 ? 1.1 : 0.65) * um};
        ellipsoid_contact a, b;

        ellipsoid_facet_cache_clear(&fresh);
        assert_ok(evaluate_pose(&model, &surroundings, x, q, &kept, &a, NULL));
        assert_ok(evaluate_pose(&model, &surroundings, x, q, &fresh, &b, NULL));
        assert_memory_equal(&a, &b, sizeof a);
        assert_true(n == 0 || a.gap < 0.2 * um);
    }
    wall_mesh_free(&mesh);
}

/* R(q) is a polynomial: q off the unit sphere, each component by itself. */
static void test_jacobian_is_exact(void **unused)
{
    const long count = test_count(300, 3000, 3000);
    const ellipsoid_options options = test_paper_options();
    const ellipsoid_model model = test_model(&options);
    wall_mesh mesh = room_of(0);
    counted_walls walls = {.mesh = &mesh};
    const ellipsoid_surroundings surroundings = around_counted(&walls);
    static ellipsoid_facet_cache cache;
    uint64_t seed = 3;
    int checked = 0;

    (void)unused;
    ellipsoid_facet_cache_clear(&cache);
    for (long n = 0; n < count; n++)
    {
        double y[7];

        random_pose(&seed, y, y + 3);
        for (int i = 3; i < 7; i++)
        {
            y[i] *= 1.01;
        }
        /* h^2 f''' of a bead just touching, and rounding / h */
        checked += assert_jacobian(&model, &surroundings, &cache, y, 1e-3);
    }
    assert_true(checked > count / 10);
    wall_mesh_free(&mesh);
}

/* Far from walls: one comparison, and results as near a distant wall. */
static void test_far_from_walls(void **unused)
{
    const ellipsoid_options options = test_paper_options();
    const ellipsoid_model model = test_model(&options);
    const double low[3] = {-60 * um, -60 * um, -60 * um};
    const double high[3] = {60 * um, 60 * um, 60 * um};
    wall_mesh mesh;
    counted_walls walls = {.mesh = &mesh};
    const ellipsoid_surroundings surroundings = around_counted(&walls);
    static ellipsoid_facet_cache cache;
    double x[3] = {0, 0, 0};
    const double q[4] = {0, 0, 0, 1};

    (void)unused;
    wall_mesh_init(&mesh);
    wall_mesh_box(&mesh, low, high, 1, 0, 0);
    wall_mesh_finish(&mesh);
    ellipsoid_facet_cache_clear(&cache);
    for (x[0] = 0; x[0] < 57 * um; x[0] += 0.01 * um)
    {
        ellipsoid_contact contact;

        assert_ok(
            evaluate_pose(&model, &surroundings, x, q, &cache, &contact, NULL));
        assert_true(contact.gap == options.bead_radius);
        assert_int_equal(contact.bead_contacts, 0);
        assert_true(ellipsoid_dot(contact.force, contact.force) == 0);
    }
    assert_true(walls.calls < 80); /* two for each reach travelled */

    /* walls that know how far they are are asked less often */
    walls.calls = 0;
    walls.farther = 30 * um;
    for (x[0] = 0; x[0] < 40 * um; x[0] += 0.01 * um)
    {
        ellipsoid_contact contact;

        assert_ok(
            evaluate_pose(&model, &surroundings, x, q, &cache, &contact, NULL));
    }
    assert_true(walls.calls < 8);
    wall_mesh_free(&mesh);
}

/* Along a wall, nearer than the body is long: facets are searched where it has
   come nearer or gone far, not wherever a bead could be that is not there. */
static void test_along_a_wall(void **unused)
{
    const ellipsoid_options options = test_paper_options();
    const ellipsoid_model model = test_model(&options);
    const double radius = options.bead_radius;
    const double low[3] = {-40 * um, -40 * um, 0};
    const double high[3] = {40 * um, 40 * um, 80 * um};
    const double *a = options.semi_axes;
    wall_mesh mesh;
    counted_walls walls = {.mesh = &mesh};
    const ellipsoid_surroundings surroundings = around_counted(&walls);
    static ellipsoid_facet_cache cache;
    const double across[3] = {0, 1, 0};
    const double height = fmin(a[0], fmin(a[1], a[2])) + 4 * radius;
    double x[3] = {0, 0, height}, q[4];
    int poses = 0;

    (void)unused;
    wall_mesh_init(&mesh);
    wall_mesh_box(&mesh, low, high, 20, 0, 0);
    wall_mesh_finish(&mesh);
    ellipsoid_quaternion_from_axis(across, 0, q);
    ellipsoid_facet_cache_clear(&cache);
    assert_true(height < model.reach);
    for (x[0] = -20 * um; x[0] < 20 * um; x[0] += 0.3 * radius, poses++)
    {
        ellipsoid_contact contact;

        assert_ok(
            evaluate_pose(&model, &surroundings, x, q, &cache, &contact, NULL));
        assert_true(contact.gap == radius);
    }
    assert_true(walls.calls < poses / 5);
    wall_mesh_free(&mesh);
}

/* R(q) shrinks by q.q: to a point, where squares of that are not numbers. */
static void test_shrunk_to_a_point(void **unused)
{
    const ellipsoid_options options = test_paper_options();
    const ellipsoid_model model = test_model(&options);
    const double radius = options.bead_radius;
    const double x[3] = {-2 * um, 1 * um, 0.5 * radius};
    wall_mesh mesh = room_of(0);
    counted_walls walls = {.mesh = &mesh};
    const ellipsoid_surroundings surroundings = around_counted(&walls);
    static ellipsoid_facet_cache cache;

    (void)unused;
    for (double turn = 1e-10; turn > 1e-110; turn *= 1e-10)
    {
        const double q[4] = {0, 0, 0, turn};
        ellipsoid_contact contact;

        ellipsoid_facet_cache_clear(&cache);
        assert_ok(
            evaluate_pose(&model, &surroundings, x, q, &cache, &contact, NULL));
        assert_int_equal(contact.bead_contacts, model.bead_count);
        assert_relative(contact.gap, -0.5 * radius, 1e-12);
    }
    wall_mesh_free(&mesh);
}

static void test_no_walls(void **unused)
{
    ellipsoid_options options = test_paper_options();
    wall_mesh mesh = room_of(0);
    counted_walls walls = {.mesh = &mesh};
    const ellipsoid_surroundings with = around_counted(&walls), without = {0};
    const double x[3] = {0, 0, 0}, q[4] = {0, 0, 0, 1};
    ellipsoid_contact contact;
    ellipsoid_wrench_jacobian jacobian;

    (void)unused;
    for (options.contact = 0; options.contact < 2; options.contact++)
    {
        const ellipsoid_model model = test_model(&options);

        assert_ok(evaluate_pose(&model, options.contact ? &without : &with, x,
                                q, NULL, &contact, &jacobian));
        assert_true(contact.gap == HUGE_VAL);
        assert_true(contact.deepest == 0);
        assert_true(ellipsoid_dot(contact.force, contact.force) == 0);
        assert_true(jacobian.force_x[2][2] == 0);
    }
    assert_int_equal(walls.calls, 0);
    wall_mesh_free(&mesh);
}

/* In order of bead, then facet; each surface once. */
static void test_touched_surfaces(void **unused)
{
    const ellipsoid_options options = test_paper_options();
    const ellipsoid_model model = test_model(&options);
    wall_mesh mesh = room_of(0);
    counted_walls walls = {.mesh = &mesh};
    const ellipsoid_surroundings surroundings = around_counted(&walls);
    const double across[3] = {1, 0, 0};
    static ellipsoid_facet_cache cache;
    ellipsoid_contact contact;
    double q[4];

    /* from the wall at -6 to the ridge at 0.5: between them, on the floor */
    const double x[3] = {0.5 * um - 1.995 * um, 0, 0.46 * um};

    (void)unused;
    ellipsoid_facet_cache_clear(&cache);
    ellipsoid_quaternion_from_axis(across, 0, q);
    assert_ok(
        evaluate_pose(&model, &surroundings, x, q, &cache, &contact, NULL));
    assert_int_equal(contact.surface_count, 2);
    assert_int_equal(contact.surface[0] + contact.surface[1], 3);
    assert_true(contact.bead_contacts > 2);
    wall_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sphere_on_a_plane),
        cmocka_unit_test(test_standing_and_lying),
        cmocka_unit_test(test_sum_over_beads),
        cmocka_unit_test(test_cache_changes_nothing),
        cmocka_unit_test(test_comes_down),
        cmocka_unit_test(test_jacobian_is_exact),
        cmocka_unit_test(test_far_from_walls),
        cmocka_unit_test(test_along_a_wall),
        cmocka_unit_test(test_shrunk_to_a_point),
        cmocka_unit_test(test_no_walls),
        cmocka_unit_test(test_touched_surfaces),
    };

    return cmocka_run_group_tests_name("contact", tests, NULL, NULL);
}
