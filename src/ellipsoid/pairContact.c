/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    pairContact.c - the forces F_S between the cells of a group.

    Beads against beads: Hertz, F = 4/3 E* sqrt(R) d^(3/2) along the line of
    centres, with 1/R = 1/r_a + 1/r_b and 1/E* = 1/E_a + 1/E_b, as for two
    spheres. One force acts on both, with opposite signs, at the beads' centres,
    which lie on its line: momentum and its moment are kept.
*/
#include "meeting.h"

#include <math.h>

/* ------------------------------------------------------- beads that touch */

static double stiffness_between(const ellipsoid_options *a,
                                const ellipsoid_options *b)
{
    const double radius =
        a->bead_radius * b->bead_radius / (a->bead_radius + b->bead_radius);
    const double modulus = a->contact_modulus * b->contact_modulus
                         / (a->contact_modulus + b->contact_modulus);

    return 4.0 / 3 * modulus * sqrt(radius);
}

/* The force on a's bead, `line` from b's bead and `distance` long, and its
   derivative by the bead's centre; by that of b's it is the negative. */
static void push_apart(const ellipsoid_meeting *m, const double line[3],
                       double distance, double depth, double force[3],
                       double force_x[3][3])
{
    const double root = m->stiffness * sqrt(depth), size = root * depth;
    double n[3];

    for (int i = 0; i < 3; i++)
    {
        n[i] = line[i] / distance;
        force[i] = size * n[i];
    }
    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            force_x[i][j] = size / distance * ((i == j) - n[i] * n[j])
                          - 1.5 * root * n[i] * n[j];
        }
    }
}

/* Before the first contact of a pair is added. */
static void begin_side(const ellipsoid_meeting *m, ellipsoid_side *s)
{
    memset(s->force, 0, sizeof(s->force));
    memset(s->torque, 0, sizeof(s->torque));
    if (m->derivatives)
    {
        memset(&s->own, 0, sizeof(s->own));
        memset(&s->other, 0, sizeof(s->other));
    }
}

static void add_touch(ellipsoid_meeting *m, int bead_a, int bead_b,
                      double force[3], double force_x[3][3])
{
    const double *arm_a = m->a->model->bead[bead_a];
    const double *arm_b = m->b->model->bead[bead_b];
    const double back[3] = {-force[0], -force[1], -force[2]};
    ellipsoid_body a = *m->a, b = *m->b;
    double across[3][3];

    ellipsoid_add_force_at(arm_a, a.r, force, m->of_a->force, m->of_a->torque);
    ellipsoid_add_force_at(arm_b, b.r, back, m->of_b->force, m->of_b->torque);
    if (!m->derivatives)
    {
        return;
    }
    for (int n = 0; n < 9; n++)
    {
        across[n / 3][n % 3] = -force_x[n / 3][n % 3];
    }
    ellipsoid_add_derivatives(arm_a, a.q, a.r, force, force_x, &m->of_a->own);
    ellipsoid_add_derivatives(arm_b, b.q, b.r, back, force_x, &m->of_b->own);
    ellipsoid_add_other_derivatives(arm_a, a.r, arm_b, b.q, across,
                                    &m->of_a->other);
    ellipsoid_add_other_derivatives(arm_b, b.r, arm_a, a.q, across,
                                    &m->of_b->other);
}

/* The contact point divides the line of centres as the radii do. */
static void add_rub(ellipsoid_meeting *m, int bead_a, int bead_b,
                    const double line[3], const double force[3],
                    double force_x[3][3])
{
    const double r_a = m->a->model->options.bead_radius;
    const double r_b = m->b->model->options.bead_radius;
    const double part_a = r_a / (r_a + r_b), part_b = r_b / (r_a + r_b);
    ellipsoid_contact_jacobian *const jacobian[2][2] = {
        {&m->of_a->own, &m->of_a->other}, {&m->of_b->other, &m->of_b->own}};
    ellipsoid_body a = *m->a, b = *m->b;
    ellipsoid_rub rub = {.bodies = 2};

    rub.grip[0] = ellipsoid_grip_of(m->state_a, a.r, a.model->bead[bead_a]);
    rub.grip[1] = ellipsoid_grip_of(m->state_b, b.r, b.model->bead[bead_b]);
    ellipsoid_copy(force, rub.push);
    for (int i = 0; i < 3; i++)
    {
        rub.grip[0].point[i] -= part_a * line[i];
        rub.grip[1].point[i] += part_b * line[i];
        for (int j = 0; j < 3; j++)
        {
            rub.push_c[0][i][j] = force_x[i][j];
            rub.push_c[1][i][j] = -force_x[i][j];
            rub.point_c[0][i][j] = i == j ? part_b : 0;
            rub.point_c[1][i][j] = i == j ? part_a : 0;
        }
    }
    if (!ellipsoid_rub_traction(&m->law, &rub, m->derivatives))
    {
        return;
    }
    ellipsoid_add_rub(&rub, 0, m->of_a->force, m->of_a->torque);
    ellipsoid_add_rub(&rub, 1, m->of_b->force, m->of_b->torque);
    if (m->derivatives)
    {
        ellipsoid_add_rub_derivatives(&rub, jacobian);
    }
}

/* A bead of each; `line` is between the centres of the cells. */
static inline void meet(ellipsoid_meeting *m, const double line[3], int bead_a,
                        int bead_b)
{
    const double both =
        m->a->model->options.bead_radius + m->b->model->options.bead_radius;
    const double far = both + fmax(m->gap, 0);
    double between[3], distance;

    ellipsoid_difference(m->a->bead[bead_a], m->b->bead[bead_b], between);
    ellipsoid_add(between, line);
    distance = ellipsoid_dot(between, between);
    if (distance >= far * far)
    {
        return;
    }
    distance = sqrt(distance);
    m->gap = fmin(m->gap, distance - both);
    if (distance < both && distance > 0)
    {
        double force[3], force_x[3][3];

        push_apart(m, between, distance, both - distance, force, force_x);
        if (m->touching++ == 0)
        {
            begin_side(m, m->of_a);
            begin_side(m, m->of_b);
        }
        if (m->rubs)
        {
            add_rub(m, bead_a, bead_b, between, force, force_x);
        }
        else
        {
            add_touch(m, bead_a, bead_b, force, force_x);
        }
    }
}

/* All beads that may; their number is listed < 0 if they are too many to list.
 */
static void meet_all(ellipsoid_meeting *m, const ellipsoid_near_pair *near)
{
    const int all_b = m->b->model->bead_count;
    const int count =
        near->listed < 0 ? m->a->model->bead_count * all_b : near->listed;
    double line[3];

    if (ellipsoid_pair_is_exact(m->a->model, m->b->model))
    {
        ellipsoid_meet_exactly(m);
        return;
    }
    ellipsoid_difference(m->a->x, m->b->x, line);
    for (int n = 0; n < count; n++)
    {
        if (near->listed < 0)
        {
            meet(m, line, n / all_b, n % all_b);
        }
        else
        {
            meet(m, line, near->bead[n][0], near->bead[n][1]);
        }
    }
}

/* ------------------------------------------------------------ in a group */

/* A force and torque more, at a point that has been evaluated. */
static ellipsoid_status push(const ellipsoid_problem *p, ellipsoid_point *at,
                             int balanced)
{
    const ellipsoid_model *m = p->model;
    const ellipsoid_contact *c = &at->contact;
    ellipsoid_state *slope = &at->derivative, *state = &at->state;
    double moved[3], omega[3], turned[4];
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
    if (ellipsoid_has_near_walls(m, p->surroundings))
    {
        memset(moved, 0, sizeof(moved));
        memset(omega, 0, sizeof(omega));
        status = ellipsoid_wall_yield(m, p->surroundings, p->cache, state->x,
                                      state->q, c->cell_force, c->cell_torque,
                                      moved, omega);
    }
    else
    {
        double r[3][3], body[3];

        ellipsoid_rotation_inline(state->q, r);
        ellipsoid_to_body(r, c->cell_force, body);
        for (int i = 0; i < 3; i++)
        {
            body[i] *= m->mobility[i];
            omega[i] = m->rotation_mobility[i] * c->cell_torque[i];
        }
        ellipsoid_product(r, body, moved);
    }
    ellipsoid_add(state->u, moved);
    ellipsoid_add(state->omega, omega);
    ellipsoid_copy(state->u, slope->x);
    ellipsoid_spin(omega, state->q, turned);
    for (int n = 0; n < 4; n++)
    {
        slope->q[n] += 0.5 * turned[n];
    }
    return status;
}

static void note_cell(ellipsoid_contact *contact, uint32_t id)
{
    if (contact->touched_cell_count < ELLIPSOID_MAX_TOUCHED)
    {
        contact->touched_cell[contact->touched_cell_count++] = id;
    }
}

/* What a cell feels of another goes into its point and the couplings. */
static void keep(ellipsoid_group *g, ellipsoid_point *points,
                 const ellipsoid_meeting *m, const ellipsoid_side *felt,
                 int row, int column)
{
    const ellipsoid_model *model = g->cell[row].model;
    ellipsoid_contact *contact = &points[row].contact;
    ellipsoid_pairs *pairs = g->pairs;

    if (m->gap < ellipsoid_pair_horizon(model, g->cell[column].model))
    {
        contact->cell_gap = fmin(contact->cell_gap, m->gap);
    }
    contact->cell_deepest = fmax(0, -contact->cell_gap);
    if (m->touching == 0)
    {
        return;
    }
    ellipsoid_add(contact->cell_force, felt->force);
    ellipsoid_add(contact->cell_torque, felt->torque);
    note_cell(contact, g->cell[column].surroundings->id);
    if (m->derivatives)
    {
        ellipsoid_coupling *c = &pairs->coupling[pairs->count++];
        const double of_torque[3] = {1 / model->inertia[0],
                                     1 / model->inertia[1],
                                     1 / model->inertia[2]};

        c->row = row;
        c->column = column;
        memset(&c->blocks, 0, sizeof(c->blocks));
        ellipsoid_add_to_blocks(&felt->other, 1 / model->mass, of_torque,
                                &c->blocks);
        ellipsoid_add_to_blocks(&felt->own, 1 / model->mass, of_torque,
                                &points[row].blocks);
    }
}

static ellipsoid_status add_pair(ellipsoid_group *g, ellipsoid_point *points,
                                 const ellipsoid_near_pair *near,
                                 int with_blocks)
{
    const int a = near->a, b = near->b;
    const ellipsoid_options *of_a = &g->cell[a].model->options;
    const ellipsoid_options *of_b = &g->cell[b].model->options;
    const ellipsoid_contact_law law =
        ellipsoid_law_between(g->cell[a].model, g->cell[b].model);
    ellipsoid_side felt_by_a, felt_by_b;
    ellipsoid_meeting m = {
        .a = ellipsoid_placed_body(g, points, a),
        .b = ellipsoid_placed_body(g, points, b),
        .state_a = &points[a].state,
        .state_b = &points[b].state,
        .stiffness = stiffness_between(of_a, of_b),
        .law = law,
        .rubs = law.friction > 0 || law.damping > 0,
        .gap = ellipsoid_pair_horizon(g->cell[a].model, g->cell[b].model),
        .derivatives = with_blocks,
        .of_a = &felt_by_a,
        .of_b = &felt_by_b,
    };

    meet_all(&m, near);
    if (m.touching > 0 && with_blocks
        && g->pairs->count + 2 > g->pairs->capacity)
    {
        g->culprit = b;
        return ELLIPSOID_TOO_MANY_CELLS;
    }
    keep(g, points, &m, &felt_by_a, a, b);
    keep(g, points, &m, &felt_by_b, b, a);
    return ELLIPSOID_OK;
}

ellipsoid_status ellipsoid_add_pairs(ellipsoid_group *g,
                                     ellipsoid_point *points, int balanced,
                                     int with_blocks)
{
    ellipsoid_status status = ellipsoid_near_pairs_collect(g, points);

    g->pairs->count = with_blocks ? 0 : g->pairs->count;
    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_model *model = g->cell[cell].model;
        ellipsoid_contact *c = &points[cell].contact;

        memset(c->cell_force, 0, sizeof(c->cell_force));
        memset(c->cell_torque, 0, sizeof(c->cell_torque));
        c->cell_gap = ellipsoid_pair_horizon(model, model);
        c->cell_deepest = 0;
        c->touched_cell_count = 0;
        g->pairs->body[cell].model = NULL;
    }
    for (int n = 0; status == ELLIPSOID_OK && n < g->pairs->near_count; n++)
    {
        status = add_pair(g, points, &g->pairs->near[n], with_blocks);
    }
    for (int cell = 0; status == ELLIPSOID_OK && cell < g->count; cell++)
    {
        if (points[cell].contact.touched_cell_count > 0)
        {
            status = push(&g->cell[cell], &points[cell], balanced);
            g->culprit = status == ELLIPSOID_OK ? -1 : cell;
        }
    }
    return status;
}

double ellipsoid_cell_gap(const ellipsoid_model *a, const double x_a[3],
                          const double q_a[4], const ellipsoid_model *b,
                          const double x_b[3], const double q_b[4],
                          double horizon)
{
    double bead_a[ELLIPSOID_MAX_BEADS][3], bead_b[ELLIPSOID_MAX_BEADS][3];
    ellipsoid_body of_a = {.bead = bead_a}, of_b = {.bead = bead_b};
    ellipsoid_near_pair near;
    ellipsoid_side felt_by_a, felt_by_b;
    ellipsoid_meeting m = {.a = &of_a,
                           .b = &of_b,
                           .gap = horizon,
                           .of_a = &felt_by_a,
                           .of_b = &felt_by_b};

    if (ellipsoid_are_apart(a, x_a, b, x_b, horizon))
    {
        return horizon;
    }
    ellipsoid_place_body(&of_a, a, x_a, q_a);
    ellipsoid_place_body(&of_b, b, x_b, q_b);
    ellipsoid_list_beads(&of_a, &of_b, horizon, &near);
    meet_all(&m, &near);
    return m.gap;
}
