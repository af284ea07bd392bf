/* SPDX-License-Identifier: BSD-3-Clause */
/* Search of pairs: cells as sorted 64-bit keys (x fastest), candidates with a skin, exact rows at every step. */
#include "neighbours.h"
#include <math.h>
#include <mps/operators.h>
#include <string.h>

enum { MPS__BITS_2D = 31, MPS__BITS_3D = 21 };

/* More particles in one cell are no cloud but an array nobody filled: n^2 pairs would take all memory. */
enum { MPS__CROWD = 4096 };

/* Places looked at between two copies of what was found. */
enum { MPS__CHUNK = 256 };

/* Parts of the particles whose rows are made by one thread each. */
enum { MPS__PARTS = 64 };

/* Functions compiled for each constant `dim`. */
#define MPS__DIM_INLINE static inline __attribute__((always_inline))

/* Pairs nearer than this [dp] have no direction and are left out: they are the two faces of a thin plate. */
static const double coincident = 1e-6;

typedef struct cell_map {
    double lo[3], size;
    int bits, dim;
} cell_map;

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

/* Upper corner of the particles' box, and the negative of the lower one; infinity where a position is no number. */
static void corner_rows(void *argument, int64_t begin, int64_t end, double *values)
{
    const cloud *c = argument;
    const int dim = c->l->dim;
    for (int d = 0; d < dim; d++) {
        double hi = values[d], lo = values[dim + d];
        bool unknown = false;
        for (int64_t i = begin; i < end; i++) {
            const double v = c->x[i * dim + d];
            if (v > hi) hi = v;
            if (-v > lo) lo = -v;
            unknown |= v != v;
        }
        values[d] = unknown ? INFINITY : hi;
        values[dim + d] = lo;
    }
}

/* Box of the particles and the packing of cell numbers into keys. */
static mps_status map_cells(mps_neighbours *l, int64_t n, const double *x, double size, cell_map *m)
{
    *m = (cell_map){.size = size, .dim = l->dim, .bits = l->dim == 2 ? MPS__BITS_2D : MPS__BITS_3D};
    const double limit = (double)(INT64_C(1) << m->bits) - 4.0;
    double corner[6] = {-INFINITY, -INFINITY, -INFINITY, -INFINITY, -INFINITY, -INFINITY};
    mps_parallel_max(l->parallel, n, 2 * l->dim, corner_rows, &(cloud){l, x}, corner);
    for (int d = 0; d < l->dim; d++) {
        const double lo = -corner[l->dim + d], hi = corner[d];
        const bool fits = (hi - lo) / size < limit;
        int64_t far = 0;
        while (!fits && far < n - 1 && x[far * l->dim + d] < hi) far++;
        MPS__CHECK(l->context, fits, "particles lie %g m apart along axis %d (particle %lld at %g): at most %g m", hi - lo, d,
                   (long long)far, x[far * l->dim + d], limit * size);
        m->lo[d] = lo - 2 * size; /* cell 0 stays empty, also when far from the origin lo - size rounds: neighbours never wrap */
    }
    return MPS_OK;
}

/* Positions lie in the box of map_cells(); the number of a cell is bounded all the same, so that no position can be cast out of range. */
static uint64_t cell_key(const cell_map *m, const double *x)
{
    const double last = (double)((INT64_C(1) << m->bits) - 2);
    uint64_t key = 0;
    for (int d = m->dim - 1; d >= 0; d--) key = (key << m->bits) | (uint64_t)fmin(fmax((x[d] - m->lo[d]) / m->size, 0), last);
    return key;
}

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
    } a[] = {{(void **)&l->begin, wanted + 1, sizeof *l->begin, NULL},
             {(void **)&l->middle, wanted, sizeof *l->middle, NULL},
             {(void **)&l->near_begin, wanted + 1, sizeof *l->near_begin, NULL},
             {(void **)&l->searched, wanted * l->dim, sizeof *l->searched, NULL},
             {(void **)&l->idle, wanted, sizeof *l->idle, NULL}};
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

/* Refuse cells with too many particles; keys are sorted. */
static mps_status check_crowds(const mps_neighbours *l, int64_t n, const double *x, double size)
{
    for (int64_t from = 0, to = 0; from < n; from = to) {
        while (to < n && l->key[to] == l->key[from]) to++;
        const double *at = x + (int64_t)l->order[from] * l->dim;
        MPS__CHECK(l->context, to - from <= MPS__CROWD,
                   "%lld particles lie within %g m of each other, particle %d at (%g, %g) m is one: at most %d", (long long)(to - from),
                   size, l->order[from], at[0], at[1], MPS__CROWD);
    }
    return MPS_OK;
}

typedef struct keying {
    mps_neighbours *l;
    const cell_map *m;
    const double *x;
} keying;

static void key_rows(void *argument, int64_t begin, int64_t end)
{
    const keying *k = argument;
    for (int64_t i = begin; i < end; i++) {
        k->l->key[i] = cell_key(k->m, k->x + i * k->l->dim);
        k->l->order[i] = (int32_t)i;
    }
}

static mps_status sort_cells(mps_neighbours *l, int64_t n, const double *x, double re_far, cell_map *m)
{
    l->valid = l->sorted = false;
    MPS__TRY(reserve(l, n));
    l->key = mps__scratch_take(l->context, l->shared, 0, 2 * n, sizeof *l->key);
    l->order = mps__scratch_take(l->context, l->shared, 1, 2 * n, sizeof *l->order);
    if (!l->key || !l->order) return MPS_E_NOMEM;
    MPS__TRY(map_cells(l, n, x, re_far + l->skin, m));
    mps_parallel_rows(l->parallel, n, key_rows, &(keying){l, m, x});
    mps__sort_keys(l->key, l->order, n);
    return check_crowds(l, n, x, m->size);
}

mps_status mps__neighbours_order(mps_neighbours *l, int64_t n, const double *x, double re_far)
{
    cell_map m;
    return sort_cells(l, n, x, re_far, &m);
}

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
static int ranges_around(const mps_neighbours *l, const cell_map *m, uint64_t key, int64_t range[9][2])
{
    int count = 0;
    for (int dz = m->dim == 3 ? -1 : 0; dz <= (m->dim == 3 ? 1 : 0); dz++)
        for (int dy = -1; dy <= 1; dy++) {
            int64_t step = (int64_t)dy * (INT64_C(1) << m->bits) + (m->dim == 3 ? (int64_t)dz * (INT64_C(1) << (2 * m->bits)) : 0);
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

static inline double distance2(const double *x, int64_t i, int64_t j, int dim)
{
    return mps__square_between(x + i * dim, x + j * dim, dim);
}

static void sort_row(int32_t *row, int64_t n)
{
    for (int64_t k = 1; k < n; k++) {
        int32_t v = row[k];
        int64_t j = k;
        for (; j > 0 && row[j - 1] > v; j--) row[j] = row[j - 1];
        row[j] = v;
    }
}

/* Positions of the sorted places, one axis after the other, so that loops over places run along memory. They borrow
 * l->searched, which takes its own values after the search. */
static void gather_places(void *argument, int64_t begin, int64_t end)
{
    mps_neighbours *l = argument;
    for (int64_t a = begin; a < end; a++)
        for (int d = 0; d < l->dim; d++) l->searched[d * l->n + a] = l->x[(int64_t)l->order[a] * l->dim + d];
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
}

/* Places of a range nearer to place a than reach; a itself is one of them if it lies in the range. */
MPS__DIM_INLINE int64_t count_range(const mps_neighbours *l, int64_t a, const int64_t range[2], double reach2, const int dim)
{
    int64_t count = 0;
    for (int64_t from = range[0]; from < range[1]; from += MPS__CHUNK) {
        const int64_t to = from + MPS__CHUNK < range[1] ? from + MPS__CHUNK : range[1];
        double r2[MPS__CHUNK];
        measure_places(l, a, from, to, dim, r2);
        for (int64_t k = 0; k < to - from; k++) count += r2[k] < reach2;
    }
    return count;
}

/* Store the particles of a range nearer to place a, without its own. Compaction without branches: every second or third place is
 * near, and no processor guesses which. */
MPS__DIM_INLINE int64_t fill_range(const mps_neighbours *l, int64_t a, const int64_t range[2], double reach2, int32_t *row, const int dim)
{
    int64_t count = 0;
    for (int64_t from = range[0]; from < range[1]; from += MPS__CHUNK) {
        const int64_t to = from + MPS__CHUNK < range[1] ? from + MPS__CHUNK : range[1];
        int32_t found[MPS__CHUNK + 1];
        double r2[MPS__CHUNK];
        int64_t n = 0;
        measure_places(l, a, from, to, dim, r2);
        for (int64_t b = from; b < to; b++) {
            found[n] = l->order[b];
            n += (r2[b - from] < reach2) & (b != a);
        }
        for (int64_t k = 0; k < n; k++) row[count + k] = found[k];
        count += n;
    }
    return count;
}

/* Is there fluid in the cells of these ranges? Yes where nobody knows the kinds. */
static bool any_fluid(const mps_neighbours *l, int64_t range[9][2], int ranges)
{
    if (!l->kind) return true;
    for (int k = 0; k < ranges; k++)
        for (int64_t b = range[k][0]; b < range[k][1]; b++)
            if (l->kind[l->order[b]] == MPS_FLUID) return true;
    return false;
}

/* A solid without fluid among its candidates. */
static bool is_idle(const mps_neighbours *l, int64_t i, const int32_t *row, int64_t count)
{
    if (!l->kind || l->kind[i] == MPS_FLUID) return false;
    for (int64_t k = 0; k < count; k++)
        if (l->kind[row[k]] == MPS_FLUID) return false;
    return true;
}

/* Count (fill = false) or store candidates of all particles of the cell that starts at sorted place `first`. */
MPS__DIM_INLINE void search_cell(mps_neighbours *l, const cell_map *m, int64_t first, double reach2, bool fill, const int dim)
{
    int64_t range[9][2];
    int ranges = ranges_around(l, m, l->key[first], range);
    const bool alone = !any_fluid(l, range, ranges);
    if (alone) ranges = 0;
    for (int64_t a = first; a < l->n && l->key[a] == l->key[first]; a++) {
        const int32_t i = l->order[a];
        int64_t count = 0;
        if (fill) {
            int32_t *row = l->col + l->begin[i];
            for (int k = 0; k < ranges; k++) count += fill_range(l, a, range[k], reach2, row + count, dim);
            sort_row(row, count);
            l->idle[i] = is_idle(l, i, row, count);
        } else {
            for (int k = 0; k < ranges; k++) count += count_range(l, a, range[k], reach2, dim);
            l->begin[i + 1] = alone ? 0 : count - 1; /* without itself */
        }
    }
}

typedef struct searching {
    mps_neighbours *l;
    const cell_map *m;
    double reach;
    bool fill;
} searching;

/* The cells that begin in one of MPS__PARTS parts of the sorted places. */
static void search_part(void *argument, int32_t part)
{
    const searching *s = argument;
    mps_neighbours *l = s->l;
    for (int64_t a = l->n * part / MPS__PARTS; a < l->n * (part + 1) / MPS__PARTS; a++) {
        if (a > 0 && l->key[a] == l->key[a - 1]) continue;
        if (l->dim == 2)
            search_cell(l, s->m, a, s->reach * s->reach, s->fill, 2);
        else
            search_cell(l, s->m, a, s->reach * s->reach, s->fill, 3);
    }
}

/* Room for `count` entries, not kept and not zeroed in what was there. Too much is given back: the first search has rows of all solids. */
static mps_status fit(mps_neighbours *l, void **block, int64_t *capacity, int64_t count, size_t size)
{
    if (*block && *capacity >= count && *capacity < count + count / 4 + 1024) return MPS_OK;
    mps__free(l->context, *block);
    *capacity = 0;
    *block = mps__alloc(l->context, count + count / 32, size);
    if (!*block) return MPS_E_NOMEM;
    *capacity = count + count / 32;
    return MPS_OK;
}

mps_status mps__neighbours_search(mps_neighbours *l, int64_t n, const double *x, double re_near, double re_far)
{
    cell_map m = {.dim = l->dim, .bits = l->dim == 2 ? MPS__BITS_2D : MPS__BITS_3D};
    if (!l->sorted) MPS__TRY(sort_cells(l, n, x, re_far, &m));
    l->sorted = false;
    l->partial = l->kind != NULL;
    l->n = n;
    l->x = x;
    l->re_near = re_near;
    l->re_far = re_far;
    searching s = {.l = l, .m = &m, .reach = re_far + l->skin};
    l->begin[0] = 0;
    mps_parallel_rows(l->parallel, n, gather_places, l);
    mps_parallel_run(l->parallel, MPS__PARTS, search_part, &s);
    l->longest = 0;
    for (int64_t i = 0; i < n; i++) {
        if (l->begin[i + 1] > l->longest) l->longest = l->begin[i + 1];
        l->begin[i + 1] += l->begin[i];
    }
    if (re_near < re_far) MPS__TRY(fit(l, (void **)&l->far_end, &l->far_capacity, n, sizeof *l->far_end));
    l->end = re_near < re_far ? l->far_end : l->middle;
    MPS__TRY(fit(l, (void **)&l->scratch, &l->scratch_capacity, MPS__PARTS * 2 * l->longest, sizeof *l->scratch));
    MPS__TRY(fit(l, (void **)&l->col, &l->pair_capacity, l->begin[n], sizeof *l->col));
    s.fill = true;
    mps_parallel_run(l->parallel, MPS__PARTS, search_part, &s);
    for (int64_t i = 0; i < n; i++) l->middle[i] = l->end[i] = l->begin[i]; /* not parted yet */
    memcpy(l->searched, x, (size_t)(n * l->dim) * sizeof *x);
    l->kind = NULL;
    l->valid = true;
    return MPS_OK;
}

/* Squares of the distances between which pairs are near, far and out of reach. */
typedef struct rings {
    double least, near2, far2;
} rings;

/* Whether the squared distances of i to some of its candidates are all in [least, most). */
MPS__DIM_INLINE bool all_between(const mps_neighbours *l, int64_t i, const int32_t *row, int64_t count, const double ring[2], const int dim)
{
    double nearest = INFINITY, farthest = 0;
    for (int64_t k = 0; k < count; k++) {
        const double r2 = distance2(l->x, i, row[k], dim);
        nearest = r2 < nearest ? r2 : nearest;
        farthest = r2 > farthest ? r2 : farthest;
    }
    return nearest >= ring[0] && farthest < ring[1];
}

/* Whether each candidate is still in the part where the last step put it: then the row is what it should be. */
MPS__DIM_INLINE bool row_stands(const mps_neighbours *l, int64_t i, const rings *g, const int dim)
{
    const int32_t *row = l->col;
    const double near[2] = {g->least, g->near2}, far[2] = {g->near2, g->far2}, out[2] = {g->far2, INFINITY};
    return all_between(l, i, row + l->begin[i], l->middle[i] - l->begin[i], near, dim) &&
           all_between(l, i, row + l->middle[i], l->end[i] - l->middle[i], far, dim) &&
           all_between(l, i, row + l->end[i], l->begin[i + 1] - l->end[i], out, dim);
}

/* One row parted: near pairs, the others within reach, what is out of it, the last two by way of `scratch`. Each candidate is written to
 * all three and counted at one: no branches. Few have changed their part since the last step, so that sorting is short work. */
MPS__DIM_INLINE void exact_row(mps_neighbours *l, int64_t i, const rings *g, int32_t *scratch, const int dim)
{
    if (l->idle[i] || row_stands(l, i, g, dim)) return;
    const int64_t count = l->begin[i + 1] - l->begin[i];
    int32_t *const row = l->col + l->begin[i], *const far = scratch, *const out = scratch + l->longest;
    int64_t nears = 0, fars = 0, outs = 0;
    for (int64_t k = 0; k < count; k++) {
        const int32_t j = row[k];
        const double r2 = distance2(l->x, i, j, dim);
        const bool within = (r2 < g->far2) & (r2 >= g->least), close = within & (r2 < g->near2);
        row[nears] = far[fars] = out[outs] = j;
        nears += close;
        fars += within & !close;
        outs += !within;
    }
    memcpy(row + nears, far, (size_t)fars * sizeof *row);
    memcpy(row + nears + fars, out, (size_t)outs * sizeof *row);
    sort_row(row, nears);
    sort_row(row + nears, fars);
    l->middle[i] = l->begin[i] + nears;
    l->end[i] = l->middle[i] + fars;
}

/* Pairs from..to-1 that see each other change places with those from `out` on; they stay in order. Returns the end. */
static int64_t keep_visible(mps_neighbours *l, const mps__seer *a, int64_t from, int64_t to, int64_t out)
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

static void exact_part(void *argument, int32_t part)
{
    mps_neighbours *l = argument;
    const rings g = {coincident * coincident * l->dp * l->dp, l->re_near * l->re_near, l->re_far * l->re_far};
    int32_t *scratch = l->scratch + 2 * l->longest * part;
    for (int64_t i = l->n * part / MPS__PARTS; i < l->n * (part + 1) / MPS__PARTS; i++) {
        if (l->dim == 2)
            exact_row(l, i, &g, scratch, 2);
        else
            exact_row(l, i, &g, scratch, 3);
    }
}

void mps__neighbours_rows(mps_neighbours *l, const double *x)
{
    l->x = x;
    mps_parallel_run(l->parallel, MPS__PARTS, exact_part, l);
    if (l->screens && l->screens->count > 0) mps_parallel_rows(l->parallel, l->screens->seers, screen_rows, l);
}

mps_status mps__neighbours_near(mps_neighbours *l)
{
    l->near_begin[0] = 0;
    for (int64_t i = 0; i < l->n; i++) l->near_begin[i + 1] = l->near_begin[i] + l->middle[i] - l->begin[i];
    MPS__TRY(fit(l, (void **)&l->near_col, &l->near_capacity, l->near_begin[l->n], sizeof *l->near_col));
    return fit(l, (void **)&l->w_r2, &l->weight_capacity, l->near_begin[l->n], sizeof *l->w_r2);
}
