/* SPDX-License-Identifier: BSD-3-Clause */
/* Restoring the fields after a failed step. */
#ifndef MPS_CORE_UNDO_H
#define MPS_CORE_UNDO_H

#include "world.h"

/* Back up the fields that calls of the plan write; numbers of models are backed up when a verb
 * requests them. */
mps_status mps__undo_keep(mps__world *w);
/* Restore them; also positions from `before` if particles have moved, else NULL. MPS_E_PLUGIN:
 * backups on a device are lost with it. */
mps_status mps__undo_restore(mps__world *w, const double *before);

#endif
