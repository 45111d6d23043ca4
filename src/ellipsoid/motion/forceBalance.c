/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    forceBalance.c - velocities that balance forces which depend on them.

    Drag alone is linear in u and omega, and equations.c inverts it. Friction,
    damping and external forces are not, and they couple the cells of a group:
    Newton's method, with the linear system of a step whose length vanishes. It
    begins at rest, so that the result is that of the poses alone. From there,
    where friction holds, towards sliding, its tangents fall short; where one
    goes too far the change is shortened. Where that does not converge, as where
    many beads slide at speeds far above the slip speed, the slip speed is
    raised first and lowered to its value in steps. Where Newton's method then
    repeats the same iterates, as where damping ends at some of many beads, the
    body's velocities relax from rest as they do in time.
*/
#include "motion/motion.h"

#include <math.h>

enum
{
    MOST_ITERATIONS = 60,
    MOST_RELAXATIONS = 400,
    MOST_HALVINGS = 40,        /* damping turns sharply where it lets go */
    CHANGE = ELLIPSOID_STAGES, /* beyond the stages of a step */
    BEST
};

/* The slip speeds begin at so much of their value, and fall by a factor. */
static const double smoothest = 1e12, less_smooth = 0.1;

/* Newton has converged when it changes velocities by so much of themselves; or
   by this little more, and goes no further: rounding, where speeds are very
   many slip speeds. */
static const double converged = 1e-12, nearly = 1e-8;

/* Where friction or damping is 1e10 times what drag is, or speeds are 1e10 slip
   speeds, rounding leaves more, in each iteration another part: it is taken if
   nothing better has come in half of the iterations, or in all of them. */
static const double stalled = 1e-5;

/* Velocities are relaxed where this part of the unbalanced forces at rest is
   left: from there Newton's method converges. On the way they may grow by so
   much in a step. */
static const double relaxed = 1e-6, growth = 1.2;

/* The length of the step whose matrix Newton's method takes, by the relaxation
   time: so short that poses do not change. */
static const double vanishing = 2.5e-21;

/* What is left of the power of the unbalanced forces along the change of
   velocities, if its sign has turned: then the step went too far. */
static const double too_far = 0.5;

/* Adds the product of the unbalanced forces and torques with u and omega. */
static void add_product(const ellipsoid_model *m, const ellipsoid_state *slope,
                        const double u[3], const double omega[3], double *sum)
{
    for (int i = 0; i < 3; i++)
    {
        *sum += m->mass * slope->u[i] * u[i]
              + m->inertia[i] * slope->omega[i] * omega[i];
    }
}

/* Power of the unbalanced forces, [W]. */
static double power_along(const ellipsoid_group *g,
                          const ellipsoid_evaluation *points)
{
    double power = 0;

    for (int cell = 0; cell < g->count; cell++)
    {
        const double *change = g->stages[cell].k[CHANGE];

        add_product(g->cell[cell].model, &points[cell].derivative,
                    change + AT_U, change + AT_OMEGA, &power);
    }
    return power;
}

static void move(const ellipsoid_group *g, double part,
                 ellipsoid_evaluation *points)
{
    for (int cell = 0; cell < g->count; cell++)
    {
        const double *change = g->stages[cell].k[CHANGE];

        ellipsoid_add_times(points[cell].state.u, part, change + AT_U);
        ellipsoid_add_times(points[cell].state.omega, part, change + AT_OMEGA);
    }
}

/* Are the changes a small part of the velocities and the slip speed? */
static int are_small(const ellipsoid_group *g,
                     const ellipsoid_evaluation *points, double part)
{
    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_cell *p = &g->cell[cell];
        const double speed = ellipsoid_surface_speed(p, points[cell].y)
                           + 1e-3 * p->model->options.slip_speed;

        if (!(ellipsoid_surface_speed(p, g->stages[cell].k[CHANGE])
              <= part * speed))
        {
            return 0;
        }
    }
    return 1;
}

/* Newton's change of velocities, from points that have their blocks. */
static int set_changes(ellipsoid_group *g, const ellipsoid_evaluation *points)
{
    double shortest = HUGE_VAL;
    int regular;

    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_cell *p = &g->cell[cell];
        double *k = g->stages[cell].k[CHANGE];

        memset(k, 0, sizeof(g->stages[cell].k[CHANGE]));
        ellipsoid_copy(points[cell].derivative.u, k + AT_U);
        ellipsoid_copy(points[cell].derivative.omega, k + AT_OMEGA);
        shortest = fmin(shortest, 1 / fmax(p->rate, p->rotation_rate));
    }
    regular = ellipsoid_group_prepare(g, points, vanishing * shortest);
    if (regular)
    {
        ellipsoid_group_solve(g, CHANGE);
    }
    return regular;
}

/* Keeps the velocities, with the poses, which stay. */
static void remember(const ellipsoid_group *g,
                     const ellipsoid_evaluation *points)
{
    for (int cell = 0; cell < g->count; cell++)
    {
        memcpy(g->stages[cell].k[BEST], points[cell].y, sizeof(points->y));
    }
}

/* Takes those kept. */
static void recall(const ellipsoid_group *g, ellipsoid_evaluation *points)
{
    for (int cell = 0; cell < g->count; cell++)
    {
        memcpy(points[cell].y, g->stages[cell].k[BEST], sizeof(points->y));
    }
}

/* rounded: may what rounding leaves be taken after all iterations? */
static ellipsoid_status iterate(ellipsoid_group *g,
                                ellipsoid_evaluation *points, int rounded)
{
    ellipsoid_status status = ellipsoid_group_evaluate_once(g, points, 0, 1);
    double previous = HUGE_VAL, least = HUGE_VAL;

    for (int n = 0; status == ELLIPSOID_OK && n < MOST_ITERATIONS; n++)
    {
        double before, part = 1;

        if (!set_changes(g, points))
        {
            return ELLIPSOID_NON_FINITE;
        }
        before = power_along(g, points);
        move(g, part, points);
        if (are_small(g, points, converged)
            || (before > 0.25 * previous && are_small(g, points, nearly))
            || (n > MOST_ITERATIONS / 2 && are_small(g, points, stalled)))
        {
            return ELLIPSOID_OK;
        }
        if (rounded && fabs(before) < least && are_small(g, points, stalled))
        {
            least = fabs(before);
            remember(g, points);
        }
        previous = before;
        status = ellipsoid_group_evaluate_once(g, points, 0, 1);
        for (int l = 0; status == ELLIPSOID_OK && l < MOST_HALVINGS
                        && power_along(g, points) / before < -too_far;
             l++)
        {
            part *= 0.5;
            move(g, -part, points);
            status = ellipsoid_group_evaluate_once(g, points, 0, 1);
        }
    }
    if (status == ELLIPSOID_OK && least < HUGE_VAL)
    {
        recall(g, points);
        return ELLIPSOID_OK;
    }
    return status == ELLIPSOID_OK ? ELLIPSOID_NON_FINITE : status;
}

static void be_at_rest(const ellipsoid_group *g, ellipsoid_evaluation *points)
{
    for (int cell = 0; cell < g->count; cell++)
    {
        ellipsoid_set_no_rates(&points[cell].state);
    }
}

/* With slip speeds that fall to their values. */
static ellipsoid_status lower_slip_speeds(ellipsoid_group *g,
                                          ellipsoid_evaluation *points)
{
    ellipsoid_smoothed_model alone = {.own = NULL};
    ellipsoid_smoothed_model *smoothed = g->pairs ? g->pairs->smoothed : &alone;
    ellipsoid_status status = ELLIPSOID_OK;

    be_at_rest(g, points);
    for (int cell = 0; cell < g->count; cell++)
    {
        smoothed[cell].own = g->cell[cell].model;
        smoothed[cell].model = *g->cell[cell].model;
        g->cell[cell].model = &smoothed[cell].model;
    }
    for (double smooth = smoothest; status == ELLIPSOID_OK && smooth > 0.5;
         smooth *= less_smooth)
    {
        for (int cell = 0; cell < g->count; cell++)
        {
            smoothed[cell].model.options.slip_speed =
                smooth * smoothed[cell].own->options.slip_speed;
        }
        status = iterate(g, points, 1);
    }
    for (int cell = 0; cell < g->count; cell++)
    {
        g->cell[cell].model = smoothed[cell].own;
    }
    return status;
}

/* Root of the sum of m a^2 and I alpha^2, of all accelerations. */
static double unbalanced(const ellipsoid_group *g,
                         const ellipsoid_evaluation *points)
{
    double sum = 0;

    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_state *slope = &points[cell].derivative;

        add_product(g->cell[cell].model, slope, slope->u, slope->omega, &sum);
    }
    return sqrt(sum);
}

/* One implicit step of 1/rate, from points that have their blocks. */
static ellipsoid_status relax_once(ellipsoid_group *g, double rate,
                                   ellipsoid_evaluation *points)
{
    for (int cell = 0; cell < g->count; cell++)
    {
        ellipsoid_jacobian_blocks *b = &points[cell].blocks;

        for (int i = 0; i < 3; i++)
        {
            b->uu[i][i] -= rate;
            b->ww[i][i] -= rate;
        }
    }
    if (!set_changes(g, points))
    {
        return ELLIPSOID_NON_FINITE;
    }
    move(g, 1, points);
    return ellipsoid_group_evaluate_once(g, points, 0, 1);
}

/* Pseudo-transient continuation (Kelley & Keyes, SIAM J. Numer. Anal. 35, 508,
   1998): steps grow while what is unbalanced falls. */
static ellipsoid_status relax(ellipsoid_group *g, ellipsoid_evaluation *points)
{
    ellipsoid_status status;
    double rate = 0, left, target;

    be_at_rest(g, points);
    for (int cell = 0; cell < g->count; cell++)
    {
        rate =
            fmax(rate, fmax(g->cell[cell].rate, g->cell[cell].rotation_rate));
    }
    status = ellipsoid_group_evaluate_once(g, points, 0, 1);
    left = unbalanced(g, points);
    target = relaxed * left;
    for (int n = 0;
         status == ELLIPSOID_OK && left > target && n < MOST_RELAXATIONS; n++)
    {
        double next;

        remember(g, points);
        status = relax_once(g, rate, points);
        next = unbalanced(g, points);
        if (next <= growth * left)
        {
            rate *= next < left ? 0.5 : 1;
            left = next;
        }
        else if (status == ELLIPSOID_OK)
        {
            recall(g, points);
            status = ellipsoid_group_evaluate_once(g, points, 0, 1);
            rate *= 4;
        }
    }
    return status == ELLIPSOID_OK ? iterate(g, points, 1) : status;
}

/* By Newton's method from rest; with slip speeds that fall, if that fails; from
   relaxed velocities, if that does, too. */
static ellipsoid_status solve(ellipsoid_group *g, ellipsoid_evaluation *points)
{
    const int inertial = g->inertial;
    ellipsoid_status status;

    ellipsoid_group_set_inertial(g, 0);
    /* poses stay, and whether derivatives were asked for must change nothing */
    for (int cell = 0; cell < g->count; cell++)
    {
        memset(points[cell].walls.by_pose, 0, sizeof(points->walls.by_pose));
    }
    ellipsoid_expand_about(g, points);
    be_at_rest(g, points);
    status = iterate(g, points, 0);
    if (status == ELLIPSOID_NON_FINITE)
    {
        status = lower_slip_speeds(g, points);
    }
    if (status == ELLIPSOID_NON_FINITE)
    {
        status = relax(g, points);
    }
    ellipsoid_expand_about(g, NULL);
    ellipsoid_group_set_inertial(g, inertial);
    return status;
}

/* One cell or several whose contacts depend on the velocities that are to be
   balanced. */
ellipsoid_status ellipsoid_group_balance(ellipsoid_group *g,
                                         ellipsoid_evaluation *points,
                                         int with_blocks)
{
    ellipsoid_status status;
    int depends = 0; /* do forces other than drag depend on velocities? */

    be_at_rest(g, points);
    status = ellipsoid_group_evaluate_once(g, points, 1, with_blocks);
    for (int cell = 0; status == ELLIPSOID_OK && cell < g->count; cell++)
    {
        depends = depends
               || ellipsoid_force_is_dissipative(&g->cell[cell].surroundings)
               || ellipsoid_in_contact(&points[cell].contact);
    }
    if (!depends)
    {
        return status;
    }
    g->has_blocks = 0; /* the couplings are no longer those of the start */
    status = solve(g, points);
    if (status == ELLIPSOID_OK)
    {
        status = ellipsoid_group_evaluate_once(g, points, 0, with_blocks);
    }
    for (int cell = 0; cell < g->count; cell++)
    {
        ellipsoid_set_no_rates(&points[cell].derivative);
    }
    return status;
}

ellipsoid_status
ellipsoid_force_balance(const ellipsoid_model *model,
                        const ellipsoid_surroundings *surroundings,
                        ellipsoid_state *state, ellipsoid_facet_cache *cache,
                        ellipsoid_state *derivative)
{
    ellipsoid_statistics statistics = {0};
    const ellipsoid_member alone = {.model = model,
                                    .surroundings = surroundings,
                                    .cache = cache,
                                    .statistics = &statistics};
    ellipsoid_cell cell = ellipsoid_cell_of(&alone, NULL);
    ellipsoid_evaluation point;
    ellipsoid_stages stages;
    ellipsoid_stage_matrix system;
    ellipsoid_group g = {.count = 1,
                         .dissipative =
                             model->dissipative
                             || ellipsoid_force_is_dissipative(surroundings),
                         .cell = &cell,
                         .stages = &stages,
                         .system = &system};
    ellipsoid_status status;

    point.state = *state;
    point.contact = ellipsoid_no_contact();
    status = ellipsoid_group_evaluate(&g, surroundings->time, &point, 1, 0);
    if (status == ELLIPSOID_OK)
    {
        *state = point.state;
        *derivative = point.derivative;
    }
    return status;
}
