/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    flowTest.h - a flow that is not a polynomial, a body in it, and how far two
    states differ, for tests of convergence.
*/
#ifndef FLOW_TEST_H
#define FLOW_TEST_H

#include "coreTest.h"

/* Vortices of size pi/k [m] and some shear through them. */
typedef struct test_vortices
{
    double speed, k;
} test_vortices;

static inline int test_vortex_flow(void *context, double t, const double x[3],
                                   int derivatives, ellipsoid_flow_sample *f)
{
    const test_vortices *v = context;
    const double k = v->k, a = v->speed;
    const double sx = sin(k * x[0]), cx = cos(k * x[0]);
    const double sy = sin(k * x[1]), cy = cos(k * x[1]);
    const double sz = sin(k * x[2]), cz = cos(k * x[2]);

    (void)t;
    memset(f, 0, sizeof(*f));
    f->velocity[0] = a * (sx * cy + cz);
    f->velocity[1] = -a * (cx * sy - 0.5 * sz);
    f->velocity[2] = a * (0.5 * sx + 0.3 * cy);
    f->gradient[0][0] = a * k * cx * cy;
    f->gradient[0][1] = -a * k * sx * sy;
    f->gradient[0][2] = -a * k * sz;
    f->gradient[1][0] = a * k * sx * sy;
    f->gradient[1][1] = -a * k * cx * cy;
    f->gradient[1][2] = 0.5 * a * k * cz;
    f->gradient[2][0] = 0.5 * a * k * cx;
    f->gradient[2][1] = -0.3 * a * k * sy;
    if (derivatives)
    {
        double(*h)[3][3] = f->gradient_jacobian;
        const double s = a * k * k;

        memcpy(f->velocity_jacobian, f->gradient, sizeof(f->gradient));
        h[0][0][0] = -s * sx * cy;
        h[0][0][1] = h[0][1][0] = -s * cx * sy;
        h[0][1][1] = -s * sx * cy;
        h[0][2][2] = -s * cz;
        h[1][0][0] = s * cx * sy;
        h[1][0][1] = h[1][1][0] = s * sx * cy;
        h[1][1][1] = s * cx * sy;
        h[1][2][2] = -0.5 * s * sz;
        h[2][0][0] = -0.5 * s * sx;
        h[2][1][1] = -0.3 * s * cy;
    }
    return 0;
}

/* A body and a fluid of order one: every time scale is of order one. */
static inline ellipsoid_model test_unit_body(void)
{
    ellipsoid_options o = test_free_cell();

    o.density = 3;
    o.fluid_density = 1;
    o.kinematic_viscosity = 0.5;
    o.semi_axes[0] = 0.8;
    o.semi_axes[1] = 1.5;
    o.semi_axes[2] = 0.5;
    o.external_torque[1] = 1;
    return test_model(&o);
}

static inline ellipsoid_state test_vortex_state(const ellipsoid_model *model,
                                                test_vortices *flow)
{
    const double a = model->options.semi_axes[1];
    ellipsoid_state s = {.x = {0.3 * a, 0.2 * a, 0.5 * a},
                         .q = {0.1, 0.2, 0.3, 0.9}};
    ellipsoid_flow_sample sample;

    ellipsoid_normalise(s.q);
    test_vortex_flow(flow, 0, s.x, 0, &sample);
    memcpy(s.u, sample.velocity, sizeof(s.u));
    return s;
}

typedef struct test_errors
{
    double u, x, omega, q;
} test_errors;

static inline double test_distance(const double *a, const double *b, int count)
{
    double sum = 0;

    for (int i = 0; i < count; i++)
    {
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    }
    return sqrt(sum);
}

static inline test_errors test_difference(const ellipsoid_state *a,
                                          const ellipsoid_state *b)
{
    const test_errors e = {
        test_distance(a->u, b->u, 3), test_distance(a->x, b->x, 3),
        test_distance(a->omega, b->omega, 3), test_distance(a->q, b->q, 4)};

    return e;
}

#endif
