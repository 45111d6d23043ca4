/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    ellipsoidPairContact.c - force and torque of two ellipsoids on one another.

    One contact, where they are deepest (ellipsoidPair.c), with the law of two
    beads. The points on either surface lie on the line of action of the force;
    it acts on both in the middle between them.
*/
#include "contact/contact.h"

#include <math.h>

static ellipsoid_surface surface_of(const ellipsoid_body *body)
{
    ellipsoid_surface result;

    ellipsoid_surface_set(body->model->options.semi_axes, body->x, body->q,
                          &result);
    return result;
}

double ellipsoid_surface_gap(const ellipsoid_body *a, const ellipsoid_body *b)
{
    const ellipsoid_surface of_a = surface_of(a), of_b = surface_of(b);
    ellipsoid_surface_pair pair;

    ellipsoid_surface_pair_set(&of_a, &of_b, 0, &pair);
    return -pair.depth;
}

static void set_force(const ellipsoid_surface_pair *pair,
                      const ellipsoid_contact_law *law, int derivatives,
                      ellipsoid_surface_force *p)
{
    const ellipsoid_normal_force f =
        ellipsoid_contact_normal_force(law, -pair->depth);
    double line[3]; /* from b's centre to a's */

    ellipsoid_difference(p->body[0]->centre, p->body[1]->centre, line);
    for (int i = 0; i < 3; i++)
    {
        const double sum = pair->point_a[i] + pair->point_b[i];

        p->force[i] = f.force * pair->normal[i];
        p->point[0][i] = 0.5 * (sum - line[i]);
        p->point[1][i] = 0.5 * (sum + line[i]);
        for (int k = 0; derivatives && k < ELLIPSOID_PAIR_VARIABLES; k++)
        {
            const double change =
                pair->point_a_slope[i][k] + pair->point_b_slope[i][k];

            p->force_slope[k][i] =
                f.secant
                * (f.exponent * pair->depth_slope[k] * pair->normal[i]
                   + pair->depth * pair->normal_slope[i][k]);
            p->point_slope[0][k][i] = 0.5 * (change - (k == i));
            p->point_slope[1][k][i] = 0.5 * (change + (k == i));
        }
    }
}

void ellipsoid_surface_pair_contact(ellipsoid_pair_contact *m)
{
    ellipsoid_pair_wrench *const side[2] = {m->of_a, m->of_b};
    ellipsoid_wrench_jacobian *const by[2][2] = {
        {&m->of_a->own, &m->of_a->other}, {&m->of_b->other, &m->of_b->own}};
    ellipsoid_surface a = surface_of(m->a), b = surface_of(m->b);
    ellipsoid_surface_pair pair;

    ellipsoid_surface_pair_set(&a, &b, m->derivatives, &pair);
    m->gap = fmin(m->gap, -pair.depth);
    if (!(pair.depth > 0))
    {
        return;
    }

    ellipsoid_surface_force at = {
        .bodies = 2, .body = {&a, &b}, .state = {m->state_a, m->state_b}};
    ellipsoid_wrench sum = {.slip = HUGE_VAL};

    m->contacts = 1;
    set_force(&pair, &m->normal_law, m->derivatives, &at);
    ellipsoid_wrench_add(&at, m->dissipative ? &m->law : NULL, m->derivatives,
                         &sum);
    m->slip = sum.slip;
    for (int k = 0; k < 2; k++)
    {
        ellipsoid_wrench_report(&at, &sum, k, side[k]->force, side[k]->torque,
                                m->derivatives ? by[k] : NULL);
    }
}
