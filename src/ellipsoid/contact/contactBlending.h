/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    contactBlending.h - how the contacts of one body with the wall add up. Included by
    beadContact.c for beads and by ellipsoidContact.c for ellipsoids, each with its own
    number of variables, by which forces have gradients, as a constant.

    The contacts of a body, at heights h along the normals n, add up as
        F = sum w_i f_i n_i,   w_i = g_i / sum_j g_j max(0, n_i.n_j),
    so that contacts along one normal count once and perpendicular ones fully.
    g_i = f_i phi_i. The share phi_i is 1 where normals differ by more than 60
    degrees. Between contacts less than 37 degrees apart it is
        phi_i = s_i f_i / (s_i f_i + s_j f_j),   s_i = max(0, rise_ij)
    with rise_ij the height of i's contact point above j's tangent plane. Where
    the body leaves a facet over a gently concave seam or a low step, that point
    lies on the next facet: s_i, and with it the contact's weight, is zero
    before the contact ends, and the force stays continuous.
    The rule for w_i is docs/theory.md's, "Contact"; the shares add to it.

    Before the inclusion: BLENDING_VARIABLES and a type `contact` with feature,
    height and normal as in ellipsoid_nearest. After it: rise() and shadow().
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

/* Contacts closer than this in normal and height are one, seen twice. */
static const double same = 1e-8;

/* Cosines between which contacts share fully (near 1) or not at all. */
static const double share_all = 0.8, share_none = 0.5;

/* The part of a common claim beyond which a contact is about to end. */
static const double spared_first = 0.75;

typedef struct contacts
{
    int count;
    contact at[MAX_CONTACTS];
} contacts;

static int is_same(const contact *a, const contact *b,
                   double size)
{
    double d[3];

    ellipsoid_difference(a->normal, b->normal, d);
    return ellipsoid_dot(d, d) < same * same
        && fabs(a->height - b->height) < same * size;
}

static void add(contacts *all, const contact *found, double size)
{
    int shallowest = 0;

    for (int i = 0; i < all->count; i++)
    {
        if (is_same(&all->at[i], found, size))
        {
            /* a face knows its normal best */
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

static void note_surface(ellipsoid_contact *report, int surface)
{
    for (int i = 0; i < report->touched_count; i++)
    {
        if (report->touched[i] == surface)
        {
            return;
        }
    }
    if (report->touched_count < ELLIPSOID_MAX_TOUCHED)
    {
        report->touched[report->touched_count++] = surface;
    }
}

/* A scalar with its gradient. */
typedef struct scalar
{
    double value, gradient[VARIABLES];
} scalar;

typedef struct mix
{
    int count; /* the first of the contacts */
    double width, apart; /* [m] for shadow() */
    double turn[MAX_CONTACTS][3][VARIABLES]; /* derivatives of normals */
    scalar force[MAX_CONTACTS];              /* f_i */
} mix;

static const scalar unity = {.value = 1};

/* Height of i's contact point above j's tangent plane; c = n_i.n_j. */
static scalar rise(const contacts *all, const mix *m, const scalar *c, int i,
                   int j);

/* How much of i's part j takes over where both bear fully, 1 if they are one
   contact; n_i.n_j, or less where they are far apart. */
static scalar shadow(const contacts *all, const mix *m, int i, int j);

/* n_i.n_j */
static scalar cosine(const contacts *all, const mix *m, int i, int j)
{
    const double *a = all->at[i].normal, *b = all->at[j].normal;
    scalar c = {.value = ellipsoid_dot(a, b)};

    for (int k = 0; k < VARIABLES; k++)
    {
        c.gradient[k] = 0;
        for (int l = 0; l < 3; l++)
        {
            c.gradient[k] +=
                m->turn[i][l][k] * b[l] + m->turn[j][l][k] * a[l];
        }
    }
    return c;
}

/* s_i times i's weight, see above */
static scalar claim(const contacts *all, const mix *m, const scalar *weight,
                    const scalar *c, int i, int j)
{
    const scalar s = rise(all, m, c, i, j);
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

/* Takes from phi what of another's claim exceeds a part `spared` of both:
   phi *= 1 - degree (other/total - spared)/(1 - spared). */
static void concede(scalar *phi, const scalar *degree, const scalar *other,
                    const scalar *own, double spared)
{
    const double total = other->value + own->value;
    const double part = other->value / total;
    const double taken = (part - spared) / (1 - spared);
    const double factor = 1 - degree->value * taken;

    if (!(taken > 0))
    {
        return;
    }
    for (int k = 0; k < VARIABLES; k++)
    {
        const double part_gradient =
            ((1 - part) * other->gradient[k] - part * own->gradient[k]) / total;

        phi->gradient[k] = phi->gradient[k] * factor
            - phi->value * (degree->gradient[k] * taken
                            + degree->value * part_gradient / (1 - spared));
    }
    phi->value *= factor;
}

/* Every two contacts share out what they cover both. */
static void share_out(const contacts *all, const mix *m, const scalar *weight,
                      double spared, scalar *share)
{
    for (int i = 0; i < m->count; i++)
    {
        for (int j = 0; j < i; j++)
        {
            const scalar c = cosine(all, m, i, j);
            const double ramp = (c.value - share_none)
                              / (share_all - share_none);
            scalar degree = {.value = fmin(ramp, 1)};

            if (!(ramp > 0))
            {
                continue;
            }

            const scalar mine = claim(all, m, weight, &c, i, j);
            const scalar other = claim(all, m, weight, &c, j, i);

            if (!(mine.value + other.value > 0))
            {
                continue;
            }
            for (int k = 0; k < VARIABLES && ramp < 1; k++)
            {
                degree.gradient[k] = c.gradient[k] / (share_all - share_none);
            }
            concede(&share[i], &degree, &other, &mine, spared);
            concede(&share[j], &degree, &mine, &other, spared);
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
    g_i = f_i phi_i in two rounds. The first, by heights alone, lets go of those
    about to end, so that in the second they claim nothing from third ones.
*/
static void weigh(const contacts *all, const mix *m, scalar *weight)
{
    scalar one[MAX_CONTACTS], share[MAX_CONTACTS];

    /* all, lest compilers fear for those beyond the count */
    for (int i = 0; i < MAX_CONTACTS; i++)
    {
        one[i] = share[i] = unity;
    }
    share_out(all, m, one, spared_first, share);
    for (int i = 0; i < m->count; i++)
    {
        weight[i] = product(&m->force[i], &share[i]);
        share[i] = unity;
    }
    memcpy(one, weight, m->count * sizeof *one);
    share_out(all, m, one, 0, share);
    for (int i = 0; i < m->count; i++)
    {
        weight[i] = product(&one[i], &share[i]);
    }
}

/* sum_j g_j max(0, shadow_ij) */
static scalar covered(const contacts *all, const mix *m, const scalar *weight,
                      int i)
{
    scalar sum = weight[i];

    for (int j = 0; j < m->count; j++)
    {
        const scalar c = shadow(all, m, i, j);

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

/* w_i f_i of all contacts, 0 where nothing is left of one. */
static void mix_forces(const contacts *all, const mix *m,
                       scalar size[MAX_CONTACTS])
{
    scalar weight[MAX_CONTACTS];

    if (m->count == 1)
    {
        size[0] = m->force[0];
        return;
    }

    weigh(all, m, weight);
    for (int i = 0; i < m->count; i++)
    {
        const scalar *f = &m->force[i], *g = &weight[i];

        size[i] = (scalar){.value = 0};
        if (g->value > 0)
        {
            const scalar sum = covered(all, m, weight, i);
            const double w = g->value / sum.value;

            size[i].value = w * f->value;
            for (int k = 0; k < VARIABLES; k++)
            {
                size[i].gradient[k] = w * f->gradient[k]
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
