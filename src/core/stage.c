/* SPDX-License-Identifier: BSD-3-Clause */
/* Loops, sums, bodies and scratch for verbs of models: the one place where these loops are. */
#include "host.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Sums are taken in so many parts of the rows, each by one thread: the same bytes for any number of threads. */
enum { PARTS = 64, SUMS = 16 };

static mps__host *host_of(const mps_stage *s)
{
    return s->host;
}

/* ---- loops ---- */

void mps_stage_rows(const mps_stage *s, mps_rows_fn rows, void *arguments)
{
    const int parts = host_of(s)->threads;
#pragma omp parallel for num_threads(parts) schedule(static)
    for (int p = 0; p < parts; p++) rows(s, arguments, s->n * p / parts, s->n * (p + 1) / parts);
}

typedef struct sums {
    double of[SUMS];
} sums;

static void collect(const mps_stage *s, mps_sums_fn add, void *arguments, double first, sums part[PARTS])
{
    for (int p = 0; p < PARTS; p++)
        for (int k = 0; k < SUMS; k++) part[p].of[k] = first;
#pragma omp parallel for num_threads(host_of(s)->threads) schedule(static)
    for (int p = 0; p < PARTS; p++) add(s, arguments, s->n * p / PARTS, s->n * (p + 1) / PARTS, part[p].of);
}

void mps_stage_sum(const mps_stage *s, int32_t count, mps_sums_fn add, void *arguments, double *out)
{
    sums part[PARTS];
    collect(s, add, arguments, 0.0, part);
    for (int32_t k = 0; k < count && k < SUMS; k++) {
        out[k] = 0;
        for (int p = 0; p < PARTS; p++) out[k] += part[p].of[k];
    }
}

void mps_stage_max(const mps_stage *s, int32_t count, mps_sums_fn raise, void *arguments, double *out)
{
    sums part[PARTS];
    collect(s, raise, arguments, -INFINITY, part);
    for (int32_t k = 0; k < count && k < SUMS; k++) {
        out[k] = -INFINITY;
        for (int p = 0; p < PARTS; p++) out[k] = part[p].of[k] > out[k] ? part[p].of[k] : out[k];
    }
}

/* These rows are few as a rule, and pairs are symmetric: one thread looks about each of them sooner than all threads about all rows. */
void mps_stage_beside(const mps_stage *s, const int32_t *member, int32_t *beside)
{
    const mps_stencil *t = s->near;
    memset(beside, 0, (size_t)s->n * sizeof *beside);
    for (int64_t i = 0; i < s->n; i++) {
        if (!member[i]) continue;
        for (int64_t p = t->begin[i]; p < t->end[i]; p++) beside[t->col[p]] = 1;
    }
}

/* Rows of a body in the order in which they were found. */
typedef struct search {
    const int32_t *role;
    int32_t *body, *queue;
    int64_t found;
} search;

/* In `body` until the search of all is over: not looked at; member of a body that is held. */
enum { NEW = -1, HELD = -2 };

static void join(search *k, int64_t i, int32_t number)
{
    k->body[i] = number;
    k->queue[k->found++] = (int32_t)i;
}

/* Look at the neighbours of row i. @return whether one of them holds the body; new members join it */
static bool is_held(const mps_stage *s, search *k, int64_t i)
{
    const mps_stencil *t = s->near;
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int32_t j = t->col[p];
        if (k->role[j] == MPS_BODY_NONE) continue;
        if (k->role[j] == MPS_BODY_ANCHOR || k->body[j] == HELD) return true;
        if (k->body[j] == NEW) join(k, j, k->body[i]);
    }
    return false;
}

int mps_stage_bodies(mps_stage *s, int32_t most, const int32_t *role, int32_t *body)
{
    search k = {role, body, mps_stage_scratch_integers(s, s->n), 0};
    int32_t count = 0;
    if (!k.queue) return 1;
    for (int64_t i = 0; i < s->n; i++) body[i] = NEW;
    for (int64_t seed = 0; seed < s->n; seed++) {
        if (role[seed] != MPS_BODY_SEED || body[seed] != NEW) continue;
        bool held = false;
        k.found = 0;
        join(&k, seed, count);
        for (int64_t next = 0; next < k.found && !held; next++) held = is_held(s, &k, k.queue[next]) || k.found > most;
        for (int64_t m = 0; m < k.found && held; m++) body[k.queue[m]] = HELD;
        count += !held;
    }
    for (int64_t i = 0; i < s->n; i++) body[i] = body[i] >= 0 ? body[i] : -1;
    host_of(s)->scratch_used--; /* the queue is not needed any more */
    return 0;
}

void mps_stage_tank(const mps_stage *s, const double *x, double *place, double *velocity)
{
    const mps__host *h = host_of(s);
    double X[3] = {0}, next[3] = {0};
    mps__motion_to_tank(h->motion, &h->motion->now, x, X);
    for (int d = 0; d < s->dim && place; d++) place[d] = X[d];
    if (!velocity) return;
    if (!h->next) {
        mps__motion_point(h->motion, &h->motion->now, X, NULL, velocity, NULL);
        return;
    }
    mps__motion_point(h->motion, h->next, X, next, NULL, NULL);
    for (int d = 0; d < s->dim; d++) velocity[d] = (next[d] - x[d]) / s->dt;
}

/* All rows are in one memory, where they are visible at once. */
int mps_stage_refresh(mps_stage *s, double *scratch, int32_t components)
{
    if (scratch && components >= 1) return 0;
    return mps_stage_fail(s, "refresh: scratch is NULL, or components is %d: must be >= 1", (int)components);
}

/* ---- scratch and errors ---- */

static void *scratch(mps_stage *s, int64_t count, size_t size)
{
    mps__host *h = host_of(s);
    if (h->scratch_used == MPS__SCRATCH || count < 0) {
        mps_stage_fail(s, "a verb may borrow at most %d blocks of scratch, of no negative size", MPS__SCRATCH);
        return NULL;
    }
    void *block = mps__scratch_take(h->context, h->scratch, h->scratch_used, count, size);
    if (!block) {
        h->no_memory = true;
        return NULL;
    }
    h->scratch_used++;
    return block;
}

double *mps_stage_scratch(mps_stage *s, int64_t count)
{
    double *block = scratch(s, count, sizeof *block);
    if (block) mps__zero(block, count, host_of(s)->threads);
    return block;
}

int32_t *mps_stage_scratch_integers(mps_stage *s, int64_t count)
{
    int32_t *block = scratch(s, count, sizeof *block);
    if (block) memset(block, 0, (size_t)count * sizeof *block);
    return block;
}

int mps_stage_fail(mps_stage *s, const char *format, ...)
{
    char text[MPS__ERROR_SIZE];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    mps__fail(host_of(s)->context, MPS_E_PLUGIN, "%s", text);
    return 1;
}
