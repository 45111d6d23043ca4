/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    fuzzMotion.c - the equations, and their advance in time.
*/
#include "fuzzCheck.h"

/* ------------------------------------------------------------ equations */

static ellipsoid_facet_cache *fresh(fuzz_scene *scene)
{
    static ellipsoid_facet_cache cache;

    scene->flow_gave_up = scene->walls_gave_up = 0;
    scene->field_gave_up = scene->force_gave_up = 0;
    ellipsoid_facet_cache_clear(&cache);
    return &cache;
}

static int is_balanced(const ellipsoid_model *model, const fuzz_scene *scene)
{
    return model->options.drag && scene->around.flow;
}

static void check_balance(const ellipsoid_model *model, fuzz_scene *scene,
                          const ellipsoid_state *state, int tame)
{
    ellipsoid_state at = *state;
    const ellipsoid_status status =
        ellipsoid_balance(model, &scene->around, &at, fresh(scene));

    require((status == ELLIPSOID_BAD_OPTION) == !is_balanced(model, scene));
    if (status != ELLIPSOID_OK)
    {
        require_same(at, *state);
        require(!tame || status == ELLIPSOID_BAD_OPTION
                || status == ELLIPSOID_TOO_MANY_FACETS);
        return;
    }
    require(fuzz_all_finite(at.u, sizeof at.u));
    require(fuzz_all_finite(at.omega, sizeof at.omega));
    require_same(at.x, state->x);
    require_same(at.q, state->q);
}

void fuzz_check_equations(const ellipsoid_model *model, fuzz_scene *scene,
                          const ellipsoid_state *state, int tame)
{
    const int inertial = model->options.motion == ELLIPSOID_MOTION_INERTIAL;
    const ellipsoid_state before = *state;
    double jacobian[ELLIPSOID_STATE_SIZE][ELLIPSOID_STATE_SIZE];
    ellipsoid_state rate, again = *state;
    ellipsoid_status status;

    status = ellipsoid_rhs(model, &scene->around, state, fresh(scene), &rate);
    require_same(*state, before);
    require((status == ELLIPSOID_BAD_OPTION)
            == !(inertial || is_balanced(model, scene)));
    require(!tame || status == ELLIPSOID_OK || status == ELLIPSOID_BAD_OPTION
            || status == ELLIPSOID_TOO_MANY_FACETS);
    require(status != ELLIPSOID_OK || fuzz_all_finite(&rate, sizeof rate));
    if (!inertial)
    {
        /* results, which are not read */
        again.u[0] = again.omega[2] = NAN;
    }
    require(
        status
        == ellipsoid_rhs(model, &scene->around, &again, fresh(scene), &again));
    require(status != ELLIPSOID_OK || memcmp(&rate, &again, sizeof rate) == 0);

    status = ellipsoid_jacobian(model, &scene->around, state, fresh(scene),
                                jacobian);
    require(!tame || status != ELLIPSOID_OK
            || fuzz_all_finite(jacobian, sizeof jacobian));
    check_balance(model, scene, state, tame);
}

/* -------------------------------------------------------------- advance */

/* A run, and what its observer saw */
typedef struct run
{
    const ellipsoid_model *model;
    fuzz_scene *scene;
    fuzz_start now;
    long stop_after; /* steps; 0: never */

    ellipsoid_state last;
    double last_time, deepest;
    long steps;
    ellipsoid_contact contact;
} run;

static void check_dense_output(const ellipsoid_step *step)
{
    ellipsoid_state state;

    ellipsoid_step_state(step, step->start, &state);
    require_same(state, step->before);
    ellipsoid_step_state(step, step->end, &state);
    require_same(state, step->after);
    for (int n = 1; n < 4; n++)
    {
        const double t = step->start + n * (step->end - step->start) / 4;

        ellipsoid_step_state(step, t, &state);
        require(fuzz_all_finite(&state, sizeof state));
        require(fuzz_is_unit(state.q));
    }
}

/* A step begins where the last one ended; but where the random force jumps, so
   do u and omega, and with inertia the pose by what they relax in. */
static int is_continued(const run *r, const ellipsoid_step *step)
{
    const ellipsoid_options *o = &r->model->options;
    const ellipsoid_state *a = &r->last, *b = &step->before;

    if (!o->brownian)
    {
        return memcmp(a, b, sizeof *a) == 0;
    }
    return o->motion == ELLIPSOID_MOTION_INERTIAL
        || (memcmp(a->x, b->x, sizeof a->x) == 0
            && memcmp(a->q, b->q, sizeof a->q) == 0);
}

static int observe(void *context, const ellipsoid_step *step)
{
    run *r = context;

    require(step->end > step->start);
    require(step->start == r->last_time);
    require(r->steps == 0 || is_continued(r, step));
    require(fuzz_all_finite(&step->before, sizeof step->before));
    require(fuzz_all_finite(&step->after, sizeof step->after));
    require(fuzz_is_unit(step->before.q) && fuzz_is_unit(step->after.q));
    check_dense_output(step);
    r->last = step->after;
    r->last_time = step->end;
    r->contact = step->contact;
    r->deepest = fmax(r->deepest, step->contact.deepest);
    r->steps++;
    return r->steps == r->stop_after;
}

/* Nothing to do, or no time to do it in */
static void check_no_run(const fuzz_start *before, const fuzz_start *now,
                         ellipsoid_status status)
{
    const int finite = isfinite(before->t) && isfinite(before->end);

    require(status == (finite ? ELLIPSOID_OK : ELLIPSOID_NON_FINITE));
    require_same(now->state, before->state);
    require_same(now->t, before->t);
    require_same(now->controller, before->controller);
    require_same(now->statistics, before->statistics);
}

/* Of a fixed body. */
static int stays(const ellipsoid_state *is, const ellipsoid_state *was)
{
    double speed = 0, move = 0;

    for (int i = 0; i < 3; i++)
    {
        speed += fabs(is->u[i]) + fabs(is->omega[i]);
        move += fabs(is->x[i] - was->x[i]); /* 0 from -0 is none */
    }
    return speed == 0 && move == 0;
}

static void check_result(const run *r, const fuzz_start *before,
                         ellipsoid_status status)
{
    const ellipsoid_options *o = &r->model->options;
    const ellipsoid_statistics *was = &before->statistics;
    const ellipsoid_statistics *is = &r->now.statistics;
    const long accepted = is->accepted - was->accepted;
    const long rejected = is->rejected - was->rejected;

    require(accepted >= 0 && rejected >= 0);
    require(accepted + rejected <= o->maximum_steps);
    require(is->rhs >= was->rhs && is->jacobians >= was->jacobians);
    require(is->deepest >= was->deepest);
    if (accepted > 0 || status == ELLIPSOID_OK)
    {
        require(fuzz_all_finite(&r->now.state, sizeof r->now.state));
        require(fuzz_is_unit(r->now.state.q));
        require(!r->scene->around.fixed
                || stays(&r->now.state, &before->state));
    }
    else
    {
        require_same(r->now.state, before->state);
        require_same(r->now.t, before->t);
        require_same(r->now.controller, before->controller);
    }
    require(r->now.t <= before->end);
    require(status != ELLIPSOID_OK || r->now.t == before->end);
    require((status == ELLIPSOID_BAD_OPTION)
            == (o->motion == ELLIPSOID_MOTION_INERTIALESS
                && !is_balanced(r->model, r->scene)));
    require(status != ELLIPSOID_FLOW_FAILED || r->scene->flow_gave_up
            || r->scene->field_gave_up);
    require(status == ELLIPSOID_FLOW_FAILED || !r->scene->flow_gave_up);
    require(status != ELLIPSOID_WALLS_FAILED || r->scene->walls_gave_up);
    require((status == ELLIPSOID_FORCE_FAILED) == r->scene->force_gave_up);
}

static void check_observed(const run *r, const fuzz_start *before,
                           ellipsoid_status status)
{
    const ellipsoid_statistics *is = &r->now.statistics;

    require(is->accepted - before->statistics.accepted == r->steps);
    require_same(r->last, r->now.state);
    require_same(r->last_time, r->now.t);
    require(is->deepest == r->deepest);
    require((status == ELLIPSOID_STOPPED)
            == (r->stop_after > 0 && r->steps == r->stop_after));
}

static ellipsoid_status go(run *r, ellipsoid_facet_cache *cache, int observed)
{
    const fuzz_start before = r->now;
    ellipsoid_status status;

    r->scene->flow_gave_up = r->scene->walls_gave_up = 0;
    r->scene->field_gave_up = r->scene->force_gave_up = 0;
    r->scene->strict = 1;
    r->last = r->now.state;
    r->last_time = r->now.t;
    r->steps = 0;
    r->deepest = before.statistics.deepest;
    status = ellipsoid_advance(
        &(ellipsoid_member){r->model, &r->scene->around, &r->now.state,
                            &r->now.controller, cache, r, &r->now.statistics},
        &r->now.t, r->now.end, observed ? observe : NULL);
    r->scene->strict = 0;

    if (!(before.end > before.t) || !isfinite(before.t)
        || !isfinite(before.end))
    {
        check_no_run(&before, &r->now, status);
        return status;
    }
    check_result(r, &before, status);
    if (observed)
    {
        check_observed(r, &before, status);
    }
    require(observed || status != ELLIPSOID_STOPPED);
    return status;
}

/* Who stops where the random force has just jumped starts with the jump; near
   walls, whose noise is of the pose where it begins, anywhere. */
static int is_at_jump(const ellipsoid_model *model, double t)
{
    const double place = t / model->options.noise_interval;

    return model->options.brownian
        && (model->options.wall_resistance
            || fabs(place - round(place)) < 2e-15 * fmax(1, fabs(place)));
}

/* The last step's contact is that of the pose where it ended; and so, without
   inertia and noise, are u and omega. */
static void check_last_pose(const run *r)
{
    const ellipsoid_options *o = &r->model->options;
    ellipsoid_contact contact;
    ellipsoid_state balanced = r->now.state;

    require(ellipsoid_contact_evaluate(r->model, &r->scene->around,
                                       &r->now.state, fresh(r->scene), &contact,
                                       NULL)
            == ELLIPSOID_OK);
    require_same(contact, r->contact);
    if (o->motion == ELLIPSOID_MOTION_INERTIALESS && !o->brownian
        && !r->scene->around.fixed)
    {
        require(ellipsoid_balance(r->model, &r->scene->around, &balanced,
                                  fresh(r->scene))
                == ELLIPSOID_OK);
        require_same(balanced, r->now.state);
    }
}

void fuzz_check_advance(const ellipsoid_model *model, fuzz_scene *scene,
                        const fuzz_start *start, int tame,
                        ellipsoid_facet_cache *warm)
{
    const int cached =
        (model->options.contact || model->options.wall_resistance)
        && scene->around.walls;
    const int pure = !cached || fuzz_scene_has_faultless_walls(scene);
    const run at_start = {.model = model, .scene = scene, .now = *start};
    run whole = at_start, again = at_start;
    ellipsoid_facet_cache *const cold = fresh(scene);
    const ellipsoid_status status = go(&whole, cached ? cold : NULL, 1);

    require(!tame || status != ELLIPSOID_NON_FINITE);
    if (whole.steps > 0 && pure)
    {
        check_last_pose(&whole);
    }
    ellipsoid_facet_cache_clear(cold);
    require(status == go(&again, pure ? warm : cold, 0));
    require_same(again.now.state, whole.now.state);
    require_same(again.now.t, whole.now.t);
    require_same(again.now.controller, whole.now.controller);
    require_same(again.now.statistics, whole.now.statistics);

    if (status != ELLIPSOID_OK || whole.steps < 2)
    {
        return;
    }
    again = at_start;
    again.stop_after = 1 + whole.steps / 2;
    ellipsoid_facet_cache_clear(cold);
    require(go(&again, cold, 1) == ELLIPSOID_STOPPED);
    if (pure && again.now.t < again.now.end && !is_at_jump(model, again.now.t))
    {
        again.stop_after = 0;
        ellipsoid_facet_cache_clear(cold);
        require(go(&again, cold, 1) == ELLIPSOID_OK);
        require_same(again.now.state, whole.now.state);
        require_same(again.now.controller, whole.now.controller);
    }
}
