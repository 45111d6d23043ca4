/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    stepControl.c - how long a step is, and whether it is good enough.
*/
#include "ellipsoidInternal.h"

#include <float.h>
#include <math.h>

enum
{
    SIZE = ELLIPSOID_STATE_SIZE,
    U = ELLIPSOID_U,
    X = ELLIPSOID_X,
    W = ELLIPSOID_OMEGA,
    Q = ELLIPSOID_Q
};

/*
    The error in units of the tolerance. Errors of u and omega count by what
    they do to x and q: they last one relaxation time or one step, whichever is
    shorter. So the stiff components do not govern the step.
*/
static double scaled_error(const ellipsoid_problem *p, const double error[SIZE],
                           double h)
{
    const double per_h = 1 / h;
    const double *q = error + Q;
    const double ex = ellipsoid_length(error + X) / p->length;
    const double eq = sqrt(ellipsoid_dot(q, q) + q[3] * q[3]);
    double eu = 0, ew = 0, sum;

    if (p->inertial)
    {
        eu = ellipsoid_length(error + U) / (p->length * fmax(p->rate, per_h));
        ew = ellipsoid_length(error + W) / fmax(p->rotation_rate, per_h);
    }
    sum = ex + eu + ew + eq;

    /* fmax would drop a NaN */
    return isfinite(sum)
             ? fmax(fmax(ex, eq), fmax(eu, ew)) / p->model->options.tolerance
             : sum;
}

/*
    The walls are felt only at the poses where the equations are evaluated. A
    bead that passes through a wall between two of them unseen has to leave the
    one gap, the wall by two radii less an overlap, and the other gap. So none
    does if none travels farther than both gaps and a bead radius: the farthest
    travel in units of that.
*/
static double unseen_travel(const ellipsoid_problem *p,
                            const ellipsoid_stages *stages)
{
    double worst = 0;

    for (int n = 1; n < stages->sampled; n++)
    {
        const int i = stages->in_time[n - 1], j = stages->in_time[n];
        const double safe = fmax(stages->gap[i], 0) + fmax(stages->gap[j], 0)
                          + p->model->options.bead_radius;
        double move[3], turn[4], travel;

        for (int l = 0; l < 3; l++)
        {
            move[l] = stages->x[j][l] - stages->x[i][l];
        }
        for (int l = 0; l < 4; l++)
        {
            turn[l] = stages->q[j][l] - stages->q[i][l];
        }
        /* a change of q by d turns the body by 2 d */
        travel = ellipsoid_length(move)
               + 2 * p->model->reach
                     * sqrt(ellipsoid_dot(turn, turn) + turn[3] * turn[3]);
        worst = fmax(worst, travel / safe);
    }
    return worst;
}

/*
    The last two steps share what is left, so that none is tiny. A proposal
    that lands on `end` but for rounding is not altered: a run cut there goes
    on as if it had not been cut.
*/
ellipsoid_plan ellipsoid_plan_step(double proposal, double t, double end)
{
    const double left = end - t;
    const double slack = 4 * DBL_EPSILON * fmax(fabs(t), proposal);

    if (fabs(left - proposal) <= slack)
    {
        return (ellipsoid_plan){proposal, 1, 0};
    }
    if (left < proposal)
    {
        return (ellipsoid_plan){left, 1, 1};
    }
    if (left < 1.25 * proposal)
    {
        return (ellipsoid_plan){0.5 * left, 0, 1};
    }
    return (ellipsoid_plan){proposal, 0, 0};
}

/*
    PI control (Hairer & Wanner II, section IV.2): the factor by which the next
    step differs, where errors grow with the step to the power of the order.
*/
double ellipsoid_step_factor(int order, double error, double previous_error)
{
    const double e = log(fmax(error, 1e-8));
    const double exponent = previous_error > 0 && error <= 1
                              ? 0.4 * log(previous_error) - 0.7 * e
                              : -e;

    return fmin(fmax(0.9 * exp(exponent / order), 0.2), 5);
}

/*
    Sets *step to a first step. With inertia it resolves the relaxation.
    Without, the times in which q turns and in which the slopes change say how
    long it may be; the latter from a short way along the slopes.
*/
ellipsoid_status ellipsoid_first_step(const ellipsoid_problem *p,
                                      const ellipsoid_point *start,
                                      double *step)
{
    const ellipsoid_options *o = &p->model->options;
    const double *u = start->derivative.x, *q = start->derivative.q;
    const double turn = sqrt(ellipsoid_dot(q, q) + q[3] * q[3]);
    const double pace = fmax(turn, ellipsoid_length(u) / p->length);
    const double h = 0.01 / pace;
    ellipsoid_state at = start->state, there;
    ellipsoid_contact contact;
    double change, bend[3], curve[4];
    ellipsoid_status status;

    *step = o->initial_step;
    if (*step > 0)
    {
        return ELLIPSOID_OK;
    }
    if (p->inertial)
    {
        *step = 0.25
              * fmin(p->model->relaxation_time,
                     p->model->rotation_relaxation_time);
        return ELLIPSOID_OK;
    }
    *step = pace > 0 ? h : o->maximum_step;
    if (!(pace > 0))
    {
        return ELLIPSOID_OK;
    }
    for (int i = 0; i < 3; i++)
    {
        at.x[i] += h * u[i];
    }
    for (int n = 0; n < 4; n++)
    {
        at.q[n] += h * q[n];
    }
    status = ellipsoid_problem_evaluate(p, &at, 1, &there, &contact, NULL);
    if (status != ELLIPSOID_OK)
    {
        return ellipsoid_may_recover(status) ? ELLIPSOID_OK : status;
    }
    ellipsoid_difference(there.x, u, bend);
    for (int n = 0; n < 4; n++)
    {
        curve[n] = there.q[n] - q[n];
    }
    change = fmax(ellipsoid_length(bend) / p->length,
                  sqrt(ellipsoid_dot(curve, curve) + curve[3] * curve[3]));
    *step = 2 * pow(o->tolerance, 0.2) / fmax(turn, sqrt(change / h));
    return ELLIPSOID_OK;
}

/* Is the error of a step, or what it may have passed unseen, acceptable? */
ellipsoid_status ellipsoid_judge_step(const ellipsoid_problem *p, double h,
                                      const ellipsoid_stages *stages,
                                      double *error)
{
    *error = scaled_error(p, stages->error, h);
    if (!isfinite(*error))
    {
        return ELLIPSOID_NON_FINITE;
    }
    if (p->walls)
    {
        /* travel is proportional to the step */
        *error =
            fmax(*error, pow(unseen_travel(p, stages), (double)stages->order));
    }
    return ELLIPSOID_OK;
}
