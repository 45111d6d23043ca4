/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    stepControl.c - how long a step is, and whether it is good enough.
*/
#include "motion/motion.h"

#include <float.h>
#include <math.h>

/* With which power of the step errors of either method grow. */
static const double order = 4;

/* m u^2 + omega I omega, of velocities or of their errors */
static double twice_kinetic(const ellipsoid_model *m, const double y[UNKNOWNS])
{
    const double *w = y + AT_OMEGA;

    return m->mass * ellipsoid_dot(y + AT_U, y + AT_U)
         + m->inertia[0] * w[0] * w[0] + m->inertia[1] * w[1] * w[1]
         + m->inertia[2] * w[2] * w[2];
}

/*
    In vacuum errors of u and omega last, and change the energy: the root of
    what they make against the body's own, in motion at either end or in the
    contact at the start (Hertz: 2/5 of force times depth).
*/
static double lasting_error(const ellipsoid_model *m,
                            const ellipsoid_evaluation *start,
                            const ellipsoid_stages *stages)
{
    const ellipsoid_contact *c = &start->contact;
    const double kinetic =
        fmax(twice_kinetic(m, start->y), twice_kinetic(m, stages->y));
    const double elastic =
        0.8
        * (ellipsoid_length(c->force) * fmax(c->deepest, 0)
           + ellipsoid_length(c->cell_force) * fmax(c->cell_deepest, 0));
    const double all = kinetic + elastic;

    return all > 0 ? sqrt(twice_kinetic(m, stages->error) / all) : 0;
}

/* Does friction act on a body with inertia? */
static int is_rubbing(const ellipsoid_cell *p,
                      const ellipsoid_evaluation *start)
{
    return p->inertial && p->model->options.friction > 0
        && ellipsoid_in_contact(&start->contact);
}

/* Errors of the velocities may be this part of the speed with which it slides. */
static const double sliding_part = 0.1;

/*
    Where friction may hold a body, errors of its velocities are to be below the
    slip speed, or each step would find it slipping another way; or a part of the
    speed with which the slowest of its contacts slides.
*/
static double slip_error(const ellipsoid_cell *p,
                         const ellipsoid_evaluation *start,
                         const double error[])
{
    const double slip = fmin(start->contact.slip, start->contact.cell_slip);

    return is_rubbing(p, start)
             ? ellipsoid_surface_speed(p, error)
                   / fmax(p->model->options.slip_speed, sliding_part * slip)
             : 0;
}

/*
    The error in units of the tolerance. Errors of u and omega count by what
    they do to x and q: they last one relaxation time or one step, whichever is
    shorter. So the stiff components do not govern the step.
*/
static double scaled_error(const ellipsoid_cell *p,
                           const ellipsoid_evaluation *start,
                           const ellipsoid_stages *stages, double h)
{
    const double per_h = 1 / h, *error = stages->error;
    const double ex = ellipsoid_length(error + AT_X) / p->length;
    const double eq = sqrt(ellipsoid_square4(error + AT_Q));
    double eu = 0, ew = 0, slip = 0, sum;

    if (p->inertial)
    {
        eu = ellipsoid_length(error + AT_U)
           / (p->length * ellipsoid_greater(p->rate, per_h));
        ew = ellipsoid_length(error + AT_OMEGA)
           / ellipsoid_greater(p->rotation_rate, per_h);
        if (!(p->rate > 0))
        {
            eu += lasting_error(p->model, start, stages);
        }
        slip = slip_error(p, start, error);
    }
    sum = ex + eu + ew + eq + slip;

    return isfinite(sum)
             ? ellipsoid_greater(ellipsoid_greater(ellipsoid_greater(ex, eq),
                                                   ellipsoid_greater(eu, ew))
                                     / p->model->options.tolerance,
                                 slip)
             : sum;
}

/*
    Contact is evaluated only at the poses where the equations are evaluated. A
    bead that passes through a wall between two of them unseen has to leave the
    one gap, the wall by two radii less an overlap, and the other gap. So none
    does if none travels farther than both gaps and a bead radius: the farthest
    travel in units of that. Of two cells either moves half as far at most.
*/
static double unseen_travel(const ellipsoid_cell *p,
                            const ellipsoid_stages *stages, double bare)
{
    double worst = 0;

    for (int n = 1; n < stages->sampled; n++)
    {
        const int i = stages->in_time[n - 1], j = stages->in_time[n];
        const double safe = stages->gap[i] + stages->gap[j]
                          + bare * p->model->options.bead_radius;

        worst = ellipsoid_greater(
            ellipsoid_travel(p->model, &stages->pose[i], &stages->pose[j])
                / safe,
            worst);
    }
    return worst;
}

/* A bead that has landed is so deep at the end of the step, as a part of the
   deepest there is: the derivatives there know of its contact, and it has not
   been pushed away yet. At least so many bead radii. */
static const double landed_part = 0.1, landed_least = 3e-5;

/* After a landing the next step is this part of the one proposed before. */
static const double after_landing = 0.5;

/*
    A contact that begins inside a Rosenbrock step is not in its derivatives, and
    is so stiff that a long one is rejected. So the step ends where it begins, if
    the bead goes on as it moves at the start, of which the result depends alone.
*/
double ellipsoid_time_to_landing(const ellipsoid_group *g, double time)
{
    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_cell *p = &g->cell[cell];
        const ellipsoid_options *o = &p->model->options;
        const ellipsoid_evaluation *start = &g->start[cell];
        const ellipsoid_contact *contact = &start->contact;
        const double horizon = ellipsoid_gap_horizon(p->model);
        double moved;

        if (p->walls && o->contact_shape != ELLIPSOID_CONTACT_ELLIPSOID
            && contact->gap < horizon
            && ellipsoid_facet_cache_update(p->cache, p->model,
                                            &p->surroundings, start->state.x,
                                            start->state.q, horizon, &moved)
                   == ELLIPSOID_OK
            && p->cache->clearance <= 0)
        {
            const double depth = fmax(landed_part * contact->deepest,
                                      landed_least * o->bead_radius);

            time = ellipsoid_landing(p->model, &start->state, p->cache, moved,
                                     depth, time);
        }
    }
    return time;
}

/*
    The last two steps share what is left, so that none is tiny. A proposal
    that lands on `end` but for rounding is not altered: a run cut there goes
    on as if it had not been cut.
*/
ellipsoid_plan ellipsoid_plan_step(double proposal, double landing, double t,
                                   double end)
{
    const int lands = landing < proposal;
    const double left = end - t, h = lands ? landing : proposal;
    const double kept = lands ? after_landing * proposal : proposal;
    const double tolerance = 4 * DBL_EPSILON * ellipsoid_greater(fabs(t), h);

    if (fabs(left - h) <= tolerance)
    {
        return (ellipsoid_plan){h, t, end, 1, lands, kept};
    }
    if (left < h)
    {
        return (ellipsoid_plan){left, t, end, 1, 1, kept};
    }
    if (left < 1.25 * h)
    {
        return (ellipsoid_plan){0.5 * left, t, t + 0.5 * left, 0, 1, kept};
    }
    return (ellipsoid_plan){h, t, t + h, 0, lands, kept};
}

/* So small an error is one of a contact that comes to rest: what changes falls
   by orders of magnitude, and the error before would only hold back the step. */
static const double at_rest = 0.1;

/*
    PI control (Hairer & Wanner II, section IV.2): the factor by which the next
    step differs.
*/
double ellipsoid_step_factor(const ellipsoid_group *g, double error,
                             double previous_error)
{
    const double e = log(ellipsoid_greater(error, 1e-8));
    int alone = !(previous_error > 0 && error <= 1);
    double exponent;

    for (int cell = 0; error < at_rest && !alone && cell < g->count; cell++)
    {
        alone = is_rubbing(&g->cell[cell], &g->start[cell]);
    }
    exponent = alone ? -e : 0.4 * log(previous_error) - 0.7 * e;
    return ellipsoid_lesser(ellipsoid_greater(0.9 * exp(exponent / order), 0.2),
                            5);
}

/* What one cell says to it: `there` is a short way `ahead` along its slopes. */
static double longest_step(const ellipsoid_cell *p,
                           const ellipsoid_evaluation *start, double ahead,
                           const ellipsoid_evaluation *there)
{
    const double turn = sqrt(ellipsoid_square4(start->derivative.q));
    double bend[UNKNOWNS];

    for (int n = 0; n < UNKNOWNS; n++)
    {
        bend[n] = there->slope[n] - start->slope[n];
    }
    return 2 * pow(p->model->options.tolerance, 0.2)
         / fmax(turn, sqrt(ellipsoid_displacement(p, bend) / ahead));
}

/*
    Sets *step to a first step. With inertia it resolves the relaxation.
    Without, the times in which q turns and in which the slopes change say how
    long it may be; the latter from a short way along the slopes.
*/
ellipsoid_status ellipsoid_first_step(ellipsoid_group *g, double t, double end,
                                      double *step)
{
    double pace = 0, ahead;
    ellipsoid_status status;

    *step = g->cell[0].model->options.maximum_step;
    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_model *m = g->cell[cell].model;
        const double relaxation =
            fmin(m->relaxation_time, m->rotation_relaxation_time);

        *step = g->inertial ? fmin(*step, 0.25 * relaxation) : *step;
        pace = fmax(
            pace, ellipsoid_displacement(&g->cell[cell], g->start[cell].slope));
    }
    if (g->inertial || !(pace > 0))
    {
        return ELLIPSOID_OK;
    }
    ahead = 0.01 / pace;
    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_evaluation *start = &g->start[cell];

        for (int n = 0; n < UNKNOWNS; n++)
        {
            g->next[cell].y[n] = start->y[n] + ahead * start->slope[n];
        }
    }
    status = ellipsoid_group_evaluate(g, fmin(t + ahead, end), g->next, 1, 0);
    if (status != ELLIPSOID_OK)
    {
        *step = ahead;
        return ellipsoid_may_recover(status) ? ELLIPSOID_OK : status;
    }
    for (int cell = 0; cell < g->count; cell++)
    {
        *step = fmin(*step, longest_step(&g->cell[cell], &g->start[cell], ahead,
                                         &g->next[cell]));
    }
    return ELLIPSOID_OK;
}

/* Is the error of a step, or what it may have passed unseen, acceptable? */
ellipsoid_status ellipsoid_judge_step(const ellipsoid_group *g, double h,
                                      double *error)
{
    *error = 0;
    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_cell *p = &g->cell[cell];
        const ellipsoid_stages *stages = &g->stages[cell];
        const double made = scaled_error(p, &g->start[cell], stages, h);

        if (!isfinite(made))
        {
            return ELLIPSOID_NON_FINITE;
        }
        *error = ellipsoid_greater(made, *error);
        if (ellipsoid_has_contact(g, cell))
        {
            const double travel = unseen_travel(p, stages, g->pairs ? 0.5 : 1);
            const double square = travel * travel;

            /* travel is proportional to the step; its power costs more than to see
               that it is too small to count */
            if (!(1.001 * square * square < *error))
            {
                *error = fmax(*error, pow(travel, order));
            }
        }
    }
    return ELLIPSOID_OK;
}

ellipsoid_status ellipsoid_judge_expansions(const ellipsoid_group *g, double h,
                                            double *error)
{
    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_cell *p = &g->cell[cell];
        double wrong[6], made;

        if (p->fixed || !ellipsoid_has_near_walls(p->model, &p->surroundings)
            || g->next[cell].walls.planes == 0)
        {
            continue;
        }

        const ellipsoid_status status = ellipsoid_wall_expansion_error(
            &g->start[cell].walls, &g->next[cell].walls, wrong);

        if (status != ELLIPSOID_OK)
        {
            return status;
        }
        /* it grows as the square of time: a third of it over the step; a turn
           changes q by half of it */
        made = h / 3
             * fmax(ellipsoid_length(wrong) / p->length,
                    0.5 * ellipsoid_length(wrong + 3))
             / p->model->options.tolerance;
        /* places are wrong by the cube of the step */
        *error = fmax(*error, pow(made, order / 3));
    }
    return ELLIPSOID_OK;
}
