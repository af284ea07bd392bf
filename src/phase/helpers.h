/* SPDX-License-Identifier: BSD-3-Clause */
/* Helpers of the models of the fluid. */
#ifndef MPS_PHASE_HELPERS_H
#define MPS_PHASE_HELPERS_H

#include <mps/model.h>
#include <stdbool.h>

/* Smallest and largest density of the fluid particles [kg/m3]; INFINITY, 0 without fluid. */
void mps__density_range(const mps_stage *s, double range[2]);

#endif
