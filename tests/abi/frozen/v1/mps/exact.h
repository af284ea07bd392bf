/* SPDX-License-Identifier: BSD-3-Clause */
/** @file exact.h  Reproducible sums: their bytes depend neither on the order nor on the grouping of
 *  the terms.
 *
 *  The levels k = 0, 1, ... have the units u_k = 2^(26 k - 1074). A term v adds an integer number
 *  n_k of units to the levels K+2, K+1, K, in this order:
 *
 *    n_k = v/u_k rounded to the nearest integer, halves to even,   v <- v - n_k u_k.
 *
 *  The remainder of v after the third level is discarded. K is the lowest level for which the
 *  largest |v| is below 2^77 u_K. The numbers n_k depend on v only, and are 0 in levels above those
 *  of the term. Therefore the three integer sums of n_k, and the value, depend only on the set of
 *  terms.
 *
 *  The value of N terms differs from the sum of the terms by at most N 2^-52 max|v|, plus one
 *  rounding to double. At most 2^37 terms may be added to one sum.
 *
 *  Method: Demmel & Nguyen 2015, "Parallel reproducible summation", IEEE Trans. Comput. 64. */
#ifndef MPS_EXACT_H
#define MPS_EXACT_H

#include <mps/parallel.h>

MPS_BEGIN_DECLS

/** A sum; all zero: no terms. Owned by the caller, may be copied. Read it with mps_exact_value().
 *  It is not thread-safe: use one sum per thread and join the sums. */
typedef struct mps_exact {
    /** Sum of n_k for k = level, level+1, level+2. */
    int64_t part[3];
    /** K, the lowest level. */
    int32_t level;
    /** Non-finite terms: bit 0 for infinity, bit 1 for -infinity, bit 2 for NaN. */
    int32_t special;
} mps_exact;

/** Initialise a sum without terms. */
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

/** Sums and maxima of mps_exact_rows(), at most MPS_PARALLEL_VALUES in total. */
typedef struct mps_exact_values {
    /** Number of sums. */
    int32_t sums;
    /** Number of maxima. */
    int32_t maxima;
    /** [sums] in and out: rows are added. */
    mps_exact *sum;
    /** [maxima] in and out: raised by rows. NaN is ignored. */
    double *maximum;
} mps_exact_values;

/** Sums and maxima over rows 0..n-1 in one loop. The result has the same bytes for any number of
 *  threads and any order of the rows.
 *  @param p NULL: in the calling thread
 *  @param least > 0, minimum number of rows of a range
 *  @param body is called with ranges that together cover all rows; the terms of a row must not
 *         depend on the range */
MPS_API void mps_exact_rows(const mps_parallel *p, int64_t n, int64_t least, mps_exact_fn body,
                            void *argument, const mps_exact_values *values);

MPS_END_DECLS

#endif
