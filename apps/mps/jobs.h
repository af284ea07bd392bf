/* SPDX-License-Identifier: BSD-3-Clause */
/* Several processes for the runs of a plan. */
#ifndef MPS_APPS_JOBS_H
#define MPS_APPS_JOBS_H

#include "plan.h"

/* plan->fits refused a run. */
enum { PLAN_REFUSED = 1000 };

/* One run of a plan in this process. @param quiet  failures and one line when it is done @return exit code, PLAN_OPEN, PLAN_REFUSED */
int plan_take(const plan *p, int64_t index, bool quiet);
/* Check runs `first`, `first + step` .. @return number of runs that are refused, each with its messages */
int64_t plan_check(const plan *p, int64_t first, int64_t step);

/* The same by c->jobs processes. */
int64_t jobs_check(const plan *p, int64_t first, int64_t step);
/* All runs `first`, `first + step` .. by c->jobs processes; plan->code is filled in. @return MPS_EXIT_OK, MPS_EXIT_INTERRUPTED, PLAN_REFUSED */
int jobs_run(plan *p, int64_t first, int64_t step);
/* Processors of this machine. */
int32_t jobs_processors(void);

#endif
