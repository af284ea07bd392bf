/* SPDX-License-Identifier: BSD-3-Clause */
/* Inverse of the moment matrix of a particle, bounded if neighbours are too few. */
#include "operators.h"
#include <math.h>
#include <mps/numbers.h>

/* Jacobi rotation of a symmetric matrix in the plane (p, q); columns of v become the eigenvectors.
 * An angle whose square would overflow is 0 in double precision. */
static void rotate(double *a, double *v, int dim, int p, int q)
{
    const double apq = a[p * dim + q], half = 0.5 * (a[q * dim + q] - a[p * dim + p]);
    if (fabs(apq) <= 1e-154 * fabs(half)) return;
    const double theta = half / apq;
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

/* Inverse by cofactors if all eigenvalues exceed `least`, that is, if m - least 1 is positive
 * definite (its leading minors are positive). This holds for all but a few particles, and is ten
 * times cheaper than eigenvectors. */
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

void mps__inverse_bounded(int dim, const double *m, double least, double *inverse)
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
                sum += v[d * dim + k] * v[e * dim + k] / mps_larger(a[k * dim + k], least);
            inverse[d * dim + e] = sum;
        }
}

mps_status mps_matrix_inverse_bounded(int32_t dim, const double *m, double floor, double *inverse)
{
    if ((dim != 2 && dim != 3) || !m || !inverse || !(floor > 0) || !isfinite(floor))
        return MPS_E_ARG;
    if (!mps__finite(m, dim * dim)) return MPS_E_ARG;
    mps__inverse_bounded(dim, m, floor, inverse);
    return MPS_OK;
}
