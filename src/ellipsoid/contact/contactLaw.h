/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    contactLaw.h - the normal force between two surfaces as a function of the
    gap between them. Beads, ellipsoids and pairs of cells take it from here;
    friction and damping (friction.c) follow from it.

    A law NAME is two functions, ellipsoid_NAME_force() of the gap and
    ellipsoid_NAME_at_wall() of a cell's options, and a line in the list below.
    They are inlined: a call of each would cost contacts a twentieth.
*/
#ifndef ELLIPSOID_CONTACT_LAW_H
#define ELLIPSOID_CONTACT_LAW_H

#include "ellipsoid.h"

#include <math.h>

#define ELLIPSOID_CONTACT_LAWS(X)                                              \
    X(hertz)                                                                   \
    X(adhesion)

#define ELLIPSOID_LAW_ENUM(name) ELLIPSOID_LAW_##name,
typedef enum ellipsoid_law_name
{
    ELLIPSOID_CONTACT_LAWS(ELLIPSOID_LAW_ENUM) ELLIPSOID_LAW_COUNT
} ellipsoid_law_name;
#undef ELLIPSOID_LAW_ENUM

/* At one gap; force, slope and energy are zero from the law's range on. */
typedef struct ellipsoid_normal_force
{
    double force;  /* [N] along the outward normal: positive if it repels */
    double slope;  /* [N/m] dF/dgap */
    double energy; /* [J] the potential, F = -dE/dgap */

    /* of laws that repel, for derivatives of a force whose normal turns:
       F = secant overlap, slope = -exponent secant */
    double secant;   /* [N/m] */
    double exponent; /* [-] d ln F/d ln overlap */
} ellipsoid_normal_force;

typedef struct ellipsoid_contact_law
{
    ellipsoid_law_name name;
    double strength; /* Hertz: 4/3 E* sqrt(R) [N/m^1.5]; adhesion: pull-off
                        force [N]; 0: there is no such force */
    double range;    /* [m] smallest gap from which on there is no force */
    int attractive;  /* such a force carries neither friction nor damping */
} ellipsoid_contact_law;

/* -------------------------------------------------------------- the laws */

/* Hertz (1882) for an overlap d: F = k d^(3/2), E = 2/5 k d^(5/2). */
static inline ellipsoid_normal_force
ellipsoid_hertz_force(const ellipsoid_contact_law *law, double gap)
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

static inline ellipsoid_contact_law ellipsoid_hertz_law(double stiffness)
{
    return (ellipsoid_contact_law){.name = ELLIPSOID_LAW_hertz,
                                   .strength = stiffness};
}

static inline ellipsoid_contact_law
ellipsoid_hertz_at_wall(const ellipsoid_options *o)
{
    return ellipsoid_hertz_law(4.0 / 3 * o->contact_modulus
                               * sqrt(o->bead_radius));
}

/*
    With t = gap/range and the pull-off force A, the smoothstep
        F = -A (1 - t)^2 (1 + 2 t),   E = -A range/2 (1 - t)^3 (1 + t)
    for 0 <= t <= 1; F = -A where surfaces overlap. F and its slope are
    continuous. docs/theory/contact.md.
*/
static inline ellipsoid_normal_force
ellipsoid_adhesion_force(const ellipsoid_contact_law *law, double gap)
{
    const double pull = law->strength, range = law->range;
    const double overlap = gap < 0 ? -gap : 0;
    const double t = gap < 0 ? 0 : gap < range ? gap / range : 1;
    const double left = 1 - t;

    return (ellipsoid_normal_force){
        .force = -(pull * left * left * (1 + 2 * t)),
        .slope = 6 * pull / range * t * left,
        .energy =
            -pull * (overlap + 0.5 * range * left * left * left * (1 + t))};
}

static inline ellipsoid_contact_law
ellipsoid_adhesion_at_wall(const ellipsoid_options *o)
{
    return (ellipsoid_contact_law){.name = ELLIPSOID_LAW_adhesion,
                                   .strength = o->adhesion,
                                   .range = o->adhesion_range,
                                   .attractive = 1};
}

/* -------------------------------------------------------------- their use */

/* gap [m]: minus the depth of an overlap */
#define ELLIPSOID_LAW_CASE(name)                                               \
    case ELLIPSOID_LAW_##name:                                                 \
        return ellipsoid_##name##_force(law, gap);
static inline ellipsoid_normal_force
ellipsoid_contact_normal_force(const ellipsoid_contact_law *law, double gap)
{
    switch (law->name)
    {
        ELLIPSOID_CONTACT_LAWS(ELLIPSOID_LAW_CASE)
    case ELLIPSOID_LAW_COUNT:
        break;
    }
    return (ellipsoid_normal_force){.force = 0};
}
#undef ELLIPSOID_LAW_CASE

/* The law between two cells. */
ellipsoid_contact_law ellipsoid_pair_law(const ellipsoid_options *a,
                                         const ellipsoid_options *b);

/* The laws between a cell and a wall, by ascending range. The contacts of a
   body add up law by law (contactBlending.h), and so do the laws. */
typedef struct ellipsoid_wall_laws
{
    int count;
    ellipsoid_contact_law law[ELLIPSOID_LAW_COUNT];
    double range;   /* [m] the largest of them */
    int attractive; /* is one of them? */
} ellipsoid_wall_laws;

/* Those that a cell's options ask for. */
void ellipsoid_wall_laws_set(ellipsoid_wall_laws *laws,
                             const ellipsoid_options *options);

#endif
