/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    manifoldTest.h - a cell among vortices that is advanced either way, and what
    its observer sees, for the tests of the slow manifold.
*/
#ifndef MANIFOLD_TEST_H
#define MANIFOLD_TEST_H

#include "flowTest.h"

static const double length = 2e-6; /* [m] largest semi-axis */

/* One cell and all that its run needs. */
typedef struct run
{
    ellipsoid_options options;
    ellipsoid_model model;
    test_vortices flow;
    ellipsoid_surroundings around;
    ellipsoid_state state;
    ellipsoid_controller controller;
    ellipsoid_statistics statistics;
    ellipsoid_facet_cache cache;
    double t;
    /* What its observer sees */
    int steps, stop_after;
    long jacobians;
    int explicitly; /* was the last step? */
    ellipsoid_state last;
    double jump, entering; /* [-] between two steps; where it enters */
    int explicit_steps, rosenbrock_steps, entered, left;
} run;

/* The paper's cell among vortices of 50 um or as asked, with their velocity and
   without spin. r must stay where it is. */
static inline void begin(run *r, ellipsoid_integrator integrator,
                         double tolerance, double k)
{
    memset(r, 0, sizeof(*r));
    r->options = test_free_cell();
    r->options.integrator = integrator;
    r->options.tolerance = tolerance;
    r->flow = (test_vortices){4e-3, k};
    r->around.flow = test_vortex_flow;
    r->around.flow_context = &r->flow;
    r->model = test_model(&r->options);
    r->state = test_vortex_state(&r->model, &r->flow);
    ellipsoid_facet_cache_clear(&r->cache);
}

static inline int observe(void *context, const ellipsoid_step *step)
{
    run *r = context;
    const int explicitly = r->statistics.jacobians == r->jacobians;

    if (r->steps > 0)
    {
        const test_errors d = test_difference(&step->before, &r->last);
        const double moved = fmax(d.x / length, d.q);

        if (explicitly && !r->explicitly)
        {
            r->entered++;
            r->entering = fmax(r->entering, moved);
        }
        else
        {
            r->left += !explicitly && r->explicitly;
            r->jump = fmax(r->jump, moved + d.u + d.omega);
        }
    }
    r->last = step->after;
    r->explicitly = explicitly;
    r->jacobians = r->statistics.jacobians;
    r->explicit_steps += explicitly;
    r->rosenbrock_steps += !explicitly;
    return ++r->steps == r->stop_after;
}

static inline ellipsoid_status go(run *r, double end)
{
    return ellipsoid_advance(&(ellipsoid_member){&r->model, &r->around,
                                                 &r->state, &r->controller,
                                                 &r->cache, r, &r->statistics},
                             &r->t, end, observe);
}

/* In units of the semi-axis, and of q. */
static inline double distance(const run *a, const run *b)
{
    const test_errors e = test_difference(&a->state, &b->state);

    return fmax(e.x / length, e.q);
}

#endif
