/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_advance.c - step control: where a run ends, what it does when the
    callbacks fail, and that it can be cut and continued.
*/
#include "coreTest.h"

/* A shear that fails as told. */
typedef struct trouble
{
    test_quadratic shear;
    double limit; /* [m] trouble where x1 is beyond this */
    int answer;   /* what it answers there */
    double bad;   /* added to the velocity there */
    long calls;
} trouble;

static int troubled_flow(void *context, double t, const double x[3],
                         int derivatives, ellipsoid_flow_sample *sample)
{
    trouble *where = context;

    where->calls++;
    assert_true(isfinite(x[0] + x[1] + x[2])); /* never asked at nowhere */
    test_quadratic_flow(&where->shear, t, x, derivatives, sample);
    if (x[0] > where->limit)
    {
        sample->velocity[0] += where->bad;
        return where->answer;
    }
    return 0;
}

typedef struct run
{
    ellipsoid_model model;
    ellipsoid_state state;
    ellipsoid_controller controller;
    ellipsoid_statistics statistics;
    trouble trouble;
    double t;
} run;

/* The paper's cell in u = 4 mm/s + shear, started at the fluid's velocity. */
static run new_run(void)
{
    ellipsoid_options o = test_free_cell();
    run r;

    memset(&r, 0, sizeof(r));
    o.tolerance = 1e-6;
    r.model = test_model(&o);
    r.trouble.shear = test_shear(1000);
    r.trouble.shear.u[0] = 4e-3;
    r.trouble.limit = INFINITY;
    r.state.u[0] = 4e-3;
    r.state.q[0] = 0.6;
    r.state.q[3] = 0.8;
    return r;
}

static ellipsoid_status go(run *r, double end, ellipsoid_observer observer,
                           void *context)
{
    const ellipsoid_surroundings around = {.flow = troubled_flow,
                                           .flow_context = &r->trouble};

    return ellipsoid_advance(&(ellipsoid_member){&r->model, &around, &r->state,
                                                 &r->controller, NULL, context,
                                                 &r->statistics},
                             &r->t, end, observer);
}

/* --------------------------------------------------------------- the end */

typedef struct record
{
    int count;
    int stop_at; /* stops when so many steps are seen */
    double t[4096], shortest, longest;
    ellipsoid_state state;
} record;

static int observe(void *context, const ellipsoid_step *step)
{
    record *l = context;
    const double h = step->end - step->start;

    assert_true(h > 0);
    if (l->count > 0)
    {
        /* steps join */
        assert_true(step->start == l->t[l->count - 1]);
        assert_memory_equal(&step->before, &l->state, sizeof(l->state));
    }
    l->shortest = l->count ? fmin(l->shortest, h) : h;
    l->longest = fmax(l->longest, h);
    l->state = step->after;
    l->t[l->count++] = step->end;
    return l->count == l->stop_at;
}

static void test_lands_on_end(void **unused)
{
    (void)unused;
    for (int n = 1; n < 200; n++)
    {
        run r = new_run();
        static record l;
        const double end = 1e-9 * pow(1.1, n);

        memset(&l, 0, sizeof(l));
        assert_ok(go(&r, end, observe, &l));
        assert_true(r.t == end);
        assert_true(l.t[l.count - 1] == end);
        assert_memory_equal(&l.state, &r.state, sizeof(r.state));
    }
}

/* No tiny last step: it is at least a quarter of the one before, or it would
   have been shared. */
static void test_no_tiny_last_step(void **unused)
{
    (void)unused;
    for (int n = 0; n < 200; n++)
    {
        run r = new_run();
        static record l;
        double last, before;

        memset(&l, 0, sizeof(l));
        assert_ok(go(&r, 0.01 + 1e-5 * n, observe, &l));
        last = l.t[l.count - 1] - l.t[l.count - 2];
        before = l.t[l.count - 2] - l.t[l.count - 3];
        assert_true(last >= 0.2 * before);
    }
}

/* The controller survives a truncated step: many short calls end with a step
   proposal as long as one call's. */
static void test_short_calls_keep_the_proposal(void **unused)
{
    run once = new_run(), often = new_run();
    double proposal;

    (void)unused;
    assert_ok(go(&once, 0.002, NULL, NULL));
    assert_ok(go(&often, 0.002, NULL, NULL));
    proposal = often.controller.step;
    for (int n = 1; n <= 1000; n++)
    {
        assert_ok(go(&often, 0.002 + 1e-8 * n, NULL, NULL));
    }
    assert_true(often.controller.step >= proposal);
}

static void test_nothing_to_do(void **unused)
{
    run r = new_run();
    const ellipsoid_state before = r.state;

    (void)unused;
    assert_ok(go(&r, 0, NULL, NULL));
    assert_ok(go(&r, -1, NULL, NULL));
    assert_int_equal(go(&r, NAN, NULL, NULL), ELLIPSOID_NON_FINITE);
    assert_int_equal(go(&r, INFINITY, NULL, NULL), ELLIPSOID_NON_FINITE);
    assert_memory_equal(&r.state, &before, sizeof(before));
    assert_true(r.t == 0 && r.controller.step == 0 && r.statistics.rhs == 0);
}

/* ------------------------------------------------------------ continuation */

/* Stopped by the observer after any step and continued with what the caller
   holds: the same bits at the end. */
static void test_cut_by_observer(void **unused)
{
    run whole = new_run();

    (void)unused;
    assert_ok(go(&whole, 0.02, NULL, NULL));
    for (int stop = 1; stop < whole.statistics.accepted; stop += 7)
    {
        run r = new_run(), continued = new_run();
        static record l;

        memset(&l, 0, sizeof(l));
        l.stop_at = stop;
        assert_int_equal(go(&r, 0.02, observe, &l), ELLIPSOID_STOPPED);
        assert_true(r.t == l.t[stop - 1]);
        continued.t = r.t;
        continued.state = r.state;
        continued.controller = r.controller;
        assert_ok(go(&continued, 0.02, NULL, NULL));
        assert_memory_equal(&continued.state, &whole.state,
                            sizeof(whole.state));
        assert_memory_equal(&continued.controller, &whole.controller,
                            sizeof(whole.controller));
        assert_int_equal(continued.statistics.accepted + stop,
                         whole.statistics.accepted);
    }
}

/* The same where the pieces end at the ends of steps. */
static void test_cut_by_end(void **unused)
{
    run whole = new_run(), pieces = new_run();
    static record l;

    (void)unused;
    memset(&l, 0, sizeof(l));
    assert_ok(go(&whole, 0.02, observe, &l));
    for (int n = 0; n < l.count - 2; n += 5)
    {
        assert_ok(go(&pieces, l.t[n], NULL, NULL));
    }
    assert_ok(go(&pieces, 0.02, NULL, NULL));
    assert_memory_equal(&pieces.state, &whole.state, sizeof(whole.state));
}

/* ----------------------------------------------------------------- trouble */

/* On a failure everything is as after the last accepted step, which the
   observer has seen. */
static void check_failure(run *r, ellipsoid_status expected, double end)
{
    static record l;

    memset(&l, 0, sizeof(l));
    assert_int_equal(go(r, end, observe, &l), expected);
    if (l.count > 0)
    {
        assert_true(r->t == l.t[l.count - 1]);
        assert_memory_equal(&r->state, &l.state, sizeof(l.state));
    }
    assert_true(r->state.x[0] <= r->trouble.limit);
    assert_true(r->t < end);
}

/* +1 beyond a line: the cell creeps up to it, until the step underflows. */
static void test_shorten(void **unused)
{
    run r = new_run();

    (void)unused;
    r.trouble.limit = 1e-5;
    r.trouble.answer = 1;
    check_failure(&r, ELLIPSOID_STEP_UNDERFLOW, 0.1);
    assert_near(r.state.x[0], 1e-5, 1e-15);
    assert_true(r.statistics.rejected > 10);
}

static void test_give_up(void **unused)
{
    run r = new_run();

    (void)unused;
    r.trouble.limit = 1e-5;
    r.trouble.answer = -1;
    check_failure(&r, ELLIPSOID_FLOW_FAILED, 0.1);
}

static void test_not_finite(void **unused)
{
    const double bad[] = {NAN, INFINITY, -INFINITY};

    (void)unused;
    for (int n = 0; n < 3; n++)
    {
        run r = new_run();

        r.trouble.limit = 1e-5;
        r.trouble.bad = bad[n];
        check_failure(&r, ELLIPSOID_NON_FINITE, 0.1);
        assert_near(r.state.x[0], 1e-5, 1e-15);
    }
}

/* Trouble at the very start leaves all as it was. */
static void test_trouble_at_start(void **unused)
{
    const int answers[] = {1, -1, 0};
    const ellipsoid_status expected[] = {
        ELLIPSOID_OUTSIDE, ELLIPSOID_FLOW_FAILED, ELLIPSOID_NON_FINITE};

    (void)unused;
    for (int n = 0; n < 3; n++)
    {
        run r = new_run(), before;

        r.trouble.limit = -1;
        r.trouble.answer = answers[n];
        r.trouble.bad = NAN;
        before = r;
        assert_int_equal(go(&r, 1, NULL, NULL), expected[n]);
        assert_memory_equal(&r.state, &before.state, sizeof(r.state));
        assert_true(r.t == 0 && r.controller.step == 0);
    }
}

static void test_bad_state(void **unused)
{
    const double bad[] = {NAN, INFINITY};

    (void)unused;
    for (int i = 0; i < ELLIPSOID_STATE_SIZE; i++)
    {
        for (int n = 0; n < 2; n++)
        {
            run r = new_run();
            double y[ELLIPSOID_STATE_SIZE];

            memcpy(y, &r.state, sizeof(y));
            y[i] = bad[n];
            memcpy(&r.state, y, sizeof(y));
            assert_int_equal(go(&r, 1, NULL, NULL), ELLIPSOID_BAD_STATE);
            assert_int_equal(r.trouble.calls, 0);
        }
    }
    {
        run r = new_run();

        memset(r.state.q, 0, sizeof(r.state.q));
        assert_int_equal(go(&r, 1, NULL, NULL), ELLIPSOID_BAD_STATE);
    }
}

/* What must not be NULL is refused, and what may be is not missed. */
static void test_null(void **unused)
{
    run r = new_run();
    const ellipsoid_surroundings around = {.flow = troubled_flow,
                                           .flow_context = &r.trouble};
    const ellipsoid_member all = {&r.model, &around, &r.state, &r.controller,
                                  NULL,     NULL,    NULL};
    double t = 0;

    (void)unused;
    assert_ok(ellipsoid_advance(&(ellipsoid_member){all.model, all.surroundings,
                                                    all.state, all.controller,
                                                    NULL, NULL, NULL},
                                &t, 1e-4, NULL));
    assert_true(t == 1e-4);
    assert_int_equal(ellipsoid_advance(NULL, &t, 2e-4, NULL),
                     ELLIPSOID_BAD_ARGUMENT);
    for (int n = 0; n < 5; n++)
    {
        assert_int_equal(
            ellipsoid_advance(
                &(ellipsoid_member){
                    n == 0 ? NULL : all.model, n == 1 ? NULL : all.surroundings,
                    n == 2 ? NULL : all.state, n == 4 ? NULL : all.controller,
                    NULL, NULL, NULL},
                n == 3 ? NULL : &t, 2e-4, NULL),
            ELLIPSOID_BAD_ARGUMENT);
        assert_true(t == 1e-4);
    }
    assert_int_equal(ellipsoid_model_init(&r.model, NULL),
                     ELLIPSOID_BAD_ARGUMENT);
    assert_int_equal(ellipsoid_options_check(NULL, NULL, NULL),
                     ELLIPSOID_BAD_ARGUMENT);
}

/* Memory grows with the square of the count; there is none for a group that
   cannot be. */
static void test_group_size(void **unused)
{
    const double one = (double)ellipsoid_group_size(50000);
    const double two = (double)ellipsoid_group_size(100000);

    (void)unused;
    assert_true(two / one > 3.9 && two / one < 4);
    assert_true(ellipsoid_group_size(0) == 0);
    assert_true(ellipsoid_group_size(ELLIPSOID_MAX_GROUP + 1) == 0);
}

/* A wall of trouble that is left in time is passed: the run goes on. */
static int flicker(void *context, double t, const double x[3], int derivatives,
                   ellipsoid_flow_sample *sample)
{
    trouble *where = context;

    test_quadratic_flow(&where->shear, t, x, derivatives, sample);
    return ++where->calls % 31 == 0;
}

static void test_passing_trouble(void **unused)
{
    run r = new_run();
    const ellipsoid_surroundings around = {.flow = flicker,
                                           .flow_context = &r.trouble};

    (void)unused;
    assert_ok(ellipsoid_advance(&(ellipsoid_member){&r.model, &around, &r.state,
                                                    &r.controller, NULL, NULL,
                                                    &r.statistics},
                                &r.t, 0.001, NULL));
    assert_true(r.t == 0.001);
    assert_true(r.statistics.rejected > 5);
}

static void test_too_many_steps(void **unused)
{
    run r = new_run();

    (void)unused;
    r.model.options.maximum_steps = 17;
    check_failure(&r, ELLIPSOID_TOO_MANY_STEPS, 0.1);
    assert_int_equal(r.statistics.accepted + r.statistics.rejected, 17);
    r.model.options.maximum_steps = 10000000;
    assert_ok(go(&r, 0.1, NULL, NULL));
}

/* At a large t a step below its rounding is an underflow, not an endless
   loop. */
static void test_time_too_coarse(void **unused)
{
    run r = new_run();

    (void)unused;
    r.trouble.limit = 1e-5;
    r.trouble.answer = 1;
    r.t = 1e6;
    assert_int_equal(go(&r, 1e6 + 1, NULL, NULL), ELLIPSOID_STEP_UNDERFLOW);
}

static void test_step_limits(void **unused)
{
    run r = new_run();
    static record l;

    (void)unused;
    memset(&l, 0, sizeof(l));
    r.model.options.maximum_step = 1e-5;
    assert_ok(go(&r, 0.005, observe, &l));
    assert_true(l.longest <= 1e-5 * (1 + 1e-9));
    /* chosen: a quarter of the shorter relaxation time */
    assert_relative(l.t[0], 0.25 * r.model.rotation_relaxation_time, 1e-15);

    r = new_run();
    memset(&l, 0, sizeof(l));
    r.controller.step = 3e-9;
    assert_ok(go(&r, 0.005, observe, &l));
    assert_true(l.t[0] == 3e-9);
}

/* Evaluations: one Jacobian and six right-hand sides a step, of which the one
   at its end serves the next. */
static void test_cost(void **unused)
{
    run r = new_run();
    long steps, rejected;

    (void)unused;
    assert_ok(go(&r, 0.02, NULL, NULL));
    steps = r.statistics.accepted;
    rejected = r.statistics.rejected;
    assert_int_equal(r.statistics.jacobians, steps);
    assert_int_equal(r.statistics.rhs, 6 * steps + 5 * rejected + 1);
    assert_int_equal(r.trouble.calls, r.statistics.rhs);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lands_on_end),
        cmocka_unit_test(test_no_tiny_last_step),
        cmocka_unit_test(test_short_calls_keep_the_proposal),
        cmocka_unit_test(test_nothing_to_do),
        cmocka_unit_test(test_cut_by_observer),
        cmocka_unit_test(test_cut_by_end),
        cmocka_unit_test(test_shorten),
        cmocka_unit_test(test_give_up),
        cmocka_unit_test(test_not_finite),
        cmocka_unit_test(test_trouble_at_start),
        cmocka_unit_test(test_bad_state),
        cmocka_unit_test(test_null),
        cmocka_unit_test(test_group_size),
        cmocka_unit_test(test_passing_trouble),
        cmocka_unit_test(test_too_many_steps),
        cmocka_unit_test(test_time_too_coarse),
        cmocka_unit_test(test_step_limits),
        cmocka_unit_test(test_cost),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
