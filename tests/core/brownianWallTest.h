/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    brownianWallTest.h - a Brownian body over a wall that it touches.
*/
#ifndef BROWNIAN_WALL_TEST_H
#define BROWNIAN_WALL_TEST_H

#include "brownianProfile.h"

static const double micron = 1e-6; /* [m] */

/* ----------------------------------------------------------- the scene */

/* A body as heavy as to have the scale height [m]. */
static inline ellipsoid_options over_wall(ellipsoid_motion motion, int beads,
                                          double modulus, double scale_height,
                                          double interval)
{
    ellipsoid_options o = test_brownian(motion, interval);
    double volume;

    o.contact = 1;
    o.buoyancy = 1;
    o.contact_modulus = modulus;
    o.bead_count = beads;
    if (beads == 1)
    {
        o.semi_axes[1] = o.semi_axes[0];
        o.bead_radius = radius;
    }
    volume = 4 * test_pi / 3 * o.semi_axes[0] * o.semi_axes[1] * o.semi_axes[2];
    o.density =
        o.fluid_density - test_kt / (scale_height * volume * o.gravity[2]);
    return o;
}

/* Interval after which a sphere has moved by `way` [m], rms along an axis. */
static inline double interval_of(double way)
{
    const ellipsoid_options o =
        over_wall(ELLIPSOID_MOTION_INERTIALESS, 1, 1, scale, 1);

    return way * way / (2 * test_kt * test_model(&o).mobility[0]);
}

#endif
