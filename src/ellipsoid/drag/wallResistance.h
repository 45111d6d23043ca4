/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    wallResistance.h - what the files of the wall-corrected resistance share.
*/
#ifndef ELLIPSOID_WALL_RESISTANCE_H
#define ELLIPSOID_WALL_RESISTANCE_H

#include "drag/drag.h"

#include <math.h>

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
    double range, longest, shortest; /* [m] of the semi-axes two */
} ellipsoid_wall_search;

/* The body as seen along a normal; that of a facet is mostly that of the last,
   too, in one plane with it. */
typedef struct ellipsoid_wall_view
{
    double along[3];       /* lab; 0: none yet */
    double normal[3];      /* body */
    double way[3];         /* lab; the centre less this times its height is the
                              point that the grown body meets first */
    double support, far;   /* [m]; [-] length of the way */
    double beside;         /* [-] how far beside an extended facet a plane has
                              faded, by the height */
} ellipsoid_wall_view;

static inline void ellipsoid_look_along(const ellipsoid_wall_search *s,
                                        const double normal[3],
                                        ellipsoid_wall_view *view)
{
    double b[3], support2;

    if (view->along[0] == normal[0] && view->along[1] == normal[1]
        && view->along[2] == normal[2])
    {
        return;
    }
    ellipsoid_copy(normal, view->along);
    ellipsoid_product(s->axis, normal, view->normal);
    for (int i = 0; i < 3; i++)
    {
        b[i] = s->square[i] * view->normal[i];
    }
    support2 = ellipsoid_dot(view->normal, b);
    view->support = sqrt(support2);
    view->far = ellipsoid_length(b) / support2;
    view->beside = ellipsoid_fading * s->longest / view->support;
    ellipsoid_combination(s->axis, b[0] / support2, b[1] / support2,
                          b[2] / support2, view->way);
}

/* Does a facet's plane go on beside it? */
static inline int ellipsoid_facet_is_extended(const ellipsoid_facet *facet)
{
    return facet->edge[0] == ELLIPSOID_EDGE_CONCAVE
        || facet->edge[1] == ELLIPSOID_EDGE_CONCAVE
        || facet->edge[2] == ELLIPSOID_EDGE_CONCAVE;
}

/* How far a point in the facet's plane lies beyond edge k, times that edge's
   length, which `along` has. */
static inline double ellipsoid_beyond(const ellipsoid_facet *facet,
                                      const double foot[3],
                                      int k, double along[3])
{
    double inward[3], from[3];

    ellipsoid_difference(facet->vertex[(k + 1) % 3], facet->vertex[k], along);
    ellipsoid_cross(facet->normal, along, inward);
    ellipsoid_difference(facet->vertex[k], foot, from);
    return ellipsoid_dot(inward, from);
}

/* Where a plane was found: on a facet, on edge k or at vertex k of it. */
typedef struct ellipsoid_wall_feature
{
    const ellipsoid_facet *facet;
    int feature, k;
    int over[3];      /* beside the facet, over these edges: it fades */
    double foot;      /* along the edge, 0 to 1 on it */
    double place[3];  /* lab, on the plane of a face */
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

/* Lists facets in range anew if the centre has moved too far (nearFacets.c). */
ellipsoid_status
ellipsoid_collect_near(const ellipsoid_surroundings *surroundings,
                       const double x[3], double range, double slimness,
                       ellipsoid_facet_cache *cache);

/* Lists those of them that count near this pose, unless it has changed little.
   Returns the list that serves now. */
int ellipsoid_look_closer(const ellipsoid_wall_search *s,
                          ellipsoid_facet_cache *cache);

/* Finds the point that this facet gives; 0 if there is none (wallFeatures.c).
 */
int ellipsoid_find_feature(const ellipsoid_wall_search *s,
                           const ellipsoid_facet *facet,
                           ellipsoid_wall_view *view,
                           ellipsoid_wall_feature *p);

/* Sets a feature's plane but for what may be slow; 0 if it is too far to count.
   The rest: derivatives, if s->turned, window and extent (featurePlane.c). */
int ellipsoid_begin_plane(const ellipsoid_wall_search *s,
                          const ellipsoid_wall_feature *p,
                          ellipsoid_plane *plane);
void ellipsoid_complete_plane(const ellipsoid_wall_search *s,
                              const ellipsoid_wall_feature *p,
                              ellipsoid_plane *plane);

/* How far all points over convex edges, and the vertices, are from the centre
   at least, squared. */
double ellipsoid_squared_rim_distance(const ellipsoid_facet *facet,
                                      const double x[3]);

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
