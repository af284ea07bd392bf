/* SPDX-License-Identifier: BSD-3-Clause */
/* Snapshot data besides the particles: samples of probes, which only grow between two cuts, and
 * numbers of models. */
#include "snapshot.h"
#include <string.h>

/* ---- series ---- */

static int64_t width_of(const mps__series *s)
{
    return 1 + s->size;
}

/* Number of leading samples of a probe that the snapshot already has. */
static int64_t same_samples(const mps__kept_series *k, const mps__series *s)
{
    if (k->cuts != s->cuts || k->own.size != s->size) return 0;
    return k->same < s->count ? k->same : s->count;
}

/* Allocate the rows in use and the samples of another series. The first `used` samples are kept. */
static mps_status reserve_series(mps__context *c, mps__series *to, const mps__series *from,
                                 int64_t used)
{
    const int64_t rows = (from->rows - from->first + 2) * width_of(from);
    MPS__TRY(mps__grow(c, (void **)&to->row, &to->row_capacity, to->rows * width_of(to), rows,
                       sizeof *to->row));
    MPS__TRY(mps__grow(c, (void **)&to->t, &to->t_capacity, used, from->count, sizeof *to->t));
    return mps__grow(c, (void **)&to->value, &to->value_capacity, used * from->size,
                     from->count * from->size, sizeof *to->value);
}

/* Copy a series; of its samples only those from `same` on. The capacity is sufficient. */
static void copy_series(mps__series *to, const mps__series *from, int64_t same)
{
    const size_t rows = (size_t)((from->rows - from->first) * width_of(from));
    if (rows > 0) memcpy(to->row, from->row + from->first * width_of(from), rows * sizeof *to->row);
    const int64_t fresh = from->count - same;
    if (fresh > 0) {
        memcpy(to->t + same, from->t + same, (size_t)fresh * sizeof *to->t);
        memcpy(to->value + same * from->size, from->value + same * from->size,
               (size_t)(fresh * from->size) * sizeof *to->value);
    }
    to->size = from->size;
    to->first = 0;
    to->rows = from->rows - from->first;
    to->step = from->step;
    to->waits = from->waits;
    to->start = from->start;
    to->next = from->next;
    to->count = from->count;
}

/* A probe unknown to the snapshot starts again. */
static void restart(mps__series *s)
{
    s->first = s->rows = s->count = 0;
    s->step = -1;
    s->waits = false;
    s->cuts++;
}

/* ---- save ---- */

static mps_status reserve_numbers(mps__context *c, mps__numbers *to, const mps__numbers *from)
{
    return mps__grow(c, (void **)&to->value, &to->capacity, to->count, from->count,
                     sizeof *to->value);
}

mps_status mps__kept_reserve(mps_snapshot *k)
{
    mps__context *c = &k->sim->context;
    const mps__probes *p = &k->sim->probes;
    const mps__models *m = &k->sim->world.models;
    MPS__TRY(mps__grow(c, (void **)&k->series, &k->probe_capacity, k->probes, p->count,
                       sizeof *k->series));
    for (int64_t i = 0; i < p->count; i++)
        MPS__TRY(reserve_series(c, &k->series[i].own, &p->list[i].series, k->series[i].own.count));
    for (int32_t i = 0; i < m->active; i++)
        MPS__TRY(reserve_numbers(c, &k->numbers[i], &m->on[i].state));
    return MPS_OK;
}

static void copy_numbers(mps__numbers *to, const mps__numbers *from)
{
    if (from->count > 0) memcpy(to->value, from->value, (size_t)from->count * sizeof *to->value);
    to->count = from->count;
}

void mps__kept_take(mps_snapshot *k)
{
    const mps__probes *p = &k->sim->probes;
    const mps__models *m = &k->sim->world.models;
    for (int64_t i = 0; i < p->count; i++) {
        const mps__series *s = &p->list[i].series;
        copy_series(&k->series[i].own, s, same_samples(&k->series[i], s));
        k->series[i].same = s->count;
        k->series[i].cuts = s->cuts;
    }
    if (p->count > k->probes) k->probes = p->count;
    k->models = m->active;
    for (int32_t i = 0; i < m->active; i++) {
        k->model[i] = m->on[i].ops;
        copy_numbers(&k->numbers[i], &m->on[i].state);
    }
}

/* ---- restore ---- */

/* Whether the snapshot has this probe. */
static bool has_probe(const mps_snapshot *k, int64_t i)
{
    return i < k->probes && k->series[i].own.size == k->sim->probes.list[i].series.size;
}

mps_status mps__kept_return_reserve(mps_snapshot *k)
{
    mps__context *c = &k->sim->context;
    mps__probes *p = &k->sim->probes;
    mps__models *m = &k->sim->world.models;
    for (int64_t i = 0; i < p->count; i++)
        if (!p->list[i].removed && has_probe(k, i))
            MPS__TRY(
                reserve_series(c, &p->list[i].series, &k->series[i].own, p->list[i].series.count));
    for (int32_t i = 0; i < m->active; i++)
        MPS__TRY(reserve_numbers(c, &m->on[i].state, &k->numbers[i]));
    return MPS_OK;
}

void mps__kept_return(mps_snapshot *k)
{
    mps__probes *p = &k->sim->probes;
    mps__models *m = &k->sim->world.models;
    for (int64_t i = 0; i < p->count; i++) {
        mps__series *s = &p->list[i].series;
        if (p->list[i].removed) continue;
        if (!has_probe(k, i)) {
            restart(s);
            continue;
        }
        copy_series(s, &k->series[i].own, same_samples(&k->series[i], s));
        /* other snapshots must copy the next samples again */
        s->cuts++;
        k->series[i].same = s->count;
        k->series[i].cuts = s->cuts;
    }
    for (int32_t i = 0; i < m->active; i++) copy_numbers(&m->on[i].state, &k->numbers[i]);
}

void mps__kept_free(mps_snapshot *k)
{
    mps__context *c = &k->sim->context;
    for (int64_t i = 0; i < k->probe_capacity; i++) mps__series_free(c, &k->series[i].own);
    mps__free(c, k->series);
    for (int32_t i = 0; i < MPS__MODELS_ACTIVE; i++) mps__numbers_free(c, &k->numbers[i]);
}
