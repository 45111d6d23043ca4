/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    nearCells.c - which cells may have been near one another: boxes about what
    they swept, sorted along the direction in which they are spread most, and
    then the gaps at the start.
*/
#include "world/world.h"

#include <math.h>

/* A box, of a cell or of an image of it. */
typedef struct swept_box
{
    double low[3], high[3];
    int place;  /* in the query */
    int repeat; /* -1: the cell itself */
} swept_box;

size_t ellipsoid_near_size(int count, int repeat_count)
{
    const size_t boxes = (size_t)count * (1 + repeat_count);

    return ellipsoid_piece(boxes, sizeof(swept_box))
         + ellipsoid_piece(boxes, sizeof(ellipsoid_sort_key));
}

static int overlap(const double low[3], const double high[3],
                   const swept_box *box)
{
    for (int i = 0; i < 3; i++)
    {
        if (low[i] > box->high[i] || high[i] < box->low[i])
        {
            return 0;
        }
    }
    return 1;
}

static void widen(const swept_box *by, double low[3], double high[3])
{
    for (int i = 0; i < 3; i++)
    {
        low[i] = ellipsoid_lesser(low[i], by->low[i]);
        high[i] = ellipsoid_greater(high[i], by->high[i]);
    }
}

/* Those of all cells, and of their images that come near them; sets what the
   cells span and returns how many. */
static int set_boxes(const ellipsoid_near_query *query, swept_box *boxes,
                     double low[3], double high[3])
{
    const ellipsoid_world_cells *cells = query->cells;
    int count = query->count;

    ellipsoid_set(low, HUGE_VAL, HUGE_VAL, HUGE_VAL);
    ellipsoid_set(high, -HUGE_VAL, -HUGE_VAL, -HUGE_VAL);
    for (int k = 0; k < query->count; k++)
    {
        const ellipsoid_sweep *sweep =
            ellipsoid_world_at(cells, query->index[k]);
        const double off =
            ellipsoid_world_look(cells, query->index[k]).model->reach
            + 0.5 * query->margin;

        boxes[k].place = k;
        boxes[k].repeat = -1;
        for (int i = 0; i < 3; i++)
        {
            boxes[k].low[i] = sweep->low[i] - off;
            boxes[k].high[i] = sweep->high[i] + off;
        }
        widen(&boxes[k], low, high);
    }
    for (int n = 0; n < cells->repeat_count; n++)
    {
        for (int k = 0; k < query->count; k++)
        {
            swept_box *image = &boxes[count];

            *image = boxes[k];
            image->repeat = n;
            ellipsoid_add(image->low, cells->repeat[n]);
            ellipsoid_add(image->high, cells->repeat[n]);
            count += overlap(low, high, image);
        }
    }
    return count;
}

/* Two boxes overlap: visits their cells if they may have met. Of an image and a
   cell each pair comes once, as the image of the one meets the other as
   well. */
static void visit(const ellipsoid_near_query *query, const swept_box *a,
                  const swept_box *b, ellipsoid_near_visitor visitor,
                  void *context)
{
    const ellipsoid_world_cells *cells = query->cells;
    const ellipsoid_sweep *sweep_a, *sweep_b;
    ellipsoid_cell_view view_a, view_b;
    double horizon, gap, x_b[3];

    if (a->repeat >= 0 || (b->repeat < 0 && b->place < a->place))
    {
        const swept_box *other = a;

        a = b;
        b = other;
    }
    if (a->repeat >= 0 || a->place >= b->place
        || query->group[a->place] == query->group[b->place])
    {
        return;
    }
    view_a = ellipsoid_world_look(cells, query->index[a->place]);
    view_b = ellipsoid_world_look(cells, query->index[b->place]);
    if (view_a.fixed && view_b.fixed)
    {
        return;
    }
    sweep_a = ellipsoid_world_at(cells, query->index[a->place]);
    sweep_b = ellipsoid_world_at(cells, query->index[b->place]);
    ellipsoid_copy(sweep_b->start.x, x_b);
    if (b->repeat >= 0)
    {
        ellipsoid_add(x_b, cells->repeat[b->repeat]);
    }

    /* each point of a cell stays within its travel of where it began */
    horizon = sweep_a->travel + sweep_b->travel + query->margin;
    gap = ellipsoid_cell_gap(view_a.model, sweep_a->start.x, sweep_a->start.q,
                             view_b.model, x_b, sweep_b->start.q, horizon);
    if (gap < horizon)
    {
        visitor(context, a->place, b->place, gap);
    }
}

int ellipsoid_near_cells(const ellipsoid_near_query *query,
                         ellipsoid_arena memory, ellipsoid_near_visitor visitor,
                         void *context)
{
    const size_t most = (size_t)query->count * (1 + query->cells->repeat_count);
    swept_box *boxes = ellipsoid_take(&memory, most, sizeof *boxes);
    ellipsoid_sort_key *order = ellipsoid_take(&memory, most, sizeof *order);
    double low[3], high[3];
    int count, axis = 0;

    if (!query->cells->pushing || query->count < 1)
    {
        return 1;
    }
    if (!boxes || !order)
    {
        return 0;
    }
    count = set_boxes(query, boxes, low, high);
    for (int i = 1; i < 3; i++)
    {
        axis = high[i] - low[i] > high[axis] - low[axis] ? i : axis;
    }
    for (int k = 0; k < count; k++)
    {
        order[k].key = ellipsoid_sort_key_of(boxes[k].low[axis]);
        order[k].index = k;
    }
    ellipsoid_sort(order, count);
    for (int i = 0; i < count; i++)
    {
        const swept_box *a = &boxes[order[i].index];

        for (int j = i + 1;
             j < count && boxes[order[j].index].low[axis] <= a->high[axis]; j++)
        {
            const swept_box *b = &boxes[order[j].index];

            if (overlap(a->low, a->high, b))
            {
                visit(query, a, b, visitor, context);
            }
        }
    }
    return 1;
}
