/* SPDX-License-Identifier: BSD-3-Clause */
/* The public operators: argument checks, then the loop compiled for the dimension. */
#include "operators.h"
#include <math.h>

/* Jacobi rotation of a symmetric matrix in the plane (p, q); columns of v take the eigenvectors. */
static void rotate(double *a, double *v, int dim, int p, int q)
{
    const double apq = a[p * dim + q];
    if (apq == 0.0) return;
    const double theta = 0.5 * (a[q * dim + q] - a[p * dim + p]) / apq;
    const double t = (theta >= 0 ? 1.0 : -1.0) / (fabs(theta) + sqrt(theta * theta + 1.0));
    const double c = 1.0 / sqrt(t * t + 1.0), s = t * c;
    for (int k = 0; k < dim; k++) {
        double x = a[k * dim + p], y = a[k * dim + q];
        a[k * dim + p] = c * x - s * y;
        a[k * dim + q] = s * x + c * y;
    }
    for (int k = 0; k < dim; k++) {
        double x = a[p * dim + k], y = a[q * dim + k];
        a[p * dim + k] = c * x - s * y;
        a[q * dim + k] = s * x + c * y;
        x = v[k * dim + p], y = v[k * dim + q];
        v[k * dim + p] = c * x - s * y;
        v[k * dim + q] = s * x + c * y;
    }
}

/* Inverse by cofactors if all eigenvalues exceed `least`, that is, if m - least 1 is positive definite (its leading minors
 * are positive). The rule for all but a few particles, and ten times cheaper than eigenvectors. */
static bool inverse_regular_2d(const double *m, double least, double *inverse)
{
    if (!(m[0] > least && (m[0] - least) * (m[3] - least) > m[1] * m[1])) return false;
    const double over = 1.0 / (m[0] * m[3] - m[1] * m[1]);
    inverse[0] = over * m[3];
    inverse[1] = inverse[2] = -over * m[1];
    inverse[3] = over * m[0];
    return true;
}

static bool inverse_regular_3d(const double *m, double least, double *inverse)
{
    const double a = m[0] - least, b = m[4] - least, c = m[8] - least, f = m[5], g = m[2], h = m[1];
    const double minor = a * b - h * h,
                 determinant = a * (b * c - f * f) - h * (h * c - f * g) + g * (h * f - b * g);
    if (!(a > 0 && minor > 0 && determinant > 0)) return false;
    const double xx = m[4] * m[8] - f * f, xy = f * g - h * m[8], xz = h * f - m[4] * g;
    const double over = 1.0 / (m[0] * xx + h * xy + g * xz);
    inverse[0] = over * xx;
    inverse[1] = inverse[3] = over * xy;
    inverse[2] = inverse[6] = over * xz;
    inverse[4] = over * (m[0] * m[8] - g * g);
    inverse[5] = inverse[7] = over * (h * g - m[0] * f);
    inverse[8] = over * (m[0] * m[4] - h * h);
    return true;
}

/* Inverse of a symmetric matrix whose eigenvalues are raised to `least`: bounded where neighbours are too few. */
static void inverse_bounded(const double *m, int dim, double least, double *inverse)
{
    if (dim == 2 ? inverse_regular_2d(m, least, inverse) : inverse_regular_3d(m, least, inverse))
        return;
    double a[9], v[9] = {0};
    for (int k = 0; k < dim * dim; k++) a[k] = m[k];
    for (int k = 0; k < dim; k++) v[k * dim + k] = 1.0;
    for (int sweep = 0; sweep < (dim == 2 ? 1 : 6); sweep++)
        for (int p = 0; p < dim; p++)
            for (int q = p + 1; q < dim; q++) rotate(a, v, dim, p, q);
    for (int d = 0; d < dim; d++)
        for (int e = 0; e < dim; e++) {
            double sum = 0;
            for (int k = 0; k < dim; k++)
                sum += v[d * dim + k] * v[e * dim + k] / fmax(a[k * dim + k], least);
            inverse[d * dim + e] = sum;
        }
}

/* What the rows of an operator look at; each uses its own. */
typedef struct loop {
    const mps_stencil *s;
    const double *b, *f; /* correction, field */
    double *out;
    double sign, least;
    const mps__weighed *weighed;
} loop;

/* Pairs worked on at a time: the longest usual row, for buffers on the stack. */
enum { MPS__PAIRS = 64 };

#define MPS__DIM     2
#define MPS__NAME(f) f##_2d
#include "operators.inc"
#undef MPS__DIM
#undef MPS__NAME

#define MPS__DIM     3
#define MPS__NAME(f) f##_3d
#include "operators.inc"
#undef MPS__DIM
#undef MPS__NAME

/* ---- arguments ------------------------------------------------------------------------------------------------- */

/* Where the text of an error goes. The host lies in front, so that a struct cut short still has it. */
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
                         const mps__array *arrays)
{
    mps__context *c = told_to(given);
    MPS__TRY(mps__struct_in(c, "mps_stencil", s, sizeof *s, given));
    MPS__TRY(check_stencil(c, call, s));
    for (; arrays->name; arrays++)
        MPS__CHECK(c, arrays->data, "%s(): %s is NULL: must be an array", call, arrays->name);
    return MPS_OK;
}

/* ---- operators ------------------------------------------------------------------------------------------------- */

/* All rows of an operator, on the threads of the stencil. */
#define RUN(from, operator, ...)                                                                               \
    mps_parallel_rows((from)->parallel, (from)->n, (from)->dim == 2 ? operator##_rows_2d : operator##_rows_3d, \
                      &(loop){.s = (from), __VA_ARGS__})

/* Begin an operator with a copy `own` of its stencil. */
#define BEGIN(...)         \
    mps_stencil own = {0}; \
    MPS__TRY(mps__op_begin(__func__, s, &own, (const mps__array[]){__VA_ARGS__, {NULL, NULL}}))

void mps__op_weigh(const mps_stencil *s, const mps__weighed *out)
{
    RUN(s, weigh, .weighed = out);
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

mps_status mps_matrix_inverse_bounded(int32_t dim, const double *m, double floor, double *inverse)
{
    if ((dim != 2 && dim != 3) || !m || !inverse || !(floor > 0) || !isfinite(floor))
        return MPS_E_ARG;
    if (!mps__finite(m, dim * dim)) return MPS_E_ARG;
    inverse_bounded(m, dim, floor, inverse);
    return MPS_OK;
}
