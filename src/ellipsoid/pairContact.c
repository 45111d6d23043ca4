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
#include "integrator.h"

#include <math.h>

/* How far beyond a bead's surface a gap is measured, in bead radii. */
static const double gap_horizon = 1;

/* A cell in a pose. */
typedef struct body
{
    const ellipsoid_model *model;
    const double *x, *q;
    double r[3][3];
    double (*bead)[3]; /* [m] lab, from the centre */
} body;

/* Places the beads in the array if `anew`; else they are there. */
static body place(const ellipsoid_model *model, const double x[3],
                  const double q[4], double bead[][3], int anew)
{
    body b = {.model = model, .x = x, .q = q, .bead = bead};

    ellipsoid_rotation_inline(q, b.r);
    for (int n = 0; anew && n < model->bead_count; n++)
    {
        ellipsoid_product(b.r, model->bead[n], bead[n]);
    }
    return b;
}

/* Lies a point [m, lab, from the body's centre] outside the box that holds what
   is nearer than `far` to the centre of a bead? */
static int is_beyond(body *b, const double point[3], double far)
{
    const double *a = b->model->options.semi_axes;
    double at[3];

    ellipsoid_to_body(b->r, point, at);
    return fabs(at[0]) >= a[0] + far || fabs(at[1]) >= a[1] + far
        || fabs(at[2]) >= a[2] + far;
}

/* Are two cells farther apart than `far` [m]? */
static int are_apart(const ellipsoid_model *a, const double x_a[3],
                     const ellipsoid_model *b, const double x_b[3], double far)
{
    /* beads of a stage are placed with a q that is not of length one */
    const double reach = 1.1 * (a->reach + b->reach) + far;
    double line[3];

    ellipsoid_difference(x_a, x_b, line);
    return ellipsoid_dot(line, line) > reach * reach;
}

/* ------------------------------------------------------- beads that touch */

/* What one cell feels of the other, and its derivatives. */
typedef struct side
{
    double force[3], torque[3];
    ellipsoid_contact_jacobian own, other;
} side;

typedef struct meeting
{
    body a, b;
    double stiffness; /* [N/m^1.5] 4/3 E* sqrt(R) */
    double gap;       /* [m] the smallest found */
    int touching;     /* beads */
    int derivatives;
    side of_a, of_b;
} meeting;

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
static void push_apart(const meeting *m, const double line[3], double distance,
                       double depth, double force[3], double force_x[3][3])
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

static void add_touch(meeting *m, int bead_a, int bead_b, double force[3],
                      double force_x[3][3])
{
    const double *arm_a = m->a.model->bead[bead_a];
    const double *arm_b = m->b.model->bead[bead_b];
    const double back[3] = {-force[0], -force[1], -force[2]};
    double across[3][3];

    ellipsoid_add_force_at(arm_a, m->a.r, force, m->of_a.force, m->of_a.torque);
    ellipsoid_add_force_at(arm_b, m->b.r, back, m->of_b.force, m->of_b.torque);
    m->touching++;
    if (!m->derivatives)
    {
        return;
    }
    for (int n = 0; n < 9; n++)
    {
        across[n / 3][n % 3] = -force_x[n / 3][n % 3];
    }
    ellipsoid_add_derivatives(arm_a, m->a.q, m->a.r, force, force_x,
                              &m->of_a.own);
    ellipsoid_add_derivatives(arm_b, m->b.q, m->b.r, back, force_x,
                              &m->of_b.own);
    ellipsoid_add_other_derivatives(arm_a, m->a.r, arm_b, m->b.q, across,
                                    &m->of_a.other);
    ellipsoid_add_other_derivatives(arm_b, m->b.r, arm_a, m->a.q, across,
                                    &m->of_b.other);
}

/* One bead of a against all of b; `from` is it seen from b's centre. */
static void meet_bead(meeting *m, int bead_a, const double from[3])
{
    const double both = m->a.model->options.bead_radius
                      + m->b.model->options.bead_radius;

    for (int n = 0; n < m->b.model->bead_count; n++)
    {
        double line[3], distance, force[3], force_x[3][3];

        ellipsoid_difference(from, m->b.bead[n], line);
        distance = ellipsoid_dot(line, line);
        if (distance >= (both + m->gap) * (both + m->gap)
            && distance >= both * both)
        {
            continue;
        }
        distance = sqrt(distance);
        m->gap = fmin(m->gap, distance - both);
        if (distance < both && distance > 0)
        {
            push_apart(m, line, distance, both - distance, force, force_x);
            add_touch(m, bead_a, n, force, force_x);
        }
    }
}

static void meet(meeting *m)
{
    const double both = m->a.model->options.bead_radius
                      + m->b.model->options.bead_radius;
    double line[3];

    ellipsoid_difference(m->a.x, m->b.x, line);
    for (int n = 0; n < m->a.model->bead_count; n++)
    {
        double from[3];

        ellipsoid_copy(line, from);
        ellipsoid_add(from, m->a.bead[n]);
        if (!is_beyond(&m->b, from, both + fmax(m->gap, 0)))
        {
            meet_bead(m, n, from);
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
    double r[3][3], body[3], moved[3], omega[3], turned[4];
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
static void keep(ellipsoid_group *g, ellipsoid_point *points, const meeting *m,
                 const side *felt, int row, int column)
{
    const ellipsoid_model *model = g->cell[row].model;
    ellipsoid_contact *contact = &points[row].contact;
    ellipsoid_pairs *pairs = g->pairs;

    contact->cell_gap = fmin(contact->cell_gap, m->gap);
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

/* The body of a cell of the group, its beads placed at most once. */
static body place_cell(ellipsoid_group *g, const ellipsoid_point *points,
                       int cell)
{
    const int anew = !g->pairs->placed[cell];

    g->pairs->placed[cell] = 1;
    return place(g->cell[cell].model, points[cell].state.x,
                 points[cell].state.q, g->pairs->bead[cell], anew);
}

static double horizon_between(const ellipsoid_model *a,
                              const ellipsoid_model *b)
{
    return gap_horizon * fmin(a->options.bead_radius, b->options.bead_radius);
}

static ellipsoid_status add_pair(ellipsoid_group *g, ellipsoid_point *points,
                                 int a, int b, int with_blocks)
{
    const ellipsoid_model *of_a = g->cell[a].model, *of_b = g->cell[b].model;
    const double horizon = horizon_between(of_a, of_b);
    meeting m;

    if (are_apart(of_a, points[a].state.x, of_b, points[b].state.x, horizon))
    {
        return ELLIPSOID_OK;
    }
    if (g->pairs->count + 2 > g->pairs->capacity)
    {
        return ELLIPSOID_TOO_MANY_CELLS;
    }
    memset(&m.of_a, 0, sizeof(m.of_a));
    memset(&m.of_b, 0, sizeof(m.of_b));
    m.a = place_cell(g, points, a);
    m.b = place_cell(g, points, b);
    m.stiffness = stiffness_between(&of_a->options, &of_b->options);
    m.gap = horizon;
    m.touching = 0;
    m.derivatives = with_blocks;
    meet(&m);
    keep(g, points, &m, &m.of_a, a, b);
    keep(g, points, &m, &m.of_b, b, a);
    return ELLIPSOID_OK;
}

ellipsoid_status ellipsoid_add_pairs(ellipsoid_group *g,
                                     ellipsoid_point *points, int balanced,
                                     int with_blocks)
{
    ellipsoid_status status = ELLIPSOID_OK;

    g->pairs->count = with_blocks ? 0 : g->pairs->count;
    for (int cell = 0; cell < g->count; cell++)
    {
        ellipsoid_contact *c = &points[cell].contact;

        memset(c->cell_force, 0, sizeof(c->cell_force));
        memset(c->cell_torque, 0, sizeof(c->cell_torque));
        c->cell_gap =
            gap_horizon * g->cell[cell].model->options.bead_radius;
        c->cell_deepest = 0;
        c->touched_cell_count = 0;
        g->pairs->placed[cell] = 0;
    }
    for (int a = 0; a < g->count; a++)
    {
        for (int b = a + 1; status == ELLIPSOID_OK && b < g->count; b++)
        {
            status = add_pair(g, points, a, b, with_blocks);
            g->culprit = status == ELLIPSOID_OK ? -1 : b;
        }
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
    meeting m = {.stiffness = 0, .gap = horizon};

    if (are_apart(a, x_a, b, x_b, horizon))
    {
        return horizon;
    }
    m.a = place(a, x_a, q_a, bead_a, 1);
    m.b = place(b, x_b, q_b, bead_b, 1);
    meet(&m);
    return m.gap;
}
