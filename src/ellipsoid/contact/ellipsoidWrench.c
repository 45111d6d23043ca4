/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    ellipsoidWrench.c - force and torque of a contact between an ellipsoid and a
    wall, or between two ellipsoids, with friction and damping, and their
    derivatives.

    The force acts on both bodies at one point, so that momentum and its moment
    are conserved. A wall is a second body that does not move.
*/
#include "contact/contact.h"

enum
{
    VARIABLES = ELLIPSOID_WRENCH_VARIABLES,
    POSE = ELLIPSOID_PAIR_VARIABLES,
    POSITION = 0,         /* x_a - x_b */
    ROTATION = 3,         /* a small rotation of a, then one of b */
    VELOCITY = 9,         /* u_a - u_b */
    ANGULAR_VELOCITY = 12 /* of a, then that of b */
};

/* The axis of the k-th variable if it belongs to body b, of those that begin at
   `first`; else -1. */
static int own_axis(int k, int first, int b)
{
    const int axis = k - first - 3 * b;

    return axis >= 0 && axis < 3 ? axis : -1;
}

/* The velocity of a's material relative to b's at the contact; and R omega. */
static void set_velocity(const ellipsoid_surface_force *p, double spin[2][3],
                         double velocity[3])
{
    double there[2][3] = {{0}};

    for (int b = 0; b < p->bodies; b++)
    {
        ellipsoid_product(p->body[b]->rotation, p->state[b]->omega, spin[b]);
        ellipsoid_cross(spin[b], p->point[b], there[b]);
        ellipsoid_add(there[b], p->state[b]->u);
    }
    ellipsoid_difference(there[0], there[1], velocity);
}

/* Derivative of this velocity by the k-th variable: omega turns with its
   body. */
static void set_velocity_slope(const ellipsoid_surface_force *p,
                               double spin[2][3], int k, double slope[3])
{
    ellipsoid_set(slope, 0, 0, 0);
    if (k >= VELOCITY && k < ANGULAR_VELOCITY)
    {
        slope[k - VELOCITY] = 1;
        return;
    }
    for (int b = 0; b < p->bodies; b++)
    {
        const int turn = own_axis(k, ROTATION, b);
        const int turning = own_axis(k, ANGULAR_VELOCITY, b);
        double change[3] = {0, 0, 0}, moved[3] = {0, 0, 0}, part[3];

        if (turn >= 0)
        {
            double axis[3] = {0, 0, 0};

            axis[turn] = 1;
            ellipsoid_cross(axis, spin[b], change);
        }
        if (turning >= 0)
        {
            double(*r)[3] = p->body[b]->rotation;

            ellipsoid_set(change, r[0][turning], r[1][turning], r[2][turning]);
        }
        if (k < POSE)
        {
            ellipsoid_cross(spin[b], p->point_slope[b][k], moved);
        }
        ellipsoid_cross(change, p->point[b], part);
        ellipsoid_add(part, moved);
        for (int i = 0; i < 3; i++)
        {
            slope[i] += b == 0 ? part[i] : -part[i];
        }
    }
}

static void set_force_slope(const ellipsoid_surface_force *p, double spin[2][3],
                            ellipsoid_traction *t, int k, double slope[3])
{
    double velocity[3];

    set_velocity_slope(p, spin, k, velocity);
    ellipsoid_product(t->by_velocity, velocity, slope);
    if (k < POSE)
    {
        double part[3];

        ellipsoid_product(t->by_elastic, p->force_slope[k], part);
        ellipsoid_add(slope, part);
    }
}

/* The moment of a force on the first body, or of its opposite on the other. */
static void add_moment(const double point[3], const double force[3], int b,
                       double torque[3])
{
    double moment[3];

    if (b == 0)
    {
        ellipsoid_cross(point, force, moment);
    }
    else
    {
        ellipsoid_cross(force, point, moment);
    }
    ellipsoid_add(torque, moment);
}

void ellipsoid_wrench_add(const ellipsoid_surface_force *p,
                          const ellipsoid_friction_law *law, int derivatives,
                          ellipsoid_wrench *sum)
{
    ellipsoid_traction traction;
    double spin[2][3];

    ellipsoid_copy(p->force, traction.force);
    if (law)
    {
        double velocity[3];

        set_velocity(p, spin, velocity);
        if (!ellipsoid_contact_traction(law, p->force, velocity, derivatives,
                                        &traction))
        {
            return;
        }
        sum->slip = fmin(sum->slip, traction.slip);
    }
    ellipsoid_add(sum->force, traction.force);
    for (int b = 0; b < p->bodies; b++)
    {
        add_moment(p->point[b], traction.force, b, sum->torque[b]);
    }
    for (int k = 0; derivatives && k < (law ? VARIABLES : POSE); k++)
    {
        double slope[3];

        if (p->bodies == 1
            && (own_axis(k, ROTATION, 1) >= 0
                || own_axis(k, ANGULAR_VELOCITY, 1) >= 0))
        {
            continue;
        }
        if (law)
        {
            set_force_slope(p, spin, &traction, k, slope);
        }
        else
        {
            ellipsoid_copy(p->force_slope[k], slope);
        }
        ellipsoid_add(sum->force_slope[k], slope);
        for (int b = 0; b < p->bodies; b++)
        {
            add_moment(p->point[b], slope, b, sum->torque_slope[b][k]);
            if (k < POSE)
            {
                add_moment(p->point_slope[b][k], traction.force, b,
                           sum->torque_slope[b][k]);
            }
        }
    }
}

/* Derivatives by q, row[i][n], from those by small rotations about the lab's
   axes, slope[axis][i]: a change dq is the rotation 2 (dq q*)/q.q, with the
   conjugate q*; a stretch of q is none. */
static void by_components(const double q[4], double slope[3][3],
                          double row[3][4])
{
    const double scale = 2 / (ellipsoid_dot(q, q) + q[3] * q[3]);

    for (int n = 0; n < 4; n++)
    {
        double rotation[3], unit[3] = {0, 0, 0};

        if (n < 3)
        {
            unit[n] = 1;
        }
        ellipsoid_cross(q, unit, rotation);
        for (int i = 0; i < 3; i++)
        {
            rotation[i] += n < 3 ? q[3] * unit[i] : -q[i];
        }
        for (int i = 0; i < 3; i++)
        {
            row[i][n] = scale
                      * (slope[0][i] * rotation[0] + slope[1][i] * rotation[1]
                         + slope[2][i] * rotation[2]);
        }
    }
}

/* Derivatives by the state of body `by`: those of the relative position and
   velocity with their sign. */
static void set_state_derivatives(double slope[VARIABLES][3], int by,
                                  const double q[4], double u[3][3],
                                  double x[3][3], double omega[3][3],
                                  double of_q[3][4])
{
    const double sign = by == 0 ? 1 : -1;

    for (int k = 0; k < 3; k++)
    {
        for (int i = 0; i < 3; i++)
        {
            u[i][k] = sign * slope[VELOCITY + k][i];
            x[i][k] = sign * slope[POSITION + k][i];
            omega[i][k] = slope[ANGULAR_VELOCITY + 3 * by + k][i];
        }
    }
    by_components(q, slope + ROTATION + 3 * by, of_q);
}

/* Torques are in the body frame, which rotates with the body; the force on the
   second body is the opposite one. */
void ellipsoid_wrench_report(const ellipsoid_surface_force *p,
                             const ellipsoid_wrench *sum, int b,
                             double force[3], double torque[3],
                             ellipsoid_wrench_jacobian *const by[2])
{
    double(*r)[3] = p->body[b]->rotation;
    double force_slope[VARIABLES][3], torque_slope[VARIABLES][3];
    const double sign = b == 0 ? 1 : -1;

    for (int i = 0; i < 3; i++)
    {
        force[i] = sign * sum->force[i];
    }
    ellipsoid_to_body(r, sum->torque[b], torque);
    if (!by)
    {
        return;
    }
    for (int k = 0; k < VARIABLES; k++)
    {
        const int turn = own_axis(k, ROTATION, b);
        double change[3];

        ellipsoid_copy(sum->torque_slope[b][k], change);
        if (turn >= 0)
        {
            double axis[3] = {0, 0, 0}, turned[3];

            axis[turn] = 1;
            ellipsoid_cross(sum->torque[b], axis, turned);
            ellipsoid_add(change, turned);
        }
        ellipsoid_to_body(r, change, torque_slope[k]);
        for (int i = 0; i < 3; i++)
        {
            force_slope[k][i] = sign * sum->force_slope[k][i];
        }
    }
    for (int n = 0; n < p->bodies; n++)
    {
        const double *q = p->state[n]->q;
        ellipsoid_wrench_jacobian *to = by[n];

        set_state_derivatives(force_slope, n, q, to->force_u, to->force_x,
                              to->force_omega, to->force_q);
        set_state_derivatives(torque_slope, n, q, to->torque_u, to->torque_x,
                              to->torque_omega, to->torque_q);
    }
}
