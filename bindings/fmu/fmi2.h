/* SPDX-License-Identifier: BSD-3-Clause */
/* The part of the FMI 2.0 interface for co-simulation that the module implements: types of values
 * and of functions, written after the text of the standard (https://fmi-standard.org). Functions
 * are exported under the standard's names. */
#ifndef MPS_FMI2_H
#define MPS_FMI2_H

#include <stddef.h>

typedef int fmi2_status; /* 0 ok, 1 warning, 2 discard, 3 error, 4 fatal, 5 pending */
typedef unsigned int fmi2_reference;

/* The message is a printf() format. */
typedef void fmi2_log(void *environment, const char *name, fmi2_status status, const char *category,
                      const char *message, ...);

/* Passed by an importer at instantiation. */
typedef struct fmi2_callbacks {
    fmi2_log *log;
    void *(*allocate)(size_t count, size_t size);
    void (*release)(void *memory);
    void (*step_finished)(void *environment, fmi2_status status);
    void *environment;
} fmi2_callbacks;

typedef const char *fmi2_version(void);
typedef fmi2_status fmi2_debug(void *instance, int on, size_t count, const char *const *categories);
typedef void *fmi2_instantiate(const char *name, int kind, const char *token, const char *resources,
                               const fmi2_callbacks *callbacks, int visible, int logging);
typedef void fmi2_free_instance(void *instance);
typedef fmi2_status fmi2_setup(void *instance, int tolerance_defined, double tolerance,
                               double start, int stop_defined, double stop);
typedef fmi2_status fmi2_call(void *instance);
typedef fmi2_status fmi2_get(void *instance, const fmi2_reference *reference, size_t count,
                             double *value);
typedef fmi2_status fmi2_set(void *instance, const fmi2_reference *reference, size_t count,
                             const double *value);
typedef fmi2_status fmi2_state_get(void *instance, void **state);
typedef fmi2_status fmi2_state_set(void *instance, void *state);
typedef fmi2_status fmi2_state_size(void *instance, void *state, size_t *size);
typedef fmi2_status fmi2_state_write(void *instance, void *state, char *bytes, size_t size);
typedef fmi2_status fmi2_state_read(void *instance, const char *bytes, size_t size, void **state);
typedef fmi2_status fmi2_derivative(void *instance, const fmi2_reference *unknown, size_t unknowns,
                                    const fmi2_reference *known, size_t knowns, const double *seed,
                                    double *out);
typedef fmi2_status fmi2_step(void *instance, double time, double length, int no_rollback);
typedef fmi2_status fmi2_status_get(void *instance, int kind, fmi2_status *value);
typedef fmi2_status fmi2_real_status_get(void *instance, int kind, double *value);
typedef fmi2_status fmi2_flag_status_get(void *instance, int kind, int *value);

#endif
