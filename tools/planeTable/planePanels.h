/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    planePanels.h - panels of the spheroid's surface, and their integrals, for
    planeSolver.c.
*/
#ifndef PLANE_PANELS_H
#define PLANE_PANELS_H

#include "planeSolver.h"

#define MAX_NODES 12 /* of a panel along a side */

static const double pi = 3.14159265358979323846;

/* A panel or a piece of it. */
typedef struct piece
{
    double s0, s1, phi0, phi1;
} piece;

/* Everything that one case needs. */
typedef struct solver
{
    plane_mesh mesh;
    double width, stretch;        /* psi = width sinh(stretch s), s to 1 */
    double centre[3], axes[3][3]; /* A times the directions of psi and phi */
    double gauss[MAX_NODES], weight[MAX_NODES], barycentric[MAX_NODES];
    double point[MAX_NODES], part[MAX_NODES]; /* of a piece, with its weight */
    int count;         /* nodes, each with three components */
    double *matrix[2]; /* in and across the plane of symmetry */
    double target[3];  /* where the row's velocity is */
    int mirrored;      /* is the piece on the other side? */
    piece panel;
    double sum[MAX_NODES * MAX_NODES][3][3]; /* over it, by node */
} solver;

/* Sets all but count, matrix and what a row changes, for the mesh that is set. */
void plane_set_geometry(solver *v, const plane_case *c);

/* The surface at (s, phi), and the solid angle over ds dphi. */
double plane_place(const solver *v, double s, double phi, double x[3]);

/* The place of node k, l of a panel. */
void plane_node_at(const solver *v, int ring, int sector, int k, int l,
                   double *s, double *phi);

/* The columns of one panel in the rows of one node; own: is it of the panel? */
void plane_add_panel(solver *v, int row, int ring, int sector, int own,
                     double s, double phi);

#endif
