/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    nearPairs.c - which beads of which cells of a group may come into
    contact.

    The list holds all beads of two cells with gaps below the horizon and a
    margin, and is valid until a bead can have moved half the margin. What is
    summed is then the same, in the same order, whenever it was made.
*/
#include "motion/motion.h"

#include <math.h>

/* How far two beads may approach before the list is made anew, in radii. */
static const double margin = 0.5;

const ellipsoid_body *ellipsoid_placed_body(ellipsoid_group *g,
                                            const ellipsoid_evaluation *points,
                                            int cell)
{
    ellipsoid_body *b = &g->pairs->body[cell];

    if (!b->model)
    {
        ellipsoid_place_body(b, g->cell[cell].model, points[cell].state.x,
                             points[cell].state.q);
    }
    return b;
}

const double *ellipsoid_nearest_image(const ellipsoid_surroundings *around,
                                      const double to[3], const double x[3],
                                      double image[3])
{
    const double *best = x;
    double line[3], least;

    ellipsoid_difference(x, to, line);
    least = ellipsoid_dot(line, line);
    for (int n = 0; n < around->repeat_count; n++)
    {
        double at[3];

        ellipsoid_copy(x, at);
        ellipsoid_add(at, around->repeat[n]);
        ellipsoid_difference(at, to, line);
        if (ellipsoid_dot(line, line) < least)
        {
            least = ellipsoid_dot(line, line);
            ellipsoid_copy(at, image);
            best = image;
        }
    }
    return best;
}

/* Has a bead of this cell moved so far that the list may lack a contact? */
static int has_moved(const ellipsoid_pairs *pairs, const ellipsoid_model *model,
                     const ellipsoid_state *now, int cell)
{
    /* a quarter more for |q| that are not one */
    return 1.25 * ellipsoid_travel(model, &pairs->listed_at[cell], now)
         > 0.5 * margin * model->options.bead_radius;
}

static ellipsoid_status collect(ellipsoid_group *g,
                                const ellipsoid_evaluation *points)
{
    ellipsoid_pairs *pairs = g->pairs;

    pairs->near_count = 0;
    for (int a = 0; a < g->count; a++)
    {
        for (int b = a + 1; b < g->count; b++)
        {
            const ellipsoid_model *of_a = g->cell[a].model;
            const ellipsoid_model *of_b = g->cell[b].model;
            const double far = ellipsoid_pair_horizon(of_a, of_b)
                             + margin
                                   * fmax(of_a->options.bead_radius,
                                          of_b->options.bead_radius);
            ellipsoid_near_pair *near = &pairs->near[pairs->near_count];
            double place[3];
            const double *x_b = ellipsoid_nearest_image(
                &g->cell[a].surroundings, points[a].state.x, points[b].state.x,
                place);
            ellipsoid_body body_b;

            if (ellipsoid_are_apart(of_a, points[a].state.x, of_b, x_b, far))
            {
                continue;
            }
            ellipsoid_placed_body(g, points, a);
            body_b = *ellipsoid_placed_body(g, points, b);
            body_b.x = x_b;
            if (ellipsoid_pair_is_exact(of_a, of_b))
            {
                near->listed =
                    ellipsoid_surface_gap(&pairs->body[a], &body_b) < far;
            }
            else
            {
                ellipsoid_list_beads(&pairs->body[a], &body_b, far, near);
            }
            near->a = a;
            near->b = b;
            pairs->near_count += near->listed != 0;
            if (pairs->near_count > pairs->near_capacity)
            {
                pairs->is_listed = 0;
                g->failed = b;
                return ELLIPSOID_TOO_MANY_CELLS;
            }
        }
    }
    return ELLIPSOID_OK;
}

ellipsoid_status
ellipsoid_near_pairs_collect(ellipsoid_group *g,
                             const ellipsoid_evaluation *points)
{
    ellipsoid_pairs *pairs = g->pairs;
    int current = pairs->is_listed;

    for (int cell = 0; current && cell < g->count; cell++)
    {
        current =
            !has_moved(pairs, g->cell[cell].model, &points[cell].state, cell);
    }
    if (current)
    {
        return ELLIPSOID_OK;
    }
    for (int cell = 0; cell < g->count; cell++)
    {
        pairs->listed_at[cell] = points[cell].state;
    }
    pairs->is_listed = 1;
    return collect(g, points);
}
