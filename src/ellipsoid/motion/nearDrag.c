/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    nearDrag.c - drag near walls in the equations of one cell: of each pose, or
    by a resistance that is kept over a step.
*/
#include "motion/motion.h"

#include <math.h>

/* The resistance of this pose, and for how long it may be kept. */
static ellipsoid_status set_kept(const ellipsoid_cell *cell,
                                 const ellipsoid_planes *planes,
                                 ellipsoid_frame *frame,
                                 const ellipsoid_free_motion *free,
                                 ellipsoid_evaluation *at)
{
    /* contact sees no farther than its horizon; planes do */
    const int seen = ellipsoid_has_walls(cell->model, &cell->surroundings)
                  && at->contact.gap < ellipsoid_gap_horizon(cell->model);
    const double gap = !seen                                ? HUGE_VAL
                     : ellipsoid_in_contact(&at->contact) ? 0
                                                          : at->contact.gap;

    at->resistance.in_blocks = 0;
    return ellipsoid_keep_resistance(cell->model, planes, frame, free,
                                     &at->state, gap, &at->resistance);
}

/* The drag with the resistance of this pose kept, if that may be kept over any
   step at all. Its planes need no slopes. */
static ellipsoid_status keep(const ellipsoid_cell *cell,
                             ellipsoid_evaluation *at, ellipsoid_frame *frame,
                             const ellipsoid_free_motion *free,
                             ellipsoid_body_wrench *wrench, int *acted)
{
    ellipsoid_kept_resistance *kept = &at->resistance;
    ellipsoid_frame plain = *frame;
    ellipsoid_planes planes;
    ellipsoid_status status;

    kept->in_blocks = 0;
    if (ellipsoid_in_contact(&at->contact))
    {
        return ELLIPSOID_OK;
    }
    plain.by_q = NULL;
    status = ellipsoid_find_planes(cell->model, &cell->surroundings, &at->state,
                                   &plain, cell->cache, &planes);
    if (status == ELLIPSOID_OK)
    {
        status = set_kept(cell, &planes, &plain, free, at);
    }
    kept->in_blocks = status == ELLIPSOID_OK && kept->longest > 0;
    *acted = kept->in_blocks && kept->acts;
    if (*acted)
    {
        ellipsoid_add_kept_drag(cell->model, kept, frame, free, &at->state,
                                wrench, &at->blocks);
    }
    return status;
}

ellipsoid_status ellipsoid_add_near_drag(const ellipsoid_cell *cell,
                                         ellipsoid_evaluation *at,
                                         ellipsoid_frame *frame,
                                         const ellipsoid_free_motion *free,
                                         ellipsoid_body_wrench *wrench,
                                         ellipsoid_near_drag *asked)
{
    ellipsoid_jacobian_blocks *blocks = asked->with_blocks ? &at->blocks : NULL;
    ellipsoid_state *state = &at->state;
    ellipsoid_planes planes;
    ellipsoid_status status = ELLIPSOID_OK;

    if (cell->kept)
    {
        asked->acted = cell->kept->acts;
        if (asked->acted)
        {
            ellipsoid_add_kept_drag(cell->model, cell->kept, frame, free, state,
                                    wrench, blocks);
        }
        return ELLIPSOID_OK;
    }
    if (cell->planes)
    {
        ellipsoid_linear_planes_at(cell->planes, state, &planes);
        asked->acted = planes.count > 0;
        return asked->acted
                 ? ellipsoid_add_wall_drag(cell->model, &planes, frame, free,
                                           state, wrench, NULL)
                 : ELLIPSOID_OK;
    }
    if (asked->with_blocks == ELLIPSOID_KEEPING)
    {
        status = keep(cell, at, frame, free, wrench, &asked->acted);
        if (status != ELLIPSOID_OK || at->resistance.in_blocks)
        {
            return status;
        }
    }
    status = ellipsoid_find_planes(cell->model, &cell->surroundings, state,
                                   frame, cell->cache, &planes);
    if (status == ELLIPSOID_OK && blocks && cell->keeps)
    {
        status = set_kept(cell, &planes, frame, free, at);
    }
    if (status == ELLIPSOID_OK && cell->keeps)
    {
        double rates[6];

        ellipsoid_wall_rates(frame, free, state, rates);
        ellipsoid_linear_planes_set(&planes, state, rates, &at->planes);
    }
    asked->acted = status == ELLIPSOID_OK && planes.count > 0;
    if (!asked->acted)
    {
        return status;
    }
    if (asked->balanced)
    {
        ellipsoid_copy(free->u, state->u);
        ellipsoid_copy(free->omega, state->omega);
        status = ellipsoid_add_wall_mobility(cell->model, &planes, frame,
                                             wrench, state);
    }
    if (status == ELLIPSOID_OK && (blocks || !asked->balanced))
    {
        status = ellipsoid_add_wall_drag(cell->model, &planes, frame, free,
                                         state, wrench, blocks);
    }
    return status;
}

/* The part of the tolerance that a defect may take up that is not corrected. */
static const double slight = 0.2;

/* Is what velocities make small that grow in a step of h with the square of
   time, to this defect at the end? */
static int is_slight(const ellipsoid_cell *p, double h, const double defect[6])
{
    return h
             * fmax(ellipsoid_length(defect) / p->length,
                    0.5 * ellipsoid_length(defect + 3))
             / p->model->options.tolerance
        <= 3 * slight;
}

int ellipsoid_planes_are_linear(const ellipsoid_group *g, double h)
{
    const ellipsoid_evaluation *next = &g->next[0];
    double defect[6];

    if (next->planes.count < 0)
    {
        return 0;
    }
    ellipsoid_linear_planes_defect(g->cell[0].model, &g->start[0].planes,
                                   &next->planes, &next->state, defect);
    return is_slight(&g->cell[0], h, defect);
}
