/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    pushingCells.c - a hundred cells that settle in a box of fluid at rest and
    push one another: walls made of triangles, and a world.
*/
#include "surroundings.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define CELLS 100

/* Above the floor in rows, turned at random. Each looks for walls by itself, and
   has surroundings of its own, whose id names it. */
static void set_cells(ellipsoid_world_body body[CELLS],
                      const ellipsoid_model *model,
                      const ellipsoid_surroundings *around, char *caches)
{
    static ellipsoid_surroundings own[CELLS];

    for (int n = 0; n < CELLS; n++)
    {
        double uniform[3];

        body[n].model = model;
        own[n] = *around;
        own[n].id = n;
        body[n].surroundings = &own[n];
        body[n].cache = (ellipsoid_facet_cache *)caches;
        ellipsoid_facet_cache_clear(body[n].cache);
        caches += ellipsoid_facet_cache_size(model);
        ellipsoid_random_uniform(1, n, 0, 0, 3, uniform);
        ellipsoid_quaternion_from_uniform(uniform, body[n].state.q);
        body[n].state.x[0] = (3 + 3.3 * (n % 10)) * um;
        body[n].state.x[1] = (3 + 3.3 * (n / 10)) * um;
        body[n].state.x[2] = (3 + 4 * (n % 2)) * um;
    }
}

/* Why the first cell that is gone is, if any. */
static ellipsoid_status status_of(const ellipsoid_world_body body[CELLS])
{
    for (int n = 0; n < CELLS; n++)
    {
        if (body[n].phase == ELLIPSOID_GONE)
        {
            return body[n].status;
        }
    }
    return ELLIPSOID_OK;
}

static void print_cells(double t, const ellipsoid_world_body body[CELLS])
{
    double height = 0, deepest = 0, force = 0;
    int touching = 0;

    for (int n = 0; n < CELLS; n++)
    {
        const ellipsoid_contact *contact = &body[n].contact;

        height += body[n].state.x[2] / CELLS;
        touching += contact->cell_count > 0;
        deepest = fmax(deepest, fmax(contact->deepest, contact->cell_deepest));
        force -= contact->force[2] / body[n].model->constant_force[2] / CELLS;
    }
    printf("%5.1f %8.3f %4d %.5f %.6f\n", t, height / um, touching,
           deepest / um, force);
}

int main(void)
{
    static ellipsoid_world_body body[CELLS];
    static ellipsoid_member member[CELLS];
    ellipsoid_world_bodies bodies = {
        .count = CELLS, .body = body, .largest = CELLS, .member = member};
    ellipsoid_world_cells cells;
    const double low[3] = {0, 0, 0}, high[3] = {36 * um, 36 * um, 20 * um};
    double point[8][3];
    int corner[12][3], index[12] = {0};
    const ellipsoid_triangles box = {
        8, (const double(*)[3])point, 12, (const int(*)[3])corner, NULL, NULL};
    const ellipsoid_walls_options as_given = {.same_point = 0};
    ellipsoid_walls *made = NULL;
    ellipsoid_options options = ellipsoid_options_default();
    ellipsoid_model model;

    options.density = 1500;
    options.tolerance = 1e-4; /* overlaps are below a nanometre */
    options.motion = ELLIPSOID_MOTION_INERTIALESS;
    options.wall_resistance =
        ELLIPSOID_WALL_RESISTANCE_NONE; /* contact alone */
    options.contact_shape = ELLIPSOID_CONTACT_ELLIPSOID;
    ellipsoid_status status = ellipsoid_model_init(&model, &options);

    ellipsoid_box(low, high, point, corner);
    const size_t walls_size = ellipsoid_walls_size(&box, &as_given);
    const size_t world_size = ellipsoid_world_size(CELLS, sizeof *body, 0);
    void *walls_memory = malloc(walls_size), *world = malloc(world_size);
    char *caches = malloc(CELLS * ellipsoid_facet_cache_size(&model));

    bodies.memory = malloc(ellipsoid_group_size(CELLS));
    if (!walls_memory || !world || !caches || !bodies.memory)
    {
        status = ELLIPSOID_BAD_ARGUMENT;
    }
    if (status == ELLIPSOID_OK)
    {
        status = ellipsoid_walls_create(walls_memory, walls_size, &box,
                                        &as_given, &made, NULL);
    }

    ellipsoid_walls_context walls = {made, 12, index};
    const ellipsoid_surroundings around = {.flow = fluid_at_rest,
                                           .walls = ellipsoid_walls_list,
                                           .walls_context = &walls};

    if (status == ELLIPSOID_OK)
    {
        set_cells(body, &model, &around, caches);
        ellipsoid_world_cells_set(&cells, &bodies);
    }
    printf("# t[s]  mean height[um]  cells that touch others  deepest[um]  "
           "force of the walls/weight\n");
    for (int n = 0; n < 200 && status == ELLIPSOID_OK; n++)
    {
        status = ellipsoid_world_advance(world, world_size, &cells, 0.1 * n,
                                         0.1 * (n + 1));
        if (status == ELLIPSOID_OK)
        {
            status = status_of(body);
        }
        if (n % 20 == 19)
        {
            print_cells(0.1 * (n + 1), body);
        }
    }
    printf("# %s, %ld steps\n", ellipsoid_status_text(status),
           bodies.statistics.accepted);
    free(walls_memory);
    free(world);
    free(caches);
    free(bodies.memory);
    return status != ELLIPSOID_OK;
}
