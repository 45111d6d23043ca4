/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    groupTest.h - several cells that are advanced as one system.
*/
#ifndef GROUP_TEST_H
#define GROUP_TEST_H

#include "flowTest.h"

#include <stdlib.h>

/* What an advance of several cells is called with. */
typedef struct crowd
{
    int count;
    ellipsoid_model model;
    test_quadratic flow;
    ellipsoid_surroundings *around;
    ellipsoid_state *state;
    ellipsoid_controller *controller;
    ellipsoid_statistics *statistics;
    ellipsoid_member *member;
    void *memory;
} crowd;

static inline void *zeros(size_t count, size_t size)
{
    void *memory = calloc(count, size);

    assert_non_null(memory);
    return memory;
}

static inline void crowd_init(crowd *c, int count,
                              const ellipsoid_options *options,
                              const test_quadratic *flow)
{
    const size_t n = (size_t)count;

    c->count = count;
    c->model = test_model(options);
    c->around = zeros(n, sizeof(*c->around));
    c->state = zeros(n, sizeof(*c->state));
    c->controller = zeros(n, sizeof(*c->controller));
    c->statistics = zeros(n, sizeof(*c->statistics));
    c->member = zeros(n, sizeof(*c->member));
    c->memory = zeros(1, ellipsoid_group_size(count));
    if (flow)
    {
        c->flow = *flow;
    }
    for (int i = 0; i < count; i++)
    {
        c->around[i].flow = flow ? test_quadratic_flow : NULL;
        c->around[i].flow_context = &c->flow;
        c->around[i].id = 100 + (uint32_t)i;
        c->state[i].q[3] = 1;
        c->member[i] = (ellipsoid_member){
            &c->model, &c->around[i], &c->state[i],     &c->controller[i],
            NULL,      NULL,          &c->statistics[i]};
    }
}

static inline void crowd_free(crowd *c)
{
    free(c->around);
    free(c->state);
    free(c->controller);
    free(c->statistics);
    free(c->member);
    free(c->memory);
}

static inline void crowd_advance(crowd *c, double *t, double end,
                                 ellipsoid_observer observer)
{
    int which = -2;

    assert_ok(ellipsoid_advance_group(c->count, c->member, t, end, observer,
                                      c->memory, &which));
    assert_int_equal(which, -1);
}

/* Everything is tested for cells that touch with beads, and with themselves. */
static ellipsoid_contact_shape shape;

static inline int with_beads(void **unused)
{
    (void)unused;
    shape = ELLIPSOID_CONTACT_BEADS;
    return 0;
}

static inline int with_ellipsoids(void **unused)
{
    (void)unused;
    shape = ELLIPSOID_CONTACT_ELLIPSOID;
    return 0;
}

/* The paper's cell, weightless, that touches. */
static inline ellipsoid_options touching_cell(void)
{
    ellipsoid_options o = test_free_cell();

    o.contact = 1;
    o.contact_shape = shape;
    return o;
}

/* A flow from everywhere to the origin. */
static inline test_quadratic towards_origin(double rate)
{
    test_quadratic flow = {.answer = 0};

    for (int i = 0; i < 3; i++)
    {
        flow.g[i][i] = -rate;
    }
    return flow;
}

static double deepest;

static inline int note_deepest(void *context, const ellipsoid_step *step)
{
    (void)context;
    deepest = fmax(deepest, step->contact.cell_deepest);
    return 0;
}

#define BOTH(test)                                                             \
    cmocka_unit_test_setup(test, with_beads),                                  \
        cmocka_unit_test_setup(test, with_ellipsoids)

#endif
