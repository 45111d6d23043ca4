/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    planeFunctions.c - what one plane does to a spheroid, from a table.

    With e the body's axis, n the plane's normal, nu = n.e, t = n - nu e, lengths
    a across e and b along it, and the gap g, a plane adds to the resistance over
    mu
        K: f0 (I - e e) + f1 t t + f2 e e + nu f3 (e t + t e),
        C: the same with f4 to f7, force by turning:
        B: f8 e (e x t) + nu f9 [e x] + nu f10 t (e x t) + f11 (e x t) e
    and q o o, o = (n, c x n) with the nearest point c: squeezing, q = 12 pi
    S^3/(tau g) (p/h)^3, p = sqrt(a^2 + (b^2 - a^2) nu^2), h = p + g. It resists
    motion relative to the wall, whatever the flow would do with a free body: in
    the gap the flow along n is of the second order in g. On a body that moves as
    a free one far from walls would in the flow (z - z of the centre) gamma,
    gamma.n = 0, acts besides
        F: f12 gamma + (gamma.e) (f13 e + nu f14 t),
        T: f15 (n x gamma) + (f16 - f15) e e.(n x gamma)
           + f17 (gamma.e) e x n.

    The f are even in nu and were computed by boundary elements
    (tools/planeTable). Over p/h and their sizes (body/planeTable.c) they are
    polynomials in x = ln(h/g), w = ln(p/a)/ln(b/a) and the logarithm of b/a: x is
    of the order of the distance's inverse far away, and near by lubrication is
    linear in it; beyond the table it goes on so.
*/
#include "body/planeTable.h"
#include "drag/drag.h"

enum
{
    TILTS = ELLIPSOID_PLANE_TILTS,
    GAPS = ELLIPSOID_PLANE_GAPS,
    FUNCTIONS = ELLIPSOID_PLANE_FUNCTIONS
};

/* p/h over the equatorial radius, and how p and p/h change with nu and gap. */
typedef struct heights
{
    double p, h, p_nu, close, close_nu, close_gap;
} heights;

static heights set_heights(double b, double nu, double gap)
{
    const double more = b * b - 1, p = sqrt(1 + more * nu * nu), h = p + gap;
    const double p_nu = more * nu / p;

    return (heights){.p = p,
                     .h = h,
                     .p_nu = p_nu,
                     .close = p / h,
                     .close_nu = p_nu * gap / (h * h),
                     .close_gap = -p / (h * h)};
}

/* The functions of the table. */
static void set_functions(const ellipsoid_plane_table *own, double nu,
                          double gap, int slopes, ellipsoid_plane_values *v)
{
    const double b = own->ratio, more = b * b - 1;
    const heights at = set_heights(b, nu, gap);
    const int sphere = fabs(more) < 1e-9;
    const double w = sphere ? nu * nu : log1p(more * nu * nu) / log1p(more);
    const double w_nu =
        2 * nu * (sphere ? 1 : more / (at.p * at.p * log1p(more)));
    const double depth = ELLIPSOID_PLANE_DEPTH;
    const double x = log(at.h / gap), beyond = fmax(x - depth, 0);
    const double x_gap = 1 / at.h - 1 / gap, x_nu = at.p_nu / at.h;
    double in_x[GAPS], slope_x[GAPS], in_w[TILTS], slope_w[TILTS];
    double sum[3][FUNCTIONS] = {{0}}; /* value, by w, by x */
    double scale[FUNCTIONS], scale_p[FUNCTIONS];

    ellipsoid_chebyshev(fmin(x, depth) / depth, GAPS, in_x, slope_x);
    ellipsoid_chebyshev(w, TILTS, in_w, slopes ? slope_w : NULL);
    for (int k = 0; k < GAPS; k++)
    {
        slope_x[k] /= depth;
        in_x[k] += beyond * slope_x[k];
    }
    for (int j = 0; j < TILTS; j++)
    {
        double value[FUNCTIONS] = {0};

        for (int k = 0; k < GAPS; k++)
        {
            for (int n = 0; n < FUNCTIONS; n++)
            {
                value[n] += in_x[k] * own->at[j][k][n];
            }
        }
        for (int n = 0; n < FUNCTIONS; n++)
        {
            sum[0][n] += in_w[j] * value[n];
        }
        for (int n = 0; slopes && n < FUNCTIONS; n++)
        {
            sum[1][n] += slope_w[j] * value[n];
        }
        for (int k = 1; slopes && k < GAPS; k++)
        {
            for (int n = 0; n < FUNCTIONS; n++)
            {
                sum[2][n] += in_w[j] * slope_x[k] * own->at[j][k][n];
            }
        }
    }
    ellipsoid_plane_scales(b, own->free, at.p, scale, scale_p);
    for (int n = 0; n < FUNCTIONS; n++)
    {
        v->f[n] = scale[n] * at.close * sum[0][n];
    }
    for (int n = 0; slopes && n < FUNCTIONS; n++)
    {
        const double of_p =
            scale_p[n] * at.p_nu * at.close + scale[n] * at.close_nu;

        v->by_nu[n] =
            of_p * sum[0][n]
            + scale[n] * at.close * (w_nu * sum[1][n] + x_nu * sum[2][n]);
        v->by_gap[n] =
            scale[n]
            * (at.close_gap * sum[0][n] + at.close * x_gap * sum[2][n]);
    }
}

/* 12 pi S^3/tau = 12 pi b^3/(p^3 (b^2 + p^2)) */
static void set_squeezing(double b, double nu, double gap,
                          ellipsoid_plane_values *v)
{
    const double more = b * b - 1;
    const heights at = set_heights(b, nu, gap);
    const double p = at.p, per_close = 3 / at.close;

    v->squeeze[0] =
        ellipsoid_squeeze(b, p) * at.close * at.close * at.close / gap;
    v->squeeze[1] = v->squeeze[0]
                  * (-at.p_nu * (3 / p + 2 * p / (b * b + p * p))
                     + per_close * at.close_nu);
    v->squeeze[2] = v->squeeze[0] * (per_close * at.close_gap - 1 / gap);
    v->arm[0] = -at.p_nu;
    v->arm[1] = -more / (p * p * p);
}

/* Two elements of the symmetric part. */
static inline void set_pair(double column[9][6], int m, int n, double value)
{
    column[m][n] = column[n][m] = value;
}

/* Force and torque of the tabulated part, with functions f, by each of the
   motion's components and the shear's; of linear order in nu, of the second in t. */
static void set_columns(const ellipsoid_plane_table *own, const double *f,
                        const double normal[3], double column[9][6])
{
    const int k = own->axis, i = (k + 1) % 3, j = (k + 2) % 3;
    const double nu = normal[k], x = normal[i], y = normal[j];

    memset(column, 0, 9 * sizeof(*column));
    for (int at = 0; at < 6; at += 3)
    {
        const double *part = at == 0 ? f : f + 4;

        column[at + i][at + i] = part[0] + part[1] * x * x;
        column[at + j][at + j] = part[0] + part[1] * y * y;
        column[at + k][at + k] = part[2];
        set_pair(column, at + i, at + j, part[1] * x * y);
        set_pair(column, at + i, at + k, nu * part[3] * x);
        set_pair(column, at + j, at + k, nu * part[3] * y);
    }
    set_pair(column, i, 3 + i, -nu * f[10] * x * y);
    set_pair(column, j, 3 + j, nu * f[10] * x * y);
    set_pair(column, i, 3 + j, nu * (f[10] * x * x - f[9]));
    set_pair(column, j, 3 + i, nu * (f[9] - f[10] * y * y));
    set_pair(column, i, 3 + k, -f[11] * y);
    set_pair(column, j, 3 + k, f[11] * x);
    set_pair(column, k, 3 + i, -f[8] * y);
    set_pair(column, k, 3 + j, f[8] * x);
    column[6 + i][i] = column[6 + j][j] = f[12];
    column[6 + k][i] = nu * f[14] * x;
    column[6 + k][j] = nu * f[14] * y;
    column[6 + k][k] = f[12] + f[13];
    column[6 + j][3 + i] = -f[15] * nu;
    column[6 + i][3 + j] = f[15] * nu;
    column[6 + k][3 + i] = (f[15] - f[17]) * y;
    column[6 + k][3 + j] = (f[17] - f[15]) * x;
    column[6 + j][3 + k] = f[16] * x;
    column[6 + i][3 + k] = -f[16] * y;
}

/* (n, c x n), c the nearest point. */
static void set_row(const ellipsoid_plane_table *own, double arm,
                    const double normal[3], double row[6])
{
    const int k = own->axis, i = (k + 1) % 3, j = (k + 2) % 3;

    ellipsoid_copy(normal, row);
    row[3 + i] = -own->radius * arm * normal[j];
    row[3 + j] = own->radius * arm * normal[i];
    row[3 + k] = 0;
}

void ellipsoid_plane_effect_set(const ellipsoid_plane_table *own,
                                const double normal[3], const double gap[2],
                                int slopes, ellipsoid_plane_effect *e)
{
    const double nu = normal[own->axis], a = own->radius;
    const double size[3] = {1, a, a}; /* by length, radii times 1/s */

    e->own = own;
    ellipsoid_copy(normal, e->normal);
    set_functions(own, nu, gap[ELLIPSOID_PLANE_FAR] / a, slopes, &e->values);
    set_squeezing(own->ratio, nu, gap[ELLIPSOID_PLANE_NEAR] / a, &e->values);
    set_columns(own, e->values.f, normal, e->column);
    set_row(own, e->values.arm[0], normal, e->row);
    e->squeeze = a * e->values.squeeze[0];
    for (int n = 0; n < 9; n++)
    {
        for (int m = 0; m < 6; m++)
        {
            e->column[n][m] *= a * size[n / 3] * size[m / 3];
        }
    }
}

/* Adds what rates and shear do, times a factor. */
static void add_action(double column[9][6], const double rates[6],
                       const double shear[3], double factor, double action[6])
{
    for (int n = 0; n < 9; n++)
    {
        ellipsoid_add6(factor * (n < 6 ? rates[n] : shear[n - 6]), column[n],
                       action);
    }
}

static double dot6(const double a[6], const double b[6])
{
    return ellipsoid_dot(a, b) + ellipsoid_dot(a + 3, b + 3);
}

void ellipsoid_plane_action(ellipsoid_plane_effect *e, const double rates[6],
                            const double velocity[6], const double shear[3],
                            double action[2][6], double change[4][2][6])
{
    const ellipsoid_plane_values *v = &e->values;
    const ellipsoid_plane_table *own = e->own;
    const int k = own->axis;
    const double a = own->radius, along = dot6(e->row, velocity);
    const double turn[6] = {rates[0],     rates[1],     rates[2],
                            a * rates[3], a * rates[4], a * rates[5]};
    const double bent[3] = {a * shear[0], a * shear[1], a * shear[2]};
    double column[9][6], foot[6];

    memset(action, 0, 2 * sizeof(*action));
    add_action(e->column, rates, shear, 1, action[0]);
    ellipsoid_add6(-e->squeeze * along, e->row, action[1]);
    if (!change)
    {
        return;
    }
    memset(change, 0, 4 * sizeof(*change));
    set_columns(own, v->by_nu, e->normal, column);
    add_action(column, turn, bent, a, change[k][0]);
    set_columns(own, v->by_gap, e->normal, column);
    add_action(column, turn, bent, 1, change[3][0]);
    ellipsoid_add6(-v->squeeze[2] * along, e->row, change[3][1]);
    set_row(own, v->arm[1], e->normal, foot);
    for (int by = 0; by < 3; by++)
    {
        const double unit[3] = {by == 0, by == 1, by == 2};
        double turned[6];

        /* of so low an order that differences are derivatives */
        for (int side = -1; side <= 1; side += 2)
        {
            double normal[3] = {e->normal[0], e->normal[1], e->normal[2]};

            normal[by] += side;
            set_columns(own, v->f, normal, column);
            add_action(column, turn, bent, 0.5 * a * side, change[by][0]);
        }
        set_row(own, v->arm[0], unit, turned);
        if (by == k)
        {
            ellipsoid_add(turned + 3, foot + 3);
            ellipsoid_add6(-a * v->squeeze[1] * along, e->row, change[by][1]);
        }
        ellipsoid_add6(-e->squeeze * dot6(turned, velocity), e->row,
                       change[by][1]);
        ellipsoid_add6(-e->squeeze * along, turned, change[by][1]);
    }
    for (int by = 0; by < 4; by++)
    {
        for (int i = 3; i < 6; i++)
        {
            change[by][0][i] *= a;
        }
    }
}
