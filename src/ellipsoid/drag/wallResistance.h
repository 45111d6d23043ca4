/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    wallResistance.h - what the files of the wall-corrected resistance share.
*/
#ifndef ELLIPSOID_WALL_RESISTANCE_H
#define ELLIPSOID_WALL_RESISTANCE_H

#include "drag/drag.h"

/* The part of the height over which a place beside its facet fades. */
static const double ellipsoid_fading = 0.25;

/* What the search of the planes of one pose needs. */
typedef struct ellipsoid_wall_search
{
    const double *x;
    double square[3];     /* [m2] a_i^2 */
    double (*axis)[3];    /* unit */
    double (*turned)[3][3]; /* their derivatives by q, NULL: no slopes */
    double range, longest; /* [m] largest semi-axis */
} ellipsoid_wall_search;

/* Where a plane was found: on a facet, on edge k or at vertex k of it. */
typedef struct ellipsoid_wall_feature
{
    const ellipsoid_facet *facet;
    int feature, k;
    int over[3];      /* beside the facet, over these edges: it fades */
    double foot;      /* along the edge, 0 to 1 on it */
    double normal[3]; /* body */
    double height;
} ellipsoid_wall_feature;

/* diag(1/a_i^2) v */
static inline void ellipsoid_shrink(const ellipsoid_wall_search *s,
                                    const double v[3], double result[3])
{
    for (int i = 0; i < 3; i++)
    {
        result[i] = v[i] / s->square[i];
    }
}

/* Finds the place that this facet gives; 0 if there is none (wallFeatures.c). */
int ellipsoid_find_feature(const ellipsoid_wall_search *s,
                         const ellipsoid_facet *facet, ellipsoid_wall_feature *p);

/* Walls that act at once; of more, the nearest. */
#define ELLIPSOID_MAX_PLANES 24

/* The position x and the quaternion q: what derivatives are taken by. */
#define ELLIPSOID_POSE_SIZE 7

/* A number that depends on the pose; the slopes only where asked for. */
typedef struct ellipsoid_quantity
{
    double value, slope[ELLIPSOID_POSE_SIZE];
} ellipsoid_quantity;

/* A wall as the body sees it: the plane on which it rests, grown or shrunk. */
typedef struct ellipsoid_plane
{
    double normal[3]; /* unit, body frame, into the fluid */
    double normal_slope[ELLIPSOID_POSE_SIZE][3];
    ellipsoid_quantity height; /* [m] of the centre above the plane */
    ellipsoid_quantity window; /* [-] 1 near, 0 out of range, or where
                                  its place is well beside its facet */
    ellipsoid_quantity weight; /* [-] 0 to 1: window and what it leaves to
                                  other planes */
} ellipsoid_plane;

typedef struct ellipsoid_planes
{
    int count;
    ellipsoid_plane at[ELLIPSOID_MAX_PLANES];
} ellipsoid_planes;

/* The planes at a pose; axis and axis_derivatives as in ellipsoid_faxen(),
   the latter NULL where no slopes are wanted (wallPlanes.c). */
ellipsoid_status
ellipsoid_find_planes(const ellipsoid_model *model,
                      const ellipsoid_surroundings *surroundings,
                      const double x[3], const double q[4],
                      double axis[3][3], double axis_derivatives[4][3][3],
                      ellipsoid_facet_cache *cache,
                      ellipsoid_planes *planes);

/* Sets the weights from all the rest (planeWeights.c). */
void ellipsoid_weigh_planes(const ellipsoid_model *model,
                            ellipsoid_planes *planes);

/*
    What a plane at height [m] adds to the resistance, over mu: force [m2/s] and
    torque [m3/s] on a body with the given velocity and angular velocity, all in
    the body frame and with the sign of the velocities. change, if not NULL:
    its derivatives by the three components of the normal and the height, force
    and torque (wallResistance.c).
*/
void ellipsoid_plane_resistance(const ellipsoid_model *model,
                                const double normal[3], double height,
                                const double rates[6], double action[6],
                                double change[4][6]);

/* The same as a symmetric matrix. */
void ellipsoid_plane_matrix(const ellipsoid_model *model,
                            const double normal[3], double height,
                            double matrix[6][6]);

#endif
