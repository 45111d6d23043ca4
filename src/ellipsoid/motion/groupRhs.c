/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    groupRhs.c - the equations of the cells of a group, contacts between them
    included.
*/
#include "motion/motion.h"

/* The drag near walls is what costs most, and its derivatives are exact, so that a
   method is of its order in the rest. */
void ellipsoid_expand_about(ellipsoid_group *g,
                            const ellipsoid_evaluation *points)
{
    for (int cell = 0; cell < g->count; cell++)
    {
        g->cell[cell].about = points ? &points[cell].walls : NULL;
    }
}

void ellipsoid_group_set_inertial(ellipsoid_group *g, int inertial)
{
    g->inertial = inertial;
    for (int cell = 0; cell < g->count; cell++)
    {
        g->cell[cell].inertial = inertial;
    }
}

static ellipsoid_status evaluate(ellipsoid_group *g,
                                 ellipsoid_evaluation *points, int balanced,
                                 int with_blocks)
{
    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_status status = ellipsoid_evaluate(
            &g->cell[cell], &points[cell], balanced, with_blocks);

        if (status != ELLIPSOID_OK)
        {
            g->failed = cell;
            return status;
        }
    }
    return ellipsoid_add_group_contacts(g, points, balanced, with_blocks);
}

/* Balanced, the derivatives of several depend on velocities that all contacts
   decide: these come first. */
ellipsoid_status ellipsoid_pairs_evaluate(ellipsoid_group *g,
                                          ellipsoid_evaluation *points,
                                          int balanced, int with_blocks)
{
    ellipsoid_status status;

    if (!balanced || !with_blocks)
    {
        return evaluate(g, points, balanced, with_blocks);
    }
    status = evaluate(g, points, 1, 0);
    if (status == ELLIPSOID_OK)
    {
        status = evaluate(g, points, 0, 1);
    }
    for (int cell = 0; cell < g->count; cell++)
    {
        ellipsoid_set_no_rates(&points[cell].derivative);
    }
    return status;
}
