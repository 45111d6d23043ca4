/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    beadPairs.c - which beads of two bodies may come into contact.
*/
#include "contact/contact.h"

#include <math.h>

double ellipsoid_pair_horizon(const ellipsoid_model *a,
                              const ellipsoid_model *b)
{
    return fmin(ellipsoid_gap_horizon(a), ellipsoid_gap_horizon(b));
}

int ellipsoid_are_apart(const ellipsoid_model *a, const double x_a[3],
                        const ellipsoid_model *b, const double x_b[3],
                        double far)
{
    /* beads of a stage are placed with a q that is not of length one */
    const double reach = 1.1 * (a->reach + b->reach) + far;
    double line[3];

    ellipsoid_difference(x_a, x_b, line);
    return ellipsoid_dot(line, line) > reach * reach;
}

void ellipsoid_place_body(ellipsoid_body *b, const ellipsoid_model *model,
                          const double x[3], const double q[4])
{
    b->model = model;
    b->x = x;
    b->q = q;
    ellipsoid_rotation_inline(q, b->r);
    for (int n = 0; n < model->bead_count; n++)
    {
        ellipsoid_product(b->r, model->bead[n], b->bead[n]);
    }
}

/* Lies a point [m, lab, from the body's centre] outside the box that holds what
   is nearer than `far` to the centre of a bead? */
static int is_beyond(ellipsoid_body *b, const double point[3], double far)
{
    const double *a = b->model->options.semi_axes;
    /* R(q) of a stage stretches by |q|^2 */
    const double stretch = ellipsoid_square4(b->q);
    double at[3];

    ellipsoid_to_body(b->r, point, at);
    for (int i = 0; i < 3; i++)
    {
        if (fabs(at[i]) >= stretch * (stretch * a[i] + far))
        {
            return 1;
        }
    }
    return 0;
}

void ellipsoid_list_beads(ellipsoid_body *a, ellipsoid_body *b, double far,
                          ellipsoid_near_pair *near)
{
    const double both =
        a->model->options.bead_radius + b->model->options.bead_radius + far;
    double line[3];

    near->listed = 0;
    ellipsoid_difference(a->x, b->x, line);
    for (int n = 0; n < a->model->bead_count; n++)
    {
        double from[3];

        ellipsoid_copy(line, from);
        ellipsoid_add(from, a->bead[n]);
        for (int l = 0; l < b->model->bead_count && !is_beyond(b, from, both);
             l++)
        {
            double between[3];

            ellipsoid_difference(from, b->bead[l], between);
            if (ellipsoid_dot(between, between) >= both * both)
            {
                continue;
            }
            if (near->listed == ELLIPSOID_NEAR_BEADS)
            {
                near->listed = -1;
                return;
            }
            near->bead[near->listed][0] = (unsigned char)n;
            near->bead[near->listed++][1] = (unsigned char)l;
        }
    }
}
