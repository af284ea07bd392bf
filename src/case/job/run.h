/* SPDX-License-Identifier: BSD-3-Clause */
/* A job inside: what it was told, what it writes, what it has summed up. */
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
    /* what it is, behind a colon where and how: "Wall pressure: sensor at (0, 0.05) m" */
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

/* A figure from the rows of all steps. */
typedef struct trace_figure {
    mps_job *job;
    int column; /* of trace.csv */
    mps_trace of;
} trace_figure;

/* Known points. */
typedef struct job_reference {
    char *label, *unit, *column; /* column: NULL for all of the unit */
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

/* The box about the centres of some particles [m]; count 0: there are none. */
typedef struct job_box {
    int64_t count;
    double lo[3], hi[3];
} job_box;

/* Sums over the run, for summary.json and the page. Of one that goes on from a checkpoint: seconds are without what was before it. */
typedef struct job_totals {
    int64_t fluid, wall, dummy, steps, steps_here,
        lost;        /* steps_here: without those before the checkpoint */
    double t_before; /* time of the checkpoint; 0: none */
    double t, wall_s, cpu_s, step_s, output_s, max_speed, volume_error;
    double crossing_least, crossing_most; /* mps_step_info.crossing_time [s] */
    double ppe_iterations, ppe_solves, seconds[MPS_STAGE_COUNT];
    const char *status;
} job_totals;

struct mps_job {
    mps_job_config config; /* with copies of its texts and times */
    mps_sim *sim;          /* of mps_job_run() */
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
    double level;          /* still level as filled in [m]; 0: that of the highest particle */
    film_pose built;       /* of the tank, as the case is built */
    job_box walls, liquid; /* in the frame of the tank */
    int32_t phases;        /* the highest number among the fluid, plus one */
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
    int pictures;       /* taken so far */
    double *picture_at; /* [s]; NAN: before this program went on with the run */
    mps_picture_config picture;
    progress progress;
    job_totals totals;
    int64_t checkpoint;      /* number of the next checkpoint by simulated time */
    double checkpoint_t;     /* of the last; 0: none */
    double checkpoint_clock; /* wall clock at which one is due [s] */
    double fluid_at_start;   /* particles of fluid when a run that goes on began; NAN: not known */
    bool fitted;          /* the steps are fitted to the end: no checkpoint is written any more */
    double *start;        /* row of t = 0, until it is written after the first step */
    double *row;          /* scratch, as long as a row of probes.csv or trace.csv */
    double step_end;      /* wall clock when the last step's outputs were done */
    double lock_clock;    /* wall clock at which the lock was renewed */
    double summary_clock; /* wall clock of the last summary.json of an unfinished run; 0: none */
    int messages;         /* of the library, shown so far */
    bool output_failed;
    bool ran;
    volatile sig_atomic_t stop;
    /* the first failure: its exit code, 0: none; whether this rank shows it; its text */
    int32_t code;
    bool tells;
    char error[JOB_ERROR];
};

/* ---- job.c ---- */

/* Note the first failure. @return false */
bool mps__job_fail(mps_job *job, int32_t code, const char *format, ...);
/* The same for calls of the program, whose last failure counts. @return status */
mps_status mps__job_refuse(mps_job *job, mps_status status, const char *format, ...);
/* Say a text as it is. */
void mps__job_show(mps_job *job, int32_t kind, const char *text);
/* Say a message behind the name of the job. */
void mps__job_tell(mps_job *job, const char *format, ...);
/* Remember the first thing that went wrong besides stepping. @return false if it did */
bool mps__job_note(mps_job *job, mps_status status, const char *what);
/* A copy, or NULL; also of NULL. */
char *mps__job_copy(const char *text);

/* Load a library: from the folder of the program, from where it is installed beside that folder, or where the system has libraries. NULL: dlerror() */
void *mps__job_module(const char *name);
/* Whether a device has such a name. */
bool mps__job_device_known(const char *device);
/* Let the steps run on the device that was asked for. @return false: the job has failed */
bool mps__job_device(mps_job *job);
/* ---- ranks.c ---- */

bool mps__job_first(const mps_job *job); /* this is rank 0 */
int32_t mps__job_ranks(const mps_job *job);
/* Largest value of all ranks. All ranks make this call. */
int32_t mps__job_most(mps_job *job, int32_t value);
/* A value that rank 0 decides. Values are not negative. */
int32_t mps__job_told(mps_job *job, int32_t value);
/* All ranks make this call. @return false: one of them has failed, and all have its code */
bool mps__job_agree(mps_job *job);
/* Particles of all ranks at rank 0, until mps__job_gather_end(), which is allowed after a failure as well. */
bool mps__job_gather(const mps_job *job);
void mps__job_gather_end(const mps_job *job);

/* ---- columns.c ---- */

/* Columns of probes.csv behind the time, and column k of them: those that were added, then the common ones. */
int mps__job_columns(const mps_job *job);
job_column mps__job_column(const mps_job *job, int k);
/* One of the common columns, or the time, has this name. */
bool mps__job_is_common(const char *name);
/* Measure the boxes of walls and liquid, and the pose of the tank, before the first step or a checkpoint. */
void mps__job_boxes(mps_job *job);
/* Depth of the liquid at the start [m]; NAN if it does not stand on the floor. */
double mps__job_depth(const mps_job *job);

/* ---- rows.c ---- */

/* Values of the added columns now; NAN where one cannot be measured. All ranks make this call, rank 0 gets all values.
 * @param values  [columns] */
void mps__job_measure(mps_job *job, double *values);
/* Open all tables, or go on with them from the checkpoint. @return false: it failed */
bool mps__job_open_tables(mps_job *job);
/* Open a table, or continue with its rows. @return false: the job has failed */
bool mps__job_open_table(mps_job *job, table *t, const char *name, const char *header, int columns);
/* The state that the first step begins with. Its row is in the files where a run goes on: it is only what the next one is interpolated from. */
void mps__job_first_rows(mps_job *job);
/* A row at t. */
void mps__job_sample(mps_job *job, double t);
/* There is no pressure before the first step: the row of t = 0 waits for it and takes its pressures, or goes out without (NULL). */
void mps__job_write_start(mps_job *job, const double *first);

/* ---- trace.c ---- */

/* Open trace.csv or go on with it, if there is to be one. @return false: it failed */
bool mps__trace_open(mps_job *job);
/* A table_row_fn for trace.csv: keep a row in memory. */
void mps__trace_keep(void *job, const double *row);
/* Take a row of it. */
void mps__trace_step(mps_job *job, double t, double dt);

/* ---- resume.c ---- */

#define RESUME_ANEW "start anew with --overwrite, or in another folder with --out"

/* Go on from the checkpoint; without one the run begins again, and config.resume is 0. All ranks make this call.
 * @return false: it failed on this rank */
bool mps__resume_read(mps_job *job);
/* How a user continues the run, in the words of the program: of 'mps', or of a driver; a folder behind it, "" of a driver. */
const char *mps__resume_words(const mps_job *job);
const char *mps__resume_folder(const mps_job *job);
/* Begin anew: remove an earlier run, but for the file `keep`, or NULL. */
bool mps__resume_forget(mps_job *job, const char *keep);
/* Check what the tables have, and cut them at the checkpoint. */
bool mps__resume_tables(mps_job *job);
/* A table_row_fn for steps.csv: take a step into the totals. */
void mps__resume_add_step(void *job, const double *row);
/* Is a checkpoint due after this step? */
bool mps__resume_due(mps_job *job, const mps_step_info *info);
/* Write a checkpoint. All ranks make this call. */
void mps__resume_save(mps_job *job);

/* ---- colours.c ---- */

/* Title, gravity and colour scale of all pictures. All ranks make this call, before a checkpoint is read: the scale is that of the case as it
 * is built. */
void mps__colours_begin(mps_job *job);

/* ---- drawing.c ---- */

/* What rank 0 finds due after a step, and all ranks then do. */
enum { DUE_SAMPLE = 1, DUE_FRAME = 2, DUE_PICTURE = 4, DUE_CHECKPOINT = 8, DUE_PEAK = 16 };

/* Frames about peaks: which columns are looked at. All ranks make this call before the tables
 * are opened. */
void mps__peaks_begin(mps_job *job);
/* DUE_PEAK, after a sample. All ranks make this call. */
int mps__peaks_due(mps_job *job);
void mps__frames_begin(mps_job *job);
/* DUE_FRAME and DUE_PICTURE. */
int mps__drawing_due(const mps_job *job, double t);
/* Pictures up to t were taken by an earlier program. */
void mps__drawing_skip(mps_job *job, double t);
/* Frames and pictures of the particles of all ranks. */
void mps__drawing_do(mps_job *job, double t, int due);
/* The last state, also of a run that broke off: frame, picture, figures of particles. */
void mps__drawing_end(mps_job *job, mps_status status);

/* ---- finish.c, summary.c, page.c ---- */

/* The first table that could not be written, or NULL. */
const table *mps__job_failed_table(const mps_job *job);
/* All that comes after the last step. @param wall_s,cpu_s  times up to it [s] @return exit code */
int32_t mps__job_finish(mps_job *job, mps_status status, double wall_s, double cpu_s);
/* Largest memory of this process so far [bytes]; NAN: not known. */
double mps__job_peak_memory(void);
/* summary.json; before totals.status is set, that of a run that is unfinished. @return false: it could not be written, job->error says why */
bool mps__summary_save(mps_job *job);
/* report.html, if it is wanted. @return false: likewise */
bool mps__page_save(mps_job *job);
/* "solver/preconditioner" */
void mps__job_solver(const mps_job *job, char *text, size_t size);

#endif
