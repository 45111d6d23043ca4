/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_options.c - defaults, their checker, and the model made of them.
*/
#include "coreTest.h"

/* Sets one member to one bad value and expects to be told which it was. */
#define assert_refused(member, value, name)                                    \
    do                                                                         \
    {                                                                          \
        ellipsoid_options bad = ellipsoid_options_default();                   \
        const char *field = NULL, *range = NULL;                               \
        bad.member = (value);                                                  \
        assert_int_equal(ellipsoid_options_check(&bad, &field, &range),        \
                         ELLIPSOID_BAD_OPTION);                                \
        assert_string_equal(field, name);                                      \
        assert_non_null(range);                                                \
    } while (0)

/* Every double must refuse NaN and the infinities. */
#define assert_needs_number(member, name)                                      \
    assert_refused(member, NAN, name);                                         \
    assert_refused(member, INFINITY, name);                                    \
    assert_refused(member, -INFINITY, name)

static void test_default_is_accepted(void **unused)
{
    const ellipsoid_options options = ellipsoid_options_default();
    const char *field = "untouched", *range = "untouched";

    (void)unused;
    assert_ok(ellipsoid_options_check(&options, &field, &range));
    assert_string_equal(field, "untouched");
    assert_string_equal(range, "untouched");
    assert_ok(ellipsoid_options_check(&options, NULL, NULL));
}

static void test_faults_are_named(void **unused)
{
    (void)unused;
    for (int i = 0; i < 3; i++)
    {
        assert_needs_number(semi_axes[i], "semi_axes");
        assert_refused(semi_axes[i], 0, "semi_axes");
        assert_refused(semi_axes[i], -1e-6, "semi_axes");
        assert_needs_number(gravity[i], "gravity");
        assert_needs_number(external_force[i], "external_force");
        assert_needs_number(external_torque[i], "external_torque");
    }
    assert_needs_number(density, "density");
    assert_refused(density, 0, "density");
    assert_needs_number(fluid_density, "fluid_density");
    assert_refused(fluid_density, -1, "fluid_density");
    assert_needs_number(kinematic_viscosity, "kinematic_viscosity");
    assert_refused(kinematic_viscosity, 0, "kinematic_viscosity");
    assert_refused(drag, 2, "drag");
    assert_refused(buoyancy, -1, "buoyancy");
    assert_refused(pressure_gradient, (ellipsoid_pressure_gradient)3,
                   "pressure_gradient");
    assert_refused(contact, 7, "contact");
    assert_refused(bead_layout, (ellipsoid_bead_layout)3, "bead_layout");
    assert_refused(bead_count, 0, "bead_count");
    assert_refused(bead_count, ELLIPSOID_MAX_BEADS + 1, "bead_count");
    assert_needs_number(bead_radius, "bead_radius");
    assert_refused(bead_radius, 0, "bead_radius");
    assert_refused(bead_radius, 0.5e-6, "bead_radius");
    assert_needs_number(contact_modulus, "contact_modulus");
    assert_refused(contact_modulus, 0, "contact_modulus");
    assert_needs_number(friction, "friction");
    assert_refused(friction, -0.1, "friction");
    assert_needs_number(slip_speed, "slip_speed");
    assert_refused(slip_speed, 0, "slip_speed");
    assert_needs_number(contact_damping, "contact_damping");
    assert_refused(contact_damping, -1, "contact_damping");
    assert_refused(contact_shape, (ellipsoid_contact_shape)2, "contact_shape");
    assert_needs_number(adhesion, "adhesion");
    assert_refused(adhesion, -1e-12, "adhesion");
    assert_needs_number(tolerance, "tolerance");
    assert_refused(tolerance, 0.9e-14, "tolerance");
    assert_refused(tolerance, 0.11, "tolerance");
    assert_needs_number(maximum_step, "maximum_step");
    assert_refused(maximum_step, 1e-19, "maximum_step");
    assert_refused(maximum_steps, 0, "maximum_steps");
}

/* A sphere as one bead of its own radius; a larger bead, or more of them, have no room. */
static void test_sphere_as_one_bead(void **state)
{
    (void)state;
    ellipsoid_options options = ellipsoid_options_default();
    const char *field = NULL;

    options.semi_axes[1] = options.bead_radius = 0.5e-6;
    options.bead_count = 1;
    assert_int_equal(ellipsoid_options_check(&options, NULL, NULL),
                     ELLIPSOID_OK);
    options.bead_radius *= 1 + 1e-15;
    assert_int_equal(ellipsoid_options_check(&options, &field, NULL),
                     ELLIPSOID_BAD_OPTION);
    assert_string_equal(field, "bead_radius");
    options.bead_radius = 0.5e-6;
    options.bead_count = 2;
    assert_int_equal(ellipsoid_options_check(&options, &field, NULL),
                     ELLIPSOID_BAD_OPTION);
    assert_string_equal(field, "bead_radius");
}

/* Where a member of the options is, for its type. */
static void set_member(const ellipsoid_option *option, int component,
                       double value, ellipsoid_options *options)
{
    char *member = (char *)options + option->offset;

    if (option->type == ELLIPSOID_OPTION_REAL
        || option->type == ELLIPSOID_OPTION_VECTOR)
    {
        memcpy(member + (size_t)component * sizeof value, &value, sizeof value);
    }
    else
    {
        const int whole = (int)value;

        memcpy(member, &whole, sizeof whole);
    }
}

static int is_whole(const ellipsoid_option *option)
{
    return option->type != ELLIPSOID_OPTION_REAL
        && option->type != ELLIPSOID_OPTION_VECTOR;
}

/* One option at a value, where its range matters: accepted, or refused by its
   own name. */
static void check_value(const ellipsoid_option *list,
                        const ellipsoid_option *option, double value,
                        int accepted)
{
    const int count = option->type == ELLIPSOID_OPTION_VECTOR ? 3 : 1;

    for (int i = 0; i < count; i++)
    {
        ellipsoid_options options = test_paper_options();
        const char *field = "none", *range = "none";
        ellipsoid_status status;

        /* a cell of any size and shape that has no beads */
        options.contact = strcmp(option->member, "semi_axes") != 0;
        for (int n = option->needs; n >= 0; n = list[n].needs)
        {
            set_member(&list[n], 0, 1, &options);
        }
        set_member(option, i, value, &options);
        status = ellipsoid_options_check(&options, &field, &range);
        assert_string_equal(field, accepted ? "none" : option->member);
        assert_string_equal(range, accepted ? "none" : option->range);
        assert_int_equal(status,
                         accepted ? ELLIPSOID_OK : ELLIPSOID_BAD_OPTION);
    }
}

/* The ends of the ranges of options.def, and what is just beyond them. Where
   another option narrows a range, only what is beyond. */
static void test_ends_of_ranges(void **unused)
{
    int count = 0;
    const ellipsoid_option *list = ellipsoid_option_list(&count);

    (void)unused;
    assert_true(count > 30);
    for (const ellipsoid_option *o = list; o < list + count; o++)
    {
        const int whole = is_whole(o);

        check_value(list, o, whole ? o->low - 1 : nextafter(o->low, -HUGE_VAL),
                    0);
        if (!o->related)
        {
            check_value(list, o, o->low, !o->above);
        }
        if (o->high < 1e300)
        {
            check_value(list, o,
                        whole ? o->high + 1 : nextafter(o->high, HUGE_VAL), 0);
        }
        if (o->high < 1e300 && !o->related)
        {
            check_value(list, o, o->high, 1);
        }
        if (!whole)
        {
            check_value(list, o, NAN, 0);
            check_value(list, o, HUGE_VAL, 0);
        }
    }
}

/* The range of adhesion matters where there is adhesion. */
static void test_adhesion_range(void **unused)
{
    const double refused[] = {0, -1, 0.29e-6, NAN, HUGE_VAL};

    (void)unused;
    for (int n = 0; n < 5; n++)
    {
        ellipsoid_options options = ellipsoid_options_default();
        const char *field = NULL;

        options.adhesion_range = refused[n];
        assert_ok(ellipsoid_options_check(&options, NULL, NULL));
        options.adhesion = 1e-12;
        assert_int_equal(ellipsoid_options_check(&options, &field, NULL),
                         ELLIPSOID_BAD_OPTION);
        assert_string_equal(field, "adhesion_range");
    }
}

/* Near walls: refused with what it cannot go with, by its own name; its members
   do not matter without it. */
static void test_near_walls(void **unused)
{
    ellipsoid_options options = test_paper_options();
    const char *field = NULL, *range = NULL;

    (void)unused;
    assert_refused(wall_resistance, (ellipsoid_wall_resistance)2,
                   "wall_resistance");
    options.lubrication_gap = options.wall_range = -1;
    assert_ok(ellipsoid_options_check(&options, NULL, NULL));
    options.wall_resistance = ELLIPSOID_WALL_RESISTANCE_PLANE;
    assert_int_equal(ellipsoid_options_check(&options, &field, &range),
                     ELLIPSOID_BAD_OPTION);
    assert_string_equal(field, "lubrication_gap");
    options.lubrication_gap = 1e-8;
    options.wall_range = 0.99 * options.semi_axes[1];
    assert_int_equal(ellipsoid_options_check(&options, &field, &range),
                     ELLIPSOID_BAD_OPTION);
    assert_string_equal(field, "wall_range");
    options.wall_range = options.semi_axes[1];
    assert_ok(ellipsoid_options_check(&options, NULL, NULL));
    assert_float_equal(ellipsoid_wall_range(&options), 2e-6, 0);
    options.wall_range = 0;
    assert_ok(ellipsoid_options_check(&options, NULL, NULL));
    assert_float_equal(ellipsoid_wall_range(&options), 4e-6, 1e-20);
    options.brownian = 1;
    assert_ok(ellipsoid_options_check(&options, NULL, NULL));
    options.wall_range = 1e-4;
    options.semi_axes[1] = 21 * options.semi_axes[0];
    assert_int_equal(ellipsoid_options_check(&options, &field, &range),
                     ELLIPSOID_BAD_OPTION);
    assert_string_equal(field, "wall_resistance");
    assert_string_equal(range,
                        "none for a body that is not between 1:6 and 20:1");
    options.semi_axes[1] = 20 * options.semi_axes[0];
    assert_ok(ellipsoid_options_check(&options, NULL, NULL));
    options.brownian = options.drag = 0;
    assert_ok(ellipsoid_options_check(&options, NULL, NULL));
    assert_float_equal(ellipsoid_wall_range(&options), 0, 0);
}

/* Contact members do not matter where there is no contact. */
static void test_contact_off(void **unused)
{
    ellipsoid_options options = ellipsoid_options_default();

    (void)unused;
    options.contact = 0;
    options.bead_radius = -1;
    options.bead_count = 0;
    assert_ok(ellipsoid_options_check(&options, NULL, NULL));
}

static void test_bad_options_leave_the_model(void **unused)
{
    ellipsoid_options options = ellipsoid_options_default();
    static ellipsoid_model model, before;

    (void)unused;
    memset(&model, 0x5a, sizeof(model));
    memcpy(&before, &model, sizeof(model));
    options.density = NAN;
    assert_int_equal(ellipsoid_model_init(&model, &options),
                     ELLIPSOID_BAD_OPTION);
    assert_memory_equal(&model, &before, sizeof(model));
}

/* The paper's formulas for its spheroid (supplement, below eq. 4): rounding
   is all that may differ. */
static void test_model_of_the_paper(void **unused)
{
    const ellipsoid_options options = ellipsoid_options_default();
    const ellipsoid_model m = test_model(&options);
    const double a = 0.5e-6, beta = 4;
    const double mass = 4 * test_pi / 3 * a * a * a * beta * 1040;

    (void)unused;
    assert_relative(m.mass, mass, 1e-15);
    assert_relative(m.fluid_mass, mass * 997.5 / 1040, 1e-15);
    assert_relative(m.volume, mass / 1040, 1e-15);
    assert_relative(m.viscosity, 997.5e-6, 1e-15);
    assert_relative(m.inertia[0], 0.2 * (1 + beta * beta) * a * a * mass,
                    1e-15);
    assert_relative(m.inertia[1], 0.4 * a * a * mass, 1e-15);
    assert_relative(m.inertia[2], m.inertia[0], 1e-15);
    assert_relative(m.strain_factor[0], 15.0 / 17, 1e-15);
    assert_true(m.strain_factor[1] == 0);
    assert_relative(m.strain_factor[2], -15.0 / 17, 1e-15);
    assert_relative(m.relaxation_time,
                    mass / (997.5e-6 * fmin(m.resistance[0], m.resistance[1])),
                    1e-15);
}

/* s_1 = (a2^2 - a3^2)/(a2^2 + a3^2) of a near-sphere: the difference of the
   axes is exact here, so the factor must be good to rounding. */
static void test_near_sphere_keeps_its_digits(void **unused)
{
    ellipsoid_options options = test_free_cell();
    const double d = 1.0 / (1 << 20) * 1e-6;
    ellipsoid_model m;

    (void)unused;
    options.semi_axes[0] = options.semi_axes[2] = 1e-6;
    options.semi_axes[1] = 1e-6 + d;
    m = test_model(&options);
    assert_relative(m.strain_factor[0],
                    (options.semi_axes[1] - 1e-6) / 1e-6 * (1 + 0.5 * d * 1e6)
                        / (1 + d * 1e6 + 0.5 * d * d * 1e12),
                    1e-15);
    assert_true(m.strain_factor[2] == -m.strain_factor[0]);
}

static void test_library_has_the_version_of_the_header(void **unused)
{
    (void)unused;
    assert_string_equal(ellipsoid_version(), ELLIPSOID_VERSION);
}

static void test_every_status_has_a_text(void **unused)
{
    (void)unused;
    for (int s = 0; s < ELLIPSOID_STATUS_COUNT; s++)
    {
        assert_string_not_equal(ellipsoid_status_text((ellipsoid_status)s),
                                "unknown status");
    }
    assert_string_equal(ellipsoid_status_name(ELLIPSOID_OUTSIDE), "OUTSIDE");
    assert_string_equal(ellipsoid_status_name(ELLIPSOID_STATUS_COUNT),
                        "UNKNOWN");
    assert_string_equal(ellipsoid_status_text(ELLIPSOID_STATUS_COUNT),
                        "unknown status");
    assert_non_null(ellipsoid_status_text((ellipsoid_status)999));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sphere_as_one_bead),
        cmocka_unit_test(test_default_is_accepted),
        cmocka_unit_test(test_faults_are_named),
        cmocka_unit_test(test_ends_of_ranges),
        cmocka_unit_test(test_adhesion_range),
        cmocka_unit_test(test_near_walls),
        cmocka_unit_test(test_contact_off),
        cmocka_unit_test(test_bad_options_leave_the_model),
        cmocka_unit_test(test_model_of_the_paper),
        cmocka_unit_test(test_near_sphere_keeps_its_digits),
        cmocka_unit_test(test_library_has_the_version_of_the_header),
        cmocka_unit_test(test_every_status_has_a_text),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
