/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_flatParts.c - walls of unordered triangles, as strangers' meshes have
    them: what is nearly a plane resists as one.
*/
#include "wallResistanceTest.h"
#include "drag/drag.h"
#include "wallsTest.h"
#include "walls/wallSurface.h"

#include <stdlib.h>

/* A surface whose points are moved within it, each by up to 0.3 of a step. */
typedef struct scattered
{
    arc shape;
    double length, step[2]; /* [m] along x2; of u and v */
    double noise;           /* [m] off the surface */
} scattered;

static double hashed(double a, double b)
{
    const double s = 43758.5453 * sin(12.9898 * a + 78.233 * b);

    return 2 * (s - floor(s)) - 1;
}

static void scatter(const double *uv, double point[3], void *context)
{
    const scattered *s = context;
    const double u[2] = {
        uv[0] + 0.3 * s->step[0] * hashed(uv[0] + 0.1, uv[1] + 0.2),
        uv[1] + 0.3 * s->step[1] * hashed(uv[0] + 0.4, uv[1] + 0.7)};
    const double angle = 2 * test_pi * (u[0] - 0.5);
    const double r = s->shape.radius + s->noise * hashed(uv[1], uv[0]);

    if (s->shape.sign == 0)
    {
        ellipsoid_set(point, s->length * (u[0] - 0.5), s->length * (u[1] - 0.5),
                      s->noise * hashed(uv[1], uv[0]));
        return;
    }
    ellipsoid_set(point, r * sin(angle), s->length * (u[1] - 0.5),
                  s->shape.sign * (s->shape.radius - r * cos(angle)));
}

/* A quarter of it all round, in triangles of `size`; parts flat to `depth`. */
static made_walls make(scattered s, double size, double depth)
{
    const double around =
        s.shape.sign == 0 ? s.length : 2 * test_pi * s.shape.radius;
    const int nu = (int)(around / size), nv = (int)(s.length / size);
    wall_mesh mesh;
    made_walls m;

    s.step[0] = 1.0 / nu;
    s.step[1] = 1.0 / nv;
    wall_mesh_init(&mesh);
    wall_mesh_grid(&mesh, nu, nv, scatter, &s, 2, 0);
    m = triangles_of(&mesh);
    m.options.same_point = 1e-12;
    m.options.flat_depth = depth;
    assert_ok(create(&m));
    wall_mesh_free(&mesh);
    return m;
}

/* What the plane x3 = 0 adds where the walls are seen from here; planes: how
   many of them squeeze. */
static double squeezing(const ellipsoid_model *model, const made_walls *m,
                        const double x[3], int *planes_found)
{
    static const double still[9] = {0}, down[6] = {0, 0, -1};
    ellipsoid_walls_context context = {m->walls, m->count,
                                       malloc(m->count * sizeof(int))};
    test_quadratic rest = {.answer = 0};
    const ellipsoid_surroundings s = {.flow = test_quadratic_flow,
                                      .flow_context = &rest,
                                      .walls = ellipsoid_walls_list,
                                      .walls_context = &context};
    ellipsoid_state state = {.q = {0, 0, 0, 1}};
    ellipsoid_planes planes;
    double force = 0;

    *planes_found = 0;
    ellipsoid_copy(x, state.x);
    ellipsoid_facet_cache_clear(&cache);
    assert_ok(ellipsoid_find_planes(model, &s, &state, 0, &cache, &planes));
    for (int p = 0; p < planes.count; p++)
    {
        double action[2][6];

        *planes_found += planes.at[p].weight[ELLIPSOID_PLANE_NEAR].value != 0;
        action_of(&planes.at[p].effect, still, down, action);
        force += planes.at[p].weight[ELLIPSOID_PLANE_NEAR].value
               * action[ELLIPSOID_PLANE_NEAR][2];
    }
    free(context.index);
    return force;
}

/*
    A sphere by a round post or in a tunnel of triangles in no order: squeezing
    is that of the reduced radii, as of walls in strips (test_wallParts.c),
    however fine they are.
*/
static void test_round(void **unused)
{
    static const test_row row = {
        "walls",
        "squeezing of a sphere at a round wall of unordered triangles over "
        "that "
        "known",
        "posts and tunnels of 4 and 8 radii in triangles of 0.15 to 0.5 radii, "
        "gap 0.06 radii",
        "Reynolds' equation, S^3/(R1 + R2) of the reduced radii",
        "A",
        "20 %: in strips it is within 15 %, and planes of a part are less deep "
        "than it",
        0};
    const double radius = 1e-6, gap = 0.06e-6;
    ellipsoid_options o = near_walls();
    ellipsoid_model model;
    scattered floor = {.shape = {0, 0}, .length = 20e-6};
    made_walls flat;
    int planes;

    (void)unused;
    ellipsoid_set(o.semi_axes, radius, radius, radius);
    model = test_model(&o);
    flat = make(floor, 2e-6, 0);
    for (int n = 0; n < 8; n++)
    {
        const double size = (n & 4 ? 0.15 : 0.5) * radius;
        const scattered s = {
            .shape = {n & 1 ? 1 : -1, (n & 2 ? 4 : 8) * radius},
            .length = 14e-6};
        const double x[3] = {0, 0, radius + gap};
        const double bent =
            1 / (1 / radius - s.shape.sign / s.shape.radius) / radius;
        const double known = 2 * pow(bent, 1.5) / (bent + 1)
                           * squeezing(&model, &flat, x, &planes);
        made_walls m = make(s, size, 1e-2 * radius);
        const double ratio = squeezing(&model, &m, x, &planes) / known;

        print_message("%s of %g in %g: %.3f, %d planes\n",
                      s.shape.sign > 0 ? "tunnel" : "post", s.shape.radius,
                      size, ratio, planes);
        assert_row(&row, ratio, 1, 0.2);
        destroy(&m);
    }
    destroy(&flat);
}

/* A plane of which the points are rounded is one plane. */
static void test_rounded_plane(void **unused)
{
    const ellipsoid_options o = near_walls();
    const ellipsoid_model model = test_model(&o);
    const scattered even = {.length = 20e-6};
    scattered rounded = even;
    made_walls m[2];
    uint64_t seed = 5;

    (void)unused;
    rounded.noise = 1e-10;
    m[0] = make(even, 0.4e-6, 0);
    m[1] = make(rounded, 0.4e-6, 5e-9);
    for (int n = 0; n < 50; n++)
    {
        const double x[3] = {1e-6 * test_signed(&seed),
                             1e-6 * test_signed(&seed),
                             0.55e-6 + 2e-6 * test_uniform(&seed)};
        int planes[2];
        const double known = squeezing(&model, &m[0], x, &planes[0]);

        assert_near(squeezing(&model, &m[1], x, &planes[1]) / known, 1, 0.01);
        assert_int_equal(planes[0], 1);
        assert_int_equal(planes[1], 1);
    }
    destroy(&m[0]);
    destroy(&m[1]);
}

/* The plane that a facet is of: a point and the normal. */
static const double (*plane_of(const ellipsoid_facet *f))[3]
{
    return (const double(*)[3])((const char *)f + f->plane);
}

/* No point of a part of a round wall is farther from its plane than from that of
   one of its facets, and that mean of theirs. */
static void test_depth(void **unused)
{
    const double depth = 2e-8;
    const scattered s = {.shape = {1, 4e-6}, .length = 8e-6};
    made_walls m = make(s, 0.3e-6, depth);
    double deepest = 0;

    (void)unused;
    for (int f = 0; f < m.count; f++)
    {
        const double(*plane)[3] = plane_of(&m.facets[f]);

        for (int k = 0; k < 3; k++)
        {
            double d[3];

            ellipsoid_difference(m.facets[f].vertex[k], plane[0], d);
            deepest = fmax(deepest, fabs(ellipsoid_dot(d, plane[1])));
        }
    }
    print_message("%.2f depths off at most\n", deepest / depth);
    assert_true(deepest > 0.5 * depth && deepest < 1.2 * depth);
    destroy(&m);
}

/* The areas of a surface in a rim have the sum of the rim's, whatever is
   within: points that are off leave the plane of a rim as it is. */
static void bump(const double *uv, double point[3], void *context)
{
    const double *height = context;
    const double hill = 16 * uv[0] * (1 - uv[0]) * uv[1] * (1 - uv[1]);

    ellipsoid_set(point, 8e-6 * uv[0] * uv[0], 8e-6 * uv[1] * sqrt(uv[1]),
                  *height * hill * hashed(uv[0], uv[1]));
}

static void test_rim(void **unused)
{
    double height = 2e-9;
    made_walls m;
    wall_mesh mesh;

    (void)unused;
    wall_mesh_init(&mesh);
    wall_mesh_grid(&mesh, 10, 10, bump, &height, 2, 0);
    m = triangles_of(&mesh);
    m.options.same_point = 1e-12;
    m.options.flat_depth = 1e-7;
    assert_ok(create(&m));
    for (int f = 0; f < m.count; f++)
    {
        const double *normal = plane_of(&m.facets[f])[1];

        assert_near(fabs(normal[2]), 1, 1e-12);
        assert_true(hypot(normal[0], normal[1]) < 1e-9);
    }
    wall_mesh_free(&mesh);
    destroy(&m);
}

/* What is flat but for rounding is one part, and the two sides of a sheet are
   two, however thin it is. */
static void test_sides(void **unused)
{
    const double corner[3] = {1e-6, 2e-6, 3e-6};
    const double along[3] = {4.1e-6, 1.3e-6, 0.7e-6};
    const double across[3] = {-1.7e-6, 3.3e-6, 1.9e-6};
    const double tip[2][3] = {{0, 0, -1e-9}, {0, 0, 1e-9}};
    const double rim[4][3] = {
        {2e-6, 0, 0}, {0, 2e-6, 0}, {-2e-6, 0, 0}, {0, -2e-6, 0}};

    (void)unused;
    for (int sheet = 0; sheet < 2; sheet++)
    {
        made_walls m;
        wall_mesh mesh;

        wall_mesh_init(&mesh);
        if (sheet)
        {
            for (int k = 0; k < 8; k++)
            {
                const int next = (k + 1) % 4;

                wall_mesh_triangle(&mesh, tip[k < 4], rim[k < 4 ? k % 4 : next],
                                   rim[k < 4 ? next : k % 4], 0);
            }
        }
        else
        {
            wall_mesh_plane(&mesh, corner, along, across, 20, 17, 2, 0);
        }
        m = triangles_of(&mesh);
        m.options.same_point = 1e-12;
        m.options.flat_depth = sheet ? 5e-9 : 0;
        assert_ok(create(&m));
        for (int f = 0; f < m.count; f++)
        {
            const double(*plane)[3] = plane_of(&m.facets[f]);

            assert_true(ellipsoid_dot(plane[1], m.facets[f].normal) > 0.99);
            assert_true(sheet || plane == plane_of(&m.facets[0]));
        }
        wall_mesh_free(&mesh);
        destroy(&m);
    }
}

/* Where several sheets meet, the way across an edge may not lead back: those are
   no neighbours. */
static void test_ways_back(void **unused)
{
    static const int across[2][2][3] = {{{1, -1, -1}, {0, -1, -1}},
                                        {{1, -1, -1}, {-1, -1, -1}}};
    const double p[4][3] = {{0}, {1e-6, 0, 0}, {0, 1e-6, 0}, {1e-6, -1e-6, 0}};

    (void)unused;
    for (int n = 0; n < 2; n++)
    {
        double planes[2][2][3];
        int room[64];
        ellipsoid_arena scratch = {(char *)room, sizeof room};
        wall_mesh mesh;

        wall_mesh_init(&mesh);
        wall_mesh_triangle(&mesh, p[0], p[1], p[2], 0);
        wall_mesh_triangle(&mesh, p[1], p[0], p[3], 0);
        wall_mesh_finish(&mesh);
        assert_int_equal(ellipsoid_flat_parts_set(1e-9, across[n], 2, scratch,
                                                  mesh.facets, planes),
                         n == 0 ? 1 : 2);
        wall_mesh_free(&mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round), cmocka_unit_test(test_rounded_plane),
        cmocka_unit_test(test_depth), cmocka_unit_test(test_rim),
        cmocka_unit_test(test_sides), cmocka_unit_test(test_ways_back),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
