/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    bodyForces.c - what acts on the body besides drag and contact.
*/
#include "motion/motion.h"

/* F_PG = -V grad p and, if wanted, its derivatives; of the other F_PG these alone:
   it is in equations.c, where it costs less. */
static void add_pressure_gradient(const ellipsoid_model *m, int unsteady,
                                  ellipsoid_flow_sample *flow, double force[3],
                                  ellipsoid_jacobian_blocks *b)
{
    const ellipsoid_pressure_gradient kind = m->options.pressure_gradient;
    const double *u = flow->velocity;

    if (kind == ELLIPSOID_PRESSURE_GRADP)
    {
        ellipsoid_add_times(force, -m->volume, flow->pressure_gradient);
    }
    for (int i = 0; b && i < 3; i++)
    {
        if (kind == ELLIPSOID_PRESSURE_DUDT)
        {
            const double *g = flow->gradient[i];
            double change[3], of_velocity[3];

            ellipsoid_combination(flow->gradient_jacobian[i], u[0], u[1], u[2],
                                  change);
            ellipsoid_combination(flow->velocity_jacobian, g[0], g[1], g[2],
                                  of_velocity);
            ellipsoid_add(change, of_velocity);
            ellipsoid_add_times(b->ux[i], m->fluid_mass, change);
            if (unsteady)
            {
                ellipsoid_add_times(b->ux[i], m->fluid_mass,
                                    flow->acceleration_jacobian[i]);
            }
        }
        else if (kind == ELLIPSOID_PRESSURE_GRADP)
        {
            ellipsoid_add_times(b->ux[i], -m->volume,
                                flow->pressure_jacobian[i]);
        }
    }
}

/* R^T v = (r_1 . v, r_2 . v, r_3 . v) */
static void add_torque_of_dipole(const double dipole[3], double axis[3][3],
                                 const double v[3], double torque[3])
{
    double body[3], turning[3];

    ellipsoid_product(axis, v, body);
    ellipsoid_cross(dipole, body, turning);
    ellipsoid_add(torque, turning);
}

/* F_E = charge E (paper eq. (1), second form), T^_E = dipole x R^T E. */
static ellipsoid_status add_electric(const ellipsoid_model *m,
                                     const ellipsoid_surroundings *surroundings,
                                     const double x[3], ellipsoid_frame *frame,
                                     ellipsoid_body_wrench *wrench,
                                     ellipsoid_jacobian_blocks *b)
{
    const ellipsoid_options *o = &m->options;
    double field[3] = {0, 0, 0}, jacobian[3][3] = {{0}};

    if (surroundings->field)
    {
        const int answer =
            surroundings->field(surroundings->field_context, surroundings->time,
                                x, field, b ? jacobian : NULL);

        if (answer != 0)
        {
            return ellipsoid_answer_status(answer);
        }
    }
    ellipsoid_add(field, o->electric_field);
    ellipsoid_add_times(wrench->force, o->charge, field);
    add_torque_of_dipole(o->dipole, frame->axis, field, wrench->torque);

    for (int l = 0; b && l < 3; l++)
    {
        const double column[3] = {jacobian[0][l], jacobian[1][l],
                                  jacobian[2][l]};
        double turning[3] = {0, 0, 0};

        add_torque_of_dipole(o->dipole, frame->axis, column, turning);
        for (int i = 0; i < 3; i++)
        {
            b->ux[i][l] += o->charge * column[i];
            b->wx[i][l] += turning[i];
        }
    }
    for (int n = 0; b && n < 4; n++)
    {
        double turning[3] = {0, 0, 0};

        add_torque_of_dipole(o->dipole, frame->by_q[n], field, turning);
        for (int i = 0; i < 3; i++)
        {
            b->wq[i][n] += turning[i];
        }
    }
    return ELLIPSOID_OK;
}

/* The external force and torque of a callback. */
static ellipsoid_status add_external(const ellipsoid_surroundings *surroundings,
                                     const ellipsoid_state *state,
                                     ellipsoid_body_wrench *wrench,
                                     ellipsoid_jacobian_blocks *b)
{
    static const double ones[3] = {1, 1, 1};
    double more[3] = {0, 0, 0}, turning[3] = {0, 0, 0};
    ellipsoid_wrench_jacobian jacobian = {.force_x = {{0}}};
    const int answer =
        surroundings->force(surroundings->force_context, surroundings->time,
                            state, more, turning, b ? &jacobian : NULL);

    if (answer != 0)
    {
        return answer > 0 ? ELLIPSOID_STEP_UNDERFLOW : ELLIPSOID_FORCE_FAILED;
    }
    ellipsoid_add(wrench->force, more);
    ellipsoid_add(wrench->torque, turning);
    if (b)
    {
        ellipsoid_add_to_blocks(&jacobian, 1, ones, b);
    }
    return ELLIPSOID_OK;
}

ellipsoid_status ellipsoid_add_body_forces(
    const ellipsoid_model *model, const ellipsoid_surroundings *surroundings,
    const ellipsoid_state *state, ellipsoid_frame *frame,
    ellipsoid_flow_sample *flow, ellipsoid_body_wrench *wrench,
    ellipsoid_jacobian_blocks *blocks)
{
    ellipsoid_status status = ELLIPSOID_OK;

    if (flow)
    {
        add_pressure_gradient(model, surroundings->unsteady, flow,
                              wrench->force, blocks);
    }
    if (model->electric)
    {
        status =
            add_electric(model, surroundings, state->x, frame, wrench, blocks);
    }
    if (status == ELLIPSOID_OK && surroundings->force)
    {
        status = add_external(surroundings, state, wrench, blocks);
    }
    return status;
}
