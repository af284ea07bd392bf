/* SPDX-License-Identifier: BSD-3-Clause */
/* Fields that a step changes are kept beside themselves until it has succeeded. */
#include "undo.h"
#include <string.h>

/* What is new on a device that fails is lost, and with it the old positions that a step has there. */
static bool on_device(const mps__world *w)
{
    return mps__device_there(&w->host.twins.device);
}

/* All that calls write; of positions the step itself keeps the old ones. */
static bool is_kept(mps__world *w, const mps__field *f)
{
    if (on_device(w)) return true;
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
        f->undone = is_kept(w, f);
        if (!f->undone) continue;
        const int64_t room = s->n > f->kept_capacity ? mps__room(s->n, f->kept_capacity) : 0;
        MPS__TRY(mps__grow(w->context, &f->kept, &f->kept_capacity, 0, room,
                           (size_t)f->components * f->size));
        mps__parallel_copy(&w->pool.parallel, f->kept, *f->data, bytes_of(w, f));
        w->host.plan.outside[MPS__UNDO].bytes += 2.0 * (double)bytes_of(w, f);
    }
    return MPS_OK;
}

void mps__undo_restore(mps__world *w, const double *before)
{
    const mps__particles *s = &w->particles;
    for (int32_t k = 0; k < s->fields; k++)
        if (s->field[k].undone)
            memcpy(*s->field[k].data, s->field[k].kept, bytes_of(w, &s->field[k]));
    mps__models_restore(&w->models);
    if (before && !on_device(w)) memcpy(s->x, before, (size_t)(s->n * w->setup.dim) * sizeof *s->x);
}
