/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    rhs.c - right-hand side, balanced motion, drag and dense Jacobian
    for callers; the integrator uses the blocks of equations.c as they are.
*/
#include "motion/motion.h"

#include <string.h>

/* The equations, without noise; only what is read of the evaluation is set. */
static ellipsoid_status evaluate(const ellipsoid_model *model,
                                 const ellipsoid_surroundings *surroundings,
                                 const ellipsoid_state *state,
                                 ellipsoid_facet_cache *cache, int with_blocks,
                                 ellipsoid_evaluation *at)
{
    ellipsoid_statistics unused = {0};
    const ellipsoid_cell cell = {.model = model,
                                 .surroundings = *surroundings,
                                 .cache = cache,
                                 .statistics = &unused,
                                 .inertial = model->options.motion
                                          == ELLIPSOID_MOTION_INERTIAL};

    at->state = *state;
    at->contact = ellipsoid_no_contact();
    return ellipsoid_evaluate(&cell, at, 0, with_blocks);
}

ellipsoid_status ellipsoid_rhs(const ellipsoid_model *model,
                               const ellipsoid_surroundings *surroundings,
                               const ellipsoid_state *state,
                               ellipsoid_facet_cache *cache,
                               ellipsoid_state *derivative)
{
    ellipsoid_state balanced = *state;
    ellipsoid_evaluation at;
    ellipsoid_status status;

    if (model->options.motion == ELLIPSOID_MOTION_INERTIALESS)
    {
        return surroundings->flow ? ellipsoid_force_balance(
                   model, surroundings, &balanced, cache, derivative)
                                  : ELLIPSOID_BAD_OPTION;
    }
    status = evaluate(model, surroundings, state, cache, 0, &at);
    if (status == ELLIPSOID_OK)
    {
        *derivative = at.derivative;
    }
    return status;
}

ellipsoid_status ellipsoid_balance(const ellipsoid_model *model,
                                   const ellipsoid_surroundings *surroundings,
                                   ellipsoid_state *state,
                                   ellipsoid_facet_cache *cache)
{
    ellipsoid_state derivative;

    return surroundings->flow && model->options.drag ? ellipsoid_force_balance(
               model, surroundings, state, cache, &derivative)
                                                     : ELLIPSOID_BAD_OPTION;
}

void ellipsoid_drag_at_rest(const ellipsoid_model *model, const double q[4],
                            const double velocity[3], double drag[3])
{
    double r[3][3], along[3];

    ellipsoid_rotation_inline(q, r);
    ellipsoid_to_body(r, velocity, along);
    for (int i = 0; i < 3; i++)
    {
        along[i] *= model->viscosity * model->resistance[i];
    }
    ellipsoid_product(r, along, drag);
}

ellipsoid_status
ellipsoid_jacobian(const ellipsoid_model *model,
                   const ellipsoid_surroundings *surroundings,
                   const ellipsoid_state *state, ellipsoid_facet_cache *cache,
                   double jacobian[ELLIPSOID_STATE_SIZE][ELLIPSOID_STATE_SIZE])
{
    ellipsoid_evaluation at;
    const ellipsoid_jacobian_blocks *b = &at.blocks;
    const ellipsoid_status status =
        evaluate(model, surroundings, state, cache, 1, &at);

    if (status != ELLIPSOID_OK)
    {
        return status;
    }
    memset(jacobian, 0,
           sizeof(double[ELLIPSOID_STATE_SIZE][ELLIPSOID_STATE_SIZE]));
    for (int i = 0; i < 3; i++)
    {
        memcpy(&jacobian[AT_U + i][AT_U], b->uu[i], sizeof(b->uu[i]));
        memcpy(&jacobian[AT_U + i][AT_X], b->ux[i], sizeof(b->ux[i]));
        memcpy(&jacobian[AT_U + i][AT_OMEGA], b->uw[i], sizeof(b->uw[i]));
        memcpy(&jacobian[AT_U + i][AT_Q], b->uq[i], sizeof(b->uq[i]));
        jacobian[AT_X + i][AT_U + i] = 1;
        memcpy(&jacobian[AT_OMEGA + i][AT_U], b->wu[i], sizeof(b->wu[i]));
        memcpy(&jacobian[AT_OMEGA + i][AT_X], b->wx[i], sizeof(b->wx[i]));
        memcpy(&jacobian[AT_OMEGA + i][AT_OMEGA], b->ww[i], sizeof(b->ww[i]));
        memcpy(&jacobian[AT_OMEGA + i][AT_Q], b->wq[i], sizeof(b->wq[i]));
    }
    for (int l = 0; l < 4; l++) /* of 1/2 Q(omega) q */
    {
        const double unit[4] = {l == 0, l == 1, l == 2, l == 3};
        double by_q[4], by_omega[4];

        ellipsoid_spin(state->omega, unit, by_q);
        ellipsoid_spin(unit, state->q, by_omega);
        for (int n = 0; n < 4; n++)
        {
            jacobian[AT_Q + n][AT_Q + l] = 0.5 * by_q[n];
            if (l < 3)
            {
                jacobian[AT_Q + n][AT_OMEGA + l] = 0.5 * by_omega[n];
            }
        }
    }
    return ELLIPSOID_OK;
}
