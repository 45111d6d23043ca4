/* SPDX-License-Identifier: GPL-3.0-or-later
   Copyright (C) 2026 the ellipsoidTrapFoam authors */

/*
    rungeKutta.c - one explicit step of inertialess motion, and its dense output.

    Tsitouras, Comput. Math. Appl. 62, 770 (2011): order 5(4), the last stage
    is the first of the next step, with a continuous extension of order 4. Its
    error is half that of Dormand and Prince's method for the same work.

    Where the flow's gradient jumps, its error estimate is an eighth of the
    error (root mean squares over where in the step the jump is), and error and
    work are larger than with stages that lie evenly: there steps are those of
    Kutta's 3/8 rule (1901), order 4, with the weights (1/12, 1/2, 1/4, 0,
    1/6) of order 3, the last for the slope at the end, and Hermite's cubic.
*/
#include "motion/motion.h"

enum
{
    MOST = ELLIPSOID_MAX_STAGES
};

/* A method whose last stage is its result. */
typedef struct method
{
    int stages, order;
    double a[MOST][MOST - 1];
    double error[MOST]; /* of the result less that of lower order */
    double dense[MOST]; /* of the fourth power of time in the continuous
                           extension */
    double time[MOST];  /* c_i, which ascend */
} method;

static const method tsitouras = {
    .stages = 7,
    .order = 5,
    .a = {{0},
          {0.161},
          {-0.008480655492356989, 0.335480655492357},
          {2.8971530571054935, -6.359448489975075, 4.3622954328695815},
          {5.325864828439257, -11.748883564062828, 7.4955393428898365,
           -0.09249506636175525},
          {5.86145544294642, -12.92096931784711, 8.159367898576159,
           -0.071584973281401, -0.028269050394068383},
          {0.09646076681806523, 0.01, 0.4798896504144996, 1.379008574103742,
           -3.290069515436081, 2.324710524099774}},
    .error = {-0.00178001105222577714, -0.0008164344596567469,
              0.007880878010261995, -0.1447110071732629, 0.5823571654525552,
              -0.45808210592918697, 1.0 / 66},
    .dense = {-1.0530884977290216, 0.1017, 2.490627285651253,
              -16.548102889244902, 47.37952196281928, -34.87065786149661, 2.5},
    .time = {0, 0.161, 0.327, 0.9, 0.9800255409045097, 1, 1}};

static const method kutta = {
    .stages = 5,
    .order = 4,
    .a = {{0},
          {1.0 / 3},
          {-1.0 / 3, 1},
          {1, -1, 1},
          {1.0 / 8, 3.0 / 8, 3.0 / 8, 1.0 / 8}},
    .error = {1.0 / 24, -1.0 / 8, 1.0 / 8, 1.0 / 8, -1.0 / 6},
    .time = {0, 1.0 / 3, 2.0 / 3, 1, 1}};

static const int in_time[MOST] = {0, 1, 2, 3, 4, 5, 6};

static inline const method *method_of(const ellipsoid_group *g)
{
    return g->piecewise ? &kutta : &tsitouras;
}

/* A stage's slopes: of x, and of q; and, for dense output, omega itself in
   that of its derivative. */
static inline void keep_slopes(const ellipsoid_state *state,
                               const ellipsoid_state *derivative,
                               double k[UNKNOWNS])
{
    ellipsoid_copy(derivative->x, k + AT_X);
    ellipsoid_copy(state->omega, k + AT_OMEGA);
    memcpy(k + AT_Q, derivative->q, sizeof(derivative->q));
}

/* Sets the state of a stage; the last one is the result. */
static inline int set_stage(const method *m, const ellipsoid_evaluation *start,
                            int stage, double h, int fixed, ellipsoid_stages *s,
                            ellipsoid_evaluation *at)
{
    double change[UNKNOWNS];

    ellipsoid_weighted_sum(s->k, m->a[stage], stage, AT_X, change);
    for (int n = AT_X; n < UNKNOWNS; n++)
    {
        at->y[n] = start->y[n] + (ellipsoid_is_rate(n) ? 0 : h * change[n]);
    }
    if (!ellipsoid_is_pose(at->state.x, at->state.q))
    {
        return 0;
    }
    if (stage == m->stages - 1 && !fixed)
    {
        ellipsoid_normalise(at->state.q);
    }
    return 1;
}

/* All of the step for `count` cells; inlined for one and for several. */
static inline ellipsoid_status take(ellipsoid_group *g, const method *m,
                                    int count, const ellipsoid_plan *plan,
                                    int *touched)
{
    const double h = plan->h;

    *touched = 0;
    for (int cell = 0; cell < count; cell++)
    {
        const ellipsoid_evaluation *start = &g->start[cell];
        ellipsoid_stages *s = &g->stages[cell];

        s->order = m->order;
        s->sampled = m->stages;
        s->in_time = in_time;
        keep_slopes(&start->state, &start->derivative, s->k[0]);
        ellipsoid_stages_sample(s, 0, start);
    }

    for (int i = 1; i < m->stages; i++)
    {
        ellipsoid_status status;

        for (int cell = 0; cell < count; cell++)
        {
            if (!set_stage(m, &g->start[cell], i, h, g->cell[cell].fixed,
                           &g->stages[cell], &g->next[cell]))
            {
                return ELLIPSOID_STEP_UNDERFLOW;
            }
        }
        status = ellipsoid_group_evaluate(
            g, ellipsoid_stage_time(plan, m->time[i]), g->next, 1, 0);
        if (status != ELLIPSOID_OK)
        {
            return status;
        }
        for (int cell = 0; cell < count; cell++)
        {
            const ellipsoid_evaluation *at = &g->next[cell];
            ellipsoid_stages *s = &g->stages[cell];

            *touched = *touched || ellipsoid_in_contact(&at->contact);
            ellipsoid_stages_sample(s, i, at);
            keep_slopes(&at->state, &at->derivative, s->k[i]);
        }
        if (*touched)
        {
            return ELLIPSOID_OK;
        }
    }
    for (int cell = 0; cell < count; cell++)
    {
        ellipsoid_stages *s = &g->stages[cell];

        ellipsoid_weighted_sum(s->k, m->error, m->stages, AT_X, s->error);
        for (int n = AT_X; n < UNKNOWNS; n++)
        {
            s->error[n] *= h;
        }
        memcpy(s->y, g->next[cell].y, sizeof(s->y));
    }
    return ELLIPSOID_OK;
}

ellipsoid_status ellipsoid_explicit_step(ellipsoid_group *g,
                                         const ellipsoid_plan *plan,
                                         int *touched)
{
    if (method_of(g) == &kutta)
    {
        return take(g, &kutta, g->count, plan, touched);
    }
    return g->count == 1 ? take(g, &tsitouras, 1, plan, touched)
                         : take(g, &tsitouras, g->count, plan, touched);
}

/*
    With D = y1 - y0 the extension is y0 + s D + s (1-s) (d_0 + s d_1
    + s (1-s) d_2), d_0 = h k_1 - D, d_1 = D - h k_7 - d_0,
    d_2 = h sum_j dense_j k_j. u and omega are slopes: theirs is the derivative
    of the extension of x, and of that of an angle with slopes omega.
*/
void ellipsoid_explicit_dense(const ellipsoid_group *g, int cell,
                              double dense[3][UNKNOWNS])
{
    const method *m = method_of(g);
    const double *before = g->start[cell].y, *after = g->next[cell].y;
    const int last = m->stages - 1;
    const double h = g->step[cell].end - g->step[cell].start;
    double(*k)[UNKNOWNS] = g->stages[cell].k;
    double change[UNKNOWNS];

    ellipsoid_weighted_sum(k, m->a[last], last, AT_X, change);
    ellipsoid_weighted_sum(k, m->dense, m->stages, AT_X, dense[2]);
    for (int n = AT_X; n < UNKNOWNS; n++)
    {
        const double d =
            ellipsoid_is_rate(n) ? h * change[n] : after[n] - before[n];

        dense[0][n] = h * k[0][n] - d;
        dense[1][n] = d - h * k[last][n] - dense[0][n];
        dense[2][n] *= h;
    }
    for (int n = 0; n < 3; n++)
    {
        const int of[2] = {AT_X + n, AT_OMEGA + n};
        const int to[2] = {AT_U + n, AT_OMEGA + n};

        for (int i = 0; i < 2; i++)
        {
            const double d1 = dense[1][of[i]], d2 = dense[2][of[i]];

            dense[0][to[i]] = (3 * d1 + 2 * d2) / h;
            dense[1][to[i]] = -4 * d2 / h;
            dense[2][to[i]] = 0;
        }
    }
}
