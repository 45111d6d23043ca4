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

/* A step as planned. */
typedef struct plan
{
    double h;
    int last;      /* ends at `end` */
    int shortened; /* less than proposed, to land on `end` */
} plan;

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
    step differs, where errors grow with the step to the power of the order.
*/
static double step_factor(int order, double error, double previous_error)
{
    const double e = log(fmax(error, 1e-8));
    const double exponent = previous_error > 0 && error <= 1
                              ? 0.4 * log(previous_error) - 0.7 * e
                              : -e;

    return fmin(fmax(0.9 * exp(exponent / order), 0.2), 5);
}

/* Is it a failure that a shorter step may cure? */
static int may_recover(ellipsoid_status status)
{
    return status == ELLIPSOID_STEP_UNDERFLOW || status == ELLIPSOID_NON_FINITE;
}

/*
    Sets *step to a first step. With inertia it resolves the relaxation.
    Without, the times in which q turns and in which the slopes change say how
    long it may be; the latter from a short way along the slopes.
*/
static ellipsoid_status first_step(const ellipsoid_problem *p,
                                   const ellipsoid_point *start, double *step)
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
        return may_recover(status) ? ELLIPSOID_OK : status;
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

/* The blocks at a point that has been evaluated without. */
static ellipsoid_status add_blocks(const ellipsoid_problem *p,
                                   ellipsoid_point *at)
{
    at->has_blocks = 1;
    return ellipsoid_problem_evaluate(p, &at->state, !p->inertial,
                                      &at->derivative, &at->contact,
                                      &at->blocks);
}

/* Is the error of a step, or what it may have passed unseen, acceptable? */
static ellipsoid_status judge(const ellipsoid_problem *p, double h,
                              const ellipsoid_stages *stages, double *error)
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

/*
    One attempt at a Rosenbrock step. A step counts only if the equations can be
    evaluated where it ends.
*/
static ellipsoid_status try_rosenbrock(const ellipsoid_problem *p,
                                       ellipsoid_point *start,
                                       const plan *planned,
                                       ellipsoid_stages *stages,
                                       ellipsoid_point *next, double *error)
{
    ellipsoid_status status =
        start->has_blocks ? ELLIPSOID_OK : add_blocks(p, start);

    if (status == ELLIPSOID_OK)
    {
        status = ellipsoid_rosenbrock_step(p, start, planned->h, stages);
    }
    if (status == ELLIPSOID_OK)
    {
        status = judge(p, planned->h, stages, error);
    }
    if (status != ELLIPSOID_OK || *error > 1)
    {
        return status;
    }
    ellipsoid_normalise(stages->y + Q);
    memcpy(&next->state, stages->y, sizeof(next->state));
    next->has_blocks = !planned->last;
    return ellipsoid_problem_evaluate(p, &next->state, !p->inertial,
                                      &next->derivative, &next->contact,
                                      planned->last ? NULL : &next->blocks);
}

/*
    One attempt at a step. Without inertia it is explicit, unless the cell
    touches a wall in it. Sets next; *error is above 1 if it is too large.
*/
static ellipsoid_status try_step(const ellipsoid_problem *p,
                                 ellipsoid_point *start, const plan *planned,
                                 ellipsoid_stages *stages,
                                 ellipsoid_point *next, double *error,
                                 int *explicitly)
{
    int touched = start->contact.touching_beads > 0;
    ellipsoid_status status = ELLIPSOID_OK;

    if (!p->inertial && !touched)
    {
        status = ellipsoid_explicit_step(p, start, planned->h, stages, next,
                                         &touched);
    }
    *explicitly = !p->inertial && !touched;
    if (!*explicitly)
    {
        return try_rosenbrock(p, start, planned, stages, next, error);
    }
    return status == ELLIPSOID_OK ? judge(p, planned->h, stages, error)
                                  : status;
}

/*
    Takes one step from `start`, shortened until it succeeds. Sets next, step
    and controller.
*/
static ellipsoid_status take_step(const ellipsoid_problem *p,
                                  ellipsoid_point *start, double t, double end,
                                  long *attempts,
                                  ellipsoid_controller *controller,
                                  ellipsoid_point *next, ellipsoid_step *step)
{
    const ellipsoid_options *o = &p->model->options;
    const double shortest =
        fmax(o->minimum_step, 4 * DBL_EPSILON * fmax(fabs(t), DBL_MIN));
    double largest_factor = 5, proposal = controller->step;

    if (!(proposal > 0))
    {
        const ellipsoid_status status = first_step(p, start, &proposal);

        if (status != ELLIPSOID_OK)
        {
            return status;
        }
    }
    if (o->maximum_step < shortest)
    {
        return ELLIPSOID_STEP_UNDERFLOW;
    }
    proposal = fmin(fmax(proposal, shortest), o->maximum_step);
    while (*attempts < o->maximum_steps)
    {
        const plan planned = plan_step(proposal, t, end);
        ellipsoid_stages stages;
        double error = 0;
        int explicitly;
        const ellipsoid_status status =
            try_step(p, start, &planned, &stages, next, &error, &explicitly);

        ++*attempts;
        if (status == ELLIPSOID_OK && error <= 1)
        {
            controller->step = planned.h
                             * fmin(step_factor(stages.order, error,
                                                controller->previous_error),
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
                if (explicitly)
                {
                    ellipsoid_explicit_dense(&stages, step, step->dense);
                }
                else
                {
                    ellipsoid_rosenbrock_dense(&stages, step->dense);
                }
            }
            p->statistics->accepted++;
            return ELLIPSOID_OK;
        }

        p->statistics->rejected++;
        if (status != ELLIPSOID_OK && !may_recover(status))
        {
            return status;
        }
        proposal = planned.h
                 * (status == ELLIPSOID_OK ? step_factor(stages.order, error, 0)
                                           : 0.25);
        largest_factor = 1;
        if (proposal < shortest)
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
        const int is_rate = n < X || (n >= W && n < Q);

        y[n] = is_rate && !p->inertial ? 0 : y[n]; /* not read */
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
    start->has_blocks = p->inertial;
    return ellipsoid_problem_evaluate(
        p, &start->state, !p->inertial, &start->derivative, &start->contact,
        start->has_blocks ? &start->blocks : NULL);
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
        .inertial = model->options.motion == ELLIPSOID_MOTION_INERTIAL,
        .walls = ellipsoid_has_walls(model, surroundings),
        .observed = observer != NULL,
    };
    ellipsoid_point points[2], *start = &points[0], *next = &points[1];
    ellipsoid_step step;
    long attempts = 0;
    ellipsoid_status status;

    if (!isfinite(*t) || !isfinite(end))
    {
        return ELLIPSOID_NON_FINITE;
    }
    if (!(end > *t))
    {
        return ELLIPSOID_OK;
    }
    if (!p.inertial && !drag)
    {
        return ELLIPSOID_BAD_OPTION;
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
