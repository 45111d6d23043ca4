/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_sedimentation.c - ellipsoids that settle in fluid at rest, and that a
    fluid in motion takes along from rest.
*/
#include "coreTest.h"

/* ------------------------------------------------------ terminal velocity */

/*
    K^ = 6 pi b k of a spheroid with the semi-axis r b along its axis and k[0]
    along it, k[1] across: Clift, Grace & Weber, Bubbles, Drops and Particles
    (1978), table 4.1, from Oberbeck (1876) and Perrin (1934). In long double,
    as these and the next cancel.
*/
static void spheroid(long double r, double k[2])
{
    const long double s = r * r - 1, root = sqrtl(fabsl(s));
    const long double l =
        (r > 1 ? logl(r + root) : -acosl(r)) / (root * fabsl(s));

    k[0] = (double)(4 / (3 * (-r / s + (2 * r * r - 1) * l)));
    k[1] = (double)(8 / (3 * (r / s + (2 * r * r - 3) * l)));
}

/*
    K^ of any ellipsoid a1 > a2 > a3: Perrin (1934), with Legendre's F(p, k) and
    E(p, k), cos p = a3/a1, k^2 = (a1^2 - a2^2)/(a1^2 - a3^2) (Byrd & Friedman,
    Handbook of Elliptic Integrals (1971)), by Simpson's rule.
*/
static void triaxial(const double a[3], double friction[3])
{
    const int count = 20000;
    const long double s1 = (long double)a[0] * a[0];
    const long double s2 = (long double)a[1] * a[1];
    const long double s3 = (long double)a[2] * a[2];
    const long double root = sqrtl(s1 - s3), k2 = (s1 - s2) / (s1 - s3);
    const long double product = (long double)a[0] * a[1] * a[2];
    const long double phi = acosl((long double)a[2] / a[0]);
    long double f = 0, e = 0, alpha[3];

    for (int i = 0; i <= count; i++)
    {
        const long double x = sinl(phi * i / count), d = sqrtl(1 - k2 * x * x);
        const long double weight =
            (i % count == 0 ? 1 : 2 + 2 * (i % 2)) * phi / (3 * count);

        f += weight / d;
        e += weight * d;
    }
    /* the integral of 1/((a_i^2 + l) D) for l from 0 to infinity, with
       D^2 = (a1^2 + l)(a2^2 + l)(a3^2 + l); that of 1/D is 2 F/root */
    alpha[0] = 2 * (f - e) / ((s1 - s2) * root);
    alpha[2] = 2 * (s2 * root / product - e) / ((s2 - s3) * root);
    alpha[1] = 2 / product - alpha[0] - alpha[2];
    for (int i = 0; i < 3; i++)
    {
        friction[i] =
            (double)(16 * 3.14159265358979323846L
                     / (2 * f / root + alpha[i] * a[i] * (long double)a[i]));
    }
}

/* A body that settles in an oblique field of gravity. */
static ellipsoid_model heavy_body(const double axes[3], ellipsoid_motion motion)
{
    ellipsoid_options o = test_free_cell();

    memcpy(o.semi_axes, axes, sizeof(o.semi_axes));
    o.motion = motion;
    o.buoyancy = 1;
    o.gravity[0] = 3;
    o.gravity[1] = -2;
    o.gravity[2] = -9;
    o.tolerance = 1e-10;
    return test_model(&o);
}

/* u_i = (rho_p - rho_f) V g.r_i/(mu K^_i) along each body axis r_i; in the lab
   u and x_i = u_i (t - tau_i), long after rest, tau_i = m/(mu K^_i) or 0. */
static void settle(const ellipsoid_options *o, const double friction[3],
                   const double q[4], double t, int inertia, double u[3],
                   double x[3])
{
    const double *a = o->semi_axes;
    const double volume = 4 * test_pi / 3 * a[0] * a[1] * a[2];
    const double mu = o->fluid_density * o->kinematic_viscosity;
    const double excess = (o->density - o->fluid_density) * volume;
    double r[3][3];

    ellipsoid_rotation(q, r);
    u[0] = u[1] = u[2] = x[0] = x[1] = x[2] = 0;
    for (int i = 0; i < 3; i++)
    {
        const double axis[3] = {r[0][i], r[1][i], r[2][i]};
        const double resistance = mu * friction[i];
        const double along =
            excess * ellipsoid_dot(axis, o->gravity) / resistance;
        const double tau = inertia ? o->density * volume / resistance : 0;

        for (int k = 0; k < 3; k++)
        {
            u[k] += axis[k] * along;
            x[k] += axis[k] * along * (t - tau);
        }
    }
}

/*
    mu R K^ R^T u = (m_p - m_f) g: the body drifts sideways as it settles, and
    does not turn. In five orientations and by three ways: the balance of
    forces, motion without inertia, and from rest with inertia for 1e6
    relaxation times, after which nothing is left of the errors of the start.
    Rounding: 1e-14.
*/
static void check_settling(const double axes[3], const double friction[3],
                           const test_row *row)
{
    uint64_t seed = 1;
    test_quadratic still = {.answer = 0};
    const ellipsoid_surroundings around = {.flow = test_quadratic_flow,
                                           .flow_context = &still};

    for (int n = 0; n < 15; n++)
    {
        const int way = n % 3;
        const ellipsoid_model m =
            heavy_body(axes, way == 1 ? ELLIPSOID_MOTION_INERTIALESS
                                      : ELLIPSOID_MOTION_INERTIAL);
        const double end = way == 0 ? 0 : 1e6 * m.relaxation_time;
        ellipsoid_state s = {.u = {0}};
        ellipsoid_controller controller = {0};
        ellipsoid_statistics statistics = {0};
        double u[3], x[3], q[4], t = 0, size;

        test_orientation(&seed, q);
        memcpy(s.q, q, sizeof(s.q));
        if (way == 0)
        {
            assert_ok(ellipsoid_balance(&m, &around, &s, NULL));
        }
        assert_ok(
            test_advance(&m, &still, &s, &t, end, &controller, &statistics));
        settle(&m.options, friction, q, end, way == 2, u, x);
        size = ellipsoid_length(u);
        for (int k = 0; k < 3; k++)
        {
            assert_row(row, (s.u[k] - u[k]) / size, 0, 1e-14);
            assert_near(s.x[k], x[k], 1e-14 * size * end);
        }
        for (int k = 0; k < 4; k++)
        {
            assert_near(s.q[k], q[k], 1e-15);
        }
    }
}

static void test_spheroids(void **unused)
{
    static const test_row row = {
        "free motion",
        "error of the velocity of a spheroid that settles, over it",
        "aspect ratios 0.05 to 20, oblique; statics and both motions",
        "Clift, Grace & Weber (1978), table 4.1",
        "A",
        "rounding",
        0};
    static const double ratio[] = {0.05, 0.25, 0.5, 2, 4, 20};

    (void)unused;
    for (int n = 0; n < 6; n++)
    {
        const double b = 1e-6 / sqrt(ratio[n]), six = 6 * test_pi * b;
        const double axes[3] = {b, ratio[n] * b, b};
        double k[2], friction[3];

        spheroid(ratio[n], k);
        friction[0] = friction[2] = six * k[1];
        friction[1] = six * k[0];
        check_settling(axes, friction, &row);
    }
}

static void test_triaxial_body(void **unused)
{
    static const test_row row = {
        "free motion",
        "error of the velocity of a triaxial body that settles, over it",
        "three bodies, oblique; statics and both motions",
        "Perrin (1934)",
        "A",
        "rounding",
        0};
    static const double axes[][3] = {
        {4e-6, 2e-6, 1e-6}, {5e-6, 0.6e-6, 0.5e-6}, {3e-6, 2.9e-6, 0.1e-6}};

    (void)unused;
    for (int n = 0; n < 3; n++)
    {
        double friction[3];

        triaxial(axes[n], friction);
        check_settling(axes[n], friction, &row);
    }
}

/*
    The steepest drift: with friction k0 along and k1 across the axis, at the
    inclination tan(i) = sqrt(k1/k0) to gravity the velocity is at an angle d to
    it with sin(d) = |k1 - k0|/(k1 + k0); less at others. (19.5 degrees at most:
    k1/k0 < 2 for rods, and > 2/3 for discs.) To second order around it.
*/
static void test_steepest_drift(void **unused)
{
    static const test_row row = {
        "free motion",
        "error of the sine of the steepest drift",
        "spheroids that settle, aspect ratios 0.25 and 4",
        "|k1 - k0|/(k1 + k0), from Oberbeck (1876)",
        "A",
        "rounding",
        0};
    static const double ratio[] = {0.25, 4};
    test_quadratic still = {.answer = 0};
    const ellipsoid_surroundings around = {.flow = test_quadratic_flow,
                                           .flow_context = &still};

    (void)unused;
    for (int n = 0; n < 2; n++)
    {
        const double axes[3] = {1e-6, ratio[n] * 1e-6, 1e-6};
        const ellipsoid_model m = heavy_body(axes, ELLIPSOID_MOTION_INERTIAL);
        const double *g = m.options.gravity, size = ellipsoid_length(g);
        const double level = hypot(g[0], g[1]);
        double k[2], drift[3];

        spheroid(ratio[n], k);
        for (int i = 0; i < 3; i++)
        {
            const double tilt = atan(sqrt(k[1] / k[0])) + 1e-3 * (i - 1);
            double axis[3], across[3];
            ellipsoid_state s = {.u = {0}};

            /* gravity, turned by `tilt` in a vertical plane */
            for (int l = 0; l < 2; l++)
            {
                axis[l] = g[l] / size * cos(tilt)
                        - g[l] / level * g[2] / size * sin(tilt);
            }
            axis[2] = g[2] / size * cos(tilt) + level / size * sin(tilt);
            ellipsoid_quaternion_from_axis(axis, 0, s.q);
            assert_ok(ellipsoid_balance(&m, &around, &s, NULL));
            ellipsoid_cross(s.u, g, across);
            drift[i] =
                ellipsoid_length(across) / (ellipsoid_length(s.u) * size);
        }
        assert_row(&row, drift[1] - fabs(k[1] - k[0]) / (k[1] + k[0]), 0,
                   1e-13);
        assert_true(drift[0] < drift[1] && drift[2] < drift[1]);
        assert_true(drift[1] < 1.0 / 3);
    }
}

/* ---------------------------------------------------- relaxation from rest */

static const double sampling = 1e-8; /* [s] */

/* A body at rest in a fluid that streams and turns, and how the samples of it
   differ from what they should be. */
typedef struct relaxation
{
    ellipsoid_model model;
    double q[4];      /* orientation at the start */
    double stream[3]; /* [m/s] velocity of the fluid along the body's axes */
    double spin[3];   /* [rad/s] of the fluid about them: one of them only */
    int samples;      /* so far */
    double u, x, omega, q_error; /* the largest so far */
} relaxation;

/*
    m du/dt = mu K^ (u_f - u) along each axis, so 1 - u/u_f = exp(-t/tau), and
    I domega/dt = mu C (w_f - omega) likewise (K^ as above, C as checked in
    test_resistance.c).
*/
static void compare(relaxation *c, const ellipsoid_state *s, double t)
{
    const ellipsoid_model *m = &c->model;
    double r[3][3], u[3] = {0}, x[3] = {0}, turn[3];

    ellipsoid_rotation(c->q, r);
    for (int i = 0; i < 3; i++)
    {
        const double tau = m->mass / (m->viscosity * m->resistance[i]);
        const double slow =
            m->inertia[i] / (m->viscosity * m->rotation_resistance[i]);
        const double share = -expm1(-t / tau), turned = -expm1(-t / slow);

        for (int k = 0; k < 3; k++)
        {
            u[k] += r[k][i] * c->stream[i] * share;
            x[k] += r[k][i] * c->stream[i] * (t - tau * share);
        }
        c->omega = fmax(c->omega, fabs(s->omega[i] - c->spin[i] * turned));
        turn[i] = sin(c->spin[i] / 2 * (t - slow * turned));
    }
    for (int k = 0; k < 3; k++)
    {
        c->u = fmax(c->u, fabs(s->u[k] - u[k]));
        c->x = fmax(c->x, fabs(s->x[k] - x[k]));
    }
    /* the vector part of q_0^-1 q is sin(angle/2) about the axis */
    for (int i = 0; i < 3; i++)
    {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double part = c->q[3] * s->q[i] - s->q[3] * c->q[i]
                          - c->q[j] * s->q[k] + c->q[k] * s->q[j];

        c->q_error = fmax(c->q_error, fabs(part - turn[i]));
    }
}

static int sample(void *context, const ellipsoid_step *step)
{
    relaxation *c = context;

    for (; c->samples * sampling <= step->end; c->samples++)
    {
        ellipsoid_state s;

        ellipsoid_step_state(step, c->samples * sampling, &s);
        compare(c, &s, c->samples * sampling);
    }
    return 0;
}

/* The run, from rest: 3 us, more than ten relaxation times. */
static void relax(relaxation *c, const double axes[3], double tolerance)
{
    static const test_row speed = {
        "integration",
        "error of the velocity from rest, in tolerances a relaxation time",
        "301 samples of 3 us, tolerances 1e-6 to 1e-12",
        "1 - exp(-t/tau)",
        "A",
        "a step's error is the tolerance; old ones decay",
        0};
    static const test_row spinning = {
        "integration",
        "error of the spin from rest, in tolerances a relaxation time",
        "301 samples of 3 us, tolerances 1e-6 to 1e-12",
        "1 - exp(-t/tau)",
        "A",
        "a step's error is the tolerance; old ones decay",
        0};
    const double longest = fmax(axes[0], fmax(axes[1], axes[2]));
    ellipsoid_options o = test_free_cell();
    test_quadratic flow = {.answer = 0};
    const ellipsoid_surroundings around = {.flow = test_quadratic_flow,
                                           .flow_context = &flow};
    ellipsoid_state s = {.u = {0}};
    ellipsoid_controller controller = {0};
    ellipsoid_statistics statistics = {0};
    double r[3][3], spin[3], t = 0;

    memcpy(o.semi_axes, axes, sizeof(o.semi_axes));
    o.tolerance = tolerance;
    c->model = test_model(&o);
    ellipsoid_rotation(c->q, r);
    for (int i = 0; i < 3; i++)
    {
        flow.u[i] = ellipsoid_dot(r[i], c->stream);
        spin[i] = ellipsoid_dot(r[i], c->spin);
    }
    for (int i = 0; i < 3; i++)
    {
        const int j = (i + 1) % 3, k = (i + 2) % 3;

        flow.g[j][k] = -spin[i];
        flow.g[k][j] = spin[i];
    }
    memcpy(s.q, c->q, sizeof(s.q));
    assert_ok(ellipsoid_advance(&(ellipsoid_member){&c->model, &around, &s,
                                                    &controller, NULL, c,
                                                    &statistics},
                                &t, 3e-6, sample));
    assert_int_equal(c->samples, 301);
    assert_row(&speed, c->u * c->model.relaxation_time / (tolerance * longest),
               0, 2);
    assert_near(c->x, 0, 2 * tolerance * longest);
    assert_row(&spinning,
               c->omega * c->model.rotation_relaxation_time / tolerance, 0, 2);
    assert_near(c->q_error, 0, 2 * tolerance);
}

/*
    Along and about each axis in turn, and in an oblique stream that all three
    axes share in; 301 samples, 1e-8 s apart, of relaxations that take 0.1 us.
    A step's error may be the tolerance, times a for x, over the relaxation time
    for u and omega. Old errors decay, so that all samples keep within two.
*/
static void test_relaxation(void **unused)
{
    static const double axes[2][3] = {{0.5e-6, 2e-6, 0.5e-6},
                                      {1e-6, 2e-6, 0.5e-6}};
    uint64_t seed = 3;

    (void)unused;
    for (double tolerance = 1e-6; tolerance > 1e-13; tolerance /= 100)
    {
        for (int n = 0; n < 8; n++)
        {
            relaxation c = {.samples = 0};

            test_orientation(&seed, c.q);
            if (n % 4 == 3)
            {
                c.stream[0] = 4e-3;
                c.stream[1] = -3e-3;
                c.stream[2] = 1e-3;
            }
            else
            {
                c.stream[n % 4] = 4e-3;
                c.spin[n % 4] = 1000;
            }
            relax(&c, axes[n / 4], tolerance);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_spheroids),
        cmocka_unit_test(test_triaxial_body),
        cmocka_unit_test(test_steepest_drift),
        cmocka_unit_test(test_relaxation),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
