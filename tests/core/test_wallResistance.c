/*
    ellipsoidTrapFoam: rigid ellipsoids in a viscous flow
    Copyright (C) 2026 the ellipsoidTrapFoam authors
    SPDX-License-Identifier: GPL-3.0-or-later

    test_wallResistance.c - resistance near one plane wall, against what is known of
    it from elsewhere.
*/
#include "coreTest.h"
#include "drag/wallResistance.h"
#include "wallMesh.h"

static const double up[3] = {0, 0, 1};

/* The whole resistance over mu, columns; the wall's normal is m (body). */
static void resistance(const ellipsoid_model *model, const double m[3],
                       double height, double matrix[6][6])
{
    ellipsoid_plane_matrix(model, m, height, matrix);
    for (int i = 0; i < 3; i++)
    {
        matrix[i][i] += model->resistance[i];
        matrix[i + 3][i + 3] += model->rotation_resistance[i];
    }
}

static ellipsoid_model body(double a1, double a2, double a3)
{
    ellipsoid_options o = test_free_cell();

    ellipsoid_set(o.semi_axes, a1, a2, a3);
    o.wall_resistance = ELLIPSOID_WALL_RESISTANCE_PLANE;
    o.wall_range = 1e6;
    o.lubrication_gap = 1e-12;
    return test_model(&o);
}

static double support(const ellipsoid_model *m, const double n[3])
{
    const double *a = m->options.semi_axes;

    return sqrt(pow(a[0] * n[0], 2) + pow(a[1] * n[1], 2)
                + pow(a[2] * n[2], 2));
}

static void random_direction(uint64_t *seed, double n[3])
{
    double length;

    do
    {
        ellipsoid_set(n, test_signed(seed), test_signed(seed),
                      test_signed(seed));
        length = ellipsoid_length(n);
    } while (length > 1 || length < 0.1);
    ellipsoid_set(n, n[0] / length, n[1] / length, n[2] / length);
}

static ellipsoid_model random_body(uint64_t *seed)
{
    double a[3];

    for (int i = 0; i < 3; i++)
    {
        a[i] = pow(10, 0.5 * test_signed(seed));
    }
    return body(a[0], a[1], a[2]);
}

/* Brenner, Chem. Eng. Sci. 16, 242 (1961), eq. 2.19: the drag of a sphere on
   its way to a plane, over that of the free one; an exact series. */
static double brenner(double s)
{
    const double alpha = acosh(1 / s);
    double sum = 0;

    for (int n = 1; n * alpha < 40; n++)
    {
        const double wide = sinh((n + 0.5) * alpha), odd = 2 * n + 1;

        sum += n * (n + 1.0) / ((2 * n - 1.0) * (2 * n + 3.0))
             * ((2 * sinh(odd * alpha) + odd * sinh(2 * alpha))
                    / (4 * wide * wide
                       - odd * odd * sinh(alpha) * sinh(alpha))
                - 1);
    }
    return 4.0 / 3 * sinh(alpha) * sum;
}

/*
    Towards the wall, against the exact series: mobilities agree to s^3, and of
    s^4 they differ by 1 - 135/256; 0.6 s^4. At any gap the drag is right to 4
    %, of which most is at a tenth of the radius.
*/
static void test_sphere_towards(void **unused)
{
    const ellipsoid_model m = body(1, 1, 1);
    double far = 0, worst = 0;

    (void)unused;
    for (double gap = 1e-3; gap < 60; gap *= 1.05)
    {
        const double s = 1 / (1 + gap), exact = brenner(s);
        double a[6][6];

        resistance(&m, up, 1 / s, a);
        assert_near(6 * test_pi / a[2][2], 1 / exact, 0.6 * s * s * s * s);
        assert_relative(a[2][2] / (6 * test_pi), exact, 0.04);
        worst = fmax(worst, fabs(a[2][2] / (6 * test_pi * exact) - 1));
        far = s <= 0.5 ? fmax(far, fabs(a[2][2] / (6 * test_pi * exact) - 1))
                       : far;
    }
    print_message("sphere towards: %.2e for s <= 0.5, %.2e at any\n", far,
                  worst);
}

/*
    Along the wall, far: Faxen (1923), in Happel and Brenner's book (1965), eq.
    7-4.28. The model is exact to s^3, of s^4 it is off by 45/256 - 2/15 = 0.04;
    0.2 s^4 with the terms after.
*/
static void test_sphere_along(void **unused)
{
    const ellipsoid_model m = body(1, 1, 1);
    double worst = 0;

    (void)unused;
    for (double s = 0.02; s <= 0.505; s += 0.02)
    {
        const double s3 = s * s * s;
        const double exact = 1 - 9 * s / 16 + s3 / 8 - 45 * s3 * s / 256
                           - s3 * s * s / 16;
        double a[6][6];

        resistance(&m, up, 1 / s, a);
        assert_near(6 * test_pi / a[0][0], exact, 0.2 * s3 * s);
        assert_near(6 * test_pi / a[1][1], exact, 0.2 * s3 * s);
        worst = fmax(worst, fabs(6 * test_pi / a[0][0] / exact - 1));
    }
    print_message("sphere along: %.2e for s <= 0.5\n", worst);
}

/*
    Close: Goldman, Cox and Brenner, Chem. Eng. Sci. 22, 637 (1967), eqs. 2.65,
    3.13 and after, with L = log(radius/gap):
        force by velocity 8/15 L + 0.9588, torque by it 1/10 L - 0.1895,
        torque by rotation 2/5 L + 0.3817, over 6 pi, 8 pi and 8 pi.
    The logarithms are the model's, so the constants are what is compared. At
    contact the model's are 0.8749, -0.1833 and 0.4229: within 0.09 and 0.05 of
    a free one's resistance. The torque by rotation about the normal is
    Jeffery's (1915) at contact, zeta(3) = 1.2021, against 1 + 1/16: 13 %.
*/
static void test_sphere_close(void **unused)
{
    const ellipsoid_model m = body(1, 1, 1);

    (void)unused;
    for (double gap = 1e-6; gap < 2e-3; gap *= 2)
    {
        const double l = -log(gap);
        double a[6][6];

        resistance(&m, up, 1 + gap, a);
        assert_near(a[0][0] / (6 * test_pi), 8 * l / 15 + 0.9588, 0.09);
        assert_near(-a[0][4] / (8 * test_pi), l / 10 - 0.1895, 0.05);
        assert_near(a[1][3] / (8 * test_pi), l / 10 - 0.1895, 0.05);
        assert_near(a[3][3] / (8 * test_pi), 2 * l / 5 + 0.3817, 0.05);
        assert_relative(a[5][5] / (8 * test_pi), 1.2021, 0.13);
    }
}

/* Rotation, far: 1 + 5/16 s^3 about an axis along the wall, 1 + 1/8 s^3 about
   its normal (Happel and Brenner 1965, table 7-4.1 and eq. 7-9.10). The next
   terms are 0.1 s^4 and s^6: 0.35 s^4. */
static void test_sphere_turning(void **unused)
{
    const ellipsoid_model m = body(1, 1, 1);

    (void)unused;
    for (double s = 0.02; s <= 0.505; s += 0.02)
    {
        double a[6][6];

        resistance(&m, up, 1 / s, a);
        assert_near(a[3][3] / (8 * test_pi), 1 + 5 * s * s * s / 16,
                    0.35 * pow(s, 4));
        assert_near(a[5][5] / (8 * test_pi), 1 + s * s * s / 8,
                    0.35 * pow(s, 4));
    }
}

/*
    Brenner (1962): a body of any shape has 1/K = 1/K_free - c/(6 pi h), with c
    = 9/16 along the wall and 9/8 towards it. A spheroid of 4:1 with its axis
    along and across, from two half-lengths b on; what is left is of order
    (b/h)^3.
*/
static void test_spheroid_far(void **unused)
{
    const ellipsoid_model m = body(0.5, 2, 0.5);
    const double normals[2][3] = {{0, 0, 1}, {0, 1, 0}};
    double worst = 0;

    (void)unused;
    for (double h = 4; h < 200; h *= 1.1)
    {
        for (int upright = 0; upright < 2; upright++)
        {
            double a[6][6];

            resistance(&m, normals[upright], h, a);
            for (int i = 0; i < 3; i++)
            {
                const double c = normals[upright][i] > 0 ? 9.0 / 8 : 9.0 / 16;
                const double k =
                    1 / (1 / m.resistance[i] - c / (6 * test_pi * h));

                assert_relative(a[i][i], k, 0.3 * pow(2 / h, 3));
                worst = fmax(worst, fabs(a[i][i] / k - 1));
            }
        }
    }
    print_message("spheroid from two half-lengths on: %.2e\n", worst);
}

/*
    Spheroids of 4:1 and 1:4 against a numerical solution: 500 point forces with
    their images inside the body, fitted to its motion at 900 points of the
    surface (method of fundamental solutions; spheres come out to 1e-4, these to
    some 2 %). The wall is below, the axis tilted out of it [degrees]; the six
    diagonal terms are force along x1, x2, x3, torque about them. Bounds as
    docs/theory.md tells them.
*/
static void test_spheroid_numerically(void **unused)
{
    static const struct known
    {
        double axes[3], tilt, gap, diagonal[6], bound;
    } known[] = {
        {{0.5, 2, 0.5}, 0, 0.25,
         {44.22, 28.7, 135.7, 106.6, 10.88, 56.27}, 0.25},
        {{0.5, 2, 0.5}, 0, 0.5,
         {35.45, 23.86, 75.92, 72.91, 9.827, 50.15}, 0.21},
        {{0.5, 2, 0.5}, 0, 1,
         {28.99, 20.37, 46.8, 54.51, 9.309, 45.82}, 0.13},
        {{0.5, 2, 0.5}, 0, 2,
         {24.71, 18.07, 32.56, 46.19, 9.121, 43.6}, 0.06},
        {{0.5, 2, 0.5}, 0, 4,
         {22.16, 16.67, 25.65, 43.41, 9.072, 42.86}, 0.03},
        {{0.5, 2, 0.5}, 45, 0.25,
         {30.51, 26, 44.7, 62.18, 29.95, 29.78}, 0.25},
        {{0.5, 2, 0.5}, 45, 0.5,
         {27.91, 23.96, 35.87, 52.53, 28.1, 28.02}, 0.21},
        {{0.5, 2, 0.5}, 45, 1,
         {25.42, 22.02, 29.18, 46.89, 26.85, 26.82}, 0.13},
        {{0.5, 2, 0.5}, 45, 2,
         {23.27, 20.34, 24.36, 44.08, 26.19, 26.18}, 0.06},
        {{0.5, 2, 0.5}, 45, 4,
         {21.67, 19.07, 21.2, 43.01, 25.94, 25.94}, 0.03},
        {{0.5, 2, 0.5}, 90, 0.25,
         {27.95, 27.94, 29.46, 48.72, 48.74, 9.131}, 0.25},
        {{0.5, 2, 0.5}, 90, 0.5,
         {26.2, 26.19, 25.48, 46.1, 46.11, 9.104}, 0.21},
        {{0.5, 2, 0.5}, 90, 1,
         {24.41, 24.41, 22.19, 44.26, 44.26, 9.082}, 0.13},
        {{0.5, 2, 0.5}, 90, 2,
         {22.78, 22.78, 19.6, 43.23, 43.24, 9.069}, 0.06},
        {{0.5, 2, 0.5}, 90, 4,
         {21.48, 21.47, 17.75, 42.81, 42.82, 9.063}, 0.03},
        {{2, 0.5, 2}, 0, 0.25,
         {41.42, 62.52, 84.61, 119, 137.4, 102}, 1.02},
        {{2, 0.5, 2}, 0, 0.5,
         {38.09, 55.67, 66.38, 108, 127.8, 99.07}, 0.29},
        {{2, 0.5, 2}, 0, 1,
         {34.81, 49.06, 51.77, 100.1, 120.3, 96.23}, 0.22},
        {{2, 0.5, 2}, 0, 2,
         {31.85, 43.38, 41.32, 95.57, 115.9, 94.17}, 0.08},
        {{2, 0.5, 2}, 0, 4,
         {29.5, 39.09, 34.48, 93.66, 113.9, 93.15}, 0.03},
        {{2, 0.5, 2}, 45, 0.25,
         {46.39, 60.87, 168.5, 199, 154.3, 122.2}, 1.02},
        {{2, 0.5, 2}, 45, 0.5,
         {41.33, 52.72, 114.4, 144.2, 133.6, 114.7}, 0.29},
        {{2, 0.5, 2}, 45, 1,
         {36.65, 45.21, 77.31, 113.6, 117.8, 108.8}, 0.22},
        {{2, 0.5, 2}, 45, 2,
         {32.74, 39.18, 54.91, 99.7, 108.4, 105.1}, 0.08},
        {{2, 0.5, 2}, 45, 4,
         {29.85, 34.93, 42.37, 94.63, 104.4, 103.5}, 0.03},
        {{2, 0.5, 2}, 90, 0.25,
         {75.55, 75.56, 893.3, 462.5, 457.8, 160.4}, 1.02},
        {{2, 0.5, 2}, 90, 0.5,
         {56.39, 56.42, 443.8, 265, 263.5, 138.6}, 0.29},
        {{2, 0.5, 2}, 90, 1,
         {43.4, 43.44, 177.6, 152, 151.5, 123.7}, 0.22},
        {{2, 0.5, 2}, 90, 2,
         {35.36, 35.4, 86.05, 109.4, 109.1, 116.2}, 0.08},
        {{2, 0.5, 2}, 90, 4,
         {30.73, 30.76, 54.28, 96.44, 96.21, 113.8}, 0.03},
    };

    (void)unused;
    for (size_t n = 0; n < sizeof known / sizeof *known; n++)
    {
        const ellipsoid_model m = body(known[n].axes[0], known[n].axes[1],
                                       known[n].axes[2]);
        const double c = cos(known[n].tilt * test_pi / 180);
        const double s = sin(known[n].tilt * test_pi / 180);
        const double normal[3] = {0, s, c};
        const double axes[3][3] = {{1, 0, 0}, {0, c, -s}, {0, s, c}};
        double a[6][6], worst = 0;

        resistance(&m, normal, support(&m, normal) + known[n].gap, a);
        for (int i = 0; i < 6; i++)
        {
            const double *axis = axes[i % 3];
            const int first = i < 3 ? 0 : 3;
            double sum = 0;

            for (int j = 0; j < 3; j++)
            {
                sum += axis[j] * ellipsoid_dot(a[first + j] + first, axis);
            }
            worst = fmax(worst, fabs(sum / known[n].diagonal[i] - 1));
            assert_relative(sum, known[n].diagonal[i], known[n].bound);
        }
        print_message("%g, tilt %2.0f, gap %.2f: %.3f\n", known[n].axes[0],
                      known[n].tilt, known[n].gap, worst);
    }
}

/* Reynolds' equation between a plane and a paraboloid of radii R1 and R2: 12 pi
   (R1 R2)^(3/2)/((R1 + R2) gap). At the ends of the axes of an ellipsoid R is
   a_j^2/a_i. What remains beside it is of the order of the gap and its log. */
static void test_squeezing(void **unused)
{
    uint64_t seed = 3;

    (void)unused;
    for (int n = 0; n < 50; n++)
    {
        const ellipsoid_model m = random_body(&seed);
        const double *axes = m.options.semi_axes;

        for (int i = 0; i < 3; i++)
        {
            const double aj = axes[(i + 1) % 3], ak = axes[(i + 2) % 3];
            const double r1 = aj * aj / axes[i], r2 = ak * ak / axes[i];
            const double gap = 1e-7 * fmin(r1, r2);
            double a[6][6], normal[3] = {0, 0, 0};

            normal[i] = 1;
            resistance(&m, normal, axes[i] + gap, a);
            assert_relative(a[i][i],
                            12 * test_pi * pow(r1 * r2, 1.5)
                                / ((r1 + r2) * gap),
                            1e-3);
        }
    }
}

/* Symmetric, and never less than free: its excess has Cholesky factors. */
static void test_positive(void **unused)
{
    uint64_t seed = 4;

    (void)unused;
    for (int n = 0; n < 3000; n++)
    {
        const ellipsoid_model m = random_body(&seed);
        const double gap = pow(10, 4 * test_signed(&seed));
        double normal[3], a[6][6];

        random_direction(&seed, normal);
        resistance(&m, normal, support(&m, normal) + gap, a);
        for (int i = 0; i < 6; i++)
        {
            a[i][i] -=
                i < 3 ? m.resistance[i] : m.rotation_resistance[i - 3];
            for (int j = 0; j < i; j++)
            {
                assert_near(a[i][j], a[j][i],
                            1e-12 * sqrt(a[i][i] * a[j][j])
                                + 1e-15 * m.rotation_resistance[0]);
            }
        }
        for (int i = 0; i < 6; i++)
        {
            /* what rounding may take: the free one's digits */
            const double own =
                i < 3 ? m.resistance[i] : m.rotation_resistance[i - 3];

            a[i][i] += 1e-13 * own + 1e-13 * a[i][i];
            assert_true(a[i][i] > 0);
            for (int j = i + 1; j < 6; j++)
            {
                for (int k = i + 1; k < 6; k++)
                {
                    a[j][k] -= a[j][i] * a[i][k] / a[i][i];
                }
            }
        }
    }
}

/* At the cut-off it stays what it is there, however deep the overlap. */
static void test_cut_off(void **unused)
{
    ellipsoid_model m = body(0.5, 2, 0.5);
    double at_zero[6][6], below[6][6], above[6][6];

    (void)unused;
    m.options.lubrication_gap = 0.01;
    resistance(&m, up, 0.5, at_zero);
    resistance(&m, up, 0.2, below);
    assert_relative(at_zero[2][2], below[2][2], 1e-14);
    resistance(&m, up, 0.52, above);
    m.options.lubrication_gap = 1e-6;
    resistance(&m, up, 0.52, below);
    assert_relative(above[2][2], below[2][2], 1e-14);
    resistance(&m, up, 0.51, below);
    assert_relative(at_zero[2][2], below[2][2], 1e-14);
}

/* Derivatives by normal and height against central differences of the fourth
   order, steps of 1e-3 of the gap; these leave some 1e-9. */
static void test_change(void **unused)
{
    uint64_t seed = 5;

    (void)unused;
    for (int n = 0; n < 300; n++)
    {
        ellipsoid_model m = random_body(&seed);
        const double gap = pow(10, -1.5 + 1.5 * test_signed(&seed));
        double normal[3], rates[6], action[6], change[4][6], height;

        m.options.lubrication_gap = n % 2 ? 1e-6 : gap;
        random_direction(&seed, normal);
        for (int i = 0; i < 6; i++)
        {
            rates[i] = test_signed(&seed);
        }
        height = support(&m, normal) + gap;
        ellipsoid_plane_resistance(&m, normal, height, rates, action, change);
        for (int v = 0; v < 4; v++)
        {
            const double h = 1e-3 * gap;
            double difference[6] = {0}, size = 0;

            for (int p = -2; p <= 2; p++)
            {
                static const double weight[] = {1.0 / 12, -2.0 / 3, 0, 2.0 / 3,
                                                -1.0 / 12};
                double moved[3];

                ellipsoid_copy(normal, moved);
                if (v < 3)
                {
                    moved[v] += p * h;
                }
                ellipsoid_plane_resistance(&m, moved,
                                           height + (v == 3 ? p * h : 0), rates,
                                           action, NULL);
                for (int i = 0; i < 6; i++)
                {
                    difference[i] += weight[p + 2] * action[i] / h;
                }
            }
            for (int i = 0; i < 6; i++)
            {
                size = fmax(size, fabs(change[v][i]));
            }
            for (int i = 0; i < 6; i++)
            {
                assert_near(change[v][i], difference[i], 1e-7 * size);
            }
        }
    }
}

/*
    A heavy sphere of 1 um falls from a gap of 3 to one of 0.05 radii, without
    inertia. The time is the integral of Brenner's exact drag over the force, by
    Simpson's rule to 1e-6; the drag is right to 2 % (above).
*/
static void test_fall(void **unused)
{
    static ellipsoid_facet_cache cache;
    const double corner[3] = {-1e-4, -1e-4, 0};
    const double along[3] = {2e-4, 0, 0}, across[3] = {0, 2e-4, 0};
    const double radius = 1e-6, top = 3, bottom = 0.05;
    ellipsoid_options o = test_free_cell();
    ellipsoid_state state = {.x = {0, 0, (1 + 3) * 1e-6}, .q = {0, 0, 0, 1}};
    ellipsoid_controller controller = {0};
    ellipsoid_statistics statistics = {0};
    test_quadratic rest = {.answer = 0};
    double t = 0, exact = 0;
    const int pieces = 400;
    ellipsoid_model m;
    wall_mesh mesh;

    (void)unused;
    ellipsoid_set(o.semi_axes, radius, radius, radius);
    o.motion = ELLIPSOID_MOTION_INERTIALESS;
    o.wall_resistance = ELLIPSOID_WALL_RESISTANCE_PLANE;
    o.wall_range = 20e-6;
    o.external_force[2] = -1e-12;
    m = test_model(&o);
    wall_mesh_init(&mesh);
    wall_mesh_plane(&mesh, corner, along, across, 1, 1, 0, 0);
    wall_mesh_finish(&mesh);
    for (int n = 0; n <= pieces; n++)
    {
        /* in the logarithm of the gap */
        const double width = log(top / bottom) / pieces;
        const double gap = bottom * exp(n * width);
        const double weight = n == 0 || n == pieces ? 1 : n % 2 ? 4 : 2;

        exact += weight * width / 3 * gap * brenner(1 / (1 + gap));
    }
    exact *= radius * 6 * test_pi * m.viscosity * radius / 1e-12;
    {
        const ellipsoid_surroundings s = {.flow = test_quadratic_flow,
                                          .flow_context = &rest,
                                          .walls = wall_mesh_list,
                                          .walls_context = &mesh};

        ellipsoid_facet_cache_clear(&cache);
        assert_ok(ellipsoid_advance(
            &(ellipsoid_member){&m, &s, &state, &controller, &cache, NULL,
                                &statistics},
            &t, exact, NULL));
    }
    /* the rest of the way, at the speed it has there */
    exact += (state.x[2] - (1 + bottom) * radius) / state.u[2];
    assert_relative(t, exact, 0.02);
    print_message("fall: %.4f of the exact time, %ld steps\n", t / exact,
                  statistics.accepted);
    wall_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sphere_towards),
        cmocka_unit_test(test_sphere_along),
        cmocka_unit_test(test_sphere_close),
        cmocka_unit_test(test_sphere_turning),
        cmocka_unit_test(test_spheroid_far),
        cmocka_unit_test(test_spheroid_numerically),
        cmocka_unit_test(test_squeezing),
        cmocka_unit_test(test_positive),
        cmocka_unit_test(test_cut_off),
        cmocka_unit_test(test_change),
        cmocka_unit_test(test_fall),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
