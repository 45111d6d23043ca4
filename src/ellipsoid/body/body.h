/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    body.h - the room that knows one ellipsoid: its options, shape, pose,
    resistance, beads and surface quadrature. It depends on nothing else of the
    core; walls, drag, contact and motion depend on it.
*/
#ifndef ELLIPSOID_BODY_H
#define ELLIPSOID_BODY_H

#include "ellipsoid.h"
#include "body/vectors.h"

#include <stdint.h>
#include <string.h>

#define ELLIPSOID_BOLTZMANN 1.380649e-23 /* [J/K], SI 2019 */

/*
    The part of the Jacobian that is not known beforehand: rows are du/dt and
    domega/dt, columns the unknowns. Until all forces are in, rows are force and
    torque; only then are they divided by mass and inertia. The rest follows
    from paper eqs. (2) and (4): dx/dt = u and dq/dt = 1/2 Q(omega) q.
*/
typedef struct ellipsoid_jacobian_blocks
{
    double uu[3][3], ux[3][3], uw[3][3], uq[3][4];
    double wu[3][3], wx[3][3], ww[3][3], wq[3][4];
} ellipsoid_jacobian_blocks;

/* Adds derivatives of force and torque to the blocks: rows of u times
   of_force, row i of omega times of_torque[i] (jacobianBlocks.c). */
void ellipsoid_add_to_blocks(const ellipsoid_wrench_jacobian *jacobian,
                             double of_force, const double of_torque[3],
                             ellipsoid_jacobian_blocks *blocks);

/* The body axes in the lab, the columns of R(q), and their derivatives. Not
   const where it is an argument, as C11 takes no const matrix for a plain one.
 */
typedef struct ellipsoid_frame
{
    double axis[3][3];    /* r_i, as long as q squared */
    double (*by_q)[3][3]; /* [n][i] = dr_i/dq_n; NULL: none are wanted */
} ellipsoid_frame;

/* What acts on a body, summed up. */
typedef struct ellipsoid_body_wrench
{
    double force[3];  /* [N] lab */
    double torque[3]; /* [N m] body */
} ellipsoid_body_wrench;

/* In place, by blocks of 3x3; 0 if one of them is singular
   (invert6.c). */
int ellipsoid_invert6(double matrix[6][6]);

/* Puts the points of FLOW_BODY into the model (surfaceQuadrature.c). */
void ellipsoid_surface_quadrature(ellipsoid_model *model);

/* An ellipsoid in the lab. */
typedef struct ellipsoid_surface
{
    double axes[3], smallest; /* [m] semi-axes */
    double centre[3];         /* [m] */
    double q[4];              /* of length one */
    double rotation[3][3];
    double shape[3][3]; /* [m2] R diag(axes^2) R^T */
} ellipsoid_surface;

/* Sets all of it from a pose; q may be of any length
   (surface.c). */
void ellipsoid_surface_set(const double axes[3], const double x[3],
                           const double q[4], ellipsoid_surface *body);

/* R^T v */
static inline void ellipsoid_to_body(double r[3][3], const double v[3],
                                     double body[3])
{
    ellipsoid_combination(r, v[0], v[1], v[2], body);
}

/* R^T v and R v of an ellipsoid that is not to be changed: C11 takes no const
   matrix for the parameter above. */
static inline void ellipsoid_surface_to_body(const ellipsoid_surface *body,
                                             const double v[3],
                                             double result[3])
{
    const double(*r)[3] = body->rotation;

    ellipsoid_set(result, v[0] * r[0][0] + v[1] * r[1][0] + v[2] * r[2][0],
                  v[0] * r[0][1] + v[1] * r[1][1] + v[2] * r[2][1],
                  v[0] * r[0][2] + v[1] * r[1][2] + v[2] * r[2][2]);
}

static inline void ellipsoid_surface_to_lab(const ellipsoid_surface *body,
                                            const double v[3], double result[3])
{
    const double(*r)[3] = body->rotation;

    ellipsoid_set(result, ellipsoid_dot(r[0], v), ellipsoid_dot(r[1], v),
                  ellipsoid_dot(r[2], v));
}

/* Adds a force [N, lab] at the point `arm` [m, body] and its torque. */
static inline void ellipsoid_add_force_at(const double arm[3], double r[3][3],
                                          const double force[3],
                                          double total[3], double torque[3])
{
    double body[3], turning[3];

    ellipsoid_to_body(r, force, body);
    ellipsoid_cross(arm, body, turning);
    ellipsoid_add(total, force);
    ellipsoid_add(torque, turning);
}

/* What the flow or the field meant by an answer other than 0. */
static inline ellipsoid_status ellipsoid_answer_status(int answer)
{
    return answer > 0 ? ELLIPSOID_STEP_UNDERFLOW : ELLIPSOID_FLOW_FAILED;
}

/* Indices that hang together, each of which begins as its own lowest: the lowest
   of those that hang together with one, and how two come to. */
static inline int ellipsoid_lowest(int *lowest, int i)
{
    while (lowest[i] != i)
    {
        lowest[i] = lowest[lowest[i]];
        i = lowest[i];
    }
    return i;
}

static inline void ellipsoid_unite(int *lowest, int a, int b)
{
    a = ellipsoid_lowest(lowest, a);
    b = ellipsoid_lowest(lowest, b);
    lowest[a > b ? a : b] = a > b ? b : a;
}

/* A number to sort by, and what it belongs to (sort.c). */
typedef struct ellipsoid_sort_key
{
    uint64_t key;
    int index;
} ellipsoid_sort_key;

/* In the order of the numbers that it is made of. */
uint64_t ellipsoid_sort_key_of(double number);

/* Ascending, those of one key by index. */
void ellipsoid_sort(ellipsoid_sort_key *keys, int count);

#endif
