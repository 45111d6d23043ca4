/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_manyWalls.c - more planes near a cell than count.
*/
#include "wallResistanceTest.h"

/* Large triangles of planes below a cell at x3, whose nearest edges no kernel sees
   though the spheres about them come near. */
static void add_beside(wall_mesh *mesh, double x3, double range)
{
    for (int n = 0; n < 12; n++)
    {
        const double turn = 2 * test_pi * n / 12, edge = 0.8 * range;
        const double along = 0.6 * sqrt(12) * range, away = 1.8 * range;
        const double c = cos(turn), s = sin(turn);
        const double height = x3 - (0.3 + 0.01 * n) * range;
        const double a[3] = {edge * c - along / 2 * s, edge * s + along / 2 * c,
                             height};
        const double b[3] = {edge * c + along / 2 * s, edge * s - along / 2 * c,
                             height};
        const double d[3] = {(edge + away) * c, (edge + away) * s, height};

        wall_mesh_triangle(mesh, b, d, a, 0);
    }
}

/* A floor of which a far facet comes first, and parts of a dome above a cell. */
static void add_crowd(wall_mesh *mesh, const double x[3], double range)
{
    const double size = 0.02 * range;

    for (int n = 0; n < 2; n++)
    {
        const double at = n == 0 ? 0.5 * range : 0;
        const double a[3] = {at - size, -size, 0}, b[3] = {at + size, -size, 0},
                     c[3] = {at, 2 * size, 0};

        wall_mesh_triangle(mesh, a, b, c, 0);
    }
    for (int n = 0; n < 60; n++)
    {
        /* seen from their middles, the normal leads to the cell */
        const double turn = 2 * test_pi * n / 60, tilt = 0.2 + 0.01 * n;
        const double inward[3] = {-sin(tilt) * cos(turn),
                                  -sin(tilt) * sin(turn), -cos(tilt)};
        const double u[3] = {-sin(turn), cos(turn), 0};
        const double away = (0.4 + 0.001 * n) * range;
        double v[3], corner[3][3];

        ellipsoid_cross(inward, u, v);
        for (int i = 0; i < 3; i++)
        {
            const double middle = x[i] - away * inward[i];

            corner[0][i] = middle - size * u[i] - size * v[i];
            corner[1][i] = middle + size * u[i] - size * v[i];
            corner[2][i] = middle + 2 * size * v[i];
        }
        wall_mesh_triangle(mesh, corner[0], corner[1], corner[2], 0);
    }
}

/* Planes are 48 at most, those of the nearest facets. A facet that is not seen
   takes nobody's place. */
static void test_too_many(void **unused)
{
    const ellipsoid_options o = near_walls();
    const ellipsoid_model model = test_model(&o);
    const ellipsoid_state state = {.x = {0, 0, 0.2 * o.wall_range},
                                   .q = {0, 0, 0, 1}};
    ellipsoid_planes planes[2];
    int floors = 0;

    (void)unused;
    for (int beside = 0; beside < 2; beside++)
    {
        wall_mesh mesh;

        wall_mesh_init(&mesh);
        add_crowd(&mesh, state.x, o.wall_range);
        if (beside)
        {
            add_beside(&mesh, state.x[2], o.wall_range);
        }
        wall_mesh_finish(&mesh);
        planes[beside] = planes_at(&model, &mesh, &state);
        assert_int_equal(planes[beside].count, ELLIPSOID_MAX_PLANES);
        wall_mesh_free(&mesh);
    }
    for (int k = 0; k < ELLIPSOID_MAX_PLANES; k++)
    {
        const double *normal = planes[0].at[k].effect.normal;

        floors += normal[2] > 1 - 1e-12;
        assert_memory_equal(planes[1].at[k].effect.normal, normal,
                            3 * sizeof(*normal));
    }
    assert_int_equal(floors, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_too_many),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
