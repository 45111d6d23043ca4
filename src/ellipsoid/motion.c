/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    motion.c - one cell through time: step control, start and end.
*/
#include "ellipsoidInternal.h"

#include <float.h>
#include <math.h>
#include <string.h>

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
    const double eu =
        ellipsoid_length(error + U) / (p->length * fmax(p->rate, per_h));
    const double ew =
        ellipsoid_length(error + W) / fmax(p->rotation_rate, per_h);
    const double eq = sqrt(ellipsoid_dot(q, q) + q[3] * q[3]);
    double sum = ex + eu + ew + eq;

    /* fmax would drop a NaN */
    return isfinite(sum)
             ? fmax(fmax(ex, eq), fmax(eu, ew)) / p->model->options.tolerance
             : sum;
}

/* A step as planned. */
typedef struct plan
{
    double h;
    int last;      /* ends at `end` */
    int shortened; /* less than proposed, to land on `end` */
} plan;

/* The stages in the order of their times 0, 0.21, 0.386, 0.63, 1, 1. */
static const int in_time[ELLIPSOID_STAGES] = {0, 2, 1, 3, 4, 5};

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

    for (int n = 1; n < ELLIPSOID_STAGES; n++)
    {
        const int i = in_time[n - 1], j = in_time[n];
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
static plan plan_step(double proposal, double t, double end)
{
    const double left = end - t;
    const double slack = 4 * DBL_EPSILON * fmax(fabs(t), proposal);

    if (fabs(left - proposal) <= slack)
    {
        return (plan){proposal, 1, 0};
    }
    if (left < proposal)
    {
        return (plan){left, 1, 1};
    }
    if (left < 1.25 * proposal)
    {
        return (plan){0.5 * left, 0, 1};
    }
    return (plan){proposal, 0, 0};
}

/*
    PI control (Hairer & Wanner II, section IV.2): the factor by which the next
    step differs.
*/
static double step_factor(double error, double previous_error)
{
    const double e = fmax(error, 1e-8);
    double factor = 0.9 * pow(e, -0.25);

    if (previous_error > 0 && error <= 1)
    {
        factor = 0.9 * pow(e, -0.7 / 4) * pow(previous_error, 0.4 / 4);
    }
    return fmin(fmax(factor, 0.2), 5);
}

/* Is it a failure that a shorter step may cure? */
static int may_recover(ellipsoid_status status)
{
    return status == ELLIPSOID_STEP_UNDERFLOW || status == ELLIPSOID_NON_FINITE;
}

/*
    One attempt at a step. A step counts only if the equations can be evaluated
    where it ends. Sets next; *error is above 1 if it is too large.
*/
static ellipsoid_status try_step(const ellipsoid_problem *p,
                                 const ellipsoid_point *start,
                                 const plan *planned, ellipsoid_stages *stages,
                                 ellipsoid_point *next, double *error)
{
    ellipsoid_status status =
        ellipsoid_rosenbrock_step(p, start, planned->h, stages);

    if (status != ELLIPSOID_OK)
    {
        return status;
    }
    *error = scaled_error(p, stages->k[ELLIPSOID_STAGES - 1], planned->h);
    if (!isfinite(*error))
    {
        return ELLIPSOID_NON_FINITE;
    }
    if (p->walls)
    {
        const double travel = unseen_travel(p, stages);

        /* travel is proportional to the step, the error to its 4th power */
        *error = fmax(*error, travel * travel * travel * travel);
    }
    if (*error > 1)
    {
        return ELLIPSOID_OK;
    }
    ellipsoid_normalise(stages->y + Q);
    memcpy(&next->state, stages->y, sizeof(next->state));
    return ellipsoid_problem_evaluate(p, &next->state, &next->derivative,
                                      &next->contact,
                                      planned->last ? NULL : &next->blocks);
}

/*
    Takes one step from `start`, shortened until it succeeds. Sets next, step
    and controller.
*/
static ellipsoid_status take_step(const ellipsoid_problem *p,
                                  const ellipsoid_point *start, double t,
                                  double end, long *attempts,
                                  ellipsoid_controller *controller,
                                  ellipsoid_point *next, ellipsoid_step *step)
{
    const ellipsoid_options *o = &p->model->options;
    double proposal = controller->step > 0 ? controller->step : o->initial_step;
    double largest_factor = 5;

    proposal = fmin(proposal, o->maximum_step);
    while (*attempts < o->maximum_steps)
    {
        const plan planned = plan_step(proposal, t, end);
        ellipsoid_stages stages;
        double error = 0;
        const ellipsoid_status status =
            try_step(p, start, &planned, &stages, next, &error);

        ++*attempts;
        if (status == ELLIPSOID_OK && error <= 1)
        {
            controller->step =
                planned.h
                * fmin(step_factor(error, controller->previous_error),
                       largest_factor);
            if (planned.shortened)
            {
                controller->step = fmax(controller->step, proposal);
            }
            else
            {
                controller->previous_error = fmax(error, 1e-4);
            }
            step->start = t;
            step->end = planned.last ? end : t + planned.h;
            if (p->observed)
            {
                step->before = start->state;
                step->after = next->state;
                step->contact = next->contact;
                ellipsoid_rosenbrock_dense(&stages, step->dense);
            }
            p->statistics->accepted++;
            return ELLIPSOID_OK;
        }

        p->statistics->rejected++;
        if (status != ELLIPSOID_OK && !may_recover(status))
        {
            return status;
        }
        proposal =
            planned.h * (status == ELLIPSOID_OK ? step_factor(error, 0) : 0.25);
        largest_factor = 1;
        if (proposal < o->minimum_step || !(t + proposal > t))
        {
            return status == ELLIPSOID_NON_FINITE ? status
                                                  : ELLIPSOID_STEP_UNDERFLOW;
        }
    }
    return ELLIPSOID_TOO_MANY_STEPS;
}

/* Where the run begins. An orientation of length one is taken as it is, so
   that a run can be continued without a change in the last digit. */
static ellipsoid_status begin(const ellipsoid_problem *p,
                              const ellipsoid_state *state,
                              ellipsoid_point *start)
{
    double y[SIZE], sum = 0, square = 0;

    memcpy(y, state, sizeof(y));
    for (int n = 0; n < SIZE; n++)
    {
        sum += y[n];
    }
    for (int n = Q; n < SIZE; n++)
    {
        square += y[n] * y[n];
    }
    if (!isfinite(sum) || !isfinite(square) || !(square > 0))
    {
        return ELLIPSOID_NON_FINITE;
    }
    if (fabs(square - 1) > 1e-14)
    {
        ellipsoid_normalise(y + Q);
    }
    memcpy(&start->state, y, sizeof(start->state));
    return ellipsoid_problem_evaluate(p, &start->state, &start->derivative,
                                      &start->contact, &start->blocks);
}

ellipsoid_status ellipsoid_advance(const ellipsoid_model *model,
                                   const ellipsoid_surroundings *surroundings,
                                   ellipsoid_state *state, double *t,
                                   double end, ellipsoid_controller *controller,
                                   ellipsoid_contact_cache *cache,
                                   ellipsoid_observer observer,
                                   void *observer_context,
                                   ellipsoid_statistics *statistics)
{
    const double *a = model->options.semi_axes;
    const int drag = model->options.drag && surroundings->flow != NULL;
    const ellipsoid_problem p = {
        .model = model,
        .surroundings = surroundings,
        .cache = cache,
        .statistics = statistics,
        .length = fmax(a[0], fmax(a[1], a[2])),
        .rate = drag ? 1 / model->relaxation_time : 0,
        .rotation_rate = drag ? 1 / model->rotation_relaxation_time : 0,
        .walls = ellipsoid_has_walls(model, surroundings),
        .observed = observer != NULL,
    };
    ellipsoid_point points[2], *start = &points[0], *next = &points[1];
    ellipsoid_step step;
    long attempts = 0;
    ellipsoid_status status;

    if (!(end > *t))
    {
        return ELLIPSOID_OK;
    }
    memset(&points[0].contact, 0, sizeof(points[0].contact));
    points[0].contact.gap = HUGE_VAL;
    points[1].contact = points[0].contact;

    status = begin(&p, state, start);
    while (status == ELLIPSOID_OK && *t < end)
    {
        ellipsoid_point *finished = start;

        status =
            take_step(&p, start, *t, end, &attempts, controller, next, &step);
        if (status == ELLIPSOID_OK)
        {
            *state = next->state;
            *t = step.end;
            statistics->deepest =
                fmax(statistics->deepest, next->contact.deepest);
            if (observer && observer(observer_context, &step))
            {
                status = ELLIPSOID_STOPPED;
            }
            start = next;
            next = finished;
        }
    }
    return status;
}
