/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    stokesDrag.h - the drag of a body far from walls, and its derivatives,
    inlined into the one file that evaluates the equations.

    The flow acts through the motion that it would give a body free of other
    forces, u_free and omega_free:
        F_H = mu R K^ R^T (u_free - u),   T^_H,i = mu C_i (omega_free,i - w^_i)
    and without inertia all other forces are balanced by these.
*/
#ifndef ELLIPSOID_STOKES_DRAG_H
#define ELLIPSOID_STOKES_DRAG_H

#include "drag/drag.h"

#include <string.h>

/* What one evaluation shares between values and derivatives. */
typedef struct evaluation
{
    const ellipsoid_model *model;
    const ellipsoid_state *state;
    ellipsoid_flow_sample *flow;
    ellipsoid_free_motion free;
    double axis[3][3];    /* r_i: body axes in the lab, the columns of R(q) */
    double stretch[3][3]; /* G r_i; of FLOW_CENTRE */
    ellipsoid_body_wrench wrench;
} evaluation;

/* ----------------------------------------------------- flow at the centre */

/*
    Jeffery (1922), eqs. 36: omega_free,i = s_i e^_jk + W^_i, i, j, k cyclic.
    With G^ = R^T G R that is p G^_kj - m G^_jk, p = (1 + s_i)/2,
    m = (1 - s_i)/2: strain and vorticity merge.
*/
INLINED double free_spin_about(const evaluation *e, int i, int j, int k)
{
    const double p = 0.5 + 0.5 * e->model->strain_factor[i];
    const double m = 0.5 - 0.5 * e->model->strain_factor[i];

    return p * ellipsoid_dot(e->axis[k], e->stretch[j])
         - m * ellipsoid_dot(e->axis[j], e->stretch[k]);
}

INLINED void set_free_motion(evaluation *e)
{
    ellipsoid_product(e->flow->gradient, e->axis[0], e->stretch[0]);
    ellipsoid_product(e->flow->gradient, e->axis[1], e->stretch[1]);
    ellipsoid_product(e->flow->gradient, e->axis[2], e->stretch[2]);
    ellipsoid_set(e->free.u, e->flow->velocity[0], e->flow->velocity[1],
                  e->flow->velocity[2]);
    ellipsoid_set(e->free.omega, free_spin_about(e, 0, 1, 2),
                  free_spin_about(e, 1, 2, 0), free_spin_about(e, 2, 0, 1));
}

/*
    As omega_free,i = r_k . (p G - m G^T) r_j, a change of the axes adds
    dr_k . (p G - m G^T) r_j + dr_j . (p G^T - m G) r_k.
*/
INLINED void free_spin_derivatives(evaluation *e, double d[4][3][3],
                                   double back[3][3], double change[3][3][3],
                                   int i, int j, int k)
{
    const double p = 0.5 + 0.5 * e->model->strain_factor[i];
    const double m = 0.5 - 0.5 * e->model->strain_factor[i];
    const double *rj = e->axis[j], *rk = e->axis[k];
    double by_j[3], by_k[3], with[3], against[3];

    for (int l = 0; l < 3; l++)
    {
        by_k[l] = p * e->stretch[j][l] - m * back[j][l];
        by_j[l] = p * back[k][l] - m * e->stretch[k][l];
    }
    for (int n = 0; n < 4; n++)
    {
        e->free.omega_q[i][n] =
            ellipsoid_dot(d[n][k], by_k) + ellipsoid_dot(d[n][j], by_j);
    }
    ellipsoid_combination(change[j], p * rk[0], p * rk[1], p * rk[2], with);
    ellipsoid_combination(change[k], m * rj[0], m * rj[1], m * rj[2], against);
    for (int l = 0; l < 3; l++)
    {
        e->free.omega_x[i][l] = with[l] - against[l];
    }
}

static void set_free_derivatives(evaluation *e, double d[4][3][3])
{
    double back[3][3];      /* G^T r_i */
    double change[3][3][3]; /* [i][s][l]: sum_t dG_st/dx_l r_i[t] */

    memcpy(e->free.u_x, e->flow->velocity_jacobian, sizeof(e->free.u_x));
    for (int i = 0; i < 3; i++)
    {
        const double *r = e->axis[i];

        ellipsoid_combination(e->flow->gradient, r[0], r[1], r[2], back[i]);
        for (int s = 0; s < 3; s++)
        {
            ellipsoid_combination(e->flow->gradient_jacobian[s], r[0], r[1],
                                  r[2], change[i][s]);
        }
    }
    free_spin_derivatives(e, d, back, change, 0, 1, 2);
    free_spin_derivatives(e, d, back, change, 1, 2, 0);
    free_spin_derivatives(e, d, back, change, 2, 0, 1);
}

/* ------------------------------------------------------------------ drag */

/* u and omega with which the drag balances all other forces. */
INLINED void balance(evaluation *e, double u[3], double omega[3])
{
    const double *m = e->model->mobility, *w = e->model->rotation_mobility;
    double slip[3];

    ellipsoid_combination(
        e->axis, m[0] * ellipsoid_dot(e->axis[0], e->wrench.force),
        m[1] * ellipsoid_dot(e->axis[1], e->wrench.force),
        m[2] * ellipsoid_dot(e->axis[2], e->wrench.force), slip);
    ellipsoid_set(u, e->free.u[0] + slip[0], e->free.u[1] + slip[1],
                  e->free.u[2] + slip[2]);
    ellipsoid_set(omega, e->free.omega[0] + w[0] * e->wrench.torque[0],
                  e->free.omega[1] + w[1] * e->wrench.torque[1],
                  e->free.omega[2] + w[2] * e->wrench.torque[2]);
}

/* Oberbeck (1876), Jeffery (1922), Brenner (1964): see above. */
INLINED void add_drag(evaluation *e, double slip[3], double resisted[3])
{
    const double mu = e->model->viscosity, *k = e->model->resistance;
    const double *c = e->model->rotation_resistance;
    const double *free_u = e->free.u, *free_w = e->free.omega;
    const double *u = e->state->u, *w = e->state->omega;
    double force[3];

    ellipsoid_set(slip, free_u[0] - u[0], free_u[1] - u[1], free_u[2] - u[2]);
    ellipsoid_set(resisted, mu * k[0] * ellipsoid_dot(e->axis[0], slip),
                  mu * k[1] * ellipsoid_dot(e->axis[1], slip),
                  mu * k[2] * ellipsoid_dot(e->axis[2], slip));
    ellipsoid_combination(e->axis, resisted[0], resisted[1], resisted[2],
                          force);
    ellipsoid_add(e->wrench.force, force);
    e->wrench.torque[0] += mu * c[0] * (free_w[0] - w[0]);
    e->wrench.torque[1] += mu * c[1] * (free_w[1] - w[1]);
    e->wrench.torque[2] += mu * c[2] * (free_w[2] - w[2]);
}

/* Derivatives of F = sum_i r_i mu K^_i (r_i . slip) and of T^. */
static void add_drag_blocks(evaluation *e, double d[4][3][3],
                            const double slip[3], const double resisted[3],
                            ellipsoid_jacobian_blocks *b)
{
    const ellipsoid_model *m = e->model;
    double scaled[3][3];

    for (int i = 0; i < 3; i++)
    {
        const double k = m->viscosity * m->resistance[i];

        ellipsoid_set(scaled[i], k * e->axis[i][0], k * e->axis[i][1],
                      k * e->axis[i][2]);
    }
    for (int i = 0; i < 3; i++)
    {
        const double c = m->viscosity * m->rotation_resistance[i];
        double row[3], by_x[3];

        ellipsoid_combination(scaled, e->axis[0][i], e->axis[1][i],
                              e->axis[2][i], row);
        ellipsoid_combination(e->free.u_x, row[0], row[1], row[2], by_x);
        for (int l = 0; l < 3; l++)
        {
            b->uu[i][l] -= row[l];
            b->ux[i][l] += by_x[l];
            b->wx[i][l] += c * e->free.omega_x[i][l];
        }
        for (int n = 0; n < 4; n++)
        {
            b->wq[i][n] += c * e->free.omega_q[i][n];
            if (m->flow_points > 0)
            {
                b->uq[i][n] += row[0] * e->free.u_q[0][n]
                             + row[1] * e->free.u_q[1][n]
                             + row[2] * e->free.u_q[2][n];
            }
        }
        b->ww[i][i] -= c;
    }
    for (int n = 0; n < 4; n++)
    {
        double turned[3], moved[3], carried[3];

        ellipsoid_product(d[n], slip, turned);
        ellipsoid_combination(d[n], resisted[0], resisted[1], resisted[2],
                              moved);
        ellipsoid_combination(scaled, turned[0], turned[1], turned[2], carried);
        b->uq[0][n] += moved[0] + carried[0];
        b->uq[1][n] += moved[1] + carried[1];
        b->uq[2][n] += moved[2] + carried[2];
    }
}

#endif
