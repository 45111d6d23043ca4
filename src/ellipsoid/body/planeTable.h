/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    planeTable.h - the table of what one plane does to spheroids. Also for the
    program that makes it.
*/
#ifndef ELLIPSOID_PLANE_TABLE_H
#define ELLIPSOID_PLANE_TABLE_H

#include "ellipsoid.h"

#include <math.h>

/* Chebyshev polynomials in the logarithm of the axis ratio, of prolate bodies and
   of oblate ones; those in the tilt and the gap, and the functions, are counted
   in ellipsoidModel.h. */
enum
{
    ELLIPSOID_PLANE_PROLATE = 9,
    ELLIPSOID_PLANE_OBLATE = 7
};

/* x at the least gap of the table, p/500: ln 501. */
#define ELLIPSOID_PLANE_DEPTH 6.216606101085159

/* The axis ratios of the table, and where one is between 1 and the end on its
   side, 0 to 1. */
#define ELLIPSOID_PLANE_LEAST_RATIO 0.25
#define ELLIPSOID_PLANE_LARGEST_RATIO 10.0

static inline double ellipsoid_plane_ratio_part(double ratio)
{
    return log(ratio)
         / log(ratio < 1 ? ELLIPSOID_PLANE_LEAST_RATIO
                         : ELLIPSOID_PLANE_LARGEST_RATIO);
}

/* 12 pi S^3/tau, what squeezing resists with times the gap, for an equatorial
   radius of 1: S^2 is the product of the radii of curvature R1 = b^2/p^3 and R2 =
   1/p at the nearest point, tau their sum; p the height of the centre above it.
 */
static inline double ellipsoid_squeeze(double ratio, double p)
{
    const double b = ratio;

    return 37.69911184307752 * b * b * b / (p * p * p * (b * b + p * p));
}

/* The resistance of the free spheroid over mu, equatorial radius 1: to
   translation across its axis and along it, to rotation. */
enum
{
    ELLIPSOID_K_ACROSS,
    ELLIPSOID_K_ALONG,
    ELLIPSOID_C_ACROSS,
    ELLIPSOID_C_ALONG
};

/* The size of each function, and its derivative by p (planeTable.c). */
void ellipsoid_plane_scales(double ratio, const double free[4], double p,
                            double scale[ELLIPSOID_PLANE_FUNCTIONS],
                            double slope[ELLIPSOID_PLANE_FUNCTIONS]);

/* Chebyshev's polynomials of t in [0, 1], and their derivatives unless slope is
   NULL. */
void ellipsoid_chebyshev(double t, int count, double *value, double *slope);

/* The spheroid of nearest shape: its axis is that of the body across which the
   two others differ least, its equatorial radius their geometric mean. Returns
   the axis ratio. */
double ellipsoid_nearest_spheroid(const double semi_axes[3], int *axis);

/* Is the shape of that in the table, or slimmer or flatter by a factor of two at
   most? Then it is taken for one of the table that is as long, or as wide. */
int ellipsoid_plane_table_has(const double semi_axes[3]);

/* The table for a body of this shape. */
void ellipsoid_plane_table_set(const double semi_axes[3],
                               ellipsoid_plane_table *own);

#endif
