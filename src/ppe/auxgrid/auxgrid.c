/* SPDX-License-Identifier: BSD-3-Clause */
/* auxgrid: z = D^-1 r + P V(P' r). The diagonal D reduces residuals that vary from particle to
 * particle; V, one multigrid V-cycle on a background grid of cells two to three spacings wide,
 * reduces smooth ones. */
#include "auxgrid.h"
#include "builtin.h"
#include "rows.h"

typedef struct auxgrid {
    mps__grid on_host, on_device; /* in the memory of the host, of a device */
    mps__grid *grid;              /* that of the last set-up */
    /* [n] of the diagonal, in a buffer of the grid that is unused after the set-up */
    double *inverse;
    int64_t n;
} auxgrid;

static int create(const mps_allocator *allocator, void **self)
{
    const int64_t *whole = *self; /* set by tests */
    auxgrid *a = mps__take(allocator, 1, sizeof *a);
    if (!a) return MPS_PPE_NOMEM;
    *a = (auxgrid){.on_host = {.allocator = *allocator, .host = *allocator}};
    a->on_host.ranks.whole = whole ? *whole : MPS__GRID_WHOLE;
    a->grid = &a->on_host;
    *self = a;
    return 0;
}

typedef struct inverting {
    const double *diagonal;
    double *inverse;
} inverting;

/* An empty row is a particle without neighbours; its residual is 0. */
MPS_ROW void invert_row(const inverting *f, int64_t i)
{
    const double d = f->diagonal[i];
    f->inverse[i] = d > 0 ? 1 / d : 1;
}
MPS__LOOP_ANY(invert_rows, invert_row, inverting)

static void invert_diagonal(auxgrid *a, const mps_ppe_problem *problem)
{
    a->inverse = a->grid->point_kappa;
    mps__loop_run_cheap(problem->parallel, &invert_rows, MPS__ANY_DIM, problem->n,
                        &(inverting){problem->diagonal, a->inverse});
}

/* Cells of the first grid. */
static int find_cells(mps__grid *g, const mps_ppe_problem *problem, const mps__grid_common *common)
{
    mps__grid_measure(g, problem, common->square);
    mps__grid_lay(g, problem, common->least);
    if (mps__grid_many(g)) return mps__grid_ranks_cells(g, problem);
    mps__grid_place(g, problem, problem->n);
    return mps__grid_cells(g, &g->level[0], problem->n) ? 0 : MPS_PPE_NOMEM;
}

/* Whether the device measures the rows without waiting for the host in between. On many ranks the
 * host reduces the sums over the ranks each time. */
static bool asks_once(const mps__grid *g, const mps_ppe_problem *problem)
{
    return g->device && !problem->ranks;
}

static int build_grids(mps__grid *g, const mps_ppe_problem *problem, const mps__grid_common *common)
{
    const bool once = asks_once(g, problem);
    int reason = once ? mps__grid_ask(g, problem) : find_cells(g, problem, common);
    if (!reason && once && !mps__grid_make_cells(g, &g->level[0])) reason = MPS_PPE_NOMEM;
    if (!reason) reason = mps__grid_from_matrix(g, problem);
    if (reason) return reason;
    g->levels = 1;
    if (!mps__grid_coarsen(g)) return MPS_PPE_NOMEM;
    if (!mps__grid_factorise(g)) return MPS_PPE_NAN;
    return mps__grid_many(g) ? mps__grid_divide(g) : 0;
}

static void release_device(void *self)
{
    auxgrid *a = self;
    if (a->on_device.device) mps__grid_release(&a->on_device);
    a->on_device = (mps__grid){.levels = 0};
}

/* The grid in the memory space of the equation. */
static mps__grid *grid_for(auxgrid *a, const mps_ppe_problem *problem)
{
    mps__device *d = mps__device_of(problem->parallel);
    if (!d) return &a->on_host;
    if (a->on_device.device != d) {
        release_device(a);
        a->on_device = (mps__grid){.allocator = d->memory,
                                   .host = a->on_host.allocator,
                                   .device = d,
                                   .ranks.whole = INT64_MAX};
    }
    return &a->on_device;
}

static int setup(void *self, const mps_ppe_problem *problem)
{
    auxgrid *a = self;
    mps__grid *g = a->grid = grid_for(a, problem);
    const int64_t columns = mps__columns(problem),
                  rows = problem->ranks ? problem->ranks->rows : problem->n;
    mps__grid_common common = {.square = 0};
    int reason = asks_once(g, problem) ? 0 : mps__grid_look(problem, &common);
    g->levels = 0;
    if (reason) return reason;
    if (g->dim != problem->dim) mps__grid_release(g); /* its arrays are sized by the dimension */
    a->n = problem->n;
    g->dim = problem->dim;
    g->parallel = problem->parallel;
    if (!mps__grid_reserve(g, columns > 0 ? columns : 1)) return MPS_PPE_NOMEM;
    reason = mps__grid_ranks_begin(g, problem);
    if (!reason && rows > 0) reason = build_grids(g, problem, &common);
    if (!reason) invert_diagonal(a, problem);
    if (!reason && g->device && g->device->failed) reason = MPS_PPE_NOMEM;
    return reason;
}

typedef struct application {
    mps__grid_points points;
    const double *inverse, *r;
    double *z;
} application;

MPS_ROW void apply_row(const int dim, const application *o, int64_t i)
{
    o->z[i] = o->inverse[i] * o->r[i] + mps__grid_value(dim, &o->points, i);
}
MPS__LOOP(apply_rows, apply_row, application)

static int apply(void *self, const double *r, double *z)
{
    auxgrid *a = self;
    mps__grid *g = a->grid;
    if (g->levels == 0) return 0; /* no rank has rows */
    int reason = mps__grid_restrict(g, r, g->unit);
    if (!reason) reason = mps__grid_cycle(g);
    if (reason) return reason;
    mps__loop_run_cheap(g->parallel, &apply_rows, g->dim, a->n,
                        &(application){mps__grid_points_of(&g->level[0]), a->inverse, r, z});
    return 0;
}

static void destroy(const mps_allocator *allocator, void *self)
{
    auxgrid *a = self;
    if (!a) return;
    release_device(a);
    mps__grid_release(&a->on_host);
    mps__release(allocator, a);
}

const mps_preconditioner_ops mps__preconditioner_auxgrid = {
    .struct_size = sizeof(mps_preconditioner_ops),
    .api = MPS_PPE_API,
    .name = "auxgrid",
    .symmetric = 1,
    .create = create,
    .setup = setup,
    .apply = apply,
    .destroy = destroy,
    .help = "Multigrid cycle on auxiliary grids; the fastest for large systems",
    .ranks = 1,
    .device = 1,
    .release_device = release_device,
    .fallback = "jacobi", /* fast, and not proved for every matrix of a plug-in */
    .reach = 2.3, /* from the centre of a cell to its corners; the largest is sqrt(3) 1.25 */
};
