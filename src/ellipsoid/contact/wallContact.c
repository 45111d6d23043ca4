/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    wallContact.c - the walls' force and torque on a cell in one state.
*/
#include "contact/contact.h"

#include <math.h>
#include <string.h>

static void add_elastic(const ellipsoid_state *state, const double arm[3],
                        double r[3][3], ellipsoid_point_force *felt,
                        ellipsoid_contact *contact,
                        ellipsoid_wrench_jacobian *jacobian)
{
    ellipsoid_add_force_at(arm, r, felt->force, contact->force,
                           contact->torque);
    if (jacobian)
    {
        ellipsoid_add_wrench_jacobian(arm, state->q, r, felt->force, felt->force_x,
                                  jacobian);
    }
}

static void add_bead(const ellipsoid_model *model, const ellipsoid_state *state,
                     const double arm[3], double r[3][3],
                     ellipsoid_point_force *push, ellipsoid_point_force *pull,
                     ellipsoid_contact *contact,
                     ellipsoid_wrench_jacobian *jacobian)
{
    contact->touching_beads++;
    if (model->dissipative)
    {
        ellipsoid_add_wall_friction(model, state, r, arm, push, contact, jacobian);
    }
    else
    {
        add_elastic(state, arm, r, push, contact, jacobian);
    }
    if (model->options.adhesion > 0)
    {
        add_elastic(state, arm, r, pull, contact, jacobian);
    }
}

/* A bead in the pose (x, R) */
static ellipsoid_bead placed(const ellipsoid_model *model, int b,
                             const double x[3], double r[3][3],
                             const ellipsoid_wall_laws *laws)
{
    ellipsoid_bead bead = {.radius = model->options.bead_radius, .laws = laws};

    for (int i = 0; i < 3; i++)
    {
        bead.centre[i] = x[i] + ellipsoid_dot(r[i], model->bead[b]);
    }
    return bead;
}

/*
    Beads that have moved less than they were from any facet need no look. The
    first round is of those that may feel a wall, in order; if none touches, the
    second finds the gap.
*/
static void sum_beads(const ellipsoid_model *model,
                      const ellipsoid_facet_cache *cache,
                      const ellipsoid_state *state, double moved,
                      ellipsoid_contact *contact,
                      ellipsoid_wrench_jacobian *jacobian)
{
    /* the bounds are rounded too */
    const double away = moved + 1e-9 * model->options.bead_radius;
    ellipsoid_wall_laws laws;
    ellipsoid_point_force push, pull;
    double r[3][3];

    ellipsoid_wall_laws_set(&laws, &model->options);
    ellipsoid_rotation_inline(state->q, r);
    for (int round = 0; round < 2 && contact->gap > 0; round++)
    {
        for (int b = 0; b < model->bead_count; b++)
        {
            const double clear =
                cache->nearest[b] - away - model->options.bead_radius;
            const ellipsoid_candidates from = {
                cache->facets, cache->facet + cache->first[b],
                cache->first[b + 1] - cache->first[b]};

            if (round == 0 ? clear > laws.range
                           : clear <= laws.range || clear >= contact->gap)
            {
                continue;
            }

            const ellipsoid_bead bead = placed(model, b, state->x, r, &laws);

            if (ellipsoid_bead_contact(&bead, &from, &contact->gap,
                                     jacobian != NULL, &push, &pull, contact)
                > 0)
            {
                add_bead(model, state, model->bead[b], r, &push, &pull,
                         contact, jacobian);
            }
        }
    }
    contact->deepest = fmax(0, -contact->gap);
}

ellipsoid_status ellipsoid_contact_evaluate(
    const ellipsoid_model *model,
    const ellipsoid_surroundings *surroundings,
    const ellipsoid_state *state,
    ellipsoid_facet_cache *cache,
    ellipsoid_contact *contact,
    ellipsoid_wrench_jacobian *jacobian)
{
    memset(contact, 0, sizeof *contact);
    contact->gap = contact->cell_gap = HUGE_VAL;
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
        /* it turns by q of length one */
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

    if (status == ELLIPSOID_OK && cache->clearance <= 0)
    {
        sum_beads(model, cache, state, moved, contact, jacobian);
    }
    return status;
}
