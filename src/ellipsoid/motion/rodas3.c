/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    rodas3.c - the coefficients of Rodas3.

    Sandu et al., Atmos. Environ. 31, 3459 (1997): four stages, the second at
    the start, so that a step takes two evaluations besides that with
    derivatives, where RODAS4P2 takes five; order 3(2), L-stable, stiffly
    accurate.
*/
#include "motion/motion.h"

const ellipsoid_rosenbrock_table ellipsoid_rosenbrock_third = {
    .stages = 4,
    .order = 3,
    .gamma = 0.5,
    .a = {{0}, {0}, {2, 0}, {2, 0, 1}},
    .c = {{0}, {4}, {1, -1}, {1, -1, -8.0 / 3}},
    .alpha = {0, 0, 1, 1},
    .gamma_sum = {0.5, 1.5, 0, 0},
    .in_time = {0, 1, 2, 3},
};
