/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    faxenTest.h - bodies that the flow acts on all over.
*/
#ifndef FAXEN_TEST_H
#define FAXEN_TEST_H

#include "coreTest.h"

static inline ellipsoid_model body(double a1, double a2, double a3)
{
    ellipsoid_options o = test_free_cell();

    o.flow_at = ELLIPSOID_FLOW_BODY;
    o.pressure_gradient = ELLIPSOID_PRESSURE_NONE;
    o.motion = ELLIPSOID_MOTION_INERTIALESS;
    ellipsoid_set(o.semi_axes, a1, a2, a3);
    return test_model(&o);
}

/* The motion of a free body, from a flow. */
static inline void free_motion(const ellipsoid_model *model,
                               ellipsoid_flow_function flow, void *context,
                               const double x[3], const double q[4],
                               double u[3], double omega[3])
{
    const ellipsoid_surroundings around = {.flow = flow,
                                           .flow_context = context};
    ellipsoid_state s = {.q = {q[0], q[1], q[2], q[3]}};

    ellipsoid_copy(x, s.x);
    assert_ok(ellipsoid_balance(model, &around, &s, NULL));
    ellipsoid_copy(s.u, u);
    ellipsoid_copy(s.omega, omega);
}

#endif
