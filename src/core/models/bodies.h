/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies of fluid: what the search on the host and the one at a device have in common. */
#ifndef MPS_CORE_BODIES_H
#define MPS_CORE_BODIES_H

#include "host.h"

/* Flags of a set: it is held; it has a row where searches may begin; it goes on at another rank. */
enum { MPS__BODY_HELD = 1, MPS__BODY_SEEDED = 2, MPS__BODY_PARTED = 4 };

/* Solids may have no rows: a link through one would depend on where the search begins. */
MPS_ROW bool mps__body_has(const mps_view *v, const int32_t *role, int64_t i)
{
    return mps_is_fluid(v, i) && (role[i] == MPS_BODY_SEED || role[i] == MPS_BODY_MEMBER);
}

/* Numbers of the sets that are free, by their labels; -1 for the others. */
void mps__bodies_number(mps__sets *sets, int32_t most);
/* mps_stage_bodies() with arrays of a device. */
int mps__bodies_there(mps_stage *s, int32_t most, int32_t *role, int32_t *body);
/* The same found on the host: for bodies that go on at other ranks. */
int mps__bodies_away(mps_stage *s, int32_t most, const int32_t *role, int32_t *body);

#endif
