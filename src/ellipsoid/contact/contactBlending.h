/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    contactBlending.h - the sum of the contacts of one body with the wall.
    beadContact.c includes it for beads and ellipsoidContact.c for ellipsoids,
    each with the number of variables of its gradients as a constant.

    The contacts of a body, at heights h along the normals n, add up as
        F = sum w_i f_i n_i,   w_i = g_i / sum_j g_j max(0, r_ij),
    r_ij = n_i.n_j: contacts along one normal count once, and those along
    perpendicular normals count fully (docs/theory/contact.md).
    g_i = f_i phi_i. The share phi_i is 1 where normals differ by more than 60
    degrees. Between contacts less than 37 degrees apart it is
        phi_i = e_i f_i / (e_i f_i + e_j f_j),   e_i = max(0, elevation_ij)
    with elevation_ij the height of i's contact point above j's tangent plane.
    Where the body leaves a facet over a gently concave seam or a low step, that
    point lies on the next facet: e_i, and with it the contact's weight, is zero
    before the contact ends, and the force stays continuous.

    Before the inclusion: BLENDING_VARIABLES and a type `contact` with feature,
    height and normal as in ellipsoid_nearest. After it: elevation() and
    redundancy().
*/
#ifndef ELLIPSOID_CONTACT_BLENDING_H
#define ELLIPSOID_CONTACT_BLENDING_H

#include "contact/contact.h"

#include <math.h>
#include <string.h>

enum
{
    VARIABLES = BLENDING_VARIABLES,
    MAX_CONTACTS = 16 /* distinct ones; of more, the deepest are kept */
};

/* Relative tolerance in normal and height within which two contacts are one
   that was found on two facets. */
static const double coincidence = 1e-8;

/* Cosines of the angle between normals: contacts share fully above the first,
   and not at all below the second. */
static const double full_sharing = 0.8, no_sharing = 0.5;

/* The other contact's fraction of the elevations beyond which the first round
   reduces a share: such a contact is about to end. */
static const double first_threshold = 0.75;

typedef struct contacts
{
    int count;
    contact at[MAX_CONTACTS];
} contacts;

static int is_same(const contact *a, const contact *b, double size)
{
    double d[3];

    ellipsoid_difference(a->normal, b->normal, d);
    return ellipsoid_dot(d, d) < coincidence * coincidence
        && fabs(a->height - b->height) < coincidence * size;
}

/* Adds a contact unless it is there already. */
static void add_contact(contacts *all, const contact *found, double size)
{
    int shallowest = 0;

    for (int i = 0; i < all->count; i++)
    {
        if (is_same(&all->at[i], found, size))
        {
            /* the normal of a face has the smallest rounding error */
            if (found->feature < all->at[i].feature)
            {
                all->at[i] = *found;
            }
            return;
        }
        if (all->at[i].height > all->at[shallowest].height)
        {
            shallowest = i;
        }
    }
    if (all->count < MAX_CONTACTS)
    {
        all->at[all->count++] = *found;
    }
    else if (found->height < all->at[shallowest].height)
    {
        all->at[shallowest] = *found;
    }
}

static void list_surface(ellipsoid_contact *report, int surface)
{
    for (int i = 0; i < report->surface_count; i++)
    {
        if (report->surface[i] == surface)
        {
            return;
        }
    }
    if (report->surface_count < ELLIPSOID_MAX_SURFACES)
    {
        report->surface[report->surface_count++] = surface;
    }
}

/* A scalar with its gradient. */
typedef struct scalar
{
    double value, gradient[VARIABLES];
} scalar;

/* The contacts that one law acts at. */
typedef struct blend
{
    int count;                 /* the first of all contacts */
    double radius, separation; /* [m] for redundancy() of ellipsoids */
    double normal_slope[MAX_CONTACTS][3][VARIABLES];
    scalar force[MAX_CONTACTS]; /* f_i */
} blend;

static const scalar unity = {.value = 1};

/* Height of i's contact point above j's tangent plane; c = n_i.n_j. */
static scalar elevation(const contacts *all, const blend *m, const scalar *c,
                        int i, int j);

/* r_ij: 1 if they are one contact, n_i.n_j in general, and less where their
   points are far apart. */
static scalar redundancy(const contacts *all, const blend *m, int i, int j);

/* n_i.n_j */
static scalar cosine(const contacts *all, const blend *m, int i, int j)
{
    const double *a = all->at[i].normal, *b = all->at[j].normal;
    scalar c = {.value = ellipsoid_dot(a, b)};

    for (int k = 0; k < VARIABLES; k++)
    {
        c.gradient[k] = 0;
        for (int l = 0; l < 3; l++)
        {
            c.gradient[k] += m->normal_slope[i][l][k] * b[l]
                           + m->normal_slope[j][l][k] * a[l];
        }
    }
    return c;
}

/* e_i times the weight of i */
static scalar weighted_elevation(const contacts *all, const blend *m,
                                 const scalar *weight, const scalar *c, int i,
                                 int j)
{
    const scalar s = elevation(all, m, c, i, j);
    scalar result = {.value = 0};

    if (s.value > 0)
    {
        result.value = s.value * weight[i].value;
        for (int k = 0; k < VARIABLES; k++)
        {
            result.gradient[k] = s.value * weight[i].gradient[k]
                               + weight[i].value * s.gradient[k];
        }
    }
    return result;
}

/* Reduces a share by what the other's fraction of both weighted elevations
   exceeds a threshold by:
   phi *= 1 - degree (other/total - threshold)/(1 - threshold). */
static void reduce_share(scalar *phi, const scalar *degree, const scalar *other,
                         const scalar *own, double threshold)
{
    const double total = other->value + own->value;
    const double part = other->value / total;
    const double excess = (part - threshold) / (1 - threshold);
    const double factor = 1 - degree->value * excess;

    if (!(excess > 0))
    {
        return;
    }
    for (int k = 0; k < VARIABLES; k++)
    {
        const double part_gradient =
            ((1 - part) * other->gradient[k] - part * own->gradient[k]) / total;

        phi->gradient[k] =
            phi->gradient[k] * factor
            - phi->value
                  * (degree->gradient[k] * excess
                     + degree->value * part_gradient / (1 - threshold));
    }
    phi->value *= factor;
}

/* The shares of every two contacts with normals of similar direction. */
static void set_shares(const contacts *all, const blend *m,
                       const scalar *weight, double threshold, scalar *share)
{
    for (int i = 0; i < m->count; i++)
    {
        for (int j = 0; j < i; j++)
        {
            const scalar c = cosine(all, m, i, j);
            const double ramp =
                (c.value - no_sharing) / (full_sharing - no_sharing);
            scalar degree = {.value = fmin(ramp, 1)};

            if (!(ramp > 0))
            {
                continue;
            }

            const scalar own = weighted_elevation(all, m, weight, &c, i, j);
            const scalar other = weighted_elevation(all, m, weight, &c, j, i);

            if (!(own.value + other.value > 0))
            {
                continue;
            }
            for (int k = 0; k < VARIABLES && ramp < 1; k++)
            {
                degree.gradient[k] =
                    c.gradient[k] / (full_sharing - no_sharing);
            }
            reduce_share(&share[i], &degree, &other, &own, threshold);
            reduce_share(&share[j], &degree, &own, &other, threshold);
        }
    }
}

static scalar product(const scalar *a, const scalar *b)
{
    scalar result = {.value = a->value * b->value};

    for (int k = 0; k < VARIABLES; k++)
    {
        result.gradient[k] =
            a->gradient[k] * b->value + a->value * b->gradient[k];
    }
    return result;
}

/*
    g_i = f_i phi_i in two rounds. The first, by elevations alone, takes the
    weight from contacts about to end, so that they do not reduce the shares of
    others in the second.
*/
static void set_weights(const contacts *all, const blend *m, scalar *weight)
{
    scalar one[MAX_CONTACTS], share[MAX_CONTACTS];

    /* all of them: compilers warn of those beyond the count otherwise */
    for (int i = 0; i < MAX_CONTACTS; i++)
    {
        one[i] = share[i] = unity;
    }
    set_shares(all, m, one, first_threshold, share);
    for (int i = 0; i < m->count; i++)
    {
        weight[i] = product(&m->force[i], &share[i]);
        share[i] = unity;
    }
    memcpy(one, weight, m->count * sizeof *one);
    set_shares(all, m, one, 0, share);
    for (int i = 0; i < m->count; i++)
    {
        weight[i] = product(&one[i], &share[i]);
    }
}

/* sum_j g_j max(0, r_ij) */
static scalar weight_sum(const contacts *all, const blend *m,
                         const scalar *weight, int i)
{
    scalar sum = weight[i];

    for (int j = 0; j < m->count; j++)
    {
        const scalar c = redundancy(all, m, i, j);

        if (j == i || !(c.value > 0))
        {
            continue;
        }
        sum.value += weight[j].value * c.value;
        for (int k = 0; k < VARIABLES; k++)
        {
            sum.gradient[k] += weight[j].gradient[k] * c.value
                             + weight[j].value * c.gradient[k];
        }
    }
    return sum;
}

/* w_i f_i of all contacts. */
static void blend_forces(const contacts *all, const blend *m,
                         scalar size[MAX_CONTACTS])
{
    scalar weight[MAX_CONTACTS];

    if (m->count == 1)
    {
        size[0] = m->force[0];
        return;
    }

    set_weights(all, m, weight);
    for (int i = 0; i < m->count; i++)
    {
        const scalar *f = &m->force[i], *g = &weight[i];

        size[i] = (scalar){.value = 0};
        if (g->value > 0)
        {
            const scalar sum = weight_sum(all, m, weight, i);
            const double w = g->value / sum.value;

            size[i].value = w * f->value;
            for (int k = 0; k < VARIABLES; k++)
            {
                size[i].gradient[k] =
                    w * f->gradient[k]
                    + f->value * (g->gradient[k] - w * sum.gradient[k])
                          / sum.value;
            }
        }
    }
}

/* Moves the contacts below a height to the front; returns how many. */
static int nearest_first(contacts *all, double height)
{
    int count = 0;

    for (int i = 0; i < all->count; i++)
    {
        if (!(all->at[i].height < height))
        {
            continue;
        }
        if (i > count)
        {
            const contact found = all->at[i];

            memmove(&all->at[count + 1], &all->at[count],
                    (size_t)(i - count) * sizeof found);
            all->at[count] = found;
        }
        count++;
    }
    return count;
}

/* Puts the contacts in range of each law before the others; count[n] are in
   that of the n-th. A body's surface is at a height of `radius`. */
static void order_by_range(contacts *all, const ellipsoid_wall_laws *laws,
                           double radius, int count[ELLIPSOID_LAW_COUNT])
{
    for (int n = 0; n < laws->count; n++)
    {
        count[n] = nearest_first(all, radius + laws->law[n].range);
    }
}

#endif
