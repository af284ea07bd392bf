/* SPDX-License-Identifier: BSD-3-Clause */
/* auxgrid: z = D^-1 r + P V(P' r). The diagonal D takes care of pressures that change from particle to particle, one multigrid
 * V-cycle on a background grid of cells two to three spacings wide of the smooth ones. */
#include "auxgrid.h"
#include "builtin.h"
#include "kernels.h"
#include <math.h>

typedef struct auxgrid {
    mps__grid grid;
    double *inverse; /* [n] of the diagonal, in memory of the grid that is free once it is there */
    int64_t n;
    mps__grid_away away;
} auxgrid;

static int create(const mps_allocator *allocator, void **self)
{
    const int64_t *whole = *self; /* of tests */
    auxgrid *a = mps__take(allocator, 1, sizeof *a);
    if (!a) return MPS_PPE_NOMEM;
    *a = (auxgrid){.grid.allocator = *allocator};
    a->grid.ranks.whole = whole ? *whole : MPS__GRID_WHOLE;
    *self = a;
    return 0;
}

/* Whether there is a diagonal entry that is not finite, and one that is negative. */
static void check_rows(void *argument, int64_t begin, int64_t end, double *values)
{
    const mps_ppe_problem *problem = argument;
    int bad = 0, negative = 0;
    for (int64_t i = begin; i < end; i++) {
        double d = problem->diagonal[i];
        bad |= !isfinite(d);
        negative |= d < 0;
    }
    if (bad) values[0] = 1;
    if (negative) values[1] = 1;
}

/* The same answer on all ranks: too many unknowns on one, or a diagonal entry that is refused. */
static int check(const mps_ppe_problem *problem)
{
    double found[3] = {0, 0, mps__columns(problem) >= INT32_MAX};
    mps_parallel_max(mps__team(problem->parallel, problem->n), problem->n, 2, check_rows,
                     (mps_ppe_problem *)problem, found);
    mps_ppe_total(problem, &(mps_exact_values){.maxima = 3, .maximum = found});
    if (found[2] > 0) return MPS_PPE_BREAKDOWN;
    return found[0] > 0 ? MPS_PPE_NAN : found[1] > 0 ? MPS_PPE_INDEFINITE : 0;
}

/* What a loop over the unknowns works on; each uses its own. */
typedef struct operands {
    const mps_ppe_problem *problem;
    double *z;
} operands;

static void invert_rows(void *argument, int64_t begin, int64_t end)
{
    const operands *o = argument;
    for (int64_t i = begin; i < end; i++) {
        const double d = o->problem->diagonal[i];
        o->z[i] = d > 0 ? 1 / d
                        : 1; /* an empty row is a particle without neighbours, its residual is 0 */
    }
}

static void invert_diagonal(auxgrid *a, const mps_ppe_problem *problem)
{
    a->inverse = a->grid.point_kappa;
    mps_parallel_rows_least(problem->parallel, problem->n, MPS__TEAM_LEAST / 2, invert_rows,
                            &(operands){.problem = problem, .z = a->inverse});
}

/* Cells of the first grid. */
static int find_cells(mps__grid *g, const mps_ppe_problem *problem)
{
    if (mps__grid_many(g)) return mps__grid_ranks_cells(g, problem);
    mps__grid_place(g, problem, problem->n);
    return mps__grid_cells(g, &g->level[0], problem->n) ? 0 : MPS_PPE_NOMEM;
}

static int build_grids(mps__grid *g, const mps_ppe_problem *problem)
{
    mps__grid_measure(g, problem);
    mps__grid_lay(g, problem);
    int reason = find_cells(g, problem);
    if (!reason) reason = mps__grid_from_matrix(g, problem);
    if (reason) return reason;
    g->levels = 1;
    if (!mps__grid_coarsen(g)) return MPS_PPE_NOMEM;
    if (!mps__grid_factorise(g)) return MPS_PPE_NAN;
    return mps__grid_many(g) ? mps__grid_divide(g) : 0;
}

static int setup_from(auxgrid *a, const mps_ppe_problem *problem)
{
    mps__grid *g = &a->grid;
    const int64_t columns = mps__columns(problem),
                  rows = problem->ranks ? problem->ranks->rows : problem->n;
    int reason = check(problem);
    g->levels = 0;
    a->away.there = false;
    if (reason) return reason;
    if (g->dim != problem->dim) mps__grid_release(g); /* its arrays are sized by the dimension */
    a->n = problem->n;
    g->dim = problem->dim;
    g->parallel = problem->parallel;
    if (!mps__grid_reserve(g, columns > 0 ? columns : 1)) return MPS_PPE_NOMEM;
    reason = mps__grid_ranks_begin(g, problem);
    if (!reason && rows > 0) reason = build_grids(g, problem);
    if (!reason) invert_diagonal(a, problem);
    return reason;
}

static int setup(void *self, const mps_ppe_problem *problem)
{
    return setup_from(self, problem);
}

int mps__auxgrid_setup_there(void *self, const mps__equation_there *source, mps__device *d)
{
    auxgrid *a = self;
    mps_ppe_problem here;
    if (source->show(source->owner, false, &here)) return MPS_PPE_NOMEM;
    a->grid.source = source;
    const int reason = setup_from(a, &here);
    a->grid.source = NULL;
    return reason ? reason : mps__auxgrid_send(a, d);
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
    const bool there = a->away.there;
    mps__grid *g = there ? &a->away.grid : &a->grid;
    const double *inverse = there ? a->away.inverse : a->inverse;
    if (g->levels == 0) return 0; /* no rank has rows */
    int reason = mps__grid_restrict(g, r, g->unit);
    if (!reason) reason = mps__grid_cycle(g);
    if (reason) return reason;
    mps__loop_run_cheap(g->parallel, &apply_rows, g->dim, a->n,
                        &(application){mps__grid_points_of(&g->level[0]), inverse, r, z});
    return 0;
}

int mps__auxgrid_send(void *self, mps__device *d)
{
    auxgrid *a = self;
    return mps__grid_send(&a->away, &a->grid, d, a->inverse);
}

void mps__auxgrid_leave(void *self)
{
    mps__grid_leave(&((auxgrid *)self)->away);
}

static void destroy(const mps_allocator *allocator, void *self)
{
    auxgrid *a = self;
    if (!a) return;
    mps__grid_leave(&a->away);
    mps__give(allocator, a->away.lists.at);
    mps__grid_release(&a->grid);
    mps__give(allocator, a);
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
    .reach = 2.3, /* from the centre of a cell to its corners, the largest is sqrt(3) 1.25 */
};
