/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    brownian.c - the random force and torque of the fluid.

    Fluctuation and dissipation: <F F^T> = 2 kT mu K delta(t), and likewise the
    torque with the rotational resistance. Over an interval dt both are constant
    in the body frame, of variance 2 kT mu K^_i/dt and 2 kT mu C_i/dt.

    Near walls the resistance R is a matrix of the pose, and so force and torque
    are (2 kT/dt)^(1/2) L xi, L L^T = R where the interval begins. They stay the
    same while the body moves and its mobility M = 1/R changes: in the mean that
    displaces it by kT div M dt, the drift that is needed, as in the midpoint
    scheme of Fixman, J. Chem. Phys. 69, 1527 (1978). Intervals are so short that
    the body moves by a part of its gap, where a load does not hold it to the wall.
*/
#include "drag/drag.h"

#include <float.h>

ellipsoid_status ellipsoid_noise_at(const ellipsoid_model *model,
                                    const ellipsoid_surroundings *surroundings,
                                    double t, ellipsoid_noise *noise)
{
    const double interval = model->options.noise_interval;
    const double intervals = t / interval;
    /* a time so close to the end of an interval, in units of it, is that end */
    const double tolerance = fmax(1e-9, 4 * DBL_EPSILON * fabs(intervals));
    const double number = floor(intervals + tolerance);
    double normal[6];

    noise->near = 0;
    noise->start = number * interval;
    noise->end = (number + 1) * interval;
    noise->tolerance = tolerance * interval;
    if (!(tolerance < 0.01))
    {
        return ELLIPSOID_STEP_UNDERFLOW;
    }
    ellipsoid_random_normal(surroundings->seed, surroundings->id,
                            (int64_t)number, normal);
    for (int i = 0; i < 3; i++)
    {
        noise->force[i] = model->noise_force[i] * normal[i];
        noise->torque[i] = model->noise_torque[i] * normal[3 + i];
    }
    return ELLIPSOID_OK;
}

/* In place, the lower triangle; 0 if it is not positive. */
static int factorise(double matrix[6][6])
{
    for (int j = 0; j < 6; j++)
    {
        for (int i = j; i < 6; i++)
        {
            for (int k = 0; k < j; k++)
            {
                matrix[i][j] -= matrix[i][k] * matrix[j][k];
            }
            if (i == j && !(matrix[j][j] > 0))
            {
                return 0;
            }
            matrix[i][j] /= i == j ? sqrt(matrix[j][j]) : matrix[j][j];
        }
    }
    return 1;
}

/* Of an interval in which the nearest point moves by `part` of the gap along the
   normal, rms: (part gap)^2/(2 kT o.M o), o.M o the square of 1/L o; the gap is
   that at which the table is read, which is wider past a wall's rim. Without
   limit where a load holds it to the wall, which pushes half of that back at
   least: it is off the wall by kT/load in the mean, which such an interval would
   not resolve. load: in the body frame. */
static double longest_interval(const ellipsoid_model *model,
                               const ellipsoid_noise *noise,
                               const ellipsoid_plane *plane,
                               const ellipsoid_load *load)
{
    static const double part = 0.4;
    const double energy = ELLIPSOID_BOLTZMANN * model->options.temperature;
    const double moved = part * plane->effect.gap[ELLIPSOID_PLANE_FAR];
    const double *a = model->options.semi_axes, *n = plane->effect.normal;
    const double stretched[3] = {a[0] * a[0] * n[0], a[1] * a[1] * n[1],
                                 a[2] * a[2] * n[2]};
    const double p = sqrt(ellipsoid_dot(n, stretched));
    const double pressed = -ellipsoid_dot(n, load->force);
    double out[6] = {n[0], n[1], n[2]}, square = 0;

    if (pressed * moved > energy
        && ellipsoid_dot(n, load->push) >= 0.5 * pressed)
    {
        return HUGE_VAL;
    }
    ellipsoid_cross(n, stretched, out + 3);
    for (int i = 0; i < 6; i++)
    {
        out[i] /= i < 3 ? 1 : p;
        for (int k = 0; k < i; k++)
        {
            out[i] -= noise->factor[i][k] * out[k];
        }
        out[i] /= noise->factor[i][i];
        square += out[i] * out[i];
    }
    return moved * moved / (2 * energy * square);
}

ellipsoid_status ellipsoid_wall_noise_begin(
    const ellipsoid_model *model, const ellipsoid_surroundings *surroundings,
    const ellipsoid_state *state, ellipsoid_facet_cache *cache, double t,
    const ellipsoid_load *load, ellipsoid_noise *noise)
{
    ellipsoid_frame frame = {.by_q = NULL};
    ellipsoid_planes planes;
    ellipsoid_wall_expansion here;
    ellipsoid_load in_body;
    ellipsoid_status status;

    ellipsoid_axes(state->q, frame.axis);
    ellipsoid_product(frame.axis, load->force, in_body.force);
    ellipsoid_product(frame.axis, load->push, in_body.push);
    status =
        ellipsoid_find_planes(model, surroundings, state, 0, cache, &planes);
    noise->near = status == ELLIPSOID_OK && planes.count > 0;
    if (!noise->near)
    {
        return status;
    }
    noise->start = t;
    ellipsoid_wall_expansion_set(model, &planes, state, &here);
    ellipsoid_wall_matrix(&here, noise->factor);
    if (!factorise(noise->factor))
    {
        return ELLIPSOID_NON_FINITE;
    }
    for (int p = 0; p < planes.count; p++)
    {
        noise->end =
            fmin(noise->end,
                 t + longest_interval(model, noise, &planes.at[p], &in_body));
    }
    return noise->end > t ? ELLIPSOID_OK : ELLIPSOID_STEP_UNDERFLOW;
}

void ellipsoid_wall_noise_set(const ellipsoid_model *model,
                              const ellipsoid_surroundings *surroundings,
                              double end, ellipsoid_noise *noise)
{
    const double scale =
        sqrt(2 * ELLIPSOID_BOLTZMANN * model->options.temperature
             / (end - noise->start));
    double normal[6], action[6] = {0};
    int64_t number;

    /* another number for every start, and of no interval far from walls */
    memcpy(&number, &noise->start, sizeof(number));
    ellipsoid_random_normal(surroundings->seed, surroundings->id, number,
                            normal);
    noise->end = end;
    for (int i = 0; i < 6; i++)
    {
        for (int k = 0; k <= i; k++)
        {
            action[i] += scale * noise->factor[i][k] * normal[k];
        }
    }
    ellipsoid_copy(action, noise->force);
    ellipsoid_copy(action + 3, noise->torque);
}

void ellipsoid_add_noise(const ellipsoid_noise *noise, ellipsoid_frame *frame,
                         ellipsoid_body_wrench *wrench,
                         ellipsoid_jacobian_blocks *blocks)
{
    const double *f = noise->force;
    double lab[3];

    ellipsoid_combination(frame->axis, f[0], f[1], f[2], lab);
    ellipsoid_add(wrench->force, lab);
    ellipsoid_add(wrench->torque, noise->torque);
    for (int n = 0; blocks && n < 4; n++)
    {
        ellipsoid_combination(frame->by_q[n], f[0], f[1], f[2], lab);
        for (int i = 0; i < 3; i++)
        {
            blocks->uq[i][n] += lab[i];
        }
    }
}
