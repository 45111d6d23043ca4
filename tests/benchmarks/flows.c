/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    flows.c - flows given by formulas, with exact derivatives.
*/
#include "flows.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

static void set_derivatives(ellipsoid_flow_sample *f)
{
    memcpy(f->velocity_jacobian, f->gradient, sizeof(f->gradient));
    memset(f->gradient_jacobian, 0, sizeof(f->gradient_jacobian));
}

int benchmark_slit_flow(void *context, double t, const double x[3],
                        int derivatives, ellipsoid_flow_sample *f)
{
    const benchmark_flow *flow = context;
    const double across = 2 / flow->size, s = across * x[2];

    (void)t;
    memset(f->velocity, 0, sizeof(f->velocity));
    memset(f->gradient, 0, sizeof(f->gradient));
    f->velocity[1] = flow->speed * (1 - s * s);
    f->gradient[1][2] = -2 * flow->speed * across * s;
    if (derivatives)
    {
        set_derivatives(f);
        f->gradient_jacobian[1][2][2] = -2 * flow->speed * across * across;
    }
    return 0;
}

int benchmark_helical_flow(void *context, double t, const double x[3],
                           int derivatives, ellipsoid_flow_sample *f)
{
    const benchmark_flow *flow = context;
    const double k = pi / flow->size, root = sqrt(2.0);
    const double a = flow->speed, b = a * k;
    const double s1 = sin(k * x[0]), c1 = cos(k * x[0]);
    const double s2 = sin(k * x[1]), c2 = cos(k * x[1]);

    (void)t;
    f->velocity[0] = a * s1 * c2;
    f->velocity[1] = -a * c1 * s2;
    f->velocity[2] = root * a * s1 * s2;
    memset(f->gradient, 0, sizeof(f->gradient));
    f->gradient[0][0] = b * c1 * c2;
    f->gradient[0][1] = -b * s1 * s2;
    f->gradient[1][0] = b * s1 * s2;
    f->gradient[1][1] = -b * c1 * c2;
    f->gradient[2][0] = root * b * c1 * s2;
    f->gradient[2][1] = root * b * s1 * c2;
    if (derivatives)
    {
        double(*h)[3][3] = f->gradient_jacobian;
        const double c = b * k;

        set_derivatives(f);
        h[0][0][0] = h[0][1][1] = -c * s1 * c2;
        h[0][0][1] = h[0][1][0] = -c * c1 * s2;
        h[1][0][0] = h[1][1][1] = c * c1 * s2;
        h[1][0][1] = h[1][1][0] = c * s1 * c2;
        h[2][0][0] = h[2][1][1] = -root * c * s1 * s2;
        h[2][0][1] = h[2][1][0] = root * c * c1 * c2;
    }
    return 0;
}
