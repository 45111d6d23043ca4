/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    exactContactTest.h - the ellipsoid itself among walls.
*/
#ifndef EXACT_CONTACT_TEST_H
#define EXACT_CONTACT_TEST_H

#include "roomTest.h"

static inline ellipsoid_surroundings inside(wall_mesh *mesh)
{
    const ellipsoid_surroundings surroundings = {.walls = wall_mesh_list,
                                                 .walls_context = mesh};

    return surroundings;
}

static inline ellipsoid_options exact_options(double a, double b, double c)
{
    ellipsoid_options options = test_paper_options();

    options.contact_shape = ELLIPSOID_CONTACT_ELLIPSOID;
    ellipsoid_set(options.semi_axes, a, b, c);
    return options;
}

#endif
