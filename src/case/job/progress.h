/* SPDX-License-Identifier: BSD-3-Clause */
/* Progress lines: a line that is updated on a terminal, else a line of key=value every 10 s for
 * batch logs: t [s], step, dt [s], wall [s] since the start, eta [s] until the end. */
#ifndef MPS_CASE_PROGRESS_H
#define MPS_CASE_PROGRESS_H

#include <mps/step.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct progress {
    bool terminal, colour;
    bool line;           /* the terminal shows a line without its newline */
    double start, shown; /* wall clock [s] */
    double t_begin, t_end;
    int64_t particles;
    int64_t steps_shown; /* steps at the last output, for the rate */
    double rate;         /* particles per second, smoothed */
} progress;

/* Wall clock, monotonic [s]. */
double mps__progress_clock(void);
/* @param terminal  stderr may be a terminal that shows progress */
void mps__progress_begin(progress *p, double t_end, int64_t particles, bool terminal);
/* The run continues from here: earlier steps are excluded from the rate. */
void mps__progress_from(progress *p, double t, int64_t steps);
/* @param text  [size] out: the line to show
 * @return true if it is due (about ten times a second, or every 10 s) */
bool mps__progress_step(progress *p, const mps_step_info *info, char *text, size_t size);
/* Control text that clears the progress line before a message, "" if there is none. */
const char *mps__progress_clear(progress *p);

#endif
