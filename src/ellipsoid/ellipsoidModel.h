/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    ellipsoidModel.h - statuses, the options of a body and of what acts on it,
    and the model that is computed from them. Programs include ellipsoid.h,
    which includes this header.
*/
#ifndef ELLIPSOID_MODEL_H
#define ELLIPSOID_MODEL_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The version is defined here only. A minor version adds declarations to the
   public headers; a major one may change them (semver.org). Below 1.0 any
   version may change them. */
#define ELLIPSOID_VERSION_MAJOR 0
#define ELLIPSOID_VERSION_MINOR 1
#define ELLIPSOID_VERSION_PATCH 0

#define ELLIPSOID_QUOTED(x) #x
#define ELLIPSOID_DOTTED(a, b, c)                                              \
    ELLIPSOID_QUOTED(a) "." ELLIPSOID_QUOTED(b) "." ELLIPSOID_QUOTED(c)
#define ELLIPSOID_VERSION                                                      \
    ELLIPSOID_DOTTED(ELLIPSOID_VERSION_MAJOR, ELLIPSOID_VERSION_MINOR,         \
                     ELLIPSOID_VERSION_PATCH)

/* ELLIPSOID_VERSION of the library, which may differ from that of the
   header. */
const char *ellipsoid_version(void);

/* -------------------------------------------------------------- status */

/* All statuses with their texts. */
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

/* The name of a status without the prefix, such as "OUTSIDE"; never NULL. */
const char *ellipsoid_status_name(ellipsoid_status status);

/* ------------------------------------------------------------- options */

/*
    The types of options that are one of several words: ellipsoid_motion,
    ellipsoid_flow_at, ellipsoid_wall_resistance, ellipsoid_pressure_gradient,
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
    All options: those of the body, the fluid, the forces, contact and
    integration. Start from ellipsoid_options_default(). The struct may be
    copied. options.def lists the members, each with its unit, default, range,
    meaning and frame.
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

/* The type of an option's member. */
typedef enum ellipsoid_option_type
{
    ELLIPSOID_OPTION_REAL,   /* double */
    ELLIPSOID_OPTION_VECTOR, /* double[3] */
    ELLIPSOID_OPTION_WHOLE,  /* int */
    ELLIPSOID_OPTION_SWITCH, /* int, 0 or 1 */
    ELLIPSOID_OPTION_CHOICE  /* enumeration: 0 to number of words minus 1 */
} ellipsoid_option_type;

/* The entry of one option in options.def. */
typedef struct ellipsoid_option
{
    ellipsoid_option_type type;
    size_t offset;            /* [bytes] of the member in ellipsoid_options */
    const char *member;       /* its name */
    const char *section;      /* of the dictionary; "" for its top level */
    const char *entry;        /* keyword in that section */
    const char *unit;         /* "" for none */
    const char *default_text; /* as it is written in options.def */
    const char *range;        /* text of the allowed values */
    const char *meaning;
    const char *const *words; /* of a CHOICE, terminated by NULL; else NULL */
    double low, high;         /* limits of the range, for each component */
    int above;                /* 1: low itself is not allowed */
    int related;              /* 1: other options narrow the range */
    int needs; /* index of another option in the list: the range is checked only
                  if that option is not 0; -1: it is always checked */
} ellipsoid_option;

/* All options, in the order of options.def; *count is set to their number. */
const ellipsoid_option *ellipsoid_option_list(int *count);

/*
    Returns OK or BAD_OPTION. For BAD_OPTION, *field is the name of the member
    that is out of range, and *range lists the allowed values in the words of
    the dictionary. Both are static strings, and both pointers may be NULL.
*/
ellipsoid_status ellipsoid_options_check(const ellipsoid_options *options,
                                         const char **field,
                                         const char **range);

/*
    The options of a cell with another length 2 a2 and width 2 a1 [m]. a3 and
    the bead radius keep their ratio to a1. Rings of beads are added if the
    beads would otherwise lie farther apart, in units of their radius. The
    result is not checked.
*/
ellipsoid_options ellipsoid_options_resized(const ellipsoid_options *options,
                                            double length, double width);

/* --------------------------------------------------------------- model */

/* The effect of a plane wall on the spheroid that represents a body's shape
   (drag/planeFunctions.c). */
#define ELLIPSOID_PLANE_TILTS 9
#define ELLIPSOID_PLANE_GAPS 8
#define ELLIPSOID_PLANE_FUNCTIONS 18

typedef struct ellipsoid_plane_table
{
    int axis;       /* the body axis along the axis of the spheroid */
    double radius;  /* [m] semi-axis across this axis */
    double ratio;   /* [-] semi-axis along this axis, divided by radius */
    double free[4]; /* resistance far from walls, with lengths in units of
                       radius */
    double at[ELLIPSOID_PLANE_TILTS][ELLIPSOID_PLANE_GAPS]
             [ELLIPSOID_PLANE_FUNCTIONS]; /* coefficients */
} ellipsoid_plane_table;

/* Quantities that are computed once from the options; read-only afterwards. */
typedef struct ellipsoid_model
{
    ellipsoid_options options;
    double volume;                 /* [m3] V = 4/3 pi a1 a2 a3 */
    double mass;                   /* [kg] m_p */
    double fluid_mass;             /* [kg] m_f, of the displaced fluid */
    double viscosity;              /* [Pa s] mu = rho_f nu, dynamic */
    double inertia[3];             /* [kg m2] body axes */
    double constant_force[3];      /* [N] lab: (m_p - m_f) g + external_force */
    double resistance[3];          /* [m] K^_i: F = mu R K^ R^T (u_f - u) */
    double rotation_resistance[3]; /* [m3] C_i = c_i (a_j^2 + a_k^2) / mu:
                                      T^_i = mu C_i (W^_i - w^_i + ...) */
    double strain_factor[3];     /* [-] (a_j^2 - a_k^2)/(a_j^2 + a_k^2), cyclic:
                               T^_1 = mu C_1 (s_1 e^23 + W^_1 - w^_1) */
    double mobility[3];          /* [s/kg] 1/(mu K^_i) */
    double rotation_mobility[3]; /* [1/(J s)] 1/(mu C_i) */
    double relaxation_time;      /* [s] longest of translation, m/(mu K^) */
    double rotation_relaxation_time; /* [s] longest, I/(mu C) */
    double noise_force[3];    /* [N] body, standard deviation of a component */
    double noise_torque[3];   /* [N m] the same of the torque */
    int electric, has_dipole; /* 1: E acts on charge or dipole; on a dipole */
    int dissipative;          /* 1: contact forces depend on velocities */
    double wall_range; /* [m] distance from the centre up to which walls act on
                          the drag; 0: they do not act */
    ellipsoid_plane_table plane; /* set if wall_range is above 0 */
    double reach;    /* [m] largest distance of a contact surface from the
                        centre */
    int flow_points; /* their number; 0 unless FLOW_BODY */
    double flow_point[ELLIPSOID_MAX_FLOW_POINTS][3]; /* [m] body, on surface */
    double flow_weight[ELLIPSOID_MAX_FLOW_POINTS];   /* [-] they add up to 1 */
    int bead_count;
    double bead[ELLIPSOID_MAX_BEADS][3]; /* [m] body frame, bead centres */
} ellipsoid_model;

/* The distance from the centre of a body with these options up to which walls
   act on its drag [m]; 0: they do not act. */
double ellipsoid_wall_range(const ellipsoid_options *options);

/* Size of a model [bytes], for languages that do not read this header. */
size_t ellipsoid_model_size(void);

/* Checks the options and computes the model. On failure *model is unchanged. */
ellipsoid_status ellipsoid_model_init(ellipsoid_model *model,
                                      const ellipsoid_options *options);

/*
    Translation and rotation coefficients of an ellipsoid with any three
    semi-axes [m] in Stokes flow: K^ [m] and C [m3] as in ellipsoid_model. For a
    sphere of radius a they are K^ = 6 pi a and C = 8 pi a^3.
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
