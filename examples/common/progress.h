/* SPDX-License-Identifier: BSD-3-Clause */
/* Progress on stderr: one line kept up to date on a terminal, else a line of key=value every 10 s for batch logs:
 * t [s], step, dt [s], wall [s] since the start, eta [s] until the end. */
#ifndef MPS_EXAMPLES_PROGRESS_H
#define MPS_EXAMPLES_PROGRESS_H

#include <mps/step.h>
#include <stdbool.h>

typedef struct progress {
    bool quiet, terminal, colour;
    bool line;           /* a line without its newline stands on the terminal */
    double start, shown; /* wall clock [s] */
    double t_begin, t_end;
    int64_t particles;
    int64_t steps_shown; /* steps at the last output, for the rate */
    double rate;         /* particles a second, smoothed */
} progress;

/* Wall clock, monotonic [s]. */
double progress_clock(void);
void progress_begin(progress *p, double t_end, int64_t particles, bool quiet);
/* The run goes on from here: what was computed before took no time. */
void progress_from(progress *p, double t, int64_t steps);
/* Show a step if it is time to, unless it is to be quiet. @return true if it was time (about ten times a second, or every 10 s) */
bool progress_step(progress *p, const mps_step_info *info);
/* Free the line for a message on stderr. */
void progress_clear(progress *p);

#endif
