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
    FUNCTIONS = ELLIPSOID_PLANE_FUNCTIONS,
    FAR = ELLIPSOID_PLANE_FAR,
    NEAR = ELLIPSOID_PLANE_NEAR
};

typedef ellipsoid_dual dual;

static inline dual times(dual a, dual b) { return ellipsoid_times(a, b); }

/* The functions of the table, and 12 pi S^3/tau = 12 pi b^3/(p^3 (b^2 + p^2)). */
static void set_values(const ellipsoid_plane_table *own, double nu,
                       const double gap[2], int slopes,
                       ellipsoid_plane_values *v)
{
    const double a = own->radius, per = 1 / a, b = own->ratio;
    const double more = b * b - 1, area = a * a, volume = area * a;
    const double p = sqrt(1 + more * nu * nu), p_nu = more * nu / p;
    const double g = gap[FAR] / a, h = p + g, close = p / h;
    const double close_nu = p_nu * g / (h * h), close_gap = -p / (h * h);
    const int sphere = fabs(more) < 1e-9;
    const double w = sphere ? nu * nu : log1p(more * nu * nu) / log1p(more);
    const double w_nu = 2 * nu * (sphere ? 1 : more / (p * p * log1p(more)));
    const double depth = ELLIPSOID_PLANE_DEPTH;
    const double x = log(h / g), beyond = fmax(x - depth, 0);
    const double x_gap = 1 / h - 1 / g, x_nu = p_nu / h;
    const double s = gap[NEAR] / a, over = p + s;
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
        for (int k = 1; slopes && k < GAPS; k++)
        {
            for (int n = 0; n < FUNCTIONS; n++)
            {
                sum[2][n] += in_w[j] * slope_x[k] * own->at[j][k][n];
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
    }
    ellipsoid_plane_scales(b, own->free, p, scale, scale_p);
    for (int n = 0; n < FUNCTIONS; n++)
    {
        const double size = n < 4 ? a : n < 8 || n >= 15 ? volume : area;
        const double of_p =
            size * (scale_p[n] * p_nu * close + scale[n] * close_nu);

        scale[n] *= size;
        v->f[n] = scale[n] * close * sum[0][n];
        v->by_nu[n] = of_p * sum[0][n]
                    + scale[n] * close * (w_nu * sum[1][n] + x_nu * sum[2][n]);
        v->by_gap[n] = scale[n] * per
                     * (close_gap * sum[0][n] + close * x_gap * sum[2][n]);
    }
    v->squeeze[0] = a * ellipsoid_squeeze(b, p) * pow(p / over, 3) / s;
    v->squeeze[1] =
        v->squeeze[0] * p_nu * (-2 * p / (b * b + p * p) - 3 / over);
    v->squeeze[2] = -v->squeeze[0] / a * (3 / over + 1 / s);
    v->arm[0] = -a * p_nu;
    v->arm[1] = -a * more / (p * p * p);
}

/* Two elements of the symmetric part. */
static inline void set_pair(dual column[9][6], int m, int n, dual value)
{
    column[m][n] = column[n][m] = value;
}

/* Force and torque of the tabulated part, with functions f, by each of the
   motion's components and the shear's. */
static void set_columns(const ellipsoid_plane_table *own, const dual *f,
                        const dual normal[3], dual column[9][6])
{
    const int k = own->axis, i = (k + 1) % 3, j = (k + 2) % 3;
    const dual nu = normal[k], x = normal[i], y = normal[j];
    const dual xx = times(x, x), xy = times(x, y), yy = times(y, y);
    const dual bent = times(nu, f[10]), along = times(nu, f[9]);
    const dual sheared = times(nu, f[14]);

    memset(column, 0, 9 * sizeof(*column));
    for (int at = 0; at < 6; at += 3)
    {
        const dual *part = at == 0 ? f : f + 4, turned = times(nu, part[3]);

        column[at + i][at + i] = part[0] + times(part[1], xx);
        column[at + j][at + j] = part[0] + times(part[1], yy);
        column[at + k][at + k] = part[2];
        set_pair(column, at + i, at + j, times(part[1], xy));
        set_pair(column, at + i, at + k, times(turned, x));
        set_pair(column, at + j, at + k, times(turned, y));
    }
    set_pair(column, i, 3 + i, -times(bent, xy));
    set_pair(column, j, 3 + j, times(bent, xy));
    set_pair(column, i, 3 + j, times(bent, xx) - along);
    set_pair(column, j, 3 + i, along - times(bent, yy));
    set_pair(column, i, 3 + k, -times(f[11], y));
    set_pair(column, j, 3 + k, times(f[11], x));
    set_pair(column, k, 3 + i, -times(f[8], y));
    set_pair(column, k, 3 + j, times(f[8], x));
    column[6 + i][i] = column[6 + j][j] = f[12];
    column[6 + k][i] = times(sheared, x);
    column[6 + k][j] = times(sheared, y);
    column[6 + k][k] = f[12] + f[13];
    column[6 + i][3 + j] = times(nu, f[15]);
    column[6 + j][3 + i] = -column[6 + i][3 + j];
    column[6 + k][3 + i] = times(f[15] - f[17], y);
    column[6 + k][3 + j] = times(f[17] - f[15], x);
    column[6 + j][3 + k] = times(f[16], x);
    column[6 + i][3 + k] = -times(f[16], y);
}

void ellipsoid_plane_matrix_at(const ellipsoid_plane_effect *e,
                               const dual normal[3], dual wider,
                               ellipsoid_plane_matrix *at)
{
    const ellipsoid_plane_values *v = &e->values;
    const int k = e->own->axis, i = (k + 1) % 3, j = (k + 2) % 3;
    const dual nu = normal[k] - e->normal[k];
    const dual arm = v->arm[0] + v->arm[1] * nu;
    dual f[FUNCTIONS];

    for (int n = 0; n < FUNCTIONS; n++)
    {
        f[n] = v->f[n] + v->by_nu[n] * nu + v->by_gap[n] * wider;
    }
    set_columns(e->own, f, normal, at->column);
    memcpy(at->row, normal, 3 * sizeof(*normal));
    at->row[3 + i] = -arm * normal[j];
    at->row[3 + j] = arm * normal[i];
    at->row[3 + k] = 0;
    at->squeeze = v->squeeze[0] + v->squeeze[1] * nu + v->squeeze[2] * wider;
}

void ellipsoid_plane_effect_set(const ellipsoid_plane_table *own,
                                const double normal[3], const double gap[2],
                                int slopes, ellipsoid_plane_effect *e)
{
    const dual here[3] = {normal[0], normal[1], normal[2]};

    e->own = own;
    ellipsoid_copy(normal, e->normal);
    memcpy(e->gap, gap, sizeof(e->gap));
    set_values(own, normal[own->axis], gap, slopes, &e->values);
    ellipsoid_plane_matrix_at(e, here, ELLIPSOID_DUAL_STEP * I, &e->by_gap);
}

void ellipsoid_plane_action(const ellipsoid_plane_matrix *of,
                            const dual motion[9], const double velocity[6],
                            dual action[2][6])
{
    dual along = 0;

    for (int m = 0; m < 6; m++)
    {
        along += velocity[m] * of->row[m];
        action[FAR][m] = 0;
        for (int n = 0; n < 9; n++)
        {
            action[FAR][m] += times(motion[n], of->column[n][m]);
        }
    }
    for (int m = 0; m < 6; m++)
    {
        action[NEAR][m] = -of->squeeze * along * of->row[m];
    }
}
