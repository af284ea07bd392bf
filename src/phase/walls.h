/* SPDX-License-Identifier: BSD-3-Clause */
/* Walls stop particles: shared by the models that change velocities or positions near walls. */
#ifndef MPS_PHASE_WALLS_H
#define MPS_PHASE_WALLS_H

#include "helpers.h"

/* Removes from v [dim] the part that carries fluid particle i into walls nearer than `reach` [m].
 * v is a velocity and u [n*dim] holds the velocities of the walls; or v is a displacement and u is
 * NULL. A particle nearer than reach/2 to a face, or behind its plane (it came over a rim), is
 * moved out by up to `lift` a call. */
void mps__walls_keep_off(const mps_view *view, double reach, double lift, const double *u,
                         int64_t i, double v[3]);

#endif
