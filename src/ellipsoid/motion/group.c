/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    group.c - one cell, or several that may touch, are made a group and
    advanced, from one noise interval to the next.
*/
#include "body/arena.h"
#include "motion/motion.h"

#include <math.h>
#include <string.h>

/* Memory for as many neighbours of a cell, in the mean: touching, and near.
   Twelve fit around it. */
static const int touching_each = 16, near_each = 32;

/* Can these go together, and at all? */
static ellipsoid_status check(const ellipsoid_group *g)
{
    const ellipsoid_cell *first = &g->cell[0];

    for (int cell = 0; cell < g->count; cell++)
    {
        const ellipsoid_cell *p = &g->cell[cell];

        if (p->inertial != first->inertial || !p->noise != !first->noise
            || (p->noise
                && p->model->options.noise_interval
                       != first->model->options.noise_interval)
            || (!p->inertial && !(p->rate > 0)))
        {
            return ELLIPSOID_BAD_OPTION;
        }
    }
    return ELLIPSOID_OK;
}

/* What the forces on one more cell ask of the method. */
static void set_kind(ellipsoid_group *g, const ellipsoid_model *model,
                     const ellipsoid_surroundings *surroundings)
{
    g->stiff = g->stiff || model->has_dipole || surroundings->force != NULL;
    g->unsteady = g->unsteady || surroundings->unsteady;
    g->dissipative = g->dissipative || model->dissipative
                  || ellipsoid_force_is_dissipative(surroundings);
}

static int is_complete(const ellipsoid_member *m)
{
    return m->model && m->surroundings && m->state && m->controller
        && m->statistics
        && (m->cache
            || !(ellipsoid_has_walls(m->model, m->surroundings)
                 || ellipsoid_has_near_walls(m->model, m->surroundings)));
}

/* Is its random force that near walls? */
static int is_near_walls(const ellipsoid_cell *p)
{
    return !p->fixed && ellipsoid_has_near_walls(p->model, &p->surroundings);
}

/* Evaluates what acts on the cells at rest, without noise; where none touches a
   wall, their contacts alone. */
static ellipsoid_status evaluate_at_rest(ellipsoid_group *g, double t)
{
    ellipsoid_status status = ELLIPSOID_OK;
    int touching = 0;

    for (int cell = 0; status == ELLIPSOID_OK && cell < g->count; cell++)
    {
        ellipsoid_cell *p = &g->cell[cell];
        ellipsoid_evaluation *rest = &g->next[cell];

        rest->state = g->start[cell].state;
        ellipsoid_set_no_rates(&rest->state);
        memset(&g->noise[cell], 0, sizeof g->noise[cell]);
        p->surroundings.time = t;
        if (is_near_walls(p))
        {
            g->failed = cell;
            status = ellipsoid_contact_evaluate(p->model, &p->surroundings,
                                                &rest->state, p->cache,
                                                &rest->contact, NULL);
            touching = touching || rest->contact.bead_contacts > 0;
        }
    }
    if (status == ELLIPSOID_OK && touching)
    {
        status = ellipsoid_group_evaluate_once(g, g->next, 0, 0);
    }
    return ellipsoid_status_at_start(status);
}

/* The noise of all cells from t on, and until when. Near walls the interval ends
   with the run, too, as it cannot be continued: the resistance was that of its
   start. What is left until then is divided evenly, so that no interval is much
   shorter than it has to be: the force grows as it gets shorter. */
static ellipsoid_status set_noise(ellipsoid_group *g, double t, double end,
                                  double *until)
{
    ellipsoid_status status = evaluate_at_rest(g, t);
    double whole = end;
    int near = 0;

    *until = end;
    for (int cell = 0; status == ELLIPSOID_OK && cell < g->count; cell++)
    {
        const ellipsoid_cell *p = &g->cell[cell];
        ellipsoid_noise *noise = &g->noise[cell];

        status = ellipsoid_noise_at(p->model, &p->surroundings, t, noise);
        if (noise->end < whole - noise->tolerance)
        {
            whole = noise->end;
        }
        if (status == ELLIPSOID_OK && is_near_walls(p))
        {
            const ellipsoid_evaluation *rest = &g->next[cell];
            ellipsoid_load load = {.push = {0}};

            for (int i = 0; i < 3 && rest->contact.bead_contacts > 0; i++)
            {
                load.push[i] = rest->contact.force[i];
                load.force[i] =
                    p->model->mass * rest->derivative.u[i] - load.push[i];
            }
            status = ellipsoid_wall_noise_begin(p->model, &p->surroundings,
                                                &g->start[cell].state, p->cache,
                                                t, &load, noise);
        }
        if (noise->end < *until - noise->tolerance)
        {
            *until = noise->end;
        }
        near = near || noise->near;
    }
    if (status == ELLIPSOID_OK && near && *until < whole)
    {
        *until = t + (whole - t) / ceil((whole - t) / (*until - t));
    }
    for (int cell = 0; status == ELLIPSOID_OK && cell < g->count; cell++)
    {
        if (g->noise[cell].near)
        {
            ellipsoid_wall_noise_set(g->cell[cell].model,
                                     &g->cell[cell].surroundings, *until,
                                     &g->noise[cell]);
        }
    }
    return status;
}

/* From noise interval to noise interval, to the end. */
static ellipsoid_status advance(ellipsoid_group *g,
                                const ellipsoid_member members[], double *t,
                                double end, ellipsoid_observer observer)
{
    ellipsoid_status status;
    long attempts = 0;

    for (int cell = 0; cell < g->count; cell++)
    {
        if (!is_complete(&members[cell]))
        {
            return ELLIPSOID_BAD_ARGUMENT;
        }
    }
    if (!isfinite(*t) || !isfinite(end))
    {
        return ELLIPSOID_NON_FINITE;
    }
    if (!(*t < end))
    {
        return ELLIPSOID_OK;
    }
    g->failed = -1;
    g->observed = observer != NULL;
    for (int cell = 0; cell < g->count; cell++)
    {
        g->cell[cell] = ellipsoid_cell_of(&members[cell], &g->noise[cell]);
        set_kind(g, members[cell].model, members[cell].surroundings);
        g->start[cell].contact = g->next[cell].contact = ellipsoid_no_contact();
    }
    g->inertial = g->cell[0].inertial;
    status = check(g);
    while (status == ELLIPSOID_OK && *t < end)
    {
        double until = end;

        status = ellipsoid_group_start(g, members);
        if (status == ELLIPSOID_OK && g->cell[0].noise)
        {
            status = set_noise(g, *t, end, &until);
        }
        if (status == ELLIPSOID_OK)
        {
            status = ellipsoid_group_advance(g, members, t, until, observer,
                                             &attempts);
        }
    }
    return status;
}

ellipsoid_status ellipsoid_advance(const ellipsoid_member *alone, double *t,
                                   double end, ellipsoid_observer observer)
{
    ellipsoid_statistics unused = {0};
    ellipsoid_member member;
    ellipsoid_cell cell;
    ellipsoid_evaluation start, next;
    ellipsoid_stages stages;
    ellipsoid_stage_matrix system;
    ellipsoid_step step;
    ellipsoid_noise noise = {.near = 0};
    ellipsoid_group g = {
        .count = 1,
        .cell = &cell,
        .start = &start,
        .next = &next,
        .stages = &stages,
        .system = &system,
        .step = &step,
        .noise = &noise,
    };

    if (!alone || !t)
    {
        return ELLIPSOID_BAD_ARGUMENT;
    }
    member = *alone;
    member.statistics = alone->statistics ? alone->statistics : &unused;
    return advance(&g, &member, t, end, observer);
}

/* ---------------------------------------------------------------- memory */

/* Takes `count` things of a size from the memory, or only counts bytes. */
static void *take(unsigned char *memory, size_t *used, size_t size,
                  size_t count)
{
    unsigned char *at = memory ? memory + *used : NULL;

    *used += ellipsoid_piece(count, size);
    return at;
}

size_t ellipsoid_group_lay_out(int count, void *memory, ellipsoid_group *g,
                               ellipsoid_pairs *pairs)
{
    const size_t squared = (size_t)count * (size_t)count;
    double(*bead)[ELLIPSOID_MAX_BEADS][3];
    size_t used = 0;

    memset(g, 0, sizeof(*g));
    memset(pairs, 0, sizeof(*pairs));
    g->count = count;
    g->pairs = pairs;
    g->cell = take(memory, &used, sizeof(*g->cell), count);
    g->start = take(memory, &used, sizeof(*g->start), count);
    g->next = take(memory, &used, sizeof(*g->next), count);
    g->stages = take(memory, &used, sizeof(*g->stages), count);
    g->system = take(memory, &used, sizeof(*g->system), count);
    g->step = take(memory, &used, sizeof(*g->step), count);
    g->noise = take(memory, &used, sizeof(*g->noise), count);
    pairs->capacity = touching_each * count;
    pairs->coupling =
        take(memory, &used, sizeof(*pairs->coupling), pairs->capacity);
    pairs->near_capacity = near_each * count;
    /* one more, where the next is tried */
    pairs->near =
        take(memory, &used, sizeof(*pairs->near), pairs->near_capacity + 1);
    pairs->listed_at = take(memory, &used, sizeof(*pairs->listed_at), count);
    pairs->body = take(memory, &used, sizeof(*pairs->body), count);
    pairs->smoothed = take(memory, &used, sizeof(*pairs->smoothed), count);
    bead = take(memory, &used, sizeof(*bead), count);
    for (int cell = 0; memory && cell < count; cell++)
    {
        pairs->body[cell].bead = bead[cell];
    }
    pairs->block = take(memory, &used, sizeof(*pairs->block), squared);
    pairs->blocks = take(memory, &used, sizeof(*pairs->blocks), squared);
    pairs->rates = take(memory, &used, sizeof(*pairs->rates), count);
    return used;
}

size_t ellipsoid_group_size(int count)
{
    ellipsoid_group g;
    ellipsoid_pairs pairs;

    return count < 1 || count > ELLIPSOID_MAX_GROUP
             ? 0
             : ellipsoid_group_lay_out(count, NULL, &g, &pairs);
}

ellipsoid_status ellipsoid_advance_group(int count,
                                         const ellipsoid_member members[],
                                         double *t, double end,
                                         ellipsoid_observer observer,
                                         void *memory, int *which)
{
    ellipsoid_group g;
    ellipsoid_pairs pairs;
    ellipsoid_status status;

    if (!members || !t || !memory || !which)
    {
        return ELLIPSOID_BAD_ARGUMENT;
    }
    *which = -1;
    if (count < 1 || count > ELLIPSOID_MAX_GROUP)
    {
        return ELLIPSOID_BAD_OPTION;
    }
    ellipsoid_group_lay_out(count, memory, &g, &pairs);
    if (count == 1)
    {
        g.pairs = NULL;
    }
    status = advance(&g, members, t, end, observer);
    *which = status == ELLIPSOID_OK ? -1 : g.failed;
    return status;
}
