/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_threads.c - the core keeps nothing of its own: threads that share the
    models, the flow and the facets of the walls find, to the last bit, what one
    finds alone.
*/
#define _POSIX_C_SOURCE 200809L

#include <pthread.h>
#include <stdlib.h>

#include "coreTest.h"
#include "wallMesh.h"

enum
{
    CELLS = 48,
    THREADS = 7, /* no multiple of the kinds of cells */
    SLICES = 50
};

static const double um = 1e-6;

/* What all share; nobody writes to it. */
typedef struct common
{
    ellipsoid_model model[4];
    test_quadratic flow;
    wall_mesh mesh;
    pthread_barrier_t start;
} common;

/* All that is one cell's, and a digest of all its steps. */
typedef struct cell
{
    ellipsoid_state state;
    ellipsoid_controller controller;
    ellipsoid_statistics statistics;
    ellipsoid_facet_cache cache;
    double t, uniform[3];
    uint64_t digest;
    ellipsoid_status status;
    int overlaps;
} cell;

/* One thread's share of the cells: every THREADS-th, or all. */
typedef struct worker
{
    common *shared;
    cell *cells;
    int first, stride;
} worker;

/* A field that turns and carries: uniform, and stronger with height. */
static int field_of(void *context, double t, const double x[3], double field[3],
                    double (*jacobian)[3])
{
    const double *slope = context;

    (void)t;
    field[0] = 2e3;
    field[1] = -1e3;
    field[2] = *slope * x[2];
    if (jacobian)
    {
        memset(jacobian, 0, sizeof(double[3][3]));
        jacobian[2][2] = *slope;
    }
    return 0;
}

/* FNV-1a, over the doubles of a step. */
static int digest(void *context, const ellipsoid_step *step)
{
    cell *c = context;
    const void *parts[] = {&step->end, &step->after, step->dense,
                           step->contact.force, step->contact.torque};
    const size_t sizes[] = {sizeof(step->end), sizeof(step->after),
                            sizeof(step->dense), sizeof(step->contact.force),
                            sizeof(step->contact.torque)};

    for (int n = 0; n < 5; n++)
    {
        for (size_t i = 0; i < sizes[n]; i++)
        {
            c->digest ^= ((const unsigned char *)parts[n])[i];
            c->digest *= 0x100000001b3u;
        }
    }
    return 0;
}

/*
    Cells of all kinds in turn, each a slice further: so the calls of one thread
    leave something of another cell behind, if they could. The list of facets is
    the callback's memory and so the thread's own.
*/
static void *work(void *context)
{
    const worker *w = context;
    common *shared = w->shared;
    double slope = 1e9;
    wall_mesh mesh = shared->mesh;
    ellipsoid_surroundings around = {.flow = test_quadratic_flow,
                                     .flow_context = &shared->flow,
                                     .walls = wall_mesh_list,
                                     .walls_context = &mesh,
                                     .field = field_of,
                                     .field_context = &slope};

    mesh.listed = malloc((size_t)mesh.count * sizeof(*mesh.listed));
    if (w->stride > 1)
    {
        pthread_barrier_wait(&shared->start);
    }
    for (int slice = 1; mesh.listed && slice <= SLICES; slice++)
    {
        for (int n = w->first; n < CELLS; n += w->stride)
        {
            const ellipsoid_model *m = &shared->model[n % 4];
            cell *c = &w->cells[n];

            around.id = (uint32_t)n;
            ellipsoid_random_uniform(1, (uint32_t)n, 0, (uint32_t)slice, 3,
                                     c->uniform);
            c->status = ellipsoid_advance(
                &(ellipsoid_member){m, &around, &c->state, &c->controller,
                                    &c->cache, c, &c->statistics},
                &c->t, slice * 0.02 / SLICES, digest);
            if (c->status == ELLIPSOID_OK)
            {
                c->status = ellipsoid_overlaps_walls(m, &around, c->state.x,
                                                     c->state.q, &c->overlaps);
            }
        }
    }
    free(mesh.listed);
    return NULL;
}

static void place_cells(cell cells[CELLS])
{
    for (int n = 0; n < CELLS; n++)
    {
        uint64_t seed = 1000 + (uint64_t)n;
        cell *c = &cells[n];

        memset(c, 0, sizeof(*c));
        ellipsoid_facet_cache_clear(&c->cache);
        for (int i = 0; i < 3; i++)
        {
            c->state.x[i] = 3 * um * test_signed(&seed);
        }
        test_orientation(&seed, c->state.q);
        c->digest = 0xcbf29ce484222325u;
        c->status = ELLIPSOID_STATUS_COUNT;
    }
}

/* With inertia; with Brownian motion; without inertia; and without in a flow
   averaged over the whole surface. */
static void prepare(common *shared)
{
    const double low[3] = {-6 * um, -6 * um, -6 * um};
    const double high[3] = {6 * um, 6 * um, 6 * um};
    ellipsoid_options o = test_paper_options();

    o.charge = 1e-16;
    o.dipole[1] = 1e-21;
    shared->model[0] = test_model(&o);
    o.brownian = 1;
    shared->model[1] = test_model(&o);
    o.brownian = 0;
    o.motion = ELLIPSOID_MOTION_INERTIALESS;
    shared->model[2] = test_model(&o);
    o.flow_at = ELLIPSOID_FLOW_BODY;
    shared->model[3] = test_model(&o);
    /* a shear that carries them against the walls, and vortices */
    shared->flow = test_shear(1000);
    shared->flow.u[1] = 2e-3;
    shared->flow.h[2][0][1] = shared->flow.h[2][1][0] = 1e8;
    wall_mesh_init(&shared->mesh);
    wall_mesh_box(&shared->mesh, low, high, 1, 0, 1);
    wall_mesh_finish(&shared->mesh);
    assert_int_equal(pthread_barrier_init(&shared->start, NULL, THREADS), 0);
}

static void compare(const cell *a, const cell *b)
{
    assert_ok(a->status);
    assert_ok(b->status);
    assert_memory_equal(&a->state, &b->state, sizeof(a->state));
    assert_memory_equal(&a->t, &b->t, sizeof(a->t));
    assert_memory_equal(&a->controller, &b->controller, sizeof(a->controller));
    assert_memory_equal(&a->statistics, &b->statistics, sizeof(a->statistics));
    assert_memory_equal(a->uniform, b->uniform, sizeof(a->uniform));
    assert_int_equal(a->overlaps, b->overlaps);
    assert_true(a->digest == b->digest);
}

static void test_threads(void **unused)
{
    static cell alone[CELLS], together[CELLS];
    common shared;
    worker one = {&shared, alone, 0, 1}, many[THREADS];
    pthread_t threads[THREADS];
    long steps = 0;
    int touched = 0;

    (void)unused;
    prepare(&shared);
    place_cells(alone);
    work(&one);
    for (int round = 0; round < 3; round++)
    {
        place_cells(together);
        for (int n = 0; n < THREADS; n++)
        {
            many[n] = (worker){&shared, together, n, THREADS};
            assert_int_equal(pthread_create(&threads[n], NULL, work, &many[n]),
                             0);
        }
        for (int n = 0; n < THREADS; n++)
        {
            assert_int_equal(pthread_join(threads[n], NULL), 0);
        }
        for (int n = 0; n < CELLS; n++)
        {
            compare(&together[n], &alone[n]);
        }
    }
    for (int n = 0; n < CELLS; n++)
    {
        steps += alone[n].statistics.accepted;
        touched += alone[n].statistics.deepest > 0;
    }
    print_message("# %d cells, %ld steps, %d touch a wall\n", CELLS, steps,
                  touched);
    assert_true(touched > CELLS / 2);
    pthread_barrier_destroy(&shared.start);
    wall_mesh_free(&shared.mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_threads),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
