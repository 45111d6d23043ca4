/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    linearPlanes.c - the planes near a cell, linear in the pose.

    A wall is looked for among many facets; what was found, and its slopes, tell
    where it is from a pose nearby. On a face the height is linear in x as it
    is. The resistance is that of the planes so set, with its lubrication.
*/
#include "drag/drag.h"
#include "drag/wallResistance.h"

void ellipsoid_linear_planes_set(const ellipsoid_planes *planes,
                                 const ellipsoid_state *state,
                                 const double rates[6],
                                 ellipsoid_linear_planes *linear)
{
    ellipsoid_copy(state->x, linear->x);
    memcpy(linear->q, state->q, sizeof(linear->q));
    memcpy(linear->rates, rates, sizeof(linear->rates));
    linear->count =
        planes->count <= ELLIPSOID_MOST_LINEAR ? planes->count : -1;
    for (int p = 0; p < linear->count; p++)
    {
        const ellipsoid_plane *from = &planes->at[p];
        ellipsoid_linear_plane *to = &linear->at[p];

        ellipsoid_copy(from->normal, to->normal);
        memcpy(to->normal_slope, from->normal_slope, sizeof(to->normal_slope));
        to->height = from->height;
        to->weight = from->weight;
    }
}

static double changed(const ellipsoid_quantity *from,
                      const double way[ELLIPSOID_POSE_SIZE])
{
    double value = from->value;

    for (int n = 0; n < ELLIPSOID_POSE_SIZE; n++)
    {
        value += from->slope[n] * way[n];
    }
    return value;
}

void ellipsoid_linear_planes_at(const ellipsoid_linear_planes *linear,
                                const ellipsoid_state *state,
                                ellipsoid_planes *planes)
{
    double way[ELLIPSOID_POSE_SIZE];

    ellipsoid_difference(state->x, linear->x, way);
    for (int n = 0; n < 4; n++)
    {
        way[n + 3] = state->q[n] - linear->q[n];
    }
    planes->count = linear->count;
    for (int p = 0; p < linear->count; p++)
    {
        const ellipsoid_linear_plane *from = &linear->at[p];
        ellipsoid_plane *to = &planes->at[p];
        double normal[3], per;

        ellipsoid_copy(from->normal, normal);
        for (int n = 0; n < ELLIPSOID_POSE_SIZE; n++)
        {
            for (int i = 0; i < 3; i++)
            {
                normal[i] += from->normal_slope[n][i] * way[n];
            }
        }
        per = 1 / ellipsoid_length(normal);
        ellipsoid_set(to->normal, per * normal[0], per * normal[1],
                      per * normal[2]);
        to->height.value = changed(&from->height, way);
        to->weight.value = fmax(changed(&from->weight, way), 0);
    }
}

void ellipsoid_linear_planes_defect(const ellipsoid_model *model,
                                    const ellipsoid_linear_planes *linear,
                                    const ellipsoid_linear_planes *is,
                                    const ellipsoid_state *state,
                                    double defect[6])
{
    const double mu = model->viscosity;
    double taken[6], found[6];
    ellipsoid_planes planes;

    ellipsoid_linear_planes_at(linear, state, &planes);
    ellipsoid_wall_action(model, &planes, is->rates, taken);
    ellipsoid_linear_planes_at(is, state, &planes);
    ellipsoid_wall_action(model, &planes, is->rates, found);
    for (int i = 0; i < 3; i++)
    {
        defect[i] = (found[i] - taken[i]) / (mu * model->resistance[i]);
        defect[i + 3] = (found[i + 3] - taken[i + 3])
                      / (mu * model->rotation_resistance[i]);
    }
}
