/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    Surfaces with fewer triangles where they are flat: they cover what they did.
    Processor time: 1, full 12
*/
#include "wallsTest.h"

/* A square of 16 x 16 quads is two triangles, of which none is longer than its
   diagonal; each side of a baffle, too, and a floor on which it stands four; within
   labels, each is as large as it was; a long edge is not made where it is not
   wanted */
static void test_merges_what_is_flat(void **state)
{
    const double origin[3] = {1, 2, 3}, u[3] = {4, 0, 0}, v[3] = {0, 4, 0};
    wall_mesh mesh;
    made_walls m;

    (void)state;
    wall_mesh_init(&mesh);
    wall_mesh_plane(&mesh, origin, u, v, 16, 16, 2, 0);
    m = triangles_of(&mesh);
    m.options.longest_edge = 6;
    assert_ok(create(&m));
    assert_int_equal(m.count, 2);
    assert_near(area_of(&m, 0), 16, 1e-12);

    for (int f = 0; f < m.triangles.count; f++)
    {
        m.label[f] = mesh.facets[f].vertex[0][0] + mesh.facets[f].vertex[1][0]
                       + mesh.facets[f].vertex[2][0]
                   < 9;
    }
    assert_ok(create(&m));
    assert_int_equal(m.count, 4);
    assert_near(area_of(&m, 0), 8, 1e-12);
    assert_near(area_of(&m, 1), 8, 1e-12);

    m.options.longest_edge = 1;
    assert_ok(create(&m));
    assert_true(m.count > 32 && m.count < 512);
    assert_near(area_of(&m, 0) + area_of(&m, 1), 16, 1e-12);
    for (int f = 0; f < m.count; f++)
    {
        for (int k = 0; k < 3; k++)
        {
            double along[3];

            ellipsoid_difference(m.facets[f].vertex[k],
                                 m.facets[f].vertex[(k + 1) % 3], along);
            assert_true(ellipsoid_length(along) <= 1);
        }
    }
    destroy(&m);
    wall_mesh_free(&mesh);
}

/* Both sides of a wall without thickness merge as one that has some, also where
   it stands on a floor */
static void test_merges_baffles(void **state)
{
    const double origin[3] = {0, 2, 0}, u[3] = {4, 0, 0}, up[3] = {0, 0, 4};
    const double corner[3] = {0, 0, 0}, v[3] = {0, 4, 0};
    int floor;

    (void)state;
    for (floor = 0; floor < 2; floor++)
    {
        wall_mesh mesh;
        made_walls m;

        wall_mesh_init(&mesh);
        wall_mesh_plane(&mesh, origin, u, up, 16, 16, 0, 1);
        wall_mesh_plane(&mesh, origin, up, u, 16, 16, 1, 2);
        if (floor)
        {
            wall_mesh_plane(&mesh, corner, u, v, 16, 16, 2, 3);
        }
        m = triangles_of(&mesh);
        m.options.longest_edge = 6;
        assert_ok(create(&m));
        assert_int_equal(m.count, floor ? 8 : 4);
        assert_near(area_of(&m, 1), 16, 1e-12);
        assert_near(area_of(&m, 2), 16, 1e-12);
        destroy(&m);
        wall_mesh_free(&mesh);
    }
}

/* The distance of a point to the nearest facet, each asked by itself: over
   the facet, or to an edge */
static double distance_to(const made_walls *m, const double x[3])
{
    double least = HUGE_VAL;

    for (int f = 0; f < m->count; f++)
    {
        const ellipsoid_facet *a = &m->facets[f];
        double from[3], along[3], inward[3], off[3];
        int inside = 1;

        for (int k = 0; k < 3; k++)
        {
            ellipsoid_difference(x, a->vertex[k], from);
            ellipsoid_difference(a->vertex[(k + 1) % 3], a->vertex[k], along);
            ellipsoid_cross(a->normal, along, inward);
            inside = inside && ellipsoid_dot(inward, from) >= -1e-12;

            const double foot = fmin(
                fmax(ellipsoid_dot(from, along) / ellipsoid_dot(along, along),
                     0),
                1);

            for (int i = 0; i < 3; i++)
            {
                off[i] = from[i] - foot * along[i];
            }
            least = fmin(least, ellipsoid_length(off));
        }
        if (inside)
        {
            least = fmin(least, fabs(ellipsoid_dot(from, a->normal)));
        }
    }
    return least;
}

/* Between a solid voxel and one that is not, two triangles of the surface. */
static void add_side(wall_mesh *mesh, const int at[3], int axis, int upper,
                     int diagonal)
{
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    double p[4][3];

    for (int k = 0; k < 4; k++)
    {
        p[k][axis] = at[axis] + upper;
        p[k][u] = at[u] + (k == 1 || k == 2);
        p[k][v] = at[v] + (k >= 2);
    }
    if (upper)
    {
        wall_mesh_quad(mesh, p[0], p[1], p[2], p[3], diagonal, 0);
    }
    else
    {
        wall_mesh_quad(mesh, p[3], p[2], p[1], p[0], diagonal, 0);
    }
}

#define SIDE 6

/* The surface of random voxels, some of which meet in edges or corners alone, and
   baffles at this part of the sides without walls */
static void add_voxels(wall_mesh *mesh, double baffles, uint64_t *seed)
{
    int solid[SIDE + 2][SIDE + 2][SIDE + 2] = {{{0}}};
    const double part = 0.1 + 0.8 * test_uniform(seed);
    int at[3];

    for (int n = 0; n < SIDE * SIDE * SIDE; n++)
    {
        solid[1 + n % SIDE][1 + n / SIDE % SIDE][1 + n / SIDE / SIDE] =
            test_uniform(seed) < part;
    }
    for (at[0] = 1; at[0] <= SIDE; at[0]++)
    {
        for (at[1] = 1; at[1] <= SIDE; at[1]++)
        {
            for (at[2] = 1; at[2] <= SIDE; at[2]++)
            {
                for (int side = 0; side < 6; side++)
                {
                    int next[3] = {at[0], at[1], at[2]};

                    next[side / 2] += side % 2 ? 1 : -1;
                    if (solid[next[0]][next[1]][next[2]])
                    {
                        continue;
                    }
                    if (solid[at[0]][at[1]][at[2]])
                    {
                        add_side(mesh, at, side / 2, side % 2,
                                 test_uniform(seed) < 0.5);
                    }
                    else if (side % 2 && test_uniform(seed) < baffles)
                    {
                        const int diagonal = test_uniform(seed) < 0.5;

                        add_side(mesh, at, side / 2, 1, diagonal);
                        add_side(mesh, next, side / 2, 0,
                                 test_uniform(seed) < 0.5 ? diagonal
                                                          : !diagonal);
                    }
                }
            }
        }
    }
}

/* What is merged covers what was given, with the same area: each facet's middle
   is on one of those that are left. Returns the part that is left. */
static double part_left(int baffled)
{
    const long samples = test_count(10, 100, 1000);
    uint64_t seed = 17;
    long given = 0, left = 0;

    for (long sample = 0; sample < samples; sample++)
    {
        const double baffles = baffled ? test_uniform(&seed) : 0;
        wall_mesh mesh;
        made_walls m;

        wall_mesh_init(&mesh);
        add_voxels(&mesh, baffles, &seed);
        m = triangles_of(&mesh);
        m.options.longest_edge = 1 + 8 * test_uniform(&seed);
        assert_ok(create(&m));
        given += mesh.count;
        left += m.count;
        assert_near(area_of(&m, 0), 0.5 * mesh.count, 1e-9);
        for (int f = 0; f < mesh.count; f++)
        {
            double x[3];

            for (int i = 0; i < 3; i++)
            {
                x[i] =
                    (mesh.facets[f].vertex[0][i] + mesh.facets[f].vertex[1][i]
                     + mesh.facets[f].vertex[2][i])
                    / 3;
            }
            assert_near(distance_to(&m, x), 0, 1e-12);
        }
        destroy(&m);
        wall_mesh_free(&mesh);
    }
    print_message("# voxels: %ld triangles, %ld when merged\n", given, left);
    return (double)left / given;
}

static void test_merges_voxels(void **state)
{
    (void)state;
    assert_true(part_left(0) < 0.8);
    assert_true(part_left(1) < 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_merges_what_is_flat),
        cmocka_unit_test(test_merges_baffles),
        cmocka_unit_test(test_merges_voxels),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
