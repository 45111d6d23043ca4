/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    planeWeights.c - how the planes that stand for walls share what they cover.

    Planes come and go at the end of their range, where the window is zero, and
    where their place leaves a facet over a concave seam. There it reaches the
    plane beyond, so that of two planes with c = n_i.n_j > 0 the part
        c (h_i - c h_j)/(h_j (1 - c^2)),
    which is 1 there, is taken from i. With g_i, what is left of the window v_i,
        weight_i = v_i g_i/sum_j max(0, n_i.n_j) g_j.
    So planes with one normal count once, those of a slit or a right corner
    fully.
*/
#include "nearWall.h"

enum
{
    POSE = ELLIPSOID_POSE_SIZE
};

static ellipsoid_quantity times(const ellipsoid_quantity *a,
                                const ellipsoid_quantity *b)
{
    ellipsoid_quantity product = {.value = a->value * b->value};

    for (int n = 0; n < POSE; n++)
    {
        product.slope[n] = a->slope[n] * b->value + a->value * b->slope[n];
    }
    return product;
}

static ellipsoid_quantity over(const ellipsoid_quantity *a,
                               const ellipsoid_quantity *b)
{
    ellipsoid_quantity ratio = {.value = a->value / b->value};

    for (int n = 0; n < POSE; n++)
    {
        ratio.slope[n] = (a->slope[n] - ratio.value * b->slope[n]) / b->value;
    }
    return ratio;
}

/* a + sign b */
static ellipsoid_quantity plus(const ellipsoid_quantity *a, double sign,
                               const ellipsoid_quantity *b)
{
    ellipsoid_quantity sum = {.value = a->value + sign * b->value};

    for (int n = 0; n < POSE; n++)
    {
        sum.slope[n] = a->slope[n] + sign * b->slope[n];
    }
    return sum;
}

static ellipsoid_quantity cosine(const ellipsoid_plane *a,
                                 const ellipsoid_plane *b)
{
    ellipsoid_quantity c = {.value = ellipsoid_dot(a->normal, b->normal)};

    for (int n = 0; n < POSE; n++)
    {
        c.slope[n] = ellipsoid_dot(a->normal_slope[n], b->normal)
                   + ellipsoid_dot(a->normal, b->normal_slope[n]);
    }
    return c;
}

/* Takes from what is left of i what j covers. */
static void concede(const ellipsoid_plane *i, const ellipsoid_plane *j,
                    const ellipsoid_quantity *c, ellipsoid_quantity *left)
{
    const ellipsoid_quantity reach_i = times(c, &i->height);
    const ellipsoid_quantity reach_j = times(c, &j->height);
    const ellipsoid_quantity mine = plus(&j->height, -1, &reach_i);
    const ellipsoid_quantity others = plus(&i->height, -1, &reach_j);
    const ellipsoid_quantity one = {.value = 1};
    ellipsoid_quantity part = one, kept;

    if (!(others.value > 0))
    {
        return;
    }
    if (mine.value > 0)
    {
        /* mine + c others = h_j (1 - c^2) */
        const ellipsoid_quantity claim = times(c, &others);
        const ellipsoid_quantity all = plus(&mine, 1, &claim);

        part = over(&claim, &all);
    }
    if (j->window.value < i->window.value)
    {
        const ellipsoid_quantity fading = over(&j->window, &i->window);

        part = times(&part, &fading);
    }
    kept = plus(&one, -1, &part);
    *left = times(left, &kept);
}

void ellipsoid_weigh_planes(ellipsoid_planes *planes)
{
    ellipsoid_quantity left[ELLIPSOID_MAX_PLANES];

    for (int i = 0; i < planes->count; i++)
    {
        const ellipsoid_plane *plane = &planes->at[i];

        left[i] = plane->window;
        for (int j = 0; j < planes->count; j++)
        {
            const ellipsoid_quantity c = cosine(plane, &planes->at[j]);

            if (j != i && c.value > 0)
            {
                concede(plane, &planes->at[j], &c, &left[i]);
            }
        }
    }
    for (int i = 0; i < planes->count; i++)
    {
        ellipsoid_plane *plane = &planes->at[i];
        ellipsoid_quantity sum = left[i];

        for (int j = 0; j < planes->count; j++)
        {
            const ellipsoid_quantity c = cosine(plane, &planes->at[j]);

            if (j != i && c.value > 0)
            {
                const ellipsoid_quantity covered = times(&c, &left[j]);

                sum = plus(&sum, 1, &covered);
            }
        }
        memset(&plane->weight, 0, sizeof(plane->weight));
        if (left[i].value > 0)
        {
            plane->weight = over(&left[i], &sum);
            plane->weight = times(&plane->weight, &plane->window);
        }
    }
}
