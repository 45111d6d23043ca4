/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    faxen.c - the undisturbed flow averaged over the body.

    Faxen's law for the ellipsoid, Brenner, Chem. Eng. Sci. 19, 703 (1964):
    with x^ = A n, n uniform on the unit sphere and < > the mean over n,
        F^ = mu K^ (<u^> - u^_p),
        T^_i = 3 c_i <(x^ x u^)_i> - c_i (a_j^2 + a_k^2) w^_i,
    so that a free body moves with <u> and turns with
    3 <(x^ x u^)_i> / (a_j^2 + a_k^2). A flow that is linear gives what
    FLOW_CENTRE gives.
*/
#include "drag/drag.h"

#include <string.h>

/* As surroundings->velocities, from the flow alone. */
static int velocities_of_flow(const ellipsoid_surroundings *surroundings,
                              int count, double (*points)[3],
                              double (*velocity)[3], double (*jacobian)[3][3])
{
    for (int p = 0; p < count; p++)
    {
        ellipsoid_flow_sample sample = {.velocity = {0}};
        const int answer =
            surroundings->flow(surroundings->flow_context, surroundings->time,
                               points[p], jacobian != NULL, &sample);

        if (answer < 0)
        {
            return answer;
        }
        if (answer > 0)
        {
            memset(&sample, 0, sizeof sample);
        }
        ellipsoid_copy(sample.velocity, velocity[p]);
        if (jacobian)
        {
            memcpy(jacobian[p], sample.velocity_jacobian, sizeof jacobian[p]);
        }
    }
    return 0;
}

/* Adds to two columns the change of the velocity and its turning moment. */
static void add_column(const double point[3], double weight,
                       const double change[3], const double body[3],
                       double *of_u, double *of_omega, int stride)
{
    double turning[3];

    ellipsoid_cross(point, body, turning);
    for (int i = 0; i < 3; i++)
    {
        of_u[i * stride] += weight * change[i];
        of_omega[i * stride] += weight * turning[i];
    }
}

/* One point's part in the derivatives. rel: its velocity less the centre's. */
static void add_derivatives(const double point[3], double weight,
                            const double rel[3], double jacobian[3][3],
                            ellipsoid_frame *frame,
                            ellipsoid_free_motion *free)
{
    double change[3], body[3];

    for (int l = 0; l < 3; l++)
    {
        ellipsoid_set(change, jacobian[0][l], jacobian[1][l], jacobian[2][l]);
        ellipsoid_product(frame->axis, change, body);
        add_column(point, weight, change, body, &free->u_x[0][l],
                   &free->omega_x[0][l], 3);
    }
    for (int n = 0; n < 4; n++)
    {
        /* the point moves, and the body turns under the flow */
        double moved[3], turned[3];

        ellipsoid_combination(frame->by_q[n], point[0], point[1], point[2],
                              moved);
        ellipsoid_product(jacobian, moved, change);
        ellipsoid_product(frame->axis, change, body);
        ellipsoid_product(frame->by_q[n], rel, turned);
        ellipsoid_add(body, turned);
        add_column(point, weight, change, body, &free->u_q[0][n],
                   &free->omega_q[0][n], 4);
    }
}

ellipsoid_status ellipsoid_faxen(const ellipsoid_model *model,
                                 const ellipsoid_surroundings *surroundings,
                                 const double x[3],
                                 const double centre_velocity[3],
                                 ellipsoid_frame *frame,
                                 ellipsoid_free_motion *free)
{
    const double *a = model->options.semi_axes;
    const int count = model->flow_points;
    double points[ELLIPSOID_MAX_FLOW_POINTS][3];
    double velocity[ELLIPSOID_MAX_FLOW_POINTS][3];
    double jacobian[ELLIPSOID_MAX_FLOW_POINTS][3][3];
    double(*wanted)[3][3] = frame->by_q ? jacobian : NULL;
    int answer;

    for (int p = 0; p < count; p++)
    {
        const double *c = model->flow_point[p];

        ellipsoid_combination(frame->axis, c[0], c[1], c[2], points[p]);
        ellipsoid_add(points[p], x);
    }
    memset(velocity, 0, (size_t)count * sizeof *velocity);
    if (wanted)
    {
        memset(jacobian, 0, (size_t)count * sizeof *jacobian);
    }
    answer =
        surroundings->velocities
            ? surroundings->velocities(surroundings->flow_context,
                                       surroundings->time, x, count, points,
                                       velocity, wanted)
            : velocities_of_flow(surroundings, count, points, velocity, wanted);
    if (answer != 0)
    {
        return ellipsoid_answer_status(answer);
    }

    memset(free, 0, sizeof *free);
    ellipsoid_copy(centre_velocity, free->u);
    for (int p = 0; p < count; p++)
    {
        const double weight = model->flow_weight[p];
        double rel[3], body[3], turning[3];

        ellipsoid_difference(velocity[p], centre_velocity, rel);
        ellipsoid_product(frame->axis, rel, body);
        ellipsoid_cross(model->flow_point[p], body, turning);
        for (int i = 0; i < 3; i++)
        {
            free->u[i] += weight * rel[i];
            free->omega[i] += weight * turning[i];
        }
        if (wanted)
        {
            add_derivatives(model->flow_point[p], weight, rel, jacobian[p],
                            frame, free);
        }
    }
    for (int i = 0; i < 3; i++)
    {
        const double aj = a[(i + 1) % 3], ak = a[(i + 2) % 3];
        const double scale = 3 / (aj * aj + ak * ak);

        free->omega[i] *= scale;
        for (int l = 0; l < 3; l++)
        {
            free->omega_x[i][l] *= scale;
        }
        for (int n = 0; n < 4; n++)
        {
            free->omega_q[i][n] *= scale;
        }
    }
    return ELLIPSOID_OK;
}
