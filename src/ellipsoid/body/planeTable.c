/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    planeTable.c - the table of what a plane does to spheroids, and that of one
    body. drag/planeFunctions.c says what the functions are; the program that
    computes them is in tools/planeTable.
*/
#include "body/planeTable.h"
#include "body/vectors.h"

#include <string.h>

enum
{
    FUNCTIONS = ELLIPSOID_PLANE_FUNCTIONS
};

static const struct
{
    int oblate, ratio, tilt, gap;
    float value[FUNCTIONS];
} table[] = {
#define P(oblate, ratio, tilt, gap, ...)                                       \
    {oblate, ratio, tilt, gap, {__VA_ARGS__}},
#include "body/planeTable.def"
};

void ellipsoid_chebyshev(double t, int count, double *value, double *slope)
{
    const double z = 2 * t - 1;

    value[0] = 1;
    value[1] = z;
    for (int k = 2; k < count; k++)
    {
        value[k] = 2 * z * value[k - 1] - value[k - 2];
    }
    for (int k = 0; k < count && slope; k++)
    {
        slope[k] = k == 0 ? 0
                 : k == 1
                     ? 2
                     : 4 * value[k - 1] + 2 * z * slope[k - 1] - slope[k - 2];
    }
}

void ellipsoid_plane_table_set(const double semi_axes[3],
                               ellipsoid_plane_table *own)
{
    double basis[ELLIPSOID_PLANE_PROLATE], unit[3], k[3], c[3];
    int oblate;

    memset(own, 0, sizeof(*own));
    own->ratio = ellipsoid_nearest_spheroid(semi_axes, &own->axis);
    own->radius = semi_axes[own->axis] / own->ratio;
    ellipsoid_set(unit, 1, own->ratio, 1);
    ellipsoid_resistance(unit, k, c);
    own->free[ELLIPSOID_K_ACROSS] = k[0];
    own->free[ELLIPSOID_K_ALONG] = k[1];
    own->free[ELLIPSOID_C_ACROSS] = c[0];
    own->free[ELLIPSOID_C_ALONG] = c[1];
    oblate = own->ratio < 1;
    ellipsoid_chebyshev(ellipsoid_plane_ratio_part(own->ratio),
                        ELLIPSOID_PLANE_PROLATE, basis, NULL);
    for (size_t i = 0; i < sizeof(table) / sizeof(*table); i++)
    {
        for (int n = 0; n < FUNCTIONS && table[i].oblate == oblate; n++)
        {
            own->at[table[i].tilt][table[i].gap][n] +=
                basis[table[i].ratio] * (double)table[i].value[n];
        }
    }
}
