/* SPDX-License-Identifier: BSD-3-Clause */
/* A job inside: its configuration, outputs and totals. */
#ifndef MPS_CASE_RUN_H
#define MPS_CASE_RUN_H

#include "folder.h"
#include "measure.h"
#include "peaks.h"
#include "picture_scene.h"
#include "progress.h"
#include "table.h"
#include "tables.h"
#include <mps/job.h>
#include <mps/picture.h>
#include <mps/mps.h>
#include <signal.h>
#include <stdbool.h>

enum { JOB_ERROR = 1024, JOB_NAME = 32, JOB_UNIT = 16, JOB_ABOUT = 240, JOB_PLUGINS = 16 };

/* One column of probes.csv: a probe's value minus `zero`, or a quantity. */
typedef struct job_column {
    char name[JOB_NAME], unit[JOB_UNIT];
    /* what it is, after a colon where and how: "Wall pressure: sensor at (0, 0.05) m" */
    char about[JOB_ABOUT];
    const char *type;       /* "wall_pressure", "pressure", "gauge", "force", "moment", "value" */
    double at[3], diameter; /* of a sensor or gauge, in the tank's frame [m] */
    /* the face that a sensor reads: its normal, and its part */
    double normal[3];
    char part[JOB_NAME];
    int32_t probe, component;
    double zero;
    int32_t flags; /* sum of MPS_JOB_... */
    mps_job_value_fn value;
    void *user;
} job_column;

/* A number for summary.json, measured after the last step. */
typedef struct job_figure {
    char name[JOB_NAME], about[JOB_ABOUT];
    int32_t flags;
    mps_job_value_fn value;
    void *user;
    double measured;
} job_figure;

/* A figure evaluated from the rows of all steps. */
typedef struct trace_figure {
    mps_job *job;
    int column; /* of trace.csv */
    mps_trace of;
} trace_figure;

/* Reference points. */
typedef struct job_reference {
    char *label, *unit, *column; /* column: NULL for all columns of the unit */
    int32_t line;
    int64_t count;
    double *t, *value;
} job_reference;

/* A line of the sketch. */
typedef struct job_outline {
    int32_t count;
    double *x; /* [2*count] */
} job_outline;

typedef struct job_input {
    char *key, *value;
} job_input;

/* Bounding box of the centres of some particles [m]; count 0: none. */
typedef struct job_box {
    int64_t count;
    double lo[3], hi[3];
} job_box;

/* Totals of the run, for summary.json and the page. For a continued run, seconds exclude the time
 * before the checkpoint. */
typedef struct job_totals {
    /* steps_of_run: excludes steps before the checkpoint */
    int64_t fluid, wall, dummy, steps, steps_of_run, lost;
    double t_before; /* time of the checkpoint; 0: none */
    double t, wall_s, cpu_s, step_s, output_s, max_speed;
    double volume_error, volume_largest;  /* of the last sample; largest magnitude in a row */
    double crossing_least, crossing_most; /* mps_step_info.crossing_time [s] */
    double ppe_iterations, ppe_solves, seconds[MPS_STAGE_COUNT];
    const char *status;
} job_totals;

struct mps_job {
    mps_job_config config; /* with its own copies of texts and times */
    mps_sim *sim;          /* simulation of mps_job_run() */
    int32_t dim;
    double dp;
    folder place;
    int columns, figures, references, inputs, outlines, traces, quantities;
    job_column *column;
    job_figure *figure;
    job_reference *reference;
    job_input *input;
    job_outline *outline;
    int32_t plugins;
    const mps_plugin_file *plugin[JOB_PLUGINS];
    int32_t edges;
    double *edge; /* [6*edges] */
    trace_figure **trace;
    quantity **quantity;   /* of measures */
    double level;          /* still level as filled [m]; 0: that of the highest particle */
    film_pose built;       /* pose of the tank as built */
    job_box walls, liquid; /* in the frame of the tank */
    int32_t phases;        /* highest phase number of the fluid, plus one */
    table probes, steps, momentum, trace_rows;
    double *
        all_rows; /* of trace.csv, [all_count][trace_rows.columns]; the first is the state before the first step, with dt = 0 */
    int64_t all_count;
    bool all_failed;
    mps_frames *frames;
    int64_t frame;           /* next frame */
    double frame_t;          /* of the last frame; -1: none yet */
    mps_frames *peak_frames; /* about the highest peaks; NULL: none */
    peaks peaks;
    int pictures;       /* written so far */
    double *picture_at; /* [s]; NAN: written by an earlier program */
    mps_picture_config picture;
    progress progress;
    job_totals totals;
    int64_t checkpoint;      /* number of the next checkpoint by simulated time */
    double checkpoint_t;     /* of the last; 0: none */
    double checkpoint_clock; /* wall clock of the next due checkpoint [s] */
    double fluid_at_start;   /* fluid particles at the start of a continued run; NAN: not known */
    bool fitted;             /* steps are fitted to the end: no more checkpoints */
    double *start;           /* row of t = 0, written after the first step */
    double *row;             /* workspace as long as a row of probes.csv or trace.csv */
    double step_end;         /* wall clock when the outputs of the last step were done */
    double lock_clock;       /* wall clock at which the lock was renewed */
    double summary_clock;    /* wall clock of the last summary.json of an unfinished run; 0: none */
    int messages;            /* of the library, shown so far */
    bool output_failed;
    bool ran;
    volatile sig_atomic_t stop;
    /* the first failure: its exit code, 0: none; whether this rank shows it; its text */
    int32_t code;
    bool prints;
    char error[JOB_ERROR];
};

/* ---- job.c ---- */

/* Record the first failure. @return false */
bool mps__job_fail(mps_job *job, int32_t code, const char *format, ...);
/* Record a failure of a call of the program; the last one counts. @return status */
mps_status mps__job_refuse(mps_job *job, mps_status status, const char *format, ...);
/* Log a text unchanged. */
void mps__job_show(mps_job *job, int32_t kind, const char *text);
/* Log a message with the name of the job as prefix. */
void mps__job_print(mps_job *job, const char *format, ...);
/* Record the first failure other than one of a step. @return false on failure */
bool mps__job_note(mps_job *job, mps_status status, const char *what);
/* A copy, or NULL; also of NULL. */
char *mps__job_copy(const char *text);

/* Load a library from the folder of the program, from its installed folder beside that one, or from
 * the search path of the system. NULL: dlerror() */
void *mps__job_module(const char *name);
/* Whether this is a valid name of a device. */
bool mps__job_device_known(const char *device);
/* Select the requested device for the steps. @return false: the job has failed */
bool mps__job_device(mps_job *job);
/* ---- ranks.c ---- */

bool mps__job_first(const mps_job *job); /* this is rank 0 */
int32_t mps__job_ranks(const mps_job *job);
/* Maximum over all ranks. Collective call. */
int32_t mps__job_most(mps_job *job, int32_t value);
/* Broadcast a value of rank 0. Values are not negative. */
int32_t mps__job_broadcast(mps_job *job, int32_t value);
/* Collective call. @return false: a rank has failed, and all ranks have its code */
bool mps__job_agree(mps_job *job);
/* Collect the particles of all ranks on rank 0, until mps__job_collect_end(), which is valid
 * after a failure too. */
bool mps__job_collect(const mps_job *job);
void mps__job_collect_end(const mps_job *job);

/* ---- added.c ---- */

/* Unit of a component of a probe. */
const char *mps__job_probe_unit(int32_t dim, const mps_probe *probe, int32_t component);

/* ---- columns.c ---- */

/* Number of columns of probes.csv after the time, and column k: added columns first, then the
 * common ones. */
int mps__job_columns(const mps_job *job);
job_column mps__job_column(const mps_job *job, int k);
/* Common column k, from 0; false: there are no more. */
bool mps__job_common(int k, int32_t dim, job_column *out);
/* Whether one of the common columns, or the time, has this name. */
bool mps__job_is_common(const char *name);
/* Measure the bounding boxes of walls and liquid, and the pose of the tank, before the first step
 * or a checkpoint. */
void mps__job_boxes(mps_job *job);
/* Depth of the liquid at the start [m]; NAN if it does not rest on the floor. */
double mps__job_depth(const mps_job *job);

/* ---- rows.c ---- */

/* Present values of the added columns; NAN where one cannot be measured. Collective call, rank 0
 * gets all values.
 * @param values  [columns] */
void mps__job_measure(mps_job *job, double *values);
/* Open all tables, or continue them from the checkpoint. @return false: failed */
bool mps__job_open_tables(mps_job *job);
/* Open a table, or continue with its rows. @return false: the job has failed */
bool mps__job_open_table(mps_job *job, table *t, const char *name, const char *header, int columns);
/* The state before the first step. In a resumed run its row is in the files already: it serves
 * only to interpolate the next row. */
void mps__job_first_rows(mps_job *job);
/* Record a row at t. */
void mps__job_sample(mps_job *job, double t);
/* There is no pressure before the first step: the row of t = 0 is kept and written with its
 * pressures, or without (NULL). */
void mps__job_write_start(mps_job *job, const double *first);

/* ---- trace.c ---- */

/* Open or continue trace.csv, if it is requested. @return false: failed */
bool mps__trace_open(mps_job *job);
/* A table_row_fn for trace.csv: keep a row in memory. */
void mps__trace_keep(void *job, const double *row);
/* Take a row of it. */
void mps__trace_step(mps_job *job, double t, double dt);

/* ---- resume.c ---- */

#define RESUME_ANEW "start anew with --overwrite, or in another folder with --out"

/* Continue from the checkpoint; without one the run starts again, and config.resume is 0.
 * Collective call.
 * @return false: it failed on this rank */
bool mps__resume_read(mps_job *job);
/* How a user continues the run: the command of 'mps' as a shell reads it, or the option of a
 * driver. */
void mps__resume_command(const mps_job *job, char *out, size_t size);
/* Remove an earlier run, except the file `keep`, or NULL. */
bool mps__resume_forget(mps_job *job, const char *keep);
/* Check the rows of the tables, and truncate them at the checkpoint. */
bool mps__resume_tables(mps_job *job);
/* A table_row_fn for steps.csv: add a step to the totals. */
void mps__resume_add_step(void *job, const double *row);
/* Whether a checkpoint is due after this step. */
bool mps__resume_due(mps_job *job, const mps_step_info *info);
/* Write a checkpoint. Collective call. */
void mps__resume_save(mps_job *job);

/* ---- colours.c ---- */

/* Set title, gravity and colour scale of all pictures. Collective call, before a checkpoint is
 * read: the scale is that of the case as built. */
void mps__colours_begin(mps_job *job);

/* ---- drawing.c ---- */

/* What rank 0 finds due after a step, and all ranks then do. */
enum { DUE_SAMPLE = 1, DUE_FRAME = 2, DUE_PICTURE = 4, DUE_CHECKPOINT = 8, DUE_PEAK = 16 };

/* Select the columns whose peaks get frames. Collective call before the tables are opened. */
void mps__peaks_begin(mps_job *job);
/* DUE_PEAK, after a sample. Collective call. */
int mps__peaks_due(mps_job *job);
void mps__frames_begin(mps_job *job);
/* DUE_FRAME and DUE_PICTURE. */
int mps__drawing_due(const mps_job *job, double t);
/* Skip pictures up to t, which an earlier program wrote. */
void mps__drawing_skip(mps_job *job, double t);
/* Write frames and pictures of the particles of all ranks. */
void mps__drawing_do(mps_job *job, double t, int due);
/* Write the final state, also of an aborted run: frame, picture, figures of particles. */
void mps__drawing_end(mps_job *job, mps_status status);

/* ---- finish.c, summary.c, page.c ---- */

/* The first table that could not be written, or NULL. */
const table *mps__job_failed_table(const mps_job *job);
/* All work after the last step. @param wall_s,cpu_s  times up to it [s] @return exit code */
int32_t mps__job_finish(mps_job *job, mps_status status, double wall_s, double cpu_s);
/* Largest memory of this process so far [bytes]; NAN: not known. */
double mps__job_peak_memory(void);
/* summary.json; before totals.status is set, that of an unfinished run. @return false: the file
 * could not be written, job->error has the reason */
bool mps__summary_save(mps_job *job);
/* Write report.html, if it is requested.
 * @return false: it could not be written, job->error is the reason */
bool mps__page_save(mps_job *job);
/* "solver/preconditioner" */
void mps__job_solver(const mps_job *job, char *text, size_t size);

#endif
