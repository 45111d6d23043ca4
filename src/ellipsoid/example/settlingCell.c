/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    settlingCell.c - the paper's cell sinking in fluid at rest onto a floor of
    two facets, which come to carry its weight less its buoyancy.
*/
#include "ellipsoid.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double um = 1e-6; /* [m] */

static int fluid_at_rest(void *context, double t, const double x[3],
                         int derivatives, ellipsoid_flow_sample *sample)
{
    (void)context;
    (void)t;
    (void)x;
    (void)derivatives;
    memset(sample, 0, sizeof(*sample));
    return 0;
}

/* A square of two facets in the plane x3 = 0, the fluid above. */
typedef struct floor_walls
{
    ellipsoid_facet facet[2];
} floor_walls;

static int floor_walls_set(floor_walls *walls)
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
static int list_floor(void *context, double t, const double centre[3],
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

int main(void)
{
    ellipsoid_options options = ellipsoid_options_default();
    ellipsoid_model model;
    floor_walls walls;
    ellipsoid_surroundings surroundings = {
        .flow = fluid_at_rest, .walls = list_floor, .walls_context = &walls};
    ellipsoid_state state = {.x = {0, 0, 1.5 * um}};
    ellipsoid_controller controller = {0};
    ellipsoid_contact contact = {.gap = 0};
    ellipsoid_member cell = {&model, &surroundings, &state, &controller,
                             NULL,   NULL,          NULL};
    const double axis[3] = {1, 0, 0.1};
    ellipsoid_status status;
    double t = 0, weight;

    options.tolerance = 1e-6;
    options.contact_shape = ELLIPSOID_CONTACT_ELLIPSOID;
    status = ellipsoid_model_init(&model, &options);
    if (status != ELLIPSOID_OK || !floor_walls_set(&walls))
    {
        printf("# %s\n", ellipsoid_status_text(status));
        return 1;
    }
    weight = -options.gravity[2] * model.volume
           * (options.density - options.fluid_density);
    ellipsoid_quaternion_from_axis(axis, 0, state.q);
    cell.cache = malloc(ellipsoid_facet_cache_size(&model));
    if (!cell.cache)
    {
        return 1;
    }
    ellipsoid_facet_cache_clear(cell.cache);

    printf("# t[s]  x3[um]  tilt[deg]  gap[um]  force of the floor/weight\n");
    for (int i = 0; i <= 20 && status == ELLIPSOID_OK; i++)
    {
        double rotation[3][3];

        status = ellipsoid_advance(&cell, &t, 3 * i, NULL);
        if (status == ELLIPSOID_OK)
        {
            status = ellipsoid_contact_evaluate(&model, &surroundings, &state,
                                                cell.cache, &contact, NULL);
        }
        ellipsoid_rotation(state.q, rotation);
        printf("%4.1f %.6f %8.4f %+.6f %.8f\n", t, state.x[2] / um,
               180 / 3.14159265358979323846 * asin(rotation[2][1]),
               contact.gap / um, contact.force[2] / weight);
    }
    free(cell.cache);
    printf("# %s\n", ellipsoid_status_text(status));
    return status != ELLIPSOID_OK;
}
