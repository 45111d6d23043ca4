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

static void assert_derivative(const wall_mesh *wall, const double x[3],
                              int contacts)
{
    const double h = 1e-6;
    const ellipsoid_facet_list facets = wall_mesh_all(wall);
    double force[3], exact[3][3];

    assert_int_equal(ellipsoid_bead_force(x, r, 1, &facets, force, exact),
                     contacts);
    for (int j = 0; j < 3; j++)
    {
        double up[3], down[3], y[3];

        ellipsoid_copy(x, y);
        y[j] = x[j] + h;
        touch(wall, y, up);
        y[j] = x[j] - h;
        touch(wall, y, down);
        for (int i = 0; i < 3; i++)
        {
            /* the difference quotient's own error: h^2 f''', and f eps/h */
            assert_near(exact[i][j], (up[i] - down[i]) / (2 * h), 2e-7);
        }
    }
}

static void test_derivative_is_exact(void **unused)
{
    wall_mesh outside = box_of(2, 0, 0), inside = box_of(2, 1, 1);
    const double face[3] = {0.3, 0.2, 2.95};
    const double edge[3] = {0.3, 2.5, 2.8}, corner[3] = {2.5, 2.6, 2.55};
    const double two[3] = {-1.05, 0.2, 1.1}, three[3] = {-1.05, 1.02, 1.1};
    uint64_t seed = 5;

    (void)unused;
    assert_derivative(&outside, face, 1);
    assert_derivative(&outside, edge, 1);
    assert_derivative(&outside, corner, 1);
    assert_derivative(&inside, two, 2);
    assert_derivative(&inside, three, 3);
    wall_mesh_free(&outside);
    wall_mesh_free(&inside);

    /* two planes at any angle: weights and shares */
    for (int k = 1; k < 16; k++)
    {
        const double lean = 0.05 * k;
        wall_mesh wall = wedge_of(lean, 1, 0);
        const double x[3] = {0.005 * lean, 0.1, 0.95 / cos(lean)};

        assert_derivative(&wall, x, 2);
        wall_mesh_free(&wall);
    }

    /* an edge and a face, an edge and an edge: normals that turn */
    wall_mesh ground = terrain_of(0.5, &seed);
    int checked = 0;

    for (int n = 0; n < 100000 && checked < 200; n++)
    {
        const double x[3] = {12 + 16 * test_uniform(&seed),
                             12 + 16 * test_uniform(&seed),
                             0.7 + 0.8 * test_uniform(&seed)};
        double force[3], y[3];
        const int contacts = touch(&ground, x, force);
        int kinks = contacts < 2;

        /* not across the ends of contacts, where the derivative changes */
        for (int k = 0; k < 8 && !kinks; k++)
        {
            for (int i = 0; i < 3; i++)
            {
                y[i] = x[i] + (k >> i & 1 ? 1e-4 : -1e-4);
            }
            kinks = touch(&ground, y, force) != contacts
                 || ellipsoid_dot(force, force) > 0.2;
        }
        if (!kinks)
        {
            assert_derivative(&ground, x, contacts);
            checked++;
        }
    }
    assert_int_equal(checked, 200);
    wall_mesh_free(&ground);
}

/* One contact at a time is a potential: 0.4 d^2.5. */
static void test_energy_is_kept(void **unused)
{
    wall_mesh wall = box_of(3, 0, 0);
    const int samples = 40000;
    const double middles[3][3] = {
        {0.4, 0.5, 3.95}, {0.2, 3.69, 3.69}, {3.56, 3.56, 3.56}};

    (void)unused;
    for (int m = 0; m < 3; m++)
    {
        double work = 0, spent = 0, before[3], x[3], force[3];

        for (int s = 0; s <= samples; s++)
        {
            const double a = 2 * test_pi * s / samples;

            for (int i = 0; i < 3; i++)
            {
                x[i] =
                    middles[m][i] + 0.04 * cos(a + 2 * i) + 0.01 * sin(3 * a);
            }
            touch(&wall, x, force);
            if (s > 0)
            {
                /* force at the end, with the midpoint made up for by symmetry:
                   the trapezoidal rule on a closed path */
                for (int i = 0; i < 3; i++)
                {
                    work += force[i] * (x[i] - before[i]) / 2;
                    spent += fabs(force[i] * (x[i] - before[i]));
                }
            }
            ellipsoid_copy(x, before);
            if (s < samples)
            {
                double next[3];
                const double b = 2 * test_pi * (s + 1) / samples;

                for (int i = 0; i < 3; i++)
                {
                    next[i] = middles[m][i] + 0.04 * cos(b + 2 * i)
                            + 0.01 * sin(3 * b);
                    work += force[i] * (next[i] - x[i]) / 2;
                }
            }
        }
        assert_true(spent > 1e-4);
        assert_near(work, 0, 1e-8 * spent);
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
        cmocka_unit_test(test_derivative_is_exact),
        cmocka_unit_test(test_energy_is_kept),
    };

    return cmocka_run_group_tests_name("touch", tests, NULL, NULL);
}
