/* SPDX-License-Identifier: BSD-3-Clause */
/* trace.csv: the driver's own columns after every step, with no interpolation, and figures measured from them. Impacts last a few steps:
 * rows at fixed times would miss them. */
#ifndef MPS_EXAMPLES_TRACE_H
#define MPS_EXAMPLES_TRACE_H

#include "run.h"

/* Columns. Momentum of the fluid and what the walls gave it have three columns each, in 2-D the third is 0; behind them the driver's own. */
enum {
    TRACE_T,
    TRACE_DT,
    TRACE_MOMENTUM,
    TRACE_WALLS = TRACE_MOMENTUM + 3,
    TRACE_OWN = TRACE_WALLS + 3
};

typedef struct trace {
    table file;
    int columns;
    int64_t count, room;
    /* [count*columns] all rows; the first is the state before the first step, with dt = 0 */
    double *row;
    bool failed; /* memory was out */
} trace;

/* What is measured. A value holds over its whole step, because a step's pressures act from its beginning to its end. */
typedef enum trace_kind {
    TRACE_GIVEN,    /* `scale` itself */
    TRACE_INTEGRAL, /* over time */
    TRACE_MEAN,
    TRACE_CHANGE,  /* of a state, linear between steps */
    TRACE_LARGEST, /* also of all centred means over `window`, if that is > 0 */
    TRACE_LEAST,
    TRACE_SLOPE /* of the straight line that fits best */
} trace_kind;

/* A measure between two times, over `scale`. */
typedef struct trace_measure {
    const trace *rows;
    trace_kind kind;
    int column;
    double from, to, window; /* [s] */
    double scale;
} trace_measure;

/* Trace this run; before run_finish(). */
void trace_add(run *r, trace *t);
/* A run_value_fn for run_figure_add(); user: a trace_measure. NAN if the run did not reach its `to`. */
double trace_figure(void *user, mps_sim *sim);

/* For stepping.c: open trace.csv or go on with it, @return false with a message on stderr; take a row; free the memory. */
bool trace_open(run *r);
void trace_step(run *r, double t, double dt);
void trace_free(trace *t);

#endif
