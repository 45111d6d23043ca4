/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    fuzzScene.c - a flow, an electric field and walls out of bytes.
*/
#include "fuzzScene.h"

#include <limits.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void require_finite(const fuzz_scene *scene, const double x[3])
{
    require(!scene->strict
            || (isfinite(x[0]) && isfinite(x[1]) && isfinite(x[2])));
}

static void require_zero(const double *number, size_t bytes)
{
    for (size_t n = 0; n < bytes / sizeof *number; n++)
    {
        require(number[n] == 0);
    }
}

/* --------------------------------------------------------------- faults */

static void read_fault(fuzz_fault *fault, fuzz_input *in, double length)
{
    static const int answers[] = {1, -1, 2, -2, INT_MAX, INT_MIN};
    const int kind = fuzz_choice(in, 8);

    fault->kind = kind == 6 ? FUZZ_REFUSES
                : kind == 7 ? FUZZ_GOES_WILD
                            : FUZZ_NO_FAULT;
    if (fault->kind == FUZZ_NO_FAULT)
    {
        return;
    }
    fuzz_vector(in, 1, 3, fault->normal);
    fault->offset =
        fuzz_choice(in, 4) == 0 ? -HUGE_VAL : length * fuzz_between(in, -3, 3);
    fault->answer = answers[fuzz_choice(in, 6)];
    fault->which = fuzz_bits(in, 1);
    fault->value = fuzz_wild(in);
}

static int is_at_fault(const fuzz_fault *fault, fuzz_fault_kind kind,
                       const double x[3])
{
    return fault->kind == kind && dot(fault->normal, x) > fault->offset;
}

static int answer_of(const fuzz_fault *fault, const double x[3], int *gave_up)
{
    const int answer = is_at_fault(fault, FUZZ_REFUSES, x) ? fault->answer : 0;

    *gave_up = *gave_up || answer < 0;
    return answer;
}

/* ----------------------------------------------------------------- flow */

static void set_quadratic(const fuzz_scene *s, const double x[3],
                          ellipsoid_flow_sample *sample)
{
    for (int i = 0; i < 3; i++)
    {
        sample->velocity[i] = s->u[i];
        sample->pressure_gradient[i] = s->p[i] + dot(s->pp[i], x);
        for (int j = 0; j < 3; j++)
        {
            const double change = dot(s->h[i][j], x);

            sample->gradient[i][j] = s->g[i][j] + change;
            sample->velocity[i] += (s->g[i][j] + change / 2) * x[j];
        }
    }
    memcpy(sample->gradient_jacobian, s->h, sizeof s->h);
    memcpy(sample->pressure_jacobian, s->pp, sizeof s->pp);
}

static void add_waves(const fuzz_scene *s, const double x[3],
                      ellipsoid_flow_sample *sample)
{
    for (int w = 0; w < 2; w++)
    {
        const fuzz_wave *wave = &s->wave[w];
        const double angle = dot(wave->k, x) + wave->phase;

        for (int i = 0; i < 3; i++)
        {
            const double a = wave->amplitude[i];

            sample->velocity[i] += a * sin(angle);
            for (int j = 0; j < 3; j++)
            {
                sample->gradient[i][j] += a * wave->k[j] * cos(angle);
                for (int k = 0; k < 3; k++)
                {
                    sample->gradient_jacobian[i][j][k] -=
                        a * wave->k[j] * wave->k[k] * sin(angle);
                }
            }
        }
    }
}

/* Numbers drawn anew in every cell of a grid that is finer where x is small */
static void set_noise(const fuzz_scene *s, const double x[3],
                      ellipsoid_flow_sample *sample)
{
    double number[sizeof *sample / sizeof(double)];
    uint64_t z = 0;

    for (int i = 0; i < 3; i++)
    {
        uint64_t bits;

        memcpy(&bits, &x[i], sizeof bits);
        z = (z ^ (bits >> 46)) * 0xff51afd7ed558ccdu;
        z ^= z >> 33;
    }
    for (size_t n = 0; n < sizeof number / sizeof *number; n++)
    {
        const double size = n < 3  ? s->speed
                          : n < 15 ? s->speed / s->length
                                   : s->speed / s->length / s->length;

        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u + n;
        number[n] = size * ((double)(z >> 40) / 8388608 - 1);
    }
    memcpy(sample, number, sizeof number);
}

static void set_nan(double *from, size_t bytes)
{
    for (size_t n = 0; n < bytes / sizeof *from; n++)
    {
        from[n] = NAN;
    }
}

static void sample_flow(const fuzz_scene *s, const double x[3],
                        ellipsoid_flow_sample *sample)
{
    if (s->flow == FUZZ_FLOW_NOISE)
    {
        set_noise(s, x, sample);
    }
    else
    {
        set_quadratic(s, x, sample);
        if (s->flow == FUZZ_FLOW_WAVES)
        {
            add_waves(s, x, sample);
        }
        memcpy(sample->velocity_jacobian, sample->gradient,
               sizeof sample->gradient);
    }
    if (is_at_fault(&s->flow_fault, FUZZ_GOES_WILD, x))
    {
        const size_t count = sizeof *sample / sizeof(double);

        memcpy((char *)sample + s->flow_fault.which % count * sizeof(double),
               &s->flow_fault.value, sizeof(double));
    }
}

static int flow(void *context, double t, const double x[3], int derivatives,
                ellipsoid_flow_sample *sample)
{
    fuzz_scene *s = context;

    (void)t;
    require_finite(s, x);
    require(!s->flow_gave_up);
    require_zero(sample->velocity, derivatives ? sizeof *sample
                                               : offsetof(ellipsoid_flow_sample,
                                                          velocity_jacobian));
    memcpy(s->sampled, x, sizeof s->sampled);
    sample_flow(s, x, sample);
    /* who reads what was not asked for gets NaN */
    if (!derivatives)
    {
        set_nan(sample->velocity_jacobian[0],
                sizeof sample->velocity_jacobian
                    + sizeof sample->gradient_jacobian);
    }
    if (!s->needs_pressure)
    {
        set_nan(sample->pressure_gradient, sizeof sample->pressure_gradient);
    }
    set_nan(sample->local_acceleration, sizeof sample->local_acceleration);
    set_nan(sample->acceleration_jacobian[0],
            sizeof sample->acceleration_jacobian);
    if (!derivatives || !s->needs_pressure)
    {
        set_nan(sample->pressure_jacobian[0], sizeof sample->pressure_jacobian);
    }
    return answer_of(&s->flow_fault, x, &s->flow_gave_up);
}

static int velocities(void *context, double t, const double centre[3],
                      int count, double (*points)[3], double (*velocity)[3],
                      double (*jacobian)[3][3])
{
    fuzz_scene *s = context;

    (void)t;
    require_zero(velocity[0], (size_t)count * sizeof *velocity);
    require_zero(jacobian ? jacobian[0][0] : NULL,
                 jacobian ? (size_t)count * sizeof *jacobian : 0);
    require_finite(s, centre);
    require(count > 0 && count <= ELLIPSOID_MAX_FLOW_POINTS);
    require(memcmp(centre, s->sampled, sizeof s->sampled) == 0);
    require(!s->flow_gave_up);
    for (int n = 0; n < count; n++)
    {
        ellipsoid_flow_sample sample = {0};
        const int answer =
            answer_of(&s->flow_fault, points[n], &s->flow_gave_up);

        require_finite(s, points[n]);
        /* what cannot be answered is a place beyond a wall, or not */
        if (answer < 0 || (answer > 0 && s->flow_fault.which % 2))
        {
            return answer;
        }
        if (answer == 0 && dot(s->shore, points[n]) <= s->shore[3])
        {
            sample_flow(s, points[n], &sample);
        }
        memcpy(velocity[n], sample.velocity, sizeof sample.velocity);
        if (jacobian)
        {
            memcpy(jacobian[n], sample.velocity_jacobian,
                   sizeof sample.velocity_jacobian);
        }
    }
    return 0;
}

static int field(void *context, double t, const double x[3], double e[3],
                 double (*jacobian)[3])
{
    fuzz_scene *s = context;

    (void)t;
    require_finite(s, x);
    require(!s->field_gave_up);
    for (int i = 0; i < 3; i++)
    {
        e[i] = s->e[i] + dot(s->ee[i], x);
        if (jacobian)
        {
            memcpy(jacobian[i], s->ee[i], sizeof s->ee[i]);
        }
    }
    if (is_at_fault(&s->field_fault, FUZZ_GOES_WILD, x))
    {
        const size_t which = s->field_fault.which % 12;

        if (which < 3)
        {
            e[which] = s->field_fault.value;
        }
        else if (jacobian)
        {
            jacobian[which / 3 - 1][which % 3] = s->field_fault.value;
        }
    }
    return answer_of(&s->field_fault, x, &s->field_gave_up);
}

/* Both linear in the place, the torque alike in the body frame */
static int force(void *context, double t, const ellipsoid_state *state,
                 double f[3], double torque[3],
                 ellipsoid_wrench_jacobian *jacobian)
{
    fuzz_scene *s = context;

    require(isfinite(t));
    require_finite(s, state->x);
    require(!s->force_gave_up);
    for (int i = 0; i < 3; i++)
    {
        require(f[i] == 0 && torque[i] == 0);
        f[i] = s->f[i] + dot(s->ff[i], state->x);
        torque[i] = s->length * f[i];
        for (int l = 0; jacobian && l < 3; l++)
        {
            jacobian->force_x[i][l] = s->ff[i][l];
            jacobian->torque_x[i][l] = s->length * s->ff[i][l];
        }
    }
    if (is_at_fault(&s->force_fault, FUZZ_GOES_WILD, state->x))
    {
        f[s->force_fault.which % 3] = s->force_fault.value;
    }
    return answer_of(&s->force_fault, state->x, &s->force_gave_up);
}

/* ---------------------------------------------------------------- walls */

static int walls(void *context, double t, const double centre[3], double reach,
                 ellipsoid_facet_list *list)
{
    fuzz_scene *s = context;

    require_finite(s, centre);
    require(!s->strict || (reach > 0 && isfinite(reach)));
    wall_mesh_list(&s->mesh, t, centre, reach, list);
    if (s->generous)
    {
        list->index = s->mesh.index;
        list->count = s->mesh.count;
        list->reach = HUGE_VAL;
    }
    return answer_of(&s->walls_fault, centre, &s->walls_gave_up);
}

static void read_walls(fuzz_scene *s, fuzz_input *in)
{
    wall_mesh_init(&s->mesh);
    if (!fuzz_walls_read(&s->mesh, s->length, in))
    {
        return;
    }
    s->sound = 1;
    for (int n = 0; n < s->mesh.count; n++)
    {
        ellipsoid_facet facet;

        s->sound = ellipsoid_facet_set(
                       &facet, (const double(*)[3])s->mesh.facets[n].vertex)
                && isfinite(dot(facet.normal, facet.normal)) && s->sound;
    }
    read_fault(&s->walls_fault, in, s->length);
    if (s->walls_fault.kind == FUZZ_GOES_WILD)
    {
        /* middle, radius, normal and vertices: sixteen numbers */
        ellipsoid_facet *facet = &s->mesh.facets[fuzz_choice(
            in, s->mesh.count < 256 ? s->mesh.count : 256)];

        memcpy((char *)facet + s->walls_fault.which % 16 * sizeof(double),
               &s->walls_fault.value, sizeof(double));
    }
    s->around.walls = walls;
    s->around.walls_context = s;
}

/* ---------------------------------------------------------------- scene */

static void read_flow(fuzz_scene *s, fuzz_input *in)
{
    const double rate = s->speed / s->length;

    fuzz_vector(in, s->speed, 3, s->u);
    fuzz_vector(in, rate, 9, s->g[0]);
    fuzz_vector(in, s->speed * rate * 1e3, 3, s->p);
    for (int i = 0; i < 3 && fuzz_choice(in, 2); i++)
    {
        fuzz_vector(in, rate / s->length, 9, s->h[i][0]);
        fuzz_vector(in, rate * rate * 1e3, 3, s->pp[i]);
    }
    if (s->flow == FUZZ_FLOW_WAVES)
    {
        for (int w = 0; w < 2; w++)
        {
            fuzz_vector(in, s->speed, 3, s->wave[w].amplitude);
            fuzz_vector(in, 4 / s->length, 3, s->wave[w].k);
            s->wave[w].phase = fuzz_between(in, 0, 6);
        }
    }
    read_fault(&s->flow_fault, in, s->length);
    s->around.flow = flow;
    s->around.flow_context = s;
    if (fuzz_choice(in, 2))
    {
        fuzz_vector(in, 1, 3, s->shore);
        s->shore[3] = fuzz_between(in, -1, 3) * s->length;
        s->around.velocities = velocities;
    }
    s->around.fixed = fuzz_choice(in, 8) == 7;
}

void fuzz_scene_read(fuzz_scene *s, fuzz_input *in, const ellipsoid_options *o)
{
    const double *a = o->semi_axes;
    const int parts = fuzz_choice(in, 16);

    memset(s, 0, sizeof *s);
    s->length = fmax(a[0], fmax(a[1], a[2]));
    s->speed = fuzz_scaled(in, 1e-7, 10) * s->length / 2e-6;
    s->needs_pressure = o->pressure_gradient == ELLIPSOID_PRESSURE_GRADP;
    s->sound = 1;
    s->around.seed = fuzz_bits(in, 2);
    s->around.id = (uint32_t)fuzz_bits(in, 2);
    if (parts & 1)
    {
        const int kind = fuzz_choice(in, 3);

        s->flow = kind == 0 ? FUZZ_FLOW_QUADRATIC
                : kind == 1 ? FUZZ_FLOW_WAVES
                            : FUZZ_FLOW_NOISE;
        read_flow(s, in);
    }
    if (parts & 2)
    {
        read_walls(s, in);
    }
    if (parts & 4)
    {
        fuzz_vector(in, 1e4, 3, s->e);
        fuzz_vector(in, 1e4 / s->length, 9, s->ee[0]);
        read_fault(&s->field_fault, in, s->length);
        s->around.field = field;
        s->around.field_context = s;
    }
    if (parts & 8)
    {
        /* about the drag at that speed */
        const double size = 1e-2 * s->length * s->speed;

        fuzz_vector(in, size, 3, s->f);
        fuzz_vector(in, size / s->length, 9, s->ff[0]);
        read_fault(&s->force_fault, in, s->length);
        s->around.force = force;
        s->around.force_context = s;
    }
}

void fuzz_scene_free(fuzz_scene *scene) { wall_mesh_free(&scene->mesh); }

int fuzz_scene_has_faultless_walls(const fuzz_scene *scene)
{
    return scene->sound && scene->walls_fault.kind == FUZZ_NO_FAULT;
}

int fuzz_scene_is_tame(const fuzz_scene *scene)
{
    return fuzz_scene_has_faultless_walls(scene)
        && scene->flow_fault.kind == FUZZ_NO_FAULT
        && scene->force_fault.kind == FUZZ_NO_FAULT
        && scene->field_fault.kind == FUZZ_NO_FAULT
        && scene->flow != FUZZ_FLOW_NOISE;
}
