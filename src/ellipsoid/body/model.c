/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    model.c - what follows from the options once and for all.
*/
#include "body/body.h"
#include "body/planeTable.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/* Fluctuation and dissipation, see brownian.c. */
static void set_noise_scales(ellipsoid_model *model)
{
    const ellipsoid_options *o = &model->options;
    const double power = 2 * ELLIPSOID_BOLTZMANN * o->temperature
                       * model->viscosity / o->noise_interval;

    for (int i = 0; i < 3; i++)
    {
        model->noise_force[i] = sqrt(power * model->resistance[i]);
        model->noise_torque[i] = sqrt(power * model->rotation_resistance[i]);
    }
}

/* The farthest surface that a wall can touch. */
static double contact_reach(const ellipsoid_model *model)
{
    double farthest = 0;

    for (int b = 0; b < model->bead_count; b++)
    {
        const double *c = model->bead[b];

        farthest = fmax(farthest, ellipsoid_dot(c, c));
    }
    return sqrt(farthest) + model->options.bead_radius;
}

size_t ellipsoid_model_size(void) { return sizeof(ellipsoid_model); }

ellipsoid_status ellipsoid_model_init(ellipsoid_model *model,
                                      const ellipsoid_options *options)
{
    ellipsoid_model m = {0};
    const double *a;

    if (!model || !options)
    {
        return ELLIPSOID_BAD_ARGUMENT;
    }
    a = options->semi_axes;
    if (ellipsoid_options_check(options, NULL, NULL) != ELLIPSOID_OK)
    {
        return ELLIPSOID_BAD_OPTION;
    }

    m.options = *options;
    m.wall_range = ellipsoid_wall_range(options);
    m.volume = 4 * pi / 3 * a[0] * a[1] * a[2];
    m.mass = options->density * m.volume;
    m.fluid_mass = options->fluid_density * m.volume;
    m.viscosity = options->fluid_density * options->kinematic_viscosity;
    ellipsoid_resistance(a, m.resistance, m.rotation_resistance);

    for (int i = 0; i < 3; i++)
    {
        const double aj = a[(i + 1) % 3], ak = a[(i + 2) % 3];
        const double sum = aj * aj + ak * ak;

        m.inertia[i] = m.mass / 5 * sum;
        /* a product, so that a near-sphere keeps its digits */
        m.strain_factor[i] = (aj - ak) * (aj + ak) / sum;
        m.constant_force[i] = options->external_force[i];
        if (options->buoyancy)
        {
            m.constant_force[i] +=
                (m.mass - m.fluid_mass) * options->gravity[i];
        }
        m.mobility[i] = 1 / (m.viscosity * m.resistance[i]);
        m.rotation_mobility[i] = 1 / (m.viscosity * m.rotation_resistance[i]);
        m.relaxation_time = fmax(m.relaxation_time, m.mass * m.mobility[i]);
        m.rotation_relaxation_time = fmax(
            m.rotation_relaxation_time, m.inertia[i] * m.rotation_mobility[i]);
    }

    if (options->flow_at == ELLIPSOID_FLOW_BODY)
    {
        ellipsoid_surface_quadrature(&m);
    }
    if (m.wall_range > 0)
    {
        ellipsoid_plane_table_set(a, &m.plane);
    }
    if (options->brownian)
    {
        set_noise_scales(&m);
    }
    m.has_dipole = options->dipole[0] != 0 || options->dipole[1] != 0
                || options->dipole[2] != 0;
    m.electric = options->charge != 0 || m.has_dipole;

    m.reach = ellipsoid_largest(a);
    if (options->contact)
    {
        m.dissipative = options->friction > 0 || options->contact_damping > 0;
        m.bead_count = ellipsoid_beads(options, m.bead);
        /* of the ellipsoid, too, if that is what meets the walls */
        m.reach = options->contact_shape == ELLIPSOID_CONTACT_ELLIPSOID
                    ? fmax(m.reach, contact_reach(&m))
                    : contact_reach(&m);
    }

    *model = m;
    return ELLIPSOID_OK;
}
