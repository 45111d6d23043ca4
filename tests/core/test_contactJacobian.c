/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    test_contactJacobian.c - the Jacobian of a group of cells in contact with
    walls and with one another, friction, damping and adhesion included.

    Lengths, times and masses are of the order of one here, so that differences
    are good to 1e-9.
*/
#include "coreTest.h"
#include "wallMesh.h"

#include <stdlib.h>

enum
{
    CELLS = 3,
    SIZE = ELLIPSOID_STATE_SIZE
};

typedef struct scene
{
    ellipsoid_model model[CELLS];
    ellipsoid_surroundings around;
    ellipsoid_facet_cache cache[CELLS];
    ellipsoid_statistics statistics;
    ellipsoid_evaluation *point;
    ellipsoid_pairs pairs;
    ellipsoid_group group;
    void *memory;
} scene;

static void set_scene(scene *s, const ellipsoid_options options[CELLS],
                      test_quadratic *flow, wall_mesh *mesh)
{
    s->around = (ellipsoid_surroundings){.flow = test_quadratic_flow,
                                         .flow_context = flow,
                                         .walls = wall_mesh_list,
                                         .walls_context = mesh};
    s->memory = malloc(ellipsoid_group_size(CELLS));
    ellipsoid_group_lay_out(CELLS, s->memory, &s->group, &s->pairs);
    s->group.inertial = 1;
    s->point = s->group.start;
    for (int c = 0; c < CELLS; c++)
    {
        s->model[c] = test_model(&options[c]);
        ellipsoid_facet_cache_clear(&s->cache[c]);
        s->group.cell[c] = (ellipsoid_cell){.model = &s->model[c],
                                            .surroundings = s->around,
                                            .cache = &s->cache[c],
                                            .statistics = &s->statistics,
                                            .inertial = 1,
                                            .walls = 1};
    }
}

/* The accelerations of all cells. */
static void accelerations(scene *s, double all[6 * CELLS], int touching[CELLS])
{
    assert_ok(ellipsoid_group_evaluate(&s->group, 0, s->point, 0, 0));
    for (int c = 0; c < CELLS; c++)
    {
        memcpy(all + 6 * c, s->point[c].derivative.u, 3 * sizeof(*all));
        memcpy(all + 6 * c + 3, s->point[c].derivative.omega, 3 * sizeof(*all));
        touching[c] = s->point[c].contact.bead_contacts;
    }
}

/* Six rows of a cell by the thirteen unknowns of one. */
static void add_rows(const ellipsoid_jacobian_blocks *b, double rows[6][SIZE])
{
    for (int i = 0; i < 3; i++)
    {
        for (int l = 0; l < 3; l++)
        {
            rows[i][AT_U + l] += b->uu[i][l];
            rows[i][AT_X + l] += b->ux[i][l];
            rows[i][AT_OMEGA + l] += b->uw[i][l];
            rows[i + 3][AT_U + l] += b->wu[i][l];
            rows[i + 3][AT_X + l] += b->wx[i][l];
            rows[i + 3][AT_OMEGA + l] += b->ww[i][l];
        }
        for (int l = 0; l < 4; l++)
        {
            rows[i][AT_Q + l] += b->uq[i][l];
            rows[i + 3][AT_Q + l] += b->wq[i][l];
        }
    }
}

static void analytic(scene *s, double rows[CELLS][CELLS][6][SIZE])
{
    assert_ok(ellipsoid_group_evaluate(&s->group, 0, s->point, 0, 1));
    memset(rows, 0, sizeof(double[CELLS][CELLS][6][SIZE]));
    for (int c = 0; c < CELLS; c++)
    {
        add_rows(&s->point[c].blocks, rows[c][c]);
    }
    for (int n = 0; n < s->pairs.count; n++)
    {
        const ellipsoid_coupling *between = &s->pairs.coupling[n];

        add_rows(&between->blocks, rows[between->row][between->column]);
    }
}

/* Cells that overlap one another and the walls of a corner, in motion. */
static void throw_cells(uint64_t *seed, scene *s)
{
    for (int c = 0; c < CELLS; c++)
    {
        ellipsoid_state *at = &s->point[c].state;

        test_orientation(seed, at->q);
        for (int i = 0; i < 3; i++)
        {
            at->u[i] = test_signed(seed);
            at->omega[i] = test_signed(seed);
            at->x[i] = 0.6 + 0.5 * test_uniform(seed);
        }
        at->x[2] = 0.6 + 0.85 * c + 0.1 * test_signed(seed);
        for (int i = 0; i < 4; i++)
        {
            at->q[i] *= 1.01; /* as inside a step */
        }
    }
}

/* Is something near a kink: a bead about to touch, or one that the damping
   lets go? The forces of two differences tell. */
static int differ(const double a[6 * CELLS], const double b[6 * CELLS],
                  double by)
{
    for (int i = 0; i < 6 * CELLS; i++)
    {
        if (!(fabs(a[i] - b[i]) <= by))
        {
            return 1;
        }
    }
    return 0;
}

/* Central differences of two widths, where they agree. */
static int difference(scene *s, double *value, double step[6 * CELLS])
{
    const double middle = *value;
    double slope[2][6 * CELLS], low[6 * CELLS], high[6 * CELLS];
    int before[CELLS], after[CELLS];

    for (int n = 0; n < 2; n++)
    {
        const double h = n == 0 ? 2e-5 : 1e-5;

        *value = middle - h;
        accelerations(s, low, before);
        *value = middle + h;
        accelerations(s, high, after);
        *value = middle;
        for (int i = 0; i < 6 * CELLS; i++)
        {
            slope[n][i] = (high[i] - low[i]) / (2 * h);
        }
        if (memcmp(before, after, sizeof(before)) != 0)
        {
            return 0;
        }
    }
    memcpy(step, slope[1], sizeof(slope[1]));
    return !differ(slope[0], slope[1], 1e-5);
}

static const double law_of_cell[CELLS][3] = {
    {0.5, 0.2, 0.1}, {0.8, 0.3, 0.2}, {0.3, 0.25, 0}};

/*
    All blocks, uw, wu and those between cells included, against central
    differences. Rounding: 1e-16 of forces of 10 over 1e-5; truncation where the
    differences of two widths agree to 1e-5: a third of that.
*/
static void check_jacobian(ellipsoid_contact_shape shape, double adhesion)
{
    static scene s;
    static double rows[CELLS][CELLS][6][SIZE];
    ellipsoid_options options[CELLS];
    const double low[3] = {0, 0, 0}, high[3] = {9, 9, 9};
    test_quadratic flow = test_shear(0.3);
    wall_mesh mesh;
    uint64_t seed = 5;
    int checked = 0, mixed = 0;

    wall_mesh_init(&mesh);
    wall_mesh_box(&mesh, low, high, 1, 0, 0);
    wall_mesh_finish(&mesh);
    for (int c = 0; c < CELLS; c++)
    {
        options[c] = test_paper_options();
        ellipsoid_set(options[c].semi_axes, 0.6, 1 - 0.1 * c, 0.5);
        options[c].bead_radius = 0.3 + 0.05 * c;
        options[c].contact_shape = shape;
        options[c].adhesion = adhesion;
        options[c].adhesion_range = 0.1;
        options[c].density = options[c].fluid_density = 1;
        options[c].kinematic_viscosity = 0.1;
        options[c].contact_modulus = 3;
        options[c].friction = law_of_cell[c][0];
        options[c].slip_speed = law_of_cell[c][1];
        options[c].contact_damping = law_of_cell[c][2];
    }
    set_scene(&s, options, &flow, &mesh);
    for (int n = 0; n < 60; n++)
    {
        throw_cells(&seed, &s);
        analytic(&s, rows);
        mixed += s.pairs.count > 0 && s.point[0].contact.bead_contacts > 0;
        for (int c = 0; c < CELLS; c++)
        {
            double y[SIZE];

            for (int l = 0; l < SIZE; l++)
            {
                double slope[6 * CELLS];
                const ellipsoid_state kept = s.point[c].state;

                memcpy(y, &kept, sizeof(y));
                if (!difference(&s, (double *)&s.point[c].state + l, slope))
                {
                    continue;
                }
                s.point[c].state = kept;
                checked++;
                for (int i = 0; i < 6 * CELLS; i++)
                {
                    assert_near(rows[i / 6][c][i % 6][l], slope[i], 2e-5);
                }
            }
        }
    }
    print_message("# %d checked, %d mixed\n", checked, mixed);
    assert_true(checked > 1000);
    assert_true(mixed > 20);
    free(s.memory);
    wall_mesh_free(&mesh);
}

static void test_jacobian_of_a_group(void **unused)
{
    (void)unused;
    check_jacobian(ELLIPSOID_CONTACT_BEADS, 0);
    check_jacobian(ELLIPSOID_CONTACT_BEADS, 0.1);
}

static void test_jacobian_of_exact_contact(void **unused)
{
    (void)unused;
    check_jacobian(ELLIPSOID_CONTACT_ELLIPSOID, 0);
    check_jacobian(ELLIPSOID_CONTACT_ELLIPSOID, 0.1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_jacobian_of_a_group),
        cmocka_unit_test(test_jacobian_of_exact_contact),
    };

    return cmocka_run_group_tests_name("contactJacobian", tests, NULL, NULL);
}
