/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    pairContact.c - the forces F_S between the cells of a group.

    Beads against beads: the law of two spheres (contactLaw.h) along the line of
    centres. One force acts on both, with opposite signs, at the beads' centres,
    which lie on its line: momentum and its moment are conserved.
*/
#include "contact/contact.h"

#include <math.h>

/* The force on a's bead, `line` from b's bead and `distance` long, and its
   derivative by the bead's centre; by that of b's it is the negative. */
static void set_normal_force(const ellipsoid_contact_law *law,
                             const double line[3], double distance, double gap,
                             double force[3], double force_x[3][3])
{
    const ellipsoid_normal_force f = ellipsoid_contact_normal_force(law, gap);
    double n[3];

    for (int i = 0; i < 3; i++)
    {
        n[i] = line[i] / distance;
        force[i] = f.force * n[i];
    }
    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            force_x[i][j] = f.force / distance * ((i == j) - n[i] * n[j])
                          + f.slope * n[i] * n[j];
        }
    }
}

/* Before the first contact of a pair is added. */
static void clear_wrench(const ellipsoid_pair_contact *m,
                         ellipsoid_pair_wrench *s)
{
    memset(s->force, 0, sizeof(s->force));
    memset(s->torque, 0, sizeof(s->torque));
    if (m->derivatives)
    {
        memset(&s->own, 0, sizeof(s->own));
        memset(&s->other, 0, sizeof(s->other));
    }
}

static void add_elastic(ellipsoid_pair_contact *m, int bead_a, int bead_b,
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
    ellipsoid_add_wrench_jacobian(arm_a, a.q, a.r, force, force_x,
                                  &m->of_a->own);
    ellipsoid_add_wrench_jacobian(arm_b, b.q, b.r, back, force_x,
                                  &m->of_b->own);
    ellipsoid_add_cross_jacobian(arm_a, a.r, arm_b, b.q, across,
                                 &m->of_a->other);
    ellipsoid_add_cross_jacobian(arm_b, b.r, arm_a, a.q, across,
                                 &m->of_b->other);
}

/* The contact point divides the line of centres as the radii do. */
static void add_with_friction(ellipsoid_pair_contact *m, int bead_a, int bead_b,
                              const double line[3], const double force[3],
                              double force_x[3][3])
{
    const double r_a = m->a->model->options.bead_radius;
    const double r_b = m->b->model->options.bead_radius;
    const double part_a = r_a / (r_a + r_b), part_b = r_b / (r_a + r_b);
    ellipsoid_wrench_jacobian *const jacobian[2][2] = {
        {&m->of_a->own, &m->of_a->other}, {&m->of_b->other, &m->of_b->own}};
    ellipsoid_body a = *m->a, b = *m->b;
    ellipsoid_friction friction = {.bodies = 2};

    friction.attachment[0] =
        ellipsoid_attachment_of(m->state_a, a.r, a.model->bead[bead_a]);
    friction.attachment[1] =
        ellipsoid_attachment_of(m->state_b, b.r, b.model->bead[bead_b]);
    ellipsoid_copy(force, friction.elastic);
    for (int i = 0; i < 3; i++)
    {
        friction.attachment[0].point[i] -= part_a * line[i];
        friction.attachment[1].point[i] += part_b * line[i];
        for (int j = 0; j < 3; j++)
        {
            friction.elastic_c[0][i][j] = force_x[i][j];
            friction.elastic_c[1][i][j] = -force_x[i][j];
            friction.point_c[0][i][j] = i == j ? part_b : 0;
            friction.point_c[1][i][j] = i == j ? part_a : 0;
        }
    }
    if (!ellipsoid_friction_traction(&m->law, &friction, m->derivatives))
    {
        return;
    }
    m->slip = fmin(m->slip, friction.traction.slip);
    ellipsoid_add_friction(&friction, 0, m->of_a->force, m->of_a->torque);
    ellipsoid_add_friction(&friction, 1, m->of_b->force, m->of_b->torque);
    if (m->derivatives)
    {
        ellipsoid_add_friction_jacobian(&friction, jacobian);
    }
}

/* A bead of each; `line` is between the centres of the cells. */
static inline void add_bead_pair(ellipsoid_pair_contact *m,
                                 const double line[3], int bead_a, int bead_b)
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

        set_normal_force(&m->normal_law, between, distance, distance - both,
                         force, force_x);
        if (m->contacts++ == 0)
        {
            clear_wrench(m, m->of_a);
            clear_wrench(m, m->of_b);
        }
        if (m->dissipative)
        {
            add_with_friction(m, bead_a, bead_b, between, force, force_x);
        }
        else
        {
            add_elastic(m, bead_a, bead_b, force, force_x);
        }
    }
}

void ellipsoid_pair_contact_evaluate(ellipsoid_pair_contact *m,
                                     const ellipsoid_near_pair *near)
{
    const int all_b = m->b->model->bead_count;
    const int count =
        near->listed < 0 ? m->a->model->bead_count * all_b : near->listed;
    double line[3];

    if (ellipsoid_pair_is_exact(m->a->model, m->b->model))
    {
        ellipsoid_surface_pair_contact(m);
        return;
    }
    ellipsoid_difference(m->a->x, m->b->x, line);
    for (int n = 0; n < count; n++)
    {
        if (near->listed < 0)
        {
            add_bead_pair(m, line, n / all_b, n % all_b);
        }
        else
        {
            add_bead_pair(m, line, near->bead[n][0], near->bead[n][1]);
        }
    }
}

double ellipsoid_cell_gap(const ellipsoid_model *a, const double x_a[3],
                          const double q_a[4], const ellipsoid_model *b,
                          const double x_b[3], const double q_b[4],
                          double horizon)
{
    double bead_a[ELLIPSOID_MAX_BEADS][3], bead_b[ELLIPSOID_MAX_BEADS][3];
    ellipsoid_body of_a = {.bead = bead_a}, of_b = {.bead = bead_b};
    ellipsoid_near_pair near;
    ellipsoid_pair_wrench on_a, on_b;
    ellipsoid_pair_contact m = {
        .a = &of_a,
        .b = &of_b,
        .normal_law = ellipsoid_pair_law(&a->options, &b->options),
        .gap = horizon,
        .of_a = &on_a,
        .of_b = &on_b};

    if (ellipsoid_are_apart(a, x_a, b, x_b, horizon))
    {
        return horizon;
    }
    ellipsoid_place_body(&of_a, a, x_a, q_a);
    ellipsoid_place_body(&of_b, b, x_b, q_b);
    ellipsoid_list_beads(&of_a, &of_b, horizon, &near);
    ellipsoid_pair_contact_evaluate(&m, &near);
    return m.gap;
}
