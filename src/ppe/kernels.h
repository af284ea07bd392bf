/* SPDX-License-Identifier: BSD-3-Clause */
/* Building blocks of the solvers. Sums over rows are exact (mps/exact.h), so the bytes of a result depend neither on the
 * number of threads nor on the order of the rows. */
#ifndef MPS_PPE_KERNELS_H
#define MPS_PPE_KERNELS_H

#include "device.h"
#include "vectors.h"
#include <mps/exact.h>
#include <mps/ppe.h>
#include <mps/stage.h>
#include <stdbool.h>

/* Elements of a block; elements that are worth a second thread in loops of next to nothing each. */
enum { MPS__BLOCK = 1024, MPS__TEAM_LEAST = 8192 };

/* The parallel-for of a loop over n elements: NULL, the calling thread alone, if there are so few
 * that the start of other threads takes longer than the loop. That of a device stays. */
static inline const mps_parallel *mps__team(const mps_parallel *p, int64_t n)
{
    return n < MPS__TEAM_LEAST && !mps__device_of(p) ? NULL : p;
}

/* `count` elements (at least one) or NULL; not zeroed. */
void *mps__take(const mps_allocator *allocator, int64_t count, size_t size);
void mps__give(const mps_allocator *allocator, void *block);

/* y = A x. @return x'y */
double mps__rows_multiply(const mps_ppe_problem *problem, const double *x, double *y);
/* The same on the device of the problem's parallel-for, without waiting for the sum. */
void mps__rows_gather(const mps_ppe_problem *problem, const double *x, double *y, mps__reduced *to);
/* Whether no row has a negative diagonal. */
bool mps__rows_nonnegative(const mps_ppe_problem *problem);

/* Whether something is so on any rank. */
bool mps__on_any_rank(const mps_ppe_problem *problem, bool here);
/* Columns of the matrix: room for an array that is multiplied by it. */
static inline int64_t mps__columns(const mps_ppe_problem *problem)
{
    return problem->n + (problem->ranks ? problem->ranks->ghosts : 0);
}

/* A first guess with NaN or infinity becomes zero. */
void mps__guess_clean(const mps_ppe_problem *problem, double *p);
/* Sum, number and mean of the rows of a singular component. */
typedef struct mps__component {
    mps_exact sum;
    double rows, mean;
} mps__component;

/* The guess a solver begins with, zero if p leads nowhere, centred, and its residual in `residual` [n]. False: not even that is finite. */
bool mps__guess_begin(const mps_ppe_problem *problem, double *p, double *residual,
                      mps__component *sums, mps_ppe_result *result);
/* Whether the curvature x'Ax < 0 is more than the rounding of a direction of no curvature. */
bool mps__curvature_negative(const mps_ppe_problem *problem, const double *x, double curvature);
/* Subtract the mean of p over each singular component, whose null vector is 1; sums [components] is scratch. */
void mps__components_center(const mps_ppe_problem *problem, double *p, mps__component *sums);

/* What a solver reports before it has done anything: no memory. */
void mps__result_begin(mps_ppe_result *result);
/* How far a residual and a divergence are above the wanted limits; at most 1: both are met. A limit of divergence of 0: it is not asked. */
MPS_ROW double mps__excess_of(double residual, double tolerance, double divergence, double limit)
{
    const double norm = residual == 0 ? 0 : residual / tolerance,
                 other = limit > 0 ? divergence / limit : 0;
    return norm >= other ? norm : other;
}
double mps__result_excess(const mps_ppe_problem *problem, const mps_ppe_result *result);
/* The residual that a pass aims at, which begins at `now`: never deeper than a recursive residual can be trusted. */
MPS_ROW double mps__aim(double wanted, double now)
{
    const double deepest = 1e-10 * now;
    return wanted >= deepest ? wanted : deepest;
}

/* Passes of a solver that stops on a residual of its own: they go on until the true one is small enough. */
typedef struct mps__progress {
    int passes, idle; /* in all; the last ones, without progress */
    double best;      /* excess, that of the guess at first */
} mps__progress;
/* After a pass that has reached `excess` and found `failure`, 0: none. @return the reason that ends them, < 0: they go on */
int mps__progress_after(mps__progress *p, double excess, int failure);

double mps__seconds(void); /* monotonic */

#endif
