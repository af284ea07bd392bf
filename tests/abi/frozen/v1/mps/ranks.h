/* SPDX-License-Identifier: BSD-3-Clause */
/** @file ranks.h  Plug-in interface of a communication engine, which runs one simulation on many
 *  ranks.
 *
 *  A rank is one of several processes, each with its own handle. All ranks make the same calls of
 *  the library with the same arguments, and together run one simulation. A rank owns the particles
 *  of one subdomain. It also has ghosts: copies of the particles of other ranks within reach of its
 *  own. An engine handles ranks, subdomains and messages; it knows no particles. Results depend
 *  neither on the number of ranks nor on the partition.
 *
 *  All ranks call the same functions of their engines in the same order. Functions that return int
 *  return 0, or non-zero if a message, an allocation or a rank failed: then the run ends on all
 *  ranks. The library calls an engine from the thread that called the library. */
#ifndef MPS_RANKS_H
#define MPS_RANKS_H

#include <mps/types.h>

MPS_BEGIN_DECLS

/** Version of this interface, for mps_ranks_ops.api. */
#define MPS_RANKS_API 1u

/** A fixed communication pattern: the number of elements that pairs of ranks exchange. */
typedef struct mps_route {
    /** Number of ranks to which this rank sends. */
    int32_t to_count;
    /** Number of ranks from which this rank receives. */
    int32_t from_count;
    /** [to_count] numbers of the receiving ranks, ascending, without this rank */
    const int32_t *to;
    /** [to_count] number of elements for each of them */
    const int64_t *sent;
    /** [from_count] numbers of the sending ranks, ascending, without this rank */
    const int32_t *from;
    /** [from_count] number of elements from each of them */
    const int64_t *received;
    /** Private to the engine. */
    void *data;
} mps_route;

/** Combine two values, e.g. into = into + from, or the maximum. The result must not depend on the
 *  order in which values are combined. */
typedef void (*mps_combine_fn)(void *into, const void *from);

/** A communication engine. */
typedef struct mps_ranks_ops {
    /** sizeof(mps_ranks_ops) */
    uint32_t struct_size;
    /** MPS_RANKS_API */
    uint32_t api;
    /** e.g. "mpi.zoltan" */
    const char *name;
    /** Create a state in *self; on entry *self is `user`. Non-zero: failed.
     *  @param text  [size] out: the reason of the failure; empty: out of memory */
    int (*create)(const mps_allocator *allocator, void **self, char *text, size_t size);
    /** Frees the state of create. All ranks call it, also after a failure. */
    void (*destroy)(const mps_allocator *allocator, void *self);
    /** Number of this rank, from 0, and number of ranks. */
    void (*place)(void *self, int32_t *rank, int32_t *ranks);
    /** Repartition space, so that all ranks own about the same weight.
     *  @param n  number of positions of this rank @param x  [n*dim] @param weight  [n] > 0 */
    int (*partition)(void *self, int32_t dim, int64_t n, const double *x, const float *weight);
    /** Owner ranks of positions: a function of the position and the last partition, the same on all
     *  ranks. Not collective. @param x  [n*dim] @param rank  [n] out */
    int (*owner)(void *self, int64_t n, const double *x, int32_t *rank);
    /** Ranks whose subdomain overlaps a box, ascending. Not collective.
     *  @param lo  [dim] @param hi  [dim] @param rank  [ranks] out @param count  out */
    int (*overlap)(void *self, const double *lo, const double *hi, int32_t *rank, int32_t *count);
    /** Create a route from the number of elements that this rank sends to others; the engine
     *  determines the number that it receives.
     *  @param to  [count] ascending, without this rank @param sent  [count] elements, > 0
     *  @param route  out; empty after a failure */
    int (*connect)(void *self, int32_t count, const int32_t *to, const int64_t *sent,
                   mps_route *route);
    /** Free a route. Not collective. */
    void (*disconnect)(void *self, mps_route *route);
    /** Begin a halo exchange along a route. Both arrays must remain unchanged until exchange_end().
     *  @param bytes  of an element @param out  elements for route->to[0], then for to[1], ...
     *  @param in  elements from route->from[0], then from from[1], ... */
    int (*exchange_begin)(void *self, const mps_route *route, size_t bytes, const void *out,
                          void *in);
    /** Wait for the last exchange_begin(). */
    int (*exchange_end)(void *self, const mps_route *route);
    /** Allreduce: combine values of all ranks; all ranks get the same bytes.
     *  @param count  elements @param bytes  of an element @param values  [count] in and out */
    int (*reduce)(void *self, int32_t count, size_t bytes, void *values, mps_combine_fn combine);
    /** Allgather: collect blocks of all ranks in the order of the ranks.
     *  @param own  block of this rank @param bytes  [ranks] of each block @param all  out */
    int (*gather)(void *self, const void *own, const int64_t *bytes, void *all);
    /** Report that this rank has failed, possibly while others wait for it: their calls return
     *  non-zero, and so do all later calls on every rank. No array of an exchange is accessed any
     *  more. Not collective. */
    void (*fail)(void *self, const char *text);
    /** Text of the rank that failed first, the same on all ranks; NULL: no rank failed. */
    const char *(*failure)(void *self);
    /** Value of *self on entry to create. */
    void *user;
} mps_ranks_ops;

/** Run this handle on the ranks of an engine. Call it once, on all ranks, before particles, solids,
 *  probes or steps. On one rank it has no effect.
 *
 *  Before the first step the program builds the same simulation on all ranks; each rank then keeps
 *  its own particles. Add tanks, solids and fills before the first step. mps_particles_add() and
 *  _remove() may be called later, with the same arguments on all ranks. Motions and limits must be
 *  functions of the time and of values that are equal on all ranks.
 *
 *  Leases and stencils contain the owned particles and the ghosts of this rank;
 *  mps_particles_ghosts() distinguishes them. A sum must omit ghosts. After a successful step or
 *  measurement all fields of ghosts are equal to those of their owners. A lease sends no message
 *  and is not collective, also in a monitor. Written values take effect at owned particles only;
 *  ghosts receive them in the next step or measurement. Added particles have no ghosts until then.
 *  @return MPS_E_ARG (which entry, and what is allowed), MPS_E_STATE (called too late),
 *  MPS_E_VERSION, MPS_E_PLUGIN (reason of the engine), MPS_E_NOMEM, MPS_E_BUSY */
MPS_API mps_status mps_sim_ranks_set(mps_sim *sim, const mps_ranks_ops *ops);

/** Number of this rank and number of ranks; 0 and 1 without an engine. @return MPS_E_ARG */
MPS_API mps_status mps_sim_ranks(const mps_sim *sim, int32_t *rank, int32_t *ranks);

/** Flags of ghosts, copies of particles of other ranks. The array is valid until the next step.
 *  @param ghost  out: [n] 1 for a ghost; NULL: no ghosts @return MPS_E_ARG, MPS_E_BUSY */
MPS_API mps_status mps_particles_ghosts(const mps_sim *sim, const uint8_t **ghost);

/** Collect the particles of all ranks on rank 0 for output, in the order that they have on one
 *  rank: leases and mps_frames_write() then have all particles on rank 0, and none on other ranks.
 *  All ranks make this call and mps_particles_collect_end(); between the two the handle may only be
 *  read. On one rank it has no effect.
 *  @return MPS_E_BUSY (a lease is open), MPS_E_STATE (already collected), MPS_E_NOMEM,
 *          MPS_E_RANKS */
MPS_API mps_status mps_particles_collect(mps_sim *sim);

/** Restore the particles of each rank. @return MPS_E_BUSY (a lease is open), MPS_E_STATE */
MPS_API mps_status mps_particles_collect_end(mps_sim *sim);

MPS_END_DECLS

#endif
