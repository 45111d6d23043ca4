/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_wallPlaneCache.c - the drag near walls is that of the pose, whatever the
    cache of facets holds.
*/
#include "wallResistanceTest.h"

static ellipsoid_facet_cache fresh;

/* The result is that of the pose, to the last bit, whatever the cache holds:
   after a new pose, and after moves of about what leaves the closer look as it
   is, near few large facets and near many small ones. */
static void test_cache(void **unused)
{
    const double corner[3] = {-8e-6, -8e-6, -5e-6};
    const double along[3] = {16e-6, 0, 0}, across[3] = {0, 16e-6, 0};
    const ellipsoid_options o = near_walls();
    const ellipsoid_model model = test_model(&o);
    test_quadratic flow = test_shear(1000);
    uint64_t seed = 24;

    (void)unused;
    for (int n = 0; n < 2400; n++)
    {
        static wall_mesh mesh;
        static ellipsoid_state state;
        const ellipsoid_surroundings s = around(&mesh, &flow);
        ellipsoid_state a, b;

        if (n % 1200 == 0)
        {
            wall_mesh_init(&mesh);
            if (n == 0)
            {
                add_landscape(&mesh);
            }
            else
            {
                wall_mesh_plane(&mesh, corner, along, across, 32, 32, 2, 0);
            }
            wall_mesh_finish(&mesh);
            ellipsoid_set(state.x, -2e-6, -3e-6, -1e-6);
            ellipsoid_facet_cache_clear(&cache);
        }
        state.x[n % 3] += 0.3e-6 * test_signed(&seed);
        state.q[n % 4] += 0.011 * test_signed(&seed);
        if (n % 8 == 0)
        {
            test_orientation(&seed, state.q);
        }
        ellipsoid_facet_cache_clear(&fresh);
        assert_ok(ellipsoid_rhs(&model, &s, &state, &cache, &a));
        assert_ok(ellipsoid_rhs(&model, &s, &state, &fresh, &b));
        assert_memory_equal(&a, &b, sizeof(a));
        if (n % 1200 == 1199)
        {
            wall_mesh_free(&mesh);
        }
    }
}

/* So too where a small wall is as far beside the place as it may be. */
static void test_cache_far_beside(void **unused)
{
    const double corner[3] = {0, 0, 0}, size = 2e-7;
    const double along[3] = {size, 0, 0}, across[3] = {0, size, 0};
    const ellipsoid_options o = near_walls();
    const ellipsoid_model model = test_model(&o);
    const long count = test_count(5000, 100000, 100000);
    test_quadratic flow = test_shear(1000);
    uint64_t seed = 25;
    int felt = 0;
    wall_mesh mesh;

    (void)unused;
    wall_mesh_init(&mesh);
    wall_mesh_plane(&mesh, corner, along, across, 1, 1, 2, 0);
    wall_mesh_finish(&mesh);
    for (long n = 0; n < count; n++)
    {
        const ellipsoid_surroundings s = around(&mesh, &flow);
        const double away = o.wall_range * (1.05 + 0.6 * test_uniform(&seed));
        double to[3];
        ellipsoid_state near = {.u = {0}}, a, b, free;
        ellipsoid_surroundings none = s;

        none.walls = NULL;
        test_orientation(&seed, near.q);
        test_long_axis(&near, to);
        test_orientation(&seed, near.q);
        ellipsoid_set(near.x, away * to[0], away * to[1], away * fabs(to[2]));
        ellipsoid_facet_cache_clear(&cache);
        ellipsoid_facet_cache_clear(&fresh);
        assert_ok(ellipsoid_rhs(&model, &s, &near, &cache, &a));
        for (int i = 0; i < 3; i++)
        {
            near.x[i] *= 1 - 0.099 * o.wall_range / away;
        }
        assert_ok(ellipsoid_rhs(&model, &s, &near, &cache, &a));
        assert_ok(ellipsoid_rhs(&model, &s, &near, &fresh, &b));
        assert_memory_equal(&a, &b, sizeof(a));
        assert_ok(ellipsoid_rhs(&model, &none, &near, NULL, &free));
        felt += memcmp(&a, &free, sizeof(a)) != 0;
    }
    assert_true(felt > 0);
    wall_mesh_free(&mesh);
}

/* All facets, whatever the reach. */
static int list_all(void *context, double t, const double centre[3],
                    double reach, ellipsoid_facet_list *list)
{
    (void)t;
    (void)centre;
    *list = wall_mesh_all(context);
    list->reach = reach;
    return 0;
}

/* None within the reach, and how far the floor x3 = 0 is. */
static int list_and_say_how_far(void *context, double t, const double centre[3],
                                double reach, ellipsoid_facet_list *list)
{
    list_all(context, t, centre, reach, list);
    if (centre[2] > reach)
    {
        list->count = 0;
        list->reach = centre[2];
    }
    return 0;
}

/* So too after a look from so far that no facet was listed, by walls that say
   how far they are. */
static void test_cache_from_afar(void **unused)
{
    const ellipsoid_options o = near_walls();
    const ellipsoid_model model = test_model(&o);
    test_quadratic flow = test_shear(1000);
    ellipsoid_state state = {.q = {0, 0, 0, 1}}, a, b;
    ellipsoid_surroundings s;
    wall_mesh mesh;

    (void)unused;
    wall_mesh_init(&mesh);
    add_floor(&mesh, 0, 1, 1);
    wall_mesh_finish(&mesh);
    s = around(&mesh, &flow);
    s.walls = list_and_say_how_far;
    ellipsoid_facet_cache_clear(&cache);
    state.x[2] = 4 * o.wall_range;
    assert_ok(ellipsoid_rhs(&model, &s, &state, &cache, &a));
    state.x[2] = 0.3 * o.wall_range;
    ellipsoid_facet_cache_clear(&fresh);
    assert_ok(ellipsoid_rhs(&model, &s, &state, &cache, &a));
    assert_ok(ellipsoid_rhs(&model, &s, &state, &fresh, &b));
    assert_memory_equal(&a, &b, sizeof(a));
    wall_mesh_free(&mesh);
}

/*
    So too where a crest meets the foot of a rise at an acute angle of a facet
    beside it: the plane of the crest goes on into the rise, and where it has
    faded its facet may be dropped. A list of all facets gives the same.
*/
static void test_cache_at_acute_angles(void **unused)
{
    const double w = 0.3e-6;
    const double crest[3][3] = {{0, -6e-6, 0}, {0}, {0, 6e-6, 1.2e-6}};
    ellipsoid_options o = near_walls();
    ellipsoid_model model;
    test_quadratic flow = test_shear(1000);
    ellipsoid_state state = {.x = {-1e-6, -2e-6, 1e-6}, .q = {0, 0, 0, 1}};
    uint64_t seed = 27;
    wall_mesh mesh;

    (void)unused;
    ellipsoid_set(o.semi_axes, 1e-6, 1e-6, 1e-6);
    o.wall_range = 2.5e-6;
    model = test_model(&o);
    wall_mesh_init(&mesh);
    for (int part = 0; part < 2; part++)
    {
        double top[2][3], side[2][3];

        for (int end = 0; end < 2; end++)
        {
            const double *at = crest[part + end];

            ellipsoid_set(top[end], at[0] + w, at[1], at[2]);
            ellipsoid_set(side[end], at[0], at[1], -w);
        }
        wall_mesh_quad(&mesh, crest[part], top[0], top[1], crest[part + 1], 1,
                       0);
        wall_mesh_quad(&mesh, crest[part], crest[part + 1], side[1], side[0], 1,
                       0);
    }
    wall_mesh_finish(&mesh);
    ellipsoid_facet_cache_clear(&cache);
    for (long n = test_count(20000, 200000, 200000); n > 0; n--)
    {
        static const double limit[3] = {4e-6, 9e-6, 4e-6};
        const ellipsoid_surroundings s = around(&mesh, &flow);
        ellipsoid_surroundings all = s;
        ellipsoid_state a, b;

        all.walls = list_all;
        for (int i = 0; i < 3; i++)
        {
            state.x[i] += 0.3e-6 * test_signed(&seed);
            state.x[i] = fabs(state.x[i]) < limit[i] ? state.x[i] : -1e-6;
        }
        state.q[n % 4] += 0.02 * test_signed(&seed);
        assert_ok(ellipsoid_rhs(&model, &s, &state, &cache, &a));
        ellipsoid_facet_cache_clear(&fresh);
        assert_ok(ellipsoid_rhs(&model, &s, &state, &fresh, &b));
        assert_memory_equal(&a, &b, sizeof(a));
        ellipsoid_facet_cache_clear(&fresh);
        assert_ok(ellipsoid_rhs(&model, &all, &state, &fresh, &b));
        assert_memory_equal(&a, &b, sizeof(a));
    }
    wall_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cache),
        cmocka_unit_test(test_cache_far_beside),
        cmocka_unit_test(test_cache_from_afar),
        cmocka_unit_test(test_cache_at_acute_angles),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
