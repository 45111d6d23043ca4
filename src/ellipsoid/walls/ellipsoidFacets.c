/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    ellipsoidFacets.c - an ellipsoid against one facet: does its distance to the
    wall have a local minimum there?

    The signed distance of a point w to the ellipsoid at x is
        D(w) = max over unit n of n.(x - w) - h(n),   h(n)^2 = n.M n,
    with the shape M = R diag(a_i^2) R^T. It is a convex function of w, whose
    gradient is -n. So the minimum over a facet is unique, and a local one of
    the wall under the same conditions on n as for a bead (facets.c): inside
    the facet where n is the facet's normal; on an edge where n is perpendicular
    to it and points into neither facet; at a vertex where it points along none
    of its edges. There the contact point of the ellipsoid is x - p,
    p = M n/h, and that of the wall w = x - p - D n.

    Where several edges may have it, w on the line of one tells on which side of
    the edge to go on.
    A face takes D along its own normal, an edge the largest D of the normals
    perpendicular to it. Deeper than its radius of curvature, an ellipsoid has
    other points nearer to w, and w may even lie beyond the body: no contact
    is deeper than half the chord along the normal.
*/
#include "walls/walls.h"

#include <math.h>

/* As in facets.c */
static const double rounding = 1e-9;

/* A contact point farther beside a flat edge, relative to the support, is there
   neither by rounding nor because the edge is not quite flat. */
static const double beside_edge = 1e-4;

/* Relative lower bounds of what vanishes at centres of curvature: of distances
   from the axes, and of D + P below. */
static const double smallest_offset = 1e-18, smallest_radius = 1e-9;

/* h(n), and p; written so that it loses no digits in long ellipsoids. */
static double support_at(const ellipsoid_surface *body, const double n[3],
                         double p[3])
{
    double along[3], far[3], h;

    ellipsoid_surface_to_body(body, n, along);
    for (int i = 0; i < 3; i++)
    {
        along[i] *= body->axes[i];
        far[i] = along[i] * body->axes[i];
    }
    h = ellipsoid_length(along);
    ellipsoid_surface_to_lab(body, far, p);
    for (int i = 0; i < 3; i++)
    {
        p[i] /= h;
    }
    return h;
}

/*
    Direction v, not of length one, of the outward normal at the point nearest
    to d of an ellipse or ellipsoid in its own axes: d = (a_i^2 + t) v with the
    largest t for which the a_i v_i have the length 1. That length's inverse is
    an increasing, concave function of t, and a linear one for a sphere: Newton
    from anywhere arrives on the root's left and goes on monotonically.
*/
static void nearest_normal(int dimension, const double *axes, const double *d,
                           double *v)
{
    double b[3], e[3], smallest = axes[0], low = 0;

    for (int i = 1; i < dimension; i++)
    {
        smallest = fmin(smallest, axes[i]);
    }
    for (int i = 0; i < dimension; i++)
    {
        b[i] = axes[i] * fmax(fabs(d[i]), smallest_offset * smallest);
        e[i] = (axes[i] - smallest) * (axes[i] + smallest);
        low = fmax(low, b[i] - e[i]);
    }

    /* s = t + smallest^2; one term alone is 1 at `low` */
    double s = fmax(low, smallest * smallest);

    for (int n = 0; n < 50; n++)
    {
        double squared = 0, slope = 0, before = s;

        for (int i = 0; i < dimension; i++)
        {
            const double y = b[i] / (e[i] + s);

            squared += y * y;
            slope += y * y / (e[i] + s);
        }
        s = fmax(low, s + (sqrt(squared) - 1) * squared / slope);
        if (n > 0 && !(s > before + 1e-15 * s))
        {
            break;
        }
    }
    for (int i = 0; i < dimension; i++)
    {
        v[i] = copysign(b[i] / axes[i] / (e[i] + s), d[i]);
    }
}

/* Completes a contact from its normal; d: from the wall to the centre. */
static void complete(const ellipsoid_surface *body, const double d[3],
                     ellipsoid_surface_contact *c)
{
    const double length = ellipsoid_length(c->normal);

    for (int i = 0; i < 3; i++)
    {
        c->normal[i] /= length;
    }
    c->support = support_at(body, c->normal, c->arm);
    c->height = ellipsoid_dot(c->normal, d) - c->support;
}

/* The plane of normal n through a point; d: from there to the centre. */
static void contact_plane(const ellipsoid_surface *body, const double n[3],
                          const double d[3], ellipsoid_surface_contact *c)
{
    c->feature = ELLIPSOID_ON_FACE;
    ellipsoid_copy(n, c->normal);
    c->support = support_at(body, n, c->arm);
    c->height = ellipsoid_dot(n, d) - c->support;
}

/* A vertex; d: from it to the centre. */
static void contact_point(const ellipsoid_surface *body, const double d[3],
                          ellipsoid_surface_contact *c)
{
    double along[3], v[3];

    ellipsoid_surface_to_body(body, d, along);
    nearest_normal(3, body->axes, along, v);
    ellipsoid_surface_to_lab(body, v, c->normal);
    c->feature = ELLIPSOID_ON_VERTEX;
    complete(body, d, c);
}

/* The line of direction c->edge; d: from it to the centre, across:
   perpendicular to it. Along it, the ellipsoid is an ellipse. */
static void contact_line(const ellipsoid_surface *body, const double d[3],
                         const double across[3], ellipsoid_surface_contact *c)
{
    double t[2][3], l[2][3], area[3], axes[2], in_axes[2], v[2];

    ellipsoid_copy(across, t[0]);
    ellipsoid_cross(c->edge, across, t[1]);
    for (int n = 0; n < 2; n++)
    {
        ellipsoid_surface_to_body(body, t[n], l[n]);
        for (int i = 0; i < 3; i++)
        {
            l[n][i] *= body->axes[i];
        }
    }
    ellipsoid_cross(l[0], l[1], area);

    /* eigenvalues of the matrix of the l.l; the smaller from the area, lest
       digits be lost */
    const double half =
        (ellipsoid_dot(l[0], l[0]) - ellipsoid_dot(l[1], l[1])) / 2;
    const double mixed = ellipsoid_dot(l[0], l[1]);
    const double root = sqrt(half * half + mixed * mixed);
    const double larger = ellipsoid_dot(l[1], l[1]) + half + root;
    /* of half the angle of (half, mixed); the larger without loss of digits */
    const double more = root > 0 ? sqrt((root + fabs(half)) / (2 * root)) : 1;
    const double less = root > 0 ? mixed / (2 * root * more) : 0;
    const double cosine = half >= 0 ? more : fabs(less);
    const double sine = half >= 0 ? less : copysign(more, mixed);
    const double d0 = ellipsoid_dot(d, t[0]), d1 = ellipsoid_dot(d, t[1]);

    axes[0] = sqrt(larger);
    axes[1] = ellipsoid_length(area) / axes[0];
    in_axes[0] = cosine * d0 + sine * d1;
    in_axes[1] = cosine * d1 - sine * d0;
    nearest_normal(2, axes, in_axes, v);
    for (int i = 0; i < 3; i++)
    {
        c->normal[i] = (cosine * v[0] - sine * v[1]) * t[0][i]
                     + (sine * v[0] + cosine * v[1]) * t[1][i];
    }
    c->feature = ELLIPSOID_ON_EDGE;
    complete(body, d, c);
}

/* A facet as it is seen: from where its normal points, or from behind, where it
   has only what is at free rims. */
typedef struct view
{
    double normal[3];
    int behind;
} view;

static int at_vertex(const ellipsoid_facet *facet, const view *seen, int k,
                     double reach, const ellipsoid_surface_contact *c)
{
    const double upright = ellipsoid_dot(c->normal, seen->normal);

    return c->height < reach && upright >= -rounding
        && (!seen->behind || ellipsoid_facet_ends_at_vertex(facet, k))
        && (ellipsoid_facet_owns_vertex(facet, k) || upright >= 1 - rounding)
        && ellipsoid_facet_is_apex(facet, k, c->normal, rounding);
}

/* The lowest of the vertices in the set, bit by bit. */
static int nearest_vertex(const ellipsoid_facet *facet, const view *seen,
                          const ellipsoid_surface *body, double from[3][3],
                          int set, double reach,
                          ellipsoid_surface_contact *contact)
{
    int closest = -1;

    for (int k = 0; k < 3; k++)
    {
        ellipsoid_surface_contact c;

        if (set >> k & 1)
        {
            contact_point(body, from[k], &c);
            if (closest < 0 || c.height < contact->height)
            {
                *contact = c;
                closest = k;
            }
        }
    }
    return closest >= 0 && at_vertex(facet, seen, closest, reach, contact);
}

/* 1 in the first half of the chord that goes into the body at the contact point
   along the normal, 2 in the second, 0 beyond: on the body's other side. */
static int half_of_chord(const ellipsoid_surface *body,
                         const ellipsoid_surface_contact *c)
{
    double along[3], inverse = 0;

    ellipsoid_surface_to_body(body, c->normal, along);
    for (int i = 0; i < 3; i++)
    {
        along[i] /= body->axes[i];
        inverse += along[i] * along[i];
    }

    const double half = 1 / (c->support * inverse);

    return -c->height <= half ? 1 : -c->height < 2 * half ? 2 : 0;
}

/* inward: across edge k, into the facet. A normal points into neither facet of
   an edge. */
static int at_edge(const ellipsoid_facet *facet, const view *seen, int k,
                   const double inward[3], const ellipsoid_surface *body,
                   const ellipsoid_surface_contact *c)
{
    const int ends = ellipsoid_facet_ends_at_edge(facet, k);
    const double *into = ends ? inward : facet->edge_inward[k];

    return facet->edge[k] != ELLIPSOID_EDGE_CONCAVE && (ends || !seen->behind)
        && ellipsoid_dot(c->normal, into) <= rounding * ellipsoid_length(into)
        && ellipsoid_dot(c->normal, seen->normal) >= -rounding
        && half_of_chord(body, c) == 1;
}

static int nearest_from(const ellipsoid_facet *facet, const view *seen,
                        const ellipsoid_surface *body, double reach,
                        ellipsoid_surface_contact *contact)
{
    const double *n = seen->normal;
    double from[3][3], p[3];
    int outside = 0, candidates = 0;

    ellipsoid_difference(body->centre, facet->vertex[0], from[0]);

    /* no point of the plane is nearer */
    const double support = support_at(body, n, p);
    const double height = ellipsoid_dot(from[0], n);

    if (!(fabs(height) - support < reach))
    {
        return 0;
    }
    ellipsoid_difference(body->centre, facet->vertex[1], from[1]);
    ellipsoid_difference(body->centre, facet->vertex[2], from[2]);

    for (int k = 0; k < 3; k++)
    {
        double along[3], inward[3], foot[3];

        ellipsoid_difference(facet->vertex[(k + 1) % 3], facet->vertex[k],
                             along);
        ellipsoid_cross(facet->normal, along, inward);
        ellipsoid_difference(from[k], p, foot);
        if (!(ellipsoid_dot(inward, foot) < 0))
        {
            continue;
        }
        outside = 1;

        const double size = ellipsoid_length(along);

        /* far over a flat edge the neighbour is nearer all along it */
        if (facet->edge[k] == ELLIPSOID_EDGE_FLAT
            && ellipsoid_dot(inward, foot) < -beside_edge * support * size)
        {
            continue;
        }
        for (int i = 0; i < 3; i++)
        {
            contact->edge[i] = along[i] / size;
        }
        contact_line(body, from[k], n, contact);
        if (!(contact->height < reach))
        {
            continue; /* nor are its ends */
        }
        ellipsoid_difference(from[k], contact->arm, foot);

        const double part = ellipsoid_dot(foot, contact->edge) / size;

        if (part >= 0 && part <= 1)
        {
            return at_edge(facet, seen, k, inward, body, contact);
        }
        candidates |= 1 << (part < 0 ? k : (k + 1) % 3);
    }
    if (outside)
    {
        return nearest_vertex(facet, seen, body, from, candidates, reach,
                              contact);
    }
    if (seen->behind)
    {
        return 0;
    }
    contact_plane(body, n, from[0], contact);
    return half_of_chord(body, contact);
}

int ellipsoid_surface_nearest(const ellipsoid_facet *facet,
                              const ellipsoid_surface *body, double reach,
                              ellipsoid_surface_contact *contact)
{
    const double *n = facet->normal;
    const view front = {{n[0], n[1], n[2]}, 0};
    const view back = {{-n[0], -n[1], -n[2]}, 1};
    const int found = nearest_from(facet, &front, body, reach, contact);
    ellipsoid_surface_contact rim;

    if (found != 1
        && (ellipsoid_facet_ends_at_edge(facet, 0)
            || ellipsoid_facet_ends_at_edge(facet, 1)
            || ellipsoid_facet_ends_at_edge(facet, 2))
        && nearest_from(facet, &back, body, reach, &rim))
    {
        *contact = rim;
        return 1;
    }
    return found;
}

int ellipsoid_surface_cut_plane(const ellipsoid_facet *facet,
                                const ellipsoid_surface *body,
                                ellipsoid_surface_contact *contact)
{
    double d[3];

    ellipsoid_difference(body->centre, facet->vertex[0], d);
    contact_plane(body, facet->normal, d, contact);
    return contact->height < 0 && contact->height + contact->support >= 0
        && ellipsoid_surface_cuts(facet, body);
}

int ellipsoid_surface_may_reach(const ellipsoid_facet *facet,
                                const ellipsoid_surface *body, double reach)
{
    ellipsoid_surface_contact c;
    double d[3], p[3];

    ellipsoid_difference(body->centre, facet->vertex[0], d);
    if (fabs(ellipsoid_dot(d, facet->normal))
            - support_at(body, facet->normal, p)
        > reach)
    {
        return 0;
    }
    /* no distance changes by more than the way */
    ellipsoid_difference(body->centre, facet->middle, d);
    contact_point(body, d, &c);
    return !(c.height - facet->radius > reach);
}

/* The directions in which the normal may turn, none or one or two. */
static void set_directions(const ellipsoid_surface_contact *c, double t[2][3])
{
    const double *n = c->normal;

    if (c->feature == ELLIPSOID_ON_EDGE)
    {
        ellipsoid_cross(c->edge, n, t[0]);
    }
    else if (c->feature == ELLIPSOID_ON_VERTEX)
    {
        const double away[3] = {fabs(n[0]) < 0.6, fabs(n[0]) >= 0.6, 0};

        ellipsoid_cross(away, n, t[0]);

        const double length = ellipsoid_length(t[0]);

        ellipsoid_set(t[0], t[0][0] / length, t[0][1] / length,
                      t[0][2] / length);
        ellipsoid_cross(n, t[0], t[1]);
    }
}

/*
    p is that of a turned normal in a turned body: dp = P (dn - w x n) + w x p
    with P = dp/dn = (M - pp)/h for a rotation w. From x - p - D n staying on
    the edge or the vertex follows, in the directions in which n may turn,
        (D + P) dn = dx + P (w x n) - w x p,
    and from D being stationary, dD = n.dx - w.(p x n).
*/
void ellipsoid_surface_derivatives(const ellipsoid_surface *body,
                                   ellipsoid_surface_contact *c)
{
    const double *n = c->normal, *p = c->arm;
    const double floor = smallest_radius * body->smallest;
    double bend[3][3], t[2][3] = {{0}}, bent[2][3], couple[3];

    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            bend[i][j] = (body->shape[i][j] - p[i] * p[j]) / c->support;
        }
    }
    set_directions(c, t);
    ellipsoid_product(bend, t[0], bent[0]);
    ellipsoid_product(bend, t[1], bent[1]);

    /* D + P; where n does not turn, t is zero and the rest does not matter */
    const double a00 = fmax(c->height + ellipsoid_dot(t[0], bent[0]), floor);
    const double a11 = c->height + ellipsoid_dot(t[1], bent[1]);
    const double a01 = ellipsoid_dot(t[0], bent[1]);
    const double rest = fmax(a11 - a01 * a01 / a00, floor);

    ellipsoid_cross(p, n, couple);
    for (int k = 0; k < ELLIPSOID_SURFACE_VARIABLES; k++)
    {
        double unit[3] = {0, 0, 0}, turn[3] = {0, 0, 0}, swept[3] = {0, 0, 0};
        double right[3], change[3], moved[3];

        unit[k % 3] = 1;
        c->height_slope[k] = k < 3 ? n[k] : -couple[k - 3];
        if (k >= 3)
        {
            ellipsoid_cross(unit, n, turn);
            ellipsoid_cross(unit, p, swept);
        }
        ellipsoid_product(bend, turn, right);
        for (int i = 0; i < 3; i++)
        {
            right[i] += (k < 3 ? unit[i] : 0) - swept[i];
        }

        const double along[2] = {ellipsoid_dot(t[0], right),
                                 ellipsoid_dot(t[1], right)};
        const double second = (along[1] - a01 * along[0] / a00) / rest;
        const double first = (along[0] - a01 * second) / a00;

        for (int i = 0; i < 3; i++)
        {
            change[i] = first * t[0][i] + second * t[1][i];
            c->normal_slope[i][k] = change[i];
            change[i] -= turn[i];
        }
        ellipsoid_product(bend, change, moved);
        for (int i = 0; i < 3; i++)
        {
            c->arm_slope[i][k] = moved[i] + swept[i];
        }
    }
}
