/* SPDX-License-Identifier: BSD-3-Clause */
/* One time step: preparation, the calls of its plan by hooks, commit. */
#include "guard.h"
#include "populate.h"
#include "step.h"
#include "undo.h"
#include "world_ranks.h"
#include <math.h>
#include <string.h>

/* ---- the flow ---- */

static mps_status run_hooks(mps__step *q)
{
    for (int32_t hook = MPS_MOTION; hook < MPS_HOOK_COUNT; hook++) {
        MPS__TRY(mps__step_run(q, hook));
        /* a body has changed the pressures, so their datum has changed */
        if (hook == MPS_GRADIENT && mps__body_carries(q->w)) MPS__TRY(mps__step_run(q, MPS_LEVEL));
    }
    return MPS_OK;
}

/* ---- before and after it ---- */

static void commit(mps__step *q)
{
    mps__world *w = q->w;
    mps__step_load_end(q);
    mps__step_body_end(q);
    w->state.t = q->pose.t;
    w->state.step++;
    w->state.crossing_time = q->info.crossing_time;
    q->info.struct_size = sizeof q->info;
    q->info.step = w->state.step;
    q->info.dt = q->view.dt;
    q->info.t = w->state.t;
    q->info.lost = w->state.lost;
    q->info.pockets = w->runner.gas.pockets;
    q->info.pocket_volume = w->runner.gas.volume;
    q->info.pocket_pressure = w->runner.gas.pressure;
    q->budget.gas += w->runner.gas.work;
    w->info = q->info;
    w->state.before = w->motion.now;
    w->state.dt_before = q->view.dt;
    w->motion.now = q->pose;
    w->state.jump = q->jump;
    w->state.spread = q->spread;
    w->state.budget = q->budget;
    memcpy(w->state.reaction, q->reaction, sizeof q->reaction);
    w->state.budget.last = q->last;
    w->booked = mps__particles_flow(&w->particles);
    memcpy(w->next_flags.most, q->next_flags, sizeof q->next_flags);
    /* solids move in the tank; without a device nothing was requested */
    w->next_flags.flow = w->runner.memory.last.launches > 0 && !w->work.bodies ? w->booked : -1;
    w->next_flags.searches = w->lists.neighbours.searches;
    w->state.budget.deviation = q->deviation;
    if (!w->state.budget.started) {
        w->state.budget.started = true;
        w->state.budget.deviation_start = w->state.budget.deviation;
    }
}

/* Times by MPS_STAGE_...; the last one is the remainder. */
static void book_times(mps__step *q, double seconds)
{
    mps__runner *h = &q->w->runner;
    double *stage = q->w->info.seconds, rest = seconds;
    h->seconds[MPS_STAGE_PPE_SOLVE] -= q->setup_seconds;
    h->seconds[MPS_STAGE_PPE_SETUP] += q->setup_seconds;
    for (int k = 0; k < MPS_STAGE_CORRECT; k++) rest -= stage[k] = h->seconds[k];
    stage[MPS_STAGE_CORRECT] = rest;
}

/* The liquid starts with the tank's velocity, or everything starts at rest. */
static mps_status start(mps__world *w, mps__budget *budget)
{
    mps__particles *s = &w->particles;
    if (!w->state.start_pending) return MPS_OK;
    MPS__TRY(mps__world_fetch(w));
    w->state.start_pending = 0;
    for (int64_t i = 0; i < s->n; i++) {
        double X[3];
        mps__motion_to_tank(&w->motion, &w->motion.now, s->x + i * w->setup.dim, X);
        mps__motion_point(&w->motion, &w->motion.now, X, NULL, s->u + i * w->setup.dim, NULL);
    }
    mps__array_written(mps__field_array(&s->field[MPS__FIELD_VELOCITY]), MPS__ON_HOST);
    mps__budget_book_added(w, budget);
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

/* The part of a step that can fail and be undone. */
static mps_status try_step(mps__step *q, double dt_max, double *planned)
{
    mps__world *w = q->w;
    q->budget = w->state.budget;
    if (w->lists.gone > 0 || w->lists.first_new != w->particles.next_id)
        mps__budget_book_added(w, &q->budget);
    MPS__TRY(start(w, &q->budget));
    MPS__TRY(mps__step_rotate_areas(w));
    MPS__TRY(mps__step_place_solids(w));
    /* a user's kernel function has no device code */
    if (w->setup.kernel.id != MPS_KERNEL_CUSTOM)
        MPS__TRY(mps__memory_open(&w->runner.memory, &w->runner.plan));
    MPS__TRY(mps__world_mirror_lists(w));
    mps__step_find_areas(w);
    mps__step_open(q);
    mps__runner_log_spaces(&w->runner);
    MPS__TRY(mps__world_stencil(w, MPS_NEAR, &q->view.near));
    MPS__TRY(mps__world_stencil(w, MPS_FAR, &q->view.far));
    mps__runner_book(&w->runner, MPS__OPEN);
    MPS__TRY(mps__world_limit_step(w, &q->stage, &q->view, dt_max, planned, &q->info.limit));
    MPS__TRY(mps__motion_pose(&w->motion, w->state.t + q->view.dt, &q->pose));
    MPS__TRY(mps__world_check_pose(w, &w->motion, &q->pose, MPS_E_DIVERGED));
    mps__motion_view_next(&q->pose, &q->view.tank);
    mps__runner_book(&w->runner, MPS__LIMITS);
    MPS__TRY(run_hooks(q));
    MPS__TRY(check_numbers(w));
    return mps__ranks_status(&w->ranks);
}

static bool any_fluid(mps__world *w)
{
    bool any = false;
    for (int64_t i = 0; i < w->particles.n && !any; i++) any = w->particles.kind[i] == MPS_FLUID;
    mps__world_any(w, 1, &any);
    return any;
}

/* Neighbours, and memory of the step's arrays. */
static mps_status prepare(mps__world *w)
{
    mps__neighbours_release(&w->lists.complete); /* its stencils are valid until this step */
    MPS__TRY(mps__world_populate(w));
    if (!any_fluid(w))
        return mps__fail(w->context, MPS_E_STATE, "there is no fluid particle to step");
    MPS__TRY(mps__world_neighbours_populated(w));
    return mps__channels_reserve(&w->channels, w->particles.n);
}

/* Extend the error text: if the tank is moved by its load and jumps in a failed step, its coupling
 * is the likely cause. */
static mps_status name_coupling(const mps__step *q, mps_status status)
{
    const mps__world *w = q->w;
    const double jump = fmax(q->jump.accel, w->state.jump.accel),
                 usual = w->setup.velocity_scale * w->setup.velocity_scale / w->setup.dp;
    if (status != MPS_E_DIVERGED || !(jump > 2 * usual) || strstr(w->context->error, "coupling"))
        return status;
    if (mps__body_carries(w))
        return mps__fail(w->context, status,
                         "%.330s; coupling: the body moved walls with %.3g m/s2", w->context->error,
                         jump);
    if (!w->motion.posed) return status;
    return mps__fail(w->context, status,
                     "%.330s; coupling: mps_motion_pose_set() moved walls with %.3g m/s2. A body "
                     "that is lighter than the added mass of its liquid needs mps_load.mass",
                     w->context->error, jump);
}

/* After the calls. Lists on the device may be lost: then the next step searches again at the
 * positions of the last search. */
static mps_status exit_device(mps__world *w)
{
    const mps__memory *t = &w->runner.memory;
    char why[MPS__ERROR_SIZE];
    const mps_status status = mps__memory_close(&w->runner.memory);
    w->next_flags.holds = false;
    if (status == MPS_OK) return MPS_OK;
    if (t->torn) w->lists.neighbours.torn = true;
    memcpy(why, w->context->error, sizeof why);
    return mps__fail(w->context, status, "t = %.9g s: %.400s", w->state.t, why);
}

mps_status mps__world_step(mps__world *w, double dt_max)
{
    mps__step q = {.w = w};
    mps__runner_begin(&w->runner);
    const double begin = w->runner.clock;
    w->balance.waited = w->ranks.seconds;
    MPS__TRY(mps__memory_alive(&w->runner.memory));
    MPS__TRY(mps__world_adopt(w));
    MPS__TRY(mps__plan_make(&w->runner.plan, &w->models));
    mps__plan_note(&w->runner.plan, &w->models);
    /* changes since the last step, whether this one succeeds or not */
    MPS__TRY(mps__step_book_between(w));
    mps__memory_begin(&w->runner.memory);
    w->next_flags.holds = w->next_flags.flow == mps__particles_flow(&w->particles) &&
                          w->next_flags.searches == w->lists.neighbours.searches;
    mps_status status = prepare(w);
    if (status < 0) {
        exit_device(w);
        mps__world_depopulate(w);
        return status;
    }
    w->runner.seconds[MPS_STAGE_NEIGHBOURS] += mps__runner_book(&w->runner, MPS__SEARCH);
    const int32_t start_pending = w->state.start_pending;
    double planned = 0;
    status = mps__undo_keep(w);
    mps__runner_book(&w->runner, MPS__UNDO);
    const bool kept = status >= 0;
    if (kept) status = try_step(&q, dt_max, &planned);
    const mps_status closed = exit_device(w);
    if (closed < 0) status = closed; /* a device error takes precedence */
    if (kept && status < 0) {
        const mps_status undone = mps__undo_restore(w, q.before);
        if (undone < 0) status = undone;
    }
    if (status < 0) {
        mps__world_depopulate(w);
        w->state.start_pending = start_pending;
        return name_coupling(&q, status);
    }
    if (w->state.step == 0) mps__world_note_phases(w);
    commit(&q);
#ifdef MPS_CHECKED
    mps__guard_poison(&w->runner);
#endif
    /* a step shortened by the caller does not limit the growth of the next */
    if (planned > 0) w->state.dt_previous = planned;
    mps__runner_book(&w->runner, MPS__COMMIT);
    book_times(&q, w->runner.clock - begin);
    mps__world_balance(w, mps__clock() - begin);
    MPS__TRY(mps__ranks_status(&w->ranks));
    return q.not_converged ? MPS_W_NOT_CONVERGED : MPS_OK;
}
