/* SPDX-License-Identifier: BSD-3-Clause */
/* Shared by the models of surface tension. */
#ifndef MPS_PHASE_TENSION_H
#define MPS_PHASE_TENSION_H

#include "builtin.h"
#include <stdbool.h>

/* kappa [n] of fluid with another phase among its `pairs` [1/m]; others are left. False when memory is out.
 * `radius` is rs [dp], `threshold` the least |grad f| dp. */
bool mps__curvatures(mps_stage *s, const mps_stencil *pairs, double radius, double threshold, double *kappa);

/* sigma of two phases [N/m]; `other` where the pair has none of its own. */
double mps__pair_sigma(const mps_stage *s, int32_t a, int32_t b, double other);

/* Half the time in which the shortest capillary wave runs over a spacing, of the quickest pair of phases [s]. */
double mps__tension_dt(const mps_stage *s, double other);

#endif
