/* SPDX-License-Identifier: BSD-3-Clause */
/* Droplets (connected components of fluid): common to the searches on the host and on a device. */
#ifndef MPS_CORE_BODIES_H
#define MPS_CORE_BODIES_H

#include "runner.h"

/* Flags of a set: it is anchored or too large; it contains a particle where searches may begin; it
 * continues on another rank. */
enum { MPS__BODY_HELD = 1, MPS__BODY_SEEDED = 2, MPS__BODY_PARTED = 4 };

/* Solids may have no rows: a link through a solid would depend on where the search begins. */
MPS_ROW bool mps__body_has(const mps_view *v, const int32_t *role, int64_t i)
{
    return mps_is_fluid(v, i) && (role[i] == MPS_BODY_SEED || role[i] == MPS_BODY_MEMBER);
}

/* Number the sets that are not anchored, in the order of their labels; the others get -1. */
void mps__bodies_number(mps__sets *sets, int32_t most);
/* mps_stage_bodies() with arrays of a device. */
int mps__bodies_device(mps_stage *s, int32_t most, int32_t *role, int32_t *body);
/* mps_stage_bodies() on the host, for droplets that continue on other ranks. */
int mps__bodies_away(mps_stage *s, int32_t most, const int32_t *role, int32_t *body);

#endif
