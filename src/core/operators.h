/* SPDX-License-Identifier: BSD-3-Clause */
/* Layer 3: operators that only the step uses. */
#ifndef MPS_CORE_OPERATORS_H
#define MPS_CORE_OPERATORS_H

#include <mps/operators.h>

/* W/|r|^2 of all pairs into w_r2 (beside s->col), number densities n [n] and asymmetries a [n*dim] in one pass: what a step
 * computes of its pairs once, so that its models need neither roots nor divisions. */
void mps__op_weigh(const mps_stencil *s, double *w_r2, double *n, double *a);

#endif
