/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    noiseLayer.c - the start of a noise interval.

    There the random force and torque jump, and u and omega relax to new values.
    Where the interval is many relaxation times long the layer is not resolved:
    the state is taken across it by matched asymptotics. A cell that is slow and
    touches something with friction may be taken across the whole interval.
*/
#include "motion/motion.h"

#include <float.h>
#include <math.h>

/* [relaxation times] from which on an interval is long */
static const double long_interval = 30;

/* Is the layer at t, where the noise of this cell jumps, to be crossed? */
static int is_thin(const ellipsoid_cell *p, double t, double until)
{
    const ellipsoid_noise *noise = p->noise;
    const double slowest =
        fmax(p->model->relaxation_time, p->model->rotation_relaxation_time);

    return noise
        && fabs(t - noise->start) <= 8 * DBL_EPSILON * fmax(fabs(t), until - t)
        && until - t >= long_interval * slowest;
}

/* u and omega decay: x moves by R m (mu K^)^-1 R^T u, and q likewise. */
static void displace(const ellipsoid_model *m, const double u[3],
                     const double omega[3], ellipsoid_state *state)
{
    double axis[3][3], angle[3], turn[4];

    ellipsoid_axes(state->q, axis);
    for (int i = 0; i < 3; i++)
    {
        ellipsoid_add_times(
            state->x, m->mass * m->mobility[i] * ellipsoid_dot(axis[i], u),
            axis[i]);
        angle[i] = m->inertia[i] * m->rotation_mobility[i] * omega[i];
    }
    ellipsoid_spin(angle, state->q, turn);
    for (int n = 0; n < 4; n++)
    {
        state->q[n] += 0.5 * turn[n];
    }
    ellipsoid_normalise(state->q);
}

/*
    Leading order of matched asymptotics. u_b being the balanced velocity,
        m du/dt = mu R K^ R^T (u_b - u)
    leaves x displaced by R m (mu K^)^-1 R^T (u - u_b), and u = u_b; and
    likewise the rotation. A cell that touches is not displaced: a stiff wall
    does not let it drift on.
*/
ellipsoid_status ellipsoid_noise_layer(ellipsoid_group *g, double t,
                                       double until)
{
    ellipsoid_status status;
    int crossed = g->inertial;

    for (int cell = 0; cell < g->count; cell++)
    {
        crossed = crossed && is_thin(&g->cell[cell], t, until);
        g->next[cell].state = g->start[cell].state;
    }
    if (!crossed)
    {
        return ELLIPSOID_OK;
    }
    status = ellipsoid_group_evaluate(g, t, g->next, 1, 0);
    if (g->dissipative && ellipsoid_may_recover(status))
    {
        return ELLIPSOID_OK; /* followed instead */
    }
    for (int cell = 0; status == ELLIPSOID_OK && cell < g->count; cell++)
    {
        ellipsoid_state *before = &g->start[cell].state;
        ellipsoid_state *after = &g->next[cell].state;

        if (!g->cell[cell].fixed
            && !ellipsoid_in_contact(&g->next[cell].contact))
        {
            double slip[3], spin[3];

            ellipsoid_difference(before->u, after->u, slip);
            ellipsoid_difference(before->omega, after->omega, spin);
            displace(g->cell[cell].model, slip, spin, after);
        }
        *before = *after;
        /* a cell may be so fast that it overflows */
        if (!ellipsoid_is_pose(after->x, after->q))
        {
            status = ELLIPSOID_BAD_STATE;
            g->failed = cell;
        }
    }
    return status;
}

/* ---------------------------------------------------- cells that lie on walls */

/*
    When the random force jumps, contacts give way, within microseconds at first
    and creeping at last, with velocities far above the slip speed in between. To
    follow that takes some twenty steps, though hardly anything moves. So, where
    friction acts, an interval is first tried as one step of the implicit Euler
    method, solved by Newton's method.
*/

/* [tolerances] displacement in an interval up to which that serves: its error was
   a thirtieth of the displacement in the median, an eighth in 95 of 100. */
static const double most_displaced = 3;

/* Newton's method has converged where a change moves a cell by this part of the
   tolerance, or its surface by this part of the slip speed. */
static const double converged = 0.1;

enum
{
    MOST_ITERATIONS = 10,
    CHANGE = 0 /* of the stages */
};

/* Is no cell displaced too far, nor past a wall or another cell unseen
   (unseen_travel() of stepControl.c)? */
static int are_near(const ellipsoid_group *g)
{
    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_cell *p = &g->cell[cell];
        const ellipsoid_options *o = &p->model->options;
        const double safe = (g->pairs ? 0.5 : 1) * o->bead_radius;
        double change[UNKNOWNS];

        for (int n = 0; n < UNKNOWNS; n++)
        {
            change[n] = g->next[cell].y[n] - g->start[cell].y[n];
        }
        if (!(ellipsoid_displacement(p, change) / o->tolerance <= most_displaced
              && ellipsoid_travel(p->model, &g->start[cell].state,
                                  &g->next[cell].state)
                     <= safe))
        {
            return 0;
        }
    }
    return 1;
}

/* Is the cell, in a noise interval that begins, too slow to be displaced by more
   than most_displaced? */
static int is_slow(const ellipsoid_cell *p, const ellipsoid_evaluation *start,
                   const ellipsoid_plan *interval)
{
    const ellipsoid_options *o = &p->model->options;
    const ellipsoid_state *state = &start->state;

    return o->friction > 0 && is_thin(p, interval->start, interval->end)
        && interval->h <= o->maximum_step
        && interval->h
                   * fmax(ellipsoid_length(state->u) / p->length,
                          0.5 * ellipsoid_length(state->omega))
               <= most_displaced * o->tolerance;
}

/* An implicit step does not leave an equilibrium, stable or not. Of a stable one
   the matrix of the step, of u and omega, has positive pivots, as it is that of
   drag, masses and stiffnesses but for positive factors of its rows. */
static int is_stable(const ellipsoid_evaluation *start, double h)
{
    ellipsoid_reduced reduced;
    double(*m)[6] = reduced.rates;

    ellipsoid_stage_matrix_reduce(&start->blocks, &start->state, h, &reduced);
    for (int n = 0; n < 6; n++)
    {
        m[n][n] += 1 / h;
    }
    for (int n = 0; n < 6; n++)
    {
        if (!(m[n][n] > 0))
        {
            return 0;
        }
        for (int i = n + 1; i < 6; i++)
        {
            const double part = m[i][n] / m[n][n];

            for (int k = n; k < 6; k++)
            {
                m[i][k] -= part * m[n][k];
            }
        }
    }
    return 1;
}

/* Are there cells that are not fixed, and all of these slow, in contact, and
   stable? Sets what the start has. */
static ellipsoid_status may_rest(ellipsoid_group *g,
                                 const ellipsoid_plan *interval)
{
    ellipsoid_status status;
    int may = !g->unsteady, moving = 0;

    for (int cell = 0; may && cell < g->count; cell++)
    {
        moving += !g->cell[cell].fixed;
        may = g->cell[cell].fixed
           || (ellipsoid_has_contact(g, cell)
               && is_slow(&g->cell[cell], &g->start[cell], interval));
    }
    status = may && moving > 0
               ? ellipsoid_group_evaluate(g, interval->end, g->start, 0, 1)
               : ELLIPSOID_STEP_UNDERFLOW;
    may = status == ELLIPSOID_OK;
    for (int cell = 0; may && cell < g->count; cell++)
    {
        may = g->cell[cell].fixed
           || (ellipsoid_in_contact(&g->start[cell].contact)
               && is_stable(&g->start[cell], interval->h));
    }
    return status == ELLIPSOID_OK && !may ? ELLIPSOID_STEP_UNDERFLOW : status;
}

/* One of Newton's changes to the next states, which have their blocks. */
static int change_next(ellipsoid_group *g, double h, double *largest)
{
    int regular;

    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_evaluation *at = &g->next[cell];
        double *k = g->stages[cell].k[CHANGE];

        for (int n = 0; n < UNKNOWNS; n++)
        {
            k[n] = at->slope[n] - (at->y[n] - g->start[cell].y[n]) / h;
        }
    }
    regular = ellipsoid_group_prepare(g, g->next, h);
    if (regular)
    {
        ellipsoid_group_solve(g, CHANGE);
    }
    *largest = 0;
    for (int cell = 0; regular && cell < g->count; cell++)
    {
        const ellipsoid_cell *p = &g->cell[cell];
        const double *k = g->stages[cell].k[CHANGE];

        if (p->fixed)
        {
            continue;
        }
        for (int n = 0; n < UNKNOWNS; n++)
        {
            g->next[cell].y[n] += k[n];
        }
        *largest = fmax(
            *largest,
            fmax(ellipsoid_displacement(p, k) / p->model->options.tolerance,
                 ellipsoid_surface_speed(p, k) / p->model->options.slip_speed));
        regular = isfinite(*largest);
    }
    return regular;
}

/* The implicit step, to the next states. */
static ellipsoid_status solve(ellipsoid_group *g,
                              const ellipsoid_plan *interval)
{
    ellipsoid_status status = ELLIPSOID_OK;
    double largest;
    int goes_on;

    memcpy(g->next, g->start, (size_t)g->count * sizeof(*g->start));
    goes_on = change_next(g, interval->h, &largest);
    ellipsoid_expand_about(g, g->start);
    for (int n = 1; goes_on && largest > converged && n < MOST_ITERATIONS; n++)
    {
        status = ellipsoid_group_evaluate(g, interval->end, g->next, 0, 1);
        goes_on =
            status == ELLIPSOID_OK && change_next(g, interval->h, &largest);
    }
    ellipsoid_expand_about(g, NULL);
    if (!goes_on || largest > converged || !are_near(g))
    {
        return status == ELLIPSOID_OK ? ELLIPSOID_STEP_UNDERFLOW : status;
    }
    for (int cell = 0; cell < g->count; cell++)
    {
        if (!g->cell[cell].fixed)
        {
            ellipsoid_normalise(g->next[cell].state.q);
        }
    }
    return ellipsoid_group_evaluate(g, interval->end, g->next, 0, 0);
}

ellipsoid_status ellipsoid_rest(ellipsoid_group *g,
                                const ellipsoid_plan *interval)
{
    const int inertial = g->inertial;
    ellipsoid_status status;

    ellipsoid_group_set_inertial(g, 1);
    status = may_rest(g, interval);
    if (status == ELLIPSOID_OK)
    {
        status = solve(g, interval);
    }
    ellipsoid_group_set_inertial(g, inertial);
    return status;
}
