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
} auxgrid;

static int create(const mps_allocator *allocator, void **self)
{
    auxgrid *a = mps__take(allocator, 1, sizeof *a);
    if (!a) return MPS_PPE_NOMEM;
    *a = (auxgrid){.grid.allocator = *allocator};
    *self = a;
    return 0;
}

static int check_diagonal(const mps_ppe_problem *problem)
{
    int bad = 0, negative = 0;
#pragma omp parallel for schedule(static) num_threads(mps__team(problem->n, problem->threads)) reduction(| : bad, negative)
    for (int64_t i = 0; i < problem->n; i++) {
        double d = problem->diagonal[i];
        bad |= !isfinite(d);
        negative |= d < 0;
    }
    return bad ? MPS_PPE_NAN : negative ? MPS_PPE_INDEFINITE : 0;
}

static void invert_diagonal(auxgrid *a, const mps_ppe_problem *problem)
{
    a->inverse = a->grid.point_kappa;
#pragma omp parallel for schedule(static) num_threads(mps__team(problem->n, problem->threads))
    for (int64_t i = 0; i < problem->n; i++) {
        const double d = problem->diagonal[i];
        a->inverse[i] = d > 0 ? 1 / d : 1; /* an empty row is a particle without neighbours, its residual is 0 */
    }
}

static int build_grids(mps__grid *g, const mps_ppe_problem *problem)
{
    mps__grid_measure(g, problem);
    mps__grid_place(g, problem);
    if (!mps__grid_cells(g, &g->level[0], problem->n)) return MPS_PPE_NOMEM;
    if (!mps__grid_from_matrix(g, problem)) return MPS_PPE_NOMEM;
    g->levels = 1;
    if (!mps__grid_coarsen(g)) return MPS_PPE_NOMEM;
    return mps__grid_factorise(g) ? 0 : MPS_PPE_NAN;
}

static int setup(void *self, const mps_ppe_problem *problem)
{
    auxgrid *a = self;
    mps__grid *g = &a->grid;
    if (problem->n >= INT32_MAX) return MPS_PPE_BREAKDOWN;
    if (g->dim != problem->dim) mps__grid_release(g); /* its arrays are sized by the dimension */
    a->n = problem->n;
    g->dim = problem->dim;
    g->threads = problem->threads;
    g->levels = 0;
    if (!mps__grid_reserve(g, problem->n)) return MPS_PPE_NOMEM;
    int reason = check_diagonal(problem);
    if (!reason && problem->n > 0) reason = build_grids(g, problem);
    if (!reason) invert_diagonal(a, problem);
    return reason;
}

static int apply(void *self, const double *r, double *z)
{
    auxgrid *a = self;
    mps__grid *g = &a->grid;
    if (a->n == 0) return 0;
    mps__grid_level *first = &g->level[0];
    mps__grid_restrict(g, r, g->unit);
    mps__grid_cycle(g);
#pragma omp parallel for schedule(static) num_threads(mps__team(a->n, g->threads))
    for (int64_t i = 0; i < a->n; i++) z[i] = a->inverse[i] * r[i] + mps__grid_value(first, g->dim, i);
    return 0;
}

static void destroy(void *self)
{
    auxgrid *a = self;
    if (!a) return;
    mps_allocator allocator = a->grid.allocator;
    mps__grid_release(&a->grid);
    mps__give(&allocator, a);
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
};
