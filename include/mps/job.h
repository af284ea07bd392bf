/* SPDX-License-Identifier: BSD-3-Clause */
/** @file job.h  A job: one run of a simulation with a folder of outputs. Functions of libmps_case,
 *  which is linked beside libmps.
 *
 *  A job steps a simulation that the program has built. It writes probes.csv, steps.csv,
 *  momentum.csv, summary.json, frames, pictures, plots, report.html and checkpoints into its
 *  folder, and continues from a checkpoint. It never ends the program. It prints through
 *  mps_job_config.say alone.
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
    /** The run came to its end. */
    MPS_EXIT_OK = 0,
    /** An output could not be written, or memory was out. */
    MPS_EXIT_FAILED = 1,
    /** The folder or a choice is refused; no step was done. */
    MPS_EXIT_USAGE = 2,
    /** The run diverged or left the range of a model; its outputs are readable. */
    MPS_EXIT_DIVERGED = 3,
    /** A signal or mps_job_stop() stopped the run; it has a checkpoint. */
    MPS_EXIT_INTERRUPTED = 130
};

/** What a text for mps_job_say_fn is. */
enum {
    /** A message, one or more lines. */
    MPS_JOB_MESSAGE = 0,
    /** A line of progress. */
    MPS_JOB_PROGRESS = 1,
    /** A table that was asked for, e.g. of mps_job_config.profile. */
    MPS_JOB_TABLE = 2
};

/** Gets all texts of a job. @param text  with its newlines */
typedef void (*mps_job_say_fn)(void *user, int32_t kind, const char *text);

/** One run on many ranks: what a module of messages gives to the program and to its job. All ranks
 *  make the same calls. */
typedef struct mps_job_ranks {
    /** Set by mps_job_ranks_load(). */
    uint32_t struct_size;
    /** Number of this rank, from 0. */
    int32_t rank;
    /** Number of ranks. */
    int32_t count;
    /** First argument of the functions. */
    void *user;
    /** Let a simulation run on the ranks, before it is built. */
    mps_status (*attach)(void *user, mps_sim *sim);
    /** Largest of each value over all ranks. @return 0: not all ranks came within so many seconds;
     *  seconds 0: wait for ever */
    int32_t (*largest)(void *user, int32_t count, int32_t *values, double seconds);
    /** The same of numbers; it waits for ever. */
    void (*largest_numbers)(void *user, int32_t count, double *values);
    /** End the messages, before the program ends. */
    void (*end)(void *user);
    /** End all ranks at once, because one does not answer. */
    void (*abort)(void *user, int32_t code);
} mps_job_ranks;

/** The one symbol of a module of messages: begin, and fill in all entries. Modules are built with
 *  the programs of libmps. @param ranks  struct_size is set */
typedef mps_status (*mps_job_ranks_begin_fn)(mps_job_ranks *ranks);

/** Load the module mps_drivers_mpi.so and begin with MPI. It is looked for in the folder of the
 *  program, in libexec/mps beside that folder, and where the system has libraries. It stays until
 *  the program ends.
 *  @param ranks  out; end it with ranks->end()
 *  @param error  [error_size] out: why it failed; error_size >= 1
 *  @return MPS_E_ARG, MPS_E_IO: no module, MPS_E_VERSION: it is of another version */
MPS_API mps_status mps_job_ranks_load(mps_job_ranks *ranks, char *error, size_t error_size);

/** Tell the other ranks that this one ends, in place of exit(). All ranks end with the same code.
 *  @param ranks  NULL: one process
 *  @param code   exit code of this rank
 *  @param speak  out: 1 on the one rank that must show its message
 *  @return code to exit with; -1: another rank does not answer: show the message, then call
 *          ranks->abort() */
MPS_API int32_t mps_job_ranks_leave(const mps_job_ranks *ranks, int32_t code, int32_t *speak);

/** What a job is. Fill it with mps_job_config_init(), then change entries. Texts are copied. */
typedef struct mps_job_config {
    /** Set by mps_job_config_init(). */
    uint32_t struct_size;
    /** 1: continue from the checkpoint in the folder; a run without a checkpoint that did not reach
     *  its end begins again. Where `text` is set, it must be the case of the folder, but for its
     *  run.until, run.threads, run.checkpoint, run.checkpoint_clock, and for what is measured or
     *  written after the run: title, impacts, collect, references and output, of it not rate,
     *  frame, trace and pieces. */
    int32_t resume;
    /** Name of the case in messages, in summary.json and on the page; required. */
    const char *name;
    /** One line for people; NULL: the name. */
    const char *title;
    /** How the program was called; NULL: none. */
    const char *command;
    /** The case file as run, for case.yaml and the page; NULL: none. */
    const char *text;
    /** The preset of models and what was changed in it, for summary.json; NULL: none. */
    const char *model;
    /** Folder of all outputs; required. Folders above it are made too. */
    const char *folder;
    /** End of the run [s]; required. */
    double t_end;
    /** Interval of rows in probes.csv and momentum.csv [s]; default 1e-3. */
    double row_interval;
    /** Interval of checkpoints in simulated time [s], besides those of checkpoint_clock; default 0:
     *  none. */
    double checkpoint;
    /** Gravity [m/s2], for the colour scale of pictures (picture.h); default 9.81. */
    double gravity;
    /** mps_probe.average of all wall pressures and forces, for summary.json; default
     *  MPS_AVERAGE_AUTO. */
    double average;
    /** Frames besides the first; 0: none; default 50. */
    int32_t frames;
    /** Number of times at picture_t; default 0: pictures at quarters of the run. */
    int32_t picture_count;
    /** [picture_count] times of pictures, ascending, > 0 [s]. */
    const double *picture_t;
    /** 1: remove an earlier run from the folder. */
    int32_t overwrite;
    /** 1: each rank writes a piece of its own of each frame. */
    int32_t pieces;
    /** 1: frames are in the frame of the tank. */
    int32_t tank_frame;
    /** 1 (default): write report.html. */
    int32_t report;
    /** 1: a table of all passes of the steps at the end. */
    int32_t profile;
    /** 1: no progress, no messages but of failures. */
    int32_t quiet;
    /** 1: the first SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2 or SIGXCPU stops the run after its
     *  step; handlers are installed while mps_job_run() runs. A second SIGINT or SIGTERM ends the
     *  process at once. Terminals and queues send the others more than once: one that stopped the
     *  run is ignored from then on. Default 0. */
    int32_t signals;
    /** 1: write trace.csv, the added columns after every step. mps_job_trace_add() sets it too. */
    int32_t trace;
    /** 1: film.mp4 of all frames, by the program ffmpeg; if that fails, a message says why. */
    int32_t film;
    /** Threads of the simulation, for summary.json; default 1. */
    int32_t threads;
    /** Limit of report.html [bytes], 500,000 or more; default 12e6. */
    int64_t page_bytes;
    /** NULL: one process. It must live as long as the job. */
    const mps_job_ranks *ranks;
    /** NULL: messages and progress go to stderr, tables to stdout. */
    mps_job_say_fn say;
    /** First argument of say. */
    void *say_user;
    /** NULL, or where mps_job_create() writes why it failed. */
    char *error;
    /** Bytes at `error`. */
    size_t error_size;
    /** Spacing as asked for [m], >= 0, for summary.json and messages: the first tank changes
     *  mps_config.dp. Default 0: not told. */
    double dp;
    /** Device of the time steps. NULL: the host; "cuda", "cuda:1": a GPU of NVIDIA, by libmps_cuda,
     *  which mps_job_run() loads. The outputs are the same. */
    const char *device;
    /** Peaks of each pressure with finer frames about them, in peaks.pvd with peaks/: the highest
     *  ones, at most 10, fewer of more than four pressures. 0: none. Default 10. */
    int32_t peaks;
    /** Kept 0. */
    int32_t reserved;
    /** Interval of checkpoints by the wall clock [s]; default 600; 0: none. It is extended so that
     *  checkpoints take at most a hundredth of the time of the run. A checkpoint is also written
     *  when a signal or mps_job_stop() stops the run, and before the last steps, whose lengths are
     *  fitted to t_end: a run that goes on from it to a later t_end has the bytes of one run to
     *  that t_end. */
    double checkpoint_clock;
} mps_job_config;

/** Set every entry to its default. @param size  sizeof(mps_job_config) @return MPS_E_ARG: bad
 *  size */
MPS_API mps_status mps_job_config_init(mps_job_config *config, size_t size);

/** Make the folder and lock it against other programs until mps_job_destroy(). Nothing in it is
 *  changed yet. The lock holds between programs: one program must not have two jobs in a folder.
 *  @param job  out: the job, or NULL on failure
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | a value |
 *  | MPS_E_IO | the folder cannot be written |
 *  | MPS_E_STATE | the folder has an earlier run and neither resume nor overwrite is set |
 *  | MPS_E_BUSY | another program runs there |
 *  | MPS_E_RANKS | another rank failed |
 *  | MPS_E_NOMEM | no memory | */
MPS_API mps_status mps_job_create(const mps_job_config *config, mps_job **job);

/** Unlock the folder and free the job. NULL is allowed. */
MPS_API void mps_job_destroy(mps_job *job);

/** Why the last call on this job failed, one line; "": none did. Valid until the next call. */
MPS_API const char *mps_job_error(const mps_job *job);

/** For mps_config.log, with the job as log_user: says warnings and messages of the library, the
 *  first 20 of them. */
MPS_API void mps_job_log(void *job, int level, const char *text);

/** Say a message of the program as the job does, behind its name; not on a quiet job, and only on
 *  rank 0. @param text  one line without its newline */
MPS_API void mps_job_say(mps_job *job, const char *text);

/** Add a probe and a column of probes.csv with one of its values. Columns stand in the order of
 *  these calls; each adds a probe of its own.
 *  @param sim        the simulation of this job, with all solids; the same in all calls
 *  @param probe      wall pressure, fluid pressure, gauge or force; probe->name is not used
 *  @param component  of its values, from 0
 *  @param zero       subtracted from the value; of a gauge: still level less y of its foot
 *  @param name       of the column: 1..31 letters, digits, '_', '-' or '.'; of no other one
 *  @param unit       NULL: by type of the probe
 *  @return MPS_E_ARG, MPS_E_NAME (another column has this name), MPS_E_NOMEM, and those of
 *          mps_probe_add() */
MPS_API mps_status mps_job_probe_add(mps_job *job, mps_sim *sim, const mps_probe *probe,
                                     int32_t component, double zero, const char *name,
                                     const char *unit);

/** A quantity of the program. @return its value now; NAN: it cannot be measured */
typedef double (*mps_job_value_fn)(void *user, mps_sim *sim);

/** Flags of a quantity. */
enum {
    /** It leases particles. Rank 0 alone is asked and has those of all ranks; it must not make
     *  calls that all ranks make. Others are asked on all ranks. */
    MPS_JOB_PARTICLES = 1,
    /** It is known after the first step: the row of t = 0 has the value of that step. */
    MPS_JOB_PRESSURE = 2,
    /** It is how the tank moves: the page has it with the other motions. */
    MPS_JOB_MOTION = 4
};

/** Add a column with a quantity of the program.
 *  @param unit   "": none
 *  @param about  what it is, the title of its plot; behind a colon where and how
 *  @param flags  sum of MPS_JOB_...
 *  @return MPS_E_ARG, MPS_E_NAME (another column has this name), MPS_E_NOMEM */
MPS_API mps_status mps_job_value_add(mps_job *job, const char *name, const char *unit,
                                     const char *about, int32_t flags, mps_job_value_fn value,
                                     void *user);

/** A column that was added to a job: of a case, one of its sensors. */
typedef struct mps_job_column {
    /** Set by mps_job_column_init(). */
    uint32_t struct_size;
    /** Sum of MPS_JOB_... */
    int32_t flags;
    /** Its name; like `unit` and `about` it belongs to the job and is valid until a column is added
     *  or the job is destroyed. */
    const char *name;
    /** "": none. */
    const char *unit;
    /** What it is, behind a colon where and how. */
    const char *about;
} mps_job_column;

/** Set struct_size and zero. @param size  sizeof(mps_job_column) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_job_column_init(mps_job_column *column, size_t size);

/** Tell what a column is. @param index  from 0, in the order in which columns were added
 *  @param column  initialised by mps_job_column_init(); out
 *  @return MPS_E_ARG: no such column */
MPS_API mps_status mps_job_column_get(const mps_job *job, int32_t index, mps_job_column *column);

/** Measure a column now, for programs that step the simulation themselves.
 *  @param sim    the simulation to which it was added
 *  @param value  out; NAN: it cannot be measured now
 *  @return MPS_E_ARG: no such column; MPS_E_STATE: a column with MPS_JOB_PARTICLES on many ranks;
 *          those of mps_probe_read() */
MPS_API mps_status mps_job_column_read(mps_job *job, mps_sim *sim, int32_t index, double *value);

/** Add a number to summary.json, measured after the last step.
 *  @return MPS_E_ARG, MPS_E_NAME (another figure has this name), MPS_E_NOMEM */
MPS_API mps_status mps_job_figure_add(mps_job *job, const char *name, const char *about,
                                      int32_t flags, mps_job_value_fn value, void *user);

/** A known quantity of the fluid or the tank, see mps_measure_info_get(). Fill it with
 *  mps_measure_init(). A measure uses the entries that its help names. */
typedef struct mps_measure {
    /** Set by mps_measure_init(). */
    uint32_t struct_size;
    /** Phase that is measured; default 0. */
    int32_t phase;
    /** Axis that is measured, 0..2; default 0. */
    int32_t axis;
    /** 1: its difference from the value at mps_job_measure_add(). */
    int32_t change;
    /** 1: a figure of summary.json, measured after the last step; 0: a column. */
    int32_t at_end;
    /** Name in the table, e.g. "front"; required. */
    const char *measure;
    /** Name of the column or figure; NULL: that of the measure. */
    const char *name;
    /** What it is, as in mps_job_value_add(); NULL: the text of the table. */
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
    /** Width of the means by which an interface is found [dp], 1..3; default 2. */
    double smoothing;
} mps_measure;

/** Set every entry to its default. @param size  sizeof(mps_measure) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_measure_init(mps_measure *measure, size_t size);

/** Add a column or a figure with a known quantity.
 *  @return MPS_E_NAME (no such measure, or another column has this name), MPS_E_ARG, MPS_E_NOMEM,
 *          MPS_E_STATE: it cannot be measured in this simulation */
MPS_API mps_status mps_job_measure_add(mps_job *job, mps_sim *sim, const mps_measure *measure);

/** An entry of the table of measures. */
typedef struct mps_measure_info {
    /** Set by mps_measure_info_init(). */
    uint32_t struct_size;
    /** 2: in 2-D alone; 0: in 2-D and 3-D. */
    int32_t dim;
    /** Name, e.g. "front". */
    const char *name;
    /** Unit in 2-D; "": none. */
    const char *unit;
    /** Unit in 3-D. */
    const char *unit_3d;
    /** What it is, and which entries of mps_measure it uses. */
    const char *help;
} mps_measure_info;

/** Set struct_size and zero. @param size  sizeof(mps_measure_info) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_measure_info_init(mps_measure_info *info, size_t size);

/** Get an entry of the table of measures. @param index  from 0 @return MPS_E_ARG: no such entry */
MPS_API mps_status mps_measure_info_get(int32_t index, mps_measure_info *info);

/** What is measured from the rows of trace.csv. A value holds over its whole step. */
enum {
    /** `scale` itself. */
    MPS_TRACE_GIVEN = 0,
    /** Integral over time. */
    MPS_TRACE_INTEGRAL = 1,
    /** Mean over time. */
    MPS_TRACE_MEAN = 2,
    /** Change of a state, linear between steps. */
    MPS_TRACE_CHANGE = 3,
    /** Largest value; with a window: largest mean over it. */
    MPS_TRACE_LARGEST = 4,
    /** Least value; with a window: least mean over it. */
    MPS_TRACE_LEAST = 5,
    /** Slope of the straight line that fits best. */
    MPS_TRACE_SLOPE = 6
};

/** A figure measured between two times, over `scale`. Fill it with mps_trace_init(). */
typedef struct mps_trace {
    /** Set by mps_trace_init(). */
    uint32_t struct_size;
    /** MPS_TRACE_... */
    int32_t kind;
    /** Name of the figure; required. */
    const char *name;
    /** What it is; NULL: made from the other entries. */
    const char *about;
    /** A column that was added, "momentum_x" .. "momentum_z" (of the fluid) or "walls_x" ..
     *  "walls_z" (what the walls gave it); not needed by MPS_TRACE_GIVEN. */
    const char *column;
    /** Begin [s]. */
    double from;
    /** End [s]. */
    double to;
    /** Of means, for MPS_TRACE_LARGEST and MPS_TRACE_LEAST [s]; 0: none. */
    double window;
    /** Divisor; default 1. */
    double scale;
} mps_trace;

/** Set every entry to its default. @param size  sizeof(mps_trace) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_trace_init(mps_trace *trace, size_t size);

/** Add a figure that is measured from all steps; trace.csv is written. It is NAN where the run does
 *  not reach `to`, and where `to` is before `from`.
 *  @return MPS_E_ARG, MPS_E_NAME (no such column, another figure has this name), MPS_E_NOMEM */
MPS_API mps_status mps_job_trace_add(mps_job *job, const mps_trace *trace);

/** Known points to compare with, drawn in the plots of a unit. Fill it with
 *  mps_reference_init(). */
typedef struct mps_reference {
    /** Set by mps_reference_init(). */
    uint32_t struct_size;
    /** 0 (default): marks; 1: a line. */
    int32_t line;
    /** What they are; required. */
    const char *label;
    /** Unit of the values; required. */
    const char *unit;
    /** The one column that they belong to; NULL: all of the unit. */
    const char *column;
    /** Number of points, >= 1. */
    int64_t count;
    /** [count] times, not descending [s] */
    const double *t;
    /** [count] values */
    const double *value;
} mps_reference;

/** Set every entry to its default. @param size  sizeof(mps_reference) @return MPS_E_ARG: bad
 *  size */
MPS_API mps_status mps_reference_init(mps_reference *reference, size_t size);

/** Add known points; they are copied. @return MPS_E_ARG, MPS_E_NOMEM */
MPS_API mps_status mps_job_reference_add(mps_job *job, const mps_reference *reference);

/** Set the still level as filled, y [m]; the figure "still_level". Without it the highest particle
 *  of phase 0 is the level. @return MPS_E_ARG, MPS_E_NAME: it is set already, MPS_E_NOMEM */
MPS_API mps_status mps_job_level_set(mps_job *job, double level);

/** Add an input of the case to "inputs" of summary.json and to the page, e.g. "dp" and "4 mm".
 *  @return MPS_E_ARG, MPS_E_NOMEM */
MPS_API mps_status mps_job_input_add(mps_job *job, const char *key, const char *value);

/** Name a plug-in that the simulation has, for "plugins" of summary.json and for the page: its
 *  name, version, file, SHA-256 and what it registers. 16 at most.
 *  @param plugin  it lives as long as the job @return MPS_E_ARG */
MPS_API mps_status mps_job_plugin_add(mps_job *job, const mps_plugin_file *plugin);

/** Add a line of the sketch on the page, e.g. the tank or a baffle, in its frame; 2-D, or a cut.
 *  @param count  number of points, >= 2; closed where the last is the first
 *  @param x      [2*count] places along x and y [m]; copied
 *  @return MPS_E_ARG, MPS_E_NOMEM */
MPS_API mps_status mps_job_outline_add(mps_job *job, int32_t count, const double *x);

/** Add edges of the tank, which pictures and the film of the page draw in 3-D in place of its box.
 *  @param count  number of edges, >= 1
 *  @param ends   [6*count] both ends of each, frame of the tank [m]; copied
 *  @return MPS_E_ARG, MPS_E_NOMEM */
MPS_API mps_status mps_job_edges_add(mps_job *job, int32_t count, const double *ends);

/** Stop the run after its step, as a signal does. Allowed in signal handlers and other threads. */
MPS_API void mps_job_stop(mps_job *job);

/** Step to the end with all outputs; once for a job. @return MPS_EXIT_..., the same on all ranks */
MPS_API int32_t mps_job_run(mps_job *job, mps_sim *sim);

/** Print the table of passes since mps_profile_reset() into a text.
 *  @param measured  mps_step_info.seconds of these steps, summed [s]
 *  @param text      out: to be freed with free()
 *  @return MPS_E_ARG, MPS_E_NOMEM */
MPS_API mps_status mps_job_profile_text(mps_sim *sim, double measured, char **text);

/** All presets, models with settings, channels, orders of verbs, solvers and kernels of libmps as
 *  Markdown. @param text  out: to be freed with free() @return MPS_E_ARG, MPS_E_NOMEM */
MPS_API mps_status mps_job_models_text(char **text);

MPS_END_DECLS

#endif
