/* SPDX-License-Identifier: BSD-3-Clause */
/* Points sorted into square cells, to find those near a position. Points are added one by one;
 * results of a search depend only on the order of adding. */
#ifndef MPS_CORE_BUCKETS_H
#define MPS_CORE_BUCKETS_H

#include "base.h"

typedef struct mps__buckets {
    mps__context *context;
    int32_t dim;
    double lo[3], over; /* corner of the first cell, 1/side */
    int64_t cells[3];
    /* 1 + the last point added to a cell; 1 + the point added before it; 0: none */
    int32_t *head, *next;
    double *x; /* [3*count], z = 0 in 2-D */
    int64_t count, capacity, x_capacity;
} mps__buckets;

/* Visits one point; `d` is the vector from the position to it. */
typedef void (*mps__buckets_fn)(void *user, int64_t point, const double d[3], double r2);

/* Initialise without points: cells of `side` over the box lo..hi [dim]. Points outside belong to
 * the nearest cell. */
mps_status mps__buckets_init(mps__buckets *b, mps__context *context, int32_t dim, const double *lo,
                             const double *hi, double side);
void mps__buckets_free(mps__buckets *b);
/* Reserve capacity for `count` points in total. */
mps_status mps__buckets_reserve(mps__buckets *b, int64_t count);
mps_status mps__buckets_add(mps__buckets *b, const double x[3]);
/* Call fn for each point nearer than `reach`, which may be longer than a side. */
void mps__buckets_visit(const mps__buckets *b, const double x[3], double reach, mps__buckets_fn fn,
                        void *user);
/* The nearest point nearer than `reach` (of two at the same distance: the older), -1: none. `r` may
 * be NULL. */
int64_t mps__buckets_nearest(const mps__buckets *b, const double x[3], double reach, double *r);

#endif
