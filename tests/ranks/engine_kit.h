/* SPDX-License-Identifier: BSD-3-Clause */
/* Conformance of an engine of ranks. All ranks call the same functions, each with its own table. `fault` [ENGINE_TEXT] gets the first
 * fault, and stays empty if there is none. */
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

/* Cuts, routes, exchanges, reductions, gathers.
 * @param balance  most that a rank may own over the mean; 0: any share */
void engine_kit_check(const mps_ranks_ops *ops, double balance, char *fault);

/* The last rank fails while others wait, or rank `also` and the last one fail at the same time; -1: none.
 * @param said  [ENGINE_TEXT] out: text of the failure, to be compared between ranks */
void engine_kit_fail(const mps_ranks_ops *ops, int call, int32_t also, char *said, char *fault);

#endif
