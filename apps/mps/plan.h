/* SPDX-License-Identifier: BSD-3-Clause */
/* Runs of a series, of which this process takes all or a part, by itself or by several processes. */
#ifndef MPS_APPS_PLAN_H
#define MPS_APPS_PLAN_H

#include "series.h"

/* The state of a run that has no exit code: no process has taken it, or another one has it. */
enum { PLAN_OPEN = -1 };

typedef struct plan {
    const choices *c;
    char place[SERIES_PATH];
    int64_t runs;
    /* Add the values of run `index` as sets; their texts are valid until the next call. @return false: there is a message */
    bool (*set)(void *user, int64_t index, choices *one);
    /* NULL, or what is checked after a run that is done. @return false: no other begins */
    bool (*fits)(void *user, int64_t index);
    void *user;
    int *code; /* [runs] out: exit codes, PLAN_OPEN; the caller frees it */
} plan;

/* Check all runs, then run those that are not done. @return exit code: the largest of the runs, 130 where a signal ended it, or that of a
 * plan that is refused; plan->code is NULL then */
int plan_run(plan *p);
/* Print what is not done, as text for people. */
void plan_say_open(const plan *p);

#endif
