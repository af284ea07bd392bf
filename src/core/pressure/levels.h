/* SPDX-License-Identifier: BSD-3-Clause */
/* Components of the pressure equation without a pressure datum. */
#ifndef MPS_CORE_LEVELS_H
#define MPS_CORE_LEVELS_H

#include "ppe.h"

/* Set e->lacking: whether a component of any rank has no datum. e->queue has the union-find of the
 * rows then. On a device the result is deferred: */
void mps__levels_look(mps__ppe *e);
/* it is a number on the device, above -INFINITY if there is such a component, until this call waits
 * for it. MPS_E_PLUGIN */
mps_status mps__levels_wait(mps__ppe *e);
/* Find the components without a datum, and make their right sides solvable: the mean is volume that
 * cannot go anywhere. On the host. `singular`: out, their number; if > 0, e->component has the
 * number of each row's component, -1: it has a datum. Sets e->level_free. */
mps_status mps__levels_find(mps__ppe *e, const int64_t *id, int32_t *singular);

#endif
