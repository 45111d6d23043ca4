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

/* Fitted to spheres and spheroids held in the flows of stagnation points, by
   boundary elements: a median error of 8 % in place of 46 (test_wallFit.c). */
static const double towards = 0.43;

typedef ellipsoid_dual dual;

/* 2 a_i^2 a_j^2/(a_i^2 + a_j^2), by which E^_ij m_j, m = -n/p (below), adds to
   G' r. */
static double left(const double a[3], int i, int j)
{
    const double ii = a[i] * a[i], jj = a[j] * a[j];

    return 2 * ii * jj / (ii + jj);
}

static void cross(const dual a[3], const dual b[3], dual result[3])
{
    for (int i = 0; i < 3; i++)
    {
        const int j = (i + 1) % 3, k = (i + 2) % 3;

        result[i] = ellipsoid_times(a[j], b[k]) - ellipsoid_times(a[k], b[j]);
    }
}

void ellipsoid_along_wall(const double m[9], const dual n[3], dual value[3])
{
    dual along = 0;

    for (int i = 0; i < 3; i++)
    {
        value[i] = m[3 * i] * n[0] + m[3 * i + 1] * n[1] + m[3 * i + 2] * n[2];
        along += n[i] * value[i];
    }
    for (int i = 0; i < 3; i++)
    {
        value[i] -= along * n[i];
    }
}

/* Where a body is nearest to a wall: m = -n/p, p = sqrt(sum a_i^2 n_i^2), r_i =
   a_i^2 m_i; and d_i = J_i - k^2 r.r, with which
       (diag(d) + k^2 r r^T) w = k^2 s x r,   s = G' r. */
typedef struct nearest
{
    double towards;                  /* k */
    dual m[3], r[3], d[3], minor[3]; /* d_j d_k */
    dual determinant;
} nearest;

/* 1/x to the first order of its derivative. */
static dual inverse(dual x) { return (2 - x / creal(x)) / creal(x); }

static nearest set_nearest(const ellipsoid_model *model, const dual n[3])
{
    const double *a = model->options.semi_axes;
    const double k = model->flow_points > 0 ? towards : 0;
    nearest at = {.towards = k};
    dual square = 0, per;

    for (int i = 0; i < 3; i++)
    {
        square += a[i] * a[i] * n[i] * n[i];
    }
    per = inverse(sqrt(creal(square)) * (1 + square / creal(square)) / 2);
    square = 0;
    for (int i = 0; i < 3; i++)
    {
        at.m[i] = -n[i] * per;
        at.r[i] = a[i] * a[i] * at.m[i];
        square += at.r[i] * at.r[i];
    }
    for (int i = 0; i < 3; i++)
    {
        at.d[i] = (ellipsoid_dot(a, a) - a[i] * a[i]) / 3 - k * k * square;
    }
    at.determinant = at.d[0] * at.d[1] * at.d[2];
    for (int i = 0; i < 3; i++)
    {
        at.minor[i] = at.d[(i + 1) % 3] * at.d[(i + 2) % 3];
        at.determinant += k * k * at.r[i] * at.r[i] * at.minor[i];
    }
    return at;
}

/* The motion by s: w = k^2/det (minor_i mu_i - k^2 r x diag(d) (r x mu)), mu = s x
   r. */
static void set_motion(const nearest *at, const dual s[3], dual motion[6])
{
    const double k = at->towards;
    const dual per = k * k * inverse(at->determinant);
    dual *w = motion + 3, moment[3], turned[3], back[3];

    cross(s, at->r, moment);
    cross(at->r, moment, turned);
    for (int i = 0; i < 3; i++)
    {
        turned[i] *= at->d[i];
    }
    cross(at->r, turned, back);
    for (int i = 0; i < 3; i++)
    {
        w[i] = per * (at->minor[i] * moment[i] - k * k * back[i]);
    }
    cross(w, at->r, turned);
    for (int i = 0; i < 3; i++)
    {
        motion[i] = k * (s[i] - turned[i]);
    }
}

/* Takes from vectors of six numbers what they have along n. */
static void project(const double n[3], double v[3][6])
{
    double along[6] = {0};

    for (int i = 0; i < 3; i++)
    {
        ellipsoid_add6(n[i], v[i], along);
    }
    for (int i = 0; i < 3; i++)
    {
        ellipsoid_add6(-n[i], along, v[i]);
    }
}

void ellipsoid_wall_fit_columns(const ellipsoid_model *model, const double n[3],
                                double column[9][6], double by[18][6])
{
    const dual normal[3] = {n[0], n[1], n[2]};
    const nearest at = set_nearest(model, normal);
    double by_s[3][6] = {{0}}, of_n[3][6] = {{0}};

    for (int i = 0; i < 3; i++)
    {
        const dual s[3] = {i == 0, i == 1, i == 2};
        dual motion[6];

        set_motion(&at, s, motion);
        for (int c = 0; c < 6; c++)
        {
            ellipsoid_add6(creal(motion[c]), column[c], by_s[i]);
        }
    }
    project(n, column + 6);
    memset(by, 0, 18 * sizeof(*by));
    /* by all of the strain, symmetric; then without (I - n n) E n */
    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            const double half = 0.5 * left(model->options.semi_axes, i, j);
            double *of_mean = by[9 + 3 * i + j];

            ellipsoid_add6(n[j], column[6 + i], by[3 * i + j]);
            ellipsoid_add6(half * creal(at.m[j]), by_s[i], of_mean);
            ellipsoid_add6(half * creal(at.m[i]), by_s[j], of_mean);
            ellipsoid_add6(n[j], of_mean, of_n[i]);
        }
    }
    project(n, of_n);
    for (int i = 0; i < 9; i++)
    {
        ellipsoid_add6(-n[i % 3], of_n[i / 3], by[9 + i]);
        ellipsoid_add6(-n[i / 3], of_n[i % 3], by[9 + i]);
    }
}

void ellipsoid_wall_fit_motion(const ellipsoid_model *model, const dual n[3],
                               const double g[9], dual motion[6])
{
    const nearest at = set_nearest(model, n);
    double strain[9];
    dual shear[3], s[3] = {0};

    for (int i = 0; i < 9; i++)
    {
        strain[i] = 0.5 * (g[i] + g[i % 3 * 3 + i / 3]);
    }
    ellipsoid_along_wall(strain, n, shear);
    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            s[i] += left(model->options.semi_axes, i, j)
                  * (strain[3 * i + j] - shear[i] * n[j] - n[i] * shear[j])
                  * at.m[j];
        }
    }
    set_motion(&at, s, motion);
}
