/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    motion.h - what the integrator's files share.

    Everything advances a group of cells in common steps; mostly it is a group
    of one. Not for users; tests may include it.
*/
#ifndef ELLIPSOID_MOTION_H
#define ELLIPSOID_MOTION_H

#include "contact/contact.h"
#include "drag/drag.h"

_Static_assert(sizeof(ellipsoid_state) == ELLIPSOID_STATE_SIZE * sizeof(double),
               "the state is thirteen doubles without padding");

/* Where the unknowns are in a vector of thirteen. */
enum
{
    UNKNOWNS = ELLIPSOID_STATE_SIZE,
    AT_U = 0,
    AT_X = 3,
    AT_OMEGA = 6,
    AT_Q = 9
};

/* Is the n-th unknown one of u and omega? */
static inline int ellipsoid_is_rate(int n)
{
    return n < AT_X || (n >= AT_OMEGA && n < AT_Q);
}

/*
    The Rosenbrock coefficients as in Hairer & Wanner II, eq. (IV.7.25):
    (1/(gamma h) - J) K_i = f(t0 + alpha_i h, y0 + sum a_ij K_j)
                            + sum c_ij/h K_j + gamma_i h df/dt(t0, y0),
    y1 = y0 + sum m_j K_j; the error estimate is the last K, and
    y(s) = y0 (1-s) + s (y1 + (1-s) (d_0 + s d_1)), d_i = sum_j dense_ij K_j.
*/
#define ELLIPSOID_STAGES 6 /* of a step of any method */

typedef struct ellipsoid_rosenbrock_table
{
    double gamma;
    double a[ELLIPSOID_STAGES][ELLIPSOID_STAGES];
    double c[ELLIPSOID_STAGES][ELLIPSOID_STAGES];
    double alpha[ELLIPSOID_STAGES];
    double gamma_sum[ELLIPSOID_STAGES]; /* gamma_i */
    double dense[2][ELLIPSOID_STAGES];
    int in_time[ELLIPSOID_STAGES]; /* stages by their time */
} ellipsoid_rosenbrock_table;

extern const ellipsoid_rosenbrock_table
    ellipsoid_rosenbrock_set; /* rodas4p2.c */

/* -------------------------------------------------------- the equations */

/* Adds to the wrench, and to the blocks if wanted, what is not drag, contact,
   constant or DUDT; of that the blocks alone (bodyForces.c). flow may be
   NULL. */
ellipsoid_status ellipsoid_add_body_forces(
    const ellipsoid_model *model, const ellipsoid_surroundings *surroundings,
    const ellipsoid_state *state, ellipsoid_frame *frame,
    ellipsoid_flow_sample *flow, ellipsoid_body_wrench *wrench,
    ellipsoid_jacobian_blocks *blocks);

/* --------------------------------------------------------------- a cell */

/* One cell's surroundings, and what an advance does not change. */
typedef struct ellipsoid_cell
{
    const ellipsoid_model *model;
    ellipsoid_surroundings surroundings; /* at the time of an evaluation */
    ellipsoid_facet_cache *cache;
    ellipsoid_statistics *statistics;
    double length;                /* [m] largest semi-axis */
    double rate;                  /* [1/s] 1/tau of u, 0 in vacuum */
    double rotation_rate;         /* [1/s] 1/tau of omega, 0 in vacuum */
    const ellipsoid_noise *noise; /* NULL: none */
    /* about which the drag near walls is expanded; NULL: it is not */
    const ellipsoid_wall_expansion *about;
    int inertial;
    int fixed;
    int walls;
} ellipsoid_cell;

/* That of a member, with the noise that is its own (equations.c). */
ellipsoid_cell ellipsoid_cell_of(const ellipsoid_member *member,
                                 const ellipsoid_noise *noise);

/* The equations in one state; those of a start stay while steps are rejected. Who
   makes one sets its contact to ellipsoid_no_contact(). */
typedef struct ellipsoid_evaluation
{
    union
    {
        ellipsoid_state state;
        double y[UNKNOWNS];
    };
    union
    {
        ellipsoid_state derivative;
        double slope[UNKNOWNS];
    };
    ellipsoid_jacobian_blocks blocks;
    ellipsoid_contact contact;      /* left as it is where there are no walls */
    ellipsoid_wall_expansion walls; /* likewise; not of a stage */
} ellipsoid_evaluation;

/*
    The equations of one cell in the state of `at`, without contact with other
    cells (equations.c). balanced: u and omega are first set to those that
    balance the forces; their derivatives are then zero. STEP_UNDERFLOW: a
    callback asks for a shorter step.
*/
ellipsoid_status ellipsoid_evaluate(const ellipsoid_cell *cell,
                                    ellipsoid_evaluation *at, int balanced,
                                    int with_blocks);

/* The stages of one step. */
typedef struct ellipsoid_stages
{
    /* two more, for forceBalance.c: a change, and the best velocities so far */
    double k[ELLIPSOID_STAGES + 2][UNKNOWNS];
    double time_derivative[UNKNOWNS]; /* df/dt at the start, if unsteady */
    double y[UNKNOWNS];               /* result */
    double error[UNKNOWNS];
    /* Where contact was evaluated, by time: poses, gap [m] that a bead may cross */
    int sampled;
    const int *in_time;
    ellipsoid_state pose[ELLIPSOID_STAGES];
    double gap[ELLIPSOID_STAGES];
} ellipsoid_stages;

/* What solves the linear system of a stage (stageMatrix.c). */
typedef struct ellipsoid_stage_matrix
{
    double per_g;
    double to_rates[UNKNOWNS][6]; /* transposed: (k_u, k_omega) from r; of a
                                     cell of a group: their part in its row */
    double q_from_q[4][4];        /* transposed: k_q from r_q */
    double q_from_w[3][4];        /* transposed: k_q from k_omega */
} ellipsoid_stage_matrix;

/* Rows (u, omega) of one cell by the unknowns of one, its own or another's,
   once x and q are eliminated: -J is left in `rates`, and what multiplies r_x
   and r_q; both transposed. */
typedef struct ellipsoid_reduced
{
    double x[3][6], q[4][6];
    double rates[6][6];
} ellipsoid_reduced;

/* per_g is gamma h. Returns 0 if the step is so long that the matrix is
   singular. */
int ellipsoid_stage_matrix_prepare(ellipsoid_stage_matrix *system,
                                   const ellipsoid_evaluation *start,
                                   int inertial, double per_g);

/* k is r before. */
void ellipsoid_stage_matrix_solve(const ellipsoid_stage_matrix *system,
                                  double k[restrict UNKNOWNS]);

/* The same by parts, for a group: rows against the unknowns of `column`; what
   the cell needs for k_x and k_q; k from r, in place, and (k_u, k_omega). */
void ellipsoid_stage_matrix_reduce(const ellipsoid_jacobian_blocks *blocks,
                                   const ellipsoid_state *column, double per_g,
                                   ellipsoid_reduced *reduced);
void ellipsoid_stage_matrix_kinematics(ellipsoid_stage_matrix *system,
                                       const ellipsoid_state *state,
                                       double per_g);
void ellipsoid_stage_matrix_finish(const ellipsoid_stage_matrix *system,
                                   const double rates[6],
                                   double k[restrict UNKNOWNS]);

/* A step as planned. */
typedef struct ellipsoid_plan
{
    double h, start, end; /* [s] */
    int last;             /* ends where the run does */
    int shortened;        /* to end there, or where a bead lands, */
    double kept;          /* [s] which leaves so much for the next at least */
} ellipsoid_plan;

/* -------------------------------------------------------------- a group */

/* How the rows of one cell depend on the pose of another that it touches. */
typedef struct ellipsoid_coupling
{
    int row, column;
    ellipsoid_jacobian_blocks blocks;
    ellipsoid_reduced reduced;
} ellipsoid_coupling;

/* A model that differs, for a time, from that of a cell (forceBalance.c). */
typedef struct ellipsoid_smoothed_model
{
    const ellipsoid_model *own;
    ellipsoid_model model;
} ellipsoid_smoothed_model;

/* What a group of several needs; arrays in the caller's memory. */
typedef struct ellipsoid_pairs
{
    int capacity, count; /* of couplings, at the start of a step */
    ellipsoid_coupling *coupling;
    int near_capacity, near_count;
    ellipsoid_near_pair *near;
    int is_listed;
    ellipsoid_state *listed_at;         /* where the near pairs were listed */
    ellipsoid_body *body;               /* in the poses of an evaluation */
    ellipsoid_smoothed_model *smoothed; /* for each cell */
    int *block;             /* [count][count]: number of a 6x6 block, or -1 */
    double (*blocks)[6][6]; /* of the factorised matrix */
    double (*rates)[6];     /* right-hand sides, solutions */
} ellipsoid_pairs;

/* A group of cells at the start of a step and on the way to its end. */
typedef struct ellipsoid_group
{
    int count;
    int inertial;    /* all or none */
    int stiff;       /* is one a dipole in a field or under a given force? */
    int unsteady;    /* do the surroundings of one depend on time? */
    int dissipative; /* do forces other than drag depend on velocities? */
    int observed;    /* is the whole of ellipsoid_step asked for? */
    ellipsoid_cell *cell;
    ellipsoid_evaluation *start, *next; /* next serves the stages, too */
    ellipsoid_stages *stages;
    ellipsoid_stage_matrix *system;
    ellipsoid_step *step;
    ellipsoid_noise *noise;
    ellipsoid_pairs *pairs; /* NULL: alone */
    int has_blocks, next_has_blocks;
    int failed; /* the cell that failed or stopped last, or -1 */
} ellipsoid_group;

/* Lays a group of several out in memory, which may be NULL; returns the bytes
   it takes (group.c). */
size_t ellipsoid_group_lay_out(int count, void *memory, ellipsoid_group *group,
                               ellipsoid_pairs *pairs);

/* No velocities, or no change of them. */
static inline void ellipsoid_set_no_rates(ellipsoid_state *state)
{
    ellipsoid_set(state->u, 0, 0, 0);
    ellipsoid_set(state->omega, 0, 0, 0);
}

/* Do external forces depend on the velocities? */
static inline int
ellipsoid_force_is_dissipative(const ellipsoid_surroundings *surroundings)
{
    return surroundings->force && surroundings->force_depends_on_velocity;
}

/* Can it touch anything? */
static inline int ellipsoid_has_contact(const ellipsoid_group *g, int cell)
{
    return g->pairs != NULL || g->cell[cell].walls;
}

/* Of a change or derivative of the unknowns: that of the pose, the larger of x in
   semi-axes and q; and the most that it adds to the speed of the surface. */
static inline double ellipsoid_displacement(const ellipsoid_cell *p,
                                            const double change[])
{
    return fmax(ellipsoid_length(change + AT_X) / p->length,
                sqrt(ellipsoid_square4(change + AT_Q)));
}

static inline double ellipsoid_surface_speed(const ellipsoid_cell *p,
                                             const double change[])
{
    return ellipsoid_length(change + AT_U)
         + p->length * ellipsoid_length(change + AT_OMEGA);
}

/* How far a point of the body goes at most from one pose to another [m]: a change
   of q by d turns the body by 2 d. */
static inline double ellipsoid_travel(const ellipsoid_model *model,
                                      const ellipsoid_state *from,
                                      const ellipsoid_state *to)
{
    double moved[3], turned[4];

    ellipsoid_difference(to->x, from->x, moved);
    for (int n = 0; n < 4; n++)
    {
        turned[n] = to->q[n] - from->q[n];
    }
    return ellipsoid_length(moved)
         + 2 * model->reach * sqrt(ellipsoid_square4(turned));
}

/* A stage's pose and the gap there [m], for the guard against tunnelling: two
   cells may both move, each by half the gap between them. */
static inline void ellipsoid_stages_sample(ellipsoid_stages *stages, int stage,
                                           const ellipsoid_evaluation *at)
{
    const ellipsoid_contact *c = &at->contact;

    ellipsoid_copy(at->state.x, stages->pose[stage].x);
    memcpy(stages->pose[stage].q, at->state.q, sizeof(at->state.q));
    stages->gap[stage] = ellipsoid_lesser(
        ellipsoid_greater(c->gap, 0), 0.5 * ellipsoid_greater(c->cell_gap, 0));
}

/* For one cell with drag, its velocities set to those that balance; all stays if
   there are none. */
ellipsoid_status
ellipsoid_force_balance(const ellipsoid_model *model,
                        const ellipsoid_surroundings *surroundings,
                        ellipsoid_state *state, ellipsoid_facet_cache *cache,
                        ellipsoid_state *derivative);

/* Are all cells with inertia, which have mass and a gyroscopic torque, for a time
   (groupRhs.c)? */
void ellipsoid_group_set_inertial(ellipsoid_group *group, int inertial);

/* Expands the drag near walls about these points, or no longer: NULL
   (groupRhs.c). */
void ellipsoid_expand_about(ellipsoid_group *group,
                            const ellipsoid_evaluation *points);

/* The equations of several cells in the states of all points, at the time that is
   set; balanced: with u and omega, for contacts that do not depend on them;
   with_blocks: and the Jacobian (groupRhs.c). For those that do (forceBalance.c). */
ellipsoid_status ellipsoid_pairs_evaluate(ellipsoid_group *group,
                                          ellipsoid_evaluation *points,
                                          int balanced, int with_blocks);
ellipsoid_status ellipsoid_group_balance(ellipsoid_group *group,
                                         ellipsoid_evaluation *points,
                                         int with_blocks);

static inline ellipsoid_status
ellipsoid_group_evaluate_once(ellipsoid_group *g, ellipsoid_evaluation *points,
                              int balanced, int with_blocks)
{
    if (g->pairs)
    {
        return ellipsoid_pairs_evaluate(g, points, balanced, with_blocks);
    }
    g->failed = 0;
    return ellipsoid_evaluate(g->cell, points, balanced, with_blocks);
}

/* What fits, at the time t. */
static inline ellipsoid_status
ellipsoid_group_evaluate(ellipsoid_group *g, double t,
                         ellipsoid_evaluation *points, int balanced,
                         int with_blocks)
{
    for (int cell = 0; cell < g->count; cell++)
    {
        g->cell[cell].surroundings.time = t;
    }
    return balanced && g->dissipative
             ? ellipsoid_group_balance(g, points, with_blocks)
             : ellipsoid_group_evaluate_once(g, points, balanced, with_blocks);
}

/* Where an advance begins no step is short enough for an answer (advance.c). */
ellipsoid_status ellipsoid_status_at_start(ellipsoid_status status);

/* A cell of the group where the points are, placed at most once. */
const ellipsoid_body *ellipsoid_placed_body(ellipsoid_group *group,
                                            const ellipsoid_evaluation *points,
                                            int cell);

/* Where a cell at x is nearest to another: x, or the image that is set. */
const double *ellipsoid_nearest_image(const ellipsoid_surroundings *around,
                                      const double to[3], const double x[3],
                                      double image[3]);

/* Sees to it that all pairs that may touch in these states are listed.
   TOO_MANY_CELLS: there is no memory for so many. */
ellipsoid_status
ellipsoid_near_pairs_collect(ellipsoid_group *group,
                             const ellipsoid_evaluation *points);

/* Adds the forces between cells to points evaluated without (groupContacts.c). */
ellipsoid_status ellipsoid_add_group_contacts(ellipsoid_group *group,
                                              ellipsoid_evaluation *points,
                                              int balanced, int with_blocks);

/* The linear system of a step from points that have their blocks, that of each cell
   coupled by contacts. It is solved for a stage k_i in place. 0 if it is singular
   (groupMatrix.c). */
int ellipsoid_group_prepare(ellipsoid_group *group,
                            const ellipsoid_evaluation *points, double per_g);
void ellipsoid_pairs_solve(const ellipsoid_group *group, int stage);

static inline void ellipsoid_group_solve(const ellipsoid_group *g, int stage)
{
    g->pairs ? ellipsoid_pairs_solve(g, stage)
             : ellipsoid_stage_matrix_solve(g->system, g->stages->k[stage]);
}

/* sum_j<count weight[j] k_j, component n: a loop over n that keeps the sums in
   registers where count is a constant. */
INLINED double ellipsoid_weighted_sum(double k[][UNKNOWNS],
                                      const double *weight, int count, int n)
{
    double sum = weight[0] * k[0][n];

    for (int j = 1; j < count; j++)
    {
        sum += weight[j] * k[j][n];
    }
    return sum;
}

/* result = base + factor sum_j<stage weight[j] k_j (rosenbrock.c). */
void ellipsoid_combine(const double base[UNKNOWNS], double factor,
                       const double *weight, int stage, double k[][UNKNOWNS],
                       double result[restrict UNKNOWNS]);

/* The time of a stage, exactly the end of the step where it is that. */
static inline double ellipsoid_stage_time(const ellipsoid_plan *plan,
                                          double part)
{
    return part < 1 ? plan->start + part * plan->h : plan->end;
}

/* One Rosenbrock step from a start that has its blocks; y has a q not yet of
   length one. Returns STEP_UNDERFLOW or NON_FINITE where a shorter step may
   succeed. */
ellipsoid_status ellipsoid_rosenbrock_step(ellipsoid_group *group,
                                           const ellipsoid_plan *plan);

/* One explicit step of inertialess motion (rungeKutta.c). Its last stage is
   `next`, the end of the step. *touched is set, and the step not finished, where
   a stage touches something: the equations are stiff there. */
ellipsoid_status ellipsoid_explicit_step(ellipsoid_group *g,
                                         const ellipsoid_plan *plan,
                                         int *touched);

/* The continuous extensions of such steps of a cell. */
void ellipsoid_rosenbrock_dense(const ellipsoid_group *group, int cell,
                                double dense[2][UNKNOWNS]);
void ellipsoid_explicit_dense(const ellipsoid_group *group, int cell,
                              double dense[2][UNKNOWNS]);

/* At the start of a noise interval that lasts many relaxation times: takes the
   start to where they have passed, in no time; or, if all cells are slow and touch
   with friction, `next` to its end, else STEP_UNDERFLOW (noiseLayer.c). */
ellipsoid_status ellipsoid_noise_layer(ellipsoid_group *group, double t,
                                       double until);
ellipsoid_status ellipsoid_rest(ellipsoid_group *group,
                                const ellipsoid_plan *interval);

/* -------------------------------------------------------- step control */

/* The next step from t towards end, at most until the next bead lands on a wall:
   after this time, or `time` if that is less. */
ellipsoid_plan ellipsoid_plan_step(double proposal, double landing, double t,
                                   double end);
double ellipsoid_time_to_landing(const ellipsoid_group *group, double time);

/* Sets *step to a first step from the start at t towards end. */
ellipsoid_status ellipsoid_first_step(ellipsoid_group *group, double t,
                                      double end, double *step);

/* Sets *error to what the step has made, above 1 if it is too much. NON_FINITE
   if it is not finite. */
ellipsoid_status ellipsoid_judge_step(const ellipsoid_group *group, double h,
                                      double *error);

/* Raises *error to what the drag near walls, expanded about the start in the
   stages, has made wrong, now that the end is known. */
ellipsoid_status ellipsoid_judge_expansions(const ellipsoid_group *group,
                                            double h, double *error);

/* The factor by which the next step differs from one that made that error. */
double ellipsoid_step_factor(const ellipsoid_group *group, double error,
                             double previous_error);

/* Is it a failure that a shorter step may cure? */
static inline int ellipsoid_may_recover(ellipsoid_status s)
{
    return s == ELLIPSOID_STEP_UNDERFLOW || s == ELLIPSOID_NON_FINITE;
}

/* Where the members are, unit quaternions, becomes the group's start. BAD_STATE:
   not all is finite (advance.c). */
ellipsoid_status ellipsoid_group_start(ellipsoid_group *group,
                                       const ellipsoid_member members[]);

/* Takes a group from its start at *t to `end` [s]; the observer may stop it
   (advance.c). Controllers and observers are the members'; *attempts counts on. */
ellipsoid_status ellipsoid_group_advance(ellipsoid_group *group,
                                         const ellipsoid_member members[],
                                         double *t, double end,
                                         ellipsoid_observer observer,
                                         long *attempts);

#endif
