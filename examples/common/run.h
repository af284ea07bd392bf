/* SPDX-License-Identifier: BSD-3-Clause */
/* One run of a driver: simulation, probes, outputs. A driver opens it, builds its case in r.sim, names its columns, finishes. */
#ifndef MPS_EXAMPLES_RUN_H
#define MPS_EXAMPLES_RUN_H

#include "cli.h"
#include "progress.h"
#include "table.h"
#include <mps/mps.h>

enum {
    RUN_COLUMNS = 32,
    RUN_COMMON = 12,
    RUN_MARKS = 4,
    RUN_FIGURES = 32,
    RUN_MARK_POINTS = 16,
    RUN_ERROR = 640
};

/* A quantity of a driver's own. */
typedef double (*run_value_fn)(void *user, mps_sim *sim);

/* One column of probes.csv: a probe's value minus `zero`, or a driver's own quantity. */
typedef struct run_column {
    char name[32], unit[8];
    /* what it is, behind a colon where and how: "Wall pressure: sensor at (0, 0.05) m" */
    char about[240];
    const char *type;       /* "wall_pressure", "gauge", "force", or "value": a driver's own */
    double at[3], diameter; /* of a sensor or gauge, in the tank's frame [m] */
    /* the face that a sensor reads: its normal, and its part */
    double normal[3];
    char part[32];
    int32_t probe, component;
    double zero;
    bool pressure;  /* known after the first step */
    bool particles; /* `value` reads particles */
    run_value_fn value;
    void *user;
} run_column;

/* Known points, drawn as marks into the plot of all columns with the same unit. */
typedef struct run_mark {
    const char *label, *unit;
    int count;
    double t[RUN_MARK_POINTS], value[RUN_MARK_POINTS];
} run_mark;

/* A number of a driver's own for summary.json, measured after the last step. */
typedef struct run_figure {
    const char *name;
    char about[160]; /* what it is */
    bool particles;  /* `value` reads particles */
    run_value_fn value;
    void *user;
    double measured;
} run_figure;

/* The box about the centres of some particles [m]; count 0: there are none. */
typedef struct run_box {
    int64_t count;
    double lo[3], hi[3];
} run_box;

/* Sums over the run, for summary.json and the report. Of one that goes on from a checkpoint: seconds are without what was before it. */
typedef struct run_totals {
    int64_t fluid, wall, dummy, steps, steps_here, not_converged,
        lost;        /* steps_here: without those before the checkpoint */
    double t_before; /* time of the checkpoint; 0: none */
    double t, wall_s, cpu_s, step_s, output_s, max_speed, volume_error;
    double crossing_least, crossing_most; /* mps_step_info.crossing_time [s] */
    double ppe_iterations, ppe_solves, seconds[MPS_STAGE_COUNT];
    const char *status;
    char error[RUN_ERROR];
} run_totals;

typedef struct run {
    cli_options options;
    mps_sim *sim;
    int columns, own_columns, marks, figures; /* own: those of the driver, before the common ones */
    run_column column[RUN_COLUMNS];
    run_mark mark[RUN_MARKS];
    run_figure figure[RUN_FIGURES];
    table probes, steps, momentum;
    run_box walls, liquid; /* as built; wall particles are on the inner faces; phase 0 */
    double level;          /* still level as filled in [m]; 0: that of the highest particle */
    struct trace *trace;   /* NULL, or every step of the driver's own columns: trace.h */
    mps_frames *frames;
    int64_t frame;                /* next frame */
    int pictures;                 /* taken so far */
    double picture_at[CLI_TIMES]; /* [s]; NAN: before this program went on with the run */
    progress progress;
    run_totals totals;
    int64_t checkpoint;  /* next checkpoint */
    double checkpoint_t; /* of the last; 0: none */
    double frame_t;      /* of the last frame; -1: none yet */
    /* row of t = 0, until it is written after the first step */
    double start[1 + RUN_COLUMNS + RUN_COMMON];
    double step_end; /* wall clock when the last step's outputs were done */
    int messages;    /* of the library, shown so far */
    bool output_failed;
} run;

/* Create the simulation and the folder of outputs as the options say; exits with a message if that fails. */
void run_open(run *r, const cli_options *o);
/* Exit with a message unless a call of the library succeeded; for building the case. */
void run_check(run *r, mps_status status, const char *what);
/* The model is one of several phases: what the liquid leaves of a tank is gas. */
bool run_has_gas(const run *r);
/* Define a phase: 0 is the liquid, 1 what is around it [kg/m3], [Pa s]. */
void run_phase(run *r, int32_t index, double density, double viscosity);
/* Still level above the lab's origin: `level`, or the height of the highest particle of phase 0, which is layers * dp [m]. */
double run_level(run *r);

/* Columns, in the order of the file. Places are in the tank's frame. */
void run_wall_pressure(run *r, const char *name, double x, double y, double z);
/* A sensor with a face of this diameter [m]; 0: a spacing. */
void run_wall_sensor(run *r, const char *name, double x, double y, double z, double diameter);
void run_gauge(run *r, const char *name, double x, double z, double level);
/* A gauge that begins above the floor, e.g. on a baffle. @param foot [3] [m] */
void run_gauge_from(run *r, const char *name, const double *foot, double level);
/* A component of the pressure force on a part, or on all solids for NULL. */
void run_force(run *r, const char *name, const char *part, int32_t component);
/* A value of the driver. All ranks ask for it: it may call mps_probe_read() and the like. If it leases particles, these are the rank's own and
 * its ghosts, and ranks_largest() must combine what the ranks find: ghosts change no maximum, but a sum.
 * @param about  what it is, title of its plot; behind a colon where and how */
void run_value(run *r, const char *name, const char *unit, const char *about, run_value_fn value,
               void *user);
/* A value that leases the particles. Rank 0 alone asks for it and has those of all ranks; no call that all ranks make is allowed. */
void run_particle_value(run *r, const char *name, const char *unit, const char *about,
                        run_value_fn value, void *user);
/* A number for summary.json, likewise. @param about  what it is */
void run_figure_add(run *r, const char *name, const char *about, run_value_fn value, void *user);
void run_particle_figure(run *r, const char *name, const char *about, run_value_fn value,
                         void *user);
void run_mark_add(run *r, const char *label, const char *unit, int count, const double *t,
                  const double *value);

/* Step to the end with all outputs, destroy the simulation. @return exit code of the program */
int run_finish(run *r);

#endif
