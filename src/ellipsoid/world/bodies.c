/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    bodies.c - cells of a world for a program that has no type of its own.
*/
#include "world/world.h"

#include <math.h>

static void look(void *context, const void *cell, ellipsoid_cell_view *view)
{
    const ellipsoid_world_body *body = cell;

    (void)context;
    view->model = body->model;
    view->state = &body->state;
    view->phase = body->phase;
    view->time = body->time;
    view->fixed = body->surroundings->fixed;
}

/* Sees the steps of a body. */
static int observe(void *context, const ellipsoid_step *step)
{
    ellipsoid_world_body *body = context;

    ellipsoid_sweep_add_step(&body->sweep, body->model, step);
    body->contact = step->contact;
    return body->observer ? body->observer(body->observer_context, step) : 0;
}

static void set_members(ellipsoid_world_bodies *bodies, int count,
                        const int index[])
{
    for (int n = 0; n < count; n++)
    {
        ellipsoid_world_body *body = &bodies->body[index[n]];

        body->phase = ELLIPSOID_PRESENT;
        bodies->member[n] = (ellipsoid_member){
            body->model,        body->surroundings, &body->state,
            &body->controller,  body->cache,        body,
            &bodies->statistics};
    }
}

/* One that stopped, or that the core cannot go on with, is gone; the last one
   where none is blamed. Others go on. */
static int advance(void *context, int count, const int index[], double end,
                   int may_fail)
{
    ellipsoid_world_bodies *bodies = context;
    double t = bodies->body[index[0]].time;

    if (count > bodies->largest)
    {
        return may_fail ? 0 : -1;
    }
    set_members(bodies, count, index);
    while (count > 0)
    {
        int which = -1, left = 0;
        const ellipsoid_status status = ellipsoid_advance_group(
            count, bodies->member, &t, end, observe, bodies->memory, &which);

        if (status != ELLIPSOID_OK && status != ELLIPSOID_STOPPED && may_fail
            && count > 1)
        {
            return 0;
        }
        which = which < 0 ? count - 1 : which;
        for (int n = 0; n < count; n++)
        {
            ellipsoid_world_body *body = bodies->member[n].observer_context;

            body->time = t;
            if (status != ELLIPSOID_OK && n == which)
            {
                body->phase = ELLIPSOID_GONE;
                body->status = status;
            }
            else if (status != ELLIPSOID_OK)
            {
                bodies->member[left++] = bodies->member[n];
            }
        }
        count = left;
    }
    return 1;
}

void ellipsoid_world_cells_set(ellipsoid_world_cells *cells,
                               ellipsoid_world_bodies *bodies)
{
    *cells = (ellipsoid_world_cells){.count = bodies->count,
                                     .cell = bodies->body,
                                     .size = sizeof *bodies->body,
                                     .context = bodies,
                                     .look = look,
                                     .advance = advance};
    for (int n = 0; n < bodies->count; n++)
    {
        const ellipsoid_options *options = &bodies->body[n].model->options;

        cells->pushing = cells->pushing || options->contact;
        cells->length = ellipsoid_greater(cells->length, options->bead_radius);
    }
}
