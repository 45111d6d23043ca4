/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    wallParts.h - how much of a plane a wall covers, for wallPlanes.c.
*/
#ifndef ELLIPSOID_WALL_PARTS_H
#define ELLIPSOID_WALL_PARTS_H

#include "drag/drag.h"

/* How far from the foot a wall is looked for at most, and so from a body in
   range, in ranges. */
#define ELLIPSOID_WALL_BESIDE 0.75

/* Where a kernel sees a point v of the wall, from the centre in the body frame:
   r = scale (shrink v + shift). */
typedef struct ellipsoid_wall_kernel
{
    double scale, shrink[3], shift[3], normal[3];
    double foot[3], reach; /* [m] lab, where r is 0; beyond it r is above c */
    double cut, k, n;      /* c, k and N above */
    double cut_slope;      /* of ln c by ln scale */
} ellipsoid_wall_kernel;

/* Sums along the rim: of Phi - 1 over the angle, of the weight times the
   outward normal, of its product with v (lab), and with r; what the cut is
   worth. */
typedef struct ellipsoid_wall_rim
{
    int inside, edges; /* edges that are seen */
    double value, normal[3], moment[3][3], stretch, of_cut;
} ellipsoid_wall_rim;

/* One wall of a pose. */
typedef struct ellipsoid_wall
{
    const double *normal;                     /* unit, into the fluid, lab */
    double normal_by[ELLIPSOID_POSE_SIZE][3]; /* of it in the body frame */
    ellipsoid_of_pose height;                 /* [m] of the centre */
    ellipsoid_of_pose support; /* [m] of that over the nearest point */
    ellipsoid_of_pose gap;     /* [m] cut off */
    double gap_slope;          /* its derivative by that which is not */
    double away; /* [m] of its nearest facet, about, from the centre */
    ellipsoid_wall_kernel seen[2];
    ellipsoid_wall_rim sum[2];
    /* once it has all its facets: the part of the plane that it covers, by each
       kernel, and how it fades */
    ellipsoid_of_pose part[2], fade;
} ellipsoid_wall;

typedef struct ellipsoid_wall_view
{
    const ellipsoid_model *model;
    const double *x;
    int slopes;             /* are derivatives wanted? else they are 0 */
    double axis[3][3];      /* unit */
    double turned[4][3][3]; /* their derivatives by q */
} ellipsoid_wall_view;

/* What depends on a and b: of this value, by a and by b. */
static inline ellipsoid_of_pose ellipsoid_chain(double value, double by_a,
                                                const ellipsoid_of_pose *a,
                                                double by_b,
                                                const ellipsoid_of_pose *b)
{
    ellipsoid_of_pose result = {.value = value};

    for (int n = 0; n < ELLIPSOID_POSE_SIZE; n++)
    {
        result.by[n] = by_a * a->by[n] + by_b * b->by[n];
    }
    return result;
}

/* Does its wall end at an edge of it, or bend? */
static inline int ellipsoid_has_seam(const ellipsoid_facet *facet)
{
    return facet->within != 7;
}

/* Begins a wall of a plane of this normal, which lives as long; the centre is
   `height` above it. */
void ellipsoid_wall_begin(ellipsoid_wall_view *view, const double normal[3],
                          double height, ellipsoid_wall *wall);

/* Adds a facet of its plane. */
void ellipsoid_wall_add(ellipsoid_wall_view *view, const ellipsoid_facet *facet,
                        ellipsoid_wall *wall);

/* When it has all facets: parts, and fade where it goes out of range, and where
   its plane cuts the body, which then is beside it. */
void ellipsoid_wall_end(ellipsoid_wall_view *view, ellipsoid_wall *wall);

#endif
