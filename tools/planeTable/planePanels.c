/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    planePanels.c - panels of the spheroid's surface, and their integrals.

    The surface is x = c + A n, n on the unit sphere, and the density is taken per
    solid angle of n, as that of a free ellipsoid is constant when it translates and
    linear in n when it turns. Polar coordinates of n about the point nearest to the
    plane, psi and phi: there the height of the surface is gap + p (1 - cos psi), so
    that the pressure of lubrication depends on psi and a few harmonics of phi.
    Panels are even in s, psi = width sinh(s), width = sqrt(2 gap/p).

    Collocation at Gauss nodes. Pieces of panels are halved until they are small
    against their distance; about the node itself the two triangles of a corner
    are mapped to squares, by which 1/r is smooth (Duffy 1982). Blake's tensor:
    Blake, Proc. Camb. Phil. Soc. 70, 303 (1971).
*/
#include "planePanels.h"

#include <math.h>
#include <string.h>

void plane_green(const double x[3], const double y[3], double g[3][3])
{
    const double h = y[2];
    const double r[3] = {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
    const double m[3] = {r[0], r[1], x[2] + y[2]}; /* from the image */
    const double across2 = r[0] * r[0] + r[1] * r[1];
    const double per_r = 1 / sqrt(across2 + r[2] * r[2]);
    const double per_m = 1 / sqrt(across2 + m[2] * m[2]);
    const double r3 = per_r * per_r * per_r, m2 = per_m * per_m;
    const double m3 = per_m * m2;

    for (int j = 0; j < 3; j++)
    {
        const double image = 2 * h * (j < 2 ? 1 : -1) * m3;

        for (int i = 0; i < 3; i++)
        {
            const double same = i == j;
            const double dipole = h * (same - 3 * m[i] * m[j] * m2);
            const double doublet = same * m[2] + m[i] * (j == 2)
                                 - (i == 2) * m[j]
                                 - 3 * m[i] * m[2] * m[j] * m2;

            g[i][j] = same * (per_r - per_m) + r[i] * r[j] * r3
                    - m[i] * m[j] * m3 + image * (dipole - doublet);
        }
    }
}

/* Gauss-Legendre on [0, 1]. */
static void set_gauss(int n, double *at, double *weight)
{
    for (int k = 0; k < n; k++)
    {
        double z = cos(pi * (k + 0.75) / (n + 0.5)), slope = 1;

        for (int step = 0; step < 20; step++)
        {
            double before = 1, now = z;

            for (int l = 2; l <= n; l++)
            {
                const double next =
                    ((2 * l - 1) * z * now - (l - 1) * before) / l;

                before = now;
                now = next;
            }
            slope = n * (z * now - before) / (z * z - 1);
            z -= now / slope;
        }
        at[k] = 0.5 * (1 - z);
        weight[k] = 1 / ((1 - z * z) * slope * slope);
    }
}

double plane_place(const solver *v, double s, double phi, double x[3])
{
    const double psi = v->width * sinh(v->stretch * s);
    const double along = cos(psi), across = sin(psi);
    const double first = across * cos(phi), second = across * sin(phi);

    for (int i = 0; i < 3; i++)
    {
        x[i] = v->centre[i] + first * v->axes[0][i] + second * v->axes[1][i]
             + along * v->axes[2][i];
    }
    if (v->mirrored)
    {
        x[1] = -x[1];
    }
    return across * v->width * v->stretch * cosh(v->stretch * s);
}

/* The values of Lagrange's polynomials at t in [0, 1]. */
static void lagrange(const solver *v, double t, double value[MAX_NODES])
{
    double sum = 0;

    for (int k = 0; k < v->mesh.nodes; k++)
    {
        const double d = t - v->gauss[k];

        value[k] = v->barycentric[k] / (d == 0 ? 1e-300 : d);
        sum += value[k];
    }
    for (int k = 0; k < v->mesh.nodes; k++)
    {
        value[k] /= sum;
    }
}

/* Adds what a point of the panel, with its weight, does to its sums; ls, lphi:
   the polynomials there. */
static void add_point(solver *v, double s, double phi, double weight,
                      const double ls[MAX_NODES], const double lphi[MAX_NODES])
{
    const int n = v->mesh.nodes;
    double x[3], g[3][3];

    weight *= plane_place(v, s, phi, x);
    plane_green(v->target, x, g);
    for (int k = 0; k < n; k++)
    {
        for (int l = 0; l < n; l++)
        {
            const double factor = weight * ls[k] * lphi[l];
            double *sum = &v->sum[k * n + l][0][0];

            for (int i = 0; i < 9; i++)
            {
                sum[i] += factor * (&g[0][0])[i];
            }
        }
    }
}

static void difference(const double a[3], const double b[3], double d[3])
{
    for (int i = 0; i < 3; i++)
    {
        d[i] = a[i] - b[i];
    }
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The sides of a piece, as vectors through its middle. */
static void measure(const solver *v, piece q, double along[3], double across[3])
{
    const double s = 0.5 * (q.s0 + q.s1), phi = 0.5 * (q.phi0 + q.phi1);
    double from[3], to[3];

    plane_place(v, q.s0, phi, from);
    plane_place(v, q.s1, phi, to);
    difference(to, from, along);
    plane_place(v, s, q.phi0, from);
    plane_place(v, s, q.phi1, to);
    difference(to, from, across);
}

/* A piece that does not hold the target. Its sides may be almost parallel where
   the body is slim: the diagonals count, too. */
static void add_piece(solver *v, piece q)
{
    const double s = 0.5 * (q.s0 + q.s1), phi = 0.5 * (q.phi0 + q.phi1);
    const int n = v->mesh.points;
    double middle[3], along[3], across[3], way[3], a, b;

    measure(v, q, along, across);
    plane_place(v, s, phi, middle);
    difference(middle, v->target, way);
    a = dot(along, along);
    b = dot(across, across);
    if (fmax(fmax(a, b), 0.5 * (a + b) + fabs(dot(along, across)))
        > dot(way, way))
    {
        const piece first = {q.s0, a > b ? s : q.s1, q.phi0,
                             a > b ? q.phi1 : phi};
        const piece second = {a > b ? s : q.s0, q.s1, a > b ? q.phi0 : phi,
                              q.phi1};

        add_piece(v, first);
        add_piece(v, second);
        return;
    }

    double lphi[MAX_NODES][MAX_NODES], at[MAX_NODES];

    for (int l = 0; l < n; l++)
    {
        at[l] = q.phi0 + (q.phi1 - q.phi0) * v->point[l];
        lagrange(v, (at[l] - v->panel.phi0) / (v->panel.phi1 - v->panel.phi0),
                 lphi[l]);
    }
    for (int k = 0; k < n; k++)
    {
        const double here = q.s0 + (q.s1 - q.s0) * v->point[k];
        double ls[MAX_NODES];

        lagrange(v, (here - v->panel.s0) / (v->panel.s1 - v->panel.s0), ls);
        for (int l = 0; l < n; l++)
        {
            add_point(v, here, at[l],
                      (q.s1 - q.s0) * (q.phi1 - q.phi0) * v->part[k]
                          * v->part[l],
                      ls, lphi[l]);
        }
    }
}

/* One half of a piece at the target: the triangle of its corner there and the
   side across from it, that over phi or, if turned, over s. With the sides a and
   b, the distance of the point t of that side is |a + b t|, which may be small
   in between: t = nearest + away sinh(w). */
static void add_triangle(solver *v, piece q, const double a[3],
                         const double b[3], int turned)
{
    const double bb = dot(b, b), nearest = -dot(a, b) / bb;
    const double away = sqrt(fmax(dot(a, a) / bb - nearest * nearest, 1e-12));
    const double from = asinh(-nearest / away);
    const double to = asinh((1 - nearest) / away);
    const double area = fabs((q.s1 - q.s0) * (q.phi1 - q.phi0));
    const int n = v->mesh.points;

    for (int l = 0; l < n; l++)
    {
        const double w = from + (to - from) * v->point[l];
        const double t = nearest + away * sinh(w);

        for (int k = 0; k < n; k++)
        {
            const double far = v->point[k], beside = far * t;
            const double weight = area * far * v->part[k] * v->part[l]
                                * (to - from) * away * cosh(w);
            const double s = q.s0 + (q.s1 - q.s0) * (turned ? beside : far);
            const double phi =
                q.phi0 + (q.phi1 - q.phi0) * (turned ? far : beside);
            double ls[MAX_NODES], lphi[MAX_NODES];

            lagrange(v, (s - v->panel.s0) / (v->panel.s1 - v->panel.s0), ls);
            lagrange(v, (phi - v->panel.phi0) / (v->panel.phi1 - v->panel.phi0),
                     lphi);
            add_point(v, s, phi, weight, ls, lphi);
        }
    }
}

/* A piece with the target at its corner (s0, phi0), from which it extends to
   (s1, phi1), on either side. It is to be no longer than the image is far. */
static void add_corner(solver *v, piece q)
{
    double along[3], across[3], a, b, most;

    measure(v, q, along, across);
    a = sqrt(dot(along, along));
    b = sqrt(dot(across, across));
    most = fmin(1.5 * fmin(a, b), 2 * v->target[2]);
    if (fmax(a, b) > most)
    {
        const double s = a > b ? 0.5 * (q.s0 + q.s1) : q.s0;
        const double phi = a > b ? q.phi0 : 0.5 * (q.phi0 + q.phi1);
        const piece rest = {fmin(s, q.s1), fmax(s, q.s1), fmin(phi, q.phi1),
                            fmax(phi, q.phi1)};
        const piece own = {q.s0, a > b ? s : q.s1, q.phi0,
                           a > b ? q.phi1 : phi};

        add_piece(v, rest);
        add_corner(v, own);
        return;
    }
    add_triangle(v, q, along, across, 0);
    add_triangle(v, q, across, along, 1);
}

void plane_node_at(const solver *v, int ring, int sector, int k, int l,
                   double *s, double *phi)
{
    *s = (ring + v->gauss[k]) / v->mesh.rings;
    *phi = pi * (sector + v->gauss[l]) / v->mesh.sectors;
}

void plane_add_panel(solver *v, int row, int ring, int sector, int own,
                     double s, double phi)
{
    const int n = v->mesh.nodes, width = 3 * v->count;
    const int column = (ring * v->mesh.sectors + sector) * n * n;

    const piece all = {
        (double)ring / v->mesh.rings, (ring + 1.0) / v->mesh.rings,
        pi * sector / v->mesh.sectors, pi * (sector + 1.0) / v->mesh.sectors};

    v->panel = all;
    for (v->mirrored = 0; v->mirrored < 2; v->mirrored++)
    {
        memset(v->sum, 0, sizeof(v->sum));
        if (own && !v->mirrored)
        {
            for (int corner = 0; corner < 4; corner++)
            {
                const piece q = {s, corner < 2 ? all.s0 : all.s1, phi,
                                 corner % 2 ? all.phi0 : all.phi1};

                add_corner(v, q);
            }
        }
        else
        {
            add_piece(v, all);
        }
        for (int m = 0; m < n * n; m++)
        {
            for (int i = 0; i < 3; i++)
            {
                for (int j = 0; j < 3; j++)
                {
                    const int at = (3 * row + i) * width + 3 * (column + m) + j;
                    const double turned = v->mirrored && j == 1
                                            ? -v->sum[m][i][j]
                                            : v->sum[m][i][j];

                    v->matrix[0][at] += turned / (8 * pi);
                    v->matrix[1][at] +=
                        (v->mirrored ? -turned : turned) / (8 * pi);
                }
            }
        }
    }
    v->mirrored = 0;
}

void plane_set_geometry(solver *v, const plane_case *c)
{
    const double d[3] = {sin(c->tilt), 0, cos(c->tilt)};
    const double support =
        sqrt(d[0] * d[0] + c->ratio * c->ratio * d[2] * d[2]);
    double pole[3], side[3];

    v->width = sqrt(2 * c->gap / support);
    v->stretch = asinh(pi / v->width);
    v->centre[0] = v->centre[1] = 0;
    v->centre[2] = support + c->gap;
    for (int i = 0; i < 3; i++)
    {
        pole[i] = -((i == 2) + (c->ratio - 1) * d[2] * d[i]) / support;
    }
    side[0] = pole[2]; /* y x pole */
    side[1] = 0;
    side[2] = -pole[0];
    for (int i = 0; i < 3; i++)
    {
        const double more = c->ratio - 1;

        v->axes[0][i] =
            side[i] + more * d[i] * (d[0] * side[0] + d[2] * side[2]);
        v->axes[1][i] = i == 1;
        v->axes[2][i] =
            pole[i] + more * d[i] * (d[0] * pole[0] + d[2] * pole[2]);
    }
    set_gauss(v->mesh.nodes, v->gauss, v->weight);
    set_gauss(v->mesh.points, v->point, v->part);
    for (int k = 0; k < v->mesh.nodes; k++)
    {
        v->barycentric[k] = 1;
        for (int l = 0; l < v->mesh.nodes; l++)
        {
            v->barycentric[k] /= l == k ? 1 : v->gauss[k] - v->gauss[l];
        }
    }
}
