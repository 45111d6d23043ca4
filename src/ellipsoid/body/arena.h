/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    arena.h - pieces of a caller's memory.
*/
#ifndef ELLIPSOID_ARENA_H
#define ELLIPSOID_ARENA_H

#include <stddef.h>

/* What is left of it. */
typedef struct ellipsoid_arena
{
    char *next;
    size_t left; /* [bytes] */
} ellipsoid_arena;

/* All pieces begin as malloc() has them. */
#define ELLIPSOID_ALIGNMENT 16

/* Bytes that a piece takes. */
static inline size_t ellipsoid_piece(size_t count, size_t size)
{
    return (count * size + ELLIPSOID_ALIGNMENT - 1) / ELLIPSOID_ALIGNMENT
         * ELLIPSOID_ALIGNMENT;
}

/* NULL if there is too little. */
static inline void *ellipsoid_take(ellipsoid_arena *arena, size_t count,
                                   size_t size)
{
    const size_t bytes = ellipsoid_piece(count, size);
    void *taken = arena->next;

    if (bytes > arena->left)
    {
        return NULL;
    }
    arena->next += bytes;
    arena->left -= bytes;
    return taken;
}

#endif
