/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    ellipsoidInternal.h - what the core's own files share.

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
    double uu[3][3], ux[3][3], uq[3][4];
    double wx[3][3], ww[3][3], wq[3][4];
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

/*
    The Rosenbrock coefficients as in Hairer & Wanner II, eq. (IV.7.25):
    (1/(gamma h) - J) K_i = f(y0 + sum a_ij K_j) + sum c_ij/h K_j,
    y1 = y0 + sum m_j K_j; the error estimate is K_6, and
    y(s) = y0 (1-s) + s (y1 + (1-s) (d_0 + s d_1)), d_i = sum_j dense_ij K_j.
*/
#define ELLIPSOID_ROSENBROCK_STAGES 6

typedef struct ellipsoid_rosenbrock_table
{
    double gamma;
    double a[ELLIPSOID_ROSENBROCK_STAGES][ELLIPSOID_ROSENBROCK_STAGES];
    double c[ELLIPSOID_ROSENBROCK_STAGES][ELLIPSOID_ROSENBROCK_STAGES];
    double dense[2][ELLIPSOID_ROSENBROCK_STAGES];
    int in_time[ELLIPSOID_ROSENBROCK_STAGES]; /* stages by their time */
} ellipsoid_rosenbrock_table;

extern const ellipsoid_rosenbrock_table ellipsoid_rosenbrock_set; /* rodas4p2.c */

/* Indices of the unknowns in a vector of thirteen. */
enum
{
    ELLIPSOID_U = 0,
    ELLIPSOID_X = 3,
    ELLIPSOID_OMEGA = 6,
    ELLIPSOID_Q = 9
};

/* One cell's surroundings, and what an advance does not change. */
typedef struct ellipsoid_problem
{
    const ellipsoid_model *model;
    const ellipsoid_surroundings *surroundings;
    ellipsoid_contact_cache *cache;
    ellipsoid_statistics *statistics;
    double length;        /* [m] largest semi-axis */
    double rate;          /* [1/s] 1/tau of u, 0 in vacuum */
    double rotation_rate; /* [1/s] 1/tau of omega, 0 in vacuum */
    const ellipsoid_noise *noise; /* NULL: none */
    int aligned; /* by a dipole */
    int inertial;
    int walls;
    int observed; /* is the whole of ellipsoid_step asked for? */
} ellipsoid_problem;

/* The equations at the start of a step, kept while steps are rejected. */
typedef struct ellipsoid_point
{
    ellipsoid_state state;
    ellipsoid_state derivative;
    ellipsoid_blocks blocks;
    ellipsoid_contact contact;
    int has_blocks;
} ellipsoid_point;

#define ELLIPSOID_MAX_STAGES 7

/* The stages of one step. */
typedef struct ellipsoid_stages
{
    double k[ELLIPSOID_MAX_STAGES][ELLIPSOID_STATE_SIZE];
    double y[ELLIPSOID_STATE_SIZE]; /* result */
    double error[ELLIPSOID_STATE_SIZE];
    int order;     /* of the error estimate in the step */
    int sampled;   /* poses where walls were felt, in the order of their time; */
    const int *in_time; /* only with walls */
    double x[ELLIPSOID_MAX_STAGES][3], q[ELLIPSOID_MAX_STAGES][4];
    double gap[ELLIPSOID_MAX_STAGES];
} ellipsoid_stages;

/* A stage's pose and the gap there [m], for the guard against tunnelling. */
static inline void ellipsoid_stages_sample(ellipsoid_stages *stages, int stage,
                                           const ellipsoid_state *state,
                                           double gap)
{
    memcpy(stages->x[stage], state->x, sizeof(state->x));
    memcpy(stages->q[stage], state->q, sizeof(state->q));
    stages->gap[stage] = gap;
}

/* ellipsoid_evaluate(), counted; balanced says whether u and omega are set
   first. blocks may be NULL. */
ellipsoid_status ellipsoid_problem_evaluate(const ellipsoid_problem *problem,
                                            ellipsoid_state *state,
                                            int balanced,
                                            ellipsoid_state *derivative,
                                            ellipsoid_contact *contact,
                                            ellipsoid_blocks *blocks);

/*
    (g M - J) k = r with g = 1/(gamma h), M = I but for inertialess motion.
    As dx/dt = u, k_x = (r_x + k_u)/g. As Q^2 = -|omega|^2 I,
        (g I - Q/2)^-1 = (g I + Q/2)/(g^2 + |omega|^2/4)
    gives k_q from k_omega. A dense 6x6 system in (k_u, k_omega) is left. The
    solution is wanted six times, hence explicit matrices instead of
    substitutions, in which each number waits for the one before.
*/
typedef struct ellipsoid_stage_system
{
    double per_g;
    double to_rates[ELLIPSOID_STATE_SIZE][6]; /* transposed: (k_u, k_omega)
                                                 from r */
    double q_from_q[4][4];    /* transposed: k_q from r_q */
    double q_from_w[3][4];    /* transposed: k_q from k_omega */
} ellipsoid_stage_system;

/* Returns 0 if the step is so long that the matrix is singular
   (stageSystem.c). */
int ellipsoid_stage_system_prepare(ellipsoid_stage_system *system,
                                   const ellipsoid_problem *problem,
                                   const ellipsoid_point *start, double h);

void ellipsoid_stage_system_solve(const ellipsoid_stage_system *system,
                                  const double r[ELLIPSOID_STATE_SIZE],
                                  double k[ELLIPSOID_STATE_SIZE]);

/*
    One Rosenbrock step of length h [s] from a point that has its blocks; y has
    a q not yet of length one. Returns STEP_UNDERFLOW or NON_FINITE where a
    shorter step may succeed.
*/
ellipsoid_status ellipsoid_rosenbrock_step(const ellipsoid_problem *problem,
                                           const ellipsoid_point *start,
                                           double h, ellipsoid_stages *stages);

/* The continuous extension of such a step. */
void ellipsoid_rosenbrock_dense(ellipsoid_stages *stages,
                                double dense[3][ELLIPSOID_STATE_SIZE]);

/*
    One explicit step of inertialess motion (rungeKutta.c). Its last stage is
    `next`, the end of the step. *touched is set, and the step not finished,
    where a stage touches a wall: the equations are stiff there.
*/
ellipsoid_status ellipsoid_explicit_step(const ellipsoid_problem *problem,
                                         const ellipsoid_point *start, double h,
                                         ellipsoid_stages *stages,
                                         ellipsoid_point *next, int *touched);

/* The continuous extension of such a step. */
void ellipsoid_explicit_dense(ellipsoid_stages *stages,
                              const ellipsoid_step *step,
                              double dense[3][ELLIPSOID_STATE_SIZE]);

/* At the start of a noise interval that lasts many relaxation times: takes the
   state to where they have passed, in no time (brownian.c). */
ellipsoid_status ellipsoid_cross_layer(const ellipsoid_problem *problem,
                                       double t, double until,
                                       ellipsoid_state *state);

/* -------------------------------------------------------- step control */

/* A step as planned. */
typedef struct ellipsoid_plan
{
    double h;
    int last;      /* ends at `end` */
    int shortened; /* less than proposed, to land on `end` */
} ellipsoid_plan;

/* The next step from t towards end (stepControl.c). */
ellipsoid_plan ellipsoid_plan_step(double proposal, double t, double end);

/* Sets *step to a first step from a point. */
ellipsoid_status ellipsoid_first_step(const ellipsoid_problem *problem,
                                      const ellipsoid_point *start,
                                      double *step);

/* Sets *error to what the step has made, above 1 if it is too much. NON_FINITE
   if it is not finite. */
ellipsoid_status ellipsoid_judge_step(const ellipsoid_problem *problem,
                                      double h,
                                      const ellipsoid_stages *stages,
                                      double *error);

/* The factor by which the next step differs from one that made that error. */
double ellipsoid_step_factor(int order, double error, double previous_error);

/* Is it a failure that a shorter step may cure? */
static inline int ellipsoid_may_recover(ellipsoid_status status)
{
    return status == ELLIPSOID_STEP_UNDERFLOW || status == ELLIPSOID_NON_FINITE;
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

/*
    The wall's force on one bead and its derivative by the centre (touch.c),
    set only where it is felt; returns the number of contacts. *gap [m] is how
    far beyond the bead to look and is lowered to the smallest gap found (minus
    the depth of an overlap). Surfaces touched are noted in *report. force_x
    and report may be NULL.
*/
int ellipsoid_bead_touch(const ellipsoid_bead *bead,
                         const ellipsoid_candidates *from, double *gap,
                         double force[3], double force_x[3][3],
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

/* Are walls felt at all? */
static inline int ellipsoid_has_walls(const ellipsoid_model *model,
                                      const ellipsoid_surroundings *around)
{
    return model->options.contact && around->walls != NULL;
}

#endif
