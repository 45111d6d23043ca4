/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    options.c - defaults (here and nowhere else) and their checker.
*/
#include "ellipsoid.h"

#include <math.h>

ellipsoid_options ellipsoid_options_default(void)
{
    const ellipsoid_options options = {
        .semi_axes = {0.5e-6, 2e-6, 0.5e-6},
        .density = 1040,
        .fluid_density = 997.5,
        .kinematic_viscosity = 1e-6,
        .motion = ELLIPSOID_MOTION_INERTIAL,
        .drag = 1,
        .flow_at = ELLIPSOID_FLOW_CENTRE,
        .flow_points = 26,
        .wall_resistance = ELLIPSOID_WALL_RESISTANCE_NONE,
        .lubrication_gap = 20e-9,
        .wall_range = 10e-6,
        .buoyancy = 1,
        .pressure_gradient = ELLIPSOID_PRESSURE_DUDT,
        .gravity = {0, 0, -9.81},
        .external_force = {0, 0, 0},
        .external_torque = {0, 0, 0},
        .charge = 0,
        .dipole = {0, 0, 0},
        .electric_field = {0, 0, 0},
        .brownian = 0,
        .temperature = 298.15,
        .noise_interval = 1e-3,
        .contact = 1,
        .contact_shape = ELLIPSOID_CONTACT_BEADS,
        .bead_layout = ELLIPSOID_BEADS_STAGGERED,
        .bead_count = 32,
        .bead_radius = 0.285e-6,
        .contact_modulus = 1e6,
        .friction = 0,
        .slip_speed = 1e-5,
        .contact_damping = 0,
        .adhesion = 0,
        .adhesion_range = 20e-9,
        .tolerance = 1e-6,
        .initial_step = 0,
        .minimum_step = 1e-18,
        .maximum_step = 1,
        .maximum_steps = 10000000,
    };

    return options;
}

/* Where a member was found at fault, if any yet. */
typedef struct verdict
{
    const char *field, *range;
} verdict;

/* NaN fails every comparison, hence the form: require what must be true. */
static void require(verdict *v, int holds, const char *field, const char *range)
{
    if (!holds && !v->field)
    {
        v->field = field;
        v->range = range;
    }
}

static int within(double value, double low, double high)
{
    return value >= low && value <= high;
}

static int all_within(const double value[3], double low, double high)
{
    return within(value[0], low, high) && within(value[1], low, high)
        && within(value[2], low, high);
}

static int is_switch(int value) { return value == 0 || value == 1; }

/* The ranges keep every derived quantity a normal, finite number. */
static void check_body_and_fluid(verdict *v, const ellipsoid_options *o)
{
    require(v, all_within(o->semi_axes, 1e-12, 1e3), "semi_axes",
            "1e-12 to 1e3 m");
    require(v, within(o->density, 1e-12, 1e12), "density",
            "1e-12 to 1e12 kg/m3");
    require(v, within(o->fluid_density, 1e-12, 1e12), "fluid_density",
            "1e-12 to 1e12 kg/m3");
    require(v, within(o->kinematic_viscosity, 1e-15, 1e12),
            "kinematic_viscosity", "1e-15 to 1e12 m2/s");
}

static void check_equations(verdict *v, const ellipsoid_options *o)
{
    const int points = o->flow_points;

    require(v,
            o->motion == ELLIPSOID_MOTION_INERTIAL
                || o->motion == ELLIPSOID_MOTION_INERTIALESS,
            "motion", "INERTIAL or INERTIALESS");
    require(v, is_switch(o->drag), "drag", "0 or 1");
    require(v, o->drag || o->motion != ELLIPSOID_MOTION_INERTIALESS, "drag",
            "1 with motion INERTIALESS");
    require(v,
            o->flow_at == ELLIPSOID_FLOW_CENTRE
                || o->flow_at == ELLIPSOID_FLOW_BODY,
            "flow_at", "CENTRE or BODY");
    require(v, points == 6 || points == 14 || points == 26 || points == 50,
            "flow_points", "6, 14, 26 or 50");
    require(v, is_switch(o->buoyancy), "buoyancy", "0 or 1");
    require(v,
            o->pressure_gradient == ELLIPSOID_PRESSURE_NONE
                || o->pressure_gradient == ELLIPSOID_PRESSURE_DUDT
                || o->pressure_gradient == ELLIPSOID_PRESSURE_GRADP,
            "pressure_gradient", "NONE, DUDT or GRADP");
    require(v, all_within(o->gravity, -1e30, 1e30), "gravity", "-1e30 to 1e30");
    require(v, all_within(o->external_force, -1e30, 1e30), "external_force",
            "-1e30 to 1e30");
    require(v, all_within(o->external_torque, -1e30, 1e30), "external_torque",
            "-1e30 to 1e30");
    require(v, within(o->charge, -1e30, 1e30), "charge", "-1e30 to 1e30");
    require(v, all_within(o->dipole, -1e30, 1e30), "dipole", "-1e30 to 1e30");
    require(v, all_within(o->electric_field, -1e30, 1e30), "electric_field",
            "-1e30 to 1e30");
}

static void check_brownian(verdict *v, const ellipsoid_options *o)
{
    require(v, is_switch(o->brownian), "brownian", "0 or 1");
    require(v, o->drag || !o->brownian, "brownian", "0 without drag");
    require(v, within(o->temperature, 0, 1e5), "temperature", "0 to 1e5 K");
    require(v, within(o->noise_interval, 1e-15, 1e6), "noise_interval",
            "1e-15 to 1e6 s");
}

static void check_near_walls(verdict *v, const ellipsoid_options *o)
{
    const double *a = o->semi_axes;
    const double largest = fmax(a[0], fmax(a[1], a[2]));

    require(v,
            o->wall_resistance == ELLIPSOID_WALL_RESISTANCE_NONE
                || o->wall_resistance == ELLIPSOID_WALL_RESISTANCE_PLANE,
            "wall_resistance", "NONE or PLANE");
    if (o->wall_resistance == ELLIPSOID_WALL_RESISTANCE_NONE)
    {
        return;
    }
    require(v, o->drag, "wall_resistance", "NONE without drag");
    require(v, !o->brownian, "wall_resistance",
            "NONE with Brownian motion: the drift kT div M is not there");
    require(v, within(o->lubrication_gap, 1e-15, 1e3), "lubrication_gap",
            "1e-15 to 1e3 m");
    require(v, within(o->wall_range, largest, 1e6), "wall_range",
            "the largest semi-axis to 1e6 m");
}

static void check_contact(verdict *v, const ellipsoid_options *o)
{
    const double *a = o->semi_axes;
    const double smallest = fmin(a[0], fmin(a[1], a[2]));

    require(v, is_switch(o->contact), "contact", "0 or 1");
    if (!o->contact)
    {
        return;
    }
    require(v,
            o->contact_shape == ELLIPSOID_CONTACT_BEADS
                || o->contact_shape == ELLIPSOID_CONTACT_ELLIPSOID,
            "contact_shape", "BEADS or ELLIPSOID");
    require(v,
            o->bead_layout == ELLIPSOID_BEADS_STAGGERED
                || o->bead_layout == ELLIPSOID_BEADS_PAPER
                || o->bead_layout == ELLIPSOID_BEADS_SURFACE,
            "bead_layout", "STAGGERED, PAPER or SURFACE");
    require(v, o->bead_count >= 1 && o->bead_count <= ELLIPSOID_MAX_BEADS,
            "bead_count", "1 to 256");
    require(v, o->bead_radius > 0 && o->bead_radius < smallest, "bead_radius",
            "above 0, below the smallest semi-axis");
    require(v, within(o->contact_modulus, 1e-12, 1e15), "contact_modulus",
            "1e-12 to 1e15 Pa");
    require(v, within(o->friction, 0, 100), "friction", "0 to 100");
    require(v, within(o->slip_speed, 1e-15, 1e3), "slip_speed",
            "1e-15 to 1e3 m/s");
    require(v, within(o->contact_damping, 0, 1e12), "contact_damping",
            "0 to 1e12 s/m");
    require(v, within(o->adhesion, 0, 1e30), "adhesion", "0 to 1e30 N");
    require(v,
            o->adhesion == 0
                || within(o->adhesion_range, 1e-6 * o->bead_radius,
                          o->bead_radius),
            "adhesion_range", "1e-6 to 1 times the bead radius");
    if (!v->field)
    {
        double bead[ELLIPSOID_MAX_BEADS][3];

        require(v, ellipsoid_beads(o, bead) > 0, "bead_count",
                "one the layout allows: 2 + 3 n, or 1; 32 for PAPER");
    }
}

static void check_integrator(verdict *v, const ellipsoid_options *o)
{
    require(v, within(o->tolerance, 1e-14, 1e-1), "tolerance", "1e-14 to 1e-1");
    require(v, o->minimum_step > 0 && isfinite(o->minimum_step), "minimum_step",
            "above 0 s");
    require(v, o->maximum_step >= o->minimum_step && isfinite(o->maximum_step),
            "maximum_step", "minimum_step or more, finite");
    require(v,
            o->initial_step == 0
                || within(o->initial_step, o->minimum_step, o->maximum_step),
            "initial_step", "minimum_step to maximum_step, or 0");
    require(v, o->maximum_steps >= 1, "maximum_steps", "1 or more");
}

ellipsoid_status ellipsoid_options_check(const ellipsoid_options *options,
                                         const char **field, const char **range)
{
    verdict v = {NULL, NULL};

    check_body_and_fluid(&v, options);
    check_equations(&v, options);
    check_brownian(&v, options);
    check_near_walls(&v, options);
    check_contact(&v, options);
    check_integrator(&v, options);

    if (!v.field)
    {
        return ELLIPSOID_OK;
    }
    if (field)
    {
        *field = v.field;
    }
    if (range)
    {
        *range = v.range;
    }
    return ELLIPSOID_BAD_OPTION;
}

/* Half the line of the beads' centres, in their radii. */
static double line_in_radii(const ellipsoid_options *o)
{
    const double *a = o->semi_axes;
    const int inside = o->bead_layout == ELLIPSOID_BEADS_STAGGERED;

    return fmax(a[0], fmax(a[1], a[2])) / o->bead_radius - inside;
}

ellipsoid_options ellipsoid_options_resized(const ellipsoid_options *options,
                                            double length, double width)
{
    ellipsoid_options other = *options;
    const double wider = width / (2 * options->semi_axes[0]);

    other.semi_axes[0] *= wider;
    other.semi_axes[1] = 0.5 * length;
    other.semi_axes[2] *= wider;
    other.bead_radius *= wider;

    if (other.contact && other.bead_layout != ELLIPSOID_BEADS_PAPER
        && other.bead_count > 1
        && ellipsoid_options_check(&other, NULL, NULL) == ELLIPSOID_OK)
    {
        const int rings = (options->bead_count - 2) / 3;
        const double needed = ceil((rings + 1) * line_in_radii(&other)
                                       / line_in_radii(options)
                                   - 1e-9)
                            - 1;

        /* Never fewer: round the body they are as far apart as they were */
        other.bead_count =
            2 + 3 * (int)fmax(rings, fmin(needed, ELLIPSOID_MAX_BEADS));
    }
    return other;
}
