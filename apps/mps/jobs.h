/* SPDX-License-Identifier: BSD-3-Clause */
/* Several processes for the runs of a plan. */
#ifndef MPS_APPS_JOBS_H
#define MPS_APPS_JOBS_H

#include "plan.h"

/* plan->fits refused a run. */
enum { PLAN_REFUSED = 1000 };

/* Run one run of a plan in this process.
 * @param quiet  print failures and one line at its end
 * @return exit code, PLAN_OPEN, PLAN_REFUSED */
int plan_take(const plan *p, int64_t index, bool quiet);
/* Check runs `first`, `first + step` .. @return number of refused runs, each with its messages */
int64_t plan_check(const plan *p, int64_t first, int64_t step);

/* plan_check() by c->jobs processes. */
int64_t jobs_check(const plan *p, int64_t first, int64_t step);
/* Run all runs `first`, `first + step` .. by c->jobs processes; sets plan->code.
 * @return MPS_EXIT_OK, MPS_EXIT_INTERRUPTED, PLAN_REFUSED */
int jobs_run(plan *p, int64_t first, int64_t step);
/* Number of processors of this machine. */
int32_t jobs_processors(void);

#endif
