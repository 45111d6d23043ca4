/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    world.c - groups of cells over an interval: formed at its start, advanced as
    if alone, joined where they may have met, and then advanced in parts.
*/
#include "world/world.h"

#include <math.h>

/* Frames that ellipsoid_world_size() has memory for: one for each halving, and
   some for cells that enter. */
#define FRAMES 12

static size_t span_size(size_t count, size_t cell_size)
{
    return ellipsoid_piece(count, cell_size)
         + 6 * ellipsoid_piece(count, sizeof(int))
         + ellipsoid_piece(count, sizeof(double));
}

static int span_take(ellipsoid_arena *arena, size_t cell_size, int count,
                     ellipsoid_span *s)
{
    s->before = ellipsoid_take(arena, count, cell_size);
    s->group = ellipsoid_take(arena, count, sizeof(int));
    s->next = ellipsoid_take(arena, count, sizeof(int));
    s->first = ellipsoid_take(arena, count, sizeof(int));
    s->in_parts = ellipsoid_take(arena, count, sizeof(int));
    s->is_old = ellipsoid_take(arena, count, sizeof(int));
    s->todo = ellipsoid_take(arena, count, sizeof(int));
    s->travel = ellipsoid_take(arena, count, sizeof(double));
    return s->before && s->group && s->next && s->first && s->in_parts
        && s->is_old && s->todo && s->travel;
}

size_t ellipsoid_world_size(int count, size_t cell_size, int repeat_count)
{
    const size_t n = count > 0 ? count : 0;

    /* besides: the cells of a group and their sweeps, for each frame; the roots
       of groups, and pairs of cells that enter at once */
    return ellipsoid_piece(1, sizeof(ellipsoid_world))
         + FRAMES
               * (span_size(n, cell_size) + ellipsoid_piece(n, sizeof(int))
                  + ellipsoid_piece(n, sizeof(ellipsoid_sweep)))
         + 4 * ellipsoid_piece(n, sizeof(int))
         + ellipsoid_piece(8 * n, sizeof(ellipsoid_sort_key))
         + ellipsoid_near_size(count, repeat_count);
}

/* Begins a span at cells as they are. */
static int begin(ellipsoid_world *world, ellipsoid_span *s)
{
    const ellipsoid_world_cells *cells = world->cells;

    if (!span_take(&world->rest, cells->size, s->count, s))
    {
        return 0;
    }
    for (int k = 0; k < s->count; k++)
    {
        void *cell = ellipsoid_world_at(cells, s->index[k]);

        ellipsoid_sweep_begin(cell,
                              ellipsoid_world_look(cells, s->index[k]).state);
        memcpy(s->before + k * cells->size, cell, cells->size);
    }
    return ellipsoid_groups_form(world, s);
}

/* --------------------------------------------------------------- advance */

/* The indices of the cells of a group unless index is NULL; returns how many. */
static int list_group(const ellipsoid_span *s, int group, int *index)
{
    int count = 0;

    for (int k = s->first[group]; k >= 0; k = s->next[k])
    {
        if (index)
        {
            index[count] = s->index[k];
        }
        count++;
    }
    return count;
}

/* The cells of a group in memory of its own; NULL if there is too little */
static int *take_group(ellipsoid_world *world, const ellipsoid_span *s,
                       int group, int *count)
{
    int *index;

    *count = list_group(s, group, NULL);
    index = ellipsoid_take(&world->rest, *count, sizeof(int));
    if (index)
    {
        list_group(s, group, index);
    }
    return index;
}

/* index NULL: not reported. */
static void put_back(ellipsoid_world *world, const ellipsoid_span *s, int group,
                     const int *index, int count)
{
    const ellipsoid_world_cells *cells = world->cells;

    for (int k = s->first[group]; k >= 0; k = s->next[k])
    {
        memcpy(ellipsoid_world_at(cells, s->index[k]),
               s->before + k * cells->size, cells->size);
    }
    if (cells->put_back && index)
    {
        cells->put_back(cells->context, count, index, s->start);
    }
}

static ellipsoid_status advance_span(ellipsoid_world *world, ellipsoid_span *s);

/* Cells over two parts of the time of a span, one after the other. */
static ellipsoid_status advance_parts(ellipsoid_world *world,
                                      const ellipsoid_span *whole,
                                      const int *index, int count,
                                      double middle, int halvings)
{
    const ellipsoid_world_cells *cells = world->cells;
    ellipsoid_sweep *first = ellipsoid_take(&world->rest, count, sizeof *first);
    ellipsoid_span part = {.start = whole->start,
                           .end = middle,
                           .halvings = halvings,
                           .index = index,
                           .count = count};
    ellipsoid_status status =
        first ? advance_span(world, &part) : ELLIPSOID_TOO_MANY_CELLS;

    if (status != ELLIPSOID_OK)
    {
        return status;
    }
    for (int n = 0; n < count; n++)
    {
        first[n] = *(ellipsoid_sweep *)ellipsoid_world_at(cells, index[n]);
    }
    part = (ellipsoid_span){.start = middle,
                            .end = whole->end,
                            .halvings = halvings,
                            .index = index,
                            .count = count};
    status = advance_span(world, &part);
    for (int n = 0; n < count && status == ELLIPSOID_OK; n++)
    {
        ellipsoid_sweep_prepend(ellipsoid_world_at(cells, index[n]), &first[n]);
    }
    return status;
}

/* When the first cell that waits enters, of a group of several; HUGE_VAL if
   none does within the time: a group in parts is cut there. */
static double first_entry(const ellipsoid_world *world, const ellipsoid_span *s,
                          const int *index, int count)
{
    double entry = HUGE_VAL;

    for (int n = 0; n < count && count > 1; n++)
    {
        const ellipsoid_cell_view view =
            ellipsoid_world_look(world->cells, index[n]);

        if (view.phase == ELLIPSOID_WAITING && view.time > s->start
            && view.time < s->end)
        {
            entry = fmin(entry, view.time);
        }
    }
    return entry;
}

static ellipsoid_status advance_group(ellipsoid_world *world, ellipsoid_span *s,
                                      int group)
{
    const ellipsoid_world_cells *cells = world->cells;
    int count;
    int *index = take_group(world, s, group, &count);
    double entry;

    if (!index)
    {
        return ELLIPSOID_TOO_MANY_CELLS;
    }
    if (s->is_old[group])
    {
        put_back(world, s, group, index, count);
    }
    s->is_old[group] = 1;
    entry = first_entry(world, s, index, count);
    if (entry < s->end)
    {
        return advance_parts(world, s, index, count, entry, s->halvings);
    }
    if (!s->in_parts[group])
    {
        const int done = cells->advance(cells->context, count, index, s->end,
                                        s->halvings < ELLIPSOID_MOST_HALVINGS);

        if (done != 0)
        {
            return done > 0 ? ELLIPSOID_OK : ELLIPSOID_STOPPED;
        }
        put_back(world, s, group, index, count);
    }
    return advance_parts(world, s, index, count, 0.5 * (s->start + s->end),
                         s->halvings + 1);
}

/* From forming groups to the end. */
static ellipsoid_status advance_span(ellipsoid_world *world, ellipsoid_span *s)
{
    const ellipsoid_arena mark = world->rest;
    ellipsoid_status status =
        begin(world, s) ? ELLIPSOID_OK : ELLIPSOID_TOO_MANY_CELLS;

    while (status == ELLIPSOID_OK && s->todos > 0)
    {
        for (int n = 0; n < s->todos && status == ELLIPSOID_OK; n++)
        {
            const ellipsoid_arena rest = world->rest;

            status = advance_group(world, s, s->todo[n]);
            world->rest = rest;
        }
        if (status == ELLIPSOID_OK && !ellipsoid_groups_join(world, s))
        {
            status = ELLIPSOID_TOO_MANY_CELLS;
        }
    }
    world->rest = mark;
    return status;
}

/* --------------------------------------------------------------- public */

ellipsoid_status ellipsoid_world_begin(void *memory, size_t size,
                                       const ellipsoid_world_cells *cells,
                                       double start, double end,
                                       ellipsoid_world **world)
{
    ellipsoid_arena arena = {memory, size};
    ellipsoid_world *made;
    int *index;

    if (!memory || !world || !cells || !cells->look || !cells->advance
        || cells->count < 0 || (cells->count > 0 && !cells->cell)
        || cells->size < sizeof(ellipsoid_sweep)
        || (cells->repeat_count > 0 && !cells->repeat))
    {
        return ELLIPSOID_BAD_ARGUMENT;
    }
    made = ellipsoid_take(&arena, 1, sizeof *made);
    index = ellipsoid_take(&arena, cells->count, sizeof *index);
    if (!made || !index)
    {
        return ELLIPSOID_TOO_MANY_CELLS;
    }
    for (int n = 0; n < cells->count; n++)
    {
        index[n] = n;
    }
    *made = (ellipsoid_world){
        .cells = cells,
        .rest = arena,
        .top = {
            .start = start, .end = end, .index = index, .count = cells->count}};
    if (!begin(made, &made->top))
    {
        return ELLIPSOID_TOO_MANY_CELLS;
    }
    *world = made;
    return ELLIPSOID_OK;
}

int ellipsoid_world_group_count(const ellipsoid_world *world)
{
    return world->top.groups;
}

int ellipsoid_world_group(const ellipsoid_world *world, int group, int *index)
{
    return list_group(&world->top, group, index);
}

int ellipsoid_world_todo(const ellipsoid_world *world, const int **group)
{
    *group = world->top.todo;
    return world->top.todos;
}

const void *ellipsoid_world_before(const ellipsoid_world *world, int index)
{
    return world->top.before + (size_t)index * world->cells->size;
}

ellipsoid_status ellipsoid_world_advance_group(ellipsoid_world *world,
                                               int group)
{
    const ellipsoid_arena rest = world->rest;
    const ellipsoid_status status = advance_group(world, &world->top, group);

    world->rest = rest;
    if (status != ELLIPSOID_OK)
    {
        int count, *index = take_group(world, &world->top, group, &count);

        put_back(world, &world->top, group, index, count);
        world->rest = rest;
    }
    return status;
}

void ellipsoid_world_extend(ellipsoid_world *world, void *memory, size_t size)
{
    world->rest = (ellipsoid_arena){memory, size};
}

ellipsoid_status ellipsoid_world_join(ellipsoid_world *world)
{
    return ellipsoid_groups_join(world, &world->top) ? ELLIPSOID_OK
                                                     : ELLIPSOID_TOO_MANY_CELLS;
}

/* All cells as they were at the start of the interval */
static void restore(ellipsoid_world *world)
{
    const ellipsoid_world_cells *cells = world->cells;
    const ellipsoid_span *s = &world->top;

    memcpy(cells->cell, s->before, s->count * cells->size);
    if (cells->put_back)
    {
        cells->put_back(cells->context, s->count, s->index, s->start);
    }
}

ellipsoid_status ellipsoid_world_advance(void *memory, size_t size,
                                         const ellipsoid_world_cells *cells,
                                         double start, double end)
{
    ellipsoid_world *world;
    ellipsoid_status status =
        ellipsoid_world_begin(memory, size, cells, start, end, &world);

    while (status == ELLIPSOID_OK && world->top.todos > 0)
    {
        for (int n = 0; n < world->top.todos && status == ELLIPSOID_OK; n++)
        {
            status = ellipsoid_world_advance_group(world, world->top.todo[n]);
        }
        status = status == ELLIPSOID_OK ? ellipsoid_world_join(world) : status;
        if (status != ELLIPSOID_OK)
        {
            restore(world);
        }
    }
    return status;
}
