/* SPDX-License-Identifier: BSD-3-Clause */
/* An array on the host with a mirror in device memory. Each change of its values is a new version;
 * a permutation of all fields is none. A memory space, and the ghosts of other ranks, are valid
 * while they have the newest version. */
#ifndef MPS_CORE_ARRAY_H
#define MPS_CORE_ARRAY_H

#include "device.h"
#include "parallel.h"

/* Memory spaces. */
enum { MPS__ON_HOST, MPS__ON_DEVICE, MPS__SPACES, MPS__NOWHERE = -1 };

typedef struct mps__array {
    void *host;
    mps__device *device;             /* of the mirror; NULL: there has been none */
    mps__device_block mirror;        /* its memory */
    mps__device_block spare;         /* the values before a step, or in another order */
    size_t bytes;                    /* of the values; 0: the mirror is not in use */
    size_t number;                   /* bytes of a number */
    int64_t version;                 /* of the newest values */
    int64_t version_in[MPS__SPACES]; /* version in each memory space */
    int64_t ghosts;                  /* version in which ghosts have the values of their owners */
    int32_t kept_in;       /* memory space of a copy for mps__array_restore(), or MPS__NOWHERE */
    void *kept;            /* memory of such a copy on the host */
    int64_t kept_capacity; /* its bytes */
} mps__array;

/* ---- what an array knows ---- */

static inline bool mps__array_valid(const mps__array *a, int32_t space)
{
    return a->version_in[space] == a->version || (space == MPS__ON_HOST && a->bytes == 0);
}

static inline bool mps__array_ghosts_valid(const mps__array *a)
{
    return a->ghosts == a->version;
}

/* ---- values ---- */

/* Copy the newest values to a memory space that does not have them. If the copy fails the device
 * notes it, and the space stays invalid. */
void mps__array_copy(mps__array *a, int32_t space);
/* A memory space has new values, the other one becomes invalid. Ghosts that were valid stay valid;
 * mps__array_ghosts_set() says otherwise. */
void mps__array_written(mps__array *a, int32_t space);
/* mps__array_written(), but the older values of the other memory space are still read. */
void mps__array_advanced(mps__array *a, int32_t space);
/* The values of a memory space are not read any more, without new ones in the other. */
void mps__array_invalidate(mps__array *a, int32_t space);
/* Ghosts have the values of their owners, or not. */
static inline void mps__array_ghosts_set(mps__array *a, bool valid)
{
    a->ghosts = valid ? a->version : -1;
}

/* ---- memory of the mirror ---- */

/* Use the mirror for `bytes` bytes of the host's values. MPS_E_NOMEM */
mps_status mps__array_fit(mps__array *a, mps__device *d, size_t bytes, size_t number);
/* Release it. */
void mps__array_release(mps__array *a);
/* Exchange mirror and spare memory, which has the newest values. */
void mps__array_exchange(mps__array *a);

/* ---- a step that may fail ---- */

/* Copy `bytes` bytes, in the memory space that has the newest values. MPS_E_NOMEM, MPS_E_PLUGIN */
mps_status mps__array_keep(mps__array *a, mps__context *c, const mps_parallel *p, size_t bytes);
/* Restore this copy, if there is one. */
void mps__array_restore(mps__array *a, size_t bytes);

#endif
