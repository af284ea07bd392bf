/* SPDX-License-Identifier: BSD-3-Clause */
/* What a failed step brings back. */
#ifndef MPS_CORE_UNDO_H
#define MPS_CORE_UNDO_H

#include "world.h"

/* Keep velocities, pressures and the fields that verbs write. */
mps_status mps__undo_keep(mps__world *w);
/* Bring them back; positions too if particles `moved`, from work.x0. */
void mps__undo_restore(const mps__world *w, bool moved);

#endif
