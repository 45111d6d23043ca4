/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    planeSolver.c - a rigid spheroid above a no-slip plane in Stokes flow.

    A single layer of forces with Blake's tensor (Blake, Proc. Camb. Phil. Soc.
    70, 303, 1971) gives the velocity of the surface; its density is the
    traction (Pozrikidis 1992, section 4.1). The surface is x = c + A n, n on the
    unit sphere, and the density is taken per solid angle of n, as that of a
    free ellipsoid is constant when it translates and linear in n when it turns.
    Polar coordinates of n about the point nearest to the plane, psi and phi:
    there the height of the surface is gap + p (1 - cos psi), so that the
    pressure of lubrication depends on psi and a few harmonics of phi. Panels are
    even in s, psi = width sinh(s), width = sqrt(2 gap/p). The plane y = 0 is one
    of symmetry: motions in it and across it make two systems of half the size.

    Collocation at Gauss nodes. Pieces of panels are halved until they are small
    against their distance; about the node itself the two triangles of a corner
    are mapped to squares, by which 1/r is smooth (Duffy 1982). A held body in a
    flow feels the integral of that flow times the tractions of its motions (the
    reciprocal theorem).
*/
#include "planeSolver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MAX_NODES 12 /* of a panel along a side */

static const double pi = 3.14159265358979323846;

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

/* A panel or a piece of it. */
typedef struct piece
{
    double s0, s1, phi0, phi1;
} piece;

/* Everything that one case needs. */
typedef struct solver
{
    plane_mesh mesh;
    double width, stretch;        /* psi = width sinh(stretch s), s to 1 */
    double centre[3], axes[3][3]; /* A times the directions of psi and phi */
    double gauss[MAX_NODES], weight[MAX_NODES], barycentric[MAX_NODES];
    double point[MAX_NODES], part[MAX_NODES]; /* of a piece, with its weight */
    int count;         /* nodes, each with three components */
    double *matrix[2]; /* in and across the plane of symmetry */
    double target[3];  /* where the row's velocity is */
    int mirrored;      /* is the piece on the other side? */
    piece panel;
    double sum[MAX_NODES * MAX_NODES][3][3]; /* over it, by node */
} solver;

/* The surface at (s, phi), and the solid angle over ds dphi. */
static double place(const solver *v, double s, double phi, double x[3])
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

    weight *= place(v, s, phi, x);
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

    place(v, q.s0, phi, from);
    place(v, q.s1, phi, to);
    difference(to, from, along);
    place(v, s, q.phi0, from);
    place(v, s, q.phi1, to);
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
    place(v, s, phi, middle);
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

/* The place of node k, l of a panel. */
static void node_at(const solver *v, int ring, int sector, int k, int l,
                    double *s, double *phi)
{
    *s = (ring + v->gauss[k]) / v->mesh.rings;
    *phi = pi * (sector + v->gauss[l]) / v->mesh.sectors;
}

/* The columns of one panel in the rows of one node; own: is it of the panel? */
static void add_panel(solver *v, int row, int ring, int sector, int own,
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

/* The surface's velocity by motion m of those in (0) or across (1) the plane of
   symmetry, and the shear flow as the fourth. */
static void velocity(const solver *v, int part, int m, const double x[3],
                     double u[3])
{
    const double r[3] = {x[0] - v->centre[0], x[1] - v->centre[1],
                         x[2] - v->centre[2]};

    u[0] = u[1] = u[2] = 0;
    if (m == 3)
    {
        u[part] = r[2];
    }
    else if (part == 0)
    {
        u[0] = m == 0 ? 1 : m == 2 ? r[2] : 0;
        u[2] = m == 1 ? 1 : m == 2 ? -r[0] : 0;
    }
    else
    {
        u[0] = m == 2 ? -r[1] : 0;
        u[1] = m == 0 ? 1 : m == 1 ? -r[2] : r[0];
        u[2] = m == 1 ? r[1] : 0;
    }
}

/* Gauss's elimination with pivots, four columns at a time, of `rights` right
   sides in rows; 0 if singular. */
static int eliminate(double *a, int n, double (*right)[3])
{
    for (int k = 0; k < n; k++)
    {
        int best = k;

        for (int i = k + 1; i < n; i++)
        {
            best = fabs(a[i * n + k]) > fabs(a[best * n + k]) ? i : best;
        }
        if (!isnormal(a[best * n + k]))
        {
            return 0;
        }
        for (int j = 0; best != k && j < n; j++)
        {
            const double kept = a[k * n + j];

            a[k * n + j] = a[best * n + j];
            a[best * n + j] = kept;
        }
        for (int j = 0; best != k && j < 3; j++)
        {
            const double kept = right[k][j];

            right[k][j] = right[best][j];
            right[best][j] = kept;
        }
        /* the columns of a block now, those beyond it once it is complete */
        const int first = k / 32 * 32, last = first + 32 < n ? first + 32 : n;

        for (int i = k + 1; i < n; i++)
        {
            const double factor = a[i * n + k] /= a[k * n + k];

            for (int j = k + 1; j < last; j++)
            {
                a[i * n + j] -= factor * a[k * n + j];
            }
            for (int j = 0; j < 3; j++)
            {
                right[i][j] -= factor * right[k][j];
            }
        }
        if (k + 1 < last)
        {
            continue;
        }
        for (int i = first + 1; i < n; i++)
        {
            const int most = i < last ? i : last;
            double *row = &a[i * n];
            int m = first;

            for (; m + 4 <= most; m += 4)
            {
                const double *r = &a[m * n];
                const double f[4] = {row[m], row[m + 1], row[m + 2],
                                     row[m + 3]};

                for (int j = last; j < n; j++)
                {
                    row[j] -= f[0] * r[j] + f[1] * r[j + n]
                            + f[2] * r[j + 2 * n] + f[3] * r[j + 3 * n];
                }
            }
            for (; m < most; m++)
            {
                for (int j = last; j < n; j++)
                {
                    row[j] -= row[m] * a[m * n + j];
                }
            }
        }
    }
    for (int k = n - 1; k >= 0; k--)
    {
        for (int j = 0; j < 3; j++)
        {
            for (int i = k + 1; i < n; i++)
            {
                right[k][j] -= a[k * n + i] * right[i][j];
            }
            right[k][j] /= a[k * n + k];
        }
    }
    return 1;
}

static void set_geometry(solver *v, const plane_case *c)
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

/* Calls for each node of half the surface: its number and place. */
#define FOR_EACH_NODE(v)                                                       \
    for (int row = 0, n_ = (v)->mesh.nodes; row < (v)->count; row++)           \
        for (int panel = row / (n_ * n_), ring = panel / (v)->mesh.sectors,    \
                 sector = panel % (v)->mesh.sectors, k = row / n_ % n_,        \
                 l = row % n_, once = 1;                                       \
             once; once = 0)

static int solve_part(const solver *v, int part, plane_functions *result)
{
    double(*block)[3] = part ? result->across : result->in;
    double *shear = part ? result->shear_across : result->shear_in;
    double(*right)[3] = malloc(3 * (size_t)v->count * sizeof(*right));
    double sum[4][3] = {{0}};
    int regular;

    if (!right)
    {
        return 0;
    }
    FOR_EACH_NODE(v)
    {
        double s, phi, x[3];

        node_at(v, ring, sector, k, l, &s, &phi);
        place(v, s, phi, x);
        for (int m = 0; m < 3; m++)
        {
            double u[3];

            velocity(v, part, m, x, u);
            for (int i = 0; i < 3; i++)
            {
                right[3 * row + i][m] = u[i];
            }
        }
    }
    regular = eliminate(v->matrix[part], 3 * v->count, right);
    FOR_EACH_NODE(v)
    {
        double s, phi, x[3], weight;

        node_at(v, ring, sector, k, l, &s, &phi);
        weight = 2 * place(v, s, phi, x) * v->weight[k] * v->weight[l] * pi
               / (v->mesh.rings * v->mesh.sectors);
        for (int m = 0; m < 4; m++)
        {
            double u[3];

            velocity(v, part, m, x, u);
            for (int j = 0; j < 3; j++)
            {
                for (int i = 0; i < 3; i++)
                {
                    sum[m][j] += weight * u[i] * right[3 * row + i][j];
                }
            }
        }
    }
    free(right);
    for (int i = 0; i < 3; i++)
    {
        shear[i] = sum[3][i];
        for (int j = 0; j < 3; j++)
        {
            block[i][j] = 0.5 * (sum[i][j] + sum[j][i]);
            result->asymmetry =
                fmax(result->asymmetry,
                     fabs(sum[i][j] - sum[j][i]) / sqrt(sum[i][i] * sum[j][j]));
        }
    }
    return regular;
}

int plane_solve(const plane_case *c, const plane_mesh *mesh,
                plane_functions *result)
{
    solver v = {.mesh = *mesh};
    size_t size;
    int done = 0;

    set_geometry(&v, c);
    v.count = mesh->rings * mesh->sectors * mesh->nodes * mesh->nodes;
    size = 9 * (size_t)v.count * (size_t)v.count;
    v.matrix[0] = calloc(size, sizeof(double));
    v.matrix[1] = calloc(size, sizeof(double));
    if (v.matrix[0] && v.matrix[1])
    {
        FOR_EACH_NODE(&v)
        {
            double s, phi;

            node_at(&v, ring, sector, k, l, &s, &phi);
            place(&v, s, phi, v.target);
            for (int p = 0; p < mesh->rings * mesh->sectors; p++)
            {
                add_panel(&v, row, p / mesh->sectors, p % mesh->sectors,
                          p == panel, s, phi);
            }
        }
        result->asymmetry = 0;
        done = solve_part(&v, 0, result) && solve_part(&v, 1, result);
    }
    free(v.matrix[0]);
    free(v.matrix[1]);
    return done;
}
