/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_thinWalls.c - whole cells, 1 um thick and 4 um long, where walls are
    close together: a slit of 0.1 um, a plate of 0.1 um, a baffle, two of them; and
    how often a cell far from all walls asks for them.
*/
#include "coreTest.h"
#include "wallMesh.h"

static const double um = 1e-6;

/* Walls that count their calls and tell, as OpenFOAM's layer does, how far the
   nearest facet is. */
typedef struct asked_walls
{
    wall_mesh *mesh;
    double (*distance)(const double centre[3]);
    int calls;
} asked_walls;

static int asked(void *context, double t, const double centre[3], double reach,
                 ellipsoid_facet_list *list)
{
    asked_walls *walls = context;

    walls->calls++;
    wall_mesh_list(walls->mesh, t, centre, reach, list);
    if (walls->distance)
    {
        list->reach = fmax(reach, walls->distance(centre));
    }
    return 0;
}

typedef struct trip
{
    ellipsoid_state state;
    ellipsoid_statistics statistics;
    asked_walls walls;
    double time;
    int shape; /* of contact */
} trip;

/* A cell pushed by a force through a fluid for a while. */
static void go(trip *t, test_quadratic *flow, const double force[3], double end)
{
    static ellipsoid_facet_cache cache;
    ellipsoid_options options = test_paper_options();
    ellipsoid_controller controller = {0, 0};
    const ellipsoid_surroundings surroundings = {.flow = test_quadratic_flow,
                                                 .flow_context = flow,
                                                 .walls = asked,
                                                 .walls_context = &t->walls};

    options.buoyancy = 0;
    options.contact_shape = t->shape;
    options.tolerance = 1e-6; /* depths of nanometres are compared */
    ellipsoid_copy(force, options.external_force);

    const ellipsoid_model model = test_model(&options);

    ellipsoid_facet_cache_clear(&cache);
    assert_ok(ellipsoid_advance(
        &(ellipsoid_member){&model, &surroundings, &t->state, &controller,
                            &cache, NULL, &t->statistics},
        &t->time, end, NULL));
}

/* Hertz's depth of one bead under a force */
static double depth_of(double force)
{
    const ellipsoid_options options = test_paper_options();
    const double k =
        4.0 / 3 * options.contact_modulus * sqrt(options.bead_radius);

    return pow(force / k, 2.0 / 3);
}

/* Two plates x1 < 0 with a slit of 0.1 um between them, at x3 = 0 */
static wall_mesh slit_of(double width, int cells, int diagonal)
{
    const double half = width / 2, far = 8 * um;
    const double y[3] = {0, 2 * far, 0}, depth[3] = {far, 0, 0};
    const double back[3] = {-far, 0, 0};
    wall_mesh mesh;

    wall_mesh_init(&mesh);
    for (int side = 0; side < 2; side++)
    {
        const double s = side ? 1 : -1;
        const double lip[3] = {0, -far, s * half};
        const double inner[3] = {side ? 0 : -far, -far, s * half};
        const double up[3] = {0, 0, s * (far - half)};

        wall_mesh_plane(&mesh, lip, side ? y : up, side ? up : y, cells, cells,
                        diagonal, side);
        wall_mesh_plane(&mesh, inner, side ? back : depth, y, cells, cells,
                        diagonal, side);
    }
    wall_mesh_finish(&mesh);
    return mesh;
}

/*
    A cell before the slit, nose first, along it and across, is pushed with 1 pN
    to 10 nN: it stays out. One bead that bears it all is the deepest that can
    be at rest; a nose that arrives under 10 nN, with 0.5 m/s and hence an
    energy m u^2/2 of 2.8e-16 J against 2.3e-16 J of that bead's, swings beyond
    by half.
*/
static void test_slit_keeps_out(void **unused)
{
    const double forces[] = {1e-12, 1e-10, 1e-8};
    const double axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

    (void)unused;
    for (int cut = 0; cut < 2; cut++)
    {
        wall_mesh mesh = slit_of(0.1 * um, cut ? 9 : 1, cut);

        for (int n = 0; n < 9; n++)
        {
            const double force = forces[n / 3], *axis = axes[n % 3];
            const double push[3] = {-force, 0, 0};
            const double half = axis[0] > 0 ? 2 * um : 0.5 * um;
            /* the drag of half a body length of way */
            const double duration = 2e-14 / force * 3;
            test_quadratic still = {.answer = 0};
            trip t = {.walls = {.mesh = &mesh}};

            ellipsoid_set(t.state.x, half + 0.2 * um, 0, 0);
            ellipsoid_quaternion_from_axis(axis, 0.3, t.state.q);
            go(&t, &still, push, duration);

            const double deep = t.statistics.deepest / depth_of(force);

            print_message("# %g N, axis %d: %ld steps, %ld rejected, deepest "
                          "%.3g nm, %.2f of one bead's\n",
                          force, n % 3, t.statistics.accepted,
                          t.statistics.rejected, 1e9 * t.statistics.deepest,
                          deep);
            assert_true(deep > 0.3 && deep < (force > 1e-9 ? 1.6 : 1.1));
            assert_true(t.state.x[0] > half - 0.1 * um);
            assert_true(t.statistics.accepted < 300);
        }
        wall_mesh_free(&mesh);
    }
}

/* A plate of 0.1 um, and one of no thickness, which a cell is pushed against
   from above and, the mirror image, from below. */
static void test_thin_plate_from_either_side(void **unused)
{
    const double forces[] = {1e-12, 1e-10, 1e-8};

    (void)unused;
    for (int n = 0; n < 12; n++)
    {
        const double thick = n % 2 ? 0.05 * um : 0, force = forces[n / 2 % 3];
        const double corner[3] = {-8 * um, -8 * um, thick};
        const double under[3] = {-8 * um, -8 * um, -thick};
        const double u[3] = {16 * um, 0, 0}, v[3] = {0, 16 * um, 0};
        const double lean[3] = {0.3, 1, n < 6 ? 0 : 0.8};
        wall_mesh mesh;
        double ends[2][2];

        wall_mesh_init(&mesh);
        wall_mesh_plane(&mesh, corner, u, v, 5, 5, 0, 0);
        wall_mesh_plane(&mesh, under, v, u, 5, 5, 0, 1);
        wall_mesh_finish(&mesh);
        for (int side = 0; side < 2; side++)
        {
            const double s = side ? -1 : 1, push[3] = {0, 0, -s * force};
            test_quadratic still = {.answer = 0};
            trip t = {.walls = {.mesh = &mesh}};

            ellipsoid_set(t.state.x, 0.3 * um, -0.2 * um, s * 2.5 * um);
            ellipsoid_quaternion_from_axis(lean, 0.3, t.state.q);
            if (side)
            {
                /* half a turn about x1: back to back with the other */
                const double q[4] = {t.state.q[3], -t.state.q[2], t.state.q[1],
                                     -t.state.q[0]};

                memcpy(t.state.q, q, sizeof q);
                t.state.x[1] *= -1;
            }
            go(&t, &still, push, 2e-13 / force);
            ends[side][0] = s * t.state.x[2];
            ends[side][1] = t.statistics.deepest;
            assert_true(s * t.state.x[2] > thick + 0.35 * um);
            assert_true(t.statistics.deepest < 1.1 * depth_of(force));
        }
        print_message("# %g N, %g um: rests %.4f um off, deepest %.3g nm\n",
                      force, 2e6 * thick, 1e6 * (ends[0][0] - thick),
                      1e9 * ends[0][1]);
        /* to the tolerance of the steps, which are not the same to the bit */
        assert_near(ends[0][0], ends[1][0], 1e-4 * um);
        assert_relative(ends[0][1], ends[1][1], 1e-2);
        wall_mesh_free(&mesh);
    }
}

/*
    A cell that lies along a slit of 0.7 um between two baffles is pushed into it
    from either side, with 1 to 100 pN, and comes to rest on both rims. The
    ellipsoid lies there as a circle of 0.5 um on two points, at Hertz's depth, to
    first order in that: 2 %. Beads have valleys for the rims.
*/
static void test_between_rims(void **unused)
{
    const double half = 0.35 * um, far = 8 * um;
    const double deep = sqrt(0.5 * um * 0.5 * um - half * half);
    const double up[3] = {0, 0, far}, y[3] = {0, 2 * far, 0};
    wall_mesh mesh;

    (void)unused;
    wall_mesh_init(&mesh);
    for (int n = 0; n < 4; n++)
    {
        const double corner[3] = {0, -far, n < 2 ? half : -half - far};

        wall_mesh_plane(&mesh, corner, n % 2 ? y : up, n % 2 ? up : y, 5, 5, 0,
                        n);
    }
    wall_mesh_finish(&mesh);
    for (int n = 0; n < 12; n++)
    {
        const int side = n % 2 ? 1 : -1, shape = n / 2 % 2;
        const double force = 1e-12 * pow(10, n / 4);
        const double push[3] = {-side * force, 0, 0};
        const double along[3] = {0.02, 1, 0.01};
        test_quadratic still = {.answer = 0};
        trip t = {.walls = {.mesh = &mesh},
                  .shape = shape ? ELLIPSOID_CONTACT_ELLIPSOID
                                 : ELLIPSOID_CONTACT_BEADS};

        ellipsoid_set(t.state.x, side * 0.7 * um, 0.1 * um, 0.1 * um);
        ellipsoid_quaternion_from_axis(along, 0.3, t.state.q);
        go(&t, &still, push, 4e-13 / force);

        /* each rim bears half of the force */
        const double cosine = deep / (0.5 * um);
        const double sink = depth_of(force / 2 / cosine) / cosine;
        const double off = deep - side * t.state.x[0];

        print_message("# shape %d, %g N: %.3f nm deep, by Hertz %.3f nm, %.2g "
                      "m/s, %ld steps\n",
                      shape, force, 1e9 * off, 1e9 * sink,
                      ellipsoid_length(t.state.u), t.statistics.accepted);
        assert_true(shape ? fabs(off - sink) < 0.02 * sink : off < 0.1 * um);
        /* of the 1e-4 m/s and more with which it came */
        assert_true(ellipsoid_length(t.state.u) < 1e-12);
    }
    wall_mesh_free(&mesh);
}

static double above_floor(const double centre[3])
{
    return centre[2] + 20 * um;
}

/*
    20 um from the only wall, in a shear flow that turns the cell: one look-up
    serves until the cell has moved by what it was off, whatever the steps. The
    way is counted between look-ups.
*/
static void test_far_from_walls(void **unused)
{
    const double corner[3] = {-1, -1, -20 * um}, u[3] = {2, 0, 0};
    const double v[3] = {0, 2, 0}, none[3] = {0, 0, 0};
    wall_mesh mesh;

    (void)unused;
    wall_mesh_init(&mesh);
    wall_mesh_plane(&mesh, corner, u, v, 1, 1, 0, 0);
    wall_mesh_finish(&mesh);
    for (int knows = 0; knows < 2; knows++)
    {
        test_quadratic flow = test_shear(100);
        trip t = {
            .walls = {.mesh = &mesh, .distance = knows ? above_floor : NULL}};

        flow.u[0] = 1e-3;
        t.state.u[0] = 1e-3;
        t.state.q[3] = 1;
        go(&t, &flow, none, 1);

        /* reach: 2 um, and a bead radius of horizon beyond the beads */
        const double reach = 2.285 * um,
                     margin = knows ? 20 * um - reach : reach;
        const double asks = t.state.x[0] / margin;

        print_message("# %g mm, %ld steps, %ld evaluations: %d look-ups, one a "
                      "%.1f um\n",
                      1e3 * t.state.x[0], t.statistics.accepted,
                      t.statistics.rhs, t.walls.calls,
                      1e6 * t.state.x[0] / t.walls.calls);
        assert_true(t.statistics.accepted > 500);
        assert_true(t.walls.calls <= (knows ? 1.5 : 3) * asks + 2);
        assert_true(t.walls.calls >= 0.7 * asks);
    }
    wall_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_slit_keeps_out),
        cmocka_unit_test(test_thin_plate_from_either_side),
        cmocka_unit_test(test_between_rims),
        cmocka_unit_test(test_far_from_walls),
    };

    return cmocka_run_group_tests_name("thinWalls", tests, NULL, NULL);
}
