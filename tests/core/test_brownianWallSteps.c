/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_brownianWallSteps.c - Brownian motion over a wall that the body touches:
    how it depends on intervals and steps.
    Processor time: 1, full 14
*/
#include "brownianWallTest.h"
#include "referenceSphere.h"

/* ------------------------------------------------ refinement, soft wall */

/* Cells are independent: each gives the reference's mean over time after 12
   relaxation times, and their scatter the deviation. apart: the mean of those
   followed less that of their references. */
static test_sample mean_height(const ellipsoid_options *o, double way,
                               int followed, long length, test_sample *apart)
{
    const long before = (long)(12 * 8 * scale * scale / (way * way));
    test_sample sample = {0};

    *apart = sample;
    for (int id = 0; id < 40; id++)
    {
        const double start = radius + scale;
        test_walk w = walk_over_wall(o, 36, (uint32_t)id, start);
        reference r = reference_of(*o, 36, (uint32_t)id, start);
        double sum = 0, off = 0;

        for (long n = -before; n < length; n++)
        {
            reference_on(&r);
            sum += n >= 0 ? r.height - radius : 0;
            if (id < followed)
            {
                test_walk_on(&w);
                off += n >= 0 ? w.state.x[2] - r.height : 0;
            }
        }
        test_sample_add(&sample, sum / (double)length);
        if (id < followed)
        {
            test_sample_add(apart, off / (double)length);
        }
    }
    return sample;
}

/*
    Where kT presses the sphere in by 0.5 L (3.4 Pa) the mean height is that of
    Boltzmann once an interval's way is short against it; before, it is lower,
    and by less than half as much when the way is halved: better than on a hard
    wall. In the long run 0.8 L and 0.4 L are off by 0.26 (sigma/L)^2: of the
    finest 0.3 (sigma/L)^2 is allowed, and 5 sigma.
*/
static void test_soft_wall_refinement(void **unused)
{
    const long length = test_count(1000, 1000, 20000);
    const int followed = (int)test_count(2, 4, 4);
    double before = 0;

    (void)unused;
    for (double part = 1.6; part > 0.19; part /= 2)
    {
        const double way = part * scale;
        ellipsoid_options o = over_wall(ELLIPSOID_MOTION_INERTIALESS, 1, 3.4,
                                        scale, interval_of(way));
        test_sample sample, apart;
        ellipsoid_model m;
        double sigma, off;
        profile p;

        m = test_model(&o);
        p = boltzmann(&m, 0, radius + 20 * scale);
        sample = mean_height(&o, way, followed, length, &apart);
        sigma = test_sample_sigma(&sample) / scale;
        off = (sample.mean + apart.mean - (p.mean - radius)) / scale;
        print_message("# soft wall, sqrt(2 D dt) = %.2f L (dt = %.1e s): mean "
                      "height off by %.4f +- %.4f L, %.1e +- %.1e L from the "
                      "reference\n",
                      part, o.noise_interval, off, sigma, apart.mean / scale,
                      test_sample_sigma(&apart) / scale);
        assert_true(test_sample_sigma(&apart) / scale < 0.2 * sigma);
        if (before < 0)
        {
            assert_true(fabs(off) < 0.5 * fabs(before) + 5 * sigma);
        }
        before = off;
        if (part < 0.21)
        {
            assert_near(off, 0, 5 * sigma + 0.3 * part * part);
        }
    }
}

/* --------------------------------------------------------------- steps */

/*
    Resting on a wall, pressed by 1 and 10 pN (the drag of 0.1 and 1 mm/s on the
    paper's cell; the noise has 0.3 pN), at the default interval, tolerance and
    modulus. A free cell takes one step an interval (test_brownianPath.c). Here
    the noise shifts the depth by some 1e-11 m, less than the tolerance, but
    rocks the cell from bead to bead: 1 to 9 steps were found, rejected ones
    included, and no interval that took forty (90 where steps threw the cell off
    and it landed again).
*/
static double steps_an_interval(ellipsoid_motion motion, int beads,
                                double force)
{
    const long count = test_count(300, 3000, 3000);
    ellipsoid_options o = over_wall(motion, beads, 1e6, scale, 1e-3);
    long worst = 0, before = 0, tried = 0;
    test_walk w;

    o.buoyancy = 0;
    o.density = 1040;
    o.external_force[2] = -force;
    o.tolerance = ellipsoid_options_default().tolerance;
    w = walk_over_wall(&o, 35, 1, 0.5 * micron);
    for (long n = 0; n < count; n++)
    {
        test_walk_on(&w);
        tried = w.statistics.accepted + w.statistics.rejected;
        worst = worst > tried - before ? worst : tried - before;
        before = tried;
    }
    print_message("# %s, %2d beads, pressed by %.0e N: %.2f + %.2f steps an "
                  "interval, at most %ld\n",
                  test_motion_name(motion), beads, force,
                  (double)w.statistics.accepted / (double)count,
                  (double)w.statistics.rejected / (double)count, worst);
    assert_true(worst < 60);
    return (double)tried / (double)count;
}

static void test_steps(void **unused)
{
    double most = 0;

    (void)unused;
    for (int k = 0; k < 2; k++)
    {
        const ellipsoid_motion motion =
            k ? ELLIPSOID_MOTION_INERTIALESS : ELLIPSOID_MOTION_INERTIAL;

        most = fmax(most, steps_an_interval(motion, 1, 1e-11));
        most = fmax(most, steps_an_interval(motion, 1, 1e-12));
        most = fmax(most, steps_an_interval(motion, 32, 1e-11));
        most = fmax(most, steps_an_interval(motion, 32, 1e-12));
    }
    assert_true(most <= 15);
}

/* How deep a load presses a bead in. */
static double overlap_at_rest(const ellipsoid_options *o, double load)
{
    return pow(0.75 * load / o->contact_modulus / sqrt(o->bead_radius),
               2.0 / 3);
}

/*
    However stiff the wall, the noise presses a sphere in by what its force
    does: the force has 0.3 pN, pressed by 10 pN, so that in 1000 intervals the
    overlap exceeds that at rest by (1 + 4 0.03)^(2/3) at most, 8 %. (At 1e12 Pa
    it would be 5e-15 m, a ten-thousandth of the tolerance.)
*/
static void test_stiff_wall(void **unused)
{
    (void)unused;
    for (int k = 0; k < 3; k++)
    {
        const double modulus = pow(10, 6 + 2 * k), force = 1e-11;
        ellipsoid_options o =
            over_wall(ELLIPSOID_MOTION_INERTIAL, 1, modulus, scale, 1e-3);
        const double rest = overlap_at_rest(&o, force);
        test_walk w;

        o.buoyancy = 0;
        o.density = 1040;
        o.external_force[2] = -force;
        w = walk_over_wall(&o, 37, 1, o.bead_radius - rest);
        for (int n = 0; n < 1000; n++)
        {
            test_walk_on(&w);
        }
        print_message("# %.0e Pa: deepest overlap %.3f of that at rest\n",
                      modulus, w.statistics.deepest / rest);
        assert_true(w.statistics.deepest < 1.08 * rest);
    }
}

/* A cell with friction that a load presses to the wall. */
static ellipsoid_options pressed(ellipsoid_motion motion, double tolerance,
                                 double load)
{
    ellipsoid_options o = over_wall(motion, 32, 1e6, scale, 5e-3);

    o.buoyancy = 0;
    o.density = 1040;
    o.friction = 0.3;
    o.slip_speed = 1e-7;
    o.wall_resistance = ELLIPSOID_WALL_RESISTANCE_PLANE;
    o.tolerance = tolerance;
    o.external_force[2] = -load;
    return o;
}

/* And that is pulled along the wall, by half of what friction bears. */
static test_walk held_cell(ellipsoid_motion motion, double tolerance,
                           double load)
{
    ellipsoid_options o = pressed(motion, tolerance, load);

    o.external_force[0] = 0.15 * load;
    o.external_force[1] = 0.05 * load;
    return walk_over_wall(&o, 77, 3, 0.5 * micron);
}

static test_walk held_by_friction(ellipsoid_motion motion, double tolerance,
                                  double load, long count)
{
    test_walk w = held_cell(motion, tolerance, load);

    for (long n = 0; n < count; n++)
    {
        test_walk_on(&w);
    }
    return w;
}

/* |q - p| */
static double turned(const ellipsoid_state *one, const ellipsoid_state *other)
{
    double change[4];

    for (int n = 0; n < 4; n++)
    {
        change[n] = one->q[n] - other->q[n];
    }
    return sqrt(ellipsoid_square4(change));
}

/*
    A cell that friction holds while a load presses it to the wall, and a pull of
    half of what friction bears acts along it: each interval of the noise is one
    step in most cases, or a few, where small tolerances take a dozen and more; and
    the cell is where they lead, to the tolerance.
*/
static void check_rests(ellipsoid_motion motion)
{
    const double load = 32e-12, tolerance = 1e-3, length = 2 * micron;
    const long count = test_count(100, 400, 400);
    const test_walk rough = held_by_friction(motion, tolerance, load, count);
    const test_walk fine = held_by_friction(motion, 1e-6, load, count);
    const long attempts = rough.statistics.accepted + rough.statistics.rejected;
    const double turn = turned(&rough.state, &fine.state);
    double apart[3];

    ellipsoid_difference(rough.state.x, fine.state.x, apart);
    print_message(
        "# held by friction: %.1f attempted steps an interval in place "
        "of %.1f, %.2f nm and %.1e apart after %.2f um\n",
        (double)attempts / (double)count,
        (double)(fine.statistics.accepted + fine.statistics.rejected)
            / (double)count,
        ellipsoid_length(apart) / 1e-9, turn, fine.state.x[0] / micron);
    assert_true(attempts < 5 * count);
    assert_true(ellipsoid_length(apart) < tolerance * length);
    assert_true(turn < tolerance);
}

static void test_rests(void **unused)
{
    (void)unused;
    check_rests(ELLIPSOID_MOTION_INERTIAL);
    check_rests(ELLIPSOID_MOTION_INERTIALESS);
}

/* What depends on time is followed; and one step of an interval counts as one of
   those allowed. */
static void test_rests_are_limited(void **unused)
{
    const double load = 32e-12;
    const long count = 40;
    test_walk w = held_cell(ELLIPSOID_MOTION_INERTIAL, 1e-3, load);

    (void)unused;
    w.around.unsteady = 1;
    for (long n = 0; n < count; n++)
    {
        test_walk_on(&w);
    }
    assert_true(w.statistics.accepted > 8 * count);

    w = held_cell(ELLIPSOID_MOTION_INERTIAL, 1e-3, load);
    w.model.options.maximum_steps = 30;
    assert_int_equal(test_walk_to(&w, 1), ELLIPSOID_TOO_MANY_STEPS);
    assert_int_equal(w.statistics.accepted + w.statistics.rejected, 30);
}

/*
    A cell that stands upright on the wall falls, though one implicit step would
    leave it there: at 1 K the noise alone takes long to. Each interval leads where
    small steps do, of which the rough ones are a few tolerances off as it falls.
*/
static void test_upright_falls(void **unused)
{
    const double load = 100e-12, tolerance = 1e-3;
    ellipsoid_options o = pressed(ELLIPSOID_MOTION_INERTIAL, 1e-5, load);
    static ellipsoid_facet_cache own;
    double worst = 0, axis[3];
    test_walk w, fine;

    (void)unused;
    o.contact_shape = ELLIPSOID_CONTACT_ELLIPSOID;
    o.temperature = 1;
    fine = walk_over_wall(&o, 50, 1, 2 * micron);
    o.tolerance = tolerance;
    w = walk_over_wall(&o, 50, 1, 2 * micron - overlap_at_rest(&o, load));
    w.state.q[0] = w.state.q[3] = sqrt(0.5);
    ellipsoid_facet_cache_clear(&own);
    fine.cache = &own;
    for (int n = 0; n < 100; n++)
    {
        fine.state = w.state;
        fine.controller = (ellipsoid_controller){0};
        test_walk_on(&w);
        test_walk_on(&fine);
        worst = fmax(worst, turned(&w.state, &fine.state) / tolerance);
    }
    test_long_axis(&w.state, axis);
    print_message(
        "# upright: axis at %.3f of upright, an interval off by at most "
        "%.2f tolerances\n",
        fabs(axis[2]), worst);
    assert_true(fabs(axis[2]) < 0.5);
    assert_true(worst < 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_soft_wall_refinement),
        cmocka_unit_test(test_steps),
        cmocka_unit_test(test_stiff_wall),
        cmocka_unit_test(test_rests),
        cmocka_unit_test(test_rests_are_limited),
        cmocka_unit_test(test_upright_falls),
    };

    return cmocka_run_group_tests(tests, build_wall, free_wall);
}
