/* SPDX-License-Identifier: BSD-3-Clause */
/* ic0: incomplete Cholesky factorisation without fill, M = U' D U with U unit upper triangular in
 * single precision. Most of the dropped fill is added to the diagonal, which preserves smooth
 * pressures. It runs on one thread, since each row needs the previous ones. */
#include "builtin.h"
#include "rows.h"
#include <math.h>

enum { TRIES = 12 };
static const double kept_fill = 0.97; /* fraction of the dropped fill added to the diagonal */

typedef struct ic0 {
    mps_allocator allocator;
    int64_t n, capacity, entry_capacity;
    int64_t *row;    /* [n+1] starts of the strictly upper rows */
    int32_t *col;    /* [row[n]] */
    float *upper;    /* [row[n]] U without its diagonal of ones */
    double *inverse; /* [n] 1/D */
    double *work;    /* [n] row in progress */
    int32_t *mark;   /* [n] last row whose pattern contains this column */
} ic0;

static int create(const mps_allocator *allocator, void **self)
{
    ic0 *f = mps__take(allocator, 1, sizeof *f);
    if (!f) return MPS_PPE_NOMEM;
    *f = (ic0){.allocator = *allocator};
    *self = f;
    return 0;
}

static void drop_rows(ic0 *f)
{
    mps__release(&f->allocator, f->row);
    mps__release(&f->allocator, f->inverse);
    mps__release(&f->allocator, f->work);
    mps__release(&f->allocator, f->mark);
    f->row = NULL;
    f->mark = NULL;
    f->inverse = f->work = NULL;
    f->capacity = 0;
}

static void drop_entries(ic0 *f)
{
    mps__release(&f->allocator, f->col);
    mps__release(&f->allocator, f->upper);
    f->col = NULL;
    f->upper = NULL;
    f->entry_capacity = 0;
}

static bool reserve_rows(ic0 *f, int64_t n)
{
    if (n <= f->capacity) return true;
    drop_rows(f);
    int64_t capacity = n + n / 8;
    f->row = mps__take(&f->allocator, capacity + 1, sizeof *f->row);
    f->inverse = mps__take(&f->allocator, capacity, sizeof *f->inverse);
    f->work = mps__take(&f->allocator, capacity, sizeof *f->work);
    f->mark = mps__take(&f->allocator, capacity, sizeof *f->mark);
    if (f->row && f->inverse && f->work && f->mark)
        f->capacity = capacity;
    else
        drop_rows(f);
    return f->capacity > 0;
}

static bool reserve_entries(ic0 *f, int64_t entries)
{
    if (entries <= f->entry_capacity) return true;
    drop_entries(f);
    int64_t capacity = entries + entries / 8;
    f->col = mps__take(&f->allocator, capacity, sizeof *f->col);
    f->upper = mps__take(&f->allocator, capacity, sizeof *f->upper);
    if (f->col && f->upper)
        f->entry_capacity = capacity;
    else
        drop_entries(f);
    return f->entry_capacity > 0;
}

/* Scatter a matrix row into `work`. */
static void scatter(ic0 *f, const mps_ppe_problem *problem, int64_t i)
{
    f->mark[i] = (int32_t)i;
    f->work[i] = problem->diagonal[i];
    for (int64_t k = problem->row[i]; k < problem->row[i + 1]; k++) {
        int32_t j = problem->col[k];
        f->mark[j] = (int32_t)i;
        f->work[j] = (double)problem->val[k];
    }
}

/* Subtract the contribution of row j < i of U from row i. @return fill outside the pattern */
static double eliminate(ic0 *f, int64_t i, int32_t j)
{
    double a = f->work[j], dropped = 0; /* a = D_j U_ji */
    for (int64_t k = f->row[j]; k < f->row[j + 1]; k++) {
        double t = a * f->upper[k];
        int32_t c = f->col[k];
        if (f->mark[c] == i)
            f->work[c] -= t;
        else
            dropped += t;
    }
    return dropped;
}

/* Upper part of `work` becomes row i of U. */
static void store(ic0 *f, const mps_ppe_problem *problem, int64_t i, double pivot)
{
    int64_t at = f->row[i];
    f->inverse[i] = 1 / pivot;
    for (int64_t k = problem->row[i]; k < problem->row[i + 1]; k++) {
        int32_t j = problem->col[k];
        if (j <= i) continue;
        f->col[at] = j;
        f->upper[at++] = (float)(f->work[j] / pivot);
    }
    f->row[i + 1] = at;
}

/* Factorise A + shift diag(A). False: a pivot is not positive. */
static bool factorise(ic0 *f, const mps_ppe_problem *problem, double shift)
{
    f->row[0] = 0;
    for (int64_t i = 0; i < problem->n; i++) f->mark[i] = -1;
    for (int64_t i = 0; i < problem->n; i++) {
        double diagonal = problem->diagonal[i], dropped = 0;
        scatter(f, problem, i);
        f->mark[i] = (int32_t)i;
        /* an empty row is a particle without neighbours; its residual is 0 */
        if (diagonal == 0) diagonal = 1;
        f->work[i] = diagonal * (1 + shift);
        for (int64_t k = problem->row[i]; k < problem->row[i + 1] && problem->col[k] < i; k++)
            dropped += eliminate(f, i, problem->col[k]);
        double pivot = f->work[i] - kept_fill * dropped;
        if (!(pivot > 1e-4 * diagonal)) return false;
        store(f, problem, i, pivot);
    }
    return true;
}

static int check_diagonal(const mps_ppe_problem *problem)
{
    for (int64_t i = 0; i < problem->n; i++) {
        double d = problem->diagonal[i];
        if (!isfinite(d)) return MPS_PPE_NAN;
        if (d < 0) return MPS_PPE_INDEFINITE;
    }
    return 0;
}

static int setup(void *self, const mps_ppe_problem *problem)
{
    ic0 *f = self;
    if (problem->n >= INT32_MAX) return MPS_PPE_BREAKDOWN;
    if (!reserve_rows(f, problem->n) ||
        !reserve_entries(f, problem->row[problem->n] / 2 + problem->n))
        return MPS_PPE_NOMEM;
    f->n = problem->n;
    int reason = check_diagonal(problem);
    if (reason) return reason;
    double shift = 0;
    for (int k = 0; k < TRIES; k++) {
        if (factorise(f, problem, shift)) return 0;
        shift = shift > 0 ? 4 * shift : 1e-3;
    }
    return MPS_PPE_BREAKDOWN;
}

static int apply(void *self, const double *r, double *z)
{
    const ic0 *f = self;
    for (int64_t i = 0; i < f->n; i++) z[i] = r[i];
    for (int64_t i = 0; i < f->n; i++) {
        double y = z[i];
        for (int64_t k = f->row[i]; k < f->row[i + 1]; k++) z[f->col[k]] -= f->upper[k] * y;
    }
    for (int64_t i = f->n - 1; i >= 0; i--) {
        double s = z[i] * f->inverse[i];
        for (int64_t k = f->row[i]; k < f->row[i + 1]; k++) s -= f->upper[k] * z[f->col[k]];
        z[i] = s;
    }
    return 0;
}

static void destroy(const mps_allocator *allocator, void *self)
{
    ic0 *f = self;
    if (!f) return;
    drop_rows(f);
    drop_entries(f);
    mps__release(allocator, f);
}

const mps_preconditioner_ops mps__preconditioner_ic0 = {
    .struct_size = sizeof(mps_preconditioner_ops),
    .api = MPS_PPE_API,
    .name = "ic0",
    .symmetric = 1,
    .create = create,
    .setup = setup,
    .apply = apply,
    .destroy = destroy,
    .help = "Incomplete Cholesky factorisation without fill-in",
};
