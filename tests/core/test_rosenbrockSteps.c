/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_rosenbrockSteps.c - steps of the Rosenbrock method: their order, dense output,
    and the elimination of a stage.
*/
#include "flowTest.h"
#include "wallMesh.h"

enum
{
    SIZE = ELLIPSOID_STATE_SIZE
};

/* ---------------------------------------------------------- observed order */

/* What a group of one cell needs. */
typedef struct lone_cell
{
    ellipsoid_evaluation start, next;
    ellipsoid_stages stages;
    ellipsoid_stage_matrix system;
} lone_cell;

static ellipsoid_status step_of(ellipsoid_group *group, double h)
{
    const ellipsoid_plan plan = {.h = h, .end = h};

    return ellipsoid_rosenbrock_step(group, &plan);
}

static ellipsoid_group group_of(ellipsoid_cell *problem, lone_cell *cell)
{
    cell->start.contact = cell->next.contact = ellipsoid_no_contact();
    return (ellipsoid_group){.count = 1,
                             .inertial = problem->inertial,
                             .cell = problem,
                             .start = &cell->start,
                             .next = &cell->next,
                             .stages = &cell->stages,
                             .system = &cell->system};
}

/* `count` equal steps to `end`; the last one is shown if `last` is not NULL. */
static ellipsoid_state equal_steps(const ellipsoid_model *model,
                                   test_vortices *flow,
                                   const ellipsoid_state *begin, double end,
                                   int count, ellipsoid_step *last)
{
    const ellipsoid_surroundings around = {.flow = test_vortex_flow,
                                           .flow_context = flow};
    ellipsoid_statistics statistics = {0};
    ellipsoid_cell problem = {
        .model = model,
        .surroundings = around,
        .statistics = &statistics,
        .length = model->options.semi_axes[1],
        .inertial = 1,
    };
    lone_cell cell;
    ellipsoid_group g = group_of(&problem, &cell);
    const double h = end / count;

    cell.start.state = *begin;
    for (int n = 0; n < count; n++)
    {
        assert_ok(ellipsoid_group_evaluate(&g, 0, g.start, 0, 1));
        assert_ok(step_of(&g, h));
        ellipsoid_normalise(cell.stages.y + AT_Q);
        if (last)
        {
            last->start = n * h;
            last->end = (n + 1) * h;
            last->before = cell.start.state;
            memcpy(&last->after, cell.stages.y, sizeof(last->after));
            ellipsoid_rosenbrock_dense(&g, 0, last->dense);
        }
        memcpy(&cell.start.state, cell.stages.y, sizeof(cell.start.state));
    }
    return cell.start.state;
}

/* Steps far below the relaxation time: order 4 in every variable. */
static void test_order_not_stiff(void **unused)
{
    static const test_row row = {
        "integration",
        "order of the Rosenbrock steps",
        "u, x, omega, q; steps below the relaxation time",
        "Hairer & Wanner (1996), table IV.7.1",
        "A",
        "the next order, at these steps",
        0};
    const ellipsoid_model model = test_unit_body();
    test_vortices flow = {1, 1};
    const ellipsoid_state begin = test_vortex_state(&model, &flow);
    const ellipsoid_state exact =
        equal_steps(&model, &flow, &begin, 1, 4096, NULL);
    ellipsoid_state s = equal_steps(&model, &flow, &begin, 1, 64, NULL);
    const test_errors coarse = test_difference(&s, &exact);
    test_errors fine;

    (void)unused;
    s = equal_steps(&model, &flow, &begin, 1, 256, NULL);
    fine = test_difference(&s, &exact);
    assert_row(&row, log2(coarse.u / fine.u) / 2, 4, 0.2);
    assert_row(&row, log2(coarse.x / fine.x) / 2, 4, 0.2);
    assert_row(&row, log2(coarse.omega / fine.omega) / 2, 4, 0.2);
    assert_row(&row, log2(coarse.q / fine.q) / 2, 4, 0.2);
}

/*
    The paper's cell, steps hundreds of relaxation times (2e-7 s) long: x and q
    keep the order while their errors exceed 1e-9 of the body and of one; u
    and omega, slaved to them, are reported.
*/
static void test_order_stiff(void **unused)
{
    const ellipsoid_options options = test_free_cell();
    const ellipsoid_model model = test_model(&options);
    test_vortices flow = {4e-3, 3e5};
    ellipsoid_state begin = test_vortex_state(&model, &flow), exact, s;
    const double end = 4e-3, a = 2e-6;
    test_errors e[3];

    (void)unused;
    /* past the first relaxation, which equal steps do not resolve */
    begin = equal_steps(&model, &flow, &begin, 1e-5, 1000, NULL);
    exact = equal_steps(&model, &flow, &begin, end, 6400, NULL);
    for (int n = 0; n < 3; n++)
    {
        s = equal_steps(&model, &flow, &begin, end, 50 << n, NULL);
        e[n] = test_difference(&s, &exact);
    }
    print_message("# errors at 50, 100, 200 steps: x %.1e %.1e %.1e"
                  " q %.1e %.1e %.1e\n",
                  e[0].x / a, e[1].x / a, e[2].x / a, e[0].q, e[1].q, e[2].q);
    print_message("# order of u %.2f, of omega %.2f\n",
                  log2(e[0].u / e[2].u) / 2, log2(e[0].omega / e[2].omega) / 2);
    assert_true(e[2].x / a > 1e-9 && e[2].q > 1e-9);
    assert_true(log2(e[0].x / e[2].x) / 2 >= 3.8);
    assert_true(log2(e[0].q / e[2].q) / 2 >= 3.8);
}

/*
    Inside a step the extension is of order 3: its local error falls with the
    fourth power of the step. At both ends it is the step's own result.
*/
static void test_dense_order(void **unused)
{
    const ellipsoid_model model = test_unit_body();
    test_vortices flow = {1, 1};
    const ellipsoid_state begin = test_vortex_state(&model, &flow);
    test_errors e[2];

    (void)unused;
    for (int n = 0; n < 2; n++)
    {
        const double h = n ? 0.025 : 0.05;
        ellipsoid_step step;
        ellipsoid_state s, exact;

        equal_steps(&model, &flow, &begin, h, 1, &step);
        exact = equal_steps(&model, &flow, &begin, 0.4 * h, 64, NULL);
        ellipsoid_step_state(&step, 0.4 * h, &s);
        e[n] = test_difference(&s, &exact);
        ellipsoid_step_state(&step, 0, &s);
        assert_memory_equal(&s, &step.before, sizeof(s));
        ellipsoid_step_state(&step, h, &s);
        assert_memory_equal(&s, &step.after, sizeof(s));
    }
    assert_true(log2(e[0].u / e[1].u) >= 3.7);
    assert_true(log2(e[0].x / e[1].x) >= 3.7);
    assert_true(log2(e[0].omega / e[1].omega) >= 3.7);
    assert_true(log2(e[0].q / e[1].q) >= 3.7);
}

/* Every component of a stage solves (I/(gamma h) - J) k = r: the elimination
   against the full matrix. Rounding times the condition of the blocks. */
static void test_block_elimination(void **unused)
{
    const ellipsoid_model model = test_unit_body();
    test_vortices flow = {1, 1};
    const ellipsoid_surroundings around = {.flow = test_vortex_flow,
                                           .flow_context = &flow};
    ellipsoid_statistics statistics = {0};
    ellipsoid_cell problem = {.model = &model,
                              .surroundings = around,
                              .statistics = &statistics,
                              .length = 1.5,
                              .inertial = 1};
    const double h = 0.7, g = 1 / (ellipsoid_rosenbrock_set.gamma * h);
    double jacobian[SIZE][SIZE], f[SIZE];
    lone_cell cell;
    ellipsoid_group group = group_of(&problem, &cell);
    ellipsoid_state *begin = &cell.start.state;

    (void)unused;
    *begin = test_vortex_state(&model, &flow);
    begin->omega[0] = 1;
    begin->omega[1] = -2;
    begin->omega[2] = 0.5;
    assert_ok(ellipsoid_jacobian(&model, &around, begin, NULL, jacobian));
    assert_ok(ellipsoid_group_evaluate(&group, 0, group.start, 0, 1));
    assert_ok(step_of(&group, h));
    memcpy(f, &cell.start.derivative, sizeof(f));
    for (int i = 0; i < SIZE; i++)
    {
        double sum = g * cell.stages.k[0][i];

        for (int j = 0; j < SIZE; j++)
        {
            sum -= jacobian[i][j] * cell.stages.k[0][j];
        }
        assert_near(sum, f[i], 1e-13);
    }
}

/*
    The same for the paper's cell pressed into a plate that is stiff, where u
    and omega are coupled and the elimination takes differences: with steps
    from a hundredth of the relaxation time to 1e7 of them. Of the terms that
    cancel in a row 7e-11 was left at moduli up to 1e7 Pa (ten times the
    default), 4e-8 at 1e9 Pa, where row exchanges would leave 3e-10.
*/
static void test_elimination_in_contact(void **unused)
{
    static ellipsoid_facet_cache cache;
    static const double plate[3][3] = {
        {-1e-4, -1e-4, 0}, {1e-4, -1e-4, 0}, {0, 1e-4, 0}};
    ellipsoid_options o = test_paper_options();
    wall_mesh wall;
    test_quadratic flow = test_shear(1000);
    ellipsoid_statistics statistics = {0};
    uint64_t seed = 21;

    (void)unused;
    wall_mesh_init(&wall);
    wall_mesh_triangle(&wall, plate[0], plate[1], plate[2], 0);
    wall_mesh_finish(&wall);
    for (int n = 0; n < 500; n++)
    {
        const ellipsoid_surroundings around = {.flow = test_quadratic_flow,
                                               .flow_context = &flow,
                                               .walls = wall_mesh_list,
                                               .walls_context = &wall};
        const double h = pow(10, -9 + n % 10),
                     modulus = pow(10, 5 + n / 10 % 5);
        double jacobian[SIZE][SIZE], f[SIZE], r[3][3], lowest = 0;
        lone_cell cell;
        ellipsoid_state *state = &cell.start.state;
        ellipsoid_model model;

        o.contact_modulus = modulus;
        model = test_model(&o);
        ellipsoid_cell problem = {.model = &model,
                                  .surroundings = around,
                                  .cache = &cache,
                                  .statistics = &statistics,
                                  .length = 2e-6,
                                  .inertial = 1,
                                  .walls = 1};
        ellipsoid_group group = group_of(&problem, &cell);

        memset(state, 0, sizeof(*state));
        test_orientation(&seed, state->q);
        ellipsoid_rotation(state->q, r);
        for (int b = 0; b < model.bead_count; b++)
        {
            lowest = fmin(lowest, ellipsoid_dot(r[2], model.bead[b]));
        }
        state->x[2] = o.bead_radius - lowest - 2e-8 * test_uniform(&seed);
        state->omega[0] = 100 * test_signed(&seed);
        ellipsoid_facet_cache_clear(&cache);
        assert_ok(ellipsoid_jacobian(&model, &around, state, &cache, jacobian));
        assert_ok(ellipsoid_group_evaluate(&group, 0, group.start, 0, 1));
        assert_true(cell.start.contact.bead_contacts > 0);
        /* later stages may lie in the wall: the first is of interest */
        (void)step_of(&group, h);
        memcpy(f, &cell.start.derivative, sizeof(f));
        for (int i = 0; i < SIZE; i++)
        {
            double sum =
                cell.stages.k[0][i] / (ellipsoid_rosenbrock_set.gamma * h)
                - f[i];
            double size = fabs(sum) + fabs(f[i]);

            for (int j = 0; j < SIZE; j++)
            {
                sum -= jacobian[i][j] * cell.stages.k[0][j];
                size += fabs(jacobian[i][j] * cell.stages.k[0][j]);
            }
            assert_near(sum / size, 0, modulus > 1e7 ? 1e-6 : 1e-9);
        }
    }
    wall_mesh_free(&wall);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_block_elimination),
        cmocka_unit_test(test_elimination_in_contact),
        cmocka_unit_test(test_order_not_stiff),
        cmocka_unit_test(test_order_stiff),
        cmocka_unit_test(test_dense_order),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
