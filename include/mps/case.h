/* SPDX-License-Identifier: BSD-3-Clause */
/** @file case.h  Case files: a tank, its liquids, its motion and its sensors as a text in YAML.
 *  Functions of libmps_case, which is linked beside libmps.
 *
 *  A case is read as a whole. All its errors are messages, each with file, line and column. The
 *  table of keys gives kind, units, range and default of each value. */
#ifndef MPS_CASE_H
#define MPS_CASE_H

#include <mps/job.h>
#include <mps/plugin.h>
#include <mps/types.h>
#include <stddef.h>

MPS_BEGIN_DECLS

/** A case: what was read, and messages about it. One thread at a time may use it. */
typedef struct mps_case mps_case;

/** Most messages of a case; what comes after them is not kept. */
enum { MPS_CASE_MESSAGES = 20 };

/** A message about a case. */
typedef struct mps_case_message {
    /** sizeof(mps_case_message), set by the caller. */
    uint32_t struct_size;
    /** 0: an error, 1: a warning. */
    int32_t warning;
    /** Line in the file, from 1; 0: the whole file, or a text of `sets`. */
    int32_t line;
    /** Column in characters, from 1; 0: the whole line. */
    int32_t column;
    /** Name of the file, or the text of `sets` behind "--set ". */
    const char *file;
    /** What is wrong, and what is allowed. */
    const char *text;
    /** The line of the file, or NULL. */
    const char *source;
} mps_case_message;

/** Which plug-ins of a case are loaded. A plug-in is a program that runs with all rights of this
 *  one. A case from a page or from memory may come from anywhere, and so may the files that it
 *  names. */
enum {
    /** None. The case can be read; mps_case_job() and mps_case_check() refuse it. */
    MPS_CASE_PLUGINS_NONE = 0,
    /** Those that case files name, `sets` and mps_case_options.plugin. A case of a page or from
     *  memory that names some has an error. */
    MPS_CASE_PLUGINS_FILES = 1,
    /** All. */
    MPS_CASE_PLUGINS_ALL = 2
};

/** How a case is read. Fill it with mps_case_options_init(). */
typedef struct mps_case_options {
    /** Set by mps_case_options_init(). */
    uint32_t struct_size;
    /** MPS_CASE_PLUGINS_... */
    int32_t load;
    /** Number of `set`. */
    int32_t set_count;
    /** Number of `plugin`. */
    int32_t plugin_count;
    /** [set_count] "path=value", e.g. "run.until=60 s"; each wins over the file. */
    const char *const *set;
    /** [plugin_count] files of plug-ins, relative to the present folder. One takes the place of a
     *  plug-in of the case whose file has the same name; others are added. They are loaded unless
     *  `load` is MPS_CASE_PLUGINS_NONE. */
    const char *const *plugin;
    /** NULL: `path` is a file that is read. Else the case as YAML, and `path` is its name. */
    const char *text;
    /** Bytes of `text`. */
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

/** A plug-in of a case that is loaded. @param index  from 0 @return NULL: there is none */
MPS_API const mps_plugin_file *mps_case_plugin(const mps_case *c, int32_t index);

/** Read a case from a file: YAML, of which JSON is a part, or a report.html with its case. Files
 *  named by `base` are read too. Plug-ins are not loaded, see mps_case_open().
 *  @param path   of the file; other files are named relative to its folder
 *  @param count  number of `sets`, >= 0
 *  @param sets   [count] "path=value", e.g. "run.until=60 s"; each wins over the file
 *  @param out    the case; it may have messages: see mps_case_message_count(). NULL on failure;
 *                destroy it with mps_case_destroy()
 *  @return MPS_OK: no errors; MPS_E_ARG: errors, and a case with their messages; or no case, where
 *          an argument is NULL; MPS_E_IO: the file cannot be read, and a case with the message;
 *          MPS_E_NOMEM: no case */
MPS_API mps_status mps_case_read(const char *path, int32_t count, const char *const *sets,
                                 mps_case **out);

/** Read a case from memory. Plug-ins are not loaded, see mps_case_open().
 *  @param text  [size] YAML
 *  @param name  of the text in messages; other files are named relative to its folder
 *  @return as mps_case_read() */
MPS_API mps_status mps_case_read_text(const char *text, size_t size, const char *name,
                                      int32_t count, const char *const *sets, mps_case **out);

/** Destroy a case and its texts. NULL is allowed. */
MPS_API void mps_case_destroy(mps_case *c);

/** Number of messages; 0 for NULL. Messages are in the order of their places. */
MPS_API int32_t mps_case_message_count(const mps_case *c);

/** Message number `index`. Its texts are valid until the next call that may add messages.
 *  @param message  with its struct_size; out
 *  @return MPS_E_ARG */
MPS_API mps_status mps_case_message_get(const mps_case *c, int32_t index,
                                        mps_case_message *message);

/** Write all messages as a compiler does: `file:line:column: error: text`, the line, and a caret.
 *  @param buffer  [size] out, ends with 0; may be NULL where size is 0
 *  @return length of the whole text, without its end; a text of `size` or more was cut */
MPS_API size_t mps_case_messages_write(const mps_case *c, char *buffer, size_t size);

/** The case as it is run: `base`, `set` and `sets` are merged; names of files are absolute. Read
 *  again, it gives the same case. Owned by the case. NULL: the case is NULL, or has errors. */
MPS_API const char *mps_case_text(const mps_case *c);

/** Number of combinations of `sweep`, 1 if there is none. 0: the case is NULL, or has errors. */
MPS_API int64_t mps_case_runs(const mps_case *c);

/** Number of paths that `sweep` changes. */
MPS_API int32_t mps_case_sweep_count(const mps_case *c);

/** What run number `index` of a sweep sets, for the argument `sets` of mps_case_read(). The last
 *  path of `sweep` changes fastest.
 *  @param which   path number `which` of `sweep`
 *  @param buffer  [size] out, "path=value", ends with 0
 *  @return MPS_E_ARG: an argument, or the buffer is too short */
MPS_API mps_status mps_case_sweep_get(const mps_case *c, int64_t index, int32_t which, char *buffer,
                                      size_t size);

/** Read a value of a case as a number in SI, e.g. one of a sweep.
 *  @param text   one number with or without a unit: "20 mm", "0.9 T1", "10 %"
 *  @param dp     spacing for the unit dp [m]; NAN: not known
 *  @param T1     period for the unit T1 [s]; NAN: not known
 *  @param value  out; a share of "10 %" is 0.1; NAN: dp or T1 is not known
 *  @param unit   [size] out: its unit in SI, "m", ends with 0; "" for none
 *  @return MPS_E_ARG: an argument, or the text is no single number */
MPS_API mps_status mps_case_quantity(const char *text, double dp, double T1, double *value,
                                     char *unit, size_t size);

/** What a run costs, by the steps of mps_case_check(). */
typedef struct mps_case_cost {
    /** sizeof(mps_case_cost), set by the caller. */
    uint32_t struct_size;
    /** Kept 0. */
    int32_t reserved;
    /** Wall clock if the liquid stays calm [s]. */
    double wall_least;
    /** Wall clock in violent flow [s]. */
    double wall_most;
    /** Largest memory of the process so far, page included [bytes]. */
    double memory;
} mps_case_cost;

/** What the last mps_case_check() with a `text` found.
 *  @param cost  with its struct_size; out
 *  @return MPS_E_ARG: an argument; MPS_E_STATE: there was no such check, or its steps failed */
MPS_API mps_status mps_case_cost_get(const mps_case *c, mps_case_cost *cost);

/** A key of the language. */
typedef struct mps_case_key {
    /** sizeof(mps_case_key), set by the caller. */
    uint32_t struct_size;
    /** 1: must be given where its place is given. */
    int32_t required;
    /** Path; `*` is a name that the user chooses, `a|b` stands for both: "sensors.*.wall". */
    const char *path;
    /** What is allowed of each number, e.g. "> 0" (in SI units), or words, "x|y|z"; "" where all
     *  is. */
    const char *range;
    /** Default, "" for none. */
    const char *otherwise;
    /** An example of a value. */
    const char *example;
    /** One line. */
    const char *help;
    /** What it holds, e.g. "length", "text", "map". */
    char kind[96];
    /** Units of its kind, e.g. "m, cm, mm, km, um, dp"; "" for none. */
    char units[160];
} mps_case_key;

/** Key number `index`, from 0, in the order of the reference. Its texts are constants.
 *  @param key  with its struct_size; out
 *  @return MPS_E_ARG: beyond the last key; key */
MPS_API mps_status mps_case_key_get(int32_t index, mps_case_key *key);

/** The JSON Schema (2020-12) of a case, made from the table of keys.
 *  @param buffer  [size] out, ends with 0; may be NULL where size is 0
 *  @return length of the whole text, without its end; a text of `size` or more was cut */
MPS_API size_t mps_case_schema_write(char *buffer, size_t size);

/** Build the simulation of a case, and its job with all columns, figures and references. What the
 *  library refuses becomes a message at the line of the object. The case must live until job and
 *  simulation are destroyed.
 *  @param options  of the program: folder, command, resume, overwrite, quiet, signals, ranks, say,
 *                  error; the case says the rest
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

/** What a case amounts to: particles, volumes asked for and built, natural periods, largest motion,
 *  sensors, expected cost. It builds the simulation and does a few steps.
 *  @param text    out: lines for people; to be freed with free(), NULL on failure. A NULL argument:
 *                 not wanted, and no step is done
 *  @param sketch  out: tank, liquid and sensors as SVG; to be freed with free(), NULL on failure. A
 *                 NULL argument: not wanted
 *  @return as mps_case_job() */
MPS_API mps_status mps_case_check(mps_case *c, char **text, char **sketch);

/** @param from,to  units as `mps list units` prints them, "kPa", "Pa"
 *  @return number of `to` in one of `from`; 1 for the same text; NAN: a unit is not known, or they
 *          are of different kinds */
MPS_API double mps_unit_factor(const char *from, const char *to);

MPS_END_DECLS

#endif
