/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_brownianWall.c - Brownian motion over a wall that the body touches:
    Boltzmann's distribution of height and orientation.
    Processor time: 2, full 40
*/
#include "brownianWallTest.h"
#include "referenceSphere.h"

/* -------------------------------------------------------------- sphere */

/*
    A soft sphere: kT presses it in by 0.1 um, (2.5 kT/k)^(2/5). An interval
    moves it by 0.04 um, which by test_soft_wall_refinement makes the mean low
    by 0.3 (0.04/L)^2 L = 2.4 nm at most, a hundredth of the deviation. Heights
    relax with 4 L^2/D or faster (Risken, The Fokker-Planck Equation, 1989, of a
    constant force on a wall), from 3 L above the wall and for 9 of these times:
    exp(-9) of exp(1.5) is left. 1e-4 of L/2 = 0.1 um is the tolerance, less
    than a thousandth of the way of an interval.

    Cells are independent. Kolmogorov & Smirnov at a significance of 1e-4, c =
    2.225; the mean within 5 sigma of its known deviation. Both of the
    reference; the cells followed stay within 2e-3 L of it, 0.4 nm: 0.14 nm
    found, which the tolerance leaves.
*/
static void check_sphere(ellipsoid_motion motion, int cells, int followed)
{
    const double dt = interval_of(0.2 * scale);
    const int length =
        (int)(9 * 8 / (0.2 * 0.2)); /* 4 L^2/D is 8 L^2/way^2 dt */
    ellipsoid_options o = over_wall(motion, 1, 3.4, scale, dt);
    double *height = calloc((size_t)cells, sizeof(*height));
    static const test_row row = {
        "Brownian motion",
        "error of the mean height over a wall, over that allowed",
        "heavy sphere, soft wall, both motions",
        "Boltzmann",
        "A",
        "5 standard errors, and 2.4 nm by the interval",
        0};
    double distance, sigma, apart = 0;
    long tried = 0, touching = 0;
    test_sample sample = {0};
    ellipsoid_model m;
    profile p;

    o.tolerance = 1e-4;
    m = test_model(&o);
    p = boltzmann(&m, 0, radius + 20 * scale);
    assert_non_null(height);
    for (int id = 0; id < cells; id++)
    {
        const double start = radius + 3 * scale;
        test_walk w = walk_over_wall(&o, 31, (uint32_t)id, start);
        reference r = reference_of(o, 31, (uint32_t)id, start);

        for (int n = 0; n < length; n++)
        {
            reference_on(&r);
            if (id < followed)
            {
                test_walk_on(&w);
                apart = fmax(apart, fabs(w.state.x[2] - r.height));
            }
        }
        height[id] = r.height;
        test_sample_add(&sample, height[id]);
        tried += w.statistics.accepted + w.statistics.rejected;
        touching += height[id] < radius;
    }
    distance = test_kolmogorov(height, cells, height_distribution, &p);
    sigma = p.deviation / sqrt(cells);
    print_message(
        "# %s sphere, %d cells, dt = %.2e s: %.2f touch, mean %.4f of "
        "%.4f +- %.4f um, deviation %.4f of %.4f um, sqrt(n) D = %.2f "
        "(2.225 allowed); %d followed, %.2f steps an interval, never farther "
        "apart than %.5f L\n",
        test_motion_name(motion), cells, dt, (double)touching / cells,
        sample.mean / micron, p.mean / micron, sigma / micron,
        test_sample_sigma(&sample) * sqrt(cells) / micron, p.deviation / micron,
        distance, followed, (double)tried / followed / length, apart / scale);
    free(height);
    assert_true(touching > cells / 5); /* contact counts */
    assert_true(distance < 2.225);
    assert_row(&row, (sample.mean - p.mean) / (5 * sigma + 2.4e-9), 0, 1);
    assert_true(apart < 2e-3 * scale);
}

static void test_sphere_profile(void **unused)
{
    (void)unused;
    check_sphere(ELLIPSOID_MOTION_INERTIALESS, (int)test_count(300, 300, 2500),
                 (int)test_count(3, 30, 300));
    check_sphere(ELLIPSOID_MOTION_INERTIAL, (int)test_count(60, 60, 800),
                 (int)test_count(1, 10, 60));
}

/* ------------------------------------------------ refinement, hard wall */

/*
    On a hard wall (1 MPa: pressed in by 0.1 nm) a cell that is pushed against
    it waits there for the interval to end. With the same noise, heights at
    interval ends are those of Lindley's recursion h -> max(0, h + sigma n -
    sigma^2/(2 L)), sigma = sqrt(2 D dt), whose stationary mean is (Chang &
    Peres, Ann. Probab. 25, 787 (1997)) L + sigma zeta(1/2)/sqrt(2 pi) +
    sigma^2/(8 L) + O(sigma^3/L^2), zeta(1/2)/sqrt(2 pi) = -0.5826. So the
    profile converges with sqrt(dt).

    The mean of the cell's heights is compared with that of the recursion over
    the intervals followed: they differ by the depth and by what Simpson's rule
    makes of the turn of the force in an interval, phi^4/2880: 0.005 L is far
    more. The recursion's over all with the theory: 5 sigma; the mean over N intervals has a deviation of L
    sqrt(8/N) L/sigma, as a Brownian motion with drift above a wall stays
    correlated for 2 L^2/D (Abate & Whitt, Adv. Appl. Probab. 19, 560 (1987)).
*/
static void check_hard_wall(ellipsoid_motion motion, double part,
                            double tolerance, long count, long followed)
{
    const double way = part * scale;
    const double theory = scale - 0.582597 * way + way * way / (8 * scale);
    const double sigma = scale * sqrt(8 / (double)count) / part;
    ellipsoid_options o = over_wall(motion, 1, 1e6, scale, interval_of(way));
    static const test_row row = {
        "Brownian motion",
        "mean height over a hard wall less Lindley's, over kT/weight",
        "sphere, the same noise, intervals of three lengths",
        "Lindley's recursion",
        "A",
        "depth of contact, and the turn of the force in an interval",
        0};
    double height = 0, sum = 0, beside = 0, expected = 0;
    reference r = reference_of(o, 32, 1, radius);
    test_walk w;

    o.tolerance = tolerance;
    w = walk_over_wall(&o, 32, 1, radius);
    for (long n = 0; n < count; n++)
    {
        double push[3];

        reference_turn(&r, push);
        height = fmax(0, height + reference_mean(push) * o.noise_interval
                             - way * way / (2 * scale));
        expected += height / (double)count;
        if (n < followed)
        {
            test_walk_on(&w);
            beside += height / (double)followed;
            sum += (w.state.x[2] - radius) / (double)followed;
        }
    }
    print_message("# hard wall, %s, sqrt(2 D dt) = %.3f L (dt = %.1e s), "
                  "tolerance %.0e: mean height %.4f L, by Lindley %.4f, over "
                  "all %.4f, in the long run %.4f +- %.4f; %.1f + %.1f steps "
                  "an interval\n",
                  test_motion_name(motion), part, o.noise_interval, tolerance,
                  sum / scale, beside / scale, expected / scale, theory / scale,
                  sigma / scale,
                  (double)w.statistics.accepted / (double)followed,
                  (double)w.statistics.rejected / (double)followed);
    assert_row(&row, (sum - beside) / scale, 0, 0.005);
    /* measured: the third order is -0.01 (sigma/L)^3 L */
    assert_near(expected, theory, 5 * sigma + 0.02 * way * part * part);
}

static void test_hard_wall(void **unused)
{
    const long count = test_count(20000, 20000, 300000);
    const long n = test_count(500, 5000, 20000);

    (void)unused;
    check_hard_wall(ELLIPSOID_MOTION_INERTIALESS, 0.5, 1e-6, count, n);
    check_hard_wall(ELLIPSOID_MOTION_INERTIALESS, 0.25, 1e-6, count, n);
    check_hard_wall(ELLIPSOID_MOTION_INERTIALESS, 0.125, 1e-6, 2 * count,
                    2 * n);
    check_hard_wall(ELLIPSOID_MOTION_INERTIAL, 0.25, 1e-6, count, n);
}

/* The same at a loose tolerance: step control must not hold a cell on the
   wall. */
static void test_hard_wall_loosely(void **unused)
{
    const long count = test_count(20000, 20000, 300000);
    const long n = test_count(500, 5000, 20000);

    (void)unused;
    check_hard_wall(ELLIPSOID_MOTION_INERTIALESS, 0.25, 1e-4, count, n);
    check_hard_wall(ELLIPSOID_MOTION_INERTIAL, 0.25, 1e-4, count, n);
}

/*
    A sphere pressed on the wall by a force, which is then reversed: nothing
    holds it, and in one interval it goes where the drag lets it, F t/(mu K), to
    the tolerance and the depth it was pressed in (0.03 nm and less).
*/
static int lifts(ellipsoid_motion motion, double modulus, double tolerance)
{
    const double force = 1.4e-13, time = 4e-3;
    ellipsoid_options o = over_wall(motion, 1, modulus, scale, 1);
    double theory, height;
    test_walk w;

    o.brownian = 0;
    o.buoyancy = 0;
    o.tolerance = tolerance;
    o.external_force[2] = -force;
    w = walk_over_wall(&o, 1, 1, radius);
    assert_ok(test_walk_to(&w, 1));
    o.external_force[2] = force;
    w.model = test_model(&o);
    w.controller = (ellipsoid_controller){.step = time};
    assert_ok(test_walk_to(&w, 1 + time));
    theory = force * w.model.mobility[2] * time;
    height = w.state.x[2] - radius;
    print_message("# pulled off, %s, E* = %.0e Pa, tolerance %.0e: %.4f of "
                  "%.4f um, %ld + %ld steps in all\n",
                  test_motion_name(motion), modulus, tolerance, height / micron,
                  theory / micron, w.statistics.accepted,
                  w.statistics.rejected);
    return fabs(height - theory) <= 10 * tolerance * o.semi_axes[0] + 1e-10;
}

static void test_pulled_off(void **unused)
{
    int held = 0;

    (void)unused;
    for (double tolerance = 1e-8; tolerance < 5e-3; tolerance *= 100)
    {
        for (double modulus = 1e6; modulus < 5e9; modulus *= 1000)
        {
            held += !lifts(ELLIPSOID_MOTION_INERTIAL, modulus, tolerance);
            held += !lifts(ELLIPSOID_MOTION_INERTIALESS, modulus, tolerance);
        }
    }
    assert_int_equal(held, 0);
}

/* ------------------------------------------------------ the paper's cell */

/*
    32 beads, kT/weight = 0.3 um: it lies on the wall, on several beads, and
    rises on one end at times. One bead is pressed in by 0.1 um by kT; an
    interval of 4 ms moves the centre by 0.04 um and an end by 0.06 um. Heights
    relax with 4 L^2/D = 1.7 s. Started 2 um up, in any direction, and sampled
    from 12 s to 24 s: each cell is independent and gives one mean over time,
    and the scatter of these the deviation; its last height goes into
    Kolmogorov & Smirnov's test, at a significance of 1e-4.
*/
static void check_cell(ellipsoid_motion motion, double dt, int cells)
{
    ellipsoid_options o = over_wall(motion, 32, 4.6, 0.3 * micron, dt);
    const long half = lround(12 / dt);
    double *height = calloc((size_t)cells, sizeof(*height));
    static const test_row heights = {
        "Brownian motion",
        "mean height over a wall, in standard errors",
        "E. coli of 32 beads, soft wall",
        "Boltzmann",
        "A",
        "5 sigma",
        0};
    static const test_row turned = {
        "Brownian motion",
        "mean square of the axis along the normal, in standard errors",
        "E. coli of 32 beads, soft wall",
        "Boltzmann",
        "A",
        "5 sigma",
        0};
    double distance;
    long tried = 0;
    test_sample mean = {0}, upright = {0};
    uint64_t seed = 33;
    ellipsoid_model m;
    profile p;

    assert_non_null(height);
    o.tolerance = 1e-4;
    m = test_model(&o);
    p = boltzmann(&m, 0, 6 * micron);
    for (int id = 0; id < cells; id++)
    {
        test_walk w = walk_over_wall(&o, 34, (uint32_t)id, 2 * micron);
        double sum = 0, square = 0;

        test_orientation(&seed, w.state.q);
        for (long n = 0; n < 2 * half; n++)
        {
            test_walk_on(&w);
            if (n >= half)
            {
                double r[3][3];

                ellipsoid_rotation(w.state.q, r);
                sum += w.state.x[2];
                square += r[2][1] * r[2][1];
            }
        }
        height[id] = w.state.x[2];
        test_sample_add(&mean, sum / (double)half);
        test_sample_add(&upright, square / (double)half);
        tried += w.statistics.accepted + w.statistics.rejected;
    }
    distance = test_kolmogorov(height, cells, height_distribution, &p);
    print_message("# %s cell of 32 beads, %d, dt = %.0e s: height %.4f +- %.4f "
                  "of %.4f um, <O3^2> %.5f +- %.5f of %.5f, sqrt(n) D = %.2f "
                  "(2.225 allowed), %.2f steps an interval\n",
                  test_motion_name(motion), cells, dt, mean.mean / micron,
                  test_sample_sigma(&mean) / micron, p.mean / micron,
                  upright.mean, test_sample_sigma(&upright), p.upright,
                  distance, (double)tried / cells / (double)(2 * half));
    free(height);
    assert_true(distance < 2.225);
    assert_row(&heights, (mean.mean - p.mean) / test_sample_sigma(&mean), 0, 5);
    assert_row(&turned,
               (upright.mean - p.upright) / test_sample_sigma(&upright), 0, 5);
}

static void test_cell_profile(void **unused)
{
    (void)unused;
    check_cell(ELLIPSOID_MOTION_INERTIALESS, 4e-3, (int)test_count(4, 30, 500));
    if (test_count(0, 0, 1))
    {
        check_cell(ELLIPSOID_MOTION_INERTIALESS, 1e-3, 100);
        check_cell(ELLIPSOID_MOTION_INERTIAL, 4e-3, 100);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sphere_profile),
        cmocka_unit_test(test_hard_wall),
        cmocka_unit_test(test_hard_wall_loosely),
        cmocka_unit_test(test_pulled_off),
        cmocka_unit_test(test_cell_profile),
    };

    return cmocka_run_group_tests(tests, build_wall, free_wall);
}
