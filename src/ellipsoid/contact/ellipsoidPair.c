/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    ellipsoidPair.c - two ellipsoids against one another.

    With the support functions h(n) = |A R^T n| the depth of one in the other is
    the least over unit vectors n of
        phi(n) = h_a(n) + h_b(n) - n.(x_a - x_b),
    the way that a has to be moved along n until they part; where they are
    apart, minus the distance. At the minimum w = p_a + p_b - (x_a - x_b) is
    along n, p = R A^2 R^T n/h being the points of support: the surfaces are
    nearest, or deepest, at x_a - p_a and x_b + p_b, phi apart along n.

    phi is minimised by Newton's method on the sphere. Its derivatives by the
    poses are those at fixed n; n and p follow from the implicit function.
*/
#include "contact/contact.h"

#include <math.h>

/* Steps that Newton's method may take; five are usual. */
#define MAX_NEWTON 60

/* The support function of one body in a direction. */
typedef struct support
{
    double height;          /* [m] h(n) */
    double point[3];        /* [m] p, from the centre */
    double curvature[3][3]; /* [m] dp/dn = (S - p p^T)/h */
} support;

static void set_support(const ellipsoid_surface *body, const double n[3],
                        support *s)
{
    const double(*shape)[3] = body->shape;
    double stretched[3];

    for (int i = 0; i < 3; i++)
    {
        stretched[i] = ellipsoid_dot(shape[i], n);
    }
    s->height = sqrt(ellipsoid_dot(stretched, n));
    for (int i = 0; i < 3; i++)
    {
        s->point[i] = stretched[i] / s->height;
    }
    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            s->curvature[i][j] =
                (shape[i][j] - s->point[i] * s->point[j]) / s->height;
        }
    }
}

/* phi, the support functions in it, and its derivatives across n. */
typedef struct objective
{
    support a, b;
    double phi;
    double across[2][3];
    double slope[2], curvature[3]; /* 11, 12, 22 */
} objective;

static void evaluate(const ellipsoid_surface *a, const ellipsoid_surface *b,
                     const double line[3], const double n[3], objective *at)
{
    double w[3], both[3];

    set_support(a, n, &at->a);
    set_support(b, n, &at->b);
    for (int i = 0; i < 3; i++)
    {
        w[i] = at->a.point[i] + at->b.point[i] - line[i];
    }
    at->phi = at->a.height + at->b.height - ellipsoid_dot(n, line);
    ellipsoid_tangents(n, at->across);
    for (int k = 0; k < 2; k++)
    {
        at->slope[k] = ellipsoid_dot(at->across[k], w);
        for (int l = k; l < 2; l++)
        {
            for (int i = 0; i < 3; i++)
            {
                both[i] = ellipsoid_dot(at->a.curvature[i], at->across[l])
                        + ellipsoid_dot(at->b.curvature[i], at->across[l]);
            }
            at->curvature[k + l] =
                ellipsoid_dot(at->across[k], both) - (k == l ? at->phi : 0);
        }
    }
}

/* (11, 12, 22) d = r; 0 unless it is positive definite */
static int solve2(const double m[3], const double r[2], double d[2])
{
    const double determinant = m[0] * m[2] - m[1] * m[1];

    d[0] = (m[2] * r[0] - m[1] * r[1]) / determinant;
    d[1] = (m[0] * r[1] - m[1] * r[0]) / determinant;
    return m[0] > 0 && determinant > 0;
}

/* The unit vector along n + d, with d in the plane across n. */
static void retract(const double n[3], double across[2][3], const double d[2],
                    double moved[3])
{
    double length;

    for (int i = 0; i < 3; i++)
    {
        moved[i] = n[i] + d[0] * across[0][i] + d[1] * across[1][i];
    }
    length = ellipsoid_length(moved);
    ellipsoid_set(moved, moved[0] / length, moved[1] / length,
                  moved[2] / length);
}

/* The direction from one to the other, were both one ellipsoid of half the
   size; a function of the poses alone, as is then the minimum that is found. */
static void first_direction(const ellipsoid_surface *a,
                            const ellipsoid_surface *b, const double line[3],
                            double n[3])
{
    double both[3][3], inverse[3][3], length;

    for (int i = 0; i < 9; i++)
    {
        both[i / 3][i % 3] = a->shape[i / 3][i % 3] + b->shape[i / 3][i % 3];
    }
    if (!ellipsoid_invert3(both, inverse))
    {
        memset(inverse, 0, sizeof(inverse));
    }
    ellipsoid_product(inverse, line, n);
    length = ellipsoid_length(n);
    if (isnormal(length))
    {
        ellipsoid_set(n, n[0] / length, n[1] / length, n[2] / length);
    }
    else
    {
        ellipsoid_set(n, 1, 0, 0);
    }
}

static double gradient_norm(const objective *at)
{
    return hypot(at->slope[0], at->slope[1]);
}

static void minimise(const ellipsoid_surface *a, const ellipsoid_surface *b,
                     const double line[3], double n[3], objective *at)
{
    evaluate(a, b, line, n, at);
    for (int step = 0; step < MAX_NEWTON; step++)
    {
        const double down[2] = {-at->slope[0], -at->slope[1]};
        double d[2], moved[3], length;
        objective there;

        if (!solve2(at->curvature, down, d))
        {
            const double scale = fabs(at->curvature[0]) + fabs(at->curvature[1])
                               + fabs(at->curvature[2]);

            d[0] = down[0] / scale;
            d[1] = down[1] / scale;
        }
        length = hypot(d[0], d[1]);
        if (!(length > 1e-15))
        {
            return;
        }
        for (int halved = 0;; halved++)
        {
            retract(n, at->across, d, moved);
            evaluate(a, b, line, moved, &there);
            /* close to the minimum phi is flat to rounding, its slope is not */
            if (length < 1e-3 ? gradient_norm(&there) < gradient_norm(at)
                              : there.phi <= at->phi)
            {
                break;
            }
            if (halved == 30 || length < 1e-7)
            {
                return;
            }
            d[0] *= 0.5;
            d[1] *= 0.5;
        }
        ellipsoid_copy(moved, n);
        *at = there;
    }
}

void ellipsoid_surface_pair_set(const ellipsoid_surface *a,
                                const ellipsoid_surface *b, int derivatives,
                                ellipsoid_surface_pair *pair)
{
    double line[3];
    objective at;

    ellipsoid_difference(a->centre, b->centre, line);
    first_direction(a, b, line, pair->normal);
    minimise(a, b, line, pair->normal, &at);
    pair->depth = at.phi;
    for (int i = 0; i < 3; i++)
    {
        pair->point_a[i] = -at.a.point[i];
        pair->point_b[i] = at.b.point[i];
    }
    for (int k = 0; derivatives && k < ELLIPSOID_PAIR_VARIABLES; k++)
    {
        const double *n = pair->normal;
        double unit[3] = {0, 0, 0}, fixed[3] = {0, 0, 0}, w[3];
        double dn[3], d[2], down[2], moment[3];

        unit[k % 3] = 1;
        if (k < 3)
        {
            pair->depth_slope[k] = -n[k];
            w[0] = -unit[0];
            w[1] = -unit[1];
            w[2] = -unit[2];
        }
        else
        {
            /* p turns with the body, and slides as n does not */
            const support *s = k < 6 ? &at.a : &at.b;
            double turned[3];

            ellipsoid_cross(s->point, n, moment);
            pair->depth_slope[k] = moment[k % 3];
            ellipsoid_cross(unit, s->point, fixed);
            ellipsoid_cross(unit, n, turned);
            for (int i = 0; i < 3; i++)
            {
                fixed[i] -= ellipsoid_dot(s->curvature[i], turned);
            }
            ellipsoid_copy(fixed, w);
        }
        down[0] = -ellipsoid_dot(at.across[0], w);
        down[1] = -ellipsoid_dot(at.across[1], w);
        if (!solve2(at.curvature, down, d))
        {
            d[0] = d[1] = 0; /* deeper than the bodies' curvature: no minimum */
        }
        for (int i = 0; i < 3; i++)
        {
            dn[i] = d[0] * at.across[0][i] + d[1] * at.across[1][i];
        }
        for (int i = 0; i < 3; i++)
        {
            pair->normal_slope[i][k] = dn[i];
            pair->point_a_slope[i][k] = -ellipsoid_dot(at.a.curvature[i], dn)
                                      - (k / 3 == 1 ? fixed[i] : 0);
            pair->point_b_slope[i][k] = ellipsoid_dot(at.b.curvature[i], dn)
                                      + (k / 3 == 2 ? fixed[i] : 0);
        }
    }
}
