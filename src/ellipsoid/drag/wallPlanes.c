/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    wallPlanes.c - the walls near a body as planes, and how much of each is
    there.

    Facets of one plane are one wall. It counts by the part of the plane that it
    covers, with a weight that falls off like the body's action on it: 1/(pi (1 +
    r^2)^2), r in the plane in units of the height, about the foot of the centre
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
#include "drag/drag.h"

static const double pi = 3.14159265358979323846;

/* c if the body is near; how far from the foot a wall is looked for at most, and
   so from a body in range, in ranges; how far the centre may move before facets
   are listed again, the less where there are too many. */
static const double widest = 4, beside = 0.75, looked = 1.25;
static const double margin_parts[] = {0.4, 0.1};

/* What makes two planes one: an angle [rad], a part of the range. */
static const double in_plane = 1e-6;

enum
{
    POSE = ELLIPSOID_POSE_SIZE,
    FAR = ELLIPSOID_PLANE_FAR,
    NEAR = ELLIPSOID_PLANE_NEAR
};

/* Where a kernel sees a point v of the wall, from the centre in the body frame:
   r = scale (shrink v + shift). */
typedef struct kernel
{
    double scale, shrink[3], shift[3], normal[3];
    double cut, k, n; /* c, k and N above */
    double cut_slope; /* of ln c by ln scale */
} kernel;

/* Sums along the rim: of Phi - 1 over the angle, of the weight times the
   outward normal, of its product with v (lab), and with r; what the cut is
   worth. */
typedef struct rim
{
    int inside, edges; /* edges that are seen */
    double value, normal[3], moment[3][3], stretch, of_cut;
} rim;

/* One wall of a pose. */
typedef struct wall
{
    const ellipsoid_facet *facet; /* the first */
    double height, support, gap;
    kernel seen[2];
    rim sum[2];
} wall;

typedef struct view
{
    const ellipsoid_model *model;
    const double *x;
    double axis[3][3];      /* unit */
    double turned[4][3][3]; /* their derivatives by q */
} view;

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

static void set_wall(view *s, const ellipsoid_facet *facet,
                     double height, wall *w)
{
    const double *a = s->model->options.semi_axes;
    const double reach = beside * s->model->options.wall_range;
    const double longest = fmax(a[0], fmax(a[1], a[2]));
    kernel *far = &w->seen[FAR], *near = &w->seen[NEAR];
    double n[3], stretched[3], slope;

    memset(w, 0, sizeof(*w));
    w->facet = facet;
    w->height = height;
    ellipsoid_product(s->axis, facet->normal, n);
    for (int i = 0; i < 3; i++)
    {
        stretched[i] = a[i] * n[i];
    }
    w->support = ellipsoid_length(stretched);
    w->gap = cut_off(height - w->support, s->model->options.lubrication_gap,
                     &slope);
    far->scale = 1 / height;
    near->scale = sqrt(0.5 * w->support / w->gap);
    for (int i = 0; i < 3; i++)
    {
        far->shrink[i] = 1;
        far->shift[i] = height * n[i];
        far->normal[i] = n[i];
        near->shrink[i] = 1 / a[i];
        near->normal[i] = stretched[i] / w->support;
        near->shift[i] = near->normal[i] + (height - w->support) * n[i] / a[i];
    }
    set_cut(far, reach * far->scale);
    set_cut(near, reach * near->scale / longest);
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
    const double by_low = 1 / (q2 + low * low), by_high = 1 / (q2 + high * high);
    const double turn = atan2(q * span, q2 + low * high) / q;
    const double angle = atan2(d * span, d * d + low * high);
    const double part = d * (turn - k->k * span) / k->n;
    const double per = 1 / (pi * k->n);
    const double whole = per
                       * (0.5 * (high * by_high - low * by_low + turn) / q2
                          - k->k * span);
    const double first = 0.5 * per
                       * (by_low - by_high - k->k * (high * high - low * low));
    const double c2 = k->cut * k->cut, more = (first - start * whole) / length;

    sum->value += (part - angle) / (2 * pi);
    sum->of_cut += 4 / (2 * pi * k->cut * (1 + c2))
                 * (d * span * c2 * k->k / k->n - part);
    sum->stretch += whole * d;
    ellipsoid_cross(along, k->normal, outward);
    for (int i = 0; i < 3; i++)
    {
        const double o = outward[i] / length;

        sum->normal[i] += whole * o;
        for (int l = 0; l < 3; l++)
        {
            sum->moment[l][i] +=
                o * (whole * v1[l] + more * (v2[l] - v1[l]));
        }
    }
}

static void add_facet(view *s, const ellipsoid_facet *facet, wall *w)
{
    for (int m = 0; m < 2; m++)
    {
        const kernel *k = &w->seen[m];
        double r[3][3], from[3][3];
        int left = 0;

        for (int i = 0; i < 3; i++)
        {
            look(s, k, facet->vertex[i], from[i], r[i]);
        }
        for (int i = 0; i < 3; i++)
        {
            const int next = (i + 1) % 3;

            const double side = side_of(k, r[i], r[next], facet->vertex[i],
                                        facet->vertex[next]);

            left += !signbit(side);
            if (facet->edge[i] != ELLIPSOID_EDGE_FLAT)
            {
                add_edge(k, r[i], r[next], from[i], from[next], side,
                         &w->sum[m]);
            }
        }
        w->sum[m].inside += left == 3;
    }
}

/* Lists facets anew if the centre has moved too far. Where walls are refused
   far off, or too many, those nearer may do. */
static ellipsoid_status
collect(const ellipsoid_surroundings *surroundings, const double x[3],
        double range, double reach, ellipsoid_facet_cache *cache)
{
    const int tries = sizeof(margin_parts) / sizeof(*margin_parts);
    ellipsoid_status status = ELLIPSOID_OK;
    double d[3];

    ellipsoid_difference(x, cache->near_x, d);
    if (cache->near_count >= 0
        && ellipsoid_dot(d, d) <= cache->near_margin * cache->near_margin)
    {
        return ELLIPSOID_OK;
    }
    for (int k = 0; k < tries; k++)
    {
        const double margin = margin_parts[k] * range;
        ellipsoid_facet_list list;

        cache->near_count = -1;
        status = ellipsoid_list_facets(surroundings, x, reach + margin, &list);
        if (status == ELLIPSOID_STEP_UNDERFLOW)
        {
            continue;
        }
        if (status != ELLIPSOID_OK)
        {
            return status;
        }
        cache->near_facets = list.facets;
        ellipsoid_copy(x, cache->near_x);
        cache->near_count = 0;
        for (int i = 0; i < list.count; i++)
        {
            const ellipsoid_facet *facet = &list.facets[list.index[i]];
            double height;

            ellipsoid_difference(x, facet->middle, d);
            height = ellipsoid_dot(d, facet->normal);
            if (facet->mirror || !(height > -margin && height < range + margin))
            {
                continue;
            }
            if (cache->near_count == ELLIPSOID_MAX_NEAR)
            {
                status = ELLIPSOID_TOO_MANY_FACETS;
                break;
            }
            cache->near_facet[cache->near_count++] = list.index[i];
        }
        if (status == ELLIPSOID_OK)
        {
            cache->near_margin = list.count == 0 && list.reach > reach + margin
                                   ? list.reach - reach
                                   : margin;
            return ELLIPSOID_OK;
        }
    }
    cache->near_count = -1;
    return status;
}

/* The wall of this facet among those found, or a new one; NULL: it is too far.
   Where there are too many, the farthest goes. */
static wall *find_wall(view *s, const ellipsoid_facet *facet,
                       double height, wall *walls, int *count)
{
    const double same = in_plane * s->model->options.wall_range;
    int at = *count;

    for (int k = 0; k < *count; k++)
    {
        double d[3];

        ellipsoid_difference(facet->normal, walls[k].facet->normal, d);
        if (ellipsoid_dot(d, d) < in_plane * in_plane
            && fabs(height - walls[k].height) < same)
        {
            return &walls[k];
        }
    }
    if (*count < ELLIPSOID_MAX_PLANES)
    {
        (*count)++;
    }
    else
    {
        at = 0;
        for (int k = 1; k < *count; k++)
        {
            at = walls[k].height > walls[at].height ? k : at;
        }
        if (walls[at].height <= height)
        {
            return NULL;
        }
    }
    set_wall(s, facet, height, &walls[at]);
    return &walls[at];
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

/* Slopes of a plane by component n of the pose; fade: the factor of its weights
   and its derivatives by height and support. */
static void set_slopes(view *s, const wall *w, int n, const double fade[3],
                       double gap_slope, ellipsoid_plane *plane)
{
    const double *a = s->model->options.semi_axes;
    const double *axis = w->seen[FAR].normal, *out = w->seen[NEAR].normal;
    const double h = w->height, p = w->support;
    const double h_n = n < 3 ? w->facet->normal[n] : 0;
    double *turn = plane->normal_slope[n], p_n = 0, shift[2][3], scale[2];

    for (int i = 0; i < 3; i++)
    {
        turn[i] =
            n < 3 ? 0 : ellipsoid_dot(s->turned[n - 3][i], w->facet->normal);
        p_n += a[i] * out[i] * turn[i];
    }
    plane->gap_slope[n] = gap_slope * (h_n - p_n);
    scale[FAR] = -h_n / h;
    scale[NEAR] = 0.5 * (p_n / p - plane->gap_slope[n] / w->gap);
    for (int i = 0; i < 3; i++)
    {
        shift[FAR][i] = h_n * axis[i] + h * turn[i];
        shift[NEAR][i] = (a[i] * turn[i] - out[i] * p_n) / p
                       + ((h_n - p_n) * axis[i] + (h - p) * turn[i]) / a[i];
    }
    for (int m = 0; m < 2; m++)
    {
        const rim *sum = &w->sum[m];

        plane->weight_slope[m][n] =
            (fade[1] * h_n + fade[2] * p_n) * (sum->inside + sum->value)
            + fade[0]
                  * sum_slope(s, &w->seen[m], sum, n, scale[m], shift[m]);
    }
}

/* The plane of a wall; 0 if it does not count. It fades where it goes out of
   range, and where it cuts the body, which then is beside its wall. */
static int set_plane(view *s, const wall *w, int slopes, ellipsoid_plane *plane)
{
    const double range = s->model->options.wall_range, h = w->height;
    const double p = w->support;
    double far_slope, beside_slope, gap_slope;
    const double far = 1 - smooth_step(2 * h / range - 1, &far_slope);
    const double cut = smooth_step(h / p, &beside_slope);
    const double fade[3] = {far * cut,
                            far * beside_slope / p - 2 * far_slope / range * cut,
                            -far * beside_slope * h / (p * p)};

    plane->gap = cut_off(h - p, s->model->options.lubrication_gap, &gap_slope);
    ellipsoid_copy(w->facet->normal, plane->wall);
    ellipsoid_copy(w->seen[FAR].normal, plane->normal);
    for (int m = 0; m < 2; m++)
    {
        plane->weight[m] = fade[0] * (w->sum[m].inside + w->sum[m].value);
    }
    for (int n = 0; slopes && n < POSE; n++)
    {
        set_slopes(s, w, n, fade, gap_slope, plane);
    }
    return plane->weight[FAR] != 0 || plane->weight[NEAR] != 0;
}

/* Axes of length one, and their derivatives, from those of any q. */
static void set_axes(const double q[4], const ellipsoid_frame *frame, view *s)
{
    const double per = 1 / ellipsoid_square4(q);

    for (int i = 0; i < 3; i++)
    {
        for (int l = 0; l < 3; l++)
        {
            s->axis[i][l] = per * frame->axis[i][l];
            for (int n = 0; frame->by_q && n < 4; n++)
            {
                s->turned[n][i][l] =
                    per * (frame->by_q[n][i][l] - 2 * q[n] * s->axis[i][l]);
            }
        }
    }
}

/* Has it nothing of which anything is seen? */
static int is_unseen(const wall *w)
{
    return w->sum[FAR].inside + w->sum[FAR].edges + w->sum[NEAR].inside
            + w->sum[NEAR].edges
        == 0;
}

static int has_seam(const ellipsoid_facet *facet)
{
    return facet->edge[0] != ELLIPSOID_EDGE_FLAT
        || facet->edge[1] != ELLIPSOID_EDGE_FLAT
        || facet->edge[2] != ELLIPSOID_EDGE_FLAT;
}

ellipsoid_status
ellipsoid_find_planes(const ellipsoid_model *model,
                      const ellipsoid_surroundings *surroundings,
                      const ellipsoid_state *state,
                      const ellipsoid_frame *frame,
                      ellipsoid_facet_cache *cache, ellipsoid_planes *planes)
{
    const double *a = model->options.semi_axes, *x = state->x;
    const double range = model->options.wall_range;
    const double longest = fmax(a[0], fmax(a[1], a[2]));
    const ellipsoid_status status = collect(
        surroundings, x, range, looked * range + longest, cache);
    wall walls[ELLIPSOID_MAX_PLANES];
    view s = {.model = model, .x = x};
    int count = 0;

    planes->count = 0;
    if (status != ELLIPSOID_OK || cache->near_count == 0)
    {
        return status;
    }
    set_axes(state->q, frame, &s);
    for (int k = 0; k < cache->near_count; k++)
    {
        const ellipsoid_facet *facet =
            &cache->near_facets[cache->near_facet[k]];
        double d[3], height, off, width;
        int before;
        wall *w;

        ellipsoid_difference(x, facet->middle, d);
        height = ellipsoid_dot(d, facet->normal);
        if (!(height > 0 && height < range))
        {
            continue;
        }
        /* beyond what both kernels see; without seams it is to hold a foot */
        off = ellipsoid_dot(d, d) - height * height;
        width = (has_seam(facet) ? beside * range : 0) + longest
              + facet->radius;
        if (off > width * width * (1 + 1e-9))
        {
            continue;
        }
        before = count;
        w = find_wall(&s, facet, height, walls, &count);
        if (w)
        {
            add_facet(&s, facet, w);
        }
        /* which facets are listed must not tell whose plane it is */
        count = count > before && is_unseen(w) ? before : count;
    }
    for (int k = 0; k < count; k++)
    {
        planes->count += set_plane(&s, &walls[k], frame->by_q != NULL,
                                   &planes->at[planes->count]);
    }
    return ELLIPSOID_OK;
}
