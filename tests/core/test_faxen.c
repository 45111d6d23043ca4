/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_faxen.c - the flow over the body: quadrature and Faxen's laws.
*/
#include "faxenTest.h"

/* A sphere, a triaxial body and a slender one, and how many points they have. */
static const struct
{
    double axes[3];
    int points;
} bodies[] = {
    {{0.8, 0.8, 0.8}, 12}, {{0.3, 1.7, 0.9}, 12}, {{0.5, 2, 0.4}, 10}};

static ellipsoid_model body_of(int n)
{
    const double *a = bodies[n % 3].axes;

    return body(a[0], a[1], a[2]);
}

/* Mean of n1^a n2^b n3^c over the unit sphere: 0 if one is odd, else
   (a-1)!! (b-1)!! (c-1)!! / (a+b+c+1)!! (Folland, Am. Math. Mon. 108, 446,
   2001). */
static double mean_of_monomial(int a, int b, int c)
{
    const int power[3] = {a, b, c};
    double mean = 1;
    int total = 1;

    for (int i = 0; i < 3; i++)
    {
        if (power[i] % 2)
        {
            return 0;
        }
        for (int n = 1; n < power[i]; n += 2)
        {
            mean *= n;
        }
        total += power[i];
    }
    for (int n = 1; n <= total; n += 2)
    {
        mean /= n;
    }
    return mean;
}

/* Of monomials of at most `across` factors n1, n3. */
static double worst_of_degree(const ellipsoid_model *m, int degree, int across)
{
    const double *axes = m->options.semi_axes;
    double worst = 0;

    for (int a = 0; a <= degree; a++)
    {
        for (int c = 0; a + c <= degree && a + c <= across; c++)
        {
            const int b = degree - a - c;
            double sum = 0;

            for (int p = 0; p < m->flow_points; p++)
            {
                const double *x = m->flow_point[p];

                sum += m->flow_weight[p] * pow(x[0] / axes[0], a)
                     * pow(x[1] / axes[1], b) * pow(x[2] / axes[2], c);
            }
            worst = fmax(worst, fabs(sum - mean_of_monomial(a, b, c)));
        }
    }
    return worst;
}

/* Exact to rounding up to the degree, and not beyond it. */
static void test_quadrature(void **unused)
{
    static const test_row row = {"free motion",
                                 "error of means of monomials over a sphere",
                                 "10 and 12 points, up to their degree",
                                 "Folland, Am. Math. Mon. 108, 446 (2001)",
                                 "A",
                                 "rounding",
                                 0};

    (void)unused;
    for (int n = 0; n < 3; n++)
    {
        const ellipsoid_model m = body_of(n);
        const int slender = bodies[n].points == 10;

        assert_int_equal(m.flow_points, bodies[n].points);
        for (int degree = 0; degree <= 5; degree++)
        {
            assert_row(&row, worst_of_degree(&m, degree, slender ? 3 : 5), 0,
                       1e-15);
        }
        assert_true(worst_of_degree(&m, slender ? 4 : 6, 6) > 1e-6);
    }
}

static test_quadratic random_flow(uint64_t *seed, double curvature)
{
    test_quadratic f = {.answer = 0};

    for (int i = 0; i < 3; i++)
    {
        f.u[i] = test_signed(seed);
        for (int j = 0; j < 3; j++)
        {
            f.g[i][j] = test_signed(seed);
            for (int k = 0; k <= j; k++)
            {
                f.h[i][j][k] = f.h[i][k][j] = curvature * test_signed(seed);
            }
        }
    }
    return f;
}

/* Brenner (1964): a linear flow does what Jeffery (1922) says. Rounding. */
static void test_linear_flow(void **unused)
{
    uint64_t seed = 5;

    (void)unused;
    for (int n = 0; n < 80; n++)
    {
        ellipsoid_model m = body_of(n);
        test_quadratic flow = random_flow(&seed, 0);
        double x[3], q[4], u[2][3], omega[2][3];

        test_orientation(&seed, q);
        ellipsoid_set(x, test_signed(&seed), test_signed(&seed), 0.3);
        free_motion(&m, test_quadratic_flow, &flow, x, q, u[0], omega[0]);
        m.options.flow_at = ELLIPSOID_FLOW_CENTRE;
        m = test_model(&m.options);
        assert_int_equal(m.flow_points, 0);
        free_motion(&m, test_quadratic_flow, &flow, x, q, u[1], omega[1]);
        for (int i = 0; i < 3; i++)
        {
            assert_near(u[0][i], u[1][i], 1e-14);
            assert_near(omega[0][i], omega[1][i], 1e-14);
        }
    }
}

/*
    A flow of second degree: <u> = u + 1/6 sum_j a_j^2 d^2u/dx^_j^2 (Brenner
    1964), for a sphere Faxen's (1 + a^2/6 laplacian) u; the torque is that of
    the centre. Rounding.
*/
static void test_quadratic_flow_moves(void **unused)
{
    static const test_row row = {
        "free motion",
        "error of the velocity in a quadratic flow, flow body",
        "a sphere, a triaxial and a slender body",
        "Faxen (1922); Brenner, Chem. Eng. Sci. 19, 703 (1964)",
        "A",
        "rounding",
        0};
    uint64_t seed = 6;

    (void)unused;
    for (int n = 0; n < 80; n++)
    {
        const int sphere = n % 3 == 0;
        ellipsoid_model m = body_of(n);
        const double *a = m.options.semi_axes;
        test_quadratic flow = random_flow(&seed, 1);
        double x[3], q[4], u[3], omega[3], u_c[3], omega_c[3], r[3][3];

        test_orientation(&seed, q);
        ellipsoid_set(x, test_signed(&seed), test_signed(&seed), 0.3);
        ellipsoid_rotation(q, r);
        free_motion(&m, test_quadratic_flow, &flow, x, q, u, omega);
        m.options.flow_at = ELLIPSOID_FLOW_CENTRE;
        m = test_model(&m.options);
        free_motion(&m, test_quadratic_flow, &flow, x, q, u_c, omega_c);
        for (int i = 0; i < 3; i++)
        {
            double mean = u_c[i];

            for (int j = 0; j < 3; j++)
            {
                for (int k = 0; k < 3; k++)
                {
                    for (int b = 0; b < 3; b++)
                    {
                        mean += a[b] * a[b] * r[j][b] * r[k][b]
                              * flow.h[i][j][k] / 6;
                    }
                }
            }
            if (sphere)
            {
                assert_near(u[i],
                            u_c[i]
                                + a[0] * a[0] / 6
                                      * (flow.h[i][0][0] + flow.h[i][1][1]
                                         + flow.h[i][2][2]),
                            1e-14);
            }
            assert_row(&row, u[i] - mean, 0, 1e-14);
            assert_near(omega[i], omega_c[i], 1e-14);
        }
    }
}

/* u_i = (k_i . x)^degree: polynomials of any degree. */
typedef struct powers
{
    double k[3][3];
    int degree;
} powers;

static int power_flow(void *context, double t, const double x[3],
                      int derivatives, ellipsoid_flow_sample *f)
{
    const powers *p = context;

    (void)t;
    (void)derivatives;
    memset(f, 0, sizeof(*f));
    for (int i = 0; i < 3; i++)
    {
        f->velocity[i] = pow(ellipsoid_dot(p->k[i], x), p->degree);
    }
    return 0;
}

/*
    Twelve points give the force of flows up to degree 5 and the torque of those
    up to 4, and not of the next: with kappa_i = A R^T k_i, n over the unit sphere,
    <(kappa.n)^d> = |kappa|^d/(d + 1), d even, and <n (kappa.n)^d> =
    kappa |kappa|^(d - 1)/(d + 2), d odd.
*/
static void test_degree_of_flow(void **unused)
{
    const double q[4] = {0.1, 0.3, 0.3, 0.9},
                 x[3] = {0, 0, 0}; /* of length 1 */
    const ellipsoid_model m = body(0.5, 0.9, 0.7);
    const double *a = m.options.semi_axes;
    double r[3][3];
    uint64_t seed = 7;
    powers flow;

    (void)unused;
    ellipsoid_rotation(q, r);
    for (int i = 0; i < 9; i++)
    {
        flow.k[i / 3][i % 3] = test_signed(&seed);
    }
    for (flow.degree = 0; flow.degree <= 6; flow.degree++)
    {
        const int odd = flow.degree % 2;
        double u[3], omega[3], mean[3] = {0}, moment[3][3] = {{0}};
        double force = 0, torque = 0;

        free_motion(&m, power_flow, &flow, x, q, u, omega);
        for (int i = 0; i < 3; i++)
        {
            double kappa[3], size;

            for (int j = 0; j < 3; j++)
            {
                kappa[j] = a[j]
                         * (r[0][j] * flow.k[i][0] + r[1][j] * flow.k[i][1]
                            + r[2][j] * flow.k[i][2]);
            }
            size = ellipsoid_length(kappa);
            mean[i] = odd ? 0 : pow(size, flow.degree) / (flow.degree + 1);
            for (int j = 0; odd && j < 3; j++)
            {
                for (int k = 0; k < 3; k++)
                {
                    moment[j][k] += a[j] * r[i][k] * kappa[j]
                                  * pow(size, flow.degree - 1)
                                  / (flow.degree + 2);
                }
            }
        }
        for (int i = 0; i < 3; i++)
        {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            const double turn =
                3 * (moment[j][k] - moment[k][j]) / (a[j] * a[j] + a[k] * a[k]);

            force = fmax(force, fabs(u[i] - mean[i]));
            torque = fmax(torque, fabs(omega[i] - turn));
        }
        assert_true(flow.degree > 5 ? force > 1e-5 : force < 1e-14);
        assert_true(flow.degree == 5 ? torque > 1e-5 : torque < 1e-14);
    }
}

/* A shear above the wall x3 = 0, where the flow is told to end. */
static int shear_above(void *context, double t, const double x[3],
                       int derivatives, ellipsoid_flow_sample *f)
{
    (void)t;
    (void)context;
    (void)derivatives;
    memset(f, 0, sizeof(*f));
    f->velocity[0] = x[2];
    f->gradient[0][2] = 1;
    return x[2] < 0;
}

static int calls;

static int velocities_above(void *context, double t, const double centre[3],
                            int count, double (*points)[3],
                            double (*velocity)[3], double (*jacobian)[3][3])
{
    (void)t;
    (void)context;
    (void)jacobian;
    assert_true(centre[2] == 0.2);
    calls++;
    for (int p = 0; p < count; p++)
    {
        ellipsoid_set(velocity[p], fmax(points[p][2], 0), 0, 0);
    }
    return 0;
}

/* Points beyond the wall see its velocity, zero; by either callback. */
static void test_beyond_a_wall(void **unused)
{
    const ellipsoid_model m = body(1, 1, 1);
    ellipsoid_surroundings around = {.flow = shear_above};
    ellipsoid_state s[2] = {{.x = {0, 0, 0.2}, .q = {0, 0, 0, 1}},
                            {.x = {0, 0, 0.2}, .q = {0, 0, 0, 1}}};
    double mean = 0;

    (void)unused;
    for (int p = 0; p < m.flow_points; p++)
    {
        mean += m.flow_weight[p] * fmax(0, 0.2 + m.flow_point[p][2]);
    }
    assert_ok(ellipsoid_balance(&m, &around, &s[0], NULL));
    around.velocities = velocities_above;
    assert_ok(ellipsoid_balance(&m, &around, &s[1], NULL));
    assert_int_equal(calls, 1);
    assert_near(s[0].u[0], mean, 1e-15);
    for (int i = 0; i < 3; i++)
    {
        assert_near(s[0].u[i], s[1].u[i], 1e-15);
        assert_near(s[0].omega[i], s[1].omega[i], 1e-15);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_quadrature),
        cmocka_unit_test(test_linear_flow),
        cmocka_unit_test(test_quadratic_flow_moves),
        cmocka_unit_test(test_degree_of_flow),
        cmocka_unit_test(test_beyond_a_wall),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
