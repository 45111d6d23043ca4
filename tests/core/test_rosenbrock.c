/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_rosenbrock.c - the coefficients of the method: order, stability, stiffly
    accurate ends, continuous extension.
*/
#include "flowTest.h"

#include <complex.h>

enum
{
    S = ELLIPSOID_STAGES
};

/* ------------------------------------------------------------ coefficients */

/*
    The method in the form of Hairer & Wanner II, eq. (IV.7.4). From (IV.7.25):
    Gamma = (I/gamma - C)^-1, alpha = A Gamma, b = m Gamma.
*/
typedef struct method
{
    double alpha[S][S], beta[S][S]; /* beta = alpha + gamma */
    double a[S], bb[S];             /* their row sums */
    double b[S], embedded[S];
    double gamma[S][S];
} method;

/* row Gamma */
static void times_gamma(double gamma[S][S], const double row[S],
                        double result[S])
{
    for (int j = 0; j < S; j++)
    {
        result[j] = 0;
        for (int k = 0; k < S; k++)
        {
            result[j] += row[k] * gamma[k][j];
        }
    }
}

static method standard_form(const ellipsoid_rosenbrock_table *t)
{
    method m;
    double gamma[S][S] = {{0}}, weights[S];

    for (int j = 0; j < S; j++)
    {
        for (int i = j; i < S; i++)
        {
            double sum = i == j;

            for (int k = j; k < i; k++)
            {
                sum += t->c[i][k] * gamma[k][j];
            }
            gamma[i][j] = t->gamma * sum;
        }
    }
    memcpy(m.gamma, gamma, sizeof(gamma));
    for (int i = 0; i < S; i++)
    {
        times_gamma(gamma, t->a[i], m.alpha[i]);
        m.a[i] = m.bb[i] = 0;
        for (int j = 0; j < S; j++)
        {
            m.beta[i][j] = m.alpha[i][j] + gamma[i][j];
            m.a[i] += m.alpha[i][j];
            m.bb[i] += m.beta[i][j];
        }
    }
    memcpy(weights, t->a[S - 1], sizeof(weights));
    times_gamma(gamma, weights, m.embedded);
    weights[S - 1] = 1;
    times_gamma(gamma, weights, m.b);
    return m;
}

static double sum1(const double b[S], const double x[S])
{
    double sum = 0;

    for (int i = 0; i < S; i++)
    {
        sum += b[i] * x[i];
    }
    return sum;
}

static void apply(const double matrix[S][S], const double x[S], double y[S])
{
    for (int i = 0; i < S; i++)
    {
        y[i] = sum1(matrix[i], x);
    }
}

/* Conditions up to order 3 for weights that stand for a step of length s. */
static void check_third_order(method *m, const double b[S], double s,
                              double tolerance)
{
    double one[S], aa[S], bbb[S];

    for (int i = 0; i < S; i++)
    {
        one[i] = 1;
        aa[i] = m->a[i] * m->a[i];
    }
    apply((const double(*)[S])m->beta, m->bb, bbb);
    assert_near(sum1(b, one), s, tolerance);
    assert_near(sum1(b, m->bb), s * s / 2, tolerance);
    assert_near(sum1(b, aa), s * s * s / 3, tolerance);
    assert_near(sum1(b, bbb), s * s * s / 6, tolerance);
}

/* Hairer & Wanner II, table IV.7.1: the eight conditions of order 4, and those
   of order 3 for the embedded solution. Printed to 16 digits, coefficients up
   to 34: 1e-13. */
static void test_order_conditions(void **unused)
{
    method m = standard_form(&ellipsoid_rosenbrock_set);
    double aaa[S], aa[S], ab[S], baa[S], bb[S], bbb[S];

    (void)unused;
    check_third_order(&m, m.b, 1, 1e-13);
    check_third_order(&m, m.embedded, 1, 1e-13);

    apply((const double(*)[S])m.alpha, m.bb, ab);
    for (int i = 0; i < S; i++)
    {
        aa[i] = m.a[i] * m.a[i];
        aaa[i] = aa[i] * m.a[i];
        ab[i] *= m.a[i];
    }
    apply((const double(*)[S])m.beta, aa, baa);
    apply((const double(*)[S])m.beta, m.bb, bb);
    apply((const double(*)[S])m.beta, bb, bbb);
    assert_near(sum1(m.b, aaa), 1.0 / 4, 1e-13);
    assert_near(sum1(m.b, ab), 1.0 / 8, 1e-13);
    assert_near(sum1(m.b, baa), 1.0 / 12, 1e-13);
    assert_near(sum1(m.b, bbb), 1.0 / 24, 1e-13);
}

/* Stiffly accurate: b_i is beta of the last stage and the embedded one that of
   the last but one; these two are at the end of the step. */
static void test_stiffly_accurate(void **unused)
{
    const method m = standard_form(&ellipsoid_rosenbrock_set);
    const int last = S - 1;

    (void)unused;
    for (int i = 0; i < S; i++)
    {
        assert_near(m.b[i], m.beta[last][i], 1e-13);
        assert_near(m.embedded[i], m.beta[last - 1][i], 1e-13);
    }
    assert_near(m.a[last], 1, 1e-13);
    assert_near(m.a[last - 1], 1, 1e-13);
}

/* R(z) = 1 + z b^T (I - z beta)^-1 1 */
static double complex stability(const method *m, double complex z)
{
    double complex k[S], r = 1;

    for (int i = 0; i < S; i++)
    {
        double complex sum = 1;

        for (int j = 0; j < i; j++)
        {
            sum += z * m->beta[i][j] * k[j];
        }
        k[i] = sum / (1 - z * m->beta[i][i]);
        r += z * m->b[i] * k[i];
    }
    return r;
}

/* |R| <= 1 on the imaginary axis and no pole to its left make it A-stable;
   with R(infinity) = 0, L-stable. */
static void test_l_stable(void **unused)
{
    const method m = standard_form(&ellipsoid_rosenbrock_set);

    (void)unused;
    for (double y = 1e-3; y < 1e6; y *= 1.01)
    {
        assert_true(cabs(stability(&m, y * I)) <= 1 + 1e-13);
    }
    for (double x = 1e2; x < 1e8; x *= 10)
    {
        /* falls like 1/x, down to the rounding of the coefficients */
        assert_true(cabs(stability(&m, -x)) <= 10 / x + 1e-10);
    }
    assert_near(creal(stability(&m, -1)), exp(-1), 1e-3);
}

/* The continuous extension is of order 3 at every point of the step. */
static void test_dense_order_conditions(void **unused)
{
    const ellipsoid_rosenbrock_table *t = &ellipsoid_rosenbrock_set;
    method m = standard_form(t);

    (void)unused;
    for (double s = 0; s <= 1; s += 0.125)
    {
        double weights[S], b[S];

        for (int j = 0; j < S; j++)
        {
            const double end = t->a[S - 1][j] + (j == S - 1);

            weights[j] =
                s * (end + (1 - s) * (t->dense[0][j] + s * t->dense[1][j]));
        }
        times_gamma(m.gamma, weights, b);
        check_third_order(&m, b, s, 1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_order_conditions),
        cmocka_unit_test(test_stiffly_accurate),
        cmocka_unit_test(test_l_stable),
        cmocka_unit_test(test_dense_order_conditions),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
