/* SPDX-License-Identifier: BSD-3-Clause */
/* What a failed step brings back. */
#ifndef MPS_CORE_UNDO_H
#define MPS_CORE_UNDO_H

#include "world.h"

/* Keep the fields that calls of the plan write; numbers of models are kept when a verb asks for them. */
mps_status mps__undo_keep(mps__world *w);
/* Bring them back; positions too if particles have moved, from `before`; else NULL. MPS_E_PLUGIN: what a device kept is lost with it. */
mps_status mps__undo_restore(mps__world *w, const double *before);

#endif
