/* SPDX-License-Identifier: BSD-3-Clause */
/* Common code of the drivers: the command line, and the simulation and job that it sets up. On
 * failure a function ends the program with a message and an exit code, on all ranks. */
#ifndef MPS_EXAMPLES_DRIVER_H
#define MPS_EXAMPLES_DRIVER_H

#include "options.h"
#include <mps/job.h>
#include <mps/mps.h>

enum { DRIVER_OWN = 8 };

/* Options of a driver, and the objects made from them. A driver sets its own defaults before it
 * parses. */
typedef struct driver {
    const char *program; /* name of the case */
    const char *about;   /* one line for --help */
    const char *model;   /* preset of the library */
    option_list use, remove,
        set;            /* "slot.variant", "slot" and "slot.key=value", on top of the preset */
    double re_far;      /* far radius [dp]; 0: the library's */
    const char *solver; /* "solver" or "solver/preconditioner" */
    const char *out;    /* folder of all outputs */
    double checkpoint;  /* interval of checkpoints [s]; 0: by the clock only */
    double dp, dp_min, dp_max; /* spacing and its allowed range [m] */
    double dt;                 /* fixed step [s]; 0: adaptive */
    double cfl;                /* adaptive: dt u / dp */
    double calm;               /* adaptive: dt sqrt(g / dp); 0: default of the model */
    double t_end, t_max;       /* [s]; t_end 0: set by the driver after parsing */
    double probe_dt;           /* interval of rows in probes.csv [s] */
    double sensor_average;     /* mps_probe.average of wall pressures and forces [s] */
    option_times pictures;     /* none: at quarters of the run */
    const char *device;        /* NULL: the host */
    int32_t threads;           /* of the simulation; with --mpi, of each rank */
    int32_t frames;            /* frames besides the first */
    int32_t dim;               /* 2 or 3 */
    double gravity;            /* downwards [m/s2] */
    double velocity_scale;     /* mps_config.velocity_scale [m/s]; 0: the library's */
    double amplitude;          /* of the motion [m]; offered by drivers that set it */
    double ramp;               /* ramp of the motion [periods]; offered with has_ramp */
    int32_t layers;            /* columns of a baffle, 0: by its thickness; has_layers */
    double sigma;              /* surface tension [N/m]; has_sigma */
    bool has_dim, has_ramp, has_layers, has_sigma;
    bool resume, overwrite, pieces, tank_frame, mpi, report, quiet, profile;
    bool average_given, sigma_given; /* set by the user */
    bool no_gas;                     /* both phases are liquids: the gas model is switched off */
    /* NULL, or "slot.variant", activated if there are two phases and its slot is empty */
    const char *need;
    /* case allows models of several phases; it always has two phases: by its default */
    bool two_phases, both_phases;
    int owns; /* options of this driver alone */
    option own[DRIVER_OWN];
    char command[1024];
    mps_job_ranks ranks;
    mps_sim *sim;
    mps_job *job;
} driver;

/* Defaults of all options except dp and t_end. */
void driver_defaults(driver *d, const char *program, const char *about);
/* Add an option of this driver only; its default is the current content of `value`. */
void driver_own(driver *d, option own);
void driver_parse(driver *d, int argc, char **argv);
/* End with a message. */
_Noreturn void driver_exit(driver *d, int code, const char *format, ...);
/* End with a message and MPS_EXIT_USAGE. */
_Noreturn void driver_refuse(driver *d, const char *format, ...);
/* Lock the folder, and create a simulation with the requested models, solver and time step. */
void driver_open(driver *d);
/* End with a message unless a call of the library succeeded. */
void driver_check(driver *d, mps_status status, const char *what);
/* End with a message unless a call of the job succeeded. */
void driver_check_job(driver *d, mps_status status);
/* Free everything, and end together with the other ranks. */
void driver_finish(driver *d);
/* Whether the model has several phases: gas fills the tank above the liquid. */
bool driver_has_gas(const driver *d);
/* Define a phase: 0: the liquid, 1: the fluid around it [kg/m3], [Pa s]. */
void driver_phase(driver *d, int32_t index, double density, double viscosity);
/* Height of the highest particle of phase 0. */
double driver_top(driver *d);

/* Columns, in the order of probes.csv. Positions are in the frame of the tank. `diameter` of a
 * sensor [m]; 0: dp. */
void driver_wall(driver *d, const char *name, double x, double y, double z, double diameter);
/* A gauge with a given foot [3], e.g. on a baffle. */
void driver_gauge_from(driver *d, const char *name, const double *foot, double level);
/* A gauge from y = 0. */
void driver_gauge(driver *d, const char *name, double x, double z, double level);
/* A component of the force on a part, or on all solids for NULL. */
void driver_force(driver *d, const char *name, const char *part, int32_t component);
/* A quantity of the driver, see mps_job_value_add(). */
void driver_value(driver *d, const char *name, const char *unit, const char *about, int32_t flags,
                  mps_job_value_fn value, void *user);
void driver_measure(driver *d, mps_measure measure);
/* Set all entries to their defaults, with these names. */
mps_measure driver_measure_of(const char *measure, const char *name, const char *about);
void driver_marks(driver *d, const char *label, const char *unit, int count, const double *t,
                  const double *value);

/* Run to the end. @return exit code of the program */
int driver_run(driver *d);

#endif
