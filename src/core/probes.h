/* SPDX-License-Identifier: BSD-3-Clause */
/* Layer 7: probes look at the world and change nothing. */
#ifndef MPS_CORE_PROBES_H
#define MPS_CORE_PROBES_H

#include "world.h"
#include <mps/probe.h>

typedef struct mps__probe {
    mps_probe config; /* part points to part_name */
    char part_name[MPS__PART_NAME];
} mps__probe;

typedef struct mps__probes {
    int64_t count, capacity;
    mps__probe *list;
} mps__probes;

void mps__probes_free(mps__context *c, mps__probes *p);
mps_status mps__probes_add(mps__world *w, mps__probes *p, const mps_probe *probe, int32_t *id);
int32_t mps__probe_values(const mps__world *w, const mps__probe *p);
mps_status mps__probe_measure(mps__world *w, const mps__probe *p, double *values);
mps_status mps__energy_measure(mps__world *w, mps_energy *e);

#endif
