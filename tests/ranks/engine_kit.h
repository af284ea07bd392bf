/* SPDX-License-Identifier: BSD-3-Clause */
/* Conformance of a communication engine. All ranks call the same functions, each with its own
 * table. `fault` [ENGINE_TEXT] out: the first fault; empty without a fault. */
#ifndef RANKS_ENGINE_KIT_H
#define RANKS_ENGINE_KIT_H

#include <mps/ranks.h>

enum { ENGINE_TEXT = 400 };

/* The call in which others wait when a rank fails. */
enum {
    ENGINE_REDUCE,
    ENGINE_GATHER,
    ENGINE_CONNECT,
    ENGINE_EXCHANGE,
    ENGINE_PARTITION,
    ENGINE_CALLS
};

/* Partitions, routes, halo exchanges, reductions, allgathers. @param balance  largest weight of a
 * rank over the mean; 0: no limit */
void engine_kit_check(const mps_ranks_ops *ops, double balance, char *fault);

/* The last rank fails while others wait, or rank `also` and the last one fail at the same time; -1:
 * none.
 * @param said  [ENGINE_TEXT] out: text of the failure, to be compared between ranks */
void engine_kit_fail(const mps_ranks_ops *ops, int call, int32_t also, char *said, char *fault);

#endif
