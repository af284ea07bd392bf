/* SPDX-License-Identifier: BSD-3-Clause */
/* Loops over the elements of vectors, in the memory space of the parallel-for and of the arrays:
 * host or device. Arrays are identical or do not overlap. */
#ifndef MPS_PPE_VECTORS_H
#define MPS_PPE_VECTORS_H

#include <mps/exact.h>
#include <mps/ppe.h>
#include <stdbool.h>

/* z = a */
void mps__vectors_fill(const mps_parallel *p, int64_t n, double a, double *z);
/* z = a x */
void mps__vectors_scale(const mps_parallel *p, int64_t n, double a, const double *x, double *z);
/* z = a x + b y; `a` and `b` are the two factors. */
void mps__vectors_sum(const mps_parallel *p, int64_t n, const double factor[2], const double *x,
                      const double *y, double *z);
/* z = x y, by elements */
void mps__vectors_product(const mps_parallel *p, int64_t n, const double *x, const double *y,
                          double *z);
/* z = x / y */
void mps__vectors_quotient(const mps_parallel *p, int64_t n, const double *x, const double *y,
                           double *z);
/* z = |x| */
void mps__vectors_absolute(const mps_parallel *p, int64_t n, const double *x, double *z);
/* z = 1 / x */
void mps__vectors_inverse(const mps_parallel *p, int64_t n, const double *x, double *z);
/* z = x, and z = 0 */
void mps__vectors_copy(const mps_parallel *p, int64_t n, const double *x, double *z);
void mps__vectors_clear(const mps_parallel *p, int64_t n, double *z);

/* Over the rows of all ranks: sum of x y; sum of (x y)^2. */
double mps__vectors_dot(const mps_ppe_problem *problem, const double *x, const double *y);
double mps__vectors_squares(const mps_ppe_problem *problem, const double *x, const double *y);
/* Sum of x^2, and largest |x weight|, without NaNs; weight NULL: 0. */
void mps__vectors_norms(const mps_ppe_problem *problem, const double *x, const double *weight,
                        double *squares, double *largest);
/* Asynchronous reductions on the device of the problem's parallel-for: `to` is an address of the
 * device. */
typedef struct mps__reduced {
    mps_exact sum;
    double largest;
} mps__reduced;
void mps__vectors_dot_async(const mps_ppe_problem *problem, const double *x, const double *y,
                            mps__reduced *to);
/* Largest of factor x, or of |x| if the factor is 0; not below `least`. NaNs do not count. */
double mps__vectors_largest(const mps_ppe_problem *problem, const double *x, double factor,
                            double least);
/* Whether an element is NaN or infinite. */
bool mps__vectors_poisoned(const mps_ppe_problem *problem, const double *x);

#endif
