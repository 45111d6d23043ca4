/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    friction.c - friction and damping where surfaces touch.

    An elastic contact pushes with P = N n. With v the velocity of the body's
    material at the contact point against what it touches, v_n = v.n and
    v_t = v - v_n n,
        F = N max(0, 1 - 3/2 alpha v_n) (n - mu v_t / sqrt(v_t^2 + v_s^2)).
    The first factor is Hunt & Crossley's (1975): v_n > 0 is separation, and
    this never pulls. The last is Coulomb's friction, regularised below the
    slip speed v_s so that it is smooth, as the Jacobian wants it. Adhesion is a
    force of its own: it pulls a contact the deeper, and so adds to N.
*/
#include "contact/contact.h"

#include <math.h>

ellipsoid_friction_law ellipsoid_friction_law_of(const ellipsoid_model *model)
{
    const ellipsoid_options *o = &model->options;

    return (ellipsoid_friction_law){o->friction, o->slip_speed,
                                   o->contact_damping};
}

/* A cell without friction slides on any other; the rest is between the two. */
ellipsoid_friction_law ellipsoid_friction_law_between(const ellipsoid_model *a,
                                            const ellipsoid_model *b)
{
    const ellipsoid_friction_law of_a = ellipsoid_friction_law_of(a);
    const ellipsoid_friction_law of_b = ellipsoid_friction_law_of(b);

    return (ellipsoid_friction_law){
        sqrt(of_a.friction * of_b.friction),
        fmax(of_a.slip_speed, of_b.slip_speed),
        0.5 * (of_a.damping + of_b.damping)};
}

/* result += scale a b^T */
static void add_outer(double scale, const double a[3], const double b[3],
                      double result[3][3])
{
    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            result[i][j] += scale * a[i] * b[j];
        }
    }
}

/*
    With w = 1/sqrt(v_t^2 + v_s^2), s the damping's factor and d = n - mu w v_t,
    F = N s d. A change of P changes N by n.dP and n by (I - n n^T) dP/N; that
    changes v_t by -v_n dn - n (v_t.dn).
*/
static void set_derivatives(const ellipsoid_friction_law *law, double size,
                            double along, const double slip[3], double w,
                            double damped, ellipsoid_traction *t)
{
    const double *n = t->normal;
    const double rubbing = law->friction * w, bent = rubbing * w * w;
    const double slope = damped > 0 ? 1.5 * law->damping : 0;
    double direction[3];

    for (int i = 0; i < 3; i++)
    {
        direction[i] = n[i] - rubbing * slip[i];
        for (int j = 0; j < 3; j++)
        {
            const double across = (i == j) - n[i] * n[j];

            t->by_velocity[i][j] = -size * damped * rubbing * across;
            t->by_push[i][j] = damped * (1 + rubbing * along) * across;
        }
    }
    add_outer(size * damped * bent, slip, slip, t->by_velocity);
    add_outer(-size * slope, direction, n, t->by_velocity);
    add_outer(damped, direction, n, t->by_push);
    add_outer(damped * rubbing, n, slip, t->by_push);
    add_outer(-damped * bent * along, slip, slip, t->by_push);
    add_outer(-slope, direction, slip, t->by_push);
}

int ellipsoid_contact_traction(const ellipsoid_friction_law *law,
                               const double push[3], const double velocity[3],
                               int derivatives, ellipsoid_traction *t)
{
    const double size = ellipsoid_length(push);

    if (!isnormal(size))
    {
        return 0;
    }
    for (int i = 0; i < 3; i++)
    {
        t->normal[i] = push[i] / size;
    }

    const double along = ellipsoid_dot(t->normal, velocity);
    const double damped = fmax(0, 1 - 1.5 * law->damping * along);
    double slip[3], w;

    for (int i = 0; i < 3; i++)
    {
        slip[i] = velocity[i] - along * t->normal[i];
    }
    w = 1 / sqrt(ellipsoid_dot(slip, slip) + law->slip_speed * law->slip_speed);
    for (int i = 0; i < 3; i++)
    {
        t->force[i] =
            size * damped * (t->normal[i] - law->friction * w * slip[i]);
    }
    if (derivatives)
    {
        set_derivatives(law, size, along, slip, w, damped, t);
    }
    return 1;
}

/* ------------------------------------------------------ bodies that rub */

ellipsoid_attachment ellipsoid_attachment_of(const ellipsoid_state *state, double r[3][3],
                                 const double arm[3])
{
    ellipsoid_attachment grip = {.state = state, .arm = arm, .r = r};

    ellipsoid_product(r, state->omega, grip.spin);
    ellipsoid_product(r, arm, grip.point);
    return grip;
}

int ellipsoid_friction_traction(const ellipsoid_friction_law *law, ellipsoid_friction *rub,
                           int derivatives)
{
    double velocity[3] = {0, 0, 0}, spun[3];

    for (int k = rub->bodies - 1; k >= 0; k--)
    {
        const ellipsoid_attachment *grip = &rub->grip[k];

        ellipsoid_cross(grip->spin, grip->point, spun);
        ellipsoid_add(spun, grip->state->u);
        if (k == 0 && rub->bodies == 2)
        {
            ellipsoid_difference(spun, velocity, velocity);
        }
        else
        {
            ellipsoid_copy(spun, velocity);
        }
    }
    return ellipsoid_contact_traction(law, rub->push, velocity, derivatives,
                                      &rub->traction);
}

void ellipsoid_add_friction(const ellipsoid_friction *rub, int body, double force[3],
                       double torque[3])
{
    const ellipsoid_attachment *grip = &rub->grip[body];
    const double *f = rub->traction.force, sign = body == 0 ? 1 : -1;
    const double felt[3] = {sign * f[0], sign * f[1], sign * f[2]};
    double turning[3], in_body[3];

    ellipsoid_cross(grip->point, felt, turning);
    ellipsoid_to_body(grip->r, turning, in_body);
    ellipsoid_add(force, felt);
    ellipsoid_add(torque, in_body);
}

/*
    The point lies r_b below the bead's centre, along the normal, which turns as
    the push does.
*/
void ellipsoid_add_wall_friction(const ellipsoid_model *model,
                        const ellipsoid_state *state, double r[3][3],
                        const double arm[3], ellipsoid_point_force *push,
                        ellipsoid_contact *contact,
                        ellipsoid_wrench_jacobian *jacobian)
{
    const ellipsoid_friction_law law = ellipsoid_friction_law_of(model);
    const double size = ellipsoid_length(push->force);
    const double lever = size > 0 ? model->options.bead_radius / size : 0;
    ellipsoid_wrench_jacobian *const by_own[2][2] = {{jacobian, NULL},
                                                      {NULL, NULL}};
    ellipsoid_friction rub = {.bodies = 1};

    rub.grip[0] = ellipsoid_attachment_of(state, r, arm);
    for (int i = 0; i < 3; i++)
    {
        rub.push[i] = push->force[i];
        rub.grip[0].point[i] -= lever * push->force[i];
    }
    if (!ellipsoid_friction_traction(&law, &rub, jacobian != NULL))
    {
        return;
    }
    ellipsoid_add_friction(&rub, 0, contact->force, contact->torque);
    for (int j = 0; jacobian && j < 3; j++)
    {
        const double *n = rub.traction.normal;
        const double column[3] = {push->force_x[0][j], push->force_x[1][j],
                                  push->force_x[2][j]};
        const double along = ellipsoid_dot(n, column);

        for (int i = 0; i < 3; i++)
        {
            rub.push_c[0][i][j] = column[i];
            rub.point_c[0][i][j] =
                (i == j) - lever * (column[i] - along * n[i]);
        }
    }
    if (jacobian)
    {
        ellipsoid_add_friction_jacobian(&rub, by_own);
    }
}
