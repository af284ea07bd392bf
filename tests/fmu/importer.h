/* SPDX-License-Identifier: BSD-3-Clause */
/* A minimal importer of FMUs for tests: an unpacked FMU of either version with one set of
 * functions. */
#ifndef TESTS_FMU_IMPORTER_H
#define TESTS_FMU_IMPORTER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { INPUTS = 9, OUTPUTS = 6 };

/* In 2-D, as modelDescription.xml has them. */
extern const uint32_t pose_refs[INPUTS];  /* x, y, angle, then their rates, then accelerations */
extern const uint32_t load_refs[OUTPUTS]; /* F, F0 */

typedef struct module module;
typedef struct tank {
    const module *of;
    void *instance;
    bool logging;
    int messages;
    char text[8192]; /* the last message */
} tank;

/* A module of an unpacked FMU in FOLDER/2 or FOLDER/3. Ends the program if it does not exist. */
const module *module_load(const char *folder, int version);
int module_version(const module *m);
const char *module_token(const module *m);

/* NULL token: that of the description. @return false: refused */
bool tank_open(tank *t, const module *m, const char *token);
void tank_close(tank *t);
int tank_start(tank *t, double time); /* both ends of the initialisation */
int tank_set(tank *t, const uint32_t *reference, size_t count, const double *value);
int tank_get(tank *t, const uint32_t *reference, size_t count, double *value);
int tank_step(tank *t, double time, double length);
int tank_reset(tank *t);
int tank_terminate(tank *t);
int tank_state_take(tank *t, void **state);
int tank_state_put(tank *t, void *state);
int tank_state_free(tank *t, void **state);
int tank_state_size(tank *t, void *state, size_t *size);
int tank_state_write(tank *t, void *state, void *bytes, size_t size);
int tank_state_read(tank *t, const void *bytes, size_t size, void **state);
/* Of outputs by inputs, along `seed`. */
int tank_derivative(tank *t, const uint32_t *unknown, size_t unknowns, const uint32_t *known,
                    size_t count, const double *seed, double *out);

/* All functions of the standard with NULL for the instance and for all else: no crash, an error
 * where a call needs them. */
void module_null(const module *m);

#endif
