/* SPDX-License-Identifier: BSD-3-Clause */
/* Operators that only the step uses. */
#ifndef MPS_CORE_OPERATORS_H
#define MPS_CORE_OPERATORS_H

#include "base.h"
#include <mps/operators.h>

/* What a step computes of its pairs once, so that its models need neither roots nor divisions. */
typedef struct mps__weighed {
    const int64_t *begin; /* [n+1] rows without gaps, as long as those of the stencil: */
    int32_t *col;
    double *w_r2;        /* W/|r|^2 */
    const uint8_t *idle; /* [n] number densities of rows where it is not 0 stay */
    double *n, *a;       /* [n] number densities, [n*dim] asymmetries */
} mps__weighed;

/* An array that an operator was given, with its name in the header. */
typedef struct mps__array {
    const char *name;
    const void *data;
} mps__array;

/* What every operator checks: the stencil, of which `s` becomes a copy, and the arrays up to one without a name. */
mps_status mps__op_begin(const char *call, const mps_stencil *given, mps_stencil *s,
                         const mps__array *arrays);

/* Inverse of a symmetric matrix whose eigenvalues are raised to `least`: bounded where neighbours are too few. */
void mps__inverse_bounded(int dim, const double *m, double least, double *inverse);

/* All of it in one pass. */
void mps__op_weigh(const mps_stencil *s, const mps__weighed *out);

#endif
