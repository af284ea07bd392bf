/* SPDX-License-Identifier: BSD-3-Clause */
/* The public operators: argument checks, then the loop compiled for the dimension. */
#include "base.h"
#include <math.h>
#include <mps/operators.h>

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

/* Inverse of a symmetric matrix whose eigenvalues are raised to `least`: bounded where neighbours are too few. */
static void inverse_bounded(const double *m, int dim, double least, double *inverse)
{
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

#define MPS__DIM 2
#define MPS__NAME(f) f##_2d
#include "operators.inc"
#undef MPS__DIM
#undef MPS__NAME

#define MPS__DIM 3
#define MPS__NAME(f) f##_3d
#include "operators.inc"
#undef MPS__DIM
#undef MPS__NAME

#define DISPATCH(s, f, ...)                            \
    do {                                               \
        if ((s)->dim == 2)                             \
            f##_2d((s), __VA_ARGS__);                  \
        else                                           \
            f##_3d((s), __VA_ARGS__);                  \
    } while (0)

static bool usable(const mps_stencil *s)
{
    return s && s->struct_size == sizeof *s && (s->dim == 2 || s->dim == 3) && s->n > 0 && s->x && s->begin && s->end && s->col && s->n0 > 0;
}

mps_status mps_op_number_density(const mps_stencil *s, double *n)
{
    if (!usable(s) || !n) return MPS_E_ARG;
    DISPATCH(s, number_density, n);
    return MPS_OK;
}

mps_status mps_op_gradient(const mps_stencil *s, const double *f, double *grad)
{
    if (!usable(s) || !f || !grad) return MPS_E_ARG;
    DISPATCH(s, gradient, -1.0, f, grad);
    return MPS_OK;
}

mps_status mps_op_gradient_conservative(const mps_stencil *s, const double *f, double *grad)
{
    if (!usable(s) || !f || !grad) return MPS_E_ARG;
    DISPATCH(s, gradient, 1.0, f, grad);
    return MPS_OK;
}

mps_status mps_op_gradient_corrected(const mps_stencil *s, const double *b, const double *f, double *grad)
{
    if (!usable(s) || !b || !f || !grad) return MPS_E_ARG;
    DISPATCH(s, gradient_corrected, b, f, grad);
    return MPS_OK;
}

mps_status mps_op_divergence(const mps_stencil *s, const double *u, double *div)
{
    if (!usable(s) || !u || !div) return MPS_E_ARG;
    DISPATCH(s, divergence, NULL, u, div);
    return MPS_OK;
}

mps_status mps_op_divergence_corrected(const mps_stencil *s, const double *b, const double *u, double *div)
{
    if (!usable(s) || !b || !u || !div) return MPS_E_ARG;
    DISPATCH(s, divergence, b, u, div);
    return MPS_OK;
}

mps_status mps_op_laplacian(const mps_stencil *s, const double *f, double *lap)
{
    if (!usable(s) || !f || !lap) return MPS_E_ARG;
    DISPATCH(s, laplacian, f, lap);
    return MPS_OK;
}

mps_status mps_op_laplacian_vector(const mps_stencil *s, const double *u, double *lap)
{
    if (!usable(s) || !u || !lap) return MPS_E_ARG;
    DISPATCH(s, laplacian_vector, u, lap);
    return MPS_OK;
}

mps_status mps_op_asymmetry(const mps_stencil *s, double *a)
{
    if (!usable(s) || !a) return MPS_E_ARG;
    DISPATCH(s, asymmetry, a);
    return MPS_OK;
}

mps_status mps_op_correction(const mps_stencil *s, double floor, double *b)
{
    if (!usable(s) || !b || !(floor > 0) || !isfinite(floor)) return MPS_E_ARG;
    DISPATCH(s, correction, floor, b);
    return MPS_OK;
}

mps_status mps_matrix_inverse_bounded(int32_t dim, const double *m, double floor, double *inverse)
{
    if ((dim != 2 && dim != 3) || !m || !inverse || !(floor > 0) || !isfinite(floor)) return MPS_E_ARG;
    inverse_bounded(m, dim, floor, inverse);
    return MPS_OK;
}
