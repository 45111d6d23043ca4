/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    invert6.c - the inverse of a 6x6 matrix, that of one body's rates.
*/
#include "body/body.h"

/* The square of a determinant by that of perpendicular rows of the same
   lengths, below which digits are lost. */
static const double flat = 1e-10;

/* left right, times sign */
static inline void multiply3(double sign, double left[3][3], double right[3][3],
                             double result[3][3])
{
    for (int n = 0; n < 3; n++)
    {
        ellipsoid_combination(right, sign * left[n][0], sign * left[n][1],
                              sign * left[n][2], result[n]);
    }
}

/* In place, by elimination with row exchanges; 0 if it is singular. */
static int eliminate6(double m[6][6])
{
    double row[6][12];
    int regular = 1;

    for (int i = 0; i < 6; i++)
    {
        for (int j = 0; j < 6; j++)
        {
            row[i][j] = m[i][j];
            row[i][j + 6] = i == j;
        }
    }
    for (int i = 0; i < 6; i++)
    {
        int pivot = i;

        for (int n = i + 1; n < 6; n++)
        {
            pivot = fabs(row[n][i]) > fabs(row[pivot][i]) ? n : pivot;
        }
        for (int j = i; j < 12; j++)
        {
            const double kept = row[pivot][j];

            row[pivot][j] = row[i][j];
            row[i][j] = kept;
        }
        regular = regular && isnormal(row[i][i]);
        for (int n = 0; n < 6; n++)
        {
            const double part = row[n][i] / row[i][i];

            for (int j = i + 1; n != i && j < 12; j++)
            {
                row[n][j] -= part * row[i][j];
            }
        }
    }
    for (int i = 0; i < 36; i++)
    {
        m[i / 6][i % 6] = row[i / 6][i % 6 + 6] / row[i / 6][i / 6];
    }
    return regular;
}

/* 0 if it is singular, or stiffer in one direction, as a contact makes it. */
static inline int invert_even(double m[3][3], double inverse[3][3])
{
    double minor[3], determinant, rows;

    ellipsoid_cross(m[1], m[2], minor);
    determinant = ellipsoid_dot(m[0], minor);
    rows = ellipsoid_dot(m[0], m[0]) * ellipsoid_dot(m[1], m[1])
         * ellipsoid_dot(m[2], m[2]);
    return ellipsoid_invert3(m, inverse)
        && determinant * determinant > flat * rows;
}

/*
    In place, by blocks of 3x3: with S the last of the four, a, b, c, and
    M = a - b S^-1 c the inverse is
        (M^-1, -M^-1 b S^-1; -S^-1 c M^-1, S^-1 + S^-1 c M^-1 b S^-1).
    Where a stiff contact holds one direction this loses the square of how much
    stiffer that is than drag, to cofactors and to the difference, elimination
    only once (test_invert6.c). 0 if the matrix is singular.
*/
int ellipsoid_invert6(double m[6][6])
{
    double a[3][3], b[3][3], c[3][3], last[3][3];
    double s[3][3], bs[3][3], sc[3][3], bsc[3][3], first[3][3];
    double above[3][3], below[3][3], rest[3][3];

    for (int i = 0; i < 3; i++)
    {
        ellipsoid_copy(m[i], a[i]);
        ellipsoid_copy(m[i] + 3, b[i]);
        ellipsoid_copy(m[i + 3], c[i]);
        ellipsoid_copy(m[i + 3] + 3, last[i]);
    }
    if (!invert_even(last, s))
    {
        return eliminate6(m);
    }
    multiply3(1, b, s, bs);
    multiply3(1, s, c, sc);
    multiply3(1, bs, c, bsc);
    for (int i = 0; i < 3; i++)
    {
        ellipsoid_difference(a[i], bsc[i], a[i]);
    }
    if (!invert_even(a, first))
    {
        return eliminate6(m);
    }
    multiply3(-1, first, bs, above);
    multiply3(-1, sc, first, below);
    multiply3(-1, sc, above, rest);
    for (int i = 0; i < 3; i++)
    {
        ellipsoid_add(s[i], rest[i]);
        ellipsoid_copy(first[i], m[i]);
        ellipsoid_copy(above[i], m[i] + 3);
        ellipsoid_copy(below[i], m[i + 3]);
        ellipsoid_copy(s[i], m[i + 3] + 3);
    }
    return 1;
}
