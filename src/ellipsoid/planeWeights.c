/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    planeWeights.c - how the planes that stand for walls share what they cover.

    In the space where the body is the unit sphere, let planes have the normals
    N = diag(a) n/p, p being the body's support. With the windows v, which end
    smoothly wherever a plane comes and goes,
        weight_i = v_i v_i/sum_j max(0, N_i.N_j) v_j.
    So planes with one normal count once, those of a slit fully.
*/
#include "nearWall.h"

enum
{
    POSE = ELLIPSOID_POSE_SIZE
};

/* A normal where the body is the unit sphere. */
typedef struct scaled
{
    double normal[3], slope[POSE][3];
} scaled;

static scaled scale(const double axes[3], const ellipsoid_plane *plane)
{
    double stretched[3], support;
    scaled s;

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

void ellipsoid_weigh_planes(const ellipsoid_model *model,
                            ellipsoid_planes *planes)
{
    const int count = planes->count;
    scaled s[ELLIPSOID_MAX_PLANES];

    for (int i = 0; i < count; i++)
    {
        s[i] = scale(model->options.semi_axes, &planes->at[i]);
    }
    for (int i = 0; i < count; i++)
    {
        ellipsoid_plane *plane = &planes->at[i];
        const ellipsoid_quantity *v = &plane->window;
        ellipsoid_quantity sum = *v;

        for (int j = 0; j < count; j++)
        {
            const ellipsoid_quantity *other = &planes->at[j].window;
            const double c = ellipsoid_dot(s[i].normal, s[j].normal);

            if (j == i || !(c > 0))
            {
                continue;
            }
            sum.value += c * other->value;
            for (int n = 0; planes->sloped && n < POSE; n++)
            {
                sum.slope[n] += c * other->slope[n]
                              + (ellipsoid_dot(s[i].slope[n], s[j].normal)
                                 + ellipsoid_dot(s[i].normal, s[j].slope[n]))
                                    * other->value;
            }
        }
        plane->weight.value = v->value * v->value / sum.value;
        for (int n = 0; n < POSE; n++)
        {
            plane->weight.slope[n] = (2 * v->value * v->slope[n]
                                      - plane->weight.value * sum.slope[n])
                                   / sum.value;
        }
    }
}
