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

#include <math.h>

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

/*
    One evaluation of the equations: derivative, the contact met (may be NULL
    where there are no walls) and, if not NULL, the blocks. Returns
    STEP_UNDERFLOW where a callback asks for a shorter step.
*/
ellipsoid_status ellipsoid_evaluate(const ellipsoid_model *model,
                                    const ellipsoid_surroundings *surroundings,
                                    const ellipsoid_state *state,
                                    ellipsoid_contact_cache *cache,
                                    ellipsoid_state *derivative,
                                    ellipsoid_contact *contact,
                                    ellipsoid_blocks *blocks);

/*
    The Rosenbrock coefficients as in Hairer & Wanner II, eq. (IV.7.25):
    (1/(gamma h) - J) K_i = f(y0 + sum a_ij K_j) + sum c_ij/h K_j,
    y1 = y0 + sum m_j K_j; the error estimate is K_6, and
    y(s) = y0 (1-s) + s (y1 + (1-s) (d_0 + s d_1)), d_i = sum_j dense_ij K_j.
*/
#define ELLIPSOID_STAGES 6

typedef struct ellipsoid_rosenbrock_table
{
    double gamma;
    double a[ELLIPSOID_STAGES][ELLIPSOID_STAGES];
    double c[ELLIPSOID_STAGES][ELLIPSOID_STAGES];
    double dense[2][ELLIPSOID_STAGES];
} ellipsoid_rosenbrock_table;

extern const ellipsoid_rosenbrock_table ellipsoid_rodas4;

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
} ellipsoid_point;

/* The stages of one step; the last is the error estimate. */
typedef struct ellipsoid_stages
{
    double k[ELLIPSOID_STAGES][ELLIPSOID_STATE_SIZE];
    double y[ELLIPSOID_STATE_SIZE]; /* result, q not yet normalised */
    double x[ELLIPSOID_STAGES][3], q[ELLIPSOID_STAGES][4]; /* where sampled, */
    double gap[ELLIPSOID_STAGES]; /* and the gap there; only with walls */
} ellipsoid_stages;

/* ellipsoid_evaluate(), counted. blocks may be NULL. */
ellipsoid_status ellipsoid_problem_evaluate(const ellipsoid_problem *problem,
                                            const ellipsoid_state *state,
                                            ellipsoid_state *derivative,
                                            ellipsoid_contact *contact,
                                            ellipsoid_blocks *blocks);

/*
    One Rosenbrock step of length h [s] from a point. Returns STEP_UNDERFLOW or
    NON_FINITE where a shorter step may succeed.
*/
ellipsoid_status ellipsoid_rosenbrock_step(const ellipsoid_problem *problem,
                                           const ellipsoid_point *start,
                                           double h, ellipsoid_stages *stages);

/* The continuous extension of such a step. */
void ellipsoid_rosenbrock_dense(
    ellipsoid_stages *stages,
    double dense[2][ELLIPSOID_STATE_SIZE]);

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

/* One bead, lab frame. */
typedef struct ellipsoid_bead
{
    double centre[3]; /* [m] */
    double radius;    /* [m] */
    double stiffness; /* [N/m^1.5] 4/3 E* sqrt(r_b) */
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
    set only where it touches; returns the number of contacts. *gap [m] is how
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

static inline double ellipsoid_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline double ellipsoid_length(const double v[3])
{
    return sqrt(ellipsoid_dot(v, v));
}

static inline void ellipsoid_normalise(double q[4])
{
    const double scale = 1 / sqrt(ellipsoid_dot(q, q) + q[3] * q[3]);

    for (int n = 0; n < 4; n++)
    {
        q[n] *= scale;
    }
}

static inline void ellipsoid_difference(const double a[3], const double b[3],
                                        double result[3])
{
    result[0] = a[0] - b[0];
    result[1] = a[1] - b[1];
    result[2] = a[2] - b[2];
}

static inline void ellipsoid_cross(const double a[3], const double b[3],
                                   double result[3])
{
    result[0] = a[1] * b[2] - a[2] * b[1];
    result[1] = a[2] * b[0] - a[0] * b[2];
    result[2] = a[0] * b[1] - a[1] * b[0];
}

static inline void ellipsoid_copy(const double from[3], double to[3])
{
    to[0] = from[0];
    to[1] = from[1];
    to[2] = from[2];
}

/* R(q), see ellipsoid_rotation(); inlined into the right-hand side. */
static inline void ellipsoid_rotation_inline(const double q[4], double r[3][3])
{
    const double aa = q[0] * q[0], bb = q[1] * q[1];
    const double cc = q[2] * q[2], nn = q[3] * q[3];
    const double ab = q[0] * q[1], ac = q[0] * q[2], bc = q[1] * q[2];
    const double an = q[0] * q[3], bn = q[1] * q[3], cn = q[2] * q[3];

    r[0][0] = (nn - cc) + (aa - bb);
    r[0][1] = 2 * (ab - cn);
    r[0][2] = 2 * (ac + bn);
    r[1][0] = 2 * (ab + cn);
    r[1][1] = (nn - cc) - (aa - bb);
    r[1][2] = 2 * (bc - an);
    r[2][0] = 2 * (ac - bn);
    r[2][1] = 2 * (bc + an);
    r[2][2] = (nn + cc) - (aa + bb);
}

/* Q(omega) v: dq/dt = 1/2 Q(omega) q, paper eq. (4). Q^2 = -|omega|^2. */
static inline void ellipsoid_spin(const double w[3], const double v[4],
                                  double result[4])
{
    result[0] = v[3] * w[0] + v[1] * w[2] - v[2] * w[1];
    result[1] = v[3] * w[1] + v[2] * w[0] - v[0] * w[2];
    result[2] = v[3] * w[2] + v[0] * w[1] - v[1] * w[0];
    result[3] = -(v[0] * w[0] + v[1] * w[1] + v[2] * w[2]);
}

#endif
