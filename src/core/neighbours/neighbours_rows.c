/* SPDX-License-Identifier: BSD-3-Clause */
/* Exact rows at the present positions from the candidates of the last search; occlusion. */
#include "neighbours_rows.h"
#include "loop.h"
#include "scan.h"
#include <math.h>

/* Pairs nearer than this [dp] have no direction and are skipped: they are the two faces of a thin
 * plate. */
static const double coincident = 1e-6;

mps__rings mps__rings_of(const mps_neighbours *l)
{
    return (mps__rings){coincident * coincident * l->dp * l->dp, l->re_near * l->re_near,
                        l->re_far * l->re_far};
}

void mps__sort_row(int32_t *row, int64_t n)
{
    for (int64_t k = 1; k < n; k++) {
        int32_t v = row[k];
        int64_t j = k;
        for (; j > 0 && row[j - 1] > v; j--) row[j] = row[j - 1];
        row[j] = v;
    }
}

/* What exact rows use: the list, and a workspace for rows that exceed the stack buffer. */
typedef struct exact {
    mps__rings rings;
    const double *x;
    const int64_t *begin;
    const int32_t *count;
    int64_t *middle, *end;
    int32_t *col;
    int64_t n, longest; /* particles; candidates of the longest such row */
    double *scratch;    /* [MPS__PARTS * 2 longest] */
} exact;

/* Squared distances of i to some candidates. @return whether all are in [least, most) */
MPS_ROW bool measure(const int dim, const double *x, int64_t i, const int32_t *row, int64_t count,
                     const double ring[2], double *r2)
{
    const double *const at = x + i * dim;
    double nearest = INFINITY, farthest = 0;
    for (int64_t k = 0; k < count; k++) {
        const double d2 = mps__square_between(at, x + (int64_t)row[k] * dim, dim);
        r2[k] = d2;
        nearest = d2 < nearest ? d2 : nearest;
        farthest = d2 > farthest ? d2 : farthest;
    }
    return nearest >= ring[0] && farthest < ring[1];
}

/* Squared distances of i to all candidates. @return whether each is still in its part, so that the
 * row is unchanged */
MPS_ROW bool row_stands(const int dim, const exact *l, int64_t i, double *r2)
{
    const mps__rings *g = &l->rings;
    const int32_t *row = l->col + l->begin[i];
    const int64_t nears = l->middle[i] - l->begin[i], within = l->end[i] - l->begin[i];
    const double near[2] = {g->least, g->near2}, far[2] = {g->near2, g->far2},
                 out[2] = {g->far2, INFINITY};
    const bool near_stand = measure(dim, l->x, i, row, nears, near, r2);
    const bool far_stand = measure(dim, l->x, i, row + nears, within - nears, far, r2 + nears);
    const bool out_stand = measure(dim, l->x, i, row + within, l->count[i] - within, out,
                                   r2 + within);
    return near_stand && far_stand && out_stand;
}

/* Workspace of a row. */
typedef struct workspace {
    double *r2;
    int32_t *far, *out;
} workspace;

/* Few candidates have changed their part since the last step, so that the insertion sort is
 * cheap. */
MPS_ROW void part_again(const int dim, const exact *l, int64_t i, const workspace *r)
{
    if (row_stands(dim, l, i, r->r2)) return;
    int32_t *const row = l->col + l->begin[i];
    const mps__parted parted = mps__part_row(&l->rings, row, r->r2, l->count[i], row, r->far,
                                             r->out);
    mps__sort_row(row, parted.near);
    mps__sort_row(row + parted.near, parted.far);
    l->middle[i] = l->begin[i] + parted.near;
    l->end[i] = l->middle[i] + parted.far;
}

#ifdef MPS_DEVICE
/* A device has no buffers: each candidate is inserted into its part in place. Most do not move. */

MPS_ROW int ring_of(const int dim, const exact *l, int64_t i, int32_t j)
{
    return mps__ring_of(&l->rings,
                        mps__square_between(l->x + i * dim, l->x + (int64_t)j * dim, dim));
}

MPS_ROW void exact_row(const int dim, const exact *l, int64_t i)
{
    int32_t *const row = l->col + l->begin[i];
    int64_t nears = 0, fars = 0;
    if (l->count[i] > MPS__ROW) return;
    for (int64_t k = 0; k < l->count[i]; k++) {
        const int32_t j = row[k];
        const int ring = ring_of(dim, l, i, j);
        int64_t to = k;
        for (; to > 0; to--) {
            const int before = ring_of(dim, l, i, row[to - 1]);
            if (before < ring || (before == ring && (ring == 2 || row[to - 1] < j))) break;
            row[to] = row[to - 1];
        }
        row[to] = j;
        nears += ring == 0;
        fars += ring == 1;
    }
    if (l->count[i] == 0) return;
    l->middle[i] = l->begin[i] + nears;
    l->end[i] = l->middle[i] + fars;
}
#else
MPS_ROW void exact_row(const int dim, const exact *l, int64_t i)
{
    double r2[MPS__ROW];
    int32_t far[MPS__ROW], out[MPS__ROW];
    if (l->count[i] > 0 && l->count[i] <= MPS__ROW)
        part_again(dim, l, i, &(workspace){r2, far, out});
}
#endif
MPS__LOOP(exact_rows, exact_row, exact)

/* Rows that exceed the stack buffer, of one of MPS__PARTS parts of the particles. */
MPS_ROW void exact_part(const int dim, const exact *l, int64_t part)
{
    double *const r2 = l->scratch + 2 * l->longest * part;
    int32_t *const far = (int32_t *)(void *)(r2 + l->longest), *const out = far + l->longest;
    for (int64_t i = l->n * part / MPS__PARTS; i < l->n * (part + 1) / MPS__PARTS; i++)
        if (l->count[i] > MPS__ROW) part_again(dim, l, i, &(workspace){r2, far, out});
}
MPS__LOOP(exact_parts, exact_part, exact)

static exact exact_of(const mps_neighbours *l)
{
    return (exact){.rings = mps__rings_of(l),
                   .x = l->x,
                   .begin = l->begin,
                   .count = l->count,
                   .middle = l->middle,
                   .end = l->end,
                   .col = l->col,
                   .n = l->n,
                   .longest = l->longest,
                   .scratch = l->scratch};
}

mps_status mps__neighbours_part_long(mps_neighbours *l)
{
    MPS__TRY(mps__neighbours_fit(l, (void **)&l->scratch, &l->scratch_capacity,
                                 MPS__PARTS * 2 * l->longest, sizeof *l->scratch));
    const exact rows = exact_of(l);
    mps__loop_run_long(l->parallel, &exact_parts, l->dim, MPS__PARTS, &rows);
    return MPS_OK;
}

/* Occlusion in the rows of near-plate particles. */
typedef struct hiding {
    const mps__occluder *list;
    int32_t occluders;
    const mps__near_plate *near_plate;
    const int32_t *slot;
    const int64_t *begin;
    int64_t *middle, *end;
    int32_t *col;
} hiding;

/* Swap the visible pairs of from..to-1 with those from `out` on, in order. @return the end of the
 * visible ones */
static int64_t keep_visible(const hiding *l, const mps__near_plate *a, int64_t from, int64_t to,
                            int64_t out)
{
    for (int64_t k = from; k < to; k++) {
        const int32_t j = l->col[k], slot = l->slot[j];
        if (slot >= 0 && mps__occluders_hidden(l->list, l->occluders, a, &l->near_plate[slot]))
            continue;
        l->col[k] = l->col[out];
        l->col[out++] = j;
    }
    return out;
}

/* Move occluded pairs behind the others. */
MPS_ROW void hide_row(const hiding *l, int64_t k)
{
    const mps__near_plate *a = &l->near_plate[k];
    const int64_t i = a->particle, middle = l->middle[i], last = l->end[i];
    l->middle[i] = keep_visible(l, a, l->begin[i], middle, l->begin[i]);
    l->end[i] = keep_visible(l, a, middle, last, l->middle[i]);
}
MPS__LOOP_ANY(hide_rows, hide_row, hiding)

void mps__neighbours_hide_device(const mps_neighbours *l, const mps__row_arrays *on_device)
{
    const mps__occluders *s = l->occluders;
    if (!s || s->count == 0) return;
    mps__loop_run(l->parallel, &hide_rows, l->dim, s->near_plates,
                  &(hiding){on_device->occluder, s->count, on_device->near_plate, on_device->slot,
                            on_device->begin, on_device->middle, on_device->end, on_device->col});
}

void mps__neighbours_hide(mps_neighbours *l)
{
    const mps__occluders *s = l->occluders;
    if (!s) return;
    mps__neighbours_hide_device(l, &(mps__row_arrays){.begin = l->begin,
                                                      .middle = l->middle,
                                                      .end = l->end,
                                                      .col = l->col,
                                                      .occluder = s->list,
                                                      .near_plate = s->near_plate,
                                                      .slot = s->slot});
}

void mps__neighbours_rows(mps_neighbours *l, const double *x)
{
    l->x = x;
    const exact rows = exact_of(l);
    mps__loop_run(l->parallel, &exact_rows, l->dim, l->n, &rows);
    if (l->longest > 0) mps__loop_run_long(l->parallel, &exact_parts, l->dim, MPS__PARTS, &rows);
    mps__neighbours_hide(l);
}

void mps__neighbours_rows_device(mps_neighbours *l, const double *x,
                                 const mps__row_arrays *on_device)
{
    exact rows = exact_of(l);
    l->x = x;
    rows.x = on_device->x;
    rows.begin = on_device->begin;
    rows.count = on_device->count;
    rows.middle = on_device->middle;
    rows.end = on_device->end;
    rows.col = on_device->col;
    mps__loop_run(l->parallel, &exact_rows, l->dim, l->n, &rows);
    mps__neighbours_hide_device(l, on_device);
}

/* Number of near pairs of row i - 1 at index i; its prefix sum is the begin of row i. */
typedef struct nears {
    const int64_t *begin, *middle;
    int64_t *near_begin;
} nears;

MPS_ROW void near_row(const nears *f, int64_t i)
{
    f->near_begin[i] = i > 0 ? f->middle[i - 1] - f->begin[i - 1] : 0;
}
MPS__LOOP_ANY(near_rows, near_row, nears)

void mps__neighbours_near(const mps_neighbours *l, const int64_t *begin, const int64_t *middle,
                          int64_t *near_begin)
{
    mps__loop_run_cheap(l->parallel, &near_rows, MPS__ANY_DIM, l->n + 1,
                        &(nears){begin, middle, near_begin});
    mps__scan(l->parallel, near_begin, l->n + 1);
}

mps_status mps__neighbours_near_fit(mps_neighbours *l, int64_t pairs)
{
    MPS__TRY(mps__neighbours_fit(l, (void **)&l->near_col, &l->near_capacity, pairs,
                                 sizeof *l->near_col));
    return mps__neighbours_fit(l, (void **)&l->w_r2, &l->weight_capacity, pairs, sizeof *l->w_r2);
}
