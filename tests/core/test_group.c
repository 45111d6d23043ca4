/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_group.c - several cells as one system: contact between them, its
    derivatives, the coupled linear system.
*/
#include "groupTest.h"

/* Two cells that overlap by some nanometres, moving and turning; a group laid
   out over them. */
static void overlapping(crowd *c, ellipsoid_group *g, ellipsoid_pairs *pairs,
                        double depth, uint64_t *seed)
{
    double way[3] = {0, 0, 0}, gap;

    for (int i = 0; i < 2; i++)
    {
        ellipsoid_state *s = &c->state[i];

        test_orientation(seed, s->q);
        for (int l = 0; l < 3; l++)
        {
            s->x[l] = 1e-6 * test_signed(seed);
            s->u[l] = 1e-3 * test_signed(seed);
            s->omega[l] = 100 * test_signed(seed);
        }
    }
    /* pulls the second one away until the depth is as asked for */
    for (int l = 0; l < 3; l++)
    {
        way[l] = test_signed(seed);
    }
    for (double near = 0, far = 10e-6; far - near > 1e-14;)
    {
        const double middle = 0.5 * (near + far);

        for (int l = 0; l < 3; l++)
        {
            c->state[1].x[l] =
                c->state[0].x[l] + middle * way[l] / ellipsoid_length(way);
        }
        gap = ellipsoid_cell_gap(&c->model, c->state[0].x, c->state[0].q,
                                 &c->model, c->state[1].x, c->state[1].q, 1e-7);
        *(gap < -depth ? &near : &far) = middle;
    }

    ellipsoid_group_lay_out(2, c->memory, g, pairs);
    g->inertial = 1;
    for (int i = 0; i < 2; i++)
    {
        g->cell[i] = (ellipsoid_cell){
            .model = &c->model,
            .surroundings = c->around[i],
            .statistics = &c->statistics[i],
            .length = 2e-6,
            .rate = 1 / c->model.relaxation_time,
            .rotation_rate = 1 / c->model.rotation_relaxation_time,
            .inertial = 1,
        };
        g->start[i].state = c->state[i];
    }
}

/* -------------------------------------------------------------- forces */

/* One force, two signs: to the last bit; and one line of action, so that the
   moment about any point is rounding. */
static void test_equal_and_opposite(void **unused)
{
    const ellipsoid_options o = touching_cell();
    uint64_t seed = 5;
    int touching = 0;
    crowd c;

    (void)unused;
    crowd_init(&c, 2, &o, NULL);
    for (int n = 0; n < 200; n++)
    {
        ellipsoid_group g;
        ellipsoid_pairs pairs;
        double moment[3] = {0, 0, 0}, size = 0;

        overlapping(&c, &g, &pairs, 2e-8, &seed);
        assert_ok(ellipsoid_group_evaluate(&g, 0, g.start, 0, 0));
        for (int i = 0; i < 2; i++)
        {
            const ellipsoid_contact *contact = &g.start[i].contact;
            double arm[3];

            test_add_moment(&c.state[i], contact, moment);
            ellipsoid_cross(c.state[i].x, contact->cell_force, arm);
            size +=
                ellipsoid_length(contact->cell_torque) + ellipsoid_length(arm);
            assert_int_equal(contact->cell_count, 1);
            assert_int_equal(contact->cell_id[0], 101 - i);
            assert_near(contact->cell_deepest, 2e-8, 1e-12);
            touching++;
        }
        for (int l = 0; l < 3; l++)
        {
            assert_true(g.start[0].contact.cell_force[l]
                        == -g.start[1].contact.cell_force[l]);
        }
        assert_near(ellipsoid_length(moment) / size, 0, 1e-14);
    }
    assert_int_equal(touching, 400);
    crowd_free(&c);
}

/* Two spheres of one bead each: Hertz with half the radius, half the modulus.
 */
static void test_two_spheres(void **unused)
{
    const double r = 0.5e-6, depth = 1e-8;
    ellipsoid_options o = touching_cell();
    ellipsoid_contact *contact;
    ellipsoid_group g;
    ellipsoid_pairs pairs;
    uint64_t seed = 1;
    crowd c;

    (void)unused;
    for (int i = 0; i < 3; i++)
    {
        o.semi_axes[i] = r * (1 + 1e-9);
    }
    o.bead_count = 1;
    o.bead_radius = r;
    crowd_init(&c, 2, &o, NULL);
    overlapping(&c, &g, &pairs, depth, &seed);
    assert_ok(ellipsoid_group_evaluate(&g, 0, g.start, 0, 0));
    contact = &g.start[0].contact;
    /* the depth is set to 1e-14 m */
    assert_relative(ellipsoid_length(contact->cell_force),
                    4.0 / 3 * (o.contact_modulus / 2) * sqrt(r / 2)
                        * pow(depth, 1.5),
                    3e-6);
    assert_near(ellipsoid_length(contact->cell_torque), 0, 1e-30);
    crowd_free(&c);
}

/* --------------------------------------------------------- derivatives */

/* The 26 derivatives at a state of two cells. */
static void slopes(ellipsoid_group *g, double f[26])
{
    assert_ok(ellipsoid_group_evaluate(g, 0, g->next, 0, 0));
    memcpy(f, g->next[0].slope, sizeof(g->next[0].slope));
    memcpy(f + 13, g->next[1].slope, sizeof(g->next[1].slope));
}

static int is_coupled(int n, const ellipsoid_jacobian_blocks *b, int row,
                      double *value)
{
    const int i = row % 3;
    const int of_omega = row >= AT_OMEGA;

    if (row >= AT_Q || (row >= AT_X && row < AT_OMEGA))
    {
        return 0;
    }
    if (n < AT_X)
    {
        *value = of_omega ? b->wu[i][n] : b->uu[i][n];
    }
    else if (n < AT_OMEGA)
    {
        *value = of_omega ? b->wx[i][n - AT_X] : b->ux[i][n - AT_X];
    }
    else if (n < AT_Q)
    {
        *value = of_omega ? b->ww[i][n - AT_OMEGA] : b->uw[i][n - AT_OMEGA];
    }
    else
    {
        *value = of_omega ? b->wq[i][n - AT_Q] : b->uq[i][n - AT_Q];
    }
    return 1;
}

/* The whole Jacobian of a pair against central differences, relative to the
   largest of its block of rows and columns. Differences of 1e-12 m and 1e-7 in
   q leave 1e-6: the force's third derivative, (h/depth)^2 / 24, and rounding.
 */
static void test_jacobian(void **unused)
{
    const ellipsoid_options o = touching_cell();
    const test_quadratic flow = towards_origin(100);
    uint64_t seed = 11;
    crowd c;

    (void)unused;
    crowd_init(&c, 2, &o, &flow);
    for (int n = 0; n < 40; n++)
    {
        ellipsoid_group g;
        ellipsoid_pairs pairs;
        double largest[4][4][2] = {{{0}}};

        overlapping(&c, &g, &pairs, 3e-8, &seed);
        assert_ok(ellipsoid_group_evaluate(&g, 0, g.start, 0, 1));
        assert_int_equal(pairs.count, 2);
        for (int column = 0; column < 26; column++)
        {
            const int of = column / 13, m = column % 13;
            const double h = m < AT_X     ? 1e-9
                           : m < AT_OMEGA ? 1e-12
                           : m < AT_Q     ? 1e-3
                                          : 1e-7;
            double up[26], down[26];

            g.next[0] = g.start[0];
            g.next[1] = g.start[1];
            g.next[of].y[m] += h;
            slopes(&g, up);
            g.next[of].y[m] -= 2 * h;
            slopes(&g, down);
            for (int row = 0; row < 26; row++)
            {
                const int cell = row / 13, k = row % 13;
                const int rows = k < 3 ? 0 : k < 6 ? 1 : k < 9 ? 2 : 3;
                const int columns = m < 3 ? 0 : m < 6 ? 1 : m < 9 ? 2 : 3;
                const ellipsoid_jacobian_blocks *b =
                    cell == of ? &g.start[cell].blocks
                               : &pairs.coupling[cell].blocks;
                const double difference = (up[row] - down[row]) / (2 * h);
                double value;

                if (is_coupled(m, b, k, &value))
                {
                    double *worst = largest[rows][columns];

                    worst[0] = fmax(worst[0], fabs(difference));
                    worst[1] = fmax(worst[1], fabs(difference - value));
                }
            }
        }
        for (int rows = 0; rows < 4; rows += 2)
        {
            for (int columns = 0; columns < 4; columns++)
            {
                const double *worst = largest[rows][columns];

                assert_near(worst[1], 0, 1e-6 * worst[0] + 1e-30);
            }
        }
    }
    crowd_free(&c);
}

/* Stages solve (I/(gamma h) - J) k = r with J of all 26 unknowns. Of the terms
   that cancel in a row 1e-9 may be left, as for a wall (test_rosenbrockSteps.c). */
static void test_coupled_system(void **unused)
{
    const ellipsoid_options o = touching_cell();
    const test_quadratic flow = towards_origin(100);
    uint64_t seed = 17;
    crowd c;

    (void)unused;
    crowd_init(&c, 2, &o, &flow);
    for (int n = 0; n < 100; n++)
    {
        const double h = pow(10, -9 + n % 8);
        const double per_g = 0.25 * h, g_h = 1 / per_g;
        ellipsoid_group g;
        ellipsoid_pairs pairs;

        overlapping(&c, &g, &pairs, 1e-8, &seed);
        assert_ok(ellipsoid_group_evaluate(&g, 0, g.start, 0, 1));
        assert_true(ellipsoid_group_prepare(&g, g.start, per_g));
        for (int cell = 0; cell < 2; cell++)
        {
            memcpy(g.stages[cell].k[0], g.start[cell].slope,
                   sizeof(g.start[cell].slope));
        }
        ellipsoid_group_solve(&g, 0);
        for (int row = 0; row < 26; row++)
        {
            const int cell = row / 13, k = row % 13;
            const double *own = g.stages[cell].k[0];
            double sum = g_h * own[k] - g.start[cell].slope[k];
            double size = fabs(sum) + fabs(g.start[cell].slope[k]);

            for (int column = 0; column < 26; column++)
            {
                const int of = column / 13, m = column % 13;
                const ellipsoid_jacobian_blocks *b =
                    cell == of ? &g.start[cell].blocks
                               : &pairs.coupling[cell].blocks;
                double value;

                if (is_coupled(m, b, k, &value))
                {
                    sum -= value * g.stages[of].k[0][m];
                    size += fabs(value * g.stages[of].k[0][m]);
                }
            }
            if (ellipsoid_is_rate(k))
            {
                assert_near(sum / size, 0, 1e-9);
            }
            else if (k < AT_OMEGA)
            {
                assert_relative(g_h * own[k],
                                own[k - AT_X] + g.start[cell].slope[k], 1e-13);
            }
        }
    }
    crowd_free(&c);
}

/* -------------------------------------------------------------- motion */

/* A group of one is a cell alone, to the last bit. */
static void test_group_of_one(void **unused)
{
    const ellipsoid_options o = touching_cell();
    const test_quadratic flow = towards_origin(100);
    ellipsoid_controller controller = {0, 0};
    ellipsoid_statistics statistics = {0};
    ellipsoid_state alone;
    uint64_t seed = 3;
    double t = 0, t_alone = 0;
    crowd c;

    (void)unused;
    crowd_init(&c, 1, &o, &flow);
    test_orientation(&seed, c.state[0].q);
    c.state[0].x[1] = 5e-6;
    alone = c.state[0];
    crowd_advance(&c, &t, 0.01, NULL);
    assert_ok(ellipsoid_advance(&(ellipsoid_member){&c.model, &c.around[0],
                                                    &alone, &controller, NULL,
                                                    NULL, &statistics},
                                &t_alone, 0.01, NULL));
    assert_memory_equal(&alone, &c.state[0], sizeof(alone));
    assert_memory_equal(&controller, &c.controller[0], sizeof(controller));
    crowd_free(&c);
}

/* Two cells pressed together by the flow, at a tight tolerance and at two that
   are looser: what they differ by follows the tolerance. */
static void test_converges(void **unused)
{
    const test_quadratic flow = towards_origin(50);
    const double tolerance[3] = {1e-10, 1e-5, 1e-7};
    double x[3][3], error[3];

    (void)unused;
    for (int n = 0; n < 3; n++)
    {
        ellipsoid_options o = touching_cell();
        double t = 0;
        crowd c;

        o.tolerance = tolerance[n];
        crowd_init(&c, 2, &o, &flow);
        c.state[0].x[0] = -2e-6;
        c.state[1].x[0] = 2e-6;
        c.state[1].x[1] = 0.7e-6;
        ellipsoid_quaternion_from_axis((const double[]){0.3, 1, 0.2}, 0.1,
                                       c.state[1].q);
        crowd_advance(&c, &t, 0.05, NULL);
        memcpy(x[n], c.state[1].x, sizeof(x[n]));
        error[n] = test_distance(x[n], x[0], 3) / 2e-6;
        crowd_free(&c);
    }
    assert_true(error[1] < 100 * tolerance[1]);
    assert_true(error[2] < 100 * tolerance[2]);
    assert_true(error[2] < error[1]);
}

/* Without inertia the same, but for relaxation times of 1e-7 s. */
static void test_inertialess(void **unused)
{
    const test_quadratic flow = towards_origin(50);
    double x[2][3];

    (void)unused;
    for (int n = 0; n < 2; n++)
    {
        ellipsoid_options o = touching_cell();
        double t = 0;
        crowd c;

        o.tolerance = 1e-8;
        o.motion = n ? ELLIPSOID_MOTION_INERTIALESS : ELLIPSOID_MOTION_INERTIAL;
        crowd_init(&c, 2, &o, &flow);
        c.state[0].x[0] = -2e-6;
        c.state[1].x[0] = 2e-6;
        c.state[1].x[1] = 0.7e-6;
        deepest = 0;
        crowd_advance(&c, &t, 0.05, note_deepest);
        assert_true(deepest > 0);
        memcpy(x[n], c.state[1].x, sizeof(x[n]));
        crowd_free(&c);
    }
    assert_near(test_distance(x[0], x[1], 3), 0, 1e-11);
}

/* A cell that the flow takes against another, which is fixed or, for
   comparison, heavy in a fluid as viscous; stopped after each step or not. */
static void against(int heavy, const ellipsoid_options *o,
                    ellipsoid_observer observer, ellipsoid_state end[2])
{
    const test_quadratic flow = towards_origin(50);
    ellipsoid_options of_heavy = *o;
    ellipsoid_status status = ELLIPSOID_STOPPED;
    ellipsoid_model model;
    uint64_t seed = 8;
    double t = 0;
    int which;
    crowd c;

    crowd_init(&c, 2, o, &flow);
    of_heavy.density *= 1e8;
    of_heavy.kinematic_viscosity *= 1e8;
    of_heavy.pressure_gradient = ELLIPSOID_PRESSURE_NONE;
    model = test_model(&of_heavy);
    test_orientation(&seed, c.state[0].q);
    ellipsoid_set(c.state[1].x, 0.4e-6, 0.3e-6, 5e-6);
    c.around[0].fixed = !heavy;
    c.member[0].model = heavy ? &model : &c.model;
    while (status == ELLIPSOID_STOPPED)
    {
        status = ellipsoid_advance_group(2, c.member, &t, 0.05, observer,
                                         c.memory, &which);
    }
    assert_ok(status);
    memcpy(end, c.state, 2 * sizeof(*end));
    crowd_free(&c);
}

static int stop(void *context, const ellipsoid_step *step)
{
    (void)context;
    (void)step;
    return 1;
}

/* Nothing moves a fixed cell, to the last bit; the other goes as against one
   that is a billion times as heavy, and so it does if it is stopped and
   continued. */
static void test_fixed(void **unused)
{
    (void)unused;
    for (int n = 0; n < 4; n++)
    {
        ellipsoid_options o = touching_cell();
        ellipsoid_state fixed[2], heavy[2], stopped[2];
        uint64_t seed = 8;
        double q[4];

        o.motion =
            n % 2 ? ELLIPSOID_MOTION_INERTIALESS : ELLIPSOID_MOTION_INERTIAL;
        o.friction = n < 2 ? 0 : 0.3;
        o.tolerance = 1e-8;
        against(0, &o, NULL, fixed);
        against(1, &o, NULL, heavy);
        against(0, &o, stop, stopped);
        test_orientation(&seed, q);
        assert_memory_equal(fixed[0].q, q, sizeof(q));
        assert_memory_equal(fixed[0].x, ((double[3]){0, 0, 0}),
                            sizeof(fixed[0].x));
        assert_true(ellipsoid_length(fixed[0].u) == 0
                    && ellipsoid_length(fixed[0].omega) == 0);
        print_message("# beside a heavy one: %.1e of a length\n",
                      test_distance(fixed[1].x, heavy[1].x, 3) / 2e-6);
        assert_true(test_distance(fixed[1].x, heavy[1].x, 3) < 1e-5 * 2e-6);
        assert_memory_equal(stopped, fixed, sizeof(fixed));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        BOTH(test_equal_and_opposite),
        BOTH(test_two_spheres),
        BOTH(test_jacobian),
        BOTH(test_coupled_system),
        cmocka_unit_test_setup(test_group_of_one, with_beads),
        BOTH(test_converges),
        BOTH(test_inertialess),
        BOTH(test_fixed),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
