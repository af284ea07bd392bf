/* SPDX-License-Identifier: BSD-3-Clause */
/* Data that a probe keeps between steps, for its moving average and its samples. */
#ifndef MPS_CORE_PROBE_SERIES_H
#define MPS_CORE_PROBE_SERIES_H

#include "world.h"
#include <mps/probe.h>

enum { MPS__PROBE_VALUES = 6 }; /* of any probe, at most */

typedef struct mps__series {
    int32_t size; /* values of the probe */
    /* signal: rows of time and values after each step, over the averaging interval */
    int64_t first, rows, row_capacity; /* rows first .. rows-1 are in use; capacity in numbers */
    double *row;
    int64_t step; /* steps done when the last row was taken; -1: none */
    bool waits;   /* the first row waits for the first step, before which there is no pressure */
    double start; /* its time */
    /* the samples */
    int64_t next; /* sample `next` is due at next / rate */
    int64_t count, t_capacity, value_capacity;
    int64_t cuts; /* how often samples were removed or replaced; otherwise they only grow */
    double *t, *value;
} mps__series;

/* What a series records. */
typedef struct mps__window {
    double average, reach; /* present and largest averaging interval [s] */
    double rate;           /* samples per second; 0: none */
} mps__window;

/* Time of values. */
typedef struct mps__instant {
    double t;
    int64_t step;
} mps__instant;

/* Add a row of the present state, and the samples due by now. On failure nothing changes. */
mps_status mps__series_take(mps__context *c, mps__series *s, const mps__window *window,
                            const mps__instant *now, const double *values);
/* Mean from `from` to `to`, both clipped to the stored interval; there must be a row. */
void mps__series_mean(const mps__series *s, double from, double to, double *out);
void mps__series_free(mps__context *c, mps__series *s);

#endif
