/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    contactLaw.c - the normal force between two surfaces.

    Another law for walls is a function below, the law that names it, and its
    line in ellipsoid_wall_laws_set().
*/
#include "contact/contactLaw.h"

#include <math.h>

/* Hertz (1882) for an overlap d: F = k d^(3/2), E = 2/5 k d^(5/2). */
static ellipsoid_normal_force hertz(const ellipsoid_contact_law *law,
                                    double gap)
{
    const double overlap = gap < 0 ? -gap : 0;
    const double secant = law->strength * sqrt(overlap);
    const double force = secant * overlap;

    return (ellipsoid_normal_force){.force = force,
                                    .slope = -1.5 * secant,
                                    .energy = 0.4 * force * overlap,
                                    .secant = secant,
                                    .exponent = 1.5};
}

ellipsoid_contact_law ellipsoid_hertz_law(double stiffness)
{
    return (ellipsoid_contact_law){.normal_force = hertz,
                                   .strength = stiffness};
}

/*
    With t = gap/range and the pull-off force A, the smoothstep
        F = -A (1 - t)^2 (1 + 2 t),   E = -A range/2 (1 - t)^3 (1 + t)
    for 0 <= t <= 1; F = -A where surfaces overlap. F and its slope are
    continuous. docs/theory.md, "Contact".
*/
static ellipsoid_normal_force adhesion(const ellipsoid_contact_law *law,
                                       double gap)
{
    const double pull = law->strength, range = law->range;
    const double overlap = gap < 0 ? -gap : 0;
    const double t = fmin(fmax(0, gap / range), 1), left = 1 - t;

    return (ellipsoid_normal_force){
        .force = -(pull * left * left * (1 + 2 * t)),
        .slope = 6 * pull / range * t * left,
        .energy = -pull * (overlap + 0.5 * range * left * left * left * (1 + t))};
}

ellipsoid_contact_law ellipsoid_adhesion_law(double pull_off, double range)
{
    return (ellipsoid_contact_law){.normal_force = adhesion,
                                   .strength = pull_off,
                                   .range = range,
                                   .attractive = 1};
}

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

void ellipsoid_wall_laws_set(ellipsoid_wall_laws *laws,
                             const ellipsoid_options *o)
{
    const ellipsoid_contact_law all[] = {
        ellipsoid_hertz_law(4.0 / 3 * o->contact_modulus * sqrt(o->bead_radius)),
        ellipsoid_adhesion_law(o->adhesion, o->adhesion_range),
    };
    const int count = sizeof all / sizeof *all;

    _Static_assert(sizeof all <= sizeof laws->law, "room for every law");
    laws->count = 0;
    laws->range = 0;
    for (int n = 0; n < count; n++)
    {
        if (all[n].strength > 0)
        {
            laws->law[laws->count++] = all[n];
            laws->range = fmax(laws->range, all[n].range);
        }
    }
}
