/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    settlingCell.c - the paper's cell sinking in fluid at rest onto a floor of
    two facets, which come to carry its weight less its buoyancy.
*/
#include "surroundings.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

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
    options.wall_resistance =
        ELLIPSOID_WALL_RESISTANCE_NONE; /* contact alone */
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
