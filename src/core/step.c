/* SPDX-License-Identifier: BSD-3-Clause */
/* One time step, W22 section 2.5 and Fig. 2: predict, pressure equation, correct. The one file that knows the order. */
#include "budget.h"
#include "operators.h"
#include "plates.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Share of its way to that of the present step that the spread of pressures goes in a step. */
static const double SPREAD_SHARE = 0.2;

/* What one step carries along; committed to the world only when all went well. */
typedef struct step_state {
    mps__world *w;
    mps_stage stage;
    mps_stencil near, far;
    mps_ppe_terms terms;
    mps__pose pose; /* of the tank at the end of the step */
    mps_step_info info;
    mps__budget budget;
    double momentum[3]; /* of the prediction */
    mps__jump jump;
    double spread; /* time that a gain below 1 spreads pressures over [s] */
    double clock;  /* beginning of the present stage */
    bool not_converged;
    bool no_memory; /* a verb got no scratch */
    bool moved;     /* positions are new, the old ones kept */
} step_state;

/* ---- calling models -------------------------------------------------------------------------------------------- */

double *mps_stage_scratch(mps_stage *s, int64_t count)
{
    mps__world *w = ((step_state *)s->host)->w;
    mps__work *k = &w->work;
    if (k->scratch_used == MPS__SCRATCH || count < 0) {
        mps_stage_fail(s, "a verb may borrow at most %d blocks of scratch, of no negative size", MPS__SCRATCH);
        return NULL;
    }
    const int32_t b = k->scratch_used;
    double *block = mps__scratch_take(w->context, &w->scratch, b, count, sizeof *block);
    if (!block) {
        ((step_state *)s->host)->no_memory = true;
        return NULL;
    }
    mps__zero(block, count, w->threads);
    k->scratch_used++;
    return block;
}

int mps_stage_fail(mps_stage *s, const char *format, ...)
{
    char text[MPS__ERROR_SIZE];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    mps__fail(((step_state *)s->host)->w->context, MPS_E_PLUGIN, "%s", text);
    return 1;
}

static mps_status verb_failed(step_state *q, const mps__model *m)
{
    char *error = q->w->context->error;
    const mps_status status = q->no_memory ? MPS_E_NOMEM : MPS_E_PLUGIN;
    if (!error[0]) return mps__fail(q->w->context, status, "model \"%s\" failed at t = %.9g s", m->ops->name, q->stage.t);
    return mps__fail(q->w->context, status, "model \"%s\" at t = %.9g s: %.300s", m->ops->name, q->stage.t, error);
}

/* Call one verb of a model that has it. */
#define CALL_VERB(q, model, verb, ...)                                                  \
    do {                                                                                \
        (q)->w->context->error[0] = 0;                                                  \
        const int failed_ = (model)->ops->verb((model)->self, (model)->k, __VA_ARGS__); \
        (q)->w->work.scratch_used = 0;                                                  \
        if (failed_) return verb_failed((q), (model));                                  \
    } while (0)

/* Call one verb of all active models in their order. */
#define EACH_MODEL(q, verb, ...)                                          \
    for (int32_t m_ = 0; m_ < (q)->w->models.active; m_++) {              \
        const mps__model *model_ = &(q)->w->models.on[m_];                \
        if (model_->ops->verb) CALL_VERB((q), model_, verb, __VA_ARGS__); \
    }

/* Copy, to undo a failed step from. */
static void keep(double *kept, const double *values, int64_t count, int threads)
{
    (void)threads; /* unused without OpenMP */
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int64_t k = 0; k < count; k++) kept[k] = values[k];
}

/* ---- the stages -------------------------------------------------------------------------------------------------- */

static void end_stage(step_state *q, int stage)
{
    const double now = mps__clock();
    q->info.seconds[stage] += now - q->clock;
    q->clock = now;
}

/* Velocity of a point of the tank over the last step; before the first: what the start convention says. */
static void tank_velocity(const mps__world *w, const double *X, double *u)
{
    double from[3], to[3];
    if (w->dt_before > 0) {
        mps__motion_point(&w->motion, &w->before, X, from, NULL, NULL);
        mps__motion_point(&w->motion, &w->motion.now, X, to, NULL, NULL);
        for (int d = 0; d < w->dim; d++) u[d] = (to[d] - from[d]) / w->dt_before;
    } else if (w->motion.start == MPS_START_WITH_TANK) {
        mps__motion_point(&w->motion, &w->motion.now, X, NULL, u, NULL);
    } else {
        for (int d = 0; d < w->dim; d++) u[d] = 0;
    }
}

/* Whether the tank has the same place in both poses. */
static bool same_place(const mps__pose *a, const mps__pose *b)
{
    bool same = true;
    for (int k = 0; k < MPS_DOF_COUNT; k++) same = same && a->state.value[k] == b->state.value[k];
    for (int k = 0; k < 9; k++) same = same && a->rotation[k] == b->rotation[k];
    return same;
}

/* Whether the tank neither moves in this step nor was moving before it. */
static bool at_rest(const step_state *q)
{
    const mps__world *w = q->w;
    const bool was = w->dt_before > 0 ? same_place(&w->before, &w->motion.now) : w->motion.start != MPS_START_WITH_TANK;
    return was && same_place(&w->motion.now, &q->pose);
}

/* A velocity that changes within a step by more than twice as much as in the last one, and than by 2 g, jumps. Velocities are means over a step, so
 * half a step lies on either side of the change: over dt alone a steady acceleration would jump where a step is cut short. */
static void note_jump(step_state *q)
{
    const mps__world *w = q->w;
    double most = 0;
    for (int64_t i = 0; i < q->stage.n; i++) {
        const double *a = w->work.tank_accel + i * w->dim;
        if (w->particles.kind[i] != MPS_FLUID) most = fmax(most, mps__dot(a, a, w->dim));
    }
    const double dt = q->stage.dt, change = w->dt_before > 0 ? 2 * dt / (dt + w->dt_before) : 1;
    q->jump = (mps__jump){change * sqrt(most), w->jump.since < INT32_MAX ? w->jump.since + 1 : INT32_MAX};
    if (q->jump.accel > 2 * w->velocity_scale * w->velocity_scale / w->dp && q->jump.accel > 2 * w->jump.accel) q->jump.since = 0;
    q->stage.since_jump = q->jump.since;
}

/* Solids get the velocity that carries them to their next place; every particle the acceleration a rigid tank has there. */
static void move_walls(step_state *q)
{
    mps__world *w = q->w;
    mps__particles *s = &w->particles;
    const int dim = w->dim;
    const bool rest = at_rest(q);
#pragma omp parallel for num_threads(w->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        double X[3], here[3], next[3], old[3];
        for (int d = 0; d < dim && rest; d++) {
            w->work.tank_accel[i * dim + d] = 0;
            if (s->kind[i] != MPS_FLUID) s->u[i * dim + d] = 0;
        }
        if (rest) continue;
        if (s->kind[i] == MPS_FLUID)
            mps__motion_to_tank(&w->motion, &w->motion.now, s->x + i * dim, X);
        else
            memcpy(X, s->ref + i * dim, (size_t)dim * sizeof *X);
        mps__motion_point(&w->motion, &w->motion.now, X, here, NULL, NULL);
        mps__motion_point(&w->motion, &q->pose, X, next, NULL, NULL);
        tank_velocity(w, X, old);
        for (int d = 0; d < dim; d++) {
            const double u = (next[d] - here[d]) / q->stage.dt;
            w->work.tank_accel[i * dim + d] = (u - old[d]) / q->stage.dt;
            if (s->kind[i] != MPS_FLUID) s->u[i * dim + d] = u;
        }
    }
}

/* Area vectors turn with the tank. */
static mps_status turn_areas(mps__world *w)
{
    const mps__particles *s = &w->particles;
    mps__work *k = &w->work;
    k->area = s->area;
    if (!mps__motion_turned(&w->motion.now)) return MPS_OK;
    MPS__TRY(mps__grow(w->context, (void **)&k->turned, &k->turned_capacity, 0, s->n * w->dim, sizeof *k->turned));
#pragma omp parallel for num_threads(w->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) mps__motion_rotate(&w->motion, &w->motion.now, s->area + i * w->dim, k->turned + i * w->dim);
    k->area = k->turned;
    return MPS_OK;
}

static void set_stage(step_state *q)
{
    mps__world *w = q->w;
    mps__particles *s = &w->particles;
    mps__work *k = &w->work;
    q->stage = (mps_stage){.struct_size = sizeof q->stage,
                           .dim = w->dim,
                           .threads = w->threads,
                           .n = s->n,
                           .step = w->info.step + 1,
                           .t = w->info.t,
                           .dt = q->stage.dt,
                           .dp = w->dp,
                           .velocity_scale = w->velocity_scale,
                           .g = {w->g[0], w->g[1], w->g[2]},
                           .kind = s->kind,
                           .phase = s->phase,
                           .id = s->id,
                           .x = s->x,
                           .u = s->u,
                           .p = s->p,
                           .density = s->rho,
                           .viscosity = w->phase_viscosity,
                           .tank_accel = k->tank_accel,
                           .area = k->area,
                           .wall_of = s->wall_of,
                           .number_density = s->nd,
                           .volume = k->volume,
                           .asymmetry = k->asymmetry,
                           .region = s->region,
                           .wet = k->wet,
                           .correction = k->correction,
                           .near = &q->near,
                           .far = &q->far,
                           .host = q,
                           .density_smooth = k->density_smooth,
                           .tension = w->tension,
                           .capillary = k->capillary,
                           .depth = k->depth};
    for (int p = 0; p < MPS__PHASES; p++) q->stage.phases += w->phase_defined[p];
    q->terms = (mps_ppe_terms){.struct_size = sizeof q->terms,
                               .radius = MPS_FAR,
                               .rhs = k->rhs,
                               .shift = k->shift,
                               .value = k->value,
                               .fixed = k->fixed,
                               .body = k->body,
                               .gain = 1.0,
                               .gas = k->gas,
                               .law = k->law};
}

/* Weights of the near pairs, and their rows without gaps; where the radii are equal the far rows are the same. */
static void weigh_pairs(step_state *q)
{
    const mps_neighbours *l = &q->w->neighbours;
    mps__op_weigh(&q->near, &(mps__weighed){.begin = l->near_begin,
                                            .col = l->near_col,
                                            .w_r2 = l->w_r2,
                                            .idle = l->idle,
                                            .n = q->stage.number_density,
                                            .a = q->w->work.asymmetry});
    q->near.begin = l->near_begin;
    q->near.end = l->near_begin + 1;
    q->near.col = l->near_col;
    if (q->near.re == q->far.re) q->far = q->near;
    q->near.w_r2 = l->w_r2;
}

/* A stranger's model may leave anything in the regions, and everything after counts on them. */
static mps_status check_regions(const step_state *q, const mps__model *model)
{
    const mps_stage *s = &q->stage;
    int64_t first = s->n;
#pragma omp parallel for num_threads(s->threads) reduction(min : first) schedule(static)
    for (int64_t i = 0; i < s->n; i++)
        if (s->region[i] < MPS_REGION_INNER || s->region[i] > MPS_REGION_DRY) first = i < first ? i : first;
    if (first == s->n) return MPS_OK;
    const double *x = s->x + first * s->dim;
    return mps__fail(q->w->context, MPS_E_PLUGIN,
                     "model \"%s\" at t = %.9g s: its classify left region %d at particle %lld, (%g, %g, %g) m; must be %d..%d",
                     model->ops->name, s->t, (int)s->region[first], (long long)s->id[first], x[0], x[1], s->dim == 3 ? x[2] : 0,
                     MPS_REGION_INNER, MPS_REGION_DRY);
}

static mps_status classify(step_state *q)
{
    const mps__models *models = &q->w->models;
    for (int32_t m = 0; m < models->active; m++) {
        const mps__model *model = &models->on[m];
        if (!model->ops->classify) continue;
        CALL_VERB(q, model, classify, &q->stage);
        if (mps__models_foreign(models, model)) MPS__TRY(check_regions(q, model));
    }
    return MPS_OK;
}

/* Number density, asymmetry, regions at r^k. */
static mps_status look_around(step_state *q)
{
    mps__world *w = q->w;
    mps_stage *s = &q->stage;
    MPS__TRY(mps__neighbours_near(&w->neighbours));
    end_stage(q, MPS_STAGE_NEIGHBOURS);
    move_walls(q);
    note_jump(q);
    weigh_pairs(q);
    MPS__TRY(mps_op_volume_deviation(&q->far, w->work.volume));
    const int dim = s->dim;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        s->region[i] = s->kind[i] == MPS_DUMMY ? MPS_REGION_DRY : MPS_REGION_INNER;
        s->wet[i] = 1.0;
        s->density_smooth[i] = s->density[i];
        s->capillary[i] = s->depth[i] = 0;
        for (int d = 0; d < dim * dim; d++) s->correction[i * dim * dim + d] = d % (dim + 1) == 0;
    }
    MPS__TRY(classify(q));
    int64_t surface = 0;
#pragma omp parallel for num_threads(s->threads) reduction(+ : surface) schedule(static)
    for (int64_t i = 0; i < s->n; i++) surface += s->kind[i] == MPS_FLUID && s->region[i] == MPS_REGION_SURFACE;
    q->info.surface = surface;
    return MPS_OK;
}

/* What force models and gravity are about to do. */
static void note_forces(step_state *q)
{
    const mps_stage *s = &q->stage;
    mps_momentum *m = &q->budget.momentum;
    mps__push push;
    mps__budget_push(q->w, q->w->work.a, s->dt, &push);
    q->budget.viscous -= push.energy;
    for (int d = 0; d < s->dim; d++) {
        const double weight = push.mass * s->dt * s->g[d];
        m->force[d] += push.impulse[d];
        m->gravity[d] += weight;
        q->momentum[d] = push.momentum[d] + push.impulse[d] + weight;
    }
}

/* What the new pressures have done; `bulk` takes the state they left. */
static void note_pressure(step_state *q, mps__bulk *bulk)
{
    mps__world *w = q->w;
    mps_momentum *m = &q->budget.momentum;
    double force[3];
    q->budget.wall_work += mps__budget_wall_work(w, &q->pose, w->work.a, q->stage.dt);
    mps__budget_sum(w, bulk);
    mps__budget_wall_force(w, w->work.load, force);
    for (int d = 0; d < w->dim; d++) {
        m->pressure[d] += bulk->momentum[d] - q->momentum[d];
        m->walls[d] += q->stage.dt * force[d];
    }
}

/* u* = u + dt (a + g). Z14 (9). The power of a is what force models dissipate. */
static mps_status predict(step_state *q)
{
    mps_stage *s = &q->stage;
    mps__work *k = &q->w->work;
    mps__zero(k->a, s->n * s->dim, s->threads);
    EACH_MODEL(q, force, s, k->a);
    note_forces(q);
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++)
        if (s->kind[i] == MPS_FLUID)
            for (int d = 0; d < s->dim; d++) s->u[i * s->dim + d] += s->dt * (k->a[i * s->dim + d] + s->g[d]);
    return MPS_OK;
}

static mps_status check_result(step_state *q);

/* Call the source verbs; a gas law asks for a solver of nonlinear rows. */
static mps_status collect_sources(step_state *q)
{
    const mps__world *w = q->w;
    for (int32_t m = 0; m < w->models.active; m++) {
        const mps__model *model = &w->models.on[m];
        if (!model->ops->source) continue;
        CALL_VERB(q, model, source, &q->stage, &q->terms);
        for (int64_t i = 0; i < q->stage.n && !w->solvers.use->nonlinear; i++)
            if (q->terms.law[i] > 0)
                return mps__fail(w->context, MPS_E_STATE,
                                 "model \"%s\" makes the pressure equation nonlinear, and solver '%s' is for linear ones: choose "
                                 "'sundials.kinsol'",
                                 model->ops->name, w->solvers.use->name);
    }
    return MPS_OK;
}

/* A gain g below 1 leaves (1 - g) dt/g =: T of a steady demand to later steps. In a shorter step g would ask for what longer ones left at
 * once: pressures would jump by (1 - g)(dt_before/dt - 1). With g = dt/(dt + T) they do not feel dt; T follows the steps slowly. */
static void spread_gain(step_state *q)
{
    const double dt = q->stage.dt, gain = q->terms.gain, wanted = dt * (1 - gain) / gain;
    q->spread = q->w->spread > 0 ? q->w->spread + SPREAD_SHARE * (wanted - q->w->spread) : wanted;
    q->terms.gain = dt / (dt + q->spread);
}

static void note_level(step_state *q)
{
    mps__world *w = q->w;
    q->stage.level_free = w->ppe.level_free;
    if (!w->ppe.level_free || w->level_told) return;
    w->level_told = true;
    mps__log(w->context, MPS_LOG_INFO,
             "t = %.9g s: no surface, fixed pressure or compressible phase gives the pressures a level; their mean is zero", q->stage.t);
}

/* <lap p> = source. W22 (10). */
static mps_status project(step_state *q)
{
    mps__world *w = q->w;
    mps_stage *s = &q->stage;
    mps__zero(q->terms.rhs, s->n, s->threads);
    mps__zero(q->terms.shift, s->n, s->threads);
    mps__zero(q->terms.value, s->n, s->threads);
    mps__zero(q->terms.body, s->n * s->dim, s->threads);
    mps__zero(q->terms.gas, s->n, s->threads);
    mps__zero(q->terms.law, s->n, s->threads);
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) q->terms.fixed[i] = s->region[i] == MPS_REGION_SURFACE ? MPS_ROW_FIXED : MPS_ROW_FREE;
    MPS__TRY(collect_sources(q));
    spread_gain(q);
    end_stage(q, MPS_STAGE_OPERATORS);
    MPS__TRY(mps__ppe_assemble(&w->ppe, s, &q->terms));
    note_level(q);
    end_stage(q, MPS_STAGE_PPE_SETUP);
    mps_ppe_result result = {0};
    w->bounds.held = w->particles.held;
    w->bounds.solves = 0;
    if (w->ppe.n > 0) {
        mps_status status = mps__bounds_solve(&w->bounds, &w->solvers, &w->ppe, s, &q->terms, &result);
        if (status == MPS_E_SOLVER) MPS__TRY(check_result(q)); /* a NaN of the prediction has a particle and a place */
        if (status < 0) return mps__fail(w->context, status, "t = %.9g s: %.400s", s->t, w->context->error);
        q->not_converged = status == MPS_W_NOT_CONVERGED;
        if (q->not_converged) mps__log(w->context, MPS_LOG_WARNING, "t = %.9g s: %.400s", s->t, w->context->error);
    }
    mps__ppe_scatter(&w->ppe, s, &q->terms, s->p);
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

/* Drops that plates stop have collided with them. */
static void stop_at_plates(step_state *q)
{
    mps__world *w = q->w;
    mps__bulk moved, stopped;
    if (w->screens.count == 0) return;
    mps__budget_sum(w, &moved);
    mps__plates_stop(w, &q->pose);
    mps__budget_sum(w, &stopped);
    q->budget.collision += (moved.kinetic - stopped.kinetic) + (moved.potential - stopped.potential);
    for (int d = 0; d < w->dim; d++) q->budget.momentum.collision[d] += stopped.momentum[d] - moved.momentum[d];
}

/* u = u* + dt a(p), collisions, r = r + dt u + shift. Z14 (12)(13). */
static mps_status correct(step_state *q)
{
    mps__world *w = q->w;
    mps_stage *s = &q->stage;
    mps__work *k = &w->work;
    mps__zero(k->a, s->n * s->dim, s->threads);
    EACH_MODEL(q, gradient, s, k->a);
    s->wall_pressure = k->load;
    keep(s->wall_pressure, s->p, s->n, s->threads);
    EACH_MODEL(q, load, s, k->a);
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++)
        for (int64_t a = i * s->dim; a < (i + 1) * s->dim; a++) s->u[a] += s->kind[i] == MPS_FLUID ? s->dt * k->a[a] : 0;
    mps__bulk pushed, collided, shifted;
    note_pressure(q, &pushed);
    EACH_MODEL(q, velocity, s);
    mps__budget_sum(w, &collided);
    q->budget.collision += pushed.kinetic - collided.kinetic;
    double *const dx = k->a; /* the accelerations are done with */
    mps__zero(dx, s->n * s->dim, s->threads);
    EACH_MODEL(q, shift, s, dx);
    mps__budget_sum(w, &shifted);
    q->budget.shift += collided.kinetic - shifted.kinetic + mps__budget_lift(w, dx);
    for (int d = 0; d < s->dim; d++) {
        q->budget.momentum.collision[d] += collided.momentum[d] - pushed.momentum[d];
        q->budget.momentum.shift[d] += shifted.momentum[d] - collided.momentum[d];
    }
    keep(k->x0, s->x, s->n * s->dim, s->threads);
    q->moved = true;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        double *x = w->particles.x + i * s->dim;
        if (s->kind[i] == MPS_FLUID)
            for (int d = 0; d < s->dim; d++) x[d] += s->dt * s->u[i * s->dim + d] + dx[i * s->dim + d];
        else
            mps__motion_point(&w->motion, &q->pose, w->particles.ref + i * s->dim, x, NULL, NULL);
    }
    stop_at_plates(q);
    return MPS_OK;
}

/* NaN and speeds beyond every physical range stop the run, with the particle and its place. */
static mps_status check_result(step_state *q)
{
    const mps__world *w = q->w;
    const mps_stage *s = &q->stage;
    double most = 0, liquid = 0, dense = 0;
    int64_t worst = s->n;
    for (int k = 0; k < MPS__PHASES; k++)
        if (w->phase_defined[k]) dense = fmax(dense, 0.5 * w->phase_density[k]);
#pragma omp parallel for num_threads(s->threads) reduction(max : most, liquid) reduction(min : worst) schedule(static)
    for (int64_t i = 0; i < s->n; i++) {
        const double *u = s->u + i * s->dim, *x = s->x + i * s->dim;
        const double speed = sqrt(mps__dot(u, u, s->dim));
        if (!(isfinite(speed) && speed <= w->speed_limit && mps__finite(x, s->dim) && isfinite(s->p[i])))
            worst = i < worst ? i : worst;
        else if (s->kind[i] == MPS_FLUID) {
            most = speed > most ? speed : most;
            if (s->density[i] >= dense) liquid = speed > liquid ? speed : liquid;
        }
    }
    q->info.crossing_time = mps__crossing_time(w, liquid, s->dt);
    q->info.max_speed = most;
    q->info.cfl = most * s->dt / s->dp;
    if (worst == s->n) return MPS_OK;
    const double *u = s->u + worst * s->dim, *x = (q->moved ? w->work.x0 : s->x) + worst * s->dim;
    return mps__fail(
        w->context, MPS_E_DIVERGED,
        "t = %.9g s: particle %lld at (%g, %g, %g) m got velocity (%g, %g, %g) m/s and pressure %g Pa; allowed: finite, at most %g m/s",
        s->t, (long long)s->id[worst], x[0], x[1], s->dim == 3 ? x[2] : 0, u[0], u[1], s->dim == 3 ? u[2] : 0, s->p[worst], w->speed_limit);
}

static void restore_state(const step_state *q)
{
    const mps__world *w = q->w;
    const size_t n = (size_t)w->particles.n, dim = (size_t)w->dim;
    memcpy(w->particles.u, w->work.u0, n * dim * sizeof(double));
    memcpy(w->particles.p, w->work.p0, n * sizeof(double));
    if (q->moved) memcpy(w->particles.x, w->work.x0, n * dim * sizeof(double));
}

static mps_status run_stages(step_state *q)
{
    MPS__TRY(look_around(q));
    MPS__TRY(predict(q));
    MPS__TRY(project(q));
    MPS__TRY(correct(q));
    MPS__TRY(check_result(q));
    return mps__world_check_moves(q->w, &q->pose, q->stage.dt);
}

static void commit(step_state *q)
{
    mps__world *w = q->w;
    q->info.struct_size = sizeof q->info;
    q->info.step = w->info.step + 1;
    q->info.dt = q->stage.dt;
    q->info.t = q->pose.t;
    q->info.lost = w->info.lost;
    w->info = q->info;
    w->before = w->motion.now;
    w->dt_before = q->stage.dt;
    w->motion.now = q->pose;
    keep(w->particles.load, w->work.load, w->particles.n, w->threads);
    w->info.separated = 0;
    for (int64_t i = 0; i < w->particles.n; i++) w->info.separated += w->particles.held[i] = q->terms.fixed[i] == MPS__ROW_HELD;
    w->jump = q->jump;
    w->spread = q->spread;
    w->budget = q->budget;
    mps__budget_sum(w, &w->budget.last);
    w->budget.deviation = mps__budget_mean_deviation(w);
    if (!w->budget.started) {
        w->budget.started = true;
        w->budget.deviation_start = w->budget.deviation;
    }
}

/* The liquid starts with the tank's velocity, or everything from rest. */
static void start(mps__world *w, mps__budget *budget)
{
    mps__particles *s = &w->particles;
    if (!w->start_pending) return;
    w->start_pending = 0;
    for (int64_t i = 0; i < s->n; i++) {
        double X[3];
        mps__motion_to_tank(&w->motion, &w->motion.now, s->x + i * w->dim, X);
        mps__motion_point(&w->motion, &w->motion.now, X, NULL, s->u + i * w->dim, NULL);
    }
    mps__budget_book_added(w, budget);
}

/* All that may fail after the state is kept. */
static mps_status try_step(step_state *q, double dt_max, double *planned)
{
    mps__world *w = q->w;
    q->budget = w->budget;
    if (w->aside > 0) mps__budget_book_added(w, &q->budget);
    start(w, &q->budget);
    MPS__TRY(turn_areas(w));
    set_stage(q);
    MPS__TRY(mps__world_stencil(w, MPS_NEAR, &q->near));
    MPS__TRY(mps__world_stencil(w, MPS_FAR, &q->far));
    MPS__TRY(mps__world_limit_step(w, &q->stage, dt_max, planned));
    MPS__TRY(mps__motion_pose(&w->motion, w->info.t + q->stage.dt, &q->pose));
    return run_stages(q);
}

static bool any_fluid(const mps__world *w)
{
    for (int64_t i = 0; i < w->particles.n; i++)
        if (w->particles.kind[i] == MPS_FLUID) return true;
    return false;
}

mps_status mps__world_step(mps__world *w, double dt_max)
{
    step_state q = {.w = w, .clock = mps__clock()};
    if (!any_fluid(w)) return mps__fail(w->context, MPS_E_STATE, "there is no fluid particle to step");
    mps__budget_update(w, &w->budget); /* what has come, changed or gone since the last step, whatever becomes of this one */
    MPS__TRY(mps__world_neighbours(w));
    keep(w->work.u0, w->particles.u, w->particles.n * w->dim, w->threads);
    keep(w->work.p0, w->particles.p, w->particles.n, w->threads);
    const int32_t start_pending = w->start_pending;
    double planned = 0;
    const mps_status status = try_step(&q, dt_max, &planned);
    if (status < 0) {
        restore_state(&q);
        mps__world_take_back(w);
        w->start_pending = start_pending;
        return status;
    }
    if (w->info.step == 0) mps__world_note_phases(w);
    commit(&q);
    if (planned > 0) w->dt_previous = planned; /* a step cut short says nothing about the next */
    end_stage(&q, MPS_STAGE_CORRECT);
    w->info.seconds[MPS_STAGE_CORRECT] = q.info.seconds[MPS_STAGE_CORRECT];
    return q.not_converged ? MPS_W_NOT_CONVERGED : MPS_OK;
}
