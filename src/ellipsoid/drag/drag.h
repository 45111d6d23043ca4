/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    drag.h - the room that knows what the fluid exerts on a body: the motion of
    a free body in the flow averaged over it (Faxen), the random force and
    torque, and the resistance near walls. It depends on walls and body.
*/
#ifndef ELLIPSOID_DRAG_H
#define ELLIPSOID_DRAG_H

#include "walls/walls.h"

/* The motion that the flow would give a body free of other forces, and its
   derivatives; u_q only of FLOW_BODY. */
typedef struct ellipsoid_free_motion
{
    double u[3];     /* [m/s] lab */
    double omega[3]; /* [rad/s] body */
    double u_x[3][3], u_q[3][4];
    double omega_x[3][3], omega_q[3][4];
} ellipsoid_free_motion;

/* The free motion by FLOW_BODY at x, where the flow is centre_velocity. */
ellipsoid_status ellipsoid_faxen(const ellipsoid_model *model,
                                 const ellipsoid_surroundings *surroundings,
                                 const double x[3],
                                 const double centre_velocity[3],
                                 ellipsoid_frame *frame,
                                 ellipsoid_free_motion *free);

/* The random force and torque of a noise interval (brownian.c). */
typedef struct ellipsoid_noise
{
    double force[3];  /* [N] body */
    double torque[3]; /* [N m] body */
    double start, end; /* [s] of the interval */
    double tolerance;  /* [s] a time so close to an end counts as that end */
} ellipsoid_noise;

/* The noise of the interval that holds t. STEP_UNDERFLOW: t is too far from 0
   for intervals so short. */
ellipsoid_status ellipsoid_noise_at(const ellipsoid_model *model,
                                    const ellipsoid_surroundings *surroundings,
                                    double t, ellipsoid_noise *noise);

/* Adds it to the wrench and, if wanted, to the blocks. */
void ellipsoid_add_noise(const ellipsoid_noise *noise, ellipsoid_frame *frame,
                         ellipsoid_body_wrench *wrench,
                         ellipsoid_jacobian_blocks *blocks);

/* Does the resistance know of walls? */
static inline int
ellipsoid_has_near_walls(const ellipsoid_model *model,
                         const ellipsoid_surroundings *around)
{
    return model->options.wall_resistance != ELLIPSOID_WALL_RESISTANCE_NONE
        && around->walls && around->flow;
}

/* Walls that act at once; of more, the nearest. */
#define ELLIPSOID_MAX_PLANES 24

/* The position x and the quaternion q: what derivatives are taken by. */
#define ELLIPSOID_POSE_SIZE 7

/* A number that depends on the pose; the slopes only where asked for. */
typedef struct ellipsoid_quantity
{
    double value, slope[ELLIPSOID_POSE_SIZE];
} ellipsoid_quantity;

/* A wall as the body sees it: the plane on which it rests, grown or shrunk. */
typedef struct ellipsoid_plane
{
    double normal[3]; /* unit, body frame, into the fluid */
    double normal_slope[ELLIPSOID_POSE_SIZE][3];
    ellipsoid_quantity height; /* [m] of the centre above the plane */
    ellipsoid_quantity window; /* [-] 1 near, 0 out of range */
    ellipsoid_quantity extent; /* [-] 1 where its point is on the wall, 0 well
                                  beside it */
    ellipsoid_quantity weight; /* [-] 0 to 1: both, and what they leave to
                                  other planes */
    int feature;               /* where its point is, as in ellipsoid_nearest */
    const double *vertex[2];   /* of that edge, or of that vertex the first */
} ellipsoid_plane;

typedef struct ellipsoid_planes
{
    int count;
    ellipsoid_plane at[ELLIPSOID_MAX_PLANES + 1]; /* one, where it is tried */
} ellipsoid_planes;

/* The planes at the pose of a state (wallPlanes.c). */
ellipsoid_status
ellipsoid_find_planes(const ellipsoid_model *model,
                      const ellipsoid_surroundings *surroundings,
                      const ellipsoid_state *state, ellipsoid_frame *frame,
                      ellipsoid_facet_cache *cache, ellipsoid_planes *planes);

/* What is kept of planes near a pose; of more than so many nothing. */
#define ELLIPSOID_MOST_LINEAR 8

typedef struct ellipsoid_linear_plane
{
    double normal[3], normal_slope[ELLIPSOID_POSE_SIZE][3];
    ellipsoid_quantity height, weight; /* as those of a plane */
} ellipsoid_linear_plane;

typedef struct ellipsoid_linear_planes
{
    int count;         /* -1: they are too many */
    double x[3], q[4]; /* where */
    double rates[6];   /* there, as ellipsoid_wall_rates() */
    ellipsoid_linear_plane at[ELLIPSOID_MOST_LINEAR];
} ellipsoid_linear_planes;

/* The velocities of the fluid relative to the body, (R^T (u_free - u),
   omega_free - w^), body frame. */
void ellipsoid_wall_rates(ellipsoid_frame *frame,
                          const ellipsoid_free_motion *free,
                          const ellipsoid_state *state, double rates[6]);

/* The drag (F^, T^) in the body frame that they make near these planes; 0 if
   the resistance is singular (wallDrag.c). */
int ellipsoid_wall_action(const ellipsoid_model *model,
                          const ellipsoid_planes *planes,
                          const double rates[6], double action[6]);

/* Keeps planes with their slopes; as they are at another pose if all is linear
   in the pose; and what that leaves out at a state where `is` was set, as
   velocities of the free body (linearPlanes.c). */
void ellipsoid_linear_planes_set(const ellipsoid_planes *planes,
                                 const ellipsoid_state *state,
                                 const double rates[6],
                                 ellipsoid_linear_planes *linear);
void ellipsoid_linear_planes_at(const ellipsoid_linear_planes *linear,
                                const ellipsoid_state *state,
                                ellipsoid_planes *planes);
void ellipsoid_linear_planes_defect(const ellipsoid_model *model,
                                    const ellipsoid_linear_planes *linear,
                                    const ellipsoid_linear_planes *is,
                                    const ellipsoid_state *state,
                                    double defect[6]);

/* The resistance near walls as it is kept over a step (wallDrag.c). */
typedef struct ellipsoid_kept_resistance
{
    double longest;      /* [s] of a step over which it may be; 0: none */
    int acts;            /* do walls add to that of the free body? */
    int in_blocks;       /* are the blocks those of a kept one? */
    double matrix[6][6]; /* [N s/m, ...] body frame */
} ellipsoid_kept_resistance;

/* Sets it, and how long it may be kept. gap [m]: to where it touches, as far as
   contact knows. NON_FINITE: it is singular. */
ellipsoid_status ellipsoid_keep_resistance(const ellipsoid_model *model,
                                           const ellipsoid_planes *planes,
                                           ellipsoid_frame *frame,
                                           const ellipsoid_free_motion *free,
                                           const ellipsoid_state *state,
                                           double gap,
                                           ellipsoid_kept_resistance *kept);

/* As ellipsoid_add_wall_drag() with a resistance that is the same in all poses,
   as seen by the body. */
void ellipsoid_add_kept_drag(const ellipsoid_model *model,
                             const ellipsoid_kept_resistance *kept,
                             ellipsoid_frame *frame,
                             const ellipsoid_free_motion *free,
                             const ellipsoid_state *state,
                             ellipsoid_body_wrench *wrench,
                             ellipsoid_jacobian_blocks *blocks);

/* Adds to the state's u and omega what a wrench does against the resistance
   near these planes (wallDrag.c). NON_FINITE: the resistance is singular. */
ellipsoid_status
ellipsoid_add_wall_mobility(const ellipsoid_model *model,
                            const ellipsoid_planes *planes,
                            ellipsoid_frame *frame,
                            const ellipsoid_body_wrench *wrench,
                            ellipsoid_state *state);

/* Adds the drag near these planes to the wrench and, if wanted, to the blocks.
   NON_FINITE: the resistance is singular. */
ellipsoid_status ellipsoid_add_wall_drag(const ellipsoid_model *model,
                                         const ellipsoid_planes *planes,
                                         ellipsoid_frame *frame,
                                         const ellipsoid_free_motion *free,
                                         const ellipsoid_state *state,
                                         ellipsoid_body_wrench *wrench,
                                         ellipsoid_jacobian_blocks *blocks);

#endif
