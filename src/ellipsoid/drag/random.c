/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    random.c - numbers that depend on their key alone: Philox4x32-10 of
    Random123 (Salmon et al., SC11, 2011).
*/
#include "drag/drag.h"

#include <Random123/philox.h>

static const double pi = 3.14159265358979323846;

/* The streams of the core itself begin here. */
static const uint32_t normal_stream = 0x80000000u;

/* Numbers i and i + 1 of a key. */
static void uniform_pair(uint64_t seed, uint32_t id, uint32_t stream,
                         uint32_t index, uint32_t i, double uniform[2])
{
    const philox4x32_key_t key = {{(uint32_t)seed, (uint32_t)(seed >> 32)}};
    const philox4x32_ctr_t counter = {{id, stream, index, i}};
    const philox4x32_ctr_t bits = philox4x32(counter, key);

    /* 53 of each 64 bits, so that 1 is never reached */
    for (int j = 0; j < 2; ++j)
    {
        const uint64_t word =
            ((uint64_t)bits.v[2 * j] << 32) | bits.v[2 * j + 1];
        uniform[j] = (double)(word >> 11) * 0x1.0p-53;
    }
}

void ellipsoid_random_uniform(uint64_t seed, uint32_t id, uint32_t stream,
                              uint32_t index, int count, double *uniform)
{
    for (int i = 0; i < count; i += 2)
    {
        double pair[2];

        uniform_pair(seed, id, stream, index, (uint32_t)i, pair);
        for (int j = 0; j < 2 && i + j < count; ++j)
        {
            uniform[i + j] = pair[j];
        }
    }
}

/* Box & Muller, Ann. Math. Stat. 29, 610 (1958). */
void ellipsoid_random_normals(uint64_t seed, uint32_t id, uint32_t stream,
                              uint32_t index, int count, double *normal)
{
    for (int i = 0; i < count; i += 2)
    {
        double uniform[2];

        uniform_pair(seed, id, stream, index, (uint32_t)i, uniform);

        const double length = sqrt(-2 * log(1 - uniform[0]));
        const double angle = 2 * pi * uniform[1];

        normal[i] = length * cos(angle);
        if (i + 1 < count)
        {
            normal[i + 1] = length * sin(angle);
        }
    }
}

void ellipsoid_random_normal(uint64_t seed, uint32_t id, int64_t interval,
                             double normal[6])
{
    const uint64_t index = (uint64_t)interval;
    const uint32_t high = (uint32_t)(index >> 32) & 0x7fffffffu;

    ellipsoid_random_normals(seed, id, normal_stream | high, (uint32_t)index, 6,
                             normal);
}
