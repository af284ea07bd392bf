/* SPDX-License-Identifier: BSD-3-Clause */
/* Loops, sums and scratch for verbs of models, and loops of solvers; the only place with these
 * loops. Rows are owned particles, or the unknowns of an equation. */
#include "runner.h"
#include "sort.h"
#include "terms.h"
#include <mps/ppe.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static mps__runner *host_of(const mps_stage *s)
{
    return s->host;
}

/* ---- loops ---- */

/* A loop or a sum over rows, passed to the parallel-for of the handle. */
typedef struct job {
    const mps__runner *h; /* NULL: a loop of a solver */
    const mps_view *v;
    const mps_rows *rows;
    const mps_sums *sums;
    const void *fields;
    int32_t count;       /* sums or maxima */
    bool raises;         /* maxima instead of sums */
    const uint8_t *mask; /* mask of a launch */
} job;

static void own_rows(void *argument, int64_t begin, int64_t end)
{
    const job *k = argument;
    k->rows->run(k->v, k->fields, begin, end);
}

/* Run a range without the particles of other ranks. */
static void skip_ghosts(const job *k, mps_range_fn rows, void *argument, int64_t begin, int64_t end)
{
    if (k->h)
        mps__ghosts_rows(k->h->ghosts, rows, argument, begin, end);
    else
        rows(argument, begin, end);
}

static void run_rows(void *argument, int64_t begin, int64_t end)
{
    const job *k = argument;
    if (k->h && k->h->with_ghosts)
        own_rows(argument, begin, end);
    else
        skip_ghosts(k, own_rows, argument, begin, end);
}

/* Rows of one thread, and its partial sums. */
typedef struct part {
    const job *k;
    mps_exact *sums;
    double *maxima;
} part;

/* Adding zeros does not change an exact sum. */
static bool is_zero(const double *values, int32_t count)
{
    int32_t k = 0;
    while (k < count && values[k] == 0) k++;
    return k == count;
}

/* Add the terms of each row separately: a sum over several rows would depend on the start of
 * ranges. */
static void sum_rows(void *argument, int64_t begin, int64_t end)
{
    enum { BLOCK = 32 };
    const part *own_part = argument;
    const job *k = own_part->k;
    mps__terms t;
    mps__terms_begin(&t, own_part->sums, k->count);
    for (int64_t from = begin; from < end; from += BLOCK) {
        const int64_t to = from + BLOCK < end ? from + BLOCK : end;
        double values[BLOCK * MPS_PARALLEL_VALUES];
        memset(values, 0, (size_t)((to - from) * k->count) * sizeof *values);
        k->sums->run(k->v, k->fields, from, to, k->count, values);
        for (int64_t i = from; i < to; i++) {
            const double *own = values + (i - from) * k->count;
            if (!is_zero(own, k->count)) mps__terms_add(&t, own);
        }
    }
    mps__terms_end(&t);
}

static void run_sums(void *argument, int64_t begin, int64_t end, mps_exact *sums, double *none)
{
    const job *k = argument;
    part own = {.k = k, .sums = sums};
    (void)none;
    skip_ghosts(k, sum_rows, &own, begin, end);
}

static void raise_rows(void *argument, int64_t begin, int64_t end)
{
    const part *own_part = argument;
    const job *k = own_part->k;
    k->sums->run(k->v, k->fields, begin, end, 0, own_part->maxima);
}

static void run_maxima(void *argument, int64_t begin, int64_t end, double *values)
{
    const job *k = argument;
    part own = {.k = k, .maxima = values};
    skip_ghosts(k, raise_rows, &own, begin, end);
}

/* ---- on a device ---- */

/* The rows of a launch that are not masked. */
static void launch_rows(const job *k, mps_range_fn rows, void *argument, int64_t begin, int64_t end)
{
    for (int64_t i = begin; i < end;) {
        while (k->mask && i < end && k->mask[i]) i++;
        const int64_t from = i;
        while (i < end && !(k->mask && k->mask[i])) i++;
        if (from < i) rows(argument, from, i);
    }
}

static void run_launch(const void *host, int64_t begin, int64_t end, mps_exact *sums,
                       double *maxima)
{
    const job *k = host;
    part own = {.k = k, .sums = sums, .maxima = maxima};
    if (k->rows)
        launch_rows(k, own_rows, (void *)k, begin, end);
    else
        launch_rows(k, k->raises ? raise_rows : sum_rows, &own, begin, end);
}

/* Mask of a loop: particles of other ranks. */
static const uint8_t *mask_of(const job *k, mps__device *d)
{
    return k->rows && k->h->with_ghosts ? NULL : mps__ghosts_seen(k->h->ghosts, d);
}

/* Launch rows, and `count` sums or maxima, which are written to device memory if `to` is not
 * NULL. */
static void launch(mps__device *d, const job *given, mps_exact *sums, double *maxima, void *to)
{
    mps_view v = *given->v;
    job k = *given;
    const mps__runner *h = k.h;
    if (h)
        mps__memory_loop_view((mps__memory *)&h->memory,
                              h->model ? (int32_t)(h->model - h->models->on) : 0, &v);
    k.v = &v;
    k.mask = h ? mask_of(&k, d) : NULL;
    mps_launch l = {.dim = v.dim,
                    .n = v.n,
                    /* NOLINTNEXTLINE(clang-analyzer-core.NullDereference): rows or sums */
                    .file = k.rows ? k.rows->file : k.sums->file,
                    .name = k.rows ? k.rows->name : k.sums->name,
                    .view = &v,
                    .fields = k.fields,
                    .bytes = k.rows ? k.rows->bytes : k.sums->bytes,
                    .sums = k.raises ? 0 : k.count,
                    .maxima = k.raises ? k.count : 0,
                    .run = run_launch,
                    .host = &k,
                    .mask = k.mask};
    if (to)
        mps__device_reduce_async(d, &l, to);
    else
        mps__device_launch(d, &l, sums, maxima);
}

/* ---- loops of calls ---- */

/* Rows of a loop on the host: none if its inputs could not be copied from the device. */
static int64_t rows_on_host(const mps__runner *h, const mps_view *v)
{
    return h->memory.device.failed ? 0 : v->n;
}

void mps__runner_rows(const mps__runner *h, const mps_view *v, const mps_rows *rows,
                      const void *fields)
{
    job k = {.h = h, .v = v, .rows = rows, .fields = fields};
    mps__device *d = mps__device_of(h->parallel);
    if (d)
        launch(d, &k, NULL, NULL, NULL);
    else
        mps_parallel_rows(h->parallel, rows_on_host(h, v), run_rows, &k);
}

void mps__runner_sum(const mps__runner *h, const mps_view *v, int32_t count, const mps_sums *add,
                     const void *fields, double *sums)
{
    job k = {.h = h, .v = v, .sums = add, .fields = fields, .count = count};
    mps_exact sum[MPS_PARALLEL_VALUES] = {{{0}, 0, 0}};
    mps__device *d = mps__device_of(h->parallel);
    if (d)
        launch(d, &k, sum, NULL, NULL);
    else
        mps_exact_rows(h->parallel, rows_on_host(h, v), MPS_PARALLEL_LEAST, run_sums, &k,
                       &(mps_exact_values){.sums = count, .sum = sum});
    mps__ranks_sum(h->ghosts->ranks, count, sum);
    for (int32_t m = 0; m < count; m++) sums[m] = mps_exact_value(&sum[m]);
}

void mps__runner_max(const mps__runner *h, const mps_view *v, int32_t count, const mps_sums *raise,
                     const void *fields, double *maxima)
{
    job k = {.h = h, .v = v, .sums = raise, .fields = fields, .count = count, .raises = true};
    mps__device *d = mps__device_of(h->parallel);
    if (d)
        launch(d, &k, NULL, maxima, NULL);
    else
        mps_parallel_max(h->parallel, rows_on_host(h, v), count, run_maxima, &k, maxima);
    mps__ranks_max(h->ghosts->ranks, count, maxima);
}

void mps__runner_sum_deferred(mps__runner *h, const mps_view *v, int32_t count, const mps_sums *add,
                              const void *fields, mps__then then)
{
    const job k = {.h = h, .v = v, .sums = add, .fields = fields, .count = count};
    double sums[MPS_PARALLEL_VALUES];
    mps__device *d = mps__device_of(h->parallel);
    if (d) {
        launch(d, &k, NULL, NULL, mps__deferred_sums(h, count, then));
        return;
    }
    mps__runner_sum(h, v, count, add, fields, sums);
    then.run(then.owner, sums);
}

void mps__runner_max_deferred(mps__runner *h, const mps_view *v, int32_t count,
                              const mps_sums *raise, const void *fields, mps__then then)
{
    const job k = {.h = h, .v = v, .sums = raise, .fields = fields, .count = count, .raises = true};
    double maxima[MPS_PARALLEL_VALUES];
    mps__device *d = mps__device_of(h->parallel);
    if (d) {
        launch(d, &k, NULL, NULL, mps__deferred_maxima(h, count, then));
        return;
    }
    for (int32_t m = 0; m < count; m++) maxima[m] = -INFINITY;
    mps__runner_max(h, v, count, raise, fields, maxima);
    then.run(then.owner, maxima);
}

/* ---- what solvers call ---- */

/* At most the values of a message of mps_ppe_total(). */
enum { PPE_VALUES = 4 };

static mps_view view_of(const mps_ppe_problem *problem)
{
    return (mps_view){
        .struct_size = sizeof(mps_view), .dim = problem->dim, .n = problem->n, .dp = problem->dp};
}

void mps_ppe_rows(const mps_ppe_problem *problem, const mps_rows *rows, const void *fields)
{
    const mps_view v = view_of(problem);
    job k = {.v = &v, .rows = rows, .fields = fields};
    mps__device *d = mps__device_of(problem->parallel);
    if (d)
        launch(d, &k, NULL, NULL, NULL);
    else
        mps_parallel_rows(problem->parallel, problem->n, run_rows, &k);
}

int mps_ppe_sum(const mps_ppe_problem *problem, int32_t count, const mps_sums *add,
                const void *fields, double *sums)
{
    const mps_view v = view_of(problem);
    job k = {.v = &v, .sums = add, .fields = fields, .count = count};
    mps_exact sum[PPE_VALUES] = {{{0}, 0, 0}};
    const mps_exact_values values = {.sums = count, .sum = sum};
    mps__device *d = mps__device_of(problem->parallel);
    if (count < 1 || count > PPE_VALUES) return 1;
    if (d)
        launch(d, &k, sum, NULL, NULL);
    else
        mps_exact_rows(problem->parallel, problem->n, MPS_PARALLEL_LEAST, run_sums, &k, &values);
    double lost = d && d->failed; /* of any rank: all ranks return the same */
    const int failed = mps_ppe_total(problem, &(mps_exact_values){count, 1, sum, &lost});
    for (int32_t m = 0; m < count; m++) sums[m] = mps_exact_value(&sum[m]);
    return failed || lost > 0;
}

int mps_ppe_max(const mps_ppe_problem *problem, int32_t count, const mps_sums *raise,
                const void *fields, double *maxima)
{
    const mps_view v = view_of(problem);
    job k = {.v = &v, .sums = raise, .fields = fields, .count = count, .raises = true};
    mps__device *d = mps__device_of(problem->parallel);
    if (count < 1 || count > PPE_VALUES) return 1;
    for (int32_t m = 0; m < count; m++) maxima[m] = -INFINITY;
    if (d)
        launch(d, &k, NULL, maxima, NULL);
    else
        mps_parallel_max(problem->parallel, problem->n, count, run_maxima, &k, maxima);
    const double here = d && d->failed;
    mps_exact lost = {{0}, 0, 0};
    mps_exact_add(&lost, 1, &here);
    const int failed = mps_ppe_total(problem, &(mps_exact_values){1, count, &lost, maxima});
    return failed || mps_exact_value(&lost) > 0;
}

/* ---- what verbs call ---- */

void mps_stage_rows(const mps_stage *s, const mps_rows *rows, const void *fields)
{
    mps__runner_to_host(host_of(s));
    mps__runner_rows(host_of(s), s->view, rows, fields);
}

/* Initialise the results of a loop with sums or maxima. An invalid count makes the verb fail,
 * whatever it returns. @return whether the loop may run */
static bool begin_values(const mps_stage *s, int32_t count, const char *what, double first,
                         double *values)
{
    mps__runner *h = host_of(s);
    mps__runner_to_host(h);
    for (int32_t m = 0; m < count && m < MPS_PARALLEL_VALUES; m++) values[m] = first;
    if (count >= 1 && count <= MPS_PARALLEL_VALUES) return true;
    h->misused = true;
    mps__fail(h->context, MPS_E_PLUGIN, "a loop requests %d %s: must be 1..%d", (int)count, what,
              MPS_PARALLEL_VALUES);
    return false;
}

void mps_stage_sum(const mps_stage *s, int32_t count, const mps_sums *add, const void *fields,
                   double *sums)
{
    if (begin_values(s, count, "sums", 0, sums))
        mps__runner_sum(host_of(s), s->view, count, add, fields, sums);
}

void mps_stage_max(const mps_stage *s, int32_t count, const mps_sums *raise, const void *fields,
                   double *maxima)
{
    if (begin_values(s, count, "maxima", -INFINITY, maxima))
        mps__runner_max(host_of(s), s->view, count, raise, fields, maxima);
}

typedef struct besides {
    const int32_t *member;
    int32_t *beside;
} besides;

MPS_ROW void look_beside(const int dim, const mps_view *v, const besides *b, int64_t i)
{
    const mps_stencil *t = &v->near;
    bool any = false;
    (void)dim;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i) && !any; p++)
        any = b->member[mps_stencil_column(t, p)] != 0;
    b->beside[i] = any;
}
MPS_ROWS(beside_rows, look_beside, besides)

/* Calls that use pairs; there are none before the search. */
int mps__stage_has_pairs(mps_stage *s, const char *call)
{
    if (s->hook != MPS_POPULATE) return 1;
    mps_stage_fail(s,
                   "%s() was called in hook '%s', where there are no pairs yet: call it in a later "
                   "hook",
                   call, mps__hook_name(s->hook));
    return 0;
}

int mps_stage_adjacent(mps_stage *s, int32_t *member, int32_t *beside)
{
    const mps_shared shared = {.values = member, .components = 1, .type = MPS_TYPE_INTEGER};
    if (!mps__stage_has_pairs(s, "mps_stage_adjacent")) return 1;
    if (!member || !beside)
        return mps_stage_fail(s, "mps_stage_adjacent(): %s is NULL: must be an array of view->n",
                              member ? "beside" : "member");
    if (mps_stage_refresh(s, 1, &shared)) return 1;
    mps_stage_rows(s, &beside_rows, &(besides){member, beside});
    return 0;
}

mps_status mps_grid_init(mps_grid *grid, size_t size)
{
    static const mps_grid none = {.struct_size = sizeof none};
    return mps__struct_init("mps_grid", grid, size, &none, sizeof none);
}

/* Linked lists of the grid buckets: serial, as each particle may change the list of any bucket. */
static void chain_rows(const mps_view *v, const mps_grid *grid, int32_t *first, int32_t *next)
{
    for (int64_t i = v->n - 1; i >= 0; i--) {
        int64_t cell[3];
        if (!mps_is_fluid(v, i)) continue;
        mps_grid_cell(grid, v->x + i * v->dim, cell);
        const int64_t b = mps_grid_bucket(grid, cell);
        next[i] = first[b];
        first[b] = (int32_t)(i + 1);
    }
}

/* ---- linked lists on a device: particles are sorted by bucket ---- */

typedef struct chaining {
    mps_grid grid;
    uint64_t *key; /* of particles; of sorted indices */
    int32_t *order;
    int32_t *first, *next;
} chaining;

MPS_ROW void bucket_row(const int dim, const mps_view *v, const chaining *f, int64_t i)
{
    int64_t cell[3];
    mps_grid_cell(&f->grid, v->x + i * dim, cell);
    f->key[i] = mps_is_fluid(v, i) ? (uint64_t)mps_grid_bucket(&f->grid, cell) : UINT64_MAX;
    f->order[i] = (int32_t)i;
}
MPS_ROWS(bucket_rows, bucket_row, chaining)

MPS_ROW void chain_row(const int dim, const mps_view *v, const chaining *f, int64_t a)
{
    const uint64_t key = f->key[a];
    (void)dim;
    if (key == UINT64_MAX) return;
    if (a == 0 || f->key[a - 1] != key) f->first[key] = f->order[a] + 1;
    f->next[f->order[a]] = a + 1 < v->n && f->key[a + 1] == key ? f->order[a + 1] + 1 : 0;
}
MPS_ROWS(chain_device_rows, chain_row, chaining)

/* Scratch until the end of a call. NULL: out of memory. */
static void *workspace_device(mps__runner *h, int32_t block, size_t bytes)
{
    void *buffer = NULL;
    if (h->scratch_used + block < MPS__SCRATCH)
        buffer = mps__memory_workspace(&h->memory, h->scratch_used + block, bytes);
    h->no_memory = h->no_memory || !buffer;
    return buffer;
}

static int chain_device(mps_stage *s, const mps_grid *grid, int32_t *first, int32_t *next)
{
    mps__runner *h = host_of(s);
    const int64_t n = s->view->n;
    uint64_t *key = workspace_device(h, 0, 2 * (size_t)n * sizeof *key);
    int32_t *order = workspace_device(h, 1, 2 * (size_t)n * sizeof *order);
    chaining f = {*grid, key, order, first, next};
    mps__sorting m = {
        .n = n, .run = 1, .key = key, .order = order, .new_key = key + n, .new_order = order + n};
    if (!key || !order) return 1;
    h->with_ghosts = true; /* the grid includes ghosts */
    mps_stage_rows(s, &bucket_rows, &f);
    mps__merge_sort(h->parallel, &m);
    f.key = (uint64_t *)m.key;
    f.order = (int32_t *)m.order;
    mps_stage_rows(s, &chain_device_rows, &f);
    h->with_ghosts = false;
    return 0;
}

int mps_stage_grid(mps_stage *s, double side, mps_grid *grid)
{
    mps_grid made = {.dim = s->view->dim, .side = side, .buckets = s->view->n};
    int32_t *first = mps_stage_scratch_integers(s, s->view->n),
            *next = mps_stage_scratch_integers(s, s->view->n);
    if (!(side > 0)) return mps_stage_fail(s, "the side of a grid is %g m: must be > 0", side);
    if (!first || !next) return 1;
    made.first = first;
    made.next = next;
    if (mps__struct_out(NULL, "mps_grid", grid, &made, sizeof made) < 0)
        return mps_stage_fail(s, "the grid is NULL or not initialised: call mps_grid_init() first");
    if (host_of(s)->memory.space == MPS__ON_DEVICE) return chain_device(s, &made, first, next);
    mps__runner_to_host(host_of(s));
    chain_rows(s->view, &made, first, next);
    return 0;
}

int mps_stage_refresh(mps_stage *s, int32_t count, const mps_shared *shared)
{
    enum { MOST = 16 };
    mps__halo_array list[MOST];
    mps__runner *h = host_of(s);
    mps__runner_to_host(h);
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
        list[k] = (mps__halo_array){
            a->values,
            (size_t)a->components * (a->type == MPS_TYPE_REAL ? sizeof(double) : sizeof(int32_t)),
            h->memory.space == MPS__ON_DEVICE};
    }
    return mps__ghosts_exchange_at(h->ghosts, &h->memory.device, list, count) < 0;
}

/* ---- scratch and errors ---- */

static void *scratch(mps_stage *s, int64_t count, size_t size)
{
    mps__runner *h = host_of(s);
    if (h->scratch_used == MPS__SCRATCH || count < 0) {
        mps_stage_fail(s, "a verb may borrow at most %d blocks of scratch, of no negative size",
                       MPS__SCRATCH);
        return NULL;
    }
    void *block = h->memory.space == MPS__ON_DEVICE
                      ? mps__memory_scratch(&h->memory, h->scratch_used, (size_t)count * size)
                      : mps__scratch_take(h->context, h->scratch, h->scratch_used, count, size);
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
    if (block && host_of(s)->memory.space == MPS__ON_HOST)
        mps__parallel_zero(host_of(s)->parallel, &(mps__block){block, count}, 1);
    return block;
}

int32_t *mps_stage_scratch_integers(mps_stage *s, int64_t count)
{
    int32_t *block = scratch(s, count, sizeof *block);
    if (block && host_of(s)->memory.space == MPS__ON_HOST)
        memset(block, 0, (size_t)count * sizeof *block);
    return block;
}

int mps_stage_gas(mps_stage *s, int32_t pockets, double volume, double pressure, double work)
{
    if (s->hook != MPS_SHIFT) return mps_stage_fail(s, "mps_stage_gas() is for verbs of MPS_SHIFT");
    if (pockets < 0 || !isfinite(volume) || !isfinite(pressure) || !isfinite(work))
        return mps_stage_fail(s,
                              "mps_stage_gas(): %d pockets, volume %g m3, pressure %g Pa, work "
                              "%g J: must be >= 0 and finite",
                              (int)pockets, volume, pressure, work);
    host_of(s)->gas = (mps__gas){pockets, volume, pressure, work};
    return 0;
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
