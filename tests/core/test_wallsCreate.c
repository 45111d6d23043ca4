/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    Walls made of triangles: the facets against those of wallMesh.c, which joins
    them by another method; images and search against what geometry says.
*/
#include "wallsTest.h"

static const double *star_of(const ellipsoid_facet *f, int k)
{
    return (const double *)((const char *)f + f->star[k]);
}

/* Is each direction of one star in the other? */
static void assert_same_star(const ellipsoid_facet *a, const ellipsoid_facet *b,
                             int k)
{
    assert_int_equal(a->star_count[k], b->star_count[k]);
    for (int i = 0; i < a->star_count[k]; i++)
    {
        int found = 0;

        for (int j = 0; j < b->star_count[k]; j++)
        {
            found += ellipsoid_dot(star_of(a, k) + 3 * i, star_of(b, k) + 3 * j)
                   > 1 - 1e-14;
        }
        assert_int_equal(found, 1);
    }
}

static void assert_same_facets(const made_walls *m, const wall_mesh *mesh)
{
    assert_int_equal(m->count, mesh->count);
    for (int f = 0; f < m->count; f++)
    {
        const ellipsoid_facet *a = &m->facets[f], *b = &mesh->facets[f];

        assert_memory_equal(a->vertex, b->vertex, sizeof a->vertex);
        assert_memory_equal(a->normal, b->normal, sizeof a->normal);
        assert_int_equal(a->surface, b->surface);
        for (int k = 0; k < 3; k++)
        {
            assert_int_equal(a->edge[k], b->edge[k]);
            for (int i = 0; i < 3; i++)
            {
                assert_near(a->edge_inward[k][i], b->edge_inward[k][i], 1e-14);
                assert_near(a->neighbour_normal[k][i],
                            b->neighbour_normal[k][i], 1e-14);
            }
            assert_same_star(a, b, k);
        }
    }
}

/* A box with a block in it, and a sheet across that meets the floor on both
   sides: convex, concave and flat edges, free rims, four facets at an edge */
static void add_scene(wall_mesh *mesh)
{
    const double low[3] = {0, 0, 0}, high[3] = {8, 6, 4};
    const double block_low[3] = {5, 2, 1}, block_high[3] = {6, 4, 2};
    const double corner[3] = {0, 3, 0}, u[3] = {3, 0, 0}, v[3] = {0, 0, 2};
    const double back[3] = {0, 3, 2}, down[3] = {0, 0, -2};

    wall_mesh_box(mesh, low, high, 1, 0, 1);
    wall_mesh_box(mesh, block_low, block_high, 0, 1, 2);
    wall_mesh_plane(mesh, corner, u, v, 3, 2, 0, 3);
    wall_mesh_plane(mesh, back, u, down, 3, 2, 0, 4);
}

static void test_joins_and_stars(void **state)
{
    wall_mesh mesh;
    made_walls m;
    int kinds[3] = {0};

    (void)state;
    wall_mesh_init(&mesh);
    add_scene(&mesh);
    wall_mesh_finish(&mesh);
    m = triangles_of(&mesh);
    assert_ok(create(&m));
    assert_same_facets(&m, &mesh);
    for (int f = 0; f < m.count; f++)
    {
        for (int k = 0; k < 3; k++)
        {
            kinds[m.facets[f].edge[k]]++;
        }
    }
    assert_true(kinds[0] > 0 && kinds[1] > 0 && kinds[2] > 0);
    destroy(&m);
    wall_mesh_free(&mesh);
}

/* What is copied elsewhere answers alike when what it was made in is gone */
/* Corners that are off by rounding are one, as of an STL in single precision */
static void test_corners_off(void **state)
{
    uint64_t seed = 5;
    wall_mesh mesh;
    made_walls m;

    (void)state;
    wall_mesh_init(&mesh);
    add_scene(&mesh);
    wall_mesh_finish(&mesh);
    m = triangles_of(&mesh);
    for (int p = 0; p < m.triangles.point_count; p++)
    {
        for (int i = 0; i < 3; i++)
        {
            m.point[p][i] += 0.2 * m.options.same_point * test_signed(&seed);
        }
    }
    assert_ok(create(&m));
    assert_int_equal(m.count, mesh.count);
    for (int f = 0; f < m.count; f++)
    {
        assert_memory_equal(m.facets[f].edge, mesh.facets[f].edge,
                            sizeof m.facets[f].edge);
    }
    destroy(&m);
    wall_mesh_free(&mesh);
}

static void test_is_position_independent(void **state)
{
    wall_mesh mesh;
    made_walls m;
    size_t bytes;
    void *copy;

    (void)state;
    wall_mesh_init(&mesh);
    add_scene(&mesh);
    wall_mesh_finish(&mesh);
    m = triangles_of(&mesh);
    assert_ok(create(&m));
    bytes = ellipsoid_walls_bytes(m.walls);
    copy = malloc(bytes);
    memcpy(copy, m.walls, bytes);
    memset(m.memory, 0xff, bytes);
    free(m.memory);
    m.memory = copy;
    m.walls = copy;
    m.facets = ellipsoid_walls_facets(m.walls, &m.count);
    assert_same_facets(&m, &mesh);
    destroy(&m);
    wall_mesh_free(&mesh);
}

/* Adds what is seen in a mirror at x = 0, in a box that holds all of it. */
static void reflect(made_walls *m)
{
    static const ellipsoid_isometry image[2] = {{.b = {0}},
                                                {.A = {{-2, 0, 0}}}};
    static const ellipsoid_symmetry_plane plane = {{0, 0, 0}, {-1, 0, 0}};

    m->options.image_count = 2;
    m->options.image = image;
    m->options.plane_count = 1;
    m->options.plane = &plane;
    ellipsoid_set(m->options.low, -10, -10, -10);
    ellipsoid_set(m->options.high, 10, 10, 10);
}

/* A floor from x1 = 0 to 4, and what is mirrored in x1 = 0: it goes on flat
   there. The wall in that plane is no image of itself. */
static void test_images_of_a_plane(void **state)
{
    const double origin[3] = {0, 0, 0}, u[3] = {4, 0, 0}, v[3] = {0, 3, 0};
    wall_mesh mesh;
    made_walls m;
    int free_edges = 0, at_plane = 0;

    (void)state;
    wall_mesh_init(&mesh);
    wall_mesh_plane(&mesh, origin, u, v, 4, 3, 0, 5);
    m = triangles_of(&mesh);
    reflect(&m);
    assert_ok(create(&m));
    assert_int_equal(m.count, 48);
    for (int f = 0; f < m.count; f++)
    {
        assert_near(m.facets[f].normal[2], 1, 1e-15);
        for (int k = 0; k < 3; k++)
        {
            const double *a = m.facets[f].vertex[k];
            const double *b = m.facets[f].vertex[(k + 1) % 3];

            free_edges += ellipsoid_facet_ends_at_edge(&m.facets[f], k);
            at_plane += a[0] == 0 && b[0] == 0
                     && m.facets[f].edge[k] == ELLIPSOID_EDGE_FLAT;
        }
    }
    /* the rim of 8 x 3, of edges of length 1; three edges, seen from both */
    assert_int_equal(free_edges, 22);
    assert_int_equal(at_plane, 6);

    /* the far half of the image is beside the box */
    m.options.low[0] = -1.5;
    assert_ok(create(&m));
    assert_int_equal(m.count, 36);

    m.options.longest_edge = 20;
    assert_ok(create(&m));
    assert_int_equal(m.count, 2);
    assert_near(area_of(&m, 5), 18, 1e-12);
    destroy(&m);
    wall_mesh_free(&mesh);
}

/* The back of a triangle that lies in a plane of symmetry is left out, and
   what is a part of it is marked, joined to no wall */
static void test_planes_of_symmetry(void **state)
{
    const double low[3] = {0, 0, 0}, high[3] = {1, 1, 1};
    double point[8][3];
    int corner[12][3], mirror[12] = {1, 1}, marked = 0;
    made_walls m = {.which = -1};

    (void)state;
    ellipsoid_box(low, high, point, corner);
    m.triangles = (ellipsoid_triangles){.point_count = 8,
                                        .point = (const double(*)[3])point,
                                        .count = 12,
                                        .corner = (const int(*)[3])corner,
                                        .mirror = mirror};
    reflect(&m);
    assert_ok(create(&m));
    assert_int_equal(m.count, 22);
    for (int f = 0; f < m.count; f++)
    {
        marked += m.facets[f].mirror;
        assert_int_equal(m.facets[f].mirror, f >= 20);
        assert_true(!m.facets[f].mirror || m.facets[f].normal[0] == 1);
        for (int k = 0; k < 3; k++)
        {
            assert_int_not_equal(m.facets[f].edge[k],
                                 m.facets[f].mirror ? ELLIPSOID_EDGE_CONCAVE
                                                    : ELLIPSOID_EDGE_CONVEX);
        }
    }
    assert_int_equal(marked, 2);
    free(m.memory);
}

/* Those whose box is near, and no others but for rounding */
static void test_search(void **state)
{
    const double low[3] = {-4, -3, -2}, high[3] = {4, 3, 2};
    const double rounding = 1e-5 * (high[0] - low[0]);
    const long samples = test_count(200, 5000, 50000);
    uint64_t seed = 5;
    wall_mesh mesh;
    made_walls m;
    int *index, most = 0;
    double narrow[3];

    (void)state;
    wall_mesh_init(&mesh);
    wall_mesh_box(&mesh, low, high, 1, 0, 0);
    for (int side = 0; side < 40; side++)
    {
        const double a = -4 + 0.2 * side, b = a + 0.2;
        const double c[3] = {a, -3, -2}, d[3] = {b, -3, -2}, e[3] = {a, 3, -2};

        wall_mesh_triangle(&mesh, c, d, e, 0);
    }
    m = triangles_of(&mesh);
    assert_ok(create(&m));
    index = malloc(m.count * sizeof *index);
    for (long n = 0; n < samples; n++)
    {
        const double reach = 0.01 + 2 * test_uniform(&seed) * (n % 2);
        ellipsoid_facet_list list;
        double x[3];
        int found = 0;

        for (int i = 0; i < 3; i++)
        {
            x[i] = high[i] * test_signed(&seed);
        }
        ellipsoid_walls_search(m.walls, x, reach, 1.5, m.count, index, &list);
        assert_true(list.facets == m.facets);
        for (int f = 0; f < m.count; f++)
        {
            double square = 0;

            for (int i = 0; i < 3; i++)
            {
                const double a = m.facets[f].vertex[0][i];
                const double b = m.facets[f].vertex[1][i];
                const double c = m.facets[f].vertex[2][i];
                const double below = fmin(a, fmin(b, c)) - x[i];
                const double above = x[i] - fmax(a, fmax(b, c));

                square += pow(fmax(0, fmax(below, above)), 2);
            }
            const int listed = found < list.count && list.index[found] == f;

            assert_true(listed || square >= reach * reach);
            assert_true(!listed || square < pow(reach + rounding, 2));
            found += listed;
        }
        assert_int_equal(found, list.count);
        most = found > most ? found : most;

        /* as much room as they need, and less */
        memset(index, 0xff, m.count * sizeof *index);
        assert_int_equal(
            ellipsoid_walls_search(m.walls, x, reach, 1.5, found, index, &list),
            found);
        assert_true(found == 0 || index[0] >= 0);
        for (int i = 1; i < found; i++)
        {
            assert_true(index[i - 1] < index[i]);
        }
        assert_int_equal(index[found < m.count ? found : 0] == -1,
                         found < m.count);
        assert_int_equal(ellipsoid_walls_search(m.walls, x, reach, 1.5,
                                                found / 2, index, &list),
                         found);
        assert_true(list.reach >= reach);
    }
    assert_true(most > 20);
    ellipsoid_set(narrow, 3.9, 0, 0);
    ellipsoid_walls_context little = {m.walls, 1, index};
    ellipsoid_facet_list list;
    assert_int_equal(ellipsoid_walls_list(&little, 0, narrow, 1, &list), -1);
    little.room = m.count;
    assert_int_equal(ellipsoid_walls_list(&little, 0, narrow, 1, &list), 0);
    free(index);
    destroy(&m);
    wall_mesh_free(&mesh);
}

/* The nearest facet of a fine grid, far from all of them */
static void test_nearest_of_many(void **state)
{
    const double origin[3] = {-2, -2, 0}, u[3] = {4, 0, 0}, v[3] = {0, 4, 0};
    uint64_t seed = 11;
    wall_mesh mesh;
    made_walls m;
    int index[1];

    (void)state;
    wall_mesh_init(&mesh);
    wall_mesh_plane(&mesh, origin, u, v, 40, 40, 2, 0);
    m = triangles_of(&mesh);
    assert_ok(create(&m));
    for (int n = 0; n < 1000; n++)
    {
        ellipsoid_facet_list list;
        const double x[3] = {4 * test_signed(&seed), 4 * test_signed(&seed),
                             0.2 + test_uniform(&seed)};
        const double over[3] = {fmax(fabs(x[0]) - 2, 0),
                                fmax(fabs(x[1]) - 2, 0), x[2]};

        ellipsoid_walls_search(m.walls, x, 0.05, 100, 1, index, &list);
        assert_int_equal(list.count, 0);
        assert_near(list.reach, ellipsoid_length(over), 1e-12);
    }
    destroy(&m);
    wall_mesh_free(&mesh);
}

static void test_refuses(void **state)
{
    const double low[3] = {0, 0, 0}, high[3] = {1, 1, 1};
    double point[8][3];
    int corner[12][3];
    made_walls m = {.which = -1};
    size_t size;

    (void)state;
    ellipsoid_box(low, high, point, corner);
    m.triangles = (ellipsoid_triangles){.point_count = 8,
                                        .point = (const double(*)[3])point,
                                        .count = 12,
                                        .corner = (const int(*)[3])corner};
    assert_ok(create(&m));
    assert_int_equal(m.count, 12);
    for (int f = 0; f < 12; f++)
    {
        const double middle[3] = {0.5, 0.5, 0.5};
        double in[3];

        ellipsoid_difference(middle, m.facets[f].vertex[0], in);
        assert_near(ellipsoid_dot(in, m.facets[f].normal), 0.5, 1e-15);
    }
    size = ellipsoid_walls_size(&m.triangles, &m.options);
    assert_int_equal(ellipsoid_walls_create(m.memory, size - 1, &m.triangles,
                                            &m.options, &m.walls, NULL),
                     ELLIPSOID_BAD_ARGUMENT);
    assert_int_equal(ellipsoid_walls_create(NULL, size, &m.triangles,
                                            &m.options, &m.walls, NULL),
                     ELLIPSOID_BAD_ARGUMENT);
    assert_int_equal(ellipsoid_walls_size(NULL, &m.options), 0);
    corner[7][1] = 8;
    assert_int_equal(create(&m), ELLIPSOID_BAD_TRIANGLE);
    assert_int_equal(m.which, 7);
    corner[7][1] = corner[7][0];
    assert_int_equal(create(&m), ELLIPSOID_BAD_TRIANGLE);
    assert_int_equal(m.which, 7);

    /* no walls at all */
    m.triangles = (ellipsoid_triangles){.count = 0};
    assert_ok(create(&m));
    assert_int_equal(m.count, 0);
    free(m.memory);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_joins_and_stars),
        cmocka_unit_test(test_corners_off),
        cmocka_unit_test(test_is_position_independent),
        cmocka_unit_test(test_images_of_a_plane),
        cmocka_unit_test(test_planes_of_symmetry),
        cmocka_unit_test(test_search),
        cmocka_unit_test(test_nearest_of_many),
        cmocka_unit_test(test_refuses),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
