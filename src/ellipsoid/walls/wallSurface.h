/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    wallSurface.h - what the makers of walls share: a surface that is changed on
    the way from triangles to facets, and the memory for it.
*/
#ifndef ELLIPSOID_WALL_SURFACE_H
#define ELLIPSOID_WALL_SURFACE_H

#include "body/arena.h"
#include "walls/walls.h"

typedef struct ellipsoid_wall_surface
{
    int point_count, count;
    double (*point)[3];
    int (*corner)[3];
    int *label;
    int *source; /* which of the given triangles it was */
} ellipsoid_wall_surface;

/* Bytes of a surface of so many points and triangles; takes them. */
size_t ellipsoid_wall_surface_size(size_t points, size_t triangles);
int ellipsoid_wall_surface_take(ellipsoid_arena *arena, size_t points,
                                size_t triangles,
                                ellipsoid_wall_surface *surface);

/* ------------------------------------------------------- wallImages.c */

/* At most so many points and triangles come of the given ones. */
void ellipsoid_images_count(const ellipsoid_triangles *triangles,
                            const ellipsoid_walls_options *options,
                            size_t *points, size_t *count);

/* Fills an empty surface with the triangles that are, or are not, parts of
   planes of symmetry, and their images. */
void ellipsoid_images_set(const ellipsoid_triangles *triangles,
                          const ellipsoid_walls_options *options, int mirror,
                          ellipsoid_arena scratch,
                          ellipsoid_wall_surface *surface);

size_t ellipsoid_images_scratch(size_t points, size_t given_points);

/* -------------------------------------------------------- flatMerging.c */

size_t ellipsoid_flat_merging_scratch(size_t points, size_t triangles);

/* Takes points out where the surface is flat. */
void ellipsoid_flat_merge(double longest_edge, ellipsoid_arena scratch,
                          ellipsoid_wall_surface *surface);

/* ---------------------------------------------------------- flatParts.c */

/* Bytes of planes, at most. */
size_t ellipsoid_flat_parts_size(size_t triangles);
size_t ellipsoid_flat_parts_scratch(size_t triangles);

/* Sets plane and within of facets, and planes[], as many as it returns; across:
   which facet each edge of each leads to, -1: none. */
int ellipsoid_flat_parts_set(double depth, const int (*across)[3], int count,
                             ellipsoid_arena scratch, ellipsoid_facet *facets,
                             double (*planes)[2][3]);

/* ---------------------------------------------------------- facetTree.c */

#define ELLIPSOID_TREE_FAN 8     /* boxes in a node */
#define ELLIPSOID_TREE_LEVELS 11 /* for as many facets as an int counts */

/* Boxes from the middle of all, by the tree's size; one array for each of their
   numbers so that loops vectorise, in single precision and so much wider. */
typedef struct ellipsoid_tree_node
{
    float middle[3][ELLIPSOID_TREE_FAN], half[3][ELLIPSOID_TREE_FAN];
} ellipsoid_tree_node;

/* Boxes about boxes about facets, as offsets [bytes] from itself. */
typedef struct ellipsoid_facet_tree
{
    int count, levels;
    int first[ELLIPSOID_TREE_LEVELS]; /* node of a level; level 0: of facets */
    double middle[3], size; /* [m] of the box about all; half its longest */
    ptrdiff_t order, node;  /* the facet of each box of level 0; nodes */
} ellipsoid_facet_tree;

size_t ellipsoid_facet_tree_size(size_t count);
size_t ellipsoid_facet_tree_scratch(size_t count);
void ellipsoid_facet_tree_set(ellipsoid_facet_tree *tree,
                              const ellipsoid_facet *facets, int count,
                              ellipsoid_arena *arena, ellipsoid_arena scratch);

/* As ellipsoid_walls_search(), but for the nearest one. */
int ellipsoid_facet_tree_list(const ellipsoid_facet_tree *tree,
                              const double centre[3], double reach, int room,
                              int *index);

/* The distance [m] of the nearest facet if it is below `far`, or that. */
double ellipsoid_facet_tree_distance(const ellipsoid_facet_tree *tree,
                                     const ellipsoid_facet *facets,
                                     const double centre[3], double far);

#endif
