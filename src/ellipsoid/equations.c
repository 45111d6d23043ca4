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

/*
    The small loops over three components are written out where speed counts:
    compilers then keep the numbers in registers.
*/
static inline void set3(double v[3], double a, double b, double c)
{
    v[0] = a;
    v[1] = b;
    v[2] = c;
}

/* m v; m is not const as C11 would not take a plain matrix then. */
static inline void product(double m[3][3], const double v[3], double result[3])
{
    set3(result, ellipsoid_dot(m[0], v), ellipsoid_dot(m[1], v),
         ellipsoid_dot(m[2], v));
}

/* m^T v = a m_0 + b m_1 + c m_2 */
static inline void combination(double m[3][3], double a, double b, double c,
                               double result[3])
{
    set3(result, a * m[0][0] + b * m[1][0] + c * m[2][0],
         a * m[0][1] + b * m[1][1] + c * m[2][1],
         a * m[0][2] + b * m[1][2] + c * m[2][2]);
}

static inline double sum3(const double v[3])
{
    return v[0] + v[1] + v[2];
}

static inline void add3(double v[3], const double change[3])
{
    v[0] += change[0];
    v[1] += change[1];
    v[2] += change[2];
}

/* What one evaluation shares between values and derivatives. */
typedef struct evaluation
{
    const ellipsoid_model *model;
    const ellipsoid_state *state;
    ellipsoid_flow_sample flow;
    double axis[3][3];      /* r_i: body axes in the lab, the columns of R(q) */
    double slip[3];         /* u_f - u, lab */
    double resisted[3];     /* mu K^ R^T (u_f - u), body */
    double stretch[3][3];   /* G r_i */
    double back[3][3];      /* G^T r_i; only for the Jacobian */
    double change[3][3][3]; /* [i][s][l]: sum_t dG_st/dx_l r_i[t]; likewise */
    double force[3];        /* lab */
    double torque[3];       /* body */
} evaluation;

/* (m_p - m_f) g and the constant external force and torque. */
static void set_constant_forces(const ellipsoid_model *m, double force[3],
                                double torque[3])
{
    const ellipsoid_options *o = &m->options;
    const double weight = o->buoyancy ? m->mass - m->fluid_mass : 0;

    set3(force, weight * o->gravity[0] + o->external_force[0],
         weight * o->gravity[1] + o->external_force[1],
         weight * o->gravity[2] + o->external_force[2]);
    set3(torque, o->external_torque[0], o->external_torque[1],
         o->external_torque[2]);
}

/* F_H = mu R K^ R^T (u_f - u): Oberbeck (1876), Brenner (1964). */
static inline void add_drag(evaluation *e)
{
    const double mu = e->model->viscosity, *k = e->model->resistance;
    const double *u_f = e->flow.velocity, *u = e->state->u;
    double force[3], *slip = e->slip, *body = e->resisted;

    set3(slip, u_f[0] - u[0], u_f[1] - u[1], u_f[2] - u[2]);
    set3(body, mu * k[0] * ellipsoid_dot(e->axis[0], slip),
         mu * k[1] * ellipsoid_dot(e->axis[1], slip),
         mu * k[2] * ellipsoid_dot(e->axis[2], slip));
    combination(e->axis, body[0], body[1], body[2], force);
    add3(e->force, force);
}

/*
    Jeffery (1922), eqs. 36: T^_i = mu C_i (s_i e^_jk + W^_i - w^_i), i, j, k
    cyclic. With G^ = R^T G R that is mu C_i (p G^_kj - m G^_jk - w^_i),
    p = (1 + s_i)/2, m = (1 - s_i)/2: strain and vorticity merge.
*/
static inline double torque_about(const evaluation *e, int i, int j, int k)
{
    const ellipsoid_model *model = e->model;
    const double p = 0.5 + 0.5 * model->strain_factor[i];
    const double m = 0.5 - 0.5 * model->strain_factor[i];

    return model->viscosity * model->rotation_resistance[i]
         * (p * ellipsoid_dot(e->axis[k], e->stretch[j])
            - m * ellipsoid_dot(e->axis[j], e->stretch[k])
            - e->state->omega[i]);
}

static inline void add_torque(evaluation *e)
{
    product(e->flow.gradient, e->axis[0], e->stretch[0]);
    product(e->flow.gradient, e->axis[1], e->stretch[1]);
    product(e->flow.gradient, e->axis[2], e->stretch[2]);
    e->torque[0] += torque_about(e, 0, 1, 2);
    e->torque[1] += torque_about(e, 1, 2, 0);
    e->torque[2] += torque_about(e, 2, 0, 1);
}

/* F_PG: m_f (u_f . grad) u_f, or -V grad p. */
static inline void add_pressure_gradient(evaluation *e)
{
    const ellipsoid_model *m = e->model;

    if (m->options.pressure_gradient == ELLIPSOID_PRESSURE_DUDT)
    {
        const double *u_f = e->flow.velocity;

        e->force[0] += m->fluid_mass * ellipsoid_dot(e->flow.gradient[0], u_f);
        e->force[1] += m->fluid_mass * ellipsoid_dot(e->flow.gradient[1], u_f);
        e->force[2] += m->fluid_mass * ellipsoid_dot(e->flow.gradient[2], u_f);
    }
    else if (m->options.pressure_gradient == ELLIPSOID_PRESSURE_GRADP)
    {
        e->force[0] -= m->volume * e->flow.pressure_gradient[0];
        e->force[1] -= m->volume * e->flow.pressure_gradient[1];
        e->force[2] -= m->volume * e->flow.pressure_gradient[2];
    }
}

/* Derivatives [n][i] = dr_i/dq_n of the body axes, the columns of R(q). */
static inline void axis_derivatives(const double q[4], double d[4][3][3])
{
    const double a = 2 * q[0], b = 2 * q[1], c = 2 * q[2], n = 2 * q[3];

    set3(d[0][0], a, b, c);
    set3(d[0][1], b, -a, n);
    set3(d[0][2], c, -n, -a);
    set3(d[1][0], -b, a, -n);
    set3(d[1][1], a, b, c);
    set3(d[1][2], n, c, -b);
    set3(d[2][0], -c, n, a);
    set3(d[2][1], -n, -c, b);
    set3(d[2][2], a, b, c);
    set3(d[3][0], n, c, -b);
    set3(d[3][1], -c, n, a);
    set3(d[3][2], b, -a, n);
}

/* Derivatives of the drag: F = sum_i r_i mu K^_i (r_i . slip). */
static void drag_blocks(evaluation *e, double d[4][3][3], ellipsoid_blocks *b)
{
    const ellipsoid_model *m = e->model;
    const double *f = e->resisted;
    double scaled[3][3];

    for (int i = 0; i < 3; i++)
    {
        const double k = m->viscosity * m->resistance[i];

        set3(scaled[i], k * e->axis[i][0], k * e->axis[i][1],
             k * e->axis[i][2]);
    }
    for (int i = 0; i < 3; i++)
    {
        double row[3];

        combination(scaled, e->axis[0][i], e->axis[1][i], e->axis[2][i], row);
        set3(b->uu[i], -row[0], -row[1], -row[2]);
        combination(e->flow.velocity_jacobian, row[0], row[1], row[2],
                    b->ux[i]);
    }
    for (int n = 0; n < 4; n++)
    {
        double turned[3], moved[3], carried[3];

        product(d[n], e->slip, turned);
        combination(d[n], f[0], f[1], f[2], moved);
        combination(scaled, turned[0], turned[1], turned[2], carried);
        b->uq[0][n] = moved[0] + carried[0];
        b->uq[1][n] = moved[1] + carried[1];
        b->uq[2][n] = moved[2] + carried[2];
    }
}

/*
    Derivatives of Jeffery's torque. As T_i = r_k . (p G - m G^T) r_j, a change
    of the axes adds dr_k . (p G - m G^T) r_j + dr_j . (p G^T - m G) r_k.
*/
static inline void torque_blocks_about(evaluation *e, double d[4][3][3],
                                       ellipsoid_blocks *b, int i, int j, int k)
{
    const ellipsoid_model *model = e->model;
    const double c = model->viscosity * model->rotation_resistance[i];
    const double p = c * (0.5 + 0.5 * model->strain_factor[i]);
    const double m = c * (0.5 - 0.5 * model->strain_factor[i]);
    const double *rj = e->axis[j], *rk = e->axis[k];
    double by_j[3], by_k[3], with[3], against[3];

    for (int l = 0; l < 3; l++)
    {
        by_k[l] = p * e->stretch[j][l] - m * e->back[j][l];
        by_j[l] = p * e->back[k][l] - m * e->stretch[k][l];
    }
    for (int n = 0; n < 4; n++)
    {
        b->wq[i][n] =
            ellipsoid_dot(d[n][k], by_k) + ellipsoid_dot(d[n][j], by_j);
    }
    combination(e->change[j], p * rk[0], p * rk[1], p * rk[2], with);
    combination(e->change[k], m * rj[0], m * rj[1], m * rj[2], against);
    for (int l = 0; l < 3; l++)
    {
        b->wx[i][l] = with[l] - against[l];
        b->ww[i][l] = 0;
    }
    b->ww[i][i] = -c;
}

static void torque_blocks(evaluation *e, double d[4][3][3], ellipsoid_blocks *b)
{
    for (int i = 0; i < 3; i++)
    {
        const double *r = e->axis[i];

        combination(e->flow.gradient, r[0], r[1], r[2], e->back[i]);
        for (int s = 0; s < 3; s++)
        {
            combination(e->flow.gradient_jacobian[s], r[0], r[1], r[2],
                        e->change[i][s]);
        }
    }
    torque_blocks_about(e, d, b, 0, 1, 2);
    torque_blocks_about(e, d, b, 1, 2, 0);
    torque_blocks_about(e, d, b, 2, 0, 1);
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
        const double *u = e->flow.velocity, *g = e->flow.gradient[i];
        double of_gradient[3], of_velocity[3];

        combination(e->flow.gradient_jacobian[i], u[0], u[1], u[2],
                    of_gradient);
        combination(e->flow.velocity_jacobian, g[0], g[1], g[2], of_velocity);
        for (int l = 0; l < 3; l++)
        {
            b->ux[i][l] += m->fluid_mass * (of_gradient[l] + of_velocity[l]);
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

/* I w x w */
static inline double gyroscopic(const double inertia[3], const double w[3],
                                int j, int k)
{
    return (inertia[j] - inertia[k]) * w[j] * w[k];
}

/* Forces to accelerations, paper eqs. (1) and (3), and the kinematics. */
static inline ellipsoid_status finish_rates(const evaluation *e,
                                            ellipsoid_state *derivative)
{
    const double *inertia = e->model->inertia, *f = e->force, *t = e->torque;
    const double *w = e->state->omega;
    const double per_mass = 1 / e->model->mass;
    double q[4];

    set3(derivative->u, f[0] * per_mass, f[1] * per_mass, f[2] * per_mass);
    set3(derivative->x, e->state->u[0], e->state->u[1], e->state->u[2]);
    set3(derivative->omega, (t[0] + gyroscopic(inertia, w, 1, 2)) / inertia[0],
         (t[1] + gyroscopic(inertia, w, 2, 0)) / inertia[1],
         (t[2] + gyroscopic(inertia, w, 0, 1)) / inertia[2]);
    ellipsoid_spin(w, e->state->q, q);
    for (int n = 0; n < 4; n++)
    {
        derivative->q[n] = 0.5 * q[n];
    }

    /* one NaN or infinity makes the sum one */
    return isfinite(sum3(derivative->u) + sum3(derivative->x)
                    + sum3(derivative->omega) + sum3(q) + q[3])
             ? ELLIPSOID_OK
             : ELLIPSOID_NON_FINITE;
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
    set_constant_forces(model, e.force, e.torque);
    if (blocks && !(surroundings->flow && model->options.drag))
    {
        memset(blocks, 0, sizeof(*blocks));
    }
    if (surroundings->flow)
    {
        const double *q = state->q;
        const double conjugate[4] = {q[0], q[1], q[2],
                                     -q[3]}; /* or its minus */
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
