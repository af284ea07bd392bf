/* SPDX-License-Identifier: BSD-3-Clause */
/* Three successive rotations about the axes of a rigid body. */
#ifndef MPS_CORE_ROTATION_H
#define MPS_CORE_ROTATION_H

#include <stdbool.h>
#include <stdint.h>

/* A right-handed set of unit vectors. */
typedef struct mps__triad {
    double e[3][3];
} mps__triad;

/* Three angles, each about a body axis in the position after the rotations before it. */
typedef struct mps__angles {
    const int32_t *order;               /* [3] axes 0, 1, 2, the first rotation first */
    double angle[3], rate[3], accel[3]; /* by index in `order` [rad, rad/s, rad/s2] */
} mps__angles;

/* Rotate the body. axes->e[k] is its axis k, in and out. omega, alpha: out, angular velocity and
 * acceleration [rad/s], [rad/s2]. */
void mps__rotation_apply(const mps__angles *a, mps__triad *axes, double omega[3], double alpha[3]);

/* Angles that rotate `rest` to `axes`, with their rates: the first and the third in -pi..pi, the
 * second in -pi/2..pi/2; if the body rotates about the axis of the second alone, that one in
 * -pi..pi. false: the second is within 1e-6 of +-pi/2, where the first and the third are
 * degenerate. */
bool mps__rotation_angles(const mps__triad *rest, const mps__triad *axes, const double omega[3],
                          const double alpha[3], mps__angles *a);

static inline void mps__cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

#endif
