/* SPDX-License-Identifier: BSD-3-Clause */
/* Backup copies of the fields that a step changes, until it has succeeded. */
#include "undo.h"
#include <string.h>

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

mps_status mps__undo_keep(mps__world *w)
{
    mps__particles *s = &w->particles;
    mps__models_keep(&w->models);
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

mps_status mps__undo_restore(mps__world *w, const double *before)
{
    mps__particles *s = &w->particles;
    mps__array *x = mps__field_array(&s->field[MPS__FIELD_POSITION]);
    bool on_device = false;
    for (int32_t k = 0; k < s->fields; k++) {
        mps__array *a = mps__field_array(&s->field[k]);
        mps__array_restore(a, bytes_of(w, &s->field[k]));
        on_device = on_device || a->kept_in == MPS__ON_DEVICE;
    }
    mps__models_restore(&w->models);
    if (before && x->kept_in == MPS__NOWHERE) {
        memcpy(s->x, before, bytes_of(w, &s->field[MPS__FIELD_POSITION]));
        mps__array_written(x, MPS__ON_HOST);
    }
    return on_device ? mps__memory_restored(&w->runner.memory, w->state.t) : MPS_OK;
}
