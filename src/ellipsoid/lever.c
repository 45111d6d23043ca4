/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    lever.c - derivatives of a force at a point of the body, and of its torque.
*/
#include "ellipsoidInternal.h"

/* v = (dR/dq_n) body: derivative of the polynomial R(q), n = 0..3. */
static void turned_by(const double q[4], int n, const double body[3],
                      double v[3])
{
    const double along = ellipsoid_dot(q, body);
    double cross[3];

    if (n == 3) /* 2 eta + 2 [eps]x */
    {
        ellipsoid_cross(q, body, cross);
        for (int i = 0; i < 3; i++)
        {
            v[i] = 2 * (q[3] * body[i] + cross[i]);
        }
        return;
    }

    /* 2 (-eps_n + e_n eps^T + eps e_n^T + eta [e_n]x) */
    double axis[3] = {0, 0, 0};

    axis[n] = 1;
    ellipsoid_cross(axis, body, cross);
    for (int i = 0; i < 3; i++)
    {
        v[i] = 2
             * (q[i] * body[n] - q[n] * body[i] + q[3] * cross[i]
                + axis[i] * along);
    }
}

void ellipsoid_add_derivatives(const double arm[3], const double q[4],
                               double r[3][3], const double force[3],
                               double force_x[3][3],
                               ellipsoid_contact_jacobian *jacobian)
{
    const double conjugate[4] = {-q[0], -q[1], -q[2], q[3]};
    double column[3], body[3], torque[3];

    for (int n = 0; n < 7; n++)
    {
        double turned[3];

        if (n < 3)
        {
            for (int i = 0; i < 3; i++)
            {
                column[i] = force_x[i][n];
                jacobian->force_x[i][n] += column[i];
            }
        }
        else
        {
            turned_by(q, n - 3, arm, turned);
            for (int i = 0; i < 3; i++)
            {
                column[i] = ellipsoid_dot(force_x[i], turned);
                jacobian->force_q[i][n - 3] += column[i];
            }
        }
        ellipsoid_to_body(r, column, body);
        if (n >= 3)
        {
            /* the frame turns under the force: (dR/dq_n)^T F, and R^T(q) is
               R of the conjugate */
            turned_by(conjugate, n - 3, force, turned);
            for (int i = 0; i < 3; i++)
            {
                body[i] += n == 6 ? turned[i] : -turned[i];
            }
        }
        ellipsoid_cross(arm, body, torque);
        for (int i = 0; i < 3; i++)
        {
            if (n < 3)
            {
                jacobian->torque_x[i][n] += torque[i];
            }
            else
            {
                jacobian->torque_q[i][n - 3] += torque[i];
            }
        }
    }
}

void ellipsoid_add_other_derivatives(const double arm[3], double r[3][3],
                                     const double other_arm[3],
                                     const double other_q[4],
                                     double force_x[3][3],
                                     ellipsoid_contact_jacobian *jacobian)
{
    for (int n = 0; n < 7; n++)
    {
        double column[3], body[3], torque[3], moved[3] = {0, 0, 0};

        if (n < 3)
        {
            moved[n] = 1;
        }
        else
        {
            turned_by(other_q, n - 3, other_arm, moved);
        }
        ellipsoid_product(force_x, moved, column);
        ellipsoid_to_body(r, column, body);
        ellipsoid_cross(arm, body, torque);
        for (int i = 0; i < 3; i++)
        {
            *(n < 3 ? &jacobian->force_x[i][n]
                    : &jacobian->force_q[i][n - 3]) += column[i];
            *(n < 3 ? &jacobian->torque_x[i][n]
                    : &jacobian->torque_q[i][n - 3]) += torque[i];
        }
    }
}

void ellipsoid_add_to_blocks(const ellipsoid_contact_jacobian *jacobian,
                             double of_force, const double of_torque[3],
                             ellipsoid_blocks *b)
{
    for (int i = 0; i < 3; i++)
    {
        for (int l = 0; l < 3; l++)
        {
            b->ux[i][l] += of_force * jacobian->force_x[i][l];
            b->wx[i][l] += of_torque[i] * jacobian->torque_x[i][l];
        }
        for (int n = 0; n < 4; n++)
        {
            b->uq[i][n] += of_force * jacobian->force_q[i][n];
            b->wq[i][n] += of_torque[i] * jacobian->torque_q[i][n];
        }
    }
}
