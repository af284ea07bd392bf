/* SPDX-License-Identifier: BSD-3-Clause */
/* Small tanks in which the kit of models runs a model. */
#ifndef MODEL_SCENES_H
#define MODEL_SCENES_H

#include "model_kit.h"
#include <mps/mps.h>
#include <stdbool.h>

/* The model under test and the scene it runs in. */
typedef struct kit_case {
    const mps_model_ops *ops;
    kit_prepare_fn prepare;
    void *user;
    const char *preset;
    int32_t dim;
    int32_t threads;
    bool reverse;                   /* add the fluid in the reverse order */
    bool without;                   /* do not switch the model on */
    bool nonlinear;                 /* use the solver of nonlinear rows */
    const char *key;                /* NULL, or a setting */
    double value;                   /* of it */
    const mps_allocator *allocator; /* NULL: malloc */
    const mps_ranks_ops *ranks;     /* NULL, or the engine of this rank */
} kit_case;

enum { KIT_SCENES = 6 };

/* Scene number k of a model. */
kit_case kit_scene(const mps_model_ops *ops, kit_prepare_fn prepare, void *user, int k);

/* Build a scene. @param sim out, NULL after a failure without a handle */
mps_status kit_open(const kit_case *scene, mps_sim **sim);

/* Switch the model of a scene on and prepare it. */
mps_status kit_switch_on(const kit_case *scene, mps_sim *sim);

/* Steps; the first failure ends them. */
mps_status kit_steps(mps_sim *sim, int steps);

/* Columns of a state that contain one field. */
typedef struct kit_field {
    char name[32];
    int32_t first, components;
    bool own; /* of a model, not of the library */
} kit_field;

enum { KIT_FIELDS = 48 };

/* State of all fields, ordered by id. */
typedef struct kit_state {
    int64_t n;
    int32_t stride, fields;
    kit_field field[KIT_FIELDS];
    int64_t *id;
    double *data; /* [n*stride], fields one after the other in a row */
} kit_state;

/* @return false: no memory */
bool kit_state_get(mps_sim *sim, kit_state *state);
void kit_state_free(kit_state *state);
bool kit_state_finite(const kit_state *state);
bool kit_state_same(const kit_state *a, const kit_state *b);

/* Print a failure of a check on stderr. @return bit */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
int kit_print(const mps_model_ops *ops, int bit, const char *format, ...);

/* Name of a hook, e.g. "MPS_FORCE". */
const char *kit_hook(int32_t hook);

/* Print the result of all checks: on stdout if none failed, else their names on stderr.
 * @param scene  [count] scenes that accept the model
 * @param acted  [verbs of the model] whether the verb changed something in one of them */
void kit_summary(const mps_model_ops *ops, int failed, int count, const kit_case *scene,
                 const bool acted[]);

/* Run the model in a scene and check each call of each verb.
 * @param acted  [verbs of the model] true is written for verbs that change something
 * @return sum of KIT_... that failed */
int kit_watch(const kit_case *scene, bool acted[]);

/* Run the model in a scene on one rank and on two, which are threads, and compare all fields.
 * @return KIT_RANKS if it failed, else 0 */
int kit_compare_ranks(const kit_case *scene, int steps);

#endif
