/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    world.h - the room that knows many cells: which may meet, and which are
    advanced together. It depends on motion and what is below.
*/
#ifndef ELLIPSOID_WORLD_H
#define ELLIPSOID_WORLD_H

#include "body/arena.h"
#include "body/body.h"

/* Puts another sweep before this, which began where that ended. */
void ellipsoid_sweep_prepend(ellipsoid_sweep *sweep,
                             const ellipsoid_sweep *first);

/* Some of the cells of a world, and what they are looked at for. */
typedef struct ellipsoid_near_query
{
    const ellipsoid_world_cells *cells;
    const int *index; /* ascending, of cells */
    int count;
    const int *group; /* of each: those of one group are no pair */
    double margin;    /* [m] */
} ellipsoid_near_query;

/* Takes two of them, by their places in the query, and their gap [m] at the
   start. */
typedef void (*ellipsoid_near_visitor)(void *context, int a, int b, double gap);

/* Bytes for a query of so many. */
size_t ellipsoid_near_size(int count, int repeat_count);

/*
    All pairs that may have been as near to one another as the margin, in any
    order, two cells more than once if several of their images have
    (nearCells.c). 0 if there is too little memory.
*/
int ellipsoid_near_cells(const ellipsoid_near_query *query,
                         ellipsoid_arena memory, ellipsoid_near_visitor visitor,
                         void *context);

static inline void *ellipsoid_world_at(const ellipsoid_world_cells *cells,
                                       int index)
{
    return (char *)cells->cell + (size_t)index * cells->size;
}

static inline ellipsoid_cell_view
ellipsoid_world_look(const ellipsoid_world_cells *cells, int index)
{
    ellipsoid_cell_view view;

    memset(&view, 0, sizeof view);
    cells->look(cells->context, ellipsoid_world_at(cells, index), &view);
    return view;
}

/* Some of the cells over a part of an interval, and their groups. What it
   points to is of the cells' places in it, or of groups, which are no more. */
typedef struct ellipsoid_span
{
    double start, end; /* [s] */
    int halvings;
    const int *index; /* of the cells, ascending */
    int count;
    char *before; /* the cells at the start */
    int *group;   /* of a cell, or -1 */
    int *next;    /* cell of its group, ascending; or -1 */
    int groups;
    int *first;       /* cell of a group; -1: empty */
    int *in_parts;    /* is the time to be halved for it? */
    int *is_old;      /* was it advanced before? */
    double *travel;   /* [m] longest of its cells that may have met others */
    int *todo, todos; /* groups to be advanced, ascending */
} ellipsoid_span;

struct ellipsoid_world
{
    const ellipsoid_world_cells *cells;
    ellipsoid_arena rest;
    ellipsoid_span top;
};

/* How often an interval is halved at most. */
#define ELLIPSOID_MOST_HALVINGS 8

/* The groups at the start of a span of which the cells are set; cells that wait
   or have gone are in none (groups.c). 0: too little memory. */
int ellipsoid_groups_form(ellipsoid_world *world, ellipsoid_span *s);

/* Joins groups that may have met: each goes into the lowest that it hangs
   together with, and is left empty. 0: too little memory. */
int ellipsoid_groups_join(ellipsoid_world *world, ellipsoid_span *s);

#endif
