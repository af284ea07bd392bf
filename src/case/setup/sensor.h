/* SPDX-License-Identifier: BSD-3-Clause */
/* Converts one sensor of a case to columns. */
#ifndef MPS_CASE_SENSOR_H
#define MPS_CASE_SENSOR_H

#include "build.h"

typedef struct sensing {
    build *b;
    const tree_node *map; /* its key is the name of the sensor */
    bool between;         /* an inner cell of many: it is not listed */
} sensing;

void mps__sensor_log(const sensing *s, const char *key, const char *text);
/* Add a probe and its column; without a job the probe alone. @return false: there is a message */
bool mps__sensor_add(const sensing *s, mps_probe *probe, int32_t component, double zero,
                     const char *name);
/* Add a quantity of this module, known after the first step. */
bool mps__sensor_value(const sensing *s, const char *name, const char *unit, const char *about,
                       mps_job_value_fn value, void *user);
/* Id of the probe of this name; -1: none. */
int32_t mps__sensor_id(build *b, const char *name);
void mps__sensor_box(const build *b, const char *measure, bool given, double (*box)[3],
                     double *out);

/* Sensors with several probes. */
void mps__sensor_panel(const sensing *s);
void mps__sensor_row(const sensing *s);
void mps__sensor_force(const sensing *s);

#endif
