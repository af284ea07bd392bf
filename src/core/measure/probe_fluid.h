/* SPDX-License-Identifier: BSD-3-Clause */
/* Pressure in the fluid. */
#ifndef MPS_CORE_PROBE_FLUID_H
#define MPS_CORE_PROBE_FLUID_H

#include "world.h"
#include <mps/probe.h>

/* Pressure at config->at (tank frame); 0 outside the fluid. */
mps_status mps__fluid_measure(const mps__world *w, const mps_probe *config, double *value);

#endif
