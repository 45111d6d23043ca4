/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    fuzzInput.c - bytes become numbers, options and states.
*/
#include "fuzzInput.h"

#include "body/planeTable.h"

#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void fuzz_fail(const char *condition, const char *file, int line)
{
    fprintf(stderr, "%s:%d: does not hold: %s\n", file, line, condition);
    abort();
}

uint64_t fuzz_bits(fuzz_input *in, int bytes)
{
    uint64_t bits = 0;

    for (int n = 0; n < bytes && in->size > 0; n++, in->size--)
    {
        bits |= (uint64_t)*in->data++ << 8 * n;
    }
    return bits;
}

int fuzz_choice(fuzz_input *in, int count)
{
    return (int)(fuzz_bits(in, 1) % (uint64_t)count);
}

double fuzz_between(fuzz_input *in, double low, double high)
{
    return low + (high - low) * (double)fuzz_bits(in, 2) / 65536;
}

double fuzz_scaled(fuzz_input *in, double low, double high)
{
    return low * pow(high / low, fuzz_between(in, 0, 1));
}

void fuzz_vector(fuzz_input *in, double size, int count, double *v)
{
    for (int n = 0; n < count; n++)
    {
        /* zeros mean 0: the upper half of what two bytes say comes first */
        v[n] = size * (int16_t)fuzz_bits(in, 2) / 32768.0;
    }
}

double fuzz_wild(fuzz_input *in)
{
    const double known[] = {
        0,        -0.0,    NAN,      HUGE_VAL,       -HUGE_VAL,   DBL_MAX,
        -DBL_MAX, DBL_MIN, -DBL_MIN, DBL_TRUE_MIN,   DBL_EPSILON, 1e-162,
        1e154,    1,       -1,       1 + DBL_EPSILON};
    const int choice = fuzz_choice(in, 20);

    if (choice < 16)
    {
        return known[choice];
    }

    const uint64_t bits = fuzz_bits(in, 8);
    double value;

    memcpy(&value, &bits, sizeof value);
    return value;
}

/* 2 + 3 n or 1, 32 for PAPER; the radius fits into the body */
static void read_beads(fuzz_input *in, ellipsoid_options *o)
{
    const double *a = o->semi_axes;
    const int layout = fuzz_choice(in, 3), rings = fuzz_choice(in, 85);
    const int single = fuzz_choice(in, 8) == 7;

    o->bead_layout = layout == 0 ? ELLIPSOID_BEADS_STAGGERED
                   : layout == 1 ? ELLIPSOID_BEADS_PAPER
                                 : ELLIPSOID_BEADS_SURFACE;
    o->bead_count = single ? 1 : layout == 1 ? 32 : 2 + 3 * rings;
    o->bead_radius = fmin(a[0], fmin(a[1], a[2])) * fuzz_scaled(in, 0.05, 0.99);
    o->contact_modulus = fuzz_scaled(in, 1e2, 1e9);
    if (fuzz_choice(in, 2))
    {
        o->contact_shape = ELLIPSOID_CONTACT_ELLIPSOID;
    }
    if (fuzz_choice(in, 2))
    {
        o->adhesion = o->contact_modulus * o->bead_radius * o->bead_radius
                    * fuzz_scaled(in, 1e-9, 1);
        o->adhesion_range = o->bead_radius * fuzz_scaled(in, 1e-3, 0.99);
    }
}

static void read_contact_law(fuzz_input *in, ellipsoid_options *o)
{
    const int which = fuzz_choice(in, 4);

    o->friction = which & 1 ? fuzz_scaled(in, 1e-3, 10) : 0;
    o->contact_damping = which & 2 ? fuzz_scaled(in, 1e-3, 1e6) : 0;
    o->slip_speed = fuzz_scaled(in, 1e-9, 1);
}

static void read_forces(fuzz_input *in, double size, ellipsoid_options *o)
{
    const double weight = 1e4 * size * size * size; /* [N] */
    const int pressure = fuzz_choice(in, 3);

    o->pressure_gradient = pressure == 0 ? ELLIPSOID_PRESSURE_DUDT
                         : pressure == 1 ? ELLIPSOID_PRESSURE_NONE
                                         : ELLIPSOID_PRESSURE_GRADP;
    o->buoyancy = fuzz_choice(in, 2);
    fuzz_vector(in, 100, 3, o->gravity);
    fuzz_vector(in, 100 * weight, 3, o->external_force);
    fuzz_vector(in, 100 * weight * size, 3, o->external_torque);
    fuzz_vector(in, 1e3, 3, o->electric_field);
    o->charge = fuzz_between(in, 0, weight);
    fuzz_vector(in, weight * size, 3, o->dipole);
}

static void read_integrator(fuzz_input *in, ellipsoid_options *o)
{
    o->tolerance = fuzz_scaled(in, 1e-12, 1e-1);
    o->maximum_step = fuzz_scaled(in, 1e-18, 1e3);
}

ellipsoid_options fuzz_options(fuzz_input *in)
{
    ellipsoid_options o = ellipsoid_options_default();
    const int parts = (int)fuzz_bits(in, 1);
    double size = 2e-6;

    o.flow_at = ELLIPSOID_FLOW_CENTRE;
    o.wall_resistance = ELLIPSOID_WALL_RESISTANCE_NONE;
    o.contact = !(parts & 1) || fuzz_choice(in, 4) != 0;
    if (parts & 2)
    {
        size = fuzz_scaled(in, 1e-8, 1e-2);
        for (int i = 0; i < 3; i++)
        {
            o.semi_axes[i] = fuzz_choice(in, 3) == 0
                               ? size
                               : size * fuzz_scaled(in, 1e-2, 1);
        }
        o.bead_radius *= size / 2e-6;
        for (int i = 0; i < 3; i++)
        {
            o.bead_radius = fmin(o.bead_radius, o.semi_axes[i] / 2);
        }
    }
    if (parts & 4)
    {
        o.density = fuzz_scaled(in, 1, 1e5);
        o.fluid_density = fuzz_scaled(in, 1e-1, 1e4);
        o.kinematic_viscosity = fuzz_scaled(in, 1e-9, 1);
    }
    if (parts & 8)
    {
        read_beads(in, &o);
    }
    if (parts & 16)
    {
        read_forces(in, size, &o);
    }
    if (parts & 32)
    {
        read_integrator(in, &o);
    }
    if (parts & 64)
    {
        o.flow_at = ELLIPSOID_FLOW_BODY;
    }
    if (parts & 128)
    {
        o.drag = fuzz_choice(in, 4) != 3;
        o.motion = o.drag && fuzz_choice(in, 4) != 3
                     ? ELLIPSOID_MOTION_INERTIALESS
                     : ELLIPSOID_MOTION_INERTIAL;
        o.brownian = o.drag && fuzz_choice(in, 3) == 2;
        if (o.drag && ellipsoid_plane_table_has(o.semi_axes)
            && fuzz_choice(in, 2))
        {
            const double *a = o.semi_axes;

            o.wall_resistance = ELLIPSOID_WALL_RESISTANCE_PLANE;
            o.lubrication_gap = fuzz_scaled(in, 1e-12, 1e-6);
            o.wall_range =
                fmax(a[0], fmax(a[1], a[2])) * fuzz_between(in, 1, 10);
        }
    }
    if (o.brownian)
    {
        o.temperature = fuzz_between(in, 0, 1000);
        o.noise_interval = fuzz_scaled(in, 1e-9, 1);
    }
    read_contact_law(in, &o);
    /* bounds the time that one input takes */
    o.maximum_steps = 1 + fuzz_choice(in, 24);
    return o;
}

/* At an end of the range of options.def or just beyond, in it, or any number */
static double wild_value(fuzz_input *in, const ellipsoid_option *option)
{
    const double low = option->low, high = option->high;
    const int is_whole = option->type != ELLIPSOID_OPTION_REAL
                      && option->type != ELLIPSOID_OPTION_VECTOR;

    switch (fuzz_choice(in, 8))
    {
    case 0:
        return low;
    case 1:
        return high;
    case 2:
        return is_whole ? low - 1 : nextafter(low, -HUGE_VAL);
    case 3:
        return is_whole ? high + 1 : nextafter(high, HUGE_VAL);
    case 4:
        return fuzz_wild(in);
    default:
        return low > 0 ? fuzz_scaled(in, low, high)
                       : fuzz_between(in, low, high);
    }
}

static int to_int(double value)
{
    return value >= INT_MAX ? INT_MAX : value > INT_MIN ? (int)value : INT_MIN;
}

void fuzz_wild_options(fuzz_input *in, ellipsoid_options *options)
{
    int count = 0;
    const ellipsoid_option *list = ellipsoid_option_list(&count);
    const int changes = 1 + fuzz_choice(in, 4);

    for (int n = 0; n < changes; n++)
    {
        const ellipsoid_option *option = &list[fuzz_choice(in, count)];
        const double value = wild_value(in, option);
        const int whole = to_int(value);
        char *member = (char *)options + option->offset;

        switch (option->type)
        {
        case ELLIPSOID_OPTION_VECTOR:
            member += (size_t)fuzz_choice(in, 3) * sizeof value;
            memcpy(member, &value, sizeof value);
            break;
        case ELLIPSOID_OPTION_REAL:
            memcpy(member, &value, sizeof value);
            break;
        default:
            memcpy(member, &whole, sizeof whole);
        }
    }
    /* bounds the time that one input takes */
    options->maximum_steps %= 24;
}

void fuzz_state(fuzz_input *in, double length, double speed,
                ellipsoid_state *state)
{
    double uniform[3];

    fuzz_vector(in, (fuzz_choice(in, 2) ? 3 : 1) * length, 3, state->x);
    for (int i = 0; i < 3; i++)
    {
        uniform[i] = fuzz_between(in, 0, 1);
    }
    switch (fuzz_choice(in, 4))
    {
    case 0: /* along the axes of the lab */
        memset(state->q, 0, sizeof state->q);
        state->q[fuzz_choice(in, 4)] = fuzz_choice(in, 2) ? -1 : 1;
        break;
    default:
        ellipsoid_quaternion_from_uniform(uniform, state->q);
    }
    fuzz_vector(in, speed, 3, state->u);
    fuzz_vector(in, speed / length, 3, state->omega);
}

void fuzz_wild_state(fuzz_input *in, ellipsoid_state *state)
{
    const int changes = 1 + fuzz_choice(in, 3);

    for (int n = 0; n < changes; n++)
    {
        const int which = fuzz_choice(in, ELLIPSOID_STATE_SIZE);
        const double value = fuzz_wild(in);

        memcpy((char *)state + (size_t)which * sizeof value, &value,
               sizeof value);
    }
}
