/* SPDX-License-Identifier: BSD-3-Clause */
/* The free-surface gauge. */
#ifndef MPS_CORE_PROBE_GAUGE_H
#define MPS_CORE_PROBE_GAUGE_H

#include "probes.h"

/* Distance from config->at along config->direction (unit length, tank frame) to the free
 * surface. */
mps_status mps__gauge_measure(mps__world *w, const mps_probe *config, double *value);

#endif
