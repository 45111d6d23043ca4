/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    resolvedCell.c - a rigid ellipsoid among walls, resolved by boundary
    elements: a judge of what the models make of walls.

    A single layer of Stokeslets of constant strength on flat triangles of body
    and walls, collocated at their middles; walls beyond a radius of the centre
    are left out. Seven solutions, of six motions and of the held body in the
    flow that is there without it, give resistance and free motion.

    Usage: resolvedCell WALLS a1 a2 a3 x1 x2 x3 eps1 eps2 eps3 eta FINENESS [FLOW]
    Lengths in um, viscosity 1. WALLS: an ASCII STL of few large triangles,
    `plane` for x3 = 0, or `none`. FLOW: a file with lines `x1 x2 x3 u1 u2 u3`
    for the points that FLOW `-` prints; without it u = (x3, 0, 0). FINENESS is
    that of panels in parts of their usual size, 2 for tables, 1 to check them: the
    matrix grows as its inverse to the fourth power. Linear velocities come
    first, angular ones follow, both lab.
*/
#include "resolvedCell.h"

#include "body/body.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Force and torque about the centre, lab, on the fluid. */
static void wrench(const resolved_cell *p, const double *f, double sum[6])
{
    memset(sum, 0, 6 * sizeof(*sum));
    for (int k = 0; k < p->body.count; k++)
    {
        const triangle *t = &p->body.at[k];
        double d[3];

        for (int c = 0; c < 3; c++)
        {
            d[c] = t->at[c] - p->x[c];
            sum[c] += t->area * f[3 * k + c];
        }
        for (int c = 0; c < 3; c++)
        {
            const int i = (c + 1) % 3, j = (c + 2) % 3;

            sum[3 + c] += t->area * (d[i] * f[3 * k + j] - d[j] * f[3 * k + i]);
        }
    }
}

/* b of mode: six motions, and the flow as it is without the body. 0: the file has
   other points */
static int set_velocities(const resolved_cell *p, int mode, FILE *flow,
                          double *b)
{
    const int c = mode % 3, i = (c + 1) % 3, j = (c + 2) % 3;

    memset(b, 0, (size_t)p->size * sizeof(*b));
    for (int k = 0; k < p->body.count; k++)
    {
        const double *m = p->body.at[k].at;
        double *u = b + 3 * k, at[3];

        if (mode == 6 && flow)
        {
            if (fscanf(flow, "%lf %lf %lf %lf %lf %lf", at, at + 1, at + 2, u,
                       u + 1, u + 2)
                    != 6
                || resolved_distance(at, m) > 1e-4)
            {
                return 0;
            }
        }
        else if (mode == 6)
        {
            u[0] = m[2];
        }
        else if (mode < 3)
        {
            u[c] = 1;
        }
        else
        {
            u[j] = m[i] - p->x[i];
            u[i] = -(m[j] - p->x[j]);
        }
    }
    return 1;
}

/* Prints the resistance, the wrench on the held body, and the free motion. */
static int judge(resolved_cell *p, FILE *flow)
{
    double force[7][6], resistance[6][6], motion[6];
    double *b = calloc((size_t)p->size, sizeof(*b));
    double *x = calloc((size_t)p->size, sizeof(*x));
    int steps = 0;

    p->matrix = malloc((size_t)p->size * (size_t)p->size * sizeof(*p->matrix));
    if (!p->matrix || !b || !x)
    {
        fputs("no memory for so many panels\n", stderr);
        return 1;
    }
    resolved_matrix_set(p);
    for (int mode = 0; mode < 7; mode++)
    {
        if (!set_velocities(p, mode, flow, b))
        {
            fputs("the flow is not that at the points\n", stderr);
            return 1;
        }
        const int taken = resolved_solve(p, b, x);

        if (taken < 0)
        {
            fputs("GMRES did not converge\n", stderr);
            return 1;
        }
        steps += taken;
        wrench(p, x, force[mode]);
    }
    printf("# %d panels of the body, %d of walls, %d steps\n", p->body.count,
           p->walls.count, steps);
    for (int i = 0; i < 6; i++)
    {
        for (int j = 0; j < 6; j++)
        {
            resistance[i][j] = force[j][i];
            printf(" %12.5g", force[j][i]);
        }
        printf("  held %12.5g\n", force[6][i]);
    }
    if (!ellipsoid_invert6(resistance))
    {
        return 1;
    }
    for (int i = 0; i < 6; i++)
    {
        motion[i] = 0;
        for (int j = 0; j < 6; j++)
        {
            motion[i] += resistance[i][j] * force[6][j];
        }
    }
    printf("free %.6g %.6g %.6g  %.6g %.6g %.6g\n", motion[0], motion[1],
           motion[2], motion[3], motion[4], motion[5]);
    free(p->matrix);
    free(b);
    free(x);
    return 0;
}

int main(int argc, char **argv)
{
    resolved_cell p = {.fine = 1};
    const char *flow_name = argc > 13 ? argv[13] : NULL;
    double q[4];
    FILE *flow = NULL;
    int status;

    if (argc < 13)
    {
        fprintf(stderr,
                "usage: %s WALLS a1 a2 a3 x1 x2 x3 eps1 eps2 eps3 eta FINENESS "
                "[FLOW]\n",
                argv[0]);
        return 2;
    }
    for (int i = 0; i < 3; i++)
    {
        p.a[i] = atof(argv[2 + i]);
        p.x[i] = atof(argv[5 + i]);
    }
    for (int i = 0; i < 4; i++)
    {
        q[i] = atof(argv[8 + i]);
    }
    p.fine = atof(argv[12]);
    ellipsoid_rotation(q, p.r);
    if (!resolved_cell_set(&p, argv[1]))
    {
        fprintf(stderr, "cannot read walls from %s\n", argv[1]);
        return 1;
    }
    if (flow_name && strcmp(flow_name, "-") == 0)
    {
        for (int k = 0; k < p.body.count; k++)
        {
            const double *m = p.body.at[k].at;

            printf("%.9g %.9g %.9g\n", m[0], m[1], m[2]);
        }
        return 0;
    }
    if (flow_name && !(flow = fopen(flow_name, "r")))
    {
        perror(flow_name);
        return 1;
    }
    status = judge(&p, flow);
    if (flow)
    {
        fclose(flow);
    }
    free(p.given.at);
    free(p.body.at);
    free(p.walls.at);
    return status;
}
