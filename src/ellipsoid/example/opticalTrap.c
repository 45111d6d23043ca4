/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    opticalTrap.c - a force by callback: a spring pulls a cell to the origin
    through fluid at rest. Printed beside exp(-t k/(mu K)).
*/
#include "surroundings.h"

#include <math.h>
#include <stdio.h>

static const double stiffness = 1e-6; /* [N/m] */

static int spring(void *context, double t, const ellipsoid_state *state,
                  double force[3], double torque[3],
                  ellipsoid_wrench_jacobian *jacobian)
{
    (void)context;
    (void)t;
    (void)torque;
    for (int i = 0; i < 3; i++)
    {
        force[i] = -stiffness * state->x[i];
        if (jacobian)
        {
            jacobian->force_x[i][i] = -stiffness;
        }
    }
    return 0;
}

int main(void)
{
    ellipsoid_options options = ellipsoid_options_default();
    const ellipsoid_surroundings surroundings = {.flow = fluid_at_rest,
                                                 .force = spring};
    ellipsoid_state state = {.x = {1e-6, 0, 0}, .q = {0, 0, 0, 1}};
    ellipsoid_controller controller = {0};
    ellipsoid_model model;
    ellipsoid_status status;
    double t = 0;

    options.contact = options.buoyancy = 0;
    status = ellipsoid_model_init(&model, &options);
    printf("# t[s]  x1[um]  exp(-t k/(mu K)) um\n");
    for (int n = 0; n <= 10 && status == ELLIPSOID_OK; n++)
    {
        const double rate = stiffness / (model.viscosity * model.resistance[0]);

        status =
            ellipsoid_advance(&(ellipsoid_member){.model = &model,
                                                  .surroundings = &surroundings,
                                                  .state = &state,
                                                  .controller = &controller},
                              &t, 0.01 * n, NULL);
        printf("%.2f %.6f %.6f\n", t, state.x[0] / um, exp(-rate * t));
    }
    printf("# %s\n", ellipsoid_status_text(status));
    return status != ELLIPSOID_OK;
}
