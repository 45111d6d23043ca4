/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    facetTree.c - which facets are near a point: boxes about facets
    that follow one another on a curve through space (Morton 1966), and boxes
    about those.
*/
#include "walls/wallSurface.h"

#include <math.h>
#include <stddef.h>

/* Bits of a direction in the place on the curve. */
#define BITS 20

/* ---------------------------------------------------------------- order */

/* Ascending; in place, and quick for the few tens of a list. */
static void sort_indices(int *index, int count)
{
    static const int gaps[] = {701, 301, 132, 57, 23, 10, 4, 1};

    for (size_t g = 0; g < sizeof gaps / sizeof *gaps; g++)
    {
        for (int i = gaps[g]; i < count; i++)
        {
            const int moved = index[i];
            int j = i;

            for (; j >= gaps[g] && index[j - gaps[g]] > moved; j -= gaps[g])
            {
                index[j] = index[j - gaps[g]];
            }
            index[j] = moved;
        }
    }
}

/* The bits of a number, each followed by two that are 0. */
static uint64_t spread(double number)
{
    const uint64_t whole = (uint64_t)number;
    uint64_t bits = 0;

    for (int n = 0; n < BITS; n++)
    {
        bits |= (whole >> n & 1) << 3 * n;
    }
    return bits;
}

static uint64_t place_on_curve(const double x[3], const double low[3],
                               double extent)
{
    const double most = (1 << BITS) - 1;
    uint64_t place = 0;

    for (int i = 0; i < 3; i++)
    {
        place |= spread(extent > 0 ? (x[i] - low[i]) / extent * most : 0) << i;
    }
    return place;
}

/* ----------------------------------------------------------------- make */

/* Half of a box that holds nothing, and the square of how far a search looks at
   most, which does not reach it. */
static const float nothing = -3e18F, farthest = 1e36F;

typedef struct box
{
    double low[3], high[3];
} box;

static const box empty = {{HUGE_VAL, HUGE_VAL, HUGE_VAL},
                          {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};

static void box_add(box *all, int i, double low, double high)
{
    all->low[i] = fmin(all->low[i], low);
    all->high[i] = fmax(all->high[i], high);
}

static void box_add_facet(box *all, const ellipsoid_facet *facet)
{
    for (int k = 0; k < 3; k++)
    {
        for (int i = 0; i < 3; i++)
        {
            box_add(all, i, facet->vertex[k][i], facet->vertex[k][i]);
        }
    }
}

static size_t nodes_for(size_t boxes)
{
    return (boxes + ELLIPSOID_TREE_FAN - 1) / ELLIPSOID_TREE_FAN;
}

static size_t node_count(size_t count)
{
    size_t nodes = nodes_for(count), sum = nodes;

    while (nodes > 1)
    {
        nodes = nodes_for(nodes);
        sum += nodes;
    }
    return sum;
}

size_t ellipsoid_facet_tree_size(size_t count)
{
    return ellipsoid_piece(nodes_for(count), sizeof(int[ELLIPSOID_TREE_FAN]))
         + ellipsoid_piece(node_count(count), sizeof(ellipsoid_tree_node));
}

size_t ellipsoid_facet_tree_scratch(size_t count)
{
    return ellipsoid_piece(count, sizeof(ellipsoid_sort_key));
}

static const ellipsoid_tree_node *node_of(const ellipsoid_facet_tree *tree,
                                          int level, int at)
{
    return (const ellipsoid_tree_node *)((const char *)tree + tree->node)
         + tree->first[level] + at;
}

static const int *order_of(const ellipsoid_facet_tree *tree)
{
    return (const void *)((const char *)tree + tree->order);
}

/* Also where the tree is. */
static void set_order(const ellipsoid_facet *facets, int count,
                      ellipsoid_facet_tree *tree, ellipsoid_sort_key *keys)
{
    box all = empty;

    tree->size = 0;
    for (int f = 0; f < count; f++)
    {
        box_add_facet(&all, &facets[f]);
    }
    for (int i = 0; i < 3 && count > 0; i++)
    {
        tree->middle[i] = 0.5 * all.low[i] + 0.5 * all.high[i];
        tree->size = fmax(tree->size, 0.5 * all.high[i] - 0.5 * all.low[i]);
    }
    for (int f = 0; f < count; f++)
    {
        keys[f].key = place_on_curve(facets[f].middle, all.low, 2 * tree->size);
        keys[f].index = f;
    }
    ellipsoid_sort(keys, count);
}

/* Box k of a node, wider by what rounding takes. */
static void node_set(ellipsoid_tree_node *node, int k, const box *of,
                     const ellipsoid_facet_tree *tree)
{
    const int holds = of->low[0] <= of->high[0];

    for (int i = 0; i < 3; i++)
    {
        node->middle[i][k] = 0;
        node->half[i][k] = nothing;
        if (holds)
        {
            const double half = 0.5 * (of->high[i] - of->low[i]);
            const double middle = of->low[i] + half - tree->middle[i];

            node->middle[i][k] = (float)(middle / tree->size);
            node->half[i][k] = (float)(half / tree->size + 3e-7);
        }
    }
}

/* About all boxes of a node */
static box box_about(const ellipsoid_tree_node *node,
                     const ellipsoid_facet_tree *tree)
{
    box all = empty;

    for (int i = 0; i < 3; i++)
    {
        for (int k = 0; k < ELLIPSOID_TREE_FAN; k++)
        {
            const double middle = node->middle[i][k], half = node->half[i][k];

            box_add(&all, i, tree->middle[i] + (middle - half) * tree->size,
                    tree->middle[i] + (middle + half) * tree->size);
        }
    }
    return all;
}

static void set_nodes(ellipsoid_facet_tree *tree, const ellipsoid_facet *facets,
                      const int *order, ellipsoid_tree_node *node)
{
    int boxes = tree->count, first = 0;

    tree->levels = 0;
    while (boxes > 0)
    {
        const int nodes = (int)nodes_for(boxes), level = tree->levels++;

        tree->first[level] = first;
        for (int n = 0; n < nodes * ELLIPSOID_TREE_FAN; n++)
        {
            box of = empty;

            if (n < boxes && level == 0)
            {
                box_add_facet(&of, &facets[order[n]]);
            }
            else if (n < boxes)
            {
                of = box_about(&node[tree->first[level - 1] + n], tree);
            }
            node_set(&node[first + n / ELLIPSOID_TREE_FAN],
                     n % ELLIPSOID_TREE_FAN, &of, tree);
        }
        first += nodes;
        boxes = nodes > 1 ? nodes : 0;
    }
}

void ellipsoid_facet_tree_set(ellipsoid_facet_tree *tree,
                              const ellipsoid_facet *facets, int count,
                              ellipsoid_arena *arena, ellipsoid_arena scratch)
{
    const int room = (int)nodes_for(count) * ELLIPSOID_TREE_FAN;
    ellipsoid_sort_key *keys = ellipsoid_take(&scratch, count, sizeof *keys);
    int *order = ellipsoid_take(arena, room, sizeof *order);
    ellipsoid_tree_node *node =
        ellipsoid_take(arena, node_count(count), sizeof *node);

    tree->count = count;
    tree->order = (char *)order - (char *)tree;
    tree->node = (char *)node - (char *)tree;
    set_order(facets, count, tree, keys);
    for (int i = 0; i < room; i++)
    {
        order[i] = i < count ? keys[i].index : 0;
    }
    set_nodes(tree, facets, order, node);
}

/* ----------------------------------------------------------------- ask */

/* What a search goes by. */
typedef struct search
{
    const ellipsoid_facet_tree *tree;
    const ellipsoid_facet *facets; /* of the nearest */
    const double *centre;
    double squared;    /* to the nearest so far */
    float x[3], limit; /* the centre; squared twice as far as it looks */
} search;

/* The centre, and `reach`, farther by what rounding takes. */
static void set_reach(search *s, double reach)
{
    const double unit = 1 / s->tree->size;
    double twice = 1 + reach * unit;

    for (int i = 0; i < 3; i++)
    {
        s->x[i] = (float)((s->centre[i] - s->tree->middle[i]) * unit);
        twice += fabsf(s->x[i]);
    }
    twice = 2 * (reach * unit + 1e-6 * twice);
    s->limit = (float)fmin(twice * twice, farthest);
}

/* Squared twice the distances from the centre to the boxes of a node. */
static inline void set_squared(const search *s, const ellipsoid_tree_node *node,
                               float squared[ELLIPSOID_TREE_FAN])
{
    for (int k = 0; k < ELLIPSOID_TREE_FAN; k++)
    {
        float sum = 0;

        for (int i = 0; i < 3; i++)
        {
            const float off =
                fabsf(s->x[i] - node->middle[i][k]) - node->half[i][k];
            const float twice = off + fabsf(off); /* 0 inside */

            sum += twice * twice;
        }
        squared[k] = sum;
    }
}

int ellipsoid_facet_tree_list(const ellipsoid_facet_tree *tree,
                              const double centre[3], double reach, int room,
                              int *index)
{
    struct
    {
        int level, at;
    } open[ELLIPSOID_TREE_FAN * ELLIPSOID_TREE_LEVELS];
    search s = {.tree = tree, .centre = centre};
    const int *order = order_of(tree);
    int count = 0, left = 1, nowhere;

    if (tree->count == 0)
    {
        return 0;
    }
    set_reach(&s, reach);
    open[0].level = tree->levels - 1;
    open[0].at = 0;
    while (left > 0)
    {
        const int level = open[--left].level;
        const int at = open[left].at;
        float squared[ELLIPSOID_TREE_FAN];

        /* no branch, which would be predicted wrongly half of the time */
        set_squared(&s, node_of(tree, level, at), squared);
        for (int k = 0; level > 0 && k < ELLIPSOID_TREE_FAN; k++)
        {
            open[left].level = level - 1;
            open[left].at = at * ELLIPSOID_TREE_FAN + k;
            left += squared[k] <= s.limit;
        }
        for (int k = 0; level == 0 && k < ELLIPSOID_TREE_FAN; k++)
        {
            *(count < room ? &index[count] : &nowhere) =
                order[at * ELLIPSOID_TREE_FAN + k];
            count += squared[k] <= s.limit;
        }
    }
    if (count <= room)
    {
        sort_indices(index, count);
    }
    return count;
}

/* Squared, from a point to a facet. */
static double squared_to_facet(const ellipsoid_facet *f, const double x[3])
{
    double from[3], least = HUGE_VAL;
    int outside = 0;

    for (int k = 0; k < 3; k++)
    {
        double along[3], off[3], foot;

        ellipsoid_difference(x, f->vertex[k], from);
        ellipsoid_difference(f->vertex[(k + 1) % 3], f->vertex[k], along);
        outside += ellipsoid_dot(f->inward[k], from) < 0;
        foot = ellipsoid_dot(from, along) / ellipsoid_dot(along, along);
        foot = fmin(fmax(foot, 0), 1);
        for (int i = 0; i < 3; i++)
        {
            off[i] = from[i] - foot * along[i];
        }
        least = fmin(least, ellipsoid_dot(off, off));
    }
    return outside
             ? least
             : ellipsoid_dot(from, f->normal) * ellipsoid_dot(from, f->normal);
}

/* The boxes of a node, the nearest first: later ones are then left out. */
static void nearest_below(search *s, int level, int at)
{
    float squared[ELLIPSOID_TREE_FAN];
    int box[ELLIPSOID_TREE_FAN];

    set_squared(s, node_of(s->tree, level, at), squared);
    for (int n = 0; n < ELLIPSOID_TREE_FAN; n++)
    {
        const float of = squared[n];
        int k = n;

        for (; k > 0 && squared[k - 1] > of; k--)
        {
            squared[k] = squared[k - 1];
            box[k] = box[k - 1];
        }
        squared[k] = of;
        box[k] = at * ELLIPSOID_TREE_FAN + n;
    }
    for (int k = 0; k < ELLIPSOID_TREE_FAN && squared[k] <= s->limit; k++)
    {
        if (level > 0)
        {
            nearest_below(s, level - 1, box[k]);
            continue;
        }

        const double to =
            squared_to_facet(&s->facets[order_of(s->tree)[box[k]]], s->centre);

        if (to < s->squared)
        {
            s->squared = to;
            set_reach(s, sqrt(to));
        }
    }
}

double ellipsoid_facet_tree_distance(const ellipsoid_facet_tree *tree,
                                     const ellipsoid_facet *facets,
                                     const double centre[3], double far)
{
    search s = {
        .tree = tree, .facets = facets, .centre = centre, .squared = far * far};

    if (tree->count > 0)
    {
        set_reach(&s, far);
        nearest_below(&s, tree->levels - 1, 0);
    }
    return fmin(sqrt(s.squared), far);
}
