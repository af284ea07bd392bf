/* SPDX-License-Identifier: BSD-3-Clause */
#include "loops.h"
#include "runner.h"
#include "loop.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* ---- memory of the library ---- */

enum { BLOCKS = 8192, WORDS = 400 };

typedef struct block {
    char *begin;
    size_t bytes;
} block;

static block blocks[BLOCKS];
static int block_count;

void *__real_malloc(size_t bytes);
void __real_free(void *begin);
void *__wrap_malloc(size_t bytes);
void __wrap_free(void *begin);

void *__wrap_malloc(size_t bytes)
{
    void *begin = __real_malloc(bytes);
    if (begin && block_count < BLOCKS) blocks[block_count++] = (block){begin, bytes};
    return begin;
}

void __wrap_free(void *begin)
{
    for (int k = 0; begin && k < block_count; k++)
        if (blocks[k].begin == begin) blocks[k] = blocks[--block_count];
    __real_free(begin);
}

static const block *block_of(const char *address)
{
    for (int k = 0; k < block_count; k++)
        if (address >= blocks[k].begin && address < blocks[k].begin + blocks[k].bytes)
            return &blocks[k];
    return NULL;
}

/* ---- copies at the device ---- */

typedef struct mirror {
    const block *of;
    char *begin;
} mirror;

typedef struct memory {
    int count;
    mirror list[WORDS];
} memory;

static opencl *device;
static uintptr_t bottom; /* of the stack that a step may use */

void loops_watch(opencl *o)
{
    device = o;
    bottom = (uintptr_t)__builtin_frame_address(0);
}

static char *mirror_of(memory *t, const block *b)
{
    for (int k = 0; k < t->count; k++)
        if (t->list[k].of == b) return t->list[k].begin;
    assert_true(t->count < WORDS);
    char *begin = device->ops.alloc(device, b->bytes);
    assert_non_null(begin);
    assert_int_equal(device->ops.upload(device, begin, b->begin, b->bytes), 0);
    t->list[t->count++] = (mirror){b, begin};
    return begin;
}

/* Addresses of the library's memory become those of copies. One of the stack would be of no use on
 * a device. */
static void translate(memory *t, const char *loop, void *arguments, size_t bytes)
{
    const uintptr_t here = (uintptr_t)__builtin_frame_address(0);
    for (size_t at = 0; at + sizeof(char *) <= bytes; at += sizeof(char *)) {
        char *address;
        memcpy(&address, (char *)arguments + at, sizeof address);
        const block *b = block_of(address);
        if ((uintptr_t)address > here && (uintptr_t)address < bottom)
            fail_msg("%s: word %zu of its arguments is an address of the stack", loop, at / 8);
        if (!b) continue;
        address = mirror_of(t, b) + (address - b->begin);
        memcpy((char *)arguments + at, &address, sizeof address);
    }
}

static void release_all(const memory *t)
{
    for (int k = 0; k < t->count; k++) device->ops.free(device, t->list[k].begin);
}

/* ---- loops ---- */

/* A loop on copies; two of its four tables are NULL, or three. */
typedef struct job {
    const mps__loop *loop;
    const mps__values *values;
    const mps_rows *rows;
    const mps_sums *sums;
    int32_t dim, count;
    mps_view view;
    _Alignas(16) char fields[4096 * 4];
    memory memory;
} job;

/* The host code, as the library runs it. */
static void run(const void *host, int64_t begin, int64_t end, mps_exact *sum, double *maximum)
{
    const job *k = host;
    if (k->loop) k->loop->run(k->dim, k->fields, begin, end);
    if (k->values) k->values->run(k->dim, k->fields, begin, end, sum, maximum);
    if (k->rows) k->rows->run(&k->view, k->fields, begin, end);
    if (k->sums && maximum) k->sums->run(&k->view, k->fields, begin, end, 0, maximum);
    for (int64_t i = begin; i < end && k->sums && sum; i++) {
        double own[MPS_PARALLEL_VALUES] = {0};
        k->sums->run(&k->view, k->fields, i, i + 1, k->count, own);
        for (int32_t m = 0; m < k->count; m++) mps_exact_add(&sum[m], 1, &own[m]);
    }
}

static bool watched(const mps_parallel *p, int64_t n)
{
    return device && !mps__device_of(p) && n > 0;
}

static void both(job *k, const mps_launch *given, const void *fields, mps_exact *sum,
                 double *maximum)
{
    opencl *o = device;
    mps_launch l = *given;
    l.struct_size = sizeof l;
    l.run = run;
    l.host = k;
    l.fields = k->fields;
    if (!opencl_knows(o, &l)) return;
    assert_true(l.bytes <= sizeof k->fields);
    memcpy(k->fields, fields, l.bytes);
    translate(&k->memory, l.name, k->fields, l.bytes);
    if (l.view) translate(&k->memory, l.name, &k->view, sizeof k->view);
    const int failed = l.sums + l.maxima > 0 ? o->ops.reduce(o, &l, sum, maximum)
                                             : o->ops.launch(o, &l);
    release_all(&k->memory);
    if (failed) fail_msg("%s", o->failure);
}

static void loop_on_both(const mps__loop *loop, int32_t dim, int64_t n, const void *fields)
{
    static job k;
    k = (job){.loop = loop, .dim = dim};
    both(&k,
         &(mps_launch){
             .dim = dim, .n = n, .file = loop->file, .name = loop->name, .bytes = loop->bytes},
         fields, NULL, NULL);
}

#define WRAP_LOOP(name)                                                                      \
    void __real_##name(const mps_parallel *p, const mps__loop *loop, int32_t dim, int64_t n, \
                       const void *fields);                                                  \
    void __wrap_##name(const mps_parallel *p, const mps__loop *loop, int32_t dim, int64_t n, \
                       const void *fields);                                                  \
    void __wrap_##name(const mps_parallel *p, const mps__loop *loop, int32_t dim, int64_t n, \
                       const void *fields)                                                   \
    {                                                                                        \
        if (watched(p, n)) loop_on_both(loop, dim, n, fields);                               \
        __real_##name(p, loop, dim, n, fields);                                              \
    }
WRAP_LOOP(mps__loop_run)
WRAP_LOOP(mps__loop_run_long)
WRAP_LOOP(mps__loop_run_cheap)

void __real_mps__values_run(const mps_parallel *p, const mps__values *values, int32_t dim,
                            int64_t n, const void *fields, mps_exact *sum, double *maximum);
void __wrap_mps__values_run(const mps_parallel *p, const mps__values *values, int32_t dim,
                            int64_t n, const void *fields, mps_exact *sum, double *maximum);
void __wrap_mps__values_run(const mps_parallel *p, const mps__values *values, int32_t dim,
                            int64_t n, const void *fields, mps_exact *sum, double *maximum)
{
    static job k;
    mps_exact own[MPS_PARALLEL_VALUES];
    double most[MPS_PARALLEL_VALUES];
    if (watched(p, n)) {
        k = (job){.values = values, .dim = dim};
        if (sum) memcpy(own, sum, (size_t)values->sums * sizeof *sum);
        if (maximum) memcpy(most, maximum, (size_t)values->maxima * sizeof *maximum);
        both(&k,
             &(mps_launch){.dim = dim,
                           .n = n,
                           .file = values->file,
                           .name = values->name,
                           .bytes = values->bytes,
                           .sums = values->sums,
                           .maxima = values->maxima},
             fields, own, most);
    }
    __real_mps__values_run(p, values, dim, n, fields, sum, maximum);
}

/* ---- loops with a view ---- */

static void view_on_both(const mps_view *v, const mps_rows *rows, const mps_sums *sums,
                         const void *fields, int32_t count, bool maxima)
{
    static job k;
    mps_exact own[MPS_PARALLEL_VALUES] = {{{0}, 0, 0}};
    double most[MPS_PARALLEL_VALUES];
    for (int m = 0; m < MPS_PARALLEL_VALUES; m++) most[m] = -INFINITY;
    k = (job){.rows = rows, .sums = sums, .dim = v->dim, .view = *v, .count = count};
    k.view.near.host = k.view.far.host = NULL; /* no row follows these */
    k.view.near.parallel = k.view.far.parallel = NULL;
    both(&k,
         &(mps_launch){.dim = v->dim,
                       .n = v->n,
                       .file = rows ? rows->file : sums->file,
                       .name = rows ? rows->name : sums->name,
                       .view = &k.view,
                       .bytes = rows ? rows->bytes : sums->bytes,
                       .sums = maxima ? 0 : count,
                       .maxima = maxima ? count : 0},
         fields, own, most);
}

static bool watched_stage(const mps_stage *s)
{
    const mps__runner *h = s->host;
    return watched(h->parallel, s->view->n);
}

#define WRAP(result, name, parameters, arguments, before) \
    result __real_##name parameters;                      \
    result __wrap_##name parameters;                      \
    result __wrap_##name parameters                       \
    {                                                     \
        before;                                           \
        __real_##name arguments;                          \
    }
WRAP(void, mps__runner_rows,
     (const mps__runner *h, const mps_view *v, const mps_rows *rows, const void *fields),
     (h, v, rows, fields),
     if (watched(h->parallel, v->n)) view_on_both(v, rows, NULL, fields, 0, false))
WRAP(void, mps__runner_sum,
     (const mps__runner *h, const mps_view *v, int32_t count, const mps_sums *add,
      const void *fields, double *sums),
     (h, v, count, add, fields, sums),
     if (watched(h->parallel, v->n)) view_on_both(v, NULL, add, fields, count, false))
WRAP(void, mps__runner_max,
     (const mps__runner *h, const mps_view *v, int32_t count, const mps_sums *raise,
      const void *fields, double *maxima),
     (h, v, count, raise, fields, maxima),
     if (watched(h->parallel, v->n)) view_on_both(v, NULL, raise, fields, count, true))
WRAP(void, mps_stage_rows, (const mps_stage *s, const mps_rows *rows, const void *fields),
     (s, rows, fields), if (watched_stage(s)) view_on_both(s->view, rows, NULL, fields, 0, false))
WRAP(void, mps_stage_sum,
     (const mps_stage *s, int32_t count, const mps_sums *add, const void *fields, double *sums),
     (s, count, add, fields, sums),
     if (watched_stage(s)) view_on_both(s->view, NULL, add, fields, count, false))
WRAP(void, mps_stage_max,
     (const mps_stage *s, int32_t count, const mps_sums *raise, const void *fields, double *maxima),
     (s, count, raise, fields, maxima),
     if (watched_stage(s)) view_on_both(s->view, NULL, raise, fields, count, true))
