/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_beadContact.c - the wall's force on one bead, against plane geometry and
    Hertz's law f = k d^1.5 (Johnson, Contact Mechanics (1985), eq. 4.23).

    Lengths are in bead radii and stiffness is 1 unless the test says otherwise:
    the force is homogeneous in both.
*/
#include "beadContactTest.h"

static void assert_force(const wall_mesh *wall, const double x[3], double f0,
                         double f1, double f2, double tolerance)
{
    double force[3];

    touch(wall, x, force);
    assert_near(force[0], f0, tolerance);
    assert_near(force[1], f1, tolerance);
    assert_near(force[2], f2, tolerance);
}

/* Three cuts of one wall: two triangles, the other two, a fan and a grid. */
static void test_flat_wall_however_cut(void **unused)
{
    wall_mesh walls[4] = {floor_of(4, 1, 0), floor_of(4, 1, 1),
                          floor_of(4, 40, 2)};
    const double rim[5][3] = {
        {-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}, {-4, -4, 0}};
    const double apex[3] = {0.3, -0.1, 0};
    uint64_t seed = 1;

    (void)unused;
    wall_mesh_init(&walls[3]);
    for (int k = 0; k < 4; k++)
    {
        wall_mesh_triangle(&walls[3], rim[k], rim[k + 1], apex, 0);
    }
    wall_mesh_finish(&walls[3]);

    for (int n = 0; n < 4000; n++)
    {
        double x[3] = {2 * test_signed(&seed), 2 * test_signed(&seed),
                       0.9 + 0.2 * test_uniform(&seed)};

        if (n % 4 == 0) /* over an edge of the grid */
        {
            x[0] = 0.2 * floor(x[0] / 0.2);
        }
        if (n % 8 == 0) /* over a vertex */
        {
            x[1] = 0.2 * floor(x[1] / 0.2);
        }
        if (n % 4 == 1) /* over the diagonals */
        {
            x[1] = n % 8 == 1 ? x[0] : -x[0];
        }
        for (int w = 0; w < 4; w++)
        {
            const double f = x[2] < 1 ? pow(1 - x[2], 1.5) : 0;

            /* 1e-12 of the force of a deep touch, 0.03 */
            assert_force(&walls[w], x, 0, 0, f, 1e-12 * 0.03);
        }
    }
    for (int w = 0; w < 4; w++)
    {
        wall_mesh_free(&walls[w]);
    }
}

/* A box's faces cut along either diagonal, from inside and outside. */
static void test_box_however_cut(void **unused)
{
    uint64_t seed = 2;

    (void)unused;
    for (int inwards = 0; inwards < 2; inwards++)
    {
        wall_mesh a = box_of(3, inwards, 0), b = box_of(3, inwards, 1);

        for (int n = 0; n < 4000; n++)
        {
            double x[3], fa[3], fb[3];

            for (int i = 0; i < 3; i++)
            {
                const double away = 0.9 + 0.2 * test_uniform(&seed);

                x[i] = (test_uniform(&seed) < 0.5 ? -1 : 1)
                     * (inwards ? 3 - away : 3 + away);
                if (test_uniform(&seed) < 0.5)
                {
                    x[i] = 3.3 * test_signed(&seed);
                }
            }
            touch(&a, x, fa);
            touch(&b, x, fb);
            assert_near(distance(fa, fb), 0, 1e-12 * 0.03);
        }
        wall_mesh_free(&a);
        wall_mesh_free(&b);
    }
}

static void test_one_facet_small_or_large(void **unused)
{
    /* a free triangle: face, edge and corner each by its own distance */
    const double sizes[] = {0.01, 1, 1e6};

    (void)unused;
    for (int s = 0; s < 3; s++)
    {
        const double a[3] = {0, 0, 0}, b[3] = {sizes[s], 0, 0};
        const double c[3] = {0, sizes[s], 0};
        const double over[3] = {0.3 * sizes[s], 0.3 * sizes[s], 0.9};
        const double beside[3] = {0.3 * sizes[s], -0.54, 0.72};
        const double corner[3] = {-0.54 * 0.6, -0.54 * 0.8, 0.72};
        const double level[3] = {0.3 * sizes[s], -0.9, 0};
        const double under[3] = {0.3 * sizes[s], -0.54, -0.72};
        const double f = pow(0.1, 1.5);
        wall_mesh wall;

        wall_mesh_init(&wall);
        wall_mesh_triangle(&wall, a, b, c, 0);
        wall_mesh_finish(&wall);
        assert_force(&wall, over, 0, 0, f, 1e-15);
        assert_force(&wall, beside, 0, -0.6 * f, 0.8 * f, 1e-15);
        assert_force(&wall, corner, -0.36 * f, -0.48 * f, 0.8 * f, 1e-15);
        assert_force(&wall, level, 0, -f, 0, 1e-15);
        assert_force(&wall, under, 0, -0.6 * f, -0.8 * f, 1e-15);
        wall_mesh_free(&wall);
    }
}

/* Perpendicular faces push fully, each as if alone. */
static void test_concave_corner(void **unused)
{
    wall_mesh wall = box_of(3, 1, 0);
    const double edge[3] = {-3 + 0.95, 0.4, 3 - 0.9};
    const double corner[3] = {-3 + 0.95, 3 - 0.99, 3 - 0.9};

    (void)unused;
    assert_force(&wall, edge, pow(0.05, 1.5), 0, -pow(0.1, 1.5), 1e-15);
    assert_force(&wall, corner, pow(0.05, 1.5), -pow(0.01, 1.5), -pow(0.1, 1.5),
                 1e-15);
    wall_mesh_free(&wall);
}

/* Both faces of a valley touched alike: the force along either normal is that
   of the face, so together f / cos(lean) along the middle. */
static void test_valley(void **unused)
{
    (void)unused;
    for (int k = 1; k < 14; k++)
    {
        const double lean = 0.1 * k;
        wall_mesh wall = wedge_of(lean, 3, 0);
        const double x[3] = {0, 0.3, 0.97 / cos(lean)};
        const double f = pow(0.03, 1.5);
        const double expected =
            lean < test_pi / 4 ? f / cos(lean) : 2 * cos(lean) * f;

        assert_force(&wall, x, 0, 0, expected, 1e-14);
        wall_mesh_free(&wall);
    }
}

/* A slit narrower than the bead pushes from both sides. */
static void test_slit(void **unused)
{
    const double low[3] = {-5, -5, -0.9}, high[3] = {5, 5, 0.9};
    const double middle[3] = {0, 0, 0}, raised[3] = {0.3, 0.1, 0.05};
    wall_mesh wall;

    (void)unused;
    wall_mesh_init(&wall);
    wall_mesh_box(&wall, low, high, 1, 0, 0);
    wall_mesh_finish(&wall);
    assert_force(&wall, middle, 0, 0, 0, 1e-15);
    assert_force(&wall, raised, 0, 0, pow(0.05, 1.5) - pow(0.15, 1.5), 1e-15);
    wall_mesh_free(&wall);
}

/* A plate thinner than the bead: its far side does not act through it, and a
   centre pushed into it is pushed out again by the way it came. */
static void test_thin_plate(void **unused)
{
    const double low[3] = {-5, -5, -0.1}, high[3] = {5, 5, 0.1};
    wall_mesh wall;

    (void)unused;
    wall_mesh_init(&wall);
    wall_mesh_box(&wall, low, high, 0, 0, 0);
    wall_mesh_finish(&wall);
    for (double z = 0.01; z < 1.2; z += 0.01)
    {
        const double above[3] = {0.2, -0.4, z}, below[3] = {0.2, -0.4, -z};
        const double f = z < 1.1 ? pow(1.1 - z, 1.5) : 0;

        assert_force(&wall, above, 0, 0, f, 1e-15);
        assert_force(&wall, below, 0, 0, -f, 1e-15);
    }
    wall_mesh_free(&wall);
}

/* A baffle is two walls in one place, back to back. */
static void test_baffle(void **unused)
{
    const double corner[3] = {-3, -3, 0};
    const double u[3] = {6, 0, 0}, v[3] = {0, 6, 0};
    wall_mesh wall;

    (void)unused;
    wall_mesh_init(&wall);
    wall_mesh_plane(&wall, corner, u, v, 3, 3, 0, 0);
    wall_mesh_plane(&wall, corner, v, u, 3, 3, 1, 1);
    wall_mesh_finish(&wall);
    for (double z = 0.05; z < 1.2; z += 0.05)
    {
        const double above[3] = {0.2, -0.4, z}, below[3] = {0.2, -0.4, -z};
        const double f = z < 1 ? pow(1 - z, 1.5) : 0;

        assert_force(&wall, above, 0, 0, f, 1e-15);
        assert_force(&wall, below, 0, 0, -f, 1e-15);
    }
    wall_mesh_free(&wall);
}

/* A pit of three planes, each 15 degrees from the floor, n[k] their normals. Where
   the bead leaves the first over the edge to the second, the contact that ends
   there takes nothing from that with the third: no force jumps. */
static void test_pit(void **unused)
{
    double n[3][3], corner[3][3], force[2][3];
    const double bottom[3] = {0, 0, 0}, lean = test_pi / 12;
    wall_mesh wall;

    (void)unused;
    for (int k = 0; k < 3; k++)
    {
        const double angle = 2 * test_pi * k / 3;

        ellipsoid_set(n[k], -sin(lean) * cos(angle), -sin(lean) * sin(angle),
                      cos(lean));
    }
    wall_mesh_init(&wall);
    for (int k = 0; k < 3; k++)
    {
        ellipsoid_cross(n[k], n[(k + 1) % 3], corner[k]);
        for (int i = 0; i < 3; i++)
        {
            corner[k][i] *= 3 / corner[k][2];
        }
    }
    for (int k = 0; k < 3; k++)
    {
        wall_mesh_triangle(&wall, bottom, corner[(k + 2) % 3], corner[k], k);
    }
    wall_mesh_finish(&wall);
    for (double height = 0.7; height < 0.99; height += 0.02)
    {
        for (int side = 0; side < 2; side++)
        {
            double x[3];

            for (int i = 0; i < 3; i++)
            {
                x[i] = 0.004 * corner[0][i] + height * n[0][i]
                     + (side ? 1e-9 : -1e-9) * (n[0][i] - n[1][i]);
            }
            assert_int_equal(touch(&wall, x, force[side]), 3 - side);
        }
        assert_near(distance(force[0], force[1]), 0, 1e-6);
    }
    wall_mesh_free(&wall);
}

/* On the edge of a table but for rounding it is the table that the bead touches,
   whichever of both facets comes first. */
static void test_edge_but_for_rounding(void **unused)
{
    const double corner[3] = {-3, -3, 0}, along[3] = {3, 0, 0};
    const double brink[3] = {0, -3, 0}, down[3] = {0, 0, -3};
    const double across[3] = {0, 6, 0}, x[3] = {-1e-12, 0.3, 0.9};
    int order[4];
    wall_mesh wall;
    ellipsoid_facet_list list;

    (void)unused;
    wall_mesh_init(&wall);
    wall_mesh_plane(&wall, corner, along, across, 1, 1, 0, 0);
    wall_mesh_plane(&wall, brink, down, across, 1, 1, 0, 1);
    wall_mesh_finish(&wall);
    list = wall_mesh_all(&wall);
    list.index = order;
    for (int start = 0; start < 8; start++)
    {
        double force[3], slope[3][3];

        for (int k = 0; k < 4; k++)
        {
            order[k] = (start + (start < 4 ? k : 4 - k)) % 4;
        }
        assert_int_equal(ellipsoid_bead_force(x, r, 1, &list, force, slope), 1);
        assert_true(force[0] == 0 && force[1] == 0 && force[2] > 0);
        assert_true(slope[0][0] == 0 && slope[2][2] < 0);
    }
    wall_mesh_free(&wall);
}

/* In a tube of 24 sides, each of which it overlaps: the deepest 16 count, and in
   the order of the facets nothing but rounding. */
static void test_more_contacts_than_count(void **unused)
{
    enum
    {
        SIDES = 24
    };
    const double x[3] = {0.006, 0, 0.0043}, out = 0.98 / cos(test_pi / SIDES);
    double corner[2][SIDES][3], first[3], force[3];
    int order[2 * SIDES];
    wall_mesh wall;
    ellipsoid_facet_list list;

    (void)unused;
    for (int k = 0; k < SIDES; k++)
    {
        const double angle = 2 * test_pi * k / SIDES;

        for (int end = 0; end < 2; end++)
        {
            ellipsoid_set(corner[end][k], out * cos(angle), 4 * end - 2,
                          out * sin(angle));
        }
    }
    wall_mesh_init(&wall);
    for (int k = 0; k < SIDES; k++)
    {
        const int next = (k + 1) % SIDES;

        wall_mesh_quad(&wall, corner[0][k], corner[0][next], corner[1][next],
                       corner[1][k], 0, 0);
    }
    wall_mesh_finish(&wall);
    assert_int_equal(touch(&wall, x, first), 16);
    list = wall_mesh_all(&wall);
    list.index = order;
    for (int start = 0; start < 2 * SIDES; start++)
    {
        for (int k = 0; k < 2 * SIDES; k++)
        {
            const int at = start % 2 ? 2 * SIDES - k : k;

            order[k] = (start + at) % (2 * SIDES);
        }
        assert_int_equal(ellipsoid_bead_force(x, r, 1, &list, force, NULL), 16);
        assert_near(distance(force, first), 0, 1e-12);
    }
    assert_true(ellipsoid_length(first) > 1e-4);
    wall_mesh_free(&wall);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_flat_wall_however_cut),
        cmocka_unit_test(test_box_however_cut),
        cmocka_unit_test(test_one_facet_small_or_large),
        cmocka_unit_test(test_concave_corner),
        cmocka_unit_test(test_valley),
        cmocka_unit_test(test_slit),
        cmocka_unit_test(test_thin_plate),
        cmocka_unit_test(test_baffle),
        cmocka_unit_test(test_pit),
        cmocka_unit_test(test_edge_but_for_rounding),
        cmocka_unit_test(test_more_contacts_than_count),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
