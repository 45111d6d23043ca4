/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    brownianProfile.h - the wall x3 = 0, and Boltzmann's distribution of a body
    over it, by numeric integration.
*/
#ifndef BROWNIAN_PROFILE_H
#define BROWNIAN_PROFILE_H

#include "brownianTest.h"
#include "wallMesh.h"

static const double radius = 0.499999e-6; /* [m] of the sphere's one bead */
static const double scale = 0.2e-6;       /* [m] kT/weight of the sphere */

/* The wall x3 = 0, far beyond where a cell gets in a test. */
static wall_mesh wall;
static ellipsoid_facet_cache cache;

static inline test_walk walk_over_wall(const ellipsoid_options *options,
                                       uint64_t seed, uint32_t id,
                                       double height)
{
    test_walk w = test_walk_of(options, seed, id);

    w.around.walls = wall_mesh_list;
    w.around.walls_context = &wall;
    w.cache = &cache;
    w.state.x[2] = height;
    ellipsoid_facet_cache_clear(&cache);
    return w;
}

static int build_wall(void **unused)
{
    const double corner[3] = {-1e-3, -1e-3, 0};
    const double u[3] = {2e-3, 0, 0}, v[3] = {0, 2e-3, 0};

    (void)unused;
    wall_mesh_init(&wall);
    wall_mesh_plane(&wall, corner, u, v, 1, 1, 0, 0);
    wall_mesh_finish(&wall);
    return 0;
}

static int free_wall(void **unused)
{
    (void)unused;
    wall_mesh_free(&wall);
    return 0;
}

/* Of equal cells in height: the sum up to the end of each, and moments. */
enum
{
    CELLS = 4000
};

typedef struct profile
{
    double low, width; /* [m] */
    double sum[CELLS + 1];
    double mean, deviation; /* [m] */
    double upright;         /* <O3^2> */
} profile;

/* From the densities of the cells, in sum[1] and on. */
static inline void normalise(profile *p, double upright)
{
    double total = 0, first = 0, second = 0;

    for (int n = 1; n <= CELLS; n++)
    {
        const double h = p->low + (n - 0.5) * p->width;

        total += p->sum[n];
        first += p->sum[n] * h;
        second += p->sum[n] * h * h;
        p->sum[n] = total;
    }
    for (int n = 1; n <= CELLS; n++)
    {
        p->sum[n] /= total;
    }
    p->sum[0] = 0;
    p->mean = first / total;
    p->deviation = sqrt(second / total - p->mean * p->mean);
    p->upright = upright / total;
}

/* Hertz: F = k d^(3/2), k = 4/3 E* sqrt(r_b), so U = 2/5 k d^(5/2). */
static inline double contact_energy(const ellipsoid_options *o, double height)
{
    const double depth = o->bead_radius - height;

    return depth > 0 ? 0.4 * 4.0 / 3 * o->contact_modulus * sqrt(o->bead_radius)
                           * depth * depth * sqrt(depth)
                     : 0;
}

/*
    exp(-U/kT), U = weight h + contact, over height and, for several beads, over
    the direction of x3 in the body (uniform on the sphere without energy): 160
    values of its component along the body's axis, 24 about that.
*/
static inline profile boltzmann(const ellipsoid_model *m, double low,
                                double high)
{
    const ellipsoid_options *o = &m->options;
    const int heights = m->bead_count > 1 ? 160 : 1;
    const int turns = m->bead_count > 1 ? 24 : 1;
    const int skip = m->bead_count > 1 ? 10 : 1;
    const double weight = -m->constant_force[2];
    profile p = {.low = low, .width = (high - low) / CELLS};
    double upright = 0;

    for (int i = 0; i < heights * turns; i++)
    {
        const double along = 2 * (i / turns + 0.5) / heights - 1;
        const double angle = 2 * test_pi * (i % turns + 0.5) / turns;
        const double across = sqrt(1 - along * along);
        const double up[3] = {across * sin(angle), along, across * cos(angle)};

        /* the density is smooth: `skip` cells in height have the same */
        for (int n = 0; n < CELLS; n += skip)
        {
            const double h = p.low + (n + 0.5 * skip) * p.width;
            double energy = weight * h, density;

            for (int b = 0; b < m->bead_count; b++)
            {
                energy += contact_energy(o, h + ellipsoid_dot(m->bead[b], up));
            }
            density = exp(-energy / test_kt);
            for (int k = 1; k <= skip; k++)
            {
                p.sum[n + k] += density;
            }
            upright += skip * density * along * along;
        }
    }
    normalise(&p, upright);
    return p;
}

static inline double height_distribution(const void *context, double height)
{
    const profile *p = context;
    const double place = (height - p->low) / p->width;
    const int n = (int)place;

    if (place <= 0)
    {
        return 0;
    }
    return n < CELLS ? p->sum[n] + (place - n) * (p->sum[n + 1] - p->sum[n])
                     : 1;
}

#endif
