/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    ellipsoid.h - the public header of the core; statuses, options and model are
    in ellipsoidModel.h, walls in ellipsoidWalls.h, a world of cells in
    ellipsoidWorld.h, which come with it. How to build a program
    with it: docs/fromC.md.

    One rigid ellipsoid carried by a given flow and touching given walls:
    thirteen stiff equations (velocity, position, angular velocity,
    quaternion) advanced by a fourth-order adaptive Rosenbrock method; or,
    without inertia, the seven of position and quaternion, advanced by an
    explicit Runge-Kutta method of fifth order, of fourth where the velocity is
    `piecewise`, except where the body touches: there by a Rosenbrock method, of
    third order where the velocity is `piecewise`.

    SI units throughout. Frames:
      lab    x  = (x1, x2, x3)
      body   x^ = the principal axes of the ellipsoid, R(q) turns body to lab:
             v = R v^,  R = (eta^2 - eps.eps) I + 2 eps eps^T + 2 eta [eps]x
             with the unit quaternion q = (eps1, eps2, eps3, eta), scalar last.

    The core keeps no state of its own: it does not allocate, print, exit or
    hold mutable static data, so any number of threads may call it. Every
    function that can fail returns an ellipsoid_status; on failure the state
    it was given is as it was; after ellipsoid_advance() that of the last
    accepted step.

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
    The undisturbed flow at a point and time, lab frame. G_ij = du_i/dx_j.
    All that a callback may set is zero when it is called.
    velocity_jacobian is the derivative of `velocity` as interpolated, and
    gradient_jacobian[i][j][k] = dG_ij/dx_k; both are read only where
    derivatives were asked for, and only serve the Jacobian.
*/
typedef struct ellipsoid_flow_sample
{
    double velocity[3];                 /* [m/s] */
    double gradient[3][3];              /* [1/s] */
    double pressure_gradient[3];        /* [Pa/m]; only for PRESSURE_GRADP */
    double local_acceleration[3];       /* [m/s2] du/dt where x is fixed; only
                                          for PRESSURE_DUDT where the
                                          surroundings are unsteady */
    double velocity_jacobian[3][3];     /* [1/s] */
    double gradient_jacobian[3][3][3];  /* [1/(m s)] */
    double pressure_jacobian[3][3];     /* [Pa/m2] d(grad p)_i/dx_j; likewise */
    double acceleration_jacobian[3][3]; /* [1/s2] of the local one; likewise */
} ellipsoid_flow_sample;

/*
    Samples the flow at the time t [s] and x [m, lab]. derivatives: 0 or 1.
    Returns 0; > 0: not here, shorten the step; < 0: give up.
*/
typedef int (*ellipsoid_flow_function)(void *context, double t,
                                       const double x[3], int derivatives,
                                       ellipsoid_flow_sample *sample);

/*
    Velocities of the flow at the time t [s] at points near `centre` [m, lab]
    for FLOW_BODY, and their derivatives jacobian[n][i][j] = du_i/dx_j unless
    jacobian is NULL; zero when called. Beyond a wall both are the wall's, zero.
    The centre is where the flow was sampled last. Returns 0; > 0: shorten the
    step; < 0: give up.
*/
typedef int (*ellipsoid_velocities_function)(void *context, double t,
                                             const double centre[3], int count,
                                             double (*points)[3],
                                             double (*velocity)[3],
                                             double (*jacobian)[3][3]);

/*
    An electric field E [V/m, lab] at the time t [s] and x [m, lab], and its
    derivatives jacobian[i][j] = dE_i/dx_j unless jacobian is NULL; zero when
    called. Returns as above.
*/
typedef int (*ellipsoid_field_function)(void *context, double t,
                                        const double x[3], double field[3],
                                        double (*jacobian)[3]);

/* -------------------------------------------------------- other forces */

struct ellipsoid_state;

/* Derivatives of a force (lab) and a torque (body) by the state, R(q) taken as
   the polynomial below; zero where nothing is set. */
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
    the time t [s], besides those of the options; all zero when called. The
    jacobian is NULL unless derivatives are asked for. q may differ from length
    one inside a step. u and omega may be read only if the surroundings say that
    the force depends on them. Returns 0; > 0: shorten the step; < 0: give up.
*/
typedef int (*ellipsoid_force_function)(void *context, double t,
                                        const struct ellipsoid_state *state,
                                        double force[3], double torque[3],
                                        ellipsoid_wrench_jacobian *jacobian);

/*
    What surrounds a cell; each may be NULL. Without a flow there is vacuum:
    drag and pressure gradient are zero. Without velocities, FLOW_BODY asks the
    flow point by point and takes an answer > 0 for a point beyond a wall.
*/
typedef struct ellipsoid_surroundings
{
    ellipsoid_flow_function flow;
    void *flow_context; /* of velocities, too */
    ellipsoid_walls_function walls;
    void *walls_context;
    ellipsoid_velocities_function velocities;
    ellipsoid_field_function field;
    void *field_context;
    ellipsoid_force_function force;
    void *force_context;
    int force_depends_on_velocity; /* on u or omega? 0 */
    int unsteady; /* do flow, field or force depend on time? 0; if not, the
                     derivative by time that a Rosenbrock step needs is not
                     evaluated */
    const double (*repeat)[3]; /* [m] lab: flow and walls are the same where one
                                  is moved by one of these, and the cells of a
                                  group meet at the nearest of their images; */
    int repeat_count;          /* 0 */
    int fixed; /* where it is advanced, does the body keep its pose, at rest,
                  whatever acts on it? 0; other cells of its group touch it */
    int piecewise; /* does the gradient of the velocity jump, as where it is
                      interpolated piece by piece? 0; explicit steps are of
                      another method then */
    double time; /* [s] when callbacks are asked by functions that are given no
                     time, such as ellipsoid_rhs(); 0 */
    /* The key of the cell's Brownian motion. Noise interval n begins at the
       time n noise_interval. */
    uint64_t seed;
    uint32_t id;
} ellipsoid_surroundings;

/* --------------------------------------------------------------- state */

#define ELLIPSOID_STATE_SIZE 13

/* The thirteen unknowns, in this order wherever they form a vector. Of
   INERTIALESS motion u and omega are results, not unknowns: what is put in is
   not read. */
typedef struct ellipsoid_state
{
    double u[3];     /* [m/s] velocity, lab */
    double x[3];     /* [m] centre, lab */
    double omega[3]; /* [rad/s] angular velocity, body */
    double q[4];     /* quaternion (eps1, eps2, eps3, eta), body to lab */
} ellipsoid_state;

/* R(q), row-major: lab = R body. q need not be exactly of length one. */
void ellipsoid_rotation(const double q[4], double rotation[3][3]);

/* The paper's Euler angles (phi, theta, psi) [rad], z-x-z, and back. */
void ellipsoid_euler_from_quaternion(const double q[4], double euler[3]);
void ellipsoid_quaternion_from_euler(const double euler[3], double q[4]);

/* Quaternion that turns the body axis x^2 to the unit vector `axis` (lab),
   followed in the body by a spin [rad] about it. */
void ellipsoid_quaternion_from_axis(const double axis[3], double spin,
                                    double q[4]);

/* Uniform orientation from three numbers uniform in [0, 1) (Shoemake 1992). */
void ellipsoid_quaternion_from_uniform(const double uniform[3], double q[4]);

/* ------------------------------------------------------------- contact */

#define ELLIPSOID_MAX_SURFACES 8

/*
    Which facets each bead, or the ellipsoid, may touch, and which the
    resistance may know of, kept while the cell moves little. One per cell, in
    memory of the caller's; its content never changes a result, only its cost.
*/
typedef struct ellipsoid_facet_cache ellipsoid_facet_cache;

/* Bytes of the cache of a cell of this model, aligned as by malloc(): some
   20 kB, and 16 kB more where walls add to the resistance. */
size_t ellipsoid_facet_cache_size(const ellipsoid_model *model);

/*
    Empties a cache. It must be called before the cache is used for the first
    time, and again whenever anything but the cell's pose has changed: its
    model, the walls callback or its context, or a facet. A cell that is put
    elsewhere needs no call.
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
                               radius, beyond which nobody looks; HUGE_VAL
                               without walls. Of contact_shape ELLIPSOID, of
                               the ellipsoid in place of a bead */
    int bead_contacts; /* beads that overlap the walls or are pulled by
                               them; 1 if the ellipsoid is */
    int surface_count; /* distinct ones, at most MAX_SURFACES listed */
    int surface[ELLIPSOID_MAX_SURFACES]; /* labels, in the order of the beads
                                            that are in contact */

    double cell_force[3];  /* [N] lab, of the other cells */
    double cell_torque[3]; /* [N m] body */
    double cell_deepest;   /* [m] deepest overlap with another cell */
    double cell_gap;       /* [m] smallest gap to a bead of another cell; as
                               for walls */
    int cell_count;        /* in contact, at most MAX_SURFACES listed */
    uint32_t cell_id[ELLIPSOID_MAX_SURFACES]; /* in the order of the group */
} ellipsoid_contact;

/*
    Beads against facets: Hertz, F = 4/3 E* sqrt(r_b) d^(3/2) along the
    normal of each contact; the contacts of one bead add up as sum w_i f_i
    n_i, w_i = f_i / sum_j f_j max(0, n_i.n_j) (see contactBlending.h where
    they are nearly parallel). Adhesion adds up likewise. contact_shape
    ELLIPSOID: the same law with the depth of the ellipsoid itself, the
    force where it is deepest (ellipsoidFacets.c); q turns the ellipsoid and
    does not stretch it. Friction and damping come on top (friction.c);
    without them u and omega are not read. jacobian may be NULL. The result
    is that of the state alone, to the last bit, whatever the cache has seen
    before. STEP_UNDERFLOW: the walls ask for a shorter step.
*/
ellipsoid_status ellipsoid_contact_evaluate(
    const ellipsoid_model *model, const ellipsoid_surroundings *surroundings,
    const ellipsoid_state *state, ellipsoid_facet_cache *cache,
    ellipsoid_contact *contact, ellipsoid_wrench_jacobian *jacobian);

/*
    Contact of one bead [m, lab] of given radius with the listed facets: force
    and its derivative by the bead's centre (may be NULL); for tests and tools.
    stiffness = 4/3 E* sqrt(r_b) [N/m^1.5]. Returns the number of contacts.
*/
int ellipsoid_bead_force(const double centre[3], double radius,
                         double stiffness, const ellipsoid_facet_list *facets,
                         double force[3], double force_x[3][3]);

/*
    Bead centres of a layout on an ellipsoid (body frame) into bead[][3];
    returns how many (PAPER drops duplicates), 0 if the options do not allow it.
    bead_count is 2 + 3 n (two poles and n rings of three), 32 for PAPER, or 1:
    a single bead at the centre.
*/
int ellipsoid_beads(const ellipsoid_options *options,
                    double bead[ELLIPSOID_MAX_BEADS][3]);

/*
    The body axis whose reversal takes the ellipsoid and its beads, of any
    layout, to themselves: a shortest one.
*/
int ellipsoid_mirror_axis(const double semi_axes[3]);

/*
    Whether the ellipsoid itself, not its beads, cuts a wall facet; exact, but
    that it is a part in 1e10 smaller, so that one that touches does not. The
    cell's centre is taken to be on the fluid's side. *overlaps is 0 or 1.
*/
ellipsoid_status
ellipsoid_overlaps_walls(const ellipsoid_model *model,
                         const ellipsoid_surroundings *surroundings,
                         const double x[3], const double q[4], int *overlaps);

/* -------------------------------------------------------------- random */

/*
    `count` numbers uniform in [0, 1), a function of the key alone: the same
    for any order of calls, any number of threads or ranks, and after a
    restart. Streams keep independent uses of one cell apart; those from 2^31 on
    are the core's.
*/
void ellipsoid_random_uniform(uint64_t seed, uint32_t id, uint32_t stream,
                              uint32_t index, int count, double *uniform);

/* `count` numbers of the standard normal distribution, likewise. */
void ellipsoid_random_normals(uint64_t seed, uint32_t id, uint32_t stream,
                              uint32_t index, int count, double *normal);

/* Six of them: those of the random force and torque in a noise interval. */
void ellipsoid_random_normal(uint64_t seed, uint32_t id, int64_t interval,
                             double normal[6]);

/* ----------------------------------------------------------- equations */

/*
    The thirteen time derivatives at a state, paper eqs. (1)-(4); of INERTIALESS
    motion those of x and q, where x changes with the u and q with the omega
    that balance the forces, and zero for u and omega. Without the random force.
    STEP_UNDERFLOW: a callback wants a shorter step, that is, not this state.
    cache may be NULL where there are no walls.
*/
ellipsoid_status ellipsoid_rhs(const ellipsoid_model *model,
                               const ellipsoid_surroundings *surroundings,
                               const ellipsoid_state *state,
                               ellipsoid_facet_cache *cache,
                               ellipsoid_state *derivative);

/*
    Sets u and omega to those with which the drag balances all other forces: of
    INERTIALESS motion, or the terminal ones of a body at this point. BAD_OPTION
    without drag or flow; the state is then as it was.
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
    Derivatives by the thirteen unknowns, row-major: of INERTIAL motion those of
    ellipsoid_rhs(), paper eqs. (1)-(4); of INERTIALESS those of the index-1
    system that its Rosenbrock steps solve, the same without the gyroscopic
    torque, for u and omega as given.
*/
ellipsoid_status
ellipsoid_jacobian(const ellipsoid_model *model,
                   const ellipsoid_surroundings *surroundings,
                   const ellipsoid_state *state, ellipsoid_facet_cache *cache,
                   double jacobian[ELLIPSOID_STATE_SIZE][ELLIPSOID_STATE_SIZE]);

/* ------------------------------------------------------------- advance */

/* What step control remembers between calls: part of a cell's state. */
typedef struct ellipsoid_controller
{
    double step;           /* [s] proposed next step; 0: chosen */
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
    An accepted step, for dense output: see ellipsoid_step_state(). It begins
    where the last one ended but for INERTIAL Brownian motion in long noise
    intervals: there u and omega have jumped and x and q moved by what they do
    in a relaxation time (docs/theory/forces.md, "Brownian force and
    torque").
*/
typedef struct ellipsoid_step
{
    double start, end; /* [s] */
    ellipsoid_state before, after;
    double dense[3][ELLIPSOID_STATE_SIZE]; /* continuous extension */
    ellipsoid_contact contact;             /* at the end */
} ellipsoid_step;

/* The state at time start <= t <= end: of third order, or fourth in x and q
   where the step was explicit and no velocity is `piecewise`; u and omega of
   INERTIALESS motion one less, linear in time where such a step was not
   explicit and the velocity is `piecewise`. */
void ellipsoid_step_state(const ellipsoid_step *step, double t,
                          ellipsoid_state *state);

/* Sees every accepted step. Returns non-zero to stop there. */
typedef int (*ellipsoid_observer)(void *context, const ellipsoid_step *step);

/* A cell that is advanced, alone or in a group with others of any size and
   kind. */
typedef struct ellipsoid_member
{
    const ellipsoid_model *model;
    const ellipsoid_surroundings *surroundings; /* its id names the cell */
    ellipsoid_state *state;
    ellipsoid_controller *controller;
    ellipsoid_facet_cache *cache; /* NULL only where there are no walls */
    void *observer_context;
    ellipsoid_statistics *statistics; /* NULL: not wanted, of a cell alone */
} ellipsoid_member;

/*
    Advances a cell's state from *t to `end` [s]. State, t and controller are
    updated at every accepted step; on a failure they are those of the last
    accepted step. Statistics count failed attempts as well. observer may be
    NULL; another NULL than those allowed above is BAD_ARGUMENT. INERTIALESS
    motion needs a flow: BAD_OPTION. OUTSIDE: a callback has no answer where the
    cell is at *t.
    With Brownian motion steps end where noise intervals do; the noise is that
    of the interval, whatever the steps. Near walls, with wall_resistance, it is
    of the pose where the call or an interval begins: a call from where an
    observer stopped draws other noise. Returns OK, STOPPED (by the observer;
    *t is the end of that step), or why it could not go on.
*/
ellipsoid_status ellipsoid_advance(const ellipsoid_member *cell, double *t,
                                   double end, ellipsoid_observer observer);

/* -------------------------------------------------------------- groups */

#define ELLIPSOID_MAX_GROUP 100000

/* Bytes of memory that a group of so many cells is advanced in; 0 for fewer
   than one or more than ELLIPSOID_MAX_GROUP. */
size_t ellipsoid_group_size(int count);

/*
    Advances cells that may touch one another from *t to `end` [s], as one
    system in common steps: F_S, paper eq. (1). The beads of two cells touch as
    a bead and a wall do, with the radius r_1 r_2/(r_1 + r_2) and the modulus
    E_1 E_2/(E_1 + E_2), the geometric mean of both frictions, the larger slip
    speed and the mean damping; what acts on one acts on the other with the
    opposite sign. Two of contact_shape ELLIPSOID touch with that, not with
    their beads. As ellipsoid_advance() for the rest, for every member; members
    share motion, noise interval, and the limits of steps of the first one.
    `memory` is ellipsoid_group_size(count) bytes aligned as by malloc(); it
    holds nothing between calls. *which is the member that stopped the group or
    failed, -1 if it is none in particular; others have gone as far. The
    members' order decides the rounding. BAD_OPTION: the members do not go
    together. TOO_MANY_CELLS: more of them overlap than there is memory for.
*/
ellipsoid_status ellipsoid_advance_group(int count,
                                         const ellipsoid_member members[],
                                         double *t, double end,
                                         ellipsoid_observer observer,
                                         void *memory, int *which);

/*
    The smallest gap [m] between two cells in given poses, of their beads or of
    themselves by contact_shape, negative where they overlap; at most `horizon`
    [m], beyond which nobody looks.
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
