/* SPDX-License-Identifier: BSD-3-Clause */
/** @file types.h  Handle, particle kinds, allocator and log callback shared by the other headers.
 *
 *  Vectors: arrays named `x[dim]` hold dim = 2 or 3 numbers per particle, packed, particle by
 *  particle. Vectors in structs always have three entries; in 2-D the third is ignored. SI units
 *  throughout.
 *
 *  Structs: a struct that a program or the library fills begins with `struct_size`. Its function
 *  ..._init(&s, sizeof s) sets struct_size and the defaults; call it first. If all defaults are 0,
 *  {.struct_size = sizeof s} is equivalent. The library reads and writes no more than struct_size
 *  bytes, so a program that was compiled with older headers of the same major version continues to
 *  work. A size of no version is refused with MPS_E_ARG, a newer struct that uses unknown entries
 *  with MPS_E_VERSION. Structs grow at their end only. */
#ifndef MPS_TYPES_H
#define MPS_TYPES_H

#include <mps/export.h>
#include <mps/status.h>
#include <stddef.h>
#include <stdint.h>

/** One simulation. Different handles may be used from different threads at the same time, one
 *  handle from one thread at a time. */
typedef struct mps_sim mps_sim;

/** Kind of a particle. */
enum {
    /** Moves with the flow, has mass. */
    MPS_FLUID = 0,
    /** On the wetted face of a solid; the pressure equation has a row for it. */
    MPS_WALL = 1,
    /** Behind the face: completes the kernel, has the pressure of its wall particle. */
    MPS_DUMMY = 2
};

/** Phases of the fluid. */
enum {
    /** Maximum number of phases; they are numbered from 0. */
    MPS_PHASES = 16
};

/** Memory callbacks of a handle; set both or neither. */
typedef struct mps_allocator {
    /** At least `size` bytes aligned as by malloc, or NULL. */
    void *(*alloc)(void *user, size_t size);
    /** Frees a block; NULL is never passed. */
    void (*release)(void *user, void *block);
    /** First argument of both. */
    void *user;
} mps_allocator;

/** Level of a log message. */
enum {
    /** For information. */
    MPS_LOG_INFO = 0,
    /** Results may be worse than expected. */
    MPS_LOG_WARNING = 1
};

/** Receives messages in the thread that called the library. `text` is valid until the callback
 *  returns. */
typedef void (*mps_log_fn)(void *user, int level, const char *text);

#endif
