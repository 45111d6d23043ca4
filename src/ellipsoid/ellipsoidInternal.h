/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    ellipsoidInternal.h - what the core's own files share; the integrator's
    share more, see integrator.h.

    Not installed and not for users: everything here may change. Tests may
    include it.
*/
#ifndef ELLIPSOID_INTERNAL_H
#define ELLIPSOID_INTERNAL_H

#include "ellipsoid.h"
#include "vectors.h"

#include <string.h>

/*
    The part of the Jacobian that is not known beforehand: rows are the
    accelerations du/dt and domega/dt, columns the unknowns. The rest follows
    from paper eqs. (2) and (4): dx/dt = u and dq/dt = 1/2 Q(omega) q.
*/
typedef struct ellipsoid_blocks
{
    double uu[3][3], ux[3][3], uw[3][3], uq[3][4];
    double wu[3][3], wx[3][3], ww[3][3], wq[3][4];
} ellipsoid_blocks;

/* The motion that the flow would give a body free of other forces, and its
   derivatives; u_q only of FLOW_BODY. */
typedef struct ellipsoid_free_motion
{
    double u[3];     /* [m/s] lab */
    double omega[3]; /* [rad/s] body */
    double u_x[3][3], u_q[3][4];
    double omega_x[3][3], omega_q[3][4];
} ellipsoid_free_motion;

/* Puts the points of FLOW_BODY into the model; returns how many, 0 if the
   options do not allow it (bodyFlow.c). */
int ellipsoid_flow_points(ellipsoid_model *model);

/* The free motion by FLOW_BODY. axis[i] is r_i, the body axis in the lab, and
   axis_derivatives[n][i] = dr_i/dq_n, NULL where no derivatives are wanted. */
ellipsoid_status
ellipsoid_body_flow(const ellipsoid_model *model,
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

/* Sets the model's standard deviations. */
void ellipsoid_noise_scales(ellipsoid_model *model);

/* The noise of the interval that holds t. STEP_UNDERFLOW: t is too far from 0
   for intervals so short. */
ellipsoid_status ellipsoid_noise_at(const ellipsoid_model *model,
                                    const ellipsoid_surroundings *surroundings,
                                    double t, ellipsoid_noise *noise);

/* Adds it to force [N, lab], torque [N m, body] and, if wanted, the blocks. */
void ellipsoid_add_noise(const ellipsoid_noise *noise, double axis[3][3],
                         double axis_derivatives[4][3][3], double force[3],
                         double torque[3], ellipsoid_blocks *blocks);

/* Adds to force [N, lab] and torque [N m, body], and to the blocks if wanted,
   what is not drag, contact, constant or DUDT; of that the blocks alone
   (forces.c). flow may be NULL. */
ellipsoid_status ellipsoid_add_forces(
    const ellipsoid_model *model, const ellipsoid_surroundings *surroundings,
    const double x[3], double axis[3][3], double axis_derivatives[4][3][3],
    ellipsoid_flow_sample *flow, double force[3], double torque[3],
    ellipsoid_blocks *blocks);

/*
    One evaluation of the equations: derivative, the contact met (may be NULL
    where there are no walls) and, if not NULL, the blocks. balanced: the
    state's u and omega are first set to those that balance the forces; their
    derivatives are then zero. noise may be NULL. Returns STEP_UNDERFLOW where a
    callback asks for a shorter step.
*/
ellipsoid_status ellipsoid_evaluate(const ellipsoid_model *model,
                                    const ellipsoid_surroundings *surroundings,
                                    const ellipsoid_noise *noise,
                                    ellipsoid_state *state, int balanced,
                                    ellipsoid_contact_cache *cache,
                                    ellipsoid_state *derivative,
                                    ellipsoid_contact *contact,
                                    ellipsoid_blocks *blocks);

/* What the flow or the field meant by an answer other than 0. */
static inline ellipsoid_status ellipsoid_answer_status(int answer)
{
    return answer > 0 ? ELLIPSOID_STEP_UNDERFLOW : ELLIPSOID_FLOW_FAILED;
}

/* ------------------------------------------------------------- contact */

/* Where the distance from a point to the wall has a local minimum. */
typedef struct ellipsoid_nearest
{
    enum
    {
        ELLIPSOID_ON_FACE,
        ELLIPSOID_ON_EDGE,
        ELLIPSOID_ON_VERTEX
    } feature;
    double height;    /* [m] distance; negative behind a face */
    double normal[3]; /* unit, from there to the point; into the fluid */
    double edge[3];   /* unit, along the edge; only ON_EDGE */
} ellipsoid_nearest;

/* Fills *nearest and returns 1 if there is one nearer than reach [m] on this
   facet (facets.c). */
int ellipsoid_facet_nearest(const ellipsoid_facet *facet,
                            const double centre[3], double reach,
                            ellipsoid_nearest *nearest);

/* Could ellipsoid_facet_nearest() find one, were the point moved by up to
   margin [m]? Errs towards 1. Beside the facet's ball, by more than 1.5 times
   the margin as seen along its normal, only a convex edge can. */
int ellipsoid_facet_concerns(const ellipsoid_facet *facet,
                             const double centre[3], double reach,
                             double margin);

/* Does it have a convex edge? (facets.c) */
int ellipsoid_facet_has_rim(const ellipsoid_facet *facet);

/* A vertex is answered for by the facets that have a convex edge there and, for
   the sake of rounding, by those that the point is right above. */
int ellipsoid_facet_answers(const ellipsoid_facet *facet, int k);

/* Is the wall at this vertex nowhere nearer to the point? r: vertex to point */
int ellipsoid_facet_is_apex(const ellipsoid_facet *facet, int k,
                            const double r[3], double tolerance);

/* One bead, lab frame. */
typedef struct ellipsoid_bead
{
    double centre[3]; /* [m] */
    double radius;    /* [m] */
    double stiffness; /* [N/m^1.5] 4/3 E* sqrt(r_b) */
    double adhesion;  /* [N] pull-off force, 0: none */
    double adhesion_range; /* [m] beyond the surface, 0 without adhesion */
} ellipsoid_bead;

/* facets[index[k]], k < count, in ascending order */
typedef struct ellipsoid_candidates
{
    const ellipsoid_facet *facets;
    const int *index;
    int count;
} ellipsoid_candidates;

/* A force on a bead [N], and its derivative by the bead's centre [N/m]. */
typedef struct ellipsoid_bead_feels
{
    double force[3], force_x[3][3];
} ellipsoid_bead_feels;

/*
    The wall's force on one bead (touch.c), set only where it is felt: that of
    overlap, which pushes, and that of adhesion, which pulls; returns the number
    of contacts. *gap [m] is how far beyond the bead to look and is lowered to
    the smallest gap found (minus the depth of an overlap). Surfaces touched are
    noted in *report, which may be NULL.
*/
int ellipsoid_bead_touch(const ellipsoid_bead *bead,
                         const ellipsoid_candidates *from, double *gap,
                         int derivatives, ellipsoid_bead_feels *push,
                         ellipsoid_bead_feels *pull,
                         ellipsoid_contact *report);

/*
    Sees to it that the cache holds all facets that beads can meet in this pose
    with gaps of up to horizon [m] (neighbours.c); collects them anew only if
    the cell has moved too far. *moved [m] is how far beads may have, since.
    STEP_UNDERFLOW: the walls ask for a shorter step, WALLS_FAILED: they gave
    up.
*/
ellipsoid_status
ellipsoid_contact_collect(ellipsoid_contact_cache *cache,
                          const ellipsoid_model *model,
                          const ellipsoid_surroundings *surroundings,
                          const double x[3], const double q[4], double horizon,
                          double *moved);

/* The walls near a place, with what their answer means (neighbours.c). */
ellipsoid_status
ellipsoid_list_facets(const ellipsoid_surroundings *surroundings,
                      const double centre[3], double reach,
                      ellipsoid_facet_list *list);

/* How far beyond a surface gaps are measured [m], to walls and to cells: the
   guard against tunnelling counts on it. */
static inline double ellipsoid_gap_horizon(const ellipsoid_model *model)
{
    return model->options.bead_radius;
}

/* How far beyond its surface a cell feels the walls [m]. */
static inline double ellipsoid_adhesion_reach(const ellipsoid_options *o)
{
    return o->adhesion > 0 ? o->adhesion_range : 0;
}

/* -------------------------------------------------- a force on the body */

/* R^T v */
static inline void ellipsoid_to_body(double r[3][3], const double v[3],
                                     double body[3])
{
    ellipsoid_combination(r, v[0], v[1], v[2], body);
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

/*
    Adds the derivatives of a force at x + R(q) arm, and of its torque, by the
    body's own pose: force_x is that of the force by this point (lever.c).
*/
void ellipsoid_add_derivatives(const double arm[3], const double q[4],
                               double r[3][3], const double force[3],
                               double force_x[3][3],
                               ellipsoid_contact_jacobian *jacobian);

/* Likewise by the pose of another body, that of its point `other_arm`. */
void ellipsoid_add_other_derivatives(const double arm[3], double r[3][3],
                                     const double other_arm[3],
                                     const double other_q[4],
                                     double force_x[3][3],
                                     ellipsoid_contact_jacobian *jacobian);

/* Adds derivatives of force and torque to the blocks: rows of u times
   of_force, row i of omega times of_torque[i]. */
void ellipsoid_add_to_blocks(const ellipsoid_contact_jacobian *jacobian,
                             double of_force, const double of_torque[3],
                             ellipsoid_blocks *blocks);

/* ------------------------------------------------- friction and damping */

typedef struct ellipsoid_contact_law
{
    double friction;   /* [-] mu */
    double slip_speed; /* [m/s] v_s */
    double damping;    /* [s/m] alpha */
} ellipsoid_contact_law;

ellipsoid_contact_law ellipsoid_law_of(const ellipsoid_model *model);
ellipsoid_contact_law ellipsoid_law_between(const ellipsoid_model *a,
                                            const ellipsoid_model *b);

/* The force where surfaces touch, and its derivatives. */
typedef struct ellipsoid_traction
{
    double normal[3];
    double force[3];          /* [N] lab */
    double by_push[3][3];     /* [-] by the elastic force, v being held */
    double by_velocity[3][3]; /* [N s/m] */
} ellipsoid_traction;

/* From the elastic force [N] and the velocity of the material there [m/s], both
   lab; 0 where there is no push (contactLaw.c). */
int ellipsoid_contact_traction(const ellipsoid_contact_law *law,
                               const double push[3], const double velocity[3],
                               int derivatives, ellipsoid_traction *traction);

/* Where a body is held by one of its beads. */
typedef struct ellipsoid_grip
{
    const ellipsoid_state *state;
    const double *arm;  /* [m] body, the bead's centre */
    double (*r)[3];     /* R(q) */
    double spin[3];     /* [rad/s] lab, R omega */
    double point[3];    /* [m] lab, the contact point, from the body's centre */
} ellipsoid_grip;

/* Its point is the bead's centre. */
ellipsoid_grip ellipsoid_grip_of(const ellipsoid_state *state, double r[3][3],
                                 const double arm[3]);

/* A body and a wall, or two bodies, that rub at one point. */
typedef struct ellipsoid_rub
{
    int bodies;
    ellipsoid_grip grip[2];
    double push[3];         /* [N] elastic force on the first */
    double push_c[2][3][3]; /* [N/m] derivative by the centre of each's bead */
    double point_c[2][3][3]; /* [-] likewise, of the contact point */
    ellipsoid_traction traction; /* on the first */
} ellipsoid_rub;

/* Sets the traction; 0 where there is none. */
int ellipsoid_rub_traction(const ellipsoid_contact_law *law, ellipsoid_rub *rub,
                           int derivatives);

/* Adds what a body feels: force [N, lab] and torque [N m, body]. */
void ellipsoid_add_rub(const ellipsoid_rub *rub, int body, double force[3],
                       double torque[3]);

/* Adds to jacobian[i][k] the derivatives of what body i feels by the state of
   body k (lever.c). */
void ellipsoid_add_rub_derivatives(
    ellipsoid_rub *rub, ellipsoid_contact_jacobian *const jacobian[2][2]);

/* A wall's push on a bead becomes force and torque with friction and damping;
   jacobian may be NULL. */
void ellipsoid_rub_wall(const ellipsoid_model *model,
                        const ellipsoid_state *state, double r[3][3],
                        const double arm[3], ellipsoid_bead_feels *push,
                        ellipsoid_contact *contact,
                        ellipsoid_contact_jacobian *jacobian);

/* Are walls felt at all? */
static inline int ellipsoid_has_walls(const ellipsoid_model *model,
                                      const ellipsoid_surroundings *around)
{
    return model->options.contact && around->walls != NULL;
}

/* ---------------------------------------------------------- near walls */

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
    the drag to these. axis and axis_derivatives as in ellipsoid_body_flow().
*/
ellipsoid_status ellipsoid_wall_drag(
    const ellipsoid_model *model, const ellipsoid_surroundings *surroundings,
    ellipsoid_contact_cache *cache, ellipsoid_state *state, int balanced,
    double axis[3][3], double axis_derivatives[4][3][3],
    const ellipsoid_free_motion *free, double force[3], double torque[3],
    ellipsoid_blocks *blocks, int *acted);

/* Adds to u [m/s, lab] and omega [rad/s, body] what a force [N, lab] and a
   torque [N m, body] do against the resistance in this pose. */
ellipsoid_status ellipsoid_wall_yield(
    const ellipsoid_model *model, const ellipsoid_surroundings *surroundings,
    ellipsoid_contact_cache *cache, const double x[3], const double q[4],
    const double force[3], const double torque[3], double u[3],
    double omega[3]);

#endif
