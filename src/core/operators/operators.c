/* SPDX-License-Identifier: BSD-3-Clause */
/* The public operators: argument checks, then the loop compiled for the dimension. */
#include "operators.h"
#include "base.h"
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
    const double minor = a * b - h * h, determinant = a * (b * c - f * f) - h * (h * c - f * g) + g * (h * f - b * g);
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
    if (dim == 2 ? inverse_regular_2d(m, least, inverse) : inverse_regular_3d(m, least, inverse)) return;
    double a[9], v[9] = {0};
    for (int k = 0; k < dim * dim; k++) a[k] = m[k];
    for (int k = 0; k < dim; k++) v[k * dim + k] = 1.0;
    for (int sweep = 0; sweep < (dim == 2 ? 1 : 6); sweep++)
        for (int p = 0; p < dim; p++)
            for (int q = p + 1; q < dim; q++) rotate(a, v, dim, p, q);
    for (int d = 0; d < dim; d++)
        for (int e = 0; e < dim; e++) {
            double sum = 0;
            for (int k = 0; k < dim; k++) sum += v[d * dim + k] * v[e * dim + k] / fmax(a[k * dim + k], least);
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

/* All rows of an operator, on the threads of the stencil. */
#define RUN(s, operator, ...)                                                                         \
    mps_parallel_rows((s)->parallel, (s)->n, (s)->dim == 2 ? operator##_rows_2d : operator##_rows_3d, \
                      &(loop){.s = (s), __VA_ARGS__})

static bool usable(const mps_stencil *s)
{
    return s && s->struct_size == sizeof *s && (s->dim == 2 || s->dim == 3) && s->n > 0 && s->x && s->begin && s->end && s->col &&
           s->n0 > 0;
}

void mps__op_weigh(const mps_stencil *s, const mps__weighed *out)
{
    RUN(s, weigh, .weighed = out);
}

mps_status mps_op_number_density(const mps_stencil *s, double *n)
{
    if (!usable(s) || !n) return MPS_E_ARG;
    RUN(s, number_density, .out = n);
    return MPS_OK;
}

mps_status mps_op_gradient(const mps_stencil *s, const double *f, double *grad)
{
    if (!usable(s) || !f || !grad) return MPS_E_ARG;
    RUN(s, gradient, .sign = -1.0, .f = f, .out = grad);
    return MPS_OK;
}

mps_status mps_op_gradient_conservative(const mps_stencil *s, const double *f, double *grad)
{
    if (!usable(s) || !f || !grad) return MPS_E_ARG;
    RUN(s, gradient, .sign = 1.0, .f = f, .out = grad);
    return MPS_OK;
}

mps_status mps_op_gradient_corrected(const mps_stencil *s, const double *b, const double *f, double *grad)
{
    if (!usable(s) || !b || !f || !grad) return MPS_E_ARG;
    RUN(s, gradient_corrected, .b = b, .f = f, .out = grad);
    return MPS_OK;
}

mps_status mps_op_divergence(const mps_stencil *s, const double *u, double *div)
{
    if (!usable(s) || !u || !div) return MPS_E_ARG;
    RUN(s, divergence, .f = u, .out = div);
    return MPS_OK;
}

mps_status mps_op_divergence_corrected(const mps_stencil *s, const double *b, const double *u, double *div)
{
    if (!usable(s) || !b || !u || !div) return MPS_E_ARG;
    RUN(s, divergence, .b = b, .f = u, .out = div);
    return MPS_OK;
}

mps_status mps_op_laplacian(const mps_stencil *s, const double *f, double *lap)
{
    if (!usable(s) || !f || !lap) return MPS_E_ARG;
    RUN(s, laplacian, .f = f, .out = lap);
    return MPS_OK;
}

mps_status mps_op_laplacian_vector(const mps_stencil *s, const double *u, double *lap)
{
    if (!usable(s) || !u || !lap) return MPS_E_ARG;
    RUN(s, laplacian_vector, .f = u, .out = lap);
    return MPS_OK;
}

mps_status mps_op_asymmetry(const mps_stencil *s, double *a)
{
    if (!usable(s) || !a) return MPS_E_ARG;
    RUN(s, asymmetry, .out = a);
    return MPS_OK;
}

mps_status mps_op_correction(const mps_stencil *s, double floor, double *b)
{
    if (!usable(s) || !b || !(floor > 0) || !isfinite(floor)) return MPS_E_ARG;
    RUN(s, correction, .least = floor, .out = b);
    return MPS_OK;
}

mps_status mps_matrix_inverse_bounded(int32_t dim, const double *m, double floor, double *inverse)
{
    if ((dim != 2 && dim != 3) || !m || !inverse || !(floor > 0) || !isfinite(floor)) return MPS_E_ARG;
    if (!mps__finite(m, dim * dim)) return MPS_E_ARG;
    inverse_bounded(m, dim, floor, inverse);
    return MPS_OK;
}
