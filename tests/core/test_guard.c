/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_guard.c - long steps beside walls: none is passed unseen, a cell at
    rest costs nothing, and a run beside walls can be cut and continued.
*/
#include "contactTest.h"

/* A plate across x1 = 0, 0.1 um thick: thinner than one bead. */
static void make_plate(wall_mesh *mesh)
{
    const double low[3] = {0, -20e-6, -20e-6};
    const double high[3] = {0.1e-6, 20e-6, 20e-6};

    wall_mesh_init(mesh);
    wall_mesh_box(mesh, low, high, 0, 0, 7);
    wall_mesh_finish(mesh);
}

typedef struct run
{
    ellipsoid_model model;
    ellipsoid_surroundings around;
    ellipsoid_state state;
    ellipsoid_controller controller;
    ellipsoid_statistics statistics;
    test_quadratic flow;
    wall_mesh mesh;
    double t;
} run;

/* 8 um before the plate, in a uniform flow that goes straight through it. */
static void new_run(run *r, ellipsoid_motion motion, int seed, double speed)
{
    ellipsoid_options o = test_paper_options();
    uint64_t number = (uint64_t)seed;

    memset(r, 0, sizeof(*r));
    o.buoyancy = 0;
    o.motion = motion;
    r->model = test_model(&o);
    make_plate(&r->mesh);
    r->around.flow = test_quadratic_flow;
    r->around.flow_context = &r->flow;
    r->around.walls = wall_mesh_list;
    r->around.walls_context = &r->mesh;
    r->flow.u[0] = speed;
    r->state.u[0] = speed;
    r->state.x[0] = -8e-6;
    test_orientation(&number, r->state.q);
}

static ellipsoid_status go(run *r, double end, ellipsoid_facet_cache *cache,
                           ellipsoid_observer observer, void *context)
{
    return ellipsoid_advance(
        &(ellipsoid_member){&r->model, &r->around, &r->state, &r->controller,
                            cache, context, &r->statistics},
        &r->t, end, observer);
}

/*
    In a uniform flow nothing but the guard holds back the step, which would
    be some body lengths. Whatever the orientation and the speed, the cell is
    stopped before the plate: its centre stays half a short axis away at least.
*/
static void test_thin_plate(void **motion)
{
    static ellipsoid_facet_cache cache;
    static run r;

    for (int n = 0; n < 60; n++)
    {
        const double speed = 4e-4 * pow(10, n % 3);

        new_run(&r, *(ellipsoid_motion *)*motion, n, speed);
        ellipsoid_facet_cache_clear(&cache);
        assert_ok(go(&r, 40e-6 / speed, &cache, NULL, NULL));
        assert_true(r.state.x[0] < -0.25e-6);
        assert_true(r.state.x[0] > -2.5e-6);
        assert_true(r.statistics.deepest > 0);
        wall_mesh_free(&r.mesh);
    }
}

/* Pressed into a corner of a box, at rest: a thousand seconds cost a few
   steps. */
static void test_rest_is_free(void **motion)
{
    static ellipsoid_facet_cache cache;
    static run r;
    const double low[3] = {-10e-6, -10e-6, -10e-6};
    const double high[3] = {10e-6, 10e-6, 10e-6};
    long steps;

    new_run(&r, *(ellipsoid_motion *)*motion, 5, 4e-3);
    wall_mesh_free(&r.mesh);
    wall_mesh_init(&r.mesh);
    wall_mesh_box(&r.mesh, low, high, 1, 0, 7);
    wall_mesh_finish(&r.mesh);
    r.state.x[0] = 0;
    r.flow.u[1] = 3e-3;
    r.flow.u[2] = 1e-3;
    r.model.options.maximum_step = 1e9;
    ellipsoid_facet_cache_clear(&cache);
    assert_ok(go(&r, 1, &cache, NULL, NULL));
    steps = r.statistics.accepted + r.statistics.rejected;
    assert_ok(go(&r, 1000, &cache, NULL, NULL));
    print_message("# to rest: %ld steps, 1000 s at rest: %ld steps\n", steps,
                  r.statistics.accepted + r.statistics.rejected - steps);
    assert_true(r.statistics.accepted + r.statistics.rejected - steps < 20);
    assert_true(ellipsoid_length(r.state.u) < 1e-12);
    wall_mesh_free(&r.mesh);
}

static int note_overlap(void *context, const ellipsoid_step *step)
{
    double *deepest = context;

    *deepest = fmax(*deepest, step->contact.cell_deepest);
    return 0;
}

/*
    Two balls of radius r, each in a uniform flow of its own, pass one another
    1.8 r beside: they touch over 2 sqrt(4 - 1.8^2) r = 1.74 r of their way, which
    the guard has to see though nothing else holds back steps. Their gaps and a
    bead radius they may travel unseen.
*/
static void test_balls_that_pass(void **unused)
{
    void *memory = malloc(ellipsoid_group_size(2));
    const double speed = 1e-3, radius = 0.5e-6;
    ellipsoid_options o = contact_ball(radius, 1040);

    (void)unused;
    o.buoyancy = 0;

    const ellipsoid_model model = test_model(&o);

    for (int n = 0; n < 100; n++)
    {
        test_quadratic flow[2] = {{.u = {speed}}, {.u = {-speed}}};
        ellipsoid_surroundings around[2];
        ellipsoid_state state[2];
        ellipsoid_controller controller[2] = {{0, 0}, {0, 0}};
        ellipsoid_statistics statistics[2] = {{0}, {0}};
        ellipsoid_member member[2];
        double t = 0, deepest = 0;
        int which;

        for (int k = 0; k < 2; k++)
        {
            const double side = k ? 1 : -1;

            around[k] = (ellipsoid_surroundings){.flow = test_quadratic_flow,
                                                 .flow_context = &flow[k]};
            state[k] = (ellipsoid_state){
                .u = {-side * speed},
                .x = {side * (5 + 0.01 * n) * radius, side * 0.9 * radius},
                .q = {0, 0, 0, 1}};
            member[k] = (ellipsoid_member){
                &model, &around[k], &state[k],     &controller[k],
                NULL,   &deepest,   &statistics[k]};
        }
        assert_ok(ellipsoid_advance_group(2, member, &t, 20 * radius / speed,
                                          note_overlap, memory, &which));
        assert_true(deepest > 0);
    }
    free(memory);
}

static int stop_at(void *context, const ellipsoid_step *step)
{
    int *left = context;

    (void)step;
    return --*left == 0;
}

/* Stopped and continued with an empty cache: the same bits. */
static void test_cut_beside_a_wall(void **motion)
{
    static ellipsoid_facet_cache cache;
    static run whole, r;

    new_run(&whole, *(ellipsoid_motion *)*motion, 11, 4e-3);
    ellipsoid_facet_cache_clear(&cache);
    assert_ok(go(&whole, 0.01, &cache, NULL, NULL));
    for (int stop = 1; stop < whole.statistics.accepted; stop += 11)
    {
        int left = stop;

        new_run(&r, *(ellipsoid_motion *)*motion, 11, 4e-3);
        ellipsoid_facet_cache_clear(&cache);
        assert_int_equal(go(&r, 0.01, &cache, stop_at, &left),
                         ELLIPSOID_STOPPED);
        ellipsoid_facet_cache_clear(&cache);
        assert_ok(go(&r, 0.01, &cache, NULL, NULL));
        assert_memory_equal(&r.state, &whole.state, sizeof(r.state));
        wall_mesh_free(&r.mesh);
    }
    wall_mesh_free(&whole.mesh);
}

static ellipsoid_motion inertial = ELLIPSOID_MOTION_INERTIAL;
static ellipsoid_motion inertialess = ELLIPSOID_MOTION_INERTIALESS;

#define WITH_BOTH(test)                                                        \
    {#test ", inertial", test, NULL, NULL, &inertial},                         \
    {                                                                          \
#test ", inertialess", test, NULL, NULL, &inertialess                  \
    }

int main(void)
{
    const struct CMUnitTest tests[] = {
        WITH_BOTH(test_thin_plate),
        cmocka_unit_test(test_balls_that_pass),
        WITH_BOTH(test_rest_is_free),
        WITH_BOTH(test_cut_beside_a_wall),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
