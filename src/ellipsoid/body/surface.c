/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    surface.c - the ellipsoid's surface in a pose.
*/
#include "body/body.h"

void ellipsoid_surface_set(const double axes[3], const double x[3],
                           const double q[4], ellipsoid_surface *body)
{
    ellipsoid_copy(axes, body->axes);
    body->smallest = fmin(axes[0], fmin(axes[1], axes[2]));
    ellipsoid_copy(x, body->centre);
    memcpy(body->q, q, sizeof body->q);
    ellipsoid_normalise(body->q);
    ellipsoid_rotation_inline(body->q, body->rotation);
    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j <= i; j++)
        {
            double sum = 0;

            for (int k = 0; k < 3; k++)
            {
                sum += body->rotation[i][k] * body->rotation[j][k] * axes[k]
                     * axes[k];
            }
            body->shape[i][j] = body->shape[j][i] = sum;
        }
    }
}
