/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    shearAtWall.c - how fast a free cell that lies across a shear flow goes
    along a plane wall, over the speed of the flow at its centre: what the wall
    adds to its resistance holds it back (docs/theory/wallResistance.md).
*/
#include "surroundings.h"

#include <stdio.h>
#include <stdlib.h>

/* u = (x3/s, 0, 0) */
static int shear_along_floor(void *context, double t, const double x[3],
                             int derivatives, ellipsoid_flow_sample *sample)
{
    fluid_at_rest(context, t, x, derivatives, sample);
    sample->velocity[0] = x[2];
    sample->gradient[0][2] = sample->velocity_jacobian[0][2] = 1;
    return 0;
}

int main(void)
{
    ellipsoid_options options = ellipsoid_options_default();
    floor_walls walls;
    const ellipsoid_surroundings surroundings = {.flow = shear_along_floor,
                                                 .walls = list_floor,
                                                 .walls_context = &walls};
    ellipsoid_facet_cache *cache;
    ellipsoid_model model;
    ellipsoid_status status;

    options.contact = 0;
    options.buoyancy = 0;
    status = ellipsoid_model_init(&model, &options);
    if (status != ELLIPSOID_OK || !floor_walls_set(&walls)
        || !(cache = malloc(ellipsoid_facet_cache_size(&model))))
    {
        return 1;
    }
    ellipsoid_facet_cache_clear(cache);

    printf("# gap[um]  speed over the flow's at the centre\n");
    for (double gap = 0.05 * um; gap < 5 * um && status == ELLIPSOID_OK;
         gap *= 2)
    {
        ellipsoid_state state = {.x = {0, 0, 0.5 * um + gap},
                                 .q = {0, 0, 0, 1}};

        status = ellipsoid_balance(&model, &surroundings, &state, cache);
        printf("%.3f %.4f\n", gap / um, state.u[0] / state.x[2]);
    }
    free(cache);
    printf("# %s\n", ellipsoid_status_text(status));
    return status != ELLIPSOID_OK;
}
