/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
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

/* Sums over the points, with their weights: of products of a point's components
   in the body frame and the velocity or its derivatives in the lab's. Points
   come in opposite pairs (surfaceQuadrature.c), of which odd products take the
   difference, even ones the sum. */
typedef struct moments
{
    double u[3][3];      /* c_j v */
    double g[3][3];      /* G */
    double cg[3][3][3];  /* c_j G */
    double ccg[6][3][3]; /* c_j c_s G, j <= s */
} moments;

static const int pair[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};

/* A matrix, as nine numbers in a row. */
static inline void add_scaled(const double *g, double factor, double *sum)
{
    for (int n = 0; n < 9; n++)
    {
        sum[n] += factor * g[n];
    }
}

/* Those of a point and of the one opposite. */
static void add_jacobians(const double c[3], double weight, const double *g,
                          const double *opposite, moments *sums)
{
    double sum[9], difference[9];

    for (int n = 0; n < 9; n++)
    {
        sum[n] = weight * (g[n] + opposite[n]);
        difference[n] = weight * (g[n] - opposite[n]);
    }
    add_scaled(sum, 1, sums->g[0]);
    for (int j = 0; j < 3; j++)
    {
        if (c[j] == 0)
        {
            continue;
        }
        add_scaled(difference, c[j], sums->cg[j][0]);
        for (int s = j; s < 3; s++)
        {
            if (c[s] != 0)
            {
                add_scaled(sum, c[j] * c[s], sums->ccg[pair[j][s]][0]);
            }
        }
    }
}

/* As the body turns with q, points move, and it turns under the flow. */
static void set_derivatives(const moments *sums, ellipsoid_frame *frame,
                            ellipsoid_free_motion *free)
{
    double(*axis)[3] = frame->axis;

    memcpy(free->u_x, sums->g, sizeof(free->u_x));
    for (int l = 0; l < 3; l++)
    {
        for (int i = 0; i < 3; i++)
        {
            const int j = (i + 1) % 3, k = (i + 2) % 3;

            for (int m = 0; m < 3; m++)
            {
                free->omega_x[i][l] += axis[k][m] * sums->cg[j][m][l]
                                     - axis[j][m] * sums->cg[k][m][l];
            }
        }
    }
    for (int n = 0; n < 4; n++)
    {
        double(*turn)[3] = frame->by_q[n], moved[3][3] = {{0}};

        for (int m = 0; m < 3; m++)
        {
            for (int s = 0; s < 3; s++)
            {
                free->u_q[m][n] += ellipsoid_dot(sums->cg[s][m], turn[s]);
                for (int j = 0; j < 3; j++)
                {
                    moved[j][m] +=
                        ellipsoid_dot(sums->ccg[pair[j][s]][m], turn[s]);
                }
            }
        }
        for (int i = 0; i < 3; i++)
        {
            const int j = (i + 1) % 3, k = (i + 2) % 3;

            free->omega_q[i][n] = ellipsoid_dot(axis[k], moved[j])
                                + ellipsoid_dot(turn[k], sums->u[j])
                                - ellipsoid_dot(axis[j], moved[k])
                                - ellipsoid_dot(turn[j], sums->u[k]);
        }
    }
}

/* The gradient that a linear flow of these moments has, and its derivatives. */
static void set_along(const double a[3], const moments *sums,
                      ellipsoid_frame *frame, ellipsoid_free_motion *free)
{
    for (int b = 0; b < 3; b++)
    {
        const double scale = 3 / (a[b] * a[b]);

        for (int i = 0; i < 3; i++)
        {
            free->along[b][i] = scale * sums->u[b][i];
            for (int l = 0; frame->by_q && l < 3; l++)
            {
                free->along_by[l][b][i] = scale * sums->cg[b][i][l];
            }
            for (int n = 0; frame->by_q && n < 4; n++)
            {
                double *by_q = &free->along_by[3 + n][b][i];

                *by_q = 0;
                for (int s = 0; s < 3; s++)
                {
                    *by_q += scale
                           * ellipsoid_dot(sums->ccg[pair[b][s]][i],
                                           frame->by_q[n][s]);
                }
            }
        }
    }
}

/* 3 <(x^ x u^)_i> / (a_j^2 + a_k^2), and as much of its derivatives. */
static void set_spin(const double a[3], const moments *sums,
                     ellipsoid_frame *frame, ellipsoid_free_motion *free)
{
    for (int i = 0; i < 3; i++)
    {
        const double aj = a[(i + 1) % 3], ak = a[(i + 2) % 3];
        const double scale = 3 / (aj * aj + ak * ak);

        free->omega[i] =
            scale
            * (ellipsoid_dot(frame->axis[(i + 2) % 3], sums->u[(i + 1) % 3])
               - ellipsoid_dot(frame->axis[(i + 1) % 3], sums->u[(i + 2) % 3]));
        for (int l = 0; l < 3; l++)
        {
            free->omega_x[i][l] *= scale;
        }
        for (int n = 0; n < 4; n++)
        {
            free->omega_q[i][n] *= scale;
        }
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
    moments sums;
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
    memset(&sums, 0, sizeof sums);
    ellipsoid_copy(centre_velocity, free->u);
    for (int p = 0; p < count; p += 2)
    {
        const double *c = model->flow_point[p], weight = model->flow_weight[p];
        const double *v = velocity[p], *opposite = velocity[p + 1];

        for (int i = 0; i < 3; i++)
        {
            const double odd = weight * (v[i] - opposite[i]);

            free->u[i] += weight
                        * ((v[i] - centre_velocity[i])
                           + (opposite[i] - centre_velocity[i]));
            sums.u[0][i] += c[0] * odd;
            sums.u[1][i] += c[1] * odd;
            sums.u[2][i] += c[2] * odd;
        }
        if (wanted)
        {
            add_jacobians(c, weight, jacobian[p][0], jacobian[p + 1][0], &sums);
        }
    }
    if (wanted)
    {
        set_derivatives(&sums, frame, free);
    }
    set_spin(a, &sums, frame, free);
    if (model->wall_range > 0)
    {
        set_along(a, &sums, frame, free);
    }
    return ELLIPSOID_OK;
}
