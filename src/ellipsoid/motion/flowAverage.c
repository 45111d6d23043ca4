/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    flowAverage.c - Faxen's average over a Rosenbrock step of motion with
    inertia.

    The stages of a step take it for linear in the pose, with the derivatives of
    the start. What that leaves out, e, is zero at the start and so is its
    slope; at the end both are found from the average there, with which the next
    step begins. Hermite's cubic through them has the integral
        h (e/2 - h e'/12),
    by which the end is displaced: a defect correction, after which the error is
    of the order of the method. So the average is evaluated once in a step.
    Where a cell touches something, which would resist a displacement, a step
    is taken so only if the defect is small.
*/
#include "motion/motion.h"

#include <math.h>

/* The part of the tolerance that the defect of a cell that touches something
   may take up. */
static const double slight = 0.05;

int ellipsoid_has_average(const ellipsoid_cell *p)
{
    return p->inertial && p->rate > 0 && p->model->flow_points > 0
        && !p->surroundings.unsteady;
}

void ellipsoid_take_averages(ellipsoid_group *g, ellipsoid_evaluation *points)
{
    for (int cell = 0; cell < g->count; cell++)
    {
        ellipsoid_cell *p = &g->cell[cell];

        p->average = points && ellipsoid_has_average(p) ? &points[cell].average
                                                        : NULL;
    }
}

/* That at the state of `at`, with derivatives. */
static ellipsoid_status sample(const ellipsoid_cell *p,
                               ellipsoid_evaluation *at)
{
    const ellipsoid_surroundings *around = &p->surroundings;
    const double *q = at->state.q, opposite[4] = {q[0], q[1], q[2], -q[3]};
    ellipsoid_average *average = &at->average;
    ellipsoid_flow_sample flow = {.velocity = {0}};
    double by_q[4][3][3];
    ellipsoid_frame frame = {.by_q = by_q};
    const int answer = around->flow(around->flow_context, around->time,
                                    at->state.x, 0, &flow);

    if (answer != 0)
    {
        return ellipsoid_answer_status(answer);
    }
    ellipsoid_rotation_inline(opposite, frame.axis);
    ellipsoid_axis_derivatives(q, by_q);
    ellipsoid_copy(at->state.x, average->x);
    memcpy(average->q, q, sizeof(average->q));
    return ellipsoid_faxen(p->model, around, average->x, flow.velocity, &frame,
                           &average->free);
}

/* How u_free and omega_free change with the pose, along a way. */
static void change_along(const ellipsoid_free_motion *free, const double x[3],
                         const double q[4], double change[6])
{
    for (int i = 0; i < 3; i++)
    {
        change[i] = ellipsoid_dot(free->u_x[i], x);
        change[i + 3] = ellipsoid_dot(free->omega_x[i], x);
        for (int n = 0; n < 4; n++)
        {
            change[i] += free->u_q[i][n] * q[n];
            change[i + 3] += free->omega_q[i][n] * q[n];
        }
    }
}

/* Of velocities that change x and q. */
static void turn_of(const double omega[3], const double q[4], double turn[4])
{
    ellipsoid_spin(omega, q, turn);
    for (int n = 0; n < 4; n++)
    {
        turn[n] *= 0.5;
    }
}

/* What a linear average leaves out, at the end of a step of h, and how it
   changes there in h. */
static void set_defect(const ellipsoid_evaluation *start,
                       const ellipsoid_evaluation *next, double h,
                       double defect[6], double slope[6])
{
    const ellipsoid_free_motion *is = &next->average.free;
    const ellipsoid_state *state = &next->state;
    ellipsoid_free_motion taken;
    double turn[4], was[6];

    ellipsoid_average_at(&start->average, state->x, state->q, &taken);
    ellipsoid_difference(is->u, taken.u, defect);
    ellipsoid_difference(is->omega, taken.omega, defect + 3);
    turn_of(state->omega, state->q, turn);
    change_along(is, state->u, turn, slope);
    change_along(&start->average.free, state->u, turn, was);
    for (int i = 0; i < 6; i++)
    {
        slope[i] = h * (slope[i] - was[i]);
    }
}

/* Displaces the end by what the defect makes, itself and by what it displaces
   in the step. */
static void displace(const ellipsoid_evaluation *start,
                     ellipsoid_evaluation *next, double h,
                     const double defect[6], const double mean[6])
{
    ellipsoid_state *to = &next->state;
    double way[6], turn[4], more[6], swept[3];

    for (int i = 0; i < 6; i++)
    {
        way[i] = h * mean[i];
    }
    turn_of(way + 3, to->q, turn);
    change_along(&start->average.free, way, turn, more);
    ellipsoid_cross(to->omega, way + 3, swept);
    for (int i = 0; i < 3; i++)
    {
        way[i] += 0.25 * h * more[i];
        way[i + 3] += 0.25 * h * (more[i + 3] - swept[i]);
    }
    turn_of(way + 3, to->q, turn);
    change_along(&next->average.free, way, turn, more);
    for (int i = 0; i < 3; i++)
    {
        to->x[i] += way[i];
        to->u[i] += defect[i] + more[i];
        to->omega[i] += defect[i + 3] + more[i + 3];
    }
    for (int n = 0; n < 4; n++)
    {
        to->q[n] += turn[n];
    }
    ellipsoid_normalise(to->q);
}

/* How far velocities of a mean over h take x, by its length, and q, in
   tolerances. */
static double effect(const ellipsoid_cell *p, double h, const double mean[6])
{
    return h
         * fmax(ellipsoid_length(mean) / p->length,
                0.5 * ellipsoid_length(mean + 3))
         / p->model->options.tolerance;
}

ellipsoid_status ellipsoid_complete_averages(ellipsoid_group *g, double h,
                                             double *error, int *too_linear)
{
    *too_linear = 0;
    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_cell *p = &g->cell[cell];
        const ellipsoid_evaluation *start = &g->start[cell];
        ellipsoid_evaluation *next = &g->next[cell];
        const int touches = ellipsoid_in_contact(&start->contact)
                         || ellipsoid_in_contact(&next->contact);
        double defect[6], slope[6], mean[6], unsure[6];
        ellipsoid_status status;

        if (!ellipsoid_has_average(p))
        {
            continue;
        }
        status = sample(p, next);
        if (status != ELLIPSOID_OK)
        {
            g->failed = cell;
            return status;
        }
        set_defect(start, next, h, defect, slope);
        for (int i = 0; i < 6; i++)
        {
            mean[i] = defect[i] / 2 - slope[i] / 12;
            unsure[i] = touches ? defect[i] / (3 * slight)
                                : defect[i] / 3 - mean[i];
        }
        if (touches)
        {
            *too_linear = *too_linear || !(effect(p, h, unsure) <= 1);
            continue;
        }
        *error = fmax(*error, effect(p, h, unsure));
        displace(start, next, h, defect, mean);
    }
    return ELLIPSOID_OK;
}
