/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    ellipsoid.h - the public header of the core. It includes ellipsoidModel.h
    (statuses, options and model), ellipsoidWalls.h (walls) and
    ellipsoidWorld.h (a world of cells). How to build a program with it:
    docs/fromC.md.

    The core moves a rigid ellipsoid that is carried by a given flow and touches
    given walls. It solves thirteen stiff equations (velocity, position, angular
    velocity, quaternion) by an adaptive Rosenbrock method of fourth order.
    Without inertia only the seven equations of position and quaternion are
    left. They are solved by an explicit Runge-Kutta method of fourth order.
    Where the body touches, steps are Rosenbrock steps, too.

    SI units throughout. Frames:
      lab    x  = (x1, x2, x3)
      body   x^ = the principal axes of the ellipsoid, R(q) turns body to lab:
             v = R v^,  R = (eta^2 - eps.eps) I + 2 eps eps^T + 2 eta [eps]x
             with the unit quaternion q = (eps1, eps2, eps3, eta), scalar last.

    The core keeps no state of its own: it does not allocate, print, exit or
    hold mutable static data, so any number of threads may call it. Every
    function that can fail returns an ellipsoid_status. On failure the state
    that it was given is unchanged; after ellipsoid_advance() it is that of the
    last accepted step.

    Sources: Kim et al., Lab Chip 11, 1089 (2011), supplement ("paper");
    Oberbeck (1876), Jeffery (1922), Brenner (1964); Hairer & Wanner,
    Solving ODEs II (1996). Equations are listed in docs/theory.
*/
#ifndef ELLIPSOID_H
#define ELLIPSOID_H

#include "ellipsoidModel.h"
#include "ellipsoidWalls.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------- flow */

/*
    The undisturbed flow at a point and time, in the lab frame. The gradient is
    G_ij = du_i/dx_j. Everything that a callback may set is zero when it is
    called. velocity_jacobian is the derivative of `velocity` as it is
    interpolated, and gradient_jacobian[i][j][k] = dG_ij/dx_k. All jacobians are
    read only if derivatives are requested, and are used only in the Jacobian
    of implicit steps.
*/
typedef struct ellipsoid_flow_sample
{
    double velocity[3];                 /* [m/s] */
    double gradient[3][3];              /* [1/s] */
    double pressure_gradient[3];        /* [Pa/m] read for PRESSURE_GRADP */
    double local_acceleration[3];       /* [m/s2] du/dt at fixed x; read for
                                          PRESSURE_DUDT if the surroundings
                                          are unsteady */
    double velocity_jacobian[3][3];     /* [1/s] */
    double gradient_jacobian[3][3][3];  /* [1/(m s)] */
    double pressure_jacobian[3][3];     /* [Pa/m2] d(grad p)_i/dx_j; read for
                                          PRESSURE_GRADP */
    double acceleration_jacobian[3][3]; /* [1/s2] of local_acceleration; read
                                          where that is read */
} ellipsoid_flow_sample;

/*
    Samples the flow at the time t [s] and position x [m, lab]. derivatives: 1
    if the jacobians are requested, else 0. Returns 0 on success; > 0 if there
    is no flow here, which shortens the step; < 0 to give up.
*/
typedef int (*ellipsoid_flow_function)(void *context, double t,
                                       const double x[3], int derivatives,
                                       ellipsoid_flow_sample *sample);

/*
    For FLOW_BODY: velocities of the flow at the time t [s] at points near
    `centre` [m, lab], and their derivatives jacobian[n][i][j] = du_i/dx_j
    unless jacobian is NULL. Both are zero when called. Beyond a wall the flow
    has the velocity of the wall, so that both stay zero. The centre is where
    the flow was sampled last. Returns 0; > 0: shorten the step; < 0: give up.
*/
typedef int (*ellipsoid_velocities_function)(void *context, double t,
                                             const double centre[3], int count,
                                             double (*points)[3],
                                             double (*velocity)[3],
                                             double (*jacobian)[3][3]);

/*
    An electric field E [V/m, lab] at the time t [s] and position x [m, lab],
    and its derivatives jacobian[i][j] = dE_i/dx_j unless jacobian is NULL. Both
    are zero when called. Returns as above.
*/
typedef int (*ellipsoid_field_function)(void *context, double t,
                                        const double x[3], double field[3],
                                        double (*jacobian)[3]);

/* -------------------------------------------------------- other forces */

struct ellipsoid_state;

/* Derivatives of a force (lab) and a torque (body) by the state. R(q) is the
   polynomial above, also where q is not of length one. All zero when called. */
typedef struct ellipsoid_wrench_jacobian
{
    double force_x[3][3];      /* [N/m] */
    double force_q[3][4];      /* [N] */
    double torque_x[3][3];     /* [N] */
    double torque_q[3][4];     /* [N m] */
    double force_u[3][3];      /* [N s/m] */
    double force_omega[3][3];  /* [N s] */
    double torque_u[3][3];     /* [N s] */
    double torque_omega[3][3]; /* [N m s] */
} ellipsoid_wrench_jacobian;

/*
    An external force [N, lab] and torque [N m, body] on a cell in this state at
    the time t [s], in addition to those of the options. All are zero when
    called. The jacobian is NULL unless derivatives are requested. Inside a step
    the length of q may differ from one. u and omega may be read only with
    force_depends_on_velocity. Returns 0; > 0: shorten the step; < 0: give up.
*/
typedef int (*ellipsoid_force_function)(void *context, double t,
                                        const struct ellipsoid_state *state,
                                        double force[3], double torque[3],
                                        ellipsoid_wrench_jacobian *jacobian);

/*
    What surrounds a cell. Each pointer may be NULL; else the default is 0.
    Without a flow there is vacuum: drag and pressure gradient are zero. Without
    `velocities`, FLOW_BODY calls `flow` for each point, and a result > 0 means
    that the point is beyond a wall.
*/
typedef struct ellipsoid_surroundings
{
    ellipsoid_flow_function flow;
    void *flow_context; /* also passed to velocities */
    ellipsoid_walls_function walls;
    void *walls_context;
    ellipsoid_velocities_function velocities;
    ellipsoid_field_function field;
    void *field_context;
    ellipsoid_force_function force;
    void *force_context;
    int force_depends_on_velocity; /* 1: the force depends on u or omega */
    int unsteady; /* 1: flow, field or force depend on time; 0: the derivative
                     by time that a Rosenbrock step needs is not evaluated */
    const double (*repeat)[3]; /* [m] lab: translations that leave flow and
                                  walls unchanged, as of periodic patches; the
                                  cells of a group touch the nearest images */
    int repeat_count;          /* how many */
    int fixed;   /* 1: the body stays at rest in its pose whatever acts on it;
                    other cells of its group touch it */
    double time; /* [s] at which functions without a time argument, such as
                    ellipsoid_rhs(), call the callbacks */
    /* The key of the cell's random numbers for Brownian motion. Noise interval
       n begins at the time n noise_interval. */
    uint64_t seed;
    uint32_t id;
} ellipsoid_surroundings;

/* --------------------------------------------------------------- state */

#define ELLIPSOID_STATE_SIZE 13

/* The thirteen unknowns, in this order wherever they form a vector. In
   INERTIALESS motion u and omega are results, not unknowns, and their initial
   values are not read. */
typedef struct ellipsoid_state
{
    double u[3];     /* [m/s] velocity, lab */
    double x[3];     /* [m] centre, lab */
    double omega[3]; /* [rad/s] angular velocity, body */
    double q[4];     /* quaternion (eps1, eps2, eps3, eta), body to lab */
} ellipsoid_state;

/* R(q), row-major: lab = R body. q need not have exactly length one. */
void ellipsoid_rotation(const double q[4], double rotation[3][3]);

/* The paper's Euler angles (phi, theta, psi) [rad], z-x-z, and back. */
void ellipsoid_euler_from_quaternion(const double q[4], double euler[3]);
void ellipsoid_quaternion_from_euler(const double euler[3], double q[4]);

/* Quaternion that turns the body axis x^2 to the unit vector `axis` (lab),
   after a rotation of the body by `spin` [rad] about x^2. */
void ellipsoid_quaternion_from_axis(const double axis[3], double spin,
                                    double q[4]);

/* A random orientation, uniformly distributed, from three numbers uniform in
   [0, 1) (Shoemake 1992). */
void ellipsoid_quaternion_from_uniform(const double uniform[3], double q[4]);

/* ------------------------------------------------------------- contact */

#define ELLIPSOID_MAX_SURFACES 8

/*
    Lists of the facets that each bead, or the ellipsoid, may touch, and of
    those that may add to the resistance. They are kept while the cell moves
    little. One cache per cell, in memory of the caller. Its content changes the
    cost of a result, but never the result.
*/
typedef struct ellipsoid_facet_cache ellipsoid_facet_cache;

/* Bytes of the cache of a cell of this model: some 20 kB, and 16 kB more where
   walls add to the resistance. The memory is to be aligned as by malloc(). */
size_t ellipsoid_facet_cache_size(const ellipsoid_model *model);

/*
    Empties a cache. It must be called before the cache is used for the first
    time, and again when the cell's model, the walls callback, its context or a
    facet has changed. It need not be called when the cell is put elsewhere.
*/
void ellipsoid_facet_cache_clear(ellipsoid_facet_cache *cache);

/* The action of the walls, and of the other cells of its group, on a cell. */
typedef struct ellipsoid_contact
{
    double force[3];   /* [N] lab, of the walls */
    double torque[3];  /* [N m] body, of the walls */
    double deepest;    /* [m] deepest overlap of a bead, 0 if none */
    double gap;        /* [m] smallest gap between a bead and the walls,
                               -deepest where they overlap; at most the bead
                               radius, the limit of the search; HUGE_VAL
                               without walls. For contact_shape ELLIPSOID the
                               gap of the ellipsoid instead of a bead */
    double slip;       /* [m/s] speed with which the slowest contact slides,
                               at least slip_speed; HUGE_VAL without friction */
    int bead_contacts; /* number of beads that overlap the walls or are
                               attracted by them; 1 if the ellipsoid is */
    int surface_count; /* distinct surfaces in contact, of which at most
                               MAX_SURFACES are listed */
    int surface[ELLIPSOID_MAX_SURFACES]; /* their labels, in the order of the
                                            beads in contact */

    double cell_force[3];  /* [N] lab, of the other cells */
    double cell_torque[3]; /* [N m] body */
    double cell_deepest;   /* [m] deepest overlap with another cell */
    double cell_gap;       /* [m] smallest gap to a bead of another cell; as
                               for walls */
    double cell_slip;      /* [m/s] as for walls */
    int cell_count;        /* cells in contact, of which at most MAX_SURFACES
                               are listed */
    uint32_t cell_id[ELLIPSOID_MAX_SURFACES]; /* in the order of the group */
} ellipsoid_contact;

/*
    Contact of the beads with facets by Hertz' law, F = 4/3 E* sqrt(r_b)
    d^(3/2) with the overlap d, along the normal of each contact. The contacts
    of one bead add up to the force sum w_i f_i n_i, w_i = f_i / sum_j f_j
    max(0, n_i.n_j) (contactBlending.h: where they are nearly parallel).
    Adhesion adds up in the same way. For contact_shape ELLIPSOID the law is the
    same, d is the overlap of the ellipsoid itself, and the force acts where it
    is deepest (ellipsoidFacets.c); q only turns the ellipsoid, whatever its
    length. Friction and damping are added (friction.c); without them u and
    omega are not read. jacobian may be NULL. The result depends on the state
    alone, to the last bit, not on the content of the cache. STEP_UNDERFLOW: the
    walls request a shorter step.
*/
ellipsoid_status ellipsoid_contact_evaluate(
    const ellipsoid_model *model, const ellipsoid_surroundings *surroundings,
    const ellipsoid_state *state, ellipsoid_facet_cache *cache,
    ellipsoid_contact *contact, ellipsoid_wrench_jacobian *jacobian);

/*
    Contact of one bead with the listed facets, for tests and tools: centre [m,
    lab], radius [m], stiffness = 4/3 E* sqrt(r_b) [N/m^1.5]. Sets the force [N,
    lab] and its derivative by the centre (may be NULL). Returns the number of
    contacts.
*/
int ellipsoid_bead_force(const double centre[3], double radius,
                         double stiffness, const ellipsoid_facet_list *facets,
                         double force[3], double force_x[3][3]);

/*
    Writes the bead centres of the options' layout into bead[][3] [m, body].
    Returns their number (PAPER drops duplicates), or 0 if the options are not
    allowed. The option bead_count is 2 + 3 n (two poles and n rings of three),
    32 for PAPER, or 1: a single bead at the centre.
*/
int ellipsoid_beads(const ellipsoid_options *options,
                    double bead[ELLIPSOID_MAX_BEADS][3]);

/*
    The body axis along which the ellipsoid and its beads, of any layout, are
    their own mirror image: a shortest one.
*/
int ellipsoid_mirror_axis(const double semi_axes[3]);

/*
    Sets *overlaps to 1 if the ellipsoid itself, not its beads, cuts a wall
    facet, else to 0. The test is exact for an ellipsoid that is smaller by a
    part in 1e10, so that one that only touches does not overlap. The cell's
    centre is assumed to be on the side of the fluid.
*/
ellipsoid_status
ellipsoid_overlaps_walls(const ellipsoid_model *model,
                         const ellipsoid_surroundings *surroundings,
                         const double x[3], const double q[4], int *overlaps);

/* -------------------------------------------------------------- random */

/*
    `count` numbers uniform in [0, 1). They depend only on the key (seed, id,
    stream, index): they are the same for any order of calls, any number of
    threads or ranks, and after a restart. Independent uses for one cell have
    different streams; those from 2^31 on are reserved for the core.
*/
void ellipsoid_random_uniform(uint64_t seed, uint32_t id, uint32_t stream,
                              uint32_t index, int count, double *uniform);

/* `count` numbers of the standard normal distribution, in the same way. */
void ellipsoid_random_normals(uint64_t seed, uint32_t id, uint32_t stream,
                              uint32_t index, int count, double *normal);

/* Six of them: those of the random force and torque in a noise interval. */
void ellipsoid_random_normal(uint64_t seed, uint32_t id, int64_t interval,
                             double normal[6]);

/* ----------------------------------------------------------- equations */

/*
    The thirteen time derivatives at a state, paper eqs. (1)-(4), without the
    random force. In INERTIALESS motion the derivatives of x and q follow from
    the u and omega that balance the forces, and those of u and omega are zero.
    STEP_UNDERFLOW: a callback has no answer at this state, and requests a
    shorter step. cache may be NULL where there are no walls.
*/
ellipsoid_status ellipsoid_rhs(const ellipsoid_model *model,
                               const ellipsoid_surroundings *surroundings,
                               const ellipsoid_state *state,
                               ellipsoid_facet_cache *cache,
                               ellipsoid_state *derivative);

/*
    Sets u and omega to the values at which the drag balances all other forces:
    those of INERTIALESS motion, or the terminal velocities of a body at this
    point. BAD_OPTION without drag or flow; the state is then unchanged.
*/
ellipsoid_status ellipsoid_balance(const ellipsoid_model *model,
                                   const ellipsoid_surroundings *surroundings,
                                   ellipsoid_state *state,
                                   ellipsoid_facet_cache *cache);

/* The drag [N, lab] on a body of orientation q held still where the flow has
   this velocity [m/s, lab]: mu R K^ R^T u_f, far from walls. */
void ellipsoid_drag_at_rest(const ellipsoid_model *model, const double q[4],
                            const double velocity[3], double drag[3]);

/*
    Derivatives by the thirteen unknowns, row-major. In INERTIAL motion they are
    those of ellipsoid_rhs(), paper eqs. (1)-(4). In INERTIALESS motion they are
    those of the index-1 differential-algebraic system that its Rosenbrock steps
    solve: the same, without the gyroscopic torque, at the given u and omega.
*/
ellipsoid_status
ellipsoid_jacobian(const ellipsoid_model *model,
                   const ellipsoid_surroundings *surroundings,
                   const ellipsoid_state *state, ellipsoid_facet_cache *cache,
                   double jacobian[ELLIPSOID_STATE_SIZE][ELLIPSOID_STATE_SIZE]);

/* ------------------------------------------------------------- advance */

/* What step control keeps between calls: part of a cell's state. */
typedef struct ellipsoid_controller
{
    double step;           /* [s] proposed next step; 0: it is chosen */
    double previous_error; /* [-] of the last accepted step; 0: none */
} ellipsoid_controller;

/* Running totals; never reset by the core. */
typedef struct ellipsoid_statistics
{
    long accepted, rejected; /* steps */
    long rhs, jacobians;     /* evaluations */
    double deepest;          /* [m] deepest overlap at the end of a step */
} ellipsoid_statistics;

/*
    An accepted step, for dense output: see ellipsoid_step_state(). It begins in
    the state in which the previous step ended. The exception is INERTIAL
    Brownian motion in long noise intervals: there u and omega jump between the
    steps, and x and q by their motion in a relaxation time
    (docs/theory/forces.md, "Brownian force and torque").
*/
typedef struct ellipsoid_step
{
    double start, end; /* [s] */
    ellipsoid_state before, after;
    double dense[2][ELLIPSOID_STATE_SIZE]; /* continuous extension */
    ellipsoid_contact contact;             /* at the end */
} ellipsoid_step;

/* The state at time start <= t <= end, interpolated to third order. In
   INERTIALESS motion u and omega have one order less. A noise interval that is
   one step is linear in all. */
void ellipsoid_step_state(const ellipsoid_step *step, double t,
                          ellipsoid_state *state);

/* Called after every accepted step. Returns non-zero to stop there. */
typedef int (*ellipsoid_observer)(void *context, const ellipsoid_step *step);

/* A cell that is advanced, alone or in a group with other cells of any size
   and model. */
typedef struct ellipsoid_member
{
    const ellipsoid_model *model;
    const ellipsoid_surroundings *surroundings; /* its id names the cell */
    ellipsoid_state *state;
    ellipsoid_controller *controller;
    ellipsoid_facet_cache *cache; /* NULL only where there are no walls */
    void *observer_context;
    ellipsoid_statistics *statistics; /* may be NULL for a cell alone */
} ellipsoid_member;

/*
    Advances a cell's state from *t to `end` [s]. State, t and controller are
    updated at every accepted step; on a failure they are those of the last
    accepted step. Statistics count failed attempts as well. observer may be
    NULL. Returns OK; STOPPED by the observer, where *t is the end of that step;
    BAD_ARGUMENT for any other NULL than those allowed above; BAD_OPTION for
    INERTIALESS motion without a flow; OUTSIDE if a callback has no answer at
    the cell's position at *t; or another status that tells why it failed.
    With Brownian motion, steps end where noise intervals end. The random force
    is that of the interval, whatever the steps. Near walls, with
    wall_resistance, it depends on the pose at the beginning of the call or the
    interval: a call that continues after an observer stopped within an interval
    thus has another random force.
*/
ellipsoid_status ellipsoid_advance(const ellipsoid_member *cell, double *t,
                                   double end, ellipsoid_observer observer);

/* -------------------------------------------------------------- groups */

#define ELLIPSOID_MAX_GROUP 100000

/* Bytes of memory that are needed to advance a group of `count` cells; 0 for
   fewer than one or more than ELLIPSOID_MAX_GROUP. */
size_t ellipsoid_group_size(int count);

/*
    Advances cells that may touch one another from *t to `end` [s], as one
    system in common steps: F_S, paper eq. (1). Two beads of different cells
    touch like a bead and a wall, with the radius r_1 r_2/(r_1 + r_2), the
    modulus E_1 E_2/(E_1 + E_2), the geometric mean of the coefficients of
    friction, the larger slip speed and the mean damping. The forces on both are
    opposite. Two cells of contact_shape ELLIPSOID touch by their ellipsoids,
    not by their beads. Everything else is as in ellipsoid_advance(), for every
    member. All members need the same motion and noise interval (else
    BAD_OPTION); the limits of the steps are those of the first one. `memory` is
    ellipsoid_group_size(count) bytes, aligned as by malloc(); its content is
    not needed between calls. *which is set to the member that stopped the group
    or failed, -1 if it is none in particular; the others have advanced to the
    same time. Rounding errors depend on the order of the members.
    TOO_MANY_CELLS: more members overlap than there is memory for.
*/
ellipsoid_status ellipsoid_advance_group(int count,
                                         const ellipsoid_member members[],
                                         double *t, double end,
                                         ellipsoid_observer observer,
                                         void *memory, int *which);

/*
    The smallest gap [m] between two cells in given poses, by contact_shape
    between their beads or their ellipsoids. Negative where they overlap; at
    most `horizon` [m], the limit of the search.
*/
double ellipsoid_cell_gap(const ellipsoid_model *a, const double x_a[3],
                          const double q_a[4], const ellipsoid_model *b,
                          const double x_b[3], const double q_b[4],
                          double horizon);

#ifdef __cplusplus
}
#endif

#include "ellipsoidWorld.h"

#endif
