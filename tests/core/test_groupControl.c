/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_groupControl.c - the steps of a group are those that each of its cells
    allows, in whatever order they come.
*/
#include "groupTest.h"

/* Two cells far apart in shear, one of which turns end over end and one about
   its long axis; `first` is which comes first. Each has a step of its own from
   before; steps[0] is the first that is taken. */
static void go(int first, double step[2], double *t, long *attempts)
{
    const ellipsoid_options o = test_free_cell();
    const test_quadratic flow = test_shear(100);
    const double along[3] = {0, 0, 1};
    const int quick = first, slow = !first;
    crowd c;

    crowd_init(&c, 2, &o, &flow);
    ellipsoid_quaternion_from_axis(along, 0, c.state[slow].q);
    c.state[slow].x[2] = 50e-6;
    c.controller[quick] = (ellipsoid_controller){1e-6, 1e-4};
    c.controller[slow] = (ellipsoid_controller){1e-4, 0.9};
    *t = 0;
    crowd_advance(&c, t, 1e-6, NULL);
    step[0] = c.controller[0].step;
    crowd_advance(&c, t, 0.05, NULL);
    step[1] = c.controller[0].step;
    *attempts = c.statistics[0].accepted + c.statistics[0].rejected;
    crowd_free(&c);
}

/* With a previous error of 0.9, the larger of the two, the step of 1e-6 s, the
   smaller one, is the more lengthened by PI control, at most by five. */
static void test_order_does_not_matter(void **unused)
{
    double step[2][2], t[2];
    long attempts[2];

    (void)unused;
    for (int first = 0; first < 2; first++)
    {
        go(first, step[first], &t[first], &attempts[first]);
        assert_true(step[first][0] <= 5e-6);
    }
    assert_true(step[0][0] == step[1][0]);
    assert_relative(step[0][1], step[1][1], 1e-9);
    assert_int_equal(attempts[0], attempts[1]);
    assert_true(attempts[0] > 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_order_does_not_matter),
    };

    return cmocka_run_group_tests_name("groupControl", tests, NULL, NULL);
}
