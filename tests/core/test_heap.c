/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_heap.c - many cells that a flow presses into a heap.
    Processor time: 4, full 10
*/
#include "groupTest.h"

/* Cells on a grid, turned at random, in a flow that presses them into a heap:
   0.4 pN on each, a tenth of what a sieve's flow does. */
static void crowd_heap(crowd *c, int count)
{
    const test_quadratic flow = towards_origin(20);
    ellipsoid_options o = touching_cell();
    uint64_t seed = 8;

    o.tolerance = 1e-5;
    crowd_init(c, count, &o, &flow);
    for (int i = 0; i < count; i++)
    {
        test_orientation(&seed, c->state[i].q);
        c->state[i].x[0] = 5e-6 * (i % 4 - 1.5);
        c->state[i].x[1] = 5e-6 * (i / 4 % 4 - 1.5);
        c->state[i].x[2] = 5e-6 * (i / 16 - 1.5);
    }
    deepest = 0;
}

static long crowd_steps(const crowd *c)
{
    return c->statistics[0].accepted + c->statistics[0].rejected;
}

/* Fifty run through the collision without deep overlaps; their heap has the
   size of a dense one: within a ball of 5 um they would fill 40 %. They are
   within it after 60 ms. */
static void test_fifty(void **unused)
{
    const long milliseconds = test_count(60, 60, 100);
    double t = 0, far = 0;
    crowd c;

    (void)unused;
    crowd_heap(&c, 50);
    crowd_advance(&c, &t, 1e-3 * (double)milliseconds, note_deepest);
    for (int i = 0; i < 50; i++)
    {
        far = fmax(far, ellipsoid_length(c.state[i].x));
    }
    print_message("# fifty: %ld steps in %ld ms, deepest %.2g r_b, centres "
                  "within %.2g m\n",
                  crowd_steps(&c), milliseconds,
                  deepest / c.model.options.bead_radius, far);
    assert_true(deepest > 0 && deepest < 0.05 * c.model.options.bead_radius);
    assert_true(far < 5e-6);
    crowd_free(&c);
}

/* A heap of twelve settles in a second, and then costs next to nothing: steps
   of ten milliseconds, 1e5 relaxation times. */
static void test_heap_at_rest(void **unused)
{
    double t = 0;
    long before;
    crowd c;

    (void)unused;
    crowd_heap(&c, 12);
    crowd_advance(&c, &t, 1.2, note_deepest);
    before = crowd_steps(&c);
    crowd_advance(&c, &t, 1.3, NULL);
    print_message("# heap: %ld steps to rest, %ld in 100 ms at rest\n", before,
                  crowd_steps(&c) - before);
    assert_true(deepest > 0 && deepest < 0.05 * c.model.options.bead_radius);
    assert_true(crowd_steps(&c) - before < 40);
    crowd_free(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        BOTH(test_fifty),
        BOTH(test_heap_at_rest),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
