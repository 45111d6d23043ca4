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

typedef ellipsoid_dual dual;

static void add_plane(const ellipsoid_model *model,
                      const ellipsoid_plane *plane, ellipsoid_wall_expansion *e)
{
    const ellipsoid_plane_matrix *of = &plane->effect.by_gap;
    const double far = model->viscosity * plane->weight[FAR].value;
    const double near =
        model->viscosity * plane->weight[NEAR].value * creal(of->squeeze);
    double column[9][6], row[6], by_flow[MOTION - GRADIENT][6];

    for (int i = 0; i < 6; i++)
    {
        row[i] = creal(of->row[i]);
        for (int n = 0; n < 9; n++)
        {
            column[n][i] = creal(of->column[n][i]);
        }
    }
    for (int m = 0; m < 6; m++)
    {
        ellipsoid_add6(far, column[m], e->by[m]);
        ellipsoid_add6(-near * row[m], row, e->by[VELOCITY + m]);
    }
    ellipsoid_wall_fit_columns(model, plane->effect.normal, column, by_flow);
    for (int m = GRADIENT; m < MOTION; m++)
    {
        ellipsoid_add6(far, by_flow[m - GRADIENT], e->by[m]);
    }
}

void ellipsoid_wall_expansion_set(const ellipsoid_model *model,
                                  ellipsoid_planes *planes,
                                  const ellipsoid_state *state,
                                  ellipsoid_wall_expansion *e)
{
    e->planes = planes->count;
    ellipsoid_copy(state->x, e->x);
    memcpy(e->q, state->q, sizeof(e->q));
    memset(e->by, 0, sizeof(e->by));
    memset(e->by_pose, 0, sizeof(e->by_pose));
    for (int i = 0; i < 3; i++)
    {
        e->by[i][i] = model->viscosity * model->resistance[i];
        e->by[i + 3][i + 3] = model->viscosity * model->rotation_resistance[i];
    }
    for (int p = 0; p < planes->count; p++)
    {
        add_plane(model, &planes->at[p], e);
    }
}

void ellipsoid_wall_matrix(const ellipsoid_wall_expansion *e,
                           double matrix[6][6])
{
    memcpy(matrix, e->by, 6 * sizeof(*matrix));
    for (int m = 0; m < 6; m++)
    {
        ellipsoid_add6(-1, e->by[VELOCITY + m], matrix[m]);
    }
}

/* Adds what the fluid does at this pose: the sum is a copy, or each term would be
   stored before the next is read. */
static void add_action(const ellipsoid_wall_expansion *e, const double x[3],
                       const double q[4], const double motion[MOTION],
                       double action[6])
{
    double sum[6];

    memcpy(sum, action, sizeof(sum));
    for (int m = 0; m < MOTION; m++)
    {
        ellipsoid_add6(motion[m], e->by[m], sum);
    }
    for (int l = 0; l < POSE; l++)
    {
        ellipsoid_add6(l < 3 ? x[l] - e->x[l] : q[l - 3] - e->q[l - 3],
                       e->by_pose[l], sum);
    }
    memcpy(action, sum, sizeof(sum));
}

static void add_lab(double axis[3][3], const double body[3], double lab[3])
{
    double turned[3];

    ellipsoid_combination(axis, body[0], body[1], body[2], turned);
    ellipsoid_add(lab, turned);
}

/* What a body does in the flow, from the lab: outrun by a free one, and along its
   axes the gradient, at the centre and averaged. Angular velocities are those of
   the body frame. */
typedef struct lab_motion
{
    double outrun[3], turn[3], u[3], omega[3], along[2][3][3];
} lab_motion;

static lab_motion lab_motion_of(const ellipsoid_near_walls *near,
                                const ellipsoid_state *state)
{
    lab_motion from = {.u = {0}};

    ellipsoid_difference(near->free->u, state->u, from.outrun);
    ellipsoid_difference(near->free->omega, state->omega, from.turn);
    ellipsoid_copy(state->u, from.u);
    ellipsoid_copy(state->omega, from.omega);
    for (int j = 0; j < 3; j++)
    {
        ellipsoid_product(near->flow->gradient, near->frame->axis[j],
                          from.along[0][j]);
    }
    if (near->model->flow_points > 0)
    {
        memcpy(from.along[1], near->free->along, sizeof(from.along[1]));
    }
    return from;
}

/* Adds R^T of it. */
static void add_motion(double axis[3][3], const lab_motion *from,
                       double motion[MOTION])
{
    for (int i = 0; i < 3; i++)
    {
        motion[i] += ellipsoid_dot(axis[i], from->outrun);
        motion[3 + i] += from->turn[i];
        motion[VELOCITY + i] += ellipsoid_dot(axis[i], from->u);
        motion[VELOCITY + 3 + i] += from->omega[i];
        for (int j = 0; j < 3; j++)
        {
            motion[GRADIENT + 3 * i + j] +=
                ellipsoid_dot(axis[i], from->along[0][j]);
            motion[MEAN + 3 * i + j] +=
                ellipsoid_dot(axis[i], from->along[1][j]);
        }
    }
}

void ellipsoid_add_wall_drag(const ellipsoid_near_walls *near,
                             const ellipsoid_wall_expansion *about,
                             const ellipsoid_state *state,
                             double motion[MOTION], double action[6],
                             ellipsoid_body_wrench *wrench)
{
    const lab_motion from = lab_motion_of(near, state);

    memset(motion, 0, MOTION * sizeof(*motion));
    memset(action, 0, 6 * sizeof(*action));
    add_motion(near->frame->axis, &from, motion);
    add_action(about, state->x, state->q, motion, action);
    add_lab(near->frame->axis, action, wrench->force);
    ellipsoid_add(wrench->torque, action + 3);
}

/* How what a plane adds changes with the pose while the motion stays: by two
   turns of the normal, and the gaps; and by the weights. */
static void add_slopes(const ellipsoid_model *model,
                       const ellipsoid_plane *plane,
                       ellipsoid_wall_expansion *e)
{
    const double *n = plane->effect.normal;
    dual motion[9] = {0}, action[2][6];
    double turn[2][3];

    ellipsoid_tangents(n, turn);
    for (int by = 0; by < 3; by++)
    {
        const double *t = turn[by % 2];
        ellipsoid_plane_matrix turned;

        if (by < 2)
        {
            const dual step = ELLIPSOID_DUAL_STEP * I;
            const dual normal[3] = {n[0] + step * t[0], n[1] + step * t[1],
                                    n[2] + step * t[2]};

            ellipsoid_wall_fit_motion(model, normal, e->motion + MEAN, motion);
            ellipsoid_along_wall(e->motion + GRADIENT, normal, motion + 6);
            ellipsoid_plane_matrix_at(&plane->effect, normal, 0, &turned);
        }
        for (int m = 0; m < 9; m++)
        {
            motion[m] = by == 2 ? creal(motion[m])
                                : motion[m] + (m < 6 ? e->motion[m] : 0);
        }
        ellipsoid_plane_action(by < 2 ? &turned : &plane->effect.by_gap, motion,
                               e->motion + VELOCITY, action);
        for (int m = 0; m < 2; m++)
        {
            double value[6], change[6];

            for (int i = 0; i < 6; i++)
            {
                value[i] = model->viscosity * creal(action[m][i]);
                change[i] = model->viscosity * plane->weight[m].value
                          * cimag(action[m][i]) / ELLIPSOID_DUAL_STEP;
            }
            for (int l = 3; by < 2 && l < POSE; l++)
            {
                ellipsoid_add6(ellipsoid_dot(plane->normal_by[l], t), change,
                               e->by_pose[l]);
            }
            for (int l = 0; by == 2 && l < POSE; l++)
            {
                ellipsoid_add6(plane->gap[m].by[l], change, e->by_pose[l]);
                ellipsoid_add6(plane->weight[m].by[l], value, e->by_pose[l]);
            }
        }
    }
}

void ellipsoid_wall_expansion_slopes(const ellipsoid_near_walls *near,
                                     ellipsoid_wall_expansion *e)
{
    for (int p = 0; p < near->planes->count; p++)
    {
        add_slopes(near->model, &near->planes->at[p], e);
    }
}

/* Adds force and torque of the body frame to a column of the blocks, whose rows
   of u and omega are apart by a stride. */
static void add_column(double axis[3][3], const double action[6], double *of_u,
                       double *of_omega, int stride)
{
    double lab[3] = {0};

    add_lab(axis, action, lab);
    for (int i = 0; i < 3; i++)
    {
        of_u[i * stride] += lab[i];
        of_omega[i * stride] += action[i + 3];
    }
}

void ellipsoid_add_wall_drag_blocks(const ellipsoid_near_walls *near,
                                    const ellipsoid_state *state,
                                    const ellipsoid_wall_expansion *e,
                                    const double action[6],
                                    ellipsoid_jacobian_blocks *b)
{
    ellipsoid_free_motion *free = near->free;
    ellipsoid_flow_sample *flow = near->flow;
    const int averaged = near->model->flow_points > 0;
    double(*axis)[3] = near->frame->axis, matrix[6][6];
    lab_motion from = lab_motion_of(near, state);

    ellipsoid_wall_matrix(e, matrix);
    for (int l = 0; l < 3; l++)
    {
        double pushed[6] = {0}, spun[6] = {0};

        for (int i = 0; i < 3; i++)
        {
            ellipsoid_add6(-axis[i][l], matrix[i], pushed);
        }
        ellipsoid_add6(-1, matrix[3 + l], spun);
        add_column(axis, pushed, &b->uu[0][l], &b->wu[0][l], 3);
        add_column(axis, spun, &b->uw[0][l], &b->ww[0][l], 3);
        from.turn[l] = from.omega[l] = 0; /* the same in a frame that turns */
    }
    for (int l = 0; l < POSE; l++)
    {
        const int n = l - 3;
        double motion[MOTION] = {0}, by[6], lab[3] = {0};
        lab_motion changes = {.u = {0}};

        memcpy(by, e->by_pose[l], sizeof(by));
        for (int i = 0; i < 3; i++)
        {
            changes.outrun[i] = n < 0    ? free->u_x[i][l]
                              : averaged ? free->u_q[i][n]
                                         : 0;
            changes.turn[i] = n < 0 ? free->omega_x[i][l] : free->omega_q[i][n];
            for (int jk = 0; jk < 9; jk++)
            {
                const int j = jk / 3, k = jk % 3;

                changes.along[0][j][i] +=
                    n < 0 ? flow->gradient_jacobian[i][k][l] * axis[j][k]
                          : flow->gradient[i][k] * near->frame->by_q[n][j][k];
            }
        }
        if (averaged)
        {
            memcpy(changes.along[1], free->along_by[l],
                   sizeof(changes.along[1]));
        }
        add_motion(axis, &changes, motion);
        if (n >= 0)
        {
            add_motion(near->frame->by_q[n], &from, motion);
            add_lab(near->frame->by_q[n], action, lab);
        }
        for (int m = 0; m < MOTION; m++)
        {
            ellipsoid_add6(motion[m], e->by[m], by);
        }
        add_column(axis, by, n < 0 ? &b->ux[0][l] : &b->uq[0][n],
                   n < 0 ? &b->wx[0][l] : &b->wq[0][n], n < 0 ? 3 : 4);
        for (int i = 0; n >= 0 && i < 3; i++)
        {
            b->uq[i][n] += lab[i];
        }
    }
}

ellipsoid_status ellipsoid_wall_rates(const ellipsoid_wall_expansion *e,
                                      const double push[6], double rates[6])
{
    double matrix[6][6];

    ellipsoid_wall_matrix(e, matrix);
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

ellipsoid_status
ellipsoid_wall_expansion_error(const ellipsoid_wall_expansion *about,
                               const ellipsoid_wall_expansion *there,
                               double error[6])
{
    double action[6] = {0}, wrong[6] = {0};

    add_action(about, there->x, there->q, there->motion, action);
    add_action(there, there->x, there->q, there->motion, wrong);
    ellipsoid_add6(-1, action, wrong);
    return ellipsoid_wall_rates(about, wrong, error);
}

ellipsoid_status ellipsoid_balance_wall_drag(
    const ellipsoid_near_walls *near, const ellipsoid_wall_expansion *e,
    const ellipsoid_body_wrench *wrench, ellipsoid_state *state)
{
    double push[6], rates[6], motion[MOTION] = {0};
    ellipsoid_status status;
    lab_motion from;

    ellipsoid_copy(near->free->u, state->u);
    ellipsoid_copy(near->free->omega, state->omega);
    from = lab_motion_of(near, state);
    add_motion(near->frame->axis, &from, motion);
    ellipsoid_product(near->frame->axis, wrench->force, push);
    ellipsoid_copy(wrench->torque, push + 3);
    add_action(e, state->x, state->q, motion, push);
    status = ellipsoid_wall_rates(e, push, rates);
    if (status == ELLIPSOID_OK)
    {
        add_lab(near->frame->axis, rates, state->u);
        ellipsoid_add(state->omega, rates + 3);
    }
    return status;
}
