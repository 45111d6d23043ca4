/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    planeTable.c - the table of src/ellipsoid/body/planeTable.def:
        planeTable nodes > nodes             ratio, tilt and gap of each node
        planeTable solve < nodes > values    the functions there, a line each
        planeTable fit < values > planeTable.def
    `solve` may be stopped and continued with the nodes that are left.
*/
#include "body/planeTable.h"
#include "planeSolver.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum
{
    PROLATE = ELLIPSOID_PLANE_PROLATE,
    RATIOS = PROLATE + ELLIPSOID_PLANE_OBLATE,
    IN_TILT = ELLIPSOID_PLANE_TILTS,
    IN_GAP = ELLIPSOID_PLANE_GAPS,
    FUNCTIONS = ELLIPSOID_PLANE_FUNCTIONS
};

static const double pi = 3.14159265358979323846;

/* Which axis ratios are computed: closer where the functions bend. */
static const double ratio_of[RATIOS] = {9.72367768053616,
                                        7.81056282032847,
                                        5.17442576289603,
                                        4,
                                        2.97124455087628,
                                        2.15,
                                        1.58113883008419,
                                        1.2,
                                        1.03,
                                        0.97,
                                        0.841398261635077,
                                        0.65,
                                        0.483145399036664,
                                        0.4,
                                        0.320079366558999,
                                        0.257104367517677};

/* Node k of n of Chebyshev's polynomials on [0, 1]. */
static double node(int k, int n) { return 0.5 - 0.5 * cos(pi * (k + 0.5) / n); }

static int print_nodes(void)
{
    for (int i = 0; i < RATIOS * IN_TILT * IN_GAP; i++)
    {
        const double ratio = ratio_of[i / (IN_TILT * IN_GAP)];
        const double w = node(i / IN_GAP % IN_TILT, IN_TILT);
        const double x = ELLIPSOID_PLANE_DEPTH * node(i % IN_GAP, IN_GAP);
        const double support = pow(ratio, w);
        const double nu2 = (support * support - 1) / (ratio * ratio - 1);

        printf("%.15g %.15g %.15g\n", ratio, acos(sqrt(nu2)),
               support / expm1(x));
    }
    return EXIT_SUCCESS;
}

static int solve_all(void)
{
    plane_case c;
    plane_functions f;

    while (scanf("%lf %lf %lf", &c.ratio, &c.tilt, &c.gap) == 3)
    {
        const double support = hypot(sin(c.tilt), c.ratio * cos(c.tilt));
        const int rings = c.gap < 0.05 * support ? 5
                        : c.gap < 0.5 * support  ? 4
                                                 : 3;
        const plane_mesh mesh = {rings, 2, 6, 8};
        const double *part[] = {f.in[0],     f.in[1],       f.in[2],
                                f.across[0], f.across[1],   f.across[2],
                                f.shear_in,  f.shear_across};

        if (!plane_solve(&c, &mesh, &f))
        {
            return EXIT_FAILURE;
        }
        printf("%.15g %.15g %.15g", c.ratio, c.tilt, c.gap);
        for (int n = 0; n < 8; n++)
        {
            for (int i = n < 6 ? n % 3 : 0; i < 3; i++)
            {
                printf(" %.8g", part[n][i]);
            }
        }
        printf(" %.1e\n", f.asymmetry);
        fflush(stdout);
    }
    return EXIT_SUCCESS;
}

/* A line of values. */
static int read_values(plane_case *c, plane_functions *f)
{
    double *part[] = {f->in[0],     f->in[1],     f->in[2],    f->across[0],
                      f->across[1], f->across[2], f->shear_in, f->shear_across};
    int found = scanf("%lf %lf %lf", &c->ratio, &c->tilt, &c->gap);

    for (int n = 0; n < 8; n++)
    {
        for (int i = n < 6 ? n % 3 : 0; i < 3; i++)
        {
            found += scanf("%lf", &part[n][i]);
        }
    }
    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < i; j++)
        {
            f->in[i][j] = f->in[j][i];
            f->across[i][j] = f->across[j][i];
        }
    }
    return found + scanf("%lf", &f->asymmetry) == 22;
}

/* What is tabulated: see drag/planeFunctions.c for the meaning. */
static void reduce(const plane_case *c, const plane_functions *f,
                   double value[FUNCTIONS])
{
    const double nu = cos(c->tilt), s = sin(c->tilt), ss = s * s;
    const double axes[3] = {1, c->ratio, 1}, b2 = c->ratio * c->ratio;
    const double p = sqrt(ss + b2 * nu * nu), close = p / (p + c->gap);
    const double squeeze =
        ellipsoid_squeeze(c->ratio, p) * close * close * close / c->gap;
    const double arm = (b2 - 1) * nu * s / p, out[3] = {0, 1, arm};
    const double bent = 0.5 * (b2 - 1) / (b2 + 1);
    const double spin_in = 0.5 + bent * (nu * nu - ss);
    const double spin[2] = {-0.5 - bent * nu * nu, bent * nu * s};
    double k[3], rot[3], in[3][3], x[3], y[3];
    double scale[FUNCTIONS], slope[FUNCTIONS];
    double free_in[3][3] = {{0}}, free_across[3][3] = {{0}}, tilted;

    ellipsoid_resistance(axes, k, rot);
    for (int i = 0; i < 2; i++)
    {
        /* of the free body: in x and z, and of y */
        const double *t = i ? rot : k;
        double(*m)[3] = i ? free_across : free_in;

        m[i][i] = t[0] + (t[1] - t[0]) * ss;
        m[i + 1][i + 1] = t[0] + (t[1] - t[0]) * nu * nu;
        m[i][i + 1] = m[i + 1][i] = (t[1] - t[0]) * nu * s;
    }
    free_in[2][2] = rot[0];
    free_across[0][0] = k[0];
    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            in[i][j] = f->in[i][j] - squeeze * out[i] * out[j];
        }
        x[i] = f->shear_in[i] - in[i][2] * spin_in;
        y[i] = f->shear_across[i] - f->across[i][1] * spin[0]
             - f->across[i][2] * spin[1];
    }
    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            in[i][j] -= free_in[i][j];
        }
    }

    const double kxx = in[0][0], kxz = in[0][1], kzz = in[1][1];
    const double kyy = f->across[0][0] - k[0];
    const double cxx = f->across[1][1] - free_across[1][1];
    const double cxz = f->across[1][2] - free_across[1][2];
    const double czz = f->across[2][2] - free_across[2][2];
    const double bxy = in[0][2], bzy = in[1][2];
    const double byx = f->across[0][1], byz = f->across[0][2];
    const double by = nu * byx - s * byz, bt = nu * bxy - s * bzy;

    value[0] = kyy;
    value[1] = (nu * nu * kxx - 2 * s * nu * kxz + ss * kzz - kyy) / ss;
    value[2] = ss * kxx + 2 * s * nu * kxz + nu * nu * kzz;
    value[3] = kzz - kxx + (ss - nu * nu) / (s * nu) * kxz;
    value[4] = in[2][2];
    value[5] = (nu * nu * cxx - 2 * s * nu * cxz + ss * czz - in[2][2]) / ss;
    value[6] = ss * cxx + 2 * s * nu * cxz + nu * nu * czz;
    value[7] = czz - cxx + (ss - nu * nu) / (s * nu) * cxz;
    value[8] = -bxy - nu / s * bzy;
    value[9] = by / nu;
    value[10] = (bt + by) / (ss * nu);
    value[11] = -byx - nu / s * byz;
    value[12] = y[0];
    value[13] = x[0] + nu / s * x[1] - y[0];
    value[14] = (s * x[1] - nu * x[0] + nu * y[0]) / (ss * nu);
    tilted = (s * y[2] - nu * y[1]) / nu;
    value[15] = tilted;
    value[16] = -y[1] - nu / s * y[2];
    value[17] = (tilted - x[2]) / ss;

    const double free[4] = {k[0], k[1], rot[0], rot[1]};

    ellipsoid_plane_scales(c->ratio, free, p, scale, slope);
    for (int n = 0; n < FUNCTIONS; n++)
    {
        value[n] /= scale[n] * close;
    }
}

/* Values to coefficients along one of three directions. */
static void transform(double *value, int count, int stride)
{
    double kept[64];

    for (int k = 0; k < count; k++)
    {
        kept[k] = 0;
        for (int n = 0; n < count; n++)
        {
            kept[k] += (k ? 2.0 : 1.0) / count * value[n * stride]
                     * cos(k * pi * (1 - (n + 0.5) / count));
        }
    }
    for (int k = 0; k < count; k++)
    {
        value[k * stride] = kept[k];
    }
}

enum
{
    OF_RATIO = IN_TILT * IN_GAP * FUNCTIONS /* values of one */
};

static double table[RATIOS][OF_RATIO];

/* Values at `count` ratios to coefficients of Chebyshev's polynomials: Gauss's
   elimination with pivots, of all columns at once. */
static int transform_ratios(const double *ratio, int count,
                            double (*value)[OF_RATIO])
{
    double m[RATIOS][RATIOS];

    for (int i = 0; i < count; i++)
    {
        ellipsoid_chebyshev(ellipsoid_plane_ratio_part(ratio[i]), count, m[i],
                            NULL);
    }
    for (int k = 0; k < count; k++)
    {
        int best = k;

        for (int i = k + 1; i < count; i++)
        {
            best = fabs(m[i][k]) > fabs(m[best][k]) ? i : best;
        }
        for (int j = 0; j < OF_RATIO || j < count; j++)
        {
            double kept;

            if (j < count)
            {
                kept = m[k][j];
                m[k][j] = m[best][j];
                m[best][j] = kept;
            }
            kept = value[k][j];
            value[k][j] = value[best][j];
            value[best][j] = kept;
        }
        if (m[k][k] == 0)
        {
            return 0;
        }
        for (int i = 0; i < count; i++)
        {
            const double factor = i == k ? 0 : m[i][k] / m[k][k];

            for (int j = k; j < count; j++)
            {
                m[i][j] -= factor * m[k][j];
            }
            for (int j = 0; j < OF_RATIO; j++)
            {
                value[i][j] -= factor * value[k][j];
            }
        }
    }
    for (int k = 0; k < count; k++)
    {
        for (int j = 0; j < OF_RATIO; j++)
        {
            value[k][j] /= m[k][k];
        }
    }
    return 1;
}

/* Without what C does not need: -.012 for -0.01200. */
static void print_short(double value)
{
    char text[32], *from = text, *end;

    snprintf(text, sizeof(text), "%.4f", value);
    end = text + strlen(text);
    while (end[-1] == '0')
    {
        *--end = 0;
    }
    if (end[-1] == '.')
    {
        end[-1] = 0;
    }
    putchar(',');
    if (*from == '-')
    {
        from++;
        if (strcmp(from, "0"))
        {
            putchar('-');
        }
    }
    fputs(from[0] == '0' && from[1] == '.' ? from + 1 : from, stdout);
}

static int fit(void)
{
    plane_case c;
    plane_functions f;

    for (int i = 0; i < RATIOS * IN_TILT * IN_GAP; i++)
    {
        if (!read_values(&c, &f))
        {
            fprintf(stderr, "planeTable: value %d is missing\n", i + 1);
            return EXIT_FAILURE;
        }
        reduce(&c, &f, &table[0][0] + i * FUNCTIONS);
    }
    for (int r = 0; r < RATIOS; r++)
    {
        for (int i = 0; i < OF_RATIO; i++)
        {
            if (i / FUNCTIONS % IN_GAP == 0)
            {
                transform(table[r] + i, IN_GAP, FUNCTIONS);
            }
        }
        for (int i = 0; i < IN_GAP * FUNCTIONS; i++)
        {
            transform(table[r] + i, IN_TILT, IN_GAP * FUNCTIONS);
        }
    }
    if (!transform_ratios(ratio_of, PROLATE, table)
        || !transform_ratios(ratio_of + PROLATE, RATIOS - PROLATE,
                             table + PROLATE))
    {
        return EXIT_FAILURE;
    }
    for (int i = 0; i < RATIOS * IN_TILT * IN_GAP; i++)
    {
        const int r = i / (IN_TILT * IN_GAP), oblate = r >= PROLATE;
        const double *v = &table[0][0] + i * FUNCTIONS;
        double most = 0;

        for (int n = 0; n < FUNCTIONS; n++)
        {
            most = fmax(most, fabs(v[n]));
        }
        if (most < 2e-4)
        {
            continue;
        }
        printf("P(%d,%d,%d,%d", oblate, r - oblate * PROLATE,
               i / IN_GAP % IN_TILT, i % IN_GAP);
        for (int n = 0; n < FUNCTIONS; n++)
        {
            print_short(v[n]);
        }
        printf(")\n");
    }
    return EXIT_SUCCESS;
}

int main(int count, char **word)
{
    const char *what = count == 2 ? word[1] : "";

    if (!strcmp(what, "nodes"))
    {
        return print_nodes();
    }
    if (!strcmp(what, "solve"))
    {
        return solve_all();
    }
    if (!strcmp(what, "fit"))
    {
        return fit();
    }
    fprintf(stderr, "usage: planeTable nodes|solve|fit\n");
    return EXIT_FAILURE;
}
