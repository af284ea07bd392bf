/* SPDX-License-Identifier: BSD-3-Clause */
/* Thin plates of a world and the particles near them. */
#ifndef MPS_CORE_PLATES_H
#define MPS_CORE_PLATES_H

#include "world.h"

/* Deactivate plates whose walls have been removed; to be called when particles are added or removed
 * otherwise than by a step. */
void mps__plates_set_active(mps__world *w);
/* Find the particles near a plate; once per search of neighbours. */
mps_status mps__plates_find(mps__world *w);
/* Update the start points of their lines of sight to the present positions. */
void mps__plates_look(mps__world *w);
/* Return fluid that has crossed a plate in this step to its side; the tank's pose is `end` now. */
void mps__plates_stop(mps__world *w, const mps__pose *end);
/* Whether particle i is hidden from a position in the tank's frame: by a plate between them, or
 * because it is a shadow. */
bool mps__plates_hide(const mps__world *w, const double *X, int64_t i);
/* Part of the plate that component d of the area of particle i belongs to, -1: none. Walls at the
 * foot of a plate contribute to it. */
int32_t mps__plates_part(const mps__world *w, int64_t i, int d);
/* 1/2 if particle i is one of two at the same position, the faces of a plate of a single layer,
 * else 1. */
double mps__plates_fraction(const mps__world *w, int64_t i);

#endif
