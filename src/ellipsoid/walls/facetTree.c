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

static void box_clear(ellipsoid_tree_box *box)
{
    ellipsoid_set(box->low, HUGE_VAL, HUGE_VAL, HUGE_VAL);
    ellipsoid_set(box->high, -HUGE_VAL, -HUGE_VAL, -HUGE_VAL);
}

static void box_add(ellipsoid_tree_box *box, const double low[3],
                    const double high[3])
{
    for (int i = 0; i < 3; i++)
    {
        box->low[i] = fmin(box->low[i], low[i]);
        box->high[i] = fmax(box->high[i], high[i]);
    }
}

static size_t box_count(size_t count)
{
    size_t boxes = (count + ELLIPSOID_TREE_LEAF - 1) / ELLIPSOID_TREE_LEAF;
    size_t sum = boxes;

    while (boxes > 1)
    {
        boxes = (boxes + ELLIPSOID_TREE_FAN - 1) / ELLIPSOID_TREE_FAN;
        sum += boxes;
    }
    return sum;
}

size_t ellipsoid_facet_tree_size(size_t count)
{
    return ellipsoid_piece(count, sizeof(int))
         + ellipsoid_piece(count, sizeof(ellipsoid_tree_box))
         + ellipsoid_piece(box_count(count), sizeof(ellipsoid_tree_box));
}

size_t ellipsoid_facet_tree_scratch(size_t count)
{
    return ellipsoid_piece(count, sizeof(ellipsoid_sort_key));
}

static const ellipsoid_tree_box *own_boxes(const ellipsoid_facet_tree *tree)
{
    return (const void *)((const char *)tree + tree->own);
}

static const ellipsoid_tree_box *boxes_of(const ellipsoid_facet_tree *tree)
{
    return (const void *)((const char *)tree + tree->box);
}

static const int *order_of(const ellipsoid_facet_tree *tree)
{
    return (const void *)((const char *)tree + tree->order);
}

static void set_order(const ellipsoid_facet *facets, int count,
                      ellipsoid_sort_key *keys)
{
    ellipsoid_tree_box all;
    double extent = 0;

    box_clear(&all);
    for (int f = 0; f < count; f++)
    {
        box_add(&all, facets[f].middle, facets[f].middle);
    }
    for (int i = 0; i < 3; i++)
    {
        extent = fmax(extent, all.high[i] - all.low[i]);
    }
    for (int f = 0; f < count; f++)
    {
        keys[f].key = place_on_curve(facets[f].middle, all.low, extent);
        keys[f].index = f;
    }
    ellipsoid_sort(keys, count);
}

static void set_boxes(ellipsoid_facet_tree *tree, ellipsoid_tree_box *box)
{
    const ellipsoid_tree_box *below = own_boxes(tree);
    int first = 0;

    tree->levels = 0;
    for (int n = tree->count, fan = ELLIPSOID_TREE_LEAF; n > 0;)
    {
        const int boxes = (n + fan - 1) / fan;

        for (int b = 0; b < boxes; b++)
        {
            box_clear(&box[first + b]);
            for (int i = b * fan; i < n && i < (b + 1) * fan; i++)
            {
                box_add(&box[first + b], below[i].low, below[i].high);
            }
        }
        tree->first[tree->levels] = first;
        tree->boxes[tree->levels++] = boxes;
        below = &box[first];
        first += boxes;
        fan = ELLIPSOID_TREE_FAN;
        n = boxes > 1 ? boxes : 0;
    }
}

void ellipsoid_facet_tree_set(ellipsoid_facet_tree *tree,
                              const ellipsoid_facet *facets, int count,
                              ellipsoid_arena *arena, ellipsoid_arena scratch)
{
    ellipsoid_sort_key *keys = ellipsoid_take(&scratch, count, sizeof *keys);
    int *order = ellipsoid_take(arena, count, sizeof *order);
    ellipsoid_tree_box *own = ellipsoid_take(arena, count, sizeof *own);
    ellipsoid_tree_box *box =
        ellipsoid_take(arena, box_count(count), sizeof *box);

    tree->count = count;
    tree->order = (char *)order - (char *)tree;
    tree->own = (char *)own - (char *)tree;
    tree->box = (char *)box - (char *)tree;
    set_order(facets, count, keys);
    for (int i = 0; i < count; i++)
    {
        const ellipsoid_facet *f = &facets[keys[i].index];

        order[i] = keys[i].index;
        box_clear(&own[i]);
        for (int k = 0; k < 3; k++)
        {
            box_add(&own[i], f->vertex[k], f->vertex[k]);
        }
    }
    set_boxes(tree, box);
}

/* ----------------------------------------------------------------- ask */

static inline double larger(double a, double b) { return a > b ? a : b; }

/* Squared, from a point to a box. */
static inline double squared_to_box(const ellipsoid_tree_box *box,
                                    const double x[3])
{
    double sum = 0;

    for (int i = 0; i < 3; i++)
    {
        const double below = box->low[i] - x[i], above = x[i] - box->high[i];
        const double off = larger(larger(below, above), 0);

        sum += off * off;
    }
    return sum;
}

/* What a search goes by. */
typedef struct search
{
    const ellipsoid_facet_tree *tree;
    const ellipsoid_facet *facets; /* of the nearest */
    const double *centre;
    double squared; /* as far as it looks; of the nearest so far */
    int room, *index, count, nowhere;
} search;

static void list_leaf(search *s, int leaf)
{
    const int first = leaf * ELLIPSOID_TREE_LEAF;
    const int after = first + ELLIPSOID_TREE_LEAF;
    const int end = after < s->tree->count ? after : s->tree->count;
    const ellipsoid_tree_box *own = own_boxes(s->tree);
    const int *order = order_of(s->tree);

    /* without a branch, which would be predicted wrongly half of the time */
    for (int i = first; i < end; i++)
    {
        *(s->count < s->room ? &s->index[s->count] : &s->nowhere) = order[i];
        s->count += squared_to_box(&own[i], s->centre) <= s->squared;
    }
}

/* In a box that is near enough */
static void list_below(search *s, int level, int at)
{
    const ellipsoid_tree_box *box;
    int end;

    if (level == 0)
    {
        list_leaf(s, at);
        return;
    }
    box = boxes_of(s->tree) + s->tree->first[level - 1];
    end = (at + 1) * ELLIPSOID_TREE_FAN;
    end = end < s->tree->boxes[level - 1] ? end : s->tree->boxes[level - 1];
    for (int n = at * ELLIPSOID_TREE_FAN; n < end; n++)
    {
        if (squared_to_box(&box[n], s->centre) <= s->squared)
        {
            list_below(s, level - 1, n);
        }
    }
}

int ellipsoid_facet_tree_list(const ellipsoid_facet_tree *tree,
                              const double centre[3], double reach, int room,
                              int *index)
{
    search s = {.tree = tree,
                .centre = centre,
                .squared = reach * reach * (1 + 1e-9), /* for rounding */
                .room = room,
                .index = index};

    if (tree->count > 0)
    {
        list_below(&s, tree->levels - 1, 0);
    }
    if (s.count <= room)
    {
        sort_indices(index, s.count);
    }
    return s.count;
}

/* Squared, from a point to a facet. */
static double squared_to_facet(const ellipsoid_facet *f, const double x[3])
{
    double from[3], least = HUGE_VAL;
    int outside = 0;

    for (int k = 0; k < 3; k++)
    {
        double along[3], inward[3], off[3], foot;

        ellipsoid_difference(x, f->vertex[k], from);
        ellipsoid_difference(f->vertex[(k + 1) % 3], f->vertex[k], along);
        ellipsoid_cross(f->normal, along, inward);
        outside += ellipsoid_dot(inward, from) < 0;
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

static void nearest_below(search *s, int level, int at);

/* The children of a box, the nearest first: later ones are then left out. */
static void nearest_in_children(search *s, int level, int at)
{
    const ellipsoid_tree_box *box =
        boxes_of(s->tree) + s->tree->first[level - 1];
    double squared[ELLIPSOID_TREE_FAN];
    int child[ELLIPSOID_TREE_FAN], count = 0;

    for (int n = at * ELLIPSOID_TREE_FAN;
         n < s->tree->boxes[level - 1] && n < (at + 1) * ELLIPSOID_TREE_FAN;
         n++)
    {
        const double off = squared_to_box(&box[n], s->centre);
        int k = count++;

        for (; k > 0 && squared[k - 1] > off; k--)
        {
            squared[k] = squared[k - 1];
            child[k] = child[k - 1];
        }
        squared[k] = off;
        child[k] = n;
    }
    for (int k = 0; k < count && squared[k] < s->squared; k++)
    {
        nearest_below(s, level - 1, child[k]);
    }
}

static void nearest_below(search *s, int level, int at)
{
    if (level > 0)
    {
        nearest_in_children(s, level, at);
        return;
    }
    for (int i = at * ELLIPSOID_TREE_LEAF;
         i < s->tree->count && i < (at + 1) * ELLIPSOID_TREE_LEAF; i++)
    {
        s->squared =
            fmin(s->squared,
                 squared_to_facet(&s->facets[order_of(s->tree)[i]], s->centre));
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
        nearest_below(&s, tree->levels - 1, 0);
    }
    return fmin(sqrt(s.squared), far);
}
