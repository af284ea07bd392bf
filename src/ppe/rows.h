/* SPDX-License-Identifier: BSD-3-Clause */
/* Building blocks of the solvers. Sums over rows are exact (mps/exact.h), so that the bytes of a
 * result depend neither on the number of threads nor on the order of the rows. */
#ifndef MPS_PPE_ROWS_H
#define MPS_PPE_ROWS_H

#include "device.h"
#include "vectors.h"
#include <mps/exact.h>
#include <mps/ppe.h>
#include <mps/stage.h>
#include <stdbool.h>

/* Elements of a block; elements from which on a loop with little work each uses a second thread. */
enum { MPS__BLOCK = 1024, MPS__TEAM_LEAST = 8192 };

/* The parallel-for of a loop over n elements. NULL, the calling thread alone, if n is so small that
 * starting threads takes longer than the loop. On a device it is unchanged. */
static inline const mps_parallel *mps__team(const mps_parallel *p, int64_t n)
{
    return n < MPS__TEAM_LEAST && !mps__device_of(p) ? NULL : p;
}

/* Allocate `count` elements (at least one), not zeroed. NULL: out of memory. */
void *mps__take(const mps_allocator *allocator, int64_t count, size_t size);
void mps__release(const mps_allocator *allocator, void *block);

/* y = A x. @return x'y */
double mps__rows_multiply(const mps_ppe_problem *problem, const double *x, double *y);
/* As mps__rows_multiply(), on the device of the problem's parallel-for; the sum is not waited
 * for. */
void mps__rows_multiply_async(const mps_ppe_problem *problem, const double *x, double *y,
                              mps__reduced *to);
/* Whether no row has a negative diagonal. */
bool mps__rows_nonnegative(const mps_ppe_problem *problem);

/* Whether `here` is true on any rank. */
bool mps__on_any_rank(const mps_ppe_problem *problem, bool here);
/* Columns of the matrix: the capacity of an array that is multiplied by it. */
static inline int64_t mps__columns(const mps_ppe_problem *problem)
{
    return problem->n + (problem->ranks ? problem->ranks->ghosts : 0);
}

/* Zero a first guess that contains NaN or infinity. */
void mps__guess_clean(const mps_ppe_problem *problem, double *p);
/* Sum, number and mean of the rows of a singular component. */
typedef struct mps__component {
    mps_exact sum;
    double rows, mean;
} mps__component;

/* The first guess, centred (zero if p has no finite residual), and its residual in `residual` [n].
 * False: the residual of zero is not finite either. */
bool mps__guess_begin(const mps_ppe_problem *problem, double *p, double *residual,
                      mps__component *sums, mps_ppe_result *result);
/* Whether a curvature x'Ax < 0 exceeds the rounding of a direction of zero curvature. */
bool mps__curvature_negative(const mps_ppe_problem *problem, const double *x, double curvature);
/* Subtract the mean of p over each singular component, whose null vector is 1; sums [components] is
 * workspace. */
void mps__components_center(const mps_ppe_problem *problem, double *p, mps__component *sums);

/* Initialise a result, as if memory ran out. */
void mps__result_begin(mps_ppe_result *result);
/* How far a residual and a divergence are above the requested limits; at most 1: both are met.
 * Limit of divergence 0: not checked. */
MPS_ROW double mps__excess_of(double residual, double tolerance, double divergence, double limit)
{
    const double norm = residual == 0 ? 0 : residual / tolerance,
                 other = limit > 0 ? divergence / limit : 0;
    return norm >= other ? norm : other;
}
double mps__result_excess(const mps_ppe_problem *problem, const mps_ppe_result *result);
/* Target residual of a pass that begins at `now`: not lower than a recursive residual is
 * reliable. */
MPS_ROW double mps__aim(double wanted, double now)
{
    const double deepest = 1e-10 * now;
    return wanted >= deepest ? wanted : deepest;
}

/* Progress of the passes of a solver that stops on its recursive residual: passes are repeated
 * until the true one is small enough. */
typedef struct mps__progress {
    int passes, idle; /* in total; latest ones without progress */
    double best;      /* excess, initially that of the guess */
} mps__progress;
/* Evaluate a pass that reached `excess` with `failure`, 0: none. @return the reason to stop, < 0:
 * continue */
int mps__progress_after(mps__progress *p, double excess, int failure);

double mps__seconds(void); /* of a monotonic clock */

#endif
