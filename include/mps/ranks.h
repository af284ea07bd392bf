/* SPDX-License-Identifier: BSD-3-Clause */
/** @file ranks.h  Plug-in interface of an engine that runs one simulation on many ranks.
 *
 *  A rank is one of several processes, each with a handle of its own. All ranks make the same calls
 *  of the library with the same arguments, and together hold one simulation. A rank owns the
 *  particles of one part of space. It also has ghosts: copies of the particles of other ranks
 *  within reach of its own. An engine knows ranks, parts of space and messages, and no particles.
 *  Results do not depend on the number of ranks, nor on where the parts of space are cut.
 *
 *  All ranks call the same functions of their engines in the same order. Functions that return int
 *  return 0, or non-zero when a message, memory or a rank failed: then the run ends on all ranks.
 *  The library calls an engine from the thread that called the library. */
#ifndef MPS_RANKS_H
#define MPS_RANKS_H

#include <mps/types.h>

MPS_BEGIN_DECLS

/** Version of this interface, for mps_ranks_ops.api. */
#define MPS_RANKS_API 1u

/** Which ranks exchange how many elements, in a fixed pattern. */
typedef struct mps_route {
    /** Ranks that this one sends to. */
    int32_t to_count;
    /** Ranks that this one receives from. */
    int32_t from_count;
    /** [to_count] their numbers, ascending, never the own one */
    const int32_t *to;
    /** [to_count] elements for each of them */
    const int64_t *sent;
    /** [from_count] likewise */
    const int32_t *from;
    /** [from_count] elements from each of them */
    const int64_t *received;
    /** Private to the engine. */
    void *data;
} mps_route;

/** Combine two values: into = into + from, or the larger one, ... The result must not depend on the
 *  order in which values are combined. */
typedef void (*mps_combine_fn)(void *into, const void *from);

/** An engine of ranks. */
typedef struct mps_ranks_ops {
    /** sizeof(mps_ranks_ops) */
    uint32_t struct_size;
    /** MPS_RANKS_API */
    uint32_t api;
    /** e.g. "mpi.zoltan" */
    const char *name;
    /** New state in *self, which holds `user` before. Non-zero: it failed.
     *  @param text  [size] out: why it failed; empty: out of memory */
    int (*create)(const mps_allocator *allocator, void **self, char *text, size_t size);
    /** Gives back what create made. All ranks call it, also after a failure. */
    void (*destroy)(const mps_allocator *allocator, void *self);
    /** Number of this rank, from 0, and of all ranks. */
    void (*place)(void *self, int32_t *rank, int32_t *ranks);
    /** Cut space anew, so that all ranks own about the same weight.
     *  @param n  places of this rank @param x  [n*dim] @param weight  [n] > 0 */
    int (*partition)(void *self, int32_t dim, int64_t n, const double *x, const float *weight);
    /** Ranks that own places: a function of the place and the last partition, the same on all
     *  ranks. Not collective. @param x  [n*dim] @param rank  [n] out */
    int (*owner)(void *self, int64_t n, const double *x, int32_t *rank);
    /** Ranks that own a place in a box, ascending. Not collective.
     *  @param lo  [dim] @param hi  [dim] @param rank  [ranks] out @param count  out */
    int (*overlap)(void *self, const double *lo, const double *hi, int32_t *rank, int32_t *count);
    /** Make a route: this rank says what it sends, and learns what it receives.
     *  @param to  [count] ascending, not the own rank @param sent  [count] elements, > 0
     *  @param route  out; empty after a failure */
    int (*connect)(void *self, int32_t count, const int32_t *to, const int64_t *sent,
                   mps_route *route);
    /** Free a route. Not collective. */
    void (*disconnect)(void *self, mps_route *route);
    /** Begin to exchange elements along a route. Both arrays stay as they are until the end.
     *  @param bytes  of an element @param out  elements for route->to[0], then for to[1], ...
     *  @param in  likewise, from route->from */
    int (*exchange_begin)(void *self, const mps_route *route, size_t bytes, const void *out,
                          void *in);
    /** Wait for the exchange that was begun last. */
    int (*exchange_end)(void *self, const mps_route *route);
    /** Combine values of all ranks; all get the same bytes.
     *  @param count  elements @param bytes  of an element @param values  [count] in and out */
    int (*reduce)(void *self, int32_t count, size_t bytes, void *values, mps_combine_fn combine);
    /** Collect blocks of all ranks in the order of the ranks.
     *  @param own  block of this rank @param bytes  [ranks] of each block @param all  out */
    int (*gather)(void *self, const void *own, const int64_t *bytes, void *all);
    /** This rank fails, perhaps while others wait for it: their calls end with non-zero, and so do
     *  all later ones on every rank. No array of an exchange is used any more. Not collective. */
    void (*fail)(void *self, const char *text);
    /** Text of the rank that failed first, the same on all ranks; NULL: none failed. */
    const char *(*failure)(void *self);
    /** What *self holds when create is called. */
    void *user;
} mps_ranks_ops;

/** Run this handle on the ranks of an engine. Call it once, on all ranks, before particles, solids,
 *  probes or steps. With one rank in all it changes nothing.
 *
 *  What the program builds before the first step is built alike on all ranks; each rank then keeps
 *  its own. Tanks, solids and fills come before the first step; mps_particles_add() and _remove()
 *  may come later, alike on all ranks. Motions and limits must be functions of the time and of
 *  what all ranks get alike.
 *
 *  Leases and stencils hold the owned particles and the ghosts of this rank, which
 *  mps_particles_ghosts() tells apart: a sum must leave out ghosts. When a function has succeeded
 *  that steps or measures, ghosts have the bytes of their owners in all fields. A lease sends no
 *  message: any rank may lease alone, also in a monitor. Values that are written count at owned
 *  particles only; ghosts get them in the next step or measurement. Particles that were added have
 *  no ghosts until then.
 *  @return MPS_E_ARG (which entry, and what is allowed), MPS_E_STATE (too late), MPS_E_VERSION,
 *  MPS_E_PLUGIN (why the engine does not begin), MPS_E_NOMEM, MPS_E_BUSY */
MPS_API mps_status mps_sim_ranks_set(mps_sim *sim, const mps_ranks_ops *ops);

/** Number of this rank and of all ranks; 0 and 1 without an engine. @return MPS_E_ARG */
MPS_API mps_status mps_sim_ranks(const mps_sim *sim, int32_t *rank, int32_t *ranks);

/** Which particles are copies of particles of other ranks. The array is valid until the next step.
 *  @param ghost  out: [n] 1 for a ghost; NULL: no particle is one @return MPS_E_ARG, MPS_E_BUSY */
MPS_API mps_status mps_particles_ghosts(const mps_sim *sim, const uint8_t **ghost);

/** Put the particles of all ranks into the store of rank 0, in the order that they would have on
 *  one rank, for output: leases and mps_frames_write() of rank 0 then see all of them, those of
 *  other ranks see none. All ranks make this call and mps_particles_gather_end(); between the two
 *  the handle may only be read. On one rank it changes nothing.
 *  @return MPS_E_BUSY (a lease is open), MPS_E_STATE (gathered already), MPS_E_NOMEM,
 *          MPS_E_RANKS */
MPS_API mps_status mps_particles_gather(mps_sim *sim);

/** Put back the particles that each rank had. @return MPS_E_BUSY (a lease is open), MPS_E_STATE */
MPS_API mps_status mps_particles_gather_end(mps_sim *sim);

MPS_END_DECLS

#endif
