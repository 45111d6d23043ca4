/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    equations.c - the thirteen equations and their derivatives.

    Everything is a polynomial in the quaternion, so the Jacobian is exact
    also where q is not of length one, as inside a Rosenbrock step.
*/
#include "ellipsoidInternal.h"

#include <math.h>
#include <string.h>

_Static_assert(sizeof(ellipsoid_state) == ELLIPSOID_STATE_SIZE * sizeof(double),
               "the state is thirteen doubles without padding");

/* What one evaluation shares between values and derivatives. */
typedef struct evaluation
{
    const ellipsoid_model *model;
    const ellipsoid_state *state;
    ellipsoid_flow_sample flow;
    double axis[3][3];    /* body axes in the lab: the columns of R(q) */
    double slip[3];       /* u_f - u, lab */
    double resisted[3];   /* mu K^ R^T (u_f - u), body */
    double turning[3][3]; /* [i]: (p G - m G^T) r_j, see add_torque() */
    double force[3];      /* lab */
    double torque[3];     /* body */
} evaluation;

/* (m^T v)_column; m is not const as C11 would not take a plain matrix then */
static double column_dot(double m[3][3], int column, const double v[3])
{
    return m[0][column] * v[0] + m[1][column] * v[1] + m[2][column] * v[2];
}

/* (m_p - m_f) g and the constant external force and torque. */
static void set_constant_forces(evaluation *e)
{
    const ellipsoid_model *m = e->model;
    const double weight = m->options.buoyancy ? m->mass - m->fluid_mass : 0;

    for (int i = 0; i < 3; i++)
    {
        e->force[i] =
            weight * m->options.gravity[i] + m->options.external_force[i];
        e->torque[i] = m->options.external_torque[i];
    }
}

/* F_H = mu R K^ R^T (u_f - u): Oberbeck (1876), Brenner (1964). */
static void add_drag(evaluation *e)
{
    const ellipsoid_model *m = e->model;

    for (int i = 0; i < 3; i++)
    {
        e->slip[i] = e->flow.velocity[i] - e->state->u[i];
    }
    for (int i = 0; i < 3; i++)
    {
        e->resisted[i] = m->viscosity * m->resistance[i]
                       * ellipsoid_dot(e->axis[i], e->slip);
    }
    for (int i = 0; i < 3; i++)
    {
        e->force[i] += column_dot(e->axis, i, e->resisted);
    }
}

/*
    Jeffery (1922), eqs. (36): T^_i = mu C_i (s_i e^_jk + W^_i - w^_i), i, j, k
    cyclic. With G^ = R^T G R that is mu C_i (p G^_kj - m G^_jk - w^_i),
    p = (1 + s_i)/2, m = (1 - s_i)/2: strain and vorticity merge.
*/
static void add_torque(evaluation *e)
{
    const ellipsoid_model *model = e->model;

    for (int i = 0; i < 3; i++)
    {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double p = 0.5 * (1 + model->strain_factor[i]);
        const double m = 0.5 * (1 - model->strain_factor[i]);

        for (int a = 0; a < 3; a++)
        {
            e->turning[i][a] =
                p * ellipsoid_dot(e->flow.gradient[a], e->axis[j])
                - m * column_dot(e->flow.gradient, a, e->axis[j]);
        }
        e->torque[i] +=
            model->viscosity * model->rotation_resistance[i]
            * (ellipsoid_dot(e->axis[k], e->turning[i]) - e->state->omega[i]);
    }
}

/* F_PG: m_f (u_f . grad) u_f, or -V grad p. */
static void add_pressure_gradient(evaluation *e)
{
    const ellipsoid_model *m = e->model;

    if (m->options.pressure_gradient == ELLIPSOID_PRESSURE_DUDT)
    {
        for (int i = 0; i < 3; i++)
        {
            e->force[i] += m->fluid_mass
                         * ellipsoid_dot(e->flow.gradient[i], e->flow.velocity);
        }
    }
    else if (m->options.pressure_gradient == ELLIPSOID_PRESSURE_GRADP)
    {
        for (int i = 0; i < 3; i++)
        {
            e->force[i] -= m->volume * e->flow.pressure_gradient[i];
        }
    }
}

/* Derivatives [n][i] = dr_i/dq_n of the body axes, the columns of R(q). */
static void axis_derivatives(const double q[4], double d[4][3][3])
{
    const double a = 2 * q[0], b = 2 * q[1], c = 2 * q[2], n = 2 * q[3];
    const double table[4][3][3] = {
        {{a, b, c}, {b, -a, n}, {c, -n, -a}},
        {{-b, a, -n}, {a, b, c}, {n, c, -b}},
        {{-c, n, a}, {-n, -c, b}, {a, b, c}},
        {{n, c, -b}, {-c, n, a}, {b, -a, n}},
    };

    memcpy(d, table, sizeof(table));
}

/* Derivatives of the drag: F = sum_i r_i mu K^_i (r_i . slip). */
static void drag_blocks(evaluation *e, double d[4][3][3], ellipsoid_blocks *b)
{
    const ellipsoid_model *m = e->model;
    double scaled[3][3], resistance[3][3];

    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            scaled[i][j] = m->viscosity * m->resistance[i] * e->axis[i][j];
        }
    }
    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            resistance[i][j] = e->axis[0][i] * scaled[0][j]
                             + e->axis[1][i] * scaled[1][j]
                             + e->axis[2][i] * scaled[2][j];
            b->uu[i][j] -= resistance[i][j];
        }
    }
    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            b->ux[i][j] +=
                column_dot(e->flow.velocity_jacobian, j, resistance[i]);
        }
    }
    for (int n = 0; n < 4; n++)
    {
        double turned[3];

        for (int i = 0; i < 3; i++)
        {
            turned[i] = ellipsoid_dot(d[n][i], e->slip);
        }
        for (int i = 0; i < 3; i++)
        {
            b->uq[i][n] += column_dot(d[n], i, e->resisted)
                         + column_dot(scaled, i, turned);
        }
    }
}

/*
    Derivatives of Jeffery's torque. As T_i = r_k . (p G - m G^T) r_j, a change
    of the axes adds dr_k . (p G - m G^T) r_j + dr_j . (p G^T - m G) r_k.
*/
static void torque_blocks(evaluation *e, double d[4][3][3], ellipsoid_blocks *b)
{
    const ellipsoid_model *model = e->model;

    for (int i = 0; i < 3; i++)
    {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double c = model->viscosity * model->rotation_resistance[i];
        const double p = 0.5 * c * (1 + model->strain_factor[i]);
        const double m = 0.5 * c * (1 - model->strain_factor[i]);
        double other[3];

        for (int a = 0; a < 3; a++)
        {
            other[a] = p * column_dot(e->flow.gradient, a, e->axis[k])
                     - m * ellipsoid_dot(e->flow.gradient[a], e->axis[k]);
        }
        b->ww[i][i] -= c;
        for (int n = 0; n < 4; n++)
        {
            b->wq[i][n] += c * ellipsoid_dot(d[n][k], e->turning[i])
                         + ellipsoid_dot(d[n][j], other);
        }
        for (int s = 0; s < 3; s++)
        {
            for (int t = 0; t < 3; t++)
            {
                const double weight = p * e->axis[k][s] * e->axis[j][t]
                                    - m * e->axis[j][s] * e->axis[k][t];

                for (int l = 0; l < 3; l++)
                {
                    b->wx[i][l] += weight * e->flow.gradient_jacobian[s][t][l];
                }
            }
        }
    }
}

/* Derivatives of F_PG; the second derivatives of p are not sampled. */
static void pressure_gradient_blocks(evaluation *e, ellipsoid_blocks *b)
{
    const ellipsoid_model *m = e->model;

    if (m->options.pressure_gradient != ELLIPSOID_PRESSURE_DUDT)
    {
        return;
    }
    for (int i = 0; i < 3; i++)
    {
        for (int l = 0; l < 3; l++)
        {
            b->ux[i][l] +=
                m->fluid_mass
                * (column_dot(e->flow.gradient_jacobian[i], l, e->flow.velocity)
                   + column_dot(e->flow.velocity_jacobian, l,
                                e->flow.gradient[i]));
        }
    }
}

static void add_flow(evaluation *e, ellipsoid_blocks *blocks)
{
    if (e->model->options.drag)
    {
        add_drag(e);
        add_torque(e);
    }
    add_pressure_gradient(e);

    if (blocks)
    {
        if (e->model->options.drag)
        {
            double d[4][3][3];

            axis_derivatives(e->state->q, d);
            drag_blocks(e, d, blocks);
            torque_blocks(e, d, blocks);
        }
        pressure_gradient_blocks(e, blocks);
    }
}

/* F_W and T^_W. */
static ellipsoid_status add_contact(evaluation *e,
                                    const ellipsoid_surroundings *surroundings,
                                    ellipsoid_contact_cache *cache,
                                    ellipsoid_contact *contact,
                                    ellipsoid_blocks *b)
{
    ellipsoid_contact_jacobian jacobian;
    const ellipsoid_status status = ellipsoid_contact_evaluate(
        e->model, surroundings, e->state->x, e->state->q, cache, contact,
        b ? &jacobian : NULL);

    if (status != ELLIPSOID_OK)
    {
        return status;
    }
    for (int i = 0; i < 3; i++)
    {
        e->force[i] += contact->force[i];
        e->torque[i] += contact->torque[i];
    }
    if (b && contact->touching_beads > 0)
    {
        for (int i = 0; i < 3; i++)
        {
            for (int j = 0; j < 3; j++)
            {
                b->ux[i][j] += jacobian.force_x[i][j];
                b->wx[i][j] += jacobian.torque_x[i][j];
            }
            for (int n = 0; n < 4; n++)
            {
                b->uq[i][n] += jacobian.force_q[i][n];
                b->wq[i][n] += jacobian.torque_q[i][n];
            }
        }
    }
    return ELLIPSOID_OK;
}

/* Forces to accelerations, paper eqs. (1) and (3), and the kinematics. */
static ellipsoid_status finish_rates(const evaluation *e,
                                     ellipsoid_state *derivative)
{
    const double *inertia = e->model->inertia;
    const double *w = e->state->omega;
    const double per_mass = 1 / e->model->mass;
    double sum = 0;

    for (int i = 0; i < 3; i++)
    {
        const int j = (i + 1) % 3, k = (i + 2) % 3;

        derivative->u[i] = e->force[i] * per_mass;
        derivative->x[i] = e->state->u[i];
        derivative->omega[i] =
            (e->torque[i] + (inertia[j] - inertia[k]) * w[j] * w[k])
            / inertia[i];
        sum += derivative->u[i] + derivative->x[i] + derivative->omega[i];
    }
    ellipsoid_spin(w, e->state->q, derivative->q);
    for (int n = 0; n < 4; n++)
    {
        derivative->q[n] *= 0.5;
        sum += derivative->q[n];
    }
    return isfinite(sum) ? ELLIPSOID_OK : ELLIPSOID_NON_FINITE;
}

static void finish_blocks(const evaluation *e, ellipsoid_blocks *b)
{
    const double *inertia = e->model->inertia;
    const double *w = e->state->omega;
    const double per_mass = 1 / e->model->mass;

    for (int i = 0; i < 3; i++)
    {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double per_inertia = 1 / inertia[i];

        b->ww[i][j] += (inertia[j] - inertia[k]) * w[k];
        b->ww[i][k] += (inertia[j] - inertia[k]) * w[j];
        for (int l = 0; l < 3; l++)
        {
            b->uu[i][l] *= per_mass;
            b->ux[i][l] *= per_mass;
            b->ww[i][l] *= per_inertia;
            b->wx[i][l] *= per_inertia;
        }
        for (int n = 0; n < 4; n++)
        {
            b->uq[i][n] *= per_mass;
            b->wq[i][n] *= per_inertia;
        }
    }
}

ellipsoid_status ellipsoid_evaluate(const ellipsoid_model *model,
                                    const ellipsoid_surroundings *surroundings,
                                    const ellipsoid_state *state,
                                    ellipsoid_contact_cache *cache,
                                    ellipsoid_state *derivative,
                                    ellipsoid_contact *contact,
                                    ellipsoid_blocks *blocks)
{
    evaluation e;

    e.model = model;
    e.state = state;
    set_constant_forces(&e);
    if (blocks)
    {
        memset(blocks, 0, sizeof(*blocks));
    }
    if (surroundings->flow)
    {
        const double conjugate[4] = {-state->q[0], -state->q[1], -state->q[2],
                                     state->q[3]};
        const int answer = surroundings->flow(
            surroundings->flow_context, state->x, blocks != NULL, &e.flow);

        if (answer != 0)
        {
            return answer > 0 ? ELLIPSOID_STEP_UNDERFLOW
                              : ELLIPSOID_FLOW_FAILED;
        }
        ellipsoid_rotation_inline(conjugate, e.axis);
        add_flow(&e, blocks);
    }
    if (ellipsoid_has_walls(model, surroundings))
    {
        const ellipsoid_status status =
            add_contact(&e, surroundings, cache, contact, blocks);

        if (status != ELLIPSOID_OK)
        {
            return status;
        }
    }
    if (blocks)
    {
        finish_blocks(&e, blocks);
    }
    return finish_rates(&e, derivative);
}

ellipsoid_status ellipsoid_rhs(const ellipsoid_model *model,
                               const ellipsoid_surroundings *surroundings,
                               const ellipsoid_state *state,
                               ellipsoid_contact_cache *cache,
                               ellipsoid_state *derivative)
{
    ellipsoid_contact contact;

    return ellipsoid_evaluate(model, surroundings, state, cache, derivative,
                              &contact, NULL);
}

ellipsoid_status ellipsoid_jacobian(
    const ellipsoid_model *model, const ellipsoid_surroundings *surroundings,
    const ellipsoid_state *state, ellipsoid_contact_cache *cache,
    double jacobian[ELLIPSOID_STATE_SIZE][ELLIPSOID_STATE_SIZE])
{
    enum
    {
        U = 0,
        X = 3,
        W = 6,
        Q = 9
    };
    ellipsoid_contact contact;
    ellipsoid_state derivative;
    ellipsoid_blocks b;
    const ellipsoid_status status = ellipsoid_evaluate(
        model, surroundings, state, cache, &derivative, &contact, &b);
    const double *w = state->omega, *q = state->q;
    /* 1/2 Q(omega) and the derivative of 1/2 Q(omega) q by omega */
    const double qq[4][4] = {{0, w[2], -w[1], w[0]},
                             {-w[2], 0, w[0], w[1]},
                             {w[1], -w[0], 0, w[2]},
                             {-w[0], -w[1], -w[2], 0}};
    const double qw[4][3] = {{q[3], -q[2], q[1]},
                             {q[2], q[3], -q[0]},
                             {-q[1], q[0], q[3]},
                             {-q[0], -q[1], -q[2]}};

    if (status != ELLIPSOID_OK)
    {
        return status;
    }
    memset(jacobian, 0,
           sizeof(double[ELLIPSOID_STATE_SIZE][ELLIPSOID_STATE_SIZE]));
    for (int i = 0; i < 3; i++)
    {
        memcpy(&jacobian[U + i][U], b.uu[i], sizeof(b.uu[i]));
        memcpy(&jacobian[U + i][X], b.ux[i], sizeof(b.ux[i]));
        memcpy(&jacobian[U + i][Q], b.uq[i], sizeof(b.uq[i]));
        jacobian[X + i][U + i] = 1;
        memcpy(&jacobian[W + i][X], b.wx[i], sizeof(b.wx[i]));
        memcpy(&jacobian[W + i][W], b.ww[i], sizeof(b.ww[i]));
        memcpy(&jacobian[W + i][Q], b.wq[i], sizeof(b.wq[i]));
    }
    for (int n = 0; n < 4; n++)
    {
        for (int l = 0; l < 3; l++)
        {
            jacobian[Q + n][W + l] = 0.5 * qw[n][l];
        }
        for (int l = 0; l < 4; l++)
        {
            jacobian[Q + n][Q + l] = 0.5 * qq[n][l];
        }
    }
    return ELLIPSOID_OK;
}
