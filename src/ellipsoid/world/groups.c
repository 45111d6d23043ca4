/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    groups.c - which cells are advanced together: those near one another at the
    start of a span, and those that may have met in it.
*/
#include "world/world.h"

#include <math.h>

/* In lengths of the world: the gap below which cells are one group; what is not
   known of a path between the poses looked at; the travel below which it does
   not pay to halve the time. */
static const double group_gap = 0.5;
static const double unseen_gap = 0.1;
static const double short_travel = 2;

/* The lists of cells, from the groups of each */
static void set_lists(ellipsoid_span *s)
{
    for (int g = 0; g < s->groups; g++)
    {
        s->first[g] = -1;
    }
    for (int k = s->count - 1; k >= 0; k--)
    {
        const int group = s->group[k];

        if (group >= 0)
        {
            s->next[k] = s->first[group];
            s->first[group] = k;
        }
    }
}

/* What is known of cells there, and of those that try to enter at the start */
typedef struct forming
{
    const ellipsoid_world_cells *cells;
    const int *here;              /* indices of the cells */
    int *stays;                   /* waits and finds no room */
    int *lowest;                  /* that they hang together with */
    ellipsoid_sort_key *entering; /* pairs that enter and overlap */
    int entering_count, entering_room;
} forming;

static int waits(const ellipsoid_world_cells *cells, int index)
{
    return ellipsoid_world_look(cells, index).phase == ELLIPSOID_WAITING;
}

static void find_blocked(void *context, int a, int b, double gap)
{
    forming *f = context;
    const int a_waits = waits(f->cells, f->here[a]);
    const int b_waits = waits(f->cells, f->here[b]);

    if (gap < 0 && a_waits != b_waits)
    {
        f->stays[a_waits ? a : b] = 1;
    }
    else if (gap < 0 && a_waits)
    {
        if (f->entering_count < f->entering_room)
        {
            f->entering[f->entering_count] =
                (ellipsoid_sort_key){.key = a, .index = b};
        }
        f->entering_count++;
    }
}

static void find_bonds(void *context, int a, int b, double gap)
{
    forming *f = context;

    (void)gap;
    if (!f->stays[a] && !f->stays[b])
    {
        ellipsoid_unite(f->lowest, a, b);
    }
}

/* Cells that wait stay where one is that is there, or one that enters and comes
   before them. 0: too little memory */
static int set_staying(const ellipsoid_near_query *query,
                       ellipsoid_arena memory, forming *f)
{
    ellipsoid_arena searched = memory;
    int any = 0;

    for (int n = 0; n < query->count; n++)
    {
        any = any || waits(query->cells, query->index[n]);
    }
    if (!any)
    {
        return 1;
    }
    ellipsoid_take(
        &memory, 1,
        ellipsoid_near_size(query->count, query->cells->repeat_count));
    f->entering = (ellipsoid_sort_key *)memory.next;
    f->entering_room = memory.left / sizeof *f->entering < 1 << 30
                         ? (int)(memory.left / sizeof *f->entering)
                         : 1 << 30;
    if (!ellipsoid_near_cells(query, searched, find_blocked, f)
        || f->entering_count > f->entering_room)
    {
        return 0;
    }
    ellipsoid_sort(f->entering, f->entering_count);
    for (int n = 0; n < f->entering_count; n++)
    {
        if (!f->stays[f->entering[n].key])
        {
            f->stays[f->entering[n].index] = 1;
        }
    }
    return 1;
}

int ellipsoid_groups_form(ellipsoid_world *world, ellipsoid_span *s)
{
    const ellipsoid_world_cells *cells = world->cells;
    ellipsoid_arena memory = world->rest;
    int *here = ellipsoid_take(&memory, s->count, sizeof(int));
    int *stays = ellipsoid_take(&memory, s->count, sizeof(int));
    int *lowest = ellipsoid_take(&memory, s->count, sizeof(int));
    int *place = ellipsoid_take(&memory, s->count, sizeof(int));
    forming f = {
        .cells = cells, .here = here, .stays = stays, .lowest = lowest};
    ellipsoid_near_query query = {cells, here, 0, lowest,
                                  group_gap * cells->length};

    if (!place)
    {
        return 0;
    }
    s->groups = 0;
    for (int k = 0; k < s->count; k++)
    {
        const ellipsoid_cell_view view =
            ellipsoid_world_look(cells, s->index[k]);

        s->group[k] = -1;
        if (view.phase == ELLIPSOID_PRESENT
            || (view.phase == ELLIPSOID_WAITING && view.time == s->start))
        {
            lowest[query.count] = query.count;
            stays[query.count] = 0;
            place[query.count] = k;
            here[query.count++] = s->index[k];
        }
    }
    if (!set_staying(&query, memory, &f))
    {
        return 0;
    }

    /* each of its own as yet: `lowest` changes while it is asked for */
    for (int n = 0; n < query.count; n++)
    {
        s->next[n] = n;
    }
    query.group = s->next;
    if (!ellipsoid_near_cells(&query, memory, find_bonds, &f))
    {
        return 0;
    }
    for (int n = 0; n < query.count; n++)
    {
        const int root = ellipsoid_lowest(lowest, n);

        if (!stays[n])
        {
            s->group[place[n]] =
                root == n ? s->groups++ : s->group[place[root]];
        }
    }

    /* those that enter later */
    for (int k = 0; k < s->count; k++)
    {
        const ellipsoid_cell_view view =
            ellipsoid_world_look(cells, s->index[k]);

        if (view.phase == ELLIPSOID_WAITING && view.time > s->start
            && view.time < s->end)
        {
            s->group[k] = s->groups++;
        }
    }
    s->todos = s->groups;
    for (int g = 0; g < s->groups; g++)
    {
        s->todo[g] = g;
        s->in_parts[g] = s->is_old[g] = 0;
    }
    set_lists(s);
    return 1;
}

/* What the groups of cells that may have met come to */
typedef struct joining
{
    const ellipsoid_world_cells *cells;
    ellipsoid_span *s;
    const int *index, *group; /* of the cells looked at */
    int *lowest;
} joining;

static void find_met(void *context, int a, int b, double gap)
{
    joining *j = context;
    const ellipsoid_sweep *of_a = ellipsoid_world_at(j->cells, j->index[a]);
    const ellipsoid_sweep *of_b = ellipsoid_world_at(j->cells, j->index[b]);
    double *travel = &j->s->travel[j->group[a]];

    (void)gap;
    *travel = ellipsoid_greater(*travel, of_a->travel);
    *travel = ellipsoid_greater(*travel, of_b->travel);
    ellipsoid_unite(j->lowest, j->group[a], j->group[b]);
}

int ellipsoid_groups_join(ellipsoid_world *world, ellipsoid_span *s)
{
    const ellipsoid_world_cells *cells = world->cells;
    const double long_travel = s->halvings < ELLIPSOID_MOST_HALVINGS
                                 ? short_travel * cells->length
                                 : HUGE_VAL;
    ellipsoid_arena memory = world->rest;
    int *index = ellipsoid_take(&memory, s->count, sizeof(int));
    int *group = ellipsoid_take(&memory, s->count, sizeof(int));
    int *lowest = ellipsoid_take(&memory, s->count, sizeof(int));
    joining j = {cells, s, index, group, lowest};
    ellipsoid_near_query query = {cells, index, 0, group,
                                  unseen_gap * cells->length};

    if (!lowest)
    {
        return 0;
    }
    for (int k = 0; k < s->count; k++)
    {
        if (s->group[k] >= 0 && !waits(cells, s->index[k]))
        {
            index[query.count] = s->index[k];
            group[query.count++] = s->group[k];
        }
    }
    for (int g = 0; g < s->groups; g++)
    {
        lowest[g] = g;
        s->travel[g] = -1;
    }
    if (!ellipsoid_near_cells(&query, memory, find_met, &j))
    {
        return 0;
    }
    s->todos = 0;
    for (int g = 0; g < s->groups; g++)
    {
        const int root = ellipsoid_lowest(lowest, g);

        if (root != g)
        {
            s->travel[root] = ellipsoid_greater(s->travel[root], s->travel[g]);
            s->travel[g] = -1;
        }
    }
    for (int k = 0; k < s->count; k++)
    {
        s->group[k] =
            s->group[k] < 0 ? -1 : ellipsoid_lowest(lowest, s->group[k]);
    }
    for (int g = 0; g < s->groups; g++)
    {
        if (s->travel[g] >= 0)
        {
            s->in_parts[g] = s->travel[g] > long_travel;
            s->is_old[g] = 1;
            s->todo[s->todos++] = g;
        }
    }
    set_lists(s);
    return 1;
}
