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

/* Access of passes of the library: the values before are dead, another life of the channel begins. */
enum { MPS__USE_BEGIN = 1 << 16 };

/* Channels of the library, in the order of the list. Those from MPS__PUBLIC_CHANNELS on are for its own passes. */
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

/* Where the array of a channel is. */
enum {
    MPS__IN_ARENA, /* memory of a step, of which channels that do not live at the same time share parts */
    MPS__IN_FIELD /* a field of the particles, or a number elsewhere: set for each step */
};

typedef struct mps__channel {
    mps_channel spec;       /* its name is that of the model's table, or the library's */
    uint32_t reads, writes; /* bits of the hooks in which it may be read and written */
    int32_t components;     /* numbers per particle; 0: a scalar */
    int32_t users;          /* active models that bring it */
    int32_t where;          /* MPS__IN_... */
    int32_t field;          /* of MPS__IN_FIELD: its number, found when a plan is made */
    int64_t offset;         /* of MPS__IN_ARENA: bytes a particle before it; -1: no call uses it */
    bool stale;    /* owners have newer values than ghosts; of MPS_LIFE_PARTICLE: the field knows */
    void *array;   /* where it is in this step; of MPS_LIFE_PARTICLE: NULL, the field has it */
    double scalar; /* value of a scalar that a model brings */
} mps__channel;

typedef struct mps__channels {
    mps__context *context;
    int32_t dim, count;
    mps__channel list[MPS__CHANNELS];
    int64_t stride; /* bytes of the arena a particle */
    size_t held;    /* bytes of the arena */
    char *arena;
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
/* Place of a channel of the library, also of those for its passes only. */
int32_t mps__channels_find_own(const char *name);
/* Place in the list, or -1. */
int32_t mps__channels_find(const mps__channels *c, const char *name);

/* Room in the arena for n particles; sets the arrays of the channels in it. */
mps_status mps__channels_reserve(mps__channels *c, int64_t n);
/* Whether channel k of the list is a number for all particles. */
static inline bool mps__channel_is_scalar(const mps__channel *k)
{
    return k->spec.components == MPS_SCALAR;
}
/* The field of the particles that channel k is, or NULL; from MPS__CHANNELS on a field by its number. */
mps__field *mps__channels_field(const mps__channels *c, mps__particles *s, int32_t k);
/* Note the fields of all channels, so that they are found without a search. */
void mps__channels_find_fields(mps__channels *c, mps__particles *s);
/* Bytes of channel k for each particle. */
size_t mps__channel_element(const mps__channel *k);
/* The same of channel k of the list, or of a field of the user. */
size_t mps__channels_bytes(const mps__channels *c, const mps__particles *s, int32_t k);
/* Whether owners have newer values of channel k than ghosts, likewise. */
bool *mps__channels_stale(mps__channels *c, mps__particles *s, int32_t k);
/* The array of channel k; from MPS__CHANNELS on of a field of the user; NULL for -1. */
void *mps__channels_array(const mps__channels *c, mps__particles *s, int32_t k);

#endif
