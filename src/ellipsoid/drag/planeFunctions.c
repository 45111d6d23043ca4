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

/* The functions of the table. */
static void set_functions(const ellipsoid_plane_table *own, double nu,
                          double gap, int slopes, ellipsoid_plane_values *v)
{
    const double b = own->ratio, more = b * b - 1, pp = 1 + more * nu * nu;
    const double p = sqrt(pp), p_nu = more * nu / p;
    const double h = p + gap, close = p / h;
    const int sphere = fabs(more) < 1e-9;
    const double w = sphere ? nu * nu : log1p(more * nu * nu) / log1p(more);
    const double w_nu = 2 * nu * (sphere ? 1 : more / (pp * log1p(more)));
    const double depth = ELLIPSOID_PLANE_DEPTH;
    const double x = log(h / gap), beyond = fmax(x - depth, 0);
    const double x_gap = 1 / h - 1 / gap, x_nu = p_nu / h;
    const double close_nu = p_nu * gap / (h * h), close_gap = -p / (h * h);
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
    ellipsoid_plane_scales(b, own->free, p, scale, scale_p);
    for (int n = 0; n < FUNCTIONS; n++)
    {
        v->f[n] = scale[n] * close * sum[0][n];
    }
    for (int n = 0; slopes && n < FUNCTIONS; n++)
    {
        const double of_p = scale_p[n] * p_nu * close + scale[n] * close_nu;

        v->by_nu[n] = of_p * sum[0][n]
                    + scale[n] * close * (w_nu * sum[1][n] + x_nu * sum[2][n]);
        v->by_gap[n] =
            scale[n] * (close_gap * sum[0][n] + close * x_gap * sum[2][n]);
    }
}

/* 12 pi S^3/tau = 12 pi b^3/(p^3 (b^2 + p^2)) */
static void set_squeezing(double b, double nu, double gap,
                          ellipsoid_plane_values *v)
{
    const double more = b * b - 1, pp = 1 + more * nu * nu, p = sqrt(pp);
    const double p_nu = more * nu / p, h = p + gap, close = p / h;
    const double close_nu = p_nu * gap / (h * h), close_gap = -p / (h * h);

    v->squeeze[0] = ellipsoid_squeeze(b, p) * close * close * close / gap;
    v->squeeze[1] =
        v->squeeze[0]
        * (-p_nu * (3 / p + 2 * p / (b * b + pp)) + 3 * close_nu / close);
    v->squeeze[2] = v->squeeze[0] * (3 * close_gap / close - 1 / gap);
    v->arm[0] = -more * nu / p;
    v->arm[1] = -more / (pp * p);
    v->arm[2] = 0;
}

/* Force and torque of the tabulated part, of functions f; k: the axis, of which
   t is not read. e x v has the components -v_j along i and v_i along j. */
static void apply_functions(int k, const double *f, double nu,
                            const double t[3], const double rates[6],
                            const double shear[3], double action[6])
{
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const double *u = rates, *w = rates + 3, *y = shear;
    const double tu = t[i] * u[i] + t[j] * u[j], tw = t[i] * w[i] + t[j] * w[j];
    const double cu = t[i] * u[j] - t[j] * u[i]; /* (e x t).u */
    const double cw = t[i] * w[j] - t[j] * w[i];
    const double turn = t[i] * y[j] - t[j] * y[i]; /* e.(n x gamma) */
    const double ye = y[k];

    action[i] = f[0] * u[i] + f[1] * t[i] * tu + nu * f[3] * t[i] * u[k]
              - nu * f[9] * w[j] + nu * f[10] * t[i] * cw - f[11] * t[j] * w[k]
              + f[12] * y[i] + nu * f[14] * t[i] * ye;
    action[j] = f[0] * u[j] + f[1] * t[j] * tu + nu * f[3] * t[j] * u[k]
              + nu * f[9] * w[i] + nu * f[10] * t[j] * cw + f[11] * t[i] * w[k]
              + f[12] * y[j] + nu * f[14] * t[j] * ye;
    action[k] = f[2] * u[k] + nu * f[3] * tu + f[8] * cw + (f[12] + f[13]) * ye;
    action[3 + i] = f[4] * w[i] + f[5] * t[i] * tw + nu * f[7] * t[i] * w[k]
                  - f[8] * t[j] * u[k] + nu * f[9] * u[j]
                  - nu * f[10] * t[j] * tu + f[15] * (t[j] * ye - nu * y[j])
                  - f[17] * t[j] * ye;
    action[3 + j] = f[4] * w[j] + f[5] * t[j] * tw + nu * f[7] * t[j] * w[k]
                  + f[8] * t[i] * u[k] - nu * f[9] * u[i]
                  + nu * f[10] * t[i] * tu + f[15] * (nu * y[i] - t[i] * ye)
                  + f[17] * t[i] * ye;
    action[3 + k] = f[6] * w[k] + nu * f[7] * tw + f[11] * cu + f[16] * turn;
}

/* How the same changes with nu, with the functions kept, and with t. */
static void normal_slopes(int k, const double *f, double nu, const double t[3],
                          const double rates[6], const double shear[3],
                          double by[3][6])
{
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const double *u = rates, *w = rates + 3, *y = shear;
    const double tu = t[i] * u[i] + t[j] * u[j], tw = t[i] * w[i] + t[j] * w[j];
    const double cw = t[i] * w[j] - t[j] * w[i], ye = y[k];
    const double along = f[3] * u[k] + f[10] * cw + f[14] * ye;
    double *by_nu = by[k];

    by_nu[i] = along * t[i] - f[9] * w[j];
    by_nu[j] = along * t[j] + f[9] * w[i];
    by_nu[k] = f[3] * tu;
    by_nu[3 + i] =
        f[7] * t[i] * w[k] + f[9] * u[j] - f[10] * t[j] * tu - f[15] * y[j];
    by_nu[3 + j] =
        f[7] * t[j] * w[k] - f[9] * u[i] + f[10] * t[i] * tu + f[15] * y[i];
    by_nu[3 + k] = f[7] * tw;
    for (int turn = 0; turn < 2; turn++)
    {
        /* once round e, i is j and j is -i: what turns changes its sign */
        const int a = turn ? j : i, b = turn ? i : j;
        const double s = turn ? -1 : 1;
        double *by_t = by[a];

        by_t[a] =
            f[1] * (tu + t[a] * u[a]) + nu * (along + s * f[10] * t[a] * w[b]);
        by_t[b] =
            f[1] * t[b] * u[a] + s * (nu * f[10] * t[b] * w[b] + f[11] * w[k]);
        by_t[k] = nu * f[3] * u[a] + s * f[8] * w[b];
        by_t[3 + a] = f[5] * (tw + t[a] * w[a]) + nu * f[7] * w[k]
                    - s * nu * f[10] * t[b] * u[a];
        by_t[3 + b] = f[5] * t[b] * w[a]
                    + s
                          * (f[8] * u[k] + nu * f[10] * (tu + t[a] * u[a])
                             + (f[17] - f[15]) * ye);
        by_t[3 + k] = nu * f[7] * w[a] + s * (f[11] * u[b] + f[16] * y[b]);
    }
}

void ellipsoid_plane_effect_set(const ellipsoid_plane_table *own,
                                const double normal[3], const double gap[2],
                                int slopes, ellipsoid_plane_effect *e)
{
    const double nu = normal[own->axis], per = 1 / own->radius;

    e->own = own;
    ellipsoid_copy(normal, e->normal);
    set_functions(own, nu, gap[ELLIPSOID_PLANE_FAR] * per, slopes, &e->values);
    set_squeezing(own->ratio, nu, gap[ELLIPSOID_PLANE_NEAR] * per, &e->values);
}

/* The parts of the wrench in the units of force and torque. */
static void add_scaled(const double part[6], double factor, double radius,
                       double action[6])
{
    for (int i = 0; i < 3; i++)
    {
        action[i] += factor * part[i];
        action[i + 3] += factor * radius * part[i + 3];
    }
}

void ellipsoid_plane_action(const ellipsoid_plane_effect *e,
                            const double rates[6], const double velocity[6],
                            const double shear[3], double action[2][6],
                            double change[4][2][6])
{
    const ellipsoid_plane_values *v = &e->values;
    const double a = e->own->radius, *n = e->normal;
    const int k = e->own->axis, i = (k + 1) % 3, j = (k + 2) % 3;
    const double nu = n[k], *u = velocity;
    const double scaled[6] = {rates[0],     rates[1],     rates[2],
                              a * rates[3], a * rates[4], a * rates[5]};
    const double sheared[3] = {a * shear[0], a * shear[1], a * shear[2]};
    const double w[3] = {a * u[3], a * u[4], a * u[5]};
    const double out[6] = {n[0], n[1], n[2]};
    /* (c x n).w over the arm; of the nearest point, towards the wall */
    const double spin = n[i] * w[j] - n[j] * w[i];
    const double approach = -ellipsoid_dot(n, u) - v->arm[0] * spin;
    double part[6], crossed[6] = {0}, by_normal[3][6];

    memset(action, 0, 2 * sizeof(*action));
    apply_functions(k, v->f, nu, n, scaled, sheared, part);
    add_scaled(part, a, a, action[0]);
    crossed[3 + i] = -n[j];
    crossed[3 + j] = n[i];
    for (int m = 0; m < 6; m++)
    {
        part[m] = v->squeeze[0] * approach * (out[m] + v->arm[0] * crossed[m]);
    }
    add_scaled(part, a, a, action[1]);
    if (!change)
    {
        return;
    }
    memset(change, 0, 4 * sizeof(*change));
    normal_slopes(k, v->f, nu, n, scaled, sheared, by_normal);
    for (int by = 0; by < 4; by++)
    {
        const int to = by == k ? 1 : by == 3 ? 2 : 0; /* nu, gap or t */
        const double per = by == 3 ? 1 : a;
        double of_approach =
            (to ? -v->arm[to] * spin : 0) - (by < 3 ? u[by] : 0);
        double turned[6] = {0};

        if (to)
        {
            apply_functions(k, to == 1 ? v->by_nu : v->by_gap, nu, n, scaled,
                            sheared, part);
            add_scaled(part, per, a, change[by][0]);
        }
        if (by < 3)
        {
            add_scaled(by_normal[by], a, a, change[by][0]);
        }
        if (by == i)
        {
            of_approach -= v->arm[0] * w[j];
            turned[3 + j] = 1;
        }
        if (by == j)
        {
            of_approach += v->arm[0] * w[i];
            turned[3 + i] = -1;
        }
        for (int m = 0; m < 6; m++)
        {
            const double row = out[m] + v->arm[0] * crossed[m];
            const double of_row = (by < 3 && by == m) + v->arm[0] * turned[m]
                                + (to ? v->arm[to] * crossed[m] : 0);

            part[m] = v->squeeze[0] * (of_approach * row + approach * of_row)
                    + (to ? v->squeeze[to] * approach * row : 0);
        }
        add_scaled(part, per, a, change[by][1]);
    }
}

/* Adds a symmetric pair of elements. */
static void add_pair(double matrix[6][6], int row, int column, double value)
{
    matrix[row][column] += value;
    matrix[column][row] += value;
}

void ellipsoid_plane_add_matrices(const ellipsoid_plane_effect *e,
                                  const double factor[2], double slip[6][6],
                                  double squeeze[6][6])
{
    const double *f = e->values.f, *t = e->normal, a = e->own->radius;
    const int k = e->own->axis, i = (k + 1) % 3, j = (k + 2) % 3;
    const double nu = t[k], per[3] = {factor[ELLIPSOID_PLANE_FAR] * a,
                                      factor[ELLIPSOID_PLANE_FAR] * a * a,
                                      factor[ELLIPSOID_PLANE_FAR] * a * a * a};
    const double arm = a * e->values.arm[0];
    const double pressed =
        factor[ELLIPSOID_PLANE_NEAR] * a * e->values.squeeze[0];
    double row[6] = {t[0], t[1], t[2]};

    for (int r = 0; r < 2; r++)
    {
        const double *part = f + 4 * r, size = per[2 * r];
        double(*m)[6] = &slip[3 * r];
        const int at = 3 * r;

        m[i][at + i] += size * (part[0] + part[1] * t[i] * t[i]);
        m[j][at + j] += size * (part[0] + part[1] * t[j] * t[j]);
        m[k][at + k] += size * part[2];
        add_pair(slip, at + i, at + j, size * part[1] * t[i] * t[j]);
        add_pair(slip, at + i, at + k, size * nu * part[3] * t[i]);
        add_pair(slip, at + j, at + k, size * nu * part[3] * t[j]);
    }
    add_pair(slip, i, 3 + i, -per[1] * nu * f[10] * t[i] * t[j]);
    add_pair(slip, j, 3 + j, per[1] * nu * f[10] * t[i] * t[j]);
    add_pair(slip, i, 3 + j, per[1] * nu * (f[10] * t[i] * t[i] - f[9]));
    add_pair(slip, j, 3 + i, per[1] * nu * (f[9] - f[10] * t[j] * t[j]));
    add_pair(slip, i, 3 + k, -per[1] * f[11] * t[j]);
    add_pair(slip, j, 3 + k, per[1] * f[11] * t[i]);
    add_pair(slip, k, 3 + i, -per[1] * f[8] * t[j]);
    add_pair(slip, k, 3 + j, per[1] * f[8] * t[i]);

    row[3 + i] = -arm * t[j];
    row[3 + j] = arm * t[i];
    for (int m = 0; m < 6; m++)
    {
        for (int n = 0; n < 6; n++)
        {
            squeeze[m][n] += pressed * row[m] * row[n];
        }
    }
}

void ellipsoid_plane_shear_columns(const ellipsoid_plane_effect *e,
                                   double factor, double column[3][6])
{
    const double *f = e->values.f, *t = e->normal, a = e->own->radius;
    const int k = e->own->axis, i = (k + 1) % 3, j = (k + 2) % 3;
    const double nu = t[k], force = factor * a * a, torque = force * a;

    memset(column, 0, 3 * sizeof(*column));
    column[i][i] = column[j][j] = force * f[12];
    column[k][i] = force * nu * f[14] * t[i];
    column[k][j] = force * nu * f[14] * t[j];
    column[k][k] = force * (f[12] + f[13]);
    column[j][3 + i] = -torque * f[15] * nu;
    column[i][3 + j] = torque * f[15] * nu;
    column[k][3 + i] = torque * (f[15] - f[17]) * t[j];
    column[k][3 + j] = torque * (f[17] - f[15]) * t[i];
    column[j][3 + k] = torque * f[16] * t[i];
    column[i][3 + k] = -torque * f[16] * t[j];
}
