/* SPDX-License-Identifier: BSD-3-Clause */
/** @file case.h  Case files: a tank, its liquids, its motion and its sensors in YAML. Functions of
 *  libmps_case, which is linked together with libmps.
 *
 *  A case is read completely; all its errors are reported as messages with file, line and column.
 *  The table of keys defines type, units, range and default of each value. */
#ifndef MPS_CASE_H
#define MPS_CASE_H

#include <mps/job.h>
#include <mps/plugin.h>
#include <mps/types.h>
#include <stddef.h>

MPS_BEGIN_DECLS

/** A case with its messages. One thread at a time may use it. */
typedef struct mps_case mps_case;

/** Maximum number of messages of a case; further messages are discarded. */
enum { MPS_CASE_MESSAGES = 20 };

/** A message about a case. */
typedef struct mps_case_message {
    /** sizeof(mps_case_message), set by the caller. */
    uint32_t struct_size;
    /** 0: an error, 1: a warning. */
    int32_t warning;
    /** Line in the file, from 1; 0: the whole file, or an entry of `sets`. */
    int32_t line;
    /** Column in characters, from 1; 0: the whole line. */
    int32_t column;
    /** Name of the file, or "--set " and the entry of `sets`. */
    const char *file;
    /** The error, and what is allowed. */
    const char *text;
    /** The line of the file, or NULL. */
    const char *source;
} mps_case_message;

/** Which plug-ins of a case are loaded. A plug-in runs code with all rights of the program. A case
 *  from a report.html or from memory, and the files that it names, may be untrusted. */
enum {
    /** None. The case can be read; mps_case_job() and mps_case_check() refuse it. */
    MPS_CASE_PLUGINS_NONE = 0,
    /** Plug-ins named in case files, in `sets` and in mps_case_options.plugin. A plug-in named in a
     *  case from a report.html or from memory is an error. */
    MPS_CASE_PLUGINS_FILES = 1,
    /** All. */
    MPS_CASE_PLUGINS_ALL = 2
};

/** Options for reading a case. Initialise with mps_case_options_init(). */
typedef struct mps_case_options {
    /** Set by mps_case_options_init(). */
    uint32_t struct_size;
    /** MPS_CASE_PLUGINS_... */
    int32_t load;
    /** Number of entries of `set`. */
    int32_t set_count;
    /** Number of entries of `plugin`. */
    int32_t plugin_count;
    /** [set_count] "path=value", e.g. "run.until=60 s"; each overrides the file. */
    const char *const *set;
    /** [plugin_count] files of plug-ins, relative to the current folder. An entry replaces a
     *  plug-in of the case with the same file name; others are added. They are loaded unless `load`
     *  is MPS_CASE_PLUGINS_NONE. */
    const char *const *plugin;
    /** NULL: `path` is the file to read. Otherwise the case as YAML, and `path` is its name. */
    const char *text;
    /** Size of `text` [bytes]. */
    size_t size;
} mps_case_options;

/** Set every entry to its default, 0. @param size  sizeof(mps_case_options)
 *  @return MPS_E_ARG: bad size */
MPS_API mps_status mps_case_options_init(mps_case_options *options, size_t size);

/** Read a case from a file or from memory, see mps_case_read(). A plug-in of the case is unloaded
 *  when the case is destroyed.
 *  @param options  NULL: all defaults
 *  @return as mps_case_read() */
MPS_API mps_status mps_case_open(const char *path, const mps_case_options *options, mps_case **out);

/** A loaded plug-in of a case. @param index  from 0 @return NULL: no such plug-in */
MPS_API const mps_plugin_file *mps_case_plugin(const mps_case *c, int32_t index);

/** Read a case from a file: YAML (JSON included), or a report.html with its case. Files named by
 *  `base` are read too. Plug-ins are not loaded, see mps_case_open().
 *  @param path   of the file; names of other files are relative to its folder
 *  @param count  number of `sets`, >= 0
 *  @param sets   [count] "path=value", e.g. "run.until=60 s"; each overrides the file
 *  @param out    the case; it may have messages, see mps_case_message_count(). NULL on failure;
 *                destroy it with mps_case_destroy()
 *  @return MPS_OK: no errors; MPS_E_ARG: errors, and a case with their messages; or an argument is
 *          NULL, and no case; MPS_E_IO: the file cannot be read, and a case with the message;
 *          MPS_E_NOMEM: no case */
MPS_API mps_status mps_case_read(const char *path, int32_t count, const char *const *sets,
                                 mps_case **out);

/** Read a case from memory. Plug-ins are not loaded, see mps_case_open().
 *  @param text  [size] YAML
 *  @param name  of the text in messages; names of other files are relative to its folder
 *  @return as mps_case_read() */
MPS_API mps_status mps_case_read_text(const char *text, size_t size, const char *name,
                                      int32_t count, const char *const *sets, mps_case **out);

/** Destroy a case and its texts. NULL is allowed. */
MPS_API void mps_case_destroy(mps_case *c);

/** Number of messages; 0 for NULL. Messages are ordered by file, line and column. */
MPS_API int32_t mps_case_message_count(const mps_case *c);

/** Message number `index`. Its texts are valid until the next call that may add messages.
 *  @param message  with its struct_size; out
 *  @return MPS_E_ARG */
MPS_API mps_status mps_case_message_get(const mps_case *c, int32_t index,
                                        mps_case_message *message);

/** Write all messages in the format of a compiler: `file:line:column: error: text`, the line, and a
 *  caret.
 *  @param buffer  [size] out, null-terminated; may be NULL if size is 0
 *  @return length of the complete text without the terminating 0; if it is `size` or more, the text
 *          is truncated */
MPS_API size_t mps_case_messages_write(const mps_case *c, char *buffer, size_t size);

/** The case as it is run: `base`, `set` and `sets` are merged; names of files are absolute. Reading
 *  it again gives the same case. Owned by the case. NULL: the case is NULL or has errors. */
MPS_API const char *mps_case_text(const mps_case *c);

/** Number of combinations of `sweep`, 1 without a sweep. 0: the case is NULL or has errors. */
MPS_API int64_t mps_case_runs(const mps_case *c);

/** Number of paths in `sweep`. */
MPS_API int32_t mps_case_sweep_count(const mps_case *c);

/** An entry of `sets` of mps_case_read() for run number `index` of a sweep. The last path of
 *  `sweep` varies fastest.
 *  @param which   number of the path in `sweep`
 *  @param buffer  [size] out, "path=value", null-terminated
 *  @return MPS_E_ARG: an argument, or the buffer is too short */
MPS_API mps_status mps_case_sweep_get(const mps_case *c, int64_t index, int32_t which, char *buffer,
                                      size_t size);

/** Read a value of a case as a number in SI, e.g. one of a sweep.
 *  @param text   one number with or without a unit: "20 mm", "0.9 T1", "10 %"
 *  @param dp     spacing for the unit dp [m]; NAN: unknown
 *  @param T1     period for the unit T1 [s]; NAN: unknown
 *  @param value  out; "10 %" is 0.1; NAN: dp or T1 is unknown
 *  @param unit   [size] out: its SI unit, e.g. "m", null-terminated; "" for none
 *  @return MPS_E_ARG: an argument, or the text is not a single number */
MPS_API mps_status mps_case_quantity(const char *text, double dp, double T1, double *value,
                                     char *unit, size_t size);

/** Estimated cost of a run, from the steps of mps_case_check(). */
typedef struct mps_case_cost {
    /** sizeof(mps_case_cost), set by the caller. */
    uint32_t struct_size;
    /** Kept 0. */
    int32_t reserved;
    /** Wall-clock time if the liquid remains calm [s]. */
    double wall_least;
    /** Wall-clock time for violent flow [s]. */
    double wall_most;
    /** Peak memory of the process so far, including that of report.html [bytes]. */
    double memory;
} mps_case_cost;

/** Cost of the last mps_case_check() with a `text`.
 *  @param cost  with its struct_size; out
 *  @return MPS_E_ARG: an argument; MPS_E_STATE: no such check, or its steps failed */
MPS_API mps_status mps_case_cost_get(const mps_case *c, mps_case_cost *cost);

/** A key of case files. */
typedef struct mps_case_key {
    /** sizeof(mps_case_key), set by the caller. */
    uint32_t struct_size;
    /** 1: required if its parent is present. */
    int32_t required;
    /** Path; `*` is a name that the user chooses, `a|b` is an alternative: "sensors.*.wall". */
    const char *path;
    /** Allowed range of each number, e.g. "> 0" (in SI units), or words, "x|y|z"; "": no
     *  restriction. */
    const char *range;
    /** Default, "" for none. */
    const char *otherwise;
    /** An example of a value. */
    const char *example;
    /** One line. */
    const char *help;
    /** Type of the value, e.g. "length", "text", "map". */
    char kind[96];
    /** Units of its type, e.g. "m, cm, mm, km, um, dp"; "" for none. */
    char units[160];
} mps_case_key;

/** Key number `index`, from 0, in the order of the reference. Its texts are static.
 *  @param key  with its struct_size; out
 *  @return MPS_E_ARG: index is beyond the last key; invalid `key` */
MPS_API mps_status mps_case_key_get(int32_t index, mps_case_key *key);

/** The JSON Schema (2020-12) of a case, generated from the table of keys.
 *  @param buffer  [size] out, null-terminated; may be NULL if size is 0
 *  @return length of the complete text without the terminating 0; if it is `size` or more, the text
 *          is truncated */
MPS_API size_t mps_case_schema_write(char *buffer, size_t size);

/** Build the simulation of a case, and its job with all columns, figures and references. An error
 *  of the library becomes a message at the line of the object. Destroy the case after job and
 *  simulation.
 *  @param options  of the program: folder, command, resume, overwrite, quiet, signals, ranks,
 *                  print, error; the case defines all others
 *  @param job      out: the job; destroy it after the simulation. NULL on failure
 *  @param sim      out: the simulation. NULL on failure
 *
 *  | error | reason |
 *  |---|---|
 *  | MPS_E_ARG | an argument; the case has errors, see mps_case_message_get() |
 *  | MPS_E_STATE, MPS_E_BUSY, MPS_E_IO, MPS_E_RANKS | as mps_job_create(); text in options->error |
 *  | MPS_E_NOMEM | no memory | */
MPS_API mps_status mps_case_job(mps_case *c, const mps_job_config *options, mps_job **job,
                                mps_sim **sim);

/** Summary of a case: particles, requested and built volumes, natural periods, largest motion,
 *  sensors, estimated cost. It builds the simulation and does several steps.
 *  @param text    out: readable lines; free it with free(), NULL on failure. A NULL argument: not
 *                 needed, and no step is done
 *  @param sketch  out: tank, liquid and sensors as SVG; free it with free(), NULL on failure. A
 *                 NULL argument: not needed
 *  @return as mps_case_job() */
MPS_API mps_status mps_case_check(mps_case *c, char **text, char **sketch);

/** @param from,to  units as `mps list units` prints them, "kPa", "Pa"
 *  @return conversion factor: 1 `from` in `to`; 1 for equal texts; NAN: a unit is unknown, or their
 *          dimensions differ */
MPS_API double mps_unit_factor(const char *from, const char *to);

MPS_END_DECLS

#endif
