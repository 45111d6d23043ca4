/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    friction.c - friction and damping at a contact.

    The elastic force of a contact is P = N n. With v the velocity of the body's
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

/* The law between a cell and its mirror image, which comes as fast from the
   other side and does not slide. */
ellipsoid_friction_law
ellipsoid_friction_law_at_mirror(const ellipsoid_model *model)
{
    const ellipsoid_options *o = &model->options;

    return (ellipsoid_friction_law){0, o->slip_speed, 2 * o->contact_damping};
}

/* The geometric mean of friction: a cell without any slides on any other. */
ellipsoid_friction_law ellipsoid_friction_law_between(const ellipsoid_model *a,
                                                      const ellipsoid_model *b)
{
    const ellipsoid_friction_law of_a = ellipsoid_friction_law_of(a);
    const ellipsoid_friction_law of_b = ellipsoid_friction_law_of(b);

    return (ellipsoid_friction_law){sqrt(of_a.friction * of_b.friction),
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
    const double rate = law->friction * w, curvature = rate * w * w;
    const double slope = damped > 0 ? 1.5 * law->damping : 0;
    double direction[3];

    for (int i = 0; i < 3; i++)
    {
        direction[i] = n[i] - rate * slip[i];
        for (int j = 0; j < 3; j++)
        {
            const double across = (i == j) - n[i] * n[j];

            t->by_velocity[i][j] = -size * damped * rate * across;
            t->by_elastic[i][j] = damped * (1 + rate * along) * across;
        }
    }
    add_outer(size * damped * curvature, slip, slip, t->by_velocity);
    add_outer(-size * slope, direction, n, t->by_velocity);
    add_outer(damped, direction, n, t->by_elastic);
    add_outer(damped * rate, n, slip, t->by_elastic);
    add_outer(-damped * curvature * along, slip, slip, t->by_elastic);
    add_outer(-slope, direction, slip, t->by_elastic);
}

int ellipsoid_contact_traction(const ellipsoid_friction_law *law,
                               const double elastic[3],
                               const double velocity[3], int derivatives,
                               ellipsoid_traction *t)
{
    const double size = ellipsoid_length(elastic);

    if (!isnormal(size))
    {
        return 0;
    }
    for (int i = 0; i < 3; i++)
    {
        t->normal[i] = elastic[i] / size;
    }

    const double along = ellipsoid_dot(t->normal, velocity);
    const double damped = fmax(0, 1 - 1.5 * law->damping * along);
    double slip[3], w;

    for (int i = 0; i < 3; i++)
    {
        slip[i] = velocity[i] - along * t->normal[i];
    }
    w = 1 / sqrt(ellipsoid_dot(slip, slip) + law->slip_speed * law->slip_speed);
    t->slip = law->friction > 0 ? 1 / w : HUGE_VAL;
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

/* ----------------------------------------- friction at one point of a bead */

ellipsoid_attachment ellipsoid_attachment_of(const ellipsoid_state *state,
                                             double r[3][3],
                                             const double arm[3])
{
    ellipsoid_attachment at = {.state = state, .arm = arm, .r = r};

    ellipsoid_product(r, state->omega, at.spin);
    ellipsoid_product(r, arm, at.point);
    return at;
}

int ellipsoid_friction_traction(const ellipsoid_friction_law *law,
                                ellipsoid_friction *friction, int derivatives)
{
    double velocity[3] = {0, 0, 0}, there[3];

    for (int k = friction->bodies - 1; k >= 0; k--)
    {
        const ellipsoid_attachment *at = &friction->attachment[k];

        ellipsoid_cross(at->spin, at->point, there);
        ellipsoid_add(there, at->state->u);
        if (k == 0 && friction->bodies == 2)
        {
            ellipsoid_difference(there, velocity, velocity);
        }
        else
        {
            ellipsoid_copy(there, velocity);
        }
    }
    return ellipsoid_contact_traction(law, friction->elastic, velocity,
                                      derivatives, &friction->traction);
}

void ellipsoid_add_friction(const ellipsoid_friction *friction, int body,
                            double force[3], double torque[3])
{
    const ellipsoid_attachment *at = &friction->attachment[body];
    const double *f = friction->traction.force, sign = body == 0 ? 1 : -1;
    const double on_body[3] = {sign * f[0], sign * f[1], sign * f[2]};
    double moment[3], in_body[3];

    ellipsoid_cross(at->point, on_body, moment);
    ellipsoid_to_body(at->r, moment, in_body);
    ellipsoid_add(force, on_body);
    ellipsoid_add(torque, in_body);
}

/*
    The contact point lies r_b below the bead's centre, along the normal, which
    turns as the elastic force does.
*/
void ellipsoid_add_wall_friction(ellipsoid_wall_contact *at,
                                 const ellipsoid_friction_law *law,
                                 const double arm[3],
                                 const ellipsoid_point_force *elastic)
{
    const double size = ellipsoid_length(elastic->force);
    const double per_force =
        size > 0 ? at->model->options.bead_radius / size : 0;
    ellipsoid_wrench_jacobian *const by_own[2][2] = {{at->jacobian, NULL},
                                                     {NULL, NULL}};
    ellipsoid_friction friction = {.bodies = 1};

    friction.attachment[0] = ellipsoid_attachment_of(at->state, at->r, arm);
    for (int i = 0; i < 3; i++)
    {
        friction.elastic[i] = elastic->force[i];
        friction.attachment[0].point[i] -= per_force * elastic->force[i];
    }
    if (!ellipsoid_friction_traction(law, &friction, at->jacobian != NULL))
    {
        return;
    }
    at->contact->slip = fmin(at->contact->slip, friction.traction.slip);
    ellipsoid_add_friction(&friction, 0, at->contact->force,
                           at->contact->torque);
    if (!at->jacobian)
    {
        return;
    }
    for (int j = 0; j < 3; j++)
    {
        const double *n = friction.traction.normal;
        const double column[3] = {elastic->force_x[0][j],
                                  elastic->force_x[1][j],
                                  elastic->force_x[2][j]};
        const double along = ellipsoid_dot(n, column);

        for (int i = 0; i < 3; i++)
        {
            friction.elastic_c[0][i][j] = column[i];
            friction.point_c[0][i][j] =
                (i == j) - per_force * (column[i] - along * n[i]);
        }
    }
    ellipsoid_add_friction_jacobian(&friction, by_own);
}
