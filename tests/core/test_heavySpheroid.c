/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_heavySpheroid.c - spheroids with inertia leave Jeffery's orbits.

    The shear is u = (x2, 0, 0) [1/s], the viscosity 1, the longest semi-axis
    1 m: time is counted in units of the inverse shear rate. The Stokes number
    is that of Lundell & Carlsson, PRE 81, 016323 (2010), St = density shear
    b^2/mu with the longest semi-axis b.
*/
#include <complex.h>

#include "coreTest.h"

/* Its axis, x^2, has the ratio r to the other two. */
typedef struct spheroid
{
    ellipsoid_model model;
    double r;
    double shape; /* (r^2 - 1)/(r^2 + 1) */
    double kappa; /* moment of inertia about the axis over that across it */
    double tau;   /* [1/shear] relaxation time of the spin across the axis */
} spheroid;

static spheroid spheroid_of(double r, double stokes, double tolerance)
{
    ellipsoid_options o = test_free_cell();
    const double across = r > 1 ? 1 / r : 1, r2 = r * r;
    spheroid b = {.r = r, .shape = (r2 - 1) / (r2 + 1), .kappa = 2 / (r2 + 1)};

    o.semi_axes[0] = o.semi_axes[2] = across;
    o.semi_axes[1] = r * across;
    o.density = stokes;
    o.fluid_density = o.kinematic_viscosity = 1;
    o.pressure_gradient = ELLIPSOID_PRESSURE_NONE;
    o.tolerance = tolerance;
    b.model = test_model(&o);
    b.tau = b.model.inertia[0]
          / (b.model.viscosity * b.model.rotation_resistance[0]);
    return b;
}

/* The axis n and the part of the angular velocity across it, lab frame. */
static void axis_and_spin(const ellipsoid_state *s, double n[3], double spin[3])
{
    double r[3][3];

    ellipsoid_rotation(s->q, r);
    for (int i = 0; i < 3; i++)
    {
        n[i] = r[i][1];
        spin[i] = r[i][0] * s->omega[0] + r[i][2] * s->omega[2];
    }
}

static void advance(const spheroid *b, ellipsoid_state *s, double *t,
                    double end, ellipsoid_controller *controller)
{
    test_quadratic flow = test_shear(1);
    ellipsoid_statistics statistics = {0};

    assert_ok(
        test_advance(&b->model, &flow, s, t, end, controller, &statistics));
}

/* ------------------------------------------------------- about log-rolling */

/*
    Euler's equations of a spheroid with Jeffery's torque, linearised about
    log-rolling. Let n be the axis, W = (0, 0, -1/2) the fluid's rotation, E its
    strain, s the spin about n and O the rest of the angular velocity. Then
        dn/dt = O x n,  L = It O + Ia s n,
        dL/dt = It/tau (W - (W.n) n + shape n x E n - O) across n,
    and s = -1/2 but for second order. With n = (n1, n2, 1) to first order,
    kappa = Ia/It:
        n1' = O2,  n2' = -O1,
        O1' =  kappa/2 O2 + ((1 - shape)/2 n1 - O1)/tau,
        O2' = -kappa/2 O1 + ((1 + shape)/2 n2 - O2)/tau.
    A solution exp(z t) of these needs
        z^2 (1 + tau z)^2 + ((1 + tau kappa z)^2 - shape^2)/4 = 0,
    and as kappa = 1 - shape, z = -1/tau or
        tau z^3 + z^2 + tau kappa^2/4 z + kappa (1 + shape)/4 = 0:
    by Hurwitz' criterion stable if and only if kappa > 1 + shape, that is
    shape < 0, at any Stokes number. tau = 0: z = +-i r/(r^2 + 1), Jeffery's.
    Returns the largest real part.
*/
static double eigenvalues(const spheroid *b, double complex z[4])
{
    const double tau = b->tau, kappa = b->kappa;
    const double c[3] = {kappa * (1 + b->shape) / (4 * tau), kappa * kappa / 4,
                         1 / tau};

    /* Durand and Kerner's iteration, from its customary start */
    for (int n = 0; n < 3; n++)
    {
        z[n] = cpow(0.4 + 0.9 * I, n) / fmin(tau, 1);
    }
    for (int pass = 0; pass < 600; pass++)
    {
        const int n = pass % 3;

        z[n] -= (c[0] + z[n] * (c[1] + z[n] * (c[2] + z[n])))
              / ((z[n] - z[(n + 1) % 3]) * (z[n] - z[(n + 2) % 3]));
    }
    z[3] = -1 / tau;
    return fmax(fmax(creal(z[0]), creal(z[1])), fmax(creal(z[2]), creal(z[3])));
}

/*
    The share of such a solution in a state: the left eigenvector times (n1, n2,
    O1, O2). It follows exp(z t) whatever the other three do.
*/
static double complex share(const spheroid *b, double complex z,
                            const ellipsoid_state *s)
{
    const double complex along = 1 / (2 * b->tau * z);
    const double complex l3 = along * (1 + b->shape) + b->kappa / 2;
    const double complex l4 = -(z + 1 / b->tau);
    double n[3], spin[3];

    axis_and_spin(s, n, spin);
    return l3 * (along * (1 - b->shape) * n[0] + spin[0])
         + l4 * (along * (1 + b->shape) * n[1] + spin[1]);
}

/* The growth of a tilt of 1e-4 over `time`, measured. */
static double complex measured(const spheroid *b, double complex z, double time)
{
    const double tilted[3] = {8e-5, 6e-5, sqrt(1 - 1e-8)};
    ellipsoid_state s = {.omega = {0, -0.5, 0}};
    ellipsoid_controller controller = {0};
    double complex sum = 0, now;
    double t = 0;

    ellipsoid_quaternion_from_axis(tilted, 0, s.q);
    now = share(b, z, &s);
    for (int n = 1; n <= 40; n++) /* so that no turn is missed */
    {
        const double complex last = now;

        advance(b, &s, &t, time * n / 40, &controller);
        now = share(b, z, &s);
        sum += clog(now / last);
    }
    return sum / time;
}

/*
    Prolate: the tilt grows; oblate: it decays. All four rates, each over the
    time in which e^2 is gained or lost at most, come out to 1e-6 of themselves:
    terms of higher order are (the tilt is 1e-3 at most) 1e-6 of the tilt, the
    integrator's errors 1e-12 a step.
*/
static void test_rates_about_log_rolling(void **unused)
{
    static const double ratio[] = {4, 2, 0.5, 0.25}, stokes[] = {1, 10, 100};

    (void)unused;
    for (int i = 0; i < 12; i++)
    {
        const double r = ratio[i / 3], st = stokes[i % 3];
        const spheroid b = spheroid_of(r, st, 1e-12);
        double complex z[4];
        const double fastest = eigenvalues(&b, z);

        assert_true(r > 1 ? fastest > 0 : fastest < 0);
        print_message("# r %4g St %3g: rates", r, st);
        for (int n = 0; n < 4; n++)
        {
            const double rate = creal(z[n]);
            const double complex found =
                measured(&b, z[n], fmin(200, 2 / fabs(rate)));

            print_message(" %+.5g%+.5gi", creal(found), cimag(found));
            assert_near(cabs(found - z[n]), 0, 1e-6 * fabs(rate));
        }
        print_message("\n");
    }
}

/* ---------------------------------------------------------- between orbits */

/* Jeffery's spin across the axis, W - (W.n) n + shape n x E n, and n's change
   by it. */
static void jeffery(const spheroid *b, const double n[3], double spin[3],
                    double change[3])
{
    ellipsoid_cross(n, (const double[3]){0.5 * n[1], 0.5 * n[0], 0}, spin);
    for (int i = 0; i < 3; i++)
    {
        spin[i] = b->shape * spin[i] + 0.5 * n[2] * n[i];
    }
    spin[2] -= 0.5;
    ellipsoid_cross(spin, n, change);
}

/*
    A little inertia: with O = O0 + tau O1 in the equations above and the time
    derivatives those of Jeffery's orbit, O1 = -(dO0/dt + kappa (W.n) dn/dt).
    This is how Einarsson, Angilella & Mehlig, Physica D 278-279, 79 (2014)
    find the drift between orbits.
*/
static void slow_spin(const spheroid *b, const double n[3], double lag[3])
{
    double spin[3], change[3], first[3], second[3];

    jeffery(b, n, spin, change);
    ellipsoid_cross(change, (const double[3]){n[1], n[0], 0}, first);
    ellipsoid_cross(n, (const double[3]){change[1], change[0], 0}, second);
    for (int i = 0; i < 3; i++)
    {
        lag[i] = (change[2] * n[i] + (1 - b->kappa) * n[2] * change[i]
                  + b->shape * (first[i] + second[i]))
               / -2;
    }
}

/*
    d ln C/dt over tau, the mean over Jeffery's orbit, on which
    n ~ (C r sin p, C cos p, 1), p = t/(r + 1/r): C^2 = (n1^2/r^2 + n2^2)/n3^2.
    Equal steps of a periodic function: the error falls exponentially.
*/
static double predicted_drift(const spheroid *b, double constant)
{
    const int count = 400;
    const double r = b->r;
    double sum = 0;

    for (int i = 0; i < count; i++)
    {
        const double p = 2 * test_pi * i / count;
        const double n1 = constant * r * sin(p), n2 = constant * cos(p);
        const double size = sqrt(n1 * n1 + n2 * n2 + 1);
        const double n[3] = {n1 / size, n2 / size, 1 / size};
        double lag[3], change[3];

        slow_spin(b, n, lag);
        ellipsoid_cross(lag, n, change);
        sum += (n[0] * change[0] / (r * r) + n[1] * change[1])
                 / (n[0] * n[0] / (r * r) + n[1] * n[1])
             - change[2] / n[2];
    }
    return sum / count;
}

/* The same from the core: over one of Jeffery's periods, from a start that
   already has the lag. */
static double observed_drift(double r, double stokes, double constant)
{
    const spheroid b = spheroid_of(r, stokes, 1e-12);
    const double size = sqrt(1 + constant * constant);
    const double period = 2 * test_pi * (r + 1 / r);
    double n[3] = {0, constant / size, 1 / size};
    double spin[3], change[3], lag[3], rotation[3][3], t = 0;
    ellipsoid_state s = {.q = {0, 0, 0, 1}};
    ellipsoid_controller controller = {0};

    jeffery(&b, n, spin, change);
    slow_spin(&b, n, lag);
    ellipsoid_quaternion_from_axis(n, 0, s.q);
    ellipsoid_rotation(s.q, rotation);
    for (int i = 0; i < 3; i++)
    {
        s.omega[0] += rotation[i][0] * (spin[i] + b.tau * lag[i]);
        s.omega[2] += rotation[i][2] * (spin[i] + b.tau * lag[i]);
    }
    s.omega[1] = -0.5 * n[2];
    advance(&b, &s, &t, period, &controller);
    axis_and_spin(&s, n, spin);
    return log(sqrt(n[0] * n[0] / (r * r) + n[1] * n[1])
               / (constant * fabs(n[2])))
         / (b.tau * period);
}

/*
    Prolate spheroids drift towards tumbling, oblate ones towards log-rolling.
    Observed at St and St/2 and extrapolated, what is left is of second order in
    tau < 2e-3: 1e-5. Near log-rolling the drift is the real part of the
    eigenvalue above for tau to 0, shape kappa/4.
*/
static void test_small_stokes_drift(void **unused)
{
    static const double ratio[] = {4, 2, 0.5, 0.25};
    static const double constant[] = {0.01, 0.3, 1, 3};

    (void)unused;
    for (int i = 0; i < 4; i++)
    {
        const double r = ratio[i];
        const spheroid b = spheroid_of(r, 0.1, 1e-12);

        assert_relative(predicted_drift(&b, 1e-6), b.shape * b.kappa / 4,
                        1e-10);
        for (int j = 0; j < 4; j++)
        {
            const double coarse = observed_drift(r, 0.1, constant[j]);
            const double fine = observed_drift(r, 0.05, constant[j]);

            assert_true(r > 1 ? fine > 0 : fine < 0);
            assert_relative(2 * fine - coarse, predicted_drift(&b, constant[j]),
                            1e-5);
        }
    }
}

/* Where the drift ends, started at C = 1: prolate spheroids tumble in the plane
   of the shear, oblate ones roll with half the shear rate. Thirty times the
   time of the linear growth leave nothing of the start. */
static void test_end_of_drift(void **unused)
{
    static const double ratio[] = {2, 0.5}, stokes[] = {1, 10, 100};

    (void)unused;
    for (int i = 0; i < 6; i++)
    {
        const double r = ratio[i / 3];
        const spheroid b = spheroid_of(r, stokes[i % 3], 1e-8);
        ellipsoid_state s = {.q = {0, 0, 0, 1}};
        ellipsoid_controller controller = {0};
        double complex z[4];
        const double rate = fabs(eigenvalues(&b, z));
        const double start[3] = {0, sqrt(0.5), sqrt(0.5)};
        double t = 0, n[3], spin[3];

        ellipsoid_quaternion_from_axis(start, 0, s.q);
        advance(&b, &s, &t, 30 / rate, &controller);
        axis_and_spin(&s, n, spin);
        assert_near(n[2], r > 1 ? 0 : 1, 1e-6);
        assert_near(s.omega[1], r > 1 ? 0 : -0.5, 1e-6);
    }
}

/* The mean period of tumbling in the plane of the shear: of ten of them, but
   for little, else the wobble within one would count. */
static double tumbling_period(double r, double tau)
{
    spheroid b = spheroid_of(r, 1, 1e-10);
    const double end = 40 * test_pi * (1 + b.shape * b.shape / (2 * tau * tau));
    ellipsoid_state s = {.omega = {0, 0, -0.5}, .q = {0, 0, 0, 1}};
    ellipsoid_controller controller = {0};
    double t = 0, begin, angle = 0, before[3], n[3], spin[3];

    b = spheroid_of(r, tau / b.tau, 1e-10);
    advance(&b, &s, &t, 20 * tau, &controller);
    begin = t;
    axis_and_spin(&s, before, spin);
    for (int i = 1; i <= 100; i++)
    {
        advance(&b, &s, &t, begin + end * i / 100, &controller);
        axis_and_spin(&s, n, spin);
        angle += atan2(n[0] * before[1] - n[1] * before[0],
                       n[0] * before[0] + n[1] * before[1]);
        memcpy(before, n, sizeof(before));
    }
    return 2 * test_pi * end / angle;
}

/*
    Lundell & Carlsson (2010): a heavy spheroid tumbles almost uniformly at half
    the shear rate. From tau p'' + p' = (1 + shape cos 2p)/2 for the angle p
    from x2 to x1, with p = t/2 + O(1/tau), the mean rate is
    1/2 - shape^2/(4 tau^2) and the period 4 pi (1 + shape^2/(2 tau^2)), up to
    terms smaller by another 1/tau^2: a quarter of them at twice tau.
*/
static void test_heavy_tumbling(void **unused)
{
    static const double ratio[] = {4, 0.25};

    (void)unused;
    for (int i = 0; i < 2; i++)
    {
        const double r2 = ratio[i] * ratio[i], shape = (r2 - 1) / (r2 + 1);
        double rest[2];

        for (int k = 0; k < 2; k++)
        {
            const double tau = k ? 40 : 20;
            const double over = tumbling_period(ratio[i], tau) / (4 * test_pi);

            rest[k] = (over - 1) * 2 * tau * tau / (shape * shape) - 1;
        }
        assert_near(rest[1], 0, 0.2 / (40 * 40));
        assert_relative(rest[0] / rest[1], 4, 0.1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rates_about_log_rolling),
        cmocka_unit_test(test_small_stokes_drift),
        cmocka_unit_test(test_end_of_drift),
        cmocka_unit_test(test_heavy_tumbling),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
