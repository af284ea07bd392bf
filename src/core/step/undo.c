/* SPDX-License-Identifier: BSD-3-Clause */
/* Backup copies of the fields that a step changes, until it has succeeded. */
#include "undo.h"
#include <string.h>

/* Whether the last pass of a step writes the field, after everything that can fail on the host. */
static bool is_written_last(const mps__world *w, const mps__field *f)
{
    const mps__particles *s = &w->particles;
    const void *const data = f->data;
    return data == &s->load || data == &s->held || data == &s->ref || data == &s->area;
}

/* Fields that calls write; the step itself keeps the old positions. A device can fail in each loop
 * and each copy, up to the last. */
static bool is_kept(mps__world *w, const mps__field *f)
{
    if (w->host.twins.step && (f->data == (void **)&w->particles.x || is_written_last(w, f)))
        return true;
    return f->data != (void **)&w->particles.x &&
           mps__plan_writes(&w->host.plan, &w->channels, &w->particles, f);
}

static size_t bytes_of(const mps__world *w, const mps__field *f)
{
    return (size_t)w->particles.n * (size_t)f->components * f->size;
}

mps_status mps__undo_keep(mps__world *w)
{
    mps__particles *s = &w->particles;
    mps__models_keep(&w->models);
    for (int32_t k = 0; k < s->fields; k++) {
        mps__field *f = &s->field[k];
        f->there = false;
        f->undone = is_kept(w, f);
        if (f->undone) MPS__TRY(mps__twins_keep(&w->host.twins, k, &f->there));
        if (!f->undone || f->there) continue;
        const int64_t room = s->n > f->kept_capacity ? mps__room(s->n, f->kept_capacity) : 0;
        MPS__TRY(mps__grow(w->context, &f->kept, &f->kept_capacity, 0, room,
                           (size_t)f->components * f->size));
        mps__parallel_copy(&w->pool.parallel, f->kept, *f->data, bytes_of(w, f));
        w->host.plan.outside[MPS__UNDO].bytes += 2.0 * (double)bytes_of(w, f);
    }
    return MPS_OK;
}

mps_status mps__undo_restore(mps__world *w, const double *before)
{
    mps__particles *s = &w->particles;
    bool moved = before != NULL, there = false;
    for (int32_t k = 0; k < s->fields; k++) {
        const mps__field *f = &s->field[k];
        if (!f->undone) continue;
        if (!f->there) memcpy(*f->data, f->kept, bytes_of(w, f));
        mps__twins_restore(&w->host.twins, k, f->there);
        there = there || f->there;
        moved = moved && f->data != (void **)&s->x;
    }
    mps__models_restore(&w->models);
    if (moved) memcpy(s->x, before, (size_t)(s->n * w->setup.dim) * sizeof *s->x);
    return there ? mps__twins_restored(&w->host.twins, w->state.t) : MPS_OK;
}
