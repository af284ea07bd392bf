/* SPDX-License-Identifier: BSD-3-Clause */
/* Operators that only the step uses. */
#ifndef MPS_CORE_OPERATORS_H
#define MPS_CORE_OPERATORS_H

#include "base.h"
#include <mps/operators.h>

/* Quantities of pairs that a step computes once, so that its models need neither roots nor
 * divisions. */
typedef struct mps__weighed {
    const int64_t *begin; /* [n+1] rows without gaps, of the lengths of the stencil's rows: */
    int32_t *col;
    double *w_r2;        /* W/|r|^2 */
    const uint8_t *idle; /* [n] particles that keep their number density if this is not 0 */
    double *n, *a;       /* [n] number densities, [n*dim] asymmetries */
} mps__weighed;

/* Array argument of an operator, with its name in the header. */
typedef struct mps__operand {
    const char *name;
    const void *data;
} mps__operand;

/* Checks of every operator: of the stencil, of which `s` becomes a copy, and of the arrays up to
 * one without a name. */
mps_status mps__op_begin(const char *call, const mps_stencil *given, mps_stencil *s,
                         const mps__operand *arrays);

/* Inverse of a symmetric matrix whose eigenvalues are raised to `least`: bounded if neighbours are
 * too few. */
void mps__inverse_bounded(int dim, const double *m, double least, double *inverse);

/* All arrays of `out` in one pass. */
void mps__op_weigh(const mps_stencil *s, const mps__weighed *out);

#endif
