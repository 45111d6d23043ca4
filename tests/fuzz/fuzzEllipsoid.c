/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    fuzzEllipsoid.c - whatever options, state and callbacks it is given, the
    core keeps the promises of ellipsoid.h.

    The entry is libFuzzer's; driver.c calls it where there is no libFuzzer.
*/
#include "fuzzCheck.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Times, controller and totals before a run; returns 1 if one is wild. */
static int read_start(fuzz_input *in, const ellipsoid_options *o,
                      fuzz_start *start)
{
    const int parts = fuzz_choice(in, 16);

    start->end = fuzz_scaled(in, 1e-9, 10);
    if (parts & 1)
    {
        start->t = fuzz_between(in, 0, 1000);
        start->end += start->t;
    }
    if (parts & 2)
    {
        start->controller.step = fuzz_scaled(in, 1e-12, 1);
        start->controller.previous_error = fuzz_scaled(in, 1e-4, 1);
        start->statistics.accepted = start->statistics.rhs = 1000;
        start->statistics.deepest = o->semi_axes[0] / 10;
    }
    if ((parts & 12) != 12)
    {
        return 0;
    }
    switch (fuzz_choice(in, 4))
    {
    case 0:
        start->t = fuzz_wild(in);
        break;
    case 1:
        start->end = fuzz_wild(in);
        break;
    case 2:
        start->controller.step = fuzz_wild(in);
        break;
    default:
        start->controller.previous_error = fuzz_wild(in);
    }
    return 1;
}

/* A pose about as far as a cache may serve, or anywhere */
static ellipsoid_state read_elsewhere(fuzz_input *in, int near,
                                      const fuzz_scene *scene,
                                      const ellipsoid_options *o,
                                      const ellipsoid_state *state)
{
    ellipsoid_state elsewhere;

    if (!near)
    {
        fuzz_state(in, scene->length, scene->speed, &elsewhere);
        return elsewhere;
    }
    elsewhere = *state;
    fuzz_vector(in, fuzz_scaled(in, 0.01, 3) * o->bead_radius, 3, elsewhere.x);
    fuzz_vector(in, fuzz_scaled(in, 1e-3, 1), 4, elsewhere.q);
    for (int i = 0; i < 3; i++)
    {
        elsewhere.x[i] += state->x[i];
    }
    for (int n = 0; n < 4; n++)
    {
        elsewhere.q[n] += state->q[n];
    }
    return elsewhere;
}

static ellipsoid_state between(const ellipsoid_state *a,
                               const ellipsoid_state *b, double part)
{
    ellipsoid_state state = *a;

    for (int i = 0; i < 3; i++)
    {
        state.x[i] += part * (b->x[i] - a->x[i]);
    }
    for (int n = 0; n < 4; n++)
    {
        state.q[n] += part * (b->q[n] - a->q[n]);
    }
    return state;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static ellipsoid_facet_cache warm;
    static ellipsoid_model model;
    fuzz_input in = {data, size};
    const int parts = (int)fuzz_bits(&in, 1);
    const int wild_options = (parts & 7) == 7, wild_state = (parts & 56) == 56;
    ellipsoid_options options = fuzz_options(&in);
    ellipsoid_state elsewhere, usual, way;
    fuzz_scene scene;
    fuzz_start start = {.t = 0};
    int tame;

    require(ellipsoid_status_text((ellipsoid_status)fuzz_bits(&in, 4)));
    if (wild_options)
    {
        fuzz_wild_options(&in, &options);
    }
    if (!fuzz_check_model(&options, &model))
    {
        return 0;
    }
    fuzz_check_rotations(&in);
    fuzz_check_random(&in);

    fuzz_scene_read(&scene, &in, &options);
    fuzz_state(&in, scene.length, scene.speed, &start.state);
    elsewhere = read_elsewhere(&in, parts & 64, &scene, &options, &start.state);
    usual = start.state;
    if (wild_state)
    {
        fuzz_wild_state(&in, &start.state);
    }
    /* Stokes numbers below one: else the flow may fling the body away */
    tame = !wild_options && !wild_state && fuzz_scene_is_tame(&scene)
        && scene.speed / scene.length * model.relaxation_time < 1
        && scene.speed / scene.length * model.rotation_relaxation_time < 1;

    ellipsoid_facet_cache_clear(&warm);
    for (int n = 0; n <= 5; n++)
    {
        way = n < 5 ? between(&elsewhere, &usual, n / 5.0) : start.state;
        fuzz_check_pose(&model, &scene, &way, &warm);
    }
    fuzz_check_equations(&model, &scene, &start.state, tame);
    if (scene.mesh.count > 0)
    {
        fuzz_check_bead(&scene, &in);
    }
    tame = !read_start(&in, &options, &start) && tame;
    fuzz_check_advance(&model, &scene, &start, tame, &warm);
    fuzz_scene_free(&scene);
    return 0;
}
