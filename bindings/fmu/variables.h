/* SPDX-License-Identifier: BSD-3-Clause */
/* The variables of the FMU, one table for the module and for the description that `mps fmu` writes;
 * and a case with its simulation. */
#ifndef MPS_FMU_VARIABLES_H
#define MPS_FMU_VARIABLES_H

#include <mps/case.h>
#include <mps/motion.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A value reference is kind * FMU_STRIDE + degree of freedom, for a sensor FMU_SENSORS + its
 * number; the time is 0. */
enum { FMU_STRIDE = 16, FMU_SENSORS = 1024, FMU_TOKEN = 40 };

typedef enum fmu_kind {
    FMU_TIME,
    FMU_POSE,         /* inputs: pose of the tank at the end of the next step .. */
    FMU_VELOCITY,     /* .. its first derivative .. */
    FMU_ACCELERATION, /* .. and its second one */
    FMU_LOAD,         /* outputs: F */
    FMU_REST,         /* F0 */
    FMU_KINDS,
    FMU_SENSOR = FMU_KINDS /* outputs: sensors of the case */
} fmu_kind;

typedef struct fmu_variable {
    uint32_t reference;
    fmu_kind kind;
    int32_t dof; /* for a sensor: its number */
    bool input;
    bool later; /* known after the first step */
    char name[48];
    const char *unit, *about; /* for a sensor: owned by the job */
} fmu_variable;

/* Hash that identifies a matching description and case: 32 hexadecimal digits of the case as run,
 * of the version of the library and of the variables. */
void fmu_token(const char *text, char token[FMU_TOKEN]);

/* A case and its simulation. Zero-initialise it before fmu_model_open(). */
typedef struct fmu_model {
    mps_case *c;
    mps_job *job; /* it is not run and has no outputs */
    mps_sim *sim;
    int32_t dim;
    char folder[256]; /* for the job and for checkpoints; "": none */
} fmu_model;

/* Build the simulation of a case in a new folder for temporary files. The model owns the case from
 * then on, also on failure. `print` receives log messages of the library, `error` all messages.
 * @return false: failed */
bool fmu_model_open(fmu_model *m, mps_case *c, mps_job_print_fn print, void *user, char *error,
                    size_t size);
/* Free all and remove the folder. */
void fmu_model_close(fmu_model *m);

/* Variable number `index` of a model, the time first. @return false: after the last */
bool fmu_variable_at(const fmu_model *m, int32_t index, fmu_variable *v);
/* @return false: there is none with this reference */
bool fmu_variable_of(const fmu_model *m, uint32_t reference, fmu_variable *v);

#endif
