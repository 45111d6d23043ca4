/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    wallDrag.c - drag near walls.

    The resistance of the free body and what each plane adds to it
    (wallResistance.c, wallPlanes.c) make one matrix in the body frame,
    symmetric and positive definite:
        (F^, T^) = mu (diag(K^, C) + sum_planes weight A(n^, h))
                   (R^T (u_free - u), omega_free - w^).
*/
#include "drag/drag.h"
#include "drag/wallResistance.h"

int ellipsoid_wall_action(const ellipsoid_model *m,
                          const ellipsoid_planes *planes,
                          const double rates[6], double action[6])
{
    int regular = 1;

    for (int i = 0; i < 3; i++)
    {
        action[i] = m->viscosity * m->resistance[i] * rates[i];
        action[i + 3] =
            m->viscosity * m->rotation_resistance[i] * rates[i + 3];
    }
    for (int p = 0; p < planes->count; p++)
    {
        const ellipsoid_plane *plane = &planes->at[p];
        const double factor = m->viscosity * plane->weight.value;
        double more[6];

        regular = ellipsoid_plane_resistance(m, plane->normal,
                                             plane->height.value, rates, more,
                                             NULL)
               && regular;
        for (int i = 0; i < 6; i++)
        {
            action[i] += factor * more[i];
        }
    }
    return regular;
}

/* The whole of it as a symmetric matrix; 0 if one is singular. */
static int set_matrix(const ellipsoid_model *m, const ellipsoid_planes *planes,
                      double matrix[6][6])
{
    int regular = 1;

    memset(matrix, 0, 6 * sizeof(*matrix));
    for (int p = 0; p < planes->count; p++)
    {
        const ellipsoid_plane *plane = &planes->at[p];
        double more[6][6];

        regular = ellipsoid_plane_matrix(m, plane->normal, plane->height.value,
                                         more)
               && regular;
        for (int i = 0; i < 6; i++)
        {
            for (int j = 0; j < 6; j++)
            {
                matrix[i][j] +=
                    m->viscosity * plane->weight.value * more[i][j];
            }
        }
    }
    for (int i = 0; i < 3; i++)
    {
        matrix[i][i] += m->viscosity * m->resistance[i];
        matrix[i + 3][i + 3] += m->viscosity * m->rotation_resistance[i];
    }
    return regular;
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

/* How the action on given rates changes with the pose. */
static void pose_changes(const ellipsoid_model *m,
                         const ellipsoid_planes *planes, const double rates[6],
                         double change[ELLIPSOID_POSE_SIZE][6])
{
    memset(change, 0, ELLIPSOID_POSE_SIZE * sizeof(*change));
    for (int p = 0; p < planes->count; p++)
    {
        const ellipsoid_plane *plane = &planes->at[p];
        double action[6], by[4][6];

        ellipsoid_plane_resistance(m, plane->normal, plane->height.value, rates,
                                   action, by);
        for (int n = 0; n < ELLIPSOID_POSE_SIZE; n++)
        {
            const double *turn = plane->normal_slope[n];
            const double weight = m->viscosity * plane->weight.value;
            const double of_weight = m->viscosity * plane->weight.slope[n];

            for (int i = 0; i < 6; i++)
            {
                change[n][i] += of_weight * action[i]
                              + weight
                                    * (turn[0] * by[0][i] + turn[1] * by[1][i]
                                       + turn[2] * by[2][i]
                                       + plane->height.slope[n] * by[3][i]);
            }
        }
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

/* The drag in the body frame, and what it comes from. */
typedef struct wall_drag
{
    double slip[3];  /* lab */
    double rates[6]; /* (R^T slip, omega_free - w^) */
    double action[6];
} wall_drag;

static void set_rates(ellipsoid_frame *frame,
                      const ellipsoid_free_motion *free,
                      const ellipsoid_state *state, wall_drag *drag)
{
    double turn[3];

    ellipsoid_difference(free->u, state->u, drag->slip);
    ellipsoid_difference(free->omega, state->omega, turn);
    to_body(frame->axis, drag->slip, turn, drag->rates);
}

void ellipsoid_wall_rates(ellipsoid_frame *frame,
                          const ellipsoid_free_motion *free,
                          const ellipsoid_state *state, double rates[6])
{
    wall_drag drag;

    set_rates(frame, free, state, &drag);
    memcpy(rates, drag.rates, sizeof(drag.rates));
}

/* change: of the action with the pose; of none if that is NULL */
static void add_blocks(const ellipsoid_model *m, double matrix[6][6],
                       double (*change)[6], ellipsoid_frame *frame,
                       const ellipsoid_free_motion *free,
                       const wall_drag *drag, ellipsoid_jacobian_blocks *b)
{
    double(*axis)[3] = frame->axis;

    for (int l = 0; l < 3; l++)
    {
        const double minus[3] = {-axis[0][l], -axis[1][l], -axis[2][l]};
        const double u_x[3] = {free->u_x[0][l], free->u_x[1][l],
                               free->u_x[2][l]};
        const double omega_x[3] = {free->omega_x[0][l], free->omega_x[1][l],
                                   free->omega_x[2][l]};
        double moved[6] = {minus[0], minus[1], minus[2], 0, 0, 0};
        double column[6];

        apply(matrix, moved, column);
        add_column(axis, column, &b->uu[0][l], &b->wu[0][l], 3);
        for (int i = 0; i < 6; i++)
        {
            column[i] = -matrix[l + 3][i];
        }
        add_column(axis, column, &b->uw[0][l], &b->ww[0][l], 3);
        to_body(axis, u_x, omega_x, moved);
        apply(matrix, moved, column);
        add_column(axis, column, &b->ux[0][l], &b->wx[0][l], 3);
        if (change)
        {
            add_column(axis, change[l], &b->ux[0][l], &b->wx[0][l], 3);
        }
    }
    for (int n = 0; n < 4; n++)
    {
        double moved[6], column[6], turned[3];

        ellipsoid_product(frame->by_q[n], drag->slip, moved);
        for (int i = 0; i < 3; i++)
        {
            moved[i] += m->flow_points > 0
                          ? axis[i][0] * free->u_q[0][n]
                                + axis[i][1] * free->u_q[1][n]
                                + axis[i][2] * free->u_q[2][n]
                          : 0;
            moved[i + 3] = free->omega_q[i][n];
        }
        apply(matrix, moved, column);
        add_column(axis, column, &b->uq[0][n], &b->wq[0][n], 4);
        if (change)
        {
            add_column(axis, change[n + 3], &b->uq[0][n], &b->wq[0][n], 4);
        }
        ellipsoid_combination(frame->by_q[n], drag->action[0], drag->action[1],
                              drag->action[2], turned);
        for (int i = 0; i < 3; i++)
        {
            b->uq[i][n] += turned[i];
        }
    }
}

ellipsoid_status ellipsoid_add_wall_drag(const ellipsoid_model *model,
                                         const ellipsoid_planes *planes,
                                         ellipsoid_frame *frame,
                                         const ellipsoid_free_motion *free,
                                         const ellipsoid_state *state,
                                         ellipsoid_body_wrench *wrench,
                                         ellipsoid_jacobian_blocks *blocks)
{
    wall_drag drag;

    set_rates(frame, free, state, &drag);
    if (!ellipsoid_wall_action(model, planes, drag.rates, drag.action))
    {
        return ELLIPSOID_NON_FINITE;
    }
    add_lab(frame->axis, drag.action, wrench->force);
    ellipsoid_add(wrench->torque, drag.action + 3);
    if (blocks)
    {
        double matrix[6][6], change[ELLIPSOID_POSE_SIZE][6];

        set_matrix(model, planes, matrix);
        pose_changes(model, planes, drag.rates, change);
        add_blocks(model, matrix, change, frame, free, &drag, blocks);
    }
    return ELLIPSOID_OK;
}

/*
    While a body is moved by forces that are weak against the drag, it goes with
    the fluid, whatever the resistance. If all that walls add to it went away,
    the displacement relative to the fluid in a step of h would change by the
    walls' part of it: that is to be below half the tolerance, and what they add
    changes by a part of itself alone, as no gap becomes less by a quarter. The
    relative velocity is taken for twice that at the start, and what constant
    forces do besides, as it may pass through zero there.
*/
ellipsoid_status ellipsoid_keep_resistance(const ellipsoid_model *model,
                                           const ellipsoid_planes *planes,
                                           ellipsoid_frame *frame,
                                           const ellipsoid_free_motion *free,
                                           const ellipsoid_state *state,
                                           double gap,
                                           ellipsoid_kept_resistance *kept)
{
    static const double small = 0.5;       /* part of the tolerance */
    static const double least = 0.1;       /* walls' part; they may come */
    static const double nearer = 0.25;     /* part of the gap */
    const double *k = model->resistance, *c = model->rotation_resistance;
    const double *a = model->options.semi_axes, mu = model->viscosity;
    const double longest = fmax(a[0], fmax(a[1], a[2]));
    const double speed = ellipsoid_length(state->u)
                       + longest * ellipsoid_length(state->omega);
    double part = least, spin_part = least, slip, spin;
    wall_drag drag;

    kept->longest = 0;
    gap = fmin(gap, model->options.wall_range); /* planes may come there */
    kept->acts = planes->count > 0;
    if (!set_matrix(model, planes, kept->matrix))
    {
        return ELLIPSOID_NON_FINITE;
    }
    for (int i = 0; i < 3; i++)
    {
        part = fmax(part, kept->matrix[i][i] / (mu * k[i]) - 1);
        spin_part =
            fmax(spin_part, kept->matrix[i + 3][i + 3] / (mu * c[i]) - 1);
    }
    for (int p = 0; p < planes->count; p++)
    {
        const double *m = planes->at[p].normal;
        const double along[3] = {a[0] * m[0], a[1] * m[1], a[2] * m[2]};

        gap = fmin(gap,
                   planes->at[p].height.value - ellipsoid_length(along));
    }
    set_rates(frame, free, state, &drag);
    slip = 2 * ellipsoid_length(drag.rates)
         + ellipsoid_length(model->constant_force)
               / (mu * fmin(k[0], fmin(k[1], k[2])));
    spin = 2 * ellipsoid_length(drag.rates + 3)
         + ellipsoid_length(model->options.external_torque)
               / (mu * fmin(c[0], fmin(c[1], c[2])));
    kept->longest = fmin(small * model->options.tolerance
                             / fmax(part * slip / longest, spin_part * spin),
                         nearer * fmax(gap, 0) / speed);
    return ELLIPSOID_OK;
}

void ellipsoid_add_kept_drag(const ellipsoid_model *model,
                             const ellipsoid_kept_resistance *kept,
                             ellipsoid_frame *frame,
                             const ellipsoid_free_motion *free,
                             const ellipsoid_state *state,
                             ellipsoid_body_wrench *wrench,
                             ellipsoid_jacobian_blocks *blocks)
{
    double matrix[6][6];
    wall_drag drag;

    memcpy(matrix, kept->matrix, sizeof(matrix));
    set_rates(frame, free, state, &drag);
    apply(matrix, drag.rates, drag.action);
    add_lab(frame->axis, drag.action, wrench->force);
    ellipsoid_add(wrench->torque, drag.action + 3);
    if (blocks)
    {
        add_blocks(model, matrix, NULL, frame, free, &drag, blocks);
    }
}

ellipsoid_status
ellipsoid_add_wall_mobility(const ellipsoid_model *model,
                            const ellipsoid_planes *planes,
                            ellipsoid_frame *frame,
                            const ellipsoid_body_wrench *wrench,
                            ellipsoid_state *state)
{
    double matrix[6][6], push[6], rates[6];

    if (!set_matrix(model, planes, matrix) || !ellipsoid_invert6(matrix))
    {
        return ELLIPSOID_NON_FINITE;
    }
    to_body(frame->axis, wrench->force, wrench->torque, push);
    apply(matrix, push, rates);
    add_lab(frame->axis, rates, state->u);
    ellipsoid_add(state->omega, rates + 3);
    return ELLIPSOID_OK;
}
