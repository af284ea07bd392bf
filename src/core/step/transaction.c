/* SPDX-License-Identifier: BSD-3-Clause */
/* The transaction around a step: backup copies, the device, undo or commit, times. */
#include "guard.h"
#include "populate.h"
#include "step.h"
#include "world_ranks.h"
#include <math.h>
#include <string.h>

/* ---- backup copies of the fields that a step changes ---- */

/* Whether the last pass of a step writes the field, after everything that can fail on the host. */
static bool is_written_last(const mps__world *w, const mps__field *f)
{
    const mps__particles *s = &w->particles;
    const void *const data = f->data;
    return data == &s->load || data == &s->active || data == &s->ref || data == &s->area;
}

/* Fields that calls write; the step itself keeps the old positions. A device can fail in each loop
 * and each copy, up to the last. */
static bool is_kept(mps__world *w, const mps__field *f)
{
    if (w->runner.memory.step && (f->data == (void **)&w->particles.x || is_written_last(w, f)))
        return true;
    return f->data != (void **)&w->particles.x &&
           mps__plan_writes(&w->runner.plan, &w->channels, &w->particles, f);
}

static size_t bytes_of(const mps__world *w, const mps__field *f)
{
    return (size_t)w->particles.n * mps__field_element(f);
}

static mps_status keep_fields(mps__world *w)
{
    mps__particles *s = &w->particles;
    for (int32_t k = 0; k < s->fields; k++) {
        const mps__field *f = &s->field[k];
        mps__array *a = mps__field_array(&s->field[k]);
        a->kept_in = MPS__NOWHERE;
        if (!is_kept(w, f)) continue;
        MPS__TRY(mps__array_keep(a, w->context, &w->pool.parallel, bytes_of(w, f)));
        if (a->kept_in == MPS__ON_HOST)
            w->runner.plan.outside[MPS__UNDO].bytes += 2.0 * (double)bytes_of(w, f);
    }
    return MPS_OK;
}

/* `before`: positions before particles moved, or NULL. MPS_E_PLUGIN: backups on a device are lost
 * with it. */
static mps_status restore_fields(mps__world *w, const double *before)
{
    mps__particles *s = &w->particles;
    mps__array *x = mps__field_array(&s->field[MPS__FIELD_POSITION]);
    bool on_device = false;
    for (int32_t k = 0; k < s->fields; k++) {
        mps__array *a = mps__field_array(&s->field[k]);
        mps__array_restore(a, bytes_of(w, &s->field[k]));
        on_device = on_device || a->kept_in == MPS__ON_DEVICE;
    }
    if (before && x->kept_in == MPS__NOWHERE) {
        memcpy(s->x, before, bytes_of(w, &s->field[MPS__FIELD_POSITION]));
        mps__array_written(x, MPS__ON_HOST);
    }
    return on_device ? mps__memory_restored(&w->runner.memory, w->state.t) : MPS_OK;
}

/* ---- begin ---- */

mps_status mps__step_begin(mps__step *q)
{
    mps__world *w = q->w;
    mps__runner *h = &w->runner;
    mps__runner_begin(h);
    q->begin = h->clock;
    w->balance.waited = w->ranks.seconds;
    MPS__TRY(mps__memory_alive(&h->memory));
    MPS__TRY(mps__world_adopt(w));
    MPS__TRY(mps__plan_make(&h->plan, &w->models));
    mps__plan_note(&h->plan, &w->models);
    /* changes since the last step, whether this one succeeds or not */
    MPS__TRY(mps__step_book_between(w));
    mps__memory_begin(&h->memory);
    w->next_flags.holds = w->next_flags.flow == mps__particles_flow(&w->particles) &&
                          w->next_flags.searches == w->lists.neighbours.searches;
    mps__neighbours_release(&w->lists.complete); /* its stencils are valid until this step */
    return MPS_OK;
}

mps_status mps__step_keep(mps__step *q)
{
    mps__world *w = q->w;
    mps__models_keep(&w->models);
    MPS__TRY(keep_fields(w));
    q->next = w->state;
    q->kept = true;
    mps__runner_book(&w->runner, MPS__UNDO);
    return MPS_OK;
}

/* ---- end ---- */

/* Lists on the device may be lost: then the next step searches again at the positions of the last
 * search. */
static mps_status close_device(mps__world *w)
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

/* Extend the error text: if the tank is moved by its load and jumps in a failed step, its coupling
 * is the likely cause. */
static mps_status name_coupling(const mps__step *q, mps_status status)
{
    const mps__world *w = q->w;
    const double jump = fmax(q->next.jump.accel, w->state.jump.accel),
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

static mps_status undo(const mps__step *q, mps_status status)
{
    mps__world *w = q->w;
    if (q->kept) {
        mps__models_restore(&w->models);
        const mps_status restored = restore_fields(w, q->before);
        if (restored < 0) status = restored;
    }
    mps__world_depopulate(w);
    return name_coupling(q, status);
}

static void commit(mps__step *q)
{
    mps__world *w = q->w;
    if (w->state.step == 0) mps__world_note_phases(w);
    mps__step_load_end(q);
    mps__step_body_end(q);
    w->state = q->next;
    w->motion.now = q->pose;
    w->info = q->info;
    w->next_flags = q->next_flags;
    w->booked = mps__particles_flow(&w->particles);
#ifdef MPS_CHECKED
    mps__guard_poison(&w->runner);
#endif
    mps__runner_book(&w->runner, MPS__COMMIT);
}

/* Times by MPS_STAGE_...; the last one is the remainder. */
static void book_times(const mps__step *q)
{
    mps__runner *h = &q->w->runner;
    double *stage = q->w->info.seconds, rest = h->clock - q->begin;
    h->seconds[MPS_STAGE_PPE_SOLVE] -= q->setup_seconds;
    h->seconds[MPS_STAGE_PPE_SETUP] += q->setup_seconds;
    for (int k = 0; k < MPS_STAGE_CORRECT; k++) rest -= stage[k] = h->seconds[k];
    stage[MPS_STAGE_CORRECT] = rest;
    mps__world_balance(q->w, mps__clock() - q->begin);
}

mps_status mps__step_end(mps__step *q, mps_status status)
{
    const mps_status closed = close_device(q->w);
    if (closed < 0) status = closed; /* a device error takes precedence */
    if (status < 0) return undo(q, status);
    commit(q);
    book_times(q);
    MPS__TRY(mps__ranks_status(&q->w->ranks));
    return q->not_converged ? MPS_W_NOT_CONVERGED : MPS_OK;
}
