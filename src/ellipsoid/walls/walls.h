/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    walls.h - the room that knows wall facets: where the distance from a point,
    or from an ellipsoid, to a facet has a local minimum, and which facets are
    near a cell. It depends on body alone.
*/
#ifndef ELLIPSOID_WALLS_H
#define ELLIPSOID_WALLS_H

#include "body/body.h"

/* Do walls touch such a body at all? */
static inline int ellipsoid_has_walls(const ellipsoid_model *model,
                                      const ellipsoid_surroundings *around)
{
    return model->options.contact && around->walls != NULL;
}

#define ELLIPSOID_MAX_PAIRS 2048
#define ELLIPSOID_MAX_NEAR 16384
#define ELLIPSOID_MAX_LISTED 128

/* Planes of listed facets and balls that hold them [m], from where they were
   listed: one array for each number so that loops vectorise. */
typedef struct ellipsoid_facet_planes
{
    float normal[3][ELLIPSOID_MAX_LISTED], height[ELLIPSOID_MAX_LISTED];
    float middle[3][ELLIPSOID_MAX_LISTED], radius[ELLIPSOID_MAX_LISTED];
} ellipsoid_facet_planes;

/* What tells that a facet is far from the box that holds a cell's beads [m]:
   how far its plane is, and the square of twice how far its ball's centre is. */
typedef struct ellipsoid_facet_bounds
{
    float above[ELLIPSOID_MAX_LISTED], squared[ELLIPSOID_MAX_LISTED], rounding;
} ellipsoid_facet_bounds;

/* What rounding takes of lengths computed from them */
#define ELLIPSOID_PLANES_ROUNDED 3e-6F

/* See ellipsoid.h. */
struct ellipsoid_facet_cache
{
    int valid;
    int uses, listed; /* since it was filled; facets listed then */
    double margin;    /* [m] how far a bead may move */
    double rotation[3][3], half_box[3]; /* R(q) there; the beads' box [m] */
    double x[3], q[4];                  /* pose at which it was filled */
    double clearance; /* [m] > 0: no facet while the centre moves less */
    const ellipsoid_facet *facets;
    double nearest[ELLIPSOID_MAX_BEADS]; /* [m] no facet nearer to a centre */
    double nearest_of_all;               /* [m] the least of these */
    int bead_count, bead[ELLIPSOID_MAX_BEADS]; /* with facets, ascending */
    int first[ELLIPSOID_MAX_BEADS + 1]; /* bead b: first[b] to first[b+1] of */
    int facet[ELLIPSOID_MAX_PAIRS];     /* facets, ascending for each bead */
    float away[ELLIPSOID_MAX_PAIRS]; /* [m] at least, from its bead; of beads */
    /* All facets within `about_reach` [m] of a point, ascending, for several
       searches; about_count -1: not looked up */
    int about_count, about[ELLIPSOID_MAX_LISTED];
    int about_nearest; /* which of a list was nearest last: it comes first */
    double about_x[3], about_reach;
    const ellipsoid_facet *about_facets;
    ellipsoid_facet_planes planes; /* of the list that was looked up last */
    int near_count;     /* of facets about the wall_range; -1: not looked up */
    double near_x[3];   /* where they were looked up */
    double near_margin; /* [m] how far the centre may move from there */
    const ellipsoid_facet *near_facets;
    int near_facet[ELLIPSOID_MAX_NEAR]; /* ascending; the last, as it is only
                                           there with near walls */
};

/* The height [m] of a point over the plane of a facet, and its unit normal. */
static inline double ellipsoid_height_over(const ellipsoid_facet *facet,
                                           const double x[3],
                                           const double **normal)
{
    const double(*plane)[3] =
        (const double(*)[3])((const char *)facet + facet->plane);
    const int own = facet->plane == 0;
    double d[3];

    *normal = own ? facet->normal : plane[1];
    ellipsoid_difference(x, own ? facet->middle : plane[0], d);
    return ellipsoid_dot(d, *normal);
}

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
    int mirror;       /* of the facet; whoever keeps it sets it */
} ellipsoid_nearest;

/* As ellipsoid_facet_nearest(), for a point beside the facet (facets.c). */
int ellipsoid_boundary_nearest(const ellipsoid_facet *facet,
                               const double centre[3], double reach,
                               ellipsoid_nearest *nearest);

/* Fills *nearest and returns 1 if there is one nearer than reach [m] on this
   facet; inlined, as most points have none or are over a face. */
static inline int ellipsoid_facet_nearest(const ellipsoid_facet *facet,
                                          const double centre[3], double reach,
                                          ellipsoid_nearest *nearest)
{
    double from[3];

    ellipsoid_difference(centre, facet->vertex[0], from);

    const double height = ellipsoid_dot(from, facet->normal);

    if (!(fabs(height) < reach))
    {
        return 0;
    }
    for (int k = 0; k < 3; k++)
    {
        ellipsoid_difference(centre, facet->vertex[k], from);
        if (ellipsoid_dot(facet->inward[k], from) < 0)
        {
            return ellipsoid_boundary_nearest(facet, centre, reach, nearest);
        }
    }
    nearest->feature = ELLIPSOID_ON_FACE;
    nearest->height = height;
    ellipsoid_copy(facet->normal, nearest->normal);
    return 1;
}

/* What of a facet's edges serves many points. */
typedef struct ellipsoid_facet_sides
{
    double length[3];                 /* [m] */
    double along[3][3], inward[3][3]; /* unit, in the facet's plane */
} ellipsoid_facet_sides;

void ellipsoid_facet_sides_set(const ellipsoid_facet *facet,
                               ellipsoid_facet_sides *sides);

/* Could ellipsoid_facet_nearest() find one if the point moved by up to
   margin [m]? Errs towards 1, and then sets *distance [m], farther than which
   the facet is. Beside the facet's ball, by more than 1.5 times the margin as
   seen along its normal, only a convex edge can. */
int ellipsoid_facet_may_be_nearest(const ellipsoid_facet *facet,
                                   const ellipsoid_facet_sides *sides,
                                   const double centre[3], double reach,
                                   double margin, double *distance);

static inline int ellipsoid_facet_has_convex_edge(const ellipsoid_facet *facet)
{
    return facet->edge[0] == ELLIPSOID_EDGE_CONVEX
        || facet->edge[1] == ELLIPSOID_EDGE_CONVEX
        || facet->edge[2] == ELLIPSOID_EDGE_CONVEX;
}

/* A minimum at a vertex is found by the facets that have a convex edge there
   and, because of rounding, by those that the point is right above. */
int ellipsoid_facet_owns_vertex(const ellipsoid_facet *facet, int k);

/* Is there no facet across edge k, or one of the edges at vertex k? Such a free
   rim is met from behind the facet, too. */
int ellipsoid_facet_ends_at_edge(const ellipsoid_facet *facet, int k);
int ellipsoid_facet_ends_at_vertex(const ellipsoid_facet *facet, int k);

/* Is the wall at this vertex nowhere nearer to the point? r: vertex to point */
int ellipsoid_facet_is_apex(const ellipsoid_facet *facet, int k,
                            const double r[3], double tolerance);

/* facets[index[k]], k < count, in ascending order */
typedef struct ellipsoid_candidates
{
    const ellipsoid_facet *facets;
    const int *index;
    int count;
    /* If not NULL, the point is no nearer to them than away[k] - moved [m] */
    const float *away;
    double moved;
} ellipsoid_candidates;

/* Lists in the cache the facets within `reach` [m] of the centre x over whose planes
   it is by less than `range` [m], and more; anew if it has moved too far. */
ellipsoid_status
ellipsoid_near_facets(const ellipsoid_surroundings *surroundings,
                      const double x[3], double range, double reach,
                      ellipsoid_facet_cache *cache);

/*
    Makes the cache hold all facets within `horizon` [m] of a bead in this pose
    (facetCache.c); they are searched again only if the cell has moved too far.
    *moved [m] bounds how far beads have moved since. STEP_UNDERFLOW: the walls
    ask for a shorter step, WALLS_FAILED: they gave up.
*/
ellipsoid_status ellipsoid_facet_cache_update(
    ellipsoid_facet_cache *cache, const ellipsoid_model *model,
    const ellipsoid_surroundings *surroundings, const double x[3],
    const double q[4], double horizon, double *moved);

/* Of the list that was looked up last, in the cache's pose; sets the box. */
void ellipsoid_facet_bounds_set(const ellipsoid_model *model,
                                const ellipsoid_facet_list *list,
                                ellipsoid_facet_cache *cache,
                                ellipsoid_facet_bounds *bounds);

/*
    Fills the lists of a cache from facets near its pose and these bounds, for
    gaps of up to horizon [m] and beads that move by up to margin [m]
    (facetSearch.c). 0 if there are too many.
*/
int ellipsoid_facet_search(const ellipsoid_model *model,
                           const ellipsoid_facet_list *list,
                           const ellipsoid_facet_bounds *bounds, double horizon,
                           double margin, ellipsoid_facet_cache *cache);

/* No bead's centre in the cache's pose is nearer to a listed facet than this
   [m], as these bounds and the box tell; at most `most`, and any number up to
   `least` if it is not above that. */
double ellipsoid_facet_bound(const ellipsoid_facet_list *list,
                             const ellipsoid_facet_bounds *bounds, double most,
                             double least, ellipsoid_facet_cache *cache);

/* A change of pose: bead b moves by x + r b. */
typedef struct ellipsoid_pose_change
{
    double x[3], r[3][3];
} ellipsoid_pose_change;

/* From where the cache was filled to the centre x and R(q) = r. */
static inline void ellipsoid_pose_change_set(const ellipsoid_facet_cache *cache,
                                             const double x[3], double r[3][3],
                                             ellipsoid_pose_change *change)
{
    ellipsoid_difference(x, cache->x, change->x);
    for (int i = 0; i < 3; i++)
    {
        ellipsoid_difference(r[i], cache->rotation[i], change->r[i]);
    }
}

/* How far it moves a bead, squared. */
static inline double ellipsoid_squared_move(const ellipsoid_pose_change *change,
                                            const double bead[3])
{
    double sum = 0;

    for (int i = 0; i < 3; i++)
    {
        const double d = change->x[i] + ellipsoid_dot(change->r[i], bead);

        sum += d * d;
    }
    return sum;
}

/* The facets near a point, and the status of the walls callback
   (facetCache.c). */
ellipsoid_status
ellipsoid_list_facets(const ellipsoid_surroundings *surroundings,
                      const double centre[3], double reach,
                      ellipsoid_facet_list *list);

/* How far beyond a surface gaps are measured [m], to walls and to cells: the
   guard against tunnelling counts on it. */
static inline double ellipsoid_gap_horizon(const ellipsoid_model *model)
{
    return model->options.bead_radius;
}

/* ------------------------------------- the ellipsoid against a facet */

/* Variables of derivatives: the centre (lab), and a small rotation (about the
   lab's axes). */
#define ELLIPSOID_SURFACE_VARIABLES 6

/* Where the ellipsoid's distance to the wall has a local minimum. */
typedef struct ellipsoid_surface_contact
{
    int feature;      /* as in ellipsoid_nearest */
    double height;    /* [m] from the wall to the ellipsoid; minus the depth */
    double normal[3]; /* unit, along which that is measured; into the fluid */
    double arm[3];    /* [m] from the contact point on the ellipsoid to its
                         centre */
    double support;   /* [m] arm.normal */
    double edge[3];   /* unit, along the edge; only ON_EDGE */
    int mirror;       /* of the facet; whoever keeps it sets it */

    /* set by ellipsoid_surface_derivatives() */
    double height_slope[ELLIPSOID_SURFACE_VARIABLES];
    double normal_slope[3][ELLIPSOID_SURFACE_VARIABLES];
    double arm_slope[3][ELLIPSOID_SURFACE_VARIABLES];
} ellipsoid_surface_contact;

/* As ellipsoid_facet_nearest(), for the ellipsoid. Returns 2 for a face that is
   deeper than the middle of the body above the contact point, as seen from
   behind. */
int ellipsoid_surface_nearest(const ellipsoid_facet *facet,
                              const ellipsoid_surface *body, double reach,
                              ellipsoid_surface_contact *contact);

void ellipsoid_surface_derivatives(const ellipsoid_surface *body,
                                   ellipsoid_surface_contact *contact);

/* Can the ellipsoid be nearer than reach [m] to any point of the facet? Errs
   towards 1. */
int ellipsoid_surface_may_reach(const ellipsoid_facet *facet,
                                const ellipsoid_surface *body, double reach);

/* Does it cut the facet? (overlap.c) */
int ellipsoid_surface_cuts(const ellipsoid_facet *facet,
                           const ellipsoid_surface *body);

/* As ellipsoid_surface_nearest() for the facet's plane in place of the facet,
   if that is cut; the centre is in front of it. */
int ellipsoid_surface_cut_plane(const ellipsoid_facet *facet,
                                const ellipsoid_surface *body,
                                ellipsoid_surface_contact *contact);

#endif
