/* SPDX-License-Identifier: BSD-3-Clause */
/** @file types.h  Handle, particle kinds, allocator and log callback shared by the other headers.
 *
 *  Vectors: arrays named `x[dim]` hold dim = 2 or 3 numbers a particle, packed, particle by particle. Vectors in
 *  structs always have room for three; in 2-D the third is ignored. SI units throughout. */
#ifndef MPS_TYPES_H
#define MPS_TYPES_H

#include <mps/export.h>
#include <mps/status.h>
#include <stddef.h>
#include <stdint.h>

/** One simulation. Different handles may be used from different threads at the same time, one handle from one at a time. */
typedef struct mps_sim mps_sim;

/** What a particle is. */
enum {
    MPS_FLUID = 0, /**< moves with the flow, carries mass */
    MPS_WALL = 1,  /**< on the wetted face of a solid; has its own pressure */
    MPS_DUMMY = 2  /**< behind the face; fills the kernel, takes its pressure from its wall particle */
};

/** Memory callbacks of a handle; both or neither are set. */
typedef struct mps_allocator {
    void *(*alloc)(void *user, size_t size);  /**< at least `size` bytes aligned as malloc does, or NULL */
    void (*release)(void *user, void *block); /**< gives back a block; NULL is never passed */
    void *user;                               /**< first argument of both */
} mps_allocator;

/** Weight of a log message. */
enum { MPS_LOG_INFO = 0, MPS_LOG_WARNING = 1 };

/** Receives messages; called in the thread that made the call. `text` lives until the callback returns. */
typedef void (*mps_log_fn)(void *user, int level, const char *text);

#endif
