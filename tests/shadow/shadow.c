/* SPDX-License-Identifier: BSD-3-Clause */
#define _GNU_SOURCE
#include "shadow.h"
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#include <cmocka.h>

/* ---- memory of a handle, that it can be closed ---- */

enum { HEAP_CLASSES = 48 };
static const size_t HEAP = (size_t)1 << 32;

typedef struct shadow_memory {
    char *begin;
    size_t used;
    void *is_free[HEAP_CLASSES]; /* by the power of two that is their size */
} shadow_memory;

/* The first one is for all handles of a thread alone, the others for one rank each. */
static shadow_memory memories[1 + SHADOW_RANKS];

/* In front of a block. */
typedef struct heap_block {
    size_t power;
    void *next;
} heap_block;

static void heap_protect(const shadow_memory *heap, int access)
{
    if (heap && heap->begin) mprotect(heap->begin, (heap->used + 4095) & ~(size_t)4095, access);
}

static void *heap_alloc(void *user, size_t size)
{
    shadow_memory *heap = user;
    size_t power = 5;
    while ((size_t)1 << power < size + sizeof(heap_block)) power++;
    heap_block *b = heap->is_free[power];
    if (b) {
        heap->is_free[power] = b->next;
    } else {
        assert_true(heap->used + ((size_t)1 << power) <= HEAP);
        b = (heap_block *)(void *)(heap->begin + heap->used);
        heap->used += (size_t)1 << power;
    }
    b->power = power;
    return b + 1;
}

static void heap_release(void *user, void *block)
{
    shadow_memory *heap = user;
    heap_block *b = (heap_block *)block - 1;
    if ((char *)block < heap->begin || (char *)block >= heap->begin + HEAP) {
        free(block); /* of before the handle was given this memory */
        return;
    }
    b->next = heap->is_free[b->power];
    heap->is_free[b->power] = b;
}

static void take_heap(mps_sim *sim, shadow_memory *heap)
{
    if (!heap->begin)
        heap->begin = mmap(NULL, HEAP, PROT_READ | PROT_WRITE,
                           MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    assert_true(heap->begin != MAP_FAILED);
    sim->context.allocator = (mps_allocator){
        .alloc = heap_alloc, .release = heap_release, .user = heap};
}

void shadow_heap(mps_sim *sim)
{
    take_heap(sim, &memories[0]);
}

void shadow_heap_of(mps_sim *sim, int32_t rank)
{
    assert_true(rank >= 0 && rank < SHADOW_RANKS);
    take_heap(sim, &memories[1 + rank]);
}

/* ---- memory of the device ---- */

/* Only functions of the device make its memory accessible. After a frequent loop it remains
 * accessible. Allocations are contiguous, so that one call changes the protection of all. */
static const size_t ARENA = (size_t)1 << 32;

/* Whole pages. */
static size_t pages(uint64_t bytes)
{
    return ((size_t)bytes + 4095) & ~(size_t)4095;
}

/* The first gap of this number of bytes, at the beginning or after an allocation. */
static char *gap_for(const shadow *s, size_t bytes)
{
    for (int after = -1; after < SHADOW_BLOCKS; after++) {
        char *begin = after < 0 ? s->arena : s->block[after].begin + s->block[after].bytes;
        bool is_free = after < 0 || s->block[after].begin;
        for (int k = 0; is_free && k < SHADOW_BLOCKS; k++)
            is_free = !s->block[k].begin || begin >= s->block[k].begin + s->block[k].bytes ||
                      begin + bytes <= s->block[k].begin;
        if (is_free) return begin;
    }
    return NULL;
}

static void *take_block(void *self, uint64_t bytes)
{
    shadow *s = self;
    int k = 0;
    s->why = NULL;
    if (s->refuses && s->allocations-- <= 0) return NULL;
    if (!s->arena)
        s->arena = s->arena_end = mmap(NULL, ARENA, PROT_NONE,
                                       MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    assert_true(s->arena != MAP_FAILED);
    char *begin = gap_for(s, pages(bytes));
    assert_true(begin && begin + pages(bytes) <= s->arena + ARENA);
    if (begin + pages(bytes) > s->arena_end) {
        if (s->open)
            mprotect(s->arena_end, (size_t)(begin + pages(bytes) - s->arena_end),
                     PROT_READ | PROT_WRITE);
        s->arena_end = begin + pages(bytes);
    }
    while (k < SHADOW_BLOCKS && s->block[k].begin) k++;
    assert_true(k < SHADOW_BLOCKS);
    s->block[k].begin = begin;
    s->block[k].bytes = pages(bytes);
    s->blocks++;
    return begin;
}

static void release(void *self, void *begin)
{
    shadow *s = self;
    for (int k = 0; k < SHADOW_BLOCKS; k++) {
        if (s->block[k].begin != begin) continue;
        s->block[k].begin = NULL;
        s->blocks--;
        if (s->blocks > 0) return;
        munmap(s->arena, ARENA);
        s->arena = s->arena_end = NULL;
        s->open = false;
        return;
    }
    fail_msg("memory is given back that is none");
}

/* The allocation of an address, -1: host memory. */
static int block_of(const shadow *s, const void *address)
{
    for (int k = 0; k < SHADOW_BLOCKS; k++)
        if (s->block[k].begin && (const char *)address >= s->block[k].begin &&
            (const char *)address < s->block[k].begin + s->block[k].bytes)
            return k;
    return -1;
}

static void protect(const shadow *s, int k, int access)
{
    if (s->block[k].begin && !s->open) mprotect(s->block[k].begin, s->block[k].bytes, access);
}

static void open_all(shadow *s, bool open)
{
    const size_t bytes = (size_t)(s->arena_end - s->arena);
    if (open == s->open) return;
    if (bytes > 0) mprotect(s->arena, bytes, open ? PROT_READ | PROT_WRITE : PROT_NONE);
    s->open = open;
}

/* ---- copies ---- */

static int fails(shadow *s)
{
    s->why = "as the test wants it";
    return 1;
}

static int upload(void *self, void *to, const void *from, uint64_t bytes)
{
    shadow *s = self;
    const int k = block_of(s, to);
    assert_true(k >= 0 && block_of(s, from) < 0);
    if (s->dead) return fails(s);
    s->uploads++;
    s->bytes_up += (int64_t)bytes;
    protect(s, k, PROT_READ | PROT_WRITE);
    memcpy(to, from, bytes);
    protect(s, k, PROT_NONE);
    return 0;
}

static int download(void *self, void *to, const void *from, uint64_t bytes)
{
    shadow *s = self;
    const int k = block_of(s, from);
    assert_true(k >= 0 && block_of(s, to) < 0);
    s->downloads++;
    s->bytes_down += (int64_t)bytes;
    if (s->dead || s->downloads == s->loses_at) {
        memset(to, 0x55, bytes); /* what a copy that failed has left is anything */
        return fails(s);
    }
    protect(s, k, PROT_READ);
    memcpy(to, from, bytes);
    protect(s, k, PROT_NONE);
    return 0;
}

static int clear(void *self, void *to, uint64_t bytes)
{
    shadow *s = self;
    const int k = block_of(s, to);
    assert_true(k >= 0);
    if (s->dead) return fails(s);
    protect(s, k, PROT_READ | PROT_WRITE);
    memset(to, 0, bytes);
    protect(s, k, PROT_NONE);
    return 0;
}

static int copy(void *self, void *to, const void *from, uint64_t bytes)
{
    shadow *s = self;
    const int a = block_of(s, to), b = block_of(s, from);
    assert_true(a >= 0 && b >= 0);
    if (s->dead) return fails(s);
    protect(s, a, PROT_READ | PROT_WRITE);
    protect(s, b, PROT_READ | PROT_WRITE);
    memcpy(to, from, bytes);
    protect(s, a, PROT_NONE);
    protect(s, b, PROT_NONE);
    return 0;
}

/* Integers get a number that is no region, no condition and no row. */
static void invalidated(void *self, void *array, uint64_t bytes, uint32_t number)
{
    const int32_t poison = INT32_MIN + 1;
    const double nan = NAN;
    shadow *s = self;
    const int k = block_of(s, array);
    s->invalidated++;
    if (k >= 0) protect(s, k, PROT_READ | PROT_WRITE);
    for (size_t at = 0; at < bytes; at += number) {
        const void *value = number == 8 ? (const void *)&nan : &poison;
        memcpy((char *)array + at, value, number);
    }
    if (k >= 0) protect(s, k, PROT_NONE);
}

/* ---- loops ---- */

static uint32_t slot_of(const char *file, const char *name)
{
    uint32_t hash = 0;
    for (const char *c = file; *c; c++) hash = hash * 31 + (unsigned char)*c;
    for (const char *c = name; *c; c++) hash = hash * 31 + (unsigned char)*c;
    return hash % SHADOW_LOOPS;
}

int32_t shadow_seen(const shadow *s, const char *file, const char *name)
{
    return s->seen[slot_of(file, name)];
}

/* Whether the memory of the handle is closed for a launch, and that of the device behind it: for
 * the first ones of a loop, because closing takes longer than most loops. */
static bool closes(shadow *s, const mps_launch *l)
{
    return s->seen[slot_of(l->file, l->name)]++ < SHADOW_CLOSED;
}

/* A host address among the arguments would be invalid on a device. Here its access finds protected
 * memory. */
static void run(shadow *s, const mps_launch *l, mps_exact *sum, double *maximum)
{
    assert_int_equal(l->struct_size, sizeof *l);
    assert_true(l->n > 0 && (l->dim == 2 || l->dim == 3) && !strchr(l->file, '/'));
    s->launches++;
    open_all(s, true);
    const bool closed = closes(s, l);
    if (closed) heap_protect(s->heap, PROT_NONE);
    l->run(l->host, 0, l->n, sum, maximum);
    if (closed) heap_protect(s->heap, PROT_READ | PROT_WRITE);
    open_all(s, !closed);
}

/* Whether the next launch fails, or any from now on. */
static bool stops(shadow *s)
{
    s->dead = s->dead || (s->dies_at > 0 && s->launches + 1 >= s->dies_at);
    return s->dead || (s->fails_at > 0 && s->launches + 1 >= s->fails_at);
}

static int rows(void *self, const mps_launch *l)
{
    shadow *s = self;
    if (stops(s)) return fails(s);
    run(s, l, NULL, NULL);
    return 0;
}

static int values(void *self, const mps_launch *l, mps_exact *sum, double *maximum)
{
    shadow *s = self;
    if (s->dead) return fails(s);
    run(s, l, sum, maximum);
    s->bytes_down += (int64_t)((size_t)l->sums * sizeof *sum + (size_t)l->maxima * sizeof *maximum);
    return 0;
}

static int gather(void *self, const mps_launch *l, void *to)
{
    shadow *s = self;
    mps_exact sum[MPS_PARALLEL_VALUES] = {{{0}, 0, 0}};
    double maximum[MPS_PARALLEL_VALUES];
    const int k = block_of(s, to);
    assert_true(k >= 0);
    for (int m = 0; m < l->maxima; m++) maximum[m] = -INFINITY;
    if (stops(s)) return fails(s);
    run(s, l, sum, maximum);
    protect(s, k, PROT_READ | PROT_WRITE);
    memcpy(to, sum, (size_t)l->sums * sizeof *sum);
    memcpy((mps_exact *)to + l->sums, maximum, (size_t)l->maxima * sizeof *maximum);
    protect(s, k, PROT_NONE);
    return 0;
}

static int wait_for(void *self)
{
    shadow *s = self;
    return s->dead ? fails(s) : 0;
}

static const char *failure(void *self)
{
    const shadow *s = self;
    return s->why;
}

void shadow_attach(shadow *s, mps_sim *sim)
{
    *s = (shadow){.ops = {.struct_size = sizeof s->ops,
                          .api = MPS_DEVICE_API,
                          .name = "shadow",
                          .self = s,
                          .alloc = take_block,
                          .free = release,
                          .upload = upload,
                          .download = download,
                          .clear = clear,
                          .copy = copy,
                          .launch = rows,
                          .reduce = values,
                          .reduce_async = gather,
                          .wait = wait_for,
                          .failure = failure,
                          .invalidated = invalidated,
                          .plugin_loops = 1}};
    if (sim->context.allocator.alloc == heap_alloc) s->heap = sim->context.allocator.user;
    assert_int_equal(mps_sim_device_set(sim, &s->ops), MPS_OK);
}

mps_device_info shadow_counts(const mps_sim *sim)
{
    mps_device_info info;
    assert_int_equal(mps_device_info_init(&info, sizeof info), MPS_OK);
    assert_int_equal(mps_sim_device_info(sim, &info), MPS_OK);
    return info;
}
