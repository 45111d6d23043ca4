/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    peer.h - the core's equations solved by SUNDIALS CVODE.
*/
#ifndef BENCHMARK_PEER_H
#define BENCHMARK_PEER_H

#include "trials.h"

#include <cvode/cvode.h>

/* What errors count against, times the tolerance. */
typedef enum benchmark_weights
{
    /* x: largest semi-axis, q: 1, u and omega by what they do to x and q within
       one relaxation time, as the core counts them; no relative part */
    BENCHMARK_BY_EFFECT,
    /* u: speed of the flow, omega: its gradient; no relative part */
    BENCHMARK_BY_FLOW,
    /* the same and as much of each unknown's own size */
    BENCHMARK_RELATIVE,
    BENCHMARK_WEIGHTS
} benchmark_weights;

typedef struct benchmark_peer
{
    ellipsoid_motion motion; /* INERTIAL: thirteen unknowns by BDF and dense
                                  Newton; INERTIALESS: seven by Adams and
                                  fixed-point iteration */
    benchmark_weights weights;
    int exact_jacobian; /* ellipsoid_jacobian(), or differences */

    const benchmark_journey *journey;
    ellipsoid_model model;
    double tolerance;
    void *solver;
    SUNContext sun;
    N_Vector y, scale;
    SUNMatrix matrix;
    SUNLinearSolver linear;
    SUNNonlinearSolver nonlinear;
} benchmark_peer;

/* Its method; what it holds is freed by benchmark_peer_free(). */
benchmark_method benchmark_peer_method(const char *name, benchmark_peer *peer);

void benchmark_peer_free(benchmark_peer *peer);

#endif
