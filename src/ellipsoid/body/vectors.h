/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    vectors.h - vectors, 3x3 matrices and quaternions, inlined.
*/
#ifndef ELLIPSOID_VECTORS_H
#define ELLIPSOID_VECTORS_H

#include <math.h>

/* A call that is left out of line keeps what it is given the address of out of
   registers: a twentieth of an evaluation's instructions. */
#ifdef __GNUC__
#define INLINED static inline __attribute__((always_inline))
#else
#define INLINED static inline
#endif

static inline double ellipsoid_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline double ellipsoid_length(const double v[3])
{
    return sqrt(ellipsoid_dot(v, v));
}

/*
    The small loops over three components are written out where speed counts:
    compilers then keep the numbers in registers.
*/
static inline void ellipsoid_set(double v[3], double a, double b, double c)
{
    v[0] = a;
    v[1] = b;
    v[2] = c;
}

/* m v; m is not const as C11 would not take a plain matrix then. */
static inline void ellipsoid_product(double m[3][3], const double v[3],
                                     double result[3])
{
    ellipsoid_set(result, ellipsoid_dot(m[0], v), ellipsoid_dot(m[1], v),
                  ellipsoid_dot(m[2], v));
}

/* m^T v = a m_0 + b m_1 + c m_2 */
static inline void ellipsoid_combination(double m[3][3], double a, double b,
                                         double c, double result[3])
{
    ellipsoid_set(result, a * m[0][0] + b * m[1][0] + c * m[2][0],
                  a * m[0][1] + b * m[1][1] + c * m[2][1],
                  a * m[0][2] + b * m[1][2] + c * m[2][2]);
}

/* Without calls, where neither is NaN. */
static inline double ellipsoid_lesser(double a, double b)
{
    return a < b ? a : b;
}

static inline double ellipsoid_greater(double a, double b)
{
    return a > b ? a : b;
}

static inline double ellipsoid_sum(const double v[3])
{
    return v[0] + v[1] + v[2];
}

/* Of the components, as of semi-axes. */
static inline double ellipsoid_largest(const double v[3])
{
    return fmax(v[0], fmax(v[1], v[2]));
}

static inline double ellipsoid_smallest(const double v[3])
{
    return fmin(v[0], fmin(v[1], v[2]));
}

static inline void ellipsoid_add(double v[3], const double change[3])
{
    v[0] += change[0];
    v[1] += change[1];
    v[2] += change[2];
}

/* v += factor change */
static inline void ellipsoid_add_times(double v[3], double factor,
                                       const double change[3])
{
    v[0] += factor * change[0];
    v[1] += factor * change[1];
    v[2] += factor * change[2];
}

/* |q|^2 of four components */
static inline double ellipsoid_square4(const double q[4])
{
    return ellipsoid_dot(q, q) + q[3] * q[3];
}

static inline void ellipsoid_normalise(double q[4])
{
    const double scale = 1 / sqrt(ellipsoid_square4(q));

    for (int n = 0; n < 4; n++)
    {
        q[n] *= scale;
    }
}

static inline void ellipsoid_difference(const double a[3], const double b[3],
                                        double result[3])
{
    result[0] = a[0] - b[0];
    result[1] = a[1] - b[1];
    result[2] = a[2] - b[2];
}

static inline void ellipsoid_cross(const double a[3], const double b[3],
                                   double result[3])
{
    result[0] = a[1] * b[2] - a[2] * b[1];
    result[1] = a[2] * b[0] - a[0] * b[2];
    result[2] = a[0] * b[1] - a[1] * b[0];
}

static inline void ellipsoid_copy(const double from[3], double to[3])
{
    to[0] = from[0];
    to[1] = from[1];
    to[2] = from[2];
}

/* Two unit vectors that span the plane across n. */
static inline void ellipsoid_tangents(const double n[3], double e[2][3])
{
    const int least = fabs(n[0]) < fabs(n[1])
                        ? (fabs(n[0]) < fabs(n[2]) ? 0 : 2)
                        : (fabs(n[1]) < fabs(n[2]) ? 1 : 2);
    double axis[3] = {0, 0, 0}, length;

    axis[least] = 1;
    ellipsoid_cross(n, axis, e[0]);
    length = ellipsoid_length(e[0]);
    ellipsoid_set(e[0], e[0][0] / length, e[0][1] / length, e[0][2] / length);
    ellipsoid_cross(n, e[0], e[1]);
}

/* By cofactors; 0 if it is singular. */
static inline int ellipsoid_invert3(double m[3][3], double inverse[3][3])
{
    double c[3][3], determinant, per;

    ellipsoid_cross(m[1], m[2], c[0]);
    ellipsoid_cross(m[2], m[0], c[1]);
    ellipsoid_cross(m[0], m[1], c[2]);
    determinant = ellipsoid_dot(m[0], c[0]);
    per = 1 / determinant;
    for (int n = 0; n < 3; n++)
    {
        ellipsoid_set(inverse[n], per * c[0][n], per * c[1][n], per * c[2][n]);
    }
    return isnormal(determinant);
}

/* Is it a pose at which the equations may be asked about? Inside a step |q| is
   not 1, but a stage that has left it far behind is of no use. */
static inline int ellipsoid_is_pose(const double x[3], const double q[4])
{
    const double square = ellipsoid_square4(q);

    return isfinite(x[0] + x[1] + x[2]) && square > 0.25 && square < 4;
}

/* R(q), see ellipsoid_rotation(); inlined into the right-hand side. */
static inline void ellipsoid_rotation_inline(const double q[4], double r[3][3])
{
    const double aa = q[0] * q[0], bb = q[1] * q[1];
    const double cc = q[2] * q[2], nn = q[3] * q[3];
    const double ab = q[0] * q[1], ac = q[0] * q[2], bc = q[1] * q[2];
    const double an = q[0] * q[3], bn = q[1] * q[3], cn = q[2] * q[3];

    r[0][0] = (nn - cc) + (aa - bb);
    r[0][1] = 2 * (ab - cn);
    r[0][2] = 2 * (ac + bn);
    r[1][0] = 2 * (ab + cn);
    r[1][1] = (nn - cc) - (aa - bb);
    r[1][2] = 2 * (bc - an);
    r[2][0] = 2 * (ac - bn);
    r[2][1] = 2 * (bc + an);
    r[2][2] = (nn + cc) - (aa + bb);
}

/* The body axes in the lab, the columns of R(q), which are the rows of R of the
   opposite turn. */
static inline void ellipsoid_axes(const double q[4], double axis[3][3])
{
    const double opposite[4] = {q[0], q[1], q[2], -q[3]};

    ellipsoid_rotation_inline(opposite, axis);
}

/* Q(omega) v: dq/dt = 1/2 Q(omega) q, paper eq. (4). Q^2 = -|omega|^2. */
static inline void ellipsoid_spin(const double w[3], const double v[4],
                                  double result[4])
{
    result[0] = v[3] * w[0] + v[1] * w[2] - v[2] * w[1];
    result[1] = v[3] * w[1] + v[2] * w[0] - v[0] * w[2];
    result[2] = v[3] * w[2] + v[0] * w[1] - v[1] * w[0];
    result[3] = -(v[0] * w[0] + v[1] * w[1] + v[2] * w[2]);
}

/* Derivatives d[n][i] = dr_i/dq_n of the body axes r_i. */
static inline void ellipsoid_axis_derivatives(const double q[4],
                                              double d[4][3][3])
{
    const double a = 2 * q[0], b = 2 * q[1], c = 2 * q[2], n = 2 * q[3];

    ellipsoid_set(d[0][0], a, b, c);
    ellipsoid_set(d[0][1], b, -a, n);
    ellipsoid_set(d[0][2], c, -n, -a);
    ellipsoid_set(d[1][0], -b, a, -n);
    ellipsoid_set(d[1][1], a, b, c);
    ellipsoid_set(d[1][2], n, c, -b);
    ellipsoid_set(d[2][0], -c, n, a);
    ellipsoid_set(d[2][1], -n, -c, b);
    ellipsoid_set(d[2][2], a, b, c);
    ellipsoid_set(d[3][0], n, c, -b);
    ellipsoid_set(d[3][1], -c, n, a);
    ellipsoid_set(d[3][2], b, -a, n);
}

#endif
