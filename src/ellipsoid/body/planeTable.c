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

double ellipsoid_nearest_spheroid(const double semi_axes[3], int *axis)
{
    const double *a = semi_axes;
    double best = HUGE_VAL;

    *axis = 0;
    for (int k = 0; k < 3; k++)
    {
        const double uneven = fabs(log(a[(k + 1) % 3] / a[(k + 2) % 3]));

        if (uneven < best)
        {
            best = uneven;
            *axis = k;
        }
    }
    return a[*axis] / sqrt(a[(*axis + 1) % 3] * a[(*axis + 2) % 3]);
}

/* Flatter ones of the table are too far off where they lie far from the plane. */
static const double flattest = 1.0 / 3;

int ellipsoid_plane_table_has(const double semi_axes[3])
{
    int axis;
    const double ratio = ellipsoid_nearest_spheroid(semi_axes, &axis);

    /* twice what there is; a little more, for rounding */
    return ratio > 0.5 * flattest * (1 - 1e-9)
        && ratio < 2 * ELLIPSOID_PLANE_LARGEST_RATIO * (1 + 1e-9);
}

/*
    Functions of t with e factors t and o factors nu, as parts of tensors, vary
    by how far the unit sphere, of which the body is made by stretching, is
    turned: t over p where that is small, nu b/p. Squeezing, of the size G = 12
    pi S^3/(tau p) with q arms of the size A, leaves terms of that size.
*/
static const struct
{
    int first, second; /* of the free resistances: the root of the product */
    int e, o, q;       /* q -1: no squeezing */
} size_of[FUNCTIONS] = {{0, 0, 0, 0, -1}, {0, 0, 2, 0, 0},  {1, 1, 0, 0, 0},
                        {0, 1, 1, 1, 0},  {2, 2, 0, 0, 2},  {2, 2, 2, 0, 2},
                        {3, 3, 0, 0, -1}, {2, 3, 1, 1, -1}, {1, 2, 1, 0, 1},
                        {0, 2, 0, 1, -1}, {0, 2, 2, 1, 1},  {0, 3, 1, 0, -1},
                        {0, 2, 0, 0, -1}, {1, 2, 1, 0, 1},  {0, 2, 2, 1, 1},
                        {2, 2, 0, 0, -1}, {3, 3, 0, 0, -1}, {2, 2, 2, 0, 2}};

void ellipsoid_plane_scales(double ratio, const double free[4], double p,
                            double scale[FUNCTIONS], double slope[FUNCTIONS])
{
    const double b = ratio, y = p * p;
    const double g = ellipsoid_squeeze(b, p) / p;
    const double g_p = -4 / p - 2 * p / (b * b + y); /* of ln G */
    const double t = sqrt(2 * y / (1 + y)), t_p = 1 / (p * (1 + y));
    const double arm = (b * b + 1) / b * t; /* of ln t, too */
    const double k = free[ELLIPSOID_K_ACROSS], c = free[ELLIPSOID_C_ACROSS];
    const double part[3] = {g / k, g * arm / sqrt(k * c), g * arm * arm / c};

    for (int n = 0; n < FUNCTIONS; n++)
    {
        const int e = size_of[n].e, o = size_of[n].o, q = size_of[n].q;
        const double more = q < 0 ? 0 : part[q];

        scale[n] = sqrt(free[size_of[n].first] * free[size_of[n].second])
                 / (e == 0   ? 1
                    : e == 1 ? t
                             : t * t)
                 * (o ? b / p : 1) * (1 + more);
        slope[n] =
            scale[n]
            * (more / (1 + more) * (g_p + q * t_p) - e * t_p - (o ? 1 / p : 0));
    }
}

void ellipsoid_plane_table_set(const double semi_axes[3],
                               ellipsoid_plane_table *own)
{
    double basis[ELLIPSOID_PLANE_PROLATE], unit[3], k[3], c[3], ratio;
    int oblate;

    memset(own, 0, sizeof(*own));
    ratio = ellipsoid_nearest_spheroid(semi_axes, &own->axis);
    own->ratio = fmax(flattest, fmin(ratio, ELLIPSOID_PLANE_LARGEST_RATIO));
    /* as long, or as wide */
    own->radius = semi_axes[own->axis] / (ratio > 1 ? own->ratio : ratio);
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
