/* SPDX-License-Identifier: BSD-3-Clause */
/* Solution of the pressure equation with least pressures: p_i >= least_i where terms say so. */
#ifndef MPS_CORE_BOUNDS_H
#define MPS_CORE_BOUNDS_H

#include "ppe.h"

/* Of an equation on a device: what its rows see, and what each has of bounds. */
typedef struct mps__bound_rows {
    const int64_t *row;
    const int32_t *col, *particle;
    float *val, *kept; /* entries of the matrix; those before pinning, of rows that it changed */
    const double *diagonal, *p;
    double *rhs, *shift, *kept_rhs, *kept_shift;
    double *least, *margin; /* [Pa]; NaN without a least pressure */
    double *pinned;         /* [columns] on many ranks: the pressure of a pinned row, else NaN */
    int64_t rows;
    uint8_t *bounded, *held, *next; /* 1: it has one; is at it; will be */
    uint8_t *changed;               /* 1: by pinning */
    const double *value, *density;  /* of particles */
    const uint8_t *held_before;     /* likewise */
    int32_t *condition;             /* likewise */
    double nearly, speed;
} mps__bound_rows;

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
    /* on a device, in place of all these */
    mps__bound_rows rows;
    mps__device *device;
    int64_t unknowns;
} mps__bounds;

/* Pressures this near to their least, over rho U_g^2, are at it. */
#define MPS__BOUNDS_NEARLY 1e-3

/* For the condition of a row, from the solution on: a row with a least pressure is at it. */
enum { MPS__ROW_HELD = 3 };

void mps__bounds_init(mps__bounds *b, mps__context *context);
void mps__bounds_free(mps__bounds *b);
/* Solve the assembled equation for e->p, with p_i >= value_i in rows of MPS_ROW_LEAST, beginning with those of b->held; its condition becomes
 * MPS__ROW_HELD where they are at it now. Iterations and times of `result` are those of all solutions.
 * The arrays of the view and the terms, and b->held, are where the equation is. */
mps_status mps__bounds_solve(mps__bounds *b, mps__solvers *solvers, mps__ppe *e, const mps_view *s,
                             mps__ppe_terms *t, mps_ppe_result *result);
/* Solve the same matrix for another right side `rhs` [n]: the change of pressures by a change of it, which is 0 in held rows and in rows
 * whose pressure is given. A row with a law has its tangent at e->p. p [columns]: first guess and solution. After mps__bounds_solve(). */
mps_status mps__bounds_solve_change(mps__bounds *b, mps__solvers *solvers, mps__ppe *e, double *rhs,
                                    double *p, mps_ppe_result *result);

/* ---- an equation on a device that has rows with a least pressure (bounds_device.c) ---- */

mps_status mps__bounds_begin_there(mps__bounds *b, mps__ppe *e, const mps_view *s,
                                   const mps__ppe_terms *t);
/* Held rows are pinned; the equation as it was assembled. */
mps_status mps__bounds_pin_there(const mps__bounds *b, const mps__ppe *e);
void mps__bounds_free_there(const mps__bounds *b, const mps__ppe *e);
/* By the present pressures, whether rows are pinned or not: whether the set will change, a number of the device, > 0: it will. */
void mps__bounds_look_there(void *bounds, double *to);
/* Change it. @param seen  what the look at these pressures has found; NaN: look now @return whether the set has changed */
bool mps__bounds_choose_there(mps__bounds *b, const mps__ppe *e, double seen);
/* Conditions of held rows become MPS__ROW_HELD. */
void mps__bounds_tell_there(const mps__bounds *b, const mps__ppe *e);

#endif
