/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    fuzzWalls.c - walls of random shapes.
*/
#include "fuzzScene.h"

#include <math.h>
#include <string.h>

/* Where walls are, and how large */
static double read_place(double length, fuzz_input *in, double place[3])
{
    fuzz_vector(in, 3 * length, 3, place);
    return length * fuzz_scaled(in, 0.01, 4);
}

/* Triangles between few points, so that they share edges and corners; some
   points lie on a grid, so that triangles share planes or have no area. */
static void read_soup(wall_mesh *mesh, double length, fuzz_input *in)
{
    double point[10][3], place[3];
    const double size = read_place(length, in, place);
    const int points = 3 + fuzz_choice(in, 8), triangles = fuzz_choice(in, 16);
    const int on_grid = fuzz_choice(in, 2);

    for (int n = 0; n < points; n++)
    {
        fuzz_vector(in, 1, 3, point[n]);
        for (int i = 0; i < 3; i++)
        {
            point[n][i] = on_grid ? round(4 * point[n][i]) / 4 : point[n][i];
            point[n][i] = place[i] + size * point[n][i];
        }
    }
    for (int n = 0; n <= triangles; n++)
    {
        const int a = fuzz_choice(in, points), b = fuzz_choice(in, points);

        wall_mesh_triangle(mesh, point[a], point[b],
                           point[fuzz_choice(in, points)], n % 12);
    }
}

/* Many narrow triangles about one corner */
static void read_fan(wall_mesh *mesh, double length, fuzz_input *in)
{
    const int count = 3 + fuzz_choice(in, 120);
    const double width = length * fuzz_scaled(in, 1e-3, 3);
    const double height = length * fuzz_between(in, -2, 2);
    double apex[3], rim[2][3];

    fuzz_vector(in, length * fuzz_scaled(in, 0.02, 2), 3, apex);
    for (int n = 0; n <= count; n++)
    {
        const double angle = 2 * 3.14159265358979323846 * (n % count) / count;

        memcpy(rim[0], rim[1], sizeof rim[0]);
        rim[1][0] = apex[0] + width * cos(angle);
        rim[1][1] = apex[1] + width * sin(angle);
        rim[1][2] = apex[2] + height;
        if (n > 0)
        {
            wall_mesh_triangle(mesh, apex, rim[0], rim[1], n % 12);
        }
    }
}

static void read_box(wall_mesh *mesh, double length, fuzz_input *in)
{
    double low[3], high[3];

    for (int i = 0; i < 3; i++)
    {
        low[i] = -length * fuzz_scaled(in, 1e-2, 4);
        high[i] = length * fuzz_scaled(in, 1e-2, 4);
    }
    wall_mesh_box(mesh, low, high, fuzz_choice(in, 2), fuzz_choice(in, 2), 7);
}

static void read_plane(wall_mesh *mesh, double length, fuzz_input *in)
{
    double corner[3], u[3], v[3];
    const double size = 2 * read_place(length, in, corner);
    const int nu = 1 + fuzz_choice(in, 8), nv = 1 + fuzz_choice(in, 8);

    fuzz_vector(in, size, 3, u);
    fuzz_vector(in, size, 3, v);
    for (int i = 0; i < 3; i++)
    {
        corner[i] -= (u[i] + v[i]) / 2;
    }
    wall_mesh_plane(mesh, corner, u, v, nu, nv, fuzz_choice(in, 3), 3);
}

int fuzz_walls_read(wall_mesh *mesh, double length, fuzz_input *in)
{
    const int kind = fuzz_choice(in, 6);

    switch (kind)
    {
    case 0:
        return 0;
    case 1:
        read_box(mesh, length, in);
        break;
    case 2:
        read_plane(mesh, length, in);
        break;
    case 3:
        read_fan(mesh, length, in);
        break;
    default:
        read_soup(mesh, length, in);
    }
    wall_mesh_finish(mesh);
    return 1;
}
