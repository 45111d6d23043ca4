/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_worldGroups.c - which cells a world has advanced together, and over
    which times: cells that go straight ahead, whatever is in their way.
*/
#include "coreTest.h"

#define MOST 4
#define CALLS 64

/* Two micrometres wide; lengths and gaps are in lengths of the world */
static const double radius = 1e-6;
static double length;

typedef struct straight
{
    ellipsoid_sweep sweep;
    ellipsoid_state state;
    ellipsoid_phase phase;
    double time;
    double speed; /* [m/s] along x1 */
    int fixed;
} straight;

typedef struct road
{
    ellipsoid_model model;
    straight cell[MOST];
    ellipsoid_world_cells cells;
    int calls, count[CALLS]; /* how many were advanced together, */
    double end[CALLS];       /* and until when */
} road;

static void look(void *context, const void *cell, ellipsoid_cell_view *view)
{
    const road *r = context;
    const straight *c = cell;

    *view = (ellipsoid_cell_view){&r->model, &c->state, c->phase, c->time,
                                  c->fixed};
}

static int advance(void *context, int count, const int index[], double end,
                   int may_fail)
{
    road *r = context;

    (void)may_fail;
    assert_true(r->calls < CALLS);
    r->count[r->calls] = count;
    r->end[r->calls++] = end;
    for (int n = 0; n < count; n++)
    {
        straight *c = &r->cell[index[n]];

        c->phase = ELLIPSOID_PRESENT;
        c->state.x[0] += c->speed * (end - c->time);
        c->time = end;
        ellipsoid_sweep_add(&c->sweep, &r->model, &c->state);
    }
    return 1;
}

/* Spheres in a row along x1, each so far from the one before: its gap */
static road row_of(int count, const double gap[])
{
    ellipsoid_options o = test_paper_options();
    road r;

    memset(&r, 0, sizeof r);
    ellipsoid_set(o.semi_axes, radius, radius, radius);
    o.contact_shape = ELLIPSOID_CONTACT_ELLIPSOID;
    r.model = test_model(&o);
    length = o.bead_radius;
    for (int n = 0; n < count; n++)
    {
        r.cell[n].phase = ELLIPSOID_PRESENT;
        r.cell[n].state.q[3] = 1;
        r.cell[n].state.x[0] =
            n > 0 ? r.cell[n - 1].state.x[0] + 2 * radius + gap[n] * length : 0;
    }
    return r;
}

/* Over a second */
static void run(road *r, int count)
{
    const size_t size = ellipsoid_world_size(count, sizeof(straight), 0);
    void *memory = malloc(size);

    r->cells = (ellipsoid_world_cells){.count = count,
                                       .cell = r->cell,
                                       .size = sizeof(straight),
                                       .context = r,
                                       .look = look,
                                       .advance = advance,
                                       .pushing = 1,
                                       .length = length};
    assert_ok(ellipsoid_world_advance(memory, size, &r->cells, 0, 1));
    free(memory);
    for (int n = 0; n < count; n++)
    {
        assert_true(r->cell[n].phase == ELLIPSOID_WAITING
                    || r->cell[n].time == 1);
    }
}

/* Below half a length they are one group */
static void test_gap(void **state)
{
    (void)state;
    for (int sample = 0; sample < 2; sample++)
    {
        const double gap[2] = {0, sample ? 0.499 : 0.501};
        road r = row_of(2, gap);

        run(&r, 2);
        assert_int_equal(r.calls, sample ? 1 : 2);
        assert_int_equal(r.count[0], sample ? 2 : 1);
    }
}

/* Two fixed cells are no group; one of them and a free one are */
static void test_fixed(void **state)
{
    const double gap[3] = {0, 0.1, 0.1};
    road r = row_of(3, gap);

    (void)state;
    r.cell[0].fixed = r.cell[1].fixed = 1;
    run(&r, 3);
    assert_int_equal(r.calls, 2);
    assert_int_equal(r.count[0] + 10 * r.count[1], 21);
}

/* The time of those that may have met is halved if one of them has come far,
   whichever it is, and if none has it is not */
static void test_travel(void **state)
{
    (void)state;
    for (int sample = 0; sample < 3; sample++)
    {
        const double gap[2] = {0, 1.5};
        road r = row_of(2, gap);

        r.cell[0].speed = (sample == 0) * 3 * length + (sample == 2) * length;
        r.cell[1].speed = -(sample == 1) * 3 * length - (sample == 2) * length;
        run(&r, 2);

        /* each alone, then both */
        assert_true(r.count[0] == 1 && r.count[1] == 1);
        assert_true(sample == 2 ? r.calls == 3 && r.count[2] == 2
                                : r.calls > 3 && r.end[2] < 1);
    }
}

/* A chain: what joins the first to the second is short, what joins these to
   the third is not */
static void test_travel_of_a_chain(void **state)
{
    const double gap[3] = {0, 0.52, 2};
    road r = row_of(3, gap);

    (void)state;
    r.cell[0].speed = 0.45 * length;
    r.cell[2].speed = -3 * length;
    run(&r, 3);
    assert_true(r.calls > 4 && r.end[3] < 1);
}

/* One that waits has room beside another, however near; where they would
   overlap it has none, and of two that would the first enters */
static void test_room(void **state)
{
    (void)state;
    for (int sample = 0; sample < 4; sample++)
    {
        const int overlap = sample % 2, both = sample / 2;
        const double gap[2] = {0, overlap ? -0.01 : 0.01};
        road r = row_of(2, gap);

        r.cell[1].phase = ELLIPSOID_WAITING;
        r.cell[0].phase = both ? ELLIPSOID_WAITING : ELLIPSOID_PRESENT;
        run(&r, 2);
        assert_int_equal(r.cell[0].phase, ELLIPSOID_PRESENT);
        assert_int_equal(r.cell[1].phase,
                         overlap ? ELLIPSOID_WAITING : ELLIPSOID_PRESENT);
        assert_int_equal(r.count[0], overlap ? 1 : 2);
    }
}

/* Of three that would enter, one on the other, the second has no room, so that
   the third has */
static void test_room_in_a_row(void **state)
{
    const double gap[3] = {0, -0.01, -0.01};
    road r = row_of(3, gap);

    (void)state;
    for (int n = 0; n < 3; n++)
    {
        r.cell[n].phase = ELLIPSOID_WAITING;
    }
    run(&r, 3);
    assert_int_equal(r.cell[0].phase, ELLIPSOID_PRESENT);
    assert_int_equal(r.cell[1].phase, ELLIPSOID_WAITING);
    assert_int_equal(r.cell[2].phase, ELLIPSOID_PRESENT);
}

/* One that finds no room between two others does not make them a group */
static void test_no_bond_by_one_that_waits(void **state)
{
    const double gap[3] = {0, 0, 0};
    road r = row_of(3, gap);

    (void)state;
    r.cell[1].state.x[0] = 3.99 * radius;
    r.cell[2].phase = ELLIPSOID_WAITING;
    r.cell[2].state.x[0] = 0.5 * r.cell[1].state.x[0];
    run(&r, 3);
    assert_int_equal(r.cell[2].phase, ELLIPSOID_WAITING);
    assert_int_equal(r.calls, 2);
    assert_int_equal(r.count[0], 1);
}

/* A group of which cells enter later is cut whenever one of them does */
static void test_entries(void **state)
{
    (void)state;
    for (int sample = 0; sample < 2; sample++)
    {
        const double gap[3] = {0, 0.1, 0.1};
        road r = row_of(3, gap);
        int first = 0, second = 0;

        for (int n = 1; n < 3; n++)
        {
            r.cell[n].phase = ELLIPSOID_WAITING;
        }
        r.cell[1].time = sample ? 0.25 : 0.75;
        r.cell[2].time = sample ? 0.75 : 0.25;
        run(&r, 3);

        /* each alone; then what there is up to the entries */
        while (r.count[first] == 1 && r.end[first] == 1)
        {
            first++;
        }
        assert_int_equal(first, 3);
        assert_true(r.end[first] == 0.25);
        while (second < r.calls && r.end[second] != 0.75)
        {
            second++;
        }
        assert_true(second > first && second < r.calls);
        assert_int_equal(r.count[r.calls - 1], 3);
        assert_true(r.end[r.calls - 1] == 1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_gap),
        cmocka_unit_test(test_fixed),
        cmocka_unit_test(test_travel),
        cmocka_unit_test(test_travel_of_a_chain),
        cmocka_unit_test(test_room),
        cmocka_unit_test(test_room_in_a_row),
        cmocka_unit_test(test_no_bond_by_one_that_waits),
        cmocka_unit_test(test_entries),
    };

    return cmocka_run_group_tests_name("worldGroups", tests, NULL, NULL);
}
