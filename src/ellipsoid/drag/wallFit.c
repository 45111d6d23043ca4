/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    wallFit.c - the motion that a wall's resistance meets in a flow.

    By the reciprocal theorem a held body feels the flow times the tractions of its
    motions. Far from walls these are such that the body is carried by the motion
    that fits the flow best over the unit sphere, x^_i = a_i nu_i (faxen.c). Near
    a wall they are larger towards it, and what the wall adds to the resistance
    meets the motion that fits with the weight 1 + 3 k nu.m, m the nu of the
    nearest point r:
        u' = u_free + k (G' r - w x r),   w' = w_free + w,
        J w = -k r x (u' - u_free),       J_i = (a_j^2 + a_k^2)/3,
    where G'_ij = 2 a_i^2/(a_i^2 + a_j^2) E^_ij is the gradient without what
    w_free follows. Left out of the strain E^ are the parts along and across the
    wall, (I - n n) E n: the force in the shear is known (planeFunctions.c), and
    velocities along n do not change along a wall that is plane. k is 0 for
    FLOW_CENTRE, which knows the flow at one point.
*/
#include "drag/drag.h"

#include <string.h>

/* Fitted to spheres and spheroids held in the flows of stagnation points, by
   boundary elements: a median error of 8 % in place of 46 (test_wallFit.c). */
static const double towards = 0.43;

/* How much of the strain ij is left to the part i of the flow along j. */
static double left(const double a[3], int i, int j)
{
    return 2 * a[i] * a[i] / (a[i] * a[i] + a[j] * a[j]);
}

void ellipsoid_along_wall(double m[3][3], const double n[3], double value[3],
                          double change[3][3])
{
    double of_n[3], back[3], along;

    ellipsoid_product(m, n, of_n);
    ellipsoid_combination(m, n[0], n[1], n[2], back);
    along = ellipsoid_dot(n, of_n);
    for (int i = 0; i < 3; i++)
    {
        value[i] = of_n[i] - along * n[i];
        for (int c = 0; c < 3; c++)
        {
            change[c][i] =
                m[i][c] - (i == c) * along - n[i] * (of_n[c] + back[c]);
        }
    }
}

void ellipsoid_wall_fit_set(const ellipsoid_model *model,
                            const double normal[3], ellipsoid_wall_fit *fit)
{
    const double *a = model->options.semi_axes;
    const double k = model->flow_points > 0 ? towards : 0;
    double *r = fit->nearest, matrix[3][3];

    fit->towards = k;
    ellipsoid_set(r, a[0] * a[0] * normal[0], a[1] * a[1] * normal[1],
                  a[2] * a[2] * normal[2]);
    fit->support = sqrt(ellipsoid_dot(r, normal));
    for (int i = 0; i < 3; i++)
    {
        r[i] /= -fit->support;
    }
    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            matrix[i][j] = k * k * r[i] * r[j];
        }
        matrix[i][i] += (ellipsoid_dot(a, a) - a[i] * a[i]) / 3
                      - k * k * ellipsoid_dot(r, r);
    }
    ellipsoid_invert3(matrix, fit->inverse);
}

/* The motion by s = G' r. */
static void set_motion(ellipsoid_wall_fit *fit, const double s[3],
                       double motion[6])
{
    const double k = fit->towards;
    double *w = motion + 3, moment[3], turned[3];

    ellipsoid_cross(s, fit->nearest, moment);
    ellipsoid_product(fit->inverse, moment, w);
    for (int i = 0; i < 3; i++)
    {
        w[i] *= k * k;
    }
    ellipsoid_cross(w, fit->nearest, turned);
    for (int i = 0; i < 3; i++)
    {
        motion[i] = k * (s[i] - turned[i]);
    }
}

void ellipsoid_wall_fit_columns(const double a[3], const double n[3],
                                ellipsoid_wall_fit *fit, double column[9][6],
                                double by[9][6])
{
    double by_s[3][6] = {{0}}, of_n[3][6] = {{0}}, along[6] = {0};

    for (int i = 0; i < 3; i++)
    {
        const double s[3] = {i == 0, i == 1, i == 2};
        double motion[6];

        set_motion(fit, s, motion);
        for (int m = 0; m < 6; m++)
        {
            ellipsoid_add6(motion[m], column[m], by_s[i]);
        }
    }
    /* by all of the strain, symmetric; then without (I - n n) E n */
    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            double *sum = by[3 * i + j];

            memset(sum, 0, 6 * sizeof(*sum));
            ellipsoid_add6(0.5 * left(a, i, j) * fit->nearest[j], by_s[i], sum);
            ellipsoid_add6(0.5 * left(a, j, i) * fit->nearest[i], by_s[j], sum);
            ellipsoid_add6(n[j], sum, of_n[i]);
        }
        ellipsoid_add6(n[i], of_n[i], along);
    }
    for (int i = 0; i < 3; i++)
    {
        ellipsoid_add6(-n[i], along, of_n[i]);
    }
    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            ellipsoid_add6(-n[j], of_n[i], by[3 * i + j]);
            ellipsoid_add6(-n[i], of_n[j], by[3 * i + j]);
        }
    }
}

void ellipsoid_wall_fit_motion(const double a[3], const double n[3],
                               double g[3][3], ellipsoid_wall_fit *fit,
                               double motion[6], double change[3][6])
{
    const double *r = fit->nearest, *w = motion + 3, k = fit->towards;
    double whole[3][3], strain[3][3], shear[3], bent[3][3], s[3] = {0};

    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            whole[i][j] = 0.5 * (g[i][j] + g[j][i]);
        }
    }
    ellipsoid_along_wall(whole, n, shear, bent);
    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            strain[i][j] = whole[i][j] - shear[i] * n[j] - n[i] * shear[j];
            s[i] += left(a, i, j) * strain[i][j] * r[j];
        }
    }
    set_motion(fit, s, motion);
    for (int c = 0; c < 3; c++)
    {
        double *u_c = change[c], *w_c = u_c + 3;
        double r_c[3], s_c[3] = {0}, moment[3], turned[2][3];

        for (int i = 0; i < 3; i++)
        {
            r_c[i] = (r[i] * r[c] - (i == c) * a[i] * a[i]) / fit->support;
        }
        for (int i = 0; i < 3; i++)
        {
            for (int j = 0; j < 3; j++)
            {
                const double strain_c = -bent[c][i] * n[j] - n[i] * bent[c][j]
                                      - shear[i] * (j == c)
                                      - shear[j] * (i == c);

                s_c[i] +=
                    left(a, i, j) * (strain_c * r[j] + strain[i][j] * r_c[j]);
            }
        }
        ellipsoid_cross(s_c, r, moment);
        ellipsoid_cross(s, r_c, turned[0]);
        ellipsoid_add(moment, turned[0]);
        for (int i = 0; i < 3; i++)
        {
            moment[i] += 2 * ellipsoid_dot(r, r_c) * w[i]
                       - r_c[i] * ellipsoid_dot(r, w)
                       - r[i] * ellipsoid_dot(r_c, w);
            moment[i] *= k * k;
        }
        ellipsoid_product(fit->inverse, moment, w_c);
        ellipsoid_cross(w_c, r, turned[0]);
        ellipsoid_cross(w, r_c, turned[1]);
        for (int i = 0; i < 3; i++)
        {
            u_c[i] = k * (s_c[i] - turned[0][i] - turned[1][i]);
        }
    }
}
