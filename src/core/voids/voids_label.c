/* SPDX-License-Identifier: BSD-3-Clause */
/* Components of the void. Runs of deep cells along a line are joined in the order of the cells;
 * then the components grow into narrow cells. */
#include "world.h"
#include <string.h>

/* A new provisional component. */
static mps_status begin_part(mps__voids *v, int32_t *part)
{
    const int64_t capacity = v->parts;
    MPS__TRY(mps__voids_push(v, &v->parent, &v->capacity.parent, capacity));
    if (capacity >= v->capacity.found)
        MPS__TRY(mps__grow(v->context, (void **)&v->found, &v->capacity.found, capacity,
                           2 * capacity + 64, sizeof *v->found));
    *part = v->parts;
    v->parent[capacity] = *part;
    v->found[capacity] = 0;
    v->parts++;
    return MPS_OK;
}

/* ---- runs of deep cells ---- */

/* Whether a run is connected to another one in the line `step` cells before; axis d is across. */
static bool touches(const mps__voids *v, const mps__void_run *a, const mps__void_run *b,
                    int64_t step, int32_t d)
{
    const int64_t begin = a->begin > b->begin + step ? a->begin : b->begin + step,
                  end = a->end < b->end + step ? a->end : b->end + step;
    if (begin >= end || !(v->marks[(begin - step) / v->cells[0]] & MPS__MASK_PLATE))
        return begin < end;
    for (int64_t c = begin; c < end; c++)
        if (!(v->mask[c - step] >> d & 1)) return true;
    return false;
}

/* Join runs first .. last-1 of a line with those of the previous line along axis d, which begin at
 * `other`. */
static void join_lines(mps__voids *v, int64_t first, int64_t last, int64_t other, int32_t d)
{
    const int64_t step = v->step[d];
    for (int64_t k = first; k < last; k++) {
        mps__void_run *r = &v->run[k];
        while (other < first && v->run[other].end + step <= r->begin) other++;
        for (int64_t o = other; o < first && v->run[o].begin + step < r->end; o++) {
            if (!touches(v, r, &v->run[o], step, d)) continue;
            if (r->part < 0)
                r->part = v->run[o].part;
            else
                mps__voids_join(v->parent, r->part, v->run[o].part);
        }
    }
}

/* The first cell from `from` on that is not deep, or `end`. Tests eight cells at once, as runs are
 * long. */
static const uint8_t *end_of_deep(const uint8_t *from, const uint8_t *end)
{
    static const uint64_t deep = MPS__CELL_DEEP * UINT64_C(0x0101010101010101);
    for (uint64_t eight; end - from >= 8; from += 8) {
        memcpy(&eight, from, sizeof eight);
        if (eight != deep) break;
    }
    while (from < end && *from == MPS__CELL_DEEP) from++;
    return from;
}

static mps_status find_runs(mps__voids *v, int64_t begin)
{
    const int64_t end = begin + v->cells[0];
    const uint8_t *what = v->what, *next = what + begin;
    const bool cut = v->marks[begin / v->cells[0]] & MPS__MASK_PLATE;
    while ((next = memchr(next, MPS__CELL_DEEP, (size_t)(what + end - next))) != NULL) {
        mps__void_run r = {(int32_t)(next - what), (int32_t)(next - what) + 1, -1};
        if (cut)
            while (r.end < end && what[r.end] == MPS__CELL_DEEP && !(v->mask[r.end - 1] & 1))
                r.end++;
        else
            r.end = (int32_t)(end_of_deep(next, what + end) - what);
        if (v->runs >= v->capacity.run)
            MPS__TRY(mps__grow(v->context, (void **)&v->run, &v->capacity.run, v->runs,
                               2 * v->runs + 64, sizeof *v->run));
        v->run[v->runs++] = r;
        next = what + r.end;
    }
    return MPS_OK;
}

/* Join with the void above the band, which is number 0. */
static void join_above(mps__voids *v, const mps__void_run *r)
{
    for (int64_t c = r->begin; c < r->end; c++)
        if (!(v->mask[c + v->plane] & MPS__MASK_SOLID) && !(v->mask[c] >> (v->dim - 1) & 1)) {
            mps__voids_join(v->parent, r->part, 0);
            return;
        }
}

/* First run that ends after a cell. */
static int64_t run_behind(const mps__voids *v, int64_t cell)
{
    int64_t low = 0, high = v->runs;
    while (low < high) {
        const int64_t k = (low + high) / 2;
        if (v->run[k].end > cell)
            high = k;
        else
            low = k + 1;
    }
    return low;
}

static mps_status join_line(mps__voids *v, int64_t begin, int32_t y, int32_t z)
{
    const int32_t up = v->dim - 1;
    const int64_t first = v->runs;
    MPS__TRY(find_runs(v, begin));
    if (v->dim == 3 && y > 0) join_lines(v, first, v->runs, run_behind(v, begin - v->step[1]), 1);
    if (z > 0) join_lines(v, first, v->runs, run_behind(v, begin - v->plane), up);
    for (int64_t k = first; k < v->runs; k++) {
        mps__void_run *r = &v->run[k];
        if (r->part < 0) MPS__TRY(begin_part(v, &r->part));
        v->found[r->part] += r->end - r->begin;
        if (z + 1 == v->band && v->band < v->slabs) join_above(v, r);
    }
    return MPS_OK;
}

static mps_status join_deep(mps__voids *v)
{
    const int32_t lines = (int32_t)(v->plane / v->cells[0]);
    int32_t above;
    v->parts = 0;
    v->runs = 0;
    if (v->band < v->slabs) {
        MPS__TRY(begin_part(v, &above));
        v->found[above] = v->ullage[v->band];
    }
    for (int32_t z = 0; z < v->band; z++)
        for (int32_t y = 0; y < lines; y++)
            MPS__TRY(join_line(v, z * v->plane + y * (int64_t)v->cells[0], y, z));
    return MPS_OK;
}

/* ---- numbers ---- */

/* Add the cells of provisional components to their representatives. @return the largest */
static int32_t collect_parts(mps__voids *v)
{
    int32_t largest = -1;
    for (int32_t k = 0; k < v->parts; k++) {
        const int32_t root = mps__voids_root(v->parent, k);
        if (root != k) v->found[root] += v->found[k];
    }
    for (int32_t k = 0; k < v->parts; k++)
        if (v->parent[k] == k && (largest < 0 || v->found[k] > v->found[largest])) largest = k;
    return largest;
}

/* The largest is number 0, the others are numbered in the order of their first cells; small ones
 * get none. */
static mps_status number_parts(mps__voids *v)
{
    const double least = fmax(1, v->config.least / mps_pow(v->config.side, v->dim));
    const int32_t largest = collect_parts(v);
    mps__void_capacity *r = &v->capacity;
    MPS__TRY(
        mps__grow(v->context, (void **)&v->number, &r->number, 0, v->parts + 1, sizeof *v->number));
    MPS__TRY(mps__grow(v->context, (void **)&v->size, &r->size, 0, v->parts + 1, sizeof *v->size));
    for (int32_t k = 0; k < v->parts; k++) v->number[k] = INT32_MIN;
    v->count = 0;
    if (largest >= 0 && (double)v->found[largest] >= least) {
        v->number[largest] = 0;
        v->size[v->count++] = (int32_t)v->found[largest];
    }
    /* the void above the band, number 0, has its first cell in the band if it extends into it */
    for (int32_t i = 1; i <= v->parts; i++) {
        const int32_t k = i % v->parts, root = mps__voids_root(v->parent, k);
        if (v->number[root] == INT32_MIN) {
            const bool kept = (double)v->found[root] >= least;
            v->number[root] = kept ? v->count : MPS_VOID_NONE;
            if (kept) v->size[v->count++] = (int32_t)v->found[root];
        }
    }
    for (int32_t k = 0; k < v->parts; k++) v->number[k] = v->number[mps__voids_root(v->parent, k)];
    v->ambient = v->band < v->slabs ? v->number[0] : -1;
    return MPS_OK;
}

/* Labels of the band before narrow cells are labelled. */
static void label_runs(mps__voids *v)
{
    for (int64_t line = 0; line < v->band * v->plane / v->cells[0]; line++) {
        const int64_t begin = line * v->cells[0];
        int32_t *label = v->label + begin;
        if (!(v->marks[line] & MPS__MASK_SOLID))
            memset(label, 0xff, (size_t)v->cells[0] * sizeof *label);
        else
            for (int64_t c = 0; c < v->cells[0]; c++)
                label[c] = v->mask[begin + c] & MPS__MASK_SOLID ? MPS_VOID_SOLID : MPS_VOID_NONE;
    }
    for (int64_t k = 0; k < v->runs; k++) {
        const int32_t number = v->number[v->run[k].part];
        if (number < 0) continue;
        for (int64_t c = v->run[k].begin; c < v->run[k].end; c++) v->label[c] = number;
    }
}

/* ---- narrow cells ---- */

static mps_status grow_into(mps__voids *v, int64_t c, int32_t label, int64_t *tail)
{
    MPS__TRY(mps__voids_push(v, &v->queue, &v->capacity.queue, *tail));
    v->queue[(*tail)++] = (int32_t)c;
    v->label[c] = label;
    v->size[label]++;
    return MPS_OK;
}

/* Mark cells of a slab that are not deep and have a deep neighbour. */
static void mark_border(const mps__voids *v, int32_t z, uint8_t *border)
{
    const uint8_t *what = v->what + z * v->plane;
    const int64_t n = v->plane, step[3] = {v->step[0], v->dim == 3 ? v->step[1] : n, n};
    memset(border, 0, (size_t)n);
    for (int32_t d = 0; d < v->dim; d++)
        for (int side = -1; side <= 1; side += 2) {
            const bool across = d == v->dim - 1;
            const int64_t by = side * step[d], begin = !across && by < 0 ? -by : 0,
                          end = !across && by > 0 ? n - by : n;
            if (across && (z + side < 0 || z + side >= v->band)) continue;
            for (int64_t c = begin; c < end; c++) border[c] |= what[c + by] == MPS__CELL_DEEP;
        }
    for (int64_t c = 0; c < n; c++)
        border[c] &= what[c] == MPS__CELL_COVERED || what[c] == MPS__CELL_NARROW;
}

/* The component of the first deep neighbour, -1: none. */
static int32_t label_beside(const mps__voids *v, int64_t c)
{
    int32_t at[3];
    mps__voids_place(v, c, at);
    for (int32_t side = 0; side < 2 * v->dim; side++) {
        const int64_t b = mps__voids_beside(v, c, at, side);
        if (b >= 0 && b < v->band * v->plane && v->what[b] == MPS__CELL_DEEP && v->label[b] >= 0)
            return v->label[b];
    }
    return -1;
}

static mps_status grow_first(mps__voids *v, const mps__world *w, int64_t *tail)
{
    uint8_t *border = v->wide; /* free at this point */
    for (int32_t z = 0; z < v->band; z++) {
        const uint8_t *next = border, *end = border + v->plane;
        mark_border(v, z, border);
        for (; (next = memchr(next, 1, (size_t)(end - next))) != NULL; next++) {
            const int64_t c = z * v->plane + (next - border);
            const int32_t label = label_beside(v, c);
            if (label >= 0 && mps__voids_is_narrow(v, w, c)) MPS__TRY(grow_into(v, c, label, tail));
        }
    }
    return MPS_OK;
}

static mps_status grow_narrow(mps__voids *v, const mps__world *w)
{
    int64_t head = 0, tail = 0;
    MPS__TRY(grow_first(v, w, &tail));
    while (head < tail) {
        const int64_t c = v->queue[head++];
        int32_t at[3];
        mps__voids_place(v, c, at);
        for (int32_t side = 0; side < 2 * v->dim; side++) {
            const int64_t b = mps__voids_beside(v, c, at, side);
            if (b < 0 || b >= v->band * v->plane || v->label[b] != MPS_VOID_NONE ||
                v->what[b] == MPS__CELL_DEEP || !mps__voids_is_narrow(v, w, b))
                continue;
            MPS__TRY(grow_into(v, b, v->label[c], &tail));
        }
    }
    return MPS_OK;
}

/* Label cells above the band, unless an earlier search has done so. */
static void fill_above(mps__voids *v)
{
    const int64_t end = (v->constant < v->slabs ? v->constant : v->slabs) * v->plane;
    for (int64_t c = v->band * v->plane; c < end; c++)
        v->label[c] = v->mask[c] & MPS__MASK_SOLID ? MPS_VOID_SOLID : v->ambient;
    v->constant = v->band;
}

mps_status mps__voids_label(mps__voids *v, const mps__world *w)
{
    const int32_t before = v->ambient;
    MPS__TRY(join_deep(v));
    MPS__TRY(number_parts(v));
    label_runs(v);
    if (v->count > 1) MPS__TRY(grow_narrow(v, w));
    if (v->ambient != before) v->constant = INT32_MAX;
    fill_above(v);
    return MPS_OK;
}
