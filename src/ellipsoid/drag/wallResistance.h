/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    wallResistance.h - what the files of the wall-corrected resistance share.
*/
#ifndef ELLIPSOID_WALL_RESISTANCE_H
#define ELLIPSOID_WALL_RESISTANCE_H

#include "drag/drag.h"

/* The part of the height over which a point beside its facet fades. */
static const double ellipsoid_fading = 0.25;

/* The part of the height by which facets in one plane, but for an angle that
   counts as none, overlap at their seam. */
static const double ellipsoid_lap = 1e-5;

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

/* Finds the point that this facet gives; 0 if there is none (wallFeatures.c).
 */
int ellipsoid_find_feature(const ellipsoid_wall_search *s,
                           const ellipsoid_facet *facet,
                           ellipsoid_wall_feature *p);

/* Sets the weights, and their slopes if asked for, from all the rest
   (planeWeights.c). */
void ellipsoid_weigh_planes(const ellipsoid_model *model,
                            ellipsoid_planes *planes, int with_slopes);

/*
    What a plane at height [m] adds to the resistance, over mu: force [m2/s] and
    torque [m3/s] on a body with the given velocity and angular velocity, all in
    the body frame and with the sign of the velocities. change, if not NULL:
    its derivatives by the three components of the normal and the height, force
    and torque. 0 if it is singular (wallResistance.c).
*/
int ellipsoid_plane_resistance(const ellipsoid_model *model,
                               const double normal[3], double height,
                               const double rates[6], double action[6],
                               double change[4][6]);

/* The same as a symmetric matrix. */
int ellipsoid_plane_matrix(const ellipsoid_model *model,
                           const double normal[3], double height,
                           double matrix[6][6]);

#endif
