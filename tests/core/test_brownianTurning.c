/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_brownianTurning.c - Brownian motion of a free cell that turns: over
    times in which it forgets its orientation, and in one interval.
*/
#include "brownianTest.h"

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

    The means are those of steady motion in each interval, over all cells, and
    of those followed the difference of the core's from it.
*/
enum
{
    LAGS = 5,
    LONGEST = 200,
    LENGTH = 20 * LONGEST
};

typedef struct path
{
    double x[LENGTH + 1][3], axis[LENGTH + 1][3];
} path;

static void note_pose(const ellipsoid_state *state, path *p, int n)
{
    double r[3][3];

    ellipsoid_rotation(state->q, r);
    ellipsoid_set(p->axis[n], r[0][1], r[1][1], r[2][1]);
    memcpy(p->x[n], state->x, sizeof(p->x[n]));
}

/* Means over the windows of a lag. */
static void window_means(const path *p, int lag, double mean[3])
{
    const int step = lag / 5, windows = (LENGTH - lag) / step;

    memset(mean, 0, 3 * sizeof(*mean));
    for (int n = 0; n < windows; n++)
    {
        const int a = n * step, b = a + lag;
        double way[3], along;

        ellipsoid_difference(p->x[b], p->x[a], way);
        along = ellipsoid_dot(way, p->axis[a]);
        mean[0] += along * along / windows;
        mean[1] += ellipsoid_dot(way, way) / windows;
        mean[2] += ellipsoid_dot(p->axis[a], p->axis[b]) / windows;
    }
}

static void check_lag(const test_sample sample[3], const test_sample apart[3],
                      double dt, int lag)
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
    static const test_row row = {
        "Brownian motion",
        "way along the first axis, way, turn, in standard errors",
        "E. coli, before and after it has turned",
        "Han et al., Science 314, 626 (2006), from three dimensions",
        "A",
        "5 sigma",
        0};

    for (int k = 0; k < 3; k++)
    {
        const double sigma = test_sample_sigma(&sample[k]);

        const double mean = sample[k].mean + apart[k].mean;

        print_message("# t = %5.2f s: %s = %.4g, theory %.4g +- %.2g, %.1e +- "
                      "%.1e apart from steady motion\n",
                      t, name[k], mean / unit[k], theory[k] / unit[k],
                      sigma / unit[k], apart[k].mean / unit[k],
                      test_sample_sigma(&apart[k]) / unit[k]);
        assert_row(&row, (mean - theory[k]) / sigma, 0, 5);
        assert_true(test_sample_sigma(&apart[k]) < 0.2 * sigma);
    }
    /* else the test would see no difference between along and across */
    assert_true(lag > 20
                || 5 * test_sample_sigma(&sample[0])
                       < theory[0] - 2 * mean * t);
}

static void test_crossover(void **unused)
{
    static const int lags[LAGS] = {10, 20, 40, 100, LONGEST};
    static path exact, own;
    const ellipsoid_options o =
        test_brownian(ELLIPSOID_MOTION_INERTIALESS, 0.05);
    const long cells = test_count(120, 120, 1500);
    const long followed = test_count(3, 30, 120);
    test_sample sample[LAGS][3] = {{{0}}}, apart[LAGS][3] = {{{0}}};

    (void)unused;
    for (uint32_t id = 0; id < cells; id++)
    {
        test_walk w = test_walk_of(&o, 4, id);
        ellipsoid_state steady = w.state;

        for (int n = 0; n <= LENGTH; n++)
        {
            double normal[6];

            note_pose(&steady, &exact, n);
            note_pose(&w.state, &own, n);
            ellipsoid_random_normal(4, id, n, normal);
            test_move_steadily(&w.model, normal, &steady);
            if (n < LENGTH && id < followed)
            {
                test_walk_on(&w);
            }
        }
        for (int l = 0; l < LAGS; l++)
        {
            double mean[2][3];

            window_means(&exact, lags[l], mean[0]);
            window_means(&own, lags[l], mean[1]);
            for (int k = 0; k < 3; k++)
            {
                test_sample_add(&sample[l][k], mean[0][k]);
                if (id < followed)
                {
                    test_sample_add(&apart[l][k], mean[1][k] - mean[0][k]);
                }
            }
        }
    }
    for (int l = 0; l < LAGS; l++)
    {
        check_lag(sample[l], apart[l], o.noise_interval, lags[l]);
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
    const long count = test_count(20000, 20000, 200000);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_crossover),
        cmocka_unit_test(test_interval_refinement),
    };

    return cmocka_run_group_tests_name("brownianTurning", tests, NULL, NULL);
}
