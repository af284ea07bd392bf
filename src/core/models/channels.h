/* SPDX-License-Identifier: BSD-3-Clause */
/* Channels, the arrays that verbs of models read and write: those of the library and those of
 * models. */
#ifndef MPS_CORE_CHANNELS_H
#define MPS_CORE_CHANNELS_H

#include "particles.h"
#include <mps/model.h>

enum { MPS__CHANNELS = 64 };

/* Access modes that read values of neighbours. */
enum { MPS__USE_AROUND = MPS_USE_NEIGHBOURS | MPS_USE_DUMMIES | MPS_USE_ROWS };

/* Access of passes of the library: the previous values are dead, a new live range of the channel
 * begins. */
enum { MPS__USE_BEGIN = 1 << 16 };

/* Channels of the library, in the order of the list. Channels from MPS__PUBLIC_CHANNELS on are
 * internal to its passes. */
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
    MPS__SOLID_PLACE,
    MPS__SOLID_AREA,
    MPS__EQUATION_RADIUS,
    MPS__EQUATION_COMPLETE,
    MPS__EQUATION_BODY,
    MPS__EQUATION_WALL_FACTOR,
    MPS__EQUATION_GAIN,
    MPS__PUBLIC_CHANNELS,
    MPS__POSITION = MPS__PUBLIC_CHANNELS,
    MPS__POSITION_BEFORE,
    MPS__UNKNOWN_NUMBERS,
    MPS__UNKNOWN_PLACES,
    MPS__OWN_CHANNELS
};

/* Memory that holds the array of a channel. */
enum {
    /* arena of a step: channels with disjoint live ranges overlap */
    MPS__IN_ARENA,
    MPS__IN_FIELD /* field of the particles, or a scalar elsewhere: set for each step */
};

typedef struct mps__channel {
    mps_channel spec;       /* its name is a string of the model's table or of the library */
    uint32_t reads, writes; /* bits of the hooks that may read and write it */
    int32_t components;     /* numbers per particle; 0: scalar */
    int32_t users;          /* active models that use it */
    int32_t where;          /* MPS__IN_... */
    int32_t field;          /* of MPS__IN_FIELD: index of the field, found when the plan is made */
    int64_t offset;         /* of MPS__IN_ARENA: offset in bytes per particle; -1: unused */
    mps__array array;       /* array in this step; not used if a field has the values */
    double scalar;          /* value of a scalar of a model */
} mps__channel;

typedef struct mps__channels {
    mps__context *context;
    int32_t dim, count;
    mps__channel list[MPS__CHANNELS];
    int64_t stride; /* bytes of the arena per particle */
    size_t held;    /* bytes of the arena */
    char *arena;
} mps__channels;

void mps__channels_init(mps__channels *c, mps__context *context, int32_t dim);
void mps__channels_free(mps__channels *c);

/* Check the description of a channel of model `model`, active or not. */
mps_status mps__channel_check(mps__context *c, const char *model, const mps_channel *spec);
/* Add the channels of a model that is activated, or use the existing ones: all or none. `leaving`,
 * the model that it replaces or NULL, may have described them differently. */
mps_status mps__channels_bring(mps__channels *c, mps__particles *s, const mps_model_ops *ops,
                               const mps_model_ops *leaving);
/* Remove the channels that only the deactivated model uses. Fields of particles stay. */
void mps__channels_drop(mps__channels *c, const mps_model_ops *ops);
/* Index of a channel of the library, internal channels included. */
int32_t mps__channels_find_own(const char *name);
/* Index in the list, or -1. */
int32_t mps__channels_find(const mps__channels *c, const char *name);

/* Allocate the arena for n particles; set the arrays of its channels. */
mps_status mps__channels_reserve(mps__channels *c, int64_t n);
/* Whether channel k is a scalar. */
static inline bool mps__channel_is_scalar(const mps__channel *k)
{
    return k->spec.components == MPS_SCALAR;
}
/* Field of the particles that stores channel k, or NULL; from MPS__CHANNELS on k counts fields. */
mps__field *mps__channels_field(const mps__channels *c, mps__particles *s, int32_t k);
/* Store the field indices of all channels. */
void mps__channels_find_fields(mps__channels *c, mps__particles *s);
/* Bytes of channel k per particle. */
size_t mps__channel_element(const mps__channel *k);
/* Bytes per particle of channel k of the list, or of a field of the user. */
size_t mps__channels_bytes(const mps__channels *c, const mps__particles *s, int32_t k);
/* Array of channel k; of a field of the user for k >= MPS__CHANNELS; NULL for scalars and -1. */
mps__array *mps__channels_of(mps__channels *c, mps__particles *s, int32_t k);
/* This array, or the scalar, on the host; NULL for -1. */
void *mps__channels_array(const mps__channels *c, mps__particles *s, int32_t k);

#endif
