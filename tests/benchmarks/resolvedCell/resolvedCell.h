/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    resolvedCell.h - a rigid ellipsoid among walls by boundary elements, see
    resolvedCell.c. Lengths in micrometres, viscosity 1.
*/
#ifndef RESOLVED_CELL_H
#define RESOLVED_CELL_H

#include "body/vectors.h"

typedef struct triangle
{
    double v[3][3];
    double middle[3], area, size;
    double at[3]; /* the middle, on the body's surface */
} triangle;

typedef struct mesh
{
    triangle *at;
    int count, room;
} mesh;

typedef struct resolved_cell
{
    double a[3], x[3], r[3][3]; /* semi-axes, centre, R(q) */
    double fine;
    mesh body, walls, given; /* given: walls as they are read */
    int size;                /* 3 times the panels */
    float *matrix;
} resolved_cell;

/* Reads the walls, `none`, `plane` for x3 = 0, or an ASCII STL, and cuts them and
   the body into panels. 0 if they cannot be read (panels.c). */
int resolved_cell_set(resolved_cell *cell, const char *walls);

double resolved_distance(const double a[3], const double b[3]);

/* Of a triangle with these corners; the longest edge, which begins at corner
   `edge` (panels.c). */
double resolved_area(double v[3][3]);
void resolved_middle(double v[3][3], double middle[3]);
double resolved_longest(double v[3][3], int *edge);

/* Puts a point onto the ellipsoid, along the line from the centre. */
void resolved_project(const resolved_cell *cell, double x[3]);

/* The matrix: velocities at the middles of panels, of a force of 1 on the unit
   of area of each (stokeslets.c). */
void resolved_matrix_set(resolved_cell *cell);

/* x with matrix x = b; how many steps that took, -1 if they did not converge
   (gmres.c). */
int resolved_solve(const resolved_cell *cell, const double *b, double *x);

#endif
