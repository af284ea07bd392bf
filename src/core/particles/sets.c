/* SPDX-License-Identifier: BSD-3-Clause */
/* Parts of sets are collected from all ranks, sorted by label and merged; all ranks do this with
 * the same lists. */
#include "sets.h"
#include <stdlib.h>

void mps__sets_begin(mps__sets *s, mps__context *context)
{
    s->context = context;
    s->count = s->parts = s->pairs = 0;
}

void mps__sets_free(mps__sets *s)
{
    void *all[] = {s->list, s->part, s->set, s->pair};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) mps__free(s->context, all[k]);
    *s = (mps__sets){.context = s->context};
}

mps_status mps__sets_add(mps__sets *s, const mps__set *part)
{
    MPS__TRY(mps__grow(s->context, (void **)&s->part, &s->part_capacity, s->parts, s->parts + 1,
                       sizeof *s->part));
    s->part[s->parts++] = *part;
    return MPS_OK;
}

mps_status mps__sets_join(mps__sets *s, int64_t a, int64_t b)
{
    /* consecutive pairs mostly repeat */
    if (s->pairs > 0 && s->pair[s->pairs - 1][0] == a && s->pair[s->pairs - 1][1] == b)
        return MPS_OK;
    MPS__TRY(mps__grow(s->context, (void **)&s->pair, &s->pair_capacity, s->pairs, s->pairs + 1,
                       sizeof *s->pair));
    s->pair[s->pairs][0] = a;
    s->pair[s->pairs++][1] = b;
    return MPS_OK;
}

static int by_label(const void *a, const void *b)
{
    const int64_t x = ((const mps__set *)a)->label, y = ((const mps__set *)b)->label;
    return (x > y) - (x < y);
}

static int64_t place_of(const mps__sets *s, int64_t label)
{
    int64_t lo = 0, hi = s->parts - 1;
    while (lo < hi) {
        const int64_t middle = lo + (hi - lo) / 2;
        if (s->part[middle].label < label)
            lo = middle + 1;
        else
            hi = middle;
    }
    return lo;
}

static int32_t root_of(int32_t *parent, int32_t k)
{
    while (parent[k] != k) k = parent[k] = parent[parent[k]];
    return k;
}

/* The representative of a set is the part with the least label. */
static void join_parts(const mps__sets *s)
{
    for (int64_t k = 0; k < s->parts; k++) s->set[k] = (int32_t)k;
    for (int64_t k = 0; k < s->pairs; k++) {
        const int32_t a = root_of(s->set, (int32_t)place_of(s, s->pair[k][0])),
                      b = root_of(s->set, (int32_t)place_of(s, s->pair[k][1]));
        s->set[a < b ? b : a] = a < b ? a : b;
    }
}

/* Sets in the order of their labels: a representative precedes its other parts. */
static mps_status list_sets(mps__sets *s)
{
    MPS__TRY(
        mps__grow(s->context, (void **)&s->list, &s->list_capacity, 0, s->parts, sizeof *s->list));
    s->count = 0;
    for (int64_t k = 0; k < s->parts; k++) {
        const int32_t root = root_of(s->set, (int32_t)k);
        if (root == k) {
            s->list[s->count] = s->part[k];
            s->list[s->count].number = s->part[k].number = (int32_t)s->count;
            s->count++;
            continue;
        }
        mps__set *set = &s->list[s->part[root].number];
        s->part[k].number = set->number;
        set->rows += s->part[k].rows;
        set->flags |= s->part[k].flags;
        mps_exact_join(&set->sum, &s->part[k].sum);
    }
    return MPS_OK;
}

mps_status mps__sets_merge(mps__sets *s, mps__ranks *r)
{
    if (mps__ranks_many(r)) {
        MPS__TRY(mps__ranks_collect(r, (void **)&s->part, &s->parts, sizeof *s->part));
        MPS__TRY(mps__ranks_collect(r, (void **)&s->pair, &s->pairs, sizeof *s->pair));
        s->part_capacity = s->parts;
        s->pair_capacity = s->pairs;
    }
    if (s->parts > 0) qsort(s->part, (size_t)s->parts, sizeof *s->part, by_label);
    MPS__TRY(
        mps__grow(s->context, (void **)&s->set, &s->set_capacity, 0, s->parts, sizeof *s->set));
    join_parts(s);
    return list_sets(s);
}

const mps__set *mps__sets_find(const mps__sets *s, int64_t label)
{
    return &s->list[s->part[place_of(s, label)].number];
}
