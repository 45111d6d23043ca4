/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    meeting.h - two cells of a group that may touch, by beads (pairContact.c) or
    by themselves (exactMeeting.c).
*/
#ifndef ELLIPSOID_MEETING_H
#define ELLIPSOID_MEETING_H

#include "integrator.h"

/* What one cell feels of the other, and its derivatives. */
typedef struct ellipsoid_side
{
    double force[3], torque[3];
    ellipsoid_contact_jacobian own, other;
} ellipsoid_side;

typedef struct ellipsoid_meeting
{
    const ellipsoid_body *a, *b;
    const ellipsoid_state *state_a, *state_b; /* read where they rub, and for
                                                 derivatives of exact contact */
    double stiffness;                         /* [N/m^1.5] 4/3 E* sqrt(R) */
    ellipsoid_contact_law law;
    int rubs;
    double gap;   /* [m] the smallest found */
    int touching; /* beads */
    int derivatives;
    ellipsoid_side *of_a, *of_b;
} ellipsoid_meeting;

/* The ellipsoids themselves against one another: gap, force, derivatives. */
void ellipsoid_meet_exactly(ellipsoid_meeting *m);

#endif
