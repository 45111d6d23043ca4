/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    A world of cells: its groups against all gaps, what it advances against
    ellipsoid_advance_group(), and that its result is one of the cells alone.
*/
#include "coreTest.h"

#define MOST 40

/* Cells of one model in one flow, and all that a world needs */
typedef struct scene
{
    ellipsoid_model model;
    ellipsoid_surroundings around[MOST];
    ellipsoid_world_body body[MOST];
    ellipsoid_member member[MOST];
    ellipsoid_world_bodies bodies;
    ellipsoid_world_cells cells;
    void *memory;
    size_t size;
} scene;

/* Towards the plane x1 = 0, and along x3 from it: no divergence. */
static int converging(void *context, double t, const double x[3],
                      int derivatives, ellipsoid_flow_sample *sample)
{
    const double rate = *(const double *)context;

    (void)t;
    (void)derivatives;
    memset(sample, 0, sizeof *sample);
    sample->velocity[0] = -rate * x[0];
    sample->velocity[2] = rate * x[2];
    sample->gradient[0][0] = sample->velocity_jacobian[0][0] = -rate;
    sample->gradient[2][2] = sample->velocity_jacobian[2][2] = rate;
    return 0;
}

static const double rate = 5, still = 0; /* [1/s] */

static void scene_make(scene *s, int count, const double *flow_rate)
{
    ellipsoid_options options = test_paper_options();

    memset(s, 0, sizeof *s);
    options.motion = ELLIPSOID_MOTION_INERTIALESS;
    ellipsoid_set(options.gravity, 0, 0, 0);
    assert_ok(ellipsoid_model_init(&s->model, &options));
    for (int n = 0; n < count; n++)
    {
        s->around[n] = (ellipsoid_surroundings){
            .flow = converging, .flow_context = (void *)flow_rate, .id = n};
        s->body[n].model = &s->model;
        s->body[n].surroundings = &s->around[n];
        s->body[n].state.q[3] = 1;
    }
    s->bodies =
        (ellipsoid_world_bodies){.count = count,
                                 .body = s->body,
                                 .largest = count,
                                 .member = s->member,
                                 .memory = malloc(ellipsoid_group_size(count))};
    ellipsoid_world_cells_set(&s->cells, &s->bodies);
    s->size = ellipsoid_world_size(count, sizeof s->body[0], 1);
    s->memory = malloc(s->size);
}

static void scene_free(scene *s)
{
    free(s->bodies.memory);
    free(s->memory);
}

static void place(scene *s, int n, double x, double y, double z)
{
    ellipsoid_set(s->body[n].state.x, x * 1e-6, y * 1e-6, z * 1e-6);
}

static void advance(scene *s, double start, double end)
{
    assert_ok(
        ellipsoid_world_advance(s->memory, s->size, &s->cells, start, end));
}

/* Cells that hang together by gaps below half a bead radius are one group, and
   no others; of all gaps */
static void test_groups_of_all_gaps(void **state)
{
    const double box = 13e-6;
    const int count = MOST;
    uint64_t seed = 3;
    int grouped = 0;

    (void)state;
    for (int sample = 0; sample < 40; sample++)
    {
        scene s;
        ellipsoid_world *world;
        int lowest[MOST], index[MOST], seen = 0;
        const double repeat[1][3] = {{box, 0, 0}};

        scene_make(&s, count, &still);
        s.cells.repeat = repeat;
        s.cells.repeat_count = sample % 2;
        for (int n = 0; n < count; n++)
        {
            lowest[n] = n;
            for (int i = 0; i < 3; i++)
            {
                s.body[n].state.x[i] = box * test_uniform(&seed);
            }
            test_orientation(&seed, s.body[n].state.q);
        }
        assert_ok(
            ellipsoid_world_begin(s.memory, s.size, &s.cells, 0, 1, &world));
        for (int pass = 0; pass < count; pass++)
        {
            for (int a = 0; a < count; a++)
            {
                for (int b = a + 1; b < count; b++)
                {
                    const double *q = s.body[b].state.q;
                    double x[3], gap = 1;

                    for (int image = 0; image <= s.cells.repeat_count; image++)
                    {
                        ellipsoid_copy(s.body[b].state.x, x);
                        x[0] += image * box;
                        gap = fmin(
                            gap, ellipsoid_cell_gap(&s.model, s.body[a].state.x,
                                                    s.body[a].state.q, &s.model,
                                                    x, q, 1e-6));
                    }
                    if (gap < 0.5 * s.model.options.bead_radius)
                    {
                        const int least =
                            lowest[a] < lowest[b] ? lowest[a] : lowest[b];

                        lowest[a] = lowest[b] = least;
                    }
                }
            }
        }
        for (int g = 0; g < ellipsoid_world_group_count(world); g++)
        {
            const int members = ellipsoid_world_group(world, g, index);

            assert_true(members > 0);
            seen += members;
            grouped += members > 1;
            for (int n = 0; n < count; n++)
            {
                int inside = 0;

                for (int k = 0; k < members; k++)
                {
                    inside += index[k] == n;
                }
                assert_int_equal(inside, lowest[n] == lowest[index[0]]);
            }
        }
        assert_int_equal(seen, count);
        scene_free(&s);
    }
    assert_true(grouped > 40);
}

/* One far from all others, to the last bit as if it were alone; two that are
   driven against one another touch, and none passes the other */
static void test_cells_that_meet(void **state)
{
    scene s, alone;
    double t = 0;

    (void)state;
    scene_make(&s, 3, &rate);
    place(&s, 0, -4, 0, 0);
    place(&s, 1, 4, 0.1, 0);
    place(&s, 2, 3, 60, 1);
    scene_make(&alone, 1, &rate);
    place(&alone, 0, 3, 60, 1);
    for (int n = 0; n < 10; n++)
    {
        advance(&s, 0.1 * n, 0.1 * (n + 1));
    }
    for (int n = 0; n < 10; n++)
    {
        ellipsoid_member m = {&alone.model,
                              &alone.around[0],
                              &alone.body[0].state,
                              &alone.body[0].controller,
                              NULL,
                              NULL,
                              NULL};

        t = 0.1 * n;
        assert_ok(ellipsoid_advance(&m, &t, 0.1 * (n + 1), NULL));
    }
    assert_memory_equal(&s.body[2].state, &alone.body[0].state,
                        sizeof(ellipsoid_state));
    assert_int_equal(s.body[0].contact.cell_count, 1);
    assert_int_equal(s.body[0].contact.cell_id[0], 1);
    assert_int_equal(s.body[1].contact.cell_id[0], 0);
    assert_true(s.body[0].state.x[0] < -0.3e-6);
    assert_true(s.body[1].state.x[0] > 0.3e-6);
    for (int i = 0; i < 3; i++)
    {
        assert_near(s.body[0].contact.cell_force[i],
                    -s.body[1].contact.cell_force[i],
                    1e-12 * ellipsoid_length(s.body[0].contact.cell_force));
    }
    assert_true(s.body[0].contact.cell_deepest
                < 0.1 * s.model.options.bead_radius);
    scene_free(&s);
    scene_free(&alone);
}

static void crowd(scene *s, int count)
{
    uint64_t seed = 9;

    scene_make(s, count, &rate);
    for (int n = 0; n < count; n++)
    {
        place(s, n, (n % 2 ? 5 : -5) + test_signed(&seed), 5.0 * (n / 2),
              test_signed(&seed));
    }
}

/* In slices, the last group first, the bits are those of one call */
static void test_slices(void **state)
{
    scene whole, slices;
    int joined = 0;

    (void)state;
    crowd(&whole, 8);
    crowd(&slices, 8);
    for (int n = 0; n < 4; n++)
    {
        ellipsoid_world *world;
        const int *todo;
        int count;

        advance(&whole, 0.1 * n, 0.1 * (n + 1));
        assert_ok(ellipsoid_world_begin(slices.memory, slices.size,
                                        &slices.cells, 0.1 * n, 0.1 * (n + 1),
                                        &world));
        for (int round = 0; (count = ellipsoid_world_todo(world, &todo)) > 0;
             round++)
        {
            joined += round > 0;
            for (int k = count - 1; k >= 0; k--)
            {
                assert_ok(ellipsoid_world_advance_group(world, todo[k]));
            }
            assert_ok(ellipsoid_world_join(world));
        }
    }
    assert_true(joined > 0);
    for (int n = 0; n < 8; n++)
    {
        assert_memory_equal(&whole.body[n].state, &slices.body[n].state,
                            sizeof(ellipsoid_state));
        assert_memory_equal(&whole.body[n].contact, &slices.body[n].contact,
                            sizeof(ellipsoid_contact));
    }
    scene_free(&whole);
    scene_free(&slices);
}

/* Any memory gives these bits, or is refused and leaves the cells as they
   were; more of it helps */
static void test_memory(void **state)
{
    const size_t step = test_count(4001, 997, 97);
    scene enough;
    int refused = 0, extended = 0;

    (void)state;
    crowd(&enough, 8);
    advance(&enough, 0, 0.5);
    for (size_t size = 16; size < enough.size; size += step)
    {
        scene s;
        ellipsoid_world *world;
        ellipsoid_state before[8];
        const int *todo;
        void *little = malloc(size);

        crowd(&s, 8);
        for (int n = 0; n < 8; n++)
        {
            before[n] = s.body[n].state;
        }
        if (ellipsoid_world_advance(little, size, &s.cells, 0, 0.5)
            != ELLIPSOID_OK)
        {
            refused++;
            for (int n = 0; n < 8; n++)
            {
                assert_memory_equal(&s.body[n].state, &before[n],
                                    sizeof before[n]);
            }
            if (ellipsoid_world_begin(little, size, &s.cells, 0, 0.5, &world)
                == ELLIPSOID_OK)
            {
                extended++;
                ellipsoid_world_extend(world, s.memory, s.size);
                for (int count; (count = ellipsoid_world_todo(world, &todo));)
                {
                    for (int k = 0; k < count; k++)
                    {
                        assert_ok(
                            ellipsoid_world_advance_group(world, todo[k]));
                    }
                    assert_ok(ellipsoid_world_join(world));
                }
            }
            else
            {
                advance(&s, 0, 0.5);
            }
        }
        for (int n = 0; n < 8; n++)
        {
            assert_memory_equal(&s.body[n].state, &enough.body[n].state,
                                sizeof(ellipsoid_state));
        }
        free(little);
        scene_free(&s);
    }
    assert_true(refused > 0 && extended > 0);
    scene_free(&enough);
}

/* A cell that enters where another is waits until there is room; of two that
   enter at one place the first comes in */
static void test_cells_that_enter(void **state)
{
    scene s;

    (void)state;
    scene_make(&s, 4, &still);
    place(&s, 1, 0.5, 0, 0);
    place(&s, 2, 20, 0, 0);
    place(&s, 3, 20.5, 0, 0);
    for (int n = 1; n < 4; n++)
    {
        s.body[n].phase = ELLIPSOID_WAITING;
    }
    advance(&s, 0, 0.1);
    assert_int_equal(s.body[1].phase, ELLIPSOID_WAITING);
    assert_int_equal(s.body[2].phase, ELLIPSOID_PRESENT);
    assert_int_equal(s.body[3].phase, ELLIPSOID_WAITING);

    /* within an interval, at a time of its own */
    place(&s, 0, -20, 0, 0);
    s.body[1].time = 0.15;
    s.body[3].time = 0.3;
    advance(&s, 0.1, 0.2);
    assert_int_equal(s.body[1].phase, ELLIPSOID_PRESENT);
    assert_int_equal(s.body[3].phase, ELLIPSOID_WAITING);
    assert_true(s.body[1].time == 0.2 && s.body[3].time == 0.3);
    scene_free(&s);
}

static int stop(void *context, const ellipsoid_step *step)
{
    (void)step;
    return *(const int *)context;
}

/* Steps that do not stand are told of, and what an observer stops is gone */
static int told;
static void tell(void *context, int count, const int index[], double time)
{
    (void)context;
    (void)index;
    told += count > 1 && time < 1;
}

static void test_what_is_told(void **state)
{
    const int yes = 1;
    scene s;

    (void)state;
    crowd(&s, 4);
    s.cells.put_back = tell;
    told = 0;
    advance(&s, 0, 0.5);
    assert_true(told > 0);
    s.body[2].observer = stop;
    s.body[2].observer_context = (void *)&yes;
    advance(&s, 0.5, 0.6);
    assert_int_equal(s.body[2].phase, ELLIPSOID_GONE);
    assert_int_equal(s.body[2].status, ELLIPSOID_STOPPED);
    assert_true(s.body[2].time < 0.6 && s.body[1].time == 0.6);
    advance(&s, 0.6, 0.7);
    assert_true(s.body[2].time < 0.6 && s.body[1].time == 0.7);
    scene_free(&s);
}

/* The length of a world is its largest bead, whichever cell has it. */
static void test_length(void **state)
{
    ellipsoid_options o = test_free_cell();
    ellipsoid_model model[2];
    ellipsoid_world_body body[2] = {{.model = &model[0]}, {.model = &model[1]}};
    ellipsoid_world_bodies bodies = {.count = 2, .body = body};
    ellipsoid_world_cells cells;

    (void)state;
    o.contact = 1;
    model[0] = test_model(&o);
    o.bead_radius *= 0.5;
    model[1] = test_model(&o);
    for (int n = 0; n < 2; n++)
    {
        ellipsoid_world_cells_set(&cells, &bodies);
        assert_true(cells.pushing && cells.length == 2 * o.bead_radius);
        body[0].model = &model[1];
        body[1].model = &model[0];
    }
}

static void test_refuses(void **state)
{
    scene s;
    ellipsoid_world *world;

    (void)state;
    scene_make(&s, 2, &still);
    place(&s, 1, 9, 0, 0);
    assert_int_equal(
        ellipsoid_world_begin(NULL, s.size, &s.cells, 0, 1, &world),
        ELLIPSOID_BAD_ARGUMENT);
    s.cells.size = sizeof(ellipsoid_sweep) - 1;
    assert_int_equal(
        ellipsoid_world_begin(s.memory, s.size, &s.cells, 0, 1, &world),
        ELLIPSOID_BAD_ARGUMENT);
    scene_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_groups_of_all_gaps),
        cmocka_unit_test(test_cells_that_meet),
        cmocka_unit_test(test_slices),
        cmocka_unit_test(test_memory),
        cmocka_unit_test(test_cells_that_enter),
        cmocka_unit_test(test_what_is_told),
        cmocka_unit_test(test_length),
        cmocka_unit_test(test_refuses),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
