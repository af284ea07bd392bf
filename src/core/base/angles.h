/* SPDX-License-Identifier: BSD-3-Clause */
/* Trigonometric functions independent of the C library, like those of mps/numbers.h: the bytes of a
 * moving tank are the same on every machine. */
#ifndef MPS_CORE_ANGLES_H
#define MPS_CORE_ANGLES_H

#define MPS__PI 3.14159265358979323846

/* Errors below 0.95 ulp for |x| < 1e8, below 5 ulp for |x| < 2^50. Larger x are 0.25 rad apart and
 * define no angle: the result is NaN, as for infinities and NaN. */
double mps__sin(double x);
double mps__cos(double x);

/* Angle of the vector (x, y), -pi..pi, like atan2() of C; error below 2 ulp. */
double mps__atan2(double y, double x);
/* -1 <= x <= 1; error below 3 ulp. */
double mps__asin(double x);
/* sqrt(x^2 + y^2); the squares must not overflow. */
double mps__hypot(double x, double y);

#endif
