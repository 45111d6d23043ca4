/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    equations.c - the equations of motion and their derivatives.

    Everything is a polynomial in the quaternion, so the derivatives are exact
    also where q is not of length one, as inside a step.
*/
#include "drag/stokesDrag.h"
#include "motion/motion.h"

#include <math.h>
#include <string.h>

/* ------------------------------------------------------------ near walls */

/*
    Drag where walls are near, or the u and omega that balance it; where none is,
    *acted is 0 and nothing done. It is expanded about the start where the group
    says so. The copies are for those who want an address: so the compiler need
    not give the originals one.
*/
static ellipsoid_status add_wall_drag(evaluation *e, const ellipsoid_cell *cell,
                                      ellipsoid_evaluation *at, int balanced,
                                      double d[4][3][3],
                                      ellipsoid_jacobian_blocks *blocks,
                                      int *acted)
{
    ellipsoid_free_motion free = e->free;
    const ellipsoid_wall_expansion *about =
        cell->about ? cell->about : &at->walls;
    ellipsoid_frame frame = {.by_q = blocks ? d : NULL};
    ellipsoid_planes planes;
    const ellipsoid_near_walls near = {e->model, &planes, &frame, &free,
                                       e->flow};
    ellipsoid_body_wrench wrench = e->wrench;
    ellipsoid_status status = ELLIPSOID_OK;

    memcpy(frame.axis, e->axis, sizeof(frame.axis));
    if (!cell->about)
    {
        status = ellipsoid_find_planes(e->model, &cell->surroundings, e->state,
                                       blocks != NULL, cell->cache, &planes);
        ellipsoid_wall_expansion_set(e->model, &planes, e->state, &at->walls);
    }
    *acted = status == ELLIPSOID_OK && about->planes > 0;
    if (!*acted)
    {
        return status;
    }
    if (balanced)
    {
        status = ellipsoid_balance_wall_drag(&near, about, &wrench, &at->state);
    }
    if (status == ELLIPSOID_OK)
    {
        double action[6];

        ellipsoid_add_wall_drag(&near, about, &at->state, at->walls.motion,
                                action, &wrench);
        if (blocks && !cell->about)
        {
            ellipsoid_wall_expansion_slopes(&near, &at->walls);
        }
        if (blocks)
        {
            ellipsoid_add_wall_drag_blocks(&near, &at->state, about, action,
                                           blocks);
        }
    }
    e->wrench = wrench;
    return status;
}

/* --------------------------------------------------------------- contact */

/* F_W and T^_W. */
INLINED ellipsoid_status add_contact(evaluation *e, const ellipsoid_cell *cell,
                                     ellipsoid_contact *contact,
                                     ellipsoid_jacobian_blocks *b)
{
    ellipsoid_wrench_jacobian jacobian;
    const ellipsoid_status status =
        ellipsoid_contact_evaluate(e->model, &cell->surroundings, e->state,
                                   cell->cache, contact, b ? &jacobian : NULL);

    if (status != ELLIPSOID_OK)
    {
        return status;
    }
    ellipsoid_add(e->wrench.force, contact->force);
    ellipsoid_add(e->wrench.torque, contact->torque);
    if (b && contact->bead_contacts > 0)
    {
        static const double ones[3] = {1, 1, 1};

        ellipsoid_add_to_blocks(&jacobian, 1, ones, b);
    }
    return ELLIPSOID_OK;
}

/* --------------------------------------------------------------- the sum */

/* I w x w */
INLINED double gyroscopic(const double inertia[3], const double w[3], int j,
                          int k)
{
    return (inertia[j] - inertia[k]) * w[j] * w[k];
}

/* Forces to accelerations, paper eqs. (1) and (3). */
INLINED void accelerations(const evaluation *e, int inertial,
                           ellipsoid_state *derivative)
{
    const double *inertia = e->model->inertia, *f = e->wrench.force,
                 *t = e->wrench.torque;
    const double *w = e->state->omega;
    const double per_mass = 1 / e->model->mass;
    double torque[3] = {t[0], t[1], t[2]};

    if (inertial)
    {
        torque[0] += gyroscopic(inertia, w, 1, 2);
        torque[1] += gyroscopic(inertia, w, 2, 0);
        torque[2] += gyroscopic(inertia, w, 0, 1);
    }
    for (int i = 0; i < 3; i++)
    {
        derivative->u[i] = f[i] * per_mass;
        derivative->omega[i] = torque[i] / inertia[i];
    }
}

INLINED void multiply(double factor, double *numbers, int count)
{
    for (int n = 0; n < count; n++)
    {
        numbers[n] *= factor;
    }
}

static void finish_blocks(const evaluation *e, int inertial,
                          ellipsoid_jacobian_blocks *b)
{
    const double *inertia = e->model->inertia;
    const double *w = e->state->omega;

    multiply(1 / e->model->mass, (double *)b->uu, 9);
    multiply(1 / e->model->mass, (double *)b->ux, 9);
    multiply(1 / e->model->mass, (double *)b->uw, 9);
    multiply(1 / e->model->mass, (double *)b->uq, 12);
    for (int i = 0; i < 3; i++)
    {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double per_inertia = 1 / inertia[i];

        if (inertial)
        {
            b->ww[i][j] += (inertia[j] - inertia[k]) * w[k];
            b->ww[i][k] += (inertia[j] - inertia[k]) * w[j];
        }
        for (int l = 0; l < 3; l++)
        {
            b->wu[i][l] *= per_inertia;
            b->ww[i][l] *= per_inertia;
            b->wx[i][l] *= per_inertia;
        }
        for (int n = 0; n < 4; n++)
        {
            b->wq[i][n] *= per_inertia;
        }
    }
}

/* Kinematics, paper eqs. (2) and (4). One NaN or infinity makes the sum one. */
INLINED ellipsoid_status finish(const ellipsoid_state *state,
                                ellipsoid_state *derivative)
{
    double q[4];

    ellipsoid_copy(state->u, derivative->x);
    ellipsoid_spin(state->omega, state->q, q);
    for (int n = 0; n < 4; n++)
    {
        derivative->q[n] = 0.5 * q[n];
    }
    return isfinite(ellipsoid_sum(derivative->u) + ellipsoid_sum(derivative->x)
                    + ellipsoid_sum(derivative->omega) + ellipsoid_sum(q)
                    + q[3])
             ? ELLIPSOID_OK
             : ELLIPSOID_NON_FINITE;
}

/* The motion that the flow would give a free body; copies as above. */
INLINED ellipsoid_status set_free(evaluation *e, const ellipsoid_cell *cell,
                                  double d[4][3][3], int derivatives)
{
    if (e->model->flow_points > 0)
    {
        ellipsoid_frame frame = {.by_q = derivatives ? d : NULL};
        ellipsoid_free_motion motion;
        ellipsoid_status status;

        memcpy(frame.axis, e->axis, sizeof(frame.axis));
        status = ellipsoid_faxen(e->model, &cell->surroundings, e->state->x,
                                 e->flow->velocity, &frame, &motion);
        if (status == ELLIPSOID_OK)
        {
            e->free = motion;
        }
        return status;
    }
    set_free_motion(e);
    if (derivatives)
    {
        set_free_derivatives(e, d);
    }
    return ELLIPSOID_OK;
}

/* All but drag and contact. */
INLINED ellipsoid_status set_forces(evaluation *e,
                                    const ellipsoid_surroundings *surroundings,
                                    const ellipsoid_noise *noise,
                                    double d[4][3][3],
                                    ellipsoid_jacobian_blocks *blocks)
{
    const ellipsoid_model *m = e->model;

    ellipsoid_copy(m->constant_force, e->wrench.force);
    ellipsoid_copy(m->options.external_torque, e->wrench.torque);
    if (e->flow && m->options.pressure_gradient == ELLIPSOID_PRESSURE_DUDT)
    {
        double convected[3];

        ellipsoid_product(e->flow->gradient, e->flow->velocity, convected);
        ellipsoid_add_times(e->wrench.force, m->fluid_mass, convected);
        if (surroundings->unsteady)
        {
            ellipsoid_add_times(e->wrench.force, m->fluid_mass,
                                e->flow->local_acceleration);
        }
    }
    if (blocks || noise || m->electric || surroundings->force
        || m->options.pressure_gradient == ELLIPSOID_PRESSURE_GRADP)
    {
        ellipsoid_frame frame = {.by_q = blocks ? d : NULL};
        ellipsoid_body_wrench wrench = e->wrench;
        ellipsoid_status status;

        memcpy(frame.axis, e->axis, sizeof(frame.axis));
        status = ellipsoid_add_body_forces(m, surroundings, e->state, &frame,
                                           e->flow, &wrench, blocks);
        if (noise)
        {
            ellipsoid_add_noise(noise, &frame, &wrench, blocks);
        }
        e->wrench = wrench;
        return status;
    }
    return ELLIPSOID_OK;
}

/* All is zero that a callback may leave out. Velocity and gradient are cleared
   number by number, which volatile sees to: the wide stores of memset() before
   the narrow ones of the callback cost a tenth of an evaluation. */
INLINED void clear_sample(int derivatives, ellipsoid_flow_sample *flow)
{
    volatile ellipsoid_flow_sample *narrow = flow;
    const size_t end = derivatives
                         ? sizeof *flow
                         : offsetof(ellipsoid_flow_sample, velocity_jacobian);

    for (int i = 0; i < 3; i++)
    {
        narrow->velocity[i] = 0;
        for (int j = 0; j < 3; j++)
        {
            narrow->gradient[i][j] = 0;
        }
    }
    memset(flow->pressure_gradient, 0,
           end - offsetof(ellipsoid_flow_sample, pressure_gradient));
}

/* The sample of the flow at the state. */
INLINED ellipsoid_status sample_flow(const ellipsoid_surroundings *surroundings,
                                     const ellipsoid_state *state,
                                     int derivatives,
                                     ellipsoid_flow_sample *flow)
{
    clear_sample(derivatives, flow);

    const int answer =
        surroundings->flow(surroundings->flow_context, surroundings->time,
                           state->x, derivatives, flow);

    return answer == 0 ? ELLIPSOID_OK : ellipsoid_answer_status(answer);
}

/* The drag of a body that no wall is near, or the u and omega that it
   balances. */
INLINED void add_free_drag(evaluation *e, ellipsoid_state *state, int balanced,
                           double d[4][3][3], ellipsoid_jacobian_blocks *blocks)
{
    double slip[3], resisted[3];

    if (balanced)
    {
        double u[3], omega[3];

        balance(e, u, omega);
        ellipsoid_copy(u, state->u);
        ellipsoid_copy(omega, state->omega);
    }
    if (blocks || !balanced)
    {
        add_drag(e, slip, resisted);
    }
    if (blocks)
    {
        add_drag_blocks(e, d, slip, resisted, blocks);
    }
}

/* Inlined below, with constants that show the compiler what to leave
   out; e has no address taken, so that it stays in registers. */
INLINED ellipsoid_status evaluate(const ellipsoid_cell *cell,
                                  ellipsoid_evaluation *at, int balanced,
                                  int with_blocks)
{
    const ellipsoid_model *model = cell->model;
    const ellipsoid_surroundings *surroundings = &cell->surroundings;
    const int drag = model->options.drag && surroundings->flow;
    ellipsoid_state *state = &at->state, *derivative = &at->derivative;
    ellipsoid_jacobian_blocks *blocks = with_blocks ? &at->blocks : NULL;
    const double *q = state->q;
    double d[4][3][3];
    ellipsoid_status status = ELLIPSOID_OK;
    ellipsoid_flow_sample flow;
    int resisted_by_walls = 0;
    evaluation e;

    e.model = model;
    e.state = state;
    e.flow = NULL;
    if (blocks)
    {
        memset(blocks, 0, sizeof(*blocks));
        ellipsoid_axis_derivatives(q, d);
    }
    if (surroundings->flow)
    {
        status = sample_flow(surroundings, state, with_blocks, &flow);
        e.flow = &flow;
    }

    ellipsoid_axes(q, e.axis);
    if (status == ELLIPSOID_OK && drag)
    {
        status = set_free(&e, cell, d, with_blocks);
    }
    if (status == ELLIPSOID_OK)
    {
        status = set_forces(&e, surroundings, cell->noise, d, blocks);
    }
    if (status == ELLIPSOID_OK && ellipsoid_has_walls(model, surroundings))
    {
        status = add_contact(&e, cell, &at->contact, blocks);
    }
    if (status == ELLIPSOID_OK && ellipsoid_has_near_walls(model, surroundings))
    {
        status = add_wall_drag(&e, cell, at, balanced, d, blocks,
                               &resisted_by_walls);
    }
    if (status != ELLIPSOID_OK)
    {
        return status;
    }
    if (drag && !resisted_by_walls)
    {
        add_free_drag(&e, state, balanced, d, blocks);
    }
    if (blocks)
    {
        finish_blocks(&e, cell->inertial, blocks);
    }
    if (balanced)
    {
        ellipsoid_set_no_rates(derivative);
    }
    else
    {
        accelerations(&e, cell->inertial, derivative);
    }
    return finish(state, derivative);
}

/* A fixed body touches walls, and others, but nothing moves it. */
static ellipsoid_status evaluate_fixed(const ellipsoid_cell *cell,
                                       ellipsoid_evaluation *at,
                                       int with_blocks)
{
    ellipsoid_set_no_rates(&at->state);
    memset(&at->derivative, 0, sizeof(at->derivative));
    if (with_blocks)
    {
        memset(&at->blocks, 0, sizeof(at->blocks));
    }
    return ellipsoid_has_walls(cell->model, &cell->surroundings)
             ? ellipsoid_contact_evaluate(cell->model, &cell->surroundings,
                                          &at->state, cell->cache, &at->contact,
                                          NULL)
             : ELLIPSOID_OK;
}

ellipsoid_status ellipsoid_evaluate(const ellipsoid_cell *cell,
                                    ellipsoid_evaluation *at, int balanced,
                                    int with_blocks)
{
    cell->statistics->rhs++;
    cell->statistics->jacobians += with_blocks != 0;
    return cell->fixed ? evaluate_fixed(cell, at, with_blocks)
         : with_blocks ? evaluate(cell, at, balanced, 1)
         : balanced    ? evaluate(cell, at, 1, 0)
                       : evaluate(cell, at, 0, 0);
}

ellipsoid_cell ellipsoid_cell_of(const ellipsoid_member *member,
                                 const ellipsoid_noise *noise)
{
    const ellipsoid_model *m = member->model;
    const int drag = m->options.drag && member->surroundings->flow != NULL;

    return (ellipsoid_cell){
        .model = m,
        .surroundings = *member->surroundings,
        .cache = member->cache,
        .statistics = member->statistics,
        .length = ellipsoid_largest(m->options.semi_axes),
        .rate = drag ? 1 / m->relaxation_time : 0,
        .rotation_rate = drag ? 1 / m->rotation_relaxation_time : 0,
        .noise = m->options.brownian && drag ? noise : NULL,
        .inertial = m->options.motion == ELLIPSOID_MOTION_INERTIAL,
        .fixed = member->surroundings->fixed,
        .walls = ellipsoid_has_walls(m, member->surroundings),
    };
}
