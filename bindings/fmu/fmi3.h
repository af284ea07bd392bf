/* SPDX-License-Identifier: BSD-3-Clause */
/* The part of the FMI 3.0 interface for co-simulation that the module implements: types of values
 * and of functions, written after the text of the standard (https://fmi-standard.org). Functions
 * are exported under the standard's names. */
#ifndef MPS_FMI3_H
#define MPS_FMI3_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef int fmi3_status; /* 0 ok, 1 warning, 2 discard, 3 error, 4 fatal */
typedef uint32_t fmi3_reference;

typedef void fmi3_log(void *environment, fmi3_status status, const char *category,
                      const char *message);
typedef void fmi3_intermediate(void *environment, double time, bool set_requested, bool get_allowed,
                               bool step_finished, bool can_return_early, bool *return_requested,
                               double *return_time);

typedef const char *fmi3_version(void);
typedef fmi3_status fmi3_debug(void *instance, bool on, size_t count,
                               const char *const *categories);
typedef void *fmi3_instantiate(const char *name, const char *token, const char *resources,
                               bool visible, bool logging, bool event_mode, bool early_return,
                               const fmi3_reference *intermediate, size_t intermediate_count,
                               void *environment, fmi3_log *log, fmi3_intermediate *update);
typedef void fmi3_free_instance(void *instance);
typedef fmi3_status fmi3_enter(void *instance, bool tolerance_defined, double tolerance,
                               double start, bool stop_defined, double stop);
typedef fmi3_status fmi3_call(void *instance);
typedef fmi3_status fmi3_get(void *instance, const fmi3_reference *reference, size_t references,
                             double *value, size_t values);
typedef fmi3_status fmi3_set(void *instance, const fmi3_reference *reference, size_t references,
                             const double *value, size_t values);
typedef fmi3_status fmi3_state_get(void *instance, void **state);
typedef fmi3_status fmi3_state_set(void *instance, void *state);
typedef fmi3_status fmi3_state_size(void *instance, void *state, size_t *size);
typedef fmi3_status fmi3_state_write(void *instance, void *state, uint8_t *bytes, size_t size);
typedef fmi3_status fmi3_state_read(void *instance, const uint8_t *bytes, size_t size,
                                    void **state);
typedef fmi3_status fmi3_derivative(void *instance, const fmi3_reference *unknown, size_t unknowns,
                                    const fmi3_reference *known, size_t knowns, const double *seed,
                                    size_t seeds, double *out, size_t outs);
typedef fmi3_status fmi3_step(void *instance, double time, double length, bool no_rollback,
                              bool *event, bool *terminate, bool *early, double *last_time);

#endif
