/* SPDX-License-Identifier: BSD-3-Clause */
/* Shared by the models that move fluid near walls. */
#ifndef MPS_PHASE_WALLS_H
#define MPS_PHASE_WALLS_H

#include "builtin.h"

/* Take from v [dim] what carries fluid particle i into walls whose faces are nearer than `reach` [m]. v is a velocity among walls of
 * velocities u [n][dim], or a displacement where u is NULL. */
void mps__walls_keep_off(const mps_stage *s, double reach, const double *u, int64_t i, double v[3]);

#endif
