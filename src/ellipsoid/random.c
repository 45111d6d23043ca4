/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    random.c - numbers that depend on their key alone: Philox4x32-10 of
    Random123 (Salmon et al., SC11, 2011).
*/
#include "ellipsoid.h"

#include <Random123/philox.h>

void ellipsoid_random_uniform(uint64_t seed, uint32_t id, uint32_t stream,
                              uint32_t index, int count, double *uniform)
{
    const philox4x32_key_t key = {{(uint32_t)seed, (uint32_t)(seed >> 32)}};

    for (int i = 0; i < count; i += 2)
    {
        const philox4x32_ctr_t counter = {{id, stream, index, (uint32_t)i}};
        const philox4x32_ctr_t bits = philox4x32(counter, key);

        /* 53 of each 64 bits, so that 1 is never reached */
        for (int j = 0; j < 2 && i + j < count; ++j)
        {
            const uint64_t word =
                ((uint64_t)bits.v[2 * j] << 32) | bits.v[2 * j + 1];
            uniform[i + j] = (double)(word >> 11) * 0x1.0p-53;
        }
    }
}
