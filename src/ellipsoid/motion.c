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

/* An error that shortens the step as far as one rejection may. */
static const double far_too_large = 1e6;

/* The blocks at a point that has been evaluated without. */
static ellipsoid_status add_blocks(const ellipsoid_problem *p,
                                   ellipsoid_point *at)
{
    const ellipsoid_status status = ellipsoid_problem_evaluate(
        p, &at->state, !p->inertial, &at->derivative, &at->contact,
        &at->blocks);

    at->has_blocks = status == ELLIPSOID_OK;
    return status;
}

/*
    Has a step that lets go of a wall been held back by it? The method takes the
    contact for a spring that also pulls, so that a long step ends beside the
    wall though the cell is free to go, which the error estimate does not show.
    Then the velocity that the cell takes up would have led much farther along
    the contact's push than the step did. Both are counted as the work of that
    push, force and torque.
*/
static int was_held_back(const ellipsoid_problem *p,
                         const ellipsoid_point *start,
                         const ellipsoid_point *next, double h)
{
    const double *force = start->contact.force, *torque = start->contact.torque;
    const double slight =
        10 * p->model->options.tolerance
        * (ellipsoid_length(force) * p->length + ellipsoid_length(torque));
    const double *from = start->state.q, *to = next->state.q;
    const double back[4] = {-from[0], -from[1], -from[2], from[3]};
    const double lag = p->inertial ? 1 / fmax(1 / h, p->rate) : 0;
    const double turning_lag =
        p->inertial ? 1 / fmax(1 / h, p->rotation_rate) : 0;
    double made = 0, coming = 0, turned[4];

    if (next->contact.touching_beads >= start->contact.touching_beads
        && next->contact.deepest >= 0.5 * start->contact.deepest)
    {
        return 0;
    }
    /* back * to, of which twice the vector is the turn in the body */
    ellipsoid_spin(to, back, turned);
    for (int i = 0; i < 3; i++)
    {
        const double turn = 2 * (turned[i] + to[3] * back[i]);
        const double u = next->state.u[i] + lag * next->derivative.u[i];
        const double omega =
            next->state.omega[i] + turning_lag * next->derivative.omega[i];

        made += force[i] * (next->state.x[i] - start->state.x[i])
              + torque[i] * turn;
        coming += h * (force[i] * u + torque[i] * omega);
    }
    return coming > 4 * fmax(made, 0) + slight;
}

/*
    One attempt at a Rosenbrock step. A step counts only if the equations can be
    evaluated where it ends.
*/
static ellipsoid_status try_rosenbrock(const ellipsoid_problem *p,
                                       ellipsoid_point *start,
                                       const ellipsoid_plan *planned,
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
        status = ellipsoid_judge_step(p, planned->h, stages, error);
    }
    if (status != ELLIPSOID_OK || *error > 1)
    {
        return status;
    }
    ellipsoid_normalise(stages->y + Q);
    memcpy(&next->state, stages->y, sizeof(next->state));
    next->has_blocks = !planned->last;
    status = ellipsoid_problem_evaluate(p, &next->state, !p->inertial,
                                        &next->derivative, &next->contact,
                                        planned->last ? NULL : &next->blocks);
    if (status == ELLIPSOID_OK && p->walls
        && was_held_back(p, start, next, planned->h))
    {
        *error = far_too_large;
    }
    return status;
}

/*
    One attempt at a step. Without inertia it is explicit, unless the cell
    touches a wall in it or is turned by a dipole: both may be stiff. Sets next;
    *error is above 1 if it is too large.
*/
static ellipsoid_status
try_step(const ellipsoid_problem *p, ellipsoid_point *start,
         const ellipsoid_plan *planned, ellipsoid_stages *stages,
         ellipsoid_point *next, double *error, int *explicitly)
{
    int touched = p->aligned || start->contact.touching_beads > 0;
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
    return status == ELLIPSOID_OK
             ? ellipsoid_judge_step(p, planned->h, stages, error)
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
        const ellipsoid_status status =
            ellipsoid_first_step(p, start, &proposal);

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
        const ellipsoid_plan planned = ellipsoid_plan_step(proposal, t, end);
        ellipsoid_stages stages;
        double error = 0;
        int explicitly;
        const ellipsoid_status status =
            try_step(p, start, &planned, &stages, next, &error, &explicitly);

        ++*attempts;
        if (status == ELLIPSOID_OK && error <= 1)
        {
            controller->step =
                planned.h
                * fmin(ellipsoid_step_factor(stages.order, error,
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
        if (status != ELLIPSOID_OK && !ellipsoid_may_recover(status))
        {
            return status;
        }
        proposal = planned.h
                 * (status == ELLIPSOID_OK
                        ? ellipsoid_step_factor(stages.order, error, 0)
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
                              const ellipsoid_state *state, double t,
                              double end, ellipsoid_point *start)
{
    double y[SIZE], sum = 0, square = 0;
    ellipsoid_status status;

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
    if (!isfinite(sum) || !isfinite(square) || !(square >= DBL_MIN))
    {
        return ELLIPSOID_NON_FINITE;
    }
    if (fabs(square - 1) > 1e-14)
    {
        ellipsoid_normalise(y + Q);
    }
    memcpy(&start->state, y, sizeof(start->state));
    status = ellipsoid_cross_layer(p, t, end, &start->state);
    if (status != ELLIPSOID_OK)
    {
        return status;
    }
    start->has_blocks = p->inertial;
    return ellipsoid_problem_evaluate(
        p, &start->state, !p->inertial, &start->derivative, &start->contact,
        start->has_blocks ? &start->blocks : NULL);
}

/* What the caller of an advance hands in, and how many steps it has tried. */
typedef struct journey
{
    ellipsoid_state *state;
    double *t;
    ellipsoid_controller *controller;
    ellipsoid_observer observer;
    void *observer_context;
    long attempts;
} journey;

/* Goes on to `end`, in one noise interval if there is noise. */
static ellipsoid_status go_to(const ellipsoid_problem *p, double end,
                              journey *j)
{
    ellipsoid_point points[2], *start = &points[0], *next = &points[1];
    ellipsoid_step step;
    ellipsoid_status status;

    memset(&points[0].contact, 0, sizeof(points[0].contact));
    points[0].contact.gap = HUGE_VAL;
    points[1].contact = points[0].contact;

    status = begin(p, j->state, *j->t, end, start);
    while (status == ELLIPSOID_OK && *j->t < end)
    {
        ellipsoid_point *finished = start;

        status = take_step(p, start, *j->t, end, &j->attempts, j->controller,
                           next, &step);
        if (status == ELLIPSOID_OK)
        {
            *j->state = next->state;
            *j->t = step.end;
            p->statistics->deepest =
                fmax(p->statistics->deepest, next->contact.deepest);
            if (j->observer && j->observer(j->observer_context, &step))
            {
                status = ELLIPSOID_STOPPED;
            }
            start = next;
            next = finished;
        }
    }
    return status;
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
    const int noisy = model->options.brownian && drag;
    ellipsoid_noise noise = {{0}, {0}, 0, 0, 0};
    const ellipsoid_problem p = {
        .model = model,
        .surroundings = surroundings,
        .cache = cache,
        .statistics = statistics,
        .length = fmax(a[0], fmax(a[1], a[2])),
        .rate = drag ? 1 / model->relaxation_time : 0,
        .rotation_rate = drag ? 1 / model->rotation_relaxation_time : 0,
        .noise = noisy ? &noise : NULL,
        .aligned = model->aligned,
        .inertial = model->options.motion == ELLIPSOID_MOTION_INERTIAL,
        .walls = ellipsoid_has_walls(model, surroundings),
        .observed = observer != NULL,
    };
    journey j = {state, t, controller, observer, observer_context, 0};
    ellipsoid_status status = ELLIPSOID_OK;

    if (!isfinite(*t) || !isfinite(end))
    {
        return ELLIPSOID_NON_FINITE;
    }
    if (!p.inertial && !drag)
    {
        return *t < end ? ELLIPSOID_BAD_OPTION : ELLIPSOID_OK;
    }
    while (status == ELLIPSOID_OK && *t < end)
    {
        double until = end;

        if (noisy)
        {
            status = ellipsoid_noise_at(model, surroundings, *t, &noise);
            if (noise.end < end - noise.slack)
            {
                until = noise.end;
            }
        }
        if (status == ELLIPSOID_OK)
        {
            status = go_to(&p, until, &j);
        }
    }
    return status;
}
