/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    ellipsoidWorld.h - a world of cells in contact with one another: which of
    them are advanced together, and over which time. Programs include
    ellipsoid.h, which includes this header.

    Cells that are near one another at the start of an interval form a group.
    Each group is advanced over the interval as if there were no others. Groups
    whose cells may have met are joined and advanced again, over each half of
    the interval, with new groups at its middle. The halving is repeated until
    the cells have separated, or move so little that they are advanced as one
    system. The result is a function of the cells alone. A cell that meets no
    other moves as if it were the only one, to the last bit. See
    docs/theory/manyCells.md.
*/
#ifndef ELLIPSOID_WORLD_PUBLIC_H
#define ELLIPSOID_WORLD_PUBLIC_H

#include "ellipsoid.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------- sweeps */

/* The space that a cell has covered over a span of time. */
typedef struct ellipsoid_sweep
{
    ellipsoid_state start;  /* at the beginning */
    double low[3], high[3]; /* [m] lab, of the box that contains the path of the
                               centre, without the jumps at periodic patches */
    double passed[3];       /* [m] position on this path minus position of the
                               cell; a caller that puts the cell back by a
                               period adds that period */
    double travel;          /* [m] no point of the cell has been farther than
                               this from where it was at the beginning */
} ellipsoid_sweep;

/* Begins a sweep at the state of a cell. */
void ellipsoid_sweep_begin(ellipsoid_sweep *sweep,
                           const ellipsoid_state *state);

/* Adds a pose on the path of a cell of this model. */
void ellipsoid_sweep_add(ellipsoid_sweep *sweep, const ellipsoid_model *model,
                         const ellipsoid_state *state);

/* Adds an accepted step. As its path is curved, four poses are added. */
void ellipsoid_sweep_add_step(ellipsoid_sweep *sweep,
                              const ellipsoid_model *model,
                              const ellipsoid_step *step);

/* ----------------------------------------------------------------- world */

typedef enum ellipsoid_phase
{
    ELLIPSOID_PRESENT,
    ELLIPSOID_WAITING, /* enters at its time if there is room for it then */
    ELLIPSOID_GONE
} ellipsoid_phase;

/* What the world needs to know of a cell; all zero when the callback is called.
   A waiting cell can enter from the start of an interval on. If it found no
   room, the caller has to set another time. */
typedef struct ellipsoid_cell_view
{
    const ellipsoid_model *model;
    const ellipsoid_state *state;
    ellipsoid_phase phase;
    double time; /* [s] of the state; for a waiting cell the time of entry */
    int fixed;   /* 1: it keeps its pose; two such cells never meet */
} ellipsoid_cell_view;

/*
    The cells of a world, and the callbacks for them. A cell is plain data of
    the caller, of any size, that begins with an ellipsoid_sweep. The world
    copies cells in order to put them back when they are advanced again. For a
    cell type of the core see ellipsoid_world_body.
*/
typedef struct ellipsoid_world_cells
{
    int count;
    void *cell;  /* the first cell */
    size_t size; /* [bytes] of one cell */
    void *context;
    void (*look)(void *context, const void *cell, ellipsoid_cell_view *view);

    /* Advances cells that begin at one time to `end` [s] as one group, and adds
       to their sweeps; waiting cells enter. Returns 1 on success; 0 if the
       group could not be advanced and may_fail is set; < 0 to give up. After 0
       the cells may be in any state: the world puts them back, and requests a
       shorter time. */
    int (*advance)(void *context, int count, const int index[], double end,
                   int may_fail);

    /* Called when cells were put back to their state at the time [s]: what was
       observed of them since then is no longer valid. May be NULL. */
    void (*put_back)(void *context, int count, const int index[], double time);

    int pushing;   /* 1: there are forces between cells */
    double length; /* [m] scale of gaps: the bead radius of a usual cell */
    const double (*repeat)[3]; /* as in ellipsoid_surroundings */
    int repeat_count;          /* how many */
} ellipsoid_world_cells;

typedef struct ellipsoid_world ellipsoid_world;

/* Bytes of memory for a world of `count` cells of `cell_size` bytes. If cells
   enter at many different times within one interval, it may need more. */
size_t ellipsoid_world_size(int count, size_t cell_size, int repeat_count);

/*
    Begins an interval [s]: makes the world, in `memory` of `size` bytes,
    aligned as by malloc(), and forms the groups at the start. *cells and what
    it points to must exist as long as the world. TOO_MANY_CELLS: there is too
    little memory.
*/
ellipsoid_status ellipsoid_world_begin(void *memory, size_t size,
                                       const ellipsoid_world_cells *cells,
                                       double start, double end,
                                       ellipsoid_world **world);

/* The number of groups. They are numbered from 0; those that were joined to
   others are empty. */
int ellipsoid_world_group_count(const ellipsoid_world *world);

/* Writes the cells of a group, ascending, into index[] unless that is NULL.
   Returns their number. */
int ellipsoid_world_group(const ellipsoid_world *world, int group, int *index);

/* Sets *group to the groups that have to be advanced, ascending. Returns their
   number; if it is 0, the interval is finished. */
int ellipsoid_world_todo(const ellipsoid_world *world, const int **group);

/* A cell as it was at the start of the interval. */
const void *ellipsoid_world_before(const ellipsoid_world *world, int index);

/*
    Advances a group over the interval. Groups are independent of one another:
    they may be advanced in any order, or in several copies of the world, if
    each copy then receives the cells that the others have advanced.
    TOO_MANY_CELLS: there is too little memory; the cells are unchanged, and
    ellipsoid_world_extend() gives more memory. STOPPED: advance() gave up.
*/
ellipsoid_status ellipsoid_world_advance_group(ellipsoid_world *world,
                                               int group);

/* Replaces the rest of the memory by this memory, for groups within groups. */
void ellipsoid_world_extend(ellipsoid_world *world, void *memory, size_t size);

/* To be called when all groups of ellipsoid_world_todo() are advanced: joins
   those that may have met, which then have to be advanced again. */
ellipsoid_status ellipsoid_world_join(ellipsoid_world *world);

/* Carries out all of this for an interval [s]. If a cell cannot be advanced
   further, its view has to report that it is GONE; the others are advanced, and
   the status is OK. */
ellipsoid_status ellipsoid_world_advance(void *memory, size_t size,
                                         const ellipsoid_world_cells *cells,
                                         double start, double end);

/* ------------------------------------------------- a cell type of the core */

/* A cell for a program that has no cell type of its own. */
typedef struct ellipsoid_world_body
{
    ellipsoid_sweep sweep;
    ellipsoid_state state;
    ellipsoid_controller controller;
    ellipsoid_phase phase; /* GONE: its observer stopped it, or the core cannot
                              advance it */
    double time;           /* [s] see ellipsoid_cell_view */
    ellipsoid_status status;   /* why it is gone */
    ellipsoid_contact contact; /* at the end */
    const ellipsoid_model *model;
    const ellipsoid_surroundings *surroundings; /* its id names the cell */
    ellipsoid_facet_cache *cache;
    ellipsoid_observer observer; /* called after its accepted steps; may be
                                    NULL. put_back() reports which are no longer
                                    valid */
    void *observer_context;
} ellipsoid_world_body;

/* All bodies, and what is needed to advance them. */
typedef struct ellipsoid_world_bodies
{
    int count;
    ellipsoid_world_body *body;
    int largest;                     /* maximum number of cells in a group */
    ellipsoid_member *member;        /* room for `largest` members */
    void *memory;                    /* ellipsoid_group_size(largest) bytes */
    ellipsoid_statistics statistics; /* includes steps that were repeated */
} ellipsoid_world_bodies;

/* Sets the cells of a world to these bodies. put_back and repeat may be set
   afterwards. */
void ellipsoid_world_cells_set(ellipsoid_world_cells *cells,
                               ellipsoid_world_bodies *bodies);

#ifdef __cplusplus
}
#endif

#endif
