/* SPDX-License-Identifier: BSD-3-Clause */
/* Command line shared by all drivers; what it means is written in the text of --help. */
#ifndef MPS_EXAMPLES_CLI_H
#define MPS_EXAMPLES_CLI_H

#include <stdbool.h>
#include <stdint.h>

/* Exit codes of every driver. */
enum { CLI_OK = 0, CLI_FAILED = 1, CLI_USAGE = 2, CLI_DIVERGED = 3, CLI_INTERRUPTED = 130 };

enum { CLI_LIST = 32, CLI_TIMES = 24, CLI_OWN = 8 };

/* How the text of an option is read. TYPE_CHOICE: one of the words of `argument`, "one|two", into an int32_t from 0. */
typedef enum cli_type {
    TYPE_TEXT,
    TYPE_REAL,
    TYPE_INT,
    TYPE_CHOICE,
    TYPE_LIST,
    TYPE_TIMES,
    TYPE_FLAG,
    TYPE_HELP,
    TYPE_LISTING,
    TYPE_VERSION
} cli_type;

/* One option. Reals are checked against min <= value <= max, with min = 0 against 0 < value; min < 0 stands for 0 <= value. */
typedef struct cli_option {
    const char *name, *argument, *help;
    cli_type type;
    void *value;
    double min, max;
    bool flag; /* what a TYPE_FLAG sets */
} cli_option;

/* The texts of an option that may be given several times. */
typedef struct cli_list {
    int count;
    const char *text[CLI_LIST];
} cli_list;

/* What a driver can be asked for. A driver fills in its own defaults before it parses. */
typedef struct cli_options {
    const char *program; /* name of the case, also of its report */
    const char *about;   /* one line for --help */
    const char *model;   /* preset of the library */
    cli_list use, remove,
        set;            /* "slot.variant", "slot" and "slot.key=value", on top of the preset */
    double re_far;      /* far radius [dp]; 0: the library's */
    const char *solver; /* "solver" or "solver/preconditioner" */
    const char *out;    /* folder of all outputs */
    double checkpoint;  /* interval of checkpoints [s]; 0: only when interrupted */
    bool resume;        /* go on from the checkpoint in `out` */
    bool overwrite;     /* remove an earlier run from `out` */
    double dp, dp_min, dp_max; /* spacing [m] and what makes sense for this case */
    double dt;                 /* fixed step [s]; 0: adaptive */
    double cfl;                /* adaptive: dt u / dp */
    double calm;               /* adaptive: dt sqrt(g / dp); 0: as the model has it */
    double t_end, t_max;       /* [s]; t_end 0: the driver sets it after parsing */
    double probe_dt;           /* rows of probes.csv [s] */
    /* wall pressures and forces are means over this [s]; MPS_AVERAGE_AUTO: over
     * mps_step_info.crossing_time */
    double sensor_average;
    bool average_given;          /* by the user */
    int32_t threads;             /* of the simulation; with --mpi, of each rank */
    bool mpi;                    /* one run on all ranks of MPI */
    int32_t frames;              /* frames besides the first */
    bool pieces;                 /* each rank writes its part of them */
    bool tank_frame;             /* they are in the frame of the tank */
    int pictures;                /* 0: at quarters of the time */
    double picture_t[CLI_TIMES]; /* [s], ascending */
    int32_t dim;                 /* 2 or 3 */
    double amplitude;            /* of the motion [m]; offered by drivers that set it */
    double ramp;                 /* periods in which the motion grows to its amplitude */
    bool has_ramp;               /* the driver offers --ramp */
    int32_t layers;              /* columns of a baffle; 0: as it is thick */
    bool has_dim, has_layers;    /* the driver offers --dim, --layers */
    const char *stl;             /* NULL, or a file with the tank; offered if has_stl */
    double stl_scale;            /* [m] a unit of it */
    bool has_stl;
    double gravity;        /* downwards [m/s2] */
    double velocity_scale; /* mps_config.velocity_scale [m/s]; 0: the library's */
    double sigma;          /* surface tension [N/m], for models that have it */
    bool has_sigma;        /* the driver offers --sigma */
    bool sigma_given;      /* by the user */
    /* models of several phases suit the case; set by cli_parse(): they are its default, or it
     * has a `need` */
    bool two_phases;
    /* the case has two phases whatever the model; set by cli_parse(): a model of several phases
     * is its default */
    bool both_phases;
    bool no_gas; /* both phases are liquids: the model of the gas is switched off */
    /* NULL, or "slot.variant" that every model gets where there are two phases and its slot is
     * empty */
    const char *need;
    const char *prefer; /* NULL, or "slot.key=value", set before --set where the model has it */
    int owns;           /* options of this driver alone */
    cli_option own[CLI_OWN];
    bool report, quiet, profile;
} cli_options;

/* Sensible defaults for everything but program, about, dp and t_end. */
void cli_defaults(cli_options *o, const char *program, const char *about);
/* Offer an option of this driver alone; its default is what `value` holds. */
void cli_own(cli_options *o, cli_option option);
/* Parse; prints --help or what is wrong and exits. */
void cli_parse(cli_options *o, int argc, char **argv);
/* Exit with a message; `format` has two %s. */
void cli_refuse(const cli_options *o, const char *format, const char *a, const char *b);

#endif
