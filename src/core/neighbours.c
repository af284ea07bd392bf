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

/* Functions compiled for each constant `dim`. */
#define MPS__DIM_INLINE static inline __attribute__((always_inline))

/* Skin [dp]: a search is good until some particle moved half of it. */
static const double skin_of_dp = 0.25;

/* Pairs nearer than this [dp] have no direction and are left out: they are the two faces of a thin plate. */
static const double coincident = 1e-6;

typedef struct cell_map {
    double lo[3], size;
    int bits, dim;
} cell_map;

mps_status mps__neighbours_init(mps_neighbours *l, mps__context *context, int32_t dim, double dp)
{
    *l = (mps_neighbours){.context = context, .dim = dim, .dp = dp, .threads = 1, .skin = skin_of_dp * dp};
    return MPS_OK;
}

void mps__neighbours_free(mps_neighbours *l)
{
    void *all[] = {l->begin, l->middle, l->end, l->col, l->w_r2, l->candidate_row, l->candidate, l->searched, l->key, l->order};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) mps__free(l->context, all[k]);
    mps__neighbours_init(l, l->context, l->dim, l->dp);
}

bool mps__neighbours_fresh(const mps_neighbours *l, int64_t n, const double *x, double re_far)
{
    if (!l->valid || n != l->n || re_far != l->re_far) return false;
    const double limit = 0.25 * l->skin * l->skin;
    double worst = 0;
    const int dim = l->dim;
#pragma omp parallel for num_threads(l->threads) reduction(max : worst) schedule(static)
    for (int64_t i = 0; i < n; i++) {
        double s = 0;
        for (int d = 0; d < dim; d++) {
            double m = x[i * dim + d] - l->searched[i * dim + d];
            s += m * m;
        }
        if (s > worst) worst = s;
    }
    return worst < limit;
}

/* Box of the particles and the packing of cell numbers into keys. */
static mps_status map_cells(mps_neighbours *l, int64_t n, const double *x, double size, cell_map *m)
{
    *m = (cell_map){.size = size, .dim = l->dim, .bits = l->dim == 2 ? MPS__BITS_2D : MPS__BITS_3D};
    const double limit = (double)(INT64_C(1) << m->bits) - 4.0;
    for (int d = 0; d < l->dim; d++) {
        double lo = x[d], hi = x[d];
        int64_t far = 0;
        for (int64_t i = 1; i < n; i++) {
            double v = x[i * l->dim + d];
            if (v < lo) lo = v;
            if (v > hi) {
                hi = v;
                far = i;
            }
        }
        MPS__CHECK(l->context, (hi - lo) / size < limit, "particles lie %g m apart along axis %d (particle %lld at %g): at most %g m",
                   hi - lo, d, (long long)far, hi, limit * size);
        m->lo[d] = lo - 2 * size; /* cell 0 stays empty, also when far from the origin lo - size rounds: neighbours never wrap */
    }
    return MPS_OK;
}

static uint64_t cell_key(const cell_map *m, const double *x)
{
    uint64_t key = 0;
    for (int d = m->dim - 1; d >= 0; d--) key = (key << m->bits) | (uint64_t)((x[d] - m->lo[d]) / m->size);
    return key;
}

/* Stable least-significant-digit radix sort of (key, order); only digits that differ are passed over. */
static void sort_keys(uint64_t *key, int32_t *order, int64_t n)
{
    uint64_t *k0 = key, *k1 = key + n;
    int32_t *o0 = order, *o1 = order + n;
    uint64_t differ = 0;
    for (int64_t i = 1; i < n; i++) differ |= k0[i] ^ k0[0];
    for (int shift = 0; shift < 64; shift += 8) {
        if (!((differ >> shift) & 255)) continue;
        int64_t count[257] = {0};
        for (int64_t i = 0; i < n; i++) count[((k0[i] >> shift) & 255) + 1]++;
        for (int b = 0; b < 256; b++) count[b + 1] += count[b];
        for (int64_t i = 0; i < n; i++) {
            int64_t to = count[(k0[i] >> shift) & 255]++;
            k1[to] = k0[i];
            o1[to] = o0[i];
        }
        uint64_t *k = k0;
        int32_t *o = o0;
        k0 = k1, k1 = k;
        o0 = o1, o1 = o;
    }
    if (k0 != key) {
        memcpy(key, k0, (size_t)n * sizeof *key);
        memcpy(order, o0, (size_t)n * sizeof *order);
    }
}

static mps_status reserve(mps_neighbours *l, int64_t n)
{
    if (n <= l->capacity) return MPS_OK;
    mps__context *c = l->context;
    int64_t wanted = n + n / 8;
    struct {
        void **place;
        int64_t count;
        size_t size;
        void *fresh;
    } a[] = {{(void **)&l->begin, wanted, sizeof *l->begin, NULL},
             {(void **)&l->middle, wanted, sizeof *l->middle, NULL},
             {(void **)&l->end, wanted, sizeof *l->end, NULL},
             {(void **)&l->candidate_row, wanted + 1, sizeof *l->candidate_row, NULL},
             {(void **)&l->searched, wanted * l->dim, sizeof *l->searched, NULL},
             {(void **)&l->key, 2 * wanted, sizeof *l->key, NULL},
             {(void **)&l->order, 2 * wanted, sizeof *l->order, NULL}};
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

static mps_status sort_cells(mps_neighbours *l, int64_t n, const double *x, double re_far, cell_map *m)
{
    l->valid = false;
    MPS__TRY(reserve(l, n));
    MPS__TRY(map_cells(l, n, x, re_far + l->skin, m));
    for (int64_t i = 0; i < n; i++) {
        l->key[i] = cell_key(m, x + i * l->dim);
        l->order[i] = (int32_t)i;
    }
    sort_keys(l->key, l->order, n);
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

static double distance2(const double *x, int64_t i, int64_t j, int dim)
{
    double s = 0;
    for (int d = 0; d < dim; d++) {
        double m = x[j * dim + d] - x[i * dim + d];
        s += m * m;
    }
    return s;
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
static void gather_places(mps_neighbours *l)
{
#pragma omp parallel for num_threads(l->threads) schedule(static)
    for (int64_t a = 0; a < l->n; a++)
        for (int d = 0; d < l->dim; d++) l->searched[d * l->n + a] = l->x[(int64_t)l->order[a] * l->dim + d];
}

/* Squared distance of two places; `axis` says where their coordinates begin. */
static inline double place_distance2(const double *const axis[3], int64_t a, int64_t b, const int dim)
{
    const double dx = axis[0][b] - axis[0][a], dy = axis[1][b] - axis[1][a];
    if (dim == 2) return dx * dx + dy * dy;
    const double dz = axis[2][b] - axis[2][a];
    return dx * dx + dy * dy + dz * dz;
}

/* Places of a range nearer to place a than reach; a itself is one of them if it lies in the range. */
MPS__DIM_INLINE int64_t count_range(const mps_neighbours *l, int64_t a, const int64_t range[2], double reach2, const int dim)
{
    const double *const axis[3] = {l->searched, l->searched + l->n, l->searched + (dim - 1) * l->n};
    int64_t count = 0;
    for (int64_t b = range[0]; b < range[1]; b++) count += place_distance2(axis, a, b, dim) < reach2;
    return count;
}

/* Store the particles of a range nearer to place a, without its own. Compaction without branches: every second or third place is
 * near, and no processor guesses which. */
MPS__DIM_INLINE int64_t fill_range(const mps_neighbours *l, int64_t a, const int64_t range[2], double reach2, int32_t *row, const int dim)
{
    const double *const axis[3] = {l->searched, l->searched + l->n, l->searched + (dim - 1) * l->n};
    int64_t count = 0;
    for (int64_t from = range[0]; from < range[1]; from += MPS__CHUNK) {
        const int64_t to = from + MPS__CHUNK < range[1] ? from + MPS__CHUNK : range[1];
        int32_t found[MPS__CHUNK + 1];
        int64_t n = 0;
        for (int64_t b = from; b < to; b++) {
            found[n] = l->order[b];
            n += (place_distance2(axis, a, b, dim) < reach2) & (b != a);
        }
        memcpy(row + count, found, (size_t)n * sizeof *found);
        count += n;
    }
    return count;
}

/* Count (fill = false) or store candidates of all particles of the cell that starts at sorted place `first`. */
MPS__DIM_INLINE void search_cell(mps_neighbours *l, const cell_map *m, int64_t first, double reach2, bool fill, const int dim)
{
    int64_t range[9][2];
    const int ranges = ranges_around(l, m, l->key[first], range);
    for (int64_t a = first; a < l->n && l->key[a] == l->key[first]; a++) {
        const int32_t i = l->order[a];
        int64_t count = 0;
        if (fill) {
            int32_t *row = l->candidate + l->candidate_row[i];
            for (int k = 0; k < ranges; k++) count += fill_range(l, a, range[k], reach2, row + count, dim);
            sort_row(row, count);
        } else {
            for (int k = 0; k < ranges; k++) count += count_range(l, a, range[k], reach2, dim);
            l->candidate_row[i + 1] = count - 1;
        }
    }
}

static void search_cells(mps_neighbours *l, const cell_map *m, double reach, bool fill)
{
#pragma omp parallel for num_threads(l->threads) schedule(dynamic, 256)
    for (int64_t a = 0; a < l->n; a++) {
        if (a > 0 && l->key[a] == l->key[a - 1]) continue;
        if (l->dim == 2)
            search_cell(l, m, a, reach * reach, fill, 2);
        else
            search_cell(l, m, a, reach * reach, fill, 3);
    }
}

mps_status mps__neighbours_search(mps_neighbours *l, int64_t n, const double *x, double re_near, double re_far)
{
    cell_map m;
    MPS__TRY(sort_cells(l, n, x, re_far, &m));
    l->n = n;
    l->x = x;
    l->re_near = re_near;
    l->re_far = re_far;
    const double reach = re_far + l->skin;
    l->candidate_row[0] = 0;
    gather_places(l);
    search_cells(l, &m, reach, false);
    for (int64_t i = 0; i < n; i++) l->candidate_row[i + 1] += l->candidate_row[i];
    int64_t pairs = l->candidate_row[n] > 0 ? l->candidate_row[n] : 1, capacity = l->candidate_capacity; /* never a NULL list */
    MPS__TRY(mps__grow(l->context, (void **)&l->candidate, &capacity, 0, pairs, sizeof *l->candidate));
    l->candidate_capacity = capacity;
    MPS__TRY(mps__grow(l->context, (void **)&l->col, &l->pair_capacity, 0, pairs, sizeof *l->col));
    search_cells(l, &m, reach, true);
    memcpy(l->searched, x, (size_t)(n * l->dim) * sizeof *x);
    l->valid = true;
    return MPS_OK;
}

static void reverse(int32_t *a, int64_t n)
{
    for (int64_t k = 0; k < n / 2; k++) {
        int32_t v = a[k];
        a[k] = a[n - 1 - k];
        a[n - 1 - k] = v;
    }
}

/* One row, in the room its candidates take: near pairs grow from the front, the others from the back. Each candidate is written to
 * both ends and counted at one or none: the room left is never less than the candidates left, and there are no branches. */
MPS__DIM_INLINE void exact_row(mps_neighbours *l, const double *x, int64_t i, const int dim)
{
    const double near2 = l->re_near * l->re_near, far2 = l->re_far * l->re_far, least = coincident * coincident * l->dp * l->dp;
    const int64_t from = l->candidate_row[i], to = l->candidate_row[i + 1];
    int32_t *const col = l->col;
    int64_t front = from, back = to;
    for (int64_t k = from; k < to; k++) {
        const int32_t j = l->candidate[k];
        const double r2 = distance2(x, i, j, dim);
        col[front] = col[back - 1] = j;
        front += (r2 < near2) & (r2 >= least);
        back -= (r2 >= near2) & (r2 < far2);
    }
    if (front < back) memmove(col + front, col + back, (size_t)(to - back) * sizeof *col);
    reverse(col + front, to - back);
    l->begin[i] = from;
    l->middle[i] = front;
    l->end[i] = front + (to - back);
}

/* Pairs from..to-1 that see each other, moved to `out`; they stay in order. Returns the end. */
static int64_t keep_visible(mps_neighbours *l, const mps__seer *a, int64_t from, int64_t to, int64_t out)
{
    const mps__screens *s = l->screens;
    for (int64_t k = from; k < to; k++) {
        const int32_t j = l->col[k], slot = s->slot[j];
        if (slot < 0 || !mps__screens_hidden(s, a, &s->seer[slot])) l->col[out++] = j;
    }
    return out;
}

/* Take away what screens hide. */
static void screen_rows(mps_neighbours *l)
{
#pragma omp parallel for num_threads(l->threads) schedule(static)
    for (int64_t k = 0; k < l->screens->seers; k++) {
        const mps__seer *a = &l->screens->seer[k];
        const int64_t i = a->particle, middle = l->middle[i], end = l->end[i];
        l->middle[i] = keep_visible(l, a, l->begin[i], middle, l->begin[i]);
        l->end[i] = keep_visible(l, a, middle, end, l->middle[i]);
    }
}

mps_status mps__neighbours_rows(mps_neighbours *l, const double *x)
{
    l->x = x;
#pragma omp parallel for num_threads(l->threads) schedule(static)
    for (int64_t i = 0; i < l->n; i++) {
        if (l->dim == 2)
            exact_row(l, x, i, 2);
        else
            exact_row(l, x, i, 3);
    }
    if (l->screens && l->screens->count > 0) screen_rows(l);
    return MPS_OK;
}

mps_status mps__neighbours_weights(mps_neighbours *l)
{
    if (l->weight_capacity >= l->pair_capacity) return MPS_OK;
    mps__free(l->context, l->w_r2); /* nothing in it outlives a step */
    l->weight_capacity = 0;
    l->w_r2 = mps__alloc(l->context, l->pair_capacity, sizeof *l->w_r2);
    if (!l->w_r2) return MPS_E_NOMEM;
    l->weight_capacity = l->pair_capacity;
    return MPS_OK;
}

/* ---- a list that stands alone ---------------------------------------------------------------------------------- */

mps_status mps_neighbours_create(int32_t dim, double dp, const mps_allocator *allocator, mps_neighbours **list)
{
    if (!list) return MPS_E_ARG;
    *list = NULL;
    if ((dim != 2 && dim != 3) || !(dp > 0) || !isfinite(dp)) return MPS_E_ARG;
    if (allocator && (!allocator->alloc || !allocator->release)) return MPS_E_ARG;
    mps__context c = {.allocator = allocator ? *allocator : mps__allocator_default()};
    mps_neighbours *l = mps__alloc(&c, 1, sizeof *l);
    if (!l) return MPS_E_NOMEM;
    mps__neighbours_init(l, NULL, dim, dp);
    l->own = c;
    l->context = &l->own;
    *list = l;
    return MPS_OK;
}

void mps_neighbours_destroy(mps_neighbours *list)
{
    if (!list) return;
    mps__context c = list->own;
    mps__neighbours_free(list);
    mps__free(&c, list);
}

mps_status mps_neighbours_build(mps_neighbours *list, int64_t n, const double *x, double re_near, double re_far)
{
    if (!list) return MPS_E_ARG;
    list->valid = false;
    list->n = 0;
    if (!x || n < 1 || n > INT32_MAX || !(re_near > 0) || !(re_far >= re_near) || !isfinite(re_far)) return MPS_E_ARG;
    if (!mps__finite(x, n * list->dim)) return MPS_E_ARG;
    list->skin = 0; /* every build searches anew */
    mps_status status = mps__neighbours_search(list, n, x, re_near, re_far);
    if (status == MPS_OK) status = mps__neighbours_rows(list, x);
    if (status != MPS_OK) list->n = 0;
    return status;
}

mps_status mps_neighbours_stencil(const mps_neighbours *list, int32_t which, const mps_kernel *kernel, mps_stencil *stencil)
{
    if (!list || !kernel || !stencil || list->n == 0 || (which != MPS_NEAR && which != MPS_FAR)) return MPS_E_ARG;
    double re = which == MPS_NEAR ? list->re_near : list->re_far, n0, lambda;
    MPS__TRY(mps_lattice_constants(kernel, list->dim, list->dp, re, &n0, &lambda));
    *stencil = (mps_stencil){.struct_size = sizeof *stencil,
                             .dim = list->dim,
                             .n = list->n,
                             .dp = list->dp,
                             .re = re,
                             .n0 = n0,
                             .lambda = lambda,
                             .kernel = *kernel,
                             .threads = list->threads,
                             .x = list->x,
                             .begin = list->begin,
                             .end = which == MPS_NEAR ? list->middle : list->end,
                             .col = list->col};
    return MPS_OK;
}
