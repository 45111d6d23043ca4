/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    fuzzInput.h - bytes become numbers, options and states.

    Bytes that are missing are zeros, and zeros mean the plainest case. So every
    input is valid, and a short one stands for a simple case.
*/
#ifndef FUZZ_INPUT_H
#define FUZZ_INPUT_H

#include "ellipsoid.h"

/* Ends the process; the fuzzer keeps the input. */
#define require(condition)                                                     \
    ((condition) ? (void)0 : fuzz_fail(#condition, __FILE__, __LINE__))

void fuzz_fail(const char *condition, const char *file, int line);

typedef struct fuzz_input
{
    const uint8_t *data;
    size_t size; /* left */
} fuzz_input;

/* An integer of so many bytes, at most 8. */
uint64_t fuzz_bits(fuzz_input *in, int bytes);

/* 0 to count - 1, count at most 256. */
int fuzz_choice(fuzz_input *in, int count);

/* Uniform, or its logarithm uniform, in [low, high). */
double fuzz_between(fuzz_input *in, double low, double high);
double fuzz_scaled(fuzz_input *in, double low, double high);

/* Each component in [-size, size). */
void fuzz_vector(fuzz_input *in, double size, int count, double *v);

/* Any number: infinities, NaN, denormals and whatever eight bytes can say. */
double fuzz_wild(fuzz_input *in);

/* Options that the core must take; wild ones it may refuse. */
ellipsoid_options fuzz_options(fuzz_input *in);
void fuzz_wild_options(fuzz_input *in, ellipsoid_options *options);

/* A state at lengths [m] and speeds [m/s] of these sizes; q is of length near
   one. A wild state has one or more wild components. */
void fuzz_state(fuzz_input *in, double length, double speed,
                ellipsoid_state *state);
void fuzz_wild_state(fuzz_input *in, ellipsoid_state *state);

#endif
