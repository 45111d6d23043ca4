/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    groupContacts.c - the forces between the cells of a group, added to
    evaluations that were made without them.
*/
#include "motion/motion.h"

#include <math.h>

/* Adds force and torque of the other cells at a point that has been evaluated
   without. */
static ellipsoid_status add_wrench(const ellipsoid_cell *p,
                                   ellipsoid_evaluation *at, int balanced)
{
    const ellipsoid_model *m = p->model;
    const ellipsoid_contact *c = &at->contact;
    ellipsoid_state *slope = &at->derivative, *state = &at->state;
    double axis[3][3], push[6], rates[6]; /* body frame */
    double lab[3], turned[4];
    ellipsoid_status status = ELLIPSOID_OK;

    if (!balanced)
    {
        for (int i = 0; i < 3; i++)
        {
            slope->u[i] += c->cell_force[i] / m->mass;
            slope->omega[i] += c->cell_torque[i] / m->inertia[i];
        }
        return ELLIPSOID_OK;
    }
    ellipsoid_axes(state->q, axis);
    ellipsoid_product(axis, c->cell_force, push);
    ellipsoid_copy(c->cell_torque, push + 3);
    for (int i = 0; i < 3; i++)
    {
        rates[i] = m->mobility[i] * push[i];
        rates[i + 3] = m->rotation_mobility[i] * push[i + 3];
    }
    if (ellipsoid_has_near_walls(m, &p->surroundings) && at->walls.planes > 0)
    {
        status = ellipsoid_wall_rates(&at->walls, push, rates);
    }
    ellipsoid_combination(axis, rates[0], rates[1], rates[2], lab);
    ellipsoid_add(state->u, lab);
    ellipsoid_add(state->omega, rates + 3);
    ellipsoid_copy(state->u, slope->x);
    ellipsoid_spin(rates + 3, state->q, turned);
    for (int n = 0; n < 4; n++)
    {
        slope->q[n] += 0.5 * turned[n];
    }
    return status;
}

/* Adds the wrench of one cell on another to its point and the couplings. */
static void add_to_point(ellipsoid_group *g, ellipsoid_evaluation *points,
                         const ellipsoid_pair_contact *m,
                         const ellipsoid_pair_wrench *wrench, int row,
                         int column)
{
    const ellipsoid_model *model = g->cell[row].model;
    ellipsoid_contact *contact = &points[row].contact;

    if (m->gap < ellipsoid_pair_horizon(model, g->cell[column].model))
    {
        contact->cell_gap = fmin(contact->cell_gap, m->gap);
    }
    contact->cell_deepest = fmax(0, -contact->cell_gap);
    if (m->contacts == 0)
    {
        return;
    }
    contact->cell_slip = fmin(contact->cell_slip, m->slip);
    ellipsoid_add(contact->cell_force, wrench->force);
    ellipsoid_add(contact->cell_torque, wrench->torque);
    if (contact->cell_count < ELLIPSOID_MAX_SURFACES)
    {
        contact->cell_id[contact->cell_count++] =
            g->cell[column].surroundings.id;
    }
    if (m->derivatives && !g->cell[row].fixed)
    {
        ellipsoid_coupling *c = &g->pairs->coupling[g->pairs->count++];
        const double of_torque[3] = {1 / model->inertia[0],
                                     1 / model->inertia[1],
                                     1 / model->inertia[2]};

        c->row = row;
        c->column = column;
        memset(&c->blocks, 0, sizeof(c->blocks));
        ellipsoid_add_to_blocks(&wrench->other, 1 / model->mass, of_torque,
                                &c->blocks);
        ellipsoid_add_to_blocks(&wrench->own, 1 / model->mass, of_torque,
                                &points[row].blocks);
    }
}

static ellipsoid_status add_pair(ellipsoid_group *g,
                                 ellipsoid_evaluation *points,
                                 const ellipsoid_near_pair *near,
                                 int with_blocks)
{
    const int a = near->a, b = near->b;
    const ellipsoid_options *of_a = &g->cell[a].model->options;
    const ellipsoid_options *of_b = &g->cell[b].model->options;
    const ellipsoid_friction_law law =
        ellipsoid_friction_law_between(g->cell[a].model, g->cell[b].model);
    ellipsoid_body body_b = *ellipsoid_placed_body(g, points, b);
    double place[3];
    ellipsoid_pair_wrench on_a, on_b;
    ellipsoid_pair_contact m = {
        .a = ellipsoid_placed_body(g, points, a),
        .b = &body_b,
        .state_a = &points[a].state,
        .state_b = &points[b].state,
        .normal_law = ellipsoid_pair_law(of_a, of_b),
        .law = law,
        .dissipative = law.friction > 0 || law.damping > 0,
        .gap = ellipsoid_pair_horizon(g->cell[a].model, g->cell[b].model),
        .slip = HUGE_VAL,
        .derivatives = with_blocks,
        .of_a = &on_a,
        .of_b = &on_b,
    };

    body_b.x = ellipsoid_nearest_image(
        &g->cell[a].surroundings, points[a].state.x, points[b].state.x, place);
    ellipsoid_pair_contact_evaluate(&m, near);
    if (m.contacts > 0 && with_blocks
        && g->pairs->count + 2 > g->pairs->capacity)
    {
        g->failed = b;
        return ELLIPSOID_TOO_MANY_CELLS;
    }
    add_to_point(g, points, &m, &on_a, a, b);
    add_to_point(g, points, &m, &on_b, b, a);
    return ELLIPSOID_OK;
}

ellipsoid_status ellipsoid_add_group_contacts(ellipsoid_group *g,
                                              ellipsoid_evaluation *points,
                                              int balanced, int with_blocks)
{
    ellipsoid_status status;

    g->pairs->count = with_blocks ? 0 : g->pairs->count;
    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_model *model = g->cell[cell].model;
        ellipsoid_contact *c = &points[cell].contact;

        memset(c->cell_force, 0, sizeof(c->cell_force));
        memset(c->cell_torque, 0, sizeof(c->cell_torque));
        c->cell_gap = ellipsoid_pair_horizon(model, model);
        c->cell_deepest = 0;
        c->cell_slip = HUGE_VAL;
        c->cell_count = 0;
        g->pairs->body[cell].model = NULL;
    }
    status = ellipsoid_near_pairs_collect(g, points);
    for (int n = 0; status == ELLIPSOID_OK && n < g->pairs->near_count; n++)
    {
        status = add_pair(g, points, &g->pairs->near[n], with_blocks);
    }
    for (int cell = 0; status == ELLIPSOID_OK && cell < g->count; cell++)
    {
        if (points[cell].contact.cell_count > 0 && !g->cell[cell].fixed)
        {
            status = add_wrench(&g->cell[cell], &points[cell], balanced);
            g->failed = status == ELLIPSOID_OK ? -1 : cell;
        }
    }
    return status;
}
