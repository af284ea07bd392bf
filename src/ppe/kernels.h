/* SPDX-License-Identifier: BSD-3-Clause */
/* Building blocks of the solvers. Reductions run over fixed blocks whose sums are added in order, so the bytes of a
 * result do not depend on the number of threads. */
#ifndef MPS_PPE_KERNELS_H
#define MPS_PPE_KERNELS_H

#include <mps/ppe.h>
#include <stdbool.h>

/* Elements of a block; elements that are worth a second thread in loops of next to nothing each. */
enum { MPS__BLOCK = 1024, MPS__TEAM_LEAST = 8192 };

/* The next loop has rounds that do not depend on each other: arrays in it are the same or apart. */
#if defined(__clang__)
#define MPS__INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define MPS__INDEPENDENT _Pragma("GCC ivdep")
#else
#define MPS__INDEPENDENT
#endif

static inline int64_t mps__blocks(int64_t n)
{
    return (n + MPS__BLOCK - 1) / MPS__BLOCK;
}

/* One past the last element of a block. */
static inline int64_t mps__block_end(int64_t block, int64_t n)
{
    const int64_t end = (block + 1) * MPS__BLOCK;
    return end < n ? end : n;
}

/* The parallel-for of a loop over n elements: NULL, the calling thread alone, if there are so few
 * that the start of other threads takes longer than the loop. */
static inline const mps_parallel *mps__team(const mps_parallel *p, int64_t n)
{
    return n < MPS__TEAM_LEAST ? NULL : p;
}

/* `count` elements (at least one) or NULL; not zeroed. */
void *mps__take(const mps_allocator *allocator, int64_t count, size_t size);
void mps__give(const mps_allocator *allocator, void *block);

/* The sum of the blocks' sums in their order. */
double mps__sum_blocks(const double *partial, int64_t count);
/* x'y over at most one block. */
double mps__block_dot(const double *x, const double *y, int64_t count);
/* x'y; partial [blocks] is scratch. */
double mps__blocked_dot(const mps_parallel *p, const double *x, const double *y, int64_t n,
                        double *partial);

/* y = A x. @return x'y; partial [blocks] is scratch */
double mps__rows_multiply(const mps_ppe_problem *problem, const double *x, double *y,
                          double *partial);
/* Whether no row has a negative diagonal. */
bool mps__rows_nonnegative(const mps_ppe_problem *problem);

/* A first guess with NaN or infinity becomes zero. */
void mps__guess_clean(double *p, int64_t n);
/* The guess a solver begins with, zero if p leads nowhere, centred, and its residual in `residual` [n]. False: not even that is finite. */
bool mps__guess_begin(const mps_ppe_problem *problem, double *p, double *residual, double *sums,
                      mps_ppe_result *result);
/* Whether the curvature x'Ax < 0 is more than the rounding of a direction of no curvature. */
bool mps__curvature_negative(const mps_ppe_problem *problem, const double *x, double curvature);
/* Subtract the mean of p over each singular component, whose null vector is 1; sums [2 components] is scratch. */
void mps__components_center(const mps_ppe_problem *problem, double *p, double *sums);

/* What a solver reports before it has done anything: no memory. */
void mps__result_begin(mps_ppe_result *result);
/* How far a result is above the wanted limits; at most 1: both are met. */
double mps__result_excess(const mps_ppe_problem *problem, const mps_ppe_result *result);

double mps__seconds(void); /* monotonic */

#endif
