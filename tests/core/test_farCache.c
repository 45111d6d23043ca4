/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_farCache.c - a cell that was far from all walls and is stretched towards
    them, as R(q) of a stage does where q is not of length one.
*/
#include "contact/contact.h"
#include "contactTest.h"

/* Height of the lowest bead's surface over the floor. */
static double lowest(const ellipsoid_model *model, const ellipsoid_state *s)
{
    double bead[ELLIPSOID_MAX_BEADS][3], low = HUGE_VAL;
    ellipsoid_body body = {.bead = bead};

    ellipsoid_place_body(&body, model, s->x, s->q);
    for (int n = 0; n < model->bead_count; n++)
    {
        low = fmin(low, s->x[2] + bead[n][2] - model->options.bead_radius);
    }
    return low;
}

/* Upright: with a new cache and with one that was filled before. */
static void test_stretched(void **unused)
{
    const ellipsoid_options options = test_paper_options();
    const double up[3] = {0, 0, 1};
    const double horizon = options.bead_radius;
    uint64_t seed = 47;
    contact_run r;
    int near = 0;

    (void)unused;
    contact_start(&r, &options, 1);
    contact_floor(&r, 1e-4);
    for (int n = 0; n < 4000; n++)
    {
        const double gap = horizon * (1 + 2 * test_uniform(&seed));

        ellipsoid_quaternion_from_axis(up, 0, r.state.q);
        r.state.x[2] = r.model.reach + gap;
        ellipsoid_facet_cache_clear(&r.cache);
        if (n % 2)
        {
            assert_near(contact_now(&r).gap, horizon, 1e-18);
        }
        for (int k = 0; k < 5; k++)
        {
            for (int i = 0; i < 4; i++)
            {
                r.state.q[i] *= 1 + 0.02 * test_uniform(&seed);
            }

            const double expected = fmin(lowest(&r.model, &r.state), horizon);

            if (expected < 0)
            {
                break;
            }
            assert_near(contact_now(&r).gap, expected, 1e-18);
            near += expected < horizon;
        }
    }
    assert_true(near > 1000);
    wall_mesh_free(&r.mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stretched),
    };

    return cmocka_run_group_tests_name("farCache", tests, NULL, NULL);
}
