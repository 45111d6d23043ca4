/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    exactMeeting.c - force and torque of two ellipsoids on one another.

    One contact, where they are deepest (exactPair.c), with the law and the
    stiffness of two beads. The points on either surface lie on the line of the
    force: momentum and its moment are kept.
*/
#include "exact.h"
#include "meeting.h"

#include <math.h>

/* Into the body's frame, which turns under the torque where the k-th variable
   is its own rotation. */
static void torque_in_body(double r[3][3], const double torque[3],
                           const double change[3], int own_axis,
                           double in_body[3])
{
    double all[3];

    ellipsoid_copy(change, all);
    if (own_axis >= 0)
    {
        double axis[3] = {0, 0, 0}, turned[3];

        axis[own_axis] = 1;
        ellipsoid_cross(torque, axis, turned);
        ellipsoid_add(all, turned);
    }
    ellipsoid_to_body(r, all, in_body);
}

/* Derivatives by x_a - x_b, a's rotation and b's become those by x and q of
   both. is_a: what is differentiated belongs to a, so that its own are a's. */
static void spread(const ellipsoid_meeting *m, double slope[9][3], double sign,
                   int is_a, double own_x[3][3], double own_q[3][4],
                   double other_x[3][3], double other_q[3][4])
{
    const double of_line = is_a ? sign : -sign;
    double(*by_a)[4] = is_a ? own_q : other_q;
    double(*by_b)[4] = is_a ? other_q : own_q;

    for (int k = 0; k < 3; k++)
    {
        for (int i = 0; i < 3; i++)
        {
            own_x[i][k] = of_line * slope[k][i];
            other_x[i][k] = -of_line * slope[k][i];
        }
    }
    ellipsoid_exact_by_components(m->a->q, slope + 3, by_a);
    ellipsoid_exact_by_components(m->b->q, slope + 6, by_b);
    for (int n = 0; n < 12; n++)
    {
        by_a[n / 4][n % 4] *= sign;
        by_b[n / 4][n % 4] *= sign;
    }
}

static void spread_pair(const ellipsoid_meeting *m, ellipsoid_exact_body *a,
                        ellipsoid_exact_body *b,
                        const ellipsoid_exact_pair *pair, double root,
                        const double force[3], const double torque_a[3],
                        const double torque_b[3])
{
    double df[9][3], da[9][3], db[9][3];

    for (int k = 0; k < 9; k++)
    {
        double point_a[3], point_b[3], moved[3], turned[3], change[3];

        for (int i = 0; i < 3; i++)
        {
            df[k][i] = root
                     * (1.5 * pair->depth_slope[k] * pair->normal[i]
                        + pair->depth * pair->normal_slope[i][k]);
            point_a[i] = pair->point_a_slope[i][k];
            point_b[i] = pair->point_b_slope[i][k];
        }
        ellipsoid_cross(point_a, force, moved);
        ellipsoid_cross(pair->point_a, df[k], turned);
        ellipsoid_copy(moved, change);
        ellipsoid_add(change, turned);
        torque_in_body(a->rotation, torque_a, change, k / 3 == 1 ? k - 3 : -1,
                       da[k]);
        ellipsoid_cross(force, point_b, moved);
        ellipsoid_cross(df[k], pair->point_b, turned);
        ellipsoid_copy(moved, change);
        ellipsoid_add(change, turned);
        torque_in_body(b->rotation, torque_b, change, k / 3 == 2 ? k - 6 : -1,
                       db[k]);
    }
    spread(m, df, 1, 1, m->of_a->own.force_x, m->of_a->own.force_q,
           m->of_a->other.force_x, m->of_a->other.force_q);
    spread(m, da, 1, 1, m->of_a->own.torque_x, m->of_a->own.torque_q,
           m->of_a->other.torque_x, m->of_a->other.torque_q);
    spread(m, df, -1, 0, m->of_b->own.force_x, m->of_b->own.force_q,
           m->of_b->other.force_x, m->of_b->other.force_q);
    spread(m, db, 1, 0, m->of_b->own.torque_x, m->of_b->own.torque_q,
           m->of_b->other.torque_x, m->of_b->other.torque_q);
}

static ellipsoid_exact_body itself(const ellipsoid_body *body)
{
    ellipsoid_exact_body result;

    ellipsoid_exact_place(body->model->options.semi_axes, body->x, body->q,
                          &result);
    return result;
}

double ellipsoid_exact_gap(const ellipsoid_body *a, const ellipsoid_body *b)
{
    const ellipsoid_exact_body of_a = itself(a), of_b = itself(b);
    ellipsoid_exact_pair pair;

    ellipsoid_exact_pair_set(&of_a, &of_b, 0, &pair);
    return -pair.depth;
}

void ellipsoid_meet_exactly(ellipsoid_meeting *m)
{
    ellipsoid_exact_body a = itself(m->a), b = itself(m->b);
    ellipsoid_exact_pair pair;
    double force[3], torque_a[3], torque_b[3], root;

    ellipsoid_exact_pair_set(&a, &b, m->derivatives, &pair);
    m->gap = fmin(m->gap, -pair.depth);
    if (!(pair.depth > 0))
    {
        return;
    }
    m->touching = 1;
    ellipsoid_begin_side(m, m->of_a);
    ellipsoid_begin_side(m, m->of_b);
    root = m->stiffness * sqrt(pair.depth);
    for (int i = 0; i < 3; i++)
    {
        force[i] = root * pair.depth * pair.normal[i];
        m->of_a->force[i] = force[i];
        m->of_b->force[i] = -force[i];
    }
    ellipsoid_cross(pair.point_a, force, torque_a);
    ellipsoid_cross(force, pair.point_b, torque_b);
    ellipsoid_to_body(a.rotation, torque_a, m->of_a->torque);
    ellipsoid_to_body(b.rotation, torque_b, m->of_b->torque);
    if (m->derivatives)
    {
        spread_pair(m, &a, &b, &pair, root, force, torque_a, torque_b);
    }
}
