/* SPDX-License-Identifier: BSD-3-Clause */
/* A copy of the state in memory. Arrays that did not change since the last copy are not copied
 * again. */
#ifndef MPS_CORE_SNAPSHOT_H
#define MPS_CORE_SNAPSHOT_H

#include "sim.h"
#include <mps/couple.h>

/* An array of all particles. */
typedef struct mps__copy {
    char name[MPS__NAME_SIZE];
    size_t bytes; /* per particle */
    char *data;
    int64_t capacity; /* particles */
} mps__copy;

/* Saved state of a probe. */
typedef struct mps__kept_series {
    mps__series own; /* owned by the snapshot */
    int64_t same;    /* number of leading samples that equal those of the probe */
    int64_t cuts;    /* `same` is valid while this equals the value of the probe's series */
} mps__kept_series;

struct mps_snapshot {
    mps_sim *sim; /* not owned */
    bool taken;
    mps__state state;
    mps__pose now;
    mps_motion_state hold;
    mps__posed posed;
    bool has_posed;
    mps_step_info info;
    mps__load load;
    mps__body_state body;
    int64_t n, known, next_id;
    int64_t generation, orders; /* of the store */
    bool linked, listed, written;
    int32_t geometry, occluders; /* solids and plates of the set-up */
    int32_t fields;
    mps__copy field[MPS__FIELDS_MAX];
    uint8_t *ghost; /* [known] */
    int64_t ghost_capacity;
    double *searched; /* [n*dim], valid if `listed` */
    int64_t searched_capacity;
    int32_t models;
    const mps_model_ops *model[MPS__MODELS_ACTIVE];
    mps__numbers numbers[MPS__MODELS_ACTIVE];
    int64_t probes, probe_capacity;
    mps__kept_series *series;
};

/* ---- snapshot_kept.c: samples of probes and numbers of models ---- */

/* Allocate for the present size of the simulation. On failure nothing changes. */
mps_status mps__kept_reserve(mps_snapshot *k);
void mps__kept_take(mps_snapshot *k);
/* Allocate in the simulation for the contents of the snapshot. */
mps_status mps__kept_return_reserve(mps_snapshot *k);
void mps__kept_return(mps_snapshot *k);
void mps__kept_free(mps_snapshot *k);

#endif
