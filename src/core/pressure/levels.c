/* SPDX-License-Identifier: BSD-3-Clause */
/* Components of the pressure equation, and whether each has a level: a row that sees a known pressure, or volume that can change. Nearly always
 * all have one. Then one pass over the entries on all threads is enough: trees of joined rows, whose root is their lowest row. */
#include "levels.h"
#include <stdatomic.h>

/* The lowest row of every tree is its own parent, others have a lower one. Parents are only ever replaced by rows further up, so that threads
 * may meet in a tree. */
typedef struct forest {
    const mps__ppe *e;
    _Atomic int32_t *parent;
} forest;

static inline int32_t parent_of(const forest *f, int32_t r)
{
    return atomic_load_explicit(&f->parent[r], memory_order_relaxed);
}

static inline void set_parent(const forest *f, int32_t r, int32_t parent)
{
    atomic_store_explicit(&f->parent[r], parent, memory_order_relaxed);
}

static int32_t root_of(const forest *f, int32_t r)
{
    int32_t parent = parent_of(f, r);
    while (parent != r) {
        r = parent;
        parent = parent_of(f, r);
    }
    return r;
}

/* Make one tree of those of rows r and c. */
static void join(const forest *f, int32_t r, int32_t c)
{
    for (;;) {
        const int32_t a = root_of(f, r), b = root_of(f, c), low = a < b ? a : b;
        int32_t high = a < b ? b : a;
        if (low == high || atomic_compare_exchange_strong(&f->parent[high], &high, low)) return;
    }
}

static void join_rows(void *argument, int64_t begin, int64_t end)
{
    const forest *f = argument;
    const mps__ppe *e = f->e;
    for (int64_t r = begin; r < end; r++)
        for (int64_t k = e->row[r]; k < e->row[r + 1] && e->col[k] < r; k++)
            if (parent_of(f, e->col[k]) != parent_of(f, (int32_t)r)) join(f, (int32_t)r, e->col[k]);
}

/* Whether each component has a level. Most rows come into the tree of their first column at once. */
static bool all_have_level(mps__ppe *e, const mps_parallel *parallel)
{
    const forest f = {e, (_Atomic int32_t *)(void *)e->queue};
    int32_t *level = e->component;
    for (int32_t r = 0; r < e->n; r++) {
        const int32_t first = e->row[r] < e->row[r + 1] ? e->col[e->row[r]] : r;
        set_parent(&f, r, first < r ? parent_of(&f, first) : r);
        level[r] = 0;
    }
    mps_parallel_rows(parallel, e->n, join_rows, (void *)&f);
    for (int32_t r = 0; r < e->n; r++)
        if (e->shift[r] > 0) level[root_of(&f, r)] = 1;
    for (int32_t r = 0; r < e->n; r++)
        if (parent_of(&f, r) == r && !level[r]) return false;
    return true;
}

/* In e->component: a row whose component was not looked at yet. In e->queue: behind the last row of a component. */
enum { NEW = -2, END = -1 };

/* From trees to chains: e->queue becomes the next row of the same component, by ascending rows. */
static void chain_rows(mps__ppe *e)
{
    int32_t *root = e->queue, *next = e->queue, *last = e->component;
    for (int32_t r = 0; r < e->n; r++) {
        root[r] = root[root[r]]; /* rows further up have their root already */
        last[r] = NEW;
    }
    for (int32_t r = 0; r < e->n; r++) {
        const int32_t first = root[r];
        if (first < r) next[last[first]] = r;
        last[first] = r;
    }
    for (int32_t r = 0; r < e->n; r++) {
        if (last[r] == NEW) continue;
        next[last[r]] = END;
        e->component[r] = NEW;
    }
}

/* A component, from its first row on. */
typedef struct component {
    int64_t rows, least; /* least id of its particles */
    bool level;
} component;

/* Its rows count as seen. */
static component look_at(mps__ppe *e, const int64_t *id, int32_t first)
{
    component c = {0, INT64_MAX, false};
    for (int32_t r = first; r != END; r = e->queue[r]) {
        const int64_t own = id[e->particle[r]];
        c.rows++;
        c.least = own < c.least ? own : c.least;
        c.level = c.level || e->shift[r] > 0;
        e->component[r] = -1;
    }
    return c;
}

/* The component gets a number; the mean of its right side is taken off. */
static void balance(mps__ppe *e, int32_t first, int64_t rows, int32_t number)
{
    double mean = 0;
    for (int32_t r = first; r != END; r = e->queue[r]) mean += e->rhs[r] / (double)rows;
    for (int32_t r = first; r != END; r = e->queue[r]) {
        e->rhs[r] -= mean;
        e->component[r] = number;
    }
}

int32_t mps__levels_find(mps__ppe *e, const int64_t *id, const mps_parallel *parallel)
{
    int32_t singular = 0;
    component largest = {0, INT64_MAX, true};
    e->level_free = false;
    if (all_have_level(e, parallel)) return 0;
    chain_rows(e);
    for (int32_t r = 0; r < e->n; r++) {
        if (e->component[r] != NEW) continue;
        const component c = look_at(e, id, r);
        if (c.rows > largest.rows || (c.rows == largest.rows && c.least < largest.least))
            largest = c;
        if (!c.level) balance(e, r, c.rows, singular++);
    }
    e->level_free = !largest.level;
    return singular;
}
