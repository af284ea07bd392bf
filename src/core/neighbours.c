/* SPDX-License-Identifier: BSD-3-Clause */
/* Search of pairs: cells as sorted 64-bit keys (x fastest), candidates with a skin, all in one pass. */
#include "neighbours_rows.h"
#include <math.h>
#include <string.h>

/* Places looked at between two copies of what was found. */
enum { MPS__CHUNK = 256 };

/* A list and positions that are not, or not yet, its own. */
typedef struct cloud {
    const mps_neighbours *l;
    const double *x;
} cloud;

/* Largest square of a way since the last search. */
static void moved_rows(void *argument, int64_t begin, int64_t end, double *values)
{
    const cloud *c = argument;
    const int dim = c->l->dim;
    const double *x = c->x, *searched = c->l->searched;
    double worst = values[0];
    for (int64_t i = begin; i < end; i++) {
        double s = 0;
        for (int d = 0; d < dim; d++) {
            double m = x[i * dim + d] - searched[i * dim + d];
            s += m * m;
        }
        if (s > worst) worst = s;
    }
    values[0] = worst;
}

bool mps__neighbours_fresh(const mps_neighbours *l, int64_t n, const double *x, double re_far)
{
    double worst = 0;
    if (!l->valid || n != l->n || re_far != l->re_far) return false;
    mps_parallel_max(l->parallel, n, 1, moved_rows, &(cloud){l, x}, &worst);
    return worst < 0.25 * l->skin * l->skin;
}


/* ---- memory ---------------------------------------------------------------------------------------------------- */

static mps_status reserve(mps_neighbours *l, int64_t n)
{
    if (n <= l->capacity) return MPS_OK;
    mps__context *c = l->context;
    const int64_t wanted = mps__room(n, l->capacity);
    struct {
        void **place;
        int64_t count;
        size_t size;
        void *fresh;
    } a[] = {{(void **)&l->begin, wanted, sizeof *l->begin, NULL},
             {(void **)&l->count, wanted, sizeof *l->count, NULL},
             {(void **)&l->middle, wanted, sizeof *l->middle, NULL},
             {(void **)&l->near_begin, wanted + 1, sizeof *l->near_begin, NULL},
             {(void **)&l->searched, wanted * l->dim, sizeof *l->searched, NULL},
             {(void **)&l->idle, wanted, sizeof *l->idle, NULL},
             {(void **)&l->rim, wanted, sizeof *l->rim, NULL}};
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

mps_status mps__neighbours_fit(mps_neighbours *l, void **block, int64_t *capacity, int64_t count, size_t size)
{
    if (*block && *capacity >= count && *capacity < count + count / 4 + 1024) return MPS_OK;
    mps__free(l->context, *block);
    *capacity = 0;
    *block = mps__alloc(l->context, count + count / 32, size);
    if (!*block) return MPS_E_NOMEM;
    *capacity = count + count / 32;
    return MPS_OK;
}

/* Room in col for the rows of each part: what they took last, and a share of what is left. As much again stays for parts that outgrow
 * theirs. */
static mps_status lay_out(mps_neighbours *l)
{
    int64_t total = 0, at = 0;
    for (int p = 0; p < MPS__PARTS; p++) total += l->span[p].used;
    MPS__TRY(mps__neighbours_fit(l, (void **)&l->col, &l->pair_capacity, total + total / 64, sizeof *l->col));
    const int64_t more = (l->pair_capacity - total) / (2 * MPS__PARTS);
    for (int p = 0; p < MPS__PARTS; p++) {
        mps__span *s = &l->span[p];
        s->begin = at;
        s->room = s->used + more;
        at += s->room;
    }
    l->laid = at;
    return MPS_OK;
}

/* Whether some part found more than it had room for. */
static bool outgrown(const mps_neighbours *l)
{
    bool any = false;
    for (int p = 0; p < MPS__PARTS; p++) any = any || l->span[p].used > l->span[p].room;
    return any;
}

/* Parts that outgrew their room get another behind all. False if there is not enough. */
static bool move_out(mps_neighbours *l)
{
    for (int p = 0; p < MPS__PARTS; p++) {
        mps__span *s = &l->span[p];
        if (s->used <= s->room) continue;
        s->begin = l->laid;
        l->laid += s->used;
    }
    return l->laid <= l->pair_capacity;
}

/* ---- places around a cell -------------------------------------------------------------------------------------- */

static int64_t first_at_least(const uint64_t *key, int64_t n, uint64_t value)
{
    int64_t lo = 0;
    while (n > 0) {
        int64_t half = n / 2;
        if (key[lo + half] < value) {
            lo += half + 1;
            n -= half + 1;
        } else {
            n = half;
        }
    }
    return lo;
}

/* Ranges of sorted places that hold the cells around `key`: one for each row of three cells. */
static int ranges_around(const mps_neighbours *l, uint64_t key, int64_t range[9][2])
{
    const int bits = mps__cell_bits(l->dim), high = l->dim == 3;
    int count = 0;
    for (int dz = -high; dz <= high; dz++)
        for (int dy = -1; dy <= 1; dy++) {
            int64_t step = (int64_t)dy * (INT64_C(1) << bits) + (high ? (int64_t)dz * (INT64_C(1) << (2 * bits)) : 0);
            uint64_t middle = key + (uint64_t)step;
            int64_t first = first_at_least(l->key, l->n, middle - 1), last = first;
            while (last < l->n && l->key[last] <= middle + 1) last++;
            if (last > first) {
                range[count][0] = first;
                range[count++][1] = last;
            }
        }
    return count;
}


/* Positions of the sorted places, one axis after the other, so that loops over places run along memory. They borrow
 * l->searched, which takes its own values after the search. */
static void gather_places(void *argument, int64_t begin, int64_t end)
{
    mps_neighbours *l = argument;
    for (int64_t a = begin; a < end; a++)
        for (int d = 0; d < l->dim; d++) l->searched[d * l->n + a] = l->x[(int64_t)l->order[a] * l->dim + d];
}

/* Fluid and dummies up to each place, itself included. They borrow the second half of the keys, which was scratch of their sort. */
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

/* Whether any are in these ranges. */
static bool any_within(const int32_t *until, int64_t range[9][2], int ranges)
{
    bool any = false;
    for (int k = 0; k < ranges; k++) any = any || until[range[k][1] - 1] > (range[k][0] > 0 ? until[range[k][0] - 1] : 0);
    return any;
}

/* Squared distances of place a to from..to-1, at most MPS__CHUNK: a loop of its own, so that the compiler takes several at a time. */
MPS__DIM_INLINE void measure_places(const mps_neighbours *l, int64_t a, int64_t from, int64_t to, const int dim, double *r2)
{
    const double *const x = l->searched, *const y = x + l->n, *const z = x + (dim - 1) * l->n;
    const double xa = x[a], ya = y[a], za = z[a];
    for (int64_t b = from; b < to; b++) {
        const double dx = x[b] - xa, dy = y[b] - ya, dz = dim == 3 ? z[b] - za : 0.0;
        r2[b - from] = dim == 3 ? dx * dx + dy * dy + dz * dz : dx * dx + dy * dy;
    }
    if (a >= from && a < to) r2[a - from] = INFINITY; /* no pair with itself */
}

/* ---- rows ------------------------------------------------------------------------------------------------------ */

typedef struct searching {
    mps_neighbours *l;
    mps__rings rings;
    double reach2;
    bool sorted; /* place a is particle a */
    bool again;  /* only parts that have outgrown their room */
} searching;

/* What was found about a place. */
typedef struct finding {
    int64_t count; /* more than MPS__ROW: not all are here */
    int32_t j[MPS__ROW + MPS__CHUNK];
    double r2[MPS__ROW + MPS__CHUNK];
} finding;

/* Particles nearer to place a than the reach. Compaction without branches: every third or sixth place is near, and no processor
 * guesses which. */
MPS__DIM_INLINE void find_row(const searching *s, int64_t a, int64_t range[9][2], int ranges, finding *f, const int dim, const bool sorted)
{
    const mps_neighbours *l = s->l;
    const double reach2 = s->reach2;
    int64_t n = 0;
    for (int k = 0; k < ranges; k++)
        for (int64_t from = range[k][0]; from < range[k][1] && n <= MPS__ROW; from += MPS__CHUNK) {
            const int64_t to = from + MPS__CHUNK < range[k][1] ? from + MPS__CHUNK : range[k][1];
            double r2[MPS__CHUNK];
            measure_places(l, a, from, to, dim, r2);
            for (int64_t b = from; b < to; b++) {
                f->j[n] = sorted ? (int32_t)b : l->order[b];
                f->r2[n] = r2[b - from];
                n += r2[b - from] < reach2;
            }
        }
    f->count = n;
}

/* The same for rows of any length, which are not parted. They are stored if there is room; returns how many. */
static int64_t long_row(const searching *s, int64_t a, int64_t range[9][2], int ranges, int64_t room, int32_t *row)
{
    const mps_neighbours *l = s->l;
    int64_t n = 0;
    for (int k = 0; k < ranges; k++)
        for (int64_t b = range[k][0]; b < range[k][1]; b++) {
            double r2;
            if (l->dim == 2)
                measure_places(l, a, b, b + 1, 2, &r2);
            else
                measure_places(l, a, b, b + 1, 3, &r2);
            if (r2 >= s->reach2) continue;
            if (n < room) row[n] = l->order[b];
            n++;
        }
    if (n <= room) mps__sort_row(row, n);
    return n;
}

static bool meets_fluid(const mps_neighbours *l, const finding *f)
{
    bool any = f->count > MPS__ROW;
    for (int64_t k = 0; k < f->count && !any; k++) any = l->kind[f->j[k]] == MPS_FLUID;
    return any;
}

/* Row i from what was found, behind those that its part has. Without room it is only counted. */
MPS__DIM_INLINE void keep_row(const searching *s, int64_t i, const finding *f, mps__span *p, const bool sorted)
{
    mps_neighbours *l = s->l;
    const int64_t at = p->begin + p->used;
    p->used += f->count;
    if (p->used > p->room) return;
    int32_t far[MPS__ROW], out[MPS__ROW];
    l->begin[i] = at;
    l->count[i] = (int32_t)f->count;
    mps__part_row(l, i, &s->rings, f->j, f->r2, far, out);
    if (sorted) return;
    mps__sort_row(l->col + at, l->middle[i] - at);
    mps__sort_row(l->col + l->middle[i], l->end[i] - l->middle[i]);
}

/* A row without pairs. */
static void empty_row(mps_neighbours *l, int64_t i)
{
    l->begin[i] = l->middle[i] = l->end[i] = 0;
    l->count[i] = 0;
}

/* A row longer than the stack has room for. */
static void keep_long_row(const searching *s, int64_t a, int64_t range[9][2], int ranges, mps__span *p)
{
    mps_neighbours *l = s->l;
    const int32_t i = l->order[a];
    const int64_t at = p->begin + p->used, room = p->room > p->used ? p->room - p->used : 0;
    const int64_t count = long_row(s, a, range, ranges, room, room > 0 ? l->col + at : NULL);
    p->used += count;
    p->longest = count > p->longest ? count : p->longest;
    l->begin[i] = l->middle[i] = l->end[i] = at; /* not parted yet */
    l->count[i] = (int32_t)count;
}

/* All rows of the cell that starts at sorted place `first`. */
MPS__DIM_INLINE void search_cell(const searching *s, int64_t first, mps__span *p, const int dim, const bool sorted)
{
    mps_neighbours *l = s->l;
    int64_t range[9][2];
    const int ranges = ranges_around(l, l->key[first], range);
    const bool fluid = !l->kind || any_within(fluid_until(l), range, ranges);
    const bool dummies = l->kind && any_within(dummies_until(l), range, ranges);
    finding f;
    for (int64_t a = first; a < l->n && l->key[a] == l->key[first]; a++) {
        const int32_t i = sorted ? (int32_t)a : l->order[a];
        const bool solid = l->kind && l->kind[i] != MPS_FLUID;
        l->rim[i] = dummies && !solid;
        l->idle[i] = solid && (!fluid || (l->kind[i] == MPS_DUMMY && !l->dummy_rows));
        if (!l->idle[i]) find_row(s, a, range, ranges, &f, dim, sorted);
        if (!l->idle[i] && solid) l->idle[i] = !meets_fluid(l, &f);
        if (l->idle[i])
            empty_row(l, i);
        else if (f.count > MPS__ROW)
            keep_long_row(s, a, range, ranges, p);
        else
            keep_row(s, i, &f, p, sorted);
    }
}

/* The cells that begin in one of MPS__PARTS parts of the sorted places. */
static void search_part(void *argument, int32_t part)
{
    const searching *s = argument;
    mps_neighbours *l = s->l;
    mps__span *p = &l->span[part];
    if (s->again && p->used <= p->room) return;
    if (s->again) p->room = p->used;
    p->used = p->longest = 0;
    for (int64_t a = l->n * part / MPS__PARTS; a < l->n * (part + 1) / MPS__PARTS; a++) {
        if (a > 0 && l->key[a] == l->key[a - 1]) continue;
        if (l->dim == 2)
            s->sorted ? search_cell(s, a, p, 2, true) : search_cell(s, a, p, 2, false);
        else
            s->sorted ? search_cell(s, a, p, 3, true) : search_cell(s, a, p, 3, false);
    }
}

/* All rows. A part of the particles finds about as many pairs as last time; where it finds more than it has room for, it counts them, and
 * the second pass stores them. */
static mps_status search_rows(mps_neighbours *l, searching *s)
{
    MPS__TRY(lay_out(l));
    mps_parallel_run(l->parallel, MPS__PARTS, search_part, s);
    if (!outgrown(l)) return MPS_OK;
    s->again = move_out(l);
    if (!s->again) MPS__TRY(lay_out(l));
    mps_parallel_run(l->parallel, MPS__PARTS, search_part, s);
    return MPS_OK;
}

/* Forget how many pairs there were if this search is of another kind than the last. */
static void expect(mps_neighbours *l, int64_t n, double re_far)
{
    const bool alike = n == l->n && re_far == l->re_far && l->partial == (l->kind != NULL) && l->dummy_rows == l->had_dummy_rows;
    for (int p = 0; p < MPS__PARTS && !alike; p++) l->span[p].used = 0;
}

mps_status mps__neighbours_search(mps_neighbours *l, int64_t n, const double *x, double re_near, double re_far)
{
    const bool sorted = l->sorted;
    if (!sorted) MPS__TRY(mps__neighbours_order(l, n, x, re_far));
    l->sorted = l->valid = false;
    MPS__TRY(reserve(l, n));
    if (re_near < re_far) MPS__TRY(mps__neighbours_fit(l, (void **)&l->far_end, &l->far_capacity, n, sizeof *l->far_end));
    expect(l, n, re_far);
    l->end = re_near < re_far ? l->far_end : l->middle;
    l->partial = l->kind != NULL;
    l->had_dummy_rows = l->dummy_rows;
    l->n = n;
    l->x = x;
    l->re_near = re_near;
    l->re_far = re_far;
    mps_parallel_rows(l->parallel, n, gather_places, l);
    if (l->kind) count_kinds(l);
    searching s = {.l = l, .rings = mps__rings_of(l), .reach2 = (re_far + l->skin) * (re_far + l->skin), .sorted = sorted};
    MPS__TRY(search_rows(l, &s));
    MPS__TRY(mps__neighbours_part_long(l));
    memcpy(l->searched, x, (size_t)(n * l->dim) * sizeof *x);
    l->kind = NULL;
    l->valid = true;
    return MPS_OK;
}
