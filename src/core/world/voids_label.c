/* SPDX-License-Identifier: BSD-3-Clause */
/* Components of the void. Deep cells are joined in the order of the cells; then the void grows into narrow ones. */
#include "voids.h"
#include <math.h>

static bool is_deep(const mps__voids *v, int64_t c)
{
    return c < v->band * v->plane ? v->what[c] == MPS__CELL_DEEP : !(v->mask[c] & MPS__MASK_SOLID);
}

/* A new provisional component. */
static mps_status begin_part(mps__voids *v, int32_t *part)
{
    MPS__TRY(mps__voids_push(v, &v->parent, &v->room.parent, v->parts));
    *part = v->parts;
    v->parent[v->parts] = v->parts;
    v->parts++;
    return MPS_OK;
}

/* ---- deep cells ---- */

/* Provisional component of a deep cell. The ullage above the band is number 0. */
static mps_status join_cell(mps__voids *v, int64_t c, const int32_t at[3])
{
    const int32_t up = v->dim - 1;
    int32_t own = -1;
    for (int32_t d = 0; d < v->dim; d++) {
        const int64_t b = at[d] > 0 ? c - v->step[d] : -1;
        if (b < 0 || v->label[b] < 0 || v->mask[b] >> d & 1) continue;
        if (own >= 0)
            mps__voids_join(v->parent, own, v->label[b]);
        else
            own = v->label[b];
    }
    if (own < 0) MPS__TRY(begin_part(v, &own));
    v->label[c] = own;
    if (at[up] + 1 == v->band && v->band < v->slabs && !(v->mask[c] >> up & 1) &&
        is_deep(v, c + v->plane))
        mps__voids_join(v->parent, own, 0);
    return MPS_OK;
}

static mps_status join_deep(mps__voids *v)
{
    int64_t c = 0;
    const int32_t lines = (int32_t)(v->plane / v->cells[0]);
    int32_t at[3];
    v->parts = 0;
    if (v->band < v->slabs) MPS__TRY(begin_part(v, &at[0]));
    for (int32_t z = 0; z < v->band; z++)
        for (int32_t y = 0; y < lines; y++) {
            at[1] = v->dim == 3 ? y : z;
            at[2] = v->dim == 3 ? z : 0;
            for (at[0] = 0; at[0] < v->cells[0]; at[0]++, c++) {
                v->label[c] = v->what[c] == MPS__CELL_SOLID ? MPS_VOID_SOLID : MPS_VOID_NONE;
                if (v->what[c] == MPS__CELL_DEEP) MPS__TRY(join_cell(v, c, at));
            }
        }
    return MPS_OK;
}

/* Components in the order of their first deep cells; `found` counts their cells. */
static mps_status count_deep(mps__voids *v)
{
    const int64_t room = v->parts + 1;
    MPS__TRY(mps__grow(v->context, (void **)&v->found, &v->room.found, 0, room, sizeof *v->found));
    MPS__TRY(
        mps__grow(v->context, (void **)&v->number, &v->room.number, 0, room, sizeof *v->number));
    MPS__TRY(mps__grow(v->context, (void **)&v->size, &v->room.size, 0, room, sizeof *v->size));
    int32_t *first = v->number; /* component of a provisional one, -1: none yet */
    for (int32_t k = 0; k < v->parts; k++) {
        first[k] = -1;
        v->found[k] = 0;
    }
    v->count = 0;
    for (int64_t c = 0; c < v->band * v->plane; c++) {
        if (v->label[c] < 0) continue;
        const int32_t root = mps__voids_root(v->parent, v->label[c]);
        if (first[root] < 0) first[root] = v->count++;
        v->label[c] = first[root];
        v->found[first[root]]++;
    }
    if (v->band == v->slabs || v->ullage[v->band] == 0) {
        v->ambient = -1;
        return MPS_OK;
    }
    const int32_t root = mps__voids_root(v->parent, 0);
    if (first[root] < 0) first[root] = v->count++;
    v->ambient = first[root];
    v->found[v->ambient] += v->ullage[v->band];
    return MPS_OK;
}

/* ---- narrow cells ---- */

static mps_status grow_into(mps__voids *v, int64_t c, int32_t label, int64_t *tail)
{
    MPS__TRY(mps__voids_push(v, &v->queue, &v->room.queue, *tail));
    v->queue[(*tail)++] = (int32_t)c;
    v->label[c] = label;
    v->found[label]++;
    return MPS_OK;
}

/* Narrow cells beside a deep one, in the order of the cells. */
static mps_status grow_first(mps__voids *v, int64_t *tail)
{
    for (int64_t c = 0; c < v->band * v->plane; c++) {
        int32_t at[3], label = -1;
        if (v->what[c] != MPS__CELL_NARROW) continue;
        mps__voids_place(v, c, at);
        for (int32_t side = 0; side < 2 * v->dim && label < 0; side++) {
            const int64_t b = mps__voids_beside(v, c, at, side);
            if (b < 0 || !is_deep(v, b)) continue;
            label = b < v->band * v->plane ? v->label[b] : v->ambient;
        }
        if (label >= 0) MPS__TRY(grow_into(v, c, label, tail));
    }
    return MPS_OK;
}

static mps_status grow_narrow(mps__voids *v)
{
    int64_t head = 0, tail = 0;
    MPS__TRY(grow_first(v, &tail));
    while (head < tail) {
        const int64_t c = v->queue[head++];
        int32_t at[3];
        mps__voids_place(v, c, at);
        for (int32_t side = 0; side < 2 * v->dim; side++) {
            const int64_t b = mps__voids_beside(v, c, at, side);
            if (b < 0 || b >= v->band * v->plane || v->what[b] != MPS__CELL_NARROW ||
                v->label[b] >= 0)
                continue;
            MPS__TRY(grow_into(v, b, v->label[c], &tail));
        }
    }
    return MPS_OK;
}

/* ---- numbers ---- */

/* The largest component is number 0, the others follow in their order; small ones are none. @return whether a number changed */
static bool number_all(mps__voids *v)
{
    const double least = v->config.least / pow(v->config.side, v->dim);
    int32_t largest = 0, count = 0;
    bool changed = false;
    for (int32_t k = 1; k < v->count; k++)
        if (v->found[k] > v->found[largest]) largest = k;
    const bool any = v->count > 0 && (double)v->found[largest] >= least;
    if (any) v->size[count++] = (int32_t)v->found[largest];
    for (int32_t k = 0; k < v->count; k++) {
        const bool kept = (double)v->found[k] >= least, is_largest = any && k == largest;
        v->number[k] = is_largest ? 0 : kept ? count : MPS_VOID_NONE;
        if (kept && !is_largest) v->size[count++] = (int32_t)v->found[k];
        changed = changed || v->number[k] != k;
    }
    v->count = count;
    return changed;
}

/* Cells above the band, unless they have their labels from an earlier search. */
static void fill_above(mps__voids *v)
{
    const int64_t end = (v->constant < v->slabs ? v->constant : v->slabs) * v->plane;
    for (int64_t c = v->band * v->plane; c < end; c++)
        v->label[c] = v->mask[c] & MPS__MASK_SOLID ? MPS_VOID_SOLID : v->ambient;
    v->constant = v->band;
}

mps_status mps__voids_label(mps__voids *v)
{
    const int32_t before = v->ambient;
    MPS__TRY(join_deep(v));
    MPS__TRY(count_deep(v));
    MPS__TRY(grow_narrow(v));
    if (number_all(v)) {
        for (int64_t c = 0; c < v->band * v->plane; c++)
            if (v->label[c] >= 0) v->label[c] = v->number[v->label[c]];
        if (v->ambient >= 0) v->ambient = v->number[v->ambient];
    }
    if (v->ambient != before) v->constant = INT32_MAX;
    fill_above(v);
    return MPS_OK;
}
