/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    exact.h - the ellipsoid itself against wall facets.
*/
#ifndef EXACT_H
#define EXACT_H

#include "ellipsoidInternal.h"

/* An ellipsoid in the lab. */
typedef struct ellipsoid_exact_body
{
    double axes[3], smallest; /* [m] semi-axes */
    double centre[3];         /* [m] */
    double q[4];              /* of length one */
    double rotation[3][3];
    double shape[3][3]; /* [m2] R diag(axes^2) R^T */
} ellipsoid_exact_body;

/* Sets all of it from a pose; q may be of any length. */
void ellipsoid_exact_place(const double axes[3], const double x[3],
                           const double q[4], ellipsoid_exact_body *body);

/* Variables of derivatives: the centre (lab), and a small rotation (about the
   lab's axes). */
#define ELLIPSOID_EXACT_VARIABLES 6

/* Where the ellipsoid's distance to the wall has a local minimum. */
typedef struct ellipsoid_exact_contact
{
    int feature;      /* as in ellipsoid_nearest */
    double height;    /* [m] from the wall to the ellipsoid; minus the depth */
    double normal[3]; /* unit, along which that is measured; into the fluid */
    double arm[3];    /* [m] from the contact point on the ellipsoid to its
                         centre */
    double support;   /* [m] arm.normal */
    double edge[3];   /* unit, along the edge; only ON_EDGE */

    /* set by ellipsoid_exact_derivatives() */
    double height_slope[ELLIPSOID_EXACT_VARIABLES];
    double normal_slope[3][ELLIPSOID_EXACT_VARIABLES];
    double arm_slope[3][ELLIPSOID_EXACT_VARIABLES];
} ellipsoid_exact_contact;

/* As ellipsoid_facet_nearest(), for the ellipsoid. Returns 2 for a face that is
   deeper than the middle of the body above the contact point, as seen from
   behind. */
int ellipsoid_exact_nearest(const ellipsoid_facet *facet,
                            const ellipsoid_exact_body *body, double reach,
                            ellipsoid_exact_contact *contact);

void ellipsoid_exact_derivatives(const ellipsoid_exact_body *body,
                                 ellipsoid_exact_contact *contact);

/* Can the ellipsoid be nearer than reach [m] to any point of the facet? Errs
   towards 1. */
int ellipsoid_exact_may_meet(const ellipsoid_facet *facet,
                             const ellipsoid_exact_body *body, double reach);

/* Does it cut the facet? (overlap.c) */
int ellipsoid_exact_cuts(const ellipsoid_facet *facet,
                         const ellipsoid_exact_body *body);

/* As ellipsoid_exact_nearest() for the facet's plane in place of the facet, if
   that is cut; the centre is in front of it. */
int ellipsoid_exact_pushed_out(const ellipsoid_facet *facet,
                               const ellipsoid_exact_body *body,
                               ellipsoid_exact_contact *contact);

/* The walls' force and torque on an ellipsoid: the part of
   ellipsoid_contact_evaluate() for it (exactTouch.c). contact->gap is how far
   to look. */
ellipsoid_status
ellipsoid_exact_contact_add(const ellipsoid_model *model,
                            const ellipsoid_surroundings *surroundings,
                            const double x[3], const double q[4],
                            ellipsoid_contact_cache *cache,
                            ellipsoid_contact *contact,
                            ellipsoid_contact_jacobian *jacobian);

/* Derivatives by q, row[i][n], from those by small rotations about the lab's
   axes, slope[axis][i]: a change dq is the rotation 2 (dq q*)/q.q, with the
   conjugate q*; a stretch of q is none (exactTouch.c). */
void ellipsoid_exact_by_components(const double q[4], double slope[3][3],
                                   double row[3][4]);

/* Derivatives of a pair are by x_a - x_b, a small rotation of a, and one of b;
   all in the lab. */
#define ELLIPSOID_EXACT_PAIR_VARIABLES 9

/* Where two ellipsoids are nearest, or deepest in one another (exactPair.c). */
typedef struct ellipsoid_exact_pair
{
    double depth;      /* [m] minus the distance where they are apart */
    double normal[3];  /* unit, from b to a */
    double point_a[3]; /* [m] on a, from its centre */
    double point_b[3]; /* [m] on b, from its centre */

    /* set where derivatives are asked for */
    double depth_slope[ELLIPSOID_EXACT_PAIR_VARIABLES];
    double normal_slope[3][ELLIPSOID_EXACT_PAIR_VARIABLES];
    double point_a_slope[3][ELLIPSOID_EXACT_PAIR_VARIABLES];
    double point_b_slope[3][ELLIPSOID_EXACT_PAIR_VARIABLES];
} ellipsoid_exact_pair;

void ellipsoid_exact_pair_set(const ellipsoid_exact_body *a,
                              const ellipsoid_exact_body *b, int derivatives,
                              ellipsoid_exact_pair *pair);

#endif
