/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    resistance.c - Stokes resistance of an ellipsoid.

    Oberbeck, J. reine angew. Math. 81, 62 (1876); Jeffery, Proc. R. Soc. A
    102, 161 (1922); the elliptic integrals in the symmetric form of Carlson,
    Numer. Algorithms 10, 13 (1995), which is exact for the sphere and loses
    no digits near it.
*/
#include "body/body.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

static double largest(double a, double b, double c)
{
    return fmax(a, fmax(b, c));
}

/*
    Carlson (1995), Algorithm 1. The series is cut at the fifth power of the
    scaled differences; they are halved twice per turn until their sixth power
    is below rounding.
*/
double ellipsoid_carlson_rf(double x, double y, double z)
{
    const double mean0 = (x + y + z) / 3;
    const double dx = mean0 - x, dy = mean0 - y;
    double mean = mean0, scale = 1;
    double spread = 480 * largest(fabs(dx), fabs(dy), fabs(mean0 - z));

    while (spread > fabs(mean))
    {
        const double sx = sqrt(x), sy = sqrt(y), sz = sqrt(z);
        const double lambda = sx * sy + sx * sz + sy * sz;

        mean = 0.25 * (mean + lambda);
        x = 0.25 * (x + lambda);
        y = 0.25 * (y + lambda);
        z = 0.25 * (z + lambda);
        scale *= 0.25;
        spread *= 0.25;
    }

    const double a = dx * scale / mean, b = dy * scale / mean, c = -a - b;
    const double e2 = a * b - c * c, e3 = a * b * c;

    return (1 - e2 / 10 + e3 / 14 + e2 * e2 / 24 - 3 * e2 * e3 / 44)
         / sqrt(mean);
}

/* Carlson (1995), Algorithm 3 (R_D as the degenerate R_J). */
double ellipsoid_carlson_rd(double x, double y, double z)
{
    const double mean0 = (x + y + 3 * z) / 5;
    const double dx = mean0 - x, dy = mean0 - y;
    double mean = mean0, scale = 1, sum = 0;
    double spread = 600 * largest(fabs(dx), fabs(dy), fabs(mean0 - z));

    while (spread > fabs(mean))
    {
        const double sx = sqrt(x), sy = sqrt(y), sz = sqrt(z);
        const double lambda = sx * sy + sx * sz + sy * sz;

        sum += scale / (sz * (z + lambda));
        mean = 0.25 * (mean + lambda);
        x = 0.25 * (x + lambda);
        y = 0.25 * (y + lambda);
        z = 0.25 * (z + lambda);
        scale *= 0.25;
        spread *= 0.25;
    }

    const double a = dx * scale / mean, b = dy * scale / mean;
    const double c = -(a + b) / 3;
    const double ab = a * b, cc = c * c;
    const double e2 = ab - 6 * cc, e3 = (3 * ab - 8 * cc) * c;
    const double e4 = 3 * (ab - cc) * cc, e5 = ab * cc * c;
    const double series = 1 - 3 * e2 / 14 + e3 / 6 + 9 * e2 * e2 / 88
                        - 3 * e4 / 22 - 9 * e2 * e3 / 52 + 3 * e5 / 26;

    return 3 * sum + scale * series / (mean * sqrt(mean));
}

/*
    Lengths in units of the largest semi-axis, P = a1 a2 a3:
        alpha_i = 2/3 P R_D(a_j^2, a_k^2, a_i^2),
        chi = 2 P R_F(a1^2, a2^2, a3^2),
        K^_i = 16 pi P / (chi + alpha_i a_i^2)                 (Oberbeck)
        C_i = 16 pi P (a_j^2 + a_k^2) / (3 (a_j^2 alpha_j + a_k^2 alpha_k))
                                                    (Jeffery, eqs. 36 and 37)
*/
void ellipsoid_resistance(const double semi_axes[3], double resistance[3],
                          double rotation_resistance[3])
{
    const double length = largest(semi_axes[0], semi_axes[1], semi_axes[2]);
    double square[3], moment[3], product = 1;

    for (int i = 0; i < 3; i++)
    {
        const double a = semi_axes[i] / length;

        product *= a;
        square[i] = a * a;
    }

    const double chi =
        2 * product * ellipsoid_carlson_rf(square[0], square[1], square[2]);

    for (int i = 0; i < 3; i++)
    {
        const int j = (i + 1) % 3, k = (i + 2) % 3;

        moment[i] = square[i] * product * 2 / 3
                  * ellipsoid_carlson_rd(square[j], square[k], square[i]);
        resistance[i] = 16 * pi * product * length / (chi + moment[i]);
    }
    for (int i = 0; i < 3; i++)
    {
        const int j = (i + 1) % 3, k = (i + 2) % 3;

        rotation_resistance[i] = 16 * pi * product * length * length * length
                               * (square[j] + square[k])
                               / (3 * (moment[j] + moment[k]));
    }
}
