/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    brownianMotion.c - many cells in fluid at rest, each with a random force and
    torque of its own: the mean square of how far they get along each axis, over
    2 D t, D the mean of kT/(mu K) over orientations (Perrin 1934).
*/
#include "surroundings.h"

#include <stdio.h>

enum
{
    CELLS = 2000
};

int main(void)
{
    ellipsoid_options options = ellipsoid_options_default();
    ellipsoid_surroundings surroundings = {.flow = fluid_at_rest, .seed = 1};
    ellipsoid_model model;
    ellipsoid_status status;
    double sum[3] = {0}, mobility = 0;

    options.contact = options.buoyancy = 0;
    options.brownian = 1;
    options.motion = ELLIPSOID_MOTION_INERTIALESS;
    status = ellipsoid_model_init(&model, &options);
    for (uint32_t id = 0; id < CELLS && status == ELLIPSOID_OK; id++)
    {
        ellipsoid_state state = {.x = {0, 0, 0}};
        ellipsoid_controller controller = {0};
        double t = 0, uniform[3];

        surroundings.id = id;
        ellipsoid_random_uniform(1, id, 0, 0, 3, uniform);
        ellipsoid_quaternion_from_uniform(uniform, state.q);
        status =
            ellipsoid_advance(&(ellipsoid_member){.model = &model,
                                                  .surroundings = &surroundings,
                                                  .state = &state,
                                                  .controller = &controller},
                              &t, 0.1, NULL);
        for (int i = 0; i < 3; i++)
        {
            sum[i] += state.x[i] * state.x[i] / CELLS;
        }
    }
    for (int i = 0; i < 3; i++)
    {
        mobility += 1 / (3 * model.viscosity * model.resistance[i]);
    }

    const double expected =
        2 * 1.380649e-23 * options.temperature * mobility * 0.1;

    printf("# mean square displacement over 2 D t, of %d cells\n", CELLS);
    printf("%.3f %.3f %.3f\n", sum[0] / expected, sum[1] / expected,
           sum[2] / expected);
    printf("# %s\n", ellipsoid_status_text(status));
    return status != ELLIPSOID_OK;
}
