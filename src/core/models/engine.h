/* SPDX-License-Identifier: BSD-3-Clause */
/* Where the arrays of a step are valid: on the host, or in the memory of an engine, which loops of calls may run on. This is the one place that
 * knows, and the one that copies. Without an engine all is on the host. On many ranks there is none. */
#ifndef MPS_CORE_ENGINE_H
#define MPS_CORE_ENGINE_H

#include "plan.h"

enum { MPS__ON_HOST, MPS__ON_ENGINE, MPS__PLACES };

/* Memory of its own. Only loops that run there follow its addresses. */
typedef struct mps__engine {
    void *(*room)(void *self, size_t bytes); /* NULL: there is none */
    void (*give)(void *self, void *room);    /* it goes back */
    void (*upload)(void *self, void *to, const void *from, size_t bytes);
    void (*download)(void *self, void *to, const void *from, size_t bytes);
    /* NULL, or: these values, numbers of 4 or 8 bytes, are not read any more; at either place */
    void (*outdated)(void *self, void *array, size_t bytes, size_t number);
    void *self;
} mps__engine;

/* The array of a channel or field that calls of the plan use. */
typedef struct mps__twin {
    void *data;            /* of the engine */
    size_t room;           /* its bytes */
    size_t bytes;          /* of the values; 0: no call uses it */
    size_t number;         /* bytes of a number */
    bool old[MPS__PLACES]; /* the other place has newer values */
} mps__twin;

typedef struct mps__twins {
    const mps__engine *engine; /* NULL: none */
    bool open;                 /* a step is in progress */
    mps__channels *channels;
    mps__particles *particles;
    mps__twin list[MPS__CHANNELS + MPS__FIELDS_MAX]; /* of channels, of fields */
} mps__twins;

/* Steps run on an engine from now on; NULL: on the host. Not during a step. */
void mps__twins_attach(mps__twins *t, const mps__engine *engine);
/* A step begins: room for what its calls use, all values are on the host. MPS_E_NOMEM */
mps_status mps__twins_open(mps__twins *t, const mps__plan *p);
/* It is over: all fields come to the host. */
void mps__twins_close(mps__twins *t);
/* Channels as mps__channels_array() counts them; those that are missing or scalars are on the host.
 * Make the values at a place the newest ones. */
void mps__twins_ready(mps__twins *t, int32_t channel, int32_t place);
/* The same of all fields on the host, for what looks at the particles outside of calls. */
void mps__twins_fields_ready(mps__twins *t);
/* The values at a place have changed. */
void mps__twins_written(mps__twins *t, int32_t channel, int32_t place);
/* The array at a place. */
void *mps__twins_array(mps__twins *t, int32_t channel, int32_t place);

#endif
