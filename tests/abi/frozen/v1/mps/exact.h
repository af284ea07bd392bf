/* SPDX-License-Identifier: BSD-3-Clause */
/** @file exact.h  Sums whose bytes depend neither on the order nor on the grouping of their terms.
 *
 *  The levels k = 0, 1, ... have the units u_k = 2^(26 k - 1074). A term v leaves an integer number
 *  of units in the three levels K+2, K+1, K, one after the other:
 *
 *    n_k = v/u_k rounded to the nearest integer, halves to even,   v <- v - n_k u_k.
 *
 *  What is left of v after the third is dropped. K is the lowest level for which the largest |v| is
 *  below 2^77 u_K. The numbers n_k depend on v alone, and a level above those of a term gets 0 from
 *  it. So the three integer sums of n_k, and the value, depend only on the set of terms.
 *
 *  The value of N terms differs from the sum of the terms by at most N 2^-52 max|v|, beside one
 *  rounding to double. At most 2^37 terms may be added to one sum.
 *
 *  Method: Demmel & Nguyen 2015, "Parallel reproducible summation", IEEE Trans. Comput. 64. */
#ifndef MPS_EXACT_H
#define MPS_EXACT_H

#include <mps/parallel.h>

MPS_BEGIN_DECLS

/** A sum; all zero: no terms yet. Memory of the caller, may be copied. Read it with
 *  mps_exact_value(). Functions on one sum must not run at the same time; give each thread its own
 *  sum and join them. */
typedef struct mps_exact {
    /** Sum of n_k for k = level, level+1, level+2. */
    int64_t part[3];
    /** K, the lowest level. */
    int32_t level;
    /** Terms that are not finite: bit 0 for infinity, bit 1 for -infinity, bit 2 for NaN. */
    int32_t special;
} mps_exact;

/** Begin a sum without terms. */
MPS_API void mps_exact_begin(mps_exact *sum);

/** Add terms. @param terms [count] */
MPS_API void mps_exact_add(mps_exact *sum, int64_t count, const double *terms);

/** Add the products x_i y_i, each rounded to double. @param x [count] @param y [count] */
MPS_API void mps_exact_add_products(mps_exact *sum, int64_t count, const double *x,
                                    const double *y);

/** Add all terms of another sum. */
MPS_API void mps_exact_join(mps_exact *sum, const mps_exact *other);

/** The sum of all terms. 0 without terms; NaN if a term is NaN, or if terms are infinite with both
 *  signs; infinity with the sign of the infinite terms, or if the sum is beyond the range of
 *  double. */
MPS_API double mps_exact_value(const mps_exact *sum);

/** Rows begin..end-1 of a sum: adds terms to the sums and raises the maxima. */
typedef void (*mps_exact_fn)(void *argument, int64_t begin, int64_t end, mps_exact *sums,
                             double *maxima);

/** Sums and maxima of mps_exact_rows(), MPS_PARALLEL_VALUES in all at most. */
typedef struct mps_exact_values {
    /** Number of sums. */
    int32_t sums;
    /** Number of maxima. */
    int32_t maxima;
    /** [sums] Rows are added to what they hold before. */
    mps_exact *sum;
    /** [maxima] Not below what they hold before. A NaN does not count. */
    double *maximum;
} mps_exact_values;

/** Sums and maxima over rows 0..n-1 in one loop. The result has the same bytes for any number of
 *  threads and any order of the rows.
 *  @param p NULL: in the calling thread
 *  @param least > 0, rows of a range at least
 *  @param body is called with ranges that together are all rows; adds the same terms for a row in
 *         any range */
MPS_API void mps_exact_rows(const mps_parallel *p, int64_t n, int64_t least, mps_exact_fn body,
                            void *argument, const mps_exact_values *values);

MPS_END_DECLS

#endif
