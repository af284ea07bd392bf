/* SPDX-License-Identifier: BSD-3-Clause */
/* Which cells liquid covers. Each particle is stamped on the cells about it: the least distance counts, of equal ones that of the least id, so
 * neither order nor threads nor ranks matter. */
#include "loop.h"
#include "plates.h"
#include <string.h>

/* Walls with fluid nearer than this are liquid [dp]. */
static const double WET = 1.5;

/* ---- liquid particles ---- */

typedef struct liquid_fields {
    const int32_t *region;
    const double *x, *ref; /* [n*dim] in the lab; of solids in the frame of the tank */
    int32_t *slab;
    double origin, side; /* along the last axis */
    int32_t slabs;
} liquid_fields;

MPS_ROW int32_t slab_of(const int dim, const mps_view *v, const liquid_fields *f, int64_t i)
{
    double X[3] = {0, 0, 0};
    if (mps_is_fluid(v, i))
        mps__tank_place(dim, v->tank.centre, v->tank.shift, v->tank.rotation, f->x + i * dim, X);
    else
        X[dim - 1] = f->ref[i * dim + dim - 1];
    const double slab = floor((X[dim - 1] - f->origin) / f->side);
    return (int32_t)fmin(fmax(slab, 0), f->slabs - 1);
}

MPS_ROW void fluid_row(const int dim, const mps_view *v, const liquid_fields *f, int64_t i)
{
    const bool liquid = mps_is_fluid(v, i) && f->region[i] != MPS_REGION_SPRAY;
    f->slab[i] = liquid ? slab_of(dim, v, f, i) : -1;
}
MPS_ROWS(fluid_rows, fluid_row, liquid_fields)

MPS_ROW void wall_row(const int dim, const mps_view *v, const liquid_fields *f, int64_t i)
{
    const mps_stencil *t = &v->near;
    bool wet = false;
    if (!mps_is_wall(v, i) || f->region[i] == MPS_REGION_DRY) return;
    for (int64_t p = mps_stencil_begin(t, i); p < mps_stencil_end(t, i) && !wet; p++) {
        const int64_t j = mps_stencil_column(t, p);
        wet = mps_is_fluid(v, j) && f->slab[j] >= 0 &&
              mps__square_between(f->x + i * dim, f->x + j * dim, dim) < WET * WET * v->dp * v->dp;
    }
    if (wet) f->slab[i] = slab_of(dim, v, f, i);
}
MPS_ROWS(wall_rows, wall_row, liquid_fields)

typedef struct slab_fields {
    const int32_t *slab;
} slab_fields;

MPS_ROW void raise_slab(const int dim, const mps_view *v, const slab_fields *f, int64_t i,
                        double *most)
{
    (void)dim, (void)v;
    if (f->slab[i] > most[0]) most[0] = f->slab[i];
}
MPS_SUMS(raise_slabs, raise_slab, slab_fields)

/* Slabs of liquid particles, and the highest one. */
static mps_status find_liquid(mps__voids *v, mps__world *w, mps_stage *s, double *highest)
{
    const mps__particles *p = &w->particles;
    mps__twins_ready(&w->host.twins, MPS__POSITION, MPS__ON_HOST);
    mps__twins_ready(&w->host.twins, MPS__REGION, MPS__ON_HOST);
    MPS__TRY(mps__grow(v->context, (void **)&v->slab, &v->room.slab, 0,
                       p->n > v->room.slab ? mps__room(p->n, v->room.slab) : p->n,
                       sizeof *v->slab));
    const liquid_fields f = {.region = p->region,
                             .x = p->x,
                             .ref = p->ref,
                             .slab = v->slab,
                             .origin = v->origin[v->dim - 1],
                             .side = v->side,
                             .slabs = v->slabs};
    const mps__shared shared = {v->slab, sizeof *v->slab};
    mps_stage_rows(s, &fluid_rows, &f);
    MPS__TRY(mps__ghosts_share(&w->ghosts, &shared, 1));
    mps_stage_rows(s, &wall_rows, &f);
    MPS__TRY(mps__ghosts_share(&w->ghosts, &shared, 1));
    mps_stage_max(s, 1, &raise_slabs, &(slab_fields){v->slab}, highest);
    return MPS_OK;
}

/* ---- the stamp ---- */

typedef struct stamp_fields {
    const mps__world *w;
    const mps__voids *v;
    mps_tank_pose tank;
    int64_t n;
    int32_t slabs; /* of a part */
} stamp_fields;

/* Whether particle i is the one that a cell counts. */
static inline bool is_nearer(const stamp_fields *f, int64_t cell, float square, int64_t i)
{
    const mps__voids *v = f->v;
    const int64_t *id = f->w->particles.id;
    if (square > v->square[cell]) return false;
    const int32_t had = v->nearest[cell];
    return square < v->square[cell] || (had >= 0 && id[i] < id[had]);
}

static bool is_hidden(const stamp_fields *f, const int32_t at[3], int64_t i)
{
    double X[3];
    for (int d = 0; d < 3; d++) X[d] = f->v->origin[d] + (at[d] + 0.5) * f->v->side;
    return mps__plates_hide(f->w, X, i);
}

/* A line of cells at[0]..last; `off` is the square of its distance from the particle at x. */
static inline void stamp_line(const stamp_fields *f, int64_t i, bool plates, double x, double off,
                              int32_t at[3], int32_t last)
{
    const mps__voids *v = f->v;
    const int64_t line = v->step[1] * at[1] + v->step[2] * at[2];
    for (; at[0] <= last; at[0]++) {
        const double dx = at[0] + 0.5 - x;
        const float square = (float)(dx * dx + off);
        if (!is_nearer(f, line + at[0], square, i) || (plates && is_hidden(f, at, i))) continue;
        v->square[line + at[0]] = square;
        v->nearest[line + at[0]] = (int32_t)i;
    }
}

/* One particle on the cells of slabs begin..end-1. */
static inline void stamp(const int dim, const stamp_fields *f, int64_t i, int32_t begin,
                         int32_t end)
{
    const mps__voids *v = f->v;
    const mps__particles *s = &f->w->particles;
    const bool plates = f->w->lists.screens.count > 0 && f->w->lists.screens.slot[i] >= 0;
    double X[3] = {0, 0, 0};
    int32_t from[3] = {0, 0, 0}, to[3] = {0, 0, 0}, at[3];
    if (s->kind[i] == MPS_FLUID)
        mps__tank_place(dim, f->tank.centre, f->tank.shift, f->tank.rotation, s->x + i * dim, X);
    else
        memcpy(X, s->ref + i * dim, (size_t)dim * sizeof *X);
    for (int d = 0; d < dim; d++) {
        const double least = d == dim - 1 ? begin : 0,
                     most = (d == dim - 1 ? end : v->cells[d]) - 1;
        X[d] = (X[d] - v->origin[d]) / v->side;
        from[d] = (int32_t)fmin(fmax(ceil(X[d] - 0.5 - v->reach), least), most + 1);
        to[d] = (int32_t)fmax(fmin(floor(X[d] - 0.5 + v->reach), most), least - 1);
    }
    for (at[2] = from[2]; at[2] <= to[2]; at[2]++)
        for (at[1] = from[1]; at[1] <= to[1]; at[1]++) {
            const double dy = at[1] + 0.5 - X[1], dz = dim == 3 ? at[2] + 0.5 - X[2] : 0;
            at[0] = from[0];
            stamp_line(f, i, plates, X[0], dy * dy + dz * dz, at, to[0]);
        }
}

static void stamp_all(const int dim, const stamp_fields *f, int32_t begin, int32_t end)
{
    const int32_t *slab = f->v->slab, reach = (int32_t)f->v->reach + 1;
    for (int64_t i = 0; i < f->n; i++)
        if (slab[i] >= begin - reach && slab[i] < end + reach && slab[i] >= 0)
            stamp(dim, f, i, begin, end);
}

/* What cells of slabs begin..end-1 are. */
static void classify(const mps__voids *v, int64_t begin, int64_t end)
{
    for (int64_t c = begin; c < end; c++) {
        const int free = (v->square[c] >= v->cover2) + (v->square[c] >= v->reach2);
        v->what[c] = (uint8_t)(v->mask[c] & MPS__MASK_SOLID ? MPS__CELL_SOLID : free);
    }
}

/* A range of slabs: one part of the raster. */
MPS_ROW void part_row(const int dim, const stamp_fields *f, int64_t part)
{
    const mps__voids *v = f->v;
    const int32_t begin = (int32_t)part * f->slabs,
                  end = begin + f->slabs < v->band ? begin + f->slabs : v->band;
    for (int64_t c = begin * v->plane; c < end * v->plane; c++) {
        v->square[c] = v->reach2;
        v->nearest[c] = -1;
    }
    stamp_all(dim, f, begin, end);
    classify(v, begin * v->plane, end * v->plane);
}
MPS__LOOP(parts, part_row, stamp_fields)

/* ---- the band ---- */

enum { LUMP = 64 };

static void least_of_each(void *into, const void *from)
{
    unsigned char *a = into;
    const unsigned char *b = from;
    for (int k = 0; k < LUMP; k++)
        if (b[k] < a[k]) a[k] = b[k];
}

/* Slabs above the highest liquid can hold nothing but ambient, as long as they hang together. */
static mps_status set_band(mps__voids *v, double highest)
{
    const double top = isfinite(highest) && highest >= 0 ? highest + v->reach + 2 : 0;
    v->band = top < v->slabs ? (int32_t)top : v->slabs;
    if (v->ullage[v->band] < 0) v->band = v->slabs;
    const int64_t cells = (v->band * v->plane / LUMP + 1) * LUMP;
    mps__void_room *r = &v->room;
    mps__context *c = v->context;
    MPS__TRY(mps__grow(c, (void **)&v->square, &r->square, 0, cells, sizeof *v->square));
    MPS__TRY(mps__grow(c, (void **)&v->nearest, &r->nearest, 0, cells, sizeof *v->nearest));
    return mps__grow(c, (void **)&v->what, &r->what, 0, cells, sizeof *v->what);
}

mps_status mps__voids_stamp(mps__voids *v, mps__world *w, mps_stage *s)
{
    double highest = -1;
    const double cover = v->config.cover / v->config.side;
    v->reach = v->config.channel / v->config.side;
    v->cover2 = (float)(cover * cover);
    v->reach2 = (float)(v->reach * v->reach);
    MPS__TRY(find_liquid(v, w, s, &highest));
    MPS__TRY(set_band(v, highest));
    if (v->band == 0) return MPS_OK;
    const int32_t threads = w->pool.parallel.threads,
                  parts_wanted = threads > 1 ? (v->band < 4 * threads ? v->band : 4 * threads) : 1;
    stamp_fields f = {.w = w, .v = v, .tank = s->view->tank, .n = w->particles.n};
    f.slabs = (v->band + parts_wanted - 1) / parts_wanted;
    mps__loop_run_long(&w->pool.parallel, &parts, v->dim, (v->band + f.slabs - 1) / f.slabs, &f);
    mps__ranks_reduce(&w->ranks, (int32_t)(v->band * v->plane / LUMP + 1), LUMP, v->what,
                      least_of_each);
    return mps__ranks_status(&w->ranks);
}
