/* SPDX-License-Identifier: BSD-3-Clause */
/* Runs of a series, of which this process takes all or a part, alone or with several processes. */
#ifndef MPS_APPS_PLAN_H
#define MPS_APPS_PLAN_H

#include "series.h"

/* State of a run without an exit code: no process has taken it, or another one has. */
enum { PLAN_OPEN = -1 };

typedef struct plan {
    const choices *c;
    char place[SERIES_PATH];
    int64_t runs;
    /* Add the values of run `index` as sets; their texts are valid until the next call.
     * @return false: there is a message */
    bool (*set)(void *user, int64_t index, choices *one);
    /* NULL, or a check after a finished run. @return false: start no other run */
    bool (*fits)(void *user, int64_t index);
    void *user;
    int *code; /* [runs] out: exit codes, PLAN_OPEN; the caller frees it */
} plan;

/* Check all runs, then run the unfinished ones.
 * @return exit code: the largest of the runs, 130 if a signal ended it, or that of a refused plan;
 * plan->code is NULL then */
int plan_run(plan *p);
/* Print the unfinished runs as text for users. */
void plan_print_open(const plan *p);

#endif
