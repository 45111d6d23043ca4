/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    fuzzScene.h - what surrounds a cell: a flow, an electric field and walls,
    each a pure function of the place, that may refuse an answer or give a wild
    one.
*/
#ifndef FUZZ_SCENE_H
#define FUZZ_SCENE_H

#include "fuzzInput.h"
#include "wallMesh.h"

typedef enum fuzz_fault_kind
{
    FUZZ_NO_FAULT,
    FUZZ_REFUSES,  /* answers with something else than 0 */
    FUZZ_GOES_WILD /* one of the numbers is wild */
} fuzz_fault_kind;

/* What goes wrong with a callback beyond a plane. */
typedef struct fuzz_fault
{
    fuzz_fault_kind kind;
    double normal[3], offset;
    int answer;
    size_t which; /* number, counted through the sample */
    double value;
} fuzz_fault;

typedef enum fuzz_flow_kind
{
    FUZZ_FLOW_NONE,
    FUZZ_FLOW_QUADRATIC,
    FUZZ_FLOW_WAVES,
    FUZZ_FLOW_NOISE /* finite numbers that have nothing to do with each other */
} fuzz_flow_kind;

/* u = amplitude sin(k.x + phase) */
typedef struct fuzz_wave
{
    double amplitude[3], k[3], phase;
} fuzz_wave;

typedef struct fuzz_scene
{
    ellipsoid_surroundings around; /* to be given to the core */
    double length, speed;          /* [m], [m/s] scales */

    fuzz_flow_kind flow;
    double u[3], g[3][3], h[3][3][3], p[3], pp[3][3]; /* Taylor's series */
    fuzz_wave wave[2];
    double e[3], ee[3][3];
    double f[3], ff[3][3]; /* of the external force and torque */
    int needs_pressure;
    fuzz_fault flow_fault, field_fault, force_fault, walls_fault;
    double shore[4]; /* beyond this plane velocities are the wall's, zero */

    wall_mesh mesh;
    int sound;    /* every facet has an area */
    int generous; /* list all facets, not only those asked for */

    /* set before a call of the core, read after it */
    int strict; /* places must be finite */
    int flow_gave_up, walls_gave_up, field_gave_up, force_gave_up;
    double sampled[3]; /* where the flow was last */
} fuzz_scene;

void fuzz_scene_read(fuzz_scene *scene, fuzz_input *in,
                     const ellipsoid_options *options);
void fuzz_scene_free(fuzz_scene *scene);

/* Add walls over about this length to a mesh, or none: is it finished? */
int fuzz_walls_read(wall_mesh *mesh, double length, fuzz_input *in);

/* Do the walls answer whenever they are asked, and with numbers? */
int fuzz_scene_has_faultless_walls(const fuzz_scene *scene);

/* Are flow and field smooth and do all answer? */
int fuzz_scene_is_tame(const fuzz_scene *scene);

#endif
