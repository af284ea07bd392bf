/* SPDX-License-Identifier: BSD-3-Clause */
/* Solution of the pressure equation with least pressures: p_i >= least_i where terms say so. */
#ifndef MPS_CORE_BOUNDS_H
#define MPS_CORE_BOUNDS_H

#include "ppe.h"

/* Rows with a least pressure, and what pinning changed in the matrix. */
typedef struct mps__bounds {
    mps__context *context;
    int64_t count, capacity;
    struct mps__bound *list;
    const uint8_t *held; /* [particles] 1: at its least in the last step; borrowed for a solution */
    int32_t solves;      /* of the last call */
    bool any;            /* on any rank a row has a least pressure */
    bool still;          /* held rows are held at 0 */
    double *pinned;      /* [columns] pressure of a held row, else NaN */
    uint8_t *mark;       /* [n] 1: the row has a pinned column or is held */
    int64_t pinned_capacity, mark_capacity;
    int64_t changes, changes_capacity;
    struct mps__change *change;
} mps__bounds;

/* For the condition of a row, from the solution on: a row with a least pressure is at it. */
enum { MPS__ROW_HELD = 3 };

void mps__bounds_init(mps__bounds *b, mps__context *context);
void mps__bounds_free(mps__bounds *b);
/* Whether an equation, on a device or not, has a row of MPS_ROW_LEAST. */
bool mps__bounds_any(const mps__ppe *e, const mps__ppe_terms *t);
/* Solve the assembled equation for e->p, with p_i >= value_i in rows of MPS_ROW_LEAST, beginning with those of b->held; its condition becomes
 * MPS__ROW_HELD where they are at it now. Iterations and times of `result` are those of all solutions.
 * An equation on a device may have no such row. */
mps_status mps__bounds_solve(mps__bounds *b, mps__solvers *solvers, mps__ppe *e, const mps_view *s,
                             mps__ppe_terms *t, mps_ppe_result *result);
/* Solve the same matrix for another right side `rhs` [n]: the change of pressures by a change of it, which is 0 in held rows and in rows
 * whose pressure is given. A row with a law has its tangent at e->p. p [columns]: first guess and solution. After mps__bounds_solve(). */
mps_status mps__bounds_solve_change(mps__bounds *b, mps__solvers *solvers, mps__ppe *e, double *rhs,
                                    double *p, mps_ppe_result *result);

#endif
