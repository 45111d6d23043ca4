/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    wallDrag.c - drag near walls.

        (F^, T^) = mu (diag(K^, C) + sum_planes A(n^, g))
                   (R^T (u_free - u), omega_free - w^)
                 - mu sum_planes Q(n^, g) (R^T u, w^)
                 + mu sum_planes (A(n^, g) d(n^, G^) + D(n^, g) gamma^),
    with the free motion as it is far from walls, d what the flow's gradient adds to
    it near one (wallFit.c), and gamma = (I - n n) G n (planeFunctions.c,
    wallPlanes.c): a plane resists motion, squeezing (Q) that relative to the wall,
    and holds back a body that the shear along it carries. At a pose all this is
    linear in the rates, the velocity and G.
*/
#include "drag/drag.h"

enum
{
    POSE = ELLIPSOID_POSE_SIZE,
    MOTION = ELLIPSOID_WALL_MOTION,
    VELOCITY = 6, /* where these begin in the motion */
    GRADIENT = 12,
    MEAN = 21,
    FAR = ELLIPSOID_PLANE_FAR,
    NEAR = ELLIPSOID_PLANE_NEAR
};

static void add_plane(const ellipsoid_model *model, ellipsoid_plane *plane,
                      ellipsoid_wall_expansion *e)
{
    ellipsoid_plane_effect *effect = &plane->effect;
    const double *a = model->options.semi_axes, *n = effect->normal;
    const double viscosity = model->viscosity;
    const double far = viscosity * plane->weight[FAR];
    const double near = viscosity * plane->weight[NEAR] * effect->squeeze;
    double by_mean[9][6], along[6] = {0};

    for (int m = 0; m < 6; m++)
    {
        ellipsoid_add6(far, effect->column[m], e->by[m]);
        ellipsoid_add6(-near * effect->row[m], effect->row,
                       e->by[VELOCITY + m]);
    }
    ellipsoid_wall_fit_columns(a, n, &plane->fit, effect->column, by_mean);
    for (int i = 0; i < 3; i++)
    {
        ellipsoid_add6(far * n[i], effect->column[6 + i], along);
    }
    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            double *by = e->by[GRADIENT + 3 * i + j];

            ellipsoid_add6(far * n[j], effect->column[6 + i], by);
            ellipsoid_add6(-n[i] * n[j], along, by);
            ellipsoid_add6(far, by_mean[3 * i + j], e->by[MEAN + 3 * i + j]);
        }
    }
}

void ellipsoid_wall_expansion_set(const ellipsoid_model *model,
                                  ellipsoid_planes *planes,
                                  const ellipsoid_state *state,
                                  ellipsoid_wall_expansion *e)
{
    e->planes = planes->count;
    if (e->planes == 0)
    {
        return;
    }
    ellipsoid_copy(state->x, e->x);
    memcpy(e->q, state->q, sizeof(e->q));
    memset(e->by, 0, sizeof(e->by));
    memset(e->by_pose, 0, sizeof(e->by_pose));
    for (int p = 0; p < planes->count; p++)
    {
        add_plane(model, &planes->at[p], e);
    }
}

/* Adds mu diag(K, C) rates. */
static void add_free(const ellipsoid_model *model, const double rates[6],
                     double action[6])
{
    for (int i = 0; i < 3; i++)
    {
        action[i] += model->viscosity * model->resistance[i] * rates[i];
        action[i + 3] +=
            model->viscosity * model->rotation_resistance[i] * rates[i + 3];
    }
}

void ellipsoid_wall_matrix(const ellipsoid_model *model,
                           const ellipsoid_wall_expansion *e,
                           double matrix[6][6])
{
    memset(matrix, 0, 6 * sizeof(*matrix));
    for (int m = 0; m < 6; m++)
    {
        double unit[6] = {0};

        unit[m] = 1;
        add_free(model, unit, matrix[m]);
        if (e->planes > 0)
        {
            ellipsoid_add6(1, e->by[m], matrix[m]);
            ellipsoid_add6(-1, e->by[VELOCITY + m], matrix[m]);
        }
    }
}

/* Adds what the planes do at this pose: the sum is a copy, or each term would be
   stored before the next is read. */
static void add_planes(const ellipsoid_wall_expansion *e, const double x[3],
                       const double q[4], const double motion[MOTION],
                       double action[6])
{
    double sum[6];

    memcpy(sum, action, sizeof(sum));
    for (int m = 0; e->planes > 0 && m < MOTION; m++)
    {
        ellipsoid_add6(motion[m], e->by[m], sum);
    }
    for (int l = 0; e->planes > 0 && l < POSE; l++)
    {
        ellipsoid_add6(l < 3 ? x[l] - e->x[l] : q[l - 3] - e->q[l - 3],
                       e->by_pose[l], sum);
    }
    memcpy(action, sum, sizeof(sum));
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

/* Adds left_i.right_j, as [3 i + j]. */
static void add_products(double left[3][3], double right[3][3], double sum[9])
{
    for (int n = 0; n < 9; n++)
    {
        double value = sum[n];

        for (int i = 0; i < 3; i++)
        {
            value += left[n / 3][i] * right[n % 3][i];
        }
        sum[n] = value;
    }
}

/* Adds left_i.(G right_j), likewise. */
static void add_turned(double g[3][3], double left[3][3], double right[3][3],
                       double sum[9])
{
    double along[3][3];

    for (int j = 0; j < 3; j++)
    {
        ellipsoid_product(g, right[j], along[j]);
    }
    add_products(left, along, sum);
}

static void set_motion(const ellipsoid_near_walls *near,
                       const ellipsoid_state *state, double motion[MOTION])
{
    double outrun[3], turn[3];

    ellipsoid_difference(near->free->u, state->u, outrun);
    ellipsoid_difference(near->free->omega, state->omega, turn);
    to_body(near->frame->axis, outrun, turn, motion);
    to_body(near->frame->axis, state->u, state->omega, motion + VELOCITY);
    memset(motion + GRADIENT, 0, (MOTION - GRADIENT) * sizeof(*motion));
    add_turned(near->flow->gradient, near->frame->axis, near->frame->axis,
               motion + GRADIENT);
    if (near->model->flow_points > 0)
    {
        add_products(near->frame->axis, near->free->along, motion + MEAN);
    }
}

void ellipsoid_add_wall_drag(const ellipsoid_near_walls *near,
                             const ellipsoid_wall_expansion *about,
                             const ellipsoid_state *state,
                             double motion[MOTION], double action[6],
                             ellipsoid_body_wrench *wrench)
{
    memset(action, 0, 6 * sizeof(*action));
    set_motion(near, state, motion);
    add_planes(about, state->x, state->q, motion, action);
    add_free(near->model, motion, action);
    add_lab(near->frame->axis, action, wrench->force);
    ellipsoid_add(wrench->torque, action + 3);
}

/* How what the planes add changes with the pose while the motion stays. */
static void add_slopes(const ellipsoid_near_walls *near, ellipsoid_plane *plane,
                       ellipsoid_wall_expansion *e)
{
    const double *a = near->model->options.semi_axes;
    const double mu = near->model->viscosity;
    const double far = mu * plane->weight[FAR];
    ellipsoid_plane_effect *effect = &plane->effect;
    const double *n = effect->normal;
    double rates[6], action[2][6], by[4][2][6], g[3][3], mean[3][3];
    double shear[3], bent[3][3], change[3][6];
    double turned[3][6] = {{0}}; /* by the normal */

    memcpy(g, e->motion + GRADIENT, sizeof(g));
    memcpy(mean, e->motion + MEAN, sizeof(mean));
    ellipsoid_wall_fit_motion(a, n, mean, &plane->fit, rates, change);
    ellipsoid_add6(1, e->motion, rates);
    ellipsoid_along_wall(g, n, shear, bent);
    for (int c = 0; c < 3; c++)
    {
        for (int m = 0; m < 6; m++)
        {
            ellipsoid_add6(far * change[c][m], effect->column[m], turned[c]);
        }
        for (int i = 0; i < 3; i++)
        {
            ellipsoid_add6(far * bent[c][i], effect->column[6 + i], turned[c]);
        }
    }
    ellipsoid_plane_action(effect, rates, e->motion + VELOCITY, shear, action,
                           by);
    for (int m = 0; m < 2; m++)
    {
        const double weight = mu * plane->weight[m];

        for (int l = 0; l < POSE; l++)
        {
            ellipsoid_add6(mu * plane->weight_slope[m][l], action[m],
                           e->by_pose[l]);
            ellipsoid_add6(weight * plane->gap_slope[m][l], by[3][m],
                           e->by_pose[l]);
        }
        for (int c = 0; c < 3; c++)
        {
            ellipsoid_add6(weight, by[c][m], turned[c]);
        }
    }
    for (int c = 0; c < 3; c++)
    {
        for (int l = 3; l < POSE; l++)
        {
            ellipsoid_add6(plane->normal_slope[l][c], turned[c], e->by_pose[l]);
        }
    }
}

/* Adds a column of the blocks, rows of u and omega apart by a stride: what this
   change of the motion does, with that of the pose. */
static void add_column(const ellipsoid_near_walls *near,
                       const ellipsoid_wall_expansion *e,
                       const double change[MOTION], const double by_pose[6],
                       double *of_u, double *of_omega, int stride)
{
    double action[6], lab[3] = {0};

    memcpy(action, by_pose, sizeof(action));
    for (int m = 0; m < MOTION; m++)
    {
        if (change[m] != 0) /* most are */
        {
            ellipsoid_add6(change[m], e->by[m], action);
        }
    }
    add_free(near->model, change, action);
    add_lab(near->frame->axis, action, lab);
    for (int i = 0; i < 3; i++)
    {
        of_u[i * stride] += lab[i];
        of_omega[i * stride] += action[i + 3];
    }
}

void ellipsoid_wall_expansion_slopes(const ellipsoid_near_walls *near,
                                     ellipsoid_wall_expansion *e)
{
    for (int p = 0; p < near->planes->count; p++)
    {
        add_slopes(near, &near->planes->at[p], e);
    }
}

void ellipsoid_add_wall_drag_blocks(const ellipsoid_near_walls *near,
                                    const ellipsoid_state *state,
                                    const ellipsoid_wall_expansion *e,
                                    const double action[6],
                                    ellipsoid_jacobian_blocks *b)
{
    static const double none[6];
    ellipsoid_free_motion *free = near->free;
    const int averaged = near->model->flow_points > 0;
    double(*axis)[3] = near->frame->axis, outrun[3];

    ellipsoid_difference(free->u, state->u, outrun);
    for (int l = 0; l < 3; l++)
    {
        const double u[3] = {free->u_x[0][l], free->u_x[1][l], free->u_x[2][l]};
        const double omega[3] = {free->omega_x[0][l], free->omega_x[1][l],
                                 free->omega_x[2][l]};
        double moved[MOTION] = {0}, pushed[MOTION] = {0}, turned[MOTION] = {0};
        double bent[3][3];

        to_body(axis, u, omega, moved);
        for (int i = 0; i < 9; i++)
        {
            bent[i / 3][i % 3] = near->flow->gradient_jacobian[i / 3][i % 3][l];
        }
        add_turned(bent, axis, axis, moved + GRADIENT);
        if (averaged)
        {
            add_products(axis, free->along_by[l], moved + MEAN);
        }
        for (int i = 0; i < 3; i++)
        {
            pushed[VELOCITY + i] = axis[i][l];
            pushed[i] = -axis[i][l];
        }
        turned[VELOCITY + 3 + l] = 1;
        turned[3 + l] = -1;
        add_column(near, e, moved, e->by_pose[l], &b->ux[0][l], &b->wx[0][l],
                   3);
        add_column(near, e, pushed, none, &b->uu[0][l], &b->wu[0][l], 3);
        add_column(near, e, turned, none, &b->uw[0][l], &b->ww[0][l], 3);
    }
    for (int n = 0; n < 4; n++)
    {
        double(*by_q)[3] = near->frame->by_q[n], moved[MOTION] = {0};
        double turned[3];

        ellipsoid_product(by_q, outrun, moved);
        ellipsoid_product(by_q, state->u, moved + VELOCITY);
        for (int i = 0; i < 3; i++)
        {
            const double u[3] = {free->u_q[0][n], free->u_q[1][n],
                                 free->u_q[2][n]};

            moved[i] += averaged ? ellipsoid_dot(axis[i], u) : 0;
            moved[i + 3] = free->omega_q[i][n];
        }
        add_turned(near->flow->gradient, by_q, axis, moved + GRADIENT);
        add_turned(near->flow->gradient, axis, by_q, moved + GRADIENT);
        if (averaged)
        {
            add_products(by_q, free->along, moved + MEAN);
            add_products(axis, free->along_by[n + 3], moved + MEAN);
        }
        add_column(near, e, moved, e->by_pose[n + 3], &b->uq[0][n],
                   &b->wq[0][n], 4);
        ellipsoid_combination(by_q, action[0], action[1], action[2], turned);
        for (int i = 0; i < 3; i++)
        {
            b->uq[i][n] += turned[i];
        }
    }
}

/* Velocities by which the resistance meets a push. */
static ellipsoid_status solve(const ellipsoid_model *model,
                              const ellipsoid_wall_expansion *e,
                              const double push[6], double rates[6])
{
    double matrix[6][6];

    ellipsoid_wall_matrix(model, e, matrix);
    if (!ellipsoid_invert6(matrix))
    {
        return ELLIPSOID_NON_FINITE;
    }
    memset(rates, 0, 6 * sizeof(*rates));
    for (int m = 0; m < 6; m++)
    {
        ellipsoid_add6(push[m], matrix[m], rates);
    }
    return ELLIPSOID_OK;
}

ellipsoid_status ellipsoid_wall_expansion_error(
    const ellipsoid_model *model, const ellipsoid_wall_expansion *about,
    const ellipsoid_wall_expansion *there, double error[6])
{
    double action[6] = {0}, wrong[6] = {0};

    add_planes(about, there->x, there->q, there->motion, action);
    add_planes(there, there->x, there->q, there->motion, wrong);
    ellipsoid_add6(-1, action, wrong);
    return solve(model, about, wrong, error);
}

ellipsoid_status ellipsoid_add_wall_mobility(const ellipsoid_model *model,
                                             const ellipsoid_wall_expansion *e,
                                             ellipsoid_frame *frame,
                                             const double push[6],
                                             ellipsoid_state *state)
{
    double rates[6];
    const ellipsoid_status status = solve(model, e, push, rates);

    if (status == ELLIPSOID_OK)
    {
        add_lab(frame->axis, rates, state->u);
        ellipsoid_add(state->omega, rates + 3);
    }
    return status;
}

ellipsoid_status ellipsoid_balance_wall_drag(
    const ellipsoid_near_walls *near, const ellipsoid_wall_expansion *e,
    const ellipsoid_body_wrench *wrench, ellipsoid_state *state)
{
    double push[6], motion[MOTION];

    ellipsoid_copy(near->free->u, state->u);
    ellipsoid_copy(near->free->omega, state->omega);
    set_motion(near, state, motion);
    to_body(near->frame->axis, wrench->force, wrench->torque, push);
    add_planes(e, state->x, state->q, motion, push);
    return ellipsoid_add_wall_mobility(near->model, e, near->frame, push,
                                       state);
}
