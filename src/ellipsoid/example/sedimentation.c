/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    sedimentation.c - a cell without inertia sinks in fluid at rest, far from
    walls, inclined by 45 degrees: it drifts aside, since it moves more easily
    along its axis. Printed beside weight over resistance (Kim & Karrila).
*/
#include "surroundings.h"

#include <math.h>
#include <stdio.h>

int main(void)
{
    ellipsoid_options options = ellipsoid_options_default();
    const ellipsoid_surroundings surroundings = {.flow = fluid_at_rest};
    ellipsoid_state state = {.x = {0, 0, 0}};
    ellipsoid_controller controller = {0};
    const double inclined[3] = {1, 0, 1};
    ellipsoid_model model;
    ellipsoid_status status;
    double t = 0;

    options.contact = 0;
    options.motion = ELLIPSOID_MOTION_INERTIALESS;
    status = ellipsoid_model_init(&model, &options);
    ellipsoid_quaternion_from_axis(inclined, 0, state.q);
    if (status == ELLIPSOID_OK)
    {
        status =
            ellipsoid_advance(&(ellipsoid_member){.model = &model,
                                                  .surroundings = &surroundings,
                                                  .state = &state,
                                                  .controller = &controller},
                              &t, 10, NULL);
    }

    const double weight = options.gravity[2] * model.volume
                        * (options.density - options.fluid_density);
    const double across = weight / model.viscosity / model.resistance[0];
    const double along = weight / model.viscosity / model.resistance[1];

    printf("# after %g s: aside [um], down [um]\n", t);
    printf("%.9f %.9f\n", state.x[0] / um, state.x[2] / um);
    printf("%.9f %.9f by weight over resistance\n",
           0.5 * (along - across) * t / um, 0.5 * (along + across) * t / um);
    printf("# %s\n", ellipsoid_status_text(status));
    return status != ELLIPSOID_OK;
}
