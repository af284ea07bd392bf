/* SPDX-License-Identifier: BSD-3-Clause */
/* auxgrid: the V-cycle. Sweeps down go red, black and sweeps up black, red, so that the cycle is a symmetric operator. */
#include "auxgrid.h"
#include "kernels.h"
#include <math.h>
#include <string.h>

enum { SWEEPS = 2 };
static const double no_level =
    1e-10; /* share of the diagonal below which a pivot belongs to a constant pressure */

/* ---- direct solution of the last grid ---- */

static void fill_matrix(mps__grid *g, const mps__grid_level *l)
{
    int sides = 2 * g->dim;
    memset(g->factor, 0, (size_t)(l->cells * l->cells) * sizeof *g->factor);
    for (int64_t c = 0; c < l->cells; c++) {
        double *row = g->factor + c * l->cells;
        row[c] = l->shift[c];
        for (int64_t s = c * sides; s < (c + 1) * sides; s++) {
            row[c] += (double)l->link[s];
            row[l->next[s]] -= (double)l->link[s];
        }
    }
}

/* L D L' in place of the lower triangle. A component without a level keeps one pivot of zero: its last cell is held. */
static void factorise_last(mps__grid *g, const mps__grid_level *l)
{
    int64_t n = l->cells;
    fill_matrix(g, l);
    for (int64_t i = 0; i < n; i++) {
        double *row = g->factor + i * n, whole = row[i], d = whole;
        for (int64_t j = 0; j < i; j++) {
            const double *other = g->factor + j * n;
            double s = row[j]; /* becomes L_ij D_j */
            for (int64_t k = 0; k < j; k++) s -= row[k] * other[k];
            row[j] = s;
        }
        for (int64_t j = 0; j < i; j++) {
            double s = row[j];
            row[j] *= g->pivot[j];
            d -= s * row[j];
        }
        g->pivot[i] = d > no_level * whole ? 1 / d : 0;
    }
}

static void solve_last(const mps__grid *g, mps__grid_level *l)
{
    int64_t n = l->cells;
    for (int64_t i = 0; i < n; i++) {
        const double *row = g->factor + i * n;
        double s = l->b[i];
        for (int64_t j = 0; j < i; j++) s -= row[j] * l->x[j];
        l->x[i] = s;
    }
    for (int64_t i = 0; i < n; i++) l->x[i] *= g->pivot[i];
    for (int64_t i = n - 1; i >= 0; i--) {
        const double *row = g->factor + i * n;
        for (int64_t j = 0; j < i; j++) l->x[j] -= row[j] * l->x[i];
    }
}

bool mps__grid_factorise(mps__grid *g)
{
    for (int k = 0; k < g->levels; k++) {
        mps__grid_level *l = &g->level[k];
        for (int64_t c = 0; c < l->cells; c++) {
            double d = l->shift[c];
            for (int64_t s = c * 2 * g->dim; s < (c + 1) * 2 * g->dim; s++) d += (double)l->link[s];
            if (!isfinite(d)) return false;
            l->inverse[c] = d > 0 ? 1 / d : 0;
        }
    }
    factorise_last(g, &g->level[g->levels - 1]);
    return true;
}

/* ---- cycle ---- */

static inline double pull_from(const mps__grid_level *l, const int sides, int64_t c)
{
    const int32_t *next = l->next + c * sides;
    const float *link = l->link + c * sides;
    double s = 0;
    for (int k = 0; k < sides; k++) s += (double)link[k] * l->x[next[k]];
    return s;
}

/* What the neighbours of a cell pull it to. */
static inline double pull(const mps__grid_level *l, int sides, int64_t c)
{
    return sides == 4 ? pull_from(l, 4, c) : pull_from(l, 6, c);
}

/* What a loop of the cycle works on; each uses its own. */
typedef struct cycle {
    mps__grid_level *l;
    const mps__grid_level *coarse;
    int sides;
    int64_t from;        /* first cell */
    const int32_t *list; /* of cells, on a divided grid */
    double *rest;
} cycle;

/* A loop over cells, which do next to nothing each. */
static void run(const mps__grid *g, int64_t cells, mps_range_fn rows, cycle *c)
{
    mps_parallel_rows_least(g->parallel, cells, MPS__TEAM_LEAST / 2, rows, c);
}

static void relax_rows(void *argument, int64_t begin, int64_t end)
{
    const cycle *y = argument;
    const mps__grid_level level = *y->l, *l = &level; /* its pointers stay in registers */
    const int sides = y->sides;
    for (int64_t c = y->from + begin; c < y->from + end; c++)
        l->x[c] = (l->b[c] + pull(l, sides, c)) * l->inverse[c];
}

/* One colour: each cell solved for itself. */
static void relax(const mps__grid *g, mps__grid_level *l, int64_t from, int64_t to)
{
    run(g, to - from, relax_rows, &(cycle){.l = l, .sides = 2 * g->dim, .from = from});
}

static void begin_rows(void *argument, int64_t begin, int64_t end)
{
    const mps__grid_level *l = ((const cycle *)argument)->l;
    for (int64_t c = begin; c < end; c++)
        l->x[c] = c < l->red ? l->b[c] * l->inverse[c]
                             : 0; /* black ones: read at missing neighbours, times zero */
}

static void sweep_down(const mps__grid *g, mps__grid_level *l)
{
    run(g, l->cells, begin_rows, &(cycle){.l = l});
    relax(g, l, l->red, l->cells);
    for (int s = 1; s < SWEEPS; s++) {
        relax(g, l, 0, l->red);
        relax(g, l, l->red, l->cells);
    }
}

static void sweep_up(const mps__grid *g, mps__grid_level *l)
{
    for (int s = 0; s < SWEEPS; s++) {
        relax(g, l, l->red, l->cells);
        relax(g, l, 0, l->red);
    }
}

/* Add a value to the 2^dim corners about a point. */
static inline void spread_over(const mps__grid_level *l, const int corners, int64_t point,
                               double value)
{
    const int32_t *about = l->about + (int64_t)l->home[point] * (corners == 4 ? 9 : 27);
    const uint8_t *corner = mps__grid_corner[l->side[point]];
    const float *share = l->share + point * corners;
    for (int k = 0; k < corners; k++) l->b[about[corner[k]]] += (double)share[k] * value;
}

static inline void spread(const mps__grid_level *l, int dim, int64_t point, double value)
{
    if (dim == 2)
        spread_over(l, 4, point, value);
    else
        spread_over(l, 8, point, value);
}

/* What is left of the right side, to the next grid. The black cells were solved last: only red ones have a residual. */
static void restrict_residual(const mps__grid *g, const mps__grid_level *fine, mps__grid_level *l)
{
    memset(l->b, 0, (size_t)l->cells * sizeof *l->b);
    for (int64_t c = 0; c < fine->red; c++) {
        if (l->home[c] < 0) continue;
        spread(l, g->dim, c,
               fine->b[c] + pull(fine, 2 * g->dim, c) - fine->x[c] / fine->inverse[c]);
    }
}

static void correct_rows(void *argument, int64_t begin, int64_t end)
{
    const cycle *y = argument;
    for (int64_t c = begin; c < end; c++)
        if (y->coarse->home[c] >= 0) y->l->x[c] += mps__grid_value(y->coarse, y->sides / 2, c);
}

static void correct(const mps__grid *g, mps__grid_level *fine, const mps__grid_level *l)
{
    run(g, fine->cells, correct_rows, &(cycle){.l = fine, .coarse = l, .sides = 2 * g->dim});
}

/* ---- divided grids: the same for the own cells, with the values of the others from their owners ---- */

static void begin_listed(void *argument, int64_t begin, int64_t end)
{
    const cycle *y = argument;
    const mps__grid_level *l = y->l;
    for (int64_t k = begin; k < end; k++) {
        const int32_t c = y->list[k];
        l->x[c] = c < l->red ? l->b[c] * l->inverse[c] : 0;
    }
}

static void relax_listed(void *argument, int64_t begin, int64_t end)
{
    const cycle *y = argument;
    const mps__grid_level level = *y->l, *l = &level;
    for (int64_t k = begin; k < end; k++) {
        const int32_t c = y->list[k];
        l->x[c] = (l->b[c] + pull(l, y->sides, c)) * l->inverse[c];
    }
}

static void rest_listed(void *argument, int64_t begin, int64_t end)
{
    const cycle *y = argument;
    const mps__grid_level *l = y->l;
    for (int64_t k = begin; k < end; k++) {
        const int32_t c = y->list[k];
        y->rest[c] = l->b[c] + pull(l, y->sides, c) - l->x[c] / l->inverse[c];
    }
}

static void correct_listed(void *argument, int64_t begin, int64_t end)
{
    const cycle *y = argument;
    for (int64_t k = begin; k < end; k++) correct_rows(argument, y->list[k], y->list[k] + 1);
}

/* Own cells of one colour, then their values for other ranks. */
static int relax_own(mps__grid *g, int k, bool red)
{
    mps__grid_divided *d = &g->ranks.level[k];
    mps__grid_level *l = &g->level[k];
    run(g, red ? d->own_red : d->own - d->own_red, relax_listed,
        &(cycle){.l = l, .sides = 2 * g->dim, .list = d->cell + (red ? 0 : d->own_red)});
    return mps__grid_plan_share(g, &d->ring, l->x);
}

static int sweep_down_own(mps__grid *g, int k)
{
    mps__grid_divided *d = &g->ranks.level[k];
    mps__grid_level *l = &g->level[k];
    run(g, d->own, begin_listed, &(cycle){.l = l, .list = d->cell});
    int reason = mps__grid_plan_share(g, &d->ring, l->x);
    for (int s = 1; s < 2 * SWEEPS && !reason; s++) reason = relax_own(g, k, s % 2 == 0);
    return reason;
}

static int sweep_up_own(mps__grid *g, int k)
{
    mps__grid_divided *d = &g->ranks.level[k];
    mps__grid_level *l = &g->level[k];
    run(g, d->own, correct_listed,
        &(cycle){.l = l, .coarse = l + 1, .sides = 2 * g->dim, .list = d->cell});
    int reason = mps__grid_plan_share(g, &d->ring, l->x);
    for (int s = 0; s < 2 * SWEEPS && !reason; s++) reason = relax_own(g, k, s % 2 == 1);
    return reason;
}

/* The terms of an own coarse cell in their order; what is summed for others is not used. */
static int restrict_own(mps__grid *g, int k)
{
    mps__grid_divided *d = &g->ranks.level[k];
    mps__grid_level *fine = &g->level[k], *l = fine + 1;
    run(g, d->own_red, rest_listed,
        &(cycle){.l = fine, .sides = 2 * g->dim, .list = d->cell, .rest = d->rest});
    const int reason = mps__grid_plan_share(g, &d->left, d->rest);
    memset(l->b, 0, (size_t)l->cells * sizeof *l->b);
    for (int64_t a = 0; a < d->adding; a++) spread(l, g->dim, d->add[a], d->rest[d->add[a]]);
    return reason;
}

static void cycle_whole(mps__grid *g, int first)
{
    int last = g->levels - 1;
    for (int k = first; k < last; k++) {
        sweep_down(g, &g->level[k]);
        restrict_residual(g, &g->level[k], &g->level[k + 1]);
    }
    solve_last(g, &g->level[last]);
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
