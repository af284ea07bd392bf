/* SPDX-License-Identifier: BSD-3-Clause */
/* The public operators: argument checks, then a loop over particles. Every sum over pairs is done
 * by the particle it belongs to, so that any number of threads gives the same bytes. */
#include "operators.h"
#include "loop.h"
#include <math.h>

/* ---- row functions ---- */

/* mps__op_begin() has refused arrays that are NULL, in a table that the analyser does not
 * follow. */
/* NOLINTBEGIN(clang-analyzer-core.NullDereference) */

/* Pairs per block: the longest usual row, for buffers on the stack. */
enum { MPS__PAIRS = MPS_PAIRS(64) };

/* Arguments of the row functions; each uses its own. */
typedef struct operation {
    mps_stencil s;
    const double *b, *f; /* correction, field */
    double *out;
    double sign, least;
    mps__weighed weighed;
} operation;

typedef struct pair {
    double d[3];  /* r_ij */
    double r2, w; /* squared distance, weight */
    int32_t j;
} pair;

MPS_ROW pair pair_at(const int dim, const mps_stencil *s, const double *xi, int64_t k)
{
    pair q = {.j = s->col[k]};
    for (int d = 0; d < dim; d++) {
        q.d[d] = s->x[(int64_t)q.j * dim + d] - xi[d];
        q.r2 += q.d[d] * q.d[d];
    }
    q.w = mps_kernel_weight(&s->kernel, sqrt(q.r2), s->re);
    return q;
}

/* `count` pairs of row i: their W/r^2, and their contributions to n_i and A_i. Short loops with one
 * operation each, so that the compiler vectorises roots and divisions. */
MPS_ROW void weigh_pairs(const int dim, const mps_stencil *s, int64_t i, const int32_t *col,
                         int count, double *w_r2, double sums[4])
{
    double e[3][MPS__PAIRS], r2[MPS__PAIRS], r[MPS__PAIRS], w[MPS__PAIRS];
    for (int k = 0; k < count; k++) {
        r2[k] = 0;
        for (int d = 0; d < dim; d++) {
            e[d][k] = s->x[(int64_t)col[k] * dim + d] - s->x[i * dim + d];
            r2[k] += e[d][k] * e[d][k];
        }
    }
    for (int k = 0; k < count; k++) r[k] = sqrt(r2[k]);
    mps_kernel_weights(&s->kernel, s->re, count, r, w);
    for (int k = 0; k < count; k++) {
        w_r2[k] = w[k] / r2[k];
        r[k] *= w_r2[k];
    }
    for (int k = 0; k < count; k++) {
        for (int d = 0; d < dim; d++) sums[d] -= r[k] * e[d][k];
        sums[dim] += w[k];
    }
}

MPS_ROW void weigh_row(const int dim, const operation *l, int64_t i)
{
    const mps_stencil *s = &l->s;
    const mps__weighed *out = &l->weighed;
    const int64_t count = s->end[i] - s->begin[i];
    const int32_t *col = s->col + s->begin[i];
    double sums[4] = {0};
    for (int64_t k = 0; k < count; k += MPS__PAIRS) {
        const int64_t left = count - k;
        weigh_pairs(dim, s, i, col + k, left < MPS__PAIRS ? (int)left : MPS__PAIRS,
                    out->w_r2 + out->begin[i] + k, sums);
    }
    for (int64_t k = 0; k < count; k++) out->col[out->begin[i] + k] = col[k];
    if (!out->idle[i]) out->n[i] = sums[dim];
    for (int d = 0; d < dim; d++) out->a[i * dim + d] = dim / s->n0 * sums[d];
}
MPS__LOOP(weigh_rows, weigh_row, operation)

MPS_ROW void number_density_row(const int dim, const operation *l, int64_t i)
{
    const mps_stencil *s = &l->s;
    double sum = 0;
    for (int64_t k = s->begin[i]; k < s->end[i]; k++) sum += pair_at(dim, s, s->x + i * dim, k).w;
    l->out[i] = sum;
}
MPS__LOOP(number_density_rows, number_density_row, operation)

/* D/n0 sum (f_j + sign f_i) r_ij/r^2 W of row i */
MPS_ROW void gradient_of(const int dim, const mps_stencil *s, double sign, const double *f,
                         int64_t i, double g[3])
{
    const double fi = sign * f[i], c = dim / s->n0;
    for (int d = 0; d < dim; d++) g[d] = 0;
    for (int64_t k = s->begin[i]; k < s->end[i]; k++) {
        const pair q = pair_at(dim, s, s->x + i * dim, k);
        const double m = (f[q.j] + fi) * q.w / q.r2;
        for (int d = 0; d < dim; d++) g[d] += m * q.d[d];
    }
    for (int d = 0; d < dim; d++) g[d] *= c;
}

MPS_ROW void gradient_row(const int dim, const operation *l, int64_t i)
{
    const mps_stencil *s = &l->s;
    double g[3];
    gradient_of(dim, s, l->sign, l->f, i, g);
    for (int d = 0; d < dim; d++) l->out[i * dim + d] = g[d];
}
MPS__LOOP(gradient_rows, gradient_row, operation)

MPS_ROW void gradient_corrected_row(const int dim, const operation *l, int64_t i)
{
    const mps_stencil *s = &l->s;
    double g[3];
    gradient_of(dim, s, -1.0, l->f, i, g);
    for (int d = 0; d < dim; d++)
        l->out[i * dim + d] = mps__dot(l->b + (i * dim + d) * dim, g, dim);
}
MPS__LOOP(gradient_corrected_rows, gradient_corrected_row, operation)

MPS_ROW void divergence_row(const int dim, const operation *l, int64_t i)
{
    const mps_stencil *s = &l->s;
    const double *b = l->b, *u = l->f, c = dim / s->n0;
    double sum = 0;
    for (int64_t k = s->begin[i]; k < s->end[i]; k++) {
        pair q = pair_at(dim, s, s->x + i * dim, k);
        double e[3], dot = 0;
        for (int d = 0; d < dim; d++)
            e[d] = b ? mps__dot(b + (i * dim + d) * dim, q.d, dim) : q.d[d];
        for (int d = 0; d < dim; d++) dot += (u[(int64_t)q.j * dim + d] - u[i * dim + d]) * e[d];
        sum += dot * q.w / q.r2;
    }
    l->out[i] = c * sum;
}
MPS__LOOP(divergence_rows, divergence_row, operation)

MPS_ROW void laplacian_row(const int dim, const operation *l, int64_t i)
{
    const mps_stencil *s = &l->s;
    const double *f = l->f, c = 2.0 * dim / (s->n0 * s->lambda);
    double sum = 0;
    for (int64_t k = s->begin[i]; k < s->end[i]; k++) {
        const pair q = pair_at(dim, s, s->x + i * dim, k);
        sum += (f[q.j] - f[i]) * q.w;
    }
    l->out[i] = c * sum;
}
MPS__LOOP(laplacian_rows, laplacian_row, operation)

MPS_ROW void laplacian_vector_row(const int dim, const operation *l, int64_t i)
{
    const mps_stencil *s = &l->s;
    const double *u = l->f, c = 2.0 * dim / (s->n0 * s->lambda);
    double sum[3] = {0};
    for (int64_t k = s->begin[i]; k < s->end[i]; k++) {
        const pair q = pair_at(dim, s, s->x + i * dim, k);
        for (int d = 0; d < dim; d++) sum[d] += (u[(int64_t)q.j * dim + d] - u[i * dim + d]) * q.w;
    }
    for (int d = 0; d < dim; d++) l->out[i * dim + d] = c * sum[d];
}
MPS__LOOP(laplacian_vector_rows, laplacian_vector_row, operation)

MPS_ROW void asymmetry_row(const int dim, const operation *l, int64_t i)
{
    const mps_stencil *s = &l->s;
    const double c = dim / s->n0;
    double sum[3] = {0};
    for (int64_t k = s->begin[i]; k < s->end[i]; k++) {
        const pair q = pair_at(dim, s, s->x + i * dim, k);
        const double m = q.w / sqrt(q.r2);
        for (int d = 0; d < dim; d++) sum[d] -= m * q.d[d];
    }
    for (int d = 0; d < dim; d++) l->out[i * dim + d] = c * sum[d];
}
MPS__LOOP(asymmetry_rows, asymmetry_row, operation)

MPS_ROW void correction_row(const int dim, const operation *l, int64_t i)
{
    const mps_stencil *s = &l->s;
    const double c = dim / s->n0;
    double m[9] = {0};
    for (int64_t k = s->begin[i]; k < s->end[i]; k++) {
        const pair q = pair_at(dim, s, s->x + i * dim, k);
        const double w = c * q.w / q.r2;
        for (int d = 0; d < dim; d++)
            for (int e = 0; e < dim; e++) m[d * dim + e] += w * q.d[d] * q.d[e];
    }
    if (s->begin[i] == s->end[i])
        for (int d = 0; d < dim; d++) m[d * dim + d] = 1.0;
    mps__inverse_bounded(dim, m, l->least, l->out + i * dim * dim);
}
MPS__LOOP(correction_rows, correction_row, operation)

/* NOLINTEND(clang-analyzer-core.NullDereference) */

/* ---- arguments ---- */

/* Context of error messages. `host` is near the front of the struct, so that a truncated one has
 * it. */
static mps__context *told_to(const mps_stencil *s)
{
    return s && s->struct_size >= offsetof(mps_stencil, host) + sizeof s->host ? s->host : NULL;
}

static mps_status check_stencil(mps__context *c, const char *call, const mps_stencil *s)
{
    const struct {
        const char *name;
        double value;
    } number[] = {{"dp", s->dp}, {"re", s->re}, {"n0", s->n0}, {"lambda", s->lambda}};
    const struct {
        const char *name;
        const void *data;
    } array[] = {{"x", s->x}, {"begin", s->begin}, {"end", s->end}, {"col", s->col}};
    MPS__CHECK(c, s->dim == 2 || s->dim == 3, "%s(): stencil.dim is %d: must be 2 or 3", call,
               s->dim);
    MPS__CHECK(c, s->n > 0, "%s(): stencil.n is %lld: must be > 0", call, (long long)s->n);
    for (int k = 0; k < 4; k++)
        MPS__CHECK(c, number[k].value > 0 && isfinite(number[k].value),
                   "%s(): stencil.%s is %g: must be > 0 and finite", call, number[k].name,
                   number[k].value);
    for (int k = 0; k < 4; k++)
        MPS__CHECK(c, array[k].data, "%s(): stencil.%s is NULL: must be an array", call,
                   array[k].name);
    MPS__CHECK(c, s->kernel.id >= MPS_KERNEL_IMPROVED && s->kernel.id <= MPS_KERNEL_CUSTOM,
               "%s(): stencil.kernel.id is %d: must be MPS_KERNEL_...", call, s->kernel.id);
    MPS__CHECK(c, s->kernel.id != MPS_KERNEL_CUSTOM || s->kernel.fn,
               "%s(): stencil.kernel.fn is NULL: must be a function", call);
    return MPS_OK;
}

mps_status mps__op_begin(const char *call, const mps_stencil *given, mps_stencil *s,
                         const mps__operand *arrays)
{
    mps__context *c = told_to(given);
    MPS__TRY(mps__struct_in(c, "mps_stencil", s, sizeof *s, given));
    MPS__TRY(check_stencil(c, call, s));
    for (; arrays->name; arrays++)
        MPS__CHECK(c, arrays->data, "%s(): %s is NULL: must be an array", call, arrays->name);
    return MPS_OK;
}

/* ---- operators ---- */

/* Run an operator for all particles, on the threads of the stencil. */
#define RUN(from, operator, ...)                                              \
    mps__loop_run((from)->parallel, &operator##_rows, (from)->dim, (from)->n, \
                  &(operation){.s = *(from), __VA_ARGS__})

/* Begin an operator with a copy `own` of its stencil. */
#define BEGIN(...)         \
    mps_stencil own = {0}; \
    MPS__TRY(mps__op_begin(__func__, s, &own, (const mps__operand[]){__VA_ARGS__, {NULL, NULL}}))

void mps__op_weigh(const mps_stencil *s, const mps__weighed *out)
{
    RUN(s, weigh, .weighed = *out);
}

mps_status mps_op_number_density(const mps_stencil *s, double *n)
{
    BEGIN({"n", n});
    RUN(&own, number_density, .out = n);
    return MPS_OK;
}

mps_status mps_op_gradient(const mps_stencil *s, const double *f, double *grad)
{
    BEGIN({"f", f}, {"grad", grad});
    RUN(&own, gradient, .sign = -1.0, .f = f, .out = grad);
    return MPS_OK;
}

mps_status mps_op_gradient_conservative(const mps_stencil *s, const double *f, double *grad)
{
    BEGIN({"f", f}, {"grad", grad});
    RUN(&own, gradient, .sign = 1.0, .f = f, .out = grad);
    return MPS_OK;
}

mps_status mps_op_gradient_corrected(const mps_stencil *s, const double *b, const double *f,
                                     double *grad)
{
    BEGIN({"b", b}, {"f", f}, {"grad", grad});
    RUN(&own, gradient_corrected, .b = b, .f = f, .out = grad);
    return MPS_OK;
}

mps_status mps_op_divergence(const mps_stencil *s, const double *u, double *div)
{
    BEGIN({"u", u}, {"div", div});
    RUN(&own, divergence, .f = u, .out = div);
    return MPS_OK;
}

mps_status mps_op_divergence_corrected(const mps_stencil *s, const double *b, const double *u,
                                       double *div)
{
    BEGIN({"b", b}, {"u", u}, {"div", div});
    RUN(&own, divergence, .b = b, .f = u, .out = div);
    return MPS_OK;
}

mps_status mps_op_laplacian(const mps_stencil *s, const double *f, double *lap)
{
    BEGIN({"f", f}, {"lap", lap});
    RUN(&own, laplacian, .f = f, .out = lap);
    return MPS_OK;
}

mps_status mps_op_laplacian_vector(const mps_stencil *s, const double *u, double *lap)
{
    BEGIN({"u", u}, {"lap", lap});
    RUN(&own, laplacian_vector, .f = u, .out = lap);
    return MPS_OK;
}

mps_status mps_op_asymmetry(const mps_stencil *s, double *a)
{
    BEGIN({"a", a});
    RUN(&own, asymmetry, .out = a);
    return MPS_OK;
}

mps_status mps_op_correction(const mps_stencil *s, double floor, double *b)
{
    BEGIN({"b", b});
    MPS__CHECK(told_to(s), floor > 0 && isfinite(floor),
               "%s(): floor is %g: must be > 0 and finite", __func__, floor);
    RUN(&own, correction, .least = floor, .out = b);
    return MPS_OK;
}
