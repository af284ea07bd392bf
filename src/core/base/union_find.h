/* SPDX-License-Identifier: BSD-3-Clause */
/* Lock-free union-find over rows: the lowest row of a set is its own parent, other rows have a
 * lower parent. Parents are only replaced by lower rows, so that threads may work on one set
 * concurrently; the resulting sets do not depend on the order. */
#ifndef MPS_CORE_UNION_FIND_H
#define MPS_CORE_UNION_FIND_H

#include <mps/stage.h>
#include <stdbool.h>
#include <stdint.h>
#ifndef MPS_DEVICE
#include <stdatomic.h>
#endif

/* Numbers shared by threads. Device compilers support the atomic operations of C11 only as
 * functions. */
#ifdef MPS_DEVICE
typedef volatile int32_t mps__atomic_number;

MPS_ROW int32_t mps__atomic_get(const mps__atomic_number *at)
{
    return *at;
}

MPS_ROW void mps__atomic_put(mps__atomic_number *at, int32_t value)
{
    *at = value;
}

MPS_ROW bool mps__atomic_replace(mps__atomic_number *at, int32_t before, int32_t value)
{
    return __sync_bool_compare_and_swap(at, before, value);
}
#else
typedef _Atomic int32_t mps__atomic_number;

MPS_ROW int32_t mps__atomic_get(const mps__atomic_number *at)
{
    return atomic_load_explicit(at, memory_order_relaxed);
}

MPS_ROW void mps__atomic_put(mps__atomic_number *at, int32_t value)
{
    atomic_store_explicit(at, value, memory_order_relaxed);
}

MPS_ROW bool mps__atomic_replace(mps__atomic_number *at, int32_t before, int32_t value)
{
    return atomic_compare_exchange_strong(at, &before, value);
}
#endif

/* With path halving. */
MPS_ROW int32_t mps__union_find(mps__atomic_number *parents, int32_t r)
{
    int32_t parent = mps__atomic_get(&parents[r]);
    while (parent != r) {
        const int32_t above = mps__atomic_get(&parents[parent]);
        if (above != parent) mps__atomic_put(&parents[r], above);
        r = parent;
        parent = above;
    }
    return r;
}

/* Merge the sets of rows r and c. */
MPS_ROW void mps__union_join(mps__atomic_number *parents, int32_t r, int32_t c)
{
    for (;;) {
        const int32_t a = mps__union_find(parents, r), b = mps__union_find(parents, c),
                      low = a < b ? a : b, high = a < b ? b : a;
        if (low == high || mps__atomic_replace(&parents[high], high, low)) return;
    }
}

#endif
