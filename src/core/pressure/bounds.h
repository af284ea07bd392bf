/* SPDX-License-Identifier: BSD-3-Clause */
/* Solution of the pressure equation with lower bounds: p_i >= least_i for rows of MPS_ROW_LEAST. */
#ifndef MPS_CORE_BOUNDS_H
#define MPS_CORE_BOUNDS_H

#include "ppe.h"

/* Lower bounds on a device: arguments of the row functions. */
typedef struct mps__bound_rows {
    const int64_t *row;
    const int32_t *col, *particle;
    float *val, *kept; /* entries of the matrix; saved entries of modified rows */
    const double *diagonal, *p;
    double *rhs, *shift, *kept_rhs, *kept_shift;
    double *least, *margin; /* [Pa]; NaN without a bound */
    double *fixed;          /* [columns] on many ranks: the pressure of an active row, else NaN */
    int64_t rows;
    uint8_t *bounded, *active, *next; /* 1: has a bound; is active; will be active */
    uint8_t *changed;                 /* 1: modified for an active row or column */
    const double *value, *density;    /* by particle */
    const uint8_t *active_before;     /* by particle */
    int32_t *condition;               /* by particle */
    double nearly, speed;
} mps__bound_rows;

/* Rows with a lower bound, and saved entries of the matrix. */
typedef struct mps__bounds {
    mps__context *context;
    int64_t count, capacity;
    struct mps__bound *list;
    /* [particles] 1: active in the last step; must stay valid during a solution */
    const uint8_t *active;
    int32_t solves; /* in the last call */
    bool any;       /* a row of any rank has a lower bound */
    bool still;     /* active rows are fixed at 0 */
    double *fixed;  /* [columns] pressure of an active row, else NaN */
    uint8_t *mark;  /* [n] 1: the row is active or has an active column */
    int64_t fixed_capacity, mark_capacity;
    int64_t changes, changes_capacity;
    struct mps__change *change;
    /* on a device, instead of the arrays above */
    mps__bound_rows rows;
    mps__device *device;
    int64_t unknowns;
} mps__bounds;

/* Tolerance of a lower bound, in rho U_g^2. */
#define MPS__BOUNDS_NEARLY 1e-3

/* Condition of a row from the solution on: its lower bound is active. */
enum { MPS__ROW_ACTIVE = 3 };

void mps__bounds_init(mps__bounds *b, mps__context *context);
void mps__bounds_free(mps__bounds *b);
/* Solve the assembled equation for e->p, with p_i >= value_i in rows of MPS_ROW_LEAST, starting
 * with the active set b->active; the condition of active rows becomes MPS__ROW_ACTIVE. Iterations and
 * times of `result` are summed over all solutions. The arrays of the view and the terms, and
 * b->active, are in the memory space of the equation. */
mps_status mps__bounds_solve(mps__bounds *b, mps__solvers *solvers, mps__ppe *e, const mps_view *s,
                             mps__ppe_terms *t, mps_ppe_result *result);
/* Solve the same matrix for another right side `rhs` [n]: a change of the pressures, which is 0 in
 * active rows and in rows of given pressure. A row with a law is linearised at e->p. p [columns]:
 * first guess and solution. After mps__bounds_solve(). */
mps_status mps__bounds_solve_change(mps__bounds *b, mps__solvers *solvers, mps__ppe *e, double *rhs,
                                    double *p, mps_ppe_result *result);

/* ---- lower bounds of an equation on a device (bounds_device.c) ---- */

mps_status mps__bounds_begin_device(mps__bounds *b, mps__ppe *e, const mps_view *s,
                                    const mps__ppe_terms *t);
/* Fix the active rows; restore the assembled equation. */
mps_status mps__bounds_fix_device(const mps__bounds *b, const mps__ppe *e);
void mps__bounds_restore_device(const mps__bounds *b, const mps__ppe *e);
/* Whether the present pressures, with active rows fixed or not, change the set: a number on the
 * device, > 0: yes. */
void mps__bounds_look_device(void *bounds, double *to);
/* Update the active set. @param seen  the result of mps__bounds_look_device() for these pressures;
 * NaN: compute it @return whether the set has changed */
bool mps__bounds_choose_device(mps__bounds *b, const mps__ppe *e, double seen);
/* Set the condition of active rows to MPS__ROW_ACTIVE. */
void mps__bounds_conditions_device(const mps__bounds *b, const mps__ppe *e);

#endif
