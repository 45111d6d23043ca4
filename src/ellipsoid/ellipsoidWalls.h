/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    ellipsoidWalls.h - walls: the facets that the core requests from a callback,
    and functions that make facets from triangles. Programs include ellipsoid.h,
    which includes this header.
*/
#ifndef ELLIPSOID_WALLS_PUBLIC_H
#define ELLIPSOID_WALLS_PUBLIC_H

#include "ellipsoidModel.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* -------------------------------------------------------------- facets */

/* How the wall turns at an edge, seen from the fluid. */
typedef enum ellipsoid_edge
{
    ELLIPSOID_EDGE_FLAT,   /* the neighbour lies in the same plane */
    ELLIPSOID_EDGE_CONVEX, /* the solid protrudes; also a free rim, which can be
                              touched from behind the facet, too */
    ELLIPSOID_EDGE_CONCAVE
} ellipsoid_edge;

/* A triangle of the wall. Edge k runs from vertex k to vertex (k+1)%3. */
typedef struct ellipsoid_facet
{
    double middle[3], radius; /* [m] lab, of a sphere that contains it */
    double normal[3];         /* unit, into the fluid */
    double vertex[3][3]; /* [m] lab, counter-clockwise seen from the fluid */
    double inward[3][3]; /* [m] in its plane, perpendicular to edge k, pointing
                            into it, as long as the edge */
    ellipsoid_edge edge[3];
    double edge_inward[3][3]; /* unit, perpendicular to edge k, in the plane of
                                 the facet ACROSS edge k, pointing into it; zero
                                 at a free rim */
    double neighbour_normal[3][3]; /* unit normal of the facet across edge k */
    ptrdiff_t star[3]; /* [bytes] from the facet to double[][3], the unit
                          directions of all wall edges that leave vertex k; an
                          offset, not an address, so that facets may be moved
                          together with these */
    int star_count[3];
    int surface; /* label of the wall patch, for reports */
    int mirror;  /* 1: a plane of symmetry, not a wall: a cell touches its own
                    mirror image there. The elastic force is that of a wall
                    (half the radius, half the modulus, twice the overlap), the
                    damping that of twice the speed. There is no friction,
                    adhesion or wall resistance. See docs/theory/contact.md */
    ptrdiff_t plane; /* [bytes] from the facet to double[2][3], a point and the
                        normal of the plane that represents the facet in the
                        wall resistance; 0: its own plane */
    int within;      /* bit k is set if this plane also represents the facet
                        across edge k */
} ellipsoid_facet;

/*
    Sets the vertices, and computes the normal and the sphere that contains the
    facet. All edges are free rims until facets are joined, and the facet is a
    wall. Returns 0 if the triangle has no area, else 1.
*/
int ellipsoid_facet_set(ellipsoid_facet *facet, const double vertex[3][3]);

/*
    Makes `other` the facet across edge k if it contains this edge in the
    opposite direction. If another facet was joined there before, the one that
    comes first in a rotation about the edge through the fluid is kept. Where
    baffles meet, all facets at an edge may therefore be joined, in any order.
    Two vertices are the same if they are equal to the last bit. Returns 1 if
    `other` is the facet across the edge now, else 0.
*/
int ellipsoid_facet_join(ellipsoid_facet *facet, int k,
                         const ellipsoid_facet *other);

/* A list of facets, by their indices in one array. The array must exist as long
   as the cells. */
typedef struct ellipsoid_facet_list
{
    const ellipsoid_facet *facets; /* the whole array */
    const int *index;              /* the candidates, ascending */
    int count;
    double reach; /* [m] at least the requested reach: no facet outside the list
                     is nearer to the centre than this */
} ellipsoid_facet_list;

/*
    Lists all facets nearer than `reach` [m] to `centre` [m, lab]. The memory of
    the list belongs to the callback and stays valid until its next call. Walls
    do not move: a cache uses facets that were listed at one time t [s] at other
    times, and has to be cleared when the facets change. Whether the callback is
    called depends on the content of the cache, but the steps must not.
    Therefore its return value may depend on the centre alone, and where it is
    not 0, that of the flow must not be 0 either. Returns 0; > 0: shorten the
    step; < 0: give up.
*/
typedef int (*ellipsoid_walls_function)(void *context, double t,
                                        const double centre[3], double reach,
                                        ellipsoid_facet_list *list);

/* ------------------------------------------------ walls from triangles */

/* A surface that consists of triangles. */
typedef struct ellipsoid_triangles
{
    int point_count;
    const double (*point)[3]; /* [m] lab */
    int count;
    const int (*corner)[3]; /* the points of each triangle, counter-clockwise
                               seen from the fluid */
    const int *label;       /* of each triangle, for reports; NULL: all 0 */
    const int *mirror;      /* of each triangle; 1: it is on a plane of
                               symmetry, see ellipsoid_facet; NULL: all 0 */
} ellipsoid_triangles;

/* A reflection, a translation, or several of them in sequence: it maps x to x +
   A x + b. */
typedef struct ellipsoid_isometry
{
    double A[3][3]; /* [-] the linear part minus the unit matrix */
    double b[3];    /* [m] */
} ellipsoid_isometry;

/* A plane of symmetry: a point [m, lab] and the unit normal out of the
   fluid. */
typedef struct ellipsoid_symmetry_plane
{
    double x[3], n[3];
} ellipsoid_symmetry_plane;

/* How walls are made. If all members are zero, the facets are the triangles as
   they are. */
typedef struct ellipsoid_walls_options
{
    double same_point;   /* [m] points that are no farther apart than this are
                            the same point, as in an STL file, where each
                            triangle has its own points; 0: only points of one
                            index are the same */
    double longest_edge; /* [m] longest edge of triangles that result from
                            merging where the wall is flat, which does not
                            change the surface; 0: none are merged */
    double flat_depth;   /* [m] in the wall resistance, a part of the wall is
                            one plane if it is nowhere farther than this from
                            the plane of one of its facets; 0: only where it is
                            flat */
    /* If the walls continue beyond planes of symmetry or periods: the
       isometries that map the walls to their images. The first one is the
       identity (all zero), for the walls themselves */
    int image_count; /* 0: no images */
    const ellipsoid_isometry *image;
    double low[3], high[3]; /* [m] images of triangles outside this box are left
                               out */
    int plane_count;
    const ellipsoid_symmetry_plane *plane; /* a triangle that lies in one of
                                              these planes has no image in it */
} ellipsoid_walls_options;

/* Facets with their neighbours, and a search tree. They contain no addresses:
   the first ellipsoid_walls_bytes() of their memory may be copied elsewhere, or
   be in memory that processes share. */
typedef struct ellipsoid_walls ellipsoid_walls;

/* Bytes of memory that are needed to make walls from these triangles; 0 if an
   argument is not valid. */
size_t ellipsoid_walls_size(const ellipsoid_triangles *triangles,
                            const ellipsoid_walls_options *options);

/*
    Makes walls in `memory` of `size` bytes, aligned as by malloc(). The walls
    are at the beginning of this memory, and *walls is set to its address. If no
    triangles are merged, the facets are in the order of the triangles.
    BAD_ARGUMENT: a pointer is NULL, or there is too little memory.
    BAD_TRIANGLE: a triangle has no area, or a corner that is not the index of a
    point; *which is set to its index. `which` may be NULL.
*/
ellipsoid_status ellipsoid_walls_create(void *memory, size_t size,
                                        const ellipsoid_triangles *triangles,
                                        const ellipsoid_walls_options *options,
                                        ellipsoid_walls **walls, int *which);

/* Bytes of their memory that walls need once they are made. */
size_t ellipsoid_walls_bytes(const ellipsoid_walls *walls);

/* All facets; *count is set to their number. */
const ellipsoid_facet *ellipsoid_walls_facets(const ellipsoid_walls *walls,
                                              int *count);

/* The usual value of `far` in a search, in units of the reach. */
#define ELLIPSOID_FAR_REACHES 1000

/*
    Writes the facets whose boxes are nearer than `reach` [m] to `centre` [m,
    lab], or farther by what single precision takes, 1e-5 of the size of the
    walls, into index[], ascending, at most `room` of them. If there are none,
    list->reach is set to the distance of the nearest facet, at most `far` [m];
    a cell needs no other search until it has moved that far. Returns the number
    of these facets. If this is larger than `room`, the list must not be used.
*/
int ellipsoid_walls_search(const ellipsoid_walls *walls, const double centre[3],
                           double reach, double far, int room, int *index,
                           ellipsoid_facet_list *list);

/* The walls_context of a cell's surroundings if their callback is
   ellipsoid_walls_list(). Each thread needs its own. */
typedef struct ellipsoid_walls_context
{
    const ellipsoid_walls *walls;
    int room;
    int *index; /* `room` numbers; as many as there are facets are always
                   enough */
} ellipsoid_walls_context;

/* An ellipsoid_walls_function; gives up if there is too little room. */
int ellipsoid_walls_list(void *context, double t, const double centre[3],
                         double reach, ellipsoid_facet_list *list);

/* Sets the eight points of a box [m, lab] and the twelve triangles of its inner
   surface, for ellipsoid_triangles. */
void ellipsoid_box(const double low[3], const double high[3],
                   double point[8][3], int corner[12][3]);

#ifdef __cplusplus
}
#endif

#endif
