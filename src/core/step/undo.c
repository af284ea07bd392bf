/* SPDX-License-Identifier: BSD-3-Clause */
/* Fields that a step changes are kept beside themselves until it has succeeded. */
#include "undo.h"
#include <string.h>

/* Whether a verb of the plan writes field number `field`, which a model brings or the user made. */
static bool is_written(const mps__world *w, int32_t field)
{
    const mps__plan *p = &w->host.plan;
    bool found = false;
    for (int32_t k = 0; k < p->begin[MPS_MOMENT_COUNT] && !found; k++) {
        const mps__call *call = &p->call[k];
        for (int32_t u = 0; u < call->verb->use_count && !found; u++)
            found = call->verb->uses[u].access & MPS_USE_WRITE &&
                    strcmp(call->verb->uses[u].channel, w->particles.field[field].name) == 0;
    }
    return found;
}

static bool is_kept(const mps__world *w, int32_t field)
{
    const mps__field *f = &w->particles.field[field];
    if (f->data == (void **)&w->particles.u || f->data == (void **)&w->particles.p) return true;
    return f->data == &f->own && is_written(w, field);
}

static size_t bytes_of(const mps__world *w, const mps__field *f)
{
    return (size_t)w->particles.n * (size_t)f->components * f->size;
}

mps_status mps__undo_keep(mps__world *w)
{
    mps__particles *s = &w->particles;
    for (int32_t k = 0; k < s->fields; k++) {
        mps__field *f = &s->field[k];
        f->undone = is_kept(w, k);
        if (!f->undone) continue;
        const int64_t room = s->n > f->kept_capacity ? mps__room(s->n, f->kept_capacity) : 0;
        MPS__TRY(mps__grow(w->context, &f->kept, &f->kept_capacity, 0, room,
                           (size_t)f->components * f->size));
        mps__parallel_copy(&w->pool.parallel, f->kept, *f->data,
                           (int64_t)(bytes_of(w, f) / sizeof(double)));
    }
    return MPS_OK;
}

void mps__undo_restore(const mps__world *w, bool moved)
{
    const mps__particles *s = &w->particles;
    for (int32_t k = 0; k < s->fields; k++)
        if (s->field[k].undone)
            memcpy(*s->field[k].data, s->field[k].kept, bytes_of(w, &s->field[k]));
    if (moved) memcpy(s->x, w->work.x0, (size_t)(s->n * w->setup.dim) * sizeof *s->x);
}
