/* SPDX-License-Identifier: BSD-3-Clause */
/* Liquid particles in the void raster: selection, and assignment to cells. Cells have linked lists
 * of particles, whose order does not matter. */
#include "loop.h"
#include "world.h"

/* Walls with fluid nearer than this count as liquid [dp]. */
static const double WET = 1.5;

typedef struct liquid_fields {
    const int32_t *kind, *region;
    const uint8_t *ghost;  /* NULL: no ghosts */
    const double *x, *ref; /* [n*dim] in the lab; of solids in the frame of the tank */
    double *place;
    int32_t *slab;
    double origin[3], side;
    int32_t slabs;
    mps_tank_pose tank;
} liquid_fields;

/* Convert a position in the tank's frame to raster units. @return its slab; particles outside
 * belong to the first or last one */
MPS_ROW int32_t put_place(const int dim, const liquid_fields *f, double *X)
{
    for (int d = 0; d < dim; d++) X[d] = (X[d] - f->origin[d]) / f->side;
    if (!(X[dim - 1] >= 0)) return 0;
    return X[dim - 1] < f->slabs ? (int32_t)X[dim - 1] : f->slabs - 1;
}

/* Fluid. Regions of ghosts may be stale: a halo exchange of the results follows. */
MPS_ROW void fluid_row(const int dim, const liquid_fields *f, int64_t i, double *most)
{
    double *X = f->place + i * dim;
    if (f->kind[i] != MPS_FLUID || f->region[i] == MPS_REGION_SPRAY) {
        f->slab[i] = -1;
        return;
    }
    mps__tank_place(dim, f->tank.centre, f->tank.shift, f->tank.rotation, f->x + i * dim, X);
    f->slab[i] = put_place(dim, f, X);
    if (f->slab[i] > most[0] && mps__owns(f->ghost, i)) most[0] = f->slab[i];
}
MPS__VALUES(fluid_rows, fluid_row, liquid_fields, 0, 1)

/* Walls that liquid wets. */
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
    if (!wet) return;
    for (int d = 0; d < dim; d++) f->place[i * dim + d] = f->ref[i * dim + d];
    f->slab[i] = put_place(dim, f, f->place + i * dim);
}
MPS_ROWS(wall_rows, wall_row, liquid_fields)

static mps_status reserve_more(mps__voids *v, int64_t n)
{
    mps__void_capacity *r = &v->capacity;
    mps__context *c = v->context;
    const int64_t capacity = n > r->slab ? mps__capacity_for(n, r->slab) : n;
    MPS__TRY(mps__grow(c, (void **)&v->place, &r->place, 0, capacity * v->dim, sizeof *v->place));
    MPS__TRY(mps__grow(c, (void **)&v->next, &r->next, 0, capacity, sizeof *v->next));
    return mps__grow(c, (void **)&v->slab, &r->slab, 0, capacity, sizeof *v->slab);
}

/* Output arrays of the row functions: v->place and v->slab, or device memory. */
typedef struct found {
    mps__device *device;
    double *place;
    int32_t *slab;
} found;

/* Positions of liquid particles, and the highest slab of fluid over all ranks. */
static mps_status find_rows(const found *k, const mps__voids *v, mps__world *w, const mps_stage *s,
                            double *highest)
{
    const mps__particles *p = &w->particles;
    const bool on_device = k->device;
    const liquid_fields f = {.kind = mps__seen(w, MPS__FIELD_KIND),
                             .region = mps__seen(w, MPS__FIELD_REGION),
                             .ghost = mps__ghosts_seen(&w->ghosts, k->device),
                             .x = mps__seen(w, MPS__FIELD_POSITION),
                             .ref = mps__seen(w, MPS__FIELD_REF),
                             .place = k->place,
                             .slab = k->slab,
                             .origin = {v->origin[0], v->origin[1], v->origin[2]},
                             .side = v->side,
                             .slabs = v->slabs,
                             .tank = s->view->tank};
    const mps__halo_array shared[2] = {
        {.values = k->slab, .bytes = sizeof *k->slab, .on_device = on_device},
        {.values = k->place, .bytes = (size_t)v->dim * sizeof *k->place, .on_device = on_device}};
    mps__values_run(&w->pool.parallel, &fluid_rows, v->dim, p->n, &f, NULL, highest);
    MPS__TRY(mps__ghosts_exchange_at(&w->ghosts, k->device, shared, 2));
    mps__runner_rows(&w->runner, s->view, &wall_rows, &f);
    MPS__TRY(mps__ghosts_exchange_at(&w->ghosts, k->device, shared, 2));
    mps__ranks_max(&w->ranks, 1, highest);
    return MPS_OK;
}

/* find_rows() on the device of the step; copies positions and slabs to the host. */
static mps_status find_device(mps__device *d, mps__voids *v, mps__world *w, const mps_stage *s,
                              double *highest)
{
    mps__memory *t = &w->runner.memory;
    const size_t places = (size_t)w->particles.n * (size_t)v->dim * sizeof *v->place,
                 slabs = (size_t)w->particles.n * sizeof *v->slab;
    const found k = {d, mps__memory_workspace(t, 0, places), mps__memory_workspace(t, 1, slabs)};
    if (!k.place || !k.slab) return MPS_E_NOMEM;
    mps__memory_set_space(t, MPS__ON_DEVICE);
    const mps_status status = find_rows(&k, v, w, s, highest);
    mps__memory_set_space(t, MPS__ON_HOST);
    MPS__TRY(status);
    mps__device_download(d, v->place, k.place, places);
    mps__device_download(d, v->slab, k.slab, slabs);
    /* needed on the host for occlusion */
    if (w->lists.occluders.count > 0) mps__seen(w, MPS__FIELD_POSITION);
    return mps__device_status(d);
}

static mps_status find_liquid(mps__voids *v, mps__world *w, const mps_stage *s, double *highest)
{
    mps__device *d = mps__memory_device(&w->runner.memory);
    MPS__TRY(reserve_more(v, w->particles.n));
    return d ? find_device(d, v, w, s, highest)
             : find_rows(&(found){NULL, v->place, v->slab}, v, w, s, highest);
}

/* ---- the band ---- */

/* Slabs above the highest liquid contain only void, which is one component as long as it is
 * connected. */
static mps_status set_band(mps__voids *v, double highest)
{
    const double walls = ceil(WET / v->config.side),
                 top = highest >= 0 ? highest + walls + v->window + 2 : 0;
    v->band = top < v->slabs ? (int32_t)top : v->slabs;
    if (v->ullage[v->band] < 0) v->band = v->slabs;
    const int64_t cells = v->band * v->plane;
    mps__void_capacity *r = &v->capacity;
    mps__context *c = v->context;
    MPS__TRY(mps__grow(c, (void **)&v->head, &r->head, 0, cells, sizeof *v->head));
    MPS__TRY(mps__grow(c, (void **)&v->taken, &r->taken, 0, cells, sizeof *v->taken));
    MPS__TRY(mps__grow(c, (void **)&v->sure, &r->sure, 0, cells, sizeof *v->sure));
    MPS__TRY(mps__grow(c, (void **)&v->wide, &r->wide, 0, cells, sizeof *v->wide));
    /* padded to whole messages of the reduction */
    return mps__grow(c, (void **)&v->what, &r->what, 0, cells + MPS__VOID_LUMP, sizeof *v->what);
}

mps_status mps__voids_liquid(mps__voids *v, mps__world *w, mps_stage *s)
{
    double highest = -1;
    MPS__TRY(find_liquid(v, w, s, &highest));
    MPS__TRY(mps__voids_wet(v, w));
    return set_band(v, highest);
}
