/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    brownian.c - the random force and torque of the fluid.

    Fluctuation and dissipation: <F F^T> = 2 kT mu K delta(t), and likewise the
    torque with the rotational resistance. Over an interval dt both are constant
    in the body frame, of variance 2 kT mu K^_i/dt and 2 kT mu C_i/dt.
*/
#include "drag/drag.h"

#include <float.h>

ellipsoid_status ellipsoid_noise_at(const ellipsoid_model *model,
                                    const ellipsoid_surroundings *surroundings,
                                    double t, ellipsoid_noise *noise)
{
    const double interval = model->options.noise_interval;
    const double intervals = t / interval;
    /* a time so close to the end of an interval, in units of it, is that end */
    const double tolerance = fmax(1e-9, 4 * DBL_EPSILON * fabs(intervals));
    const double number = floor(intervals + tolerance);
    double normal[6];

    noise->start = number * interval;
    noise->end = (number + 1) * interval;
    noise->tolerance = tolerance * interval;
    if (!(tolerance < 0.01))
    {
        return ELLIPSOID_STEP_UNDERFLOW;
    }
    ellipsoid_random_normal(surroundings->seed, surroundings->id,
                            (int64_t)number, normal);
    for (int i = 0; i < 3; i++)
    {
        noise->force[i] = model->noise_force[i] * normal[i];
        noise->torque[i] = model->noise_torque[i] * normal[3 + i];
    }
    return ELLIPSOID_OK;
}

void ellipsoid_add_noise(const ellipsoid_noise *noise, ellipsoid_frame *frame,
                         ellipsoid_body_wrench *wrench,
                         ellipsoid_jacobian_blocks *blocks)
{
    const double *f = noise->force;
    double lab[3];

    ellipsoid_combination(frame->axis, f[0], f[1], f[2], lab);
    ellipsoid_add(wrench->force, lab);
    ellipsoid_add(wrench->torque, noise->torque);
    for (int n = 0; blocks && n < 4; n++)
    {
        ellipsoid_combination(frame->by_q[n], f[0], f[1], f[2], lab);
        for (int i = 0; i < 3; i++)
        {
            blocks->uq[i][n] += lab[i];
        }
    }
}
