/* SPDX-License-Identifier: BSD-3-Clause */
/* One time step, in the order of its physics. transaction.c undoes it if a part fails.
 * W22: Wen, Zhao & Wan 2022. */
#include "step.h"
#include "populate.h"
#include "world_ranks.h"

static bool any_fluid(mps__world *w)
{
    bool any = false;
    for (int64_t i = 0; i < w->particles.n && !any; i++) any = w->particles.kind[i] == MPS_FLUID;
    mps__world_any(w, 1, &any);
    return any;
}

/* Neighbours, and memory of the step's arrays. */
static mps_status find_neighbours(mps__world *w)
{
    if (!any_fluid(w))
        return mps__fail(w->context, MPS_E_STATE, "there is no fluid particle to step");
    MPS__TRY(mps__world_neighbours_populated(w));
    MPS__TRY(mps__channels_reserve(&w->channels, w->particles.n));
    w->runner.seconds[MPS_STAGE_NEIGHBOURS] += mps__runner_book(&w->runner, MPS__SEARCH);
    return MPS_OK;
}

/* Velocities before the first step: the liquid starts with the tank's velocity, or everything
 * starts at rest. */
static mps_status start(mps__step *q)
{
    mps__world *w = q->w;
    const mps__particles *s = &w->particles;
    if (w->lists.gone > 0 || w->lists.first_new != s->next_id)
        mps__budget_book_added(w, &q->next.budget);
    if (!w->state.start_pending) return MPS_OK;
    MPS__TRY(mps__world_fetch(w));
    q->next.start_pending = 0;
    for (int64_t i = 0; i < s->n; i++) {
        double X[3];
        mps__motion_to_tank(&w->motion, &w->motion.now, s->x + i * w->setup.dim, X);
        mps__motion_point(&w->motion, &w->motion.now, X, NULL, s->u + i * w->setup.dim, NULL);
    }
    mps__array_written(mps__field_array(&w->particles.field[MPS__FIELD_VELOCITY]), MPS__ON_HOST);
    mps__budget_book_added(w, &q->next.budget);
    return MPS_OK;
}

/* The pose of the tank at the end of the step. */
static mps_status find_pose(mps__step *q)
{
    mps__world *w = q->w;
    MPS__TRY(mps__motion_pose(&w->motion, w->state.t + q->view.dt, &q->pose));
    MPS__TRY(mps__world_check_pose(w, &w->motion, &q->pose, MPS_E_DIVERGED));
    mps__motion_view_next(&q->pose, &q->view.tank);
    mps__runner_book(&w->runner, MPS__LIMITS);
    return MPS_OK;
}

/* The calls of the plan, W22 Fig. 2. */
static mps_status run_hooks(mps__step *q)
{
    for (int32_t hook = MPS_MOTION; hook < MPS_HOOK_COUNT; hook++) {
        MPS__TRY(mps__step_run(q, hook));
        /* a body has changed the pressures, so their datum has changed */
        if (hook == MPS_GRADIENT && mps__body_carries(q->w)) MPS__TRY(mps__step_run(q, MPS_LEVEL));
    }
    return MPS_OK;
}

/* Check the numbers that models keep for the next step. */
static mps_status check_numbers(const mps__world *w)
{
    int64_t k = 0;
    const mps__model *model = mps__models_not_finite(&w->models, &k);
    if (!model) return MPS_OK;
    return mps__fail(w->context, MPS_E_PLUGIN,
                     "model '%s' at t = %.9g s left number %lld of its state %g; must be finite",
                     model->ops->name, w->state.t, (long long)k, model->state.value[k]);
}

/* The next state, and the step for the caller; passes have set their parts of both. */
static void summarise(mps__step *q)
{
    const mps__world *w = q->w;
    const mps__gas *gas = &w->runner.gas;
    mps__state *next = &q->next;
    next->t = q->pose.t;
    next->step++;
    next->dt_before = q->view.dt;
    next->before = w->motion.now;
    next->budget.gas += gas->work;
    next->budget.started = true;
    q->info.struct_size = sizeof q->info;
    q->info.step = next->step;
    q->info.dt = q->view.dt;
    q->info.t = next->t;
    q->info.crossing_time = next->crossing_time;
    q->info.lost = next->lost;
    q->info.pockets = gas->pockets;
    q->info.pocket_volume = gas->volume;
    q->info.pocket_pressure = gas->pressure;
}

static mps_status advance(mps__step *q, double dt_max)
{
    MPS__TRY(mps__world_populate(q->w));
    MPS__TRY(find_neighbours(q->w));
    MPS__TRY(mps__step_keep(q));
    MPS__TRY(start(q));
    MPS__TRY(mps__step_open(q));
    MPS__TRY(mps__step_limit(q, dt_max));
    MPS__TRY(find_pose(q));
    MPS__TRY(run_hooks(q));
    MPS__TRY(check_numbers(q->w));
    summarise(q);
    return mps__ranks_status(&q->w->ranks);
}

mps_status mps__world_step(mps__world *w, double dt_max)
{
    mps__step q = {.w = w, .next_flags = {.flow = -1}};
    MPS__TRY(mps__step_begin(&q));
    return mps__step_end(&q, advance(&q, dt_max));
}
