/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    test_touch.c - the wall's force on one bead, against plane geometry and
    Hertz's law f = k d^1.5 (Johnson, Contact Mechanics (1985), eq. 4.23).

    Lengths are in bead radii and stiffness is 1 unless the test says otherwise:
    the force is homogeneous in both.
*/
#include "coreTest.h"
#include "wallMesh.h"

static const double r = 1;

static int touch(const wall_mesh *wall, const double x[3], double force[3])
{
    return ellipsoid_bead_force(x, r, 1, wall->facets, wall->index, wall->count,
                                force, NULL);
}

static void assert_force(const wall_mesh *wall, const double x[3], double f0,
                         double f1, double f2, double tolerance)
{
    double force[3];

    touch(wall, x, force);
    assert_near(force[0], f0, tolerance);
    assert_near(force[1], f1, tolerance);
    assert_near(force[2], f2, tolerance);
}

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
    wall_mesh_list(wall, middle, sqrt(ellipsoid_dot(half, half)) + 1.1 * r,
                   &list);
    part.index = wall->listed;
    part.count = list.count;
    return part;
}

static double distance(const double a[3], const double b[3])
{
    double d[3];

    ellipsoid_difference(a, b, d);
    return sqrt(ellipsoid_dot(d, d));
}

/* The floor z = 0, |x|, |y| <= size. */
static wall_mesh floor_of(double size, int cells, int diagonal)
{
    const double corner[3] = {-size, -size, 0};
    const double u[3] = {2 * size, 0, 0}, v[3] = {0, 2 * size, 0};
    wall_mesh wall;

    wall_mesh_init(&wall);
    wall_mesh_plane(&wall, corner, u, v, cells, cells, diagonal, 0);
    wall_mesh_finish(&wall);
    return wall;
}

static wall_mesh box_of(double size, int inwards, int diagonal)
{
    const double low[3] = {-size, -size, -size}, high[3] = {size, size, size};
    wall_mesh wall;

    wall_mesh_init(&wall);
    wall_mesh_box(&wall, low, high, inwards, diagonal, 0);
    wall_mesh_finish(&wall);
    return wall;
}

/* Two planes that meet in the line x = z = 0; their normals lean by `lean` to
   either side of z. lean > 0: a valley; < 0: a ridge. */
static wall_mesh wedge_of(double lean, int cells, int diagonal)
{
    const double c = 5 * cos(lean), s = 5 * sin(lean);
    const double left[3] = {-c, -5, s}, right[3] = {0, -5, 0};
    const double down[3] = {c, 0, -s}, up[3] = {c, 0, s}, y[3] = {0, 10, 0};
    wall_mesh wall;

    wall_mesh_init(&wall);
    wall_mesh_plane(&wall, left, down, y, cells, cells, diagonal, 0);
    wall_mesh_plane(&wall, right, up, y, cells, cells, diagonal, 1);
    wall_mesh_finish(&wall);
    return wall;
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
        assert_force(&wall, under, 0, 0, 0, 0);
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
    assert_force(&wall, corner, pow(0.05, 1.5), -pow(0.01, 1.5),
                 -pow(0.1, 1.5), 1e-15);
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

/* A plate thinner than the bead: its far side is not felt through it, and a
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

/* ------------------------------------------------------------ continuity */

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

/* Nothing is felt of the seams of a flat wall. */
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
    nothing else is felt: with depth measured from the nearest face, the force
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
                const double tilt =
                    atan2(-force[0], force[2]) - angle;

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

typedef struct terrain
{
    int n;
    double height[41][41], shift[41][41][2];
} terrain;

static void on_terrain(const double *uv, double point[3], void *context)
{
    const terrain *t = context;
    const int i = (int)lround(uv[0] * t->n), j = (int)lround(uv[1] * t->n);

    point[0] = i + t->shift[i][j][0];
    point[1] = j + t->shift[i][j][1];
    point[2] = t->height[i][j];
}

static wall_mesh terrain_of(double slope, uint64_t *seed)
{
    terrain t = {.n = 40};
    wall_mesh wall;

    for (int i = 0; i <= t.n; i++)
    {
        for (int j = 0; j <= t.n; j++)
        {
            t.height[i][j] = slope * test_signed(seed);
            t.shift[i][j][0] = 0.3 * test_signed(seed);
            t.shift[i][j][1] = 0.3 * test_signed(seed);
        }
    }
    wall_mesh_init(&wall);
    wall_mesh_grid(&wall, t.n, t.n, on_terrain, &t, 2, 0);
    wall_mesh_finish(&wall);
    return wall;
}

/*
    Random ground of triangles the size of a bead, edges and corners of every
    kind. Where three gentle slopes meet, a local minimum can vanish over a
    facet that is none itself; nothing else makes the force jump, and not by
    more than 5 %.
*/
static void test_random_ground(void **unused)
{
    uint64_t seed = 4;

    (void)unused;
    for (int n = 0; n < 6; n++)
    {
        wall_mesh wall = terrain_of(n % 2 ? 0.3 : 0.05, &seed);
        int index[200], jumps = 0;

        for (int path = 0; path < 20; path++)
        {
            const double start[3] = {12 + 16 * test_uniform(&seed),
                                     12 + 16 * test_uniform(&seed), 0};
            const double angle = 2 * test_pi * test_uniform(&seed);
            const double aim = -0.05 * test_uniform(&seed);
            const int samples = 5000;
            const double step = 3.0 / samples;
            double z = 3, before[3] = {0, 0, 0}, last = 0;
            ellipsoid_facet_list list;

            assert_int_equal(wall_mesh_list(&wall, start, 5, &list), 0);
            list.count = list.count < 200 ? list.count : 200;
            memcpy(index, list.index, list.count * sizeof *index);
            for (int s = -20; s <= samples; s++)
            {
                const double way = s > 0 ? s * step : 0;
                const ellipsoid_bead bead = {{start[0] + way * cos(angle),
                                              start[1] + way * sin(angle), z},
                                             r, 1};
                const ellipsoid_candidates from = {wall.facets, index,
                                                   list.count};
                double force[3] = {0, 0, 0}, gap = 4;

                ellipsoid_bead_touch(&bead, &from, &gap, force, NULL, NULL);

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

/* ---------------------------------------------------- derivative, energy */

static void assert_derivative(const wall_mesh *wall, const double x[3],
                              int contacts)
{
    const double h = 1e-6;
    double force[3], exact[3][3];

    assert_int_equal(ellipsoid_bead_force(x, r, 1, wall->facets, wall->index,
                                          wall->count, force, exact),
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
                x[i] = middles[m][i] + 0.04 * cos(a + 2 * i) + 0.01 * sin(3 * a);
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
        cmocka_unit_test(test_flat_wall_however_cut),
        cmocka_unit_test(test_box_however_cut),
        cmocka_unit_test(test_one_facet_small_or_large),
        cmocka_unit_test(test_concave_corner),
        cmocka_unit_test(test_valley),
        cmocka_unit_test(test_slit),
        cmocka_unit_test(test_thin_plate),
        cmocka_unit_test(test_baffle),
        cmocka_unit_test(test_convex_edges_and_corners),
        cmocka_unit_test(test_flat_seams),
        cmocka_unit_test(test_round_wall),
        cmocka_unit_test(test_valleys_are_continuous),
        cmocka_unit_test(test_steps_are_continuous),
        cmocka_unit_test(test_random_ground),
        cmocka_unit_test(test_derivative_is_exact),
        cmocka_unit_test(test_energy_is_kept),
    };

    return cmocka_run_group_tests_name("touch", tests, NULL, NULL);
}
