/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_ellipsoidEdges.c - edges, corners and rims against the ellipsoid itself, by
    trial.
*/
#include "exactContactTest.h"
#include "contact/contact.h"

/* n.d - h(n) for n along v, which becomes of length one */
static double tried_direction(const ellipsoid_surface *body, const double d[3],
                              double v[3])
{
    const double length = sqrt(ellipsoid_dot(v, v));
    double squared = 0;

    for (int i = 0; i < 3; i++)
    {
        v[i] /= length;
    }
    for (int k = 0; k < 3; k++)
    {
        double along = 0;

        for (int l = 0; l < 3; l++)
        {
            along += body->rotation[l][k] * v[l];
        }
        squared += pow(body->axes[k] * along, 2);
    }
    return ellipsoid_dot(v, d) - sqrt(squared);
}

/* Signed distance of a point from the ellipsoid by trial: the best direction of
   a coarse lattice, then ever smaller changes of it. */
static double tried_distance(const ellipsoid_surface *body, const double w[3],
                             double n[3])
{
    double d[3], best = -HUGE_VAL, size = 0.3;

    ellipsoid_difference(body->centre, w, d);
    for (int lattice = 1; size > 1e-9; lattice = 0)
    {
        const double before = best;
        const int side = lattice ? 5 : 1;
        double middle[3] = {0, 0, 0};

        if (!lattice)
        {
            ellipsoid_copy(n, middle);
        }
        for (int i = -side; i <= side; i++)
        {
            for (int j = -side; j <= side; j++)
            {
                for (int k = -side; k <= side; k++)
                {
                    double v[3] = {middle[0] + size * i, middle[1] + size * j,
                                   middle[2] + size * k};

                    if (i == 0 && j == 0 && k == 0)
                    {
                        continue;
                    }

                    const double value = tried_direction(body, d, v);

                    if (value > best)
                    {
                        best = value;
                        ellipsoid_copy(v, n);
                    }
                }
            }
        }
        size *= best > before && !lattice ? 1 : 0.5;
    }
    return best;
}

/* The lowest tried distance of a stretch of an edge: it is convex. */
static double tried_edge(const ellipsoid_surface *body, const double from[3],
                         const double to[3], double n[3])
{
    double low = 0, high = 1, d = 0;

    while (high - low > 1e-7)
    {
        double tried[2];

        for (int side = 0; side < 2; side++)
        {
            const double t = low + (high - low) * (side ? 0.618 : 0.382);
            double w[3];

            for (int i = 0; i < 3; i++)
            {
                w[i] = from[i] + t * (to[i] - from[i]);
            }
            tried[side] = d = tried_distance(body, w, n);
        }
        *(tried[0] < tried[1] ? &high : &low) =
            low + (high - low) * (tried[0] < tried[1] ? 0.618 : 0.382);
    }
    return d;
}

/* Of a block in the middle of the fluid, an edge and a corner. */
static void test_edge_and_corner_by_trial(void **unused)
{
    const double low[3] = {-9, -9, -9}, zero[3] = {0, 0, 0};
    const double down[3] = {0, 0, -9};
    uint64_t seed = 6;
    int edges = 0, corners = 0;
    wall_mesh block;

    (void)unused;
    wall_mesh_init(&block);
    wall_mesh_box(&block, low, zero, 0, 0, 7);
    wall_mesh_finish(&block);
    for (int n = 0; n < 4000 && (edges < 40 || corners < 40); n++)
    {
        ellipsoid_options options =
            exact_options(0.2 + 0.5 * test_uniform(&seed), 1,
                          0.2 + 0.8 * test_uniform(&seed));
        double x[3], q[4], tried[3], d;
        ellipsoid_contact contact;
        ellipsoid_surface body;
        ellipsoid_surface_contact c;
        static ellipsoid_facet_cache cache;
        const ellipsoid_surroundings surroundings = inside(&block);
        double depth = 0;
        int kind = -1, alone = 1;

        options.bead_radius = 0.1;
        options.contact_modulus = 0.75 / sqrt(0.1);
        for (int i = 0; i < 3; i++)
        {
            x[i] = i == 2 && n % 2 ? -3 : 0.7 * test_uniform(&seed);
        }
        test_orientation(&seed, q);
        ellipsoid_surface_set(options.semi_axes, x, q, &body);
        for (int f = 0; f < block.count; f++)
        {
            if (ellipsoid_surface_nearest(&block.facets[f], &body, 0.1, &c))
            {
                alone = kind < 0 || (kind == c.feature && depth == c.height);
                kind = c.feature;
                depth = c.height;
            }
        }
        /* deeper than its radii of curvature there is more than one nearest */
        const double least = fmin(options.semi_axes[0], options.semi_axes[2]);

        if (!alone || fabs(depth) > 0.5 * least * least)
        {
            continue;
        }
        if (kind == ELLIPSOID_ON_EDGE && edges < 40 && n % 2)
        {
            d = tried_edge(&body, zero, down, tried);
            edges++;
        }
        else if (kind == ELLIPSOID_ON_VERTEX && corners < 40)
        {
            d = tried_distance(&body, zero, tried);
            corners++;
        }
        else
        {
            continue;
        }

        const ellipsoid_model model = test_model(&options);
        const double f = d < 0 ? pow(-d, 1.5) : 0;

        ellipsoid_facet_cache_clear(&cache);
        assert_ok(
            evaluate_pose(&model, &surroundings, x, q, &cache, &contact, NULL));
        assert_near(contact.gap, d, 1e-9);
        for (int i = 0; i < 3; i++)
        {
            assert_near(contact.force[i], f * tried[i], 1e-4 * f + 1e-12);
        }
    }
    assert_int_equal(edges, 40);
    assert_int_equal(corners, 40);
    wall_mesh_free(&block);
}

/* The gap is negative where the ellipsoid cuts a facet: overlap.c knows by
   another way. */
static void test_gap_agrees_with_overlap(void **unused)
{
    const ellipsoid_options options = exact_options(0.5 * um, 2 * um, 0.8 * um);
    const ellipsoid_model model = test_model(&options);
    wall_mesh mesh = room_of(1);
    const ellipsoid_surroundings surroundings = inside(&mesh);
    static ellipsoid_facet_cache cache;
    uint64_t seed = 7;
    int cut = 0;

    (void)unused;
    ellipsoid_facet_cache_clear(&cache);
    for (int n = 0; n < 20000; n++)
    {
        double x[3], q[4];
        ellipsoid_contact contact;
        int overlaps;

        random_pose(&seed, x, q);
        if (fabs(x[0] - 1 * um) < 0.5 * um && fabs(x[1]) < 4 * um
            && x[2] < 2 * um)
        {
            continue; /* within the ridge */
        }
        assert_ok(
            evaluate_pose(&model, &surroundings, x, q, &cache, &contact, NULL));
        assert_ok(
            ellipsoid_overlaps_walls(&model, &surroundings, x, q, &overlaps));
        assert_int_equal(contact.gap < 0, overlaps);
        cut += overlaps;
    }
    assert_true(cut > 5000 && cut < 15000);
    wall_mesh_free(&mesh);
}

/* What is nearest at edges and vertices of all facets, if anything is. */
static int nearest_rim(const wall_mesh *mesh, const ellipsoid_surface *body,
                       ellipsoid_surface_contact *nearest)
{
    *nearest = (ellipsoid_surface_contact){.height = um};
    for (int f = 0; f < mesh->count; f++)
    {
        ellipsoid_surface_contact c;

        if (ellipsoid_surface_nearest(&mesh->facets[f], body, um, &c)
            && c.feature != ELLIPSOID_ON_FACE && c.height < nearest->height)
        {
            *nearest = c;
        }
    }
    return nearest->height < um;
}

/* The rim of a wall that ends is met from front and back alike: as that of a
   baffle, which has two sides. No deeper than half of the width. */
static void test_free_rim_is_a_baffles(void **unused)
{
    const double corner[3] = {0}, x[3] = {4 * um, 0, 0}, y[3] = {0, 4 * um, 0};
    const ellipsoid_options o = exact_options(0.5 * um, 2 * um, 0.8 * um);
    wall_mesh sheet, baffle;
    uint64_t seed = 8;
    int edges = 0, vertices = 0, from_behind = 0;

    (void)unused;
    wall_mesh_init(&sheet);
    wall_mesh_init(&baffle);
    wall_mesh_plane(&sheet, corner, x, y, 2, 2, 2, 0);
    wall_mesh_plane(&baffle, corner, x, y, 2, 2, 2, 0);
    wall_mesh_plane(&baffle, corner, y, x, 2, 2, 2, 0);
    wall_mesh_finish(&sheet);
    wall_mesh_finish(&baffle);
    for (int n = 0; n < 20000; n++)
    {
        const double centre[3] = {(2 + 4 * test_signed(&seed)) * um,
                                  (2 + 4 * test_signed(&seed)) * um,
                                  2 * um * test_signed(&seed)};
        ellipsoid_surface body;
        ellipsoid_surface_contact expected, found;
        double q[4];
        int is_found;

        test_orientation(&seed, q);
        ellipsoid_surface_set(o.semi_axes, centre, q, &body);
        is_found = nearest_rim(&sheet, &body, &found);
        if (!nearest_rim(&baffle, &body, &expected))
        {
            assert_false(is_found);
            continue;
        }
        if (expected.height < -0.25 * um)
        {
            continue;
        }
        assert_true(is_found);
        assert_near(found.height, expected.height, 1e-12 * um);
        for (int i = 0; i < 3; i++)
        {
            assert_near(found.normal[i], expected.normal[i], 1e-9);
        }
        edges += found.feature == ELLIPSOID_ON_EDGE;
        vertices += found.feature == ELLIPSOID_ON_VERTEX;
        from_behind += found.normal[2] < 0;
    }
    assert_true(edges > 1000 && vertices > 500 && from_behind > 1000);
    wall_mesh_free(&sheet);
    wall_mesh_free(&baffle);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_edge_and_corner_by_trial),
        cmocka_unit_test(test_gap_agrees_with_overlap),
        cmocka_unit_test(test_free_rim_is_a_baffles),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
