/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    referenceSphere.h - a Brownian sphere over the wall x3 = 0 with the noise of
    a cell, by formulas of its own.

    Contact pushes through its centre, so that it turns as a free body does,
    steadily in an interval, and the noise, which is fixed in the body, with it.
    It costs a tenth of a cell's interval and less. Distributions are tested of the
    reference, over a whole sample; of the cells, fewer, how far they are from
    it.
*/
#ifndef REFERENCE_SPHERE_H
#define REFERENCE_SPHERE_H

#include "brownianTest.h"

typedef struct reference
{
    ellipsoid_model model; /* inertialess: tau is 1e-4 of an interval */
    ellipsoid_state state; /* its orientation */
    double height;         /* [m] of the centre */
    uint64_t seed;
    uint32_t id;
    long n;
} reference;

static inline reference reference_of(ellipsoid_options options, uint64_t seed,
                                     uint32_t id, double height)
{
    reference r = {.height = height, .seed = seed, .id = id};

    options.motion = ELLIPSOID_MOTION_INERTIALESS;
    r.model = test_model(&options);
    r.state.q[3] = 1;
    return r;
}

/* Turns it over the next interval. push: the velocity [m/s] along x3 by the
   noise at the beginning, the middle and the end. */
static inline void reference_turn(reference *r, double push[3])
{
    const double speed = sqrt(2 * test_kt * r->model.mobility[2]
                              / r->model.options.noise_interval);
    double normal[6], q[3][4], rotation[3][3];

    ellipsoid_random_normal(r->seed, r->id, r->n++, normal);
    memcpy(q[0], r->state.q, sizeof(q[0]));
    test_move_steadily(&r->model, normal, &r->state);
    memcpy(q[2], r->state.q, sizeof(q[2]));
    for (int n = 0; n < 4; n++)
    {
        q[1][n] = 0.5 * (q[0][n] + q[2][n]);
    }
    ellipsoid_normalise(q[1]);
    for (int k = 0; k < 3; k++)
    {
        ellipsoid_rotation(q[k], rotation);
        push[k] = speed * ellipsoid_dot(rotation[2], normal);
    }
}

/* The mean of the three, by Simpson's rule. */
static inline double reference_mean(const double push[3])
{
    return (push[0] + 4 * push[1] + push[2]) / 6;
}

/* dh/dt [m/s]: Hertz's force F = k d^(3/2), the weight, and what pushes. */
static inline double reference_rate(const ellipsoid_model *m, double height,
                                    double push)
{
    const ellipsoid_options *o = &m->options;
    const double k = 4.0 / 3 * o->contact_modulus * sqrt(o->bead_radius);
    const double depth = fmax(0, o->bead_radius - height);

    return push
         + m->mobility[2] * (k * depth * sqrt(depth) + m->constant_force[2]);
}

/* An interval by the classical Runge-Kutta method, in steps of 0.3 of the time
   in which a sphere that is pressed in to its centre relaxes; the push is a
   parabola through the three. */
static inline void reference_on(reference *r)
{
    const ellipsoid_options *o = &r->model.options;
    const double dt = o->noise_interval;
    const double stiffest =
        r->model.mobility[2] * 2 * o->contact_modulus * o->bead_radius;
    const int steps = 1 + (int)(dt * stiffest / 0.3);
    const double h = dt / steps;
    double push[3];

    reference_turn(r, push);
    for (int n = 0; n < steps; n++)
    {
        double p[3], k[4], x = r->height;

        for (int i = 0; i < 3; i++)
        {
            const double s = (n + 0.5 * i) / steps;

            p[i] = push[0] * (1 - s) * (1 - 2 * s) + push[1] * 4 * s * (1 - s)
                 + push[2] * s * (2 * s - 1);
        }
        k[0] = reference_rate(&r->model, x, p[0]);
        k[1] = reference_rate(&r->model, x + 0.5 * h * k[0], p[1]);
        k[2] = reference_rate(&r->model, x + 0.5 * h * k[1], p[1]);
        k[3] = reference_rate(&r->model, x + h * k[2], p[2]);
        r->height += h * (k[0] + 2 * (k[1] + k[2]) + k[3]) / 6;
    }
}

#endif
