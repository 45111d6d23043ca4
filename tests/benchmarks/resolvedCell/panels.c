/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    panels.c - body and walls as flat triangles, the smaller the nearer they are
    to one another.
*/
#include "resolvedCell.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double farthest = 12;  /* um of walls about the centre */
static const double coarsest = 0.4; /* um of panels of the body */
static const double finest = 0.04;  /* um */
static const double of_distance = 0.5;

double resolved_area(double v[3][3])
{
    double e[2][3], n[3];

    ellipsoid_difference(v[1], v[0], e[0]);
    ellipsoid_difference(v[2], v[0], e[1]);
    ellipsoid_cross(e[0], e[1], n);
    return 0.5 * ellipsoid_length(n);
}

void resolved_middle(double v[3][3], double middle[3])
{
    for (int c = 0; c < 3; c++)
    {
        middle[c] = (v[0][c] + v[1][c] + v[2][c]) / 3;
    }
}

double resolved_distance(const double a[3], const double b[3])
{
    double d[3];

    ellipsoid_difference(a, b, d);
    return ellipsoid_length(d);
}

double resolved_longest(double v[3][3], int *edge)
{
    double longest = 0;

    for (int i = 0; i < 3; i++)
    {
        const double length = resolved_distance(v[i], v[(i + 1) % 3]);

        if (length > longest)
        {
            longest = length;
            *edge = i;
        }
    }
    return longest;
}

static void add(mesh *m, double v[3][3])
{
    triangle *t;
    int edge;

    if (m->count == m->room)
    {
        m->room = 2 * m->room + 64;
        m->at = realloc(m->at, (size_t)m->room * sizeof(*m->at));
        if (!m->at)
        {
            exit(1);
        }
    }
    t = &m->at[m->count++];
    memcpy(t->v, v, sizeof(t->v));
    resolved_middle(v, t->middle);
    ellipsoid_copy(t->middle, t->at);
    t->area = resolved_area(v);
    t->size = resolved_longest(v, &edge);
}

/* The distance of a point from a triangle (Ericson 2005). */
static double from_triangle(const triangle *t, const double x[3])
{
    double e[2][3], d[3], n[3], best = HUGE_VAL;

    ellipsoid_difference(t->v[1], t->v[0], e[0]);
    ellipsoid_difference(t->v[2], t->v[0], e[1]);
    ellipsoid_difference(x, t->v[0], d);

    const double d00 = ellipsoid_dot(e[0], e[0]);
    const double d01 = ellipsoid_dot(e[0], e[1]);
    const double d11 = ellipsoid_dot(e[1], e[1]);
    const double d20 = ellipsoid_dot(d, e[0]), d21 = ellipsoid_dot(d, e[1]);
    const double denominator = d00 * d11 - d01 * d01;
    const double v = (d11 * d20 - d01 * d21) / denominator;
    const double w = (d00 * d21 - d01 * d20) / denominator;

    if (v >= 0 && w >= 0 && v + w <= 1)
    {
        for (int c = 0; c < 3; c++)
        {
            n[c] = d[c] - v * e[0][c] - w * e[1][c];
        }
        return ellipsoid_length(n);
    }
    for (int i = 0; i < 3; i++)
    {
        const double *from = t->v[i];
        double edge[3], to[3], part;

        ellipsoid_difference(t->v[(i + 1) % 3], from, edge);
        ellipsoid_difference(x, from, to);
        part = ellipsoid_dot(edge, to) / ellipsoid_dot(edge, edge);
        part = fmin(fmax(part, 0), 1);
        for (int c = 0; c < 3; c++)
        {
            to[c] -= part * edge[c];
        }
        best = fmin(best, ellipsoid_length(to));
    }
    return best;
}

static double from_mesh(const mesh *m, const double x[3])
{
    double least = HUGE_VAL;

    for (int i = 0; i < m->count; i++)
    {
        const double near =
            resolved_distance(x, m->at[i].middle) - m->at[i].size;

        if (near < least)
        {
            least = fmin(least, from_triangle(&m->at[i], x));
        }
    }
    return least;
}

/* Puts a point onto the ellipsoid, from the centre. */
void resolved_project(const resolved_cell *p, double x[3])
{
    double b[3], scale = 0;

    for (int i = 0; i < 3; i++)
    {
        b[i] = p->r[0][i] * (x[0] - p->x[0]) + p->r[1][i] * (x[1] - p->x[1])
             + p->r[2][i] * (x[2] - p->x[2]);
        scale += pow(b[i] / p->a[i], 2);
    }
    for (int c = 0; c < 3; c++)
    {
        x[c] = p->x[c] + (x[c] - p->x[c]) / sqrt(scale);
    }
}

/* Bisects the longest edges until they are as long as the distance allows. */
static void refine(const resolved_cell *p, double v[3][3], const mesh *other,
                   int body, mesh *to)
{
    double middle[3], most;
    int at = 0;
    const double longest = resolved_longest(v, &at);

    resolved_middle(v, middle);
    if (!body && resolved_distance(middle, p->x) - longest > farthest)
    {
        return;
    }
    most = of_distance * p->fine * from_mesh(other, middle);
    most = fmax(most, finest * p->fine);
    most = body ? fmin(most, coarsest * p->fine) : most;
    if (longest <= most)
    {
        if (body || resolved_distance(middle, p->x) < farthest)
        {
            add(to, v);
        }
        return;
    }
    double half[2][3][3], m[3];

    for (int c = 0; c < 3; c++)
    {
        m[c] = 0.5 * (v[at][c] + v[(at + 1) % 3][c]);
    }
    if (body)
    {
        resolved_project(p, m);
    }
    memcpy(half[0], v, sizeof(half[0]));
    memcpy(half[1], v, sizeof(half[1]));
    memcpy(half[0][(at + 1) % 3], m, sizeof(m));
    memcpy(half[1][at], m, sizeof(m));
    refine(p, half[0], other, body, to);
    refine(p, half[1], other, body, to);
}

static void add_octahedron(const resolved_cell *p, const mesh *other, mesh *to)
{
    for (int k = 0; k < 8; k++)
    {
        double v[3][3];

        for (int i = 0; i < 3; i++)
        {
            const double sign = k >> i & 1 ? -1 : 1;

            for (int c = 0; c < 3; c++)
            {
                v[i][c] = p->x[c] + sign * p->a[i] * p->r[c][i];
            }
        }
        refine(p, v, other, 1, to);
    }
}

static int read_walls(resolved_cell *p, const char *name)
{
    double plane[2][3][3] = {{{-60, -60, 0}, {60, -60, 0}, {60, 60, 0}},
                             {{-60, -60, 0}, {60, 60, 0}, {-60, 60, 0}}};
    double v[3][3];
    char word[256];
    int n = 0;
    FILE *file;

    if (strcmp(name, "none") == 0)
    {
        return 1;
    }
    if (strcmp(name, "plane") == 0)
    {
        add(&p->given, plane[0]);
        add(&p->given, plane[1]);
        return 1;
    }
    file = fopen(name, "r");
    while (file && fscanf(file, "%255s", word) == 1)
    {
        if (strcmp(word, "vertex") == 0
            && fscanf(file, "%lf %lf %lf", v[n], v[n] + 1, v[n] + 2) == 3
            && ++n == 3)
        {
            add(&p->given, v);
            n = 0;
        }
    }
    return file && fclose(file) == 0 && p->given.count > 0;
}

int resolved_cell_set(resolved_cell *p, const char *walls)
{
    if (!read_walls(p, walls))
    {
        return 0;
    }
    add_octahedron(p, &p->given, &p->body);
    for (int i = 0; i < p->given.count; i++)
    {
        refine(p, p->given.at[i].v, &p->body, 0, &p->walls);
    }
    for (int k = 0; k < p->body.count; k++)
    {
        resolved_project(p, p->body.at[k].at);
    }
    p->size = 3 * (p->body.count + p->walls.count);
    return 1;
}
