/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    ellipsoidModel.h - what a body is and what acts on it: statuses, options,
    and the model made of them. A part of ellipsoid.h: include that.
*/
#ifndef ELLIPSOID_MODEL_H
#define ELLIPSOID_MODEL_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The one place of the version. A minor one adds, a major one may change what is
   declared here and in ellipsoid.h (semver.org; below 1.0 any may). */
#define ELLIPSOID_VERSION_MAJOR 0
#define ELLIPSOID_VERSION_MINOR 1
#define ELLIPSOID_VERSION_PATCH 0

#define ELLIPSOID_QUOTED(x) #x
#define ELLIPSOID_DOTTED(a, b, c)                                              \
    ELLIPSOID_QUOTED(a) "." ELLIPSOID_QUOTED(b) "." ELLIPSOID_QUOTED(c)
#define ELLIPSOID_VERSION                                                      \
    ELLIPSOID_DOTTED(ELLIPSOID_VERSION_MAJOR, ELLIPSOID_VERSION_MINOR,         \
                     ELLIPSOID_VERSION_PATCH)

/* ELLIPSOID_VERSION of the library, which need not be that of the header. */
const char *ellipsoid_version(void);

/* -------------------------------------------------------------- status */

/* Every status with its text, in one list. */
#define ELLIPSOID_STATUS_LIST(X)                                               \
    X(OK, "success")                                                           \
    X(STOPPED, "stopped by the observer")                                      \
    X(BAD_OPTION, "an option is outside its range")                            \
    X(BAD_ARGUMENT, "an argument is NULL that must not be")                    \
    X(BAD_STATE, "the cell's state is not finite, or its quaternion is zero")  \
    X(OUTSIDE, "flow, field, force or walls do not know the cell's position")  \
    X(NON_FINITE, "the flow or the walls gave a value that is not finite")     \
    X(FLOW_FAILED, "the flow or the field gave up at the cell's place")        \
    X(FORCE_FAILED, "the external force gave up at the cell's position")       \
    X(WALLS_FAILED, "the walls gave up at the cell's position")                \
    X(STEP_UNDERFLOW, "the step fell below the smallest step")                 \
    X(TOO_MANY_STEPS, "the number of steps is exhausted")                      \
    X(TOO_MANY_FACETS, "too many wall facets near one cell")                   \
    X(TOO_MANY_CELLS, "too many cells overlap in one group")                   \
    X(BAD_TRIANGLE, "a wall triangle has no area, or a corner that is no "     \
                    "point")

#define ELLIPSOID_STATUS_ENUM(name, text) ELLIPSOID_##name,
typedef enum ellipsoid_status
{
    ELLIPSOID_STATUS_LIST(ELLIPSOID_STATUS_ENUM) ELLIPSOID_STATUS_COUNT
} ellipsoid_status;
#undef ELLIPSOID_STATUS_ENUM

/* The text of a status; never NULL. */
const char *ellipsoid_status_text(ellipsoid_status status);

/* Its name without the prefix, as "OUTSIDE"; never NULL. */
const char *ellipsoid_status_name(ellipsoid_status status);

/* ------------------------------------------------------------- options */

/*
    The enumerations among the options: ellipsoid_motion, ellipsoid_flow_at,
    ellipsoid_wall_resistance, ellipsoid_pressure_gradient,
    ellipsoid_contact_shape, ellipsoid_bead_layout. options.def says what each
    enumerator means.
*/
#define ELLIPSOID_WORDS(member, words)                                         \
    typedef enum ellipsoid_##member{words} ellipsoid_##member;
#define ELLIPSOID_WORD(enumerator, word, meaning) enumerator,
#include "options.def"

#define ELLIPSOID_MAX_FLOW_POINTS 12
#define ELLIPSOID_MAX_BEADS 256

/*
    Everything that says what body moves in what fluid under which forces.
    Copyable; start from ellipsoid_options_default(). options.def has the
    members, each with its unit, default, range, meaning and frame.
*/
typedef struct ellipsoid_options
{
#define ELLIPSOID_REAL(member, ...) double member;
#define ELLIPSOID_VECTOR(member, ...) double member[3];
#define ELLIPSOID_WHOLE(member, ...) int member;
#define ELLIPSOID_SWITCH(member, ...) int member;
#define ELLIPSOID_CHOICE(member, ...) ellipsoid_##member member;
#include "options.def"
} ellipsoid_options;

ellipsoid_options ellipsoid_options_default(void);

/* What kind of member an option is. */
typedef enum ellipsoid_option_type
{
    ELLIPSOID_OPTION_REAL,   /* double */
    ELLIPSOID_OPTION_VECTOR, /* double[3] */
    ELLIPSOID_OPTION_WHOLE,  /* int */
    ELLIPSOID_OPTION_SWITCH, /* int, 0 or 1 */
    ELLIPSOID_OPTION_CHOICE  /* enumeration, 0 to the number of words less 1 */
} ellipsoid_option_type;

/* What options.def says of one option. */
typedef struct ellipsoid_option
{
    ellipsoid_option_type type;
    size_t offset;            /* [bytes] of the member in ellipsoid_options */
    const char *member;       /* its name */
    const char *section;      /* of the dictionary; "" at its top */
    const char *entry;        /* keyword in that section */
    const char *unit;         /* "" for none */
    const char *default_text; /* as options.def writes it */
    const char *range;        /* text of what is allowed */
    const char *meaning;
    const char *const *words; /* of a CHOICE, ends with NULL; else NULL */
    double low, high;         /* ends of the range, of each component */
    int above;                /* 1: low itself is not allowed */
    int related;              /* 1: other options narrow the range */
    int needs; /* the range matters unless this option of the list is 0; or -1
                */
} ellipsoid_option;

/* All options in the order of options.def. */
const ellipsoid_option *ellipsoid_option_list(int *count);

/*
    OK or BAD_OPTION. On BAD_OPTION, *field names the member at fault and
    *range what is allowed, in the words of the dictionary (static strings;
    both pointers may be NULL).
*/
ellipsoid_status ellipsoid_options_check(const ellipsoid_options *options,
                                         const char **field,
                                         const char **range);

/*
    The options of a cell of another length 2 a2 and width 2 a1 [m], not
    checked: a3 and the bead radius keep their ratio to a1, and beads in rings
    become more where they would else lie farther apart, in their radii.
*/
ellipsoid_options ellipsoid_options_resized(const ellipsoid_options *options,
                                            double length, double width);

/* --------------------------------------------------------------- model */

/* What walls do to the spheroid of a body's shape (drag/planeFunctions.c). */
#define ELLIPSOID_PLANE_TILTS 9
#define ELLIPSOID_PLANE_GAPS 8
#define ELLIPSOID_PLANE_FUNCTIONS 18

typedef struct ellipsoid_plane_table
{
    int axis;       /* of the body: that of the spheroid */
    double radius;  /* [m] across it */
    double ratio;   /* [-] semi-axis along it, over that */
    double free[4]; /* resistance, lengths by radius */
    double at[ELLIPSOID_PLANE_TILTS][ELLIPSOID_PLANE_GAPS]
             [ELLIPSOID_PLANE_FUNCTIONS]; /* coefficients */
} ellipsoid_plane_table;

/* What follows from the options once and for all; read-only afterwards. */
typedef struct ellipsoid_model
{
    ellipsoid_options options;
    double volume;            /* [m3] V = 4/3 pi a1 a2 a3 */
    double mass;              /* [kg] m_p */
    double fluid_mass;        /* [kg] m_f, displaced */
    double viscosity;         /* [Pa s] mu = rho_f nu, dynamic */
    double inertia[3];        /* [kg m2] body axes */
    double constant_force[3]; /* [N] lab: (m_p - m_f) g and the external one */
    double resistance[3];     /* [m] K^_i: F = mu R K^ R^T (u_f - u) */
    double rotation_resistance[3]; /* [m3] C_i = c_i (a_j^2 + a_k^2) / mu:
                                      T^_i = mu C_i (W^_i - w^_i + ...) */
    double strain_factor[3];     /* [-] (a_j^2 - a_k^2)/(a_j^2 + a_k^2), cyclic:
                               T^_1 = mu C_1 (s_1 e^23 + W^_1 - w^_1) */
    double mobility[3];          /* [s/kg] 1/(mu K^_i) */
    double rotation_mobility[3]; /* [1/(J s)] 1/(mu C_i) */
    double relaxation_time;      /* [s] slowest translational m/(mu K^) */
    double rotation_relaxation_time; /* [s] slowest I/(mu C) */
    double noise_force[3];    /* [N] body, standard deviation of a component */
    double noise_torque[3];   /* [N m] likewise */
    int electric, has_dipole; /* does a field act? On a dipole? */
    int dissipative;          /* do contacts depend on velocities? */
    double wall_range; /* [m] how far walls act on the drag; 0: they do not */
    ellipsoid_plane_table plane; /* if they do */
    double reach;    /* [m] farthest contact surface from the centre */
    int flow_points; /* 0 unless FLOW_BODY */
    double flow_point[ELLIPSOID_MAX_FLOW_POINTS][3]; /* [m] body, on surface */
    double flow_weight[ELLIPSOID_MAX_FLOW_POINTS];   /* [-] they add up to 1 */
    int bead_count;
    double bead[ELLIPSOID_MAX_BEADS][3]; /* [m] body frame, bead centres */
} ellipsoid_model;

/* How far from a body of these options walls act on its drag [m]; 0: they do
   not. */
double ellipsoid_wall_range(const ellipsoid_options *options);

/* Bytes of a model, for languages that do not read this header. */
size_t ellipsoid_model_size(void);

/* Checks the options and derives the model; *model is untouched on failure. */
ellipsoid_status ellipsoid_model_init(ellipsoid_model *model,
                                      const ellipsoid_options *options);

/*
    Translation and rotation coefficients of an ellipsoid of any three
    semi-axes [m] in Stokes flow: K^ [m] and C [m3] as in ellipsoid_model.
    Sphere of radius a: K^ = 6 pi a, C = 8 pi a^3.
*/
void ellipsoid_resistance(const double semi_axes[3], double resistance[3],
                          double rotation_resistance[3]);

/* Carlson's symmetric integrals R_F(x,y,z) and R_D(x,y,z), to rounding. */
double ellipsoid_carlson_rf(double x, double y, double z);
double ellipsoid_carlson_rd(double x, double y, double z);

#ifdef __cplusplus
}
#endif

#endif
