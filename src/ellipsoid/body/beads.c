/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    beads.c - where the beads that carry the contact sit on an ellipsoid.
*/
#include "body/body.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/* The longest axis; of equal ones the paper's symmetry axis x^2. */
static int longest_axis(const double a[3])
{
    int axis = 1;

    for (int i = 0; i < 3; i += 2)
    {
        if (a[i] > a[axis])
        {
            axis = i;
        }
    }
    return axis;
}

int ellipsoid_mirror_axis(const double axes[3])
{
    const int along = longest_axis(axes);
    const int next = (along + 1) % 3, last = (along + 2) % 3;

    return axes[last] > axes[next] ? next : last;
}

/*
    A pole at either end of the longest axis and, between them at equal
    distances along it, rings of three, each turned 60 degrees from the last:
    the beads of a ring sit over the gaps of its neighbours, and none leaves
    the axis bare as meridians do. Every ring has a bead on the plane of the two
    longer axes, where an oblate body has its rim. 2 + 3 rings beads.
*/
static int staggered(const double axes[3], int count,
                     double bead[ELLIPSOID_MAX_BEADS][3])
{
    const int along = longest_axis(axes);
    const int across = ellipsoid_mirror_axis(axes);
    const int rim = 3 - along - across;
    const int rings = (count - 2) / 3;
    int n = 0;

    if (count < 2 || 2 + 3 * rings != count)
    {
        return 0;
    }

    for (int end = -1; end <= 1; end += 2)
    {
        bead[n][along] = end * axes[along];
        bead[n][rim] = bead[n][across] = 0;
        n++;
    }
    for (int ring = 0; ring < rings; ring++)
    {
        /* odd in the ring, so that the layout is symmetric to the last bit */
        const double y = (2 * ring + 1 - rings) / (double)(rings + 1);
        const double radius = sqrt((1 - y) * (1 + y));

        for (int k = 0; k < 3; k++)
        {
            const double angle = (2 * k + ring % 2) * pi / 3;

            bead[n][along] = y * axes[along];
            bead[n][rim] = radius * cos(angle) * axes[rim];
            bead[n][across] = radius * sin(angle) * axes[across];
            n++;
        }
    }
    return n;
}

/*
    Paper, supplement Figure 3C: x = a sin(s) cos(v), y = b sin(v),
    z = a cos(s) cos(v), 0 <= s < 180, 0 <= v < 360 degrees, in steps of 45:
    four meridians of eight beads. All four share the two poles: 26 remain.
*/
static int literal(const double axes[3], double bead[ELLIPSOID_MAX_BEADS][3])
{
    int n = 0;

    for (int meridian = 0; meridian < 4; meridian++)
    {
        const double s = meridian * pi / 4;

        for (int k = 0; k < 8; k++)
        {
            const int pole = k % 4 == 2;
            const double v = k * pi / 4, c = pole ? 0 : cos(v);

            if (pole && meridian > 0)
            {
                continue;
            }
            bead[n][0] = axes[0] * sin(s) * c;
            bead[n][1] = axes[1] * sin(v);
            bead[n][2] = axes[2] * cos(s) * c;
            n++;
        }
    }
    return n;
}

int ellipsoid_beads(const ellipsoid_options *options,
                    double bead[ELLIPSOID_MAX_BEADS][3])
{
    const ellipsoid_bead_layout layout = options->bead_layout;
    double axes[3];

    if (options->bead_count < 1 || options->bead_count > ELLIPSOID_MAX_BEADS
        || !(options->bead_radius > 0))
    {
        return 0;
    }
    if (options->bead_count == 1)
    {
        bead[0][0] = bead[0][1] = bead[0][2] = 0;
        return 1;
    }

    for (int i = 0; i < 3; i++)
    {
        if (!(options->bead_radius < options->semi_axes[i]))
        {
            return 0;
        }
        axes[i] = options->semi_axes[i];
        if (layout == ELLIPSOID_BEADS_STAGGERED)
        {
            axes[i] -= options->bead_radius;
        }
    }

    if (layout == ELLIPSOID_BEADS_PAPER)
    {
        return options->bead_count == 32 ? literal(axes, bead) : 0;
    }
    return staggered(axes, options->bead_count, bead);
}
