/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    flowAverage.c - Faxen's average over a Rosenbrock step of motion with
    inertia.

    The stages of a step take it for linear in the pose, with the derivatives of
    the start. What that leaves out, e, is zero at the start and so is its
    slope. Its mean follows from two points between, those of Gauss and Jacobi
    for the weight t^2, which is exact to degree five; h times this displaces
    the end: a defect correction, after which the error is of the order of the
    method. The average at the end is that of the displaced pose, where the next
    step begins: a run that is stopped there and continued finds the same. So it
    is evaluated three times in a step, once with derivatives. By the end alone,
    e_1 and its slope e'_1, the mean of a cubic is
        e_1/2 - h e'_1/12,
    and a part of the difference is the error estimate where the gradient of the
    flow jumps; where it does not, that to e_1/3 is. What e does to u and omega
    they follow a relaxation time later. Where a cell touches something, which
    would resist a displacement, a step is taken so only if the defect is small.
*/
#include "motion/motion.h"

#include <math.h>

/* Where in the step the average is evaluated, the roots of t^2 - 4/3 t + 2/5,
   and what the mean takes of the defects there. */
static const double part[2] = {0.4558481559887748, 0.8774851773445584};
static const double weight[2] = {0.4850196082224638, 0.3020174288145726};

/* The part of the tolerance that a defect may take up that is not corrected. */
static const double slight = 0.2;

/* Where the gradient of the flow jumps, this part of the difference to the
   cubic, and of the defect, are the error estimate. */
static const double jumping = 0.25, unseen = 0.03;

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

/* That at the pose of `average`, without derivatives. */
static ellipsoid_status sample(const ellipsoid_cell *p,
                               ellipsoid_average *average)
{
    const ellipsoid_surroundings *around = &p->surroundings;
    const double *q = average->q, opposite[4] = {q[0], q[1], q[2], -q[3]};
    ellipsoid_flow_sample flow = {.velocity = {0}};
    ellipsoid_frame frame = {.by_q = NULL};
    int answer;

    if (!ellipsoid_is_pose(average->x, q))
    {
        return ELLIPSOID_NON_FINITE;
    }
    answer = around->flow(around->flow_context, around->time, average->x, 0,
                          &flow);
    if (answer != 0)
    {
        return ellipsoid_answer_status(answer);
    }
    ellipsoid_rotation_inline(opposite, frame.axis);
    return ellipsoid_faxen(p->model, around, average->x, flow.velocity, &frame,
                           &average->free);
}

/* How the free motion changes along a way. */
static void change_along(const ellipsoid_free_motion *free, const double x[3],
                         const double q[4], double change[6])
{
    memset(change, 0, 6 * sizeof(*change));
    ellipsoid_add_change(free, x, q, change, change + 3);
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
static void set_slope(const ellipsoid_average *start,
                      const ellipsoid_evaluation *next, double h,
                      double slope[6])
{
    const ellipsoid_state *state = &next->state;
    double turn[4], was[6];

    turn_of(state->omega, state->q, turn);
    change_along(&next->average.free, state->u, turn, slope);
    change_along(&start->free, state->u, turn, was);
    for (int i = 0; i < 6; i++)
    {
        slope[i] = h * (slope[i] - was[i]);
    }
}

/* The pose on the way between two states, by their velocities, too. */
static void set_between(const ellipsoid_state *from, const ellipsoid_state *to,
                        double h, double s, ellipsoid_average *between)
{
    const double r = 1 - s, with = s * s * (3 - 2 * s);
    double before[4], after[4];

    turn_of(from->omega, from->q, before);
    turn_of(to->omega, to->q, after);
    for (int i = 0; i < 3; i++)
    {
        between->x[i] = from->x[i] + with * (to->x[i] - from->x[i])
             + h * s * r * (r * from->u[i] - s * to->u[i]);
    }
    for (int n = 0; n < 4; n++)
    {
        between->q[n] = from->q[n] + with * (to->q[n] - from->q[n])
             + h * s * r * (r * before[n] - s * after[n]);
    }
}

/* Takes from what a free body follows by how much it lags behind: to first
   order (slowManifold.c) a relaxation time of its change in a step of h. */
static void lag(const ellipsoid_model *m, const double q[4], double h,
                const double change[6], double followed[6])
{
    const double opposite[4] = {q[0], q[1], q[2], -q[3]};
    double axis[3][3], piece[3], behind[3];

    ellipsoid_rotation_inline(opposite, axis);
    for (int i = 0; i < 3; i++)
    {
        piece[i] = fmin(m->mass * m->mobility[i] / h, 1.0 / 3)
                 * ellipsoid_dot(axis[i], change);
        followed[i + 3] -=
            fmin(m->inertia[i] * m->rotation_mobility[i] / h, 1.0 / 3)
            * change[i + 3];
    }
    ellipsoid_combination(axis, piece[0], piece[1], piece[2], behind);
    ellipsoid_difference(followed, behind, followed);
}

/* Displaces the pose of the end by what the defect makes, itself and by what it
   displaces in the step. */
static void displace(const ellipsoid_average *start, double h,
                     const double defect[6], ellipsoid_state *to)
{
    double way[6], turn[4], more[6], swept[3];

    for (int i = 0; i < 6; i++)
    {
        way[i] = h * defect[i];
    }
    turn_of(way + 3, to->q, turn);
    change_along(&start->free, way, turn, more);
    ellipsoid_cross(to->omega, way + 3, swept);
    for (int i = 0; i < 3; i++)
    {
        way[i] += 0.25 * h * more[i];
        way[i + 3] += 0.25 * h * (more[i + 3] - swept[i]);
    }
    turn_of(way + 3, to->q, turn);
    for (int i = 0; i < 3; i++)
    {
        to->x[i] += way[i];
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

/* Displaces the end of one that touches nothing. */
static ellipsoid_status correct(ellipsoid_cell *p,
                                const ellipsoid_evaluation *start, double h,
                                ellipsoid_state *end)
{
    ellipsoid_correction *made = &p->correction;
    ellipsoid_free_motion followed;
    ellipsoid_average between;
    double left[6], mean[6];

    memset(made->mean, 0, sizeof(made->mean));
    for (int k = 0; k < 2; k++)
    {
        ellipsoid_status status;

        set_between(&start->state, end, h, part[k], &between);
        status = sample(p, &between);
        if (status != ELLIPSOID_OK)
        {
            return status;
        }
        set_defect(&start->average, &between, left);
        for (int i = 0; i < 6; i++)
        {
            made->mean[i] += weight[k] * left[i];
        }
    }
    for (int i = 0; i < 6; i++)
    {
        left[i] /= part[1] * part[1];
    }
    ellipsoid_average_at(&start->average, end->x, end->q, &followed);
    ellipsoid_copy(followed.u, made->followed);
    ellipsoid_copy(followed.omega, made->followed + 3);
    made->start = &start->average;
    made->h = h;
    memcpy(mean, made->mean, sizeof(mean));
    lag(p->model, end->q, h, left, mean);
    displace(&start->average, h, mean, end);
    return ellipsoid_is_pose(end->x, end->q) ? ELLIPSOID_OK
                                             : ELLIPSOID_NON_FINITE;
}

ellipsoid_status ellipsoid_correct_poses(ellipsoid_group *g, double h)
{
    ellipsoid_status status = ELLIPSOID_OK;

    for (int cell = 0; status == ELLIPSOID_OK && cell < g->count; cell++)
    {
        ellipsoid_cell *p = &g->cell[cell];

        if (ellipsoid_has_average(p)
            && !ellipsoid_in_contact(&g->start[cell].contact)
            && !ellipsoid_in_contact(&g->next[cell].contact))
        {
            g->failed = cell;
            status = correct(p, &g->start[cell], h, &g->next[cell].state);
        }
    }
    return status;
}

void ellipsoid_correct_rates(const ellipsoid_cell *p, ellipsoid_evaluation *end)
{
    const ellipsoid_correction *made = &p->correction;
    const ellipsoid_free_motion *free = &end->average.free;
    double change[6], slope[6];

    if (!made->start)
    {
        return;
    }
    set_slope(made->start, end, made->h, slope);
    ellipsoid_difference(free->u, made->followed, change);
    ellipsoid_difference(free->omega, made->followed + 3, change + 3);
    lag(p->model, end->state.q, made->h, slope, change);
    ellipsoid_add(end->state.u, change);
    ellipsoid_add(end->state.omega, change + 3);
}

/* What the correction of a step may still lack. */
static double uncertainty(const ellipsoid_cell *p,
                          const ellipsoid_evaluation *end,
                          const double defect[6])
{
    const ellipsoid_correction *made = &p->correction;
    double slope[6], unsure[6];

    set_slope(made->start, end, made->h, slope);
    for (int i = 0; i < 6; i++)
    {
        unsure[i] = p->surroundings.piecewise
                      ? jumping
                            * (defect[i] / 2 - slope[i] / 12 - made->mean[i])
                      : parabola * (defect[i] / 3 - made->mean[i]);
    }
    return p->surroundings.piecewise
             ? fmax(effect(p, made->h, unsure),
                    unseen * effect(p, made->h, defect))
             : effect(p, made->h, unsure);
}

int ellipsoid_judge_averages(ellipsoid_group *g, double h, double *error)
{
    int good = 1;

    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_cell *p = &g->cell[cell];
        double defect[6];

        if (!ellipsoid_has_average(p))
        {
            continue;
        }
        set_defect(&g->start[cell].average, &g->next[cell].average, defect);
        if (p->correction.start)
        {
            *error = fmax(*error, uncertainty(p, &g->next[cell], defect));
        }
        else
        {
            good = good && ellipsoid_is_slight(p, h, defect);
        }
    }
    return good;
}

void ellipsoid_forget_corrections(ellipsoid_group *g)
{
    for (int cell = 0; cell < g->count; cell++)
    {
        g->cell[cell].correction.start = NULL;
    }
}
