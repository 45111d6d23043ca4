/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    jacobianBlocks.c - what a force and its torque add to the Jacobian.
*/
#include "body/body.h"

void ellipsoid_add_to_blocks(const ellipsoid_wrench_jacobian *jacobian,
                             double of_force, const double of_torque[3],
                             ellipsoid_jacobian_blocks *b)
{
    for (int i = 0; i < 3; i++)
    {
        for (int l = 0; l < 3; l++)
        {
            b->uu[i][l] += of_force * jacobian->force_u[i][l];
            b->ux[i][l] += of_force * jacobian->force_x[i][l];
            b->uw[i][l] += of_force * jacobian->force_omega[i][l];
            b->wu[i][l] += of_torque[i] * jacobian->torque_u[i][l];
            b->wx[i][l] += of_torque[i] * jacobian->torque_x[i][l];
            b->ww[i][l] += of_torque[i] * jacobian->torque_omega[i][l];
        }
        for (int n = 0; n < 4; n++)
        {
            b->uq[i][n] += of_force * jacobian->force_q[i][n];
            b->wq[i][n] += of_torque[i] * jacobian->torque_q[i][n];
        }
    }
}
