/* SPDX-License-Identifier: BSD-3-Clause */
/* Prefix sums by loops over rows, for threads and devices. */
#ifndef MPS_CORE_SCAN_H
#define MPS_CORE_SCAN_H

#include "loop.h"

/* Numbers that a row adds serially. */
enum { MPS__SCAN_BLOCK = 128 };

/* Buffer size of a scan of n numbers: the numbers, then block sums, sums of blocks of blocks and so
 * on. */
int64_t mps__scan_size(int64_t n);
/* Inclusive scan: values[i] becomes values[0] + ... + values[i], i < n; the next mps__scan_size(n)
 * - n numbers are workspace. */
void mps__scan(const mps_parallel *p, int64_t *values, int64_t n);

#endif
