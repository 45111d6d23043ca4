/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    contactTest.h - bodies that touch walls, for the tests of friction, damping
    and statics.
*/
#ifndef CONTACT_TEST_H
#define CONTACT_TEST_H

#include "coreTest.h"
#include "wallMesh.h"

/* A body among walls, in a flow or in vacuum. */
typedef struct contact_run
{
    ellipsoid_model model;
    ellipsoid_surroundings around;
    test_quadratic flow;
    wall_mesh mesh;
    ellipsoid_state state;
    double t;
    ellipsoid_controller controller;
    ellipsoid_facet_cache cache;
    ellipsoid_statistics statistics;
} contact_run;

/* The floor x3 = 0. */
static inline void contact_floor(contact_run *r, double size)
{
    const double corner[3] = {-size, -size, 0};
    const double u[3] = {2 * size, 0, 0}, v[3] = {0, 2 * size, 0};

    wall_mesh_init(&r->mesh);
    wall_mesh_plane(&r->mesh, corner, u, v, 1, 1, 0, 0);
    wall_mesh_finish(&r->mesh);
}

/* At rest, unturned, at the origin, at time 0. */
static inline void contact_start(contact_run *r,
                                 const ellipsoid_options *options, int vacuum)
{
    r->model = test_model(options);
    r->around =
        (ellipsoid_surroundings){.flow = vacuum ? NULL : test_quadratic_flow,
                                 .flow_context = &r->flow,
                                 .walls = wall_mesh_list,
                                 .walls_context = &r->mesh};
    memset(&r->state, 0, sizeof(r->state));
    r->state.q[3] = 1;
    r->t = 0;
    memset(&r->controller, 0, sizeof(r->controller));
    memset(&r->statistics, 0, sizeof(r->statistics));
    ellipsoid_facet_cache_clear(&r->cache);
}

static inline ellipsoid_status contact_go(contact_run *r, double end)
{
    return ellipsoid_advance(
        &(ellipsoid_member){&r->model, &r->around, &r->state, &r->controller,
                            &r->cache, NULL, &r->statistics},
        &r->t, end, NULL);
}

static inline ellipsoid_contact contact_now(contact_run *r)
{
    ellipsoid_contact contact;

    assert_ok(ellipsoid_contact_evaluate(&r->model, &r->around, &r->state,
                                         &r->cache, &contact, NULL));
    return contact;
}

/* A ball whose only bead is itself, but for rounding; [m], [kg/m3]. */
static inline ellipsoid_options contact_ball(double radius, double density)
{
    ellipsoid_options o = test_paper_options();

    ellipsoid_set(o.semi_axes, radius, radius, radius);
    o.bead_count = 1;
    o.bead_radius = radius * (1 - 1e-12);
    o.density = density;
    o.fluid_density = 1e-12; /* its weight is that in vacuum */
    return o;
}

/* Kinetic energy [J]. */
static inline double contact_energy(const ellipsoid_model *m,
                                    const ellipsoid_state *s)
{
    double sum = 0;

    for (int i = 0; i < 3; i++)
    {
        sum += m->mass * s->u[i] * s->u[i]
             + m->inertia[i] * s->omega[i] * s->omega[i];
    }
    return 0.5 * sum;
}

/* [N/m^1.5] of one bead at a wall */
static inline double contact_stiffness(const ellipsoid_options *o)
{
    return 4.0 / 3 * o->contact_modulus * sqrt(o->bead_radius);
}

#endif
