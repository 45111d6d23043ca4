/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    planeSolver.h - a rigid spheroid above a no-slip plane in Stokes flow, by
    boundary elements.
*/
#ifndef PLANE_SOLVER_H
#define PLANE_SOLVER_H

/* The spheroid has the equatorial radius 1 and the semi-axis `ratio` along its
   axis, which lies in the plane of x and z, at `tilt` [rad] to the plane's
   normal z and inclined to +x. */
typedef struct plane_case
{
    double ratio, tilt, gap;
} plane_case;

/* How fine: panels from the nearest point to the farthest and over half a turn;
   nodes of each along a side; points of quadrature of a piece along a side. */
typedef struct plane_mesh
{
    int rings, sectors, nodes, points; /* of the last two 12 at most */
} plane_mesh;

/*
    Force and torque about the centre over the viscosity. in: of a body with the
    velocities (Ux, Uz, Wy), force and torque that keep it so (Fx, Fz, Ty), and
    across: (Uy, Wx, Wz). shear_in: force and torque on the held body in the flow
    (z - z of the centre) e_x, (Fx, Fz, Ty); shear_across: likewise along e_y,
    (Fy, Tx, Tz). stagnation: in (x z, y z, -z^2), x and y from the centre, z from
    the plane, (Fx, Fz, Ty).
*/
typedef struct plane_functions
{
    double in[3][3], across[3][3];
    double shear_in[3], shear_across[3], stagnation[3];
    double asymmetry; /* largest difference of terms that should be equal, over
                         the root of the diagonal ones */
} plane_functions;

/* 1, or 0 if the matrix is singular or memory is short. */
int plane_solve(const plane_case *c, const plane_mesh *mesh,
                plane_functions *result);

/* Blake's tensor: the velocity at x by a unit force at y, both above the plane
   z = 0, times 8 pi times the viscosity. */
void plane_green(const double x[3], const double y[3], double g[3][3]);

#endif
