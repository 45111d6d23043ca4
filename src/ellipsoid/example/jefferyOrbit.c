/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    jefferyOrbit.c - the paper's cell tumbling in simple shear, printed beside
    Jeffery's period (Jeffery 1922, eq. 48): T = 2 pi (r + 1/r) / shear rate.
*/
#include "ellipsoid.h"

#include <math.h>
#include <stdio.h>

static const double shear_rate = 1000; /* [1/s] */

/* u = (shear_rate x2, 0, 0) */
static int simple_shear(void *context, double t, const double x[3],
                        int derivatives, ellipsoid_flow_sample *sample)
{
    (void)t;
    (void)context;
    sample->velocity[0] = shear_rate * x[1];
    sample->gradient[0][1] = shear_rate;
    if (derivatives)
    {
        sample->velocity_jacobian[0][1] = shear_rate;
    }
    return 0;
}

int main(void)
{
    ellipsoid_options options = ellipsoid_options_default();
    ellipsoid_model model;
    ellipsoid_surroundings surroundings = {.flow = simple_shear};
    ellipsoid_state state = {.q = {0, 0, 0, 1}};
    ellipsoid_controller controller = {0};
    ellipsoid_statistics statistics = {0};
    ellipsoid_status status;
    const double period = 2 * 3.14159265358979323846 * (4 + 0.25) / shear_rate;
    double t = 0;

    options.contact = 0;
    options.buoyancy = 0;
    options.tolerance = 1e-8;
    status = ellipsoid_model_init(&model, &options);

    printf("# Jeffery's period %.6e s\n", period);
    printf("# t/period  O_x1  O_x2  O_x3  spin[rad/s]\n");
    for (int i = 0; i <= 40 && status == ELLIPSOID_OK; i++)
    {
        double rotation[3][3];

        status = ellipsoid_advance(&(ellipsoid_member){&model, &surroundings,
                                                       &state, &controller,
                                                       NULL, NULL, &statistics},
                                   &t, i * period / 20, NULL);
        ellipsoid_rotation(state.q, rotation);
        printf("%.3f %+.8f %+.8f %+.8f %+.6e\n", t / period, rotation[0][1],
               rotation[1][1], rotation[2][1], state.omega[2]);
    }
    printf("# %ld steps, %ld rejected: %s\n", statistics.accepted,
           statistics.rejected, ellipsoid_status_text(status));
    return status != ELLIPSOID_OK;
}
