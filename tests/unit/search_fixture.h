/* SPDX-License-Identifier: BSD-3-Clause */
/* Order of particles and candidates by the loops of a device, which run as defined by the including
 * file, compared with those of the host. */
#ifndef TESTS_SEARCH_FIXTURE_H
#define TESTS_SEARCH_FIXTURE_H

#include "cloud.h"
#include "neighbours.h"
#include "scan.h"
#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static const double search_near = 2.1 * CLOUD_DP, search_far = 3.1 * CLOUD_DP;

/* Fluid over a wall over dummies, in any order; ids are in another. */
typedef struct tank {
    cloud c;
    int32_t *kind;
    int64_t *id;
} tank;

static inline int64_t below(int64_t n, uint64_t *seed)
{
    const int64_t k = (int64_t)((cloud_random(seed) + 1) / 2 * (double)n);
    return k < n ? k : n - 1;
}

static inline tank tank_of(int32_t dim, int64_t n, uint64_t seed)
{
    const size_t capacity = n > 0 ? (size_t)n : 1;
    tank t = {cloud_empty(dim, n), calloc(capacity, sizeof(int32_t)),
              calloc(capacity, sizeof(int64_t))};
    int64_t side = 1;
    while ((dim == 2 ? side * side : side * side * side) < n) side++;
    int64_t *place = calloc(capacity, sizeof *place);
    assert_true(t.c.x && t.kind && t.id && place);
    for (int64_t i = 0; i < n; i++) place[i] = t.id[i] = i;
    for (int64_t i = n - 1; i > 0; i--) {
        const int64_t a = below(i + 1, &seed), b = below(i + 1, &seed), p = place[i], q = t.id[i];
        place[i] = place[a];
        place[a] = p;
        t.id[i] = t.id[b];
        t.id[b] = q;
    }
    for (int64_t i = 0; i < n; i++) {
        const int64_t k[3] = {place[i] % side, place[i] / side % side, place[i] / side / side};
        for (int d = 0; d < dim; d++)
            t.c.x[i * dim + d] = CLOUD_DP * ((double)k[d] + 0.3 * cloud_random(&seed));
        const int64_t height = k[dim - 1];
        t.kind[i] = height < side / 3 ? MPS_DUMMY : height == side / 3 ? MPS_WALL : MPS_FLUID;
    }
    free(place);
    return t;
}

static inline void tank_free(tank *t)
{
    cloud_free(&t->c);
    free(t->kind);
    free(t->id);
}

/* Permute all particles. */
static inline void tank_sort(tank *t, const int32_t *order)
{
    const int32_t dim = t->c.dim;
    cloud c = cloud_empty(dim, t->c.n);
    int32_t *kind = calloc((size_t)c.n, sizeof *kind);
    assert_true(c.x && kind);
    for (int64_t i = 0; i < c.n; i++) {
        memcpy(c.x + i * dim, t->c.x + (int64_t)order[i] * dim, (size_t)dim * sizeof *c.x);
        kind[i] = t->kind[order[i]];
    }
    cloud_free(&t->c);
    free(t->kind);
    t->c = c;
    t->kind = kind;
}

/* Allocate arrays for loops of a device. */
typedef struct search_buffers {
    mps__order_arrays order;
    mps__search_arrays search;
} search_buffers;

static inline void *allocate(int64_t count, size_t size)
{
    void *capacity = malloc((size_t)(count > 0 ? count : 1) * size);
    assert_non_null(capacity);
    return capacity;
}

static inline search_buffers search_buffers_of(int64_t n)
{
    search_buffers r = {.order = {.key = allocate(2 * n, sizeof(uint64_t)),
                                  .order = allocate(2 * n, sizeof(int32_t))},
                        .search = {.begin = allocate(mps__scan_size(n), sizeof(int64_t)),
                                   .middle = allocate(n, sizeof(int64_t)),
                                   .end = allocate(n, sizeof(int64_t)),
                                   .count = allocate(n, sizeof(int32_t)),
                                   .idle = allocate(n, 1),
                                   .near_dummies = allocate(n, 1)}};
    r.search.key = r.order.key;
    return r;
}

static inline void search_buffers_free(search_buffers *r)
{
    free(r->order.key);
    free(r->order.order);
    free(r->search.begin);
    free(r->search.middle);
    free(r->search.end);
    free(r->search.count);
    free(r->search.idle);
    free(r->search.near_dummies);
}

/* Lists of the host and of the loops: equal rows, contiguous in the second. */
static inline void same_rows(const mps_neighbours *l, const mps__search_arrays *on_device)
{
    int64_t begin = 0;
    for (int64_t i = 0; i < l->n; i++) {
        assert_int_equal(on_device->idle[i], l->idle[i]);
        assert_int_equal(on_device->near_dummies[i], l->near_dummies[i]);
        assert_int_equal(on_device->count[i], l->count[i]);
        assert_int_equal(on_device->begin[i], begin);
        assert_int_equal(on_device->middle[i] - begin, l->middle[i] - l->begin[i]);
        assert_int_equal(on_device->end[i] - begin, l->end[i] - l->begin[i]);
        if (l->count[i] > 0)
            assert_memory_equal(on_device->col + begin, l->col + l->begin[i],
                                (size_t)l->count[i] * sizeof *l->col);
        begin += l->count[i];
    }
}

/* Order, then candidates of `n` particles on both sides. `equal`: one radius. */
static inline void search_both(int32_t dim, int64_t n, bool dummy_rows, bool equal)
{
    mps__context context = {.allocator = mps__allocator_default()};
    mps_neighbours host, l;
    tank t = tank_of(dim, n, (uint64_t)(n + dim));
    search_buffers r = search_buffers_of(n);
    const double near = equal ? search_far : search_near;
    assert_int_equal(mps__neighbours_init(&host, &context, dim, CLOUD_DP), MPS_OK);
    assert_int_equal(mps__neighbours_init(&l, &context, dim, CLOUD_DP), MPS_OK);
    assert_int_equal(mps__neighbours_order(&host, n, t.c.x, t.id, search_far), MPS_OK);
    r.order.x = t.c.x;
    r.order.id = t.id;
    const int32_t *order = mps__neighbours_order_device(&l, n, search_far, &r.order);
    assert_non_null(order);
    assert_memory_equal(order, host.order, (size_t)n * sizeof *order);
    if (n > 0) {
        tank_sort(&t, order);
        mps__neighbours_sorted(&host, n);
        host.kind = l.kind = t.kind;
        host.dummy_rows = l.dummy_rows = dummy_rows;
        assert_int_equal(mps__neighbours_search(&host, n, t.c.x, near, search_far), MPS_OK);
        assert_int_equal(mps__neighbours_begin(&l, n, t.c.x, near, search_far), MPS_OK);
        r.search.x = t.c.x;
        r.search.kind = t.kind;
        mps__search_arrays on_device = r.search;
        if (equal) on_device.end = on_device.middle;
        assert_int_equal(mps__neighbours_count_device(&l, &on_device), MPS_OK);
        assert_int_equal(l.pairs, host.pairs);
        assert_int_equal(l.longest, 0);
        on_device.col = l.col;
        mps__neighbours_fill_device(&l, &on_device);
        same_rows(&host, &on_device);
    }
    mps__neighbours_free(&host);
    mps__neighbours_free(&l);
    search_buffers_free(&r);
    tank_free(&t);
}

#endif
