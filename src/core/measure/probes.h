/* SPDX-License-Identifier: BSD-3-Clause */
/* Probes read the simulation and change nothing. */
#ifndef MPS_CORE_PROBES_H
#define MPS_CORE_PROBES_H

#include "probe_sensor.h"
#include "probe_series.h"
#include "world.h"
#include <mps/probe.h>

typedef struct mps__probe {
    mps_probe config;                                     /* part points to part_name */
    char part_name[MPS__PART_NAME], name[MPS__PART_NAME]; /* "": none; config.name is NULL */
    mps__sensor sensor;                                   /* of a wall pressure */
    mps__series series;                                   /* of an average or a rate */
    bool removed;    /* its index stays in use: numbers are not reused */
    bool lag_logged; /* a warning that its force must not drive a rigid body */
} mps__probe;

typedef struct mps__probes {
    int64_t count, capacity;
    mps__probe *list;
} mps__probes;

void mps__probes_free(mps__context *c, mps__probes *p);
mps_status mps__probes_add(mps__world *w, mps__probes *p, const mps_probe *probe, int32_t *id);
void mps__probe_remove(mps__context *c, mps__probe *p);
/* Label in error texts: "3 'P1'", or "3" for a probe without a name. */
enum { MPS__PROBE_LABEL = MPS__PART_NAME + 32 };
const char *mps__probe_label(const mps__probes *p, int64_t id, char out[MPS__PROBE_LABEL]);
int32_t mps__probe_values(const mps__world *w, const mps__probe *p);
/* The present value. */
mps_status mps__probe_measure(mps__world *w, mps__probe *p, double *values);
/* The present value, or the mean of the last `average` seconds. */
mps_status mps__probe_read(mps__world *w, mps__probe *p, double *values);
/* Add the present value to the series, once per step; everything that may fail for a series happens
 * here. */
mps_status mps__probe_take(mps__world *w, mps__probe *p);
mps_status mps__probes_take(mps__world *w, mps__probes *p);
/* Unit vectors normal to a direction of unit length: along lattice axes if that is. */
void mps__probe_across(int32_t dim, const double direction[3], double out[2][3]);
mps_status mps__energy_measure(mps__world *w, mps_energy *e);
mps_status mps__momentum_measure(const mps__world *w, mps_momentum *m);

#endif
