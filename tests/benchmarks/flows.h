/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    flows.h - flows given by formulas, with exact derivatives.
*/
#ifndef BENCHMARK_FLOWS_H
#define BENCHMARK_FLOWS_H

#include "ellipsoid.h"

typedef struct benchmark_flow
{
    double speed; /* [m/s] */
    double size;  /* [m] */
} benchmark_flow;

/*
    Plane Poiseuille flow between walls at x3 = -size/2 and size/2:
    u = (0, speed (1 - (2 x3/size)^2), 0); speed is that in the middle.
*/
int benchmark_slit_flow(void *context, double t, const double x[3],
                        int derivatives, ellipsoid_flow_sample *sample);

/*
    Taylor and Green's vortices in cells of size^2 with a third component that
    makes the curl of u parallel to u: with k = pi/size,
    u = speed (sin k x1 cos k x2, -cos k x1 sin k x2,
               sqrt(2) sin k x1 sin k x2), curl u = sqrt(2) k u.
*/
int benchmark_helical_flow(void *context, double t, const double x[3],
                           int derivatives, ellipsoid_flow_sample *sample);

#endif
