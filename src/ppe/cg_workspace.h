/* SPDX-License-Identifier: BSD-3-Clause */
/* Data of conjugate gradients on a device: of a run (cg.c) and of the passes (cg_passes.c). */
#ifndef MPS_PPE_CG_WORKSPACE_H
#define MPS_PPE_CG_WORKSPACE_H

#include "cg.h"
#include "rows.h"
#include "loop.h"
#include <math.h>

/* Why a run has stopped. From NOWHERE on, why it does not begin: the guess has no finite residual,
 * the guess is the solution, a row has a negative diagonal, the hint refuses. */
enum {
    RUNNING,
    REACHED,
    USED_UP,
    POISONED,
    NEGATIVE,
    BROKEN,
    CURVED,
    NOWHERE,
    SOLVED,
    NEGATIVE_ROW,
    REFUSED
};

/* Of a true residual: sum of its squares and of those of the right side; its largest weighted
 * element; 1 if an element is NaN or infinite. */
typedef struct mps__cg_checked {
    mps_exact squares, rhs_squares;
    double largest, poison;
} mps__cg_checked;

/* Of the right side and the first guess. */
typedef struct mps__cg_begun {
    mps_exact rhs_squares;
    double poison;   /* 1: the guess contains NaN or infinity */
    double negative; /* largest absolute value of a negative diagonal entry */
} mps__cg_begun;

/* Numbers on the device; fetch() copies them to the host. */
typedef struct mps__cg_numbers {
    int64_t stop; /* `cancel` of the launches of a run */
    /* `cancel` of the launches after a run: not 0 while the run continues, if it did not begin, and
     * once they have run */
    int64_t over;
    int64_t iterations;
    double rz; /* r'z */
    double alpha, beta;
    double curvature; /* p'Ap */
    /* the run stops when the residual is at most `delta` times its limits */
    double norm_limit, delta;
    double residual[2], divergence[2]; /* of the first guess; current */
    double reduced;                    /* of the hint */
} mps__cg_numbers;

enum { GUESS, NOW };

typedef struct mps__cg_workspace {
    mps__cg_numbers numbers;
    mps__cg_begun begun;
    mps__cg_checked checked;
    mps__reduced got;
    double poison; /* 1: the correction contains NaN or infinity */
} mps__cg_workspace;

/* Arguments of the loops. */
typedef struct mps__cg_recurrence {
    mps__cg_numbers *n;
    const mps__cg_begun *begun;
    const mps__cg_checked *checked;
    const mps__reduced *got;
    const double *poison, *unsolvable;
    /* the equation */
    const int64_t *row;
    const int32_t *col;
    const float *val;
    const double *diagonal, *rhs, *weight; /* the last of these NULL: none */
    double *solution, *start;
    double *x, *r, *p;
    const double *z, *product;
    double tolerance, divergence_limit;
    int64_t most;
    int32_t decision;
    bool preconditioned;
} mps__cg_recurrence;

/* Decisions. */
enum { WHETHER_TO_BEGIN, WHETHER_TO_GO_ON, WHETHER_TO_STOP, DIRECTION, STEP };

/* One solution in progress. */
typedef struct mps__cg_solving {
    const mps__cg *c;
    mps__device *device;
    const mps_parallel *parallel;
    int64_t n;
    mps__cg_workspace *on_device;
    mps__cg_recurrence f;
    double excess; /* of the guess */
} mps__cg_solving;

static inline void mps__cg_queue_rows(const mps__cg_solving *s, const mps__loop *loop, int64_t n)
{
    mps__loop_run(s->parallel, loop, MPS__ANY_DIM, n, &s->f);
}

static inline void mps__cg_queue_values(const mps__cg_solving *s, const mps__values *values,
                                        void *to)
{
    mps__values_reduce_async(s->device, values, MPS__ANY_DIM, s->n, &s->f, to);
}

/* Evaluates a checked residual as mps_ppe_check() does. Returns the excess. */
MPS_ROW double mps__cg_note_residual(const mps__cg_recurrence *f, int of)
{
    const mps__cg_checked *c = f->checked;
    const double squares = mps_exact_value(&c->squares),
                 rhs_squares = mps_exact_value(&c->rhs_squares);
    f->n->residual[of] = sqrt(squares) / (rhs_squares > 0 ? sqrt(rhs_squares) : 1);
    f->n->divergence[of] = c->poison > 0 ? NAN : c->largest > 0 ? c->largest : 0;
    return mps__excess_of(f->n->residual[of], f->tolerance, f->n->divergence[of],
                          f->divergence_limit);
}

/* Queue a decision. */
void mps__cg_queue_decision(mps__cg_solving *s, int32_t decision);
/* Queue an iteration. Returns 0 or a reason of failure of the host. */
int mps__cg_queue_iteration(mps__cg_solving *s);

#endif
