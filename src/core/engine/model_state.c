/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers of models that belong to no particle. A failed step restores those that its verbs
 * accessed. */
#include "runner.h"
#include <math.h>
#include <string.h>

mps_status mps__numbers_resize(mps__context *c, mps__numbers *s, int64_t count)
{
    MPS__TRY(mps__grow(c, (void **)&s->value, &s->capacity, s->count,
                       count > s->capacity ? mps__capacity_for(count, s->capacity) : 1,
                       sizeof *s->value));
    if (count > s->count)
        memset(s->value + s->count, 0, (size_t)(count - s->count) * sizeof *s->value);
    s->count = count;
    return MPS_OK;
}

void mps__numbers_free(mps__context *c, mps__numbers *s)
{
    mps__free(c, s->value);
    mps__free(c, s->kept);
    *s = (mps__numbers){0};
}

void mps__models_keep(mps__models *m)
{
    for (int32_t k = 0; k < m->active; k++) m->on[k].state.touched = false;
}

void mps__models_restore(mps__models *m)
{
    for (int32_t k = 0; k < m->active; k++) {
        mps__numbers *s = &m->on[k].state;
        if (!s->touched) continue;
        s->count = s->kept_count; /* the capacity is sufficient */
        if (s->count > 0) memcpy(s->value, s->kept, (size_t)s->count * sizeof *s->value);
    }
}

const mps__model *mps__models_not_finite(const mps__models *m, int64_t *place)
{
    for (int32_t k = 0; k < m->active; k++)
        for (int64_t i = 0; m->on[k].state.touched && i < m->on[k].state.count; i++)
            if (!isfinite(m->on[k].state.value[i])) {
                *place = i;
                return &m->on[k];
            }
    return NULL;
}

/* Save the numbers before the first change in a step. */
static mps_status keep(mps__context *c, mps__numbers *s)
{
    if (s->touched) return MPS_OK;
    MPS__TRY(
        mps__grow(c, (void **)&s->kept, &s->kept_capacity, 0,
                  s->count > s->kept_capacity ? mps__capacity_for(s->count, s->kept_capacity) : 1,
                  sizeof *s->kept));
    if (s->count > 0) memcpy(s->kept, s->value, (size_t)s->count * sizeof *s->kept);
    s->kept_count = s->count;
    s->touched = true;
    return MPS_OK;
}

double *mps_stage_state(mps_stage *s, int64_t count)
{
    mps__runner *h = s->host;
    if (s->hook == MPS_POPULATE || count < 0 || !h->model) {
        mps_stage_fail(s,
                       "mps_stage_state() requests %lld numbers in hook %d: must be >= 0, "
                       "after MPS_POPULATE",
                       (long long)count, (int)s->hook);
        return NULL;
    }
    mps__numbers *state = &h->model->state;
    if (keep(h->context, state) < 0 || mps__numbers_resize(h->context, state, count) < 0) {
        h->no_memory = true;
        return NULL;
    }
    return state->value;
}

const double *mps_stage_state_get(const mps_stage *s, int64_t *count)
{
    const mps__runner *h = s->host;
    const mps__numbers none = {0}, *state = h->model ? &h->model->state : &none;
    if (count) *count = state->count;
    return state->value;
}
