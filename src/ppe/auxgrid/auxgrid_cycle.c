/* SPDX-License-Identifier: BSD-3-Clause */
/* auxgrid: inverse diagonals and the V-cycle. Sweeps before the coarser grid relax red, then black
 * cells, sweeps after it black, then red ones: the cycle is a symmetric operator. */
#include "auxgrid.h"
#include "rows.h"
#include <math.h>
#include <string.h>

enum { SWEEPS = 2 };

/* ---- diagonals ---- */

typedef struct diagonals {
    const double *shift;
    const float *link;
    double *inverse;
} diagonals;

/* Maximum: 1 if a diagonal is not finite. */
MPS_ROW void invert_row(const int dim, const diagonals *f, int64_t c, double *bad)
{
    double d = f->shift[c];
    for (int64_t s = c * 2 * dim; s < (c + 1) * 2 * dim; s++) d += (double)f->link[s];
    if (!isfinite(d)) *bad = 1;
    f->inverse[c] = d > 0 ? 1 / d : 0;
}
MPS__VALUES(invert_rows, invert_row, diagonals, 0, 1)

/* The results of all grids are downloaded in one copy. */
static bool invert_device(const mps__grid *g)
{
    double bad[MPS__GRID_LEVELS] = {0};
    for (int k = 0; k < g->levels; k++) {
        const mps__grid_level *l = &g->level[k];
        const diagonals f = {l->shift, l->link, l->inverse};
        mps__values_reduce_async(g->device, &invert_rows, g->dim, l->cells, &f, g->bad + k);
    }
    mps__device_download(g->device, bad, g->bad, (size_t)g->levels * sizeof *bad);
    for (int k = 0; k < g->levels; k++)
        if (g->level[k].cells > 0 && bad[k] > 0) return g->device->failed;
    return true;
}

static bool invert_on_host(const mps__grid *g)
{
    double bad = 0;
    for (int k = 0; k < g->levels; k++) {
        const mps__grid_level *l = &g->level[k];
        const diagonals f = {l->shift, l->link, l->inverse};
        mps__values_run(mps__team(g->parallel, l->cells), &invert_rows, g->dim, l->cells, &f, NULL,
                        &bad);
    }
    return !(bad > 0);
}

bool mps__grid_factorise(mps__grid *g)
{
    if (!(g->device ? invert_device(g) : invert_on_host(g))) return false;
    mps__grid_factorise_last(g);
    return true;
}

/* ---- cycle ---- */

/* Arguments of loops over the cells of a grid. */
typedef struct cells {
    const int32_t *next;
    const float *link;
    const double *b, *inverse;
    double *x;
    int64_t red, from;       /* first black cell; first cell */
    mps__grid_points coarse; /* the coarser grid */
    const int32_t *list;     /* of cells, on a divided grid */
    double *rest;
} cells;

static cells cells_of(const mps__grid_level *l)
{
    return (cells){.next = l->next,
                   .link = l->link,
                   .b = l->b,
                   .inverse = l->inverse,
                   .x = l->x,
                   .red = l->red};
}

/* A loop over cells that do little work each. */
static void run(const mps__grid *g, const mps__loop *loop, int64_t count, const cells *f)
{
    mps__loop_run_cheap(g->parallel, loop, g->dim, count, f);
}

/* Sum of link * x over the neighbours of a cell. */
MPS_ROW double pull(const int dim, const cells *f, int64_t c)
{
    const int32_t *next = f->next + c * 2 * dim;
    const float *link = f->link + c * 2 * dim;
    double s = 0;
    for (int k = 0; k < 2 * dim; k++) s += (double)link[k] * f->x[next[k]];
    return s;
}

MPS_ROW void relax_cell(const int dim, const cells *f, int64_t c)
{
    f->x[c] = (f->b[c] + pull(dim, f, c)) * f->inverse[c];
}

MPS_ROW void relax_row(const int dim, const cells *f, int64_t i)
{
    relax_cell(dim, f, f->from + i);
}
MPS__LOOP(relax_rows, relax_row, cells)

/* Relax the cells of one colour. */
static void relax(const mps__grid *g, const mps__grid_level *l, int64_t from, int64_t to)
{
    cells f = cells_of(l);
    f.from = from;
    run(g, &relax_rows, to - from, &f);
}

/* Black cells are zeroed: they are read at missing neighbours, with a factor of zero. */
MPS_ROW void begin_row(const cells *f, int64_t c)
{
    f->x[c] = c < f->red ? f->b[c] * f->inverse[c] : 0;
}
MPS__LOOP_ANY(begin_rows, begin_row, cells)

static void sweep_down(const mps__grid *g, const mps__grid_level *l)
{
    const cells f = cells_of(l);
    run(g, &begin_rows, l->cells, &f);
    relax(g, l, l->red, l->cells);
    for (int s = 1; s < SWEEPS; s++) {
        relax(g, l, 0, l->red);
        relax(g, l, l->red, l->cells);
    }
}

static void sweep_up(const mps__grid *g, const mps__grid_level *l)
{
    for (int s = 0; s < SWEEPS; s++) {
        relax(g, l, l->red, l->cells);
        relax(g, l, 0, l->red);
    }
}

/* Add a value to the 2^dim corners around a point. */
static inline void spread_over(const mps__grid_level *l, const int corners, int64_t point,
                               double value)
{
    const int32_t *about = l->about + (int64_t)l->home[point] * (corners == 4 ? 9 : 27);
    const uint8_t *corner = mps__grid_corner[l->side[point]];
    const float *weight = l->weight + point * corners;
    for (int k = 0; k < corners; k++) l->b[about[corner[k]]] += (double)weight[k] * value;
}

static inline void spread(const mps__grid_level *l, int dim, int64_t point, double value)
{
    if (dim == 2)
        spread_over(l, 4, point, value);
    else
        spread_over(l, 8, point, value);
}

/* Residual of a cell. */
MPS_ROW double rest_of(const int dim, const cells *f, int64_t c)
{
    return f->b[c] + pull(dim, f, c) - f->x[c] / f->inverse[c];
}

MPS_ROW void rest_row(const int dim, const cells *f, int64_t c)
{
    f->rest[c] = f->coarse.home[c] < 0 ? 0 : rest_of(dim, f, c);
}
MPS__LOOP(rest_rows, rest_row, cells)

/* Restrict the residual of grid k to the next one, on a device. */
static void restrict_device(const mps__grid *g, int k)
{
    cells f = cells_of(&g->level[k]);
    f.coarse = mps__grid_points_of(&g->level[k + 1]);
    f.rest = g->level[k].rest;
    run(g, &rest_rows, f.red, &f);
    mps__grid_restrict_level(g, k + 1);
}

/* Restrict the residual to the next grid. The black cells were relaxed last: only red cells have a
 * residual. */
static void restrict_residual(const mps__grid *g, const mps__grid_level *fine,
                              const mps__grid_level *l)
{
    const cells f = cells_of(fine);
    memset(l->b, 0, (size_t)l->cells * sizeof *l->b);
    for (int64_t c = 0; c < fine->red; c++) {
        if (l->home[c] < 0) continue;
        spread(l, g->dim, c, g->dim == 2 ? rest_of(2, &f, c) : rest_of(3, &f, c));
    }
}

MPS_ROW void correct_row(const int dim, const cells *f, int64_t c)
{
    if (f->coarse.home[c] >= 0) f->x[c] += mps__grid_value(dim, &f->coarse, c);
}
MPS__LOOP(correct_rows, correct_row, cells)

static void correct(const mps__grid *g, const mps__grid_level *fine, const mps__grid_level *l)
{
    cells f = cells_of(fine);
    f.coarse = mps__grid_points_of(l);
    run(g, &correct_rows, fine->cells, &f);
}

/* ---- divided grids: own cells, with a halo exchange of the others ---- */

MPS_ROW void begin_own(const cells *f, int64_t k)
{
    begin_row(f, f->list[k]);
}
MPS__LOOP_ANY(begin_listed, begin_own, cells)

MPS_ROW void relax_own(const int dim, const cells *f, int64_t k)
{
    relax_cell(dim, f, f->list[k]);
}
MPS__LOOP(relax_listed, relax_own, cells)

MPS_ROW void rest_own(const int dim, const cells *f, int64_t k)
{
    f->rest[f->list[k]] = rest_of(dim, f, f->list[k]);
}
MPS__LOOP(rest_listed, rest_own, cells)

MPS_ROW void correct_own(const int dim, const cells *f, int64_t k)
{
    correct_row(dim, f, f->list[k]);
}
MPS__LOOP(correct_listed, correct_own, cells)

/* Own cells of a level, from number `from` on. */
static cells own_cells(const mps__grid *g, int k, int64_t from)
{
    const mps__grid_divided *d = &g->ranks.level[k];
    cells f = cells_of(&g->level[k]);
    f.coarse = mps__grid_points_of(&g->level[k + 1]);
    f.list = d->cell + from;
    f.rest = d->rest;
    return f;
}

/* Relax the own cells of one colour, then exchange their values. */
static int relax_colour(mps__grid *g, int k, bool red)
{
    mps__grid_divided *d = &g->ranks.level[k];
    const cells f = own_cells(g, k, red ? 0 : d->own_red);
    run(g, &relax_listed, red ? d->own_red : d->own - d->own_red, &f);
    return mps__grid_plan_exchange(g, &d->ring, f.x);
}

static int sweep_down_own(mps__grid *g, int k)
{
    mps__grid_divided *d = &g->ranks.level[k];
    const cells f = own_cells(g, k, 0);
    run(g, &begin_listed, d->own, &f);
    int reason = mps__grid_plan_exchange(g, &d->ring, f.x);
    for (int s = 1; s < 2 * SWEEPS && !reason; s++) reason = relax_colour(g, k, s % 2 == 0);
    return reason;
}

static int sweep_up_own(mps__grid *g, int k)
{
    mps__grid_divided *d = &g->ranks.level[k];
    const cells f = own_cells(g, k, 0);
    run(g, &correct_listed, d->own, &f);
    int reason = mps__grid_plan_exchange(g, &d->ring, f.x);
    for (int s = 0; s < 2 * SWEEPS && !reason; s++) reason = relax_colour(g, k, s % 2 == 1);
    return reason;
}

/* An own coarse cell adds its terms in their usual order; sums of other ranks' cells are not
 * used. */
static int restrict_own(mps__grid *g, int k)
{
    mps__grid_divided *d = &g->ranks.level[k];
    const mps__grid_level *l = &g->level[k + 1];
    const cells f = own_cells(g, k, 0);
    run(g, &rest_listed, d->own_red, &f);
    const int reason = mps__grid_plan_exchange(g, &d->left, d->rest);
    memset(l->b, 0, (size_t)l->cells * sizeof *l->b);
    for (int64_t a = 0; a < d->adding; a++) spread(l, g->dim, d->add[a], d->rest[d->add[a]]);
    return reason;
}

static void cycle_whole(mps__grid *g, int first)
{
    int last = g->levels - 1;
    for (int k = first; k < last; k++) {
        sweep_down(g, &g->level[k]);
        if (g->device)
            restrict_device(g, k);
        else
            restrict_residual(g, &g->level[k], &g->level[k + 1]);
    }
    mps__grid_solve_last(g);
    for (int k = last - 1; k >= first; k--) {
        correct(g, &g->level[k], &g->level[k + 1]);
        sweep_up(g, &g->level[k]);
    }
}

int mps__grid_cycle(mps__grid *g)
{
    const int divided = mps__grid_many(g) ? g->ranks.divided : 0;
    int reason = 0;
    for (int k = 0; k < divided && !reason; k++) {
        reason = sweep_down_own(g, k);
        if (!reason) reason = restrict_own(g, k);
    }
    if (divided > 0 && !reason)
        reason = mps__grid_ranks_collect(g, &g->ranks.level[divided].owned, 1,
                                         &g->level[divided].b);
    if (reason) return reason;
    cycle_whole(g, divided);
    for (int k = divided - 1; k >= 0 && !reason; k--) reason = sweep_up_own(g, k);
    return reason;
}
