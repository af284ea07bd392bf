/* SPDX-License-Identifier: BSD-3-Clause */
/* auxgrid: direct solution of the last grid, which has few cells. On a device a group of threads
 * factorises and solves it. */
#include "auxgrid.h"

/* fraction of the diagonal below which a pivot belongs to a constant pressure */
static const double no_level = 1e-10;

/* ---- factors ---- */

typedef struct matrix {
    int64_t cells;
    const double *shift;
    const int32_t *next;
    const float *link;
    double *factor, *pivot;
} matrix;

MPS_ROW void fill_row(const int dim, const matrix *m, int64_t c)
{
    double *row = m->factor + c * m->cells;
    for (int64_t k = 0; k < m->cells; k++) row[k] = 0;
    row[c] = m->shift[c];
    for (int64_t s = c * 2 * dim; s < (c + 1) * 2 * dim; s++) {
        row[c] += (double)m->link[s];
        row[m->next[s]] -= (double)m->link[s];
    }
}
MPS__LOOP(fill_rows, fill_row, matrix)

MPS_ROW double pivot_of(double d, double whole)
{
    return d > no_level * whole ? 1 / d : 0;
}

/* L D L' overwrites the lower triangle. A component without pressure datum has one zero pivot: the
 * x of its last cell is 0. */
static void factorise(const matrix *m)
{
    const int64_t n = m->cells;
    for (int64_t i = 0; i < n; i++) {
        double *row = m->factor + i * n, d = row[i];
        for (int64_t j = 0; j < i; j++) {
            const double *other = m->factor + j * n;
            double s = row[j]; /* becomes L_ij D_j */
            for (int64_t k = 0; k < j; k++) s -= row[k] * other[k];
            row[j] = s;
        }
        for (int64_t j = 0; j < i; j++) {
            double s = row[j];
            row[j] *= m->pivot[j];
            d -= s * row[j];
        }
        m->pivot[i] = pivot_of(d, row[i]);
    }
}

/* The host uses the lower triangle alone. It is mirrored to the upper one, which threads of a
 * device read along rows. */
static void factorise_both(const matrix *m)
{
    const int64_t n = m->cells;
    factorise(m);
    for (int64_t i = 0; i < n; i++)
        for (int64_t j = 0; j < i; j++) m->factor[j * n + i] = m->factor[i * n + j];
}

#ifdef MPS_DEVICE
/* The terms of each entry, in the order of the host: each column is subtracted from all remaining
 * ones. A thread owns columns of the upper triangle, which stores L_ij D_j until the factorisation
 * is complete; the reduced diagonal is stored where the pivot will be. */
static void factorise_together(const matrix *m, int64_t lane, bool any)
{
    const int64_t n = any ? m->cells : 0;
    double *a = m->factor;
    for (int64_t i = lane; i < n; i += MPS__TOGETHER) m->pivot[i] = a[i * n + i];
    for (int64_t k = 0; k < n; k++) {
        mps__thread_wait();
        const double pivot = pivot_of(m->pivot[k], a[k * n + k]);
        for (int64_t i = k + 1 + lane; i < n; i += MPS__TOGETHER)
            a[i * n + k] = a[k * n + i] * pivot;
        mps__thread_wait();
        if (lane == 0) m->pivot[k] = pivot;
        for (int64_t i = k + 1 + lane; i < n; i += MPS__TOGETHER) {
            const double whole = a[k * n + i];
            for (int64_t j = k + 1; j < i; j++) a[j * n + i] -= whole * a[j * n + k];
            m->pivot[i] -= whole * a[i * n + k];
        }
    }
    mps__thread_wait();
    for (int64_t i = lane; i < n; i += MPS__TOGETHER)
        for (int64_t j = 0; j < i; j++) a[j * n + i] = a[i * n + j];
}
#endif
MPS__GROUP(factorise_last, factorise_both, factorise_together, matrix)

void mps__grid_factorise_last(mps__grid *g)
{
    const mps__grid_level *l = &g->level[g->levels - 1];
    const matrix m = {l->cells, l->shift, l->next, l->link, g->factor, g->pivot};
    mps__loop_run_cheap(g->parallel, &fill_rows, g->dim, l->cells, &m);
    if (g->device)
        mps__group_run(g->device, &factorise_last, &m);
    else
        factorise(&m);
}

/* ---- solution ---- */

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
/* The terms of each cell, in the order of the host: each unknown is subtracted from all remaining
 * ones. Rows of the upper triangle are columns of L. */
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
    if (g->device)
        mps__group_run(g->device, &solve_last, &f);
    else
        solve(&f);
}
