/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_brownian.c - Brownian motion of a free cell: equilibrium and diffusion.
    Processor time: 1, full 9
*/
#include "brownianTest.h"

static const char *const direction[6] = {"u^1", "u^2", "u^3",
                                         "w^1", "w^2", "w^3"};

/* ------------------------------------------------------- one interval */

/* u and omega along the body's axes. */
static void speeds(const ellipsoid_state *state, double v[6])
{
    test_in_body(state, state->u, v);
    memcpy(v + 3, state->omega, sizeof(state->omega));
}

/*
    The body turns in an interval, by angles and with gyroscopic terms
    proportional to sqrt(T): at 1e-7 K the turn in 1000 tau is 2e-7. That times two normal
    numbers is the error, in units of the standard deviations of b and b dt:
    1e-6 is allowed. Above 30 tau the layer is crossed in one go, which is exact
    here.
*/
static void check_interval(double per_tau)
{
    ellipsoid_options o = test_brownian(ELLIPSOID_MOTION_INERTIAL, 1);
    const double slowest = test_model(&o).relaxation_time;
    double worst = 0;
    test_walk w;

    o.noise_interval = per_tau * slowest;
    o.temperature = 1e-7;
    o.tolerance = 1e-14;
    w = test_walk_of(&o, 1, 1);
    for (int n = 0; n < 40; n++)
    {
        const ellipsoid_state before = w.state;
        const double dt = o.noise_interval;
        double normal[6], moved[6], v[6], exact[6], x[6];

        ellipsoid_random_normal(1, 1, n, normal);
        speeds(&before, exact);
        test_closed_form(&w.model, normal, exact, x);
        test_walk_on(&w);
        test_moved(&before, &w.state, moved);
        speeds(&w.state, v);
        for (int i = 0; i < 6; i++)
        {
            const double scale = sqrt(2 * test_kt / 298.15 * o.temperature
                                      * test_mobility(&w.model, i) / dt);

            worst = fmax(worst, fabs(v[i] - exact[i]) / scale);
            worst = fmax(worst, fabs(moved[i] - x[i]) / (scale * dt));
        }
    }
    print_message("# dt = %g tau: worst of 40 intervals %.1e\n", per_tau,
                  worst);
    assert_true(worst <= 1e-6);
}

static void test_one_interval(void **unused)
{
    (void)unused;
    check_interval(0.1);
    check_interval(1);
    check_interval(10);
    check_interval(31);
    check_interval(1000);
}

/* -------------------------------------------------------- equilibrium */

/*
    The closed form, squared and averaged, F independent of v0:
        <v^2> (1 - exp(-2 s)) = <b^2> (1 - exp(-s))^2, <b^2> = 2 kT/(zeta dt),
        <v^2> = (2 kT/(zeta dt)) tanh(s/2) = (kT/m) (2 tau/dt) tanh(dt/(2 tau)),
    equipartition for dt -> 0. v is a Gaussian series of correlation exp(-s n):
    that of v^2 is exp(-2 s n), so that N samples count for N tanh(s), and the
    mean of their squares has the relative deviation sqrt(2/(N tanh(s))). At 0.1
    tau the formula is 0.08 % below equipartition, at tau 8 %, at 10 tau a fifth
    of it. 3 dt times 6 directions within 5 sigma: a right program fails by
    chance with 1e-5.

    <v^2> is the mean of the closed form over all samples, and the mean
    difference of the cell's from it, with the same noise, over those followed:
    a control variate (Glasserman, Monte Carlo Methods in Financial Engineering,
    4.1, 2003). In a tau the body turns by some 1e-4, so that the difference
    scatters by less than a hundredth of v^2 and adds nothing to the deviation.
*/
static void check_equilibrium(double per_tau, long count, long followed)
{
    static const test_row row = {
        "Brownian motion",
        "mean square of the velocities, in standard errors",
        "six directions; intervals of 0.1, 1 and 10 relaxation times",
        "equipartition, with the interval",
        "A",
        "5 sigma of a fixed seed",
        0};
    ellipsoid_options o = test_brownian(ELLIPSOID_MOTION_INERTIAL, 1);
    const double slowest = test_model(&o).relaxation_time;
    double sum[6] = {0}, exact[6] = {0}, x[6];
    test_sample apart[6] = {{0}};
    test_walk w;

    o.noise_interval = per_tau * slowest;
    o.tolerance = 1e-6;
    w = test_walk_of(&o, 2, 1);
    for (long n = -200; n < count; n++)
    {
        double normal[6], v[6] = {0};

        ellipsoid_random_normal(2, 1, n + 200, normal);
        test_closed_form(&w.model, normal, exact, x);
        if (n < followed)
        {
            test_walk_on(&w);
            speeds(&w.state, v);
        }
        for (int i = 0; n >= 0 && i < 6; i++)
        {
            sum[i] += exact[i] * exact[i] / (double)count;
            if (n < followed)
            {
                test_sample_add(&apart[i], v[i] * v[i] - exact[i] * exact[i]);
            }
        }
    }
    for (int i = 0; i < 6; i++)
    {
        const double tau =
            test_inertia(&w.model, i) * test_mobility(&w.model, i);
        const double s = o.noise_interval / tau;
        const double theory =
            test_kt / test_inertia(&w.model, i) * 2 / s * tanh(s / 2);
        const double sigma = sqrt(2 / ((double)count * tanh(s)));
        const double ratio = (sum[i] + apart[i].mean) / theory;

        print_message("# dt = %.3g tau: <(%s)^2> %.4f of kT/m, %.4f +- %.4f of "
                      "theory, %.1e +- %.1e apart from the closed form\n",
                      s, direction[i], ratio * 2 / s * tanh(s / 2), ratio,
                      sigma, apart[i].mean / theory,
                      test_sample_sigma(&apart[i]) / theory);
        assert_row(&row, (ratio - 1) / sigma, 0, 5);
        assert_true(test_sample_sigma(&apart[i]) / theory < 0.2 * sigma);
        /* by the step control's errors, 3e-4 found */
        assert_near(apart[i].mean / theory, 0, 1e-3);
    }
}

static void test_equilibrium(void **unused)
{
    const long count = test_count(150000, 150000, 3000000);
    const long followed = test_count(3000, 30000, 150000);

    (void)unused;
    check_equilibrium(0.1, count, followed);
    check_equilibrium(1, count, followed);
    /* two steps and more an interval */
    check_equilibrium(10, count / 4, followed / 4);
}

/* ---------------------------------------------------------- diffusion */

/*
    The displacement in N intervals is the sum of b dt less tau (v_N - v_0).
    With D = kT/zeta, <b dt . v_N> summed is 2 D (1 - exp(-N s)), so <x^2> = 2 D
    t - 2 tau (2 D - tau <v^2>) (1 - exp(-t/tau)), Ornstein & Fuerth's for dt ->
    0; without inertia tau is 0. A block's x is Gaussian, and two blocks in a
    row are correlated by less than tau/t: the relative deviation of <x^2> over
    n blocks is sqrt(2/n).
*/
static double mean_square(const ellipsoid_model *m, int i, double dt, double t)
{
    const double d = test_kt * test_mobility(m, i);
    const double tau = test_inertia(m, i) * test_mobility(m, i);
    const double tau_v2 = 2 * d * tau / dt * tanh(dt / (2 * tau));

    return m->options.motion == ELLIPSOID_MOTION_INERTIAL
             ? 2 * d * t - 2 * tau * (2 * d - tau_v2) * (1 - exp(-t / tau))
             : 2 * d * t;
}

/* One interval of it, with the noise of test_walk_of(..., seed, 1). */
static void add_closed_form(const ellipsoid_model *m, uint64_t seed,
                            long interval, double v[6], double x[6])
{
    double normal[6], moved[6];

    ellipsoid_random_normal(seed, 1, interval, normal);
    test_closed_form(m, normal, v, moved);
    for (int i = 0; i < 6; i++)
    {
        x[i] += moved[i];
    }
}

/*
    The mean of the closed form's x^2 over all blocks and, of those followed, the
    difference of the cell's with the same noise. It scatters by the turn in a
    block, 0.03 and less.
*/
static void check_diffusion(ellipsoid_motion motion, double dt, int length,
                            long blocks, long followed)
{
    static const test_row inertial = {
        "Brownian motion",
        "mean square displacement, in standard errors",
        "six directions, with inertia",
        "Ornstein & Fuerth, with the interval",
        "A",
        "5 sigma of a fixed seed",
        0};
    static const test_row without = {
        "Brownian motion",
        "mean square displacement, in standard errors",
        "six directions, without inertia",
        "2 D t",
        "A",
        "5 sigma of a fixed seed",
        0};
    const ellipsoid_options o = test_brownian(motion, dt);
    test_walk w = test_walk_of(&o, 3, 1);
    double sum[6] = {0}, v[6] = {0};
    test_sample apart[6] = {{0}};
    long interval = 0;

    for (; interval < 200; interval++)
    {
        double x[6] = {0};

        add_closed_form(&w.model, 3, interval, v, x);
        test_walk_on(&w);
    }
    for (long n = 0; n < blocks; n++)
    {
        const ellipsoid_state before = w.state;
        double moved[6], exact[6] = {0};

        for (int k = 0; k < length; k++, interval++)
        {
            add_closed_form(&w.model, 3, interval, v, exact);
            if (n < followed)
            {
                test_walk_on(&w);
            }
        }
        test_moved(&before, &w.state, moved);
        for (int i = 0; i < 6; i++)
        {
            const double square = exact[i] * exact[i];

            sum[i] += square / (double)blocks;
            if (n < followed)
            {
                test_sample_add(&apart[i], moved[i] * moved[i] - square);
            }
        }
    }
    for (int i = 0; i < 6; i++)
    {
        const double t = length * dt;
        const double d = test_kt * test_mobility(&w.model, i);
        const double theory = mean_square(&w.model, i, dt, t);
        const double sigma = sqrt(2 / (double)blocks);
        const double ratio = (sum[i] + apart[i].mean) / theory;

        print_message("# %s, dt = %.1e s, %2d intervals, %s: <x^2>/2t = %.4e, "
                      "%.4f +- %.4f of theory, which is %.3f D, %.1e +- %.1e "
                      "apart from the closed form\n",
                      test_motion_name(motion), dt, length, direction[i],
                      ratio * theory / (2 * t), ratio, sigma,
                      theory / (2 * d * t), apart[i].mean / theory,
                      test_sample_sigma(&apart[i]) / theory);
        assert_row(motion == ELLIPSOID_MOTION_INERTIAL ? &inertial : &without,
                   (ratio - 1) / sigma, 0, 5);
        assert_true(test_sample_sigma(&apart[i]) / theory < 0.2 * sigma);
    }
}

static void test_diffusion(void **unused)
{
    const long blocks = test_count(100000, 100000, 700000);
    const long followed = test_count(2000, 20000, 100000);
    const ellipsoid_options o = test_brownian(ELLIPSOID_MOTION_INERTIAL, 1e-3);
    const ellipsoid_model m = test_model(&o);

    (void)unused;
    /* Perrin's (1934) of the paper's cell, to the digits given */
    assert_near(test_kt * m.mobility[1], 2.733e-13, 0.0005e-13);
    assert_near(test_kt * m.mobility[0], 2.124e-13, 0.0005e-13);
    assert_near(test_kt * m.rotation_mobility[0], 0.0965, 0.00005);
    assert_near(test_kt * m.rotation_mobility[1], 0.454, 0.0005);
    /* the body turns by 0.03 in an interval: <x^2> along its first axes is less
       by 1e-4 of itself */
    check_diffusion(ELLIPSOID_MOTION_INERTIALESS, 1e-3, 1, blocks, followed);
    check_diffusion(ELLIPSOID_MOTION_INERTIAL, 1e-3, 1, blocks, followed);
    check_diffusion(ELLIPSOID_MOTION_INERTIAL, 0.5 * m.relaxation_time, 20,
                    blocks / 10, followed / 10);
}

/* -------------------------------------------------------------- drift */

/*
    The step control sees the noise, and must not prefer any of it: a triaxial
    body, intervals of about 10 tau in which it follows the layer, by several
    steps or by one, and intervals of one step in which the body turns by 0.03
    and 0.1. The displacement of a block is a sum of independent normal numbers
    of known variance: the mean is 0 within 5 sqrt(2 D t/n), <x^2> that of
    check_diffusion() within 5 sqrt(2/n) of itself and 1.5 of the first order in
    dt. 60 numbers within 5 sigma each. A step's error may be far above an
    interval's displacement at 1e-2, but what is left out of it stays in u and
    comes later: blocks of 20 of the shortest intervals. Both are means of the
    closed form over all blocks and, of those followed, of the difference from
    it, which scatters by the turn.
*/
static void check_drift(ellipsoid_motion motion, double dt, int length,
                        long blocks, long followed)
{
    static const test_row row = {
        "Brownian motion",
        "mean displacement, in standard errors",
        "triaxial body, tolerances 1e-2 and 1e-6, both motions",
        "no drift",
        "A",
        "5 sigma of a fixed seed",
        0};
    static const double tolerances[2] = {1e-2, 1e-6};
    const double t = length * dt;
    ellipsoid_options o = test_brownian(motion, dt);

    o.semi_axes[2] = 1e-6;
    for (int k = 0; k < 2; k++)
    {
        test_sample sample[6] = {{0}}, apart[6] = {{0}}, squares[6] = {{0}};
        double worst = 0, most = 0, steps, v[6] = {0};
        test_walk w;

        o.tolerance = tolerances[k];
        w = test_walk_of(&o, 6, 1);
        for (long n = 0; n < blocks; n++)
        {
            const ellipsoid_state before = w.state;
            double moved[6], exact[6] = {0};

            for (int l = 0; l < length; l++)
            {
                add_closed_form(&w.model, 6, n * length + l, v, exact);
                if (n < followed)
                {
                    test_walk_on(&w);
                }
            }
            test_moved(&before, &w.state, moved);
            for (int i = 0; i < 6; i++)
            {
                test_sample_add(&sample[i], exact[i]);
                if (n < followed)
                {
                    test_sample_add(&apart[i], moved[i] - exact[i]);
                    test_sample_add(&squares[i],
                                    moved[i] * moved[i] - exact[i] * exact[i]);
                }
            }
        }
        for (int i = 0; i < 6; i++)
        {
            const double d = test_kt * test_mobility(&w.model, i);
            const double theory = mean_square(&w.model, i, dt, t);
            const double ratio =
                (sample[i].squares / (double)blocks + squares[i].mean) / theory;
            const double turn =
                test_kt
                * (test_mobility(&w.model, 3) + test_mobility(&w.model, 4)
                   + test_mobility(&w.model, 5))
                / 6 * dt;
            const double mean = (sample[i].mean + apart[i].mean)
                              / sqrt(2 * d * t / (double)blocks);

            worst = fmax(worst, fabs(mean));
            most = fmax(most, fabs(ratio - 1));
            assert_row(&row, mean, 0, 5);
            assert_near(ratio, 1, 5 * sqrt(2 / (double)blocks) + 1.5 * turn);
            assert_true(test_sample_sigma(&squares[i]) / theory
                        < 0.25 * sqrt(2 / (double)blocks));
        }
        steps = (double)(followed * length);
        print_message("# %s, dt = %.0e s, tolerance %.0e: %.2f + %.2f steps an "
                      "interval, mean within %.1f sigma, <x^2> within %.4f "
                      "(sigma %.4f)\n",
                      test_motion_name(motion), dt, o.tolerance,
                      (double)w.statistics.accepted / steps,
                      (double)w.statistics.rejected / steps, worst, most,
                      sqrt(2 / (double)blocks));
    }
}

static void test_no_drift(void **unused)
{
    const long blocks = test_count(40000, 40000, 500000);
    const long followed = test_count(4000, 10000, 80000);

    (void)unused;
    check_drift(ELLIPSOID_MOTION_INERTIAL, 2e-6, 20, blocks / 10,
                followed / 10);
    check_drift(ELLIPSOID_MOTION_INERTIAL, 1e-3, 1, blocks, followed);
    check_drift(ELLIPSOID_MOTION_INERTIAL, 0.02, 1, blocks, followed);
    check_drift(ELLIPSOID_MOTION_INERTIALESS, 1e-3, 1, blocks, followed);
    check_drift(ELLIPSOID_MOTION_INERTIALESS, 0.02, 1, blocks, followed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_interval),
        cmocka_unit_test(test_equilibrium),
        cmocka_unit_test(test_diffusion),
        cmocka_unit_test(test_no_drift),
    };

    return cmocka_run_group_tests_name("brownian", tests, NULL, NULL);
}
