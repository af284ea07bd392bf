/* SPDX-License-Identifier: BSD-3-Clause */
/* auxgrid: the last grid, of few cells, is solved directly. On a device a group of threads does so together. */
#include "auxgrid.h"
#include <string.h>

static const double no_level =
    1e-10; /* share of the diagonal below which a pivot belongs to a constant pressure */

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
void mps__grid_factorise_last(mps__grid *g)
{
    const mps__grid_level *l = &g->level[g->levels - 1];
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

void mps__grid_mirror_last(mps__grid *g)
{
    const int64_t n = g->level[g->levels - 1].cells;
    for (int64_t i = 0; i < n; i++)
        for (int64_t j = 0; j < i; j++) g->factor[j * n + i] = g->factor[i * n + j];
}

/* What the solution sees. */
typedef struct last {
    int64_t cells;
    const double *factor, *pivot, *b;
    double *x;
} last;

static void solve(const last *f)
{
    const int64_t n = f->cells;
    double *x = f->x;
    for (int64_t i = 0; i < n; i++) {
        const double *row = f->factor + i * n;
        double s = f->b[i];
        for (int64_t j = 0; j < i; j++) s -= row[j] * x[j];
        x[i] = s;
    }
    for (int64_t i = 0; i < n; i++) x[i] *= f->pivot[i];
    for (int64_t i = n - 1; i >= 0; i--) {
        const double *row = f->factor + i * n;
        for (int64_t j = 0; j < i; j++) x[j] -= row[j] * x[i];
    }
}

#ifdef MPS_DEVICE
/* The same terms in the same order for each cell: one unknown after the other goes into all that are left. Rows of the upper triangle are columns of L. */
static void solve_together(const last *f, int64_t lane, bool any)
{
    const int64_t n = any ? f->cells : 0;
    double *x = f->x;
    for (int64_t i = lane; i < n; i += MPS__TOGETHER) x[i] = f->b[i];
    for (int64_t j = 0; j < n; j++) {
        mps__thread_wait();
        const double *column = f->factor + j * n;
        for (int64_t i = j + 1 + lane; i < n; i += MPS__TOGETHER) x[i] -= column[i] * x[j];
    }
    mps__thread_wait();
    for (int64_t i = lane; i < n; i += MPS__TOGETHER) x[i] *= f->pivot[i];
    for (int64_t i = n - 1; i > 0; i--) {
        mps__thread_wait();
        const double *row = f->factor + i * n;
        for (int64_t j = lane; j < i; j += MPS__TOGETHER) x[j] -= row[j] * x[i];
    }
}
#endif
MPS__GROUP(solve_last, solve, solve_together, last)

void mps__grid_solve_last(const mps__grid *g)
{
    const mps__grid_level *l = &g->level[g->levels - 1];
    const last f = {l->cells, g->factor, g->pivot, l->b, l->x};
    if (g->away)
        mps__group_run(g->away->device, &solve_last, &f);
    else
        solve(&f);
}
