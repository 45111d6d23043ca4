/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_sweep.c - what a cell sweeps holds it, and no point moves farther than
    its travel.
*/
#include "coreTest.h"
#include "world/world.h"

/* How far the beads' surfaces and the ellipsoid's axes have moved. */
static double moved(const ellipsoid_model *model, const ellipsoid_state *from,
                    const ellipsoid_state *to)
{
    double r[2][3][3], farthest = 0;

    ellipsoid_rotation(from->q, r[0]);
    ellipsoid_rotation(to->q, r[1]);
    for (int n = 0; n < model->bead_count + 3; n++)
    {
        const int axis = n - model->bead_count;
        double point[3] = {0, 0, 0}, p[2][3];

        if (axis < 0)
        {
            const double length = ellipsoid_length(model->bead[n]);

            for (int i = 0; i < 3; i++)
            {
                point[i] = model->bead[n][i]
                         * (1 + model->options.bead_radius / length);
            }
        }
        else
        {
            point[axis] = model->options.semi_axes[axis];
        }
        ellipsoid_product(r[0], point, p[0]);
        ellipsoid_product(r[1], point, p[1]);
        ellipsoid_add(p[0], from->x);
        ellipsoid_add(p[1], to->x);
        ellipsoid_difference(p[1], p[0], p[0]);
        farthest = fmax(farthest, ellipsoid_length(p[0]));
    }
    return farthest;
}

static ellipsoid_state next_to(const ellipsoid_state *s, double far,
                               uint64_t *seed)
{
    ellipsoid_state next = *s;

    for (int i = 0; i < 3; i++)
    {
        next.x[i] += far * test_signed(seed);
    }
    for (int i = 0; i < 4; i++)
    {
        next.q[i] += 0.5 * test_signed(seed);
    }
    ellipsoid_normalise(next.q);
    return next;
}

/* Two sweeps, with a period passed in each, are one. Beads stand out. */
static void test_two_are_one(void **unused)
{
    ellipsoid_options o = test_paper_options();
    uint64_t seed = 51;

    (void)unused;
    o.bead_layout = ELLIPSOID_BEADS_SURFACE;

    const ellipsoid_model model = test_model(&o);

    for (int n = 0; n < 3000; n++)
    {
        const double far = n % 2 ? 1e-7 : 1e-9;
        const double period = 1e-5;
        ellipsoid_state s[3] = {{.x = {0, 0, 0}}}, over;
        ellipsoid_sweep first, second;

        test_orientation(&seed, s[0].q);
        s[1] = next_to(&s[0], far, &seed);
        s[2] = next_to(&s[1], far, &seed);
        ellipsoid_sweep_begin(&first, &s[0]);
        ellipsoid_sweep_add(&first, &model, &s[1]);
        assert_true(first.travel >= moved(&model, &s[0], &s[1]));
        assert_true(first.travel < 4 * moved(&model, &s[0], &s[1]));

        /* placed a period back at the end of the first */
        first.passed[0] = period;
        over = s[1];
        over.x[0] -= period;
        ellipsoid_sweep_begin(&second, &over);
        over = s[2];
        over.x[0] -= period;
        ellipsoid_sweep_add(&second, &model, &over);
        second.passed[0] = period;
        ellipsoid_sweep_prepend(&second, &first);
        assert_true(second.travel >= moved(&model, &s[0], &s[2]));
        assert_near(second.passed[0], 2 * period, 1e-20);
        for (int k = 0; k < 3; k++)
        {
            for (int i = 0; i < 3; i++)
            {
                assert_true(second.low[i] <= s[k].x[i] + 1e-18
                            && second.high[i] >= s[k].x[i] - 1e-18);
                assert_true(second.high[i] - second.low[i] <= 4 * far);
            }
        }
    }
}

/* What a step sweeps holds it at its quarters, where it goes one way and back
   and then the other */
static void test_step(void **state)
{
    ellipsoid_options o = test_paper_options();
    const ellipsoid_model model = test_model(&o);
    ellipsoid_step step = {.start = 1, .end = 2};
    ellipsoid_sweep sweep;

    (void)state;
    step.before.q[3] = step.after.q[3] = 1;
    for (int i = 0; i < 3; i++)
    {
        step.dense[0][AT_X + i] = (i + 1) * 1e-6;
        step.dense[1][AT_X + i] = -2 * (i + 1) * 1e-6;
    }
    ellipsoid_sweep_begin(&sweep, &step.before);
    ellipsoid_sweep_add_step(&sweep, &model, &step);
    for (int quarter = 1; quarter < 4; quarter++)
    {
        ellipsoid_state at;

        ellipsoid_step_state(&step, 1 + 0.25 * quarter, &at);
        assert_true(sweep.travel >= (1 - 1e-12) * ellipsoid_length(at.x));
        for (int i = 0; i < 3; i++)
        {
            assert_true(sweep.low[i] <= at.x[i] && at.x[i] <= sweep.high[i]);
        }
    }
    assert_true(sweep.travel > 0.3e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_two_are_one),
        cmocka_unit_test(test_step),
    };

    return cmocka_run_group_tests_name("sweep", tests, NULL, NULL);
}
