/* SPDX-License-Identifier: BSD-3-Clause */
/* Command line shared by all drivers; what it means is written in the text of --help. */
#ifndef MPS_EXAMPLES_CLI_H
#define MPS_EXAMPLES_CLI_H

#include <stdbool.h>
#include <stdint.h>

/* Exit codes of every driver. */
enum { CLI_OK = 0, CLI_FAILED = 1, CLI_USAGE = 2, CLI_DIVERGED = 3, CLI_INTERRUPTED = 130 };

/* What a driver can be asked for. A driver fills in its own defaults before it parses. */
typedef struct cli_options {
    const char *program;       /* name of the case, also of its report */
    const char *about;         /* one line for --help */
    const char *model;         /* preset of the library */
    const char *solver;        /* "solver" or "solver/preconditioner" */
    const char *out;           /* folder of all outputs */
    double dp, dp_min, dp_max; /* spacing [m] and what makes sense for this case */
    double dt;                 /* fixed step [s]; 0: adaptive */
    double cfl;                /* adaptive: dt u / dp */
    double t_end, t_max;       /* [s] */
    double probe_dt;           /* rows of probes.csv [s] */
    int32_t threads;           /* OpenMP threads */
    int32_t frames;            /* frames besides the first */
    int32_t dim;               /* 2 or 3 */
    bool has_dim;              /* the driver offers --dim */
    bool report, quiet;
} cli_options;

/* Sensible defaults for everything but program, about, dp and t_end. */
void cli_defaults(cli_options *o, const char *program, const char *about);
/* Parse; prints --help or what is wrong and exits. */
void cli_parse(cli_options *o, int argc, char **argv);

#endif
