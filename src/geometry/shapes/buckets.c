/* SPDX-License-Identifier: BSD-3-Clause */
/* Points in cells: one list per cell, linked through the points. */
#include "buckets.h"
#include <math.h>
#include <mps/numbers.h>
#include <string.h>

/* Largest number of cells; beyond it cells are made larger. */
static const double most_cells = 1 << 24;

static int64_t cell_along(const mps__buckets *b, int d, double x)
{
    const double k = floor((x - b->lo[d]) * b->over);
    if (!(k > 0)) return 0;
    return k < (double)(b->cells[d] - 1) ? (int64_t)k : b->cells[d] - 1;
}

static int64_t cell_of(const mps__buckets *b, const int64_t k[3])
{
    return k[0] + b->cells[0] * (k[1] + b->cells[1] * k[2]);
}

/* Number of cells of a box; a side shorter than a cell counts as one. */
static double cells_of(int32_t dim, const double *lo, const double *hi, double side)
{
    double cells = 1;
    for (int d = 0; d < dim; d++) cells *= fmax((hi[d] - lo[d]) / side, 1.0);
    return cells;
}

mps_status mps__buckets_init(mps__buckets *b, mps__context *context, int32_t dim, const double *lo,
                             const double *hi, double side)
{
    *b = (mps__buckets){.context = context, .dim = dim, .cells = {1, 1, 1}};
    for (int d = 0; d < dim; d++)
        MPS__CHECK(context, isfinite(hi[d] - lo[d]),
                   "a box of %g .. %g m along axis %d: must be finite", lo[d], hi[d], d);
    const double cells = cells_of(dim, lo, hi, side);
    if (cells > most_cells) side *= mps_pow(cells / most_cells, 1.0 / dim);
    /* a long and thin box whose short sides have one cell */
    while (cells_of(dim, lo, hi, side) > 2 * most_cells) side *= 2;
    b->over = 1.0 / side;
    for (int d = 0; d < dim; d++) {
        b->lo[d] = lo[d];
        b->cells[d] = 1 + (int64_t)fmin(fmax((hi[d] - lo[d]) * b->over, 0.0), 2 * most_cells);
    }
    b->head = mps__alloc(context, b->cells[0] * b->cells[1] * b->cells[2], sizeof *b->head);
    return b->head ? MPS_OK : MPS_E_NOMEM;
}

void mps__buckets_free(mps__buckets *b)
{
    if (!b->context) return;
    mps__free(b->context, b->head);
    mps__free(b->context, b->next);
    mps__free(b->context, b->x);
    *b = (mps__buckets){0};
}

mps_status mps__buckets_reserve(mps__buckets *b, int64_t count)
{
    MPS__CHECK(b->context, count < INT32_MAX, "%lld points: at most %d", (long long)count,
               INT32_MAX - 1);
    MPS__TRY(
        mps__grow(b->context, (void **)&b->next, &b->capacity, b->count, count, sizeof *b->next));
    return mps__grow(b->context, (void **)&b->x, &b->x_capacity, 3 * b->count, 3 * count,
                     sizeof *b->x);
}

mps_status mps__buckets_add(mps__buckets *b, const double x[3])
{
    const int64_t i = b->count;
    MPS__TRY(mps__buckets_reserve(b, i + 1));
    int64_t k[3] = {0, 0, 0};
    for (int d = 0; d < b->dim; d++) k[d] = cell_along(b, d, x[d]);
    const int64_t cell = cell_of(b, k);
    memcpy(b->x + 3 * i, x, 3 * sizeof *x);
    b->next[i] = b->head[cell];
    b->head[cell] = (int32_t)(i + 1);
    b->count++;
    return MPS_OK;
}

static void visit_cell(const mps__buckets *b, const double x[3], double reach2, int64_t cell,
                       mps__buckets_fn fn, void *user)
{
    for (int32_t p = b->head[cell]; p > 0; p = b->next[p - 1]) {
        double d[3], r2 = 0;
        for (int a = 0; a < 3; a++) {
            d[a] = b->x[3 * (int64_t)(p - 1) + a] - x[a];
            r2 += d[a] * d[a];
        }
        if (r2 < reach2) fn(user, p - 1, d, r2);
    }
}

void mps__buckets_visit(const mps__buckets *b, const double x[3], double reach, mps__buckets_fn fn,
                        void *user)
{
    int64_t first[3] = {0, 0, 0}, last[3] = {0, 0, 0}, k[3];
    for (int d = 0; d < b->dim; d++) {
        first[d] = cell_along(b, d, x[d] - reach);
        last[d] = cell_along(b, d, x[d] + reach);
    }
    for (k[2] = first[2]; k[2] <= last[2]; k[2]++)
        for (k[1] = first[1]; k[1] <= last[1]; k[1]++)
            for (k[0] = first[0]; k[0] <= last[0]; k[0]++)
                visit_cell(b, x, reach * reach, cell_of(b, k), fn, user);
}

/* The nearest point so far. */
typedef struct nearest {
    int64_t point;
    double r2;
} nearest;

static void keep_nearest(void *user, int64_t point, const double d[3], double r2)
{
    nearest *n = user;
    (void)d;
    if (r2 < n->r2 || (r2 == n->r2 && point < n->point)) *n = (nearest){point, r2};
}

int64_t mps__buckets_nearest(const mps__buckets *b, const double x[3], double reach, double *r)
{
    nearest n = {-1, INFINITY};
    mps__buckets_visit(b, x, reach, keep_nearest, &n);
    if (r) *r = sqrt(n.r2);
    return n.point;
}
