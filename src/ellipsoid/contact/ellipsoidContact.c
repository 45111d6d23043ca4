/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    ellipsoidContact.c - the walls' force and torque on an ellipsoid.

    Contacts are local minima of the ellipsoid's distance to the wall
    (ellipsoidFacets.c). Law and sum are those of a bead (beadContact.c, contactBlending.h), the
    force acts at the contact point on the ellipsoid: one contact is
    conservative, with the potential 2/5 k d^2.5.

    Contacts of a bead along one normal are at one place, those of a long body
    need not be: a rod across a slit rests on both its edges. So contacts count
    each on its own where their places differ by a bead's radius more than a
    sphere's would, unless one is about to end: shadow().
*/
#include "contact/contact.h"

#define BLENDING_VARIABLES ELLIPSOID_SURFACE_VARIABLES

typedef ellipsoid_surface_contact contact;

#include "contact/contactBlending.h"

static void take(contacts *all, const contact *found, double felt, double size,
                 int surface, ellipsoid_contact *report)
{
    report->gap = fmin(report->gap, found->height);
    if (found->height < felt)
    {
        add(all, found, size);
        note_surface(report, surface);
    }
}

/* Has the centre been pushed into the wall, no farther than `reach`? Then what
   is nearest to it is a face seen from behind. */
static int is_inside(const ellipsoid_surface *body,
                     const ellipsoid_candidates *from, double reach)
{
    double clear = reach;
    int inside = 0;

    for (int k = 0; k < from->count; k++)
    {
        ellipsoid_nearest found;

        if (ellipsoid_facet_nearest(&from->facets[from->index[k]], body->centre,
                                    reach, &found))
        {
            const double away = fabs(found.height) / (found.height < 0
                                                          ? 1 - same
                                                          : 1);

            if (away < clear)
            {
                clear = away;
                inside = found.height < 0;
            }
        }
    }
    return inside;
}

/*
    Deeper in a corner than its radius of curvature, an ellipsoid may have no
    contact: every face that it cuts has its deepest point in it beside the
    face. The least deep pushes it out then, so that it is neither lost in the
    wall nor taken to be clear of it.
*/
static void find_deepest(const ellipsoid_surface *body,
                         const ellipsoid_candidates *from, double range,
                         contacts *all, ellipsoid_contact *report)
{
    const double *a = body->axes;
    const double sharpest = body->smallest * body->smallest
                          / fmax(a[0], fmax(a[1], a[2]));
    contact found, least = {.height = -HUGE_VAL};
    int surface = -1, deep = 0;

    for (int k = 0; k < from->count; k++)
    {
        const ellipsoid_facet *facet = &from->facets[from->index[k]];

        if (ellipsoid_surface_pushed_out(facet, body, &found))
        {
            deep = deep || -found.height > sharpest * (1 + same);
            if (found.height > least.height)
            {
                least = found;
                surface = facet->surface;
            }
        }
    }
    if (deep)
    {
        take(all, &least, range, body->smallest, surface, report);
    }
}

/*
    All contacts. report->gap is lowered to the smallest height. A face seen
    from behind counts only if the centre has been pushed into the wall, and of
    several the nearest. Otherwise it is the far side of a thin wall.
*/
static void find_contacts(const ellipsoid_surface *body,
                          const ellipsoid_candidates *from, double range,
                          contacts *all, ellipsoid_contact *report)
{
    contact found, behind;
    double nearest = -HUGE_VAL;
    int surface = 0, seen = 0;

    all->count = 0;
    for (int k = 0; k < from->count; k++)
    {
        const ellipsoid_facet *facet = &from->facets[from->index[k]];
        const double reach = report->gap > range ? report->gap : range;

        const int side = ellipsoid_surface_nearest(facet, body, reach, &found);

        if (side == 0)
        {
            continue;
        }
        if (side == 1)
        {
            take(all, &found, range, body->smallest, facet->surface, report);
        }
        else if (found.height + found.support > nearest)
        {
            behind = found;
            nearest = found.height + found.support;
            surface = facet->surface;
            seen = 1;
        }
    }
    if (seen && is_inside(body, from, body->smallest))
    {
        take(all, &behind, range, body->smallest, surface, report);
    }
    if (report->gap >= 0)
    {
        find_deepest(body, from, range, all, report);
    }
}

static scalar rise(const contacts *all, const mix *m, const scalar *c, int i,
                   int j)
{
    const contact *a = &all->at[i], *b = &all->at[j];
    scalar s = {.value = b->height - c->value * a->height};
    double apart[3];

    /* the points on the wall are x - arm - height n */
    ellipsoid_difference(b->arm, a->arm, apart);
    s.value += ellipsoid_dot(b->normal, apart);
    for (int k = 0; k < VARIABLES; k++)
    {
        s.gradient[k] = b->height_slope[k] - c->value * a->height_slope[k]
                      - c->gradient[k] * a->height;
        for (int l = 0; l < 3; l++)
        {
            s.gradient[k] += m->turn[j][l][k] * apart[l]
                + b->normal[l] * (b->arm_slope[l][k] - a->arm_slope[l][k]);
        }
    }
    return s;
}

/* 3 t^2 - 2 t^3 from 0 to 1 */
static scalar smooth(scalar t)
{
    const double v = fmin(fmax(t.value, 0), 1);

    t.value = v * v * (3 - 2 * v);
    for (int k = 0; k < VARIABLES; k++)
    {
        t.gradient[k] *= 6 * v * (1 - v);
    }
    return t;
}

/* i's height above j's tangent plane on the wall, by that on the ellipsoid: 0
   where the contact ends, 1 but for the depths where the wall has only the two
   points. */
static scalar standing(const contacts *all, const mix *m, const scalar *c,
                       int i, int j)
{
    const contact *a = &all->at[i], *b = &all->at[j];
    const scalar s = rise(all, m, c, i, j);
    double apart[3], above;
    scalar part = {.value = 0};

    ellipsoid_difference(b->arm, a->arm, apart);
    above = ellipsoid_dot(b->normal, apart);
    if (above > 0)
    {
        part.value = s.value / above;
        for (int k = 0; k < VARIABLES; k++)
        {
            double change = 0;

            for (int l = 0; l < 3; l++)
            {
                change += m->turn[j][l][k] * apart[l]
                    + b->normal[l] * (b->arm_slope[l][k] - a->arm_slope[l][k]);
            }
            part.gradient[k] = (s.gradient[k] - part.value * change) / above;
        }
    }
    return smooth(part);
}

static scalar shadow(const contacts *all, const mix *m, int i, int j)
{
    const contact *a = &all->at[i], *b = &all->at[j];
    const double width = m->width * m->width, apart = m->apart * m->apart;
    const scalar c = cosine(all, m, i, j);
    scalar far = {.value = 0};
    double arms[3], normals[3];

    ellipsoid_difference(a->arm, b->arm, arms);
    ellipsoid_difference(a->normal, b->normal, normals);
    far.value = (ellipsoid_dot(arms, arms)
                 - width * ellipsoid_dot(normals, normals)) / apart;
    if (!(far.value > 0 && c.value > 0))
    {
        return c;
    }
    for (int k = 0; k < VARIABLES; k++)
    {
        for (int l = 0; l < 3; l++)
        {
            const double arm = a->arm_slope[l][k] - b->arm_slope[l][k];
            const double turn = m->turn[i][l][k] - m->turn[j][l][k];

            far.gradient[k] +=
                2 / apart * (arms[l] * arm - width * normals[l] * turn);
        }
    }
    far = smooth(far);

    const scalar one = standing(all, m, &c, i, j);
    const scalar other = standing(all, m, &c, j, i);
    const scalar both = product(&one, &other);
    scalar kept = product(&far, &both);

    kept.value = 1 - kept.value;
    for (int k = 0; k < VARIABLES; k++)
    {
        kept.gradient[k] = -kept.gradient[k];
    }
    return product(&c, &kept);
}

/* Adds the forces of one law along the normals (sign 1) or against; with
   friction and damping unless `rubs` is NULL. */
static void add_mixed(const contacts *all, const mix *m, double sign,
                      const ellipsoid_friction_law *rubs, int derivatives,
                      ellipsoid_surface_push *push, ellipsoid_wrench *sum)
{
    scalar size[MAX_CONTACTS];

    mix_forces(all, m, size);
    for (int n = 0; n < m->count; n++)
    {
        const contact *c = &all->at[n];
        const double f = sign * size[n].value;

        for (int i = 0; i < 3; i++)
        {
            push->push[i] = f * c->normal[i];
            push->point[0][i] = -c->arm[i];
            for (int k = 0; derivatives && k < VARIABLES; k++)
            {
                push->push_slope[k][i] = sign * size[n].gradient[k]
                                           * c->normal[i]
                                       + f * c->normal_slope[i][k];
                push->point_slope[0][k][i] = -c->arm_slope[i][k];
            }
        }
        ellipsoid_wrench_add(push, rubs, derivatives, sum);
    }
}

/* Friction and damping go with the push: adhesion pulls as it does. */
static void combine(const ellipsoid_model *model,
                    const ellipsoid_wall_laws *laws, contacts *all,
                    int derivatives, ellipsoid_surface_push *push,
                    ellipsoid_wrench *sum)
{
    const ellipsoid_surface *body = push->body[0];
    const ellipsoid_friction_law rough = ellipsoid_friction_law_of(model);
    int count[ELLIPSOID_LAW_COUNT];
    mix m; /* large: set where it is read */

    order_by_range(all, laws, 0, count);
    m.width = body->smallest;
    m.apart = model->options.bead_radius;
    for (int i = 0; i < all->count && (derivatives || all->count > 1); i++)
    {
        ellipsoid_surface_derivatives(body, &all->at[i]);
        memcpy(m.turn[i], all->at[i].normal_slope, sizeof m.turn[i]);
    }
    for (int n = 0; n < laws->count; n++)
    {
        const ellipsoid_contact_law *law = &laws->law[n];
        const double sign = law->attractive ? -1 : 1;

        m.count = count[n];
        for (int i = 0; i < m.count; i++)
        {
            const contact *c = &all->at[i];
            const ellipsoid_normal_force f =
                ellipsoid_contact_normal_force(law, c->height);

            m.force[i].value = sign * f.force;
            for (int k = 0; k < VARIABLES; k++)
            {
                m.force[i].gradient[k] =
                    derivatives ? sign * f.slope * c->height_slope[k] : 0;
            }
        }
        if (m.count > 0)
        {
            add_mixed(all, &m, sign,
                      !law->attractive && model->dissipative ? &rough : NULL,
                      derivatives, push, sum);
        }
    }
}

ellipsoid_status
ellipsoid_surface_contact_add(const ellipsoid_model *model,
                            const ellipsoid_surroundings *surroundings,
                            const ellipsoid_state *state,
                            ellipsoid_facet_cache *cache,
                            ellipsoid_contact *contact,
                            ellipsoid_wrench_jacobian *jacobian)
{
    const ellipsoid_options *o = &model->options;
    ellipsoid_wrench_jacobian *const by[2] = {jacobian, NULL};
    ellipsoid_surface body;
    ellipsoid_wall_laws laws;
    contacts all;
    double moved;

    ellipsoid_wall_laws_set(&laws, o);
    ellipsoid_surface_set(o->semi_axes, state->x, state->q, &body);

    const ellipsoid_status status = ellipsoid_facet_cache_update(
        cache, model, surroundings, state->x, body.q, contact->gap, &moved);

    if (status == ELLIPSOID_OK && cache->clearance <= 0)
    {
        const ellipsoid_candidates from = {cache->facets, cache->facet,
                                           cache->first[1]};

        find_contacts(&body, &from, laws.range, &all, contact);
        contact->deepest = fmax(0, -contact->gap);
        contact->touching_beads = all.count > 0;
        if (all.count > 0)
        {
            ellipsoid_surface_push push = {
                .bodies = 1, .body = {&body}, .state = {state}};
            ellipsoid_wrench sum = {.force = {0, 0, 0}};

            combine(model, &laws, &all, jacobian != NULL, &push, &sum);
            ellipsoid_wrench_report(&push, &sum, 0, contact->force,
                                   contact->torque, jacobian ? by : NULL);
        }
    }
    return status;
}
