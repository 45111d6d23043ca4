/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    surroundings.h - what the examples put around a cell: fluid at rest and a
    floor of two facets.
*/
#ifndef EXAMPLE_SURROUNDINGS_H
#define EXAMPLE_SURROUNDINGS_H

#include "ellipsoid.h"

static const double um = 1e-6; /* [m] */

static inline int fluid_at_rest(void *context, double t, const double x[3],
                                int derivatives, ellipsoid_flow_sample *sample)
{
    (void)context;
    (void)t;
    (void)x;
    (void)derivatives;
    (void)sample; /* zero as it is */
    return 0;
}

/* A square of two facets in the plane x3 = 0, the fluid above. */
typedef struct floor_walls
{
    ellipsoid_facet facet[2];
} floor_walls;

/* Returns 0 if a facet has no area. */
static inline int floor_walls_set(floor_walls *walls)
{
    static const double corner[2][3][3] = {
        {{-50e-6, -50e-6, 0}, {50e-6, -50e-6, 0}, {50e-6, 50e-6, 0}},
        {{-50e-6, -50e-6, 0}, {50e-6, 50e-6, 0}, {-50e-6, 50e-6, 0}}};
    ellipsoid_facet *a = &walls->facet[0], *b = &walls->facet[1];

    /* they share the diagonal, edge 2 of the first and edge 0 of the second */
    return ellipsoid_facet_set(a, corner[0])
        && ellipsoid_facet_set(b, corner[1]) && ellipsoid_facet_join(a, 2, b)
        && ellipsoid_facet_join(b, 0, a);
}

/* So few facets need no search: all of them are listed. */
static inline int list_floor(void *context, double t, const double centre[3],
                             double reach, ellipsoid_facet_list *list)
{
    static const int index[2] = {0, 1};
    const floor_walls *walls = context;

    (void)t;
    (void)centre;
    list->facets = walls->facet;
    list->index = index;
    list->count = 2;
    list->reach = reach;
    return 0;
}

#endif
