/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_continuousWalls.c - the drag near walls has no jumps: over seams and
    edges, beside pits and posts.
    Processor time: 6, full 16
*/
#include "wallResistanceTest.h"

/* On a way of so many steps, the largest change from one to the next. */
static double largest_change(const ellipsoid_model *m, wall_mesh *mesh,
                             const double from[3], const double to[3],
                             const double q[4], int steps)
{
    double before[6][6], after[6][6], worst = 0;

    for (int n = 0; n <= steps; n++)
    {
        const double t = (double)n / steps;
        double x[3];

        for (int i = 0; i < 3; i++)
        {
            x[i] = (1 - t) * from[i] + t * to[i];
        }
        lab_resistance(m, mesh, x, q, after);
        worst = n > 0 ? fmax(worst, difference(before, after)) : 0;
        memcpy(before, after, sizeof(before));
    }
    return worst;
}

/*
    Continuous: along ways over concave and convex seams, over the landscape and
    out of range, ten times the steps make the largest change less than a third,
    where a jump would stay.
*/
static void test_continuous(void **unused)
{
    const ellipsoid_options o = near_walls();
    const ellipsoid_model model = test_model(&o);
    uint64_t seed = 23;

    (void)unused;
    for (int n = 0; n < test_count(4, 8, 20); n++)
    {
        const double ends[2][3] = {
            {2e-6 * test_signed(&seed), 3e-6 * test_signed(&seed), 2e-6},
            {2e-6 * test_signed(&seed), 3e-6 * test_signed(&seed),
             n % 4 == 3 ? 14e-6 : 2.5e-6}};
        arc shape = {n % 4 == 1 ? -1 : 1, 8e-6};
        double q[4], coarse, fine;
        wall_mesh mesh;

        wall_mesh_init(&mesh);
        if (n % 4 == 0)
        {
            add_landscape(&mesh);
        }
        else
        {
            wall_mesh_grid(&mesh, n % 4 == 3 ? 7 : 24, 3, bend, &shape, 2, 0);
        }
        wall_mesh_finish(&mesh);
        test_orientation(&seed, q);
        ellipsoid_facet_cache_clear(&cache);
        coarse = largest_change(&model, &mesh, ends[0], ends[1], q, 400);
        fine = largest_change(&model, &mesh, ends[0], ends[1], q, 4000);
        print_message("%d: %.1e %.1e\n", n % 4, coarse, fine);
        assert_true(fine < 0.35 * coarse);
        wall_mesh_free(&mesh);
    }
}

/*
    So too over an edge of a block, each face of it in several facets: a cell
    close above leaves the top, and the plane of a facet that it is beside comes
    apart from that of the edge. A hundred times the steps on a hundredth
    of the way make the largest change less than a tenth.
*/
static void test_continuous_over_edges(void **unused)
{
    ellipsoid_options o = near_walls();
    ellipsoid_model model;
    const double block[2][3] = {{-2e-6, -2e-6, -3e-6}, {2e-6, 2e-6, 0}};
    const double low[3] = {-6e-6, -6e-6, -3e-6}, high[3] = {6e-6, 6e-6, 4e-6};
    uint64_t seed = 26;
    wall_mesh mesh;

    (void)unused;
    ellipsoid_set(o.semi_axes, 0.5e-6, 1e-6, 0.5e-6);
    model = test_model(&o);
    wall_mesh_init(&mesh);
    wall_mesh_box(&mesh, low, high, 1, 2, 0);
    wall_mesh_box(&mesh, block[0], block[1], 0, 8, 0);
    wall_mesh_finish(&mesh);
    ellipsoid_facet_cache_clear(&cache);
    for (long n = test_count(3, 20, 60); n > 0; n--)
    {
        const double from[3] = {0.5e-6 * test_signed(&seed), 1.4e-6,
                                1.2e-6 + 1e-6 * test_uniform(&seed)};
        const double to[3] = {from[0] + 0.3e-6 * test_signed(&seed), 2.9e-6,
                              from[2]};
        double q[4], coarse = 0, fine = 0;

        test_orientation(&seed, q);
        for (int part = 0; part < 100; part++)
        {
            double ends[2][3];

            for (int i = 0; i < 3; i++)
            {
                ends[0][i] = from[i] + (to[i] - from[i]) * part / 100;
                ends[1][i] = from[i] + (to[i] - from[i]) * (part + 1) / 100;
            }
            coarse = fmax(
                coarse, largest_change(&model, &mesh, ends[0], ends[1], q, 2));
            fine = fmax(fine,
                        largest_change(&model, &mesh, ends[0], ends[1], q, 40));
        }
        assert_true(fine < 0.1 * coarse + 1e-12);
    }
    wall_mesh_free(&mesh);
}

/* As in test_continuous(), but for rounding, where nothing changes. */
static int is_continuous(const ellipsoid_model *m, wall_mesh *mesh,
                         const double from[3], const double to[3],
                         const double q[4])
{
    const double coarse = largest_change(m, mesh, from, to, q, 400);
    const double fine = largest_change(m, mesh, from, to, q, 4000);

    return fine < 0.35 * coarse + 1e-12;
}

/* A floor x3 = 0 along a wall x1 = 0. The floor is cut from the seam at x2 = 0
   to its far side at x2 = lean; or it has a pit, 1.5 by 5 um and 2 um deep. */
static void add_floor_at_wall(wall_mesh *mesh, double lean, int has_pit)
{
    static const double um = 1e-6;
    const double f = 12 * um, p[2] = {2 * um, 3.5 * um}, q = 5 * um;
    const double seam[3][3] = {{0, -f, 0}, {0}, {0, f, 0}};
    const double far[3][3] = {{f, -f, 0}, {f, lean, 0}, {f, f, 0}};
    const double rim[4][3] = {
        {p[0], 0, 0}, {p[1], 0, 0}, {p[1], q, 0}, {p[0], q, 0}};
    const double bottom[4][3] = {
        {p[0], 0, -p[0]}, {p[1], 0, -p[0]}, {p[1], q, -p[0]}, {p[0], q, -p[0]}};

    wall_mesh_quad(mesh, seam[0], far[0], far[1], seam[1], 0, 0);
    for (int part = 0; part < 2; part++)
    {
        double top[2][3];

        for (int end = 0; end < 2; end++)
        {
            ellipsoid_set(top[end], 0, seam[part + end][1], f);
        }
        wall_mesh_quad(mesh, seam[part], seam[part + 1], top[1], top[0], 0, 1);
    }
    if (!has_pit)
    {
        wall_mesh_quad(mesh, seam[1], far[1], far[2], seam[2], 0, 0);
        return;
    }
    wall_mesh_triangle(mesh, seam[1], far[1], rim[0], 0);
    wall_mesh_triangle(mesh, rim[0], far[1], rim[1], 0);
    wall_mesh_quad(mesh, rim[1], far[1], far[2], rim[2], 0, 0);
    wall_mesh_quad(mesh, rim[3], rim[2], far[2], seam[2], 0, 0);
    wall_mesh_quad(mesh, seam[1], rim[0], rim[3], seam[2], 0, 0);
    for (int k = 0; k < 4; k++)
    {
        const int next = (k + 1) % 4;

        wall_mesh_quad(mesh, rim[k], bottom[k], bottom[next], rim[next], 0, 0);
    }
}

/* Over a concave seam the floor goes on alike, however it is cut; what rounding
   leaves. */
static void test_cuts_at_a_seam(void **unused)
{
    const ellipsoid_options o = near_walls();
    const ellipsoid_model model = test_model(&o);
    uint64_t seed = 29;

    (void)unused;
    for (int n = 0; n < 300; n++)
    {
        const double x[3] = {(1.7 + 0.6 * test_signed(&seed)) * 1e-6,
                             0.5e-6 * test_signed(&seed), 2.5e-6};
        const double tip = 0.5 * test_pi * test_uniform(&seed);
        const double axis[3] = {cos(tip), 0, sin(tip)};
        double q[4], a[6][6], b[6][6];
        wall_mesh straight, oblique;

        wall_mesh_init(&straight);
        wall_mesh_init(&oblique);
        add_floor_at_wall(&straight, 0, 0);
        add_floor_at_wall(&oblique, 10e-6 * test_signed(&seed), 0);
        wall_mesh_finish(&straight);
        wall_mesh_finish(&oblique);
        ellipsoid_quaternion_from_axis(axis, 0, q);
        ellipsoid_facet_cache_clear(&cache);
        lab_resistance(&model, &straight, x, q, a);
        ellipsoid_facet_cache_clear(&cache);
        lab_resistance(&model, &oblique, x, q, b);
        assert_true(difference(a, b) < 1e-10);
        wall_mesh_free(&straight);
        wall_mesh_free(&oblique);
    }
}

/* Nor do the edges of a pit end it, that are in its plane but not at the seam:
   a cell tipped towards the wall approaches that, beside the pit. */
static void test_continuous_beside_a_pit(void **unused)
{
    const double axis[3] = {0.70710678118654752, 0, 0.70710678118654752};
    const ellipsoid_options o = near_walls();
    const ellipsoid_model model = test_model(&o);
    double q[4];
    wall_mesh mesh;

    (void)unused;
    wall_mesh_init(&mesh);
    add_floor_at_wall(&mesh, -5e-6, 1);
    wall_mesh_finish(&mesh);
    ellipsoid_quaternion_from_axis(axis, 0, q);
    ellipsoid_facet_cache_clear(&cache);
    for (int n = 0; n < 15; n += test_count(5, 1, 1))
    {
        const double y = (-9 + 0.4 * n) * 1e-6;
        const double from[3] = {3.2e-6, y, 2.5e-6}, to[3] = {1.6e-6, y, 2.5e-6};

        assert_true(is_continuous(&model, &mesh, from, to, q));
    }
    wall_mesh_free(&mesh);
}

/* A post, upright at x1 > 0, x2 < 0, under a lid x3 = 3 um: two of its faces,
   each long or high, in two triangles. */
static void add_post(wall_mesh *mesh, int diagonal)
{
    const double f = 8e-6, h = 3e-6, low = -5e-6;
    const double foot[3][3] = {{0, -f, low}, {0, 0, low}, {f, 0, low}};
    const double top[3][3] = {{0, -f, h}, {0, 0, h}, {f, 0, h}};
    const double lid[5][3] = {
        {-f, -f, h}, {-f, 0, h}, {-f, f, h}, {0, f, h}, {f, f, h}};

    wall_mesh_quad(mesh, foot[1], foot[0], top[0], top[1], diagonal, 0);
    wall_mesh_quad(mesh, foot[2], foot[1], top[1], top[2], diagonal, 0);
    wall_mesh_quad(mesh, top[0], lid[0], lid[1], top[1], diagonal, 1);
    wall_mesh_quad(mesh, top[1], lid[1], lid[2], lid[3], diagonal, 1);
    wall_mesh_quad(mesh, top[2], top[1], lid[3], lid[4], diagonal, 1);
}

/*
    So too by the edge of a post below the lid on which it stands: the planes of
    its faces go on above the lid as far as the edge does, with either diagonal.
    The cell tips towards the lid and a face, so that they stay perpendicular by
    M: else a face and its edge fade by distances that are not quite the same.
*/
static void test_continuous_by_a_post(void **unused)
{
    const ellipsoid_options o = near_walls();
    const ellipsoid_model model = test_model(&o);
    uint64_t seed = 28;

    (void)unused;
    for (int diagonal = 0; diagonal < 2; diagonal++)
    {
        wall_mesh mesh;

        wall_mesh_init(&mesh);
        add_post(&mesh, diagonal);
        wall_mesh_finish(&mesh);
        ellipsoid_facet_cache_clear(&cache);
        for (long n = test_count(2, 12, 40); n > 0; n--)
        {
            const double from[3] = {(-3 + test_signed(&seed)) * 1e-6,
                                    (-2 + test_signed(&seed)) * 1e-6,
                                    (1 + 0.5 * test_signed(&seed)) * 1e-6};
            const double to[3] = {from[0], from[1] + 4e-6, from[2]};
            const double tip = 0.5 * test_pi * test_uniform(&seed);
            const double axis[3] = {cos(tip), 0, sin(tip)};
            double q[4];

            ellipsoid_quaternion_from_axis(axis, 0, q);
            assert_true(is_continuous(&model, &mesh, from, to, q));
        }
        wall_mesh_free(&mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_continuous),
        cmocka_unit_test(test_continuous_over_edges),
        cmocka_unit_test(test_cuts_at_a_seam),
        cmocka_unit_test(test_continuous_beside_a_pit),
        cmocka_unit_test(test_continuous_by_a_post),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
