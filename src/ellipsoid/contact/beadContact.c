/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    beadContact.c - the wall's force on one bead.

    A contact is a local minimum of the distance from the bead's centre to the
    wall (facets.c), at height h along the normal n: the gap is h - r. The
    contacts add up law by law (contactLaw.h, contactBlending.h).
*/
#define BLENDING_VARIABLES 3 /* the bead's centre */

#include "contact/contact.h"

typedef ellipsoid_nearest contact;

#include "contact/contactBlending.h"

/*
    All contacts of a bead within the range of a law. *gap is lowered to the
    smallest height less the radius. A face seen from behind counts only if
    nothing is nearer: then the centre has been pushed into the wall. Otherwise
    it is the far side of a thin one.
*/
static void find_contacts(const ellipsoid_bead *bead,
                          const ellipsoid_candidates *from, contacts *all,
                          double *gap, ellipsoid_contact *report)
{
    const double r = bead->radius, range = r + bead->laws->range;
    contact found, behind;
    double clear = r, deep = -r, reach = r + *gap > range ? r + *gap : range;
    int surface = 0, inside = 0;

    all->count = 0;
    for (int k = 0; k < from->count; k++)
    {
        const ellipsoid_facet *facet;

        if (from->away && from->away[k] > reach + from->moved)
        {
            continue;
        }
        facet = &from->facets[from->index[k]];
        if (!ellipsoid_facet_nearest(facet, bead->centre, reach, &found))
        {
            continue;
        }
        found.mirror = facet->mirror;
        if (found.height < 0)
        {
            if (found.height > deep)
            {
                behind = found;
                deep = found.height;
                surface = facet->surface;
                inside = 1;
            }
            continue;
        }
        clear = found.height < clear ? found.height : clear;
        if (found.height - r < *gap)
        {
            *gap = found.height - r;
            reach = r + *gap > range ? r + *gap : range;
        }
        if (found.height < (found.mirror ? r : range))
        {
            add_contact(all, &found, r);
            if (report)
            {
                list_surface(report, facet->surface);
            }
        }
    }
    if (inside && -deep < (1 - coincidence) * clear)
    {
        add_contact(all, &behind, r);
        *gap = fmin(*gap, deep - r);
        if (report)
        {
            list_surface(report, surface);
        }
    }
}

/* Derivatives of a contact's normal by the centre: (I - nn - tt)/h. */
static void set_normal_slope(const contact *c, double slope[3][3])
{
    if (c->feature == ELLIPSOID_ON_FACE)
    {
        memset(slope, 0, 3 * sizeof *slope);
        return;
    }
    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            slope[i][j] = (i == j) - c->normal[i] * c->normal[j];
            if (c->feature == ELLIPSOID_ON_EDGE)
            {
                slope[i][j] -= c->edge[i] * c->edge[j];
            }
            slope[i][j] /= c->height;
        }
    }
}

static scalar elevation(const contacts *all, const blend *m, const scalar *c,
                        int i, int j)
{
    const contact *a = &all->at[i], *b = &all->at[j];
    scalar s = {.value = b->height - c->value * a->height};

    (void)m;
    for (int k = 0; k < 3; k++)
    {
        s.gradient[k] =
            b->normal[k] - c->value * a->normal[k] - a->height * c->gradient[k];
    }
    return s;
}

static scalar redundancy(const contacts *all, const blend *m, int i, int j)
{
    return cosine(all, m, i, j);
}

/* Of one law at a contact; its sign is -1 if it attracts. */
static inline scalar force_at(const contact *c,
                              const ellipsoid_contact_law *law, double radius)
{
    const ellipsoid_normal_force f =
        ellipsoid_contact_normal_force(law, c->height - radius);
    /* A cell does not adhere to its mirror image. */
    const double factor = !law->attractive ? 1 : c->mirror ? 0 : -1;
    const double slope = factor * f.slope;

    return (scalar){
        factor * f.force,
        {slope * c->normal[0], slope * c->normal[1], slope * c->normal[2]}};
}

/* Adds a force of this size along the normal, or against if it attracts. */
static inline void add_force(const contact *c, const ellipsoid_contact_law *law,
                             const scalar *size, double normal_slope[3][3],
                             int derivatives, ellipsoid_bead_forces *forces)
{
    const double sign = law->attractive ? -1 : 1;
    ellipsoid_point_force *sum = c->mirror       ? &forces->mirrored
                               : law->attractive ? &forces->attraction
                                                 : &forces->repulsion;

    for (int i = 0; i < 3; i++)
    {
        const double n = sign * c->normal[i];

        sum->force[i] += size->value * n;
        for (int j = 0; derivatives && j < 3; j++)
        {
            sum->force_x[i][j] +=
                n * size->gradient[j] + sign * size->value * normal_slope[i][j];
        }
    }
}

/* Most beads in contact have but one. */
static void add_laws_at(const ellipsoid_bead *bead, const contact *c,
                        int derivatives, ellipsoid_bead_forces *sum)
{
    double normal_slope[3][3];

    if (derivatives)
    {
        set_normal_slope(c, normal_slope);
    }
    for (int n = 0; n < bead->laws->count; n++)
    {
        const ellipsoid_contact_law *law = &bead->laws->law[n];

        if (c->height < bead->radius + law->range)
        {
            const scalar size = force_at(c, law, bead->radius);

            add_force(c, law, &size, normal_slope, derivatives, sum);
        }
    }
}

static void add_laws(const ellipsoid_bead *bead, contacts *all, int derivatives,
                     ellipsoid_bead_forces *sum)
{
    int count[ELLIPSOID_LAW_COUNT];
    scalar size[MAX_CONTACTS];
    blend m; /* large: set where it is read */

    order_by_range(all, bead->laws, bead->radius, count);
    m.count = all->count;
    for (int i = 0; i < m.count; i++)
    {
        set_normal_slope(&all->at[i], m.normal_slope[i]);
    }
    for (int n = 0; n < bead->laws->count; n++)
    {
        const ellipsoid_contact_law *law = &bead->laws->law[n];

        m.count = count[n];
        for (int i = 0; i < m.count; i++)
        {
            m.force[i] = force_at(&all->at[i], law, bead->radius);
        }
        blend_forces(all, &m, size);
        for (int i = 0; i < m.count; i++)
        {
            add_force(&all->at[i], law, &size[i], m.normal_slope[i],
                      derivatives, sum);
        }
    }
}

int ellipsoid_bead_contact(const ellipsoid_bead *bead,
                           const ellipsoid_candidates *from, double *gap,
                           int derivatives, ellipsoid_bead_forces *forces,
                           ellipsoid_contact *report)
{
    contacts all;

    find_contacts(bead, from, &all, gap, report);
    if (all.count == 0)
    {
        return 0;
    }
    if (derivatives)
    {
        memset(forces, 0, sizeof *forces);
    }
    ellipsoid_set(forces->repulsion.force, 0, 0, 0);
    ellipsoid_set(forces->mirrored.force, 0, 0, 0);
    ellipsoid_set(forces->attraction.force, 0, 0, 0);
    forces->mirrors = 0;
    for (int i = 0; i < all.count; i++)
    {
        forces->mirrors += all.at[i].mirror;
    }
    if (all.count == 1)
    {
        add_laws_at(bead, all.at, derivatives, forces);
    }
    else
    {
        add_laws(bead, &all, derivatives, forces);
    }
    return all.count;
}

int ellipsoid_bead_force(const double centre[3], double radius,
                         double stiffness, const ellipsoid_facet_list *facets,
                         double force[3], double force_x[3][3])
{
    const ellipsoid_candidates from = {facets->facets, facets->index,
                                       facets->count, NULL, 0};
    const ellipsoid_wall_laws laws = {.count = 1,
                                      .law = {ellipsoid_hertz_law(stiffness)}};
    ellipsoid_bead bead = {.radius = radius, .laws = &laws};
    ellipsoid_bead_forces forces = {.repulsion = {.force = {0, 0, 0}}};
    double gap = 0;
    int contacts;

    ellipsoid_copy(centre, bead.centre);
    contacts = ellipsoid_bead_contact(&bead, &from, &gap, force_x != NULL,
                                      &forces, NULL);
    ellipsoid_copy(forces.repulsion.force, force);
    if (force_x)
    {
        memcpy(force_x, forces.repulsion.force_x,
               sizeof forces.repulsion.force_x);
    }
    return contacts;
}
