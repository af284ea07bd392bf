/* SPDX-License-Identifier: BSD-3-Clause */
/* Channels, the arrays that verbs of models read and write: the library's own and those
 * that models bring. */
#ifndef MPS_CORE_CHANNELS_H
#define MPS_CORE_CHANNELS_H

#include "particles.h"
#include <mps/model.h>

enum { MPS__CHANNELS = 64 };

/* Accesses that read values of neighbours. */
enum { MPS__USE_AROUND = MPS_USE_NEIGHBOURS | MPS_USE_DUMMIES | MPS_USE_ROWS };

/* Channels of the library, in the order of the list. */
enum {
    MPS__VELOCITY,
    MPS__PRESSURE,
    MPS__DENSITY,
    MPS__NUMBER_DENSITY,
    MPS__REGION,
    MPS__TANK_ACCELERATION,
    MPS__VOLUME_DEVIATION,
    MPS__ASYMMETRY,
    MPS__PRESSURE_DENSITY,
    MPS__ACCELERATION,
    MPS__DISPLACEMENT,
    MPS__PRESSURE_SOURCE,
    MPS__PRESSURE_SHIFT,
    MPS__PRESSURE_VALUE,
    MPS__PRESSURE_CONDITION,
    MPS__GAS_SHIFT,
    MPS__GAS_LAW,
    MPS__WALL_PRESSURE,
    MPS__OWN_CHANNELS
};

typedef struct mps__channel {
    mps_channel spec;       /* its name is that of the model's table, or the library's */
    uint32_t reads, writes; /* bits of the moments in which it may be read and written */
    int32_t components;     /* numbers per particle */
    int32_t users;          /* active models that bring it */
    bool stale;  /* owners have newer values than ghosts; of MPS_LIFE_PARTICLE: the field knows */
    void *array; /* where it is in this step; of MPS_LIFE_PARTICLE: NULL, the field has it */
} mps__channel;

typedef struct mps__channels {
    mps__context *context;
    int32_t dim, count;
    int64_t capacity; /* particles that the arrays of models have room for */
    mps__channel list[MPS__CHANNELS];
} mps__channels;

void mps__channels_init(mps__channels *c, mps__context *context, int32_t dim);
void mps__channels_free(mps__channels *c);

/* Check the description of a channel of model `model`, whatever is active. */
mps_status mps__channel_check(mps__context *c, const char *model, const mps_channel *spec);
/* A model that is switched on brings channels, or shares those that are there: all or none. The
 * model that it replaces, `leaving` or NULL, may have described them otherwise. */
mps_status mps__channels_bring(mps__channels *c, mps__particles *s, const mps_model_ops *ops,
                               const mps_model_ops *leaving);
/* A model that is switched off takes back what no other brings. Fields of particles stay. */
void mps__channels_drop(mps__channels *c, const mps_model_ops *ops);
/* Place in the list, or -1. */
int32_t mps__channels_find(const mps__channels *c, const char *name);

/* Room for the arrays of models. */
mps_status mps__channels_reserve(mps__channels *c, int64_t n);
/* Set rows begin .. end-1 of the arrays of models that live for a step to their first values. */
void mps__channels_begin(const mps__channels *c, int64_t begin, int64_t end);
/* Bytes of channel k for each particle. */
size_t mps__channel_element(const mps__channel *k);
/* The same of channel k of the list, or of a field of the user. */
size_t mps__channels_bytes(const mps__channels *c, const mps__particles *s, int32_t k);
/* Whether owners have newer values of channel k than ghosts, likewise. */
bool *mps__channels_stale(mps__channels *c, mps__particles *s, int32_t k);
/* The array of channel k; from MPS__CHANNELS on of a field of the user; NULL for -1. */
void *mps__channels_array(const mps__channels *c, mps__particles *s, int32_t k);

#endif
