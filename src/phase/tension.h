/* SPDX-License-Identifier: BSD-3-Clause */
/* Common functions of the models of surface tension. */
#ifndef MPS_PHASE_TENSION_H
#define MPS_PHASE_TENSION_H

#include "helpers.h"

/* Curvature of the interface at fluid with another phase among its pairs [1/m]. Returns non-zero
 * after a failure (no memory). which: MPS_NEAR or MPS_FAR, the pairs. radius: r_s [dp]. threshold:
 * smallest |grad f| dp of an interface.
 * kappa: [n] in: 0; out: of the rows at an interface. */
int mps__curvatures(mps_stage *s, int32_t which, double radius, double threshold, double *kappa);

/* sigma of two phases set by mps_tension_set() [N/m]; `other` if not set. */
double mps__pair_sigma(const mps_view *v, int32_t a, int32_t b, double other);

/* Lowers s->dt_limit to half the time in which the shortest capillary wave travels a spacing, for
 * the fastest pair of phases. */
void mps__tension_limit(mps_stage *s, double other);

#endif
