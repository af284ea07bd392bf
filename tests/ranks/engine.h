/* SPDX-License-Identifier: BSD-3-Clause */
/* An engine whose ranks are threads of one process, so that tests of many ranks run under sanitizers and without MPI. */
#ifndef RANKS_ENGINE_H
#define RANKS_ENGINE_H

#include <mps/ranks.h>

typedef struct engine_team engine_team;

/* A team of ranks. @param skew  0: cuts in halves; else cuts lie at random shares, other ones at each partition */
engine_team *engine_create(int32_t ranks, uint32_t skew);
void engine_destroy(engine_team *team);
/* The table for one rank of the team. */
mps_ranks_ops engine_ops(engine_team *team, int32_t rank);
/* Run body(argument, rank) on a thread for each rank, and wait for all. */
void engine_run(engine_team *team, void (*body)(void *argument, int32_t rank), void *argument);

#endif
