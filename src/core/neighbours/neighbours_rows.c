/* SPDX-License-Identifier: BSD-3-Clause */
/* Exact rows at positions that have changed since the search, from its candidates, and what screens hide. */
#include "neighbours_rows.h"
#include <math.h>

/* Pairs nearer than this [dp] have no direction and are left out: they are the two faces of a thin plate. */
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

/* Squared distances of i to some of its candidates. Returns whether they are all in [least, most). */
MPS__DIM_INLINE bool measure(const mps_neighbours *l, int64_t i, const int32_t *row, int64_t count,
                             const double ring[2], double *r2, const int dim)
{
    const double *const x = l->x, *const at = x + i * dim;
    double nearest = INFINITY, farthest = 0;
    for (int64_t k = 0; k < count; k++) {
        const double d2 = mps__square_between(at, x + (int64_t)row[k] * dim, dim);
        r2[k] = d2;
        nearest = d2 < nearest ? d2 : nearest;
        farthest = d2 > farthest ? d2 : farthest;
    }
    return nearest >= ring[0] && farthest < ring[1];
}

/* Squared distances of i to all candidates. Returns whether each is still in the part where the last step put it: then the row is what it
 * should be. */
MPS__DIM_INLINE bool row_stands(const mps_neighbours *l, int64_t i, const mps__rings *g, double *r2,
                                const int dim)
{
    const int32_t *row = l->col + l->begin[i];
    const int64_t nears = l->middle[i] - l->begin[i], within = l->end[i] - l->begin[i];
    const double near[2] = {g->least, g->near2}, far[2] = {g->near2, g->far2},
                 out[2] = {g->far2, INFINITY};
    const bool near_stand = measure(l, i, row, nears, near, r2, dim);
    const bool far_stand = measure(l, i, row + nears, within - nears, far, r2 + nears, dim);
    const bool out_stand = measure(l, i, row + within, l->count[i] - within, out, r2 + within, dim);
    return near_stand && far_stand && out_stand;
}

/* Room for the work on a row. */
typedef struct room {
    double *r2;
    int32_t *far, *out;
} room;

/* Few have changed their part since the last step, so that sorting is short work. */
MPS__DIM_INLINE void exact_row(mps_neighbours *l, int64_t i, const mps__rings *g, const room *r,
                               const int dim)
{
    if (l->count[i] == 0 || row_stands(l, i, g, r->r2, dim)) return;
    int32_t *const row = l->col + l->begin[i];
    const mps__parted parted = mps__part_row(g, row, r->r2, l->count[i], row, r->far, r->out);
    mps__sort_row(row, parted.near);
    mps__sort_row(row + parted.near, parted.far);
    l->middle[i] = l->begin[i] + parted.near;
    l->end[i] = l->middle[i] + parted.far;
}

static void exact_part(void *argument, int32_t part)
{
    mps_neighbours *l = argument;
    const mps__rings g = mps__rings_of(l);
    double r2[MPS__ROW];
    int32_t far[MPS__ROW], out[MPS__ROW];
    room r = {r2, far, out};
    if (l->longest > 0) {
        r.r2 = l->scratch + 2 * l->longest * part;
        r.far = (int32_t *)(void *)(r.r2 + l->longest);
        r.out = r.far + l->longest;
    }
    for (int64_t i = l->n * part / MPS__PARTS; i < l->n * (part + 1) / MPS__PARTS; i++) {
        if (l->dim == 2)
            exact_row(l, i, &g, &r, 2);
        else
            exact_row(l, i, &g, &r, 3);
    }
}

mps_status mps__neighbours_part_long(mps_neighbours *l)
{
    MPS__TRY(mps__neighbours_fit(l, (void **)&l->scratch, &l->scratch_capacity,
                                 MPS__PARTS * 2 * l->longest, sizeof *l->scratch));
    mps_parallel_run(l->parallel, MPS__PARTS, exact_part, l);
    return MPS_OK;
}

/* Pairs from..to-1 that see each other change places with those from `out` on; they stay in order. Returns the end. */
static int64_t keep_visible(mps_neighbours *l, const mps__seer *a, int64_t from, int64_t to,
                            int64_t out)
{
    const mps__screens *s = l->screens;
    for (int64_t k = from; k < to; k++) {
        const int32_t j = l->col[k], slot = s->slot[j];
        if (slot >= 0 && mps__screens_hidden(s, a, &s->seer[slot])) continue;
        l->col[k] = l->col[out];
        l->col[out++] = j;
    }
    return out;
}

/* What screens hide goes behind the others. */
static void screen_rows(void *argument, int64_t begin, int64_t end)
{
    mps_neighbours *l = argument;
    for (int64_t k = begin; k < end; k++) {
        const mps__seer *a = &l->screens->seer[k];
        const int64_t i = a->particle, middle = l->middle[i], last = l->end[i];
        l->middle[i] = keep_visible(l, a, l->begin[i], middle, l->begin[i]);
        l->end[i] = keep_visible(l, a, middle, last, l->middle[i]);
    }
}

void mps__neighbours_hide(mps_neighbours *l)
{
    if (l->screens && l->screens->count > 0)
        mps_parallel_rows(l->parallel, l->screens->seers, screen_rows, l);
}

void mps__neighbours_rows(mps_neighbours *l, const double *x)
{
    l->x = x;
    mps_parallel_run(l->parallel, MPS__PARTS, exact_part, l);
    mps__neighbours_hide(l);
}

mps_status mps__neighbours_near(mps_neighbours *l)
{
    l->near_begin[0] = 0;
    for (int64_t i = 0; i < l->n; i++)
        l->near_begin[i + 1] = l->near_begin[i] + l->middle[i] - l->begin[i];
    MPS__TRY(mps__neighbours_fit(l, (void **)&l->near_col, &l->near_capacity, l->near_begin[l->n],
                                 sizeof *l->near_col));
    return mps__neighbours_fit(l, (void **)&l->w_r2, &l->weight_capacity, l->near_begin[l->n],
                               sizeof *l->w_r2);
}
