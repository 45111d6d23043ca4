/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    fuzzCheck.h - checks of what ellipsoid.h promises, by parts of the core.
*/
#ifndef FUZZ_CHECK_H
#define FUZZ_CHECK_H

#include "fuzzScene.h"
#include "walls/walls.h"

#include <math.h>
#include <string.h>

/* Two runs did the same to the last bit. */
#define require_same(a, b) require(memcmp(&(a), &(b), sizeof(a)) == 0)

static inline int fuzz_all_finite(const void *numbers, size_t bytes)
{
    const double *v = numbers;

    for (size_t n = 0; n < bytes / sizeof *v; n++)
    {
        if (!isfinite(v[n]))
        {
            return 0;
        }
    }
    return 1;
}

/* Within the rounding of the four squares and of a root */
static inline int fuzz_is_unit(const double q[4])
{
    const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];

    return fabs(square - 1) <= 2e-14;
}

/* Returns 0 if the options are refused. */
int fuzz_check_model(const ellipsoid_options *options, ellipsoid_model *model);

void fuzz_check_rotations(fuzz_input *in);
void fuzz_check_random(fuzz_input *in);

/* In one pose: neither the cache's past, nor facets beyond those asked for, nor
   whether derivatives are wanted, changes a bit. */
void fuzz_check_pose(const ellipsoid_model *model, fuzz_scene *scene,
                     const ellipsoid_state *state, ellipsoid_facet_cache *warm);

/* One bead and all facets */
void fuzz_check_bead(const fuzz_scene *scene, fuzz_input *in);

/* tame: nothing but smooth flows, numbers of usual size and answers of 0, so
   that there must be a result. */
void fuzz_check_equations(const ellipsoid_model *model, fuzz_scene *scene,
                          const ellipsoid_state *state, int tame);

/* Where a run begins and ends */
typedef struct fuzz_start
{
    ellipsoid_state state;
    double t, end;
    ellipsoid_controller controller;
    ellipsoid_statistics statistics;
} fuzz_start;

/* The same bits, whether observed or not, whatever the cache held, and if it
   is stopped and continued. */
void fuzz_check_advance(const ellipsoid_model *model, fuzz_scene *scene,
                        const fuzz_start *start, int tame,
                        ellipsoid_facet_cache *warm);

#endif
