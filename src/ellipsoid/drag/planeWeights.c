/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    planeWeights.c - how the planes that stand for walls share what they cover.

    In the space where the body is the unit sphere, let planes have the normals
    N = diag(a) n/p, p being the body's support. With the windows v, which end
    smoothly wherever a plane comes and goes, and c_ij = max(0, N_i.N_j),
        weight_i = v_i (1 - prod_j (1 - c_ij v_j))/sum_j c_ij v_j.
    So planes with one normal count once, though one of them fades; those of a
    slit fully.
*/
#include "drag/wallResistance.h"

#include <math.h>

enum
{
    POSE = ELLIPSOID_POSE_SIZE
};

/* A normal where the body is the unit sphere. */
typedef struct scaled
{
    double normal[3], slope[POSE][3];
} scaled;

static scaled scaled_normal(const double axes[3], const ellipsoid_plane *plane)
{
    double stretched[3], support;
    scaled s = {{0}, {{0}}};

    for (int i = 0; i < 3; i++)
    {
        stretched[i] = axes[i] * plane->normal[i];
    }
    support = ellipsoid_length(stretched);
    ellipsoid_set(s.normal, stretched[0] / support, stretched[1] / support,
                  stretched[2] / support);
    for (int n = 0; n < POSE; n++)
    {
        double along;

        for (int i = 0; i < 3; i++)
        {
            stretched[i] = axes[i] * plane->normal_slope[n][i];
        }
        along = ellipsoid_dot(s.normal, stretched);
        for (int i = 0; i < 3; i++)
        {
            s.slope[n][i] = (stretched[i] - along * s.normal[i]) / support;
        }
    }
    return s;
}

/* c_ij v_j and its slopes */
static ellipsoid_quantity covered(const ellipsoid_planes *planes,
                                  const scaled s[], int i, int j)
{
    const ellipsoid_quantity *v = &planes->at[j].window;
    const double c = ellipsoid_dot(s[i].normal, s[j].normal);
    ellipsoid_quantity part = *v;

    if (j == i)
    {
        return part;
    }
    part.value = fmax(0, c) * v->value;
    for (int n = 0; n < POSE; n++)
    {
        part.slope[n] = c > 0
                          ? c * v->slope[n]
                                + (ellipsoid_dot(s[i].slope[n], s[j].normal)
                                   + ellipsoid_dot(s[i].normal, s[j].slope[n]))
                                      * v->value
                          : 0;
    }
    return part;
}

static void share(ellipsoid_planes *planes, const scaled s[], int i)
{
    ellipsoid_plane *plane = &planes->at[i];
    const ellipsoid_quantity *v = &plane->window;
    ellipsoid_quantity sum = {.value = 0}, bare = {.value = 1};
    double part;

    for (int j = 0; j < planes->count; j++)
    {
        const ellipsoid_quantity c = covered(planes, s, i, j);

        for (int n = 0; n < POSE; n++)
        {
            sum.slope[n] += c.slope[n];
            bare.slope[n] =
                bare.slope[n] * (1 - c.value) - bare.value * c.slope[n];
        }
        sum.value += c.value;
        bare.value *= 1 - c.value;
    }
    part = (1 - bare.value) / sum.value;
    plane->weight.value = v->value * part;
    for (int n = 0; n < POSE; n++)
    {
        plane->weight.slope[n] =
            v->slope[n] * part
            - v->value * (bare.slope[n] + part * sum.slope[n]) / sum.value;
    }
}

void ellipsoid_weigh_planes(const ellipsoid_model *model,
                            ellipsoid_planes *planes)
{
    const int count = planes->count;
    scaled s[ELLIPSOID_MAX_PLANES];

    for (int i = 0; i < count; i++)
    {
        s[i] = scaled_normal(model->options.semi_axes, &planes->at[i]);
    }
    for (int i = 0; i < count; i++)
    {
        share(planes, s, i);
    }
}
