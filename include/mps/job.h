/* SPDX-License-Identifier: BSD-3-Clause */
/** @file job.h  A job: one run of a simulation with a folder of outputs. Functions of libmps_case,
 *  which is linked together with libmps.
 *
 *  A job steps a simulation that the program has built. It writes probes.csv, steps.csv,
 *  momentum.csv, summary.json, frames, pictures, plots, report.html and checkpoints into its
 *  folder, and continues from a checkpoint. It never ends the program. All its messages go through
 *  mps_job_config.print.
 *
 *  Order of calls: mps_job_config_init(), mps_job_create(), building of the simulation, columns
 *  and figures, mps_job_run(), mps_sim_destroy(), mps_job_destroy(). */
#ifndef MPS_JOB_H
#define MPS_JOB_H

#include <mps/plugin.h>
#include <mps/probe.h>
#include <mps/types.h>
#include <stddef.h>

MPS_BEGIN_DECLS

/** A job. One thread at a time may use it. */
typedef struct mps_job mps_job;

/** What mps_job_run() returns: exit codes of programs. */
enum {
    /** The run is complete. */
    MPS_EXIT_OK = 0,
    /** An output could not be written, or out of memory. */
    MPS_EXIT_FAILED = 1,
    /** The folder or an option is refused; no step was done. */
    MPS_EXIT_USAGE = 2,
    /** The run diverged or left the range of a model; its outputs are readable. */
    MPS_EXIT_DIVERGED = 3,
    /** A signal or mps_job_stop() stopped the run; it has a checkpoint. */
    MPS_EXIT_INTERRUPTED = 130
};

/** Kind of a text for mps_job_print_fn. */
enum {
    /** A message, one or more lines. */
    MPS_JOB_MESSAGE = 0,
    /** A line of progress. */
    MPS_JOB_PROGRESS = 1,
    /** A requested table, e.g. of mps_job_config.profile. */
    MPS_JOB_TABLE = 2
};

/** Receives all texts of a job. @param text  with newlines */
typedef void (*mps_job_print_fn)(void *user, int32_t kind, const char *text);

/** One run on many ranks: interface of a communication module for the program and its job. All
 *  ranks make the same calls. */
typedef struct mps_job_ranks {
    /** Set by mps_job_ranks_load(). */
    uint32_t struct_size;
    /** Number of this rank, from 0. */
    int32_t rank;
    /** Number of ranks. */
    int32_t count;
    /** First argument of the functions. */
    void *user;
    /** Attach a simulation to the ranks, before it is built. */
    mps_status (*attach)(void *user, mps_sim *sim);
    /** Maximum of each value over all ranks. @return 0: timeout, not all ranks called within this
     *  number of seconds; seconds 0: no timeout */
    int32_t (*largest)(void *user, int32_t count, int32_t *values, double seconds);
    /** Maximum of each double over all ranks, without a timeout. */
    void (*largest_numbers)(void *user, int32_t count, double *values);
    /** Finalise communication, before the program ends. */
    void (*end)(void *user);
    /** End all ranks immediately, because a rank does not respond. */
    void (*abort)(void *user, int32_t code);
} mps_job_ranks;

/** The only symbol of a communication module: initialise, and set all entries. Modules are built
 *  together with the programs of libmps. @param ranks  struct_size is set */
typedef mps_status (*mps_job_ranks_begin_fn)(mps_job_ranks *ranks);

/** Load the module mps_drivers_mpi.so and initialise MPI. Search path: the folder of the program,
 *  ../libexec/mps, and the library folders of the system. The module remains loaded until the
 *  program ends.
 *  @param ranks  out; finalise it with ranks->end()
 *  @param error  [error_size] out: reason of a failure; error_size >= 1
 *  @return MPS_E_ARG, MPS_E_IO: no module, MPS_E_VERSION: the module has another version */
MPS_API mps_status mps_job_ranks_load(mps_job_ranks *ranks, char *error, size_t error_size);

/** Notify the other ranks that this rank ends; call it instead of exit(). All ranks end with the
 *  same code.
 *  @param ranks  NULL: one process
 *  @param code   exit code of this rank
 *  @param speak  out: 1 on the rank that must print its message
 *  @return exit code; -1: another rank does not respond: print the message, then call
 *          ranks->abort() */
MPS_API int32_t mps_job_ranks_exit(const mps_job_ranks *ranks, int32_t code, int32_t *speak);

/** Configuration of a job. Initialise it with mps_job_config_init(), then change entries. Texts are
 *  copied. */
typedef struct mps_job_config {
    /** Set by mps_job_config_init(). */
    uint32_t struct_size;
    /** 1: continue from the checkpoint in the folder; an incomplete run without a checkpoint starts
     *  again. `text`, if set, must be equal to the case of the folder, except for run.until,
     *  run.threads, run.checkpoint, run.checkpoint_clock, title, impacts, collect, references and
     *  output (but output.rate, frame, trace and pieces must be equal). */
    int32_t resume;
    /** Name of the case in messages, in summary.json and on the page; required. */
    const char *name;
    /** Title, one line; NULL: the name. */
    const char *title;
    /** Command line of the program; NULL: none. */
    const char *command;
    /** The case file as run, for case.yaml and report.html; NULL: none. */
    const char *text;
    /** The preset of models and changes of it, for summary.json; NULL: none. */
    const char *model;
    /** Folder of all outputs; required. Parent folders are created too. */
    const char *folder;
    /** End of the run [s]; required. */
    double t_end;
    /** Interval of rows in probes.csv and momentum.csv [s]; default 1e-3. */
    double row_interval;
    /** Interval of checkpoints in simulated time [s], in addition to those of checkpoint_clock;
     *  default 0: none. */
    double checkpoint;
    /** Gravity [m/s2], for the colour scale of pictures (picture.h); default 9.81. */
    double gravity;
    /** mps_probe.average of all wall pressures and forces, for summary.json; default
     *  MPS_AVERAGE_AUTO. */
    double average;
    /** Number of frames after the first one; 0: none; default 50. */
    int32_t frames;
    /** Number of times at picture_t; default 0: pictures at quarters of the run. */
    int32_t picture_count;
    /** [picture_count] times of pictures, ascending, > 0 [s]. */
    const double *picture_t;
    /** 1: remove an earlier run from the folder. */
    int32_t overwrite;
    /** 1: each rank writes its own piece of each frame. */
    int32_t pieces;
    /** 1: frames are in the frame of the tank. */
    int32_t tank_frame;
    /** 1 (default): write report.html. */
    int32_t report;
    /** 1: print a table of all passes of the steps at the end. */
    int32_t profile;
    /** 1: no progress, only messages of failures. */
    int32_t quiet;
    /** 1: the first SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2 or SIGXCPU stops the run after its
     *  step; handlers are installed while mps_job_run() runs. A second SIGINT or SIGTERM ends the
     *  process immediately. Terminals and job schedulers may send the other signals repeatedly: the
     *  one that stopped the run is ignored from then on. Default 0. */
    int32_t signals;
    /** 1: write trace.csv, the added columns after every step. mps_job_trace_add() also sets it. */
    int32_t trace;
    /** 1: make film.mp4 of all frames with the program ffmpeg; a failure is a message. */
    int32_t film;
    /** Threads of the simulation, for summary.json; default 1. */
    int32_t threads;
    /** Limit of report.html [bytes], 500,000 or more; default 12e6. */
    int64_t page_bytes;
    /** NULL: one process. It must be valid until the job is destroyed. */
    const mps_job_ranks *ranks;
    /** NULL: messages and progress go to stderr, tables to stdout. */
    mps_job_print_fn print;
    /** First argument of `print`. */
    void *print_user;
    /** NULL, or buffer for the error text of mps_job_create(). */
    char *error;
    /** Size of `error` [bytes]. */
    size_t error_size;
    /** Requested spacing [m], >= 0, for summary.json and messages: the first tank changes
     *  mps_config.dp. Default 0: unknown. */
    double dp;
    /** Device of the time steps. NULL: the host; "cuda", "cuda:1": a GPU of NVIDIA, with
     *  libmps_cuda, which mps_job_run() loads. The outputs are the same. */
    const char *device;
    /** Number of highest peaks of each pressure with finer frames around them, in peaks.pvd and
     *  peaks/: at most 10, fewer for more than four pressures. 0: none. Default 10. */
    int32_t peaks;
    /** Kept 0. */
    int32_t reserved;
    /** Interval of checkpoints by the wall clock [s]; default 600; 0: none. It is extended so that
     *  checkpoints take at most 1 % of the time of the run. A checkpoint is also written when a
     *  signal or mps_job_stop() stops the run, and before the last steps, whose lengths are
     *  adjusted to t_end: a run that continues from it to a later t_end is bitwise equal to one run
     *  to that t_end. */
    double checkpoint_clock;
} mps_job_config;

/** Set every entry to its default. @param size  sizeof(mps_job_config) @return MPS_E_ARG: bad
 *  size */
MPS_API mps_status mps_job_config_init(mps_job_config *config, size_t size);

/** Create the folder and lock it against other processes until mps_job_destroy(). Its files are not
 *  changed yet. The lock is between processes: one process must not have two jobs in a folder.
 *  @param job  out: the job, or NULL on failure
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | an invalid value |
 *  | MPS_E_IO | the folder cannot be written |
 *  | MPS_E_STATE | the folder has an earlier run and neither resume nor overwrite is set |
 *  | MPS_E_BUSY | another process uses the folder |
 *  | MPS_E_RANKS | another rank failed |
 *  | MPS_E_NOMEM | no memory | */
MPS_API mps_status mps_job_create(const mps_job_config *config, mps_job **job);

/** Unlock the folder and free the job. NULL is allowed. */
MPS_API void mps_job_destroy(mps_job *job);

/** Reason of the failure of the last call on this job, one line; "": it succeeded. Valid until the
 *  next call. */
MPS_API const char *mps_job_error(const mps_job *job);

/** For mps_config.log, with the job as log_user: passes the first 20 warnings and messages of the
 *  library to mps_job_config.print. */
MPS_API void mps_job_log(void *job, int level, const char *text);

/** Output a message of the program like those of the job, with its name as prefix; only on rank 0,
 *  and not if the job is quiet. @param text  one line without newline */
MPS_API void mps_job_print(mps_job *job, const char *text);

/** Add a probe and a column of probes.csv with one of its values. Columns are in the order of these
 *  calls; each call adds its own probe.
 *  @param sim        the simulation of this job, with all solids; the same in all calls
 *  @param probe      wall pressure, fluid pressure, gauge or force; probe->name is not used
 *  @param component  of its values, from 0
 *  @param zero       subtracted from the value; gauge: still level minus y of its foot
 *  @param name       of the column: 1..31 letters, digits, '_', '-' or '.'; unique
 *  @param unit       NULL: the unit of the probe type
 *  @return MPS_E_ARG, MPS_E_NAME (another column has this name), MPS_E_NOMEM, and errors of
 *          mps_probe_add() */
MPS_API mps_status mps_job_probe_add(mps_job *job, mps_sim *sim, const mps_probe *probe,
                                     int32_t component, double zero, const char *name,
                                     const char *unit);

/** A quantity of the program. @return its current value; NAN: it cannot be measured */
typedef double (*mps_job_value_fn)(void *user, mps_sim *sim);

/** Flags of a quantity. */
enum {
    /** It leases particles. It is evaluated on rank 0 only, with the particles of all ranks; it
     *  must not make collective calls. Without this flag it is evaluated on all ranks. */
    MPS_JOB_PARTICLES = 1,
    /** It is known after the first step only: the row of t = 0 has the value of the first step. */
    MPS_JOB_PRESSURE = 2,
    /** It describes the motion of the tank: report.html shows it with the other motions. */
    MPS_JOB_MOTION = 4
};

/** Add a column with a quantity of the program.
 *  @param unit   "": none
 *  @param about  description, the title of its plot; after a colon: position and method
 *  @param flags  sum of MPS_JOB_...
 *  @return MPS_E_ARG, MPS_E_NAME (another column has this name), MPS_E_NOMEM */
MPS_API mps_status mps_job_value_add(mps_job *job, const char *name, const char *unit,
                                     const char *about, int32_t flags, mps_job_value_fn value,
                                     void *user);

/** A column that was added to a job, e.g. a sensor of a case. */
typedef struct mps_job_column {
    /** Set by mps_job_column_init(). */
    uint32_t struct_size;
    /** Sum of MPS_JOB_... */
    int32_t flags;
    /** Its name. `name`, `unit` and `about` are owned by the job and valid until a column is added
     *  or the job is destroyed. */
    const char *name;
    /** "": none. */
    const char *unit;
    /** Description; after a colon: position and method. */
    const char *about;
} mps_job_column;

/** Set struct_size and zero. @param size  sizeof(mps_job_column) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_job_column_init(mps_job_column *column, size_t size);

/** Properties of a column. @param index  from 0, in the order in which columns were added
 *  @param column  initialised by mps_job_column_init(); out
 *  @return MPS_E_ARG: no such column */
MPS_API mps_status mps_job_column_get(const mps_job *job, int32_t index, mps_job_column *column);

/** Measure a column at the current time, for programs that step the simulation themselves.
 *  @param sim    the simulation to which it was added
 *  @param value  out; NAN: it cannot be measured at this time
 *  @return MPS_E_ARG: no such column; MPS_E_STATE: a column with MPS_JOB_PARTICLES on many ranks;
 *          errors of mps_probe_read() */
MPS_API mps_status mps_job_column_read(mps_job *job, mps_sim *sim, int32_t index, double *value);

/** Add a figure, a number in summary.json that is measured after the last step.
 *  @return MPS_E_ARG, MPS_E_NAME (another figure has this name), MPS_E_NOMEM */
MPS_API mps_status mps_job_figure_add(mps_job *job, const char *name, const char *about,
                                      int32_t flags, mps_job_value_fn value, void *user);

/** A predefined quantity of the fluid or the tank, see mps_measure_info_get(). Initialise it with
 *  mps_measure_init(). A measure uses the entries that its help names. */
typedef struct mps_measure {
    /** Set by mps_measure_init(). */
    uint32_t struct_size;
    /** Phase that is measured; default 0. */
    int32_t phase;
    /** Axis that is measured, 0..2; default 0. */
    int32_t axis;
    /** 1: difference from the value at mps_job_measure_add(). */
    int32_t change;
    /** 1: a figure of summary.json, measured after the last step; 0: a column. */
    int32_t at_end;
    /** Name in the table, e.g. "front"; required. */
    const char *measure;
    /** Name of the column or figure; NULL: that of the measure. */
    const char *name;
    /** Description, as in mps_job_value_add(); NULL: the text of the table. */
    const char *about;
    /** Part of the solids; NULL: all. */
    const char *part;
    /** Lower and upper corner in the frame of the tank [m]; all 0: the box of the walls. */
    double box[6];
    /** Centre [m]. */
    double centre[3];
    /** Radius [m]. */
    double radius;
    /** Level above y = 0 [m]. */
    double level;
    /** Averaging width for the search of an interface [dp], 1..3; default 2. */
    double smoothing;
} mps_measure;

/** Set every entry to its default. @param size  sizeof(mps_measure) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_measure_init(mps_measure *measure, size_t size);

/** Add a column or a figure with a predefined quantity.
 *  @return MPS_E_NAME (no such measure, or another column has this name), MPS_E_ARG, MPS_E_NOMEM,
 *          MPS_E_STATE: it cannot be measured in this simulation */
MPS_API mps_status mps_job_measure_add(mps_job *job, mps_sim *sim, const mps_measure *measure);

/** An entry of the table of measures. */
typedef struct mps_measure_info {
    /** Set by mps_measure_info_init(). */
    uint32_t struct_size;
    /** 2: in 2-D only; 0: in 2-D and 3-D. */
    int32_t dim;
    /** Name, e.g. "front". */
    const char *name;
    /** Unit in 2-D; "": none. */
    const char *unit;
    /** Unit in 3-D. */
    const char *unit_3d;
    /** Description, and the entries of mps_measure that it uses. */
    const char *help;
} mps_measure_info;

/** Set struct_size and zero. @param size  sizeof(mps_measure_info) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_measure_info_init(mps_measure_info *info, size_t size);

/** Get an entry of the table of measures. @param index  from 0 @return MPS_E_ARG: no such entry */
MPS_API mps_status mps_measure_info_get(int32_t index, mps_measure_info *info);

/** Quantities from the rows of trace.csv. A value is constant over its step. */
enum {
    /** The value of `scale`. */
    MPS_TRACE_GIVEN = 0,
    /** Integral over time. */
    MPS_TRACE_INTEGRAL = 1,
    /** Mean over time. */
    MPS_TRACE_MEAN = 2,
    /** Change, linear between steps. */
    MPS_TRACE_CHANGE = 3,
    /** Maximum; with a window: maximum of the mean over it. */
    MPS_TRACE_LARGEST = 4,
    /** Minimum; with a window: minimum of the mean over it. */
    MPS_TRACE_LEAST = 5,
    /** Slope of the least-squares line. */
    MPS_TRACE_SLOPE = 6
};

/** A figure between two times, divided by `scale`. Initialise it with mps_trace_init(). */
typedef struct mps_trace {
    /** Set by mps_trace_init(). */
    uint32_t struct_size;
    /** MPS_TRACE_... */
    int32_t kind;
    /** Name of the figure; required. */
    const char *name;
    /** Description; NULL: made from the other entries. */
    const char *about;
    /** An added column, "momentum_x" .. "momentum_z" (of the fluid) or "walls_x" .. "walls_z"
     *  (momentum from the walls); not needed by MPS_TRACE_GIVEN. */
    const char *column;
    /** Begin [s]. */
    double from;
    /** End [s]. */
    double to;
    /** Averaging window of MPS_TRACE_LARGEST and MPS_TRACE_LEAST [s]; 0: none. */
    double window;
    /** Divisor; default 1. */
    double scale;
} mps_trace;

/** Set every entry to its default. @param size  sizeof(mps_trace) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_trace_init(mps_trace *trace, size_t size);

/** Add a figure from all steps; trace.csv is written. It is NAN if the run does not reach `to`, or
 *  if `to` is before `from`.
 *  @return MPS_E_ARG, MPS_E_NAME (no such column, another figure has this name), MPS_E_NOMEM */
MPS_API mps_status mps_job_trace_add(mps_job *job, const mps_trace *trace);

/** Reference points, drawn in the plots of a unit. Initialise it with mps_reference_init(). */
typedef struct mps_reference {
    /** Set by mps_reference_init(). */
    uint32_t struct_size;
    /** 0 (default): marks; 1: a line. */
    int32_t line;
    /** Label; required. */
    const char *label;
    /** Unit of the values; required. */
    const char *unit;
    /** The column of the reference; NULL: all columns of the unit. */
    const char *column;
    /** Number of points, >= 1. */
    int64_t count;
    /** [count] times, non-decreasing [s] */
    const double *t;
    /** [count] values */
    const double *value;
} mps_reference;

/** Set every entry to its default. @param size  sizeof(mps_reference) @return MPS_E_ARG: bad
 *  size */
MPS_API mps_status mps_reference_init(mps_reference *reference, size_t size);

/** Add reference points; they are copied. @return MPS_E_ARG, MPS_E_NOMEM */
MPS_API mps_status mps_job_reference_add(mps_job *job, const mps_reference *reference);

/** Set the still level y of the filled liquid [m], the figure "still_level". Default: the highest
 *  particle of phase 0. @return MPS_E_ARG, MPS_E_NAME: it is already set, MPS_E_NOMEM */
MPS_API mps_status mps_job_level_set(mps_job *job, double level);

/** Add an input of the case to "inputs" of summary.json and to report.html, e.g. "dp" and "4 mm".
 *  @return MPS_E_ARG, MPS_E_NOMEM */
MPS_API mps_status mps_job_input_add(mps_job *job, const char *key, const char *value);

/** Record a plug-in of the simulation in "plugins" of summary.json and in report.html: name,
 *  version, file, SHA-256 and registered items. At most 16.
 *  @param plugin  valid until the job is destroyed @return MPS_E_ARG */
MPS_API mps_status mps_job_plugin_add(mps_job *job, const mps_plugin_file *plugin);

/** Add a line of the sketch in report.html, e.g. the tank or a baffle, in the frame of the tank;
 *  2-D, or a section.
 *  @param count  number of points, >= 2; closed if the last is equal to the first
 *  @param x      [2*count] x and y of each point [m]; copied
 *  @return MPS_E_ARG, MPS_E_NOMEM */
MPS_API mps_status mps_job_outline_add(mps_job *job, int32_t count, const double *x);

/** Add edges of the tank, which pictures and the film of report.html draw in 3-D instead of its
 *  box.
 *  @param count  number of edges, >= 1
 *  @param ends   [6*count] both ends of each, frame of the tank [m]; copied
 *  @return MPS_E_ARG, MPS_E_NOMEM */
MPS_API mps_status mps_job_edges_add(mps_job *job, int32_t count, const double *ends);

/** Stop the run after the current step, like a signal. Async-signal-safe, callable from other
 *  threads. */
MPS_API void mps_job_stop(mps_job *job);

/** Run all steps with all outputs; once per job. @return MPS_EXIT_..., the same on all ranks */
MPS_API int32_t mps_job_run(mps_job *job, mps_sim *sim);

/** Text with the table of passes since mps_profile_reset().
 *  @param measured  mps_step_info.seconds of these steps, summed [s]
 *  @param text      out: free it with free()
 *  @return MPS_E_ARG, MPS_E_NOMEM */
MPS_API mps_status mps_job_profile_text(mps_sim *sim, double measured, char **text);

/** All presets, models with settings, channels, orders of verbs, solvers and kernels of libmps as
 *  Markdown. @param text  out: free it with free() @return MPS_E_ARG, MPS_E_NOMEM */
MPS_API mps_status mps_job_models_text(char **text);

MPS_END_DECLS

#endif
