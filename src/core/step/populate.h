/* SPDX-License-Identifier: BSD-3-Clause */
/* Fluid that models add and remove before a step. */
#ifndef MPS_CORE_POPULATE_H
#define MPS_CORE_POPULATE_H

#include "world.h"

/* Run the verbs of MPS_POPULATE, and apply their requests. At the begin of a step: no particle is
 * set aside. */
mps_status mps__world_populate(mps__world *w);
/* After a failed step: restore removed particles, and remove added ones. */
void mps__world_depopulate(mps__world *w);

#endif
