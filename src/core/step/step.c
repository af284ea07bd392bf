/* SPDX-License-Identifier: BSD-3-Clause */
/* One time step, W22 section 2.5 and Fig. 2: predict, pressure equation, correct. The one file that knows the order. */
#include "guard.h"
#include "step.h"
#include "undo.h"
#include "world_ranks.h"

static mps_status look_around(mps__step *q);
static mps_status predict(mps__step *q);
static mps_status correct(mps__step *q);

/* ---- the flow ---- */

static mps_status run_stages(mps__step *q)
{
    MPS__TRY(look_around(q));
    MPS__TRY(predict(q));
    MPS__TRY(mps__step_project(q));
    MPS__TRY(correct(q));
    MPS__TRY(mps__world_check_result(q->w, &q->stage, q->moved, &q->info));
    return mps__world_check_moves(q->w, &q->pose, q->stage.dt);
}

void mps__step_end_stage(mps__step *q, int stage)
{
    const double now = mps__clock();
    q->info.seconds[stage] += now - q->clock;
    q->clock = now;
}

static bool on_surface(const void *world, int64_t i)
{
    const mps__world *w = world;
    const mps__particles *s = &w->particles;
    return s->kind[i] == MPS_FLUID && s->region[i] == MPS_REGION_SURFACE &&
           !mps__is_ghost(&w->ghosts, i);
}

/* Neighbours, number density, regions and all else at r^k that later moments read. */
static mps_status look_around(mps__step *q)
{
    mps__world *w = q->w;
    MPS__TRY(mps__neighbours_near(&w->lists.neighbours));
    mps__step_end_stage(q, MPS_STAGE_NEIGHBOURS);
    mps__step_move_tank(q);
    MPS__TRY(mps__step_begin(q));
    MPS__TRY(mps__step_run(q, MPS_CLASSIFY));
    MPS__TRY(mps__step_run(q, MPS_PREPARE));
    q->info.surface = mps__parallel_count(&w->pool.parallel, w->particles.n, on_surface, w);
    return MPS_OK;
}

static void predict_rows(void *step, int64_t begin, int64_t end)
{
    const mps__step *q = step;
    const mps_stage *s = &q->stage;
    const double *a = q->w->work.motion;
    double *u = q->w->particles.u;
    for (int64_t i = begin; i < end; i++)
        if (s->kind[i] == MPS_FLUID)
            for (int d = 0; d < s->dim; d++)
                u[i * s->dim + d] += s->dt * (a[i * s->dim + d] + s->g[d]);
}

/* u* = u + dt (a + g). Z14 (9). */
static mps_status predict(mps__step *q)
{
    mps__world *w = q->w;
    mps__parallel_zero(&w->pool.parallel, &(mps__block){w->work.motion, q->stage.n * w->setup.dim},
                       1);
    mps__host_alike(&w->host, MPS__ACCELERATION);
    MPS__TRY(mps__step_run(q, MPS_FORCE));
    mps__step_book_forces(q);
    mps_parallel_rows(&w->pool.parallel, q->stage.n, predict_rows, q);
    mps__host_written(&w->host, MPS__VELOCITY);
    return MPS_OK;
}

/* u = u* + dt a(p) */
static void push_rows(void *step, int64_t begin, int64_t end)
{
    const mps__step *q = step;
    const mps_stage *s = &q->stage;
    const double *a = q->w->work.motion;
    double *u = q->w->particles.u;
    for (int64_t i = begin; i < end; i++)
        for (int64_t k = i * s->dim; k < (i + 1) * s->dim; k++)
            u[k] += s->kind[i] == MPS_FLUID ? s->dt * a[k] : 0;
}

/* r = r + dt u + shift; solids go where the tank will be. The old positions are kept. */
static void move_rows(void *step, int64_t begin, int64_t end)
{
    const mps__step *q = step;
    const mps_stage *s = &q->stage;
    const mps__world *w = q->w;
    const double *dx = w->work.motion, *u = w->particles.u;
    for (int64_t i = begin; i < end; i++) {
        double *x = w->particles.x + i * s->dim;
        for (int d = 0; d < s->dim; d++) w->work.x0[i * s->dim + d] = x[d];
        if (s->kind[i] == MPS_FLUID)
            for (int d = 0; d < s->dim; d++) x[d] += s->dt * u[i * s->dim + d] + dx[i * s->dim + d];
        else
            mps__motion_point(&w->motion, &q->pose, w->particles.ref + i * s->dim, x, NULL, NULL);
    }
}

/* u = u* + dt a(p), collisions, shift. Z14 (12)(13). */
static mps_status correct(mps__step *q)
{
    mps__world *w = q->w;
    const mps_parallel *threads = &w->pool.parallel;
    const int64_t n = q->stage.n;
    const mps__block motion = {w->work.motion, n * w->setup.dim};
    MPS__TRY(mps__step_run(q, MPS_LEVEL));
    mps__parallel_zero(threads, &motion, 1);
    mps__host_alike(&w->host, MPS__ACCELERATION);
    MPS__TRY(mps__step_run(q, MPS_GRADIENT));
    mps__parallel_copy(threads, w->work.load, w->particles.p, n);
    mps__host_written(&w->host, MPS__WALL_PRESSURE);
    MPS__TRY(mps__step_run(q, MPS_LOAD));
    mps_parallel_rows(threads, n, push_rows, q);
    mps__host_written(&w->host, MPS__VELOCITY);
    mps__step_book_pressure(q);
    MPS__TRY(mps__step_run(q, MPS_VELOCITY));
    mps__step_book_collisions(q);
    mps__parallel_zero(threads, &motion, 1);
    mps__host_alike(&w->host, MPS__DISPLACEMENT);
    MPS__TRY(mps__step_run(q, MPS_SHIFT));
    mps__step_book_shift(q);
    q->moved = true;
    mps_parallel_rows(threads, n, move_rows, q);
    mps__step_stop_at_plates(q);
    return MPS_OK;
}

/* ---- before and after it ---- */

static void commit(mps__step *q)
{
    mps__world *w = q->w;
    w->state.t = q->pose.t;
    w->state.step++;
    w->state.crossing_time = q->info.crossing_time;
    q->info.struct_size = sizeof q->info;
    q->info.step = w->state.step;
    q->info.dt = q->stage.dt;
    q->info.t = w->state.t;
    q->info.lost = w->state.lost;
    w->info = q->info;
    w->state.before = w->motion.now;
    w->state.dt_before = q->stage.dt;
    w->motion.now = q->pose;
    mps__parallel_copy(&w->pool.parallel, w->particles.load, w->work.load, w->particles.n);
    w->info.separated = 0;
    for (int64_t i = 0; i < w->particles.n; i++) {
        w->particles.held[i] = q->terms.condition[i] == MPS__ROW_HELD;
        w->info.separated += w->particles.held[i] && !mps__is_ghost(&w->ghosts, i);
    }
    int64_t counts[] = {w->info.surface, w->info.separated, w->info.ppe_unknowns};
    mps__ranks_add(&w->ranks, 3, counts);
    w->info.surface = counts[0];
    w->info.separated = counts[1];
    w->info.ppe_unknowns = counts[2];
    w->state.jump = q->jump;
    w->state.spread = q->spread;
    w->state.budget = q->budget;
    mps__budget_sum(w, &w->state.budget.last);
    w->state.budget.deviation = mps__budget_mean_deviation(w);
    if (!w->state.budget.started) {
        w->state.budget.started = true;
        w->state.budget.deviation_start = w->state.budget.deviation;
    }
}

/* The liquid starts with the tank's velocity, or everything from rest. */
static void start(mps__world *w, mps__budget *budget)
{
    mps__particles *s = &w->particles;
    if (!w->state.start_pending) return;
    w->state.start_pending = 0;
    for (int64_t i = 0; i < s->n; i++) {
        double X[3];
        mps__motion_to_tank(&w->motion, &w->motion.now, s->x + i * w->setup.dim, X);
        mps__motion_point(&w->motion, &w->motion.now, X, NULL, s->u + i * w->setup.dim, NULL);
    }
    mps__budget_book_added(w, budget);
}

/* All that may fail after the state is kept. */
static mps_status try_step(mps__step *q, double dt_max, double *planned)
{
    mps__world *w = q->w;
    q->budget = w->state.budget;
    if (w->lists.gone > 0) mps__budget_book_added(w, &q->budget);
    start(w, &q->budget);
    MPS__TRY(mps__step_turn_areas(w));
    mps__step_open(q);
    MPS__TRY(mps__world_stencil(w, MPS_NEAR, &q->near));
    MPS__TRY(mps__world_stencil(w, MPS_FAR, &q->far));
    MPS__TRY(mps__world_limit_step(w, &q->stage, dt_max, planned));
    MPS__TRY(mps__motion_pose(&w->motion, w->state.t + q->stage.dt, &q->pose));
    w->host.next = &q->pose;
    const mps_status status = run_stages(q);
    w->host.next = NULL;
    return status < 0 ? status : mps__ranks_status(&w->ranks);
}

static bool any_fluid(mps__world *w)
{
    bool any = false;
    for (int64_t i = 0; i < w->particles.n && !any; i++) any = w->particles.kind[i] == MPS_FLUID;
    mps__world_any(w, 1, &any);
    return any;
}

mps_status mps__world_step(mps__world *w, double dt_max)
{
    const double begin = mps__clock();
    mps__step q = {.w = w, .clock = begin};
    w->host.motion = &w->motion;
    w->host.next = NULL;
    w->balance.waited = w->ranks.seconds;
    MPS__TRY(mps__world_adopt(w));
    if (!any_fluid(w))
        return mps__fail(w->context, MPS_E_STATE, "there is no fluid particle to step");
    MPS__TRY(mps__plan_make(&w->host.plan, &w->models));
    mps__plan_note(&w->host.plan, &w->models);
    /* what has come, changed or gone since the last step, whatever becomes of this one */
    mps__budget_update(w, &w->state.budget);
    MPS__TRY(mps__world_neighbours(w));
    const int32_t start_pending = w->state.start_pending;
    double planned = 0;
    mps_status status = mps__undo_keep(w);
    if (status >= 0) {
        status = try_step(&q, dt_max, &planned);
        if (status < 0) mps__undo_restore(w, q.moved);
    }
    if (status < 0) {
        mps__world_take_back(w);
        w->state.start_pending = start_pending;
        return status;
    }
    if (w->state.step == 0) mps__world_note_phases(w);
    commit(&q);
#ifdef MPS_CHECKED
    mps__guard_poison(&w->host);
#endif
    /* a step cut short says nothing about the next */
    if (planned > 0) w->state.dt_previous = planned;
    mps__step_end_stage(&q, MPS_STAGE_CORRECT);
    w->info.seconds[MPS_STAGE_CORRECT] = q.info.seconds[MPS_STAGE_CORRECT];
    mps__world_balance(w, mps__clock() - begin);
    MPS__TRY(mps__ranks_status(&w->ranks));
    return q.not_converged ? MPS_W_NOT_CONVERGED : MPS_OK;
}
