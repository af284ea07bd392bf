/* SPDX-License-Identifier: BSD-3-Clause */
/* Loops, sums and scratch for verbs of models: the one place where these loops are. Rows are owned particles. */
#include "host.h"
#include "terms.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static mps__host *host_of(const mps_stage *s)
{
    return s->host;
}

/* ---- loops ---- */

/* A loop or a sum over rows, as the parallel-for of the handle wants it. */
typedef struct job {
    const mps_stage *s;
    mps_rows_fn rows;
    mps_sums_fn sums;
    void *arguments;
    int32_t count; /* sums */
} job;

static void own_rows(void *argument, int64_t begin, int64_t end)
{
    const job *k = argument;
    k->rows(k->s, k->arguments, begin, end);
}

static void run_rows(void *argument, int64_t begin, int64_t end)
{
    const job *k = argument;
    mps__ghosts_rows(host_of(k->s)->ghosts, own_rows, argument, begin, end);
}

/* Rows of one thread, and where it collects. */
typedef struct part {
    const job *k;
    mps_exact *sums;
    double *maxima;
} part;

/* One row at a time: a sum of several rows would depend on where ranges begin. */
static void sum_rows(void *argument, int64_t begin, int64_t end)
{
    const part *own_part = argument;
    const job *k = own_part->k;
    mps__terms t;
    mps__terms_begin(&t, own_part->sums, k->count);
    for (int64_t i = begin; i < end; i++) {
        double own[MPS_PARALLEL_VALUES] = {0};
        k->sums(k->s, k->arguments, i, i + 1, own);
        mps__terms_add(&t, own);
    }
    mps__terms_end(&t);
}

static void run_sums(void *argument, int64_t begin, int64_t end, mps_exact *sums, double *none)
{
    const job *k = argument;
    part own = {.k = k, .sums = sums};
    (void)none;
    mps__ghosts_rows(host_of(k->s)->ghosts, sum_rows, &own, begin, end);
}

static void raise_rows(void *argument, int64_t begin, int64_t end)
{
    const part *own_part = argument;
    const job *k = own_part->k;
    k->sums(k->s, k->arguments, begin, end, own_part->maxima);
}

static void run_maxima(void *argument, int64_t begin, int64_t end, double *values)
{
    const job *k = argument;
    part own = {.k = k, .maxima = values};
    mps__ghosts_rows(host_of(k->s)->ghosts, raise_rows, &own, begin, end);
}

void mps_stage_rows(const mps_stage *s, mps_rows_fn rows, void *arguments)
{
    job k = {.s = s, .rows = rows, .arguments = arguments};
    mps_parallel_rows(host_of(s)->parallel, s->n, run_rows, &k);
}

/* First values of sums or maxima. A count that the loops have no room for makes the verb fail,
 * whatever it returns. @return whether the loop may run */
static bool begin_values(const mps_stage *s, int32_t count, const char *what, double first,
                         double *values)
{
    mps__host *h = host_of(s);
    for (int32_t m = 0; m < count && m < MPS_PARALLEL_VALUES; m++) values[m] = first;
    if (count >= 1 && count <= MPS_PARALLEL_VALUES) return true;
    h->misused = true;
    mps__fail(h->context, MPS_E_PLUGIN, "a loop was asked for %d %s: must be 1..%d", (int)count,
              what, MPS_PARALLEL_VALUES);
    return false;
}

void mps_stage_sum(const mps_stage *s, int32_t count, mps_sums_fn add, void *arguments,
                   double *sums)
{
    job k = {.s = s, .sums = add, .arguments = arguments, .count = count};
    mps_exact sum[MPS_PARALLEL_VALUES] = {{{0}, 0, 0}};
    if (!begin_values(s, count, "sums", 0, sums)) return;
    mps_exact_rows(host_of(s)->parallel, s->n, MPS_PARALLEL_LEAST, run_sums, &k,
                   &(mps_exact_values){.sums = count, .sum = sum});
    mps__ranks_sum(host_of(s)->ghosts->ranks, count, sum);
    for (int32_t m = 0; m < count; m++) sums[m] = mps_exact_value(&sum[m]);
}

void mps_stage_max(const mps_stage *s, int32_t count, mps_sums_fn raise, void *arguments,
                   double *maxima)
{
    job k = {.s = s, .sums = raise, .arguments = arguments};
    if (!begin_values(s, count, "maxima", -INFINITY, maxima)) return;
    mps_parallel_max(host_of(s)->parallel, s->n, count, run_maxima, &k, maxima);
    mps__ranks_max(host_of(s)->ghosts->ranks, count, maxima);
}

typedef struct besides {
    const int32_t *member;
    int32_t *beside;
} besides;

static void beside_rows(const mps_stage *s, void *arguments, int64_t begin, int64_t end)
{
    const besides *b = arguments;
    const mps_stencil *t = s->near;
    for (int64_t i = begin; i < end; i++) {
        bool any = false;
        for (int64_t p = t->begin[i]; p < t->end[i] && !any; p++) any = b->member[t->col[p]] != 0;
        b->beside[i] = any;
    }
}

int mps_stage_beside(mps_stage *s, int32_t *member, int32_t *beside)
{
    const mps_shared shared = {.values = member, .components = 1, .type = MPS_TYPE_INTEGER};
    if (mps_stage_refresh(s, 1, &shared)) return 1;
    mps_stage_rows(s, beside_rows, &(besides){member, beside});
    return 0;
}

mps_status mps_grid_init(mps_grid *grid, size_t size)
{
    static const mps_grid none = {.struct_size = sizeof none};
    return mps__struct_init("mps_grid", grid, size, &none, sizeof none);
}

/* Chains of rows: serial, as each row may change the chain of any bucket. */
int mps_stage_grid(mps_stage *s, double side, mps_grid *grid)
{
    mps_grid made = {.dim = s->dim, .side = side, .buckets = s->n};
    int32_t *first = mps_stage_scratch_integers(s, s->n),
            *next = mps_stage_scratch_integers(s, s->n);
    if (!(side > 0)) return mps_stage_fail(s, "the side of a grid is %g m: must be > 0", side);
    if (!first || !next) return 1;
    made.first = first;
    made.next = next;
    if (mps__struct_out(NULL, "mps_grid", grid, &made, sizeof made) < 0)
        return mps_stage_fail(s, "the grid is NULL or not initialised: call mps_grid_init() first");
    for (int64_t i = s->n - 1; i >= 0; i--) {
        int64_t cell[3];
        if (s->kind[i] != MPS_FLUID) continue;
        mps_grid_cell(&made, s->x + i * s->dim, cell);
        const int64_t b = mps_grid_bucket(&made, cell);
        next[i] = first[b];
        first[b] = (int32_t)(i + 1);
    }
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

int mps_stage_refresh(mps_stage *s, int32_t count, const mps_shared *shared)
{
    enum { MOST = 16 };
    mps__shared list[MOST];
    if (count < 1 || count > MOST)
        return mps_stage_fail(s, "refresh: %d arrays: must be 1..%d", (int)count, MOST);
    for (int32_t k = 0; k < count; k++) {
        const mps_shared *a = &shared[k];
        if (!a->values || a->components < 1)
            return mps_stage_fail(s,
                                  "refresh: array %d is NULL, or has %d components: must be >= 1",
                                  (int)k, (int)a->components);
        if (a->type != MPS_TYPE_REAL && a->type != MPS_TYPE_INTEGER)
            return mps_stage_fail(s, "refresh: array %d has type %d: MPS_TYPE_REAL or _INTEGER",
                                  (int)k, (int)a->type);
        list[k] = (mps__shared){a->values,
                                (size_t)a->components *
                                    (a->type == MPS_TYPE_REAL ? sizeof(double) : sizeof(int32_t))};
    }
    return mps__ghosts_share(host_of(s)->ghosts, list, count) < 0;
}

/* ---- scratch and errors ---- */

static void *scratch(mps_stage *s, int64_t count, size_t size)
{
    mps__host *h = host_of(s);
    if (h->scratch_used == MPS__SCRATCH || count < 0) {
        mps_stage_fail(s, "a verb may borrow at most %d blocks of scratch, of no negative size",
                       MPS__SCRATCH);
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
    if (block) mps__parallel_zero(host_of(s)->parallel, &(mps__block){block, count}, 1);
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
