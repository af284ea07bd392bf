/* SPDX-License-Identifier: BSD-3-Clause */
/* Merge several sorted runs into one: the new index of an element is its index in its own run plus
 * the number of smaller elements in each other run. */
#include "sort.h"
#include "loop.h"

enum { WAYS = 4 };

MPS_ROW int64_t tie(const mps__sorting *s, int64_t a)
{
    return s->id ? s->id[s->order[a]] : s->order[a];
}

/* Number of elements of a run that precede element a. */
MPS_ROW int64_t count_before(const mps__sorting *s, int64_t a, int64_t run)
{
    const int64_t begin = run * s->run < s->n ? run * s->run : s->n,
                  end = begin + s->run < s->n ? begin + s->run : s->n;
    const uint64_t key = s->key[a];
    const int64_t own = tie(s, a);
    int64_t lo = begin, hi = end;
    while (lo < hi) {
        const int64_t b = lo + (hi - lo) / 2;
        const uint64_t other = s->key[b];
        if (other < key || (other == key && tie(s, b) < own))
            lo = b + 1;
        else
            hi = b;
    }
    return lo - begin;
}

MPS_ROW void merge_row(const mps__sorting *s, int64_t a)
{
    const int64_t own = a / s->run, first = own - own % WAYS;
    int64_t to = first * s->run + a % s->run;
    for (int64_t run = first; run < first + WAYS; run++)
        if (run != own) to += count_before(s, a, run);
    s->new_key[to] = s->key[a];
    s->new_order[to] = s->order[a];
}
MPS__LOOP_ANY(merge_rows, merge_row, mps__sorting)

void mps__merge_sort(const mps_parallel *p, mps__sorting *s)
{
    for (; s->run < s->n; s->run *= WAYS) {
        mps__loop_run(p, &merge_rows, MPS__ANY_DIM, s->n, s);
        const mps__sorting from = *s;
        s->key = from.new_key;
        s->order = from.new_order;
        s->new_key = (uint64_t *)from.key;
        s->new_order = (int32_t *)from.order;
    }
}
