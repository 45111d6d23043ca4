/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_beads.c - the envelope of the bead layouts against the figures that
    docs/beadShapes.md gives for them, and what is refused.
*/
#include "coreTest.h"

/* What a plane, or an edge, meets on a body of beads. */
typedef struct envelope
{
    double length, width; /* along x^2; largest across it */
    double narrowest;     /* gap between parallel plates it can pass */
    double over, under;   /* plane against the ellipsoid's own support */
    double valley;        /* deepest, along the ellipsoid's normal */
} envelope;

static double extent(double bead[][3], int n, const double u[3])
{
    double support = -HUGE_VAL;

    for (int b = 0; b < n; b++)
    {
        support = fmax(support, ellipsoid_dot(bead[b], u));
    }
    return support;
}

/* How far a line from the point, against the normal, misses the beads. */
static double free_depth(double bead[][3], int n, double radius,
                         const double point[3], const double normal[3])
{
    double depth = HUGE_VAL;

    for (int b = 0; b < n; b++)
    {
        double d[3];

        ellipsoid_difference(point, bead[b], d);

        const double along = ellipsoid_dot(d, normal);
        const double across = ellipsoid_dot(d, d) - along * along;

        if (across < radius * radius)
        {
            depth = fmin(depth, along - sqrt(radius * radius - across));
        }
    }
    return depth;
}

static envelope measure(const ellipsoid_options *options)
{
    const double *a = options->semi_axes, r = options->bead_radius;
    const int samples = 100000;
    double bead[ELLIPSOID_MAX_BEADS][3];
    const int n = ellipsoid_beads(options, bead);
    envelope e = {.narrowest = HUGE_VAL, .over = -HUGE_VAL, .under = HUGE_VAL};

    for (int s = 0; s < samples; s++)
    {
        /* a Fibonacci lattice */
        const double z = 1 - (2 * s + 1.0) / samples, c = sqrt(1 - z * z);
        const double angle = s * 2.399963229728653;
        const double u[3] = {c * cos(angle), z, c * sin(angle)};
        const double back[3] = {-u[0], -u[1], -u[2]};
        double point[3], normal[3], support = 0, size = 0;

        for (int i = 0; i < 3; i++)
        {
            support += a[i] * a[i] * u[i] * u[i];
            point[i] = a[i] * u[i];
            normal[i] = u[i] / a[i];
            size += normal[i] * normal[i];
        }
        for (int i = 0; i < 3; i++)
        {
            normal[i] /= sqrt(size);
        }

        const double error = extent(bead, n, u) + r - sqrt(support);
        const double width = extent(bead, n, u) + extent(bead, n, back) + 2 * r;

        e.over = fmax(e.over, error);
        e.under = fmin(e.under, error);
        e.narrowest = fmin(e.narrowest, width);
        e.width = fabs(z) < 0.01 ? fmax(e.width, width) : e.width;
        e.length = fmax(e.length, width);
        e.valley = fmax(e.valley, free_depth(bead, n, r, point, normal));
    }
    return e;
}

/* 0.001e-6: the figures are given to the nanometre; the lattice of directions
   is finer than that. */
static void test_staggered_is_the_paper_s_cell(void **unused)
{
    const ellipsoid_options options = test_paper_options();
    const envelope e = measure(&options);

    (void)unused;
    assert_near(e.length, 4.00e-6, 0.001e-6);
    assert_near(e.narrowest, 0.941e-6, 0.001e-6);
    assert_near(e.over, 60e-9, 1e-9);
    assert_near(e.under, -30e-9, 1e-9);
    assert_near(e.valley, 180e-9, 1e-9);
}

static void test_staggered_centres(void **unused)
{
    const ellipsoid_options options = test_paper_options();
    const double height[10] = {-1.403, -1.091, -0.780, -0.468, -0.156,
                               0.156,  0.468,  0.780,  1.091,  1.403};
    double bead[ELLIPSOID_MAX_BEADS][3];

    (void)unused;
    assert_int_equal(ellipsoid_beads(&options, bead), 32);
    assert_near(bead[0][1], -1.715e-6, 1e-18);
    assert_near(bead[1][1], 1.715e-6, 1e-18);
    for (int ring = 0; ring < 10; ring++)
    {
        for (int k = 0; k < 3; k++)
        {
            const double *c = bead[2 + 3 * ring + k];
            const double y = c[1] / 1.715e-6;
            const double angle = (120 * k + 60 * (ring % 2)) * test_pi / 180;

            assert_near(c[1], height[ring] * 1e-6, 0.6e-9);
            assert_near(hypot(c[0], c[2]), 0.215e-6 * sqrt(1 - y * y), 1e-18);
            assert_near(remainder(atan2(c[0], c[2]) - angle, 2 * test_pi), 0,
                        1e-12);
        }
    }
}

/* Centres on the ellipsoid: 2 r_b longer and wider. */
static void test_paper_read_literally(void **unused)
{
    ellipsoid_options options = test_paper_options();
    double bead[ELLIPSOID_MAX_BEADS][3];

    (void)unused;
    options.bead_layout = ELLIPSOID_BEADS_PAPER;
    assert_int_equal(ellipsoid_beads(&options, bead), 26);
    for (int b = 0; b < 26; b++)
    {
        double on = 0;

        for (int i = 0; i < 3; i++)
        {
            on += pow(bead[b][i] / options.semi_axes[i], 2);
        }
        assert_near(on, 1, 1e-12);
        for (int other = 0; other < b; other++)
        {
            double d[3];

            ellipsoid_difference(bead[b], bead[other], d);
            assert_true(ellipsoid_dot(d, d) > 1e-14);
        }
    }

    const envelope e = measure(&options);

    assert_near(e.length, 4.57e-6, 0.001e-6);
    assert_near(e.width, 1.57e-6, 0.001e-6);
}

static void test_surface_layout(void **unused)
{
    ellipsoid_options options = test_paper_options();
    double bead[ELLIPSOID_MAX_BEADS][3];

    (void)unused;
    options.bead_layout = ELLIPSOID_BEADS_SURFACE;
    assert_int_equal(ellipsoid_beads(&options, bead), 32);
    for (int b = 0; b < 32; b++)
    {
        double on = 0;

        for (int i = 0; i < 3; i++)
        {
            on += pow(bead[b][i] / options.semi_axes[i], 2);
        }
        assert_near(on, 1, 1e-12);
    }
    assert_near(measure(&options).length, 4.57e-6, 0.001e-6);
}

/* More beads of the same construction follow the ellipsoid more closely. */
static void test_any_number_of_rings(void **unused)
{
    ellipsoid_options options = test_paper_options();
    double valley = HUGE_VAL;

    (void)unused;
    for (options.bead_count = 32; options.bead_count <= 254;
         options.bead_count *= 2)
    {
        double bead[ELLIPSOID_MAX_BEADS][3];

        options.bead_count -= (options.bead_count - 2) % 3;
        assert_int_equal(ellipsoid_beads(&options, bead), options.bead_count);

        const envelope e = measure(&options);

        assert_near(e.length, 4e-6, 0.001e-6);
        assert_true(e.valley < valley);
        valley = e.valley;
    }
}

/*
    Cells of other lengths and widths, in parts of their width, are as narrow as
    the default cell, to 2 nm, and have no deeper valleys, to 1 nm. With the
    default's 32 beads a needle would pass between those of the longest. What
    has the default's shape has its beads.
*/
static void test_resized(void **unused)
{
    const ellipsoid_options options = test_paper_options();
    const double widths[3] = {0.8, 1, 1.25};
    ellipsoid_options same;

    (void)unused;
    for (int w = 0; w < 3; w++)
    {
        for (int l = -3; l <= 3; l++)
        {
            const double length = 4e-6 * exp(0.2 * l);
            const ellipsoid_options other =
                ellipsoid_options_resized(&options, length, 1e-6 * widths[w]);

            assert_ok(ellipsoid_options_check(&other, NULL, NULL));
            assert_relative(other.semi_axes[0], 0.5e-6 * widths[w], 1e-15);
            assert_true(other.semi_axes[2] == other.semi_axes[0]);
            assert_true(other.bead_count >= 32);

            const envelope e = measure(&other);

            assert_near(e.length, length, 0.001e-6);
            assert_near(e.narrowest / widths[w], 0.941e-6, 0.002e-6);
            assert_true(e.valley / widths[w] < 181e-9);
        }
    }

    same = ellipsoid_options_resized(&options, 8e-6, 2e-6);
    assert_int_equal(same.bead_count, 32);
    assert_relative(same.bead_radius, 0.57e-6, 1e-15);

    /* Lines of 1.715 and 3.715 um: 11 gaps become 23.8, that is 24 */
    same = ellipsoid_options_resized(&options, 8e-6, 1e-6);
    assert_int_equal(same.bead_count, 2 + 3 * 23);
    same.bead_count = 32;
    assert_true(measure(&same).valley == HUGE_VAL);

    same = ellipsoid_options_resized(&options, 4e-6, 1e-6);
    assert_memory_equal(same.semi_axes, options.semi_axes,
                        sizeof same.semi_axes);
    assert_true(same.bead_radius == options.bead_radius);
    assert_int_equal(same.bead_count, 32);
}

/* What is out of range is left to the check to say; layouts of one number of
   beads, and none at all, stay as they are. */
static void test_resized_as_given(void **unused)
{
    ellipsoid_options options = test_paper_options(), other;
    const char *field;

    (void)unused;
    other = ellipsoid_options_resized(&options, 4e-6, 0);
    assert_int_equal(ellipsoid_options_check(&other, &field, NULL),
                     ELLIPSOID_BAD_OPTION);
    assert_string_equal(field, "semi_axes");
    other = ellipsoid_options_resized(&options, 1e-3, 1e-6);
    assert_int_equal(ellipsoid_options_check(&other, &field, NULL),
                     ELLIPSOID_BAD_OPTION);
    assert_string_equal(field, "bead_count");

    options.contact = 0;
    other = ellipsoid_options_resized(&options, 8e-6, 1e-6);
    assert_int_equal(other.bead_count, 32);
    options.contact = 1;
    options.bead_layout = ELLIPSOID_BEADS_PAPER;
    other = ellipsoid_options_resized(&options, 8e-6, 1e-6);
    assert_int_equal(other.bead_count, 32);
    options.bead_layout = ELLIPSOID_BEADS_STAGGERED;
    options.bead_count = 1;
    other = ellipsoid_options_resized(&options, 8e-6, 1e-6);
    assert_int_equal(other.bead_count, 1);
}

static void test_triaxial_and_round(void **unused)
{
    const double shapes[5][3] = {{0.5e-6, 0.7e-6, 2e-6},
                                 {2e-6, 0.5e-6, 0.7e-6},
                                 {1e-6, 1e-6, 1e-6},
                                 {1.5e-6, 0.5e-6, 1.5e-6},
                                 {1.5e-6, 1.5e-6, 0.5e-6}};

    (void)unused;
    for (int s = 0; s < 5; s++)
    {
        ellipsoid_options options = test_paper_options();
        double bead[ELLIPSOID_MAX_BEADS][3];
        double longest = 0, reach = 0;

        options.bead_count = 128;
        options.bead_radius = 0.3e-6;
        memcpy(options.semi_axes, shapes[s], sizeof shapes[s]);
        assert_int_equal(ellipsoid_beads(&options, bead), 128);
        for (int b = 0; b < 128; b++)
        {
            double on = 0;

            for (int i = 0; i < 3; i++)
            {
                on += pow(bead[b][i] / (shapes[s][i] - 0.3e-6), 2);
                longest = fmax(longest, shapes[s][i]);
            }
            assert_near(on, 1, 1e-12);
            reach = fmax(reach, sqrt(ellipsoid_dot(bead[b], bead[b])));
        }
        assert_relative(reach + 0.3e-6, longest, 1e-12);

        /* every direction is covered: no plane sinks in by more than r_b/2 */
        assert_true(measure(&options).under > -0.15e-6);
    }
}

static void test_one_bead_is_a_sphere(void **unused)
{
    ellipsoid_options options = test_paper_options();
    double bead[ELLIPSOID_MAX_BEADS][3];

    (void)unused;
    options.bead_count = 1;
    options.bead_radius = 0.5e-6;
    for (options.bead_layout = ELLIPSOID_BEADS_STAGGERED;
         options.bead_layout <= ELLIPSOID_BEADS_SURFACE; options.bead_layout++)
    {
        assert_int_equal(ellipsoid_beads(&options, bead), 1);
        assert_true(ellipsoid_dot(bead[0], bead[0]) == 0);
    }
}

static void test_refusals(void **unused)
{
    const int bad[] = {-1, 0, 3, 4, 6, 31, 33, 256, 257, 1000};
    ellipsoid_options options = test_paper_options();
    double bead[ELLIPSOID_MAX_BEADS][3];

    (void)unused;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
    {
        options.bead_count = bad[i];
        assert_int_equal(ellipsoid_beads(&options, bead), 0);
    }
    options.bead_count = 35;
    assert_int_equal(ellipsoid_beads(&options, bead), 35);
    options.bead_layout = ELLIPSOID_BEADS_PAPER; /* is 32, or one */
    assert_int_equal(ellipsoid_beads(&options, bead), 0);

    options = test_paper_options();
    options.bead_radius = 0.5e-6;
    assert_int_equal(ellipsoid_beads(&options, bead), 0);
    options.bead_radius = 0;
    assert_int_equal(ellipsoid_beads(&options, bead), 0);
    options.bead_radius = NAN;
    assert_int_equal(ellipsoid_beads(&options, bead), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_staggered_is_the_paper_s_cell),
        cmocka_unit_test(test_staggered_centres),
        cmocka_unit_test(test_paper_read_literally),
        cmocka_unit_test(test_surface_layout),
        cmocka_unit_test(test_any_number_of_rings),
        cmocka_unit_test(test_resized),
        cmocka_unit_test(test_resized_as_given),
        cmocka_unit_test(test_triaxial_and_round),
        cmocka_unit_test(test_one_bead_is_a_sphere),
        cmocka_unit_test(test_refusals),
    };

    return cmocka_run_group_tests_name("beads", tests, NULL, NULL);
}
