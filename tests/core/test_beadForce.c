/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_beadForce.c - the force of walls on one bead: its derivatives and its energy.
*/
#include "beadContactTest.h"

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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_derivative_is_exact),
        cmocka_unit_test(test_energy_is_kept),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
