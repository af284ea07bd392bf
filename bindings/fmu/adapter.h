/* SPDX-License-Identifier: BSD-3-Clause */
/* One tank of an importer, for any version of FMI. fmi2.c and fmi3.c translate names and types. */
#ifndef MPS_FMU_ADAPTER_H
#define MPS_FMU_ADAPTER_H

#include "variables.h"
#include <mps/mps.h>

/* Both standards begin with ok 0, warning 1, discard 2, error 3. */
typedef enum fmu_status { FMU_OK, FMU_WARNING, FMU_DISCARD, FMU_ERROR } fmu_status;

typedef enum fmu_mode { FMU_INSTANTIATED, FMU_INITIALISING, FMU_STEPPING, FMU_TERMINATED } fmu_mode;

/* Receives a message for the importer. */
typedef void (*fmu_log_fn)(void *user, fmu_status status, const char *text);

/* All numbers of an instance besides its simulation; a state and its bytes contain them. */
typedef struct fmu_values {
    double start, time; /* of the importer: first and present communication point */
    double input[3][MPS_DOF_COUNT];
    double load[MPS_DOF_COUNT], rest[MPS_DOF_COUNT], mass[MPS_DOF_COUNT * MPS_DOF_COUNT];
    int32_t mode, has_mass;
} fmu_values;

typedef struct fmu fmu;
typedef struct fmu_state fmu_state;

struct fmu {
    fmu_model model;
    fmu_values v;
    mps_motion_state hold;         /* pose of the tank before the first step */
    mps_snapshot *origin, *before; /* as built; as at the beginning of a call */
    fmu_state *states;             /* all states that the importer holds */
    fmu_log_fn print;
    void *user;
    bool chatty; /* log messages of the library go to the importer too */
    char token[FMU_TOKEN];
};

/* The tank of resources/case.yaml.
 * @param resources  folder
 * @param token  of the description
 * @return NULL after a message */
fmu *fmu_create(const char *resources, const char *token, bool chatty, fmu_log_fn print,
                void *user);
void fmu_destroy(fmu *f);
/* Send a message. @return status */
fmu_status fmu_log(const fmu *f, fmu_status status, const char *format, ...);
fmu_status fmu_initialise(fmu *f, double start); /* inputs are initial values from now on */
fmu_status fmu_begin(fmu *f);                    /* the tank is at its initial pose */
fmu_status fmu_terminate(fmu *f);
fmu_status fmu_reset(fmu *f);
fmu_status fmu_set(fmu *f, const uint32_t *reference, size_t count, const double *value);
fmu_status fmu_get(fmu *f, const uint32_t *reference, size_t count, double *value);
fmu_status fmu_step(fmu *f, double time, double length);

/* A directional derivative along `seed`: of outputs by inputs. */
typedef struct fmu_direction {
    const uint32_t *unknown, *known;
    size_t unknowns, knowns;
    const double *seed; /* [knowns] */
    double *out;        /* [unknowns] */
} fmu_direction;
fmu_status fmu_derivative(fmu *f, const fmu_direction *d);

/* States. `*state` is NULL or one that is overwritten. */
fmu_status fmu_state_take(fmu *f, fmu_state **state);
fmu_status fmu_state_restore(fmu *f, fmu_state *state);
void fmu_state_free(fmu *f, fmu_state *state);
/* The bytes of a state, owned by it. */
fmu_status fmu_state_bytes(fmu *f, fmu_state *state, const unsigned char **bytes, size_t *size);
/* Copy the bytes of a state to `out`.
 * @param size  of `out`; less than those of the state: an error */
fmu_status fmu_state_write(fmu *f, fmu_state *state, void *out, size_t size);
fmu_status fmu_state_read(fmu *f, const unsigned char *bytes, size_t size, fmu_state **state);
/* Set the tank to the pose `f->hold`. */
mps_status fmu_hold(fmu *f);
/* Report why a call of the library failed. */
fmu_status fmu_refused(fmu *f, fmu_status status, const char *call);

#endif
