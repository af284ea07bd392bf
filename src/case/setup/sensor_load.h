/* SPDX-License-Identifier: BSD-3-Clause */
/* Columns by degree of freedom of the ship: loads of the liquid, accelerations, poses. */
#ifndef MPS_CASE_SENSOR_LOAD_H
#define MPS_CASE_SENSOR_LOAD_H

#include "sensor.h"
#include "ship_motion.h"

/* Whether the tank can move in this degree of freedom, and along which one of the lab. In 2-D
 * without `forward` it is either surge or sway. */
bool mps__degree_moves(const build_motion *m, int32_t degree, int32_t *dof, double *sign);
/* Load and acceleration of each degree of freedom, "NAME_roll" and "NAME_a_roll".
 * @param centre [3] of moments
 * @param probe  -1: load by momentum; else of this probe, without accelerations
 * @return false: there is a message */
bool mps__load_columns(const sensing *s, const char *name, const double *centre, int32_t probe);
/* sensors.*.load */
void mps__sensor_load(const sensing *s);

#endif
