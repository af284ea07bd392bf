/* SPDX-License-Identifier: BSD-3-Clause */
/** @file device.h  Plug-in interface of a device: an accelerator with memory of its own, on which
 *  the loops of a time step run.
 *
 *  A device has memory and runs loops; this interface has no particles. The library records where
 *  the values of an array are valid, and copies only what is not. A loop has a name and gets its
 *  arguments by value: numbers and addresses of the device. Scripts of the library compile the same
 *  row functions for host and devices. So results have the bytes of a step on the host, on any
 *  device whose doubles follow IEEE 754 without fused operations.
 *
 *  Calls come from the thread that calls the library, and take effect in their order. A device may
 *  return before the work of a call is done; download, values and wait return after the work of all
 *  calls before them. Functions that return int return 0, or non-zero when the device failed: then
 *  the step fails with MPS_E_PLUGIN and the text of `failure`. */
#ifndef MPS_DEVICE_H
#define MPS_DEVICE_H

#include <mps/exact.h>
#include <mps/stage.h>
#include <mps/types.h>

MPS_BEGIN_DECLS

/** Version of this interface, for mps_device_ops.api. */
#define MPS_DEVICE_API 1u

/** One loop over rows 0..n-1. The struct and what it points to are valid during the call only: a
 *  device that returns early copies them. */
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
    /** What row functions of models see, in memory of the host. Its arrays are those of the
     *  device, but for `near.host` and `near.parallel`, which no row follows. NULL: the loop takes
     *  none. */
    const mps_view *view;
    /** [bytes] numbers and addresses of the device, in memory of the host */
    const void *fields;
    /** Bytes of the fields. */
    uint64_t bytes;
    /** Sums of the rows. With `maxima` 0 too: the rows write arrays only. */
    int32_t sums;
    /** Maxima of the rows. */
    int32_t maxima;
    /** The loop compiled for the host, rows begin..end-1, for devices whose addresses the host can
     *  follow: adds terms to sums [sums], raises maxima [maxima].
     *  @param host  that of this struct */
    void (*run)(const void *host, int64_t begin, int64_t end, mps_exact *sums, double *maxima);
    /** First argument of `run`. */
    const void *host;
    /** NULL, or a number of the device. If it is not 0 when the rows are about to run, nothing
     *  reads any more what they would write: a device may leave them out. */
    const int64_t *unless;
    /** NULL, or [n] bytes of the device: rows whose byte is not 0 are left out. Their terms are 0,
     *  and they raise no maximum. `run` knows them. Only loops with a view have it. */
    const uint8_t *skip;
} mps_launch;

/** A device. A function must not be NULL unless its comment allows it. */
typedef struct mps_device_ops {
    /** sizeof(mps_device_ops) */
    uint32_t struct_size;
    /** MPS_DEVICE_API */
    uint32_t api;
    /** e.g. "cuda" */
    const char *name;
    /** First argument of all functions. Belongs to the caller of mps_sim_device_set(), and must
     *  live until the device is detached or the handle destroyed. */
    void *self;
    /** Memory of the device for `bytes` > 0, aligned to 256 bytes; values are not defined. The
     *  library adds offsets to the address and follows it on the device only.
     *  @return NULL: out of memory */
    void *(*room)(void *self, uint64_t bytes);
    /** Free memory of `room`. */
    void (*give)(void *self, void *room);
    /** Copy from the host. `from` may change after the call. */
    int (*upload)(void *self, void *to, const void *from, uint64_t bytes);
    /** Copy to the host, after the work of all calls before. */
    int (*download)(void *self, void *to, const void *from, uint64_t bytes);
    /** Set bytes of the device to 0. */
    int (*clear)(void *self, void *to, uint64_t bytes);
    /** Copy on the device; the two do not overlap. */
    int (*copy)(void *self, void *to, const void *from, uint64_t bytes);
    /** Run a loop whose rows write arrays of their own row only, or add integers to numbers of
     *  others by atomic operations. */
    int (*rows)(void *self, const mps_launch *launch);
    /** Run sums and maxima, and wait for them. The sums of any parts of the rows are joined by
     *  mps_exact_join(), in any order. A NaN does not count as maximum.
     *  A launch that fails leaves both as they were: what they hold is joined with the results once
     *  all of these are there.
     *  @param sum  [launch->sums] terms are added to what they hold before
     *  @param maximum  [launch->maxima] not below what they hold before */
    int (*values)(void *self, const mps_launch *launch, mps_exact *sum, double *maximum);
    /** Run sums and maxima and do not wait for them. Those of the rows alone, nothing before, go to
     *  memory of the device: the sums, then the maxima, -INFINITY where there is none.
     *  @param to  [launch->sums] of mps_exact, then [launch->maxima] of double */
    int (*gather)(void *self, const mps_launch *launch, void *to);
    /** Wait for the work of all calls before. */
    int (*wait)(void *self);
    /** Why a function failed, one line. NULL: not known. */
    const char *(*failure)(void *self);
    /** NULL, or for tests: these values, `number` bytes each, are not read any more. The array is
     *  one of the device or of the host. */
    void (*outdated)(void *self, void *array, uint64_t bytes, uint32_t number);
    /** NULL, or called by mps_sim_device_set() before all others: the device opens. Non-zero
     *  refuses, with the text of `failure`. */
    int (*begin)(void *self);
    /** NULL, or called once when the library no longer uses a device that it has opened: another
     *  one was set, the handle is destroyed, or on many ranks mps_sim_device_set() fails because
     *  that of another rank does. Not where it fails here. */
    void (*end)(void *self);
} mps_device_ops;

/** What a device did in the last step that succeeded, and which fields have come since. */
typedef struct mps_device_info {
    /** Set by mps_device_info_init(), or sizeof(mps_device_info). */
    uint32_t struct_size;
    /** Calls of the step, passes and verbs of models, that ran on the host, wholly or in part. */
    int32_t host_calls;
    /** Name of the device; NULL: the handle has none. */
    const char *name;
    /** Loops, clears and copies on the device; a loop with sums or maxima counts once. */
    int64_t launches;
    /** Times that the host waited for the device: downloads, sums and maxima. */
    int64_t waits;
    /** Copies from the host. */
    int64_t uploads;
    /** Copies to the host. */
    int64_t downloads;
    /** Bytes of all copies from the host. */
    int64_t bytes_up;
    /** Bytes of all copies to the host, with sums and maxima. */
    int64_t bytes_down;
    /** Bytes of the device that are in use. */
    int64_t bytes_held;
} mps_device_info;

/** Run the steps of this handle on a device from now on; NULL: on the host. A call of the step
 *  without loops for devices runs on the host, with copies of the arrays that it reads and writes;
 *  the log names it once. Verbs of models outside the library always run on the host, and so does
 *  the whole step with a kernel function of the user, mps_kernel_custom(). Results have the same
 *  bytes either way.
 *
 *  After a step the fields of the particles stay on the device; what asks for some of them, as a
 *  lease, a probe, a frame or a checkpoint does, waits for these. If the device fails then, that
 *  call returns MPS_E_PLUGIN and may be repeated. If it fails in a step for good, fields that it
 *  had alone are lost: steps and all that needs fields return MPS_E_PLUGIN with the time of the
 *  state, this function too, until mps_checkpoint_read() or mps_snapshot_restore() brings another.
 *
 *  Functions that change numbers, as mps_motion_pose_set() or mps_model_set() do, copy no field. A
 *  lease for writing, mps_phase_set() with another density and a motion that begins elsewhere copy
 *  the field that they change; the budgets of the next step need positions and velocities then.
 *
 *  On many ranks a call of all ranks together: each has a device of its own, or none has one.
 *  Where one fails all fail, and all run on the host then. A search of neighbours is done on the
 *  hosts. The pressure equation is solved on the devices by `sundials.pcg` with `auxgrid`, `jacobi`
 *  or no preconditioner, by all other solvers on the hosts.
 *  @return MPS_E_ARG (which entry, and what is allowed; some ranks have a device, others none),
 *  MPS_E_BUSY (a lease is open), MPS_E_NOMEM, MPS_E_PLUGIN (the device does not open, or the one
 *  before does not give the fields), MPS_E_RANKS; alone the handle is as before */
MPS_API mps_status mps_sim_device_set(mps_sim *sim, const mps_device_ops *ops);

/** Set struct_size and zero. @param size  sizeof(mps_device_info) @return MPS_E_ARG: bad size */
MPS_API mps_status mps_device_info_init(mps_device_info *info, size_t size);

/** What the device did in the last step; zeros without a device or a step.
 *  @param info  initialised by mps_device_info_init(); out @return MPS_E_ARG, MPS_E_BUSY */
MPS_API mps_status mps_sim_device_info(const mps_sim *sim, mps_device_info *info);

MPS_END_DECLS

#endif
