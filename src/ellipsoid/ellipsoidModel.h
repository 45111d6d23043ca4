/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    ellipsoidModel.h - what a body is and what acts on it: statuses, options,
    and the model made of them. A part of ellipsoid.h: include that.
*/
#ifndef ELLIPSOID_MODEL_H
#define ELLIPSOID_MODEL_H

#ifdef __cplusplus
extern "C" {
#endif

/* -------------------------------------------------------------- status */

/* Every status with its text, in one list. */
#define ELLIPSOID_STATUS_LIST(X)                                               \
    X(OK, "success")                                                           \
    X(STOPPED, "stopped by the observer")                                      \
    X(BAD_OPTION, "an option is outside its range")                            \
    X(NON_FINITE, "the flow or the walls gave a value that is not finite")     \
    X(FLOW_FAILED, "the flow or the field gave up at the cell's place")        \
    X(WALLS_FAILED, "the walls gave up at the cell's position")                \
    X(STEP_UNDERFLOW, "the step fell below the smallest step")                 \
    X(TOO_MANY_STEPS, "the number of steps is exhausted")                      \
    X(TOO_MANY_FACETS, "too many wall facets near one cell")                   \
    X(TOO_MANY_CELLS, "too many cells overlap in one group")

#define ELLIPSOID_STATUS_ENUM(name, text) ELLIPSOID_##name,
typedef enum ellipsoid_status
{
    ELLIPSOID_STATUS_LIST(ELLIPSOID_STATUS_ENUM)
    ELLIPSOID_STATUS_COUNT
} ellipsoid_status;
#undef ELLIPSOID_STATUS_ENUM

/* The text of a status; never NULL. */
const char *ellipsoid_status_text(ellipsoid_status status);

/* ------------------------------------------------------------- options */

/* What meets the walls. */
typedef enum ellipsoid_contact_shape
{
    ELLIPSOID_CONTACT_BEADS,    /* beads on the surface, as in the paper */
    ELLIPSOID_CONTACT_ELLIPSOID /* the ellipsoid itself */
} ellipsoid_contact_shape;

/* How the surface beads are laid out (docs/theory.md, "Contact"). */
typedef enum ellipsoid_bead_layout
{
    ELLIPSOID_BEADS_STAGGERED, /* centres on the ellipsoid shrunk by r_b */
    ELLIPSOID_BEADS_PAPER,     /* the paper's, literally, without duplicates */
    ELLIPSOID_BEADS_SURFACE    /* staggered, centres on the ellipsoid */
} ellipsoid_bead_layout;

/* The undisturbed flow's force on the fluid the body displaces. */
typedef enum ellipsoid_pressure_gradient
{
    ELLIPSOID_PRESSURE_NONE,
    ELLIPSOID_PRESSURE_DUDT, /* m_f (u_f . grad) u_f */
    ELLIPSOID_PRESSURE_GRADP /* -V grad p, for comparison only */
} ellipsoid_pressure_gradient;

/* Which equations are solved. */
typedef enum ellipsoid_motion
{
    ELLIPSOID_MOTION_INERTIAL,   /* thirteen: paper eqs. (1)-(4) */
    ELLIPSOID_MOTION_INERTIALESS /* seven: u and omega balance the forces */
} ellipsoid_motion;

/* Where the body meets the undisturbed flow. */
typedef enum ellipsoid_flow_at
{
    ELLIPSOID_FLOW_CENTRE, /* velocity and gradient there, as in the paper */
    ELLIPSOID_FLOW_BODY    /* velocity over the surface: Brenner (1964) */
} ellipsoid_flow_at;

/* What the resistance knows of walls (docs/theory.md, "Near walls"). */
typedef enum ellipsoid_wall_resistance
{
    ELLIPSOID_WALL_RESISTANCE_NONE, /* that of the free body, as in the paper */
    ELLIPSOID_WALL_RESISTANCE_PLANE /* planes at the walls' nearest places */
} ellipsoid_wall_resistance;

#define ELLIPSOID_MAX_FLOW_POINTS 50
#define ELLIPSOID_MAX_BEADS 256

/*
    Everything that says what body moves in what fluid under which forces.
    Copyable; start from ellipsoid_options_default().
*/
typedef struct ellipsoid_options
{
    /* body */
    double semi_axes[3]; /* [m] along x^1, x^2, x^3; (0.5, 2, 0.5)e-6 */
    double density;      /* [kg/m3] 1040 */

    /* fluid */
    double fluid_density;       /* [kg/m3] 997.5 */
    double kinematic_viscosity; /* [m2/s] 1e-6 */

    /* equations */
    ellipsoid_motion motion; /* INERTIAL; INERTIALESS needs drag */

    /* forces */
    int drag;         /* hydrodynamic force and torque, 1 */
    ellipsoid_flow_at flow_at; /* CENTRE */
    int flow_points;  /* of FLOW_BODY, 26; 6, 14, 26 or 50: exact for flows
                         that are polynomials of degree 3, 5, 7 or 11 (force),
                         one less (torque) */
    ellipsoid_wall_resistance wall_resistance; /* NONE; PLANE needs drag, and
                                                  no Brownian motion */
    double lubrication_gap; /* [m] smallest gap of lubrication, 20e-9; 1e-15 to
                               1e3 */
    double wall_range; /* [m] beyond which walls do not resist, fully within
                          half of it; 10e-6; from the largest semi-axis to
                          1e6 */
    int buoyancy;     /* (m_p - m_f) g, 1 */
    ellipsoid_pressure_gradient pressure_gradient; /* DUDT */
    double gravity[3];         /* [m/s2] lab, (0, 0, -9.81) */
    double external_force[3];  /* [N] lab, 0 */
    double external_torque[3]; /* [N m] body, 0 */
    double charge;             /* [C] effective charge: F_E = charge E, 0 */
    double dipole[3];          /* [C m] body: T_E = dipole x E, 0 */
    double electric_field[3];  /* [V/m] lab, uniform E, 0; added to that of the
                                  surroundings */

    /* Brownian motion; needs drag */
    int brownian;          /* random force and torque, 0 */
    double temperature;    /* [K] 298.15; 0 to 1e5 */
    double noise_interval; /* [s] over which they are constant in the body
                              frame; 1e-3; 1e-15 to 1e6 */

    /* contact */
    int contact;              /* with wall facets, 1 */
    ellipsoid_contact_shape contact_shape; /* BEADS */
    ellipsoid_bead_layout bead_layout; /* STAGGERED */
    int bead_count;           /* 32; 1 to ELLIPSOID_MAX_BEADS */
    double bead_radius;       /* [m] 0.285e-6; below the smallest semi-axis */
    double contact_modulus;   /* [Pa] effective modulus E*, 1e6 */
    double friction;          /* [-] Coulomb's coefficient, 0 to 100; 0 */
    double slip_speed;        /* [m/s] below which friction yields, 1e-5 */
    double contact_damping;   /* [s/m] Hunt and Crossley's factor, 0:
                                 restitution is 1 less this times the speed of
                                 impact */
    double adhesion;          /* [N] pull-off force of a contact, 0: none */
    double adhesion_range;    /* [m] beyond which it does not pull, 20e-9; up
                                 to bead_radius */

    /* integrator */
    double tolerance;    /* [-] local error: x against the largest semi-axis,
                            q against 1; 1e-6; 1e-14 to 1e-1 */
    double initial_step; /* [s] first step of a fresh controller; 0, which is
                            the default: it is chosen */
    double minimum_step; /* [s] 1e-18 */
    double maximum_step; /* [s] 1 */
    long maximum_steps;  /* per call of ellipsoid_advance, 10000000 */
} ellipsoid_options;

ellipsoid_options ellipsoid_options_default(void);

/*
    OK or BAD_OPTION. On BAD_OPTION, *field names the member at fault and
    *range its allowed range (static strings; both pointers may be NULL).
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

/* What follows from the options once and for all; read-only afterwards. */
typedef struct ellipsoid_model
{
    ellipsoid_options options;
    double volume;          /* [m3] V = 4/3 pi a1 a2 a3 */
    double mass;            /* [kg] m_p */
    double fluid_mass;      /* [kg] m_f, displaced */
    double viscosity;       /* [Pa s] mu = rho_f nu, dynamic */
    double inertia[3];      /* [kg m2] body axes */
    double constant_force[3]; /* [N] lab: (m_p - m_f) g and the external one */
    double resistance[3];   /* [m] K^_i: F = mu R K^ R^T (u_f - u) */
    double rotation_resistance[3]; /* [m3] C_i = c_i (a_j^2 + a_k^2) / mu:
                                      T^_i = mu C_i (W^_i - w^_i + ...) */
    double strain_factor[3]; /* [-] (a_j^2 - a_k^2)/(a_j^2 + a_k^2), cyclic:
                               T^_1 = mu C_1 (s_1 e^23 + W^_1 - w^_1) */
    double mobility[3];     /* [s/kg] 1/(mu K^_i) */
    double rotation_mobility[3]; /* [1/(J s)] 1/(mu C_i) */
    double relaxation_time;          /* [s] slowest translational m/(mu K^) */
    double rotation_relaxation_time; /* [s] slowest I/(mu C) */
    double noise_force[3];  /* [N] body, standard deviation of a component */
    double noise_torque[3]; /* [N m] likewise */
    int electric, aligned;  /* does a field act? On a dipole? */
    int dissipative;        /* do contacts depend on velocities? */
    double reach;           /* [m] farthest contact surface from the centre */
    int flow_points;        /* 0 unless FLOW_BODY */
    double flow_point[ELLIPSOID_MAX_FLOW_POINTS][3]; /* [m] body, on surface */
    double flow_weight[ELLIPSOID_MAX_FLOW_POINTS];   /* [-] they add up to 1 */
    int bead_count;
    double bead[ELLIPSOID_MAX_BEADS][3]; /* [m] body frame, bead centres */
} ellipsoid_model;

/* Checks the options and derives the model; *model is untouched on failure. */
ellipsoid_status ellipsoid_model_init(ellipsoid_model *model,
                                      const ellipsoid_options *options);

/*
    Translation and rotation coefficients of an ellipsoid of any three
    semi-axes [m] in Stokes flow: K^ [m] and C [m3] as in ellipsoid_model.
    Sphere of radius a: K^ = 6 pi a, C = 8 pi a^3.
*/
void ellipsoid_resistance(const double semi_axes[3],
                          double resistance[3],
                          double rotation_resistance[3]);

/* Carlson's symmetric integrals R_F(x,y,z) and R_D(x,y,z), to rounding. */
double ellipsoid_carlson_rf(double x, double y, double z);
double ellipsoid_carlson_rd(double x, double y, double z);

#ifdef __cplusplus
}
#endif

#endif
