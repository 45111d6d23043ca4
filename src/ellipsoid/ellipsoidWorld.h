/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    ellipsoidWorld.h - a world of cells that push one another: which of them are
    advanced together, and over which time. A part of ellipsoid.h: include that.

    Over an interval each group of cells that are near one another at its start
    is advanced as if the others were not there. Groups of which cells can have
    met are joined and advanced again: over both halves of the interval, at
    whose middle groups are formed anew, and so on, until they have parted or
    move so little that they are advanced as one system. The result is a
    function of the cells alone; one that meets no other moves as if it were the
    only one, to the last bit. See docs/theory/manyCells.md.
*/
#ifndef ELLIPSOID_WORLD_PUBLIC_H
#define ELLIPSOID_WORLD_PUBLIC_H

#include "ellipsoid.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------- sweeps */

/* What a cell has done over a span of time. */
typedef struct ellipsoid_sweep
{
    ellipsoid_state start;  /* at the beginning */
    double low[3], high[3]; /* [m] lab, of the box that the centre has swept,
                               from the beginning on in one piece */
    double passed[3];       /* [m] takes a position to there, where the cell has
                               been put a period back since; whoever puts it back
                               adds to this */
    double travel;          /* [m] no point of the cell has been farther from
                               where it began */
} ellipsoid_sweep;

/* Begins where a cell is. */
void ellipsoid_sweep_begin(ellipsoid_sweep *sweep,
                           const ellipsoid_state *state);

/* Adds a pose on the way of a cell of this model. */
void ellipsoid_sweep_add(ellipsoid_sweep *sweep, const ellipsoid_model *model,
                         const ellipsoid_state *state);

/* Adds an accepted step: its path bends between the ends, and is looked at four
   times. */
void ellipsoid_sweep_add_step(ellipsoid_sweep *sweep,
                              const ellipsoid_model *model,
                              const ellipsoid_step *step);

/* ----------------------------------------------------------------- world */

typedef enum ellipsoid_phase
{
    ELLIPSOID_PRESENT,
    ELLIPSOID_WAITING, /* enters at its time, if there is room for it then */
    ELLIPSOID_GONE
} ellipsoid_phase;

/* What the world looks at of a cell; all zero when it is asked for. A cell that
   waits enters from the start of an interval on: one that found no room is to be
   given another time. */
typedef struct ellipsoid_cell_view
{
    const ellipsoid_model *model;
    const ellipsoid_state *state;
    ellipsoid_phase phase;
    double time; /* [s] of the state; of one that waits, when it enters */
    int fixed;   /* does it keep its pose? Two such never meet */
} ellipsoid_cell_view;

/*
    The cells of a world, and what it has done with them. A cell is plain data
    of the caller's, of any size, that begins with its ellipsoid_sweep; the world
    copies it to begin again. For cells of the core's own see
    ellipsoid_world_body.
*/
typedef struct ellipsoid_world_cells
{
    int count;
    void *cell;  /* the first of them */
    size_t size; /* [bytes] of one */
    void *context;
    void (*look)(void *context, const void *cell, ellipsoid_cell_view *view);

    /* Advances cells that begin at one time to `end` [s] as one group, adding to
       their sweeps; those that wait enter. Returns 1; 0 if the group cannot and
       may fail: the cells may be anywhere then, and less is asked for; < 0 to
       give up. */
    int (*advance)(void *context, int count, const int index[], double end,
                   int may_fail);

    /* Cells were put back to where they were at the time [s]: what was seen of
       them since does not stand. May be NULL. */
    void (*put_back)(void *context, int count, const int index[], double time);

    int pushing;   /* are there forces between cells? */
    double length; /* [m] to compare with: the bead radius of a usual cell */
    const double (*repeat)[3]; /* as in ellipsoid_surroundings; */
    int repeat_count;          /* 0 */
} ellipsoid_world_cells;

typedef struct ellipsoid_world ellipsoid_world;

/* Bytes of memory for a world of so many cells of a size [bytes]. Those that
   enter at many different times within one interval may need more. */
size_t ellipsoid_world_size(int count, size_t cell_size, int repeat_count);

/*
    Begins an interval [s]: the world, in so much memory aligned as by malloc(),
    with the groups at the start. *cells and what it points to outlive it.
    TOO_MANY_CELLS: for the memory.
*/
ellipsoid_status ellipsoid_world_begin(void *memory, size_t size,
                                       const ellipsoid_world_cells *cells,
                                       double start, double end,
                                       ellipsoid_world **world);

/* Groups are numbered from 0; those that were joined to others are empty. */
int ellipsoid_world_group_count(const ellipsoid_world *world);

/* The cells of a group, ascending, into index[] unless that is NULL; returns
   how many. */
int ellipsoid_world_group(const ellipsoid_world *world, int group, int *index);

/* The groups that are to be advanced, ascending; returns how many. None: the
   interval is over. */
int ellipsoid_world_todo(const ellipsoid_world *world, const int **group);

/* A cell as it was at the start of the interval. */
const void *ellipsoid_world_before(const ellipsoid_world *world, int index);

/*
    Advances a group over the interval. Groups do not know of one another: they
    may be advanced in any order, or in several copies of the world, of which
    each is then told of the others' cells. TOO_MANY_CELLS: the memory does not
    do; the cells are as they were, more may be given by
    ellipsoid_world_extend(). STOPPED: advance() gave up.
*/
ellipsoid_status ellipsoid_world_advance_group(ellipsoid_world *world,
                                               int group);

/* More memory instead of what is left, for groups within groups. */
void ellipsoid_world_extend(ellipsoid_world *world, void *memory, size_t size);

/* When all groups that are to be advanced have been: joins those that may have
   met, which are to be advanced then. */
ellipsoid_status ellipsoid_world_join(ellipsoid_world *world);

/* All of these for an interval [s]. Of a cell that cannot go on the view says
   so; the others go on, and the status is OK. */
ellipsoid_status ellipsoid_world_advance(void *memory, size_t size,
                                         const ellipsoid_world_cells *cells,
                                         double start, double end);

/* ------------------------------------------------- cells of the core's own */

/* A cell for a program that has no type of its own. */
typedef struct ellipsoid_world_body
{
    ellipsoid_sweep sweep;
    ellipsoid_state state;
    ellipsoid_controller controller;
    ellipsoid_phase phase; /* GONE: its observer stopped it, or the core cannot
                              go on with it */
    double time;           /* [s] see ellipsoid_cell_view */
    ellipsoid_status status;   /* why it is gone */
    ellipsoid_contact contact; /* at the end */
    const ellipsoid_model *model;
    const ellipsoid_surroundings *surroundings; /* its id names the cell */
    ellipsoid_facet_cache *cache;
    ellipsoid_observer observer; /* of its accepted steps; NULL: nobody.
                                    put_back() tells which do not stand */
    void *observer_context;
} ellipsoid_world_body;

/* All of them, and what advances them. */
typedef struct ellipsoid_world_bodies
{
    int count;
    ellipsoid_world_body *body;
    int largest;                     /* cells in a group at most */
    ellipsoid_member *member;        /* room for so many */
    void *memory;                    /* ellipsoid_group_size(largest) bytes */
    ellipsoid_statistics statistics; /* also of steps that do not stand */
} ellipsoid_world_bodies;

/* Such bodies as cells of a world; put_back and repeat are the caller's to
   add. */
void ellipsoid_world_cells_set(ellipsoid_world_cells *cells,
                               ellipsoid_world_bodies *bodies);

#ifdef __cplusplus
}
#endif

#endif
