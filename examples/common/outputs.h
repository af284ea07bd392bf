/* SPDX-License-Identifier: BSD-3-Clause */
/* What is written after the last step, and the columns it is made from. */
#ifndef MPS_EXAMPLES_OUTPUTS_H
#define MPS_EXAMPLES_OUTPUTS_H

#include "run.h"

/* Columns of steps.csv. */
enum {
    STEP_T,
    STEP_DT,
    STEP_CFL,
    STEP_ITERATIONS,
    STEP_RESIDUAL,
    STEP_DIVERGENCE,
    STEP_SPEED,
    STEP_LOST,
    STEP_CROSSING,
    STEP_SOLVES,
    STEP_COLUMNS
};
#define STEP_HEADER                                                          \
    "t[s],dt[s],cfl,ppe_iterations,ppe_residual,ppe_divergence,max_speed[m/" \
    "s],lost,crossing_time[s],ppe_solves"

/* Places of the common columns in probes.csv, behind the driver's own. */
enum {
    COLUMN_KE = 1,
    COLUMN_TANK,
    COLUMN_PE,
    COLUMN_WALL_WORK,
    COLUMN_WALL_WORK_PROBES,
    COLUMN_VISCOUS,
    COLUMN_PLUGINS,
    COLUMN_COLLISION,
    COLUMN_SHIFT,
    COLUMN_NUMERICAL,
    COLUMN_ADDED,
    COLUMN_VOLUME
};

/* Columns of momentum.csv behind the time, for each axis. */
enum {
    MOMENTUM_TOTAL,
    MOMENTUM_GRAVITY,
    MOMENTUM_FORCE,
    MOMENTUM_PLUGINS,
    MOMENTUM_REACTION,
    MOMENTUM_PRESSURE,
    MOMENTUM_WALLS,
    MOMENTUM_NUMERICAL,
    MOMENTUM_COLLISION,
    MOMENTUM_SHIFT,
    MOMENTUM_ADDED,
    MOMENTUM_COLUMNS
};

/* Remember the first thing that went wrong besides stepping. @return false if it did */
bool run_note(run *r, mps_status status, const char *what);
/* Values of the driver's own columns now; NAN where one cannot be measured. All ranks make this call, rank 0 gets all values.
 * @param values  [columns] */
void run_measure_columns(run *r, double *values);
/* Open all tables, or go on with them from the checkpoint; exits with a message if that cannot be. */
void run_open_tables(run *r);
/* The state that the first step begins with. Its row is in the files where a run goes on: it is only what the next one is interpolated from. */
void run_first_rows(run *r);
/* A row at t. */
void run_sample(run *r, double t);
/* There is no pressure before the first step: the row of t = 0 waits for it and takes its pressures, or goes out without (NULL). */
void run_write_start(run *r, const double *first);
/* Columns of probes.csv behind the time, and column k of them: those of the driver, then the common ones. */
int run_columns_all(const run *r);
run_column run_column_at(const run *r, int k);
/* What it is, without where and how. */
void run_column_title(const run_column *c, char *title, size_t size);
/* Measure the boxes of walls and liquid, before the first step. */
void run_boxes(run *r);
/* Depth of the liquid at the start [m]; NAN if it does not stand on the floor. */
double run_depth(const run *r);
/* summary.json. @return false with a message on stderr */
bool summary_save(const run *r);
/* plot_*.svg, and report.html unless it was not wanted. @return false with a message on stderr */
bool report_save(const run *r);

#endif
