/* SPDX-License-Identifier: BSD-3-Clause */
/* The order of particles by their cells. */
#include "neighbours.h"
#include "loop.h"
#include "sort.h"
#include <math.h>
#include <string.h>

enum { MPS__BITS_2D = 31, MPS__BITS_3D = 21 };

/* More particles in one cell mean that positions were never set: n^2 pairs would exhaust the
 * memory. */
enum { MPS__CROWD = 4096 };

/* Cells are wider than the reach by this fraction, so that rounding of a cell index cannot lose a
 * pair. */
static const double margin = 1e-6;

int mps__cell_bits(int32_t dim)
{
    return dim == 2 ? MPS__BITS_2D : MPS__BITS_3D;
}

typedef struct corners {
    const double *x;
} corners;

/* Stable least-significant-digit radix sort of (key, order); passes only over digits that
 * differ. */
void mps__sort_keys(uint64_t *key, int32_t *order, int64_t n)
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

/* Upper corner of the particles' box, then the negative of the lower one; infinite if a position is
 * not finite. */
MPS_ROW void corner_row(const int dim, const corners *c, int64_t i, double *values)
{
    for (int d = 0; d < dim; d++) {
        const double v = c->x[i * dim + d];
        if (v > values[d]) values[d] = v;
        if (-v > values[3 + d]) values[3 + d] = -v;
        if (v != v) values[d] = INFINITY;
    }
}
MPS__VALUES(corner_rows, corner_row, corners, 0, 6)

/* Doubles from 2^52 on are integers. */
static inline double round_down(double v)
{
    static const double most = 4503599627370496.0; /* 2^52 */
    const double whole = fabs(v) < most ? (double)(int64_t)v : v;
    return whole > v ? whole - 1 : whole;
}

/* Name of particle i in error messages: its id, or its index if there are no ids. */
static long long name_of(const int64_t *id, int64_t i)
{
    return (long long)(id ? id[i] : i);
}

/* The particle at the upper end of the box along an axis, or one that is not finite; of several the
 * one with the least id. */
static int64_t far_particle(const mps_neighbours *l, int64_t n, const double *x, const int64_t *id,
                            int d, double hi)
{
    int64_t far = -1;
    for (int64_t i = 0; i < n; i++)
        if (!(x[i * l->dim + d] < hi) && (far < 0 || name_of(id, i) < name_of(id, far))) far = i;
    return far < 0 ? 0 : far;
}

/* Largest extent of the particles along an axis, in cells. */
static double cells_limit(const mps__cells *m)
{
    return (double)(INT64_C(1) << m->bits) - 4.0;
}

static bool box_fits(const mps__cells *m, const double corner[6], int d)
{
    return (corner[d] + corner[3 + d]) / m->size < cells_limit(m);
}

/* Box of the particles and the packing of cell indices into keys. @return whether they fit */
static bool find_cells(mps_neighbours *l, int64_t n, const double *x, double reach,
                       double corner[6])
{
    mps__cells *m = &l->cells;
    bool fits = true;
    *m = (mps__cells){.size = (1 + margin) * reach, .bits = mps__cell_bits(l->dim)};
    for (int k = 0; k < 6; k++) corner[k] = -INFINITY;
    mps__values_run(l->parallel, &corner_rows, l->dim, n, &(corners){x}, NULL, corner);
    for (int d = 0; d < l->dim; d++) {
        fits = fits && box_fits(m, corner, d);
        /* cell 0 stays empty: no neighbour is outside */
        m->first[d] = round_down(-corner[3 + d] / m->size) - 2;
    }
    return fits;
}

static mps_status map_cells(mps_neighbours *l, int64_t n, const double *x, const int64_t *id,
                            double reach)
{
    const mps__cells *m = &l->cells;
    double corner[6];
    if (find_cells(l, n, x, reach, corner)) return MPS_OK;
    for (int d = 0; d < l->dim; d++) {
        const double lo = -corner[3 + d], hi = corner[d];
        const bool fits = box_fits(m, corner, d);
        const int64_t far = fits ? 0 : far_particle(l, n, x, id, d, hi);
        MPS__CHECK(l->context, fits,
                   "particles lie %g m apart along axis %d (particle %lld at %g): at most %g m",
                   hi - lo, d, name_of(id, far), x[far * l->dim + d], cells_limit(m) * m->size);
    }
    return MPS_OK;
}

/* Positions are in the box of find_cells(). The index is clamped all the same, so that no cast is
 * out of range. */
MPS_ROW uint64_t cell_key(const int dim, const mps__cells *m, const double *x)
{
    const double last = (double)((INT64_C(1) << m->bits) - 2);
    uint64_t key = 0;
    for (int d = dim - 1; d >= 0; d--) {
        const double cell = round_down(x[d] / m->size) - m->first[d];
        key = (key << m->bits) | (uint64_t)(cell > 0 ? (cell < last ? cell : last) : 0);
    }
    return key;
}

/* Refuse cells with too many particles; keys are sorted. */
static mps_status check_crowds(const mps_neighbours *l, int64_t n, const double *x,
                               const int64_t *id, double size)
{
    for (int64_t from = 0, to = 0; from < n; from = to) {
        while (to < n && l->key[to] == l->key[from]) to++;
        if (to - from <= MPS__CROWD) continue;
        int64_t one = l->order[from];
        for (int64_t k = from; k < to; k++)
            if (name_of(id, l->order[k]) < name_of(id, one)) one = l->order[k];
        return mps__fail(l->context, MPS_E_ARG,
                         "%lld particles lie within %g m of each other, particle %lld at (%g, %g) "
                         "m is one: at most %d",
                         (long long)(to - from), size, name_of(id, one), x[one * l->dim],
                         x[one * l->dim + 1], MPS__CROWD);
    }
    return MPS_OK;
}

/* Sort particles of a cell by id; keys are sorted. Most are in this order since the last search. */
static void order_ties(const mps_neighbours *l, int64_t n, const int64_t *id)
{
    int32_t *const order = l->order;
    for (int64_t a = 1; a < n; a++) {
        const int32_t i = order[a];
        int64_t b = a;
        for (; b > 0 && l->key[b - 1] == l->key[a] && id[order[b - 1]] > id[i]; b--)
            order[b] = order[b - 1];
        order[b] = i;
    }
}

typedef struct keying {
    mps__cells cells;
    const double *x;
    uint64_t *key;
    int32_t *order; /* NULL: not requested */
} keying;

MPS_ROW void key_row(const int dim, const keying *k, int64_t i)
{
    k->key[i] = cell_key(dim, &k->cells, k->x + i * dim);
    if (k->order) k->order[i] = (int32_t)i;
}
MPS__LOOP(key_rows, key_row, keying)

void mps__neighbours_keys(const mps_neighbours *l, const double *x, uint64_t *key)
{
    mps__loop_run(l->parallel, &key_rows, l->dim, l->n, &(keying){l->cells, x, key, NULL});
}

mps_status mps__neighbours_order(mps_neighbours *l, int64_t n, const double *x, const int64_t *id,
                                 double re_far)
{
    l->valid = l->sorted = false;
    l->key = mps__scratch_take(l->context, l->shared, 0, 2 * n, sizeof *l->key);
    l->order = mps__scratch_take(l->context, l->shared, 1, 2 * n, sizeof *l->order);
    if (!l->key || !l->order) return MPS_E_NOMEM;
    MPS__TRY(map_cells(l, n, x, id, re_far + l->skin));
    mps__loop_run(l->parallel, &key_rows, l->dim, n, &(keying){l->cells, x, l->key, l->order});
    mps__sort_keys(l->key, l->order, n);
    MPS__TRY(check_crowds(l, n, x, id, l->cells.size));
    if (id) order_ties(l, n, id);
    return MPS_OK;
}

/* ---- on a device ---- */

MPS_ROW bool begins_crowd(const mps__sorting *m, int64_t a)
{
    return a + MPS__CROWD < m->n && m->key[a + MPS__CROWD] == m->key[a];
}
MPS__FIRST(crowds, begins_crowd, mps__sorting)

const int32_t *mps__neighbours_order_device(mps_neighbours *l, int64_t n, double re_far,
                                            const mps__order_arrays *on_device)
{
    double corner[6];
    mps__sorting m = {.n = n,
                      .run = 1,
                      .id = on_device->id,
                      .key = on_device->key,
                      .order = on_device->order,
                      .new_key = on_device->key + n,
                      .new_order = on_device->order + n};
    l->valid = l->sorted = false;
    if (!find_cells(l, n, on_device->x, re_far + l->skin, corner)) return NULL;
    mps__loop_run(l->parallel, &key_rows, l->dim, n,
                  &(keying){l->cells, on_device->x, on_device->key, on_device->order});
    mps__merge_sort(l->parallel, &m);
    return mps__first_run(l->parallel, &crowds, n, &m) == n ? m.order : NULL;
}

void mps__neighbours_sorted(mps_neighbours *l, int64_t n)
{
    for (int64_t i = 0; i < n; i++) l->order[i] = (int32_t)i;
    l->sorted = true;
}
