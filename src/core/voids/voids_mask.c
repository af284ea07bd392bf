/* SPDX-License-Identifier: BSD-3-Clause */
/* The raster of a tank: solid cells, links cut by thin plates, and whether the void above each slab
 * is connected. It depends on the solid particles alone, so that it works for any tank: boxes,
 * surfaces, walls placed by the user. */
#include "world.h"
#include <string.h>

/* Largest distance of a wall that decides on which side a cell is [dp]. */
static const double RANGE = 1.5;

/* Depth of a cell inside the solid according to a dummy [dp]: walls between two solids may have a
 * normal, too. */
static const double DEPTH = 1;

/* Area of walls inside a solid, zero up to rounding [dp^(dim-1)]. */
static const double LEAST_AREA = 1e-3;

/* Largest number of cells: indices have 32 bits. */
static const double MOST = INT32_MAX;

/* Votes of the walls around a cell; integers, as their sum does not depend on the order. */
typedef struct votes {
    int64_t height;  /* weighted height over the planes of the walls [2^-30 dp]; < 0: solid */
    int64_t walls;   /* with a normal */
    int64_t dummies; /* and walls without one */
} votes;

/* ---- size ---- */

/* Box of the walls of all ranks: upper corner, negative of the lower one. */
static void find_box(mps__world *w, double corner[6])
{
    const mps__particles *s = &w->particles;
    for (int d = 0; d < 6; d++) corner[d] = -INFINITY;
    for (int64_t i = 0; i < s->n; i++)
        for (int d = 0; s->kind[i] == MPS_WALL && d < s->dim; d++) {
            corner[d] = fmax(corner[d], s->ref[i * s->dim + d]);
            corner[3 + d] = fmax(corner[3 + d], -s->ref[i * s->dim + d]);
        }
    mps__ranks_max(&w->ranks, 6, corner);
}

/* Cells begin at the walls. Above an open tank there is space for liquid at its edge. */
static mps_status set_size(mps__voids *v, mps__world *w)
{
    double corner[6], total = 1;
    const double dp = w->setup.dp;
    find_box(w, corner);
    v->dim = w->setup.dim;
    v->side = v->config.side * dp;
    for (int d = 0; d < 3; d++) {
        const bool has = d < v->dim && isfinite(corner[d]);
        const double length = has ? corner[d] + corner[3 + d] + (d == v->dim - 1 ? 2 * dp : 0) : 0,
                     count = fmax(1, ceil(length / v->side - 1e-6));
        MPS__CHECK(v->context, (total *= count) <= MOST,
                   "the raster of voids would have %g cells: at most %g; choose larger cells than "
                   "%g dp",
                   total, MOST, v->config.side);
        v->origin[d] = has ? -corner[3 + d] : 0;
        v->cells[d] = isfinite(corner[0]) ? (int32_t)count : 0;
    }
    v->total = isfinite(corner[0]) ? (int64_t)total : 0;
    v->slabs = v->cells[v->dim - 1];
    v->plane = v->slabs > 0 ? v->total / v->slabs : 0;
    v->step[0] = 1;
    v->step[1] = v->cells[0];
    v->step[2] = (int64_t)v->cells[0] * v->cells[1];
    return MPS_OK;
}

static mps_status reserve_more(mps__voids *v)
{
    mps__void_capacity *r = &v->capacity;
    mps__context *c = v->context;
    MPS__TRY(mps__grow(c, (void **)&v->mask, &r->mask, 0, v->total, sizeof *v->mask));
    MPS__TRY(mps__grow(c, (void **)&v->label, &r->label, 0, v->total, sizeof *v->label));
    MPS__TRY(
        mps__grow(c, (void **)&v->marks, &r->marks, 0, v->total / v->cells[0], sizeof *v->marks));
    return mps__grow(c, (void **)&v->ullage, &r->ullage, 0, v->slabs + 1, sizeof *v->ullage);
}

static void centre_of(const mps__voids *v, const int32_t at[3], double X[3])
{
    for (int d = 0; d < 3; d++) X[d] = v->origin[d] + (at[d] + 0.5) * v->side;
}

/* Cells from..to that a box overlaps, clipped to the raster. */
static void cells_within(const mps__voids *v, const double *lo, const double *hi, int32_t from[3],
                         int32_t to[3])
{
    for (int d = 0; d < 3; d++) {
        const double last = v->cells[d] - 1;
        from[d] = d < v->dim
                      ? (int32_t)fmax(0, fmin(last + 1, floor((lo[d] - v->origin[d]) / v->side)))
                      : 0;
        to[d] = d < v->dim ? (int32_t)fmin(last, fmax(-1, floor((hi[d] - v->origin[d]) / v->side)))
                           : 0;
    }
}

/* ---- solid cells ---- */

/* The two faces of a thin plate may coincide, and its shadows are inside the liquid. */
static bool is_of_plate(const mps__world *w, int64_t i)
{
    const mps__particles *s = &w->particles;
    return s->plate[i] &&
           (s->kind[i] == MPS_DUMMY || s->part[i] == w->lists.occluders.list[s->plate[i] - 1].part);
}

static void vote(const mps__voids *v, const mps__world *w, int64_t i, votes *all)
{
    const mps__particles *s = &w->particles;
    const double dp = w->setup.dp, range = RANGE * dp, *x = s->ref + i * s->dim,
                 *area = s->area + i * s->dim,
                 length = s->kind[i] == MPS_WALL ? sqrt(mps__dot(area, area, s->dim)) : 0,
                 size = length > LEAST_AREA * mps_pow(dp, s->dim - 1) ? length : 0;
    double lo[3] = {0}, hi[3] = {0}, X[3];
    int32_t from[3], to[3], at[3];
    for (int d = 0; d < s->dim; d++) {
        lo[d] = x[d] - range;
        hi[d] = x[d] + range;
    }
    cells_within(v, lo, hi, from, to);
    for (at[2] = from[2]; at[2] <= to[2]; at[2]++)
        for (at[1] = from[1]; at[1] <= to[1]; at[1]++)
            for (at[0] = from[0]; at[0] <= to[0]; at[0]++) {
                votes *own = &all[at[0] + v->step[1] * at[1] + v->step[2] * at[2]];
                double height = s->kind[i] == MPS_DUMMY ? -DEPTH : 0;
                centre_of(v, at, X);
                const double near = 1 - mps__square_between(x, X, s->dim) / (range * range);
                if (near <= 0) continue;
                for (int d = 0; size > 0 && d < s->dim; d++)
                    height += area[d] / size * (X[d] - x[d]) / dp;
                own->height += (int64_t)(near * near * height * 0x1p30);
                own->walls += size > 0;
                own->dummies += size == 0;
            }
}

/* Cells without a solid nearby are void if they are connected to void cells. */
static mps_status flood(mps__voids *v, const votes *all)
{
    int64_t head = 0, tail = 0;
    for (int64_t c = 0; c < v->total; c++) {
        const bool known = all[c].walls || all[c].dummies;
        const bool solid = !known || (all[c].walls ? all[c].height < 0 : true);
        v->mask[c] = (uint8_t)((v->mask[c] & ~MPS__MASK_SOLID) | (solid ? MPS__MASK_SOLID : 0));
        if (solid) continue;
        MPS__TRY(mps__voids_push(v, &v->queue, &v->capacity.queue, tail));
        v->queue[tail++] = (int32_t)c;
    }
    while (head < tail) {
        const int64_t c = v->queue[head++];
        int32_t at[3];
        mps__voids_place(v, c, at);
        for (int32_t side = 0; side < 2 * v->dim; side++) {
            const int64_t b = mps__voids_beside(v, c, at, side);
            if (b < 0 || !(v->mask[b] & MPS__MASK_SOLID) || all[b].walls || all[b].dummies)
                continue;
            v->mask[b] &= (uint8_t)~MPS__MASK_SOLID;
            MPS__TRY(mps__voids_push(v, &v->queue, &v->capacity.queue, tail));
            v->queue[tail++] = (int32_t)b;
        }
    }
    return MPS_OK;
}

static mps_status find_solid(mps__voids *v, mps__world *w)
{
    enum { CHUNK = 1 << 20, NUMBERS = sizeof(votes) / sizeof(int64_t) };
    votes *all = mps__alloc(v->context, v->total, sizeof *all);
    if (!all) return MPS_E_NOMEM;
    for (int64_t i = mps__own_from(&w->ghosts, 0); i < w->particles.n;
         i = mps__own_from(&w->ghosts, i + 1))
        if (w->particles.kind[i] != MPS_FLUID && !is_of_plate(w, i)) vote(v, w, i, all);
    for (int64_t c = 0; c < v->total; c += CHUNK) {
        const int64_t count = c + CHUNK < v->total ? CHUNK : v->total - c;
        mps__ranks_add(&w->ranks, (int32_t)(NUMBERS * count), &all[c].height);
    }
    const mps_status status = flood(v, all);
    mps__free(v->context, all);
    return status;
}

/* ---- plates ---- */

/* Mark cells that a plate may hide from particles, and cut links that it crosses. A plate through
 * centres of cells counts as slightly below them. */
static void cut_links(mps__voids *v, const mps__occluder *p)
{
    double lo[3], hi[3], a[3], b[3];
    int32_t from[3], to[3], at[3];
    for (int d = 0; d < 3; d++) {
        lo[d] = hi[d] = p->corner[d];
        for (int e = 0; e < 2; e++) {
            const double x = fmin(p->from[e], 0) * p->along[e][d],
                         y = fmax(p->to[e], p->length[e]) * p->along[e][d];
            if (e == 1 && v->dim == 2) continue;
            lo[d] += fmin(x, y);
            hi[d] += fmax(x, y);
        }
        lo[d] -= (v->window + 1) * v->side;
        hi[d] += (v->window + 1) * v->side;
    }
    cells_within(v, lo, hi, from, to);
    for (at[2] = from[2]; at[2] <= to[2]; at[2]++)
        for (at[1] = from[1]; at[1] <= to[1]; at[1]++)
            for (at[0] = from[0]; at[0] <= to[0]; at[0]++)
                for (int d = 0; d < v->dim; d++) {
                    uint8_t *own = &v->mask[at[0] + v->step[1] * at[1] + v->step[2] * at[2]];
                    *own |= MPS__MASK_PLATE;
                    centre_of(v, at, a);
                    for (int e = 0; e < 3; e++) a[e] += 1e-7 * v->side * p->normal[e];
                    memcpy(b, a, sizeof b);
                    b[d] += v->side;
                    if (mps__occluder_crossed(p, a, b)) *own |= (uint8_t)(1 << d);
                }
}

/* ---- compartments ---- */

/* Flood fill: number all cells of the compartment of a cell. */
static mps_status spread(mps__voids *v, int64_t cell, uint8_t number)
{
    int64_t head = 0, tail = 0;
    MPS__TRY(mps__voids_push(v, &v->queue, &v->capacity.queue, tail));
    v->queue[tail++] = (int32_t)cell;
    v->space[cell] = number;
    while (head < tail) {
        const int64_t c = v->queue[head++];
        int32_t at[3];
        mps__voids_place(v, c, at);
        for (int32_t side = 0; side < 2 * v->dim; side++) {
            const int64_t b = mps__voids_beside(v, c, at, side);
            if (b < 0 || v->mask[b] & MPS__MASK_SOLID || v->space[b]) continue;
            MPS__TRY(mps__voids_push(v, &v->queue, &v->capacity.queue, tail));
            v->queue[tail++] = (int32_t)b;
            v->space[b] = number;
        }
    }
    return MPS_OK;
}

/* Blocks are hollow: only compartments with liquid are a part of the tank. */
static mps_status find_spaces(mps__voids *v)
{
    MPS__TRY(mps__grow(v->context, (void **)&v->space, &v->capacity.space, 0, v->total,
                       sizeof *v->space));
    memset(v->space, 0, (size_t)v->total);
    memset(v->wet, 1, sizeof v->wet);
    v->spaces = 0;
    for (int64_t c = 0; c < v->total; c++) {
        if (v->mask[c] & MPS__MASK_SOLID || v->space[c]) continue;
        if (v->spaces + 1 < MPS__COMPARTMENTS) v->spaces++;
        MPS__TRY(spread(v, c, (uint8_t)v->spaces));
    }
    return MPS_OK;
}

/* ---- void above a slab ---- */

/* Provisional components of the cells of slab z, given those of the slab above; -1: solid. */
static mps_status join_slab(mps__voids *v, int32_t z, const int32_t *upper, int32_t *own,
                            int32_t *used)
{
    const int32_t up = v->dim - 1;
    for (int64_t k = 0; k < v->plane; k++) {
        const int64_t c = z * v->plane + k;
        int32_t at[3], mine = -1;
        own[k] = -1;
        if (v->mask[c] & MPS__MASK_SOLID) continue;
        mps__voids_place(v, c, at);
        for (int32_t d = 0; d < v->dim; d++) {
            const int64_t b = mps__voids_beside(v, c, at, d == up ? 2 * d + 1 : 2 * d);
            if (b < 0 || v->mask[b] & MPS__MASK_SOLID) continue;
            const int32_t other = d == up ? upper[k] : own[k - v->step[d]];
            if (mine < 0) mine = other;
            v->parts -= mps__voids_join(v->parent, mine, other);
        }
        if (mine < 0) {
            MPS__TRY(mps__voids_push(v, &v->parent, &v->capacity.parent, *used));
            mine = v->parent[*used] = *used;
            (*used)++;
            v->parts++;
        }
        own[k] = mine;
    }
    return MPS_OK;
}

static mps_status find_ullage(mps__voids *v)
{
    int32_t used = 0;
    int64_t cells = 0;
    v->parts = 0;
    v->ullage[v->slabs] = 0;
    int32_t *slab = mps__alloc(v->context, 2 * v->plane, sizeof *slab);
    mps_status status = slab ? MPS_OK : MPS_E_NOMEM;
    for (int32_t z = v->slabs - 1; z >= 0 && status == MPS_OK; z--) {
        int32_t *own = slab + z % 2 * v->plane, *upper = slab + (z + 1) % 2 * v->plane;
        status = join_slab(v, z, upper, own, &used);
        for (int64_t k = 0; k < v->plane; k++) cells += own[k] >= 0;
        v->ullage[z] = v->parts <= 1 ? cells : -1;
    }
    mps__free(v->context, slab);
    return status;
}

static void find_marks(mps__voids *v)
{
    for (int64_t line = 0; line < v->total / v->cells[0]; line++) {
        uint8_t any = 0;
        for (int64_t c = 0; c < v->cells[0]; c++) any |= v->mask[line * v->cells[0] + c];
        v->marks[line] = any;
    }
}

mps_status mps__voids_raster(mps__voids *v, mps__world *w)
{
    const bool moves = mps__models_move_solids(&w->models);
    const double channel = v->config.channel / v->config.side,
                 cover = v->config.cover / v->config.side;
    const bool same = v->side == v->config.side * w->setup.dp && v->reach2 == channel * channel &&
                      v->cover2 == cover * cover;
    if (v->made && !moves && same && v->solids == w->particles.solids) return MPS_OK;
    v->made = false;
    MPS__TRY(set_size(v, w));
    if (v->total == 0) return MPS_OK;
    MPS__TRY(mps__voids_offsets(v));
    MPS__TRY(reserve_more(v));
    memset(v->mask, 0, (size_t)v->total);
    for (int32_t k = 0; k < w->lists.occluders.count; k++)
        if (w->lists.occluders.list[k].active) cut_links(v, &w->lists.occluders.list[k]);
    MPS__TRY(find_solid(v, w));
    MPS__TRY(find_spaces(v));
    MPS__TRY(find_ullage(v));
    find_marks(v);
    v->solids = w->particles.solids;
    v->constant = INT32_MAX;
    v->made = true;
    return MPS_OK;
}

static void larger_of_each(void *into, const void *from)
{
    uint8_t *a = into;
    const uint8_t *b = from;
    for (int k = 0; k < MPS__COMPARTMENTS; k++)
        if (b[k] > a[k]) a[k] = b[k];
}

mps_status mps__voids_wet(mps__voids *v, mps__world *w)
{
    uint8_t wet[MPS__COMPARTMENTS] = {0};
    if (v->spaces < 2) return MPS_OK;
    for (int64_t i = 0; i < w->particles.n; i++) {
        const int64_t c = v->slab[i] >= 0 && w->particles.kind[i] == MPS_FLUID
                              ? mps__voids_cell(v, v->place + i * v->dim)
                              : -1;
        if (c >= 0) wet[v->space[c]] = 1;
    }
    mps__ranks_reduce(&w->ranks, 1, sizeof wet, wet, larger_of_each);
    MPS__TRY(mps__ranks_status(&w->ranks));
    wet[0] = 1;
    memset(wet + v->spaces + 1, 1, (size_t)(MPS__COMPARTMENTS - 1 - v->spaces));
    if (memcmp(wet, v->wet, sizeof wet) == 0) return MPS_OK;
    v->made = false; /* until the update is complete */
    for (int64_t c = 0; c < v->total; c++) {
        if (v->mask[c] & MPS__MASK_DRY) v->mask[c] &= (uint8_t) ~(MPS__MASK_DRY | MPS__MASK_SOLID);
        if (!wet[v->space[c]]) v->mask[c] |= MPS__MASK_DRY | MPS__MASK_SOLID;
    }
    memcpy(v->wet, wet, sizeof wet);
    MPS__TRY(find_ullage(v));
    find_marks(v);
    v->constant = INT32_MAX;
    v->made = true;
    return MPS_OK;
}
