/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    drag.h - the room that knows what the fluid exerts on a body: the motion of
    a free body in the flow averaged over it (Faxen), the random force and
    torque, and the resistance near walls. It depends on walls and body.
*/
#ifndef ELLIPSOID_DRAG_H
#define ELLIPSOID_DRAG_H

#include "walls/walls.h"

/* The position x and the quaternion q: what derivatives are taken by. */
#define ELLIPSOID_POSE_SIZE 7

/* The motion that the flow would give a body free of other forces, and its
   derivatives; u_q only of FLOW_BODY. */
typedef struct ellipsoid_free_motion
{
    double u[3];     /* [m/s] lab */
    double omega[3]; /* [rad/s] body */
    double u_x[3][3], u_q[3][4];
    double omega_x[3][3], omega_q[3][4];
    /* [b][i], [1/s]: the flow's gradient along the body axis b, lab, averaged over
       the surface, and its derivatives; only of FLOW_BODY */
    double along[3][3], along_by[ELLIPSOID_POSE_SIZE][3][3];
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
    double force[3];     /* [N] body */
    double torque[3];    /* [N m] body */
    double start, end;   /* [s] of the interval */
    double tolerance;    /* [s] a time so close to an end counts as that end */
    int near;            /* to walls? */
    double factor[6][6]; /* L of the resistance near them, body frame */
} ellipsoid_noise;

/* The noise of the interval that holds t. STEP_UNDERFLOW: t is too far from 0
   for intervals so short. */
ellipsoid_status ellipsoid_noise_at(const ellipsoid_model *model,
                                    const ellipsoid_surroundings *surroundings,
                                    double t, ellipsoid_noise *noise);

/* What presses a body to walls, lab. */
typedef struct ellipsoid_load
{
    double force[3]; /* [N] of all but walls on a body at rest without noise */
    double push[3];  /* [N] of the walls that it touches; 0: none */
} ellipsoid_load;

/*
    Near walls an interval of its own begins where the noise is asked for: sets
    its start, t, an end no later than that of the noise, and the factor of the
    resistance, L L^T; *near is 0 where there are no walls. Then the noise until that
    end or an earlier one.
*/
ellipsoid_status ellipsoid_wall_noise_begin(
    const ellipsoid_model *model, const ellipsoid_surroundings *surroundings,
    const ellipsoid_state *state, ellipsoid_facet_cache *cache, double t,
    const ellipsoid_load *load, ellipsoid_noise *noise);
void ellipsoid_wall_noise_set(const ellipsoid_model *model,
                              const ellipsoid_surroundings *surroundings,
                              double end, ellipsoid_noise *noise);

/* Adds it to the wrench and, if wanted, to the blocks. */
void ellipsoid_add_noise(const ellipsoid_noise *noise, ellipsoid_frame *frame,
                         ellipsoid_body_wrench *wrench,
                         ellipsoid_jacobian_blocks *blocks);

/* Does the resistance know of walls? */
static inline int ellipsoid_has_near_walls(const ellipsoid_model *model,
                                           const ellipsoid_surroundings *around)
{
    return model->wall_range > 0 && around->walls && around->flow;
}

/* Adds to force and torque, or to velocities. */
static inline void ellipsoid_add6(double factor, const double other[6],
                                  double sum[restrict 6])
{
    for (int i = 0; i < 6; i++)
    {
        sum[i] += factor * other[i];
    }
}

/* Walls that act at once; of more, the nearest. */
#define ELLIPSOID_MAX_PLANES 48

/* The two actions of a plane: that of a table, and squeezing. */
enum
{
    ELLIPSOID_PLANE_FAR,
    ELLIPSOID_PLANE_NEAR
};

/* The functions of tilt and gap, and their derivatives by nu and the gap;
   lengths in equatorial radii. */
typedef struct ellipsoid_plane_values
{
    double f[ELLIPSOID_PLANE_FUNCTIONS], by_nu[ELLIPSOID_PLANE_FUNCTIONS];
    double by_gap[ELLIPSOID_PLANE_FUNCTIONS];
    /* with its derivatives: q; c x n over e x n */
    double squeeze[3], arm[2];
} ellipsoid_plane_values;

/*
    One plane and one body: force [m2/s] and torque [m3/s] over mu, body frame, are
    `column` by each of the motion relative to a free body's, u and omega, and of
    the shear [1/s], and -squeeze row (row.(u, omega)).
*/
typedef struct ellipsoid_plane_effect
{
    const ellipsoid_plane_table *own;
    double normal[3]; /* body frame */
    double column[9][6], row[6], squeeze;
    ellipsoid_plane_values values;
} ellipsoid_plane_effect;

/* Where a body is nearest to a plane (wallFit.c). */
typedef struct ellipsoid_wall_fit
{
    double towards;       /* [-] k */
    double nearest[3];    /* [m] r */
    double support;       /* [m] how far r is along the normal */
    double inverse[3][3]; /* [1/m2] */
} ellipsoid_wall_fit;

/* A wall as the body sees it; slopes, by the pose, only where asked for. */
typedef struct ellipsoid_plane
{
    ellipsoid_plane_effect effect;
    ellipsoid_wall_fit fit;
    double gap[2];    /* [m] of each action, at least the lubrication_gap */
    double weight[2]; /* [-] of each action: 1 on a wall without end */
    double normal_slope[ELLIPSOID_POSE_SIZE][3];
    double gap_slope[2][ELLIPSOID_POSE_SIZE];
    double weight_slope[2][ELLIPSOID_POSE_SIZE];
} ellipsoid_plane;

typedef struct ellipsoid_planes
{
    int count;
    ellipsoid_plane at[ELLIPSOID_MAX_PLANES];
} ellipsoid_planes;

/* The planes at the pose of a state; slopes if frame->by_q (wallPlanes.c). */
ellipsoid_status ellipsoid_find_planes(
    const ellipsoid_model *model, const ellipsoid_surroundings *surroundings,
    const ellipsoid_state *state, const ellipsoid_frame *frame,
    ellipsoid_facet_cache *cache, ellipsoid_planes *planes);

/* gap: of each action; slopes: are derivatives to be asked for? */
void ellipsoid_plane_effect_set(const ellipsoid_plane_table *own,
                                const double normal[3], const double gap[2],
                                int slopes, ellipsoid_plane_effect *effect);

/*
    That on a body of this velocity that a free one outruns by `rates`, in a flow
    of which (z - z of the centre) shear is a part; FAR and NEAR apart. change, if
    not NULL: its derivatives by the components of the normal, and of each action
    by its gap.
*/
void ellipsoid_plane_action(ellipsoid_plane_effect *effect,
                            const double rates[6], const double velocity[6],
                            const double shear[3], double action[2][6],
                            double change[4][2][6]);

/* (I - n n) M n, and its derivatives by each component of n. */
void ellipsoid_along_wall(double m[3][3], const double n[3], double value[3],
                          double change[3][3]);

/* The normal is in the body frame. */
void ellipsoid_wall_fit_set(const ellipsoid_model *model,
                            const double normal[3], ellipsoid_wall_fit *fit);

/* What the columns of a motion (ellipsoid_plane_effect) do by each component of
   the mean gradient, body frame, [3 i + j]: du_i/dx_j. */
void ellipsoid_wall_fit_columns(const double a[3], const double normal[3],
                                ellipsoid_wall_fit *fit, double column[9][6],
                                double by[9][6]);

/* The motion u [m/s], omega [1/s] in a mean gradient g, body frame; change: by each
   component of the normal. */
void ellipsoid_wall_fit_motion(const double a[3], const double normal[3],
                               double g[3][3], ellipsoid_wall_fit *fit,
                               double motion[6], double change[3][6]);

/* What the drag near walls depends on besides the pose. */
typedef struct ellipsoid_near_walls
{
    const ellipsoid_model *model;
    ellipsoid_planes *planes;
    ellipsoid_frame *frame;
    ellipsoid_free_motion *free;
    ellipsoid_flow_sample *flow;
} ellipsoid_near_walls;

/* The motion that the planes act on: u_free - u, omega_free - omega, u, omega and the
   flow's gradient, at the centre and averaged, all in the body frame. */
#define ELLIPSOID_WALL_MOTION 30

/*
    What the planes add at one pose to force [N] and torque [N m], body frame: by
    each component of that motion, and how the product of both changes with the
    pose.
*/
typedef struct ellipsoid_wall_expansion
{
    int planes; /* how many are near; 0: nothing else is set */
    double x[3], q[4];
    double by[ELLIPSOID_WALL_MOTION][6];
    double motion[ELLIPSOID_WALL_MOTION];
    double by_pose[ELLIPSOID_POSE_SIZE][6]; /* 0 unless asked for */
} ellipsoid_wall_expansion;

/* Sets all but the motion and by_pose (wallDrag.c). */
void ellipsoid_wall_expansion_set(const ellipsoid_model *model,
                                  ellipsoid_planes *planes,
                                  const ellipsoid_state *state,
                                  ellipsoid_wall_expansion *expansion);

/* mu (diag(K, C) + what the planes add), body frame. */
void ellipsoid_wall_matrix(const ellipsoid_model *model,
                           const ellipsoid_wall_expansion *expansion,
                           double matrix[6][6]);

/* Adds to the state's u and omega what force and torque, both in the body frame,
   do against that. NON_FINITE: it is singular. */
ellipsoid_status ellipsoid_add_wall_mobility(
    const ellipsoid_model *model, const ellipsoid_wall_expansion *expansion,
    ellipsoid_frame *frame, const double push[6], ellipsoid_state *state);

/* Sets the state's u and omega to those that balance this wrench. NON_FINITE, as
   above. */
ellipsoid_status ellipsoid_balance_wall_drag(
    const ellipsoid_near_walls *near, const ellipsoid_wall_expansion *expansion,
    const ellipsoid_body_wrench *wrench, ellipsoid_state *state);

/* Adds the drag to the wrench, in a state near that of the expansion to first
   order; tells the motion, and force and torque in the body frame. */
void ellipsoid_add_wall_drag(const ellipsoid_near_walls *near,
                             const ellipsoid_wall_expansion *about,
                             const ellipsoid_state *state,
                             double motion[ELLIPSOID_WALL_MOTION],
                             double action[6], ellipsoid_body_wrench *wrench);

/* Sets by_pose of an expansion that has its motion, by its planes. */
void ellipsoid_wall_expansion_slopes(const ellipsoid_near_walls *near,
                                     ellipsoid_wall_expansion *expansion);

/* Adds it to the blocks, in a state of that force and torque. */
void ellipsoid_add_wall_drag_blocks(const ellipsoid_near_walls *near,
                                    const ellipsoid_state *state,
                                    const ellipsoid_wall_expansion *about,
                                    const double action[6],
                                    ellipsoid_jacobian_blocks *blocks);

/* The velocities [m/s, rad/s, body frame] that an expansion is wrong by in the
   state of another. NON_FINITE: its resistance is singular. */
ellipsoid_status ellipsoid_wall_expansion_error(
    const ellipsoid_model *model, const ellipsoid_wall_expansion *about,
    const ellipsoid_wall_expansion *there, double error[6]);

#endif
