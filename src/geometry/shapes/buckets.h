/* SPDX-License-Identifier: BSD-3-Clause */
/* Points sorted into square cells, to find those near a place. Points are added one by one; what a search finds depends on
 * the order of adding and on nothing else. */
#ifndef MPS_CORE_BUCKETS_H
#define MPS_CORE_BUCKETS_H

#include "base.h"

typedef struct mps__buckets {
    mps__context *context;
    int32_t dim;
    double lo[3], over; /* corner of the first cell, 1/side */
    int64_t cells[3];
    int32_t *head,
        *next; /* 1 + the point added last to a cell, 1 + the one added before it; 0: none */
    double *x; /* [3*count], z = 0 in 2-D */
    int64_t count, capacity, x_capacity;
} mps__buckets;

/* Visit one point; `d` leads from the place to it. */
typedef void (*mps__buckets_fn)(void *user, int64_t point, const double d[3], double r2);

/* No points yet; cells of `side` over the box lo..hi [dim], outside of which points belong to the nearest cell. */
mps_status mps__buckets_init(mps__buckets *b, mps__context *context, int32_t dim, const double *lo,
                             const double *hi, double side);
void mps__buckets_free(mps__buckets *b);
/* Room for `count` points in all. */
mps_status mps__buckets_reserve(mps__buckets *b, int64_t count);
mps_status mps__buckets_add(mps__buckets *b, const double x[3]);
/* Call fn for every point nearer than `reach`, which may be longer than a side. */
void mps__buckets_visit(const mps__buckets *b, const double x[3], double reach, mps__buckets_fn fn,
                        void *user);
/* The nearest point nearer than `reach` (of two as near: the older), -1: none. `r` may be NULL. */
int64_t mps__buckets_nearest(const mps__buckets *b, const double x[3], double reach, double *r);

#endif
