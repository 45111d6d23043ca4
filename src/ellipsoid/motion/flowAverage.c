/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    flowAverage.c - Faxen's average over a Rosenbrock step of motion with
    inertia.

    The stages of a step take it for linear in the pose, with the derivatives of
    the start. What that leaves out, e, is zero at the start and so is its
    slope; at the end both follow from the average there, with which the next
    step begins, and e once more half-way. The polynomial of degree four through
    these has the integral
        h (16 e_1/2 + 7 e_1 - h e'_1/2)/30,
    by which the end is displaced: a defect correction, after which the error is
    of the order of the method. So the average is evaluated twice in a step,
    once with derivatives. Without e half-way the cubic has
        h (e_1/2 - h e'_1/12),
    and the difference is the error estimate where the gradient of the flow
    jumps; where it does not, that to h e_1/3 is. What e does to u and omega
    they follow a relaxation time later. Where a cell touches something,
    which would resist a displacement, a step is taken so only if the defect is
    small.
*/
#include "motion/motion.h"

#include <math.h>

/* The part of the tolerance that a defect may take up that is not corrected. */
static const double slight = 0.05;

/* If the gradient of the flow jumps three quarters down the step, the two
   polynomials agree, and are off by 1/24 of the defect; three times that is the
   least error that a defect is taken to make. */
static const double unseen = 0.125;

/* Where nothing jumps, the error estimate is that of the mean of a parabola,
   times this: errors over the tolerance are then those of averages at each
   stage (tests/core/test_faxen.c). */
static const double parabola = 2.5;

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

/* That at the pose of `average`. */
static ellipsoid_status sample(const ellipsoid_cell *p, int derivatives,
                               ellipsoid_average *average)
{
    const ellipsoid_surroundings *around = &p->surroundings;
    const double *q = average->q, opposite[4] = {q[0], q[1], q[2], -q[3]};
    ellipsoid_flow_sample flow = {.velocity = {0}};
    double by_q[4][3][3];
    ellipsoid_frame frame = {.by_q = derivatives ? by_q : NULL};
    const int answer = around->flow(around->flow_context, around->time,
                                    average->x, 0, &flow);

    if (answer != 0)
    {
        return ellipsoid_answer_status(answer);
    }
    ellipsoid_rotation_inline(opposite, frame.axis);
    ellipsoid_axis_derivatives(q, by_q);
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

/* What an average that is linear about the start leaves out where the other
   is. */
static void set_defect(const ellipsoid_average *start,
                       const ellipsoid_average *is, double defect[6])
{
    ellipsoid_free_motion taken;

    ellipsoid_average_at(start, is->x, is->q, &taken);
    ellipsoid_difference(is->free.u, taken.u, defect);
    ellipsoid_difference(is->free.omega, taken.omega, defect + 3);
}

/* How that changes at the end in a step of h. */
static void set_slope(const ellipsoid_evaluation *start,
                      const ellipsoid_evaluation *next, double h,
                      double slope[6])
{
    const ellipsoid_state *state = &next->state;
    double turn[4], was[6];

    turn_of(state->omega, state->q, turn);
    change_along(&next->average.free, state->u, turn, slope);
    change_along(&start->average.free, state->u, turn, was);
    for (int i = 0; i < 6; i++)
    {
        slope[i] = h * (slope[i] - was[i]);
    }
}

/* Half-way between two states, by their velocities, too. */
static void set_middle(const ellipsoid_state *from, const ellipsoid_state *to,
                       double h, ellipsoid_average *middle)
{
    double before[4], after[4];

    turn_of(from->omega, from->q, before);
    turn_of(to->omega, to->q, after);
    for (int i = 0; i < 3; i++)
    {
        middle->x[i] = 0.5 * (from->x[i] + to->x[i])
                     + 0.125 * h * (from->u[i] - to->u[i]);
    }
    for (int n = 0; n < 4; n++)
    {
        middle->q[n] = 0.5 * (from->q[n] + to->q[n])
                     + 0.125 * h * (before[n] - after[n]);
    }
}

/* Takes from what a free body follows by how much it lags behind: to first
   order (slowManifold.c) a relaxation time of its change in a step of h. */
static void lag(const ellipsoid_model *m, const double q[4], double h,
                const double change[6], double followed[6])
{
    const double opposite[4] = {q[0], q[1], q[2], -q[3]};
    double axis[3][3], part[3], behind[3];

    ellipsoid_rotation_inline(opposite, axis);
    for (int i = 0; i < 3; i++)
    {
        part[i] = fmin(m->mass * m->mobility[i] / h, 1.0 / 3)
                * ellipsoid_dot(axis[i], change);
        followed[i + 3] -=
            fmin(m->inertia[i] * m->rotation_mobility[i] / h, 1.0 / 3)
            * change[i + 3];
    }
    ellipsoid_combination(axis, part[0], part[1], part[2], behind);
    ellipsoid_difference(followed, behind, followed);
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

int ellipsoid_is_slight(const ellipsoid_cell *p, double h,
                        const double defect[6])
{
    return effect(p, h, defect) <= 3 * slight;
}

/* Displaces the end of one that touches nothing, and raises *error. */
static ellipsoid_status correct(const ellipsoid_cell *p,
                                const ellipsoid_evaluation *start,
                                ellipsoid_evaluation *next, double h,
                                double *error)
{
    const int piecewise = p->surroundings.piecewise;
    ellipsoid_average middle;
    double defect[6], halfway[6], slope[6], mean[6], unsure[6];
    ellipsoid_status status;

    set_middle(&start->state, &next->state, h, &middle);
    status = sample(p, 0, &middle);
    if (status == ELLIPSOID_OK)
    {
        status = sample(p, 1, &next->average);
    }
    if (status != ELLIPSOID_OK)
    {
        return status;
    }
    set_defect(&start->average, &middle, halfway);
    set_defect(&start->average, &next->average, defect);
    set_slope(start, next, h, slope);
    for (int i = 0; i < 6; i++)
    {
        mean[i] = (16 * halfway[i] + 7 * defect[i] - 0.5 * slope[i]) / 30;
        unsure[i] = piecewise ? defect[i] / 2 - slope[i] / 12 - mean[i]
                              : parabola * (defect[i] / 3 - mean[i]);
    }
    *error = fmax(*error, effect(p, h, unsure));
    if (piecewise)
    {
        *error = fmax(*error, unseen * effect(p, h, defect));
    }
    lag(p->model, next->state.q, h, defect, mean);
    lag(p->model, next->state.q, h, slope, defect);
    displace(start, next, h, defect, mean);
    return ELLIPSOID_OK;
}

ellipsoid_status ellipsoid_complete_averages(ellipsoid_group *g, double h,
                                             double *error, int *too_linear)
{
    ellipsoid_status status = ELLIPSOID_OK;

    *too_linear = 0;
    for (int cell = 0; status == ELLIPSOID_OK && cell < g->count; cell++)
    {
        const ellipsoid_cell *p = &g->cell[cell];
        const ellipsoid_evaluation *start = &g->start[cell];
        ellipsoid_evaluation *next = &g->next[cell];
        double defect[6];

        if (!ellipsoid_has_average(p))
        {
            continue;
        }
        g->failed = cell;
        ellipsoid_copy(next->state.x, next->average.x);
        memcpy(next->average.q, next->state.q, sizeof(next->average.q));
        if (!ellipsoid_in_contact(&start->contact)
            && !ellipsoid_in_contact(&next->contact))
        {
            status = correct(p, start, next, h, error);
            continue;
        }
        status = sample(p, 1, &next->average);
        if (status == ELLIPSOID_OK)
        {
            set_defect(&start->average, &next->average, defect);
            *too_linear = *too_linear || !ellipsoid_is_slight(p, h, defect);
        }
    }
    return status;
}
