/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    touch.c - the wall's force on one bead.

    A contact is a local minimum of the distance from the bead's centre to the
    wall (facets.c), at height h along the normal n; Hertz: f = k (r - h)^1.5.
    The contacts of one bead add up as
        F = sum w_i f_i n_i,   w_i = g_i / sum_j g_j max(0, n_i.n_j),
    so that contacts along one normal count once and perpendicular ones fully.
    g_i = f_i phi_i. The share phi_i is 1 where normals differ by more than 60
    degrees. Between contacts less than 37 degrees apart it is
        phi_i = s_i f_i / (s_i f_i + s_j f_j),   s_i = max(0, h_j - n_i.n_j h_i)
    with s_i the height of i's contact point above j's tangent plane. Where the
    bead leaves a facet over a gently concave seam or a low step, that point
    lies on the next facet: s_i, and with it the contact's weight, is zero
    before the contact ends, and the force stays continuous.
    The rule for w_i is docs/theory.md's, "Contact"; the shares add to it.
*/
#include "ellipsoidInternal.h"

#include <math.h>
#include <string.h>

/* Distinct contacts of one bead; of more, the deepest are kept. */
#define MAX_CONTACTS 16

/* Contacts closer than this in normal and height are one, seen twice. */
static const double same = 1e-8;

/* Cosines between which contacts share fully (near 1) or not at all. */
static const double share_all = 0.8, share_none = 0.5;

/* The part of a common claim beyond which a contact is about to end. */
static const double spared_first = 0.75;

typedef struct contacts
{
    int count;
    ellipsoid_nearest at[MAX_CONTACTS];
} contacts;

static int is_same(const ellipsoid_nearest *a, const ellipsoid_nearest *b,
                   double radius)
{
    double d[3];

    ellipsoid_difference(a->normal, b->normal, d);
    return ellipsoid_dot(d, d) < same * same
        && fabs(a->height - b->height) < same * radius;
}

static void add(contacts *all, const ellipsoid_nearest *found, double radius)
{
    int shallowest = 0;

    for (int i = 0; i < all->count; i++)
    {
        if (is_same(&all->at[i], found, radius))
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

/*
    All contacts of a bead. *gap is lowered to the smallest height less radius.
    A facet seen from behind counts only if nothing is nearer: then the centre
    has been pushed into the wall. Otherwise it is the far side of a thin one.
*/
static void find_contacts(const ellipsoid_bead *bead,
                          const ellipsoid_candidates *from, contacts *all,
                          double *gap, ellipsoid_contact *report)
{
    const double r = bead->radius;
    ellipsoid_nearest found, behind = {.height = -r};
    double clear = r;
    int surface = 0, inside = 0;

    all->count = 0;
    for (int k = 0; k < from->count; k++)
    {
        const ellipsoid_facet *facet =
            &from->facets[from->index[k]];
        const double reach = *gap > 0 ? r + *gap : r;

        if (!ellipsoid_facet_nearest(facet, bead->centre, reach, &found))
        {
            continue;
        }
        if (found.height < 0)
        {
            if (found.height > behind.height)
            {
                behind = found;
                surface = facet->surface;
                inside = 1;
            }
            continue;
        }
        clear = fmin(clear, found.height);
        *gap = fmin(*gap, found.height - r);
        if (found.height < r)
        {
            add(all, &found, r);
            if (report)
            {
                note_surface(report, facet->surface);
            }
        }
    }
    if (inside && -behind.height < (1 - same) * clear)
    {
        add(all, &behind, r);
        *gap = fmin(*gap, behind.height - r);
        if (report)
        {
            note_surface(report, surface);
        }
    }
}

/* How a contact's normal turns as the centre moves: (I - nn - tt)/h. */
static void turning(const ellipsoid_nearest *c, double turn[3][3])
{
    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            if (c->feature == ELLIPSOID_ON_FACE)
            {
                turn[i][j] = 0;
                continue;
            }
            turn[i][j] = (i == j) - c->normal[i] * c->normal[j];
            if (c->feature == ELLIPSOID_ON_EDGE)
            {
                turn[i][j] -= c->edge[i] * c->edge[j];
            }
            turn[i][j] /= c->height;
        }
    }
}

/* A scalar with its gradient by the bead's centre. */
typedef struct scalar
{
    double value, gradient[3];
} scalar;

typedef struct mix
{
    int count;
    double turn[MAX_CONTACTS][3][3];
    scalar force[MAX_CONTACTS]; /* f_i */
} mix;

static const scalar unity = {1, {0, 0, 0}};

/* n_i.n_j */
static scalar cosine(const contacts *all, const mix *m, int i, int j)
{
    const double *a = all->at[i].normal, *b = all->at[j].normal;
    scalar c = {ellipsoid_dot(a, b), {0, 0, 0}};

    for (int k = 0; k < 3; k++)
    {
        c.gradient[k] =
            ellipsoid_dot(m->turn[i][k], b) + ellipsoid_dot(m->turn[j][k], a);
    }
    return c;
}

/* s_i times i's weight, see above */
static scalar claim(const contacts *all, const scalar *weight, const scalar *c,
                    int i, int j)
{
    const ellipsoid_nearest *a = &all->at[i], *b = &all->at[j];
    const double s = b->height - c->value * a->height;
    scalar result = {0, {0, 0, 0}};

    if (s > 0)
    {
        result.value = s * weight[i].value;
        for (int k = 0; k < 3; k++)
        {
            result.gradient[k] = s * weight[i].gradient[k]
                + weight[i].value * (b->normal[k] - c->value * a->normal[k]
                                     - a->height * c->gradient[k]);
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
    for (int k = 0; k < 3; k++)
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
            scalar degree = {fmin(ramp, 1), {0, 0, 0}};

            if (!(ramp > 0))
            {
                continue;
            }

            const scalar mine = claim(all, weight, &c, i, j);
            const scalar other = claim(all, weight, &c, j, i);

            if (!(mine.value + other.value > 0))
            {
                continue;
            }
            for (int k = 0; k < 3 && ramp < 1; k++)
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
    scalar result = {a->value * b->value, {0, 0, 0}};

    for (int k = 0; k < 3; k++)
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

/* sum_j g_j max(0, n_i.n_j) */
static scalar covered(const contacts *all, const mix *m, const scalar *weight,
                      int i)
{
    scalar sum = weight[i];

    for (int j = 0; j < m->count; j++)
    {
        const scalar c = cosine(all, m, i, j);

        if (j == i || !(c.value > 0))
        {
            continue;
        }
        sum.value += weight[j].value * c.value;
        for (int k = 0; k < 3; k++)
        {
            sum.gradient[k] += weight[j].gradient[k] * c.value
                             + weight[j].value * c.gradient[k];
        }
    }
    return sum;
}

/* Adds size times the contact's normal. */
static void push(const ellipsoid_nearest *contact, double turn[3][3],
                 const scalar *size, double force[3], double force_x[3][3])
{
    for (int i = 0; i < 3; i++)
    {
        force[i] += size->value * contact->normal[i];
        for (int j = 0; force_x && j < 3; j++)
        {
            force_x[i][j] += contact->normal[i] * size->gradient[j]
                           + size->value * turn[i][j];
        }
    }
}

static void combine(const ellipsoid_bead *bead, const contacts *all,
                    double force[3], double force_x[3][3])
{
    mix m = {.count = all->count};
    scalar weight[MAX_CONTACTS];

    for (int i = 0; i < m.count; i++)
    {
        const double depth = bead->radius - all->at[i].height;
        const double root = bead->stiffness * sqrt(depth);

        turning(&all->at[i], m.turn[i]);
        m.force[i].value = root * depth;
        for (int k = 0; k < 3; k++)
        {
            m.force[i].gradient[k] = -1.5 * root * all->at[i].normal[k];
        }
    }
    if (m.count == 1)
    {
        push(&all->at[0], m.turn[0], &m.force[0], force, force_x);
        return;
    }

    weigh(all, &m, weight);
    for (int i = 0; i < m.count; i++)
    {
        const scalar *f = &m.force[i], *g = &weight[i];

        if (g->value > 0)
        {
            const scalar sum = covered(all, &m, weight, i);
            const double w = g->value / sum.value;
            scalar size = {w * f->value, {0, 0, 0}};

            for (int k = 0; k < 3; k++)
            {
                size.gradient[k] = w * f->gradient[k]
                    + f->value * (g->gradient[k] - w * sum.gradient[k])
                      / sum.value;
            }
            push(&all->at[i], m.turn[i], &size, force, force_x);
        }
    }
}

int ellipsoid_bead_touch(const ellipsoid_bead *bead,
                         const ellipsoid_candidates *from, double *gap,
                         double force[3], double force_x[3][3],
                         ellipsoid_contact *report)
{
    contacts all;

    find_contacts(bead, from, &all, gap, report);
    if (all.count > 0)
    {
        memset(force, 0, 3 * sizeof *force);
        if (force_x)
        {
            memset(force_x, 0, 3 * sizeof *force_x);
        }
        combine(bead, &all, force, force_x);
    }
    return all.count;
}

int ellipsoid_bead_force(const double centre[3], double radius,
                         double stiffness, const ellipsoid_facet *facets,
                         const int *index, int count, double force[3],
                         double force_x[3][3])
{
    const ellipsoid_candidates from = {facets, index, count};
    ellipsoid_bead bead = {{0, 0, 0}, radius, stiffness};
    double gap = 0;

    ellipsoid_copy(centre, bead.centre);
    memset(force, 0, 3 * sizeof *force);
    if (force_x)
    {
        memset(force_x, 0, 3 * sizeof *force_x);
    }
    return ellipsoid_bead_touch(&bead, &from, &gap, force, force_x, NULL);
}
