/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    fuzzContact.c - contact and overlap.
*/
#include "fuzzCheck.h"

/* What the contact says must fit together. */
static void check_contact(const ellipsoid_model *model, int has_walls,
                          const ellipsoid_contact *c)
{
    require(c->bead_contacts >= 0 && c->bead_contacts <= model->bead_count);
    require(c->surface_count >= 0
            && c->surface_count <= ELLIPSOID_MAX_SURFACES);
    require((c->surface_count > 0) == (c->bead_contacts > 0));
    require(has_walls ? c->gap <= model->options.bead_radius
                      : c->gap == HUGE_VAL);
    require(c->deepest == fmax(0, -c->gap));
    require(c->bead_contacts == 0 || c->deepest > 0
            || (model->options.adhesion > 0
                && c->gap < model->options.adhesion_range));
    for (int n = 0; n < c->surface_count; n++)
    {
        for (int m = 0; m < n; m++)
        {
            require(c->surface[n] != c->surface[m]);
        }
    }
}

void fuzz_check_pose(const ellipsoid_model *model, fuzz_scene *scene,
                     const ellipsoid_state *state, ellipsoid_facet_cache *warm)
{
    static ellipsoid_facet_cache cold;
    const int has_walls = model->options.contact && scene->around.walls;
    ellipsoid_contact contact, again;
    ellipsoid_wrench_jacobian jacobian;
    ellipsoid_status status;
    int overlaps = 2, all_overlaps = 2;

    ellipsoid_facet_cache_clear(&cold);
    status = ellipsoid_contact_evaluate(model, &scene->around, state, &cold,
                                        &contact, NULL);
    if (status == ELLIPSOID_OK)
    {
        check_contact(model, has_walls, &contact);
    }
    require(ellipsoid_overlaps_walls(model, &scene->around, state->x, state->q,
                                     &overlaps)
                != ELLIPSOID_OK
            || overlaps == 0 || overlaps == 1);
    if (!fuzz_scene_has_faultless_walls(scene))
    {
        return;
    }

    require(status
            == ellipsoid_contact_evaluate(model, &scene->around, state, warm,
                                          &again, &jacobian));
    if (status == ELLIPSOID_OK)
    {
        require_same(contact, again);
    }
    if (hypot(hypot(state->x[0], state->x[1]), state->x[2]) > 1e100)
    {
        return; /* the squares of distances overflow */
    }
    scene->generous = 1;
    ellipsoid_facet_cache_clear(&cold);
    require(status
            == ellipsoid_contact_evaluate(model, &scene->around, state, &cold,
                                          &again, NULL));
    if (status == ELLIPSOID_OK)
    {
        require_same(contact, again);
    }
    if (fuzz_is_unit(state->q))
    {
        ellipsoid_overlaps_walls(model, &scene->around, state->x, state->q,
                                 &all_overlaps);
        require(overlaps == all_overlaps);
    }
    scene->generous = 0;
}

void fuzz_check_bead(const fuzz_scene *scene, fuzz_input *in)
{
    double centre[3], force[3], force_x[3][3], again[3];
    const double radius = scene->length * fuzz_scaled(in, 1e-2, 1);
    const ellipsoid_facet_list facets = wall_mesh_all(&scene->mesh);
    int count;

    fuzz_vector(in, 4 * scene->length, 3, centre);
    if (fuzz_choice(in, 8) == 7)
    {
        centre[fuzz_choice(in, 3)] = fuzz_wild(in);
    }
    count = ellipsoid_bead_force(centre, radius, 1, &facets, force, force_x);
    require(count >= 0 && count <= scene->mesh.count);
    require(count
            == ellipsoid_bead_force(centre, radius, 1, &facets, again, NULL));
    require_same(force, again);
    if (scene->sound && fuzz_all_finite(centre, sizeof centre))
    {
        /* at most sixteen contacts, weights below one, two radii deep */
        require(fuzz_all_finite(force, sizeof force));
        require(hypot(hypot(force[0], force[1]), force[2])
                <= 16 * pow(2 * radius, 1.5));
    }
}
