/* SPDX-License-Identifier: BSD-3-Clause */
/* Components of the pressure equation, and whether each has a level: a row that sees a known pressure, or volume that can change. Nearly always
 * all have one. Then one pass over the entries on all threads is enough: trees of joined rows, whose root is their lowest row. */
#include "levels.h"
#include <mps/exact.h>
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

/* Visit the component of row `seed`, breadth first; its rows stand in e->queue. Returns their number. */
static int64_t flood(mps__ppe *e, int64_t seed, bool *level)
{
    int32_t *queue = e->queue;
    int64_t count = 0;
    *level = false;
    queue[count++] = (int32_t)seed;
    e->component[seed] = -1;
    for (int64_t next = 0; next < count; next++) {
        const int32_t r = queue[next];
        *level = *level || e->shift[r] > 0;
        for (int64_t k = e->row[r]; k < e->row[r + 1]; k++)
            if (e->component[e->col[k]] == -2) {
                e->component[e->col[k]] = -1;
                queue[count++] = e->col[k];
            }
    }
    return count;
}

static double mean_of(const double *rhs, const int32_t *row, int64_t count)
{
    enum { BLOCK = 256 };
    double part[BLOCK];
    mps_exact sum = {{0}, 0, 0};
    for (int64_t lo = 0, n; lo < count; lo += n) {
        n = count - lo < BLOCK ? count - lo : BLOCK;
        for (int64_t k = 0; k < n; k++) part[k] = rhs[row[lo + k]];
        mps_exact_add(&sum, n, part);
    }
    return mps_exact_value(&sum) / (double)count;
}

int32_t mps__levels_find(mps__ppe *e, const mps_parallel *parallel)
{
    int32_t singular = 0;
    int64_t largest = 0;
    e->level_free = false;
    if (all_have_level(e, parallel)) return 0;
    for (int64_t r = 0; r < e->n; r++) e->component[r] = -2;
    for (int64_t seed = 0; seed < e->n; seed++) {
        if (e->component[seed] != -2) continue;
        bool level;
        const int64_t count = flood(e, seed, &level);
        if (count > largest) {
            largest = count;
            e->level_free = !level;
        }
        if (level) continue;
        const double mean = mean_of(e->rhs, e->queue, count);
        for (int64_t k = 0; k < count; k++) {
            e->rhs[e->queue[k]] -= mean;
            e->component[e->queue[k]] = singular;
        }
        singular++;
    }
    return singular;
}
