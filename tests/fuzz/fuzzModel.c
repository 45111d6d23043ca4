/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    fuzzModel.c - options, model, rotations and random numbers.
*/
#include "fuzzCheck.h"

static const double pi = 3.14159265358979323846;

static int all_positive(const double *v, int count)
{
    for (int n = 0; n < count; n++)
    {
        if (!(v[n] > 0 && isfinite(v[n])))
        {
            return 0;
        }
    }
    return 1;
}

/* Where the model's points are, to rounding: beads no farther than the reach,
   points of the flow on the surface. */
static void check_points(const ellipsoid_model *model)
{
    const ellipsoid_options *o = &model->options;
    double sum = 0;

    require(model->bead_count >= 0 && model->bead_count <= ELLIPSOID_MAX_BEADS);
    require((model->bead_count > 0) == o->contact);
    for (int b = 0; b < model->bead_count; b++)
    {
        const double *c = model->bead[b];

        require(hypot(hypot(c[0], c[1]), c[2]) + o->bead_radius
                <= model->reach * (1 + 1e-14));
    }

    require(o->flow_at == ELLIPSOID_FLOW_BODY ? model->flow_points >= 10
                                              : model->flow_points == 0);
    require(model->flow_points <= ELLIPSOID_MAX_FLOW_POINTS);
    for (int n = 0; n < model->flow_points; n++)
    {
        double square = 0;

        for (int i = 0; i < 3; i++)
        {
            const double s = model->flow_point[n][i] / o->semi_axes[i];

            square += s * s;
        }
        require(fabs(square - 1) < 1e-13);
        require(model->flow_weight[n] > 0);
        sum += model->flow_weight[n];
    }
    require(model->flow_points == 0 || fabs(sum - 1) < 1e-13);
}

int fuzz_check_model(const ellipsoid_options *o, ellipsoid_model *model)
{
    ellipsoid_model untouched;
    const char *field = NULL, *range = NULL;
    const ellipsoid_status status = ellipsoid_options_check(o, &field, &range);

    memset(model, 0x5a, sizeof *model);
    memcpy(&untouched, model, sizeof untouched);
    require(ellipsoid_model_init(model, o) == status);
    if (status != ELLIPSOID_OK)
    {
        require(status == ELLIPSOID_BAD_OPTION);
        require(field && *field && range && *range);
        require_same(*model, untouched);
        require(ellipsoid_options_check(o, NULL, NULL) == status);
        return 0;
    }
    require(!field && !range);
    require(all_positive(&model->volume, 1) && all_positive(&model->mass, 1));
    require(all_positive(&model->fluid_mass, 1));
    require(all_positive(&model->viscosity, 1));
    require(all_positive(model->inertia, 3));
    require(
        fuzz_all_finite(model->constant_force, sizeof model->constant_force));
    require(all_positive(model->resistance, 3));
    require(all_positive(model->rotation_resistance, 3));
    require(all_positive(model->mobility, 3));
    require(all_positive(model->rotation_mobility, 3));
    for (int i = 0; o->brownian && i < 3; i++)
    {
        require(model->noise_force[i] >= 0 && isfinite(model->noise_force[i]));
        require(model->noise_torque[i] >= 0);
        require(isfinite(model->noise_torque[i]));
    }
    require(all_positive(&model->relaxation_time, 1));
    require(all_positive(&model->rotation_relaxation_time, 1));
    require(all_positive(&model->reach, 1));
    for (int i = 0; i < 3; i++)
    {
        require(fabs(model->strain_factor[i]) <= 1);
    }
    check_points(model);
    return 1;
}

void fuzz_check_rotations(fuzz_input *in)
{
    double q[4], back[4], euler[3], uniform[3], rotation[3][3], wild[4];

    for (int n = 0; n < 4; n++)
    {
        wild[n] = fuzz_choice(in, 4) ? fuzz_between(in, -1, 1) : fuzz_wild(in);
    }
    /* any four numbers: it returns */
    ellipsoid_rotation(wild, rotation);
    ellipsoid_euler_from_quaternion(wild, euler);
    ellipsoid_quaternion_from_euler(wild, q);
    ellipsoid_quaternion_from_axis(wild, wild[3], q);

    for (int n = 0; n < 3; n++)
    {
        uniform[n] = (double)(fuzz_bits(in, 8) >> 11) / 9007199254740992.0;
    }
    ellipsoid_quaternion_from_uniform(uniform, q);
    require(fuzz_is_unit(q));
    ellipsoid_euler_from_quaternion(q, euler);
    require(euler[0] > -pi && euler[0] <= pi);
    require(euler[1] >= 0 && euler[1] <= pi);
    require(euler[2] > -pi && euler[2] <= pi);
    ellipsoid_quaternion_from_euler(euler, back);
    /* the same orientation, q or -q: angles of up to 2 pi are rounded */
    require(fabs(fabs(q[0] * back[0] + q[1] * back[1] + q[2] * back[2]
                      + q[3] * back[3])
                 - 1)
            < 1e-14);

    ellipsoid_rotation(q, rotation);
    {
        const double axis[3] = {rotation[0][1], rotation[1][1], rotation[2][1]};

        ellipsoid_quaternion_from_axis(axis, 2 * pi * uniform[0], back);
        require(fuzz_is_unit(back));
        ellipsoid_rotation(back, rotation);
        for (int i = 0; i < 3; i++)
        {
            require(fabs(rotation[i][1] - axis[i]) < 1e-14);
        }
    }
}

/* A function of the key, number by number. */
void fuzz_check_random(fuzz_input *in)
{
    const uint64_t seed = fuzz_bits(in, 8);
    const uint32_t id = (uint32_t)fuzz_bits(in, 4);
    const uint32_t stream = (uint32_t)fuzz_bits(in, 4);
    const uint32_t index = (uint32_t)fuzz_bits(in, 4);
    double number[9], again[8], normal[6], normals[8];

    ellipsoid_random_normal(seed, id, (int64_t)fuzz_bits(in, 8), normal);
    for (int n = 0; n < 6; n++)
    {
        /* Box and Muller's of the smallest number above zero, 2^-53 */
        require(fabs(normal[n]) <= sqrt(2 * 53 * log(2)));
    }
    number[8] = 2;
    ellipsoid_random_uniform(seed, id, stream, index, 8, number);
    ellipsoid_random_uniform(seed, id, stream, index, fuzz_choice(in, 9),
                             memcpy(again, number, sizeof again));
    require(number[8] == 2);
    require(memcmp(number, again, sizeof again) == 0);
    ellipsoid_random_normals(seed, id, stream, index, 8, normals);
    ellipsoid_random_normals(seed, id, stream, index, fuzz_choice(in, 9),
                             memcpy(again, normals, sizeof again));
    require(memcmp(normals, again, sizeof again) == 0);
    for (int n = 0; n < 8; n++)
    {
        require(number[n] >= 0 && number[n] < 1);
    }
}
