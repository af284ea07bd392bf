/* SPDX-License-Identifier: BSD-3-Clause */
/* The particles of a world and its thin plates. */
#ifndef MPS_CORE_PLATES_H
#define MPS_CORE_PLATES_H

#include "world.h"

/* A plate whose walls are gone hides nothing; whenever particles come back or go otherwise than by a step. */
void mps__plates_set_active(mps__world *w);
/* Find the particles near a plate; once a search of neighbours, which keeps its lists for a while. */
mps_status mps__plates_find(mps__world *w);
/* Where those particles see from, at the present positions. */
void mps__plates_look(mps__world *w);
/* Put fluid that crossed a plate in this step back to its side; the tank is at `end` now. */
void mps__plates_stop(mps__world *w, const mps__pose *end);
/* True if a place of the tank's frame does not see particle i: a plate lies between them, or it is a shadow. */
bool mps__plates_hide(const mps__world *w, const double *X, int64_t i);
/* Part of the plate that component d of the area of particle i belongs to, -1: none. Walls a plate stands on carry a bit of it. */
int32_t mps__plates_part(const mps__world *w, int64_t i, int d);
/* One half if particle i is one of two at the same place, the faces of a plate of one column, else one. */
double mps__plates_share(const mps__world *w, int64_t i);

#endif
