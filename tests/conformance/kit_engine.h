/* SPDX-License-Identifier: BSD-3-Clause */
/* Engine of the conformance kits: its ranks are threads of one process, so that tests of many ranks
 * run under sanitizers and without MPI. If ranks make different calls, or one makes no more calls,
 * the run ends on all of them and its text names the calls. */
#ifndef KIT_ENGINE_H
#define KIT_ENGINE_H

#include <mps/ranks.h>

MPS_BEGIN_DECLS

typedef struct kit_engine_team kit_engine_team;

/* A team of ranks. @param skew  0: space is cut in halves; else at random fractions, new ones at
 * each partition */
kit_engine_team *kit_engine_create(int32_t ranks, uint32_t skew);
void kit_engine_destroy(kit_engine_team *team);
/* The table for one rank of the team. */
mps_ranks_ops kit_engine_ops(kit_engine_team *team, int32_t rank);
/* Run body(argument, rank) on a thread for each rank, and wait for all. */
void kit_engine_run(kit_engine_team *team, void (*body)(void *argument, int32_t rank),
                    void *argument);

MPS_END_DECLS

#endif
