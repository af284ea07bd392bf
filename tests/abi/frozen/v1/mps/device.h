/* SPDX-License-Identifier: BSD-3-Clause */
/** @file device.h  Plug-in interface of a device: an accelerator with its own memory, which runs
 *  the loops of a time step.
 *
 *  A device allocates memory and runs loops; this interface knows no particles. The library tracks
 *  in which memory space the values of an array are valid, and copies only stale arrays. A loop has
 *  a name and gets its arguments by value: numbers and device addresses. The same row functions are
 *  compiled for host and devices. Therefore a step on a device has bitwise the results of a step on
 *  the host, if doubles of the device follow IEEE 754 without fused operations.
 *
 *  The thread that calls the library makes all calls; they take effect in order. Calls may be
 *  asynchronous; download, values and wait return after all previous calls are complete. Functions
 *  that return int return 0, or non-zero if the device failed: then the step fails with
 *  MPS_E_PLUGIN and the text of `failure`. */
#ifndef MPS_DEVICE_H
#define MPS_DEVICE_H

#include <mps/exact.h>
#include <mps/stage.h>
#include <mps/types.h>

MPS_BEGIN_DECLS

/** Version of this interface, for mps_device_ops.api. */
#define MPS_DEVICE_API 1u

/** One loop over rows 0..n-1. The struct and its host memory are valid during the call only: an
 *  asynchronous device copies them. */
typedef struct mps_launch {
    /** sizeof(mps_launch) of the library */
    uint32_t struct_size;
    /** 2 or 3: a loop is compiled for both. */
    int32_t dim;
    /** Rows, > 0. */
    int64_t n;
    /** Name of the source file of the loop, without folders, e.g. "moments_bounded.c". */
    const char *file;
    /** Name of the loop in its file, e.g. "invert_rows". */
    const char *name;
    /** View for row functions of models, in host memory. Its array pointers are device addresses,
     *  except `near.host` and `near.parallel`, which no row function dereferences. NULL: the loop
     *  has no view. */
    const mps_view *view;
    /** [bytes] numbers and device addresses, in host memory */
    const void *fields;
    /** Bytes of the fields. */
    uint64_t bytes;
    /** Number of sums. If `maxima` is 0 too, the rows write arrays only. */
    int32_t sums;
    /** Number of maxima. */
    int32_t maxima;
    /** The loop compiled for the host, rows begin..end-1, for devices whose memory the host can
     *  access: adds terms to sums [sums], raises maxima [maxima].
     *  @param host  mps_launch.host */
    void (*run)(const void *host, int64_t begin, int64_t end, mps_exact *sums, double *maxima);
    /** First argument of `run`. */
    const void *host;
    /** NULL, or a number in device memory. If it is not 0 when the loop starts, the results of the
     *  loop are not needed: a device may cancel the launch. */
    const int64_t *cancel;
    /** NULL, or [n] mask bytes in device memory: rows whose byte is not 0 are skipped. Their terms
     *  are 0, and they raise no maximum. `run` applies the mask itself. Only loops with a view have
     *  a mask. */
    const uint8_t *mask;
} mps_launch;

/** A device. A function is required unless its comment allows NULL. */
typedef struct mps_device_ops {
    /** sizeof(mps_device_ops) */
    uint32_t struct_size;
    /** MPS_DEVICE_API */
    uint32_t api;
    /** e.g. "cuda" */
    const char *name;
    /** First argument of all functions. Owned by the caller of mps_sim_device_set(); it must remain
     *  valid until the device is detached or the handle destroyed. */
    void *self;
    /** Allocate `bytes` > 0 of device memory, aligned to 256 bytes; values are undefined. The
     *  library adds offsets to the address and dereferences it on the device only.
     *  @return NULL: out of memory */
    void *(*alloc)(void *self, uint64_t bytes);
    /** Free memory of `alloc`. */
    void (*free)(void *self, void *block);
    /** Copy from host to device. `from` may change after the call. */
    int (*upload)(void *self, void *to, const void *from, uint64_t bytes);
    /** Copy from device to host, after all previous calls are complete. */
    int (*download)(void *self, void *to, const void *from, uint64_t bytes);
    /** Set device memory to 0. */
    int (*clear)(void *self, void *to, uint64_t bytes);
    /** Copy on the device; the ranges do not overlap. */
    int (*copy)(void *self, void *to, const void *from, uint64_t bytes);
    /** Run a loop. A row writes its own entries of arrays only, or adds integers to entries of
     *  other rows by atomic operations. */
    int (*launch)(void *self, const mps_launch *launch);
    /** Synchronous reduction: run the loop and wait for its sums and maxima. Partial sums are
     *  combined by mps_exact_join(), in any order. Maxima ignore NaN. A launch that fails leaves
     *  both arrays unchanged: combine them with the results only when all results are available.
     *  @param sum  [launch->sums] in and out: terms are added
     *  @param maximum  [launch->maxima] in and out: raised */
    int (*reduce)(void *self, const mps_launch *launch, mps_exact *sum, double *maximum);
    /** Asynchronous reduction: run the loop, write its sums and then its maxima to device memory,
     *  and do not wait. Sums begin at 0, maxima at -INFINITY.
     *  @param to  [launch->sums] of mps_exact, then [launch->maxima] of double */
    int (*reduce_async)(void *self, const mps_launch *launch, void *to);
    /** Wait until all previous calls are complete. */
    int (*wait)(void *self);
    /** Reason of the last failure, one line. NULL: unknown. */
    const char *(*failure)(void *self);
    /** NULL, or for tests: the library has invalidated these values of `number` bytes each and does
     *  not read them again. The array is in device or host memory. */
    void (*invalidated)(void *self, void *array, uint64_t bytes, uint32_t number);
    /** NULL, or open the device: called by mps_sim_device_set() before all other functions.
     *  Non-zero: refused, with the text of `failure`. */
    int (*begin)(void *self);
    /** NULL, or close the device: called once if `begin` succeeded, when another device is set,
     *  when the handle is destroyed, or on many ranks when mps_sim_device_set() fails because the
     *  device of another rank failed. */
    void (*end)(void *self);
    /** 1: it runs loops of plug-ins too. 0: it has the loops of the library only, so that models,
     *  solvers and preconditioners of plug-ins run on the host; default 0 */
    int32_t plugin_loops;
    /** Kept 0. */
    int32_t reserved;
} mps_device_ops;

/** Counters of a device: of the last successful step and of field downloads since then. */
typedef struct mps_device_info {
    /** Set by mps_device_info_init(), or sizeof(mps_device_info). */
    uint32_t struct_size;
    /** Passes of the step and verbs of models that ran on the host, fully or partly. */
    int32_t host_calls;
    /** Name of the device; NULL: the handle has none. */
    const char *name;
    /** Loops, clears and copies on the device; a loop with sums or maxima counts once. */
    int64_t launches;
    /** Synchronisations of the host with the device: downloads, sums and maxima. */
    int64_t waits;
    /** Copies from host to device. */
    int64_t uploads;
    /** Copies from device to host. */
    int64_t downloads;
    /** Bytes of all copies from host to device. */
    int64_t bytes_up;
    /** Bytes of all copies from device to host, with sums and maxima. */
    int64_t bytes_down;
    /** Device memory in use [bytes]. */
    int64_t bytes_held;
} mps_device_info;

/** Run the steps of this handle on a device from now on; NULL: on the host. A pass of the step
 *  without loops for devices runs on the host, with copies of the arrays that it reads and writes;
 *  the log names it once. Verbs of plug-ins run on the device if mps_verb.device and
 *  mps_device_ops.plugin_loops are 1, otherwise on the host. With a kernel of the user,
 *  mps_kernel_custom(), the whole step runs on the host. Results are bitwise the same on host and
 *  device.
 *
 *  After a step the fields of the particles remain on the device. A lease, a probe, a frame or a
 *  checkpoint downloads the fields that it needs and waits for them. If the device fails in this
 *  download, the call returns MPS_E_PLUGIN and may be repeated. If it fails permanently in a step,
 *  fields that were valid on the device only are lost: steps, this function and all functions that
 *  need fields return MPS_E_PLUGIN with the time of the state, until mps_checkpoint_read() or
 *  mps_snapshot_restore() replaces the state.
 *
 *  Functions that change numbers only, e.g. mps_motion_pose_set() or mps_model_set(), copy no
 *  field. A lease for writing, mps_phase_set() with another density and a motion that begins at
 *  another pose copy the field that they change; after them the budgets of the next step need
 *  positions and velocities too.
 *
 *  On many ranks the call is collective: every rank has its own device, or no rank has one. If the
 *  call fails on one rank, it fails on all ranks, and all ranks run on the host. Neighbours are
 *  searched on the host. Solvers and preconditioners with `device` (<mps/ppe.h>) solve the pressure
 *  equation on the devices: `sundials.pcg` with `auxgrid`, `jacobi` or no preconditioner, and
 *  plug-ins if mps_device_ops.plugin_loops is 1. All others run on the host.
 *  @return MPS_E_ARG (which entry, and what is allowed; some ranks have a device, others none),
 *  MPS_E_BUSY (a lease is open), MPS_E_NOMEM, MPS_E_PLUGIN (the device does not open, or the fields
 *  cannot be downloaded from the previous device), MPS_E_RANKS; on one rank the handle is unchanged
 *  then */
MPS_API mps_status mps_sim_device_set(mps_sim *sim, const mps_device_ops *ops);

/** Set struct_size and zero. @param size  sizeof(mps_device_info) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_device_info_init(mps_device_info *info, size_t size);

/** Counters of the device in the last step; zeros without a device or a step.
 *  @param info  initialised by mps_device_info_init(); out @return MPS_E_ARG, MPS_E_BUSY */
MPS_API mps_status mps_sim_device_info(const mps_sim *sim, mps_device_info *info);

MPS_END_DECLS

#endif
