/* SPDX-License-Identifier: BSD-3-Clause */
/** @file types.h  Handle, particle kinds, allocator and log callback shared by the other headers.
 *
 *  Vectors: arrays named `x[dim]` hold dim = 2 or 3 numbers per particle, packed, particle by
 *  particle. Vectors in structs always have room for three; in 2-D the third is ignored. SI units
 *  throughout.
 *
 *  Structs: a struct that a program fills, or lets the library fill, begins with `struct_size`. Its
 *  function ..._init(&s, sizeof s) sets that and the defaults; call it first. Where all defaults
 *  are 0, {.struct_size = sizeof s} does the same. The library reads and writes no more than
 *  struct_size bytes, so a program that was compiled with older headers of the same major version
 *  works on. A size that no version had is refused with MPS_E_ARG, a newer struct that uses unknown
 *  entries with MPS_E_VERSION. Structs grow at their end only. */
#ifndef MPS_TYPES_H
#define MPS_TYPES_H

#include <mps/export.h>
#include <mps/status.h>
#include <stddef.h>
#include <stdint.h>

/** One simulation. Different handles may be used from different threads at the same time, one
 *  handle from one thread at a time. */
typedef struct mps_sim mps_sim;

/** What a particle is. */
enum {
    /** Moves with the flow, has mass. */
    MPS_FLUID = 0,
    /** On the wetted face of a solid; has its own pressure. */
    MPS_WALL = 1,
    /** Behind the face: completes the kernel, takes the pressure of its wall particle. */
    MPS_DUMMY = 2
};

/** Phases of the fluid. */
enum {
    /** So many at most, by their numbers from 0 on. */
    MPS_PHASES = 16
};

/** Memory callbacks of a handle; set both or neither. */
typedef struct mps_allocator {
    /** At least `size` bytes aligned as by malloc, or NULL. */
    void *(*alloc)(void *user, size_t size);
    /** Gives back a block; NULL is never passed. */
    void (*release)(void *user, void *block);
    /** First argument of both. */
    void *user;
} mps_allocator;

/** Weight of a log message. */
enum {
    /** For information. */
    MPS_LOG_INFO = 0,
    /** Results may be worse than expected. */
    MPS_LOG_WARNING = 1
};

/** Receives messages, in the thread that made the call. `text` is valid until the callback
 *  returns. */
typedef void (*mps_log_fn)(void *user, int level, const char *text);

#endif
