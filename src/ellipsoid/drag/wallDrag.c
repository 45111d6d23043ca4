/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    wallDrag.c - drag near walls.

        (F^, T^) = mu (diag(K^, C) + sum_planes A(n^, g))
                   (R^T (u_free - u), omega_free - w^)
                 - mu sum_planes Q(n^, g) (R^T u, w^)
                 + mu sum_planes D(n^, g) gamma^,
    with the free motion as it is far from walls and gamma = (I - n n) G n of the
    flow at the centre (planeFunctions.c, wallPlanes.c): a plane resists motion,
    squeezing (Q) that relative to the wall, and holds back a body that the shear
    along it carries.
*/
#include "drag/drag.h"

static const double none[6];

enum
{
    POSE = ELLIPSOID_POSE_SIZE
};

/* (I - n n) v */
static void project(const double normal[3], double v[3])
{
    const double along = ellipsoid_dot(normal, v);

    for (int i = 0; i < 3; i++)
    {
        v[i] -= along * normal[i];
    }
}

/* gamma in the lab and in the body frame. */
static void set_shear(const ellipsoid_near_walls *near,
                      const ellipsoid_plane *plane, double lab[3],
                      double body[3])
{
    for (int i = 0; i < 3; i++)
    {
        lab[i] = ellipsoid_dot(near->flow->gradient[i], plane->wall);
    }
    project(plane->wall, lab);
    ellipsoid_product(near->frame->axis, lab, body);
}

/* Adds the weighted sum of the two actions of a plane. */
static void add_weighted(const double weight[2], double factor,
                         double action[2][6], double sum[6])
{
    for (int i = 0; i < 6; i++)
    {
        sum[i] += factor
                * (weight[ELLIPSOID_PLANE_FAR] * action[0][i]
                   + weight[ELLIPSOID_PLANE_NEAR] * action[1][i]);
    }
}

/* Adds an action of a plane to a column. */
static void add_part(double weight, const double action[6], double sum[6])
{
    for (int i = 0; i < 6; i++)
    {
        sum[i] += weight * action[i];
    }
}

/* mu sum A and mu sum Q. */
static void set_matrices(const ellipsoid_model *model,
                         const ellipsoid_planes *planes, double slip[6][6],
                         double squeeze[6][6])
{
    const double mu = model->viscosity;

    memset(slip, 0, 6 * sizeof(*slip));
    memset(squeeze, 0, 6 * sizeof(*squeeze));
    for (int p = 0; p < planes->count; p++)
    {
        const ellipsoid_plane *plane = &planes->at[p];
        const double factor[2] = {mu * plane->weight[0], mu * plane->weight[1]};

        ellipsoid_plane_add_matrices(&plane->effect, factor, slip, squeeze);
    }
}

/* Adds mu diag(K, C). */
static void add_free_resistance(const ellipsoid_model *model,
                                double matrix[6][6])
{
    for (int i = 0; i < 3; i++)
    {
        matrix[i][i] += model->viscosity * model->resistance[i];
        matrix[i + 3][i + 3] +=
            model->viscosity * model->rotation_resistance[i];
    }
}

static void add_matrix(double other[6][6], double matrix[6][6])
{
    for (int m = 0; m < 6; m++)
    {
        add_part(1, other[m], matrix[m]);
    }
}

void ellipsoid_wall_matrix(const ellipsoid_model *model,
                           const ellipsoid_planes *planes, double matrix[6][6])
{
    double squeeze[6][6];

    set_matrices(model, planes, matrix, squeeze);
    add_matrix(squeeze, matrix);
    add_free_resistance(model, matrix);
}

/* Adds what the planes add on a body of this velocity that a free one outruns by
   these rates. */
static void add_planes(const ellipsoid_near_walls *near, const double rates[6],
                       const double velocity[6], double action[6])
{
    const ellipsoid_model *m = near->model;

    for (int p = 0; p < near->planes->count; p++)
    {
        const ellipsoid_plane *plane = &near->planes->at[p];
        double lab[3], shear[3], parts[2][6];

        set_shear(near, plane, lab, shear);
        ellipsoid_plane_action(&plane->effect, rates, velocity, shear, parts,
                               NULL);
        add_weighted(plane->weight, m->viscosity, parts, action);
    }
}

/* Adds how the same changes with the pose and with the flow's gradient, but not
   of rates and velocity. */
static void add_plane_derivatives(const ellipsoid_near_walls *near,
                                  const ellipsoid_plane *plane,
                                  ellipsoid_wall_expansion *e)
{
    const double mu = near->model->viscosity, *n = plane->wall;
    double lab[3], shear[3], parts[2][6], by[4][2][6], driven[3][6];
    double turned[3][6]; /* by the normal's components */

    set_shear(near, plane, lab, shear);
    ellipsoid_plane_action(&plane->effect, e->rates, e->velocity, shear, parts,
                           by);
    ellipsoid_plane_shear_columns(
        &plane->effect, mu * plane->weight[ELLIPSOID_PLANE_FAR], driven);
    memset(turned, 0, sizeof(turned));
    for (int c = 0; c < 3; c++)
    {
        add_weighted(plane->weight, mu, by[c], turned[c]);
    }
    for (int l = 0; l < POSE; l++)
    {
        const double of_weight[2] = {plane->weight_slope[0][l],
                                     plane->weight_slope[1][l]};
        const double of_gap[2] = {plane->weight[0] * plane->gap_slope[0][l],
                                  plane->weight[1] * plane->gap_slope[1][l]};

        add_weighted(of_weight, mu, parts, e->by_pose[l]);
        add_weighted(of_gap, mu, by[3], e->by_pose[l]);
        for (int c = 0; l >= 3 && c < 3; c++)
        {
            add_part(plane->normal_slope[l][c], turned[c], e->by_pose[l]);
            add_part(ellipsoid_dot(near->frame->by_q[l - 3][c], lab), driven[c],
                     e->by_pose[l]);
        }
    }
    for (int m = 0; m < 6; m++)
    {
        double by_shear[3];

        ellipsoid_combination(near->frame->axis, driven[0][m], driven[1][m],
                              driven[2][m], by_shear);
        project(n, by_shear);
        for (int i = 0; i < 3; i++)
        {
            for (int j = 0; j < 3; j++)
            {
                e->by_gradient[3 * i + j][m] += by_shear[i] * n[j];
            }
        }
    }
}

/* (R^T first, second) */
static void to_body(double axis[3][3], const double first[3],
                    const double second[3], double both[6])
{
    ellipsoid_product(axis, first, both);
    ellipsoid_copy(second, both + 3);
}

static void add_lab(double axis[3][3], const double body[3], double lab[3])
{
    double turned[3];

    ellipsoid_combination(axis, body[0], body[1], body[2], turned);
    ellipsoid_add(lab, turned);
}

/* Adds to a column of the blocks, rows of u and omega apart by a stride. */
static void add_column(double axis[3][3], const double action[6], double *of_u,
                       double *of_omega, int stride)
{
    for (int i = 0; i < 3; i++)
    {
        of_u[i * stride] += axis[0][i] * action[0] + axis[1][i] * action[1]
                          + axis[2][i] * action[2];
        of_omega[i * stride] += action[i + 3];
    }
}

/* action = matrix rates, with a symmetric matrix. */
static void apply(double matrix[6][6], const double rates[6], double action[6])
{
    for (int i = 0; i < 6; i++)
    {
        action[i] = ellipsoid_dot(matrix[i], rates)
                  + ellipsoid_dot(matrix[i] + 3, rates + 3);
    }
}

static void set_derivatives(const ellipsoid_near_walls *near,
                            ellipsoid_wall_expansion *e)
{
    set_matrices(near->model, near->planes, e->slip, e->squeeze);
    memset(e->by_pose, 0, sizeof(e->by_pose));
    memset(e->by_gradient, 0, sizeof(e->by_gradient));
    for (int p = 0; p < near->planes->count; p++)
    {
        add_plane_derivatives(near, &near->planes->at[p], e);
    }
}

/* How the wrench changes with the place: u_free, omega_free and the gradient do.
   slip: of all the drag. */
static void add_place_blocks(const ellipsoid_near_walls *near,
                             const ellipsoid_wall_expansion *e,
                             double slip[6][6], ellipsoid_jacobian_blocks *b)
{
    const ellipsoid_free_motion *free = near->free;
    double(*axis)[3] = near->frame->axis, column[6], moved[6];

    for (int l = 0; l < 3; l++)
    {
        const double u_x[3] = {free->u_x[0][l], free->u_x[1][l],
                               free->u_x[2][l]};
        const double omega_x[3] = {free->omega_x[0][l], free->omega_x[1][l],
                                   free->omega_x[2][l]};

        to_body(axis, u_x, omega_x, moved);
        apply(slip, moved, column);
        add_part(1, e->by_pose[l], column);
        for (int i = 0; i < 9; i++)
        {
            add_part(near->flow->gradient_jacobian[i / 3][i % 3][l],
                     e->by_gradient[i], column);
        }
        add_column(axis, column, &b->ux[0][l], &b->wx[0][l], 3);
    }
}

/* action: of all the drag, body frame; outrun: u_free - u, lab. */
static void add_blocks(const ellipsoid_near_walls *near,
                       ellipsoid_wall_expansion *e, const double u[3],
                       const double outrun[3], const double action[6],
                       ellipsoid_jacobian_blocks *b)
{
    const ellipsoid_model *m = near->model;
    const ellipsoid_free_motion *free = near->free;
    ellipsoid_frame *frame = near->frame;
    double(*axis)[3] = frame->axis, matrix[6][6];
    double column[6], moved[6];

    memcpy(matrix, e->slip, sizeof(matrix));
    add_free_resistance(m, matrix);
    add_place_blocks(near, e, matrix, b);
    for (int n = 0; n < 4; n++)
    {
        double turned[6] = {0}, squeezed[6];

        ellipsoid_product(frame->by_q[n], outrun, moved);
        ellipsoid_product(frame->by_q[n], u, turned);
        for (int i = 0; i < 3; i++)
        {
            moved[i] += m->flow_points > 0 ? axis[i][0] * free->u_q[0][n]
                                                 + axis[i][1] * free->u_q[1][n]
                                                 + axis[i][2] * free->u_q[2][n]
                                           : 0;
            moved[i + 3] = free->omega_q[i][n];
        }
        apply(matrix, moved, column);
        apply(e->squeeze, turned, squeezed);
        add_part(-1, squeezed, column);
        add_part(1, e->by_pose[n + 3], column);
        add_column(axis, column, &b->uq[0][n], &b->wq[0][n], 4);
        ellipsoid_combination(frame->by_q[n], action[0], action[1], action[2],
                              turned);
        for (int i = 0; i < 3; i++)
        {
            b->uq[i][n] += turned[i];
        }
    }
    add_matrix(e->squeeze, matrix);
    for (int l = 0; l < 3; l++)
    {
        const double back[6] = {-axis[0][l], -axis[1][l], -axis[2][l]};

        apply(matrix, back, column);
        add_column(axis, column, &b->uu[0][l], &b->wu[0][l], 3);
        for (int i = 0; i < 6; i++)
        {
            column[i] = -matrix[l + 3][i];
        }
        add_column(axis, column, &b->uw[0][l], &b->ww[0][l], 3);
    }
}

/* The drag of a free body and what the planes add, body frame, to the wrench. */
static void add_wrench(const ellipsoid_near_walls *near, const double rates[6],
                       const double planes[6], double action[6],
                       ellipsoid_body_wrench *wrench)
{
    const ellipsoid_model *m = near->model;

    for (int i = 0; i < 3; i++)
    {
        action[i] = m->viscosity * m->resistance[i] * rates[i] + planes[i];
        action[i + 3] = m->viscosity * m->rotation_resistance[i] * rates[i + 3]
                      + planes[i + 3];
    }
    add_lab(near->frame->axis, action, wrench->force);
    ellipsoid_add(wrench->torque, action + 3);
}

/* The motions that the drag depends on; returns u_free - u. */
static void set_motions(const ellipsoid_near_walls *near,
                        const ellipsoid_state *state, double outrun[3],
                        double rates[6], double velocity[6])
{
    double turn[3];

    ellipsoid_difference(near->free->u, state->u, outrun);
    ellipsoid_difference(near->free->omega, state->omega, turn);
    to_body(near->frame->axis, outrun, turn, rates);
    to_body(near->frame->axis, state->u, state->omega, velocity);
}

void ellipsoid_add_wall_drag(const ellipsoid_near_walls *near,
                             const ellipsoid_state *state,
                             ellipsoid_body_wrench *wrench,
                             ellipsoid_jacobian_blocks *blocks,
                             ellipsoid_wall_expansion *e)
{
    double outrun[3], action[6];

    e->planes = near->planes->count;
    ellipsoid_copy(state->x, e->x);
    memcpy(e->q, state->q, sizeof(e->q));
    memcpy(e->gradient, near->flow->gradient, sizeof(e->gradient));
    set_motions(near, state, outrun, e->rates, e->velocity);
    memset(e->action, 0, sizeof(e->action));
    add_planes(near, e->rates, e->velocity, e->action);
    add_wrench(near, e->rates, e->action, action, wrench);
    if (blocks)
    {
        set_derivatives(near, e);
        add_blocks(near, e, state->u, outrun, action, blocks);
    }
}

/* What the planes add where all this is known, to first order. */
static void expand(const ellipsoid_wall_expansion *e, const double x[3],
                   const double q[4], const double rates[6],
                   const double velocity[6], const double (*gradient)[3],
                   double action[6])
{
    double pose[POSE], slip[6], moved[6], steeper[9];

    ellipsoid_difference(x, e->x, pose);
    for (int i = 0; i < 9; i++)
    {
        steeper[i] = gradient[i / 3][i % 3] - e->gradient[i / 3][i % 3];
    }
    for (int n = 0; n < 4; n++)
    {
        pose[n + 3] = q[n] - e->q[n];
    }
    for (int m = 0; m < 6; m++)
    {
        slip[m] = rates[m] - e->rates[m];
        moved[m] = velocity[m] - e->velocity[m];
    }
    memcpy(action, e->action, sizeof(e->action));
    for (int l = 0; l < POSE; l++)
    {
        add_part(pose[l], e->by_pose[l], action);
    }
    for (int l = 0; l < 6; l++)
    {
        add_part(slip[l], e->slip[l], action);
        add_part(-moved[l], e->squeeze[l], action);
    }
    for (int i = 0; i < 9; i++)
    {
        add_part(steeper[i], e->by_gradient[i], action);
    }
}

void ellipsoid_add_expanded_wall_drag(const ellipsoid_near_walls *near,
                                      const ellipsoid_wall_expansion *about,
                                      const ellipsoid_state *state,
                                      ellipsoid_body_wrench *wrench)
{
    double outrun[3], rates[6], velocity[6], planes[6], action[6];

    set_motions(near, state, outrun, rates, velocity);
    expand(about, state->x, state->q, rates, velocity, near->flow->gradient,
           planes);
    add_wrench(near, rates, planes, action, wrench);
}

ellipsoid_status ellipsoid_wall_expansion_error(
    const ellipsoid_model *model, const ellipsoid_wall_expansion *about,
    const ellipsoid_wall_expansion *there, double error[6])
{
    double action[6] = {0}, matrix[6][6] = {{0}}, wrong[6];

    if (about->planes > 0)
    {
        memcpy(matrix, about->slip, sizeof(matrix));
        for (int m = 0; m < 6; m++)
        {
            add_part(1, about->squeeze[m], matrix[m]);
        }
        expand(about, there->x, there->q, there->rates, there->velocity,
               there->gradient, action);
    }
    add_free_resistance(model, matrix);
    if (!ellipsoid_invert6(matrix))
    {
        return ELLIPSOID_NON_FINITE;
    }
    for (int m = 0; m < 6; m++)
    {
        wrong[m] = there->action[m] - action[m];
    }
    apply(matrix, wrong, error);
    return ELLIPSOID_OK;
}

/* Adds to u and omega what a push does, body frame. */
static ellipsoid_status add_mobility(const ellipsoid_model *model,
                                     const ellipsoid_planes *planes,
                                     double axis[3][3], const double push[6],
                                     ellipsoid_state *state)
{
    double matrix[6][6], rates[6];

    ellipsoid_wall_matrix(model, planes, matrix);
    if (!ellipsoid_invert6(matrix))
    {
        return ELLIPSOID_NON_FINITE;
    }
    apply(matrix, push, rates);
    add_lab(axis, rates, state->u);
    ellipsoid_add(state->omega, rates + 3);
    return ELLIPSOID_OK;
}

ellipsoid_status ellipsoid_add_wall_mobility(
    const ellipsoid_model *model, const ellipsoid_planes *planes,
    ellipsoid_frame *frame, const ellipsoid_body_wrench *wrench,
    ellipsoid_state *state)
{
    double push[6];

    to_body(frame->axis, wrench->force, wrench->torque, push);
    return add_mobility(model, planes, frame->axis, push, state);
}

ellipsoid_status
ellipsoid_balance_wall_drag(const ellipsoid_near_walls *near,
                            const ellipsoid_body_wrench *wrench,
                            ellipsoid_state *state)
{
    double push[6], velocity[6];

    to_body(near->frame->axis, wrench->force, wrench->torque, push);
    to_body(near->frame->axis, near->free->u, near->free->omega, velocity);
    add_planes(near, none, velocity, push);
    ellipsoid_copy(near->free->u, state->u);
    ellipsoid_copy(near->free->omega, state->omega);
    return add_mobility(near->model, near->planes, near->frame->axis, push,
                        state);
}
