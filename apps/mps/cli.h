/* SPDX-License-Identifier: BSD-3-Clause */
/* The command line of mps: commands (verbs) with their options. */
#ifndef MPS_APPS_CLI_H
#define MPS_APPS_CLI_H

#include <mps/case.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum { CLI_SETS = 64, CLI_FILES = 64, CLI_PLUGINS = 16 };

/* Messages of one of many ranks, kept until it is known which rank shows its own. */
typedef struct cli_text {
    char text[8192];
    mps_job_ranks ranks;
} cli_text;

/* The parsed command line. */
typedef struct choices {
    cli_text *kept; /* NULL: one process, whose messages go directly to stderr */
    const char *program, *verb;
    int32_t files, sets;
    const char *file[CLI_FILES];   /* arguments that are no options */
    const char *set[CLI_SETS + 8]; /* "path=value"; a verb adds its own */
    int32_t plugins;
    const char *plugin[CLI_PLUGINS]; /* files */
    const char *out;                 /* NULL: default of the verb */
    const char *device;              /* NULL: the host processor */
    const char *degrees, *omega, *period, *amplitude;
    const char *part; /* "I/N", NULL: all */
    int32_t threads;  /* 0: as in the case */
    int32_t jobs;     /* processes; 0: this one only */
    int32_t count;    /* 0: default of the verb */
    int32_t fmi;      /* version, 0: default of the verb */
    int32_t periods;  /* 0: default of the verb */
    bool overwrite, resume, quiet, profile, mpi, allow_plugins;
    char command[1024]; /* the whole command line */
} choices;

/* Options of a verb, as bits. */
enum {
    HAS_SET = 1,
    HAS_OUT = 2,
    HAS_THREADS = 4,
    HAS_OVERWRITE = 8,
    HAS_QUIET = 16,
    HAS_PROFILE = 32,
    HAS_MPI = 64,
    HAS_RESUME = 128,
    HAS_COUNT = 256,
    HAS_FMI = 512,
    HAS_FREQUENCIES = 1024,
    HAS_DEVICE = 2048,
    HAS_PLUGIN = 4096,
    HAS_TRUST = 8192, /* --allow-plugins */
    HAS_JOBS = 16384,
    HAS_PART = 32768,
    HAS_MAP = 65536 /* instead of HAS_SET: the texts are in `set` */
};

/* A verb: `mps VERB ARGUMENTS`. @return exit code, MPS_EXIT_... */
typedef struct verb {
    const char *name, *arguments, *help;
    int32_t few, many; /* number of arguments */
    int32_t options;
    int (*run)(const choices *c);
    const char *more; /* text after the options of `mps VERB --help`, or NULL */
} verb;

/* All verbs, in the order of `mps --help`. */
extern const verb cli_verbs[];
extern const int32_t cli_verb_count;

typedef enum option_kind {
    OPTION_FLAG,
    OPTION_TEXT,
    OPTION_COUNT,
    OPTION_SET,
    OPTION_PLUGIN
} option_kind;

/* An option: available to verbs with its bit. */
typedef struct option {
    int32_t bit;
    const char *name; /* "--set" */
    char letter;      /* 's', 0: none */
    const char *argument, *help;
    option_kind kind;
    size_t place; /* offset in choices: bool, const char * or int32_t, by kind */
} option;

extern const option cli_options[];
extern const int32_t cli_option_count;

int verb_run(const choices *c);
int verb_resume(const choices *c);
int verb_sweep(const choices *c);
int verb_repeat(const choices *c);
int verb_converge(const choices *c);
int verb_coefficients(const choices *c);
int verb_collect(const choices *c);
int verb_report(const choices *c);
int verb_stats(const choices *c);
int verb_compare(const choices *c);
int verb_check(const choices *c);
int verb_fmu(const choices *c);
int verb_init(const choices *c);
int verb_list(const choices *c);
int verb_info(const choices *c);
int verb_schema(const choices *c);

/* Parse the command line; prints help or the error. @return -1: continue; else the exit code */
int cli_read(choices *c, const verb *v, int argc, char **argv);
void cli_print_help(const verb *v);
/* Read the case of a command line with its values and plug-ins. */
mps_status cli_open(const choices *c, mps_case **out);
/* Read a case and print its messages. @return NULL: it has errors, and *code is set */
mps_case *cli_case(const choices *c, int *code);
/* Run a case into a folder; `begin` has resume and error, the choices have the rest.
 * @param busy  NULL, or out: another process runs in the folder, which is then no failure and has
 * no message
 * @return exit code */
int cli_run(const choices *c, const mps_job_config *begin, const char *folder, bool *busy);
/* With --mpi among the arguments: initialise MPI before anything is printed.
 * @return -1: continue; else the exit code */
int cli_begin(choices *c, int argc, char **argv);
/* Refuse several processes that are not one run and would write to one folder.
 * @return -1: continue; else the exit code */
int cli_check_alone(const choices *c);
/* Print a message. */
void cli_print(const choices *c, const char *format, ...);
/* Agree on whether all ranks continue, which they do if all have code < 0; one of the failed ranks
 * shows its messages.
 * @return -1: continue; else the exit code of all */
int cli_agree(const choices *c, int code);
/* The end of a run on all ranks; one of them shows its messages. @return exit code of all */
int cli_end(const choices *c, int code);
/* List cases to start from, with their titles. */
void cli_list_cases(FILE *out);
/* Flush all output. @return code, or that of a failure, which is reported */
int cli_flush(const choices *c, int code);
/* Extract "surge" from "cases/surge.yaml". */
void cli_stem(const char *path, char *out, size_t size);
/* Bytes of the messages of a case; print those after the first `before` bytes. */
size_t cli_messages(const mps_case *tank);
void cli_print_messages(const choices *c, const mps_case *tank, size_t before);

#endif
