/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    ellipsoidContact.c - the walls' force and torque on an ellipsoid.

    Contacts are local minima of the ellipsoid's distance to the wall
    (ellipsoidFacets.c). Law and sum are those of a bead (contactLaw.h,
    contactBlending.h), the force acts at the contact point on the ellipsoid:
    one contact is conservative, with the potential of the law.

    Contacts of a bead along one normal are at one point, those of a long body
    need not be: a rod across a slit rests on both its edges. So contacts are
    independent where their points are farther apart, by a bead's radius, than
    those of a sphere would be, unless one is about to end: redundancy().
*/
#include "contact/contact.h"

#define BLENDING_VARIABLES ELLIPSOID_SURFACE_VARIABLES

typedef ellipsoid_surface_contact contact;

#include "contact/contactBlending.h"

static void record(contacts *all, const contact *found, double range,
                   double size, int surface, ellipsoid_contact *report)
{
    report->gap = fmin(report->gap, found->height);
    if (found->height < (found->mirror ? 0 : range))
    {
        add_contact(all, found, size);
        list_surface(report, surface);
    }
}

/* Is the centre inside the wall, no deeper than `reach`? Then the nearest facet
   to it is a face seen from behind. */
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
            const double distance =
                fabs(found.height) / (found.height < 0 ? 1 - coincidence : 1);

            if (distance < clear)
            {
                clear = distance;
                inside = found.height < 0;
            }
        }
    }
    return inside;
}

/*
    Deeper in a corner than its radius of curvature, an ellipsoid may have no
    contact: of every face that it cuts, the point deepest in it lies beside the
    face. Then the plane of the face that it is least deep behind is a contact.
*/
static void add_cut_plane(const ellipsoid_surface *body,
                          const ellipsoid_candidates *from, double range,
                          contacts *all, ellipsoid_contact *report)
{
    const double *a = body->axes;
    const double curvature_radius =
        body->smallest * body->smallest / ellipsoid_largest(a);
    contact found, least = {.height = -HUGE_VAL};
    int surface = -1, deep = 0;

    for (int k = 0; k < from->count; k++)
    {
        const ellipsoid_facet *facet = &from->facets[from->index[k]];

        if (ellipsoid_surface_cut_plane(facet, body, &found))
        {
            found.mirror = facet->mirror;
            deep = deep || -found.height > curvature_radius * (1 + coincidence);
            if (found.height > least.height)
            {
                least = found;
                surface = facet->surface;
            }
        }
    }
    if (deep)
    {
        record(all, &least, range, body->smallest, surface, report);
    }
}

/*
    All contacts. report->gap is lowered to the smallest height. A face seen
    from behind counts only if the centre is inside the wall, and of several the
    nearest. Otherwise it is the far side of a thin wall.
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

        found.mirror = facet->mirror;

        if (side == 0)
        {
            continue;
        }
        if (side == 1)
        {
            record(all, &found, range, body->smallest, facet->surface, report);
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
        record(all, &behind, range, body->smallest, surface, report);
    }
    if (report->gap >= 0)
    {
        add_cut_plane(body, from, range, all, report);
    }
}

static scalar elevation(const contacts *all, const blend *m, const scalar *c,
                        int i, int j)
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
            s.gradient[k] +=
                m->normal_slope[j][l][k] * apart[l]
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

/* i's height above j's tangent plane on the wall, divided by that on the
   ellipsoid, smoothed: 0 where the contact ends, and near 1 elsewhere. */
static scalar relative_elevation(const contacts *all, const blend *m,
                                 const scalar *c, int i, int j)
{
    const contact *a = &all->at[i], *b = &all->at[j];
    const scalar s = elevation(all, m, c, i, j);
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
                change +=
                    m->normal_slope[j][l][k] * apart[l]
                    + b->normal[l] * (b->arm_slope[l][k] - a->arm_slope[l][k]);
            }
            part.gradient[k] = (s.gradient[k] - part.value * change) / above;
        }
    }
    return smooth(part);
}

static scalar redundancy(const contacts *all, const blend *m, int i, int j)
{
    const contact *a = &all->at[i], *b = &all->at[j];
    const double radius = m->radius * m->radius;
    const double separation = m->separation * m->separation;
    const scalar c = cosine(all, m, i, j);
    scalar far = {.value = 0};
    double arms[3], normals[3];

    ellipsoid_difference(a->arm, b->arm, arms);
    ellipsoid_difference(a->normal, b->normal, normals);
    far.value =
        (ellipsoid_dot(arms, arms) - radius * ellipsoid_dot(normals, normals))
        / separation;
    if (!(far.value > 0 && c.value > 0))
    {
        return c;
    }
    for (int k = 0; k < VARIABLES; k++)
    {
        for (int l = 0; l < 3; l++)
        {
            const double arm = a->arm_slope[l][k] - b->arm_slope[l][k];
            const double turn =
                m->normal_slope[i][l][k] - m->normal_slope[j][l][k];

            far.gradient[k] +=
                2 / separation * (arms[l] * arm - radius * normals[l] * turn);
        }
    }
    far = smooth(far);

    const scalar one = relative_elevation(all, m, &c, i, j);
    const scalar other = relative_elevation(all, m, &c, j, i);
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
   friction and damping, at walls and at planes of symmetry, unless `friction` is
   NULL. */
static void add_blended(const contacts *all, const blend *m, double sign,
                        const ellipsoid_friction_law friction[2],
                        int derivatives, ellipsoid_surface_force *at,
                        ellipsoid_wrench *sum)
{
    scalar size[MAX_CONTACTS];

    blend_forces(all, m, size);
    for (int n = 0; n < m->count; n++)
    {
        const contact *c = &all->at[n];
        const double f = sign * size[n].value;

        for (int i = 0; i < 3; i++)
        {
            at->force[i] = f * c->normal[i];
            at->point[0][i] = -c->arm[i];
            for (int k = 0; derivatives && k < VARIABLES; k++)
            {
                at->force_slope[k][i] =
                    sign * size[n].gradient[k] * c->normal[i]
                    + f * c->normal_slope[i][k];
                at->point_slope[0][k][i] = -c->arm_slope[i][k];
            }
        }
        ellipsoid_wrench_add(at, friction ? &friction[c->mirror != 0] : NULL,
                             derivatives, sum);
    }
}

static void add_laws(const ellipsoid_model *model,
                     const ellipsoid_wall_laws *laws, contacts *all,
                     int derivatives, ellipsoid_surface_force *at,
                     ellipsoid_wrench *sum)
{
    const ellipsoid_surface *body = at->body[0];
    const ellipsoid_friction_law friction[2] = {
        ellipsoid_friction_law_of(model),
        ellipsoid_friction_law_at_mirror(model)};
    int count[ELLIPSOID_LAW_COUNT];
    blend m; /* large: set where it is read */

    order_by_range(all, laws, 0, count);
    m.radius = body->smallest;
    m.separation = model->options.bead_radius;
    for (int i = 0; i < all->count && (derivatives || all->count > 1); i++)
    {
        ellipsoid_surface_derivatives(body, &all->at[i]);
        memcpy(m.normal_slope[i], all->at[i].normal_slope,
               sizeof m.normal_slope[i]);
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
            /* A cell does not adhere to its mirror image. */
            const double factor = c->mirror && law->attractive ? 0 : sign;

            m.force[i].value = factor * f.force;
            for (int k = 0; k < VARIABLES; k++)
            {
                m.force[i].gradient[k] =
                    derivatives ? factor * f.slope * c->height_slope[k] : 0;
            }
        }
        if (m.count > 0)
        {
            add_blended(all, &m, sign,
                        !law->attractive && model->dissipative ? friction
                                                               : NULL,
                        derivatives, at, sum);
        }
    }
}

ellipsoid_status ellipsoid_surface_contact_add(
    const ellipsoid_model *model, const ellipsoid_surroundings *surroundings,
    const ellipsoid_state *state, ellipsoid_facet_cache *cache,
    ellipsoid_contact *contact, ellipsoid_wrench_jacobian *jacobian)
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
                                           cache->first[1], NULL, 0};

        find_contacts(&body, &from, laws.range, &all, contact);
        contact->deepest = fmax(0, -contact->gap);
        contact->bead_contacts = all.count > 0;
        if (all.count > 0)
        {
            ellipsoid_surface_force at = {
                .bodies = 1, .body = {&body}, .state = {state}};
            ellipsoid_wrench sum = {.slip = HUGE_VAL};

            add_laws(model, &laws, &all, jacobian != NULL, &at, &sum);
            contact->slip = sum.slip;
            ellipsoid_wrench_report(&at, &sum, 0, contact->force,
                                    contact->torque, jacobian ? by : NULL);
        }
    }
    return status;
}
