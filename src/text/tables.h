/* SPDX-License-Identifier: BSD-3-Clause */
/* The tables of a run: indices and names of their columns. */
#ifndef MPS_TEXT_TABLES_H
#define MPS_TEXT_TABLES_H

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

/* Indices of the common columns in probes.csv, after the added ones. */
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
    COLUMN_VOLUME,
    COLUMN_FRICTION,
    COLUMN_LAYERS,
    COLUMN_COMMON = COLUMN_LAYERS /* number of common columns */
};
/* Their names, which columns.c of the job describes. */
/* clang-format off */
#define COMMON_COLUMNS(X) \
    X(ke) X(x_tank) X(pe) X(wall_work_momentum) X(wall_work_probes) X(viscous) X(plugins) \
    X(collision) X(shift) X(numerical) X(added) X(volume_error) X(friction) X(layers)
/* clang-format on */

/* Largest change of the liquid's volume that is good, as a fraction. */
#define VOLUME_GOOD 0.02

/* Columns of momentum.csv after the time, per axis. */
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
    MOMENTUM_FRICTION,
    MOMENTUM_COLUMNS
};

#endif
