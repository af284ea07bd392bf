/* SPDX-License-Identifier: BSD-3-Clause */
/* A device with separate memory on the host, which is protected except in its functions. Stale
 * values are NaN in both copies. */
#ifndef SHADOW_H
#define SHADOW_H

#include "sim.h"
#include <mps/device.h>

enum { SHADOW_BLOCKS = 512, SHADOW_LOOPS = 4096, SHADOW_CLOSED = 6, SHADOW_RANKS = 4 };

typedef struct shadow {
    mps_device_ops ops;
    int64_t blocks;                          /* that were not given back */
    int64_t uploads, downloads, invalidated; /* so many */
    int64_t bytes_up, bytes_down;            /* of all copies, with sums and maxima */
    int64_t launches;                        /* loops */
    int32_t ended;                           /* calls of a function of the test's */
    bool refuses;                            /* an allocation is refused, */
    int64_t allocations;                     /* after so many pieces of it */
    bool dead;                               /* all fails that may */
    const char *why;                         /* what failed last; other calls forget it */
    int64_t fails_at, loses_at;              /* launch, download that fails; 0: none */
    int64_t dies_at;                         /* launch from which on all does */
    char *arena, *arena_end;                 /* memory of all allocations; NULL: none */
    struct shadow_memory *heap;              /* of the handle; NULL: it is never closed */
    bool open;                               /* it is not closed: the loop before has run often */
    int32_t seen[SHADOW_LOOPS];              /* launches of each loop, by its name */
    struct {
        char *begin;
        size_t bytes;
    } block[SHADOW_BLOCKS];
} shadow;

/* A handle that was just made takes its arrays from memory that is closed while loops run on a
 * shadow. */
void shadow_heap(mps_sim *sim);
/* The same for a rank that is a thread of its own: one handle at a time. */
void shadow_heap_of(mps_sim *sim, int32_t rank);
/* Steps of a simulation run on the shadow from now on; it must outlive the simulation. */
void shadow_attach(shadow *s, mps_sim *sim);
/* Launches of a loop. */
int32_t shadow_seen(const shadow *s, const char *file, const char *name);
/* Print what a step did: launches, waits, bytes. */
mps_device_info shadow_counts(const mps_sim *sim);

#endif
