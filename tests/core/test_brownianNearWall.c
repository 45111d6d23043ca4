/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_brownianNearWall.c - near a wall: drift, diffusion and equilibrium.
    Processor time: 3, full 34
*/
#include "brownianProfile.h"
#include "nearWallTest.h"

static ellipsoid_options near_wall(ellipsoid_motion motion, double interval)
{
    ellipsoid_options o = test_brownian(motion, interval);

    o.wall_resistance = ELLIPSOID_WALL_RESISTANCE_PLANE;
    o.tolerance = 1e-5;
    return o;
}

static const ellipsoid_load no_load;

/* The noise of the interval that begins at t. */
static void begin_noise(test_walk *w, double t, const ellipsoid_load *load,
                        ellipsoid_noise *noise)
{
    assert_ok(ellipsoid_noise_at(&w->model, &w->around, t, noise));
    assert_ok(ellipsoid_wall_noise_begin(&w->model, &w->around, &w->state,
                                         w->cache, t, load, noise));
}

/* The mobility [s/kg, ...] in the body frame. */
static void mobility_at(test_walk *w, double matrix[6][6])
{
    ellipsoid_planes planes;
    ellipsoid_wall_expansion here;

    assert_ok(ellipsoid_find_planes(&w->model, &w->around, &w->state, 0,
                                    w->cache, &planes));
    ellipsoid_wall_expansion_set(&w->model, &planes, &w->state, &here);
    ellipsoid_wall_matrix(&here, matrix);
    assert_true(ellipsoid_invert6(matrix));
}

/* kT div M along x3: how that component changes with the place, and with small
   turns about the axes of the lab. */
static double drift_of(test_walk w)
{
    static const double step = 1e-9, turn = 1e-3;
    const ellipsoid_state state = w.state;
    double sum = 0;

    for (int j = 0; j < 8; j++)
    {
        const double sign = j % 2 ? -1 : 1;
        double matrix[6][6], r[3][3], across[3], change[4] = {0};

        w.state = state;
        if (j < 2)
        {
            w.state.x[2] += sign * step;
        }
        else
        {
            /* half the turn, times q from the left */
            double half[3] = {0};

            half[j / 2 - 1] = 0.5 * sign * turn;
            ellipsoid_cross(half, state.q, change);
            for (int i = 0; i < 3; i++)
            {
                change[i] += half[i] * state.q[3];
            }
            change[3] = -ellipsoid_dot(half, state.q);
        }
        for (int n = 0; n < 4; n++)
        {
            w.state.q[n] += change[n];
        }
        ellipsoid_normalise(w.state.q);
        mobility_at(&w, matrix);
        ellipsoid_rotation(w.state.q, r);
        for (int l = 0; l < 3; l++)
        {
            across[l] = 0;
            for (int i = 0; i < 3; i++)
            {
                across[l] += r[2][i] * matrix[i][l + (j < 2 ? 0 : 3)];
            }
        }
        /* along x3, or the axis of the turn */
        sum += sign * ellipsoid_dot(r[j < 2 ? 2 : j / 2 - 1], across)
             / (2 * (j < 2 ? step : turn));
    }
    return test_kt * sum;
}

/* ------------------------------------------------- drift and diffusion */

/*
    Over one interval the cell, lying above the wall, moves by M0 F dt, of the
    covariance 2 kT M dt, and by the change of M on the way: in the mean by kT
    div M dt, with the height and with turns. The first part is known and taken off, so
    that few cells tell the second: it is of its size, each, five times its
    standard error.
*/
static void check_interval(ellipsoid_motion motion, long count)
{
    static const test_row drifts = {
        "Brownian motion",
        "mean way past the noise near a wall, in standard errors",
        "E. coli, 0.2 um above a wall, both motions",
        "drift kT div M; Ermak & McCammon, J. Chem. Phys. 69, 1352 (1978)",
        "A",
        "5 sigma",
        0};
    static const test_row diffuses = {
        "Brownian motion",
        "mean square way towards a wall, in standard errors",
        "E. coli, 0.2 um above a wall, both motions",
        "2 kT M dt; Ermak & McCammon, J. Chem. Phys. 69, 1352 (1978)",
        "A",
        "5 sigma",
        0};
    const ellipsoid_options o = near_wall(motion, 1e-3);
    const double height = 0.7e-6;
    double matrix[6][6], drift, square = 0;
    test_sample off = {0};
    double dt = 0;
    test_walk w = walk_over_wall(&o, 1, 0, height);

    mobility_at(&w, matrix);
    drift = drift_of(w);
    for (long id = 0; id < count; id++)
    {
        ellipsoid_noise noise;
        double rates[6] = {0}, action[6];

        w = walk_over_wall(&o, 1, (uint32_t)id, height);
        begin_noise(&w, 0, &no_load, &noise);
        assert_true(noise.near);
        dt = noise.end;
        ellipsoid_wall_noise_set(&w.model, &w.around, dt, &noise);
        ellipsoid_copy(noise.force, action);
        ellipsoid_copy(noise.torque, action + 3);
        for (int i = 0; i < 6; i++)
        {
            for (int k = 0; k < 6; k++)
            {
                rates[i] += matrix[i][k] * action[k];
            }
        }
        assert_ok(test_walk_to(&w, dt));
        test_sample_add(&off, w.state.x[2] - height - rates[2] * dt);
        square += rates[2] * rates[2] * dt * dt / (double)count;
    }
    print_message("# %s: dt = %.2e s, drift %.3e +- %.1e m/s of %.3e, "
                  "<dh^2>/2 dt %.4e of %.4e m2/s\n",
                  test_motion_name(motion), dt, off.mean / dt,
                  test_sample_sigma(&off) / dt, drift, square / (2 * dt),
                  test_kt * matrix[2][2]);
    assert_row(&drifts, (off.mean - drift * dt) / test_sample_sigma(&off), 0,
               5);
    assert_true(drift * dt > 10 * test_sample_sigma(&off));
    assert_row(&diffuses,
               (square / (2 * dt * test_kt * matrix[2][2]) - 1)
                   / sqrt(2.0 / (double)count),
               0, 5);
}

static void test_interval(void **unused)
{
    (void)unused;
    check_interval(ELLIPSOID_MOTION_INERTIALESS, test_count(400, 2000, 20000));
    check_interval(ELLIPSOID_MOTION_INERTIAL, test_count(400, 1000, 10000));
}

/* Where no wall is in range it is that of the interval's number, to the last
   bit; else of its start. */
static void test_numbers(void **unused)
{
    const ellipsoid_options o = near_wall(ELLIPSOID_MOTION_INERTIALESS, 1e-3);
    test_walk w = walk_over_wall(&o, 1, 7, 11e-6);
    ellipsoid_noise far, near;

    (void)unused;
    memset(&near, 0, sizeof(near));
    memset(&far, 0, sizeof(far));
    assert_ok(ellipsoid_noise_at(&w.model, &w.around, 0.0305, &far));
    begin_noise(&w, 0.0305, &no_load, &near);
    assert_memory_equal(&far, &near, sizeof(far));
    w.state.x[2] = 0.6e-6;
    begin_noise(&w, 0.0305, &no_load, &near);
    assert_true(near.near && near.start == 0.0305 && near.end <= far.end);
}

/* A cell at rest on a floor that ends under it, or on a block's edge, has a
   resistance that noise can be made of: R_w is positive definite where squeezing
   is gone, but the wall under the centre is not. */
static void test_past_rims(void **unused)
{
    static const double ratio[] = {0.34, 0.5, 1, 4, 7};
    const double low[3] = {-1e-4, -1e-4, -1e-4}, high[3] = {0, 1e-4, 0};
    static const int facets[] = {6, 24, 24};
    uint64_t seed = 31;
    wall_mesh walls[4];

    (void)unused;
    for (int k = 0; k < 4; k++)
    {
        arc shape = {k < 3 ? -1 : 1, k < 3 ? 2e-6 : 8e-6};

        wall_mesh_init(&walls[k]);
        if (k == 0)
        {
            wall_mesh_box(&walls[k], low, high, 0, 0, 0);
        }
        else
        {
            wall_mesh_grid(&walls[k], facets[k - 1], 3, bend, &shape, 2, 0);
        }
        wall_mesh_finish(&walls[k]);
    }
    for (int n = 0; n < 40000; n++)
    {
        ellipsoid_options o = near_wall(ELLIPSOID_MOTION_INERTIALESS, 1e-3);
        double r[3][3], square = 0;
        ellipsoid_noise noise;
        test_walk w;

        ellipsoid_set(o.semi_axes, 0.5e-6, 0.5e-6 * ratio[n % 5], 0.5e-6);
        w = walk_over_wall(&o, 1, (uint32_t)n, 0);
        w.around.walls_context = &walls[n / 5 % 4];
        test_orientation(&seed, w.state.q);
        ellipsoid_rotation(w.state.q, r);
        for (int i = 0; i < 3; i++)
        {
            square += pow(o.semi_axes[i] * r[2][i], 2);
        }
        ellipsoid_set(w.state.x, 3e-6 * test_signed(&seed), 0,
                      sqrt(square) + 1e-6 * pow(10, -3 * test_uniform(&seed)));
        begin_noise(&w, 0, &no_load, &noise);
    }
    for (int k = 0; k < 4; k++)
    {
        wall_mesh_free(&walls[k]);
    }
}

/* Nor is an interval shorter where the tip that is next to a floor is past its
   rim than where the floor goes on: there the tip moves more, with nothing
   across the gap. */
static void test_interval_past_a_rim(void **unused)
{
    static const double low[3] = {-1e-4, -1e-4, -1e-4};
    const ellipsoid_options o = near_wall(ELLIPSOID_MOTION_INERTIALESS, 1);
    const double axis[3] = {cos(0.3), 0, -sin(0.3)};
    double end[2];

    (void)unused;
    for (int n = 0; n < 2; n++)
    {
        const double high[3] = {n ? 1e-4 : 0, 1e-4, 0};
        test_walk w = walk_over_wall(&o, 1, 1, 0);
        ellipsoid_noise noise;
        wall_mesh block;

        wall_mesh_init(&block);
        wall_mesh_box(&block, low, high, 0, 0, 0);
        wall_mesh_finish(&block);
        w.around.walls_context = &block;
        ellipsoid_quaternion_from_axis(axis, 0, w.state.q);
        ellipsoid_set(w.state.x, -0.5e-6, 0, 0.82e-6);
        begin_noise(&w, 0, &no_load, &noise);
        end[n] = noise.end;
        wall_mesh_free(&block);
    }
    print_message("# interval past a rim %.2e s, beside a wall %.2e s\n",
                  end[0], end[1]);
    assert_true(end[0] > end[1]);
}

/* One and a half of the longest interval is two of the same length, as if the
   run had ended in the middle. */
static void test_even_intervals(void **unused)
{
    const ellipsoid_options o = near_wall(ELLIPSOID_MOTION_INERTIALESS, 1);
    test_walk whole = walk_over_wall(&o, 1, 7, 0.7e-6), parts = whole;
    ellipsoid_noise noise;
    double end;

    (void)unused;
    begin_noise(&whole, 0, &no_load, &noise);
    end = 1.5 * noise.end;
    assert_true(noise.near && end < 1);
    assert_ok(test_walk_to(&whole, end));
    assert_ok(test_walk_to(&parts, 0.5 * end));
    assert_ok(test_walk_to(&parts, end));
    for (int i = 0; i < 3; i++)
    {
        assert_near(whole.state.x[i], parts.state.x[i], 1e-15);
    }
}

/* Pressed to a wall, which pushes back, a body has the regular interval there. */
static void test_load(void **unused)
{
    static const double regular = 0.05;
    static const struct
    {
        double direction[3], energies, pushed, held;
    } loads[] = {{{0, 0, -1}, 2.51, 0.51, 1},
                 {{0, 0, -1}, 2.49, 1, 0},
                 {{0, 0, -1}, 1000, 0.49, 0},
                 {{0, 0, 1}, 1000, 1, 0},
                 {{1, 0, 0}, 1000, 1, 0}};
    const ellipsoid_options o = near_wall(ELLIPSOID_MOTION_INERTIAL, regular);
    const double gap = 50e-9; /* beyond the cut-off */

    (void)unused;
    for (size_t n = 0; n < sizeof(loads) / sizeof(*loads); n++)
    {
        test_walk w = walk_over_wall(&o, 1, 1, o.semi_axes[2] + gap);
        const double force = loads[n].energies * test_kt / gap;
        ellipsoid_noise noise;
        ellipsoid_load load;

        /* the length lies along y, and turned its load is another in its frame */
        ellipsoid_quaternion_from_axis((const double[3]){0.6, 0.8, 0}, 0.3,
                                       w.state.q);
        for (int i = 0; i < 3; i++)
        {
            load.force[i] = force * loads[n].direction[i];
            load.push[i] = -loads[n].pushed * load.force[i];
        }
        begin_noise(&w, 0, &load, &noise);
        assert_true(noise.near && (noise.end == regular) == loads[n].held);
    }
}

/* So a heavy sphere that lies on the wall takes a few steps in each interval; one
   that is pushed as hard by noise alone takes as many as its gap asks for. */
static void test_lying(void **unused)
{
    static const double weight[] = {40, 1}; /* times gap over kT */
    const double regular = 0.05, gap = 20e-9;
    long attempts[2];

    (void)unused;
    for (int n = 0; n < 2; n++)
    {
        ellipsoid_options o = near_wall(ELLIPSOID_MOTION_INERTIALESS, regular);
        test_walk w;
        double volume;

        o.contact = 1;
        o.buoyancy = 1;
        o.bead_count = 1;
        o.semi_axes[1] = o.semi_axes[0];
        o.bead_radius = o.semi_axes[0];
        o.tolerance = 1e-4;
        volume = 4 * test_pi / 3 * pow(o.semi_axes[0], 3);
        o.density = o.fluid_density
                  - weight[n] * test_kt / (gap * volume * o.gravity[2]);
        w = walk_over_wall(&o, 1, 5, o.semi_axes[2]);
        assert_ok(test_walk_to(&w, 10 * regular));
        attempts[n] = w.statistics.accepted + w.statistics.rejected;
    }
    print_message("# attempts in ten intervals: heavy %ld, light %ld\n",
                  attempts[0], attempts[1]);
    assert_true(attempts[0] < 300);
    assert_true(attempts[1] > 600);
}

static int not_asked(void *context, double t, const double centre[3],
                     double reach, ellipsoid_facet_list *list)
{
    (void)t;
    (void)centre;
    (void)reach;
    (void)list;
    *(int *)context = 1;
    return 0;
}

/* Walls are not asked about a place that is none. */
static void test_no_place(void **unused)
{
    const ellipsoid_options o = near_wall(ELLIPSOID_MOTION_INERTIALESS, 1e-3);
    test_walk w = walk_over_wall(&o, 1, 1, NAN);
    int asked = 0;

    (void)unused;
    w.around.walls = not_asked;
    w.around.walls_context = &asked;
    assert_int_equal(test_walk_to(&w, 1e-4), ELLIPSOID_BAD_STATE);
    assert_false(asked);
}

/* --------------------------------------------------------- equilibrium */

/*
    Heavy spheres over a soft wall, drawn from Boltzmann's distribution of height,
    whatever the mobility: 0.5 s later, in which a sphere moves by two scale
    heights far from the wall and by one near it, they still have it, by
    Kolmogorov & Smirnov's test at a significance of 1e-4. Without the drift
    they crowd at the wall.
*/
static void check_profile(ellipsoid_motion motion, int cells)
{
    static const test_row row = {
        "Brownian motion",
        "mean height over a wall, in standard errors",
        "heavy sphere, soft wall, wallResistance plane",
        "Boltzmann",
        "A",
        "5 sigma",
        0};
    const double dt = 4e-3;
    ellipsoid_options o = near_wall(motion, dt);
    double *height = calloc((size_t)cells, sizeof(*height)), distance;
    test_sample mean = {0};
    ellipsoid_model m;
    uint64_t seed = 12;
    long tried = 0;
    profile p;

    assert_non_null(height);
    o.contact = 1;
    o.buoyancy = 1;
    o.contact_modulus = 3.4;
    o.bead_count = 1;
    o.semi_axes[1] = o.semi_axes[0];
    o.bead_radius = radius;
    o.tolerance = 1e-4;
    o.density = o.fluid_density
              - test_kt
                    / (scale * 4 * test_pi / 3 * pow(o.semi_axes[0], 3)
                       * o.gravity[2]);
    m = test_model(&o);
    p = boltzmann(&m, 0, radius + 20 * scale);
    for (int id = 0; id < cells; id++)
    {
        const double part = test_uniform(&seed);
        int n = 0;
        test_walk w;

        while (n < CELLS && p.sum[n + 1] < part)
        {
            n++;
        }
        w = walk_over_wall(&o, 3, (uint32_t)id,
                           p.low + p.width * (n + test_uniform(&seed)));
        while (w.n < 125)
        {
            test_walk_on(&w);
        }
        height[id] = w.state.x[2];
        test_sample_add(&mean, height[id]);
        tried += w.statistics.accepted + w.statistics.rejected;
    }
    distance = test_kolmogorov(height, cells, height_distribution, &p);
    print_message("# %s, %d spheres: height %.4f +- %.4f of %.4f um, sqrt(n) D "
                  "= %.2f (2.225 allowed), %.2f steps an interval\n",
                  test_motion_name(motion), cells, 1e6 * mean.mean,
                  1e6 * test_sample_sigma(&mean), 1e6 * p.mean, distance,
                  (double)tried / cells / 125);
    free(height);
    assert_true(distance < 2.225);
    assert_row(&row, (mean.mean - p.mean) / test_sample_sigma(&mean), 0, 5);
}

static void test_profile(void **unused)
{
    (void)unused;
    check_profile(ELLIPSOID_MOTION_INERTIALESS, (int)test_count(20, 400, 6000));
    if (test_count(0, 0, 1))
    {
        check_profile(ELLIPSOID_MOTION_INERTIAL, 1000);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_interval),
        cmocka_unit_test(test_numbers),
        cmocka_unit_test(test_past_rims),
        cmocka_unit_test(test_interval_past_a_rim),
        cmocka_unit_test(test_even_intervals),
        cmocka_unit_test(test_load),
        cmocka_unit_test(test_lying),
        cmocka_unit_test(test_no_place),
        cmocka_unit_test(test_profile),
    };

    return cmocka_run_group_tests(tests, build_wall, free_wall);
}
