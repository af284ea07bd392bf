/* SPDX-License-Identifier: BSD-3-Clause */
/* Sums of all numbers up to each place, by loops over rows: a device runs them as threads do. */
#ifndef MPS_CORE_SCAN_H
#define MPS_CORE_SCAN_H

#include "loop.h"

/* Numbers that a row adds up one after the other. */
enum { MPS__SCAN_BLOCK = 128 };

/* Room for a scan of n numbers: these, then sums of blocks, of blocks of blocks and so on. */
int64_t mps__scan_room(int64_t n);
/* values[i] becomes values[0] + ... + values[i], i < n; behind them there is mps__scan_room(n) - n of room, which is written. */
void mps__scan(const mps_parallel *p, int64_t *values, int64_t n);

#endif
