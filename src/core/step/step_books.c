/* SPDX-License-Identifier: BSD-3-Clause */
/* The budget of a step: contributions of its parts to energy and momentum. Only the plates, which
 * stop droplets, change the flow here. */
#include "plates.h"
#include "step.h"
#include <string.h>

/* Whether verbs run at a hook; without, nothing changes. */
static bool acts(const mps__step *q, int32_t hook)
{
    const mps__plan *p = &q->w->runner.plan;
    bool any = false;
    for (int32_t k = p->begin[hook]; k < p->begin[hook + 1]; k++) any = any || p->call[k].model;
    return any;
}

mps_status mps__step_book_between(mps__world *w)
{
    mps__budget budget = w->state.budget;
    MPS__TRY(mps__budget_update(w, &budget));
    const double energy = budget.last.kinetic + budget.last.potential;
    if (!isfinite(energy))
        return mps__fail(w->context, MPS_E_DIVERGED,
                         "t = %.9g s: the energy of the fluid is %g J before the step; velocities "
                         "must be at most %g m/s",
                         w->state.t, energy, w->setup.speed_limit);
    w->state.budget = budget;
    return MPS_OK;
}

/* State at a hook: the kinetic energy, or the effect of the accelerations so far. */
static mps__push so_far(const mps__step *q)
{
    mps__push push = {0};
    mps__bulk bulk;
    if (q->stage.hook == MPS_FORCE) {
        mps__memory *t = &q->w->runner.memory;
        const double *a = mps__memory_array(t, MPS__ACCELERATION, t->space);
        mps__budget_push(q->w, a, q->view.dt, &push);
        return push;
    }
    mps__budget_sum_flow(q->w, &bulk);
    push.energy = bulk.kinetic;
    memcpy(push.impulse, bulk.momentum, sizeof bulk.momentum);
    return push;
}

void mps__step_book_line(mps__step *q, bool after)
{
    const bool force = q->stage.hook == MPS_FORCE;
    mps__budget *b = &q->next.budget;
    mps_momentum *m = &b->momentum;
    const bool friction = q->line == MPS__LINE_FRICTION;
    if (!force && q->stage.hook != MPS_VELOCITY) return;
    mps__memory *t = &q->w->runner.memory;
    mps__memory_set_space(t, MPS__ON_DEVICE);
    if (force) mps__memory_sync(t, MPS__ACCELERATION, t->space);
    const mps__push now = so_far(q);
    mps__memory_set_space(t, MPS__ON_HOST);
    if (!after) {
        q->before_line = now;
        return;
    }
    /* the hook's line includes all of its verbs: move this part to the other line */
    const double gained = now.energy - q->before_line.energy;
    *(friction ? &b->friction : &b->plugins) -= gained;
    *(force ? &b->viscous : &b->collision) += gained;
    for (int d = 0; d < q->view.dim; d++) {
        const double impulse = now.impulse[d] - q->before_line.impulse[d];
        *(friction ? &m->friction[d] : &m->plugins[d]) += impulse;
        *(force ? &m->force[d] : &m->collision[d]) -= impulse;
    }
}

/* The velocities are those of the last entry: no verb changes them before. */
static void add_forces(void *step, const double *sums)
{
    mps__step *q = step;
    const mps_view *s = &q->view;
    mps_momentum *m = &q->next.budget.momentum;
    mps__push push;
    mps__budget_take_push(q->w, sums, &push);
    q->next.budget.viscous -= push.energy;
    for (int d = 0; d < s->dim; d++) {
        const double weight = push.mass * s->dt * s->g[d];
        m->force[d] += push.impulse[d];
        m->gravity[d] += weight;
        q->momentum[d] = q->next.budget.last.momentum[d] + push.impulse[d] + weight;
    }
}

static mps_status book_forces(mps_stage *s)
{
    mps__step *q = mps__step_of(s);
    mps__budget_push_deferred(q->w, s->data[0], q->view.dt, (mps__then){add_forces, q});
    return MPS_OK;
}

static const mps_use book_forces_uses[] = {
    {"acceleration", MPS_USE_READ}, {"velocity", MPS_USE_READ}, {"density", MPS_USE_READ}};

const mps__pass mps__pass_book_forces = {.name = "book_forces",
                                         .hook = MPS_FORCE,
                                         .place = MPS__AFTER_MODELS,
                                         .stage = MPS_STAGE_OPERATORS,
                                         .device = true,
                                         .use_count = 3,
                                         .uses = book_forces_uses,
                                         .run = book_forces};

static void add_wall_work(void *step, const double *sums)
{
    mps__step *q = step;
    q->next.budget.wall_work_momentum += q->body_work + sums[0];
}

static void add_wall_force(void *step, const double *sums)
{
    mps__step *q = step;
    const int32_t dim = q->view.dim;
    q->next.budget.wall_work_probes += q->body_work + sums[dim];
    for (int d = 0; d < dim; d++) q->next.budget.momentum.walls[d] += q->view.dt * sums[d];
}

static void add_pressure(void *step, const double *sums)
{
    mps__step *q = step;
    mps__budget_take_flow(q->w, sums, &q->bulk);
    for (int d = 0; d < q->view.dim; d++)
        q->next.budget.momentum.pressure[d] += q->bulk.momentum[d] - q->momentum[d];
}

static mps_status book_pressure(mps_stage *s)
{
    mps__step *q = mps__step_of(s);
    mps__world *w = q->w;
    const double dt = q->view.dt;
    q->body_work = mps__budget_body_work(w, s->data[1], s->data[4]);
    mps__budget_wall_work(w, &q->pose, s->data[0], dt, (mps__then){add_wall_work, q});
    mps__budget_wall_force(w, &q->pose, s->data[1], dt, (mps__then){add_wall_force, q});
    mps__budget_flow_deferred(w, (mps__then){add_pressure, q});
    return MPS_OK;
}

static const mps_use book_pressure_uses[] = {{"acceleration", MPS_USE_READ},
                                             {"wall_pressure", MPS_USE_READ},
                                             {"velocity", MPS_USE_READ},
                                             {"density", MPS_USE_READ},
                                             {"solid_place", MPS_USE_READ}};

const mps__pass mps__pass_book_pressure = {.name = "book_pressure",
                                           .hook = MPS_LOAD,
                                           .place = MPS__AFTER_MODELS,
                                           .stage = MPS_STAGE_CORRECT,
                                           .device = true,
                                           .use_count = 5,
                                           .uses = book_pressure_uses,
                                           .run = book_pressure};

static void add_collisions(void *step, const double *sums)
{
    mps__step *q = step;
    mps__bulk after;
    mps__budget_take_flow(q->w, sums, &after);
    q->next.budget.collision += q->bulk.kinetic - after.kinetic;
    for (int d = 0; d < q->w->setup.dim; d++)
        q->next.budget.momentum.collision[d] += after.momentum[d] - q->bulk.momentum[d];
    q->bulk = after;
}

static mps_status book_collisions(mps_stage *s)
{
    mps__step *q = mps__step_of(s);
    if (acts(q, MPS_VELOCITY)) mps__budget_flow_deferred(q->w, (mps__then){add_collisions, q});
    return MPS_OK;
}

static const mps_use book_collisions_uses[] = {{"velocity", MPS_USE_READ},
                                               {"density", MPS_USE_READ}};

const mps__pass mps__pass_book_collisions = {.name = "book_collisions",
                                             .hook = MPS_VELOCITY,
                                             .place = MPS__AFTER_MODELS,
                                             .stage = MPS_STAGE_CORRECT,
                                             .device = true,
                                             .use_count = 2,
                                             .uses = book_collisions_uses,
                                             .run = book_collisions};

static void take_lift(void *step, const double *sums)
{
    mps__step *q = step;
    q->lift = sums[0];
}

static void add_shift(void *step, const double *sums)
{
    mps__step *q = step;
    mps__bulk after;
    mps__budget_take_flow(q->w, sums, &after);
    q->next.budget.shift += q->bulk.kinetic - after.kinetic + q->lift;
    for (int d = 0; d < q->w->setup.dim; d++)
        q->next.budget.momentum.shift[d] += after.momentum[d] - q->bulk.momentum[d];
}

static mps_status book_shift(mps_stage *s)
{
    mps__step *q = mps__step_of(s);
    if (!acts(q, MPS_SHIFT)) return MPS_OK;
    mps__budget_lift(q->w, s->data[0], (mps__then){take_lift, q});
    mps__budget_flow_deferred(q->w, (mps__then){add_shift, q});
    return MPS_OK;
}

static const mps_use book_shift_uses[] = {
    {"displacement", MPS_USE_READ}, {"velocity", MPS_USE_READ}, {"density", MPS_USE_READ}};

const mps__pass mps__pass_book_shift = {.name = "book_shift",
                                        .hook = MPS_SHIFT,
                                        .place = MPS__AFTER_MODELS,
                                        .stage = MPS_STAGE_CORRECT,
                                        .device = true,
                                        .use_count = 3,
                                        .uses = book_shift_uses,
                                        .run = book_shift};

/* Plates process particles sequentially, on the host. */
static void stop_drops(mps_stage *s, mps__world *w)
{
    static const int32_t changed[] = {MPS__POSITION, MPS__VELOCITY};
    mps__memory *t = &w->runner.memory;
    const bool on_device = t->space == MPS__ON_DEVICE;
    const mps_view *view = on_device ? mps__runner_begin_serial(s) : NULL;
    for (int k = 0; k < 2; k++) mps__memory_sync(t, changed[k], MPS__ON_HOST);
    mps__plates_stop(w, &mps__step_of(s)->pose);
    for (int k = 0; k < 2; k++) mps__memory_written(t, changed[k], MPS__ON_HOST);
    if (on_device) mps__runner_end_serial(s, view);
    for (int k = 0; k < 2; k++) mps__memory_sync(t, changed[k], t->space);
}

static mps_status stop_at_plates(mps_stage *s)
{
    mps__step *q = mps__step_of(s);
    mps__world *w = q->w;
    mps__bulk moved, stopped;
    if (w->lists.occluders.count == 0) return MPS_OK;
    mps__runner_flush(&w->runner); /* keep the order of the entries */
    mps__budget_sum(w, &moved);
    stop_drops(s, w);
    mps__budget_sum(w, &stopped);
    q->next.budget.collision += (moved.kinetic - stopped.kinetic) +
                                (moved.potential - stopped.potential);
    for (int d = 0; d < w->setup.dim; d++)
        q->next.budget.momentum.collision[d] += stopped.momentum[d] - moved.momentum[d];
    return MPS_OK;
}

static const mps_use stop_at_plates_uses[] = {{"velocity", MPS_USE_CHANGE},
                                              {"position", MPS_USE_CHANGE}};

const mps__pass mps__pass_plates = {.name = "plates",
                                    .hook = MPS_SHIFT,
                                    .place = MPS__AFTER_MODELS,
                                    .stage = MPS_STAGE_CORRECT,
                                    .device = true,
                                    .use_count = 2,
                                    .uses = stop_at_plates_uses,
                                    .run = stop_at_plates};
