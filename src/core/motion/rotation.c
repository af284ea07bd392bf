/* SPDX-License-Identifier: BSD-3-Clause */
/* Rotations about body-fixed axes. */
#include "rotation.h"
#include "angles.h"
#include "base.h"
#include <math.h>

/* Rotate the two other axes about axis k, from its successor towards the next one. */
static void turn_about(int32_t k, double angle, mps__triad *axes)
{
    const double c = mps__cos(angle), s = mps__sin(angle);
    double *from = axes->e[(k + 1) % 3], *to = axes->e[(k + 2) % 3];
    for (int d = 0; d < 3; d++) {
        const double f = from[d], t = to[d];
        from[d] = c * f + s * t;
        to[d] = c * t - s * f;
    }
}

/* omega = sum of rate_k e_k, where e_k is the axis of rotation k after the rotations before it. It
 * rotates with their omega, so alpha = sum of accel_k e_k + omega_before x rate_k e_k. */
void mps__rotation_apply(const mps__angles *a, mps__triad *axes, double omega[3], double alpha[3])
{
    for (int d = 0; d < 3; d++) omega[d] = alpha[d] = 0;
    for (int n = 0; n < 3; n++) {
        const double *e = axes->e[a->order[n]];
        double swing[3];
        mps__cross(omega, e, swing);
        for (int d = 0; d < 3; d++) {
            alpha[d] += a->accel[n] * e[d] + a->rate[n] * swing[d];
            omega[d] += a->rate[n] * e[d];
        }
        turn_about(a->order[n], a->angle[n], axes);
    }
}

/* Components of an angular velocity, or of the remaining angular acceleration, along the axes of
 * the three rotations. The second is normal to the others, which have the cosine g. */
static void along_axes(const mps__triad *axes, double g, double square, const double w[3],
                       double out[3])
{
    const double first = mps__dot(w, axes->e[0], 3), third = mps__dot(w, axes->e[2], 3);
    out[0] = (first - g * third) / square;
    out[1] = mps__dot(w, axes->e[1], 3);
    out[2] = (third - g * first) / square;
}

/* With i, j, k the axes in order, s = 1 where k follows j and j follows i, else -1, and M = (rest_m
 * . axes_n):
 *   M_ik = s sin b, M_jk = -s sin a cos b, M_kk = cos a cos b, M_ij = -s cos b sin c, M_ii = cos b
 * cos c. */
static bool find_angles(const mps__triad *rest, const mps__triad *axes, mps__angles *a,
                        double *square)
{
    const int32_t i = a->order[0], j = a->order[1], k = a->order[2];
    const double s = j == (i + 1) % 3 ? 1 : -1;
    const double ii = mps__dot(rest->e[i], axes->e[i], 3), ij = mps__dot(rest->e[i], axes->e[j], 3),
                 ik = mps__dot(rest->e[i], axes->e[k], 3), cosine = mps__hypot(ii, ij);
    a->angle[0] = mps__atan2(-s * mps__dot(rest->e[j], axes->e[k], 3),
                             mps__dot(rest->e[k], axes->e[k], 3));
    a->angle[1] = mps__atan2(s * ik, cosine);
    a->angle[2] = mps__atan2(-s * ij, ii);
    *square = cosine * cosine;
    return cosine > 1e-6;
}

/* Whether the body rotates about its axis j alone; then that is the second angle, of any size. */
static bool turns_about(const mps__triad *rest, const mps__triad *axes, const double omega[3],
                        const double alpha[3], mps__angles *a)
{
    const int32_t i = a->order[0], j = a->order[1], k = a->order[2];
    const double s = j == (i + 1) % 3 ? 1 : -1;
    const int32_t others[2] = {i, k};
    for (int n = 0; n < 2; n++) {
        const double *e = rest->e[others[n]];
        if (mps__dot(e, axes->e[j], 3) != 0 || mps__dot(e, omega, 3) != 0 ||
            mps__dot(e, alpha, 3) != 0)
            return false;
    }
    if (mps__dot(rest->e[j], axes->e[j], 3) < 0) return false;
    for (int n = 0; n < 3; n++) a->angle[n] = a->rate[n] = a->accel[n] = 0;
    a->angle[1] = mps__atan2(s * mps__dot(rest->e[i], axes->e[k], 3),
                             mps__dot(rest->e[i], axes->e[i], 3));
    a->rate[1] = mps__dot(rest->e[j], omega, 3);
    a->accel[1] = mps__dot(rest->e[j], alpha, 3);
    return true;
}

bool mps__rotation_angles(const mps__triad *rest, const mps__triad *axes, const double omega[3],
                          const double alpha[3], mps__angles *a)
{
    mps__triad along, turned = *rest;
    double square, turn[3], left[3];
    if (turns_about(rest, axes, omega, alpha, a)) return true;
    if (!find_angles(rest, axes, a, &square)) return false;
    const int32_t i = a->order[0], j = a->order[1], k = a->order[2];
    const double s = j == (i + 1) % 3 ? 1 : -1, c = mps__cos(a->angle[0]),
                 sine = s * mps__sin(a->angle[0]);
    for (int d = 0; d < 3; d++) {
        along.e[0][d] = rest->e[i][d];
        along.e[1][d] = c * rest->e[j][d] + sine * rest->e[k][d];
        along.e[2][d] = axes->e[k][d];
    }
    const double g = mps__dot(along.e[0], along.e[2], 3);
    along_axes(&along, g, square, omega, a->rate);
    /* angular acceleration due to the rates alone */
    for (int n = 0; n < 3; n++) a->accel[n] = 0;
    mps__rotation_apply(a, &turned, turn, left);
    for (int d = 0; d < 3; d++) left[d] = alpha[d] - left[d];
    along_axes(&along, g, square, left, a->accel);
    return true;
}
