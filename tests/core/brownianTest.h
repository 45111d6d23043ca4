/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow Copyright (C) 2026 the
    ellipsoidTrapFoam authors SPDX-License-Identifier: GPL-3.0-or-later

    brownianTest.h - one Brownian cell, an interval at a time, and statistics.

    Seeds are fixed, so no test is flaky: a bound of n sigma says how unlikely
    it is that a right program had failed when its seed was chosen. 5 sigma of a
    normal estimator are 6e-7, both sides.
*/
#ifndef BROWNIAN_TEST_H
#define BROWNIAN_TEST_H

#include "coreTest.h"

#include <stdlib.h>

static const double test_kt = 1.380649e-23 * 298.15; /* [J] */

static inline int test_still_flow(void *context, double t, const double x[3],
                                  int derivatives,
                                  ellipsoid_flow_sample *sample)
{
    (void)t;
    (void)context;
    (void)x;
    (void)derivatives;
    memset(sample, 0, sizeof(*sample));
    return 0;
}

/* The paper's cell in water of 298.15 K and 1e-3 Pa s, without weight. */
static inline ellipsoid_options test_brownian(ellipsoid_motion motion,
                                              double interval)
{
    ellipsoid_options o = test_free_cell();

    o.fluid_density = 1000;
    o.motion = motion;
    o.brownian = 1;
    o.noise_interval = interval;
    return o;
}

static inline const char *test_motion_name(ellipsoid_motion motion)
{
    return motion == ELLIPSOID_MOTION_INERTIAL ? "inertial" : "inertialess";
}

/* A cell after n intervals. */
typedef struct test_walk
{
    ellipsoid_model model;
    ellipsoid_surroundings around;
    ellipsoid_facet_cache *cache;
    ellipsoid_state state;
    ellipsoid_controller controller;
    ellipsoid_statistics statistics;
    double t;
    long n;
} test_walk;

static inline test_walk test_walk_of(const ellipsoid_options *options,
                                     uint64_t seed, uint32_t id)
{
    test_walk w = {.model = test_model(options)};

    w.around.flow = test_still_flow;
    w.around.seed = seed;
    w.around.id = id;
    w.state.q[3] = 1;
    return w;
}

static inline ellipsoid_status test_walk_to(test_walk *w, double end)
{
    return ellipsoid_advance(
        &(ellipsoid_member){&w->model, &w->around, &w->state, &w->controller,
                            w->cache, NULL, &w->statistics},
        &w->t, end, NULL);
}

static inline void test_walk_on(test_walk *w)
{
    w->n++;
    assert_ok(test_walk_to(w, (double)w->n * w->model.options.noise_interval));
}

/* A vector of the lab along the body axes of a state. */
static inline void test_in_body(const ellipsoid_state *state,
                                const double lab[3], double body[3])
{
    double r[3][3];

    ellipsoid_rotation(state->q, r);
    for (int i = 0; i < 3; i++)
    {
        body[i] = r[0][i] * lab[0] + r[1][i] * lab[1] + r[2][i] * lab[2];
    }
}

/* The motion from a to b along the body axes of a: displacement [m], and the
   rotation vector [rad]. */
static inline void test_moved(const ellipsoid_state *a,
                              const ellipsoid_state *b, double moved[6])
{
    const double *p = a->q, *q = b->q;
    double way[3], turn[3], cosine, sine, scale;

    ellipsoid_difference(b->x, a->x, way);
    test_in_body(a, way, moved);
    for (int i = 0; i < 3; i++)
    {
        const int j = (i + 1) % 3, k = (i + 2) % 3;

        turn[i] = p[3] * q[i] - q[3] * p[i] - (p[j] * q[k] - p[k] * q[j]);
    }
    cosine = ellipsoid_dot(p, q) + p[3] * q[3];
    sine = ellipsoid_length(turn);
    scale = sine > 0 ? 2 * atan2(sine, cosine) / sine : 2;
    for (int i = 0; i < 3; i++)
    {
        moved[3 + i] = scale * turn[i];
    }
}

/* Of the six directions: inertia [kg, kg m2], 1/drag [s/kg, 1/(J s)]. */
static inline double test_inertia(const ellipsoid_model *m, int i)
{
    return i < 3 ? m->mass : m->inertia[i - 3];
}

static inline double test_mobility(const ellipsoid_model *m, int i)
{
    return i < 3 ? m->mobility[i] : m->rotation_mobility[i - 3];
}

/* ----------------------------------------------- an interval in closed form */

/*
    With a force F of variance 2 kT zeta/dt, constant over an interval, and
    zeta = m/tau, m dv/dt = F - zeta v is solved by (s = dt/tau, b = F/zeta)
        v(dt) = b + (v0 - b) exp(-s),
        x(dt) = b dt + tau (v0 - b) (1 - exp(-s)),
    for each of the six directions with its own tau, 0 without inertia. Here of
    a body that does not turn: its v and x are Gaussian and all means known.
*/
static inline void test_closed_form(const ellipsoid_model *m,
                                    const double normal[6], double v[6],
                                    double x[6])
{
    const double dt = m->options.noise_interval;
    const double kt = test_kt / 298.15 * m->options.temperature;

    for (int i = 0; i < 6; i++)
    {
        const double mobility = test_mobility(m, i);
        const double tau = m->options.motion == ELLIPSOID_MOTION_INERTIAL
                             ? test_inertia(m, i) * mobility
                             : 0;
        const double decay = tau > 0 ? exp(-dt / tau) : 0;
        const double b = sqrt(2 * kt * mobility / dt) * normal[i];

        x[i] = b * dt + tau * (v[i] - b) * (1 - decay);
        v[i] = b + (v[i] - b) * decay;
    }
}

/*
    The interval of a free body without inertia: force and torque are fixed in
    the body, so that it moves and turns steadily. Over an angle A about k: q
    times (k sin(A/2), cos(A/2)), and x by R(q) [u + (1 - cos A)/A k x u +
    (1 - sin A/A) k x (k x u)] dt.
*/
static inline void test_move_steadily(const ellipsoid_model *m,
                                      const double normal[6],
                                      ellipsoid_state *state)
{
    const double *p = state->q;
    double v[6] = {0}, way[6], k[3], once[3], twice[3], r[3][3], q[4], angle;

    test_closed_form(m, normal, v, way);
    angle = ellipsoid_length(way + 3);
    for (int i = 0; i < 3; i++)
    {
        k[i] = way[3 + i] / angle;
    }
    ellipsoid_cross(k, way, once);
    ellipsoid_cross(k, once, twice);
    ellipsoid_rotation(p, r);
    for (int i = 0; i < 3; i++)
    {
        way[i] += (1 - cos(angle)) / angle * once[i]
                + (1 - sin(angle) / angle) * twice[i];
        k[i] *= sin(0.5 * angle);
    }
    ellipsoid_cross(p, k, q);
    for (int i = 0; i < 3; i++)
    {
        state->x[i] += ellipsoid_dot(r[i], way);
        q[i] += p[3] * k[i] + cos(0.5 * angle) * p[i];
    }
    q[3] = p[3] * cos(0.5 * angle) - ellipsoid_dot(p, k);
    memcpy(state->q, q, sizeof(q));
}

/* ------------------------------------------------------------ statistics */

/* Mean and scatter of a sample (Welford, Technometrics 4, 419 (1962)). */
typedef struct test_sample
{
    long count;
    double mean, squares;
} test_sample;

static inline void test_sample_add(test_sample *s, double value)
{
    const double from = value - s->mean;

    s->count++;
    s->mean += from / (double)s->count;
    s->squares += from * (value - s->mean);
}

/* The standard deviation of the mean, by the sample's own scatter. */
static inline double test_sample_sigma(const test_sample *s)
{
    return sqrt(s->squares / ((double)s->count * (double)(s->count - 1)));
}

static inline int test_ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

typedef double (*test_distribution)(const void *context, double value);

/*
    Kolmogorov & Smirnov: sqrt(n) times the largest distance between the
    sample's distribution and the given one. A right one gives more than c with
    the probability 2 exp(-2 c^2). Sorts the values.
*/
static inline double test_kolmogorov(double *value, int count,
                                     test_distribution distribution,
                                     const void *context)
{
    double worst = 0;

    qsort(value, (size_t)count, sizeof(*value), test_ascending);
    for (int n = 0; n < count; n++)
    {
        const double f = distribution(context, value[n]);

        worst = fmax(worst,
                     fmax(f - n / (double)count, (n + 1) / (double)count - f));
    }
    return sqrt(count) * worst;
}

#endif
