/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    peer.c - the core's equations solved by SUNDIALS CVODE.

    The solver is made once and started anew for every trajectory, so that no
    memory is asked for while time is taken. Everything is left as CVODE has it
    but the tolerances, the Jacobian and the bound on the number of steps.
*/
#include "peer.h"

#include <math.h>
#include <string.h>

#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

enum
{
    SIZE = ELLIPSOID_STATE_SIZE,
    U = 0,
    X = 3,
    W = 6,
    Q = 9,
    REDUCED = 7 /* x and q */
};

/* 1: the solver may try a shorter step */
static int answer(ellipsoid_status status)
{
    return status == ELLIPSOID_OK             ? 0
         : status == ELLIPSOID_STEP_UNDERFLOW ? 1
                                              : -1;
}

static void normalise(double q[4])
{
    const double length =
        sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);

    for (int n = 0; n < 4; n++)
    {
        q[n] /= length;
    }
}

/* CVODE does not keep q at length one. Without normalising, what grows of |q|
   acts as a larger body and costs it up to a quarter of its time. */
static ellipsoid_state state_of(const double *y)
{
    ellipsoid_state state;

    memcpy(&state, y, sizeof(state));
    normalise(state.q);
    return state;
}

static int thirteen(sunrealtype t, N_Vector y, N_Vector rate, void *context)
{
    const benchmark_peer *p = context;
    const ellipsoid_state state = state_of(NV_DATA_S(y));

    (void)t;
    return answer(ellipsoid_rhs(&p->model, &p->journey->around, &state, NULL,
                                (ellipsoid_state *)NV_DATA_S(rate)));
}

static int jacobian(sunrealtype t, N_Vector y, N_Vector rate, SUNMatrix matrix,
                    void *context, N_Vector a, N_Vector b, N_Vector c)
{
    const benchmark_peer *p = context;
    const ellipsoid_state state = state_of(NV_DATA_S(y));
    double j[SIZE][SIZE];
    const ellipsoid_status status =
        ellipsoid_jacobian(&p->model, &p->journey->around, &state, NULL, j);

    (void)t, (void)rate, (void)a, (void)b, (void)c;
    for (int n = 0; n < SIZE; n++)
    {
        sunrealtype *column = SM_COLUMN_D(matrix, n);

        for (int i = 0; i < SIZE; i++)
        {
            column[i] = j[i][n];
        }
    }
    return answer(status);
}

static int seven(sunrealtype t, N_Vector y, N_Vector rate, void *context)
{
    const benchmark_peer *p = context;
    ellipsoid_state state, derivative;
    ellipsoid_status status;

    (void)t;
    memcpy(state.x, NV_DATA_S(y), sizeof(state.x));
    memcpy(state.q, NV_DATA_S(y) + 3, sizeof(state.q));
    normalise(state.q);
    status = ellipsoid_rhs(&p->model, &p->journey->around, &state, NULL,
                           &derivative);
    memcpy(NV_DATA_S(rate), derivative.x, sizeof(state.x));
    memcpy(NV_DATA_S(rate) + 3, derivative.q, sizeof(state.q));
    return answer(status);
}

static void set_scales(benchmark_peer *p)
{
    const double *axes = p->model.options.semi_axes;
    const benchmark_flow *flow = &p->journey->flow;
    const double length = fmax(axes[0], fmax(axes[1], axes[2]));
    const int by_effect = p->weights == BENCHMARK_BY_EFFECT;
    double scale[SIZE];

    for (int i = 0; i < 3; i++)
    {
        scale[U + i] =
            by_effect ? length / p->model.relaxation_time : flow->speed;
        scale[X + i] = length;
        scale[W + i] = by_effect ? 1 / p->model.rotation_relaxation_time
                                 : flow->speed / flow->size;
    }
    for (int i = 0; i < 4; i++)
    {
        scale[Q + i] = 1;
    }
    for (int i = 0; i < SIZE; i++)
    {
        scale[i] *= p->tolerance;
    }
    if (p->motion == ELLIPSOID_MOTION_INERTIALESS)
    {
        memcpy(NV_DATA_S(p->scale), scale + X, 3 * sizeof(double));
        memcpy(NV_DATA_S(p->scale) + 3, scale + Q, 4 * sizeof(double));
    }
    else
    {
        memcpy(NV_DATA_S(p->scale), scale, sizeof(scale));
    }
}

/* Returns 0, or not if CVODE refuses. */
static int create(benchmark_peer *p)
{
    const int full = p->motion == ELLIPSOID_MOTION_INERTIAL;
    const sunindextype size = full ? SIZE : REDUCED;

    if (SUNContext_Create(NULL, &p->sun))
    {
        return 1;
    }
    p->y = N_VNew_Serial(size, p->sun);
    p->scale = N_VNew_Serial(size, p->sun);
    p->solver = CVodeCreate(full ? CV_BDF : CV_ADAMS, p->sun);
    if (!p->y || !p->scale || !p->solver
        || CVodeInit(p->solver, full ? thirteen : seven, 0, p->y)
        || CVodeSetUserData(p->solver, p)
        || CVodeSetMaxNumSteps(p->solver, 100000000)
        || CVodeSetErrFile(p->solver, NULL))
    {
        return 1;
    }
    if (!full)
    {
        p->nonlinear = SUNNonlinSol_FixedPoint(p->y, 0, p->sun);
        return !p->nonlinear
            || CVodeSetNonlinearSolver(p->solver, p->nonlinear);
    }
    p->matrix = SUNDenseMatrix(size, size, p->sun);
    p->linear = SUNLinSol_Dense(p->y, p->matrix, p->sun);
    return !p->matrix || !p->linear
        || CVodeSetLinearSolver(p->solver, p->linear, p->matrix)
        || (p->exact_jacobian && CVodeSetJacFn(p->solver, jacobian));
}

static int prepare(void *context, const benchmark_journey *journey,
                   double tolerance)
{
    benchmark_peer *p = context;

    p->journey = journey;
    p->tolerance = tolerance;
    p->model = benchmark_model(journey, p->motion, tolerance);
    if (!p->solver && create(p))
    {
        return 1;
    }
    set_scales(p);
    return CVodeSVtolerances(
        p->solver, p->weights == BENCHMARK_RELATIVE ? tolerance : 0, p->scale);
}

static int run(void *context, ellipsoid_state *state, benchmark_cost *cost)
{
    benchmark_peer *p = context;
    const int full = p->motion == ELLIPSOID_MOTION_INERTIAL;
    double *y = NV_DATA_S(p->y);
    long evaluations = 0, differences = 0, jacobians = 0;
    sunrealtype t = 0;

    if (full)
    {
        memcpy(y, state, sizeof(*state));
    }
    else
    {
        memcpy(y, state->x, sizeof(state->x));
        memcpy(y + 3, state->q, sizeof(state->q));
    }
    if (CVodeReInit(p->solver, 0, p->y)
        || CVode(p->solver, p->journey->duration, p->y, &t, CV_NORMAL) < 0)
    {
        return 1;
    }
    if (full)
    {
        memcpy(state, y, sizeof(*state));
        CVodeGetNumLinRhsEvals(p->solver, &differences);
        CVodeGetNumJacEvals(p->solver, &jacobians);
    }
    else
    {
        memcpy(state->x, y, sizeof(state->x));
        memcpy(state->q, y + 3, sizeof(state->q));
    }
    normalise(state->q);
    CVodeGetNumSteps(p->solver, &cost->steps);
    CVodeGetNumRhsEvals(p->solver, &evaluations);
    cost->rhs = evaluations + differences + (p->exact_jacobian ? jacobians : 0);
    return 0;
}

benchmark_method benchmark_peer_method(const char *name, benchmark_peer *peer)
{
    return (benchmark_method){name, prepare, run, peer};
}

void benchmark_peer_free(benchmark_peer *peer)
{
    if (peer->solver)
    {
        CVodeFree(&peer->solver);
    }
    if (peer->linear)
    {
        SUNLinSolFree(peer->linear);
        SUNMatDestroy(peer->matrix);
    }
    if (peer->nonlinear)
    {
        SUNNonlinSolFree(peer->nonlinear);
    }
    if (peer->sun)
    {
        N_VDestroy(peer->y);
        N_VDestroy(peer->scale);
        SUNContext_Free(&peer->sun);
    }
}
