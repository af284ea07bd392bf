/* SPDX-License-Identifier: BSD-3-Clause */
/* Lock-free union-find over rows: the lowest row of a set is its own parent, other rows have a
 * lower parent. Parents are only replaced by lower rows, so that threads may work on one set
 * concurrently; the resulting sets do not depend on the order. */
#ifndef MPS_CORE_FOREST_H
#define MPS_CORE_FOREST_H

#include <mps/stage.h>
#include <stdbool.h>
#include <stdint.h>
#ifndef MPS_DEVICE
#include <stdatomic.h>
#endif

/* Numbers shared by threads. Device compilers support the atomic operations of C11 only as
 * functions. */
#ifdef MPS_DEVICE
typedef volatile int32_t mps__shared_number;

MPS_ROW int32_t mps__forest_get(const mps__shared_number *at)
{
    return *at;
}

MPS_ROW void mps__forest_put(mps__shared_number *at, int32_t value)
{
    *at = value;
}

MPS_ROW bool mps__forest_replace(mps__shared_number *at, int32_t before, int32_t value)
{
    return __sync_bool_compare_and_swap(at, before, value);
}
#else
typedef _Atomic int32_t mps__shared_number;

MPS_ROW int32_t mps__forest_get(const mps__shared_number *at)
{
    return atomic_load_explicit(at, memory_order_relaxed);
}

MPS_ROW void mps__forest_put(mps__shared_number *at, int32_t value)
{
    atomic_store_explicit(at, value, memory_order_relaxed);
}

MPS_ROW bool mps__forest_replace(mps__shared_number *at, int32_t before, int32_t value)
{
    return atomic_compare_exchange_strong(at, &before, value);
}
#endif

/* With path halving. */
MPS_ROW int32_t mps__forest_root(mps__shared_number *parents, int32_t r)
{
    int32_t parent = mps__forest_get(&parents[r]);
    while (parent != r) {
        const int32_t above = mps__forest_get(&parents[parent]);
        if (above != parent) mps__forest_put(&parents[r], above);
        r = parent;
        parent = above;
    }
    return r;
}

/* Merge the sets of rows r and c. */
MPS_ROW void mps__forest_join(mps__shared_number *parents, int32_t r, int32_t c)
{
    for (;;) {
        const int32_t a = mps__forest_root(parents, r), b = mps__forest_root(parents, c),
                      low = a < b ? a : b, high = a < b ? b : a;
        if (low == high || mps__forest_replace(&parents[high], high, low)) return;
    }
}

#endif
