/* SPDX-License-Identifier: BSD-3-Clause */
/* Classification of the cells of the band. Most cells inside the liquid contain a particle or are
 * next to one, and far from it none is within the window: distances are computed only for the cells
 * in between. */
#include "loop.h"
#include "plates.h"
#include <string.h>

/* ---- distances ---- */

static bool is_hidden(const mps__voids *v, const mps__world *w, const int32_t at[3], int64_t i)
{
    double X[3];
    if (w->lists.occluders.count == 0 || w->lists.occluders.slot[i] < 0) return false;
    for (int d = 0; d < 3; d++) X[d] = v->origin[d] + (at[d] + 0.5) * v->side;
    return mps__plates_hide(w, X, i);
}

/* Whether the cell at offset `by` from cell `at` is in the band. */
static inline bool is_inside(const mps__voids *v, const int32_t at[3], const int32_t by[3])
{
    bool there = true;
    for (int d = 0; d < v->dim; d++) {
        const int32_t k = at[d] + by[d], end = d == v->dim - 1 ? v->band : v->cells[d];
        there = there && k >= 0 && k < end;
    }
    return there;
}

/* Whether the whole window around a cell is in the band. */
static inline bool is_inner(const mps__voids *v, const int32_t at[3])
{
    const int32_t low[3] = {-v->window, -v->window, -v->window},
                  high[3] = {v->window, v->window, v->window};
    return is_inside(v, at, low) && is_inside(v, at, high);
}

double mps__voids_nearest(const mps__voids *v, const mps__world *w, int64_t cell, double enough,
                          int32_t *row)
{
    const int64_t *id = w->particles.id;
    double least = v->reach2;
    int32_t at[3];
    *row = -1;
    mps__voids_place(v, cell, at);
    const bool inner = is_inner(v, at);
    for (int32_t k = 0; k < v->offsets && v->offset[k].least <= least; k++) {
        const int64_t from = cell + v->offset[k].cell;
        if ((!inner && !is_inside(v, at, v->offset[k].at)) || !v->taken[from]) continue;
        for (int32_t i = v->head[from]; i >= 0; i = v->next[i]) {
            double square = 0;
            for (int d = 0; d < v->dim; d++) {
                const double r = at[d] + 0.5 - v->place[i * v->dim + d];
                square += r * r;
            }
            if (square > least || (square == least && (*row < 0 || id[i] > id[*row]))) continue;
            if (is_hidden(v, w, at, i)) continue;
            least = square;
            *row = i;
            if (least < enough) return least;
        }
    }
    return *row < 0 ? INFINITY : least;
}

/* ---- parts of the band ---- */

typedef struct part_fields {
    mps__voids *v;
    const mps__world *w;
    int64_t n;
    int32_t slabs; /* per part */
    bool all;      /* all cells, not only those next to void: other ranks may need them */
} part_fields;

static void range_of(const part_fields *f, int64_t part, int32_t *begin, int32_t *end)
{
    *begin = (int32_t)part * f->slabs;
    *end = *begin + f->slabs < f->v->band ? *begin + f->slabs : f->v->band;
}

/* Mark the cells of the particle's octant that it reaches: its own one and the neighbours on its
 * side, so that few cells of the liquid remain undecided. `off`: position relative to the centre of
 * its cell `at`; only slabs begin .. end-1. */
MPS_ROW void mark(const int dim, mps__voids *v, const int32_t at[3], const double off[3],
                  int32_t begin, int32_t end)
{
    for (int k = 0; k < 1 << dim; k++) {
        int64_t cell = 0;
        double square = 0;
        bool there = true;
        for (int d = dim - 1; d >= 0; d--) {
            const bool beside = k >> d & 1;
            const int32_t c = at[d] + (!beside      ? 0
                                       : off[d] < 0 ? -1
                                                    : 1),
                          least = d == dim - 1 ? begin : 0, last = d == dim - 1 ? end : v->cells[d];
            const double r = beside ? 1 - fabs(off[d]) : fabs(off[d]);
            there = there && c >= least && c < last;
            cell = cell * v->cells[d] + c;
            square += r * r;
        }
        if (there && square < v->reach2) v->sure[cell] = 1;
    }
}

/* mark() for a cell with neighbours on all sides; also marks cells that share a side with it if all
 * of them are always reached. */
MPS_ROW void mark_inner(const int dim, const mps__voids *v, int64_t cell, const double off[3])
{
    uint8_t *own = v->sure + cell;
    int64_t step[3] = {0, 0, 0};
    double near[3] = {0, 0, 0}, far[3] = {0, 0, 0};
    for (int d = 0; d < dim; d++) {
        step[d] = off[d] < 0 ? -v->step[d] : v->step[d];
        near[d] = off[d] * off[d];
        far[d] = (1 - fabs(off[d])) * (1 - fabs(off[d]));
    }
    for (int d = 0; d < dim && v->beside_sure; d++) own[v->step[d]] = own[-v->step[d]] = 1;
    if (v->octant_sure) {
        for (int k = 0; k < 1 << dim; k++)
            own[(k & 1 ? step[0] : 0) + (k & 2 ? step[1] : 0) + (k & 4 ? step[2] : 0)] = 1;
        return;
    }
    for (int k = 0; k < 1 << dim; k++) {
        const double square = (k & 1 ? far[0] : near[0]) + (k & 2 ? far[1] : near[1]) +
                              (k & 4 ? far[2] : near[2]);
        own[(k & 1 ? step[0] : 0) + (k & 2 ? step[1] : 0) + (k & 4 ? step[2] : 0)] |= square <
                                                                                      v->reach2;
    }
}

/* Flags of v->taken; a particle may be slightly outside of the raster, e.g. a wall on its upper
 * side. */
enum { TAKEN = 1, TAKEN_BEYOND = 2 };

/* Assign particle i to its cell, or to the nearest one of the raster, if that is in slabs begin ..
 * end-1. */
MPS_ROW void put(const int dim, mps__voids *v, int32_t i, int32_t begin, int32_t end)
{
    const int32_t far = v->window + 1;
    int32_t at[3] = {0, 0, 0}, in[3] = {0, 0, 0};
    double off[3] = {0, 0, 0};
    bool within = true, inner = true, beyond = false;
    for (int d = 0; d < dim; d++) {
        const double x = v->place[i * dim + d];
        const int32_t most = v->cells[d] - 1, least = d == dim - 1 ? begin : 0,
                      last = d == dim - 1 ? end : v->cells[d];
        if (!(x >= -far && x < most + 1 + far)) return; /* it reaches no cell */
        at[d] = (int32_t)(x + far) - far;
        off[d] = x - at[d] - 0.5;
        in[d] = at[d] < 0 ? 0 : at[d] > most ? most : at[d];
        beyond = beyond || in[d] != at[d];
        within = within && in[d] >= least && in[d] < last;
        inner = inner && at[d] > least && at[d] + 1 < last;
    }
    const int64_t cell = in[0] + v->step[1] * in[1] + v->step[2] * in[2];
    if (within) {
        v->next[i] = v->taken[cell] ? v->head[cell] : -1;
        v->head[cell] = i;
        v->taken[cell] |= beyond ? TAKEN_BEYOND : TAKEN;
    }
    if (inner)
        mark_inner(dim, v, cell, off);
    else
        mark(dim, v, at, off, begin, end);
}

/* Mark cells with a marked one at up to `window` strides of `step`. */
static void widen(const uint8_t *from, uint8_t *to, int64_t lines, int64_t length, int64_t step,
                  int32_t window)
{
    for (int64_t line = 0; line < lines; line++)
        for (int32_t k = 1; k <= window; k++) {
            const uint8_t *a = from + line * length;
            uint8_t *b = to + line * length;
            for (int64_t c = 0; c + k * step < length; c++) b[c] |= a[c + k * step];
            for (int64_t c = k * step; c < length; c++) b[c] |= a[c - k * step];
        }
}

/* Set v->wide around the particles of a slab, within it. In 3-D by way of lines, with `what` as
 * buffer. */
static void mark_slab(mps__voids *v, int32_t z)
{
    const int64_t at = z * v->plane;
    uint8_t *taken = v->taken + at, *wide = v->wide + at, *lines = v->what + at;
    memcpy(v->dim == 2 ? wide : lines, taken, (size_t)v->plane);
    widen(taken, v->dim == 2 ? wide : lines, v->plane / v->cells[0], v->cells[0], 1, v->window);
    if (v->dim == 2) return;
    memcpy(wide, lines, (size_t)v->plane);
    widen(lines, wide, 1, v->plane, v->step[1], v->window);
}

MPS_ROW void put_row(const int dim, const part_fields *f, int64_t part)
{
    mps__voids *v = f->v;
    int32_t begin, end;
    range_of(f, part, &begin, &end);
    const int64_t first = begin * v->plane, cells = (end - begin) * v->plane;
    memset(v->taken + first, 0, (size_t)cells);
    memset(v->sure + first, 0, (size_t)cells);
    for (int64_t i = 0; i < f->n; i++)
        if (v->slab[i] >= begin - 1 && v->slab[i] <= end && v->slab[i] >= 0)
            put(dim, v, (int32_t)i, begin, end);
    for (int32_t z = begin; z < end; z++) mark_slab(v, z);
}
MPS__LOOP(put_parts, put_row, part_fields)

/* ---- classes ---- */

/* First guess: covered if a particle is surely within the channel, deep if none can be, liquid if a
 * distance has to decide. */
static void guess_line(mps__voids *v, int64_t first, int64_t z)
{
    const uint8_t *sure = v->sure + first;
    const int64_t n = v->cells[0];
    uint8_t any[256], *what = v->what + first;
    for (int64_t from = 0; from < n; from += (int64_t)sizeof any) {
        const int64_t m = n - from < (int64_t)sizeof any ? n - from : (int64_t)sizeof any;
        memset(any, 0, (size_t)m);
        for (int64_t k = -v->window; k <= v->window; k++) {
            const uint8_t *b = v->wide + first + from + k * v->plane;
            if (z + k < 0 || z + k >= v->band) continue;
            for (int64_t c = 0; c < m; c++) any[c] |= b[c];
        }
        for (int64_t c = 0; c < m; c++) any[c] = any[c] ? MPS__CELL_LIQUID : MPS__CELL_DEEP;
        for (int64_t c = 0; c < m; c++)
            what[from + c] = sure[from + c] ? MPS__CELL_COVERED : any[c];
    }
}

/* Class of a cell that is not deep. */
static uint8_t cover_of(const mps__voids *v, const mps__world *w, int64_t c)
{
    int32_t row;
    if (v->own_covers && v->taken[c] & TAKEN && !(v->mask[c] & MPS__MASK_PLATE))
        return MPS__CELL_LIQUID;
    return mps__voids_nearest(v, w, c, v->cover2, &row) < v->cover2 ? MPS__CELL_LIQUID
                                                                    : MPS__CELL_NARROW;
}

/* Set solid cells; where a plate may occlude, a covered cell is undecided. */
static void mask_line(mps__voids *v, int64_t first)
{
    const int64_t n = v->cells[0];
    const uint8_t *mask = v->mask + first;
    uint8_t *what = v->what + first;
    for (int64_t c = 0; c < n; c++) {
        const bool doubt = mask[c] & MPS__MASK_PLATE && what[c] == MPS__CELL_COVERED;
        const uint8_t open = doubt ? MPS__CELL_LIQUID : what[c];
        what[c] = mask[c] & MPS__MASK_SOLID ? MPS__CELL_SOLID : open;
    }
}

/* Compute distances for the cells of a line that the guess has not decided. */
static void settle_line(const part_fields *f, int64_t begin, int64_t end)
{
    mps__voids *v = f->v;
    const uint8_t *next = v->what + begin, *last = v->what + end;
    int32_t row;
    for (; (next = memchr(next, MPS__CELL_LIQUID, (size_t)(last - next))) != NULL; next++) {
        const int64_t c = next - v->what;
        v->what[c] = mps__voids_nearest(v, f->w, c, v->reach2, &row) < v->reach2 ? MPS__CELL_COVERED
                                                                                 : MPS__CELL_DEEP;
    }
    for (int64_t c = begin; f->all && c < end; c++)
        if (v->what[c] == MPS__CELL_COVERED) v->what[c] = cover_of(v, f->w, c);
}

MPS_ROW void class_row(const part_fields *f, int64_t part)
{
    mps__voids *v = f->v;
    const int64_t lines = v->plane / v->cells[0];
    int32_t begin, end;
    range_of(f, part, &begin, &end);
    for (int32_t z = begin; z < end; z++)
        for (int64_t line = 0; line < lines; line++) {
            const int64_t first = z * v->plane + line * v->cells[0];
            guess_line(v, first, z);
            if (v->marks[z * lines + line]) mask_line(v, first);
            settle_line(f, first, first + v->cells[0]);
        }
}
MPS__LOOP_ANY(class_parts, class_row, part_fields)

bool mps__voids_is_narrow(mps__voids *v, const mps__world *w, int64_t c)
{
    if (v->what[c] == MPS__CELL_COVERED) v->what[c] = cover_of(v, w, c);
    return v->what[c] == MPS__CELL_NARROW;
}

static void least_of_each(void *into, const void *from)
{
    unsigned char *a = into;
    const unsigned char *b = from;
    for (int k = 0; k < MPS__VOID_LUMP; k++)
        if (b[k] < a[k]) a[k] = b[k];
}

mps_status mps__voids_cells(mps__voids *v, mps__world *w)
{
    const mps_parallel *p = &w->pool.parallel;
    const bool many = mps__ranks_many(&w->ranks);
    part_fields f = {.v = v, .w = w, .n = w->particles.n, .all = many};
    const int32_t wanted = p->threads > 1 ? 4 * p->threads : 1,
                  parts = v->band < wanted ? v->band : wanted;
    if (parts == 0) return MPS_OK;
    f.slabs = (v->band + parts - 1) / parts;
    mps__loop_run_long(p, &put_parts, v->dim, (v->band + f.slabs - 1) / f.slabs, &f);
    mps__loop_run_long(p, &class_parts, v->dim, (v->band + f.slabs - 1) / f.slabs, &f);
    if (!many) return MPS_OK;
    const int64_t cells = v->band * v->plane;
    mps__ranks_reduce(&w->ranks, (int32_t)((cells + MPS__VOID_LUMP - 1) / MPS__VOID_LUMP),
                      MPS__VOID_LUMP, v->what, least_of_each);
    return mps__ranks_status(&w->ranks);
}
