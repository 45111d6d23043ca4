/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    wallContact.c - the walls' force and torque on a cell in one state.
*/
#include "contact/contact.h"

#include <math.h>
#include <string.h>

static void add_elastic(ellipsoid_wall_contact *at, const double arm[3],
                        ellipsoid_point_force *elastic)
{
    ellipsoid_add_force_at(arm, at->r, elastic->force, at->contact->force,
                           at->contact->torque);
    if (at->jacobian)
    {
        ellipsoid_add_wrench_jacobian(arm, at->state->q, at->r, elastic->force,
                                      elastic->force_x, at->jacobian);
    }
}

static void add_bead(ellipsoid_wall_contact *at, const double arm[3],
                     ellipsoid_bead_forces *forces)
{
    at->contact->bead_contacts++;
    if (at->model->dissipative)
    {
        const ellipsoid_friction_law law = ellipsoid_friction_law_of(at->model);

        ellipsoid_add_wall_friction(at, &law, arm, &forces->repulsion);
    }
    else
    {
        add_elastic(at, arm, &forces->repulsion);
    }
    if (forces->mirrors > 0)
    {
        const ellipsoid_friction_law law =
            ellipsoid_friction_law_at_mirror(at->model);

        ellipsoid_add_wall_friction(at, &law, arm, &forces->mirrored);
    }
    if (at->laws.attractive)
    {
        add_elastic(at, arm, &forces->attraction);
    }
}

static ellipsoid_bead bead_of(const ellipsoid_wall_contact *at, int b)
{
    const ellipsoid_model *model = at->model;
    ellipsoid_bead bead = {.radius = model->options.bead_radius,
                           .laws = &at->laws};

    for (int i = 0; i < 3; i++)
    {
        bead.centre[i] =
            at->state->x[i] + ellipsoid_dot(at->r[i], model->bead[b]);
    }
    return bead;
}

/* Looks for gaps below `range`, which is no more than the smallest so far, and
   for contacts; returns how many of these there are. clear: how far beyond the
   bead no facet is, as its move tells */
static inline int look_at_bead(ellipsoid_wall_contact *at,
                               const ellipsoid_facet_cache *cache, int b,
                               double clear, double range)
{
    const ellipsoid_bead bead = bead_of(at, b);
    const ellipsoid_candidates from = {
        cache->facets, cache->facet + cache->first[b],
        cache->first[b + 1] - cache->first[b], cache->away + cache->first[b],
        cache->nearest[b] - bead.radius - clear};
    ellipsoid_bead_forces forces;
    double gap = range;
    const int contacts = ellipsoid_bead_contact(
        &bead, &from, &gap, at->jacobian != NULL, &forces, at->contact);

    if (contacts > 0)
    {
        add_bead(at, at->model->bead[b], &forces);
    }
    if (gap < range)
    {
        at->contact->gap = gap;
    }
    return contacts;
}

/*
    A bead that has moved less than its distance from all facets needs no
    evaluation; `moved` is what none has moved more than. The first pass is over
    the beads that may be in range of a law, in their order, and looks no
    farther than that; if none overlaps, those without a contact find the gap,
    which does not depend on their order: so the nearest comes first.
*/
static void add_beads(ellipsoid_wall_contact *at,
                      const ellipsoid_facet_cache *cache, double moved)
{
    /* the bounds are rounded, too */
    const double radius = (1 + 1e-9) * at->model->options.bead_radius;
    ellipsoid_contact *contact = at->contact;
    double clear[ELLIPSOID_MAX_BEADS];
    ellipsoid_pose_change change;
    int near[ELLIPSOID_MAX_BEADS], count = 0, next = 0;

    ellipsoid_wall_laws_set(&at->laws, &at->model->options);
    ellipsoid_rotation_inline(at->state->q, at->r);
    ellipsoid_pose_change_set(cache, at->state->x, at->r, &change);

    const double range = at->laws.range, far = moved + radius + range;

    for (int n = 0; n < cache->bead_count; n++)
    {
        near[count] = n;
        count += cache->nearest[cache->bead[n]] <= far;
    }
    for (int k = 0; k < count; k++)
    {
        const int n = near[k], b = cache->bead[n];
        const double look = contact->gap < range ? contact->gap : range;

        clear[n] = cache->nearest[b] - radius
                 - sqrt(ellipsoid_squared_move(&change, at->model->bead[b]));
        if (clear[n] <= range && look_at_bead(at, cache, b, clear[n], look) > 0)
        {
            clear[n] = HUGE_VAL; /* its gap is known */
        }
    }
    for (int n = 0; n < cache->bead_count && contact->gap > 0; n++)
    {
        const double nearest = cache->nearest[cache->bead[n]];

        clear[n] = nearest <= far ? clear[n] : nearest - moved - radius;
    }
    while (contact->gap > 0 && next >= 0)
    {
        double least = contact->gap;

        next = -1;
        for (int n = 0; n < cache->bead_count; n++)
        {
            next = clear[n] < least ? n : next;
            least = clear[n] < least ? clear[n] : least;
        }
        if (next >= 0)
        {
            look_at_bead(at, cache, cache->bead[next], least, contact->gap);
            clear[next] = HUGE_VAL;
        }
    }
    contact->deepest = contact->gap < 0 ? -contact->gap : 0;
}

double ellipsoid_landing(const ellipsoid_model *model,
                         const ellipsoid_state *state,
                         const ellipsoid_facet_cache *cache, double moved,
                         double depth, double time)
{
    const double radius = model->options.bead_radius;
    const double speed = ellipsoid_length(state->u)
                       + model->reach * ellipsoid_length(state->omega);
    ellipsoid_wall_contact at = {.model = model, .state = state};

    ellipsoid_wall_laws_set(&at.laws, &model->options);
    ellipsoid_rotation_inline(state->q, at.r);

    const double range = radius + at.laws.range, beyond = moved + range;

    for (int n = 0; n < cache->bead_count; n++)
    {
        const int b = cache->bead[n];
        double turn[3], velocity[3], look;
        ellipsoid_bead bead;

        if (cache->nearest[b] - beyond > time * speed)
        {
            continue;
        }
        bead = bead_of(&at, b);
        ellipsoid_cross(state->omega, model->bead[b], turn);
        ellipsoid_product(at.r, turn, velocity);
        ellipsoid_add(velocity, state->u);
        /* how far the bead travels at most, until it is in contact */
        look = range + (1 + 1e-9) * time * ellipsoid_length(velocity);
        look = look < 2 * radius ? look : 2 * radius;
        for (int k = cache->first[b]; k < cache->first[b + 1]; k++)
        {
            ellipsoid_nearest found;

            if (cache->away[k] <= look + moved
                && ellipsoid_facet_nearest(&cache->facets[cache->facet[k]],
                                           bead.centre, look, &found)
                && found.height > range)
            {
                const double closing = -ellipsoid_dot(found.normal, velocity);
                const double way = found.height - range + depth;

                time = closing * time > way ? way / closing : time;
            }
        }
    }
    return time;
}

ellipsoid_status ellipsoid_contact_evaluate(
    const ellipsoid_model *model, const ellipsoid_surroundings *surroundings,
    const ellipsoid_state *state, ellipsoid_facet_cache *cache,
    ellipsoid_contact *contact, ellipsoid_wrench_jacobian *jacobian)
{
    *contact = ellipsoid_no_contact();
    if (jacobian)
    {
        memset(jacobian, 0, sizeof *jacobian);
    }
    if (!ellipsoid_has_walls(model, surroundings))
    {
        return ELLIPSOID_OK;
    }

    contact->gap = ellipsoid_gap_horizon(model);
    if (model->options.contact_shape == ELLIPSOID_CONTACT_ELLIPSOID)
    {
        /* its rotation is by a q of length one */
        if (!isnormal(ellipsoid_square4(state->q)))
        {
            return ELLIPSOID_NON_FINITE;
        }
        return ellipsoid_surface_contact_add(model, surroundings, state, cache,
                                             contact, jacobian);
    }

    double moved;
    const ellipsoid_status status = ellipsoid_facet_cache_update(
        cache, model, surroundings, state->x, state->q, contact->gap, &moved);

    if (status == ELLIPSOID_OK && cache->clearance <= 0
        && cache->nearest_of_all - moved
               < model->options.bead_radius * (2 + 1e-8))
    {
        ellipsoid_wall_contact at = {.model = model,
                                     .state = state,
                                     .contact = contact,
                                     .jacobian = jacobian};

        add_beads(&at, cache, moved);
    }
    return status;
}
