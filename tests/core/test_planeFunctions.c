/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_planeFunctions.c - what one plane does to a body, from the table:
    against published values and boundary elements.
    Processor time: 3, full 30
*/
#include "nearWallTest.h"
#include "body/planeTable.h"

#include "../../tools/planeTable/planePanels.c"
#include "../../tools/planeTable/planeSolver.c"

/* A body and a plane: the axis of the body is its second, tilted to +x in the
   lab, where z is the normal; lengths in equatorial radii. */
typedef struct scene
{
    ellipsoid_plane_table own;
    double axis[3][3]; /* of the body, lab */
    double normal[3];  /* of the plane, body */
} scene;

static scene place_body(double ratio, double tilt)
{
    const double axes[3] = {1, ratio, 1};
    scene s = {.axis = {{-cos(tilt), 0, sin(tilt)}, {sin(tilt), 0, cos(tilt)}}};

    ellipsoid_cross(s.axis[0], s.axis[1], s.axis[2]);
    ellipsoid_plane_table_set(axes, &s.own);
    for (int i = 0; i < 3; i++)
    {
        s.normal[i] = s.axis[i][2];
    }
    return s;
}

/* Jeffery (1922): half the curl and B e x (E e) of the flow z gamma, gamma
   along x or y. */
static void free_spin(const scene *s, const double gamma[3], double spin[3])
{
    const double *e = s->axis[s->own.axis], b = s->own.ratio;
    const double shape = (b * b - 1) / (b * b + 1);
    const double strained[3] = {0.5 * gamma[0] * e[2], 0.5 * gamma[1] * e[2],
                                0.5 * (gamma[0] * e[0] + gamma[1] * e[1])};
    double turn[3];

    ellipsoid_cross(e, strained, turn);
    ellipsoid_set(spin, shape * turn[0] - 0.5 * gamma[1],
                  shape * turn[1] + 0.5 * gamma[0], shape * turn[2]);
}

/* Resistance over mu in the lab, and the wrench on the body that moves as a free
   one in the flows (z - z of the centre) e_x and e_y. */
static void evaluate_plane(scene *s, double gap, double resistance[6][6],
                           double driven[6][2])
{
    ellipsoid_plane_effect effect;

    ellipsoid_plane_effect_set(&s->own, s->normal, (double[]){gap, gap}, 0,
                               &effect);
    for (int m = 0; m < 8; m++)
    {
        const double u[3] = {m == 0, m == 1, m == 2};
        const double w[3] = {m == 3, m == 4, m == 5};
        const double gamma[3] = {m == 6, m == 7, 0};
        double rates[9], velocity[6] = {0}, action[2][6], lab[6];
        double spin[3];

        ellipsoid_product(s->axis, u, rates);
        ellipsoid_product(s->axis, w, rates + 3);
        ellipsoid_product(s->axis, gamma, rates + 6);
        free_spin(s, gamma, spin);
        ellipsoid_product(s->axis, spin, velocity + 3);
        for (int i = 0; i < 6; i++)
        {
            velocity[i] -= rates[i];
        }
        action_of(&effect, rates, velocity, action);
        for (int i = 0; i < 6; i++)
        {
            const double *free = &s->own.free[i < 3 ? 0 : 2];

            action[0][i] += action[1][i] + free[i % 3 == 1] * rates[i];
        }
        for (int part = 0; part < 6; part += 3)
        {
            ellipsoid_combination(s->axis, action[0][part], action[0][part + 1],
                                  action[0][part + 2], lab + part);
        }
        for (int i = 0; i < 6; i++)
        {
            *(m < 6 ? &resistance[i][m] : &driven[i][m - 6]) = lab[i];
        }
    }
}

/* The same of what boundary elements give. */
static void solve_plane(double ratio, double tilt, double gap,
                        double resistance[6][6], double driven[6][2])
{
    static const plane_mesh mesh = {5, 2, 6, 8};
    static const int in[3] = {0, 2, 4}, across[3] = {1, 3, 5};
    const plane_case c = {ratio, tilt, gap};
    const double nu = cos(tilt), s = sin(tilt);
    const double bent = 0.5 * (ratio * ratio - 1) / (ratio * ratio + 1);
    const double spin[2][3] = {{0, 0.5 + bent * (nu * nu - s * s), 0},
                               {-0.5 - bent * nu * nu, 0, bent * nu * s}};
    plane_functions f;

    assert_true(plane_solve(&c, &mesh, &f));
    memset(resistance, 0, 6 * sizeof(*resistance));
    memset(driven, 0, 6 * sizeof(*driven));
    for (int i = 0; i < 3; i++)
    {
        for (int j = 0; j < 3; j++)
        {
            resistance[in[i]][in[j]] = f.in[i][j];
            resistance[across[i]][across[j]] = f.across[i][j];
        }
        driven[in[i]][0] = f.shear_in[i];
        driven[across[i]][1] = f.shear_across[i];
    }
    for (int i = 0; i < 6; i++)
    {
        for (int n = 0; n < 2; n++)
        {
            driven[i][n] -= ellipsoid_dot(resistance[i] + 3, spin[n]);
        }
    }
}

/* ---------------------------------------------------- published values */

/* Spheres, every row of Goldman, Cox & Brenner, and Brenner's series: within
   0.5 %, couplings of the root of the diagonal terms, the held torque 1 %.
   However the body is turned. */
static void test_sphere(void **unused)
{
    static const test_row along = {
        "walls",
        "drag of a sphere along a plane over the table",
        "gaps 0.0032 to 9 radii",
        "Goldman, Cox & Brenner, Chem. Eng. Sci. 22, 637 (1967), table 2",
        "P",
        "the program's own table is good to that",
        0};
    static const test_row towards = {
        "walls",
        "drag of a sphere towards a plane over the series",
        "gaps 0.0032 to 9 radii",
        "Brenner, Chem. Eng. Sci. 16, 242 (1961), eq. 2.19",
        "A",
        "the program's own table is good to that",
        0};
    static const test_row turning = {
        "walls",
        "torque on a sphere that turns at a plane over the table",
        "gaps 0.0032 to 9 radii",
        "Goldman, Cox & Brenner, Chem. Eng. Sci. 22, 637 (1967), table 2",
        "P",
        "the program's own table is good to that",
        0};
    static const test_row coupled = {
        "walls",
        "error of the coupling of a sphere at a plane, over 8 pi mu a^2",
        "gaps 0.0032 to 9 radii",
        "Goldman, Cox & Brenner, Chem. Eng. Sci. 22, 637 (1967), table 2",
        "P",
        "the program's own table is good to that",
        0};
    static const test_row held = {
        "walls",
        "force on a sphere held in shear at a plane over the table",
        "gaps 0.0032 to 9 radii",
        "Goldman, Cox & Brenner, Chem. Eng. Sci. 22, 653 (1967), table 1",
        "P",
        "the program's own table is good to that",
        0};
    static const test_row held_torque = {
        "walls",
        "torque on a sphere held in shear at a plane over the table",
        "gaps 0.0032 to 9 radii",
        "Goldman, Cox & Brenner, Chem. Eng. Sci. 22, 653 (1967), table 1",
        "P",
        "a difference of larger terms",
        0};

    (void)unused;
    for (size_t n = 0; n < sizeof(goldman) / sizeof(*goldman); n++)
    {
        const struct goldman *k = &goldman[n];
        const double force = 6 * test_pi, torque = 8 * test_pi;
        scene s = place_body(1, 0.3 + 0.15 * (double)n);
        double r[6][6], d[6][2];

        evaluate_plane(&s, k->height - 1, r, d);
        assert_row(&along, r[0][0] / (force * k->force_u), 1, 5e-3);
        assert_row(&along, r[1][1] / (force * k->force_u), 1, 5e-3);
        assert_row(&towards, r[2][2] / (force * brenner_towards(k->height)), 1,
                   5e-3);
        assert_row(&turning, r[3][3] / (torque * k->torque_omega), 1, 5e-3);
        assert_row(&coupled, r[3][1] / torque - k->torque_u, 0, 5e-3);
        assert_row(&coupled, r[0][4] / torque + k->torque_u, 0, 5e-3);
        /* held, in z e_x: that of the motion of a free one is added again */
        assert_row(&held,
                   (d[0][0] + r[0][0] * k->height + 0.5 * r[0][4])
                       / (force * k->height * k->force_s),
                   1, 5e-3);
        assert_row(&held_torque,
                   (d[4][0] + r[4][0] * k->height + 0.5 * r[4][4])
                       / (0.5 * torque * k->torque_s),
                   1, 1e-2);
    }
}

/* The limit of contact, table 1 of part II: a held sphere has 1.7005 and 0.94399.
   The wrench in the shear is the difference of terms that grow without end, so
   that it is taken at the least gap of the table: within 0.5 and 1 %. */
static void test_touching_sphere(void **unused)
{
    const double force = 6 * test_pi, torque = 4 * test_pi, height = 1.002;
    scene s = place_body(1, 0.7);
    double r[6][6], d[6][2];

    (void)unused;
    evaluate_plane(&s, height - 1, r, d);
    assert_relative(d[0][0] + r[0][0] * height + 0.5 * r[0][4], force * 1.7005,
                    5e-3);
    assert_relative(d[4][0] + r[4][0] * height + 0.5 * r[4][4],
                    torque * 0.94399, 1e-2);
}

/* In the middle of a slit the effects of two planes are added (Oseen): against
   Faxen's series for a sphere, l its radius over the distance of either wall.
   The sum leaves out what the planes reflect to one another: within 1 %, of
   which up to 0.7 % are there. */
static void test_slit_of_faxen(void **unused)
{
    static const test_row row = {
        "walls",
        "drag of a sphere in the middle of a slit over the series",
        "radius 0.05, 0.1, 0.2 of the distance of either wall",
        "Faxen (1922); Happel & Brenner, eq. 7-4.28",
        "A",
        "the sum of two planes leaves out up to 0.7 %",
        0};

    (void)unused;
    for (int n = 0; n < 3; n++)
    {
        const double l = (double[]){0.05, 0.1, 0.2}[n];
        const double series = 1 - 1.004 * l + 0.418 * pow(l, 3)
                            + 0.21 * pow(l, 4) - 0.169 * pow(l, 5);
        scene s = place_body(1, 0.7);
        double r[6][6], d[6][2];

        evaluate_plane(&s, 1 / l - 1, r, d);
        print_message("# l = %.2f: %.4f of %.4f\n", l,
                      1 + 2 * (r[0][0] / (6 * test_pi) - 1), 1 / series);
        assert_row(&row, (1 + 2 * (r[0][0] / (6 * test_pi) - 1)) * series, 1,
                   1e-2);
    }
}

/* ------------------------------------------------- boundary elements */

/* At any shape, tilt and gap down to the least: below 1 % of each diagonal
   term at gaps above 0.01 of the shorter semi-axis, 2 % of the root of two for
   the others and for the free motion, by the height and half the shear; 4 %
   below. */
static void test_solver(void **unused)
{
    const long count = test_count(1, 6, 80);
    uint64_t seed = 5;

    (void)unused;
    for (long n = 0; n < count; n++)
    {
        const double ratio = n % 2 ? 4 : pow(10, test_uniform(&seed));
        const double tilt = acos(pow(test_uniform(&seed), 2));
        const double p = hypot(sin(tilt), ratio * cos(tilt));
        const double gap = p / expm1(6.2 * test_uniform(&seed));
        const double one = gap < 0.01 ? 0.04 : 0.01;
        const double two = gap < 0.01 ? 0.04 : 0.02;
        scene s = place_body(ratio, tilt);
        double r[6][6], d[6][2], exact[6][6], exact_d[6][2];
        double moved[2][6][6];

        evaluate_plane(&s, gap, r, d);
        solve_plane(ratio, tilt, gap, exact, exact_d);
        print_message("ratio %.2f, tilt %.2f, gap %.4f\n", ratio, tilt, gap);
        for (int i = 0; i < 6; i++)
        {
            assert_relative(r[i][i], exact[i][i], one);
            for (int j = 0; j < i; j++)
            {
                assert_near(r[i][j], exact[i][j],
                            two * sqrt(exact[i][i] * exact[j][j]));
            }
        }
        memcpy(moved[0], r, sizeof(r));
        memcpy(moved[1], exact, sizeof(exact));
        assert_true(ellipsoid_invert6(moved[0]));
        assert_true(ellipsoid_invert6(moved[1]));
        for (int i = 0; i < 6; i++)
        {
            for (int m = 0; m < 2; m++)
            {
                double v = 0, is = 0;

                for (int k = 0; k < 6; k++)
                {
                    v += moved[0][i][k] * d[k][m];
                    is += moved[1][i][k] * exact_d[k][m];
                }
                assert_near(v, is, two * (i < 3 ? p + gap : 0.5));
            }
        }
    }
}

/* ------------------------------------------------------- the function */

/* Derivatives by normal and gap against central differences of the fourth
   order, for all axes and beyond the least gap. */
static void test_change(void **unused)
{
    static const double weight[] = {1.0 / 12, -2.0 / 3, 0, 2.0 / 3, -1.0 / 12};
    uint64_t seed = 9;

    (void)unused;
    for (int n = 0; n < 60; n++)
    {
        double axes[3] = {1e-6, 1e-6, 1e-6}, rates[9], normal[3];
        double velocity[6];
        const double gap[2] = {1e-6 * pow(10, -3.5 + 5 * test_uniform(&seed)),
                               1e-6 * pow(10, -3.5 + 5 * test_uniform(&seed))};
        ellipsoid_plane_table own;
        ellipsoid_plane_effect effect;

        /* some are spheres, whose functions change with the normal, too */
        axes[n % 3] *=
            pow(10, (n % 7 > 0) * (-0.6 + 1.6 * test_uniform(&seed)));
        ellipsoid_plane_table_set(axes, &own);
        for (int i = 0; i < 3; i++)
        {
            rates[i] = 1e-6 * test_signed(&seed);
            rates[i + 3] = test_signed(&seed);
            velocity[i] = 1e-6 * test_signed(&seed);
            velocity[i + 3] = test_signed(&seed);
            rates[i + 6] = test_signed(&seed);
            normal[i] = test_signed(&seed);
        }
        normal[n % 3] *= n % 5 ? 1 : 1e-3;
        {
            const double length = ellipsoid_length(normal);

            ellipsoid_set(normal, normal[0] / length, normal[1] / length,
                          normal[2] / length);
        }
        ellipsoid_plane_effect_set(&own, normal, gap, 1, &effect);
        for (int by = 0; by < 4; by++)
        {
            const double step = 1e-4;
            double slope[2][6] = {{0}};
            ellipsoid_dual exact[2][6], turned[3], motion[9];
            ellipsoid_plane_matrix at;

            for (int i = 0; i < 9; i++)
            {
                motion[i] = rates[i];
                turned[i % 3] =
                    normal[i % 3] + (i % 3 == by) * ELLIPSOID_DUAL_STEP * I;
            }
            ellipsoid_plane_matrix_at(&effect, turned, 0, &at);
            ellipsoid_plane_action(by < 3 ? &at : &effect.by_gap, motion,
                                   velocity, exact);
            for (int k = -2; k <= 2; k++)
            {
                double moved[3] = {normal[0], normal[1], normal[2]};
                double there[2][6], farther[2];
                ellipsoid_plane_effect other;

                for (int m = 0; m < 2; m++)
                {
                    farther[m] = gap[m] * (by == 3 ? 1 + k * step : 1);
                }
                if (by < 3)
                {
                    moved[by] += k * step;
                }
                ellipsoid_plane_effect_set(&own, moved, farther, 0, &other);
                action_of(&other, rates, velocity, there);
                for (int m = 0; m < 12; m++)
                {
                    slope[m / 6][m % 6] += weight[k + 2] * there[m / 6][m % 6]
                                         / (by == 3 ? step * gap[m / 6] : step);
                }
            }
            for (int m = 0; m < 4; m++)
            {
                const int first = m / 2 * 3;
                double size = 0;

                for (int i = first; i < first + 3; i++)
                {
                    size = fmax(size, fabs(slope[m % 2][i]));
                }
                for (int i = first; i < first + 3; i++)
                {
                    assert_near(cimag(exact[m % 2][i]) / ELLIPSOID_DUAL_STEP,
                                slope[m % 2][i], 1e-6 * size);
                }
            }
        }
    }
}

/* Symmetric and positive: the mobility exists, at any gap. */
static void test_positive(void **unused)
{
    uint64_t seed = 13;

    (void)unused;
    for (int n = 0; n < 4000; n++)
    {
        scene s =
            place_body(pow(10, test_uniform(&seed)), acos(test_uniform(&seed)));
        double r[6][6], d[6][2];

        evaluate_plane(&s, pow(10, -4 + 6 * test_uniform(&seed)), r, d);
        for (int j = 0; j < 6; j++)
        {
            for (int i = j; i < 6; i++)
            {
                assert_near(r[i][j], r[j][i],
                            1e-12 * sqrt(fabs(r[i][i] * r[j][j]) + 1));
                for (int k = 0; k < j; k++)
                {
                    r[i][j] -= r[i][k] * r[j][k];
                }
            }
            assert_true(r[j][j] > 0);
            for (int i = 5; i >= j; i--)
            {
                r[i][j] /= sqrt(r[j][j]);
            }
        }
    }
}

/* The spheroid of nearest shape, and which ones there are. */
static void test_shapes(void **unused)
{
    static const double cell[3] = {0.5, 2, 0.5}, uneven[3] = {3, 1, 1.21};
    static const double disc[3] = {1, 1, 0.35}, needle[3] = {1, 20.1, 1};
    static const double slim[3] = {1, 12, 1}, flat[3] = {1, 1, 0.25};
    ellipsoid_plane_table own;
    int axis;

    (void)unused;
    assert_near(ellipsoid_nearest_spheroid(cell, &axis), 4, 1e-12);
    assert_int_equal(axis, 1);
    assert_near(ellipsoid_nearest_spheroid(uneven, &axis), 3 / 1.1, 1e-12);
    assert_int_equal(axis, 0);
    assert_near(ellipsoid_nearest_spheroid(disc, &axis), 0.35, 1e-12);
    assert_int_equal(axis, 2);
    assert_true(ellipsoid_plane_table_has(disc));
    assert_false(ellipsoid_plane_table_has(needle));
    ellipsoid_plane_table_set(slim, &own);
    assert_near(own.ratio, 10, 1e-12);
    assert_near(own.radius, 1.2, 1e-12);
    ellipsoid_plane_table_set(flat, &own);
    assert_near(own.ratio, 1.0 / 3, 1e-12);
    assert_near(own.radius, 1, 1e-12);
    ellipsoid_plane_table_set(uneven, &own);
    assert_near(own.radius, 1.1, 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sphere),
        cmocka_unit_test(test_touching_sphere),
        cmocka_unit_test(test_slit_of_faxen),
        cmocka_unit_test(test_solver),
        cmocka_unit_test(test_change),
        cmocka_unit_test(test_positive),
        cmocka_unit_test(test_shapes),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
