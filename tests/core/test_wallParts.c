/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_wallParts.c - what part of its plane a wall counts by: however it is cut,
    where it ends, where it bends.
*/
#include "wallResistanceTest.h"
#include "drag/wallParts.h"

/* However the wall is cut; what rounding leaves. */
static void test_cuts(void **unused)
{
    const ellipsoid_options o = near_walls();
    const ellipsoid_model model = test_model(&o);
    wall_mesh whole, cut;
    uint64_t seed = 22;

    (void)unused;
    wall_mesh_init(&whole);
    wall_mesh_init(&cut);
    add_floor(&whole, 0, 1, 1);
    add_floor(&cut, 0, 40, 37);
    wall_mesh_finish(&whole);
    wall_mesh_finish(&cut);
    for (int n = 0; n < 200; n++)
    {
        /* some right above vertices and edges */
        const double step[2] = {1e-4 / 40, 1e-4 / 37};
        double x[3] = {0, -5e-5 + 18 * step[1], 3e-6}, q[4];
        double a[6][6], b[6][6];

        if (n % 4 > 0)
        {
            x[0] = 1e-6 * test_signed(&seed);
        }
        if (n % 4 > 1)
        {
            x[1] = 1e-6 * test_signed(&seed);
        }
        x[2] = 1e-6 + 6e-6 * test_uniform(&seed);
        test_orientation(&seed, q);
        ellipsoid_facet_cache_clear(&cache);
        lab_resistance(&model, &whole, x, q, a);
        ellipsoid_facet_cache_clear(&cache);
        lab_resistance(&model, &cut, x, q, b);
        assert_true(difference(a, b) < 1e-11);
    }
    wall_mesh_free(&whole);
    wall_mesh_free(&cut);
}

/*
    A sphere whose nearest point is beside the rim of a half-plane, inside it by
    so many widths sqrt(2 g R) of squeezing: how much of it is left, beside what
    Reynolds' equation gives, solved by differences in 121 x 121 points.
*/
static void test_wall_that_ends(void **unused)
{
    static const double known[][2] = {{-1, 0.055},  {-0.5, 0.127}, {0, 0.289},
                                      {0.5, 0.529}, {1, 0.725},    {2.5, 0.94}};
    const double radius = 0.5e-6, gap = 0.05e-6;
    const double corner[3] = {0, -5e-5, 0}, along[3] = {5e-5, 0, 0},
                 across[3] = {0, 1e-4, 0};
    ellipsoid_options o = near_walls();
    ellipsoid_model model;
    wall_mesh mesh;

    (void)unused;
    ellipsoid_set(o.semi_axes, radius, radius, radius);
    model = test_model(&o);
    wall_mesh_init(&mesh);
    wall_mesh_plane(&mesh, corner, along, across, 1, 1, 0, 0);
    wall_mesh_finish(&mesh);
    for (size_t n = 0; n < sizeof(known) / sizeof(*known); n++)
    {
        const ellipsoid_state state = {
            .x = {known[n][0] * sqrt(2 * gap * radius), 0, radius + gap},
            .q = {0, 0, 0, 1}};
        const ellipsoid_planes planes = planes_at(&model, &mesh, &state);

        assert_int_equal(planes.count, 1);
        assert_near(planes.at[0].weight[ELLIPSOID_PLANE_NEAR].value,
                    known[n][1], 0.07);
    }
    wall_mesh_free(&mesh);
}

/*
    A sphere by a round post or in a tunnel: squeezing is that of a sphere of
    radii R1 = 1/(1/a +- 1/R) and a at a plane, and alike however finely the wall
    is cut, above a facet and above an edge.
*/
static void test_round_wall(void **unused)
{
    static const test_row row = {
        "walls",
        "squeezing of a sphere at a round wall over that known",
        "posts and tunnels of 4 and 8 radii in 96 and 192 facets, gap 0.06 "
        "radii",
        "Reynolds' equation, S^3/(R1 + R2) of the reduced radii",
        "A",
        "15 %: terms of lower order are left out there, and here it is a sum "
        "of planes",
        0};
    const double radius = 1e-6, gap = 0.06e-6;
    const double x[3] = {0, 0, radius + gap}, q[4] = {0, 0, 0, 1};
    ellipsoid_options o = near_walls();
    ellipsoid_model model;
    double flat[6][6], free;
    wall_mesh floor;

    (void)unused;
    ellipsoid_set(o.semi_axes, radius, radius, radius);
    model = test_model(&o);
    free = 1e-9 * 6 * test_pi * model.viscosity * radius;
    wall_mesh_init(&floor);
    add_floor(&floor, 0, 1, 1);
    wall_mesh_finish(&floor);
    ellipsoid_facet_cache_clear(&cache);
    lab_resistance(&model, &floor, x, q, flat);
    wall_mesh_free(&floor);
    for (int n = 0; n < 16; n++)
    {
        arc shape = {n % 2 ? 1 : -1, (n & 2 ? 4 : 8) * radius};
        const int facets = (n & 4 ? 96 : 192) + (n & 8 ? 1 : 0);
        const double bent =
            1 / (1 / radius - shape.sign / shape.radius) / radius;
        const double known = 2 * pow(bent, 1.5) / (bent + 1);
        double found[6][6], ratio;
        wall_mesh mesh;

        wall_mesh_init(&mesh);
        wall_mesh_grid(&mesh, facets, 3, bend, &shape, 2, 0);
        wall_mesh_finish(&mesh);
        ellipsoid_facet_cache_clear(&cache);
        lab_resistance(&model, &mesh, x, q, found);
        ratio = (found[2][2] - free) / (flat[2][2] - free) / known;
        print_message("%s of %g in %d: %.3f, %.3f of it\n",
                      n % 2 ? "tunnel" : "post", shape.radius, facets,
                      ratio * known, ratio);
        assert_row(&row, ratio, 1, 0.15);
        wall_mesh_free(&mesh);
    }
}

/* One face of a ridge along x2, which falls by an angle to the one side (1) or
   the other (-1). */
static void add_face(wall_mesh *mesh, int side, double angle)
{
    const double far = 5e-5, x = side * far * cos(angle), z = -far * sin(angle);
    const double ridge[2][3] = {{0, -far, 0}, {0, far, 0}};
    const double foot[2][3] = {{x, -far, z}, {x, far, z}};

    wall_mesh_quad(mesh, ridge[side < 0], foot[side < 0], foot[side > 0],
                   ridge[side > 0], 0, 0);
}

/* Over a ridge a face counts by s (s + c): c is what the other one goes on with,
   s and that one's are found where each face is alone, and counts by its square.
   A bend of 30 degrees is as good as none, one of 90 is a rim. */
static void test_ridge(void **unused)
{
    static const double bend_of[] = {0.1, test_pi / 6, test_pi / 3,
                                     test_pi / 2};
    const double radius = 1e-6;
    ellipsoid_options o = near_walls();
    ellipsoid_model model;

    (void)unused;
    ellipsoid_set(o.semi_axes, radius, radius, radius);
    model = test_model(&o);
    for (int n = 0; n < 4; n++)
    {
        const double cosine = cos(bend_of[n]);
        double near[3], s[2], rest, t;

        for (int faces = 1; faces < 4; faces++)
        {
            const ellipsoid_state state = {.x = {0.05e-6, 0, 1.7e-6},
                                           .q = {0, 0, 0, 1}};
            ellipsoid_planes planes;
            wall_mesh mesh;

            wall_mesh_init(&mesh);
            if (faces & 1)
            {
                add_face(&mesh, 1, bend_of[n] / 2);
            }
            if (faces & 2)
            {
                add_face(&mesh, -1, bend_of[n] / 2);
            }
            wall_mesh_finish(&mesh);
            planes = planes_at(&model, &mesh, &state);
            assert_int_equal(planes.count, faces < 3 ? 1 : 2);
            near[faces - 1] = planes.at[0].weight[ELLIPSOID_PLANE_NEAR].value;
            wall_mesh_free(&mesh);
        }
        s[0] = sqrt(near[0]);
        s[1] = sqrt(near[1]);
        rest = 1 - s[0];
        t = fmin(cosine * cosine * s[1] / rest, 1);
        print_message("%.0f degrees: %.3f by itself, %.3f\n",
                      bend_of[n] * 180 / test_pi, near[0], near[2]);
        /* the gap to the face that is farther counts a little less */
        assert_near(near[2], s[0] * (s[0] + rest * t * (2 - t)),
                    0.01 * near[2]);
        assert_true(near[2] < s[0]);
    }
}

/* What a wall goes on with fades as it goes out of range: where the floor beside
   a terrace does, nothing jumps of the terrace. It would be by 50 nm. */
static void test_floor_out_of_range(void **unused)
{
    const double far = 5e-5, step = 1e-10;
    const double rim[2][3] = {{0, -far, 0}, {0, far, 0}};
    const double back[2][3] = {{-far, -far, 0}, {-far, far, 0}};
    ellipsoid_options o = near_walls();
    ellipsoid_model model;
    double gap[2];
    wall_mesh mesh;

    (void)unused;
    ellipsoid_set(o.semi_axes, 0.5e-6, 0.5e-6, 0.5e-6);
    o.wall_range = 10e-6;
    model = test_model(&o);
    wall_mesh_init(&mesh);
    wall_mesh_quad(&mesh, back[0], rim[0], rim[1], back[1], 0, 0);
    add_floor(&mesh, -8.5e-6, 1, 1);
    wall_mesh_finish(&mesh);
    for (int n = 0; n < 2; n++)
    {
        const double z = 1.5e-6 + (n ? step : -step);
        const ellipsoid_state state = {.x = {0, 0, z}, .q = {0, 0, 0, 1}};
        const ellipsoid_planes planes = planes_at(&model, &mesh, &state);

        assert_int_equal(planes.count, n ? 1 : 2);
        for (int k = 0; k < planes.count; k++)
        {
            if (planes.at[k].effect.gap[ELLIPSOID_PLANE_NEAR] < 2e-6)
            {
                gap[n] = planes.at[k].effect.gap[ELLIPSOID_PLANE_FAR];
            }
        }
    }
    assert_near(gap[0], gap[1], 1e-9);
    wall_mesh_free(&mesh);
}

/* Where a wall ends counts as far as 4 heights of the foot, or the widths of
   squeezing, and beyond three quarters of the range nothing does: no wall is
   looked for there. */
static void test_how_far(void **unused)
{
    uint64_t seed = 31;

    (void)unused;
    for (int n = 0; n < 300; n++)
    {
        const double normal[3] = {0, 0, 1}, x[3] = {0};
        ellipsoid_options o = near_walls();
        const double most = 0.75 * o.wall_range;
        ellipsoid_model model;
        ellipsoid_wall_view view = {.model = &model, .x = x};
        double q[4], height, longest = 0;
        ellipsoid_wall wall;

        for (int i = 0; i < 3; i++)
        {
            o.semi_axes[i] *= pow(1.5, test_signed(&seed));
            longest = fmax(longest, o.semi_axes[i]);
        }
        model = test_model(&o);
        test_orientation(&seed, q);
        ellipsoid_rotation(q, view.axis);
        height = o.wall_range * pow(10, -3 * test_uniform(&seed));
        ellipsoid_wall_begin(&view, normal, height, &wall);
        for (int m = 0; m < 2; m++)
        {
            const ellipsoid_wall_kernel *k = &wall.seen[m];
            const double width =
                m == ELLIPSOID_PLANE_FAR
                    ? height
                    : longest * sqrt(2 * wall.gap.value / wall.support.value);
            const double cut = 1 / hypot(1.0 / 4, width / most);

            assert_near(k->cut, cut, 1e-9 * cut);
            assert_near(k->reach, cut * width, 1e-9 * cut * width);
            assert_true(k->reach <= most);
        }
    }
}

/* A small facet of the floor at x1, tilted, with its x3 axis turned by so much. */
static void add_small(wall_mesh *mesh, double at, double turned)
{
    const double size = 5e-8, height = at * turned;
    const double a[3] = {at - size, -size, height - size * turned};
    const double b[3] = {at + size, -size, height + size * turned};
    const double c[3] = {at, size, height};

    wall_mesh_triangle(mesh, a, b, c, 0);
}

/* Of the facets of a plane one that is not seen has no say, not even in whose
   plane it is; one that squeezing alone sees, beneath a low end, counts. */
static void test_unseen(void **unused)
{
    const double side = sqrt(0.5), far = 1.87e-6;
    const double w = 0.5 * sqrt(1 - side), v = -side / (4 * w);
    /* the long axis falls towards x1, at 45 degrees */
    const ellipsoid_state state = {.x = {0, 0, 1.6e-6}, .q = {v, v, w, w}};
    ellipsoid_options o = near_walls();
    ellipsoid_model model;

    (void)unused;
    o.wall_range = 2.5e-6;
    model = test_model(&o);
    for (int n = 0; n < 3; n++)
    {
        ellipsoid_planes planes;
        wall_mesh mesh;

        wall_mesh_init(&mesh);
        if (n != 1)
        {
            /* what no kernel sees, or one of the two */
            add_small(&mesh, n == 0 ? -far : far, 5e-7);
        }
        if (n < 2)
        {
            add_small(&mesh, 0.5e-6, 0);
        }
        wall_mesh_finish(&mesh);
        planes = planes_at(&model, &mesh, &state);
        assert_int_equal(planes.count, 1);
        if (n < 2)
        {
            assert_near(planes.at[0].effect.normal[1], -side, 1e-9);
        }
        else
        {
            assert_true(planes.at[0].weight[ELLIPSOID_PLANE_FAR].value == 0);
            assert_true(planes.at[0].weight[ELLIPSOID_PLANE_NEAR].value != 0);
        }
        wall_mesh_free(&mesh);
    }
}

/* A plane of symmetry is no wall. */
static void test_mirrors(void **unused)
{
    const ellipsoid_options o = near_walls();
    const ellipsoid_model model = test_model(&o);
    const ellipsoid_state state = {.x = {0, 0, 3e-6}, .q = {0, 0, 0, 1}};
    wall_mesh mesh;

    (void)unused;
    wall_mesh_init(&mesh);
    add_floor(&mesh, 0, 1, 1);
    wall_mesh_finish(&mesh);
    for (int mirror = 0; mirror < 2; mirror++)
    {
        for (int f = 0; f < mesh.count; f++)
        {
            mesh.facets[f].mirror = mirror;
        }
        assert_int_equal(planes_at(&model, &mesh, &state).count, !mirror);
    }
    wall_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cuts),
        cmocka_unit_test(test_wall_that_ends),
        cmocka_unit_test(test_round_wall),
        cmocka_unit_test(test_ridge),
        cmocka_unit_test(test_floor_out_of_range),
        cmocka_unit_test(test_how_far),
        cmocka_unit_test(test_unseen),
        cmocka_unit_test(test_mirrors),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
