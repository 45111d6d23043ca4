/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    denseOutput.c - the state inside an accepted step, of either method.
*/
#include "motion/motion.h"

/* At the ends the step's own states. */
void ellipsoid_step_state(const ellipsoid_step *step, double t,
                          ellipsoid_state *state)
{
    const double s = (t - step->start) / (step->end - step->start);
    const double r = 1 - s;
    double before[UNKNOWNS], after[UNKNOWNS], y[UNKNOWNS];

    if (t <= step->start || t >= step->end)
    {
        *state = t <= step->start ? step->before : step->after;
        return;
    }
    memcpy(before, &step->before, sizeof(before));
    memcpy(after, &step->after, sizeof(after));
    for (int n = 0; n < UNKNOWNS; n++)
    {
        const double bend = step->dense[0][n] + s * step->dense[1][n];

        y[n] = r * before[n] + s * (after[n] + r * bend);
    }
    ellipsoid_normalise(y + AT_Q);
    memcpy(state, y, sizeof(*state));
}
