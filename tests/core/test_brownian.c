/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    test_brownian.c - Brownian motion of a free cell: equilibrium and diffusion.
*/
#include "brownianTest.h"

static const char *const direction[6] = {"u^1", "u^2", "u^3",
                                         "w^1", "w^2", "w^3"};

/* ------------------------------------------------------- one interval */

/*
    With a force F of variance 2 kT zeta/dt, constant over an interval, and
    zeta = m/tau, m dv/dt = F - zeta v is solved by (s = dt/tau, b = F/zeta)
        v(dt) = b + (v0 - b) exp(-s),
        x(dt) = b dt + tau (v0 - b) (1 - exp(-s)),
    for each of the six directions with its own tau. The body turns meanwhile,
    by angles and with gyroscopic terms proportional to sqrt(T): at 1e-7 K the
    turn in 1000 tau is 2e-7. That times two normal numbers is the error, in
    units of the standard deviations of b and b dt: 1e-6 is allowed. Above 30
    tau the layer is crossed in one go, which is exact here.
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
        double normal[6], moved[6], v0[6], v[6];

        ellipsoid_random_normal(1, 1, n, normal);
        test_walk_on(&w);
        test_moved(&before, &w.state, moved);
        test_in_body(&before, before.u, v0);
        test_in_body(&w.state, w.state.u, v);
        memcpy(v0 + 3, before.omega, sizeof(before.omega));
        memcpy(v + 3, w.state.omega, sizeof(w.state.omega));
        for (int i = 0; i < 6; i++)
        {
            const double zeta = 1 / test_mobility(&w.model, i);
            const double tau = test_inertia(&w.model, i) / zeta;
            const double scale =
                sqrt(2 * test_kt / 298.15 * o.temperature / (zeta * dt));
            const double b = scale * normal[i], decay = exp(-dt / tau);
            const double x = b * dt + tau * (v0[i] - b) * (1 - decay);

            worst = fmax(worst, fabs(v[i] - b - (v0[i] - b) * decay) / scale);
            worst = fmax(worst, fabs(moved[i] - x) / (scale * dt));
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
    The solution above, squared and averaged, F independent of v0:
        <v^2> (1 - exp(-2 s)) = <b^2> (1 - exp(-s))^2, <b^2> = 2 kT/(zeta dt),
        <v^2> = (2 kT/(zeta dt)) tanh(s/2) = (kT/m) (2 tau/dt) tanh(dt/(2 tau)),
    equipartition for dt -> 0. v is a Gaussian series of correlation exp(-s n):
    that of v^2 is exp(-2 s n), so that N samples count for N tanh(s), and the
    mean of their squares has the relative deviation sqrt(2/(N tanh(s))). At 0.1
    tau the formula is 0.08 % below equipartition, at tau 8 %, at 10 tau a fifth
    of it. 3 dt times 6 directions within 5 sigma: a right program fails by
    chance with 1e-5.
*/
static void check_equilibrium(double per_tau, long count)
{
    ellipsoid_options o = test_brownian(ELLIPSOID_MOTION_INERTIAL, 1);
    const double slowest = test_model(&o).relaxation_time;
    double sum[6] = {0};
    test_walk w;

    o.noise_interval = per_tau * slowest;
    w = test_walk_of(&o, 2, 1);
    for (long n = -200; n < count; n++)
    {
        double v[3];

        test_walk_on(&w);
        test_in_body(&w.state, w.state.u, v);
        for (int i = 0; n >= 0 && i < 3; i++)
        {
            sum[i] += v[i] * v[i];
            sum[3 + i] += w.state.omega[i] * w.state.omega[i];
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
        const double ratio = sum[i] / (double)count / theory;

        print_message("# dt = %.3g tau: <(%s)^2> %.4f of kT/m, %.4f +- %.4f of "
                      "theory\n",
                      s, direction[i], ratio * 2 / s * tanh(s / 2), ratio,
                      sigma);
        assert_near(ratio, 1, 5 * sigma);
    }
}

static void test_equilibrium(void **unused)
{
    const long count = test_full() ? 3000000 : 150000;

    (void)unused;
    check_equilibrium(0.1, count);
    check_equilibrium(1, count);
    check_equilibrium(10, count / 4); /* two steps and more an interval */
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

static void check_diffusion(ellipsoid_motion motion, double dt, int length,
                            long blocks)
{
    const ellipsoid_options o = test_brownian(motion, dt);
    test_walk w = test_walk_of(&o, 3, 1);
    double sum[6] = {0};

    for (int n = 0; n < 200; n++)
    {
        test_walk_on(&w);
    }
    for (long n = 0; n < blocks; n++)
    {
        const ellipsoid_state before = w.state;
        double moved[6];

        for (int k = 0; k < length; k++)
        {
            test_walk_on(&w);
        }
        test_moved(&before, &w.state, moved);
        for (int i = 0; i < 6; i++)
        {
            sum[i] += moved[i] * moved[i];
        }
    }
    for (int i = 0; i < 6; i++)
    {
        const double t = length * dt;
        const double d = test_kt * test_mobility(&w.model, i);
        const double theory = mean_square(&w.model, i, dt, t);
        const double sigma = sqrt(2 / (double)blocks);
        const double ratio = sum[i] / (double)blocks / theory;

        print_message("# %s, dt = %.1e s, %2d intervals, %s: <x^2>/2t = %.4e, "
                      "%.4f +- %.4f of theory, which is %.3f D\n",
                      test_motion_name(motion), dt, length, direction[i],
                      sum[i] / (double)blocks / (2 * t), ratio, sigma,
                      theory / (2 * d * t));
        assert_near(ratio, 1, 5 * sigma);
    }
}

static void test_diffusion(void **unused)
{
    const long blocks = test_full() ? 700000 : 100000;
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
    check_diffusion(ELLIPSOID_MOTION_INERTIALESS, 1e-3, 1, blocks);
    check_diffusion(ELLIPSOID_MOTION_INERTIAL, 1e-3, 1, blocks);
    check_diffusion(ELLIPSOID_MOTION_INERTIAL, 0.5 * m.relaxation_time, 20,
                    blocks / 10);
}

/* ---------------------------------------------------------- crossover */

/*
    The force turns with the body, so a displacement in an interval is shorter
    than its force would give: of a force across the turn phi by phi^2/12. Mean
    over the noise: D along the axis is less by Dr dt/3, each D across it by
    (Dr + Ds) dt/6 (Ds: spin), to first order in dt. Here without dt.
*/
static double along_loss(const ellipsoid_model *m)
{
    return test_kt * m->rotation_mobility[0] / 3;
}

static double across_loss(const ellipsoid_model *m)
{
    return test_kt * (m->rotation_mobility[0] + m->rotation_mobility[1]) / 6;
}

/*
    With D_ij = Dbar I + dD (O O - I/3), dD = D_along - D_across, and
    <O(t).O(0)> = exp(-2 Dr t), <(O(t).O(0))^2> = 1/3 + 2/3 exp(-6 Dr t) (Berne
    & Pecora, Dynamic Light Scattering, 1976), d<x_i x_j>/dt = 2 <D_ij> gives
        <(x.O(0))^2> = 2 [Dbar t + 2/3 dD (1 - exp(-6 Dr t))/(6 Dr)],
        <|x|^2> = 6 Dbar t.
    Cells are independent and each gives one mean over its windows of the lag:
    the scatter of these is the estimator's deviation, known to 1/sqrt(2 cells).
    dt = 0.05 s: D is taken as test_interval_refinement has it for that
    interval, less than 0.5 % below kT/zeta; O decays by 0.2 % more slowly, a
    tenth of a deviation where that is known best.
*/
enum
{
    LAGS = 5
};

static void check_lag(const test_sample sample[3], double dt, int lag)
{
    const ellipsoid_options o = test_brownian(ELLIPSOID_MOTION_INERTIALESS, dt);
    const ellipsoid_model m = test_model(&o);
    const double dr = test_kt * m.rotation_mobility[0], t = lag * dt;
    const double along = test_kt * m.mobility[1] * (1 - along_loss(&m) * dt);
    const double across = test_kt * m.mobility[0] * (1 - across_loss(&m) * dt);
    const double mean = (along + 2 * across) / 3;
    const double bend = (1 - exp(-6 * dr * t)) / (6 * dr * t);
    const double theory[3] = {2 * t
                                  * (mean + 2.0 / 3 * (along - across) * bend),
                              6 * mean * t, exp(-2 * dr * t)};
    static const char *const name[3] = {"<(x.O0)^2>/2t", "<|x|^2>/6t",
                                        "<O.O0>"};
    const double unit[3] = {2 * t, 6 * t, 1};

    for (int k = 0; k < 3; k++)
    {
        const double sigma = test_sample_sigma(&sample[k]);

        print_message("# t = %5.2f s: %s = %.4g, theory %.4g +- %.2g\n", t,
                      name[k], sample[k].mean / unit[k], theory[k] / unit[k],
                      sigma / unit[k]);
        assert_near(sample[k].mean, theory[k], 5 * sigma);
    }
    /* else the test would see no difference between along and across */
    assert_true(lag > 20
                || 5 * test_sample_sigma(&sample[0])
                       < theory[0] - 2 * mean * t);
}

static void test_crossover(void **unused)
{
    enum
    {
        LONGEST = 200
    };
    static const int lags[LAGS] = {10, 20, 40, 100, LONGEST};
    static double x[20 * LONGEST + 1][3], axis[20 * LONGEST + 1][3];
    const ellipsoid_options o =
        test_brownian(ELLIPSOID_MOTION_INERTIALESS, 0.05);
    const int cells = test_full() ? 1500 : 120;
    const int length = 20 * LONGEST;
    test_sample sample[LAGS][3] = {{{0}}};

    (void)unused;
    for (int id = 0; id < cells; id++)
    {
        test_walk w = test_walk_of(&o, 4, (uint32_t)id);

        for (int n = 0; n <= length; n++)
        {
            double r[3][3];

            ellipsoid_rotation(w.state.q, r);
            ellipsoid_set(axis[n], r[0][1], r[1][1], r[2][1]);
            memcpy(x[n], w.state.x, sizeof(x[n]));
            if (n < length)
            {
                test_walk_on(&w);
            }
        }
        for (int l = 0; l < LAGS; l++)
        {
            const int step = lags[l] / 5, windows = (length - lags[l]) / step;
            double sum[3] = {0};

            for (int n = 0; n < windows; n++)
            {
                const int a = n * step, b = a + lags[l];
                double way[3], along;

                ellipsoid_difference(x[b], x[a], way);
                along = ellipsoid_dot(way, axis[a]);
                sum[0] += along * along / windows;
                sum[1] += ellipsoid_dot(way, way) / windows;
                sum[2] += ellipsoid_dot(axis[a], axis[b]) / windows;
            }
            for (int k = 0; k < 3; k++)
            {
                test_sample_add(&sample[l][k], sum[k]);
            }
        }
    }
    for (int l = 0; l < LAGS; l++)
    {
        check_lag(sample[l], o.noise_interval, lags[l]);
    }
}

/* --------------------------------------------------------- refinement */

/*
    What along_loss() and across_loss() say of <|x|^2>, and O's decay. Not
    <|x|^2> is averaged but the difference from |F dt/zeta|^2, whose mean is
    known: its scatter is of the size of the effect itself, so 20000 intervals
    give it to 1 %; and likewise O's decay.
*/
static double check_bias(double dt, long count)
{
    ellipsoid_options o = test_brownian(ELLIPSOID_MOTION_INERTIALESS, dt);
    test_walk w = test_walk_of(&o, 5, 1);
    const double *mobility = w.model.mobility;
    const double dr = test_kt * w.model.rotation_mobility[0];
    const double ds = test_kt * w.model.rotation_mobility[1];
    const double all = mobility[0] + mobility[1] + mobility[2];
    const double slope = (mobility[1] * along_loss(&w.model)
                          + 2 * mobility[0] * across_loss(&w.model))
                       / all;
    test_sample loss = {0}, cosine = {0};
    double sigma, turns;

    for (long n = 0; n < count; n++)
    {
        const ellipsoid_state before = w.state;
        double normal[6], way[3], r[2][3][3], straight = 0;

        ellipsoid_random_normal(5, 1, n, normal);
        test_walk_on(&w);
        ellipsoid_difference(w.state.x, before.x, way);
        for (int i = 0; i < 3; i++)
        {
            straight += 2 * test_kt * mobility[i] * dt * normal[i] * normal[i];
        }
        test_sample_add(&loss, (straight - ellipsoid_dot(way, way))
                                   / (2 * test_kt * all * dt));
        ellipsoid_rotation(before.q, r[0]);
        ellipsoid_rotation(w.state.q, r[1]);
        /* less the leading part, whose mean is known */
        test_sample_add(
            &cosine,
            r[0][0][1] * r[1][0][1] + r[0][1][1] * r[1][1][1]
                + r[0][2][1] * r[1][2][1]
                + dr * dt * (normal[3] * normal[3] + normal[5] * normal[5]));
    }
    sigma = test_sample_sigma(&loss);
    turns = -log(cosine.mean - 2 * dr * dt) / (2 * dr * dt);
    print_message("# dt = %5.3f s: D %.5f +- %.5f (first order %.5f), Dr %.5f "
                  "of theory\n",
                  dt, 1 - loss.mean, sigma, 1 - slope * dt, turns);
    /* second order: the fourth power of the turn, over 360 */
    assert_near(loss.mean, slope * dt,
                5 * sigma + 0.5 * (dr + ds) * dt * slope * dt);
    /* exp(-2 Dr dt) to the order left out, with 5 sigma of it */
    assert_near(turns, 1,
                (dr + ds) * dt
                    + 5 * test_sample_sigma(&cosine) / (2 * dr * dt));
    return loss.mean;
}

static void test_interval_refinement(void **unused)
{
    const long count = test_full() ? 200000 : 20000;
    double before = 0;

    (void)unused;
    for (double dt = 0.4; dt > 0.01; dt /= 2)
    {
        const double loss = check_bias(dt, count);

        /* first order: half; 5 % for the second order at the coarsest and the
           scatter, which halving shares as the noise is the same */
        assert_true(!(before > 0) || fabs(loss / before - 0.5) < 0.05);
        before = loss;
    }
    assert_true(before < 0.002);
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
    comes later: blocks of 20 of the shortest intervals.
*/
static void check_drift(ellipsoid_motion motion, double dt, int length,
                        long blocks)
{
    static const double tolerances[2] = {1e-2, 1e-6};
    const double t = length * dt;
    ellipsoid_options o = test_brownian(motion, dt);

    o.semi_axes[2] = 1e-6;
    for (int k = 0; k < 2; k++)
    {
        test_sample sample[6] = {{0}};
        double worst = 0, most = 0, steps;
        test_walk w;

        o.tolerance = tolerances[k];
        w = test_walk_of(&o, 6, 1);
        for (long n = 0; n < blocks; n++)
        {
            const ellipsoid_state before = w.state;
            double moved[6];

            for (int l = 0; l < length; l++)
            {
                test_walk_on(&w);
            }
            test_moved(&before, &w.state, moved);
            for (int i = 0; i < 6; i++)
            {
                test_sample_add(&sample[i], moved[i]);
            }
        }
        for (int i = 0; i < 6; i++)
        {
            const double d = test_kt * test_mobility(&w.model, i);
            const double theory = mean_square(&w.model, i, dt, t);
            const double ratio = sample[i].squares / (double)blocks / theory;
            const double turn =
                test_kt
                * (test_mobility(&w.model, 3) + test_mobility(&w.model, 4)
                   + test_mobility(&w.model, 5))
                / 6 * dt;
            const double mean =
                sample[i].mean / sqrt(2 * d * t / (double)blocks);

            worst = fmax(worst, fabs(mean));
            most = fmax(most, fabs(ratio - 1));
            assert_near(mean, 0, 5);
            assert_near(ratio, 1, 5 * sqrt(2 / (double)blocks) + 1.5 * turn);
        }
        steps = (double)(blocks * length);
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
    const long blocks = test_full() ? 500000 : 40000;

    (void)unused;
    check_drift(ELLIPSOID_MOTION_INERTIAL, 2e-6, 20, blocks / 10);
    check_drift(ELLIPSOID_MOTION_INERTIAL, 1e-3, 1, blocks);
    check_drift(ELLIPSOID_MOTION_INERTIAL, 0.02, 1, blocks);
    check_drift(ELLIPSOID_MOTION_INERTIALESS, 1e-3, 1, blocks);
    check_drift(ELLIPSOID_MOTION_INERTIALESS, 0.02, 1, blocks);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_interval),
        cmocka_unit_test(test_equilibrium),
        cmocka_unit_test(test_diffusion),
        cmocka_unit_test(test_crossover),
        cmocka_unit_test(test_interval_refinement),
        cmocka_unit_test(test_no_drift),
    };

    return cmocka_run_group_tests_name("brownian", tests, NULL, NULL);
}
