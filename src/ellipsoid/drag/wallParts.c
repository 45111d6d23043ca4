/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    wallParts.c - how much of a plane a wall covers.

    A wall counts by the part of the plane that it covers, with a weight that
    falls off like the body's action on it: 1/(pi (1 + r^2)^2), r in the plane in
    units of the height, about the foot of the centre
    (the flow about a force near a plane presses on it like r^-3, and is felt
    back like 1/r); for squeezing, whose pressure falls off so, in units of
    sqrt(2 g R) along each curvature, about the foot of the nearest point. With
    Phi(r) the part of the plane within r, that of a wall is the integral of
    Phi over the angle along its rim, over 2 pi, and so adds up over facets, is
    the same for any triangulation, and continuous. At r = c, beyond which no
    wall is looked for, Phi = (r^2/(1 + r^2) - k r^2)/N is flat and 1.
    Edges between facets of one plane are left out: the angle alone gives 1 if
    the foot is on the wall, else 0, and edges that are no seams the integral of
    Phi - 1.
*/
#include "drag/wallParts.h"

static const double pi = 3.14159265358979323846;

/* c if the body is near */
static const double widest = 4;

enum
{
    POSE = ELLIPSOID_POSE_SIZE,
    FAR = ELLIPSOID_PLANE_FAR,
    NEAR = ELLIPSOID_PLANE_NEAR
};

typedef ellipsoid_wall_kernel kernel;
typedef ellipsoid_wall_rim rim;
typedef ellipsoid_wall wall;
typedef ellipsoid_wall_view view;

/* The gap g is cut off at e: g above 2 e, e + g^2/(4 e) below, e if negative;
   smooth to the first derivative. */
static double cut_off(double gap, double least, double *slope)
{
    if (gap >= 2 * least)
    {
        *slope = 1;
        return gap;
    }
    *slope = gap > 0 ? 0.5 * gap / least : 0;
    return least + 0.5 * *slope * fmax(gap, 0);
}

/* From 0 to 1 with t, smooth to the second derivative. */
static double smooth_step(double t, double *slope)
{
    t = fmin(fmax(t, 0), 1);
    *slope = 30 * t * t * (1 - t) * (1 - t);
    return t * t * t * (10 - 15 * t + 6 * t * t);
}

/* 1/c^2 = 1/widest^2 + 1/most^2 */
static void set_cut(kernel *k, double most)
{
    const double square = 1 / (1 / (widest * widest) + 1 / (most * most));
    const double per = 1 / (1 + square);

    k->cut = sqrt(square);
    k->cut_slope = square / (most * most);
    k->k = per * per;
    k->n = square * square * per * per;
}

void ellipsoid_wall_begin(view *s, const double normal[3], double height,
                          wall *w)
{
    const double *a = s->model->options.semi_axes;
    const double reach = ELLIPSOID_WALL_BESIDE * s->model->wall_range;
    const double longest = ellipsoid_largest(a);
    kernel *far = &w->seen[FAR], *near = &w->seen[NEAR];
    double n[3], stretched[3], foot[3], support;

    memset(w, 0, sizeof(*w));
    w->normal = normal;
    w->height.value = height;
    ellipsoid_product(s->axis, normal, n);
    for (int i = 0; i < 3; i++)
    {
        stretched[i] = a[i] * n[i];
    }
    w->support.value = support = ellipsoid_length(stretched);
    w->gap.value = cut_off(height - support, s->model->options.lubrication_gap,
                           &w->gap_slope);
    far->scale = 1 / height;
    near->scale = sqrt(0.5 * support / w->gap.value);
    for (int i = 0; i < 3; i++)
    {
        far->shrink[i] = 1;
        far->shift[i] = height * n[i];
        far->normal[i] = n[i];
        near->shrink[i] = 1 / a[i];
        near->normal[i] = stretched[i] / support;
        near->shift[i] = near->normal[i] + (height - support) * n[i] / a[i];
    }
    set_cut(far, reach * far->scale);
    set_cut(near, reach * near->scale / longest);
    for (int m = 0; m < 2; m++)
    {
        kernel *k = &w->seen[m];

        k->reach = k->cut / k->scale * (m == NEAR ? longest : 1);
        for (int i = 0; i < 3; i++)
        {
            foot[i] = -k->shift[i] / k->shrink[i];
        }
        ellipsoid_combination(s->axis, foot[0], foot[1], foot[2], k->foot);
        ellipsoid_add(k->foot, s->x);
    }
}

/* r of a vertex; from: where it is from the centre, lab. */
static void look(view *s, const kernel *k, const double vertex[3],
                 double from[3], double r[3])
{
    double v[3];

    ellipsoid_difference(vertex, s->x, from);
    ellipsoid_product(s->axis, from, v);
    for (int i = 0; i < 3; i++)
    {
        r[i] = k->scale * (k->shrink[i] * v[i] + k->shift[i]);
    }
}

/* normal.(r1 x r2) of an edge: without a negative sign, also of zero, where the
   foot is on its left. Of two facets with this edge exactly one has it so,
   whatever rounding does. */
static double side_of(const kernel *k, const double r1[3], const double r2[3],
                      const double vertex1[3], const double vertex2[3])
{
    int order = 0;
    double across[3], side;

    for (int i = 0; i < 3 && order == 0; i++)
    {
        order = (vertex1[i] < vertex2[i]) - (vertex1[i] > vertex2[i]);
    }
    ellipsoid_cross(order > 0 ? r1 : r2, order > 0 ? r2 : r1, across);
    side = ellipsoid_dot(k->normal, across) + 0.0; /* no -0 */
    return order > 0 ? side : -side;
}

/* Adds an edge from r1 to r2, v1 and v2 from the centre. */
static void add_edge(const kernel *k, const double r1[3], const double r2[3],
                     const double v1[3], const double v2[3], double side,
                     rim *sum)
{
    double along[3], outward[3], length, d, low, high, reach;

    ellipsoid_difference(r2, r1, along);
    length = ellipsoid_length(along);
    d = side / length;
    if (!(fabs(d) < k->cut))
    {
        return;
    }
    reach = sqrt(k->cut * k->cut - d * d);
    low = ellipsoid_dot(r1, along) / length;
    high = fmin(ellipsoid_dot(r2, along) / length, reach);

    const double start = low;

    low = fmax(low, -reach);
    if (!(low < high))
    {
        return;
    }

    sum->edges++;

    const double q2 = 1 + d * d, q = sqrt(q2), span = high - low;
    const double by_low = 1 / (q2 + low * low),
                 by_high = 1 / (q2 + high * high);
    const double turn = atan2(q * span, q2 + low * high) / q;
    const double angle = atan2(d * span, d * d + low * high);
    const double part = d * (turn - k->k * span) / k->n;
    const double per = 1 / (pi * k->n);
    const double whole =
        per * (0.5 * (high * by_high - low * by_low + turn) / q2 - k->k * span);
    const double first =
        0.5 * per * (by_low - by_high - k->k * (high * high - low * low));
    const double c2 = k->cut * k->cut, more = (first - start * whole) / length;

    sum->value += (part - angle) / (2 * pi);
    sum->of_cut +=
        4 / (2 * pi * k->cut * (1 + c2)) * (d * span * c2 * k->k / k->n - part);
    sum->stretch += whole * d;
    ellipsoid_cross(along, k->normal, outward);
    for (int i = 0; i < 3; i++)
    {
        const double o = outward[i] / length;

        sum->normal[i] += whole * o;
        for (int l = 0; l < 3; l++)
        {
            sum->moment[l][i] += o * (whole * v1[l] + more * (v2[l] - v1[l]));
        }
    }
}

void ellipsoid_wall_add(view *s, const ellipsoid_facet *facet, wall *w)
{
    double side[2][3]; /* [m] of the foot on the left of each edge */

    for (int i = 0; i < 3; i++)
    {
        const double *from = facet->vertex[i];
        double along[3], across[3], off[3], per;

        ellipsoid_difference(facet->vertex[(i + 1) % 3], from, along);
        ellipsoid_cross(w->normal, along, across);
        per = 1 / ellipsoid_length(along);
        for (int m = 0; m < 2; m++)
        {
            ellipsoid_difference(w->seen[m].foot, from, off);
            side[m][i] = per * ellipsoid_dot(across, off);
        }
    }
    for (int m = 0; m < 2; m++)
    {
        const kernel *k = &w->seen[m];
        const double most = k->reach * (1 + 1e-9);
        int left = 0;

        if (side[m][0] < -most || side[m][1] < -most || side[m][2] < -most)
        {
            continue;
        }
        for (int i = 0; i < 3; i++)
        {
            const int seen = !(facet->within & 1 << i) && side[m][i] < most;
            int on_left = side[m][i] > 0;

            /* where rounding might decide, side_of() does */
            if (seen || fabs(side[m][i]) <= 1e-6 * k->reach)
            {
                const double *v1 = facet->vertex[i];
                const double *v2 = facet->vertex[(i + 1) % 3];
                double r1[3], r2[3], from1[3], from2[3], exact;

                look(s, k, v1, from1, r1);
                look(s, k, v2, from2, r2);
                exact = side_of(k, r1, r2, v1, v2);
                on_left = !signbit(exact);
                if (seen)
                {
                    add_edge(k, r1, r2, from1, from2, exact, &w->sum[m]);
                }
            }
            left += on_left;
        }
        w->sum[m].inside += left == 3;
    }
}

/* How a weight's sum changes with component n of the pose: r = scale (shrink v +
   shift). */
static double sum_slope(view *s, const kernel *k, const rim *sum, int n,
                        double scale, const double shift[3])
{
    double by = scale * (sum->stretch + sum->of_cut * k->cut * k->cut_slope);

    for (int i = 0; i < 3; i++)
    {
        double moved = 0;

        if (n < 3)
        {
            moved = -s->axis[i][n] * sum->normal[i];
        }
        for (int l = 0; n >= 3 && l < 3; l++)
        {
            moved += s->turned[n - 3][i][l] * sum->moment[l][i];
        }
        by += k->scale * (k->shrink[i] * moved + shift[i] * sum->normal[i]);
    }
    return by;
}

/* How height, gap and parts change with component n of the pose. */
static void set_slopes(view *s, wall *w, int n)
{
    const double *a = s->model->options.semi_axes;
    const double *axis = w->seen[FAR].normal, *out = w->seen[NEAR].normal;
    const double h = w->height.value, p = w->support.value;
    const double h_n = n < 3 ? w->normal[n] : 0;
    double *turn = w->normal_by[n], p_n = 0, shift[2][3], scale[2];

    for (int i = 0; i < 3; i++)
    {
        turn[i] = n < 3 ? 0 : ellipsoid_dot(s->turned[n - 3][i], w->normal);
        p_n += a[i] * out[i] * turn[i];
    }
    w->height.by[n] = h_n;
    w->support.by[n] = p_n;
    w->gap.by[n] = w->gap_slope * (h_n - p_n);
    scale[FAR] = -h_n / h;
    scale[NEAR] = 0.5 * (p_n / p - w->gap.by[n] / w->gap.value);
    for (int i = 0; i < 3; i++)
    {
        shift[FAR][i] = h_n * axis[i] + h * turn[i];
        shift[NEAR][i] = (a[i] * turn[i] - out[i] * p_n) / p
                       + ((h_n - p_n) * axis[i] + (h - p) * turn[i]) / a[i];
    }
    for (int m = 0; m < 2; m++)
    {
        w->part[m].by[n] =
            sum_slope(s, &w->seen[m], &w->sum[m], n, scale[m], shift[m]);
    }
}

void ellipsoid_wall_end(view *s, wall *w)
{
    const double range = s->model->wall_range;
    const double h = w->height.value, p = w->support.value;
    double far_slope, beside_slope;
    const double far = 1 - smooth_step(2 * h / range - 1, &far_slope);
    const double cut = smooth_step(h / p, &beside_slope);

    for (int n = 0; s->slopes && n < POSE; n++)
    {
        set_slopes(s, w, n);
    }
    for (int m = 0; m < 2; m++)
    {
        w->part[m].value = w->sum[m].inside + w->sum[m].value;
    }
    w->fade = ellipsoid_chain(
        far * cut, far * beside_slope / p - 2 * far_slope / range * cut,
        &w->height, -far * beside_slope * h / (p * p), &w->support);
}
