/* SPDX-License-Identifier: BSD-3-Clause */
/* Shared by the models that move fluid near walls. */
#ifndef MPS_PHASE_WALLS_H
#define MPS_PHASE_WALLS_H

#include "builtin.h"

/* Take from v [dim] what carries fluid particle i into walls whose faces are nearer than `reach` [m]. v is a velocity among walls of
 * velocities u [n][dim], or a displacement where u is NULL. What is nearer than reach/2, or in the plane of the wall (it came over a rim),
 * is moved out by up to `lift` at a time. */
void mps__walls_keep_off(const mps_stage *s, double reach, double lift, const double *u, int64_t i, double v[3]);

#endif
