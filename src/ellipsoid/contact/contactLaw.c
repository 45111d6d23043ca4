/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    contactLaw.c - the laws between two cells, and between a cell and a wall.
*/
#include "contact/contactLaw.h"

/* Two spheres: 1/R = 1/r_a + 1/r_b and 1/E* = 1/E_a + 1/E_b. */
ellipsoid_contact_law ellipsoid_pair_law(const ellipsoid_options *a,
                                         const ellipsoid_options *b)
{
    const double radius =
        a->bead_radius * b->bead_radius / (a->bead_radius + b->bead_radius);
    const double modulus = a->contact_modulus * b->contact_modulus
                         / (a->contact_modulus + b->contact_modulus);

    return ellipsoid_hertz_law(4.0 / 3 * modulus * sqrt(radius));
}

static void add(ellipsoid_wall_laws *laws, ellipsoid_contact_law law)
{
    int n = laws->count;

    if (!(law.strength > 0))
    {
        return;
    }
    for (; n > 0 && laws->law[n - 1].range > law.range; n--)
    {
        laws->law[n] = laws->law[n - 1];
    }
    laws->law[n] = law;
    laws->range = laws->law[laws->count++].range;
    laws->attractive = laws->attractive || law.attractive;
}

#define ADD_WALL_LAW(name) add(laws, ellipsoid_##name##_at_wall(o));
void ellipsoid_wall_laws_set(ellipsoid_wall_laws *laws,
                             const ellipsoid_options *o)
{
    laws->count = laws->attractive = 0;
    laws->range = 0;
    ELLIPSOID_CONTACT_LAWS(ADD_WALL_LAW)
}
