/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    contact.c - the walls' force and torque on a cell in one pose.
*/
#include "exact.h"

#include <math.h>
#include <string.h>

/* How far beyond a bead's surface a gap is measured, in bead radii. */
static const double gap_horizon = 1;

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
        v[i] = 2 * (q[i] * body[n] - q[n] * body[i] + q[3] * cross[i]
                    + axis[i] * along);
    }
}

/* R^T v */
static void to_body(double r[3][3], const double v[3], double body[3])
{
    for (int i = 0; i < 3; i++)
    {
        body[i] = r[0][i] * v[0] + r[1][i] * v[1] + r[2][i] * v[2];
    }
}

/* One bead's part in the derivatives: the centre is x + R(q) arm. */
static void add_derivatives(const double arm[3], const double q[4],
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
        to_body(r, column, body);
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

static void add_bead(const double arm[3], const double q[4], double r[3][3],
                     const double force[3], double force_x[3][3],
                     ellipsoid_contact *contact,
                     ellipsoid_contact_jacobian *jacobian)
{
    double body[3], torque[3];

    to_body(r, force, body);
    ellipsoid_cross(arm, body, torque);
    for (int i = 0; i < 3; i++)
    {
        contact->force[i] += force[i];
        contact->torque[i] += torque[i];
    }
    contact->touching_beads++;
    if (jacobian)
    {
        add_derivatives(arm, q, r, force, force_x, jacobian);
    }
}

/* How far beyond its surface a bead feels the walls */
static double adhesion_reach(const ellipsoid_model *model)
{
    return model->options.adhesion > 0 ? model->options.adhesion_range : 0;
}

/* A bead in the pose (x, R) */
static ellipsoid_bead placed(const ellipsoid_model *model, int b,
                             const double x[3], double r[3][3])
{
    const double radius = model->options.bead_radius;
    ellipsoid_bead bead = {
        .radius = radius,
        .stiffness = 4.0 / 3 * model->options.contact_modulus * sqrt(radius),
        .adhesion = model->options.adhesion,
        .adhesion_range = adhesion_reach(model)};

    for (int i = 0; i < 3; i++)
    {
        bead.centre[i] = x[i] + ellipsoid_dot(r[i], model->bead[b]);
    }
    return bead;
}

/*
    Beads that have moved less than they were from any facet need no look. The
    first round is of those that may feel a wall, in order; if none touches, the
    second finds the gap.
*/
static void sum_beads(const ellipsoid_model *model,
                      const ellipsoid_contact_cache *cache, const double x[3],
                      const double q[4], double moved,
                      ellipsoid_contact *contact,
                      ellipsoid_contact_jacobian *jacobian)
{
    /* the bounds are rounded too */
    const double away = moved + 1e-9 * model->options.bead_radius;
    const double felt = adhesion_reach(model);
    double r[3][3], force[3], force_x[3][3];

    ellipsoid_rotation_inline(q, r);
    for (int round = 0; round < 2 && contact->gap > 0; round++)
    {
        for (int b = 0; b < model->bead_count; b++)
        {
            const double clear =
                cache->nearest[b] - away - model->options.bead_radius;
            const ellipsoid_candidates from = {
                cache->facets, cache->facet + cache->first[b],
                cache->first[b + 1] - cache->first[b]};

            if (round == 0 ? clear > felt
                           : clear <= felt || clear >= contact->gap)
            {
                continue;
            }

            const ellipsoid_bead bead = placed(model, b, x, r);

            if (ellipsoid_bead_touch(&bead, &from, &contact->gap, force,
                                     jacobian ? force_x : NULL, contact)
                > 0)
            {
                add_bead(model->bead[b], q, r, force, force_x, contact,
                         jacobian);
            }
        }
    }
    contact->deepest = fmax(0, -contact->gap);
}

ellipsoid_status ellipsoid_contact_evaluate(
    const ellipsoid_model *model,
    const ellipsoid_surroundings *surroundings,
    const double x[3],
    const double q[4],
    ellipsoid_contact_cache *cache,
    ellipsoid_contact *contact,
    ellipsoid_contact_jacobian *jacobian)
{
    memset(contact, 0, sizeof *contact);
    contact->gap = HUGE_VAL;
    if (jacobian)
    {
        memset(jacobian, 0, sizeof *jacobian);
    }
    if (!ellipsoid_has_walls(model, surroundings))
    {
        return ELLIPSOID_OK;
    }

    contact->gap = gap_horizon * model->options.bead_radius;
    if (model->options.contact_shape == ELLIPSOID_CONTACT_ELLIPSOID)
    {
        return ellipsoid_exact_contact_add(model, surroundings, x, q, cache,
                                           contact, jacobian);
    }

    double moved;
    const ellipsoid_status status = ellipsoid_contact_collect(
        cache, model, surroundings, x, q, contact->gap, &moved);

    if (status == ELLIPSOID_OK && cache->clearance <= 0)
    {
        sum_beads(model, cache, x, q, moved, contact, jacobian);
    }
    return status;
}
