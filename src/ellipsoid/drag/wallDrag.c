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

/* mu (diag(K, C) + sum A) and mu sum Q. */
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

        for (int m = 0; m < 6; m++)
        {
            double rates[6] = {0}, velocity[6] = {0}, action[2][6];

            rates[m] = 1;
            velocity[m] = -1;
            ellipsoid_plane_action(&plane->effect, rates, velocity, none,
                                   action, NULL);
            add_part(mu * plane->weight[ELLIPSOID_PLANE_FAR], action[0],
                     slip[m]);
            add_part(mu * plane->weight[ELLIPSOID_PLANE_NEAR], action[1],
                     squeeze[m]);
        }
    }
    for (int i = 0; i < 3; i++)
    {
        slip[i][i] += mu * model->resistance[i];
        slip[i + 3][i + 3] += mu * model->rotation_resistance[i];
    }
}

void ellipsoid_wall_matrix(const ellipsoid_model *model,
                           const ellipsoid_planes *planes, double matrix[6][6])
{
    double squeeze[6][6];

    set_matrices(model, planes, matrix, squeeze);
    for (int m = 0; m < 6; m++)
    {
        add_part(1, squeeze[m], matrix[m]);
    }
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

/* The same changes with the pose, those of the planes and of gamma, but not of
   rates and velocity. */
static void add_pose_changes(const ellipsoid_near_walls *near,
                             const ellipsoid_plane *plane,
                             const double rates[6], const double velocity[6],
                             double change[POSE][6])
{
    const double mu = near->model->viscosity, *n = plane->wall;
    double lab[3], shear[3], parts[2][6], by[4][2][6];

    set_shear(near, plane, lab, shear);
    ellipsoid_plane_action(&plane->effect, rates, velocity, shear, parts, by);
    for (int l = 0; l < POSE; l++)
    {
        const double of_weight[2] = {plane->weight_slope[0][l],
                                     plane->weight_slope[1][l]};
        double of_shear[3], driven[2][6];

        add_weighted(of_weight, mu, parts, change[l]);
        for (int c = 0; c < 3; c++)
        {
            add_weighted(plane->weight, mu * plane->normal_slope[l][c], by[c],
                         change[l]);
        }
        add_weighted(plane->weight, mu * plane->gap_slope[l], by[3], change[l]);
        if (l < 3)
        {
            double moved[3];

            for (int i = 0; i < 3; i++)
            {
                const double(*g)[3] = near->flow->gradient_jacobian[i];

                moved[i] = g[0][l] * n[0] + g[1][l] * n[1] + g[2][l] * n[2];
            }
            project(n, moved);
            ellipsoid_product(near->frame->axis, moved, of_shear);
        }
        else
        {
            ellipsoid_product(near->frame->by_q[l - 3], lab, of_shear);
        }
        ellipsoid_plane_action(&plane->effect, none, none, of_shear, driven,
                               NULL);
        add_weighted(plane->weight, mu, driven, change[l]);
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

/* What the drag is evaluated with: body frame, but slip and u. */
typedef struct motion
{
    const double *u;    /* of the body, lab */
    double slip[3];     /* u_free - u, lab */
    double rates[6];    /* of the free body less those of the body */
    double velocity[6]; /* of the body */
    double action[6];   /* force and torque */
} motion;

static void add_blocks(const ellipsoid_near_walls *near, const motion *at,
                       ellipsoid_jacobian_blocks *b)
{
    const ellipsoid_model *m = near->model;
    const ellipsoid_free_motion *free = near->free;
    ellipsoid_frame *frame = near->frame;
    double(*axis)[3] = frame->axis, change[POSE][6] = {{0}};
    double slip[6][6], squeeze[6][6], column[6], moved[6];

    set_matrices(m, near->planes, slip, squeeze);
    for (int p = 0; p < near->planes->count; p++)
    {
        add_pose_changes(near, &near->planes->at[p], at->rates, at->velocity,
                         change);
    }
    for (int l = 0; l < 3; l++)
    {
        const double u_x[3] = {free->u_x[0][l], free->u_x[1][l],
                               free->u_x[2][l]};
        const double omega_x[3] = {free->omega_x[0][l], free->omega_x[1][l],
                                   free->omega_x[2][l]};

        to_body(axis, u_x, omega_x, moved);
        apply(slip, moved, column);
        add_column(axis, column, &b->ux[0][l], &b->wx[0][l], 3);
        add_column(axis, change[l], &b->ux[0][l], &b->wx[0][l], 3);
    }
    for (int n = 0; n < 4; n++)
    {
        double turned[6] = {0}, squeezed[6];

        ellipsoid_product(frame->by_q[n], at->slip, moved);
        ellipsoid_product(frame->by_q[n], at->u, turned);
        for (int i = 0; i < 3; i++)
        {
            moved[i] += m->flow_points > 0 ? axis[i][0] * free->u_q[0][n]
                                                 + axis[i][1] * free->u_q[1][n]
                                                 + axis[i][2] * free->u_q[2][n]
                                           : 0;
            moved[i + 3] = free->omega_q[i][n];
        }
        apply(slip, moved, column);
        apply(squeeze, turned, squeezed);
        add_part(-1, squeezed, column);
        add_column(axis, column, &b->uq[0][n], &b->wq[0][n], 4);
        add_column(axis, change[n + 3], &b->uq[0][n], &b->wq[0][n], 4);
        ellipsoid_combination(frame->by_q[n], at->action[0], at->action[1],
                              at->action[2], turned);
        for (int i = 0; i < 3; i++)
        {
            b->uq[i][n] += turned[i];
        }
    }
    for (int i = 0; i < 6; i++)
    {
        add_part(1, squeeze[i], slip[i]);
    }
    for (int l = 0; l < 3; l++)
    {
        const double back[6] = {-axis[0][l], -axis[1][l], -axis[2][l]};

        apply(slip, back, column);
        add_column(axis, column, &b->uu[0][l], &b->wu[0][l], 3);
        for (int i = 0; i < 6; i++)
        {
            column[i] = -slip[l + 3][i];
        }
        add_column(axis, column, &b->uw[0][l], &b->ww[0][l], 3);
    }
}

void ellipsoid_add_wall_drag(const ellipsoid_near_walls *near,
                             const ellipsoid_state *state,
                             ellipsoid_body_wrench *wrench,
                             ellipsoid_jacobian_blocks *blocks)
{
    const ellipsoid_model *m = near->model;
    motion at = {.u = state->u};
    double turn[3];

    ellipsoid_difference(near->free->u, state->u, at.slip);
    ellipsoid_difference(near->free->omega, state->omega, turn);
    to_body(near->frame->axis, at.slip, turn, at.rates);
    to_body(near->frame->axis, state->u, state->omega, at.velocity);
    for (int i = 0; i < 3; i++)
    {
        at.action[i] = m->viscosity * m->resistance[i] * at.rates[i];
        at.action[i + 3] =
            m->viscosity * m->rotation_resistance[i] * at.rates[i + 3];
    }
    add_planes(near, at.rates, at.velocity, at.action);
    add_lab(near->frame->axis, at.action, wrench->force);
    ellipsoid_add(wrench->torque, at.action + 3);
    if (blocks)
    {
        add_blocks(near, &at, blocks);
    }
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
