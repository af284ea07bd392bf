/* SPDX-License-Identifier: BSD-3-Clause */
/* The budget of a step: what each part of it adds to energy and momentum. Only the plates, which
 * stop drops, change the flow here. */
#include "plates.h"
#include "step.h"

/* Whether verbs run at a moment. Without, all is as before it. */
static bool acts(const mps__step *q, int32_t moment)
{
    const int32_t *begin = q->w->host.plan.begin;
    return begin[moment] < begin[moment + 1];
}

/* Velocities are those that the last state was booked with: no verb changes them before. */
void mps__step_book_forces(mps__step *q)
{
    const mps_stage *s = &q->stage;
    mps_momentum *m = &q->budget.momentum;
    mps__push push;
    mps__budget_push(q->w, q->w->work.motion, s->dt, &push);
    q->budget.viscous -= push.energy;
    for (int d = 0; d < s->dim; d++) {
        const double weight = push.mass * s->dt * s->g[d];
        m->force[d] += push.impulse[d];
        m->gravity[d] += weight;
        q->momentum[d] = q->budget.last.momentum[d] + push.impulse[d] + weight;
    }
}

void mps__step_book_pressure(mps__step *q)
{
    mps__world *w = q->w;
    mps_momentum *m = &q->budget.momentum;
    double force[3];
    q->budget.wall_work += mps__budget_wall_work(w, &q->pose, w->work.motion, q->stage.dt);
    mps__budget_sum_flow(w, &q->bulk);
    mps__budget_wall_force(w, w->work.load, force);
    for (int d = 0; d < w->setup.dim; d++) {
        m->pressure[d] += q->bulk.momentum[d] - q->momentum[d];
        m->walls[d] += q->stage.dt * force[d];
    }
}

void mps__step_book_collisions(mps__step *q)
{
    mps__bulk after;
    if (!acts(q, MPS_VELOCITY)) return;
    mps__budget_sum_flow(q->w, &after);
    q->budget.collision += q->bulk.kinetic - after.kinetic;
    for (int d = 0; d < q->w->setup.dim; d++)
        q->budget.momentum.collision[d] += after.momentum[d] - q->bulk.momentum[d];
    q->bulk = after;
}

void mps__step_book_shift(mps__step *q)
{
    mps__bulk after;
    if (!acts(q, MPS_SHIFT)) return;
    mps__budget_sum_flow(q->w, &after);
    q->budget.shift += q->bulk.kinetic - after.kinetic + mps__budget_lift(q->w, q->w->work.motion);
    for (int d = 0; d < q->w->setup.dim; d++)
        q->budget.momentum.shift[d] += after.momentum[d] - q->bulk.momentum[d];
}

void mps__step_stop_at_plates(mps__step *q)
{
    mps__world *w = q->w;
    mps__bulk moved, stopped;
    if (w->lists.screens.count == 0) return;
    mps__budget_sum(w, &moved);
    mps__plates_stop(w, &q->pose);
    mps__budget_sum(w, &stopped);
    q->budget.collision += (moved.kinetic - stopped.kinetic) +
                           (moved.potential - stopped.potential);
    for (int d = 0; d < w->setup.dim; d++)
        q->budget.momentum.collision[d] += stopped.momentum[d] - moved.momentum[d];
}
