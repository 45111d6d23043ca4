/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    bodyFlow.c - the undisturbed flow averaged over the body.

    Faxen's law for the ellipsoid, Brenner, Chem. Eng. Sci. 19, 703 (1964):
    with x^ = A n, n uniform on the unit sphere and < > the mean over n,
        F^ = mu K^ (<u^> - u^_p),
        T^_i = 3 c_i <(x^ x u^)_i> - c_i (a_j^2 + a_k^2) w^_i,
    so that a free body moves with <u> and turns with
    3 <(x^ x u^)_i> / (a_j^2 + a_k^2). A flow that is linear gives what
    FLOW_CENTRE gives.
*/
#include "ellipsoidInternal.h"

#include <string.h>

/* A class of points: all that arise from one by signs and exchanges. */
typedef struct point_class
{
    double place[3];
    double weight;
} point_class;

/*
    Quadratures on the sphere with octahedral symmetry: Lebedev, USSR Comput.
    Math. Math. Phys. 16, 10 (1976). 6, 14, 26 and 50 points are exact for
    polynomials of degree 3, 5, 7 and 11.
*/
static const struct quadrature
{
    int points, classes;
    point_class class[4];
} quadratures[] = {
    {6, 1, {{{1, 0, 0}, 1.0 / 6}}},
    {14, 2, {{{1, 0, 0}, 1.0 / 15}, {{1, 1, 1}, 3.0 / 40}}},
    {26,
     3,
     {{{1, 0, 0}, 1.0 / 21}, {{1, 1, 0}, 4.0 / 105}, {{1, 1, 1}, 9.0 / 280}}},
    {50,
     4,
     {{{1, 0, 0}, 4.0 / 315},
      {{1, 1, 0}, 64.0 / 2835},
      {{1, 1, 1}, 27.0 / 1280},
      {{1, 1, 3}, 14641.0 / 725760}}},
};

static void add_point(ellipsoid_model *model, const double n[3], double weight)
{
    const double length = ellipsoid_length(n);
    const int p = model->flow_points++;

    for (int i = 0; i < 3; i++)
    {
        model->flow_point[p][i] = model->options.semi_axes[i] * n[i] / length;
    }
    model->flow_weight[p] = weight;
}

/* All signs of the numbers that are not zero. */
static void add_signs(ellipsoid_model *model, const double n[3], double weight)
{
    for (int sign = 0; sign < 8; sign++)
    {
        const double s[3] = {sign & 1 ? -1 : 1, sign & 2 ? -1 : 1,
                             sign & 4 ? -1 : 1};
        const double point[3] = {s[0] * n[0], s[1] * n[1], s[2] * n[2]};

        if ((n[0] > 0 || s[0] > 0) && (n[1] > 0 || s[1] > 0)
            && (n[2] > 0 || s[2] > 0))
        {
            add_point(model, point, weight);
        }
    }
}

int ellipsoid_flow_points(ellipsoid_model *model)
{
    model->flow_points = 0;
    for (size_t q = 0; q < sizeof quadratures / sizeof *quadratures; q++)
    {
        if (quadratures[q].points != model->options.flow_points)
        {
            continue;
        }
        for (int c = 0; c < quadratures[q].classes; c++)
        {
            const double *n = quadratures[q].class[c].place;
            const double weight = quadratures[q].class[c].weight;

            /* two of the three numbers are always equal */
            add_signs(model, n, weight);
            if (n[0] != n[2])
            {
                add_signs(model, (const double[3]){n[2], n[0], n[1]}, weight);
                add_signs(model, (const double[3]){n[1], n[2], n[0]}, weight);
            }
        }
    }
    return model->flow_points;
}

/* As surroundings->velocities, from the flow alone. */
static int velocities_of_flow(const ellipsoid_surroundings *surroundings,
                              int count, double (*points)[3],
                              double (*velocity)[3], double (*jacobian)[3][3])
{
    for (int p = 0; p < count; p++)
    {
        ellipsoid_flow_sample sample;
        const int answer = surroundings->flow(
            surroundings->flow_context, points[p], jacobian != NULL, &sample);

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
                            double axis[3][3], double d[4][3][3],
                            ellipsoid_free_motion *free)
{
    double change[3], body[3];

    for (int l = 0; l < 3; l++)
    {
        ellipsoid_set(change, jacobian[0][l], jacobian[1][l], jacobian[2][l]);
        ellipsoid_product(axis, change, body);
        add_column(point, weight, change, body, &free->u_x[0][l],
                   &free->omega_x[0][l], 3);
    }
    for (int n = 0; n < 4; n++)
    {
        /* the point moves, and the body turns under the flow */
        double moved[3], turned[3];

        ellipsoid_combination(d[n], point[0], point[1], point[2], moved);
        ellipsoid_product(jacobian, moved, change);
        ellipsoid_product(axis, change, body);
        ellipsoid_product(d[n], rel, turned);
        ellipsoid_add(body, turned);
        add_column(point, weight, change, body, &free->u_q[0][n],
                   &free->omega_q[0][n], 4);
    }
}

ellipsoid_status ellipsoid_body_flow(
    const ellipsoid_model *model, const ellipsoid_surroundings *surroundings,
    const double x[3], const double centre_velocity[3], double axis[3][3],
    double axis_derivatives[4][3][3], ellipsoid_free_motion *free)
{
    const double *a = model->options.semi_axes;
    const int count = model->flow_points;
    double points[ELLIPSOID_MAX_FLOW_POINTS][3];
    double velocity[ELLIPSOID_MAX_FLOW_POINTS][3];
    double jacobian[ELLIPSOID_MAX_FLOW_POINTS][3][3];
    double(*wanted)[3][3] = axis_derivatives ? jacobian : NULL;
    int answer;

    for (int p = 0; p < count; p++)
    {
        const double *c = model->flow_point[p];

        ellipsoid_combination(axis, c[0], c[1], c[2], points[p]);
        ellipsoid_add(points[p], x);
    }
    answer =
        surroundings->velocities
            ? surroundings->velocities(surroundings->flow_context, x, count,
                                       points, velocity, wanted)
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
        ellipsoid_product(axis, rel, body);
        ellipsoid_cross(model->flow_point[p], body, turning);
        for (int i = 0; i < 3; i++)
        {
            free->u[i] += weight * rel[i];
            free->omega[i] += weight * turning[i];
        }
        if (axis_derivatives)
        {
            add_derivatives(model->flow_point[p], weight, rel, jacobian[p],
                            axis, axis_derivatives, free);
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
