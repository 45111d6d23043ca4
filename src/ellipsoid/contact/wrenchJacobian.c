/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    wrenchJacobian.c - derivatives of a force at a point of the body, and of its
    torque.
*/
#include "contact/contact.h"

/* v = (dR/dq_n) body: derivative of the polynomial R(q), n = 0..3, that is
   2 (-eps_n + e_n eps^T + eps e_n^T + eta [e_n]x) and 2 (eta + [eps]x). */
static inline void rotation_derivative(const double q[4], int n,
                                       const double b[3], double v[3])
{
    const double along = 2 * ellipsoid_dot(q, b);

    switch (n)
    {
    case 0:
        ellipsoid_set(v, along, 2 * (q[1] * b[0] - q[0] * b[1] - q[3] * b[2]),
                      2 * (q[2] * b[0] - q[0] * b[2] + q[3] * b[1]));
        break;
    case 1:
        ellipsoid_set(v, 2 * (q[0] * b[1] - q[1] * b[0] + q[3] * b[2]), along,
                      2 * (q[2] * b[1] - q[1] * b[2] - q[3] * b[0]));
        break;
    case 2:
        ellipsoid_set(v, 2 * (q[0] * b[2] - q[2] * b[0] - q[3] * b[1]),
                      2 * (q[1] * b[2] - q[2] * b[1] + q[3] * b[0]), along);
        break;
    default:
        ellipsoid_set(v, 2 * (q[3] * b[0] + (q[1] * b[2] - q[2] * b[1])),
                      2 * (q[3] * b[1] + (q[2] * b[0] - q[0] * b[2])),
                      2 * (q[3] * b[2] + (q[0] * b[1] - q[1] * b[0])));
    }
}

/* For all n; written out, as compilers then share what they have in common. */
static inline void rotation_derivatives(const double q[4], const double b[3],
                                        double v[4][3])
{
    rotation_derivative(q, 0, b, v[0]);
    rotation_derivative(q, 1, b, v[1]);
    rotation_derivative(q, 2, b, v[2]);
    rotation_derivative(q, 3, b, v[3]);
}

void ellipsoid_add_wrench_jacobian(const double arm[3], const double q[4],
                                   double r[3][3], const double force[3],
                                   double force_x[3][3],
                                   ellipsoid_wrench_jacobian *jacobian)
{
    const double opposite[4] = {q[0], q[1], q[2], -q[3]};
    double moved[4][3], turned[4][3], column[3], body[3], torque[3];

    for (int n = 0; n < 3; n++)
    {
        ellipsoid_set(column, force_x[0][n], force_x[1][n], force_x[2][n]);
        ellipsoid_to_body(r, column, body);
        ellipsoid_cross(arm, body, torque);
        for (int i = 0; i < 3; i++)
        {
            jacobian->force_x[i][n] += column[i];
            jacobian->torque_x[i][n] += torque[i];
        }
    }

    /* the frame rotates relative to the force: (dR/dq_n)^T F, and R^T(q) is R of
       the opposite */
    rotation_derivatives(q, arm, moved);
    rotation_derivatives(opposite, force, turned);
    for (int n = 0; n < 4; n++)
    {
        ellipsoid_product(force_x, moved[n], column);
        ellipsoid_to_body(r, column, body);
        for (int i = 0; i < 3; i++)
        {
            body[i] += n == 3 ? -turned[n][i] : turned[n][i];
        }
        ellipsoid_cross(arm, body, torque);
        for (int i = 0; i < 3; i++)
        {
            jacobian->force_q[i][n] += column[i];
            jacobian->torque_q[i][n] += torque[i];
        }
    }
}

void ellipsoid_add_cross_jacobian(const double arm[3], double r[3][3],
                                  const double other_arm[3],
                                  const double other_q[4], double force_x[3][3],
                                  ellipsoid_wrench_jacobian *jacobian)
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
            rotation_derivative(other_q, n - 3, other_arm, moved);
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

/* Derivatives by one unknown of one body. */
typedef struct change
{
    double bead[3];     /* of its bead's centre */
    double centre[3];   /* of its own centre */
    double velocity[3]; /* of its material, at the same point from its centre */
} change;

static change change_of(const ellipsoid_attachment *at, int n)
{
    change c = {{0}, {0}, {0}};
    double spin[3] = {0};

    if (n < 3) /* u */
    {
        c.velocity[n] = 1;
        return c;
    }
    if (n < 6) /* x */
    {
        c.bead[n - 3] = c.centre[n - 3] = 1;
        return c;
    }
    if (n < 9) /* omega */
    {
        ellipsoid_set(spin, at->r[0][n - 6], at->r[1][n - 6], at->r[2][n - 6]);
    }
    else
    {
        rotation_derivative(at->state->q, n - 9, at->arm, c.bead);
        rotation_derivative(at->state->q, n - 9, at->state->omega, spin);
    }
    ellipsoid_cross(spin, at->point, c.velocity);
    return c;
}

/* Column n, in the order of the state, of force and torque. */
static void add_column(const double force[3], const double torque[3], int n,
                       ellipsoid_wrench_jacobian *to)
{
    for (int i = 0; i < 3; i++)
    {
        *(n < 3   ? &to->force_u[i][n]
          : n < 6 ? &to->force_x[i][n - 3]
          : n < 9 ? &to->force_omega[i][n - 6]
                  : &to->force_q[i][n - 9]) += force[i];
        *(n < 3   ? &to->torque_u[i][n]
          : n < 6 ? &to->torque_x[i][n - 3]
          : n < 9 ? &to->torque_omega[i][n - 6]
                  : &to->torque_q[i][n - 9]) += torque[i];
    }
}

/*
    The torque R^T (p x F) of a body, p the contact point from its centre: n is
    the changed unknown, of this body itself if `own`.
*/
static void add_wrench(const ellipsoid_attachment *at, const double force[3],
                       const double force_n[3], const double point_n[3],
                       int own, int n, ellipsoid_wrench_jacobian *to)
{
    const double *q = at->state->q;
    const double conjugate[4] = {-q[0], -q[1], -q[2], q[3]};
    double torque_n[3], part[3], body[3];

    ellipsoid_cross(at->point, force_n, torque_n);
    ellipsoid_cross(point_n, force, part);
    ellipsoid_add(torque_n, part);
    ellipsoid_to_body(at->r, torque_n, body);
    if (own && n >= 9)
    {
        double torque[3];

        ellipsoid_cross(at->point, force, torque);
        rotation_derivative(conjugate, n - 9, torque, part);
        for (int i = 0; i < 3; i++)
        {
            body[i] += n == 12 ? part[i] : -part[i];
        }
    }
    add_column(force_n, body, n, to);
}

/* Derivatives of the contact point, from each body's centre, and of the
   traction. */
static void change_friction(ellipsoid_friction *friction, int body,
                            const change *c, double point[2][3],
                            double force[3])
{
    double velocity[3], elastic[3], part[3];

    for (int i = 0; i < 3; i++)
    {
        velocity[i] = body == 0 ? c->velocity[i] : -c->velocity[i];
    }
    for (int k = 0; k < friction->bodies; k++)
    {
        ellipsoid_product(friction->point_c[body], c->bead, point[k]);
        if (k == body)
        {
            ellipsoid_difference(point[k], c->centre, point[k]);
        }
        if (k == 0)
        {
            ellipsoid_cross(friction->attachment[k].spin, point[k], part);
        }
        else
        {
            ellipsoid_cross(point[k], friction->attachment[k].spin, part);
        }
        ellipsoid_add(velocity, part);
    }
    ellipsoid_product(friction->elastic_c[body], c->bead, elastic);
    ellipsoid_product(friction->traction.by_elastic, elastic, force);
    ellipsoid_product(friction->traction.by_velocity, velocity, part);
    ellipsoid_add(force, part);
}

void ellipsoid_add_friction_jacobian(
    ellipsoid_friction *friction,
    ellipsoid_wrench_jacobian *const jacobian[2][2])
{
    const double *f = friction->traction.force;
    const double back[3] = {-f[0], -f[1], -f[2]};

    for (int body = 0; body < friction->bodies; body++)
    {
        for (int n = 0; n < ELLIPSOID_STATE_SIZE; n++)
        {
            const change c = change_of(&friction->attachment[body], n);
            double point[2][3], force_n[3];

            change_friction(friction, body, &c, point, force_n);
            add_wrench(&friction->attachment[0], f, force_n, point[0],
                       body == 0, n, jacobian[0][body]);
            if (friction->bodies == 2)
            {
                ellipsoid_set(force_n, -force_n[0], -force_n[1], -force_n[2]);
                add_wrench(&friction->attachment[1], back, force_n, point[1],
                           body == 1, n, jacobian[1][body]);
            }
        }
    }
}
