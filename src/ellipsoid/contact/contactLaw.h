/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    contactLaw.h - the normal force between two surfaces as a function of the
    gap between them. Beads, ellipsoids and pairs of cells all take it from here;
    friction and damping (friction.c) follow from it.
*/
#ifndef ELLIPSOID_CONTACT_LAW_H
#define ELLIPSOID_CONTACT_LAW_H

#include "ellipsoid.h"

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

typedef struct ellipsoid_contact_law ellipsoid_contact_law;

struct ellipsoid_contact_law
{
    ellipsoid_normal_force (*normal_force)(const ellipsoid_contact_law *law,
                                           double gap);
    double strength; /* Hertz: 4/3 E* sqrt(R) [N/m^1.5]; adhesion: pull-off
                        force [N] */
    double range;    /* [m] smallest gap from which on there is no force */
    int attractive;  /* such a force carries neither friction nor damping */
};

/* gap [m]: minus the depth of an overlap */
static inline ellipsoid_normal_force
ellipsoid_contact_normal_force(const ellipsoid_contact_law *law, double gap)
{
    return law->normal_force(law, gap);
}

/* Hertz's law with a stiffness of 4/3 E* sqrt(R) [N/m^1.5]. */
ellipsoid_contact_law ellipsoid_hertz_law(double stiffness);

/* A pull of full size [N] where surfaces overlap, less up to the range [m]. */
ellipsoid_contact_law ellipsoid_adhesion_law(double pull_off, double range);

/* The law between two cells. */
ellipsoid_contact_law ellipsoid_pair_law(const ellipsoid_options *a,
                                         const ellipsoid_options *b);

#define ELLIPSOID_MAX_WALL_LAWS 4

/* The laws between a cell and a wall. The contacts of a body add up law by law
   (contactBlending.h), and so do the laws. */
typedef struct ellipsoid_wall_laws
{
    int count;
    ellipsoid_contact_law law[ELLIPSOID_MAX_WALL_LAWS];
    double range; /* [m] the largest of them */
} ellipsoid_wall_laws;

/* Those that a cell's options ask for. */
void ellipsoid_wall_laws_set(ellipsoid_wall_laws *laws,
                             const ellipsoid_options *options);

#endif
