/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    slowManifold.c - u and omega as functions of pose and time.

    A few relaxation times after a disturbance the thirteen equations run on a
    slow manifold (Fenichel, J. Differ. Equ. 31, 53 (1979); for spheres Maxey,
    J. Fluid Mech. 174, 441 (1987)). With u_b and omega_b, which balance the
    forces, and T = R m (mu K^)^-1 R^T, to first order
        u = u_b - T du_b/dt,
        omega^_i = omega_b,i - (I^_i domega_b,i/dt - gyroscopic_i)/(mu C_i).
    The derivatives are differences along the path over one relaxation time:
    so they include whatever acts on the body, and their error is of the next
    order.
*/
#include "motion/motion.h"

#include <math.h>

/* The part of the tolerance that the manifold's own error may take up. */
static const double share = 0.02;

/* [relaxation times] in which fast modes have decayed */
static const double decayed = 30;

/* At other times than its own, a point is asked about within the run. */
static double other_time(const ellipsoid_group *g, double t, double lag)
{
    if (!g->unsteady || t - lag >= g->from)
    {
        return t - lag;
    }
    return fmin(t + lag, g->until);
}

/* Sets what inertia takes from u and omega, from a balanced evaluation at the
   time t and at another, from which the body moves in `span`. */
static ellipsoid_status set_inertia(const ellipsoid_model *m, double span,
                                    const ellipsoid_state *there,
                                    ellipsoid_evaluation *at)
{
    const ellipsoid_state *state = &at->state;
    const double *q = state->q, opposite[4] = {q[0], q[1], q[2], -q[3]};
    const double *w = state->omega, *inertia = m->inertia;
    const double per = 1 / span, mass = m->mass * per;
    const double gyroscopic[3] = {(inertia[1] - inertia[2]) * w[1] * w[2],
                                  (inertia[2] - inertia[0]) * w[2] * w[0],
                                  (inertia[0] - inertia[1]) * w[0] * w[1]};
    double axis[3][3], change[3], *c = at->inertia;

    ellipsoid_rotation_inline(opposite, axis);
    ellipsoid_difference(state->u, there->u, change);
    ellipsoid_combination(
        axis, mass * m->mobility[0] * ellipsoid_dot(axis[0], change),
        mass * m->mobility[1] * ellipsoid_dot(axis[1], change),
        mass * m->mobility[2] * ellipsoid_dot(axis[2], change), c);
    for (int i = 0; i < 3; i++)
    {
        c[3 + i] = m->rotation_mobility[i]
                 * (inertia[i] * per * (w[i] - there->omega[i])
                    - gyroscopic[i]);
    }
    return isfinite(ellipsoid_sum(c) + ellipsoid_sum(c + 3))
             ? ELLIPSOID_OK
             : ELLIPSOID_NON_FINITE;
}

/* For one cell, which touches nothing, from its balanced evaluation. */
static ellipsoid_status look_back(const ellipsoid_group *g, ellipsoid_cell *p,
                                  double t, ellipsoid_evaluation *at)
{
    const double lag = p->model->relaxation_time;
    const double other = g->unsteady ? other_time(g, t, lag) : t;
    const double span = g->unsteady ? t - other : lag;
    ellipsoid_evaluation there;
    ellipsoid_status status;

    for (int n = AT_X; n < UNKNOWNS; n++)
    {
        there.y[n] = at->y[n] - span * at->slope[n];
    }
    if (!ellipsoid_is_pose(there.state.x, there.state.q))
    {
        return ELLIPSOID_STEP_UNDERFLOW;
    }
    p->surroundings.time = other;
    p->statistics->rhs++;
    status = ellipsoid_evaluate_untouched(p, &there);
    p->surroundings.time = t;
    return status == ELLIPSOID_OK
             ? set_inertia(p->model, span, &there.state, at)
             : status;
}

/* Of all cells; where it cannot be had, that is a matter of the method, not of
   the step. */
static ellipsoid_status look_back_all(ellipsoid_group *g, double t,
                                      ellipsoid_evaluation *points)
{
    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_status status =
            look_back(g, &g->cell[cell], t, &points[cell]);

        if (status != ELLIPSOID_OK)
        {
            g->left_manifold = ellipsoid_may_recover(status);
            return g->left_manifold ? ELLIPSOID_OK : status;
        }
    }
    return ELLIPSOID_OK;
}

ellipsoid_status ellipsoid_manifold_stage(ellipsoid_group *g, double t,
                                          ellipsoid_evaluation *points,
                                          int look_up)
{
    ellipsoid_status status;

    for (int cell = 0; cell < g->count; cell++)
    {
        g->cell[cell].surroundings.time = t;
    }
    g->left_manifold = 0;
    status = ellipsoid_group_evaluate_once(g, points, 1, 0);
    for (int cell = 0; status == ELLIPSOID_OK && cell < g->count; cell++)
    {
        g->left_manifold =
            g->left_manifold
            || (ellipsoid_has_contact(g, cell)
                && ellipsoid_in_contact(&points[cell].contact));
    }
    return status == ELLIPSOID_OK && look_up && !g->left_manifold
             ? look_back_all(g, t, points)
             : status;
}

/* From velocities that balance the forces to those on the manifold. */
static void settle(const ellipsoid_group *g, ellipsoid_evaluation *points)
{
    for (int cell = 0; cell < g->count; cell++)
    {
        ellipsoid_evaluation *at = &points[cell];
        ellipsoid_state *state = &at->state, *slope = &at->derivative;
        double turn[4];

        ellipsoid_difference(state->u, at->inertia, state->u);
        ellipsoid_difference(state->omega, at->inertia + 3, state->omega);
        ellipsoid_copy(state->u, slope->x);
        ellipsoid_spin(state->omega, state->q, turn);
        for (int n = 0; n < 4; n++)
        {
            slope->q[n] = 0.5 * turn[n];
        }
    }
}

ellipsoid_status ellipsoid_manifold_evaluate(ellipsoid_group *g, double t,
                                             ellipsoid_evaluation *points)
{
    const ellipsoid_status status =
        ellipsoid_manifold_stage(g, t, points, 1);

    if (status == ELLIPSOID_OK && !g->left_manifold)
    {
        settle(g, points);
    }
    return status;
}

/* How far velocities u and omega^ take x, by its length, and q in a relaxation
   time. */
static double effect(const ellipsoid_cell *p, const double u[3],
                     const double omega[3])
{
    return fmax(ellipsoid_length(u) / (p->rate * p->length),
                0.5 * ellipsoid_length(omega) / p->rotation_rate);
}

/*
    The next order of u is -T d(u - u_b)/dt: over a step it displaces x by T
    times the change of u - u_b, and likewise q.
*/
static double own_error(const ellipsoid_group *g)
{
    double worst = 0;

    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_cell *p = &g->cell[cell];
        double change[6];

        ellipsoid_difference(g->next[cell].inertia, g->start[cell].inertia,
                             change);
        ellipsoid_difference(g->next[cell].inertia + 3,
                             g->start[cell].inertia + 3, change + 3);
        worst = fmax(worst, effect(p, change, change + 3)
                                / (share * p->model->options.tolerance));
    }
    return worst;
}

/*
    In a step of h inertia's part was a polynomial, which leads to stage_inertia
    at the end. Where it is smooth the error of its integral is at most a fifth
    of what that makes with its error there, and it is as much where a gradient
    jumps. Stages before it was looked up know only its start, which displaces
    them; and as the body turns by `turn`, the flow where they are differs.
*/
static double course_error(const ellipsoid_group *g, double h)
{
    double worst = 0;

    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_cell *p = &g->cell[cell];
        const double *is = g->next[cell].inertia;
        const double *was = g->start[cell].inertia;
        const double *seen = g->stages[cell].stage_inertia;
        const double turn =
            h * ellipsoid_length(g->start[cell].state.omega);
        double change[6];

        for (int n = 0; n < 6; n++)
        {
            change[n] = 0.2 * fabs(is[n] - seen[n])
                      + 0.1 * fmin(turn, 1) * fabs(is[n] - was[n]);
        }
        worst = fmax(worst, h
                                * fmax(ellipsoid_length(change) / p->length,
                                       0.5 * ellipsoid_length(change + 3))
                                / p->model->options.tolerance);
    }
    return worst;
}

ellipsoid_status ellipsoid_manifold_complete(ellipsoid_group *g,
                                             const ellipsoid_plan *plan,
                                             double *error)
{
    ellipsoid_status status;

    g->left_manifold = 0;
    status = look_back_all(g, plan->end, g->next);
    if (status == ELLIPSOID_OK && !g->left_manifold)
    {
        *error = fmax(*error, course_error(g, plan->h));
        g->left_manifold = own_error(g) > 1;
        settle(g, g->next);
    }
    return status;
}

/* Is a step of h from these points likely to stay near the manifold? That the
   body turns changes what inertia does. */
static int is_near(const ellipsoid_group *g,
                   const ellipsoid_evaluation *points, double h)
{
    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_cell *p = &g->cell[cell];
        const ellipsoid_evaluation *at = &points[cell];
        const double turn = h * ellipsoid_length(at->state.omega);

        if (effect(p, at->inertia, at->inertia + 3) * fmin(turn, 1)
            > 0.5 * share * p->model->options.tolerance)
        {
            return 0;
        }
    }
    return 1;
}

int ellipsoid_manifold_is_near(const ellipsoid_group *g, double h)
{
    return is_near(g, g->start, h);
}

/* A start's velocities less those of the manifold, where next is. */
static void set_distance(const ellipsoid_group *g, int cell, double u[3],
                         double omega[3])
{
    ellipsoid_difference(g->start[cell].state.u, g->next[cell].state.u, u);
    ellipsoid_difference(g->start[cell].state.omega, g->next[cell].state.omega,
                         omega);
}

/* The farthest of the group, by its effect, in tolerances. */
static double distance(const ellipsoid_group *g)
{
    double worst = 0;

    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_cell *p = &g->cell[cell];
        double u[3], omega[3];

        set_distance(g, cell, u, omega);
        worst = fmax(worst, effect(p, u, omega) / p->model->options.tolerance);
    }
    return worst;
}

/* As in noiseLayer.c: next goes from the start's pose to where the start's
   velocities take it as they decay. The velocities on the manifold at the
   start's pose are kept in stages.y. 0: that is no pose. */
static int displace(ellipsoid_group *g)
{
    int is_pose = 1;

    for (int cell = 0; cell < g->count; cell++)
    {
        ellipsoid_state *to = &g->next[cell].state;
        double u[3], omega[3];

        set_distance(g, cell, u, omega);
        memcpy(g->stages[cell].y, g->next[cell].y, sizeof(g->next[cell].y));
        ellipsoid_displace(g->cell[cell].model, u, omega, to);
        is_pose = is_pose && ellipsoid_is_pose(to->x, to->q);
    }
    return is_pose;
}

/* What the decay leaves out: the changes on its way of the velocities towards
   which it goes, and of the axes about which it acts; in tolerances. */
static double displacement_error(const ellipsoid_group *g)
{
    double worst = 0;

    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_cell *p = &g->cell[cell];
        const ellipsoid_state *to = &g->next[cell].state;
        const double *before = g->stages[cell].y;
        double u[3], omega[3], angle, way;

        ellipsoid_difference(g->start[cell].state.u, before + AT_U, u);
        ellipsoid_difference(g->start[cell].state.omega, before + AT_OMEGA,
                             omega);
        way = effect(p, u, omega);
        angle = ellipsoid_length(omega) / p->rotation_rate;
        ellipsoid_difference(to->u, before + AT_U, u);
        ellipsoid_difference(to->omega, before + AT_OMEGA, omega);
        worst = fmax(worst, (effect(p, u, omega) + way * angle)
                                / p->model->options.tolerance);
    }
    return worst;
}

/* Do fast modes decay between t and the end of the run? */
static int is_time_left(const ellipsoid_group *g, double t)
{
    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_cell *p = &g->cell[cell];

        if ((g->until - t) * fmin(p->rate, p->rotation_rate) < decayed)
        {
            return 0;
        }
    }
    return 1;
}

ellipsoid_status ellipsoid_manifold_enter(ellipsoid_group *g, double t,
                                          double h)
{
    ellipsoid_status status;
    double far;

    g->on_manifold = 0;
    for (int cell = 0; cell < g->count; cell++)
    {
        g->next[cell].state = g->start[cell].state;
    }
    status = ellipsoid_manifold_evaluate(g, t, g->next);
    far = distance(g);
    if (status == ELLIPSOID_OK && !g->left_manifold && far > 0)
    {
        if (far > share && !is_time_left(g, t))
        {
            return ELLIPSOID_OK;
        }
        if (!displace(g))
        {
            return ELLIPSOID_OK;
        }
        status = ellipsoid_manifold_evaluate(g, t, g->next);
        far = displacement_error(g);
    }
    /* who is there stays, as in the middle of a run */
    if (status != ELLIPSOID_OK || g->left_manifold || !(far <= share)
        || (far > 0 && !is_near(g, g->next, h)))
    {
        return ellipsoid_may_recover(status) ? ELLIPSOID_OK : status;
    }
    for (int cell = 0; cell < g->count; cell++)
    {
        ellipsoid_evaluation *start = &g->start[cell];
        const ellipsoid_evaluation *next = &g->next[cell];

        start->state = next->state;
        start->derivative = next->derivative;
        start->contact = next->contact;
        memcpy(start->inertia, next->inertia, sizeof(start->inertia));
    }
    g->on_manifold = 1;
    g->has_blocks = 0;
    return ELLIPSOID_OK;
}
