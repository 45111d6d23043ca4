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

#include <complex.h>

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

/* A number and, as its imaginary part over the step, a derivative of it: exact to
   rounding where the functions of it are analytic (complex step: Squire & Trapp,
   SIAM Review 40, 110 (1998)). */
typedef double complex ellipsoid_dual;
#define ELLIPSOID_DUAL_STEP 0x1p-100

/* a b without the product of the derivatives, which is nothing beside a b: half
   the instructions of a product that asks for NaN. */
static inline ellipsoid_dual ellipsoid_times(ellipsoid_dual a, ellipsoid_dual b)
{
    const union
    {
        double part[2];
        ellipsoid_dual whole;
    } both = {{creal(a) * creal(b), creal(a) * cimag(b) + cimag(a) * creal(b)}};

    return both.whole;
}

/* The functions of tilt and gap, and their derivatives by nu and the gap, SI
   units. */
typedef struct ellipsoid_plane_values
{
    double f[ELLIPSOID_PLANE_FUNCTIONS], by_nu[ELLIPSOID_PLANE_FUNCTIONS];
    double by_gap[ELLIPSOID_PLANE_FUNCTIONS];
    /* with its derivatives: q; c x n over e x n */
    double squeeze[3], arm[2];
} ellipsoid_plane_values;

/*
    Force [m2/s] and torque [m3/s] over mu, body frame, of one plane and one body:
    `column` by each of the motion relative to a free body's, u and omega, and of
    the shear [1/s], and -squeeze row (row.(u, omega)).
*/
typedef struct ellipsoid_plane_matrix
{
    ellipsoid_dual column[9][6], row[6], squeeze;
} ellipsoid_plane_matrix;

typedef struct ellipsoid_plane_effect
{
    const ellipsoid_plane_table *own;
    double normal[3]; /* body frame */
    double gap[2];    /* [m] of each action, at least the lubrication_gap */
    ellipsoid_plane_values values;
    ellipsoid_plane_matrix
        by_gap; /* with the derivatives by that of each action */
} ellipsoid_plane_effect;

/* What changes with the pose, and its derivatives by that. */
typedef struct ellipsoid_of_pose
{
    double value, by[ELLIPSOID_POSE_SIZE];
} ellipsoid_of_pose;

/* A wall as the body sees it. */
typedef struct ellipsoid_plane
{
    ellipsoid_plane_effect effect;
    ellipsoid_of_pose gap[2]; /* of the effect */
    ellipsoid_of_pose
        weight[2]; /* [-] of each action: 1 on a wall without end */
    double normal_by[ELLIPSOID_POSE_SIZE][3];
} ellipsoid_plane;

typedef struct ellipsoid_planes
{
    int count;
    ellipsoid_plane at[ELLIPSOID_MAX_PLANES];
} ellipsoid_planes;

/* The planes at the pose of a state; derivatives are wrong unless slopes is 1
   (wallPlanes.c). */
ellipsoid_status
ellipsoid_find_planes(const ellipsoid_model *model,
                      const ellipsoid_surroundings *surroundings,
                      const ellipsoid_state *state, int slopes,
                      ellipsoid_facet_cache *cache, ellipsoid_planes *planes);

/* gap: of each action; slopes: as above. */
void ellipsoid_plane_effect_set(const ellipsoid_plane_table *own,
                                const double normal[3], const double gap[2],
                                int slopes, ellipsoid_plane_effect *effect);

/* That of a normal and gaps which differ from those of the effect in their
   derivatives. */
void ellipsoid_plane_matrix_at(const ellipsoid_plane_effect *effect,
                               const ellipsoid_dual normal[3],
                               ellipsoid_dual wider,
                               ellipsoid_plane_matrix *matrix);

/* Its force and torque on a body of this velocity, which a free one outruns by the
   first six of `motion`, in a flow of which (z - z of the centre) shear, the last
   three, is a part; FAR and NEAR apart. */
void ellipsoid_plane_action(const ellipsoid_plane_matrix *matrix,
                            const ellipsoid_dual motion[9],
                            const double velocity[6],
                            ellipsoid_dual action[2][6]);

/* (I - n n) M n, M as [3 i + j]. */
void ellipsoid_along_wall(const double m[9], const ellipsoid_dual n[3],
                          ellipsoid_dual value[3]);

/* What the columns of an effect do by each component of the flow's gradient at the
   centre, and then of its mean; normal and gradient, [3 i + j]: du_i/dx_j, in the
   body frame. Takes from the columns of the shear what they have along n. */
void ellipsoid_wall_fit_columns(const ellipsoid_model *model,
                                const double normal[3], double column[9][6],
                                double by[18][6]);

/* The motion u [m/s], omega [1/s] in a mean gradient g, likewise. */
void ellipsoid_wall_fit_motion(const ellipsoid_model *model,
                               const ellipsoid_dual normal[3],
                               const double g[9], ellipsoid_dual motion[6]);

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
    Force [N] and torque [N m] of the fluid at one pose, body frame: by each
    component of that motion, and how what planes add to the product of both
    changes with the pose.
*/
typedef struct ellipsoid_wall_expansion
{
    int planes; /* how many are near */
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
void ellipsoid_wall_matrix(const ellipsoid_wall_expansion *expansion,
                           double matrix[6][6]);

/* The velocities [m/s, rad/s] at which that meets force and torque, all in the body
   frame. NON_FINITE: it is singular, and they are not set. */
ellipsoid_status ellipsoid_wall_rates(const ellipsoid_wall_expansion *expansion,
                                      const double push[6], double rates[6]);

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
ellipsoid_status
ellipsoid_wall_expansion_error(const ellipsoid_wall_expansion *about,
                               const ellipsoid_wall_expansion *there,
                               double error[6]);

#endif
