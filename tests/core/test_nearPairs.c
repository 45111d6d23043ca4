/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_nearPairs.c - lists of the beads of two cells of different size that
    may touch: what is in them, and how long they hold.
*/
#include "groupTest.h"
#include "contact/contact.h"

/* The paper's cell, one of half its size with smaller beads, and a short one
   with beads as large. */
static void make_models(ellipsoid_model model[3])
{
    ellipsoid_options o = test_free_cell();

    o.contact = 1;
    model[0] = test_model(&o);
    ellipsoid_set(o.semi_axes, 0.25e-6, 1e-6, 0.25e-6);
    o.bead_radius = 0.12e-6;
    model[1] = test_model(&o);
    ellipsoid_set(o.semi_axes, 0.3e-6, 0.4e-6, 0.3e-6);
    o.bead_radius = 0.25e-6;
    model[2] = test_model(&o);
}

/* Beside one another, or one before the other's end along its long axis. */
static void random_poses(int in_line, uint64_t *seed, ellipsoid_state s[2])
{
    double way[3], far = 3.3e-6 * test_uniform(seed);

    memset(s, 0, 2 * sizeof(*s));
    test_orientation(seed, s[0].q);
    test_orientation(seed, s[1].q);
    for (int i = 0; i < 3; i++)
    {
        s[0].x[i] = 1e-6 * test_signed(seed);
        way[i] = test_signed(seed);
    }
    if (in_line)
    {
        memcpy(s[1].q, s[0].q, sizeof(s[1].q));
        test_long_axis(&s[0], way);
        far = (2.8 + 0.5 * test_uniform(seed)) * 1e-6;
    }
    for (int i = 0; i < 3; i++)
    {
        s[1].x[i] = s[0].x[i] + far * way[i] / ellipsoid_length(way);
    }
}

/* All beads with gaps below `far`, in order, and no others; of cells that are
   apart there are none. */
static void check_list(ellipsoid_body *a, ellipsoid_body *b, double far,
                       int *listed)
{
    const double both =
        a->model->options.bead_radius + b->model->options.bead_radius + far;
    ellipsoid_near_pair near;
    int count = 0;

    ellipsoid_list_beads(a, b, far, &near);
    for (int n = 0; n < a->model->bead_count; n++)
    {
        for (int l = 0; l < b->model->bead_count; l++)
        {
            double line[3];

            ellipsoid_difference(a->x, b->x, line);
            ellipsoid_add(line, a->bead[n]);
            ellipsoid_difference(line, b->bead[l], line);
            if (ellipsoid_length(line) < both)
            {
                assert_true(near.listed < 0
                            || (count < near.listed && near.bead[count][0] == n
                                && near.bead[count][1] == l));
                count++;
            }
        }
    }
    assert_int_equal(near.listed, count > ELLIPSOID_NEAR_BEADS ? -1 : count);
    assert_true(count == 0
                || !ellipsoid_are_apart(a->model, a->x, b->model, b->x, far));
    *listed += count > 0;
}

/* q of a stage is not of length one. */
static void test_lists_are_whole(void **unused)
{
    ellipsoid_model model[3];
    uint64_t seed = 41;
    int listed = 0;

    (void)unused;
    make_models(model);
    for (int n = 0; n < 2000; n++)
    {
        double bead[2][ELLIPSOID_MAX_BEADS][3];
        ellipsoid_body body[2] = {{.bead = bead[0]}, {.bead = bead[1]}};
        const double far = 0.3e-6 * test_uniform(&seed);
        ellipsoid_state s[2];

        random_poses(n % 2, &seed, s);
        for (int k = 0; k < 2; k++)
        {
            const double longer = 1 + 0.045 * test_signed(&seed);

            for (int i = 0; i < 4; i++)
            {
                s[k].q[i] *= longer;
            }
            ellipsoid_place_body(&body[k], &model[k], s[k].x, s[k].q);
        }
        check_list(&body[0], &body[1], far, &listed);
        check_list(&body[1], &body[0], far, &listed);
    }
    assert_true(listed > 400);
}

/* A group of two cells at these states. */
static void set_group(crowd *c, const ellipsoid_model model[2],
                      const ellipsoid_state s[2], ellipsoid_group *g,
                      ellipsoid_pairs *pairs)
{
    ellipsoid_group_lay_out(2, c->memory, g, pairs);
    g->inertial = 1;
    for (int i = 0; i < 2; i++)
    {
        g->cell[i] = (ellipsoid_cell){.model = &model[i],
                                      .surroundings = c->around[i],
                                      .statistics = &c->statistics[i],
                                      .length = 2e-6,
                                      .inertial = 1};
        g->start[i].state = s[i];
    }
}

/* One cell comes a little nearer or turns a little. */
static void move_on(int turning, double part, const double line[3],
                    const double spin[3], double radius, ellipsoid_state *s)
{
    for (int i = 0; i < 3 && !turning; i++)
    {
        s->x[i] += part * 0.25 * radius * line[i] / ellipsoid_length(line);
    }
    if (turning)
    {
        double turn[4];

        ellipsoid_spin(spin, s->q, turn);
        for (int i = 0; i < 4; i++)
        {
            s->q[i] += part * 0.2 * turn[i];
        }
        ellipsoid_normalise(s->q);
    }
}

/* Forces and gaps are, to the last bit, those of a list that is made anew,
   while cells come nearer by what their lists bear, and beyond; or turn. */
static void test_lists_hold(void **unused)
{
    const ellipsoid_options o = test_free_cell();
    ellipsoid_model model[3];
    uint64_t seed = 43;
    crowd kept, fresh;
    int near = 0;

    (void)unused;
    make_models(model);
    crowd_init(&kept, 2, &o, NULL);
    crowd_init(&fresh, 2, &o, NULL);
    for (int n = 0; n < 3000; n++)
    {
        const int turning = n % 2, first = n / 2 % 2, other = 1 + n / 4 % 2;
        const ellipsoid_model order[2] = {model[first ? other : 0],
                                          model[first ? 0 : other]};
        ellipsoid_group g, anew;
        ellipsoid_pairs pairs, pairs_anew;
        ellipsoid_state s[2];
        double line[2][3], spin[3];

        random_poses(0, &seed, s);
        ellipsoid_difference(s[1].x, s[0].x, line[0]);
        ellipsoid_difference(s[0].x, s[1].x, line[1]);
        for (int i = 0; i < 3; i++)
        {
            spin[i] = test_signed(&seed);
        }
        set_group(&kept, order, s, &g, &pairs);
        for (int step = 0; step < 25; step++)
        {
            assert_ok(ellipsoid_group_evaluate(&g, 0, g.start, 0, 0));
            set_group(&fresh, order, s, &anew, &pairs_anew);
            assert_ok(ellipsoid_group_evaluate(&anew, 0, anew.start, 0, 0));
            for (int i = 0; i < 2; i++)
            {
                const ellipsoid_contact *a = &g.start[i].contact;
                const ellipsoid_contact *b = &anew.start[i].contact;

                assert_true(a->cell_gap == b->cell_gap);
                assert_memory_equal(a->cell_force, b->cell_force,
                                    sizeof(a->cell_force));
                assert_memory_equal(a->cell_torque, b->cell_torque,
                                    sizeof(a->cell_torque));
                near += a->cell_gap > 0 && a->cell_gap < 0.1e-6;
                move_on(turning, 0.1, line[i], spin,
                        order[i].options.bead_radius, &s[i]);
                g.start[i].state = s[i];
            }
        }
    }
    assert_true(near > 2000);
    crowd_free(&kept);
    crowd_free(&fresh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lists_are_whole),
        cmocka_unit_test(test_lists_hold),
    };

    return cmocka_run_group_tests_name("nearPairs", tests, NULL, NULL);
}
