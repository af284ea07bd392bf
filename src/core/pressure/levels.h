/* SPDX-License-Identifier: BSD-3-Clause */
/* Components of the pressure equation without a level. */
#ifndef MPS_CORE_LEVELS_H
#define MPS_CORE_LEVELS_H

#include "ppe.h"

/* Find components whose pressure has no level, and make the right side solvable there: its mean is volume that cannot go
 * anywhere. `singular`: out, their number; where there is one, e->component has that of each row, -1: has a level. Sets e->level_free. */
mps_status mps__levels_find(mps__ppe *e, const int64_t *id, const mps_parallel *parallel,
                            int32_t *singular);

#endif
