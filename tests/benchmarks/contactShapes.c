/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    contactShapes.c - beads against the ellipsoid itself: force, torque, place
    at rest and cost (docs/beadShapes.md).

    All sets of beads have the stiffness 4/3 E* sqrt(r_b) of the default cell.
*/
#include "trials.h"
#include "wallMesh.h"
#include "walls/walls.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double um = 1e-6, load = 10e-12, pi = 3.14159265358979323846;

enum
{
    POSES = 1000,
    RESTS = 40,
    SCENES = 3,
    SETS = 6
};

/* A wall, and the direction from which cells come to it. */
typedef struct scene
{
    const char *name;
    wall_mesh mesh;
    double away[3], width; /* places beside the middle, along x1 [m] */
} scene;

static ellipsoid_facet_cache cache;

static double uniform(void)
{
    static uint32_t index = 0; /* a program's, not the core's */
    double u;

    ellipsoid_random_uniform(1, 0, 0, index++, 1, &u);
    return u;
}

static void set_scenes(scene s[SCENES])
{
    const double wall[2][3] = {{-20 * um, -20 * um, -5 * um},
                               {20 * um, 20 * um, 0}};
    const double left[2][3] = {{-20 * um, -20 * um, -5 * um},
                               {-0.4 * um, 20 * um, 0}};
    const double right[2][3] = {{0.4 * um, -20 * um, -5 * um},
                                {20 * um, 20 * um, 0}};

    s[0] = (scene){.name = "wall", .away = {0, 0, 1}};
    s[1] = (scene){.name = "edge", .away = {sqrt(0.5), 0, sqrt(0.5)}};
    s[2] = (scene){.name = "aperture", .away = {0, 0, 1}, .width = 0.4e-6};
    for (int n = 0; n < SCENES; n++)
    {
        wall_mesh_init(&s[n].mesh);
    }
    wall_mesh_box(&s[0].mesh, wall[0], wall[1], 0, 0, 0);
    wall_mesh_box(&s[1].mesh, left[0], left[1], 0, 0, 0);
    wall_mesh_box(&s[2].mesh, left[0], left[1], 0, 0, 0);
    wall_mesh_box(&s[2].mesh, right[0], right[1], 0, 0, 0);
    for (int n = 0; n < SCENES; n++)
    {
        wall_mesh_finish(&s[n].mesh);
    }
}

static ellipsoid_surroundings around(scene *s)
{
    const ellipsoid_surroundings surroundings = {.walls = wall_mesh_list,
                                                 .walls_context = &s->mesh};

    return surroundings;
}

static ellipsoid_model model_of(int beads, double radius)
{
    ellipsoid_options o = ellipsoid_options_default();
    ellipsoid_model model;

    o.flow_at = ELLIPSOID_FLOW_CENTRE;
    o.wall_resistance = ELLIPSOID_WALL_RESISTANCE_NONE;
    if (beads == 0)
    {
        o.contact_shape = ELLIPSOID_CONTACT_ELLIPSOID;
    }
    else
    {
        o.contact_modulus *= sqrt(o.bead_radius / radius);
        o.bead_radius = radius;
        o.bead_count = beads;
    }
    o.motion = ELLIPSOID_MOTION_INERTIALESS;
    o.buoyancy = 0;
    o.external_force[2] = -load;
    if (ellipsoid_model_init(&model, &o) != ELLIPSOID_OK)
    {
        fprintf(stderr, "options refused\n");
        exit(1);
    }
    return model;
}

/* Root mean square of how early a plane touches the beads, over directions. */
static double bumpiness(const ellipsoid_model *model)
{
    const double *a = model->options.semi_axes;
    const int count = 4000;
    double sum = 0;

    for (int n = 0; n < count; n++)
    {
        /* on a spiral, evenly */
        const double z = (2 * n + 1.0) / count - 1, s = sqrt(1 - z * z);
        const double angle = n * pi * (3 - sqrt(5));
        const double v[3] = {s * cos(angle), s * sin(angle), z};
        double far = 0;

        for (int b = 0; b < model->bead_count; b++)
        {
            const double *c = model->bead[b];

            far = fmax(far, c[0] * v[0] + c[1] * v[1] + c[2] * v[2]);
        }
        far += model->options.bead_radius
             - sqrt(pow(a[0] * v[0], 2) + pow(a[1] * v[1], 2)
                    + pow(a[2] * v[2], 2));
        sum += far * far;
    }
    return sqrt(sum / count);
}

static double best_radius(int beads)
{
    double best = 0, least = HUGE_VAL;

    for (int n = 20; n < 100; n++)
    {
        const ellipsoid_model model = model_of(beads, n * 5e-9);
        const double rough = bumpiness(&model);

        if (rough < least)
        {
            least = rough;
            best = n * 5e-9;
        }
    }
    return best;
}

/* Force [N] and torque [N m], lab, at a way [m] from the scene's middle. */
static double evaluate(const ellipsoid_model *model, scene *s, double beside,
                       double way, const double q[4], double force[3],
                       double torque[3])
{
    const ellipsoid_surroundings surroundings = around(s);
    ellipsoid_state state = {.q = {q[0], q[1], q[2], q[3]}};
    double r[3][3];
    ellipsoid_contact contact;

    for (int i = 0; i < 3; i++)
    {
        state.x[i] = (i == 0 ? beside : 0) + way * s->away[i];
    }
    if (ellipsoid_contact_evaluate(model, &surroundings, &state, &cache,
                                   &contact, NULL)
        != ELLIPSOID_OK)
    {
        fprintf(stderr, "no contact found\n");
        exit(1);
    }
    ellipsoid_rotation(q, r);
    for (int i = 0; i < 3; i++)
    {
        const double *t = contact.torque;

        force[i] = contact.force[i];
        torque[i] = r[i][0] * t[0] + r[i][1] * t[1] + r[i][2] * t[2];
    }
    return contact.gap;
}

/* The way at which the scene bears the load, from clear of it. */
static double loaded(const ellipsoid_model *model, scene *s, double beside,
                     const double q[4], double force[3], double torque[3])
{
    double low, high = 4 * um;

    ellipsoid_facet_cache_clear(&cache);
    for (double gap = HUGE_VAL; gap > 1e-9;)
    {
        gap = evaluate(model, s, beside, high, q, force, torque);
        high -= gap > 1e-9 ? gap : 0;
    }
    high += 2e-9;
    low = high - 60e-9;
    for (int n = 0; n < 50; n++)
    {
        const double middle = (low + high) / 2;
        double along = 0;

        evaluate(model, s, beside, middle, q, force, torque);
        for (int i = 0; i < 3; i++)
        {
            along += force[i] * s->away[i];
        }
        *(along > load ? &low : &high) = middle;
    }
    return high;
}

static double difference(const double a[3], const double b[3])
{
    return sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2)
                + pow(a[2] - b[2], 2));
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

/* Median, and what one in twenty exceeds. */
static void print_spread(double *sample, int count, double unit)
{
    qsort(sample, (size_t)count, sizeof *sample, ascending);
    printf(" %.3g, %.3g |", sample[count / 2] / unit,
           sample[count * 19 / 20] / unit);
}

/* One scene, one set of beads: a row of the table. */
static void compare(scene *s, const ellipsoid_model *beads,
                    const ellipsoid_model *exact)
{
    static double force_error[POSES], place[POSES], arm[POSES], aim[POSES];
    const double none[3] = {0, 0, 0};

    for (int n = 0; n < POSES; n++)
    {
        const double beside = s->width * (2 * uniform() - 1);
        const double three[3] = {uniform(), uniform(), uniform()};
        double q[4], f[3], t[3], fb[3], tb[3];

        ellipsoid_quaternion_from_uniform(three, q);

        const double way = loaded(exact, s, beside, q, f, t);

        ellipsoid_facet_cache_clear(&cache);
        evaluate(beads, s, beside, way, q, fb, tb);
        force_error[n] = difference(fb, f) / difference(f, none);
        place[n] = fabs(loaded(beads, s, beside, q, fb, tb) - way);
        arm[n] = difference(tb, t) / load;
        aim[n] = difference(fb, f) / load;
    }
    printf("| %s | %d of %.3g |", s->name, beads->bead_count,
           beads->options.bead_radius / um);
    print_spread(force_error, POSES, 1);
    print_spread(place, POSES, 1e-9);
    print_spread(aim, POSES, 1);
    print_spread(arm, POSES, 1e-9);
    printf("\n");
}

static int still(void *context, double t, const double x[3], int derivatives,
                 ellipsoid_flow_sample *sample)
{
    (void)t;
    (void)context;
    (void)x;
    (void)derivatives;
    memset(sample, 0, sizeof *sample);
    return 0;
}

/* Let down on the wall, slightly tilted: where they come to rest. */
static void rest(scene *wall, const ellipsoid_model *model)
{
    ellipsoid_surroundings surroundings = around(wall);
    double low = HUGE_VAL, high = 0, sum = 0, tilted = 0;

    surroundings.flow = still;
    for (int n = 0; n < RESTS; n++)
    {
        const double tilt = 0.2 * uniform() - 0.1;
        const double axis[3] = {cos(tilt), 0, sin(tilt)};
        ellipsoid_state state = {.x = {0, 0, 0.8 * um}};
        ellipsoid_controller controller = {0, 0};
        ellipsoid_statistics statistics = {0};
        double t = 0, r[3][3];

        ellipsoid_quaternion_from_axis(axis, 2 * pi * uniform(), state.q);
        ellipsoid_facet_cache_clear(&cache);
        if (ellipsoid_advance(&(ellipsoid_member){model, &surroundings, &state,
                                                  &controller, &cache, NULL,
                                                  &statistics},
                              &t, 10, NULL)
            != ELLIPSOID_OK)
        {
            fprintf(stderr, "a cell did not come to rest\n");
            exit(1);
        }
        ellipsoid_rotation(state.q, r);
        low = fmin(low, state.x[2]);
        high = fmax(high, state.x[2]);
        sum += state.x[2];
        tilted = fmax(tilted, fabs(r[2][1]));
    }
    printf(" %.4g | %.4g to %.4g | %.2g |", sum / RESTS / 1e-9, low / 1e-9,
           high / 1e-9, asin(tilted) * 180 / pi);
}

/* Nanoseconds for an evaluation of poses that change by 2 nm. */
static double cost(scene s[SCENES], const ellipsoid_model *model, int jacobian,
                   int repeats)
{
    static double sample[BENCHMARK_TRAJECTORIES];
    static double start[200][8];
    const int steps = 100;

    for (int n = 0; n < 200; n++)
    {
        const double three[3] = {uniform(), uniform(), uniform()};
        double f[3], t[3];

        start[n][7] = s[n % SCENES].width * (2 * uniform() - 1);
        ellipsoid_quaternion_from_uniform(three, start[n] + 3);
        start[n][0] =
            loaded(model, &s[n % SCENES], start[n][7], start[n] + 3, f, t);
    }
    for (int r = 0; r < repeats; r++)
    {
        const double begun = benchmark_clock();

        for (int n = 0; n < 200; n++)
        {
            scene *where = &s[n % SCENES];
            const ellipsoid_surroundings surroundings = around(where);
            ellipsoid_state at = {.u = {0}};

            ellipsoid_facet_cache_clear(&cache);
            memcpy(at.q, start[n] + 3, sizeof(at.q));
            for (int i = 0; i < 3; i++)
            {
                at.x[i] =
                    (i == 0 ? start[n][7] : 0) + start[n][0] * where->away[i];
            }
            for (int k = 0; k < steps; k++)
            {
                ellipsoid_contact contact;
                ellipsoid_wrench_jacobian derivatives;

                at.x[1] += 2e-9;
                ellipsoid_contact_evaluate(model, &surroundings, &at, &cache,
                                           &contact,
                                           jacobian ? &derivatives : NULL);
            }
        }
        sample[r] = (benchmark_clock() - begun) / (200 * steps);
    }
    qsort(sample, (size_t)repeats, sizeof *sample, ascending);
    return sample[repeats / 2] * 1e9;
}

int main(int argc, char **argv)
{
    static const int counts[] = {8, 32, 128};
    const int repeats = benchmark_repeats(argc, argv);
    const ellipsoid_model exact = model_of(0, 0);
    static ellipsoid_model set[SETS];
    static scene s[SCENES];
    double base[2];

    set_scenes(s);
    for (int n = 0; n < SETS; n++)
    {
        const int beads = counts[n / 2];

        set[n] = model_of(beads, n % 2 ? best_radius(beads) : 0.285 * um);
    }

    printf("| scene | beads | force at the same place, relative | place under "
           "10 pN [nm] | force there, by the load | torque there, by the load "
           "[nm] |\n|---|---|---|---|---|---|\n");
    for (int k = 0; k < SCENES; k++)
    {
        for (int n = 0; n < SETS; n++)
        {
            compare(&s[k], &set[n], &exact);
        }
    }

    base[0] = cost(s, &set[2], 0, repeats);
    base[1] = cost(s, &set[2], 1, repeats);
    printf("\n| contact | a plane touches early or late, rms [nm] | at rest on "
           "a wall, mean height [nm] | range [nm] | largest tilt [deg] | cost "
           "| with derivatives |\n|---|---|---|---|---|---|---|\n");
    for (int n = -1; n < SETS; n++)
    {
        const ellipsoid_model *m = n < 0 ? &exact : &set[n];

        if (n < 0)
        {
            printf("| ellipsoid | 0 |");
        }
        else
        {
            printf("| %d beads of %.3g | %.3g |", m->bead_count,
                   m->options.bead_radius / um, bumpiness(m) / 1e-9);
        }
        rest(&s[0], m);
        printf(" %.2f | %.2f |\n", cost(s, m, 0, repeats) / base[0],
               cost(s, m, 1, repeats) / base[1]);
    }
    for (int k = 0; k < SCENES; k++)
    {
        wall_mesh_free(&s[k].mesh);
    }
    return 0;
}
