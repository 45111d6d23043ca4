/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_pairImpact.c - two cells that meet in vacuum: what is conserved, how
    long it takes, what friction and damping take.

    Lengths, masses and speeds are of the order of one. On what the tolerance
    allows see test_bounce.c.
*/
#include "contactTest.h"

#include <stdlib.h>

typedef struct encounter
{
    ellipsoid_model model[2];
    ellipsoid_state state[2];
    ellipsoid_controller controller[2];
    ellipsoid_statistics statistics[2];
    ellipsoid_surroundings around[2];
    double t;
    double deepest;
} encounter;

static int note_depth(void *context, const ellipsoid_step *step)
{
    encounter *e = context;

    e->deepest = fmax(e->deepest, step->contact.cell_deepest);
    return 0;
}

static void go(encounter *e, double end)
{
    ellipsoid_member members[2];
    void *memory = malloc(ellipsoid_group_size(2));
    int which;

    for (int n = 0; n < 2; n++)
    {
        members[n] =
            (ellipsoid_member){&e->model[n],      &e->around[n], &e->state[n],
                               &e->controller[n], NULL,          e,
                               &e->statistics[n]};
    }
    assert_ok(ellipsoid_advance_group(2, members, &e->t, end, note_depth,
                                      memory, &which));
    free(memory);
}

/* Momentum, its moment about the origin, energy. */
typedef struct kept
{
    double momentum[3], moment[3], energy;
} kept;

static kept sum_of(const encounter *e)
{
    kept sum = {{0}, {0}, 0};

    for (int n = 0; n < 2; n++)
    {
        const ellipsoid_model *m = &e->model[n];
        const ellipsoid_state *s = &e->state[n];
        double p[3], moment[3], spin[3], r[3][3], turned[3];

        for (int i = 0; i < 3; i++)
        {
            p[i] = m->mass * s->u[i];
            spin[i] = m->inertia[i] * s->omega[i];
        }
        ellipsoid_cross(s->x, p, moment);
        ellipsoid_rotation(s->q, r);
        ellipsoid_product(r, spin, turned);
        ellipsoid_add(sum.momentum, p);
        ellipsoid_add(sum.moment, moment);
        ellipsoid_add(sum.moment, turned);
        sum.energy += contact_energy(m, s);
    }
    return sum;
}

static ellipsoid_options partner(int is_ball, double size)
{
    ellipsoid_options o = contact_ball(size, 1);

    o.buoyancy = 0;
    o.contact_modulus = 1e4;
    if (!is_ball)
    {
        ellipsoid_set(o.semi_axes, 0.5 * size, 2 * size, 0.7 * size);
        o.bead_count = 32;
        o.bead_radius = 0.3 * size;
    }
    return o;
}

/* Head-on: along x1 towards one another; else beside one another, turning. */
static void meet(encounter *e, const ellipsoid_options options[2], int head_on,
                 uint64_t *seed)
{
    memset(e->state, 0, sizeof(e->state));
    memset(e->controller, 0, sizeof(e->controller));
    memset(e->statistics, 0, sizeof(e->statistics));
    memset(e->around, 0, sizeof(e->around));
    e->t = e->deepest = 0;
    for (int n = 0; n < 2; n++)
    {
        ellipsoid_state *s = &e->state[n];
        const double side = n == 0 ? -1 : 1;

        e->model[n] = test_model(&options[n]);
        e->around[n].id = (uint32_t)n;
        test_orientation(seed, s->q);
        s->x[0] = side * (e->model[n].reach + 0.1);
        s->u[0] = -0.5 * side;
        for (int i = 0; i < 3 && !head_on; i++)
        {
            s->omega[i] = 0.5 * test_signed(seed);
            s->x[i] += i == 0 ? 0 : 0.2 * test_signed(seed);
            s->u[i] += 0.2 * test_signed(seed);
        }
    }
}

/* Until they move apart and touch no more. */
static void part(encounter *e)
{
    double line[3], apart[3];
    ellipsoid_state *s = e->state;

    do
    {
        go(e, e->t + 0.5);
        ellipsoid_difference(s[1].x, s[0].x, line);
        ellipsoid_difference(s[1].u, s[0].u, apart);
    } while (ellipsoid_dot(line, apart) < 0
             || ellipsoid_cell_gap(&e->model[0], s[0].x, s[0].q, &e->model[1],
                                   s[1].x, s[1].q, 0.1)
                    < 0);
}

/*
    Momentum to rounding of the sums over steps. Its moment is quadratic in the
    unknowns, of which no Rosenbrock method keeps more than its tolerance; the
    forces keep it to rounding, see below. Energy likewise, without friction and
    damping; with either it falls.
*/
static void check_what_is_kept(ellipsoid_contact_shape shape)
{
    encounter e;
    uint64_t seed = 31;
    int met = 0;

    for (int n = 0; n < 120; n++)
    {
        const int is_ball = n % 2, head_on = n % 3 == 0, rough = n % 4 > 1;
        ellipsoid_options options[2] = {partner(is_ball, 1),
                                        partner(is_ball, 0.8)};
        kept before, after;
        double allowed, scale = 0, change[3];

        /* One longer and thinner, with more beads */
        if (!is_ball)
        {
            options[1] = ellipsoid_options_resized(&options[0], 6, 0.8);
            assert_int_equal(options[1].bead_count, 68);
        }
        for (int k = 0; k < 2; k++)
        {
            options[k].friction = rough ? 0.4 : 0;
            options[k].slip_speed = 1e-3;
            options[k].contact_damping = rough ? 0.3 * k : 0;
            options[k].contact_shape = shape;
        }
        meet(&e, options, head_on, &seed);
        before = sum_of(&e);
        part(&e);
        after = sum_of(&e);
        for (int k = 0; k < 2; k++)
        {
            scale += e.model[k].mass * ellipsoid_length(e.state[k].u);
        }
        ellipsoid_difference(after.momentum, before.momentum, change);
        assert_near(ellipsoid_length(change), 0, 1e-12 * scale);
        if (e.deepest == 0)
        {
            continue;
        }
        met++;
        allowed =
            10 * options[0].tolerance * options[0].semi_axes[1] / e.deepest;
        ellipsoid_difference(after.moment, before.moment, change);
        assert_near(ellipsoid_length(change), 0, allowed * scale);
        if (rough)
        {
            assert_true(after.energy < before.energy);
        }
        else
        {
            assert_relative(after.energy, before.energy, allowed);
        }
    }
    assert_true(met > 80);
}

static void test_what_is_kept(void **unused)
{
    (void)unused;
    check_what_is_kept(ELLIPSOID_CONTACT_BEADS);
    check_what_is_kept(ELLIPSOID_CONTACT_ELLIPSOID);
}

/* Two balls as in test_bounce.c, with m, R and E* those of the pair (Johnson,
   Contact Mechanics (1985), eq. 11.24). */
static void test_duration(void **unused)
{
    ellipsoid_options options[2] = {partner(1, 1), partner(1, 0.5)};
    encounter e;
    uint64_t seed = 32;

    (void)unused;
    options[1].contact_modulus = 3e4;
    options[1].density = 3;
    for (int n = 0; n < 2; n++)
    {
        options[n].tolerance = 1e-8;
    }
    meet(&e, options, 1, &seed);

    const double m =
        e.model[0].mass * e.model[1].mass / (e.model[0].mass + e.model[1].mass);
    const double radius = 1 * 0.5 / (1 + 0.5);
    const double modulus = 1e4 * 3e4 / (1e4 + 3e4);
    const double before = e.state[1].x[0] - e.state[0].x[0] - 1.5;

    part(&e);

    const double gap = e.state[1].x[0] - e.state[0].x[0] - 1.5;
    const double speed = e.state[1].u[0] - e.state[0].u[0];
    const double duration = e.t - gap / speed - before; /* at speed 1 */

    /* 2.943 (15/16)^0.4 = 2.8683 */
    assert_relative(duration,
                    2.8683 * pow(m * m / (radius * modulus * modulus), 0.2),
                    1e-4);
    assert_relative(speed, 1, 1e-5);
}

/* ------------------------------------------------------- forces at one time */

/* The forces on two cells that overlap and rub add up to nothing, and so do
   their moments: to rounding. */
static void check_forces_balance(ellipsoid_contact_shape shape)
{
    void *memory = malloc(ellipsoid_group_size(2));
    ellipsoid_options options[2] = {partner(0, 1), partner(0, 0.8)};
    ellipsoid_statistics statistics = {0};
    ellipsoid_pairs pairs;
    ellipsoid_group group;
    int touched = 0;
    encounter e;
    uint64_t seed = 33;

    ellipsoid_group_lay_out(2, memory, &group, &pairs);
    group.inertial = 1;
    for (int k = 0; k < 2; k++)
    {
        options[k].friction = 0.4;
        options[k].slip_speed = 0.01;
        options[k].contact_damping = 0.3;
        options[k].contact_shape = shape;
    }
    for (int n = 0; n < 300; n++)
    {
        double force[3] = {0}, moment[3] = {0}, size = 0;

        meet(&e, options, 0, &seed);
        pairs.is_listed = 0;
        for (int k = 0; k < 2; k++)
        {
            e.state[k].x[0] *= 0.3;
            group.cell[k] = (ellipsoid_cell){.model = &e.model[k],
                                             .surroundings = e.around[k],
                                             .statistics = &statistics,
                                             .inertial = 1};
            group.start[k].state = e.state[k];
        }
        assert_ok(ellipsoid_group_evaluate(&group, 0, group.start, 0, 0));
        for (int k = 0; k < 2; k++)
        {
            const ellipsoid_contact *c = &group.start[k].contact;

            test_add_moment(&e.state[k], c, moment);
            ellipsoid_add(force, c->cell_force);
            size += ellipsoid_length(c->cell_force)
                  + ellipsoid_length(c->cell_torque);
        }
        touched += size > 0;
        assert_near(ellipsoid_length(force), 0, 1e-14 * size);
        assert_near(ellipsoid_length(moment), 0, 1e-13 * size);
    }
    assert_true(touched > 200);
    free(memory);
}

static void test_forces_balance(void **unused)
{
    (void)unused;
    check_forces_balance(ELLIPSOID_CONTACT_BEADS);
    check_forces_balance(ELLIPSOID_CONTACT_ELLIPSOID);
}

/* One of them a period away: the same, but for its place and for rounding, which
   the stiff contact enlarges. */
static void test_over_a_period(void **unused)
{
    const double period[2][3] = {{40, 8, 0}, {-40, -8, 0}};
    uint64_t seed = 5;
    int met = 0;

    (void)unused;
    for (int n = 0; n < 40; n++)
    {
        const ellipsoid_options options[2] = {partner(0, 1), partner(0, 0.8)};
        encounter here, away;

        meet(&here, options, n % 2, &seed);
        for (int k = 0; k < 2; k++)
        {
            here.model[k].options.contact_shape =
                n % 4 < 2 ? ELLIPSOID_CONTACT_BEADS
                          : ELLIPSOID_CONTACT_ELLIPSOID;
        }
        away = here;
        ellipsoid_add(away.state[n % 2].x, period[n % 3 == 0]);
        for (int k = 0; k < 2; k++)
        {
            away.around[k].repeat = period;
            away.around[k].repeat_count = 2;
        }
        go(&here, 3);
        go(&away, 3);
        met += here.deepest > 0;
        for (int k = 0; k < 2; k++)
        {
            for (int i = 0; i < 3; i++)
            {
                const double moved = k == n % 2 ? period[n % 3 == 0][i] : 0;

                assert_near(away.state[k].x[i] - moved, here.state[k].x[i],
                            1e-6);
                assert_near(away.state[k].u[i], here.state[k].u[i], 1e-6);
                assert_near(away.state[k].omega[i], here.state[k].omega[i],
                            1e-6);
            }
        }
    }
    assert_true(met > 20);
}

/* Two balls that forces press together, all but still: as one on the floor in
   test_bounce.c. */
static void test_pressed_together(void **unused)
{
    static encounter e;
    const double press = 10;
    const ellipsoid_options o = partner(1, 1);
    /* both are as deep in one another as each in a wall */
    const double depth = 2 * pow(press / contact_stiffness(&o), 2.0 / 3);

    (void)unused;
    memset(&e, 0, sizeof e);
    for (int n = 0; n < 2; n++)
    {
        ellipsoid_options pressed = o;

        pressed.external_force[0] = n ? -press : press;
        e.model[n] = test_model(&pressed);
        e.state[n].q[3] = 1;
        e.state[n].x[0] = (n ? 1 : -1) * (1 - 0.5 * depth * (1 + 1e-7));
        e.around[n].id = n;
    }
    go(&e, 20 * sqrt(e.model[0].mass * depth / press));
    assert_true(e.statistics[0].accepted < 20);
    assert_relative(e.deepest, depth, 1e-5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_is_kept),
        cmocka_unit_test(test_duration),
        cmocka_unit_test(test_forces_balance),
        cmocka_unit_test(test_over_a_period),
        cmocka_unit_test(test_pressed_together),
    };

    return cmocka_run_group_tests_name("pairImpact", tests, NULL, NULL);
}
