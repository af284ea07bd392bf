/* SPDX-License-Identifier: BSD-3-Clause */
/* The variables of the FMU, one table for the module and for the description that `mps fmu` writes; and a case with its simulation. */
#ifndef MPS_FMU_VARIABLES_H
#define MPS_FMU_VARIABLES_H

#include <mps/case.h>
#include <mps/motion.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A value reference is kind * FMU_STRIDE + degree of freedom; the time is 0. */
enum { FMU_STRIDE = 16, FMU_TOKEN = 40 };

typedef enum fmu_kind {
    FMU_TIME,
    FMU_POSE,         /* inputs: where the tank is at the end of the next step .. */
    FMU_VELOCITY,     /* .. its first derivative .. */
    FMU_ACCELERATION, /* .. and its second one */
    FMU_LOAD,         /* outputs: F */
    FMU_REST,         /* F0 */
    FMU_KINDS
} fmu_kind;

typedef struct fmu_variable {
    uint32_t reference;
    fmu_kind kind;
    int32_t dof;
    bool input;
    char name[24];
    const char *unit, *about;
} fmu_variable;

/* Variable number `index` of a case with so many dimensions, the time first. @return false: beyond the last */
bool fmu_variable_at(int32_t dim, int32_t index, fmu_variable *v);
/* @return false: there is none with this reference */
bool fmu_variable_of(int32_t dim, uint32_t reference, fmu_variable *v);

/* What tells that a description and a case belong together: 32 digits of the case as it is run, of the version of the
 * library and of the variables. */
void fmu_token(const char *text, char token[FMU_TOKEN]);

/* A case and its simulation. Fill it with zeros before fmu_model_open(). */
typedef struct fmu_model {
    mps_case *c;
    mps_job *job; /* it is not run: it makes no outputs */
    mps_sim *sim;
    int32_t dim;
    char folder[256]; /* for the job and for checkpoints; "": none */
} fmu_model;

/* Build the simulation of a case in a new folder below that of temporary files. The model owns the case from then on,
 * also on failure. `say` gets what the library logs. `error` gets all messages. @return false: it failed */
bool fmu_model_open(fmu_model *m, mps_case *c, mps_job_say_fn say, void *user, char *error,
                    size_t size);
/* Free all and remove the folder. */
void fmu_model_close(fmu_model *m);

#endif
