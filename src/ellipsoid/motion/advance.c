/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    advance.c - a group of cells through time: start, steps, end.
*/
#include "motion/motion.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* An error that shortens the step as far as one rejection may. */
static const double far_too_large = 1e6;

/* A body that needs a shorter step is given up [s]. */
static const double smallest_step = 1e-18;

/*
    Does a step let go of a wall or a cell as the cell itself would not? The
    method takes the contact for a spring that also pulls, so that a long step
    ends beside the wall though the cell is free to go, which the error estimate
    does not show. Then the velocity that the cell takes up would have led much
    farther along the contact's push than the step did. Or a step from where a
    bead has just landed throws the cell off, by less than the tolerance, and it
    would come back, to be thrown off again: it moves against the push. Motions
    are counted as the work of that push, force and torque.
*/
static int is_release_wrong(const ellipsoid_cell *p,
                            const ellipsoid_evaluation *start,
                            const ellipsoid_evaluation *next, double h)
{
    const ellipsoid_contact *was = &start->contact, *is = &next->contact;
    const double *from = start->state.q, *to = next->state.q;
    const double back[4] = {-from[0], -from[1], -from[2], from[3]};
    double lag = 0, turning_lag = 0, slight, made = 0, coming = 0;
    double force[3], torque[3], turned[4];

    if (is->bead_contacts >= was->bead_contacts
        && is->cell_count >= was->cell_count
        && is->deepest >= 0.5 * was->deepest
        && is->cell_deepest >= 0.5 * was->cell_deepest)
    {
        return 0;
    }
    if (p->inertial)
    {
        lag = 1 / fmax(1 / h, p->rate);
        turning_lag = 1 / fmax(1 / h, p->rotation_rate);
    }
    ellipsoid_copy(was->force, force);
    ellipsoid_add(force, was->cell_force);
    ellipsoid_copy(was->torque, torque);
    ellipsoid_add(torque, was->cell_torque);
    slight = 10 * p->model->options.tolerance
           * (ellipsoid_length(force) * p->length + ellipsoid_length(torque));
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
    if (is->surface_count == 0 && is->cell_count == 0 && made > 0 && coming < 0)
    {
        return 1;
    }
    return coming > 4 * fmax(made, 0) + slight;
}

static int is_one_release_wrong(ellipsoid_group *g, double h)
{
    for (int cell = 0; cell < g->count; cell++)
    {
        if (is_release_wrong(&g->cell[cell], &g->start[cell], &g->next[cell],
                             h))
        {
            return 1;
        }
    }
    return 0;
}

/* A step from blocks that are there, to where the next states are. */
static ellipsoid_status solve_step(ellipsoid_group *g,
                                   const ellipsoid_plan *planned, double *error)
{
    ellipsoid_status status = ellipsoid_rosenbrock_step(g, planned);

    if (status == ELLIPSOID_OK)
    {
        status = ellipsoid_judge_step(g, planned->h, error);
    }
    for (int cell = 0; status == ELLIPSOID_OK && *error <= 1 && cell < g->count;
         cell++)
    {
        double *y = g->stages[cell].y;

        ellipsoid_normalise(y + AT_Q);
        memcpy(&g->next[cell].state, g->cell[cell].fixed ? g->start[cell].y : y,
               sizeof(g->next[cell].state));
    }
    return status;
}

/*
    One attempt at a Rosenbrock step. A step counts only if the equations can be
    evaluated where it ends; with derivatives if the next step needs them.
*/
static ellipsoid_status
try_rosenbrock(ellipsoid_group *g, const ellipsoid_plan *planned, double *error)
{
    ellipsoid_status status = ELLIPSOID_OK;

    if (!g->has_blocks)
    {
        status = ellipsoid_group_evaluate(g, planned->start, g->start,
                                          !g->inertial, 1);
        g->has_blocks = status == ELLIPSOID_OK;
    }
    if (status == ELLIPSOID_OK)
    {
        status = solve_step(g, planned, error);
    }
    if (status != ELLIPSOID_OK || *error > 1)
    {
        return status;
    }
    g->next_has_blocks = !planned->last;
    status = ellipsoid_group_evaluate(g, planned->end, g->next, !g->inertial,
                                      g->next_has_blocks);
    /* there is room for the couplings of one time only */
    g->has_blocks = g->has_blocks && !(g->pairs && g->next_has_blocks);
    if (status == ELLIPSOID_OK)
    {
        status = ellipsoid_judge_expansions(g, planned->h, error);
    }
    if (status == ELLIPSOID_OK && *error <= 1
        && is_one_release_wrong(g, planned->h))
    {
        *error = far_too_large;
    }
    return status;
}

/* May a step be explicit? Not with inertia, nor where a cell touches something,
   is turned by a dipole or under an external force: these may be stiff. */
static int may_be_explicit(const ellipsoid_group *g)
{
    int stiff = g->inertial || g->stiff;

    for (int cell = 0; !stiff && cell < g->count; cell++)
    {
        stiff = ellipsoid_in_contact(&g->start[cell].contact);
    }
    return !stiff;
}

/* One attempt at a step. Sets next; *error is above 1 if it is too large. */
static ellipsoid_status try_step(ellipsoid_group *g,
                                 const ellipsoid_plan *planned, double *error,
                                 int *explicitly)
{
    *explicitly = may_be_explicit(g);
    if (*explicitly)
    {
        int touched;
        ellipsoid_status status = ellipsoid_explicit_step(g, planned, &touched);

        if (status != ELLIPSOID_OK || !touched)
        {
            g->next_has_blocks = 0;
            return status == ELLIPSOID_OK
                     ? ellipsoid_judge_step(g, planned->h, error)
                     : status;
        }
        *explicitly = 0;
    }
    return try_rosenbrock(g, planned, error);
}

/* Sets what is reported of the accepted step, by the continuous extension of its
   method; NULL: it is linear in time. */
static void
describe_step(const ellipsoid_group *g, const ellipsoid_plan *planned,
              void (*dense)(const ellipsoid_group *, int, double[2][UNKNOWNS]))
{
    for (int cell = 0; cell < g->count; cell++)
    {
        ellipsoid_step *step = &g->step[cell];

        step->start = planned->start;
        step->end = planned->end;
        step->before = g->start[cell].state;
        step->after = g->next[cell].state;
        step->contact = g->next[cell].contact;
        memset(step->dense, 0, sizeof(step->dense));
        if (dense)
        {
            dense(g, cell, step->dense);
        }
    }
}

/* Sets where an attempt begins. */
static ellipsoid_status propose_step(ellipsoid_group *g, double t, double end,
                                     double shortest, double *proposal)
{
    const double longest = g->cell[0].model->options.maximum_step;
    const ellipsoid_status status =
        *proposal > 0 ? ELLIPSOID_OK
                      : ellipsoid_first_step(g, t, end, proposal);

    *proposal =
        ellipsoid_lesser(ellipsoid_greater(*proposal, shortest), longest);
    return status == ELLIPSOID_OK && longest < shortest
             ? ELLIPSOID_STEP_UNDERFLOW
             : status;
}

static void count_attempt(const ellipsoid_group *g, int accepted)
{
    for (int cell = 0; cell < g->count; cell++)
    {
        ellipsoid_statistics *statistics = g->cell[cell].statistics;

        statistics->accepted += accepted;
        statistics->rejected += !accepted;
    }
}

/* Sets what is reported of an accepted step, if it is observed, and the
   controller. largest: the factor by which the next may be longer. */
static void accept_step(ellipsoid_group *g, const ellipsoid_plan *planned,
                        int explicitly, double error, double largest,
                        ellipsoid_controller *controller)
{
    const double factor =
        ellipsoid_step_factor(g, error, controller->previous_error);

    controller->step = planned->h * ellipsoid_lesser(factor, largest);
    if (planned->shortened)
    {
        controller->step = fmax(controller->step, planned->kept);
    }
    else
    {
        controller->previous_error = ellipsoid_greater(error, 1e-4);
    }
    if (g->observed)
    {
        describe_step(g, planned,
                      explicitly ? ellipsoid_explicit_dense
                                 : ellipsoid_rosenbrock_dense);
    }
}

/*
    Takes one step from the start, shortened until it succeeds. Sets next, the
    steps, the time and the controller.
*/
static ellipsoid_status take_step(ellipsoid_group *g, double *t, double end,
                                  long *attempts,
                                  ellipsoid_controller *controller)
{
    const ellipsoid_options *o = &g->cell[0].model->options;
    const double shortest =
        ellipsoid_greater(4 * DBL_EPSILON * fabs(*t), smallest_step);
    double largest_factor = 5, proposal = controller->step, landing;
    ellipsoid_status status = propose_step(g, *t, end, shortest, &proposal);

    if (status != ELLIPSOID_OK)
    {
        return status;
    }
    landing =
        ellipsoid_greater(ellipsoid_time_to_landing(g, proposal), shortest);
    while (*attempts < o->maximum_steps)
    {
        const ellipsoid_plan planned =
            ellipsoid_plan_step(proposal, landing, *t, end);
        double error = 0;
        int explicitly;

        g->failed = -1;
        status = try_step(g, &planned, &error, &explicitly);
        ++*attempts;
        count_attempt(g, status == ELLIPSOID_OK && error <= 1);
        if (status == ELLIPSOID_OK && error <= 1)
        {
            accept_step(g, &planned, explicitly, error, largest_factor,
                        controller);
            *t = planned.end;
            return ELLIPSOID_OK;
        }
        if (status != ELLIPSOID_OK && !ellipsoid_may_recover(status))
        {
            return status;
        }
        proposal = planned.h
                 * (status == ELLIPSOID_OK ? ellipsoid_step_factor(g, error, 0)
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

/* Takes the group that rests to where the interval ends, which `next` is. */
static ellipsoid_status take_rest(ellipsoid_group *g,
                                  const ellipsoid_plan *interval, double *t,
                                  long *attempts)
{
    if (*attempts >= g->cell[0].model->options.maximum_steps)
    {
        return ELLIPSOID_TOO_MANY_STEPS;
    }
    g->next_has_blocks = 0;
    ++*attempts;
    count_attempt(g, 1);
    if (g->observed)
    {
        describe_step(g, interval, NULL);
    }
    *t = interval->end;
    return ELLIPSOID_OK;
}

/* An orientation of length one is taken as it is, so that a run can be
   continued without a change in the last digit. */
static ellipsoid_status set_start(int moves, const ellipsoid_state *state,
                                  ellipsoid_evaluation *start)
{
    double sum = 0, square;

    start->state = *state;
    if (!moves)
    {
        ellipsoid_set_no_rates(&start->state); /* not read */
    }
    for (int n = 0; n < UNKNOWNS; n++)
    {
        sum += start->y[n];
    }
    square = ellipsoid_square4(start->state.q);
    if (!isfinite(sum) || !isfinite(square) || !(square >= DBL_MIN))
    {
        return ELLIPSOID_BAD_STATE;
    }
    if (fabs(square - 1) > 1e-14)
    {
        ellipsoid_normalise(start->state.q);
    }
    return ELLIPSOID_OK;
}

ellipsoid_status ellipsoid_group_start(ellipsoid_group *g,
                                       const ellipsoid_member members[])
{
    ellipsoid_status status = ELLIPSOID_OK;

    for (int cell = 0; status == ELLIPSOID_OK && cell < g->count; cell++)
    {
        status = set_start(g->inertial && !g->cell[cell].fixed,
                           members[cell].state, &g->start[cell]);
        g->failed = status == ELLIPSOID_OK ? -1 : cell;
    }
    return status;
}

ellipsoid_status ellipsoid_status_at_start(ellipsoid_status status)
{
    return status == ELLIPSOID_STEP_UNDERFLOW ? ELLIPSOID_OUTSIDE : status;
}

/* Where an interval begins. */
static ellipsoid_status begin(ellipsoid_group *g, double t, double end)
{
    ellipsoid_status status = ellipsoid_noise_layer(g, t, end);

    if (status == ELLIPSOID_OK)
    {
        g->has_blocks = g->inertial;
        status = ellipsoid_group_evaluate(g, t, g->start, !g->inertial,
                                          g->has_blocks);
    }
    return ellipsoid_status_at_start(status);
}

/* The step control of the group follows from those of its members. */
static ellipsoid_controller common(const ellipsoid_group *g,
                                   const ellipsoid_member members[])
{
    ellipsoid_controller all = *members[0].controller;

    for (int cell = 1; cell < g->count; cell++)
    {
        const ellipsoid_controller *own = members[cell].controller;

        all.step = fmin(all.step, own->step);
        all.previous_error = fmax(all.previous_error, own->previous_error);
    }
    return all;
}

/* Gives the members their state at the end of the step. Does one want to
   stop? */
static int update_members(ellipsoid_group *g, const ellipsoid_member members[],
                          const ellipsoid_controller *controller,
                          ellipsoid_observer observer)
{
    int stopped = 0;

    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_evaluation *next = &g->next[cell];
        ellipsoid_statistics *statistics = g->cell[cell].statistics;

        *members[cell].state = next->state;
        *members[cell].controller = *controller;
        statistics->deepest =
            ellipsoid_greater(next->contact.deepest, statistics->deepest);
    }
    for (int cell = 0; observer && cell < g->count; cell++)
    {
        if (observer(members[cell].observer_context, &g->step[cell])
            && !stopped)
        {
            stopped = 1;
            g->failed = cell;
        }
    }
    return stopped;
}

ellipsoid_status ellipsoid_group_advance(ellipsoid_group *g,
                                         const ellipsoid_member members[],
                                         double *t, double end,
                                         ellipsoid_observer observer,
                                         long *attempts)
{
    ellipsoid_controller controller = common(g, members);
    const ellipsoid_plan whole = {end - *t, *t, end, 1, 1, controller.step};
    ellipsoid_status status = ellipsoid_rest(g, &whole);
    const int rests =
        status == ELLIPSOID_OK && !is_one_release_wrong(g, whole.h);

    if (!rests && (status == ELLIPSOID_OK || ellipsoid_may_recover(status)))
    {
        status = begin(g, *t, end);
    }
    while (status == ELLIPSOID_OK && *t < end)
    {
        status = rests ? take_rest(g, &whole, t, attempts)
                       : take_step(g, t, end, attempts, &controller);
        if (status == ELLIPSOID_OK)
        {
            ellipsoid_evaluation *finished = g->start;

            if (update_members(g, members, &controller, observer))
            {
                status = ELLIPSOID_STOPPED;
            }
            g->start = g->next;
            g->next = finished;
            g->has_blocks = g->next_has_blocks;
        }
    }
    return status;
}
