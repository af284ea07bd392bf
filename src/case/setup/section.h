/* SPDX-License-Identifier: BSD-3-Clause */
/* Natural periods of liquid in a section of any outline. */
#ifndef MPS_CASE_SECTION_H
#define MPS_CASE_SECTION_H

#include "form.h"
#include <mps/status.h>

/* Eigenvalues w^2/g of the waves in a 2-D section filled to a level, in ascending order: potential
 * flow, no flow through walls, and d phi/dy = w^2/g phi on the surface. The first three are within
 * 0.25 % of exact values, the first within 0.1 %.
 * @param value  [count] out [1/m]
 * @return MPS_E_NOMEM; MPS_E_STATE: the section has several basins */
mps_status mps__section_modes(const form *section, double level, int32_t count, double *value);

#endif
