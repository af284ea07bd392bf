/* SPDX-License-Identifier: BSD-3-Clause */
/* Copies of the arrays that a verb may write, and runs of the verb on them; for the kit of
 * models. */
#ifndef MODEL_COPIES_H
#define MODEL_COPIES_H

#include "model_scenes.h"

enum { KIT_USES = 24 };

/* A channel as its model describes it. */
typedef struct kit_shape {
    char name[32];
    int32_t type;
    size_t element; /* bytes per particle; of a scalar, in all */
    bool is_scalar; /* one number for all particles */
} kit_shape;

/* What a verb may write: the arrays of its uses, and an entry of the stage. */
typedef struct kit_arrays {
    void *of[KIT_USES];
    double dt_limit;
    double *state; /* [states] numbers of the model: mps_stage_state() */
    int64_t states;
} kit_arrays;

/* Take the shapes of all channels from a handle; one list for all. */
void kit_learn_shapes(const mps_sim *sim);

/* Bytes of an array of n particles. */
size_t kit_bytes(const kit_shape *k, int64_t n);

/* @return NULL: no such channel */
const kit_shape *kit_shape_of(const mps_use *use);

/* @param from  source of the copy, or NULL: the arrays of the stage @return false: no memory; call
 *              kit_release() in any case */
bool kit_copy(const mps_stage *s, const mps_verb *verb, const kit_arrays *from, kit_arrays *a);
void kit_release(kit_arrays *a);

/* Run the model's verb on other arrays; nothing of the stage changes. @return of the verb */
int kit_run_on(const mps_stage *s, const mps_verb *verb, kit_arrays *a);

/* Whether the stage has the values of the copy. */
bool kit_same(const mps_stage *s, const mps_verb *verb, const kit_arrays *a);

#endif
