/* SPDX-License-Identifier: BSD-3-Clause */
/* Volume per particle from a wide, smooth kernel. n/n0 is not suitable: its kernel is so peaked
 * that an area-preserving stretch of the lattice changes n by several per cent. */
#include "operators.h"
#include "loop.h"
#include <math.h>
#include <mps/operators.h>

/* Pairs per block. */
enum { PAIRS = MPS_PAIRS(64) };

/* Kernel at the squared distance r2 < h^2, support h = 1/over. 2-D: Wendland C2. 3-D: (1 - q^2)^3.
 * In 3-D the support is usually 2.1 dp, so small that the particle itself is a third of a sum of
 * C2, and disordered liquid looks 2 % denser than the lattice; with the broader kernel sums equal
 * those of Voronoi volumes to some tenths of a per cent. */
MPS_ROW double wide(const int dim, double r2, double over)
{
    if (dim == 3) {
        const double b = 1.0 - r2 * over * over;
        return b * b * b;
    }
    const double q = 1.0 - sqrt(r2) * over, q2 = q * q;
    return q2 * q2 * (5.0 - 4.0 * q);
}

static double wide_lattice(const mps_stencil *t)
{
    const int reach = (int)(t->re / t->dp) + 1, depth = t->dim == 3 ? reach : 0;
    double sum = 0;
    for (int k = -depth; k <= depth; k++)
        for (int j = -reach; j <= reach; j++)
            for (int i = -reach; i <= reach; i++) {
                const double r = t->dp * sqrt((double)(i * i + j * j + k * k));
                if (r < t->re) sum += wide(t->dim, r * r, 1.0 / t->re);
            }
    return sum;
}

/* Kernel sum over all pairs and the particle itself. Short loops with one operation each, so that
 * the compiler vectorises the roots. */
MPS_ROW double wide_sum(const int dim, const mps_stencil *t, int64_t i)
{
    const double *a = t->x + i * dim, over = 1.0 / t->re;
    double sum = 1.0, r[PAIRS]; /* wide(0) */
    for (int64_t from = t->begin[i]; from < t->end[i]; from += PAIRS) {
        const int count = t->end[i] - from < PAIRS ? (int)(t->end[i] - from) : PAIRS;
        for (int k = 0; k < count; k++)
            r[k] = mps__square_between(a, t->x + (int64_t)t->col[from + k] * dim, dim);
        for (int k = 0; k < count; k++) r[k] = wide(dim, r[k], over);
        for (int k = 0; k < count; k++) sum += r[k];
    }
    return sum;
}

typedef struct volume_sums {
    mps_stencil s;
    const double *f;
    double *out, full;
} volume_sums;

MPS_ROW void deviation_row(const int dim, const volume_sums *v, int64_t i)
{
    v->out[i] = wide_sum(dim, &v->s, i) / v->full - 1.0;
}
MPS__LOOP(deviation_rows, deviation_row, volume_sums)

mps_status mps_op_volume_deviation(const mps_stencil *s, double *delta)
{
    mps_stencil own = {0};
    MPS__TRY(
        mps__op_begin(__func__, s, &own, (const mps__operand[]){{"delta", delta}, {NULL, NULL}}));
    const volume_sums v = {.s = own, .out = delta, .full = wide_lattice(&own)};
    mps__loop_run(own.parallel, &deviation_rows, own.dim, own.n, &v);
    return MPS_OK;
}

/* Kernel sum of f over all pairs and the particle itself. */
MPS_ROW double wide_sum_of(const int dim, const mps_stencil *t, const double *f, int64_t i)
{
    const double *a = t->x + i * dim, over = 1.0 / t->re;
    double sum = f[i]; /* wide(0) = 1 */
    for (int64_t p = t->begin[i]; p < t->end[i]; p++) {
        const int64_t j = t->col[p];
        const double *b = t->x + j * dim;
        double r2 = 0;
        if (f[j] == 0) continue;
        for (int d = 0; d < dim; d++) r2 += (b[d] - a[d]) * (b[d] - a[d]);
        sum += f[j] * wide(dim, r2, over);
    }
    return sum;
}

MPS_ROW void sum_row(const int dim, const volume_sums *v, int64_t i)
{
    v->out[i] = wide_sum_of(dim, &v->s, v->f, i) / v->full;
}
MPS__LOOP(sum_rows, sum_row, volume_sums)

mps_status mps_op_volume_sum(const mps_stencil *s, const double *f, double *sum)
{
    mps_stencil own = {0};
    MPS__TRY(mps__op_begin(__func__, s, &own,
                           (const mps__operand[]){{"f", f}, {"sum", sum}, {NULL, NULL}}));
    MPS__CHECK(own.host, f != sum, "%s(): f and sum are the same array: must be two", __func__);
    const volume_sums v = {.s = own, .f = f, .out = sum, .full = wide_lattice(&own)};
    mps__loop_run(own.parallel, &sum_rows, own.dim, own.n, &v);
    return MPS_OK;
}
