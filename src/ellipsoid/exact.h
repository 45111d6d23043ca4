/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    exact.h - the ellipsoid itself against wall facets and other ellipsoids.
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
                            const ellipsoid_state *state,
                            ellipsoid_contact_cache *cache,
                            ellipsoid_contact *contact,
                            ellipsoid_contact_jacobian *jacobian);

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

/* Derivatives of a force of exact contact are by those nine, by u_a - u_b in
   the lab, and by omega of a and of b, each in its body. */
#define ELLIPSOID_EXACT_FORCE_VARIABLES 18

/* What pushes an ellipsoid off a wall, or off another one, at one place. */
typedef struct ellipsoid_exact_push
{
    int bodies;                     /* 1 at a wall: no variables of b */
    ellipsoid_exact_body *body[2];
    const ellipsoid_state *state[2];
    double push[3];                 /* [N] lab, elastic, on the first */
    double point[2][3];             /* [m] lab, from each one's centre */

    /* read where derivatives are asked for */
    double push_slope[ELLIPSOID_EXACT_PAIR_VARIABLES][3];
    double point_slope[2][ELLIPSOID_EXACT_PAIR_VARIABLES][3];
} ellipsoid_exact_push;

/* Sums over such places: the force on the first, torques about the centres. */
typedef struct ellipsoid_exact_wrench
{
    double force[3], torque[2][3]; /* [N], [N m] lab */
    double force_slope[ELLIPSOID_EXACT_FORCE_VARIABLES][3];
    double torque_slope[2][ELLIPSOID_EXACT_FORCE_VARIABLES][3];
} ellipsoid_exact_wrench;

/* Adds a push, with friction and damping unless law is NULL (exactForce.c). */
void ellipsoid_exact_add_push(const ellipsoid_exact_push *push,
                              const ellipsoid_contact_law *law, int derivatives,
                              ellipsoid_exact_wrench *sum);

/* What body b feels: force [N, lab], torque [N m, body] and, unless `by` is
   NULL, their derivatives by the states of the first body and the second. Of
   the push, bodies and states are read. */
void ellipsoid_exact_report(const ellipsoid_exact_push *push,
                            const ellipsoid_exact_wrench *sum, int b,
                            double force[3], double torque[3],
                            ellipsoid_contact_jacobian *const by[2]);

#endif
