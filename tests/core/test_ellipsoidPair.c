/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_ellipsoidPair.c - depth and distance of two ellipsoids, and derivatives.
*/
#include "coreTest.h"
#include "contact/contact.h"

/* An ellipsoid of three different axes of order one. */
static ellipsoid_surface random_body(uint64_t *seed, double far)
{
    const double axes[3] = {0.4 + test_uniform(seed), 0.4 + test_uniform(seed),
                            0.4 + 2 * test_uniform(seed)};
    ellipsoid_surface body;
    double x[3], q[4];

    for (int i = 0; i < 3; i++)
    {
        x[i] = far * test_signed(seed);
    }
    test_orientation(seed, q);
    ellipsoid_surface_set(axes, x, q, &body);
    return body;
}

static double support(const ellipsoid_surface *body, const double n[3])
{
    double sum = 0;

    for (int i = 0; i < 3; i++)
    {
        sum += n[i] * ellipsoid_dot(body->shape[i], n);
    }
    return sqrt(sum);
}

static double phi(const ellipsoid_surface *a, const ellipsoid_surface *b,
                  const double n[3])
{
    double line[3];

    ellipsoid_difference(a->centre, b->centre, line);
    return support(a, n) + support(b, n) - ellipsoid_dot(n, line);
}

/* The least phi on the sphere by search: 3000 directions, then ever finer about
   the best, to 1e-8 in direction, which leaves 1e-15 in phi. */
static double searched(const ellipsoid_surface *a, const ellipsoid_surface *b,
                       uint64_t *seed)
{
    double best[3] = {1, 0, 0}, least = HUGE_VAL;

    for (int n = 0; n < 9000; n++)
    {
        const double width = n < 3000 ? 0 : pow(10, -8.0 * (n - 3000) / 6000);
        double at[3], length;

        for (int i = 0; i < 3; i++)
        {
            at[i] = width > 0 ? best[i] + width * test_signed(seed)
                              : test_signed(seed);
        }
        length = ellipsoid_length(at);
        ellipsoid_set(at, at[0] / length, at[1] / length, at[2] / length);
        if (phi(a, b, at) < least)
        {
            least = phi(a, b, at);
            ellipsoid_copy(at, best);
        }
    }
    return least;
}

/* Two spheres: the distance of centres less the radii. */
static void test_spheres(void **unused)
{
    const double small[3] = {0.5, 0.5, 0.5}, large[3] = {2, 2, 2};
    const double x[3] = {1, 2, 2.5}, origin[3] = {0, 0, 0};
    const double q[4] = {0.1, 0.7, 0.1, 0.7};
    ellipsoid_surface a, b;
    ellipsoid_surface_pair pair;

    (void)unused;
    ellipsoid_surface_set(small, x, q, &a);
    ellipsoid_surface_set(large, origin, q, &b);
    ellipsoid_surface_pair_set(&a, &b, 0, &pair);
    assert_near(pair.depth, 2.5 - sqrt(11.25), 1e-14);
    for (int i = 0; i < 3; i++)
    {
        assert_near(pair.normal[i], x[i] / sqrt(11.25), 1e-14);
        assert_near(pair.point_a[i], -0.5 * pair.normal[i], 1e-14);
        assert_near(pair.point_b[i], 2 * pair.normal[i], 1e-14);
    }
}

/* Against search; points lie on both surfaces, the depth apart along n. */
static void test_against_search(void **unused)
{
    uint64_t seed = 4;
    int apart = 0, overlapping = 0;

    (void)unused;
    for (int n = 0; n < 200; n++)
    {
        const ellipsoid_surface a = random_body(&seed, 2);
        const ellipsoid_surface b = random_body(&seed, 2);
        const double least = searched(&a, &b, &seed);
        ellipsoid_surface_pair pair;

        if (least > 0.1)
        {
            continue; /* deeper than any contact */
        }
        ellipsoid_surface_pair_set(&a, &b, 0, &pair);
        assert_near(pair.depth, least, 1e-9);
        for (int i = 0; i < 3; i++)
        {
            assert_near(a.centre[i] + pair.point_a[i]
                            + pair.depth * pair.normal[i],
                        b.centre[i] + pair.point_b[i], 1e-12);
        }
        apart += least < 0;
        overlapping += least > 0;
    }
    assert_true(apart > 50 && overlapping > 5);
}

/* Long and flat bodies, where whole steps of Newton's method go too far: at the
   minimum the points on both surfaces are the depth apart along n. */
static void test_long_and_flat(void **unused)
{
    uint64_t seed = 14;
    int apart = 0;

    (void)unused;
    for (int n = 0; n < 20000; n++)
    {
        ellipsoid_surface body[2];
        ellipsoid_surface_pair pair;

        for (int k = 0; k < 2; k++)
        {
            const double axes[3] = {pow(10, -2 * test_uniform(&seed)),
                                    pow(10, -2 * test_uniform(&seed)), 1};
            double x[3], q[4];

            for (int i = 0; i < 3; i++)
            {
                x[i] = test_signed(&seed);
            }
            test_orientation(&seed, q);
            ellipsoid_surface_set(axes, x, q, &body[k]);
        }
        ellipsoid_surface_pair_set(&body[0], &body[1], 0, &pair);
        if (pair.depth > 0)
        {
            continue;
        }
        apart++;
        for (int i = 0; i < 3; i++)
        {
            assert_near(body[0].centre[i] + pair.point_a[i]
                            + pair.depth * pair.normal[i],
                        body[1].centre[i] + pair.point_b[i], 1e-11);
        }
    }
    assert_true(apart > 10000);
}

/* Turns a body about the lab's axis k, or moves it along. */
static ellipsoid_surface changed(const ellipsoid_surface *body, int k,
                                 double by)
{
    ellipsoid_surface result;
    double x[3], q[4];

    ellipsoid_copy(body->centre, x);
    memcpy(q, body->q, sizeof(q));
    if (k < 3)
    {
        x[k] += by;
    }
    else
    {
        const double turn[4] = {k == 3 ? sin(by / 2) : 0,
                                k == 4 ? sin(by / 2) : 0,
                                k == 5 ? sin(by / 2) : 0, cos(by / 2)};
        double cross[3];

        ellipsoid_cross(turn, body->q, cross);
        for (int i = 0; i < 3; i++)
        {
            q[i] = turn[3] * body->q[i] + body->q[3] * turn[i] + cross[i];
        }
        q[3] = turn[3] * body->q[3] - ellipsoid_dot(turn, body->q);
    }
    ellipsoid_surface_set(body->axes, x, q, &result);
    return result;
}

/* Central differences of 1e-5 leave 1e-10 of second differences, and rounding
   of 1e-10; slopes of n are up to 10 here. */
static void test_derivatives(void **unused)
{
    const double h = 1e-5;
    uint64_t seed = 9;

    (void)unused;
    for (int n = 0; n < 100; n++)
    {
        const ellipsoid_surface a = random_body(&seed, 2);
        const ellipsoid_surface b = random_body(&seed, 2);
        ellipsoid_surface_pair pair;

        ellipsoid_surface_pair_set(&a, &b, 1, &pair);
        if (pair.depth > 0.05 || pair.depth < -1)
        {
            continue;
        }
        for (int k = 0; k < ELLIPSOID_PAIR_VARIABLES; k++)
        {
            ellipsoid_surface_pair side[2];

            for (int s = 0; s < 2; s++)
            {
                const double by = s ? h : -h;
                const ellipsoid_surface moved =
                    k < 6 ? changed(&a, k, by) : changed(&b, k - 3, by);

                ellipsoid_surface_pair_set(k < 6 ? &moved : &a,
                                           k < 6 ? &b : &moved, 0, &side[s]);
            }
            assert_near((side[1].depth - side[0].depth) / (2 * h),
                        pair.depth_slope[k], 1e-8);
            for (int i = 0; i < 3; i++)
            {
                assert_near((side[1].normal[i] - side[0].normal[i]) / (2 * h),
                            pair.normal_slope[i][k], 1e-7);
                assert_near((side[1].point_a[i] - side[0].point_a[i]) / (2 * h),
                            pair.point_a_slope[i][k], 1e-7);
                assert_near((side[1].point_b[i] - side[0].point_b[i]) / (2 * h),
                            pair.point_b_slope[i][k], 1e-7);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_spheres),
        cmocka_unit_test(test_against_search),
        cmocka_unit_test(test_long_and_flat),
        cmocka_unit_test(test_derivatives),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
