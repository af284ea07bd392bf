/* SPDX-License-Identifier: BSD-3-Clause */
/* Neighbour search: cells as sorted 64-bit keys (x fastest), candidates with a skin, in one
 * pass. */
#include "neighbours_rows.h"
#include "ghosts.h"
#include "loop.h"
#include "scan.h"
#include <math.h>
#include <stdatomic.h>
#include <string.h>

/* Candidates tested per block; capacity of a thread's row buffer. */
enum { MPS__CHUNK = 256, MPS__SHELF = 4096 };

/* Positions now, and at the last search. */
typedef struct way {
    const double *x, *searched;
    const uint8_t *ghost; /* NULL: single rank */
} way;

/* Largest squared displacement since the last search. */
MPS_ROW void moved_row(const int dim, const way *w, int64_t i, double *worst)
{
    double s = 0;
    if (!mps__owns(w->ghost, i)) return;
    for (int d = 0; d < dim; d++) {
        const double m = w->x[i * dim + d] - w->searched[i * dim + d];
        s += m * m;
    }
    if (s > *worst) *worst = s;
}
MPS__VALUES(moved_rows, moved_row, way, 0, 1)

bool mps__neighbours_fresh(const mps_neighbours *l, int64_t n, const double *x,
                           const double *searched, const uint8_t *ghost, double re_far)
{
    double worst = 0;
    if (!mps__neighbours_within(l, n, re_far, 0)) return false;
    mps__values_run(l->parallel, &moved_rows, l->dim, n, &(way){x, searched, ghost}, NULL, &worst);
    return mps__neighbours_within(l, n, re_far, worst);
}

bool mps__neighbours_within(const mps_neighbours *l, int64_t n, double re_far, double square)
{
    return l->valid && n == l->n && re_far == l->re_far && square < 0.25 * l->skin * l->skin;
}

/* ---- memory ---- */

static mps_status reserve(mps_neighbours *l, int64_t n)
{
    if (n <= l->capacity) return MPS_OK;
    mps__context *c = l->context;
    const int64_t wanted = mps__capacity_for(n, l->capacity);
    struct {
        void **place;
        int64_t count;
        size_t size;
        void *fresh;
    } a[] = {{(void **)&l->begin, mps__scan_size(wanted), sizeof *l->begin, NULL},
             {(void **)&l->count, wanted, sizeof *l->count, NULL},
             {(void **)&l->middle, wanted, sizeof *l->middle, NULL},
             {(void **)&l->near_begin, mps__scan_size(wanted + 1), sizeof *l->near_begin, NULL},
             {(void **)&l->searched, wanted * l->dim, sizeof *l->searched, NULL},
             {(void **)&l->idle, wanted, sizeof *l->idle, NULL},
             {(void **)&l->near_dummies, wanted, sizeof *l->near_dummies, NULL}};
    const size_t count = sizeof a / sizeof a[0];
    for (size_t k = 0; k < count; k++) {
        a[k].fresh = mps__alloc(c, a[k].count, a[k].size);
        if (!a[k].fresh) {
            while (k-- > 0) mps__free(c, a[k].fresh);
            return MPS_E_NOMEM;
        }
    }
    for (size_t k = 0; k < count; k++) {
        mps__free(c, *a[k].place);
        *a[k].place = a[k].fresh;
    }
    l->capacity = wanted;
    return MPS_OK;
}

mps_status mps__neighbours_fit(mps_neighbours *l, void **block, int64_t *capacity, int64_t count,
                               size_t size)
{
    if (*block && *capacity >= count && *capacity < count + count / 4 + 1024) return MPS_OK;
    mps__free(l->context, *block);
    *capacity = 0;
    *block = mps__alloc(l->context, count + count / 32, size);
    if (!*block) return MPS_E_NOMEM;
    *capacity = count + count / 32;
    return MPS_OK;
}

/* ---- particles around a cell ---- */

/* What the search of a part of the sorted particles reads and writes. */
typedef struct search {
    mps__rings rings;
    double reach2;
    bool sorted; /* sorted index a is particle a */
    bool ghost_rows, dummy_rows;
    int64_t n, capacity; /* particles; capacity of col */
    const uint64_t *key;
    const int32_t *order;
    const double *place;          /* positions in sorted order, one axis after the other */
    const int32_t *kind;          /* NULL: every particle gets a row; else with */
    const int32_t *fluid, *dummy; /* counts of fluid and dummies up to each sorted index */
    const uint8_t *ghost;         /* NULL: single rank */
    int64_t *begin, *middle, *end;
    int32_t *count, *col;
    uint8_t *near_dummies, *idle;
    atomic_int_least64_t *taken; /* entries of col that the rows need; may exceed its capacity */
    /* [MPS__PARTS] longest row of each part if it exceeds the stack buffer, else 0 */
    int64_t *longest;
} search;

/* Positions, and a buffer for them in sorted order, one axis after the other, for contiguous
 * access. */
typedef struct places {
    int64_t n;
    const int32_t *order;
    const double *x;
    double *sorted;
} places;

MPS_ROW void place_row(const int dim, const places *p, int64_t a)
{
    for (int d = 0; d < dim; d++) p->sorted[d * p->n + a] = p->x[(int64_t)p->order[a] * dim + d];
}
MPS__LOOP(place_rows, place_row, places)

/* Whether these ranges have any. */
static bool any_within(const int32_t *until, int64_t range[9][2], int ranges)
{
    bool any = false;
    for (int k = 0; k < ranges; k++)
        any = any || until[range[k][1] - 1] > (range[k][0] > 0 ? until[range[k][0] - 1] : 0);
    return any;
}

/* Squared distances of sorted particle a to from..to-1, at most MPS__CHUNK: a separate loop, so
 * that the compiler vectorises it. */
MPS_ROW void measure_places(const int dim, const search *s, int64_t a, int64_t from, int64_t to,
                            double *r2)
{
    const double *const x = s->place, *const y = x + s->n, *const z = x + (dim - 1) * s->n;
    const double xa = x[a], ya = y[a], za = z[a];
    for (int64_t b = from; b < to; b++) {
        const double dx = x[b] - xa, dy = y[b] - ya, dz = dim == 3 ? z[b] - za : 0.0;
        r2[b - from] = dim == 3 ? dx * dx + dy * dy + dz * dz : dx * dx + dy * dy;
    }
    if (a >= from && a < to) r2[a - from] = INFINITY; /* no pair with itself */
}

/* ---- rows ---- */

/* Candidates found for one particle. */
typedef struct finding {
    int64_t count; /* above MPS__ROW: the list is incomplete */
    int32_t j[MPS__ROW + MPS__CHUNK];
    double r2[MPS__ROW + MPS__CHUNK];
} finding;

/* Particles nearer to sorted particle a than the reach. Branch-free compaction: every third or
 * sixth candidate is near, which branch prediction cannot guess. */
MPS_ROW void find_row(const int dim, const bool sorted, const search *s, int64_t a,
                      int64_t range[9][2], int ranges, finding *f)
{
    const double reach2 = s->reach2;
    int64_t n = 0;
    for (int k = 0; k < ranges; k++)
        for (int64_t from = range[k][0]; from < range[k][1] && n <= MPS__ROW; from += MPS__CHUNK) {
            const int64_t to = from + MPS__CHUNK < range[k][1] ? from + MPS__CHUNK : range[k][1];
            double r2[MPS__CHUNK];
            measure_places(dim, s, a, from, to, r2);
            for (int64_t b = from; b < to; b++) {
                f->j[n] = sorted ? (int32_t)b : s->order[b];
                f->r2[n] = r2[b - from];
                n += r2[b - from] < reach2;
            }
        }
    f->count = n;
}

/* Candidates of a row of any length, not partitioned; stored if `row` is not NULL. @return their
 * number */
MPS_ROW int64_t long_row(const int dim, const search *s, int64_t a, int64_t range[9][2], int ranges,
                         int32_t *row)
{
    int64_t n = 0;
    for (int k = 0; k < ranges; k++)
        for (int64_t b = range[k][0]; b < range[k][1]; b++) {
            double r2;
            measure_places(dim, s, a, b, b + 1, &r2);
            if (r2 >= s->reach2) continue;
            if (row) row[n] = s->order[b];
            n++;
        }
    if (row) mps__sort_row(row, n);
    return n;
}

static bool meets_fluid(const search *s, const finding *f)
{
    bool any = f->count > MPS__ROW;
    for (int64_t k = 0; k < f->count && !any; k++) any = s->kind[f->j[k]] == MPS_FLUID;
    return any;
}

/* Row buffer of a thread, written to col in blocks. The begins of rows of sorted particles from
 * `from` on are relative to it. */
typedef struct shelf {
    int64_t from, used;
    int32_t entry[MPS__SHELF];
} shelf;

/* Reserve `count` entries of col; threads reserve disjoint ranges. false: its capacity is
 * exceeded */
static bool take(const search *s, int64_t count, int64_t *at)
{
    *at = atomic_fetch_add(s->taken, count);
    return *at + count <= s->capacity;
}

/* Copy rows of sorted particles up to `to` from the buffer to col. If the capacity is exceeded they
 * are only counted. */
static void unload(const search *s, shelf *h, int64_t to)
{
    int64_t at;
    if (h->used > 0 && take(s, h->used, &at)) {
        memcpy(s->col + at, h->entry, (size_t)h->used * sizeof *s->col);
        for (int64_t a = h->from; a < to; a++) {
            const int32_t i = s->order[a];
            s->begin[i] += at;
            s->middle[i] += at;
            if (s->end != s->middle) s->end[i] += at;
        }
    }
    h->from = to;
    h->used = 0;
}

static void set_row(const search *s, int64_t i, int64_t begin, mps__parted row, int64_t count)
{
    s->begin[i] = begin;
    s->middle[i] = begin + row.near;
    s->end[i] = begin + row.near + row.far;
    s->count[i] = (int32_t)count;
}

/* Store the row of sorted particle a. */
MPS_ROW void keep_row(const bool sorted, const search *s, int64_t a, const finding *f, shelf *h)
{
    int32_t far[MPS__ROW], out[MPS__ROW];
    if (h->used + f->count > MPS__SHELF) unload(s, h, a);
    int32_t *row = h->entry + h->used;
    const mps__parted parted = mps__part_row(&s->rings, f->j, f->r2, f->count, row, far, out);
    set_row(s, sorted ? a : s->order[a], h->used, parted, f->count);
    h->used += f->count;
    if (sorted) return;
    mps__sort_row(row, parted.near);
    mps__sort_row(row + parted.near, parted.far);
}

/* Store a row that exceeds the stack buffer, not partitioned yet. */
MPS_ROW void keep_long_row(const int dim, const search *s, int64_t a, int64_t range[9][2],
                           int ranges, shelf *h, int64_t *longest)
{
    int64_t at;
    const int64_t count = long_row(dim, s, a, range, ranges, NULL);
    unload(s, h, a);
    if (take(s, count, &at)) long_row(dim, s, a, range, ranges, s->col + at);
    set_row(s, s->order[a], at, (mps__parted){0, 0}, count);
    *longest = count > *longest ? count : *longest;
    h->from = a + 1;
}

/* All rows of the cell that starts at sorted index `first`. @return its end */
MPS_ROW int64_t search_cell(const int dim, const bool sorted, const search *s, int64_t first,
                            shelf *h, int64_t *longest)
{
    int64_t range[9][2], a = first;
    const int ranges = mps__ranges_around(dim, s->key, s->n, s->key[first], range);
    const bool fluid = !s->kind || any_within(s->fluid, range, ranges);
    const bool dummies = s->kind && any_within(s->dummy, range, ranges);
    finding f;
    for (; a < s->n && s->key[a] == s->key[first]; a++) {
        const int32_t i = sorted ? (int32_t)a : s->order[a];
        const bool solid = s->kind && s->kind[i] != MPS_FLUID,
                   ghost = !mps__owns(s->ghost, i) && (solid || !s->ghost_rows);
        s->near_dummies[i] = dummies && !solid && !ghost;
        s->idle[i] = ghost || (solid && (!fluid || (s->kind[i] == MPS_DUMMY && !s->dummy_rows)));
        if (!s->idle[i]) find_row(dim, sorted, s, a, range, ranges, &f);
        if (!s->idle[i] && solid) s->idle[i] = !meets_fluid(s, &f);
        if (s->idle[i])
            set_row(s, i, h->used, (mps__parted){0, 0}, 0);
        else if (f.count > MPS__ROW)
            keep_long_row(dim, s, a, range, ranges, h, longest);
        else
            keep_row(sorted, s, a, &f, h);
    }
    return a;
}

/* The cells that begin in one of MPS__PARTS parts of the sorted particles. */
MPS_ROW void search_part(const int dim, const search *s, int64_t part)
{
    const int64_t end = s->n * (part + 1) / MPS__PARTS;
    int64_t a = s->n * part / MPS__PARTS, longest = 0;
    while (a > 0 && a < end && s->key[a] == s->key[a - 1]) a++;
    shelf h;
    h.from = a;
    h.used = 0;
    while (a < end)
        a = s->sorted ? search_cell(dim, true, s, a, &h, &longest)
                      : search_cell(dim, false, s, a, &h, &longest);
    unload(s, &h, a);
    s->longest[part] = longest;
}
MPS__LOOP(search_parts, search_part, search)

/* Counts of fluid and dummies up to and including each sorted index. They use the second half of
 * the keys, the workspace of the sort. */
static int32_t *fluid_until(const mps_neighbours *l)
{
    return (int32_t *)(void *)(l->key + l->n);
}
static int32_t *dummies_until(const mps_neighbours *l)
{
    return fluid_until(l) + l->n;
}

static void count_kinds(mps_neighbours *l)
{
    int32_t *const fluid = fluid_until(l), *const dummy = dummies_until(l);
    int32_t fluids = 0, dummies = 0;
    for (int64_t a = 0; a < l->n; a++) {
        const int32_t kind = l->kind[l->order[a]];
        fluid[a] = fluids += kind == MPS_FLUID;
        dummy[a] = dummies += kind == MPS_DUMMY;
    }
}

static search search_of(const mps_neighbours *l, bool sorted)
{
    return (search){.rings = mps__rings_of(l),
                    .reach2 = (l->re_far + l->skin) * (l->re_far + l->skin),
                    .sorted = sorted,
                    .ghost_rows = l->ghost_rows,
                    .dummy_rows = l->dummy_rows,
                    .n = l->n,
                    .key = l->key,
                    .order = l->order,
                    .place = l->searched,
                    .kind = l->kind,
                    .fluid = fluid_until(l),
                    .dummy = dummies_until(l),
                    .ghost = l->ghost,
                    .begin = l->begin,
                    .middle = l->middle,
                    .end = l->end,
                    .count = l->count,
                    .near_dummies = l->near_dummies,
                    .idle = l->idle};
}

/* All rows. The capacity is estimated from the last search; if it is too small, this pass counts
 * the pairs, and a second one stores them. */
static mps_status search_rows(mps_neighbours *l, bool sorted)
{
    int64_t expected = l->pairs + l->pairs / 64, longest[MPS__PARTS];
    atomic_int_least64_t taken;
    search s = search_of(l, sorted);
    s.taken = &taken;
    s.longest = longest;
    do {
        MPS__TRY(
            mps__neighbours_fit(l, (void **)&l->col, &l->pair_capacity, expected, sizeof *l->col));
        s.col = l->col;
        s.capacity = l->pair_capacity;
        atomic_init(&taken, 0);
        mps__loop_run_long(l->parallel, &search_parts, l->dim, MPS__PARTS, &s);
        l->pairs = expected = atomic_load(&taken);
    } while (expected > l->pair_capacity);
    l->longest = 0;
    for (int p = 0; p < MPS__PARTS; p++)
        l->longest = longest[p] > l->longest ? longest[p] : l->longest;
    return l->longest > 0 ? mps__neighbours_part_long(l) : MPS_OK;
}

mps_status mps__neighbours_begin(mps_neighbours *l, int64_t n, const double *x, double re_near,
                                 double re_far)
{
    l->sorted = l->valid = l->torn = false;
    l->searches++;
    MPS__TRY(reserve(l, n));
    if (re_near < re_far)
        MPS__TRY(
            mps__neighbours_fit(l, (void **)&l->far_end, &l->far_capacity, n, sizeof *l->far_end));
    /* on many ranks n differs slightly from search to search */
    const bool near = n <= l->n + l->n / 8 && n >= l->n - l->n / 8;
    const bool alike = near && l->n > 0 && re_far == l->re_far && l->partial == (l->kind != NULL) &&
                       l->dummy_rows == l->had_dummy_rows;
    l->pairs = alike ? (int64_t)((double)l->pairs * (double)n / (double)l->n) : 0;
    l->end = re_near < re_far ? l->far_end : l->middle;
    l->partial = l->kind != NULL;
    l->had_dummy_rows = l->dummy_rows;
    l->n = n;
    l->x = x;
    l->re_near = re_near;
    l->re_far = re_far;
    return MPS_OK;
}

void mps__neighbours_end(mps_neighbours *l)
{
    l->kind = NULL;
    l->valid = true;
}

mps_status mps__neighbours_search(mps_neighbours *l, int64_t n, const double *x, double re_near,
                                  double re_far)
{
    const bool sorted = l->sorted;
    if (!sorted) MPS__TRY(mps__neighbours_order(l, n, x, NULL, re_far));
    MPS__TRY(mps__neighbours_begin(l, n, x, re_near, re_far));
    /* uses l->searched as workspace, which is overwritten after the search */
    mps__loop_run(l->parallel, &place_rows, l->dim, n, &(places){n, l->order, x, l->searched});
    if (l->kind) count_kinds(l);
    MPS__TRY(search_rows(l, sorted));
    memcpy(l->searched, x, (size_t)(n * l->dim) * sizeof *x);
    mps__neighbours_end(l);
    return MPS_OK;
}
