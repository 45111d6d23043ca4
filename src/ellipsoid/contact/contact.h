/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    contact.h - the room that knows contact: the law, beads and ellipsoids
    against walls and against one another, friction, and the derivatives of the
    wrench. It depends on walls and body, and knows neither flow nor time.
*/
#ifndef ELLIPSOID_CONTACT_H
#define ELLIPSOID_CONTACT_H

#include "contact/contactLaw.h"
#include "walls/walls.h"

/* Is a cell in contact with anything? */
static inline int ellipsoid_in_contact(const ellipsoid_contact *contact)
{
    return contact->bead_contacts > 0 || contact->cell_count > 0;
}

/* That of a cell that nothing touches. */
static inline ellipsoid_contact ellipsoid_no_contact(void)
{
    static const ellipsoid_contact none = {.gap = HUGE_VAL,
                                           .slip = HUGE_VAL,
                                           .cell_gap = HUGE_VAL,
                                           .cell_slip = HUGE_VAL};

    return none;
}

/* ------------------------------------------------- a bead and walls */

/* One bead, lab frame. */
typedef struct ellipsoid_bead
{
    double centre[3]; /* [m] */
    double radius;    /* [m] */
    const ellipsoid_wall_laws *laws;
} ellipsoid_bead;

/* A force on a bead [N], and its derivative by the bead's centre [N/m]. */
typedef struct ellipsoid_point_force
{
    double force[3], force_x[3][3];
} ellipsoid_point_force;

/* Those of laws that repel, on which friction and damping depend, at walls and
   at planes of symmetry, and those of laws that attract. */
typedef struct ellipsoid_bead_forces
{
    ellipsoid_point_force repulsion, mirrored, attraction;
    int mirrors; /* contacts at planes of symmetry */
} ellipsoid_bead_forces;

/*
    The wall's forces on one bead (beadContact.c), set only where it is within
    the range of a law; returns the number of contacts. *gap [m] is how far
    beyond the bead to look and is lowered to the smallest gap found (minus the
    depth of an overlap). The surfaces in contact are listed in *report, which
    may be NULL.
*/
int ellipsoid_bead_contact(const ellipsoid_bead *bead,
                           const ellipsoid_candidates *from, double *gap,
                           int derivatives, ellipsoid_bead_forces *forces,
                           ellipsoid_contact *report);

/*
    When the next of a cell's beads comes into contact with a wall, all going on
    as they move in this state, for which the cache is current, and is then so
    deep [m]; `time` [s] if that is less (wallContact.c). moved: as
    ellipsoid_facet_cache_update() has set it.
*/
double ellipsoid_landing(const ellipsoid_model *model,
                         const ellipsoid_state *state,
                         const ellipsoid_facet_cache *cache, double moved,
                         double depth, double time);

/* --------------------------------------------- derivatives of a wrench */

/*
    Adds the derivatives of a force at x + R(q) arm, and of its torque, by the
    body's own pose: force_x is that of the force by this point
    (wrenchJacobian.c).
*/
void ellipsoid_add_wrench_jacobian(const double arm[3], const double q[4],
                                   double r[3][3], const double force[3],
                                   double force_x[3][3],
                                   ellipsoid_wrench_jacobian *jacobian);

/* Likewise by the pose of another body, that of its point `other_arm`. */
void ellipsoid_add_cross_jacobian(const double arm[3], double r[3][3],
                                  const double other_arm[3],
                                  const double other_q[4], double force_x[3][3],
                                  ellipsoid_wrench_jacobian *jacobian);

/* ------------------------------------------------- friction and damping */

typedef struct ellipsoid_friction_law
{
    double friction;   /* [-] mu */
    double slip_speed; /* [m/s] v_s */
    double damping;    /* [s/m] alpha */
} ellipsoid_friction_law;

ellipsoid_friction_law ellipsoid_friction_law_of(const ellipsoid_model *model);
ellipsoid_friction_law
ellipsoid_friction_law_at_mirror(const ellipsoid_model *model);
ellipsoid_friction_law ellipsoid_friction_law_between(const ellipsoid_model *a,
                                                      const ellipsoid_model *b);

/* The force at a contact point, and its derivatives. */
typedef struct ellipsoid_traction
{
    double normal[3];
    double force[3]; /* [N] lab */
    double slip;     /* [m/s] sqrt(v_t^2 + v_s^2); HUGE_VAL without friction */
    double by_elastic[3][3];  /* [-] by the elastic force, v being constant */
    double by_velocity[3][3]; /* [N s/m] */
} ellipsoid_traction;

/* From the elastic force [N] and the velocity of the material there [m/s], both
   lab; 0 where there is no elastic force (friction.c). */
int ellipsoid_contact_traction(const ellipsoid_friction_law *law,
                               const double elastic[3],
                               const double velocity[3], int derivatives,
                               ellipsoid_traction *traction);

/* One body at a contact of one of its beads. */
typedef struct ellipsoid_attachment
{
    const ellipsoid_state *state;
    const double *arm; /* [m] body, the bead's centre */
    double (*r)[3];    /* R(q) */
    double spin[3];    /* [rad/s] lab, R omega */
    double point[3];   /* [m] lab, the contact point, from the body's centre */
} ellipsoid_attachment;

/* With the bead's centre as the contact point. */
ellipsoid_attachment ellipsoid_attachment_of(const ellipsoid_state *state,
                                             double r[3][3],
                                             const double arm[3]);

/* Friction at one point between a body and a wall, or between two bodies. */
typedef struct ellipsoid_friction
{
    int bodies;
    ellipsoid_attachment attachment[2];
    double elastic[3];           /* [N] elastic force on the first */
    double elastic_c[2][3][3];   /* [N/m] derivative by each bead's centre */
    double point_c[2][3][3];     /* [-] likewise, of the contact point */
    ellipsoid_traction traction; /* on the first */
} ellipsoid_friction;

/* Sets the traction; 0 where there is none. */
int ellipsoid_friction_traction(const ellipsoid_friction_law *law,
                                ellipsoid_friction *friction, int derivatives);

/* Adds force [N, lab] and torque [N m, body] on a body. */
void ellipsoid_add_friction(const ellipsoid_friction *friction, int body,
                            double force[3], double torque[3]);

/* Adds to jacobian[i][k] the derivatives of the wrench on body i by the state
   of body k (wrenchJacobian.c). */
void ellipsoid_add_friction_jacobian(
    ellipsoid_friction *friction,
    ellipsoid_wrench_jacobian *const jacobian[2][2]);

/* A cell in contact with walls, and the sums that its beads add to. */
typedef struct ellipsoid_wall_contact
{
    const ellipsoid_model *model;
    const ellipsoid_state *state;
    double r[3][3]; /* R(q) */
    ellipsoid_wall_laws laws;
    ellipsoid_contact *contact;
    ellipsoid_wrench_jacobian *jacobian; /* may be NULL */
} ellipsoid_wall_contact;

/* Adds the elastic force on the bead at `arm`, with friction and damping. */
void ellipsoid_add_wall_friction(ellipsoid_wall_contact *at,
                                 const ellipsoid_friction_law *law,
                                 const double arm[3],
                                 const ellipsoid_point_force *elastic);

/* -------------------------------------------- the ellipsoid and walls */

/* The walls' force and torque on an ellipsoid: the part of
   ellipsoid_contact_evaluate() for it (ellipsoidContact.c). contact->gap is how
   far to look. */
ellipsoid_status ellipsoid_surface_contact_add(
    const ellipsoid_model *model, const ellipsoid_surroundings *surroundings,
    const ellipsoid_state *state, ellipsoid_facet_cache *cache,
    ellipsoid_contact *contact, ellipsoid_wrench_jacobian *jacobian);

/* Derivatives of a pair are by x_a - x_b, a small rotation of a, and one of b;
   all in the lab. */
#define ELLIPSOID_PAIR_VARIABLES 9

/* Where two ellipsoids are nearest, or deepest in one another
   (ellipsoidPair.c). */
typedef struct ellipsoid_surface_pair
{
    double depth;      /* [m] minus the distance where they are apart */
    double normal[3];  /* unit, from b to a */
    double point_a[3]; /* [m] on a, from its centre */
    double point_b[3]; /* [m] on b, from its centre */

    /* set where derivatives are asked for */
    double depth_slope[ELLIPSOID_PAIR_VARIABLES];
    double normal_slope[3][ELLIPSOID_PAIR_VARIABLES];
    double point_a_slope[3][ELLIPSOID_PAIR_VARIABLES];
    double point_b_slope[3][ELLIPSOID_PAIR_VARIABLES];
} ellipsoid_surface_pair;

void ellipsoid_surface_pair_set(const ellipsoid_surface *a,
                                const ellipsoid_surface *b, int derivatives,
                                ellipsoid_surface_pair *pair);

/* Derivatives of the wrench on an ellipsoid are by those nine, by u_a - u_b in
   the lab, and by omega of a and of b, each in its body. */
#define ELLIPSOID_WRENCH_VARIABLES 18

/* The elastic force between an ellipsoid and a wall, or between two ellipsoids,
   at one contact. */
typedef struct ellipsoid_surface_force
{
    int bodies; /* 1 at a wall: no variables of b */
    ellipsoid_surface *body[2];
    const ellipsoid_state *state[2];
    double force[3];    /* [N] lab, on the first */
    double point[2][3]; /* [m] lab, from each one's centre */

    /* read where derivatives are asked for */
    double force_slope[ELLIPSOID_PAIR_VARIABLES][3];
    double point_slope[2][ELLIPSOID_PAIR_VARIABLES][3];
} ellipsoid_surface_force;

/* Sums over contacts: the force on the first, torques about the centres. */
typedef struct ellipsoid_wrench
{
    double force[3], torque[2][3]; /* [N], [N m] lab */
    double slip;                   /* [m/s] the smallest */
    double force_slope[ELLIPSOID_WRENCH_VARIABLES][3];
    double torque_slope[2][ELLIPSOID_WRENCH_VARIABLES][3];
} ellipsoid_wrench;

/* Adds a force, with friction and damping unless law is NULL
   (ellipsoidWrench.c). */
void ellipsoid_wrench_add(const ellipsoid_surface_force *at,
                          const ellipsoid_friction_law *law, int derivatives,
                          ellipsoid_wrench *sum);

/* The wrench on body b: force [N, lab], torque [N m, body] and, unless `by` is
   NULL, their derivatives by the states of the first body and the second. Of
   `at`, bodies and states are read. */
void ellipsoid_wrench_report(const ellipsoid_surface_force *at,
                             const ellipsoid_wrench *sum, int b,
                             double force[3], double torque[3],
                             ellipsoid_wrench_jacobian *const by[2]);

/* ------------------------------------------------- two bodies in contact */

/* A cell in a pose. */
typedef struct ellipsoid_body
{
    const ellipsoid_model *model; /* NULL: not placed yet */
    const double *x, *q;
    double r[3][3];
    double (*bead)[3]; /* [m] lab, from the centre */
} ellipsoid_body;

#define ELLIPSOID_NEAR_BEADS 200

/* Two cells of a group, a < b, and the beads that may come into contact. */
typedef struct ellipsoid_near_pair
{
    int a, b;
    int listed; /* -1: too many, all may */
    unsigned char bead[ELLIPSOID_NEAR_BEADS][2];
} ellipsoid_near_pair;

/* How far beyond beads of two cells gaps are measured [m] (nearPairs.c). */
double ellipsoid_pair_horizon(const ellipsoid_model *a,
                              const ellipsoid_model *b);

/* Are the ellipsoids of two cells in contact, not their beads? */
static inline int ellipsoid_pair_is_exact(const ellipsoid_model *a,
                                          const ellipsoid_model *b)
{
    return a->options.contact_shape == ELLIPSOID_CONTACT_ELLIPSOID
        && b->options.contact_shape == ELLIPSOID_CONTACT_ELLIPSOID;
}

/* Are two cells farther apart than `far` [m]? Errs towards 0. */
int ellipsoid_are_apart(const ellipsoid_model *a, const double x_a[3],
                        const ellipsoid_model *b, const double x_b[3],
                        double far);

/* Sets all but the array for the beads, and fills that. */
void ellipsoid_place_body(ellipsoid_body *body, const ellipsoid_model *model,
                          const double x[3], const double q[4]);

/* Lists beads with gaps below `far` [m]. */
void ellipsoid_list_beads(ellipsoid_body *a, ellipsoid_body *b, double far,
                          ellipsoid_near_pair *near);

/* The gap between the ellipsoids themselves [m] (ellipsoidPairContact.c). */
double ellipsoid_surface_gap(const ellipsoid_body *a, const ellipsoid_body *b);

/* The wrench on one cell, and its derivatives by its state and the other's. */
typedef struct ellipsoid_pair_wrench
{
    double force[3], torque[3];
    ellipsoid_wrench_jacobian own, other;
} ellipsoid_pair_wrench;

typedef struct ellipsoid_pair_contact
{
    const ellipsoid_body *a, *b;
    const ellipsoid_state *state_a, *state_b; /* read with friction, and for
                                                 derivatives of ellipsoids */
    ellipsoid_contact_law normal_law;
    ellipsoid_friction_law law;
    int dissipative; /* does friction or damping act? */
    double gap;      /* [m] the smallest found */
    double slip;     /* [m/s] likewise, HUGE_VAL at first */
    int contacts;    /* of beads, or of the ellipsoids */
    int derivatives;
    ellipsoid_pair_wrench *of_a, *of_b;
} ellipsoid_pair_contact;

/* Gap and, where they are in contact, the wrenches and their derivatives, of
   the beads that are listed (pairContact.c). */
void ellipsoid_pair_contact_evaluate(ellipsoid_pair_contact *m,
                                     const ellipsoid_near_pair *near);

/* The ellipsoids themselves against one another: gap, force, derivatives. */
void ellipsoid_surface_pair_contact(ellipsoid_pair_contact *m);

#endif
