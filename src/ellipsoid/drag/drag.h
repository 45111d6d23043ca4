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

/* The free motion by FLOW_BODY. axis[i] is r_i, the body axis in the lab, and
   axis_derivatives[n][i] = dr_i/dq_n, NULL where no derivatives are wanted. */
ellipsoid_status
ellipsoid_faxen(const ellipsoid_model *model,
                    const ellipsoid_surroundings *surroundings,
                    const double x[3], const double centre_velocity[3],
                    double axis[3][3], double axis_derivatives[4][3][3],
                    ellipsoid_free_motion *free);

/* The random force and torque of a noise interval (brownian.c). */
typedef struct ellipsoid_noise
{
    double force[3];  /* [N] body */
    double torque[3]; /* [N m] body */
    double start, end; /* [s] of the interval */
    double slack;      /* [s] a time so close to an end counts as that end */
} ellipsoid_noise;

/* The noise of the interval that holds t. STEP_UNDERFLOW: t is too far from 0
   for intervals so short. */
ellipsoid_status ellipsoid_noise_at(const ellipsoid_model *model,
                                    const ellipsoid_surroundings *surroundings,
                                    double t, ellipsoid_noise *noise);

/* Adds it to force [N, lab], torque [N m, body] and, if wanted, the blocks. */
void ellipsoid_add_noise(const ellipsoid_noise *noise, double axis[3][3],
                         double axis_derivatives[4][3][3], double force[3],
                         double torque[3], ellipsoid_blocks *blocks);

/* Does the resistance know of walls? */
static inline int
ellipsoid_has_near_walls(const ellipsoid_model *model,
                         const ellipsoid_surroundings *around)
{
    return model->options.wall_resistance != ELLIPSOID_WALL_RESISTANCE_NONE
        && around->walls != NULL;
}

/*
    The drag where walls are near (wallDrag.c); where none is, *acted is 0 and
    nothing done. balanced: sets the state's u and omega to those that balance
    force [N, lab] and torque [N m, body]. Otherwise, and for the blocks, adds
    the drag to these. axis and axis_derivatives as in ellipsoid_faxen().
*/
ellipsoid_status ellipsoid_wall_drag(
    const ellipsoid_model *model, const ellipsoid_surroundings *surroundings,
    ellipsoid_facet_cache *cache, ellipsoid_state *state, int balanced,
    double axis[3][3], double axis_derivatives[4][3][3],
    const ellipsoid_free_motion *free, double force[3], double torque[3],
    ellipsoid_blocks *blocks, int *acted);

/* Adds to u [m/s, lab] and omega [rad/s, body] what a force [N, lab] and a
   torque [N m, body] do against the resistance in this pose. */
ellipsoid_status ellipsoid_wall_mobility(
    const ellipsoid_model *model, const ellipsoid_surroundings *surroundings,
    ellipsoid_facet_cache *cache, const double x[3], const double q[4],
    const double force[3], const double torque[3], double u[3],
    double omega[3]);

#endif
