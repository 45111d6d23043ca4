/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    sort.c - numbers in order, without memory: qsort() may allocate.
*/
#include "body/body.h"

#include <string.h>

uint64_t ellipsoid_sort_key_of(double number)
{
    const uint64_t sign = (uint64_t)1 << 63;
    uint64_t bits;

    number += 0.0; /* no -0 */
    memcpy(&bits, &number, sizeof bits);
    return (bits & sign) != 0 ? ~bits : (bits | sign);
}

static int is_before(const ellipsoid_sort_key *a, const ellipsoid_sort_key *b)
{
    return a->key < b->key || (a->key == b->key && a->index < b->index);
}

/* Puts keys[at] where it belongs in the heap below it. */
static void sift(ellipsoid_sort_key *keys, int at, int count)
{
    const ellipsoid_sort_key moved = keys[at];

    while (at < count / 2)
    {
        int child = 2 * at + 1;

        child += child + 1 < count && is_before(&keys[child], &keys[child + 1]);
        if (!is_before(&moved, &keys[child]))
        {
            break;
        }
        keys[at] = keys[child];
        at = child;
    }
    keys[at] = moved;
}

void ellipsoid_sort(ellipsoid_sort_key *keys, int count)
{
    for (int at = count / 2 - 1; at >= 0; at--)
    {
        sift(keys, at, count);
    }
    for (int end = count - 1; end > 0; end--)
    {
        const ellipsoid_sort_key largest = keys[0];

        keys[0] = keys[end];
        keys[end] = largest;
        sift(keys, 0, end);
    }
}
