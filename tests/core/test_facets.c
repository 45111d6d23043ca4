/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_facets.c - facets that meet at an edge, two or many, and walls cut into
    facets of any size: the force on a bead is that of the wall, by plane
    geometry and Hertz's law f = d^1.5.

    Lengths are in bead radii and stiffness is 1: the force is homogeneous in
    both.
    Processor time: 5
*/
#include "beadContactTest.h"

/* Deepest overlap of the samples, and 1e-12 of the force there */
static const double deep = 0.1;
#define EXACT (1e-12 * 0.03)

static void assert_force(const wall_mesh *wall, const double x[3],
                         const double expected[3], double tolerance)
{
    double force[3];

    touch(wall, x, force);
    assert_near(distance(force, expected), 0, tolerance);
}

/* ------------------------------------------------------------- joining */

/* A sheet from the y axis outwards at an angle from x, its front turned to
   larger angles, or its back. */
static void add_side(wall_mesh *mesh, double angle, int front)
{
    const double start[3] = {0, -5, 0}, y[3] = {0, 10, 0};
    const double out[3] = {5 * cos(angle), 0, 5 * sin(angle)};

    wall_mesh_plane(mesh, start, front ? out : y, front ? y : out, 1, 1, front,
                    0);
}

/* Sheets at random angles about one edge, the second close to the first's
   plane so that the order matters, and each sector between two of them alone */
static void test_sheets_about_an_edge(void **unused)
{
    uint64_t seed = 21;
    int touched = 0;

    (void)unused;
    for (int n = 0; n < 400; n++)
    {
        const int sheets = 1 + n % 4;
        double angle[5];
        wall_mesh all;

        angle[0] = 2 * test_pi * test_uniform(&seed);
        for (int s = 1; s <= sheets; s++)
        {
            const double left = angle[0] + 2 * test_pi - angle[s - 1];

            angle[s] =
                s == sheets
                    ? angle[0] + 2 * test_pi
                    : angle[s - 1] + left * (0.2 + 0.4 * test_uniform(&seed));
        }
        wall_mesh_init(&all);
        for (int s = 0; s < 2 * sheets; s++)
        {
            const int k = n % 3 ? s : 2 * sheets - 1 - s; /* in any order */

            add_side(&all, angle[k / 2], k % 2);
        }
        wall_mesh_finish(&all);
        for (int s = 0; s < sheets; s++)
        {
            wall_mesh sector;

            wall_mesh_init(&sector);
            add_side(&sector, angle[s], 1);
            add_side(&sector, angle[s + 1], 0);
            wall_mesh_finish(&sector);
            for (int p = 0; p < 20; p++)
            {
                const double between = angle[s + 1] - angle[s];
                const double a =
                    angle[s] + between * (0.05 + 0.9 * test_uniform(&seed));
                const double nearest =
                    fmin(1, sin(fmin(test_pi / 2,
                                     fmin(a - angle[s], angle[s + 1] - a))));
                const double far = (1 - deep * test_signed(&seed)) / nearest;
                const double x[3] = {far * cos(a), test_signed(&seed),
                                     far * sin(a)};
                double force[3];

                if (far < 4)
                {
                    touched += touch(&sector, x, force) > 0;
                    assert_force(&all, x, force, EXACT);
                }
            }
            wall_mesh_free(&sector);
        }
        wall_mesh_free(&all);
    }
    assert_true(touched > 5000);
}

/* Where a wall ends it pushes all round, from its front to its back, off its
   edge and off its corner. */
static void test_free_rim(void **unused)
{
    uint64_t seed = 24;

    (void)unused;
    for (int kind = 0; kind < 6; kind++)
    {
        wall_mesh wall = floor_of(3, kind < 3 ? 1 : 12, kind % 3);

        for (int n = 0; n < 4000; n++)
        {
            const double out = test_uniform(&seed), up = test_signed(&seed);
            double way[3] = {out, n % 2 ? 0 : test_uniform(&seed), up};
            const double length = ellipsoid_length(way);
            const double far = 1 - deep * test_signed(&seed);
            const double f = pow(fmax(0, 1 - far), 1.5);
            double x[3], expected[3];

            for (int i = 0; i < 3; i++)
            {
                way[i] /= length;
                x[i] = (i < 2 ? 3 : 0) + far * way[i];
                expected[i] = f * way[i];
            }
            if (n % 2) /* along the edge, some over seams of the finer one */
            {
                x[1] = 2 * test_signed(&seed);
                x[1] = n % 5 == 0 ? 0.5 * round(2 * x[1]) : x[1];
            }
            assert_force(&wall, x, expected, EXACT);
        }
        wall_mesh_free(&wall);
    }
}

/* A baffle without thickness that stands on the floor x3 = 0 in the plane
   x1 = 0, up to a height of 3 */
static wall_mesh baffle_on_floor(int cells, int diagonal)
{
    const double corner[3] = {0, -3, 0}, left[3] = {-6, -3, 0};
    const double x[3] = {6, 0, 0}, y[3] = {0, 6, 0}, z[3] = {0, 0, 3};
    wall_mesh mesh;

    wall_mesh_init(&mesh);
    wall_mesh_plane(&mesh, left, x, y, cells, cells, diagonal, 0);
    wall_mesh_plane(&mesh, corner, x, y, cells, cells, diagonal, 0);
    wall_mesh_plane(&mesh, corner, y, z, cells, cells, diagonal, 1);
    wall_mesh_plane(&mesh, corner, z, y, cells, cells, 2 - diagonal, 2);
    wall_mesh_finish(&mesh);
    return mesh;
}

/* Each side pushes its own way, the foot both ways, the rim outwards. */
static void test_baffle_on_floor(void **unused)
{
    uint64_t seed = 22;

    (void)unused;
    for (int diagonal = 0; diagonal < 3; diagonal++)
    {
        wall_mesh walls[2] = {baffle_on_floor(1, diagonal),
                              baffle_on_floor(12, diagonal)};

        for (int n = 0; n < 6000; n++)
        {
            const double side = n % 2 ? 1 : -1;
            double x[3] = {side * (1 - deep * test_signed(&seed)),
                           1.5 * test_signed(&seed),
                           0.9 + 2 * test_uniform(&seed)};
            double expected[3] = {0, 0, 0};

            if (n % 3 == 0) /* about the rim */
            {
                const double a = test_pi * test_uniform(&seed);
                const double far = 1 - deep * test_signed(&seed);

                ellipsoid_set(x, far * cos(a), 1.5 * test_signed(&seed),
                              3 + far * sin(a));
                if (far < 1)
                {
                    expected[0] = pow(1 - far, 1.5) * cos(a);
                    expected[2] = pow(1 - far, 1.5) * sin(a);
                }
            }
            else
            {
                expected[0] = side * pow(fmax(0, 1 - fabs(x[0])), 1.5);
                expected[2] = pow(fmax(0, 1 - x[2]), 1.5);
            }
            if (n % 5 == 0) /* over the seams of the finer one */
            {
                x[1] = 0.5 * round(2 * x[1]);
            }
            for (int w = 0; w < 2; w++)
            {
                /* cos and sin round, relative to far */
                assert_force(&walls[w], x, expected, EXACT);
            }
        }
        wall_mesh_free(&walls[0]);
        wall_mesh_free(&walls[1]);
    }
}

/* -------------------------------------------------------------- cutting */

/* Where faces are cut along one axis, ascending, 0 among them */
typedef struct cuts
{
    int count;
    double at[600];
} cuts;

static void on_cuts(const double *uv, double point[3], void *context)
{
    const cuts *const *lists = context;
    const cuts *u = lists[0], *v = lists[1];
    const int axis = (int)(lists[2] - lists[3]);
    const long i = lround(uv[0] * (u->count - 1));
    const long j = lround(uv[1] * (v->count - 1));

    point[axis] = 0;
    point[(axis + 1) % 3] = u->at[i];
    point[(axis + 2) % 3] = v->at[j];
}

static void turned(double rotation[3][3], const double v[3], double result[3])
{
    double copy[3];

    ellipsoid_copy(v, copy);
    for (int i = 0; i < 3; i++)
    {
        result[i] = ellipsoid_dot(rotation[i], copy) + 0.0; /* no -0 */
    }
}

/*
    The planes x_i = 0 of the first `faces` axes, from each other on: a plane,
    an edge or a corner; turned. fluid: 1, it is where x_i > 0, concave; -1,
    convex.
*/
static wall_mesh wall_of(int faces, int fluid, const cuts list[3], int diagonal,
                         double rotation[3][3])
{
    wall_mesh mesh;

    wall_mesh_init(&mesh);
    for (int axis = 0; axis < faces; axis++)
    {
        const cuts *u = &list[(axis + 1) % 3], *v = &list[(axis + 2) % 3];
        const cuts *lists[4] = {u, v, list + axis, list};

        wall_mesh_grid(&mesh, u->count - 1, v->count - 1, on_cuts, lists,
                       diagonal, axis);
    }
    for (int f = 0; f < mesh.count; f++)
    {
        double(*vertex)[3] = mesh.facets[f].vertex, last[3];

        for (int k = 0; k < 3; k++)
        {
            turned(rotation, vertex[k], vertex[k]);
        }
        if (fluid < 0)
        {
            ellipsoid_copy(vertex[2], last);
            ellipsoid_copy(vertex[1], vertex[2]);
            ellipsoid_copy(last, vertex[1]);
        }
    }
    wall_mesh_finish(&mesh);
    return mesh;
}

/* From 0 to size, in steps up to 1.3 and from there at once; or, whole, from
   -size, in steps within 0.5 */
static cuts cuts_of(int whole, double size, double step)
{
    const long n = step > 0 ? lround((whole ? 0.5 : 1.3) / step) : 0;
    cuts list = {.count = 0};

    if (whole)
    {
        list.at[list.count++] = -size;
    }
    for (long i = whole ? -n : 0; i <= n; i++)
    {
        list.at[list.count++] = i * step;
    }
    list.at[list.count++] = size;
    return list;
}

static void wall_force(int faces, int fluid, const double x[3], double force[3])
{
    double away[3] = {0, 0, 0};

    for (int i = 0; i < 3; i++)
    {
        force[i] = 0;
        if (i < faces && fluid > 0)
        {
            force[i] = pow(fmax(0, 1 - x[i]), 1.5);
        }
        else if (i < faces)
        {
            away[i] = fmin(x[i], 0);
        }
    }

    const double far = sqrt(ellipsoid_dot(away, away));

    for (int i = 0; i < 3 && fluid < 0 && far < 1; i++)
    {
        force[i] = pow(1 - far, 1.5) * away[i] / far;
    }
}

/* Where a bead overlaps the wall by `deep` at most, over seams now and then */
static void place(int faces, int fluid, uint64_t *seed, double x[3])
{
    const int facing = (int)(faces * test_uniform(seed));
    const double far = 1 - deep * test_uniform(seed);
    double away[3] = {0, 0, 0}, size;

    for (int i = 0; i < faces; i++)
    {
        away[i] = i == facing || test_uniform(seed) < 0.6
                    ? 0.01 + test_uniform(seed)
                    : 0;
    }
    size = sqrt(ellipsoid_dot(away, away));
    for (int i = 0; i < 3; i++)
    {
        x[i] = i >= faces  ? 0.2 * test_signed(seed)
             : fluid > 0   ? 1 - deep * test_signed(seed)
             : away[i] > 0 ? -far * away[i] / size
                           : 0.3 * test_uniform(seed);
        if (test_uniform(seed) < 0.3 && away[i] < size)
        {
            x[i] = 0.01 * round(100 * x[i]);
        }
    }
}

/*
    A plane, convex and concave edges and corners, of facets of 0.01 bead radii,
    of slivers a thousand times longer than wide, of two facets a face, of one
    metre about a bead of 0.285 um, and of some of all, by three diagonals: the
    same force, to 1e-12. The walls are turned anyhow but for those of one
    metre, whose corners are known to 1e-16 m: 4e-10 bead radii.
*/
static void test_however_cut(void **unused)
{
    const double metre = 1 / 0.285e-6;
    const struct
    {
        double size, step[3];
    } ways[] = {{1.31, {0.01, 0.01, 0.01}},
                {5, {0.005, 0, 0}},
                {5, {0, 0, 0}},
                {metre, {0, 0, 0}},
                {metre, {0.25, 0.05, 0.005}}};
    uint64_t seed = 23;

    (void)unused;
    for (int faces = 1; faces <= 3; faces++)
    {
        for (int way = 0; way < 5; way++)
        {
            for (int kind = 0; kind < 6; kind++)
            {
                const int diagonal = kind % 3;
                const int fluid = kind < 3 ? 1 : -1;
                const int small = way == 0;
                int touched = 0;
                double q[4] = {0, 0, 0, 1}, rotation[3][3];
                cuts list[3];
                wall_mesh wall;

                for (int i = 0; i < 3; i++)
                {
                    /* edges go on both ways, a plane all round */
                    list[i] =
                        cuts_of(i >= faces, ways[way].size, ways[way].step[i]);
                }
                if (ways[way].size < metre)
                {
                    test_orientation(&seed, q);
                }
                ellipsoid_rotation(q, rotation);
                wall = wall_of(faces, fluid, list, diagonal, rotation);
                for (int n = 0; n < (small ? 40 : 400); n++)
                {
                    double x[3], expected[3];

                    place(faces, fluid, &seed, x);
                    wall_force(faces, fluid, x, expected);
                    turned(rotation, x, x);
                    turned(rotation, expected, expected);
                    assert_force(&wall, x, expected, EXACT);
                    touched += ellipsoid_dot(expected, expected) > 0;
                }
                assert_true(touched > (small ? 10 : 100));
                wall_mesh_free(&wall);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sheets_about_an_edge),
        cmocka_unit_test(test_free_rim),
        cmocka_unit_test(test_baffle_on_floor),
        cmocka_unit_test(test_however_cut),
    };

    return cmocka_run_group_tests_name("facets", tests, NULL, NULL);
}
