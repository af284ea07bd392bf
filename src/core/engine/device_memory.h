/* SPDX-License-Identifier: BSD-3-Clause */
/* Fields, channels and neighbour lists have mirrors in device memory (array.h). These functions
 * determine when they are copied, and which address a loop gets. Other arrays are transferred where
 * they are used: the pressure equation (ppe_device.c, solvers_device.c), pressure data, halos
 * (ghosts_device.c), results of reductions (deferred.c, reaction.c), rigid bodies, voids, grids of
 * auxgrid. Without a device everything is on the host. */
#ifndef MPS_CORE_DEVICE_MEMORY_H
#define MPS_CORE_DEVICE_MEMORY_H

#include "device.h"
#include "ghosts.h"
#include "plan.h"
#include <mps/stage.h>

/* Arrays of a step that are neither channels nor fields: neighbour lists, pairs hidden by thin
 * plates, rotated wetted areas. */
enum {
    MPS__ROWS_BEGIN,
    MPS__ROWS_MIDDLE,
    MPS__ROWS_END,
    MPS__ROWS_COUNT,
    MPS__ROWS_COLUMNS,
    MPS__IDLE_ROWS,
    MPS__NEAR_PLATE_SLOTS,
    MPS__NEAR_DUMMIES,
    MPS__SEARCHED, /* positions of the particles at the last search */
    MPS__LASTING,  /* blocks before it persist until the next search, others for a step */
    MPS__NEAR_BEGIN = MPS__LASTING,
    MPS__NEAR_COLUMNS,
    MPS__NEAR_WEIGHTS,
    MPS__ROTATED_AREAS,
    MPS__OCCLUDER_LIST,
    MPS__NEAR_PLATE_LIST,
    MPS__BLOCKS
};

typedef struct mps__memory {
    mps__device device;
    mps_device_info last; /* device counters of the last step */
    bool step;            /* a step is in progress */
    bool open;            /* loops may run on the device */
    int64_t listed;       /* search whose lists are mirrored; -1: none */
    bool torn;            /* the host's lists are incomplete or not of the last search */
    /* not empty: the state was only on the device and is lost; the error text */
    char lost[MPS__ERROR_SIZE];
    int32_t space;                         /* memory space where loops run now */
    mps_parallel *parallel, host_parallel; /* of the handle; its host value */
    mps__channels *channels;
    mps__particles *particles;
    mps__array block[MPS__BLOCKS];
    mps__array scratch[MPS__SCRATCH]; /* of verbs */
    mps__array order;                 /* of a permutation */
    mps__array results;               /* sums and maxima not yet copied to the host */
    mps__array constants;             /* settings of models, viscosities, surface tensions */
    double *constant;                 /* their values at the last copy */
    int64_t logged;                   /* mps__models.changes at the last log message; -1: never */
    /* the same counter for the log message about the pressure equation */
    int64_t logged_solution;
} mps__memory;

void mps__memory_init(mps__memory *t, mps__channels *c, mps__particles *s, mps_parallel *parallel);
/* Run steps on a device from now on; NULL: on the host. Not allowed during a step. */
mps_status mps__memory_attach(mps__memory *t, const mps_device_ops *ops);
/* Release all device memory; all data is on the host. */
void mps__memory_free(mps__memory *t);
/* Begin a step and reset its counters. */
void mps__memory_begin(mps__memory *t);
/* Run loops on the device until mps__memory_exit(), before the calls of a step: fields and the
 * lists of the last search are available. MPS_E_NOMEM */
mps_status mps__memory_enter(mps__memory *t);
/* MPS_E_PLUGIN: a loop has failed. */
mps_status mps__memory_exit(mps__memory *t);
/* Begin the calls of a step: allocate all fields and the channels that the calls use. Fields
 * unchanged since the previous step are already on the device. MPS_E_NOMEM, MPS_E_PLUGIN */
mps_status mps__memory_open(mps__memory *t, const mps__plan *p);
/* Register the array of a block for this step; `values`: the host array is initialised. No effect
 * without a step on a device. */
mps_status mps__memory_block(mps__memory *t, int32_t block, void *host, int64_t count,
                             size_t number, bool values);
/* Device of the step in progress, or NULL. */
static inline mps__device *mps__memory_device(mps__memory *t)
{
    return t->open ? &t->device : NULL;
}
/* End the step, also after a failure. Fields and neighbour lists stay in their memory space.
 * MPS_E_PLUGIN: the device failed during the step. */
mps_status mps__memory_close(mps__memory *t);

/* ---- fields and lists between steps: device_memory_fields.c ---- */

/* Whether the device of the current step has all fields, or will get them from the host: loops may
 * run on it. */
bool mps__memory_on_device(const mps__memory *t);
/* Copy stale data to the host: all fields; one field; the candidates of the last search, in the
 * particle order of any later step; the positions of that search. MPS_E_PLUGIN: the copy failed,
 * the host data is invalid. Outside of a step the call may be repeated. */
mps_status mps__memory_fetch(mps__memory *t);
mps_status mps__memory_fetch_field(mps__memory *t, int32_t field);
mps_status mps__memory_fetch_lists(mps__memory *t);
mps_status mps__memory_fetch_searched(mps__memory *t);
/* All fields have new values on the host: discard the device values, also lost ones. */
void mps__memory_forget(mps__memory *t);
/* MPS_E_PLUGIN: a device failure lost the state. */
mps_status mps__memory_alive(const mps__memory *t);
/* After a failed step fields were restored on the device. MPS_E_PLUGIN: the restore on the
 * device failed and the state is lost; `time`: time of the state. */
mps_status mps__memory_restored(mps__memory *t, double time);
/* Permute the device fields by `order` [n] into spare buffers; `on_device`: NULL, or the order
 * on the device. The fields themselves do not change yet. `moved` [fields]: those permuted here;
 * `stale` [fields]: those that the host must not permute, as the device alone has them.
 * MPS_E_NOMEM, MPS_E_PLUGIN */
mps_status mps__memory_permute(mps__memory *t, const int32_t *order, const int32_t *on_device,
                               bool *moved, bool *stale);
/* The host particles were permuted: use the spare buffers. */
void mps__memory_permuted(mps__memory *t, const bool *moved);
/* Invalidate the mirrors of the lists. */
void mps__memory_rows_drop(mps__memory *t);
/* Invalidate them after a device failure: the host may lack candidates then. */
void mps__memory_rows_lose(mps__memory *t);

/* ---- where loops run ---- */

/* Set the memory space where loops run; always the host outside of a step. @return the previous
 * one */
int32_t mps__memory_set_space(mps__memory *t, int32_t space);
/* Address of a field for loops in the current memory space that read it, with its newest values;
 * for loops that write all values that are read afterwards. */
void *mps__memory_read(mps__memory *t, int32_t field);
void *mps__memory_write(mps__memory *t, int32_t field);
/* Address of a block; `host`: its array on the host, which is returned if the block is not mirrored
 * in this step. `all`: the loops write all values that are read afterwards. */
void *mps__memory_list_seen(mps__memory *t, int32_t block, const void *host);
void *mps__memory_list_given(mps__memory *t, int32_t block, void *host, bool all);
/* Set the arrays of a view to the current memory space; the second function also those of
 * constants. */
void mps__memory_view(mps__memory *t, mps_view *v);
void mps__memory_loop_view(mps__memory *t, int32_t model, mps_view *v);
/* An mps__results on the device. */
static inline void *mps__memory_results(const mps__memory *t)
{
    return t->results.mirror.data;
}
/* Zeroed block of device scratch for a verb. NULL: out of memory. */
void *mps__memory_scratch(mps__memory *t, int32_t block, size_t bytes);
/* Block of device scratch that persists until the next verb, not initialised. */
void *mps__memory_workspace(mps__memory *t, int32_t block, size_t bytes);

/* ---- values ---- */

/* Channel indices as in mps__channels_array(); missing channels and scalars are on the host. Make
 * the values in a memory space valid. */
void mps__memory_sync(mps__memory *t, int32_t channel, int32_t space);
/* Copy the exact rows of the last search to the host, in a step; the near rows made from them are
 * not copied. */
void mps__memory_sync_rows(mps__memory *t);
/* Copy to the host all fields, for code that reads particles outside of calls; the lists that calls
 * wrote. */
void mps__memory_sync_fields(mps__memory *t);
void mps__memory_sync_lists(mps__memory *t);
/* Values in a memory space changed: invalidate the other copy. */
void mps__memory_written(mps__memory *t, int32_t channel, int32_t space);
/* Array for the halo exchange of a channel or field: in the memory space with its newest values.
 * Ghost values are about to change. */
mps__halo_array mps__memory_halo(mps__memory *t, int32_t channel);
mps__halo_array mps__memory_halo_field(mps__memory *t, int32_t field);
/* Array in a memory space. */
void *mps__memory_array(mps__memory *t, int32_t channel, int32_t space);

#endif
