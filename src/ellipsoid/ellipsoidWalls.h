/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    ellipsoidWalls.h - walls: facets as the core asks for them, and how they are
    made of triangles. A part of ellipsoid.h: include that.
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
    ELLIPSOID_EDGE_CONVEX, /* the solid protrudes; also a free rim, which is
                              touched from behind the facet, too */
    ELLIPSOID_EDGE_CONCAVE
} ellipsoid_edge;

/* A triangle of the wall. Edge k runs from vertex k to vertex (k+1)%3. */
typedef struct ellipsoid_facet
{
    double middle[3], radius; /* [m] lab, of a ball that holds it */
    double normal[3];         /* unit, into the fluid */
    double vertex[3][3]; /* [m] lab, counter-clockwise seen from the fluid */
    ellipsoid_edge edge[3];
    double edge_inward[3][3]; /* unit, perpendicular to edge k, in the plane of
                                 the facet ACROSS edge k, pointing into it */
    double neighbour_normal[3][3]; /* unit normal of the facet across edge k */
    ptrdiff_t star[3]; /* [bytes] from the facet to double[][3], the unit
                          directions of all wall edges that leave vertex k: no
                          addresses, so that facets may be moved with them */
    int star_count[3];
    int surface; /* label of the wall patch, for reports */
    int mirror;  /* 1: no wall but a plane of symmetry, where a cell meets its
                    own mirror image: the elastic force is a wall's (half the
                    radius, half the modulus, twice the overlap), damping is of
                    twice the speed, and there is neither friction nor adhesion,
                    nor a wall's resistance. docs/theory/contact.md */
    ptrdiff_t plane; /* [bytes] from the facet to double[2][3], a point of the
                        plane that stands for it where walls add to the
                        resistance, and the normal; 0: its own */
    int within;      /* bit k: so it does for the facet across edge k */
} ellipsoid_facet;

/*
    Sets the vertices, and the normal and ball that follow from them; edges lead
    to free rims until they are set, and it is a wall. Returns 0 if the triangle
    has no area.
*/
int ellipsoid_facet_set(ellipsoid_facet *facet, const double vertex[3][3]);

/*
    Makes `other` the facet across edge k if it has that edge the other way
    round and none that was joined there before is met sooner on turning about
    the edge through the fluid. So baffles may be joined with all that meets at
    an edge, in any order. Vertices are one if they are equal to the last bit.
    Returns 1 if it is the one across now.
*/
int ellipsoid_facet_join(ellipsoid_facet *facet, int k,
                         const ellipsoid_facet *other);

/* Facets are named by their index in one array that outlives the cells. */
typedef struct ellipsoid_facet_list
{
    const ellipsoid_facet *facets; /* the whole array */
    const int *index;              /* the candidates, ascending */
    int count;
    double reach; /* [m] >= the reach asked for: no facet outside the list is
                     nearer to the centre than this */
} ellipsoid_facet_list;

/*
    Lists all facets nearer than `reach` [m] to `centre` [m, lab]. The list's
    memory is the callee's and stays valid until its next call. Walls stand
    still: a cache keeps facets from one time t [s] to others, and is to be
    cleared when the facets change. Whether this is called depends on what the
    cache holds, and steps must not: it may refuse by the centre alone, and where
    it does the flow must refuse, too.
    Returns 0; > 0: shorten the step; < 0: give up.
*/
typedef int (*ellipsoid_walls_function)(void *context, double t,
                                        const double centre[3], double reach,
                                        ellipsoid_facet_list *list);

/* ------------------------------------------------ walls from triangles */

/* A surface as triangles. */
typedef struct ellipsoid_triangles
{
    int point_count;
    const double (*point)[3]; /* [m] lab */
    int count;
    const int (*corner)[3]; /* points of a triangle, counter-clockwise seen from
                               the fluid */
    const int *label;       /* of each, for reports; NULL: all 0 */
    const int *mirror;      /* of each, 1: a part of a plane of symmetry, see
                          ellipsoid_facet; NULL: all 0 */
} ellipsoid_triangles;

/* A reflection, a translation, or several of them: x becomes x + A x + b. */
typedef struct ellipsoid_isometry
{
    double A[3][3]; /* [-] the linear part less the unit matrix */
    double b[3];    /* [m] */
} ellipsoid_isometry;

/* A plane of symmetry: a point [m, lab] and the unit normal out of the fluid. */
typedef struct ellipsoid_symmetry_plane
{
    double x[3], n[3];
} ellipsoid_symmetry_plane;

/* How walls are made; all zero: of the triangles as they are. */
typedef struct ellipsoid_walls_options
{
    double same_point;   /* [m] points no farther apart are one, as where each
                          triangle has its own (STL); 0: only those of one
                          index */
    double longest_edge; /* [m] of triangles that come about where the wall is
                            flat and few may stand for many, as long as it stays
                            what it is; 0: none are merged */
    double flat_depth;   /* [m] a part of the wall that is nowhere farther than
                            this from the plane of one of its facets is one
                            plane where walls add to the resistance; 0: only
                            where it is flat */
    /* Where the walls go on beyond planes of symmetry or a period: what takes
       them to their images, the walls themselves (all zero) first */
    int image_count; /* 0: no images */
    const ellipsoid_isometry *image;
    double low[3], high[3]; /* [m] images of triangles beside this box are left
                               out */
    int plane_count;
    const ellipsoid_symmetry_plane *plane; /* no triangle is an image in its own
                                              plane */
} ellipsoid_walls_options;

/* Facets that know their neighbours, and a search tree. Position independent:
   the first ellipsoid_walls_bytes() of its memory may be copied elsewhere, or
   lie in memory that processes share. */
typedef struct ellipsoid_walls ellipsoid_walls;

/* Bytes of memory in which walls are made of these triangles; 0 if an argument
   is not what it should be. */
size_t ellipsoid_walls_size(const ellipsoid_triangles *triangles,
                            const ellipsoid_walls_options *options);

/*
    Makes walls in so much memory, aligned as by malloc(), which they begin:
    *walls is its address. The facets keep the order of the triangles where none
    are merged. BAD_ARGUMENT: a NULL, or too little memory. BAD_TRIANGLE: it has
    no area, or a corner that is no point; *which of them (may be NULL).
*/
ellipsoid_status ellipsoid_walls_create(void *memory, size_t size,
                                        const ellipsoid_triangles *triangles,
                                        const ellipsoid_walls_options *options,
                                        ellipsoid_walls **walls, int *which);

/* Bytes of its memory that walls need once they are made. */
size_t ellipsoid_walls_bytes(const ellipsoid_walls *walls);

/* All facets, and how many. */
const ellipsoid_facet *ellipsoid_walls_facets(const ellipsoid_walls *walls,
                                              int *count);

/* In reaches, how far a search looks as a rule. */
#define ELLIPSOID_FAR_REACHES 1000

/*
    The facets whose boxes come nearer than `reach` [m] to `centre` [m, lab],
    ascending, into index[], at most so many; list->reach is the distance of the
    nearest facet, up to `far` [m], where there are none: a cell that is told of
    so many reaches does not need to ask for a while. Returns how many there are:
    if they are more than there is room for, the list is of no use.
*/
int ellipsoid_walls_search(const ellipsoid_walls *walls, const double centre[3],
                           double reach, double far, int room, int *index,
                           ellipsoid_facet_list *list);

/* Walls as a cell's surroundings have them: its context of
   ellipsoid_walls_list(), one for each thread. */
typedef struct ellipsoid_walls_context
{
    const ellipsoid_walls *walls;
    int room;
    int *index; /* as many as there are facets are always enough */
} ellipsoid_walls_context;

/* An ellipsoid_walls_function; gives up where there is too little room. */
int ellipsoid_walls_list(void *context, double t, const double centre[3],
                         double reach, ellipsoid_facet_list *list);

/* The twelve triangles of the inside of a box [m, lab], and its eight points,
   for ellipsoid_triangles. */
void ellipsoid_box(const double low[3], const double high[3],
                   double point[8][3], int corner[12][3]);

#ifdef __cplusplus
}
#endif

#endif
