/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_wallPlanes.c - the drag near walls made of facets: in the equations,
    over seams and edges, in slits and corners.
*/
#include <fenv.h>

#include "nearWallTest.h"
#include "drag/drag.h"

enum
{
    SIZE = ELLIPSOID_STATE_SIZE
};

static ellipsoid_facet_cache cache, fresh;

/* The resistance [N s/m, ...] in the lab: what the drag does against velocities
   and angular velocities, one by one, in a fluid at rest. */
static void lab_resistance(const ellipsoid_model *m, wall_mesh *mesh,
                           const double x[3], const double q[4],
                           double matrix[6][6])
{
    test_quadratic rest = {.answer = 0};
    const ellipsoid_surroundings s = around(mesh, &rest);
    double r[3][3];

    ellipsoid_rotation(q, r);
    for (int n = 0; n < 6; n++)
    {
        ellipsoid_state state = {.u = {0}}, derivative;

        ellipsoid_copy(x, state.x);
        memcpy(state.q, q, sizeof(state.q));
        if (n < 3)
        {
            state.u[n] = 1e-9;
        }
        else
        {
            ellipsoid_copy(r[n - 3], state.omega);
            ellipsoid_set(state.omega, 1e-3 * r[n - 3][0], 1e-3 * r[n - 3][1],
                          1e-3 * r[n - 3][2]);
        }
        assert_ok(ellipsoid_rhs(m, &s, &state, &cache, &derivative));
        for (int i = 0; i < 3; i++)
        {
            matrix[i][n] = -m->mass * derivative.u[i];
            matrix[i + 3][n] = -m->inertia[i] * derivative.omega[i];
        }
    }
}

/* The largest relative difference of the columns of two resistances. */
static double difference(double a[6][6], double b[6][6])
{
    double worst = 0;

    for (int n = 0; n < 6; n++)
    {
        for (int first = 0; first < 6; first += 3)
        {
            double size = 0, error = 0;

            for (int i = first; i < first + 3; i++)
            {
                size += a[i][n] * a[i][n];
                error += pow(a[i][n] - b[i][n], 2);
            }
            worst = (first == 0) == (n < 3) ? fmax(worst, sqrt(error / size))
                                            : worst;
        }
    }
    return worst;
}

/* --------------------------------------------------------------- Jacobian */

/* A shallow step, a ridge, a corner and a lid: planes, edges and vertices, all
   in range. */
static void add_landscape(wall_mesh *mesh)
{
    const double low[3] = {-6e-6, -6e-6, -4e-6}, high[3] = {6e-6, 6e-6, 4e-6};
    const double block[2][3] = {{2e-6, -7e-6, -5e-6}, {7e-6, 0, -2e-6}};

    wall_mesh_box(mesh, low, high, 1, 2, 0);
    wall_mesh_box(mesh, block[0], block[1], 0, 2, 0);
}

/* Of the fourth order, step 1e-5 of the semi-axis and of q: the block's edge
   and corner bend the planes within 1 um. 1e-6 of the block's size, and what
   rounding of the accelerations leaves. */
static int compare_jacobian(const ellipsoid_model *m,
                            const ellipsoid_surroundings *s,
                            const ellipsoid_state *state)
{
    static const double weight[] = {1.0 / 12, -2.0 / 3, 0, 2.0 / 3, -1.0 / 12};
    double jacobian[SIZE][SIZE];
    int bad = 0;

    assert_ok(ellipsoid_jacobian(m, s, state, &cache, jacobian));
    for (int j = 0; j < SIZE; j++)
    {
        const double step = j < AT_X     ? 1e-3
                          : j < AT_OMEGA ? 2e-11
                          : j < AT_Q     ? 1e3
                                         : 1e-5;
        double slope[SIZE] = {0}, largest[SIZE] = {0};

        for (int p = -2; p <= 2; p++)
        {
            double y[SIZE], f[SIZE];
            ellipsoid_state moved, derivative;

            memcpy(y, state, sizeof(y));
            y[j] += p * step;
            memcpy(&moved, y, sizeof(moved));
            assert_ok(ellipsoid_rhs(m, s, &moved, &cache, &derivative));
            memcpy(f, &derivative, sizeof(f));
            for (int i = 0; i < SIZE; i++)
            {
                slope[i] += weight[p + 2] * f[i] / step;
                largest[i] = fmax(largest[i], fabs(f[i]));
            }
        }
        for (int begin = 0; begin < AT_Q; begin += AT_OMEGA)
        {
            double size = 0, error = 0, rounding = 0;

            for (int i = begin; i < begin + 3; i++)
            {
                size = fmax(size, fabs(jacobian[i][j]));
                error = fmax(error, fabs(slope[i] - jacobian[i][j]));
                rounding = fmax(rounding, 1e-14 * largest[i] / step);
            }
            bad += !(error <= 1e-6 * size + rounding);
        }
    }
    return bad;
}

static void test_jacobian(void **unused)
{
    ellipsoid_options o = near_walls();
    ellipsoid_model model;
    test_quadratic flow = test_shear(1000);
    wall_mesh mesh;
    uint64_t seed = 21;
    int bad = 0, several = 0;

    (void)unused;
    o.wall_range = 10e-6; /* all of the landscape */
    model = test_model(&o);
    flow.h[0][2][2] = 1e8;
    flow.u[1] = 1e-3;
    wall_mesh_init(&mesh);
    add_landscape(&mesh);
    wall_mesh_finish(&mesh);
    ellipsoid_facet_cache_clear(&cache);
    for (int n = 0; n < 400; n++)
    {
        const ellipsoid_surroundings s = around(&mesh, &flow);
        ellipsoid_state state = {.u = {0}};
        double r[3][3];
        ellipsoid_frame frame = {.by_q = NULL};
        ellipsoid_planes planes;

        test_orientation(&seed, state.q);
        for (int i = 0; i < 3; i++)
        {
            state.x[i] = (i == 2 ? 2e-6 : 4e-6) * test_signed(&seed);
            state.u[i] = 1e-3 * test_signed(&seed);
            state.omega[i] = 1e3 * test_signed(&seed);
        }
        if (state.x[0] > 1e-6 && state.x[1] < 1e-6)
        {
            state.x[2] = fabs(state.x[2]);
        }
        ellipsoid_rotation(state.q, r);
        for (int i = 0; i < 3; i++)
        {
            ellipsoid_set(frame.axis[i], r[0][i], r[1][i], r[2][i]);
        }
        assert_ok(
            ellipsoid_find_planes(&model, &s, &state, &frame, &cache, &planes));
        several += planes.count >= 6;
        for (int l = 0; l < 4; l++)
        {
            state.q[l] *= 1 + 0.05 * (n % 3 - 1);
        }
        model.options.flow_at =
            n % 2 ? ELLIPSOID_FLOW_CENTRE : ELLIPSOID_FLOW_BODY;
        model = test_model(&model.options);
        bad += compare_jacobian(&model, &s, &state) > 0;
    }
    print_message("%d of 400 states with six planes or more\n", several);
    assert_true(bad == 0);
    assert_true(several > 50);
    wall_mesh_free(&mesh);
}

/* ------------------------------------------------------------------ walls */

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
    ellipsoid_facet_cache_clear(&cache);
    for (size_t n = 0; n < sizeof(known) / sizeof(*known); n++)
    {
        test_quadratic rest = {.answer = 0};
        const ellipsoid_surroundings s = around(&mesh, &rest);
        const ellipsoid_state state = {
            .x = {known[n][0] * sqrt(2 * gap * radius), 0, radius + gap},
            .q = {0, 0, 0, 1}};
        ellipsoid_frame frame = {.axis = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        ellipsoid_planes planes;

        assert_ok(
            ellipsoid_find_planes(&model, &s, &state, &frame, &cache, &planes));
        assert_int_equal(planes.count, 1);
        assert_near(planes.at[0].weight[ELLIPSOID_PLANE_NEAR], known[n][1],
                    0.07);
    }
    wall_mesh_free(&mesh);
}

/*
    A sphere held in the flow of a stagnation point, (x z, y z, -z^2): the force
    over 6 pi mu a h^2 is known (Goren & O'Neill, Chem. Eng. Sci. 26, 325 (1971):
    3.23 at contact; here by tests/benchmarks/resolvedCell) and stays finite,
    while that on a sphere that moves grows as the inverse of the gap.
*/
static void test_held_at_a_stagnation_point(void **unused)
{
    static const test_row centre = {
        "walls",
        "force on a sphere held at a stagnation point over that known",
        "gaps 0.1, 0.2, 0.6 radii, flow centre",
        "Goren & O'Neill, Chem. Eng. Sci. 26, 325 (1971); boundary elements",
        "P",
        "10 % would be good: the model knows motion and linear shear at a "
        "plane, no flow that bends",
        8};
    static const test_row body = {
        "walls",
        "force on a sphere held at a stagnation point over that known",
        "gaps 0.1, 0.2, 0.6 radii, flow body",
        "Goren & O'Neill, Chem. Eng. Sci. 26, 325 (1971); boundary elements",
        "P",
        "10 % would be good: the model knows motion and linear shear at a "
        "plane, no flow that bends",
        8};
    static const double known[][2] = {{0.1, 2.94}, {0.2, 2.73}, {0.6, 2.17}};
    const double radius = 0.5e-6;
    ellipsoid_options o = near_walls();
    wall_mesh mesh;

    (void)unused;
    ellipsoid_set(o.semi_axes, radius, radius, radius);
    wall_mesh_init(&mesh);
    add_floor(&mesh, 0, 1, 1);
    wall_mesh_finish(&mesh);
    for (int n = 0; n < 6; n++)
    {
        test_quadratic flow = {.answer = 0};
        const ellipsoid_surroundings s = around(&mesh, &flow);
        const double gap = known[n / 2][0] * radius, height = radius + gap;
        const ellipsoid_state state = {.x = {0, 0, height}, .q = {0, 0, 0, 1}};
        ellipsoid_state derivative;
        ellipsoid_model model;
        double force;

        flow.h[0][0][2] = flow.h[0][2][0] = 1e9;
        flow.h[1][1][2] = flow.h[1][2][1] = 1e9;
        flow.h[2][2][2] = -2e9;
        o.flow_at = n % 2 ? ELLIPSOID_FLOW_BODY : ELLIPSOID_FLOW_CENTRE;
        model = test_model(&o);
        ellipsoid_facet_cache_clear(&cache);
        assert_ok(ellipsoid_rhs(&model, &s, &state, &cache, &derivative));
        force =
            -model.mass * derivative.u[2]
            / (6 * acos(-1) * model.viscosity * radius * 1e9 * height * height);
        print_message("gap %g radii: %.2f, known %.2f\n", known[n / 2][0],
                      force, known[n / 2][1]);
        assert_true(force > 0.9 * known[n / 2][1]);
        assert_row(n % 2 ? &body : &centre, force / known[n / 2][1], 1, 0.1);
    }
    wall_mesh_free(&mesh);
}

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

/* A tunnel (sign 1) or a post (-1) along x2, touched from within or outside by
   x3 = 0. */
typedef struct arc
{
    double sign, radius;
} arc;

static void bend(const double *uv, double point[3], void *context)
{
    const arc *a = context;
    const double angle = 2 * test_pi * (uv[0] - 0.5);
    const double across = fabs(sin(angle)) < 1e-9 ? 0 : sin(angle);

    ellipsoid_set(point, a->radius * across, 6e-5 * (uv[1] - 0.5),
                  a->sign * a->radius * (1 - cos(angle)));
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
    for (int n = 0; n < test_count(4, 20, 20); n++)
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
    for (long n = test_count(3, 60, 60); n > 0; n--)
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
        for (long n = test_count(2, 40, 40); n > 0; n--)
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

/* The result is that of the pose, to the last bit, whatever the cache holds:
   after a new pose, and after moves of about what leaves the closer look as it
   is, near few large facets and near many small ones. */
static void test_cache(void **unused)
{
    const double corner[3] = {-8e-6, -8e-6, -5e-6};
    const double along[3] = {16e-6, 0, 0}, across[3] = {0, 16e-6, 0};
    const ellipsoid_options o = near_walls();
    const ellipsoid_model model = test_model(&o);
    test_quadratic flow = test_shear(1000);
    uint64_t seed = 24;

    (void)unused;
    for (int n = 0; n < 2400; n++)
    {
        static wall_mesh mesh;
        static ellipsoid_state state;
        const ellipsoid_surroundings s = around(&mesh, &flow);
        ellipsoid_state a, b;

        if (n % 1200 == 0)
        {
            wall_mesh_init(&mesh);
            if (n == 0)
            {
                add_landscape(&mesh);
            }
            else
            {
                wall_mesh_plane(&mesh, corner, along, across, 32, 32, 2, 0);
            }
            wall_mesh_finish(&mesh);
            ellipsoid_set(state.x, -2e-6, -3e-6, -1e-6);
            ellipsoid_facet_cache_clear(&cache);
        }
        state.x[n % 3] += 0.3e-6 * test_signed(&seed);
        state.q[n % 4] += 0.011 * test_signed(&seed);
        if (n % 8 == 0)
        {
            test_orientation(&seed, state.q);
        }
        ellipsoid_facet_cache_clear(&fresh);
        assert_ok(ellipsoid_rhs(&model, &s, &state, &cache, &a));
        assert_ok(ellipsoid_rhs(&model, &s, &state, &fresh, &b));
        assert_memory_equal(&a, &b, sizeof(a));
        if (n % 1200 == 1199)
        {
            wall_mesh_free(&mesh);
        }
    }
}

/* So too where a small wall is as far beside the place as it may be. */
static void test_cache_far_beside(void **unused)
{
    const double corner[3] = {0, 0, 0}, size = 2e-7;
    const double along[3] = {size, 0, 0}, across[3] = {0, size, 0};
    const ellipsoid_options o = near_walls();
    const ellipsoid_model model = test_model(&o);
    const long count = test_count(5000, 100000, 100000);
    test_quadratic flow = test_shear(1000);
    uint64_t seed = 25;
    int felt = 0;
    wall_mesh mesh;

    (void)unused;
    wall_mesh_init(&mesh);
    wall_mesh_plane(&mesh, corner, along, across, 1, 1, 2, 0);
    wall_mesh_finish(&mesh);
    for (long n = 0; n < count; n++)
    {
        const ellipsoid_surroundings s = around(&mesh, &flow);
        const double away = o.wall_range * (1.05 + 0.6 * test_uniform(&seed));
        double to[3];
        ellipsoid_state near = {.u = {0}}, a, b, free;
        ellipsoid_surroundings none = s;

        none.walls = NULL;
        test_orientation(&seed, near.q);
        test_long_axis(&near, to);
        test_orientation(&seed, near.q);
        ellipsoid_set(near.x, away * to[0], away * to[1], away * fabs(to[2]));
        ellipsoid_facet_cache_clear(&cache);
        ellipsoid_facet_cache_clear(&fresh);
        assert_ok(ellipsoid_rhs(&model, &s, &near, &cache, &a));
        for (int i = 0; i < 3; i++)
        {
            near.x[i] *= 1 - 0.099 * o.wall_range / away;
        }
        assert_ok(ellipsoid_rhs(&model, &s, &near, &cache, &a));
        assert_ok(ellipsoid_rhs(&model, &s, &near, &fresh, &b));
        assert_memory_equal(&a, &b, sizeof(a));
        assert_ok(ellipsoid_rhs(&model, &none, &near, NULL, &free));
        felt += memcmp(&a, &free, sizeof(a)) != 0;
    }
    assert_true(felt > 0);
    wall_mesh_free(&mesh);
}

/* All facets, whatever the reach. */
static int list_all(void *context, double t, const double centre[3],
                    double reach, ellipsoid_facet_list *list)
{
    (void)t;
    (void)centre;
    *list = wall_mesh_all(context);
    list->reach = reach;
    return 0;
}

/*
    So too where a crest meets the foot of a rise at an acute angle of a facet
    beside it: the plane of the crest goes on into the rise, and where it has
    faded its facet may be dropped. A list of all facets gives the same.
*/
static void test_cache_at_acute_angles(void **unused)
{
    const double w = 0.3e-6;
    const double crest[3][3] = {{0, -6e-6, 0}, {0}, {0, 6e-6, 1.2e-6}};
    ellipsoid_options o = near_walls();
    ellipsoid_model model;
    test_quadratic flow = test_shear(1000);
    ellipsoid_state state = {.x = {-1e-6, -2e-6, 1e-6}, .q = {0, 0, 0, 1}};
    uint64_t seed = 27;
    wall_mesh mesh;

    (void)unused;
    ellipsoid_set(o.semi_axes, 1e-6, 1e-6, 1e-6);
    o.wall_range = 2.5e-6;
    model = test_model(&o);
    wall_mesh_init(&mesh);
    for (int part = 0; part < 2; part++)
    {
        double top[2][3], side[2][3];

        for (int end = 0; end < 2; end++)
        {
            const double *at = crest[part + end];

            ellipsoid_set(top[end], at[0] + w, at[1], at[2]);
            ellipsoid_set(side[end], at[0], at[1], -w);
        }
        wall_mesh_quad(&mesh, crest[part], top[0], top[1], crest[part + 1], 1,
                       0);
        wall_mesh_quad(&mesh, crest[part], crest[part + 1], side[1], side[0], 1,
                       0);
    }
    wall_mesh_finish(&mesh);
    ellipsoid_facet_cache_clear(&cache);
    for (long n = test_count(20000, 200000, 200000); n > 0; n--)
    {
        static const double limit[3] = {4e-6, 9e-6, 4e-6};
        const ellipsoid_surroundings s = around(&mesh, &flow);
        ellipsoid_surroundings all = s;
        ellipsoid_state a, b;

        all.walls = list_all;
        for (int i = 0; i < 3; i++)
        {
            state.x[i] += 0.3e-6 * test_signed(&seed);
            state.x[i] = fabs(state.x[i]) < limit[i] ? state.x[i] : -1e-6;
        }
        state.q[n % 4] += 0.02 * test_signed(&seed);
        assert_ok(ellipsoid_rhs(&model, &s, &state, &cache, &a));
        ellipsoid_facet_cache_clear(&fresh);
        assert_ok(ellipsoid_rhs(&model, &s, &state, &fresh, &b));
        assert_memory_equal(&a, &b, sizeof(a));
        ellipsoid_facet_cache_clear(&fresh);
        assert_ok(ellipsoid_rhs(&model, &all, &state, &fresh, &b));
        assert_memory_equal(&a, &b, sizeof(a));
    }
    wall_mesh_free(&mesh);
}

/* Nothing is invalid in line with an edge, where programs may trap that: there
   the distance from it is what rounding leaves. */
static void test_in_line_with_an_edge(void **unused)
{
    const ellipsoid_options o = near_walls();
    const ellipsoid_model model = test_model(&o);
    test_quadratic flow = test_shear(1000);

    (void)unused;
    for (int size = 1; size <= 7; size++)
    {
        const double edge = size * 1e-6;
        const double low[3] = {0}, high[3] = {edge, edge, edge};
        wall_mesh mesh;

        wall_mesh_init(&mesh);
        wall_mesh_box(&mesh, low, high, 0, 0, 0);
        wall_mesh_finish(&mesh);
        for (int n = 0; n < 200; n++)
        {
            const ellipsoid_surroundings s = around(&mesh, &flow);
            const ellipsoid_state state = {
                .x = {0, 0, edge + (4 + 0.02 * n) * 1e-6}, .q = {0, 0, 0, 1}};
            ellipsoid_state derivative;

            ellipsoid_facet_cache_clear(&cache);
            feclearexcept(FE_INVALID);
            assert_ok(ellipsoid_rhs(&model, &s, &state, &cache, &derivative));
            assert_false(fetestexcept(FE_INVALID));
        }
        wall_mesh_free(&mesh);
    }
}

/* A slit: two walls add up (Oseen's superposition); a wall out of range, or
   none at all, is no wall. */
static void test_slit(void **unused)
{
    const ellipsoid_options o = near_walls(), free = test_free_cell();
    const ellipsoid_model model = test_model(&o), bare = test_model(&free);
    const double low[3] = {-1e-4, -1e-4, 0}, high[3] = {1e-4, 1e-4, 6e-6};
    const double q[4] = {0.1, 0.2, 0.3, 0.927361849549570};
    const double x[3] = {0, 0, 2.5e-6}, off[3] = {0, 0, 10.1e-6 * 4};
    double one[6][6], other[6][6], both[6][6], none[6][6];
    wall_mesh floor, lid, slit;

    (void)unused;
    wall_mesh_init(&floor);
    wall_mesh_init(&lid);
    wall_mesh_init(&slit);
    add_floor(&floor, 0, 1, 1);
    {
        const double a[3] = {1e-4, -1e-4, 6e-6}, u[3] = {-2e-4, 0, 0};
        const double v[3] = {0, 2e-4, 0};

        wall_mesh_plane(&lid, a, u, v, 1, 1, 0, 0);
    }
    wall_mesh_box(&slit, low, high, 1, 0, 0);
    wall_mesh_finish(&floor);
    wall_mesh_finish(&lid);
    wall_mesh_finish(&slit);
    ellipsoid_facet_cache_clear(&cache);
    lab_resistance(&model, &floor, x, q, one);
    ellipsoid_facet_cache_clear(&cache);
    lab_resistance(&model, &lid, x, q, other);
    ellipsoid_facet_cache_clear(&cache);
    lab_resistance(&model, &slit, x, q, both);
    lab_resistance(&bare, &slit, x, q, none);
    for (int n = 0; n < 6; n++)
    {
        for (int i = 0; i < 6; i++)
        {
            one[i][n] += other[i][n] - none[i][n];
        }
    }
    assert_true(difference(one, both) < 1e-11);
    ellipsoid_facet_cache_clear(&cache);
    lab_resistance(&model, &floor, off, q, both);
    assert_true(difference(none, both) < 1e-13);
    wall_mesh_free(&floor);
    wall_mesh_free(&lid);
    wall_mesh_free(&slit);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_jacobian),
        cmocka_unit_test(test_cuts),
        cmocka_unit_test(test_wall_that_ends),
        cmocka_unit_test(test_held_at_a_stagnation_point),
        cmocka_unit_test(test_continuous),
        cmocka_unit_test(test_continuous_over_edges),
        cmocka_unit_test(test_cuts_at_a_seam),
        cmocka_unit_test(test_continuous_beside_a_pit),
        cmocka_unit_test(test_continuous_by_a_post),
        cmocka_unit_test(test_cache),
        cmocka_unit_test(test_cache_far_beside),
        cmocka_unit_test(test_cache_at_acute_angles),
        cmocka_unit_test(test_in_line_with_an_edge),
        cmocka_unit_test(test_slit),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
