/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_letGo.c - which steps let go of a contact as the cell would not: held
    back by it, or thrown off; the work of its push in the step against that of
    the velocity after it.
*/
#include "coreTest.h"

/* The judge is local to it. */
#include "motion/advance.c"

static const double interval = 0.01, distance = 1e-9, angle = 1e-3;
static const double exact = 1e-7;

/* A step that lets go of a contact: where it began and where it ends. */
typedef struct released_step
{
    ellipsoid_model model;
    ellipsoid_cell cell;
    ellipsoid_evaluation start, next;
} released_step;

static released_step let_go(double tolerance)
{
    ellipsoid_options o = test_free_cell();
    released_step s;

    o.tolerance = tolerance;
    memset(&s, 0, sizeof(s));
    s.model = test_model(&o);
    s.cell.length = o.semi_axes[1];
    ellipsoid_set(s.start.state.x, 3e-6, -2e-6, 5e-6);
    ellipsoid_quaternion_from_axis((double[3]){0.6, 0, 0.8}, 1.1,
                                   s.start.state.q);
    s.start.contact.bead_contacts = 1;
    s.start.contact.deepest = 1e-9;
    s.next.state = s.start.state;
    return s;
}

static int is_wrong(released_step *s)
{
    s->cell.model = &s->model;
    return is_release_wrong(&s->cell, &s->start, &s->next, interval);
}

/* The next pose: moved so distance in the lab, and turned about an axis of the
   body. */
static void move(released_step *s, const double shift[3], const double axis[3],
                 double turn)
{
    const double *q = s->start.state.q, c = cos(turn / 2);
    double *x = s->next.state.x, *to = s->next.state.q, v[3], part[3];

    memcpy(x, s->start.state.x, sizeof(s->start.state.x));
    ellipsoid_add(x, shift);
    for (int i = 0; i < 3; i++)
    {
        v[i] = sin(turn / 2) * axis[i];
    }
    ellipsoid_cross(q, v, part);
    for (int i = 0; i < 3; i++)
    {
        to[i] = c * q[i] + q[3] * v[i] + part[i];
    }
    to[3] = c * q[3] - ellipsoid_dot(q, v);
}

/* Walls and cells push alike: the force along (1, 2, 2)/3 in the lab. Beyond
   four times the way that the step went the cell was held back. */
static void test_force(void **unused)
{
    const double way[3] = {distance / 3, 2 * distance / 3, 2 * distance / 3};
    const double axis[3] = {0, 1, 0};

    (void)unused;
    for (int of_cell = 0; of_cell < 2; of_cell++)
    {
        released_step s = let_go(exact);
        double *force =
            of_cell ? s.start.contact.cell_force : s.start.contact.force;

        ellipsoid_set(force, 1e-9, 2e-9, 2e-9);
        for (int i = 0; i < 3; i++)
        {
            s.next.state.u[i] = way[i] / interval;
        }
        move(&s, (double[3]){0}, axis, 0);
        assert_true(is_wrong(&s));
        for (int part = 2; part < 6; part++)
        {
            const double k = 1.0 / part;

            move(&s, (double[3]){k * way[0], k * way[1], k * way[2]}, axis, 0);
            assert_int_equal(is_wrong(&s), part > 4);
        }
        /* against the push the way counts for none, not for less */
        move(&s, (double[3]){-way[0], -way[1], -way[2]}, axis, 0);
        assert_true(is_wrong(&s));
        ellipsoid_set(s.next.state.u, 0, 0, 0);
        assert_false(is_wrong(&s));
    }
}

/* So is the torque's, in the body, of whatever orientation. */
static void test_torque(void **unused)
{
    const double axis[3] = {2.0 / 3, -1.0 / 3, 2.0 / 3};

    (void)unused;
    for (int of_cell = 0; of_cell < 2; of_cell++)
    {
        released_step s = let_go(exact);
        double *torque =
            of_cell ? s.start.contact.cell_torque : s.start.contact.torque;

        ellipsoid_set(torque, 2e-15, -1e-15, 2e-15);
        for (int i = 0; i < 3; i++)
        {
            s.next.state.omega[i] = angle / interval * axis[i];
        }
        for (int part = 2; part < 6; part++)
        {
            move(&s, (double[3]){0}, axis, angle / part);
            assert_int_equal(is_wrong(&s), part > 4);
        }
        move(&s, (double[3]){0}, axis, -angle);
        assert_true(is_wrong(&s));
    }
}

/* Work of both counts as one: what the torque made makes up for what the force
   did not. */
static void test_sum(void **unused)
{
    const double axis[3] = {1, 0, 0};
    released_step s = let_go(exact);

    (void)unused;
    ellipsoid_set(s.start.contact.force, 0, 0, 1e-9);
    ellipsoid_set(s.start.contact.torque, 1e-9 * distance / angle, 0, 0);
    ellipsoid_set(s.next.state.u, 0, 0, distance / interval);
    move(&s, (double[3]){0}, axis, 0.3 * angle);
    assert_false(is_wrong(&s));
    move(&s, (double[3]){0}, axis, 0.2 * angle);
    assert_true(is_wrong(&s));
    move(&s, (double[3]){0, 0, -0.1 * distance}, axis, 0.3 * angle);
    assert_true(is_wrong(&s));
}

/* Less than ten times the tolerance of the cell's length is none. */
static void test_slight(void **unused)
{
    const double axis[3] = {1, 0, 0};
    const double tolerance = 1e-3, slight = 10 * tolerance;
    released_step s = let_go(tolerance);

    (void)unused;
    for (int turns = 0; turns < 2; turns++)
    {
        double *push = turns ? s.start.contact.torque : s.start.contact.force;
        double *rate = turns ? s.next.state.omega : s.next.state.u;
        const double most = turns ? slight : slight * s.cell.length;

        ellipsoid_set(s.start.contact.force, 0, 0, 0);
        ellipsoid_set(s.next.state.u, 0, 0, 0);
        ellipsoid_set(push, 1e-12, 0, 0);
        move(&s, (double[3]){0}, axis, 0);
        ellipsoid_set(rate, 0.99 * most / interval, 0, 0);
        assert_false(is_wrong(&s));
        ellipsoid_set(rate, 1.01 * most / interval, 0, 0);
        assert_true(is_wrong(&s));
    }
}

/* With inertia the velocity is what the cell would take up: within the step, or
   the time in which it follows the forces if that is shorter. */
static void test_inertia(void **unused)
{
    const double axis[3] = {1, 0, 0};

    (void)unused;
    for (int turns = 0; turns < 2; turns++)
    {
        for (int slow = 0; slow < 2; slow++)
        {
            released_step s = let_go(exact);
            const double rate = slow ? 0.1 / interval : 10 / interval;
            const double lag = slow ? interval : 1 / rate;

            s.cell.rate = turns ? 0 : rate;
            s.cell.rotation_rate = turns ? rate : 0;
            ellipsoid_set(s.start.contact.force, turns ? 0 : 1e-9, 0, 0);
            ellipsoid_set(s.start.contact.torque, turns ? 1e-15 : 0, 0, 0);
            move(&s, (double[3]){distance, 0, 0}, axis, angle);
            for (int part = 3; part < 6; part += 2)
            {
                ellipsoid_set(s.next.derivative.u,
                              part * distance / interval / lag, 0, 0);
                ellipsoid_set(s.next.derivative.omega,
                              part * angle / interval / lag, 0, 0);
                s.cell.inertial = 1;
                assert_int_equal(is_wrong(&s), part > 4);
                s.cell.inertial = 0;
                assert_false(is_wrong(&s));
            }
        }
    }
}

/* Only a step that lets go is judged: of a wall or a cell, or of half of the
   depth there. */
static void test_kept(void **unused)
{
    released_step s = let_go(exact);
    ellipsoid_contact *was = &s.start.contact, *is = &s.next.contact;

    (void)unused;
    ellipsoid_set(was->force, 1e-9, 0, 0);
    ellipsoid_set(s.next.state.u, distance / interval, 0, 0);
    was->bead_contacts = was->cell_count = 2;
    was->deepest = was->cell_deepest = 1e-9;
    *is = *was;
    is->deepest = is->cell_deepest = 0.51e-9;
    assert_false(is_wrong(&s));
    is->deepest = 0.49e-9;
    assert_true(is_wrong(&s));
    is->deepest = 1e-9;
    is->cell_deepest = 0.49e-9;
    assert_true(is_wrong(&s));
    is->cell_deepest = 1e-9;
    is->bead_contacts = 1;
    assert_true(is_wrong(&s));
    is->bead_contacts = 3;
    is->cell_count = 1;
    assert_true(is_wrong(&s));
    is->cell_count = 3;
    assert_false(is_wrong(&s));
}

/* What moves back at the end of a step that took it off has been thrown off, by
   however little; if it touches nothing else. */
static void test_thrown(void **unused)
{
    const double axis[3] = {1, 0, 0};
    released_step s = let_go(1e-3);
    int *const touched[2] = {&s.next.contact.surface_count,
                             &s.next.contact.cell_count};

    (void)unused;
    ellipsoid_set(s.start.contact.force, 0, 0, 1e-12);
    ellipsoid_set(s.next.state.u, 0, 0, -1e-3 * distance / interval);
    move(&s, (double[3]){0, 0, distance}, axis, 0);
    assert_true(is_wrong(&s));
    for (int n = 0; n < 2; n++)
    {
        *touched[n] = 1;
        assert_false(is_wrong(&s));
        *touched[n] = 0;
    }
    s.next.state.u[2] *= -1;
    assert_false(is_wrong(&s));
    s.next.state.u[2] *= -1;
    move(&s, (double[3]){0, 0, -distance}, axis, 0);
    assert_false(is_wrong(&s));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_force),   cmocka_unit_test(test_torque),
        cmocka_unit_test(test_sum),     cmocka_unit_test(test_slight),
        cmocka_unit_test(test_inertia), cmocka_unit_test(test_kept),
        cmocka_unit_test(test_thrown),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
