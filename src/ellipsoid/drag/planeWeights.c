/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    planeWeights.c - how the planes that stand for walls share what they cover.

    In the space where the body is the unit sphere, let planes have the normals
    N = diag(a) n/p, p being the body's support, the windows v and the extents
    e, which end smoothly wherever a plane comes and goes. With c_ij = N_i.N_j,
    the part r_ij of it that is more than 0, t_ij, which is 1 for planes of one
    normal and 0 for others, and d_ij, which is 1 unless v_j is less than v_i,
        share_i  = (1 - prod_j (1 - t_ij d_ij e_j))/sum_j t_ij d_ij e_j,
        weight_i = v_i e_i share_i
                   / (1 + sum_j (r_ij - t_ij) v_j e_j share_j).
    So planes with one normal count once, also for others, whether they are
    seen as one or as several of which some fade; those of a slit fully; and two
    at an angle as 1/(1 + c).
*/
#include "drag/wallResistance.h"

enum
{
    POSE = ELLIPSOID_POSE_SIZE,
    MOST = ELLIPSOID_MAX_PLANES
};

/* The cosine from which on planes are taken for ones of one normal, ever more;
   that up to which those at right angles do not share at all at first. */
static const double alike = 0.8, across = 0.25;

/* A normal where the body is the unit sphere. */
typedef struct scaled
{
    double normal[3], slope[POSE][3];
} scaled;

static void set_scaled(const double axes[3], const ellipsoid_plane *plane,
                       int slopes, scaled *s)
{
    double stretched[3], support;

    for (int i = 0; i < 3; i++)
    {
        stretched[i] = axes[i] * plane->normal[i];
    }
    support = ellipsoid_length(stretched);
    ellipsoid_set(s->normal, stretched[0] / support, stretched[1] / support,
                  stretched[2] / support);
    for (int n = 0; n < slopes; n++)
    {
        double along;

        for (int i = 0; i < 3; i++)
        {
            stretched[i] = axes[i] * plane->normal_slope[n][i];
        }
        along = ellipsoid_dot(s->normal, stretched);
        for (int i = 0; i < 3; i++)
        {
            s->slope[n][i] = (stretched[i] - along * s->normal[i]) / support;
        }
    }
}

/* r and t of a pair, and their derivatives by c */
typedef struct likeness
{
    double r, t, r_slope, t_slope;
    double by[POSE]; /* of c */
} likeness;

/* Both with continuous first derivatives, and t no more than r. */
static void set_likeness(const scaled *a, const scaled *b, int slopes,
                         likeness *like)
{
    const double c = ellipsoid_dot(a->normal, b->normal);
    const double near = (c - alike) / (1 - alike), u = c / across;

    like->t = near > 0 ? near * near : 0;
    like->t_slope = near > 0 ? 2 * near / (1 - alike) : 0;
    like->r = u <= 0 ? 0 : u < 1 ? across * u * u * (2 - u) : c;
    like->r_slope = u <= 0 ? 0 : u < 1 ? u * (4 - 3 * u) : 1;
    for (int n = 0; n < slopes; n++)
    {
        like->by[n] = ellipsoid_dot(a->slope[n], b->normal)
                    + ellipsoid_dot(a->normal, b->slope[n]);
    }
}

/* d_ij e_j */
static void set_counted(const ellipsoid_plane *of, const ellipsoid_plane *plane,
                     int slopes, ellipsoid_quantity *counted)
{
    const double y = plane->window.value / of->window.value;
    const double d = y < 1 ? y * (2 - y) : 1;
    const double by = y < 1 ? 2 * (1 - y) / of->window.value : 0;

    counted->value = d * plane->extent.value;
    for (int n = 0; n < slopes; n++)
    {
        counted->slope[n] =
            d * plane->extent.slope[n]
            + by * (plane->window.slope[n] - y * of->window.slope[n])
                  * plane->extent.value;
    }
}

/* Adds t_ij d_ij e_j to a sum and takes it from what is bare. */
static void include(const ellipsoid_quantity *counted, const likeness *like,
                    int slopes, ellipsoid_quantity *sum,
                    ellipsoid_quantity *bare)
{
    const double part = like->t * counted->value, left = 1 - part;

    for (int n = 0; n < slopes; n++)
    {
        const double slope = like->t * counted->slope[n]
                           + like->t_slope * like->by[n] * counted->value;

        sum->slope[n] += slope;
        bare->slope[n] = bare->slope[n] * left - bare->value * slope;
    }
    sum->value += part;
    bare->value *= left;
}

/* v e share */
static void set_part(const ellipsoid_plane *plane,
                     const ellipsoid_quantity *sum,
                     const ellipsoid_quantity *bare, int slopes,
                     ellipsoid_quantity *part)
{
    const double v = plane->window.value, e = plane->extent.value;
    const double share = (1 - bare->value) / sum->value;

    part->value = v * e * share;
    for (int n = 0; n < slopes; n++)
    {
        part->slope[n] =
            share * (plane->window.slope[n] * e + v * plane->extent.slope[n])
            - v * e * (bare->slope[n] + share * sum->slope[n]) / sum->value;
    }
}

/* With the parts of all. */
static void set_weight(ellipsoid_planes *planes, likeness like[MOST][MOST],
                       const ellipsoid_quantity part[], int slopes, int i)
{
    ellipsoid_quantity *weight = &planes->at[i].weight;
    ellipsoid_quantity all = {.value = 1};

    for (int j = 0; j < planes->count; j++)
    {
        const likeness *with = i < j ? &like[i][j] : &like[j][i];
        const double rest = with->r - with->t;

        if (i == j || !(with->r > 0))
        {
            continue;
        }
        all.value += rest * part[j].value;
        for (int n = 0; n < slopes; n++)
        {
            all.slope[n] += rest * part[j].slope[n]
                          + (with->r_slope - with->t_slope) * with->by[n]
                                * part[j].value;
        }
    }
    weight->value = part[i].value / all.value;
    for (int n = 0; n < slopes; n++)
    {
        weight->slope[n] =
            (part[i].slope[n] - weight->value * all.slope[n]) / all.value;
    }
}

void ellipsoid_weigh_planes(const ellipsoid_model *model,
                            ellipsoid_planes *planes, int with_slopes)
{
    const int count = planes->count, slopes = with_slopes ? POSE : 0;
    static const likeness itself = {.r = 1, .t = 1}; /* of slope 0 */
    scaled s[MOST];
    likeness like[MOST][MOST];
    ellipsoid_quantity part[MOST];

    for (int i = 0; i < count; i++)
    {
        set_scaled(model->options.semi_axes, &planes->at[i], slopes, &s[i]);
    }
    for (int i = 0; i < count; i++)
    {
        for (int j = i + 1; j < count; j++)
        {
            set_likeness(&s[i], &s[j], slopes, &like[i][j]);
        }
    }
    for (int i = 0; i < count; i++)
    {
        ellipsoid_quantity sum = {.value = 0}, bare = {.value = 1};

        for (int j = 0; j < count; j++)
        {
            const likeness *with = j == i  ? &itself
                                 : i < j ? &like[i][j]
                                         : &like[j][i];
            ellipsoid_quantity counted;

            if (with->t > 0)
            {
                set_counted(&planes->at[i], &planes->at[j], slopes, &counted);
                include(&counted, with, slopes, &sum, &bare);
            }
        }
        set_part(&planes->at[i], &sum, &bare, slopes, &part[i]);
    }
    for (int i = 0; i < count; i++)
    {
        set_weight(planes, like, part, slopes, i);
    }
}
