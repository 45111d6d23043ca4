/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_seams.c - the wall's force on one bead does not jump as the bead slides
    over seams, edges, corners and steps, and flat seams add none.

    Lengths are in bead radii and stiffness is 1.
    Processor time: 3
*/
#include "beadContactTest.h"

/* Only what lies along a line, so that sampling it densely costs little. */
static wall_mesh near_line(wall_mesh *wall, const double from[3],
                           const double to[3])
{
    wall_mesh part = *wall;
    ellipsoid_facet_list list;
    double middle[3], half[3];

    for (int i = 0; i < 3; i++)
    {
        middle[i] = (from[i] + to[i]) / 2;
        half[i] = (to[i] - from[i]) / 2;
    }
    wall_mesh_list(wall, 0, middle, sqrt(ellipsoid_dot(half, half)) + 1.1 * r,
                   &list);
    part.index = wall->listed;
    part.count = list.count;
    return part;
}

/*
    The largest change of the force along a line, against what Hertz's law at
    the deepest overlap allows over one sample: 1.5 sqrt(d) a step.
*/
static double steepest(wall_mesh *wall, const double from[3],
                       const double to[3], int samples)
{
    const wall_mesh near = near_line(wall, from, to);
    double before[3], force[3], x[3], worst = 0, last = 0;
    const double step = distance(from, to) / samples;

    for (int s = 0; s <= samples; s++)
    {
        for (int i = 0; i < 3; i++)
        {
            x[i] = from[i] + (to[i] - from[i]) * s / samples;
        }
        touch(&near, x, force);

        const double size = sqrt(ellipsoid_dot(force, force));
        const double slope = 1.5 * cbrt(fmax(size, last) + 1e-9);

        if (s > 0)
        {
            worst = fmax(worst, distance(force, before) / (slope * step));
        }
        ellipsoid_copy(force, before);
        last = size;
    }
    return worst;
}

/* Past edges and corners of a box at overlaps of up to 5 % of the radius the
   force is as smooth as Hertz's law, up to its turn, d / (1.5 h). */
static void test_convex_edges_and_corners(void **unused)
{
    wall_mesh wall = box_of(2, 0, 1);
    uint64_t seed = 3;

    (void)unused;
    for (int n = 0; n < 400; n++)
    {
        /* the nearest point of the path, and a tangent to walk along */
        const double depth = 0.05 * test_uniform(&seed);
        const double corner[3] = {2, 2, n % 2 ? 2 : 0.5};
        double out[3], along[3], random[3], from[3], to[3];

        for (int i = 0; i < 3; i++)
        {
            out[i] = i == 2 && n % 2 == 0 ? 0 : test_uniform(&seed);
            random[i] = test_signed(&seed);
        }
        ellipsoid_cross(out, random, along);

        const double size = sqrt(ellipsoid_dot(out, out));
        const double length = sqrt(ellipsoid_dot(along, along));

        for (int i = 0; i < 3; i++)
        {
            const double middle = corner[i] + (1 - depth) * out[i] / size;

            from[i] = middle - 0.8 * along[i] / length;
            to[i] = middle + 0.8 * along[i] / length;
        }
        assert_true(steepest(&wall, from, to, 4000) < 1.05);
    }
    wall_mesh_free(&wall);
}

/* The seams of a flat wall add nothing. */
static void test_flat_seams(void **unused)
{
    wall_mesh wall = floor_of(4, 33, 2);
    const double from[3] = {-2, -1.7, 0.97}, to[3] = {2, 1.9, 0.97};

    (void)unused;
    assert_true(steepest(&wall, from, to, 20000) < 1e-8);
    wall_mesh_free(&wall);
}

typedef struct arc
{
    double radius, angle, height;
} arc;

static void on_arc(const double *uv, double point[3], void *context)
{
    const arc *a = context;
    const double angle = (uv[0] - 0.5) * a->angle;

    point[0] = a->radius * sin(angle);
    point[1] = a->height * uv[1];
    point[2] = a->radius - a->radius * cos(angle);
}

/*
    The chamber's round wall: 40 um radius, faces of 0.2 to 0.8 um, bead of
    0.285 um sliding 1 to 14 nm deep. Its polygon is what it is - between faces
    turned by t the normal turns by t, and a chord is flatter than the arc - but
    nothing else is added: with depth measured from the nearest face, the force
    keeps to Hertz within 1 % and turns no further than the faces do.
*/
static void test_round_wall(void **unused)
{
    const double um = 1 / 0.285; /* in bead radii */
    const double faces[] = {0.2, 0.4, 0.8}, depths[] = {0.001, 0.005, 0.014};

    (void)unused;
    for (int f = 0; f < 3; f++)
    {
        arc shape = {40 * um, 0.12, 4 * um};
        const int n = (int)lround(0.12 * 40 / faces[f]); /* even */
        const double turn = 0.12 / n;

        for (int d = 0; d < 3; d++)
        {
            wall_mesh wall;
            double worst = 0, before[3] = {0, 0, 0};
            double strongest = 0, steepest_tilt = 0;
            const int samples = 20000;

            wall_mesh_init(&wall);
            wall_mesh_grid(&wall, n, 5, on_arc, &shape, 2, 0);
            wall_mesh_finish(&wall);
            for (int s = 0; s <= samples; s++)
            {
                const double w = s / (double)samples - 0.5;
                const double angle = 0.06 * w;
                const double chord = shape.radius * cos(turn / 2);
                const double out = shape.radius - r + depths[d] * um;
                const double x[3] = {out * sin(angle), (2 + 0.7 * w) * um,
                                     shape.radius - out * cos(angle)};
                const double local = remainder(angle - turn / 2, turn);
                const double depth = out * cos(local) - chord + r;
                const double f0 = pow(depth, 1.5);
                double force[3];

                touch(&wall, x, force);

                const double size = sqrt(ellipsoid_dot(force, force));
                const double tilt = atan2(-force[0], force[2]) - angle;

                strongest = fmax(strongest, fabs(size / f0 - 1));
                steepest_tilt = fmax(steepest_tilt, fabs(tilt));
                assert_relative(size, f0, 0.01);
                assert_true(fabs(tilt) < 0.51 * turn);
                assert_near(force[1], 0, 1e-10 * f0);
                if (s > 0)
                {
                    worst = fmax(worst, distance(force, before));
                }
                ellipsoid_copy(force, before);
            }
            /* the turn at a seam takes a way of the order of turn radii: over
               one sample the force changes by no more than 0.5 % of itself */
            assert_true(worst < 0.005 * pow(depths[d] * um, 1.5));
            print_message("# faces of %g um, %g nm deep: force within %.2g of "
                          "Hertz, along the wall at most %.2g of it, %.3f of "
                          "half the turn\n",
                          faces[f], 1000 * depths[d], strongest,
                          sin(steepest_tilt), 2 * steepest_tilt / turn);
            wall_mesh_free(&wall);
        }
    }
}

/* A valley of any angle, crossed at overlaps of up to 5 % of the radius. */
static void test_valleys_are_continuous(void **unused)
{
    (void)unused;
    for (int k = 1; k < 15; k++)
    {
        const double lean = 0.05 * k;
        wall_mesh wall = wedge_of(lean, 4, 2);

        for (double depth = 0.002; depth < 0.05; depth *= 2)
        {
            const double z = (1 - depth) / cos(lean);
            const double from[3] = {-0.3, -0.2, z + 0.3 * tan(lean)};
            const double middle[3] = {0, 0.05, z};
            const double to[3] = {0.3, 0.3, z + 0.3 * tan(lean)};

            assert_true(steepest(&wall, from, middle, 5000) < 2);
            assert_true(steepest(&wall, middle, to, 5000) < 2);
        }
        wall_mesh_free(&wall);
    }
}

/* A step lower than the overlap, and one as high as the bead. */
static void test_steps_are_continuous(void **unused)
{
    const double heights[] = {1e-4, 1e-3, 1e-2, 0.1, 0.5, 1};

    (void)unused;
    for (int k = 0; k < 6; k++)
    {
        const double h = heights[k];
        const double low[3] = {0, -5, 0}, riser[3] = {0, -5, h};
        const double high[3] = {-5, -5, h};
        const double x[3] = {5, 0, 0}, y[3] = {0, 10, 0}, down[3] = {0, 0, -h};
        wall_mesh wall;

        wall_mesh_init(&wall);
        wall_mesh_plane(&wall, high, x, y, 6, 6, 0, 0);
        wall_mesh_plane(&wall, riser, down, y, 1, 6, 0, 0);
        wall_mesh_plane(&wall, low, x, y, 6, 6, 0, 0);
        wall_mesh_finish(&wall);
        for (double depth = 0.003; depth < 0.05; depth *= 2)
        {
            const double upper[3] = {-0.5, 0.1, h + 1 - depth};
            const double over[3] = {0.5, 0.2, h + 1 - depth};
            const double from[3] = {2, 0.3, 1 - depth};
            const double against[3] = {0.01, 0.31, 1 - depth};

            assert_true(steepest(&wall, upper, over, 10000) < 2);
            if (h >= 1 || h < 0.04)
            {
                assert_true(steepest(&wall, from, against, 10000) < 2);
            }
        }
        wall_mesh_free(&wall);
    }
}

/*
    Random ground of triangles the size of a bead, edges and corners of every
    kind. Where three gentle slopes meet, a local minimum can vanish over a
    facet that is none itself; nothing else makes the force jump, and not by
    more than 5 %.
*/
static void test_random_ground(void **unused)
{
    const ellipsoid_wall_laws laws = {.count = 1,
                                      .law = {ellipsoid_hertz_law(1)}};
    uint64_t seed = 4;

    (void)unused;
    for (int n = 0; n < 6; n++)
    {
        wall_mesh wall = terrain_of(n % 2 ? 0.3 : 0.05, &seed);
        int index[200], jumps = 0;

        for (long path = test_count(3, 20, 20); path > 0; path--)
        {
            const double start[3] = {12 + 16 * test_uniform(&seed),
                                     12 + 16 * test_uniform(&seed), 0};
            const double angle = 2 * test_pi * test_uniform(&seed);
            const double aim = -0.05 * test_uniform(&seed);
            const int samples = 5000;
            const double step = 3.0 / samples;
            double z = 3, before[3] = {0, 0, 0}, last = 0;
            ellipsoid_facet_list list;

            assert_int_equal(wall_mesh_list(&wall, 0, start, 5, &list), 0);
            list.count = list.count < 200 ? list.count : 200;
            memcpy(index, list.index, list.count * sizeof *index);
            for (int s = -20; s <= samples; s++)
            {
                const double way = s > 0 ? s * step : 0;
                const ellipsoid_bead bead = {
                    .centre = {start[0] + way * cos(angle),
                               start[1] + way * sin(angle), z},
                    .radius = r,
                    .laws = &laws};
                const ellipsoid_candidates from = {wall.facets, index,
                                                   list.count, NULL, 0};
                ellipsoid_bead_forces forces = {.repulsion = {.force = {0}}};
                const double *force = forces.repulsion.force;
                double gap = 4;

                ellipsoid_bead_contact(&bead, &from, &gap, 0, &forces, NULL);

                /* settles first, then follows the ground */
                const double rise = aim - gap;

                z += s < 0 ? rise : fmax(-step, fmin(step, rise));
                if (s > 0)
                {
                    const double depth = fmax(1e-4, fmax(-gap, -last));
                    const double change = distance(force, before);

                    jumps += change > 1.5 * sqrt(depth) * 4 * step;
                    assert_true(change < 0.05 * pow(depth, 1.5)
                                             + 1.5 * sqrt(depth) * 4 * step);
                }
                ellipsoid_copy(force, before);
                last = gap;
            }
        }
        assert_true(jumps <= 4); /* of 100000 samples */
        wall_mesh_free(&wall);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_convex_edges_and_corners),
        cmocka_unit_test(test_flat_seams),
        cmocka_unit_test(test_round_wall),
        cmocka_unit_test(test_valleys_are_continuous),
        cmocka_unit_test(test_steps_are_continuous),
        cmocka_unit_test(test_random_ground),
    };

    return cmocka_run_group_tests_name("seams", tests, NULL, NULL);
}
