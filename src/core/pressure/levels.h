/* SPDX-License-Identifier: BSD-3-Clause */
/* Components of the pressure equation without a level. */
#ifndef MPS_CORE_LEVELS_H
#define MPS_CORE_LEVELS_H

#include "ppe.h"

/* Whether a component has no level, on any rank; sets e->lacking. e->queue has trees of the rows then. On a device nothing waits for it: */
void mps__levels_look(mps__ppe *e);
/* it is there as a number of the device, above -INFINITY where there is such a component, until this waits for it. MPS_E_PLUGIN */
mps_status mps__levels_wait(mps__ppe *e);
/* Find the components whose pressure has no level, and make the right side solvable there: its mean is volume that cannot go anywhere. On the
 * host. `singular`: out, their number; where there is one, e->component has that of each row, -1: has a level. Sets e->level_free. */
mps_status mps__levels_find(mps__ppe *e, const int64_t *id, int32_t *singular);

#endif
