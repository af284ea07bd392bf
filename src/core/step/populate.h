/* SPDX-License-Identifier: BSD-3-Clause */
/* Fluid that models let in and out before a step. */
#ifndef MPS_CORE_POPULATE_H
#define MPS_CORE_POPULATE_H

#include "world.h"

/* Run the verbs of MPS_POPULATE, and do what they asked for. A step begins: nothing is aside. */
mps_status mps__world_populate(mps__world *w);
/* The step has failed: those who left are back, those who came are gone. */
void mps__world_depopulate(mps__world *w);

#endif
