/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_triaxial.c - triaxial ellipsoids: in simple shear against an
    independent integration, and free. The shear is u = (x2, 0, 0) [1/s], the
    viscosity 1: time is counted in units of the inverse shear rate.
    Processor time: 3
*/
#include "coreTest.h"

enum
{
    LARGEST = 12
};

/*
    The same body in other unknowns: the nine elements of the rotation matrix
    and, with inertia, the angular momentum over the mass in the lab.
*/
typedef struct reference
{
    double squares[3]; /* of the semi-axes */
    double inertia[3]; /* over the mass */
    double torque[3];  /* mu c_i over the mass */
    int size;          /* 9 or, with inertia, 12 */
} reference;

/*
    Jeffery (1922), eqs. 36: T_1 = mu c_1 (a2^2 (G32 - w1) - a3^2 (G23 + w1)),
    G = R^T grad(u) R, and cyclic. Without inertia T = 0 gives w from the ratios
    of the axes alone.
*/
static void rates(const reference *b, const double *y, double *f)
{
    const double(*r)[3] = (const double(*)[3])y;
    double(*change)[3] = (double(*)[3])f;
    double w[3], turned[3] = {0, 0, 0};

    for (int i = 0; i < 3; i++)
    {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double strain = b->squares[j] * r[0][k] * r[1][j]
                            - b->squares[k] * r[0][j] * r[1][k];
        const double sum = b->squares[j] + b->squares[k];

        w[i] = b->size == LARGEST
                 ? (r[0][i] * y[9] + r[1][i] * y[10] + r[2][i] * y[11])
                       / b->inertia[i]
                 : strain / sum;
        for (int l = 0; l < 3; l++)
        {
            turned[l] += r[l][i] * b->torque[i] * (strain - sum * w[i]);
        }
    }
    for (int l = 0; l < 3; l++)
    {
        ellipsoid_cross(r[l], w, change[l]); /* R [w]x */
        f[9 + l] = turned[l];
    }
}

/*
    One step of Gauss's implicit Runge-Kutta method of order six (Hairer &
    Wanner II, table IV.5.2), its stages by iteration to rounding: each pass
    gains a factor of ten at least. It keeps R orthogonal.
*/
static void gauss_step(const reference *b, double h, double *y)
{
    const double d = sqrt(15.0);
    const double a[3][3] = {
        {5.0 / 36, 2.0 / 9 - d / 15, 5.0 / 36 - d / 30},
        {5.0 / 36 + d / 24, 2.0 / 9, 5.0 / 36 - d / 24},
        {5.0 / 36 + d / 30, 2.0 / 9 + d / 15, 5.0 / 36},
    };
    double k[3][LARGEST] = {{0}}, moved = 1;

    for (int pass = 0; pass < 100 && moved > 1e-14; pass++)
    {
        moved = 0;
        for (int i = 0; i < 3; i++)
        {
            double stage[LARGEST] = {0}, f[LARGEST];

            for (int n = 0; n < b->size; n++)
            {
                stage[n] = y[n]
                         + h
                               * (a[i][0] * k[0][n] + a[i][1] * k[1][n]
                                  + a[i][2] * k[2][n]);
            }
            rates(b, stage, f);
            for (int n = 0; n < b->size; n++)
            {
                moved = fmax(moved, h * fabs(f[n] - k[i][n]));
                k[i][n] = f[n];
            }
        }
    }
    assert_true(moved <= 1e-14);
    for (int n = 0; n < b->size; n++)
    {
        y[n] += h * (5 * k[0][n] + 8 * k[1][n] + 5 * k[2][n]) / 18;
    }
}

/* ---------------------------------------------------------------- in shear */

/* Of the relaxation time tau [1/shear]; 0: without inertia. */
static ellipsoid_model body(const double axes[3], double tau)
{
    ellipsoid_options o = test_free_cell();
    ellipsoid_model m;

    memcpy(o.semi_axes, axes, sizeof(o.semi_axes));
    o.motion =
        tau > 0 ? ELLIPSOID_MOTION_INERTIAL : ELLIPSOID_MOTION_INERTIALESS;
    o.density = o.fluid_density = o.kinematic_viscosity = 1;
    o.pressure_gradient = ELLIPSOID_PRESSURE_NONE;
    o.tolerance = 1e-13;
    m = test_model(&o);
    o.density = tau > 0 ? tau / m.rotation_relaxation_time : 1;
    return test_model(&o);
}

static reference reference_of(const ellipsoid_model *m)
{
    const double *a = m->options.semi_axes;
    reference b = {.size = LARGEST};

    for (int i = 0; i < 3; i++)
    {
        const double aj = a[(i + 1) % 3], ak = a[(i + 2) % 3];
        const double c = m->viscosity * m->rotation_resistance[i];

        b.squares[i] = a[i] * a[i];
        b.inertia[i] = (aj * aj + ak * ak) / 5;
        b.torque[i] = c / (aj * aj + ak * ak) / m->mass;
    }
    if (m->options.motion == ELLIPSOID_MOTION_INERTIALESS)
    {
        b.size = 9;
    }
    return b;
}

/* Between two rotation matrices. */
static double distance(const double *a, const double *b)
{
    double sum = 0;

    for (int n = 0; n < 9; n++)
    {
        sum += (a[n] - b[n]) * (a[n] - b[n]);
    }
    return sqrt(sum);
}

/* Ordinary; long and nearly a spheroid, which moves with two periods (Hinch &
   Leal, J. Fluid Mech. 92, 591 (1979)); and one whose motion is chaotic from
   some starts (Yarin, Gottlieb & Roisman, J. Fluid Mech. 340, 83 (1997)). */
static const double bodies[3][3] = {{1, 2, 4}, {10, 1, 1.05}, {5, 1, 1.5}};

/* The longest period of turning about one axis. */
static double period_of(const double a[3])
{
    const double r =
        fmax(a[0], fmax(a[1], a[2])) / fmin(a[0], fmin(a[1], a[2]));

    return 2 * test_pi * (r + 1 / r);
}

/*
    The farthest that the core's rotation matrix is from that of `b` at fifty
    times in so many periods, from rest in one of several orientations. With
    steps of h/2 and h the independent integration tells its own error: 1/63
    of their difference.
*/
static double deviation(const ellipsoid_model *m, const reference *b,
                        uint64_t start, double periods, double h)
{
    const double *a = m->options.semi_axes;
    const double piece = periods * period_of(a) / 50;
    const int count = (int)ceil(piece / h);
    test_quadratic flow = test_shear(1);
    ellipsoid_state s = {.u = {0}};
    ellipsoid_controller controller = {0};
    ellipsoid_statistics statistics = {0};
    double coarse[LARGEST] = {0}, fine[LARGEST], r[9];
    double t = 0, own = 0, worst = 0;

    test_orientation(&start, s.q);
    ellipsoid_rotation(s.q, (double(*)[3])coarse);
    memcpy(fine, coarse, sizeof(fine));
    for (int k = 1; k <= 50; k++)
    {
        assert_ok(test_advance(m, &flow, &s, &t, k * piece, &controller,
                               &statistics));
        ellipsoid_rotation(s.q, (double(*)[3])r);
        for (int n = 0; n < count; n++)
        {
            gauss_step(b, piece / count, coarse);
            gauss_step(b, piece / count / 2, fine);
            gauss_step(b, piece / count / 2, fine);
        }
        own = fmax(own, distance(coarse, fine) / 63);
        worst = fmax(worst, distance(r, fine));
    }
    print_message("# %g:%g:%g: deviation %.1e, the other one's error %.1e\n",
                  a[0], a[1], a[2], worst, own);
    assert_near(own, 0, 1e-11);
    return worst;
}

/*
    Ten of the longest periods. A step's error of 1e-13 grows with the number
    of steps, a thousand, and the motion's own sensitivity, up to 500 here, but
    not by their product as few of the steps are that sensitive: 1e-9.
*/
static void test_without_inertia(void **unused)
{
    static const test_row row = {
        "free motion",
        "triaxial body off an independent integration, in shear",
        "axes 1:2:4, 10:1:1.05, 5:1:1.5; ten of the longest periods",
        "Jeffery (1922), eqs. 36, by Gauss's method of order six",
        "S",
        "1e-13 a step, a thousand steps, sensitivity up to 500",
        0};

    (void)unused;
    for (int n = 0; n < 9; n++)
    {
        const ellipsoid_model m = body(bodies[n / 3], 0);
        const reference b = reference_of(&m);

        assert_row(&row, deviation(&m, &b, 1 + n % 3, 10, 0.05), 0, 1e-9);
    }
}

/* The thirteen equations with inertia that counts: hundreds of steps with
   errors of 1e-13, and three periods only: 1e-11. */
static void test_with_inertia(void **unused)
{
    static const double relaxation[] = {0.1, 1, 20};
    static const test_row row = {
        "free motion",
        "triaxial body off an independent integration, with inertia",
        "axes 1:2:4, 10:1:1.05, 5:1:1.5; three of the longest periods",
        "Jeffery (1922), eqs. 36, by Gauss's method of order six",
        "S",
        "1e-13 a step, hundreds of steps",
        0};

    (void)unused;
    for (int n = 0; n < 9; n++)
    {
        const double tau = relaxation[n % 3];
        const ellipsoid_model m = body(bodies[n / 3], tau);
        const reference b = reference_of(&m);

        assert_row(&row, deviation(&m, &b, 1, 3, fmin(0.02, tau / 4)), 0,
                   1e-11);
    }
}

/* The thirteen equations against Jeffery's: the deviation goes to zero in
   proportion to the relaxation time. */
static void test_vanishing_inertia(void **unused)
{
    (void)unused;
    for (int n = 0; n < 3; n++)
    {
        static const double tau[] = {1e-11, 1e-7, 1e-6};
        reference b;
        double d[3];

        for (int k = 0; k < 3; k++)
        {
            const ellipsoid_model m = body(bodies[n], tau[k]);

            b = reference_of(&m);
            b.size = 9; /* without inertia */
            d[k] = deviation(&m, &b, 1, 3, 0.05);
        }
        assert_true(d[0] < 1e-9 && d[1] > 1e-8);
        assert_relative(d[2] / d[1], 10, 0.01);
    }
}

/* How much orientations 1e-9 apart, near the start of that name, part. */
static double sensitivity(const double axes[3], uint64_t start, int periods)
{
    const ellipsoid_model m = body(axes, 0);
    test_quadratic flow = test_shear(1);
    double r[2][9], q[4];

    test_orientation(&start, q);
    for (int n = 0; n < 2; n++)
    {
        ellipsoid_state s = {.q = {q[0] + n * 1e-9, q[1], q[2], q[3]}};
        ellipsoid_controller controller = {0};
        ellipsoid_statistics statistics = {0};
        double t = 0;

        assert_ok(test_advance(&m, &flow, &s, &t, periods * period_of(axes),
                               &controller, &statistics));
        ellipsoid_rotation(s.q, (double(*)[3])r[n]);
    }
    return distance(r[0], r[1]) / 1e-9;
}

/* Quasi-periodic: neighbours part in proportion to time. Chaotic:
   exponentially, but not from every start. */
static void test_chaos(void **unused)
{
    (void)unused;
    assert_near(sensitivity(bodies[1], 1, 40) / sensitivity(bodies[1], 1, 10),
                4, 0.5);
    assert_true(sensitivity(bodies[2], 1, 30)
                > 100 * sensitivity(bodies[2], 1, 10));
    assert_true(sensitivity(bodies[2], 3, 30) < 100);
}

/* -------------------------------------------------------------------- free */

/* What a free top keeps: angular momentum in the lab and energy. */
static void kept(const ellipsoid_model *m, const ellipsoid_state *s,
                 double value[4])
{
    double r[3][3];

    ellipsoid_rotation(s->q, r);
    memset(value, 0, 4 * sizeof(*value));
    for (int j = 0; j < 3; j++)
    {
        const double spin = m->inertia[j] * s->omega[j];

        for (int i = 0; i < 3; i++)
        {
            value[i] += r[i][j] * spin;
        }
        value[3] += spin * s->omega[j] / 2;
    }
}

/*
    The time in which the angular velocity of a free top comes back to itself:
    Landau & Lifshitz, Mechanics, section 37, K(k) = R_F(0, 1 - k^2, 1), for
    I1 < I2 < I3 or, where the motion is on the other side of the middle axis,
    I1 > I2 > I3.
*/
static double polhode_period(const double i[3], const double value[4])
{
    const double square = ellipsoid_dot(value, value), twice = 2 * value[3];
    const int side = square > twice * i[1];
    const double low = side ? i[0] : i[2], high = side ? i[2] : i[0];
    const double rate = (high - i[1]) * (square - twice * low);
    const double k2 = (i[1] - low) * (twice * high - square) / rate;

    return 4 * sqrt(i[0] * i[1] * i[2] / rate)
         * ellipsoid_carlson_rf(0, 1 - k2, 1);
}

/*
    Euler's free asymmetric top in vacuum, turned mainly about its long, its
    middle (unstable: it tips over and over) or its short axis. A thousand
    turns and on to the end of a period: the angular velocity is back, energy
    and angular momentum in the lab are what they were. 1e-10 was asked for;
    the phase gathers the errors of a million steps: 1e-8.
*/
static void test_free_top(void **unused)
{
    const double axes[3] = {1.6, 1, 0.7};
    ellipsoid_model m = body(axes, 1);

    (void)unused;
    m.options.tolerance = 3e-11; /* rounding: a tighter one gains nothing */
    for (int axis = 0; axis < 3; axis++)
    {
        ellipsoid_state s = {.omega = {0.3, 0.2, 0.2}, .q = {0, 0, 0, 1}};
        ellipsoid_controller controller = {0};
        ellipsoid_statistics statistics = {0};
        double t = 0, before[4], after[4], spin[3], period;

        s.omega[axis] = 1;
        memcpy(spin, s.omega, sizeof(spin));
        kept(&m, &s, before);
        period = polhode_period(m.inertia, before);
        assert_ok(test_advance(&m, NULL, &s, &t,
                               period * ceil(2000 * test_pi / period),
                               &controller, &statistics));
        kept(&m, &s, after);
        print_message("# free top: energy changes by %.1e\n",
                      after[3] / before[3] - 1);
        assert_relative(after[3], before[3], 1e-10);
        for (int i = 0; i < 3; i++)
        {
            assert_near(after[i], before[i], 1e-10 * ellipsoid_length(before));
            assert_near(s.omega[i], spin[i], 1e-8);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_without_inertia),
        cmocka_unit_test(test_with_inertia),
        cmocka_unit_test(test_vanishing_inertia),
        cmocka_unit_test(test_chaos),
        cmocka_unit_test(test_free_top),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
