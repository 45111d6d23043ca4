/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_resistance.c - Carlson's integrals and the Stokes resistance.
*/
#include "coreTest.h"

/* Values printed by Carlson (1995), section 3, to 14 digits: 1e-13. */
static void test_carlson_references(void **unused)
{
    static const test_row row = {
        "resistance",
        "elliptic integrals R_F and R_D over the printed values",
        "five of real arguments",
        "Carlson (1995), section 3",
        "P",
        "14 digits are printed",
        0};

    (void)unused;
    assert_row(&row, ellipsoid_carlson_rf(1, 2, 0) / 1.3110287771461, 1, 1e-13);
    assert_row(&row, ellipsoid_carlson_rf(0.5, 1, 0) / 1.8540746773014, 1,
               1e-13);
    assert_row(&row, ellipsoid_carlson_rf(2, 3, 4) / 0.58408284167715, 1,
               1e-13);
    assert_row(&row, ellipsoid_carlson_rd(0, 2, 1) / 1.7972103521034, 1, 1e-13);
    assert_row(&row, ellipsoid_carlson_rd(2, 3, 4) / 0.16510527294261, 1,
               1e-13);
}

/*
    DLMF 19.20.2 and 19.20.18: equal arguments; 19.20.4, R_F(x, y, y) by arcs;
    19.21.10-like: R_D(x,y,z) + R_D(y,z,x) + R_D(z,x,y) = 3/sqrt(xyz). Rounding
    only: 2e-15, 1e-14 for the arcs.
*/
static void test_carlson_identities(void **unused)
{
    uint64_t seed = 1;

    (void)unused;
    assert_true(ellipsoid_carlson_rf(4, 4, 4) == 0.5);
    assert_true(ellipsoid_carlson_rd(4, 4, 4) == 0.125);
    for (int n = 0; n < 1000; n++)
    {
        const double x = pow(10, 6 * test_signed(&seed));
        const double y = pow(10, 6 * test_signed(&seed));
        const double z = pow(10, 6 * test_signed(&seed));
        const double d = sqrt(fabs(y - x));
        const double arc = (x < y ? atan2(d, sqrt(x)) : atanh(d / sqrt(x))) / d;

        assert_relative(ellipsoid_carlson_rd(x, y, z)
                            + ellipsoid_carlson_rd(y, z, x)
                            + ellipsoid_carlson_rd(z, x, y),
                        3 / sqrt(x * y * z), 2e-15);
        if (fabs(x / y - 1) > 0.1 && x / y < 100)
        {
            assert_relative(ellipsoid_carlson_rf(x, y, y), arc, 1e-14);
        }
    }
}

/* Stokes (1851): 6 pi a and 8 pi a^3, to rounding. */
static void test_sphere(void **unused)
{
    static const test_row force = {"resistance",
                                   "force on a sphere over 6 pi mu a u",
                                   "radii 1e-9 to 1e3",
                                   "Stokes (1851)",
                                   "A",
                                   "rounding",
                                   0};
    static const test_row torque = {"resistance",
                                    "torque on a sphere over 8 pi mu a^3 omega",
                                    "radii 1e-9 to 1e3",
                                    "Stokes (1851)",
                                    "A",
                                    "rounding",
                                    0};

    (void)unused;
    for (double a = 1e-9; a < 1e3; a *= 7)
    {
        const double axes[3] = {a, a, a};
        double k[3], c[3];

        ellipsoid_resistance(axes, k, c);
        for (int i = 0; i < 3; i++)
        {
            assert_row(&force, k[i] / (6 * test_pi * a), 1, 4e-16);
            assert_row(&torque, c[i] / (8 * test_pi * a * a * a), 1, 8e-16);
        }
    }
}

/*
    Closed forms of Oberbeck (1876) and Perrin (1934) for a spheroid with
    semi-axis r along its axis and 1 across, as printed by Kim & Karrila,
    Microhydrodynamics (1991), tables 3.4 and 3.6. In long double, as they
    cancel; near the sphere by their series in e^2 = 1 - 1/r^2, which holds for
    the oblate ones too (e^2 < 0).
*/
typedef struct spheroid
{
    double along, across, turn_along, turn_across;
} spheroid;

static spheroid near_sphere(long double r)
{
    const long double e2 = (r - 1) * (r + 1) / (r * r);
    long double xa = 0, ya = 0, xc = 0, power = 1;
    const long double six = 6 * 3.14159265358979323846L * r;
    const long double eight = 8 * 3.14159265358979323846L * r * r * r;
    spheroid s;

    for (int n = 1; n < 80; n++)
    {
        const long double low = 1.0L / (2 * n - 1), high = 1.0L / (2 * n + 1);

        xa += 2 * power * (high + low);
        ya += 2 * power * (3 * low - high);
        xc += 2 * power * (low - high);
        power *= e2;
    }
    s.along = (double)(six * 8 / 3 / xa);
    s.across = (double)(six * 16 / 3 / ya);
    s.turn_along = (double)(eight * 4 / 3 * (1 - e2) / xc);
    s.turn_across = (double)(eight * 4 / 3 * (2 - e2) / xa);
    return s;
}

static spheroid prolate(long double r)
{
    const long double e2 = (r - 1) * (r + 1) / (r * r), e = sqrtl(e2);
    const long double l = 2 * logl(r * (1 + e)), e3 = e * e2;
    const long double six = 6 * 3.14159265358979323846L * r;
    const long double eight = 8 * 3.14159265358979323846L * r * r * r;
    spheroid s;

    s.along = (double)(six * 8 * e3 / (3 * (-2 * e + (1 + e2) * l)));
    s.across = (double)(six * 16 * e3 / (3 * (2 * e + (3 * e2 - 1) * l)));
    s.turn_along =
        (double)(eight * 4 * e3 / (r * r) / (3 * (2 * e - l / (r * r))));
    s.turn_across =
        (double)(eight * 4 * e3 * (2 - e2) / (3 * (-2 * e + (1 + e2) * l)));
    return s;
}

static spheroid oblate(long double r)
{
    const long double e2 = (1 - r) * (1 + r), e = sqrtl(e2), e3 = e * e2;
    const long double c = atan2l(e, r), six = 6 * 3.14159265358979323846L;
    const long double eight = 8 * 3.14159265358979323846L;
    spheroid s;

    s.along = (double)(six * 4 * e3 / (3 * ((2 * e2 - 1) * c + e * r)));
    s.across = (double)(six * 8 * e3 / (3 * ((2 * e2 + 1) * c - e * r)));
    s.turn_along = (double)(eight * 2 * e3 / (3 * (c - e * r)));
    s.turn_across =
        (double)(eight * 2 * e3 * (2 - e2) / (3 * (e * r - (1 - 2 * e2) * c)));
    return s;
}

/* Both sides are good to a few roundings: 1e-13, asked for was 1e-12. */
static void test_spheroids(void **unused)
{
    static const test_row force = {
        "resistance",
        "force on a spheroid over the closed form",
        "aspect ratios 0.01 to 100, along and across",
        "Oberbeck (1876); Kim & Karrila (1991), table 3.4",
        "A",
        "a few roundings of either side",
        0};
    static const test_row torque = {
        "resistance",
        "torque on a spheroid over the closed form",
        "aspect ratios 0.01 to 100, along and across",
        "Perrin (1934); Kim & Karrila (1991), table 3.6",
        "A",
        "a few roundings of either side",
        0};
    const double ratios[] = {0.01, 0.02,    0.1,     0.25,     0.5,  0.8, 0.9,
                             0.99, 0.99999, 1.00001, 1.000001, 1.01, 1.1, 1.3,
                             2,    4,       10,      50,       100};

    (void)unused;
    for (size_t n = 0; n < sizeof(ratios) / sizeof(*ratios); n++)
    {
        const double r = ratios[n];
        const spheroid s = fabs(1 - 1 / (r * r)) < 0.4 ? near_sphere(r)
                         : r > 1                       ? prolate(r)
                                                       : oblate(r);

        for (int along = 0; along < 3; along++)
        {
            double axes[3] = {1, 1, 1}, k[3], c[3];

            axes[along] = r;
            ellipsoid_resistance(axes, k, c);
            for (int i = 0; i < 3; i++)
            {
                assert_row(&force, k[i] / (i == along ? s.along : s.across), 1,
                           1e-13);
                assert_row(&torque,
                           c[i] / (i == along ? s.turn_along : s.turn_across),
                           1, 1e-13);
            }
        }
    }
}

/*
    Perrin's friction factor, of a body that turns at random over a sphere of its
    volume: the harmonic mean of the three resistances. Perrin (1936), of prolate
    bodies sqrt(1 - p^2)/(p^(2/3) ln((1 + sqrt(1 - p^2))/p)), of oblate ones
    sqrt(p^2 - 1)/(p^(2/3) atan(sqrt(p^2 - 1))), p the aspect ratio's inverse.
*/
static void test_friction_factor(void **unused)
{
    static const test_row row = {"resistance",
                                 "friction factor of a spheroid over Perrin's",
                                 "aspect ratios 1/20 to 20",
                                 "Perrin, J. Phys. Radium 7, 1 (1936)",
                                 "A",
                                 "rounding; the closed form cancels by 10",
                                 0};

    (void)unused;
    for (int n = 0; n < 8; n++)
    {
        const double r = (double[]){0.05, 0.1, 0.25, 0.5, 2, 4, 10, 20}[n];
        const double p = 1 / r, s = sqrt(fabs(1 - p * p));
        const double perrin =
            s / (cbrt(p * p) * (p < 1 ? log((1 + s) / p) : atan(s)));
        const double axes[3] = {1, r, 1};
        double k[3], c[3];

        ellipsoid_resistance(axes, k, c);
        assert_row(&row,
                   3 / (1 / k[0] + 1 / k[1] + 1 / k[2])
                       / (6 * test_pi * cbrt(r)) / perrin,
                   1, 1e-14);
    }
}

/* The series above against the closed forms where both are good. */
static void test_closed_forms_agree(void **unused)
{
    const spheroid a = near_sphere(1.2L), b = prolate(1.2L);
    const spheroid c = near_sphere(0.85L), d = oblate(0.85L);

    (void)unused;
    assert_relative(a.along, b.along, 1e-15);
    assert_relative(a.turn_along, b.turn_along, 1e-15);
    assert_relative(a.turn_across, b.turn_across, 1e-15);
    assert_relative(c.across, d.across, 1e-15);
    assert_relative(c.turn_along, d.turn_along, 1e-15);
    assert_relative(c.turn_across, d.turn_across, 1e-15);
}

/*
    A second formula for any triaxial body: Oberbeck's integrals themselves,
    by the trapezoidal rule in s, l = exp(s), which converges exponentially
    (error below 1e-14 at this spacing).
*/
static void integrals(const double a[3], double *chi, double alpha[3])
{
    const double step = 0.1;

    *chi = alpha[0] = alpha[1] = alpha[2] = 0;
    for (double s = -50; s < 90; s += step)
    {
        const double l = exp(s);
        const double delta =
            sqrt((a[0] * a[0] + l) * (a[1] * a[1] + l) * (a[2] * a[2] + l));
        const double weight = step * a[0] * a[1] * a[2] * l / delta;

        *chi += weight;
        for (int i = 0; i < 3; i++)
        {
            alpha[i] += weight / (a[i] * a[i] + l);
        }
    }
}

static void test_triaxial(void **unused)
{
    static const test_row force = {
        "resistance",
        "force on a triaxial ellipsoid over that by quadrature",
        "100 bodies, semi-axes 0.1 to 10",
        "Oberbeck (1876), integrals",
        "A",
        "the quadrature is good to 1e-14",
        0};
    static const test_row torque = {
        "resistance",
        "torque on a triaxial ellipsoid over that by quadrature",
        "100 bodies, semi-axes 0.1 to 10",
        "Jeffery (1922), integrals",
        "A",
        "the quadrature is good to 1e-14",
        0};
    uint64_t seed = 2;

    (void)unused;
    for (int n = 0; n < 100; n++)
    {
        double a[3], k[3], c[3], chi, alpha[3];

        for (int i = 0; i < 3; i++)
        {
            a[i] = pow(10, test_signed(&seed));
        }
        integrals(a, &chi, alpha);
        ellipsoid_resistance(a, k, c);
        for (int i = 0; i < 3; i++)
        {
            const double aj = a[(i + 1) % 3], ak = a[(i + 2) % 3];
            const double p = test_pi * a[0] * a[1] * a[2];

            assert_row(&force, k[i] * (chi + alpha[i] * a[i] * a[i]) / (16 * p),
                       1, 1e-12);
            assert_row(&torque,
                       c[i] * 3
                           * (aj * aj * alpha[(i + 1) % 3]
                              + ak * ak * alpha[(i + 2) % 3])
                           / (16 * p * (aj * aj + ak * ak)),
                       1, 1e-12);
        }
    }
}

/* The drag on a body held still is what it would be accelerated by, times its
   mass: rounding. */
static void test_held_drag(void **unused)
{
    ellipsoid_options o = test_free_cell();
    uint64_t seed = 31;

    (void)unused;
    o.pressure_gradient = ELLIPSOID_PRESSURE_NONE;
    for (int n = 0; n < 20; n++)
    {
        const ellipsoid_model model = test_model(&o);
        test_quadratic flow = test_shear(100);
        const ellipsoid_surroundings around = {.flow = test_quadratic_flow,
                                               .flow_context = &flow};
        ellipsoid_state state = {.u = {0}}, slope;
        double drag[3];

        for (int i = 0; i < 3; i++)
        {
            flow.u[i] = 1e-3 * test_signed(&seed);
        }
        test_orientation(&seed, state.q);
        assert_ok(ellipsoid_rhs(&model, &around, &state, NULL, &slope));
        ellipsoid_drag_at_rest(&model, state.q, flow.u, drag);
        for (int i = 0; i < 3; i++)
        {
            assert_near(model.mass * slope.u[i], drag[i],
                        1e-14 * ellipsoid_length(drag));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_carlson_references),
        cmocka_unit_test(test_carlson_identities),
        cmocka_unit_test(test_sphere),
        cmocka_unit_test(test_closed_forms_agree),
        cmocka_unit_test(test_spheroids),
        cmocka_unit_test(test_friction_factor),
        cmocka_unit_test(test_triaxial),
        cmocka_unit_test(test_held_drag),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
