/* SPDX-License-Identifier: BSD-3-Clause */
/* Functions of angles that depend on no C library, as those of mps/numbers.h: the bytes of a moving tank are the same everywhere. */
#ifndef MPS_CORE_ANGLES_H
#define MPS_CORE_ANGLES_H

#define MPS__PI 3.14159265358979323846

/* Errors below 0.95 units in the last place for |x| < 1e8, below 5 for |x| < 2^50. Larger x are 0.25 rad apart and tell no angle: the result
 * is NaN, as of infinities and NaN. */
double mps__sin(double x);
double mps__cos(double x);

/* Angle of the vector (x, y), -pi..pi, as atan2() of C; below 2 units in the last place. */
double mps__atan2(double y, double x);
/* -1 <= x <= 1; below 3 units in the last place. */
double mps__asin(double x);
/* sqrt(x^2 + y^2), where the squares are in the range of doubles. */
double mps__hypot(double x, double y);

#endif
