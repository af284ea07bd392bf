/* SPDX-License-Identifier: BSD-3-Clause */
/* One time step, W22 section 2.5 and Fig. 2: predict, pressure equation, correct. The one file that knows the order. */
#include "guard.h"
#include "step.h"
#include "undo.h"

/* Share of its way to that of the present step that the spread of pressures goes in a step. */
static const double SPREAD_SHARE = 0.2;

static mps_status look_around(mps__step *q);
static mps_status predict(mps__step *q);
static mps_status project(mps__step *q);
static mps_status correct(mps__step *q);

/* ---- the flow ---- */

static mps_status run_stages(mps__step *q)
{
    MPS__TRY(look_around(q));
    MPS__TRY(predict(q));
    MPS__TRY(project(q));
    MPS__TRY(correct(q));
    MPS__TRY(mps__world_check_result(q->w, &q->stage, q->moved, &q->info));
    return mps__world_check_moves(q->w, &q->pose, q->stage.dt);
}

static void end_stage(mps__step *q, int stage)
{
    const double now = mps__clock();
    q->info.seconds[stage] += now - q->clock;
    q->clock = now;
}

static bool on_surface(const void *particles, int64_t i)
{
    const mps__particles *s = particles;
    return s->kind[i] == MPS_FLUID && s->region[i] == MPS_REGION_SURFACE;
}

/* Neighbours, number density, regions and all else at r^k that later moments read. */
static mps_status look_around(mps__step *q)
{
    mps__world *w = q->w;
    MPS__TRY(mps__neighbours_near(&w->lists.neighbours));
    end_stage(q, MPS_STAGE_NEIGHBOURS);
    mps__step_move_tank(q);
    MPS__TRY(mps__step_begin(q));
    MPS__TRY(mps__step_run(q, MPS_CLASSIFY));
    MPS__TRY(mps__step_run(q, MPS_PREPARE));
    q->info.surface = mps__parallel_count(&w->pool.parallel, w->particles.n, on_surface,
                                          &w->particles);
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
    MPS__TRY(mps__step_run(q, MPS_FORCE));
    mps__step_book_forces(q);
    mps_parallel_rows(&w->pool.parallel, q->stage.n, predict_rows, q);
    return MPS_OK;
}

/* A gain g below 1 leaves (1 - g) dt/g =: T of a steady demand to later steps. In a shorter step g would ask for what longer ones left at
 * once: pressures would jump by (1 - g)(dt_before/dt - 1). With g = dt/(dt + T) they do not feel dt; T follows the steps slowly. */
static void spread_gain(mps__step *q)
{
    double *gain = &q->terms.equation.gain;
    const double dt = q->stage.dt, wanted = dt * (1 - *gain) / *gain;
    q->spread = q->w->state.spread > 0
                    ? q->w->state.spread + SPREAD_SHARE * (wanted - q->w->state.spread)
                    : wanted;
    *gain = dt / (dt + q->spread);
}

/* The law of a gas needs a solver of nonlinear rows. */
static mps_status check_laws(const mps__step *q)
{
    const mps__world *w = q->w;
    for (int64_t i = 0; i < q->stage.n && !w->solvers.use->nonlinear; i++)
        if (q->terms.law[i] > 0)
            return mps__fail(w->context, MPS_E_STATE,
                             "model '%s' makes the pressure equation nonlinear, and solver '%s' is "
                             "for linear ones: choose "
                             "'sundials.kinsol'",
                             mps__host_writer(&w->host, MPS__GAS_LAW), w->solvers.use->name);
    return MPS_OK;
}

static void note_level(mps__step *q)
{
    mps__world *w = q->w;
    q->stage.level_free = w->ppe.level_free;
    if (!w->ppe.level_free || w->state.level_told) return;
    w->state.level_told = true;
    mps__log(w->context, MPS_LOG_INFO,
             "t = %.9g s: no surface, fixed pressure or compressible phase gives the pressures a "
             "level; their mean is zero",
             q->stage.t);
}

static mps_status solve(mps__step *q, mps_ppe_result *result)
{
    mps__world *w = q->w;
    w->bounds.held = w->particles.held;
    w->bounds.solves = 0;
    if (w->ppe.n == 0) return MPS_OK;
    const mps_status status = mps__bounds_solve(&w->bounds, &w->solvers, &w->ppe, &q->stage,
                                                &q->terms, result);
    /* a NaN of the prediction has a particle and a place */
    if (status == MPS_E_SOLVER) MPS__TRY(mps__world_check_result(w, &q->stage, q->moved, &q->info));
    if (status < 0)
        return mps__fail(w->context, status, "t = %.9g s: %.400s", q->stage.t, w->context->error);
    q->not_converged = status == MPS_W_NOT_CONVERGED;
    if (q->not_converged)
        mps__log(w->context, MPS_LOG_WARNING, "t = %.9g s: %.400s", q->stage.t, w->context->error);
    return MPS_OK;
}

/* <lap p> = source. W22 (10). */
static mps_status project(mps__step *q)
{
    mps__world *w = q->w;
    mps_ppe_result result = {.struct_size = sizeof result};
    mps__step_begin_equation(q);
    MPS__TRY(mps__step_run(q, MPS_SOURCE));
    MPS__TRY(check_laws(q));
    spread_gain(q);
    end_stage(q, MPS_STAGE_OPERATORS);
    MPS__TRY(mps__ppe_assemble(&w->ppe, &q->stage, &q->terms));
    note_level(q);
    end_stage(q, MPS_STAGE_PPE_SETUP);
    MPS__TRY(solve(q, &result));
    mps__ppe_scatter(&w->ppe, &q->stage, &q->terms, w->particles.p);
    q->info.ppe_solves = w->bounds.solves;
    q->info.ppe_iterations = result.iterations;
    q->info.ppe_residual = result.residual;
    q->info.ppe_divergence = result.divergence;
    q->info.ppe_unknowns = w->ppe.n;
    end_stage(q, MPS_STAGE_PPE_SOLVE);
    q->info.seconds[MPS_STAGE_PPE_SOLVE] -= result.setup_seconds;
    q->info.seconds[MPS_STAGE_PPE_SETUP] += result.setup_seconds;
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
    MPS__TRY(mps__step_run(q, MPS_GRADIENT));
    mps__parallel_copy(threads, w->work.load, w->particles.p, n);
    MPS__TRY(mps__step_run(q, MPS_LOAD));
    mps_parallel_rows(threads, n, push_rows, q);
    mps__step_book_pressure(q);
    MPS__TRY(mps__step_run(q, MPS_VELOCITY));
    mps__step_book_collisions(q);
    mps__parallel_zero(threads, &motion, 1);
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
    for (int64_t i = 0; i < w->particles.n; i++)
        w->info.separated += w->particles.held[i] = q->terms.condition[i] == MPS__ROW_HELD;
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
    if (w->lists.aside > 0) mps__budget_book_added(w, &q->budget);
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
    return status;
}

static bool any_fluid(const mps__world *w)
{
    for (int64_t i = 0; i < w->particles.n; i++)
        if (w->particles.kind[i] == MPS_FLUID) return true;
    return false;
}

mps_status mps__world_step(mps__world *w, double dt_max)
{
    mps__step q = {.w = w, .clock = mps__clock()};
    if (!any_fluid(w))
        return mps__fail(w->context, MPS_E_STATE, "there is no fluid particle to step");
    w->host.motion = &w->motion;
    w->host.next = NULL;
    MPS__TRY(mps__plan_make(&w->host.plan, &w->models));
    mps__budget_update(
        w,
        &w->state
             .budget); /* what has come, changed or gone since the last step, whatever becomes of this one */
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
    if (planned > 0)
        w->state.dt_previous = planned; /* a step cut short says nothing about the next */
    end_stage(&q, MPS_STAGE_CORRECT);
    w->info.seconds[MPS_STAGE_CORRECT] = q.info.seconds[MPS_STAGE_CORRECT];
    return q.not_converged ? MPS_W_NOT_CONVERGED : MPS_OK;
}
