/* SPDX-License-Identifier: BSD-3-Clause */
/* Motion of the fluid in a step: prediction, correction, new positions; checks; final values.
 * Z14: Zhang, Wan & Hino 2014. */
#include "step.h"
#include "world_ranks.h"

static mps_status find_near_rows(mps_stage *s)
{
    mps__world *w = mps__step_of(s)->w;
    mps_neighbours *l = &w->lists.neighbours;
    mps__memory *t = &w->runner.memory;
    int64_t pairs = 0, *begin = mps__given_list(w, MPS__NEAR_BEGIN, l->near_begin);
    mps__neighbours_near(l, mps__seen_list(w, MPS__ROWS_BEGIN, l->begin),
                         mps__seen_list(w, MPS__ROWS_MIDDLE, l->middle), begin);
    if (mps__device_of(l->parallel))
        mps__runner_flush_with(&w->runner, begin + l->n, &pairs, sizeof pairs);
    else
        pairs = l->near_begin[l->n];
    MPS__TRY(mps__device_status(&t->device));
    MPS__TRY(mps__neighbours_near_fit(l, pairs));
    MPS__TRY(
        mps__memory_block(t, MPS__NEAR_COLUMNS, l->near_col, pairs, sizeof *l->near_col, false));
    return mps__memory_block(t, MPS__NEAR_WEIGHTS, l->w_r2, pairs, sizeof *l->w_r2, false);
}

const mps__pass mps__pass_neighbours = {.name = "neighbours",
                                        .hook = MPS_CLASSIFY,
                                        .stage = MPS_STAGE_NEIGHBOURS,
                                        .device = true,
                                        .run = find_near_rows};

/* ---- accelerations to velocities ---- */

typedef struct push_fields {
    const double *a;
    double *u;
} push_fields;

static mps_status clear_vectors(mps_stage *s)
{
    const mps__block vectors = {s->data[0], s->view->n * s->view->dim};
    mps__parallel_zero(&mps__step_of(s)->w->pool.parallel, &vectors, 1);
    return MPS_OK;
}

static const mps_use clear_uses[] = {{"acceleration", MPS_USE_WRITE | MPS__USE_BEGIN}};

const mps__pass mps__pass_clear_forces = {.name = "clear_forces",
                                          .hook = MPS_FORCE,
                                          .stage = MPS_STAGE_OPERATORS,
                                          .with_ghosts = true,
                                          .device = true,
                                          .use_count = 1,
                                          .uses = clear_uses,
                                          .run = clear_vectors};

const mps__pass mps__pass_clear_gradient = {.name = "clear_gradient",
                                            .hook = MPS_GRADIENT,
                                            .stage = MPS_STAGE_CORRECT,
                                            .with_ghosts = true,
                                            .device = true,
                                            .use_count = 1,
                                            .uses = clear_uses,
                                            .run = clear_vectors};

MPS_ROW void predict_row(const int dim, const mps_view *v, const push_fields *f, int64_t i)
{
    if (!mps_is_fluid(v, i)) return;
    for (int d = 0; d < dim; d++) f->u[i * dim + d] += v->dt * (f->a[i * dim + d] + v->g[d]);
}
MPS_ROWS(predict_rows, predict_row, push_fields)

/* u* = u + dt (a + g). Z14 (9). */
static mps_status predict(mps_stage *s)
{
    mps_stage_rows(s, &predict_rows, &(push_fields){s->data[0], s->data[1]});
    return MPS_OK;
}

static const mps_use push_uses[] = {{"acceleration", MPS_USE_READ}, {"velocity", MPS_USE_CHANGE}};

const mps__pass mps__pass_predict = {.name = "predict",
                                     .hook = MPS_FORCE,
                                     .place = MPS__AFTER_MODELS,
                                     .stage = MPS_STAGE_OPERATORS,
                                     .device = true,
                                     .use_count = 2,
                                     .uses = push_uses,
                                     .run = predict};

MPS_ROW void push_row(const int dim, const mps_view *v, const push_fields *f, int64_t i)
{
    for (int64_t k = i * dim; k < (i + 1) * dim; k++)
        f->u[k] += mps_is_fluid(v, i) ? v->dt * f->a[k] : 0;
}
MPS_ROWS(push_rows, push_row, push_fields)

/* u = u* + dt a(p) */
static mps_status push(mps_stage *s)
{
    mps_stage_rows(s, &push_rows, &(push_fields){s->data[0], s->data[1]});
    return MPS_OK;
}

const mps__pass mps__pass_push = {.name = "push",
                                  .hook = MPS_LOAD,
                                  .place = MPS__AFTER_MODELS,
                                  .stage = MPS_STAGE_CORRECT,
                                  .device = true,
                                  .use_count = 2,
                                  .uses = push_uses,
                                  .run = push};

/* ---- pressures on walls ---- */

static mps_status copy_pressures(mps_stage *s)
{
    mps__parallel_copy(&mps__step_of(s)->w->pool.parallel, s->data[1], s->data[0],
                       (size_t)s->view->n * sizeof(double));
    return MPS_OK;
}

static const mps_use load_uses[] = {{"pressure", MPS_USE_READ},
                                    {"wall_pressure", MPS_USE_WRITE | MPS__USE_BEGIN}};

const mps__pass mps__pass_first_loads = {.name = "first_loads",
                                         .hook = MPS_LOAD,
                                         .stage = MPS_STAGE_CORRECT,
                                         .with_ghosts = true,
                                         .device = true,
                                         .use_count = 2,
                                         .uses = load_uses,
                                         .run = copy_pressures};

/* ---- new positions ---- */

static const mps_use displacement_uses[] = {{"displacement", MPS_USE_WRITE | MPS__USE_BEGIN}};

const mps__pass mps__pass_clear_displacement = {.name = "clear_displacement",
                                                .hook = MPS_SHIFT,
                                                .stage = MPS_STAGE_CORRECT,
                                                .with_ghosts = true,
                                                .device = true,
                                                .use_count = 1,
                                                .uses = displacement_uses,
                                                .run = clear_vectors};

typedef struct move_fields {
    const double *dx, *u, *place;
    double *x, *before;
} move_fields;

MPS_ROW void move_row(const int dim, const mps_view *v, const move_fields *f, int64_t i)
{
    double *x = f->x + i * dim;
    for (int d = 0; d < dim; d++) f->before[i * dim + d] = x[d];
    if (mps_is_fluid(v, i))
        for (int d = 0; d < dim; d++) x[d] += v->dt * f->u[i * dim + d] + f->dx[i * dim + d];
    else
        mps__tank_point(dim, v->tank.centre, v->tank.next_shift, v->tank.next_rotation,
                        f->place + i * dim, x);
}
MPS_ROWS(move_rows, move_row, move_fields)

/* r = r + dt u + shift; solids move to the tank's next pose. */
static mps_status move(mps_stage *s)
{
    mps__step *q = mps__step_of(s);
    q->before = mps__channels_array(&q->w->channels, &q->w->particles, MPS__POSITION_BEFORE);
    mps_stage_rows(s, &move_rows,
                   &(move_fields){s->data[0], s->data[1], s->data[4], s->data[2], s->data[3]});
    return MPS_OK;
}

static const mps_use move_uses[] = {{"displacement", MPS_USE_READ},
                                    {"velocity", MPS_USE_READ},
                                    {"position", MPS_USE_CHANGE},
                                    {"position_before", MPS_USE_WRITE | MPS__USE_BEGIN},
                                    {"solid_place", MPS_USE_READ}};

const mps__pass mps__pass_move = {.name = "move",
                                  .hook = MPS_SHIFT,
                                  .place = MPS__AFTER_MODELS,
                                  .stage = MPS_STAGE_CORRECT,
                                  .with_ghosts = true,
                                  .device = true,
                                  .use_count = 5,
                                  .uses = move_uses,
                                  .run = move};

/* ---- checks, and final values ---- */

static mps_status check_result(mps__step *q)
{
    MPS__TRY(mps__runner_check_reactions(&q->w->runner, q->view.t));
    return mps__step_check_result(q, true);
}

/* On a device the result is known at the end of the step, unless displacements of the fluid are
 * checked, too. */
static mps_status check(mps_stage *s)
{
    mps__step *q = mps__step_of(s);
    mps__step_ask_result(q);
    if (mps__world_may_jump(q->w)) mps__runner_flush(&q->w->runner);
    if (mps__world_may_jump(q->w) || !mps__device_of(&q->w->pool.parallel))
        MPS__TRY(check_result(q));
    return mps__step_check_moves(q, s->data[3]);
}

static const mps_use check_uses[] = {{"velocity", MPS_USE_READ},
                                     {"pressure", MPS_USE_READ},
                                     {"position", MPS_USE_READ},
                                     {"position_before", MPS_USE_READ}};

const mps__pass mps__pass_check = {.name = "check",
                                   .hook = MPS_SHIFT,
                                   .place = MPS__AFTER_MODELS,
                                   .stage = MPS_STAGE_CORRECT,
                                   .device = true,
                                   .use_count = 4,
                                   .uses = check_uses,
                                   .run = check};

static mps_status exchange(mps_stage *s)
{
    return mps__world_exchange_step(mps__step_of(s)->w);
}

/* Halo exchange of changed fields, for leases and the next step. */
const mps__pass mps__pass_exchange = {.name = "exchange",
                                      .hook = MPS_SHIFT,
                                      .place = MPS__AFTER_MODELS,
                                      .stage = MPS_STAGE_CORRECT,
                                      .device = true,
                                      .undeclared = true,
                                      .run = exchange};

typedef struct keep_fields {
    const double *wall_pressure;
    const int32_t *condition, *region;
    double *load;
    uint8_t *active;
} keep_fields;

MPS_ROW void keep_row(const int dim, const mps_view *v, const keep_fields *f, int64_t i)
{
    (void)dim, (void)v;
    f->load[i] = f->wall_pressure[i];
    f->active[i] = f->condition[i] == MPS__ROW_ACTIVE;
}
MPS_ROWS(keep_rows, keep_row, keep_fields)

/* Sums: of 1 over the surface; over rows with an active lower bound. */
enum { SURFACE, SEPARATED, COUNTS };

MPS_ROW void count_row(const int dim, const mps_view *v, const keep_fields *f, int64_t i,
                       double *sums)
{
    (void)dim;
    sums[SURFACE] += mps_is_fluid(v, i) && f->region[i] == MPS_REGION_SURFACE;
    sums[SEPARATED] += f->condition[i] == MPS__ROW_ACTIVE;
}
MPS_SUMS(count_rows, count_row, keep_fields)

static void take_counts(void *step, const double *counts)
{
    mps__step *q = step;
    q->info.surface = (int64_t)counts[SURFACE];
    q->info.separated = (int64_t)counts[SEPARATED];
}

static void take_last(void *step, const double *sums)
{
    mps__step *q = step;
    mps__budget_take(q->w, sums, &q->next.budget.last);
}

/* Mean volume deviation of inner fluid; 0 if there is none. */
static void take_deviation(void *step, const double *sums)
{
    mps__budget *b = &((mps__step *)step)->next.budget;
    b->deviation = sums[1] > 0 ? sums[0] / sums[1] : 0;
    if (!b->started) b->deviation_start = b->deviation;
}

static mps_status keep(mps_stage *s)
{
    mps__step *q = mps__step_of(s);
    mps__world *w = q->w;
    const keep_fields f = {.wall_pressure = s->data[0],
                           .condition = s->data[1],
                           .region = s->data[2],
                           .load = mps__given(w, MPS__FIELD_WALL_PRESSURE),
                           .active = mps__given(w, MPS__FIELD_HELD)};
    const bool on_device = mps__device_of(&w->pool.parallel) != NULL;
    mps__runner_sum_deferred(&w->runner, s->view, COUNTS, &count_rows, &f,
                             (mps__then){take_counts, q});
    mps__budget_deviation(w, s->data[3], (mps__then){take_deviation, q});
    mps__budget_deferred(w, (mps__then){take_last, q});
    if (on_device && !w->work.bodies) mps__world_request_flags(w, &q->pose, &q->next_flags);
    mps__runner_flush(&w->runner);
    MPS__TRY(mps__device_status(&w->runner.memory.device));
    if (on_device) MPS__TRY(check_result(q));
    if (on_device) mps__step_crossing_end(s);
    mps_stage_rows(s, &keep_rows, &f);
    mps__step_keep_places(w, s->data[4], s->data[5]);
    mps__step_load_close(q);
    return MPS_OK;
}

static const mps_use keep_uses[] = {
    {"wall_pressure", MPS_USE_READ}, {"pressure_condition", MPS_USE_READ},
    {"region", MPS_USE_READ},        {"volume_deviation", MPS_USE_READ},
    {"solid_place", MPS_USE_READ},   {"solid_area", MPS_USE_READ}};

const mps__pass mps__pass_keep = {.name = "keep",
                                  .hook = MPS_SHIFT,
                                  .place = MPS__LAST_OF_STEP,
                                  .stage = MPS_STAGE_CORRECT,
                                  .undeclared = true,
                                  .with_ghosts = true,
                                  .device = true,
                                  .use_count = sizeof keep_uses / sizeof keep_uses[0],
                                  .uses = keep_uses,
                                  .run = keep};
