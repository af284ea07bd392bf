/* SPDX-License-Identifier: BSD-3-Clause */
/* The tank in a step: velocities of its solids, accelerations of the rigid tank, jumps of its velocity. */
#include "step.h"
#include <string.h>

/* Velocity of a point of the tank over the last step; before the first: what the start convention says. */
static void tank_velocity(const mps__world *w, const double *X, double *u)
{
    double from[3], to[3];
    if (w->state.dt_before > 0) {
        mps__motion_point(&w->motion, &w->state.before, X, from, NULL, NULL);
        mps__motion_point(&w->motion, &w->motion.now, X, to, NULL, NULL);
        for (int d = 0; d < w->setup.dim; d++) u[d] = (to[d] - from[d]) / w->state.dt_before;
    } else if (w->motion.start == MPS_START_WITH_TANK) {
        mps__motion_point(&w->motion, &w->motion.now, X, NULL, u, NULL);
    } else {
        for (int d = 0; d < w->setup.dim; d++) u[d] = 0;
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
static bool at_rest(const mps__step *q)
{
    const mps__world *w = q->w;
    const bool was = w->state.dt_before > 0 ? same_place(&w->state.before, &w->motion.now)
                                            : w->motion.start != MPS_START_WITH_TANK;
    return was && same_place(&w->motion.now, &q->pose);
}

/* Square of the largest acceleration of the solids. */
static void solid_acceleration_rows(void *world, int64_t begin, int64_t end, double *most)
{
    const mps__world *w = world;
    for (int64_t i = begin; i < end; i++) {
        const double *a = w->work.tank_acceleration + i * w->setup.dim;
        if (w->particles.kind[i] != MPS_FLUID) *most = fmax(*most, mps__dot(a, a, w->setup.dim));
    }
}

/* A velocity that changes within a step by more than twice as much as in the last one, and than by 2 g, jumps. Velocities are means over a step, so
 * half a step lies on either side of the change: over dt alone a steady acceleration would jump where a step is cut short. */
static void note_jump(mps__step *q)
{
    mps__world *w = q->w;
    double most = 0;
    mps_parallel_max(&w->pool.parallel, w->particles.n, 1, solid_acceleration_rows, w, &most);
    mps__ranks_max(&w->ranks, 1, &most);
    const double dt = q->stage.dt,
                 change = w->state.dt_before > 0 ? 2 * dt / (dt + w->state.dt_before) : 1;
    q->jump = (mps__jump){change * sqrt(most),
                          w->state.jump.since < INT32_MAX ? w->state.jump.since + 1 : INT32_MAX};
    if (q->jump.accel > 2 * w->setup.velocity_scale * w->setup.velocity_scale / w->setup.dp &&
        q->jump.accel > 2 * w->state.jump.accel)
        q->jump.since = 0;
    q->stage.since_jump = q->jump.since;
}

static void rest_rows(void *step, int64_t begin, int64_t end)
{
    const mps__step *q = step;
    const mps__particles *s = &q->w->particles;
    const int dim = s->dim;
    for (int64_t k = begin * dim; k < end * dim; k++) q->w->work.tank_acceleration[k] = 0;
    for (int64_t i = begin; i < end; i++)
        for (int d = 0; d < dim; d++)
            s->u[i * dim + d] = s->kind[i] == MPS_FLUID ? s->u[i * dim + d] : 0;
}

static void move_row(const mps__step *q, int64_t i)
{
    mps__world *w = q->w;
    const mps__particles *s = &w->particles;
    const int dim = w->setup.dim;
    double X[3], here[3], next[3], old[3];
    if (s->kind[i] == MPS_FLUID)
        mps__motion_to_tank(&w->motion, &w->motion.now, s->x + i * dim, X);
    else
        memcpy(X, s->ref + i * dim, (size_t)dim * sizeof *X);
    mps__motion_point(&w->motion, &w->motion.now, X, here, NULL, NULL);
    mps__motion_point(&w->motion, &q->pose, X, next, NULL, NULL);
    tank_velocity(w, X, old);
    for (int d = 0; d < dim; d++) {
        const double u = (next[d] - here[d]) / q->stage.dt;
        w->work.tank_acceleration[i * dim + d] = (u - old[d]) / q->stage.dt;
        if (s->kind[i] != MPS_FLUID) s->u[i * dim + d] = u;
    }
}

static void move_rows(void *step, int64_t begin, int64_t end)
{
    for (int64_t i = begin; i < end; i++) move_row(step, i);
}

static void turn_rows(void *world, int64_t begin, int64_t end)
{
    const mps__world *w = world;
    for (int64_t i = begin; i < end; i++)
        mps__motion_rotate(&w->motion, &w->motion.now, w->particles.area + i * w->setup.dim,
                           w->work.turned + i * w->setup.dim);
}

/* Area vectors turn with the tank. */
mps_status mps__step_turn_areas(mps__world *w)
{
    const mps__particles *s = &w->particles;
    mps__work *k = &w->work;
    k->area = s->area;
    if (!mps__motion_turned(&w->motion.now)) return MPS_OK;
    MPS__TRY(mps__grow(w->context, (void **)&k->turned, &k->turned_capacity, 0, s->n * w->setup.dim,
                       sizeof *k->turned));
    mps_parallel_rows(&w->pool.parallel, s->n, turn_rows, w);
    k->area = k->turned;
    return MPS_OK;
}

/* Solids get the velocity that carries them to their next place; every particle the acceleration a rigid tank has there. */
void mps__step_move_tank(mps__step *q)
{
    mps_parallel_rows(&q->w->pool.parallel, q->w->particles.n, at_rest(q) ? rest_rows : move_rows,
                      q);
    note_jump(q);
}
