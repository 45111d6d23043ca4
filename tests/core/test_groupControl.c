/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_groupControl.c - the steps of a group are those that each of its cells
    allows, in whatever order they come; one that was rejected leaves nothing; how
    large an error is.
*/
#include "groupTest.h"
#include "nearWallTest.h"

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

/* The step after a first one, of two cells with these errors before. */
static double step_after(const double before[2])
{
    const ellipsoid_options o = test_free_cell();
    const test_quadratic flow = test_shear(100);
    const double h = 2e-4;
    double t = 0, step;
    crowd c;

    crowd_init(&c, 2, &o, &flow);
    c.state[1].x[2] = 50e-6;
    for (int cell = 0; cell < 2; cell++)
    {
        c.controller[cell] = (ellipsoid_controller){h, before[cell]};
    }
    crowd_advance(&c, &t, h, NULL);
    assert_true(c.statistics[0].accepted == 1);
    step = c.controller[0].step;
    crowd_free(&c);
    return step / h;
}

/* PI control is told of the larger of the errors before. */
static void test_larger_error_before(void **unused)
{
    const double small = 1e-4, large = 0.9;
    const double both = step_after((double[2]){large, large});

    (void)unused;
    assert_true(step_after((double[2]){small, small}) < 0.9 * both);
    assert_true(step_after((double[2]){small, large}) == both);
    assert_true(step_after((double[2]){large, small}) == both);
}

static ellipsoid_step first_step;

static int note_first(void *context, const ellipsoid_step *step)
{
    (void)context;
    first_step = first_step.end > 0 ? first_step : *step;
    return 0;
}

/* Two spheres that overlap and that a flow takes apart; the first step that is
   accepted. Returns how many were rejected. */
static long let_go(double step)
{
    ellipsoid_options o = touching_cell();
    test_quadratic flow = {.answer = 0};
    double t = 0;
    long rejected;
    crowd c;

    o.contact_shape = ELLIPSOID_CONTACT_ELLIPSOID;
    o.motion = ELLIPSOID_MOTION_INERTIALESS;
    o.tolerance = 1e-4;
    o.semi_axes[1] = o.semi_axes[0];
    flow.g[0][0] = 100;
    flow.g[1][1] = -100;
    crowd_init(&c, 2, &o, &flow);
    c.state[0].x[0] = o.semi_axes[0] - 0.5e-9;
    c.state[1].x[0] = -c.state[0].x[0];
    c.controller[0].step = c.controller[1].step = step;
    first_step.end = 0;
    crowd_advance(&c, &t, 0.01, note_first);
    rejected = c.statistics[0].rejected;
    crowd_free(&c);
    return rejected;
}

/* A step that is taken again after it was rejected where it ended is that of a
   run that begins with it. */
static void test_after_rejection(void **unused)
{
    ellipsoid_step again;

    (void)unused;
    assert_true(let_go(1e-3) > 0);
    again = first_step;
    assert_true(again.end < 5e-4);
    let_go(again.end);
    assert_true(first_step.end == again.end);
    assert_memory_equal(&first_step.after, &again.after, sizeof(again.after));
}

/* A cell alone, and what it takes to judge a step of it. */
typedef struct judged
{
    ellipsoid_cell cell;
    ellipsoid_evaluation start, next;
    ellipsoid_stages stages;
} judged;

static ellipsoid_group group_of(judged *j)
{
    return (ellipsoid_group){.count = 1,
                             .cell = &j->cell,
                             .start = &j->start,
                             .next = &j->next,
                             .stages = &j->stages};
}

/* Errors of x count by the length and of q as they are; those of u and omega by
   what they do in a relaxation time or a step, whichever is shorter. */
static void test_size_of_errors(void **unused)
{
    const ellipsoid_options o = test_free_cell();
    const ellipsoid_model model = test_model(&o);
    const double length = 2e-6, h[2] = {1e-9, 1e-3};
    const double tau[2] = {3e-7, 2e-8};

    (void)unused;
    for (int n = 0; n < 2; n++)
    {
        const double each[4] = {length, length / fmin(tau[0], h[n]),
                                1 / fmin(tau[1], h[n]), 1};
        const int at[4] = {AT_X, AT_U, AT_OMEGA, AT_Q};

        for (int kind = 0; kind < 4; kind++)
        {
            judged j = {.cell = {.model = &model,
                                 .length = length,
                                 .rate = 1 / tau[0],
                                 .rotation_rate = 1 / tau[1],
                                 .inertial = 1}};
            const ellipsoid_group g = group_of(&j);
            double error;

            j.stages.error[at[kind] + 1] = -0.7 * each[kind] * o.tolerance;
            assert_ok(ellipsoid_judge_step(&g, h[n], &error));
            assert_relative(error, 0.7, 1e-12);
        }
    }
}

/* Where friction acts, errors of the velocities are to be below the slip speed, or
   a tenth of the speed with which the slowest contact slides. */
static void test_errors_in_contact(void **unused)
{
    const double slip_speed = 1e-7, length = 2e-6;
    const double slip[3] = {slip_speed, 5e-5, 2e-5};
    ellipsoid_options o = test_paper_options();
    ellipsoid_model model;

    (void)unused;
    o.friction = 0.3;
    o.slip_speed = slip_speed;
    model = test_model(&o);
    for (int n = 0; n < 6; n++)
    {
        const double allowed = fmax(slip_speed, 0.1 * slip[n / 2]);
        judged j = {.cell = {.model = &model,
                             .length = length,
                             .rate = 1e7,
                             .rotation_rate = 1e8,
                             .inertial = 1}};
        const ellipsoid_group g = group_of(&j);
        double error;

        j.start.contact = ellipsoid_no_contact();
        j.start.contact.bead_contacts = 1;
        j.start.contact.slip = n < 4 ? slip[n / 2] : slip[1];
        j.start.contact.cell_slip = n < 4 ? HUGE_VAL : slip[2];
        j.stages.error[n % 2 ? AT_OMEGA : AT_U] =
            0.7 * allowed / (n % 2 ? length : 1);
        assert_ok(ellipsoid_judge_step(&g, 1e-5, &error));
        assert_relative(error, 0.7, 1e-12);
    }
}

/* What the drag near walls is expanded wrong by: a third of it over the step,
   by the length or half of the turn; of that of places, the cube of the step. */
static void test_errors_near_walls(void **unused)
{
    const ellipsoid_options o = near_walls();
    const ellipsoid_model model = test_model(&o);
    const double h = 2e-4, per_h = 3 * o.tolerance / h;
    test_quadratic rest = {.answer = 0};
    wall_mesh mesh;

    (void)unused;
    for (int kind = 0; kind < 2; kind++)
    {
        judged j = {.cell = {.model = &model,
                             .surroundings = around(&mesh, &rest),
                             .length = 2e-6}};
        const ellipsoid_group g = group_of(&j);
        const ellipsoid_state here = {.q = {0, 0, 0, 1}};
        ellipsoid_planes none = {.count = 0};
        double error = 0;

        ellipsoid_wall_expansion_set(&model, &none, &here, &j.start.walls);
        j.next.walls = j.start.walls;
        j.next.walls.planes = 1;
        j.next.walls.motion[0] = 1;
        j.next.walls.by[0][kind ? 4 : 2] =
            kind ? 2 * 0.7 * per_h * model.viscosity
                       * model.rotation_resistance[1]
                 : 0.7 * per_h * 2e-6 * model.viscosity * model.resistance[2];
        assert_ok(ellipsoid_judge_expansions(&g, h, &error));
        assert_relative(error, pow(0.7, 4 / 3.0), 1e-12);
    }
}

/* Where friction acts on a body with inertia, so small an error that its contact
   comes to rest lengthens the next step by itself; else with the one before. */
static void test_coming_to_rest(void **unused)
{
    ellipsoid_options o = test_paper_options();

    (void)unused;
    for (int n = 0; n < 16; n++)
    {
        const int rests = n == 0, inertial = !(n & 1), touching = !(n & 2);
        const double error = n & 4 ? 0.11 : 0.09, before = 1e-3;
        ellipsoid_model model;
        judged j = {.cell = {.model = &model, .inertial = inertial}};
        const ellipsoid_group g = group_of(&j);

        o.friction = n & 8 ? 0 : 0.3;
        model = test_model(&o);
        j.start.contact.bead_contacts = touching;
        assert_relative(ellipsoid_step_factor(&g, error, before),
                        0.9 * pow(error, rests ? -1 / 4.0 : -0.7 / 4)
                            * (rests ? 1 : pow(before, 0.4 / 4)),
                        1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_order_does_not_matter),
        cmocka_unit_test(test_larger_error_before),
        cmocka_unit_test(test_after_rejection),
        cmocka_unit_test(test_size_of_errors),
        cmocka_unit_test(test_errors_in_contact),
        cmocka_unit_test(test_errors_near_walls),
        cmocka_unit_test(test_coming_to_rest),
    };

    return cmocka_run_group_tests_name("groupControl", tests, NULL, NULL);
}
