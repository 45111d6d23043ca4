/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    wallResistance.c - what a plane wall adds to an ellipsoid's resistance.

    With n the plane's normal, all in the body frame: D = diag(a_i^2), b = D n,
    support p = sqrt(n.b), gap h - p. Below, h is the height with the gap cut
    off; see docs/theory.md, "Near walls".

    Far: the image of the body's force distribution, Brenner, J. Fluid Mech. 12,
    35 (1962), to the order (a/h)^3 for the ellipsoid,
        Z = h W^-1 + W^-1 Q W^-1/h,  W = 9/16 (1 - n n) + 9/8 n n,
    adds K (6 pi Z - K)^-1 K to K; the rotlet's image adds to C
        C (5/16 - 3/16 n n) C/(8 pi h^3 + max C).
    Near: lubrication between the plane and a surface with the radii of
    curvature R1, R2 at its nearest point, S = sqrt(R1 R2), tau = R1 + R2. With
    the surface's velocity u_s there, u_n along n and u_t across, squeezing
    gives 12 pi S^3/(tau gap) u_n^2, shearing 2 pi S L u_t^2, and the wedge
    2 pi S L v.E v of dissipation over mu, v = u_t/2 - rho (n x omega), where
    rho has the eigenvalues R1 and R2 and E 12 R2/(3 R1 + 2 R2) and so on.
*/
#include "drag/wallResistance.h"

static const double pi = 3.14159265358979323846;

/* All that follows from normal and height. */
typedef struct plane_geometry
{
    const ellipsoid_model *model;
    double square[3], trace; /* [m2] a_i^2, their sum */
    double m[3], b[3], support2, support;
    double gap, gap_slope; /* cut off, and by the true one */
    double height;
    double inverse[3][3];  /* (6 pi Z - K)^-1 */
    double rotlet;         /* 1/(8 pi h^3 + max C) */
    double s, tau;
    double e1, e2;         /* E = e1 - e2 rho */
    double squeeze, shear; /* 12 pi S^3/(tau gap) screened, 2 pi S L */
    double near;           /* l/(l + gap), l = p (tau/(2 S))^(3/2) */
    double close;          /* p/h */
    double log_tail;       /* L */
    double arm[3];         /* -b/p: the nearest point */
    int regular; /* has Z an inverse? */
} plane_geometry;

/* Their change with normal and height. */
typedef struct plane_change
{
    double m[3], b[3], support2, support, gap, height, rotlet;
    double e1, e2, squeeze, shear, arm[3];
} plane_change;

/*
    The gap g is cut off at e: g above 2 e, e + g^2/(4 e) below, e if negative;
    smooth to the first derivative.
*/
static double cut_off(double gap, double least, double *slope)
{
    if (gap >= 2 * least)
    {
        *slope = 1;
        return gap;
    }
    *slope = gap > 0 ? 0.5 * gap / least : 0;
    return least + 0.5 * *slope * fmax(gap, 0);
}

/* The terms of log(1/(1 - s)) from s^4/4 on. */
static double log_tail(double s, double rest)
{
    return -log(rest) - s * (1 + s * (0.5 + s / 3));
}

/* Z with W^-1 = 16/9 - 8/9 n n and Q of the ellipsoid: see docs/theory.md. 0 if
   it cannot be inverted. */
static int set_far(plane_geometry *g)
{
    const double *k = g->model->resistance, *c = g->model->rotation_resistance;
    const double h = g->height;
    double z[3][3];

    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            const double mm = g->m[i] * g->m[j];
            const double same = i == j;
            const double y = (20 * g->trace - 36 * g->support2) * same
                           + 8 * g->square[i] * same + 32 * g->support2 * mm
                           - 16 * (g->m[i] * g->b[j] + g->b[i] * g->m[j]);

            z[i][j] = 6 * pi * (h * (16 * same - 8 * mm) / 9 + y / (81 * h))
                    - k[i] * same;
        }
    }
    g->rotlet = 1 / (8 * pi * h * h * h + fmax(c[0], fmax(c[1], c[2])));
    return ellipsoid_invert3(z, g->inverse);
}

static void set_geometry(const ellipsoid_model *model, const double normal[3],
                         double height, plane_geometry *g)
{
    const double *a = model->options.semi_axes;
    double bb, ratio, length, g2;

    g->model = model;
    ellipsoid_copy(normal, g->m);
    ellipsoid_set(g->square, a[0] * a[0], a[1] * a[1], a[2] * a[2]);
    g->trace = ellipsoid_sum(g->square);
    for (int i = 0; i < 3; i++)
    {
        g->b[i] = g->square[i] * g->m[i];
    }
    g->support2 = ellipsoid_dot(g->m, g->b);
    g->support = sqrt(g->support2);
    g->gap = cut_off(height - g->support, model->options.lubrication_gap,
                     &g->gap_slope);
    g->height = g->support + g->gap;
    ellipsoid_set(g->arm, -g->b[0] / g->support, -g->b[1] / g->support,
                  -g->b[2] / g->support);
    g->regular = set_far(g);

    bb = ellipsoid_dot(g->b, g->b);
    g->s = a[0] * a[1] * a[2] / g->support2;
    g->tau = (g->trace - bb / g->support2) / g->support;
    g2 = g->s * g->s;
    g->e1 = 12 * (2 * g->tau * g->tau + g2) / (6 * g->tau * g->tau + g2);
    g->e2 = 24 * g->tau / (6 * g->tau * g->tau + g2);
    ratio = 0.5 * g->tau / g->s;
    length = g->support * ratio * sqrt(ratio);
    g->near = length / (length + g->gap);
    g->squeeze = 12 * pi * g2 * g->s / (g->tau * g->gap) * g->near * g->near
               * g->near;
    g->close = g->support / g->height;
    g->log_tail = log_tail(g->close, g->gap / g->height);
    g->shear = 2 * pi * g->s * g->log_tail;
}

/* The change with the normal's component n, or with the height, n = 3. */
static plane_change change_of(const plane_geometry *g, int n)
{
    plane_change d = {.height = 0};
    const double bb = ellipsoid_dot(g->b, g->b), p = g->support;
    const double g2 = g->s * g->s;
    const double lower = 6 * g->tau * g->tau + g2;
    double s, tau, close, near, tail, of_g2, of_lower;

    if (n < 3)
    {
        d.m[n] = 1;
        d.b[n] = g->square[n];
    }
    d.support2 = n < 3 ? 2 * g->b[n] : 0;
    d.support = 0.5 * d.support2 / p;
    d.gap = g->gap_slope * ((n == 3) - d.support);
    d.height = d.support + d.gap;
    for (int i = 0; i < 3; i++)
    {
        d.arm[i] = -(d.b[i] + g->arm[i] * d.support) / p;
    }
    d.rotlet = -24 * pi * g->height * g->height * d.height * g->rotlet
             * g->rotlet;

    s = -g->s * d.support2 / g->support2;
    tau = (bb * d.support2 / g->support2 - 2 * ellipsoid_dot(g->b, d.b))
            / (g->support2 * p)
        - g->tau * d.support / p;
    of_g2 = 2 * g->s * s;
    of_lower = 12 * g->tau * tau + of_g2;
    d.e1 = (12 * (4 * g->tau * tau + of_g2) - g->e1 * of_lower) / lower;
    d.e2 = (24 * tau - g->e2 * of_lower) / lower;
    /* of near over near, as 1 - near = gap/(l + gap) */
    near = (1 - g->near)
         * (d.support / p + 1.5 * (tau / g->tau - s / g->s) - d.gap / g->gap);
    d.squeeze = g->squeeze
              * (3 * s / g->s - tau / g->tau - d.gap / g->gap + 3 * near);
    close = (d.support - g->close * d.height) / g->height;
    tail = g->close * g->close * g->close * g->height / g->gap * close;
    d.shear = 2 * pi * (s * g->log_tail + g->s * tail);
    return d;
}

/* rho v */
static void curved(const plane_geometry *g, const double v[3], double result[3])
{
    const double along = ellipsoid_dot(g->b, v) / g->support2;

    for (int i = 0; i < 3; i++)
    {
        result[i] = (g->square[i] * v[i] - g->b[i] * along) / g->support;
    }
}

/* (d rho) v */
static void curved_change(const plane_geometry *g, const plane_change *d,
                          const double v[3], const double rho_v[3],
                          double result[3])
{
    const double along = ellipsoid_dot(g->b, v) / g->support2;
    const double turned = ellipsoid_dot(d->b, v) / g->support2
                        - along * d->support2 / g->support2;

    for (int i = 0; i < 3; i++)
    {
        result[i] = -(d->b[i] * along + g->b[i] * turned
                      + rho_v[i] * d->support)
                  / g->support;
    }
}

/* One motion of the body, and what it makes. */
typedef struct response
{
    const double *omega;
    double at_surface[3], out, across[3]; /* u_s, u_n, u_t */
    double turning[3], wedge[3];          /* n x omega, v */
    double bent[3], raw[3];               /* rho v; E v */
    double pull[3], moment[3];             /* 2 pi S L E v; rho of it */
    double force[3];                      /* at the nearest point */
    double pushed[3], far[3];             /* K u; (6 pi Z - K)^-1 K u */
    double spun[3], along;                /* C omega; n.C omega */
} response;

static void respond(plane_geometry *g, const double rates[6], response *r)
{
    const double *k = g->model->resistance, *c = g->model->rotation_resistance;
    double rolled[3];

    r->omega = rates + 3;
    ellipsoid_cross(r->omega, g->arm, r->at_surface);
    ellipsoid_add(r->at_surface, rates);
    r->out = ellipsoid_dot(r->at_surface, g->m);
    ellipsoid_cross(g->m, r->omega, r->turning);
    curved(g, r->turning, rolled);
    for (int i = 0; i < 3; i++)
    {
        r->across[i] = r->at_surface[i] - r->out * g->m[i];
        r->wedge[i] = 0.5 * r->across[i] - rolled[i];
        r->pushed[i] = k[i] * rates[i];
        r->spun[i] = c[i] * r->omega[i];
    }
    curved(g, r->wedge, r->bent);
    for (int i = 0; i < 3; i++)
    {
        r->raw[i] = g->e1 * r->wedge[i] - g->e2 * r->bent[i];
        r->pull[i] = g->shear * r->raw[i];
        r->force[i] = g->squeeze * r->out * g->m[i] + g->shear * r->across[i]
                   + 0.5 * r->pull[i];
    }
    curved(g, r->pull, r->moment);
    ellipsoid_product(g->inverse, r->pushed, r->far);
    r->along = ellipsoid_dot(g->m, r->spun);
}

/* Force and torque. */
static void sum_up(const plane_geometry *g, const response *r, double action[6])
{
    const double *k = g->model->resistance, *c = g->model->rotation_resistance;
    double turning[3], rolling[3];

    ellipsoid_cross(g->arm, r->force, turning);
    ellipsoid_cross(g->m, r->moment, rolling);
    for (int i = 0; i < 3; i++)
    {
        action[i] = k[i] * r->far[i] + r->force[i];
        action[i + 3] = turning[i] + rolling[i]
                      + c[i] * g->rotlet
                            * (5 * r->spun[i] - 3 * r->along * g->m[i]) / 16;
    }
}

/* 6 pi (dZ) v */
static void far_change(const plane_geometry *g, const plane_change *d,
                       const double v[3], double result[3])
{
    const double h = g->height;
    const double mv = ellipsoid_dot(g->m, v), dmv = ellipsoid_dot(d->m, v);
    const double bv = ellipsoid_dot(g->b, v), dbv = ellipsoid_dot(d->b, v);

    for (int i = 0; i < 3; i++)
    {
        const double y = (20 * g->trace - 36 * g->support2) * v[i]
                       + 8 * g->square[i] * v[i]
                       + 32 * g->support2 * g->m[i] * mv
                       - 16 * (g->m[i] * bv + g->b[i] * mv);
        const double mixed = d->m[i] * mv + g->m[i] * dmv;
        const double dy = -36 * d->support2 * v[i]
                        + 32 * (d->support2 * g->m[i] * mv
                                + g->support2 * mixed)
                        - 16 * (d->m[i] * bv + g->m[i] * dbv + d->b[i] * mv
                                + g->b[i] * dmv);

        result[i] = 6 * pi
                  * (d->height * (16 * v[i] - 8 * g->m[i] * mv) / 9
                     - 8 * h * mixed / 9 + (dy - y * d->height / h) / (81 * h));
    }
}

static void respond_change(plane_geometry *g, const plane_change *d,
                           const response *r, double action[6])
{
    const double *k = g->model->resistance, *c = g->model->rotation_resistance;
    double at_surface[3], turning[3], rolled[3], more[3], wedge[3], across[3];
    double bent[3], pull[3], force[3], moment[3], far[3], turn[6][3];
    const double along = ellipsoid_dot(d->m, r->spun);
    double out;

    ellipsoid_cross(r->omega, d->arm, at_surface);
    out = ellipsoid_dot(at_surface, g->m) + ellipsoid_dot(r->at_surface, d->m);
    ellipsoid_cross(d->m, r->omega, turning);
    curved(g, turning, rolled);
    curved(g, r->turning, bent);
    curved_change(g, d, r->turning, bent, more);
    for (int i = 0; i < 3; i++)
    {
        across[i] = at_surface[i] - out * g->m[i] - r->out * d->m[i];
        wedge[i] = 0.5 * across[i] - rolled[i] - more[i];
    }
    curved(g, wedge, bent);
    curved_change(g, d, r->wedge, r->bent, more);
    for (int i = 0; i < 3; i++)
    {
        pull[i] = d->shear * r->raw[i]
                + g->shear
                      * (d->e1 * r->wedge[i] + g->e1 * wedge[i]
                         - d->e2 * r->bent[i] - g->e2 * (bent[i] + more[i]));
        force[i] = d->squeeze * r->out * g->m[i] + g->squeeze * out * g->m[i]
                 + g->squeeze * r->out * d->m[i] + d->shear * r->across[i]
                 + g->shear * across[i] + 0.5 * pull[i];
    }
    curved(g, pull, moment);
    curved_change(g, d, r->pull, r->moment, more);
    ellipsoid_add(moment, more);
    ellipsoid_cross(d->arm, r->force, turn[0]);
    ellipsoid_cross(g->arm, force, turn[1]);
    ellipsoid_cross(d->m, r->moment, turn[2]);
    ellipsoid_cross(g->m, moment, turn[3]);
    far_change(g, d, r->far, turn[4]);
    ellipsoid_product(g->inverse, turn[4], far);
    for (int i = 0; i < 3; i++)
    {
        action[i] = force[i] - k[i] * far[i];
        action[i + 3] =
            turn[0][i] + turn[1][i] + turn[2][i] + turn[3][i]
            + c[i] / 16
                  * (d->rotlet * (5 * r->spun[i] - 3 * r->along * g->m[i])
                     - 3 * g->rotlet * (along * g->m[i] + r->along * d->m[i]));
    }
}

/* Two unit vectors across the normal and each other. */
static void set_tangents(const double m[3], double tangent[2][3])
{
    const int k = fabs(m[0]) < fabs(m[1]) ? (fabs(m[0]) < fabs(m[2]) ? 0 : 2)
                                          : (fabs(m[1]) < fabs(m[2]) ? 1 : 2);
    const double axis[3] = {k == 0, k == 1, k == 2};
    double length;

    ellipsoid_cross(m, axis, tangent[0]);
    length = ellipsoid_length(tangent[0]);
    for (int i = 0; i < 3; i++)
    {
        tangent[0][i] /= length;
    }
    ellipsoid_cross(m, tangent[0], tangent[1]);
}

/* Lubrication, in which with P y = u_s the matrix of a dissipation is P^T ... P
   and so a sum of products of rows, along n and two tangents t. */
static void add_near(const plane_geometry *g, double matrix[6][6])
{
    double tangent[2][3], out[6], across[2][6], wedge[2][6], pull[2][6];
    double bent[2][3], mixed;

    set_tangents(g->m, tangent);
    ellipsoid_copy(g->m, out);
    ellipsoid_cross(g->arm, g->m, out + 3);
    for (int a = 0; a < 2; a++)
    {
        double turning[3];

        ellipsoid_copy(tangent[a], across[a]);
        ellipsoid_cross(g->arm, tangent[a], across[a] + 3);
        curved(g, tangent[a], bent[a]);
        ellipsoid_cross(g->m, bent[a], turning);
        for (int i = 0; i < 3; i++)
        {
            wedge[a][i] = 0.5 * across[a][i];
            wedge[a][i + 3] = 0.5 * across[a][i + 3] + turning[i];
        }
    }
    mixed = -g->e2 * ellipsoid_dot(tangent[0], bent[1]);
    for (int a = 0; a < 2; a++)
    {
        const double own = g->e1 - g->e2 * ellipsoid_dot(tangent[a], bent[a]);

        for (int i = 0; i < 6; i++)
        {
            pull[a][i] =
                g->shear * (own * wedge[a][i] + mixed * wedge[1 - a][i]);
        }
    }
    for (int i = 0; i < 6; i++)
    {
        const double squeezed = g->squeeze * out[i];
        const double sheared[2] = {g->shear * across[0][i],
                                   g->shear * across[1][i]};

        for (int j = 0; j < 6; j++)
        {
            matrix[i][j] += squeezed * out[j] + sheared[0] * across[0][j]
                          + sheared[1] * across[1][j]
                          + wedge[0][i] * pull[0][j] + wedge[1][i] * pull[1][j];
        }
    }
}

int ellipsoid_plane_matrix(const ellipsoid_model *model,
                           const double normal[3], double height,
                           double matrix[6][6])
{
    const double *k = model->resistance, *c = model->rotation_resistance;
    plane_geometry g;

    set_geometry(model, normal, height, &g);
    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            matrix[i][j] = k[i] * g.inverse[i][j] * k[j];
            matrix[i][j + 3] = matrix[i + 3][j] = 0;
            matrix[i + 3][j + 3] =
                c[i] * g.rotlet * c[j] * (5 * (i == j) - 3 * g.m[i] * g.m[j])
                / 16;
        }
    }
    add_near(&g, matrix);
    return g.regular;
}

int ellipsoid_plane_resistance(const ellipsoid_model *model,
                               const double normal[3], double height,
                               const double rates[6], double action[6],
                               double change[4][6])
{
    plane_geometry g;
    response r;

    set_geometry(model, normal, height, &g);
    respond(&g, rates, &r);
    sum_up(&g, &r, action);
    for (int n = 0; change && n < 4; n++)
    {
        const plane_change d = change_of(&g, n);

        respond_change(&g, &d, &r, change[n]);
    }
    return g.regular;
}
