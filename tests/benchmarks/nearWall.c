/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    nearWall.c - a sphere in shear flow along a plane wall, and what the choices
    of drag make of it: flow centre or body, wallResistance none or plane.

    Exact values are those of Goldman, Cox & Brenner, Chem. Eng. Sci. 22: part I,
    637 (1967), table 2, a sphere that translates along a wall or turns; part II,
    653, table 1, one held in a shear flow. Free motion follows from these: no
    force, no torque.
*/
#include "wallMesh.h"
#include "walls/walls.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;
static const double radius = 1e-6, shear = 100; /* [m], [1/s] */

/* h/a; force and torque by translation, torque by rotation (part I); force and
   torque of the shear (part II): over 6 pi mu a U, 8 pi mu a^2 U, 8 pi mu a^3
   omega, 6 pi mu a h S, 4 pi mu a^3 S. */
static const struct known
{
    double height, force_u, torque_u, torque_omega, force_s, torque_s;
} known[] = {{3.7622, 1.1738, 4.21e-4, 1.0059, 1.1671, 0.99711},
             {2.3524, 1.3079, 2.6425e-3, 1.0250, 1.2780, 0.99010},
             {1.5431, 1.5675, 1.4649e-2, 1.0998, 1.4391, 0.97419},
             {1.1276, 2.1514, 7.3718e-2, 1.3877, 1.6160, 0.95374},
             {1.0453, 2.6475, 0.14552, 1.7006, 1.6682, 0.94769},
             {1.005004, 3.7863, 0.34187, 2.5056, 1.6969, 0.94442}};

/* Velocity over h S, angular velocity over S/2, force and torque when held, as
   above. */
typedef struct result
{
    double velocity, spin, force, torque;
} result;

static int shear_flow(void *context, double t, const double x[3],
                      int derivatives, ellipsoid_flow_sample *sample)
{
    (void)context;
    (void)t;
    (void)derivatives;
    sample->velocity[0] = shear * x[2];
    sample->gradient[0][2] = shear;
    sample->velocity_jacobian[0][2] = shear;
    return 0;
}

/* Force 6 pi mu a (h S f_s - U f_u + 4/3 a omega t_u) and torque 4 pi mu a^2
   (a S t_s + 2 U t_u - 2 a omega t_r) vanish. */
static result exact(const struct known *k)
{
    const double h = k->height, f_w = 4.0 / 3 * k->torque_u;
    const double determinant =
        k->force_u * 2 * k->torque_omega - f_w * 2 * k->torque_u;
    const double u = (h * k->force_s * 2 * k->torque_omega + f_w * k->torque_s)
                   / determinant;
    const double omega =
        (k->force_u * k->torque_s + 2 * k->torque_u * h * k->force_s)
        / determinant;

    return (result){u / h, 2 * omega, k->force_s, k->torque_s};
}

static result computed(const wall_mesh *mesh, double height,
                       ellipsoid_flow_at flow, ellipsoid_wall_resistance walls)
{
    static ellipsoid_facet_cache cache;
    const ellipsoid_surroundings around = {.flow = shear_flow,
                                           .walls = wall_mesh_list,
                                           .walls_context = (void *)mesh};
    const double h = height * radius;
    ellipsoid_options o = ellipsoid_options_default();
    ellipsoid_state state = {.x = {0, 0, h}, .q = {0, 0, 0, 1}};
    ellipsoid_state slope;
    ellipsoid_model m;
    result r;

    for (int i = 0; i < 3; i++)
    {
        o.semi_axes[i] = radius;
    }
    o.contact = 0;
    o.buoyancy = 0;
    o.pressure_gradient = ELLIPSOID_PRESSURE_NONE;
    o.flow_at = flow;
    o.wall_resistance = walls;
    o.wall_range = 30 * radius;
    o.lubrication_gap = 1e-4 * radius;
    ellipsoid_facet_cache_clear(&cache);
    if (ellipsoid_model_init(&m, &o) != ELLIPSOID_OK
        || ellipsoid_rhs(&m, &around, &state, &cache, &slope) != ELLIPSOID_OK
        || ellipsoid_balance(&m, &around, &state, &cache) != ELLIPSOID_OK)
    {
        exit(EXIT_FAILURE);
    }
    r.velocity = state.u[0] / (h * shear);
    r.spin = 2 * state.omega[1] / shear;
    r.force = m.mass * slope.u[0] / (6 * pi * m.viscosity * radius * h * shear);
    r.torque = m.inertia[1] * slope.omega[1]
             / (4 * pi * m.viscosity * pow(radius, 3) * shear);
    return r;
}

static void print(double gap, const char *name, result r)
{
    printf("| %.3g | %s | %.3f | %.3f | %.3f | %.3f |\n", gap, name, r.velocity,
           r.spin, r.force, r.torque);
}

int main(void)
{
    const double corner[3] = {-1e-4, -1e-4, 0};
    const double along[3] = {2e-4, 0, 0}, across[3] = {0, 2e-4, 0};
    wall_mesh mesh;

    wall_mesh_init(&mesh);
    wall_mesh_plane(&mesh, corner, along, across, 1, 1, 0, 0);
    wall_mesh_finish(&mesh);
    printf("| gap/a | | free: U/(h S) | 2 omega/S | held: force | torque |\n"
           "|---|---|---|---|---|---|\n");
    for (size_t n = 0; n < sizeof known / sizeof *known; n++)
    {
        const double h = known[n].height;

        print(h - 1, "exact", exact(&known[n]));
        print(h - 1, "`centre`, `none`",
              computed(&mesh, h, ELLIPSOID_FLOW_CENTRE,
                       ELLIPSOID_WALL_RESISTANCE_NONE));
        print(h - 1, "`body`, `none`",
              computed(&mesh, h, ELLIPSOID_FLOW_BODY,
                       ELLIPSOID_WALL_RESISTANCE_NONE));
        print(h - 1, "`centre`, `plane`",
              computed(&mesh, h, ELLIPSOID_FLOW_CENTRE,
                       ELLIPSOID_WALL_RESISTANCE_PLANE));
    }
    wall_mesh_free(&mesh);
    return 0;
}
