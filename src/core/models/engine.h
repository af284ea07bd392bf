/* SPDX-License-Identifier: BSD-3-Clause */
/* Where fields, channels and lists of neighbours are valid: on the host, or in the memory of a
 * device, which loops of calls may run on. Only these functions know, and copy them. Other arrays
 * are copied where they are used: the pressure equation (ppe_device.c, solvers_device.c), levels,
 * halos (ghosts_there.c), results of reductions (later.c, reaction.c), bodies, voids, grids of
 * auxgrid. Without a device all is on the host. */
#ifndef MPS_CORE_ENGINE_H
#define MPS_CORE_ENGINE_H

#include "device.h"
#include "ghosts.h"
#include "plan.h"
#include <mps/stage.h>

enum { MPS__ON_HOST, MPS__ON_DEVICE, MPS__PLACES };

/* Arrays of a step that are neither channels nor fields: lists of neighbours, what thin plates hide, wetted areas that have turned. */
enum {
    MPS__ROWS_BEGIN,
    MPS__ROWS_MIDDLE,
    MPS__ROWS_END,
    MPS__ROWS_COUNT,
    MPS__ROWS_COLUMNS,
    MPS__IDLE_ROWS,
    MPS__SEER_SLOTS,
    MPS__RIM_ROWS,
    MPS__SEARCHED, /* places of the particles then */
    MPS__LASTING,  /* those before it stay until the next search; the others live for a step */
    MPS__NEAR_BEGIN = MPS__LASTING,
    MPS__NEAR_COLUMNS,
    MPS__NEAR_WEIGHTS,
    MPS__TURNED_AREAS,
    MPS__SCREEN_LIST,
    MPS__SEER_LIST,
    MPS__BLOCKS
};

/* An array at two places. */
typedef struct mps__twin {
    int64_t field;           /* mps__field.serial, of fields */
    void *host;              /* NULL: that of a channel, which may move */
    void *data;              /* of the device */
    size_t room;             /* its bytes */
    size_t bytes;            /* of the values; 0: not in this step */
    size_t number;           /* bytes of a number */
    bool old[MPS__PLACES];   /* the other place has newer values */
    mps__device_block spare; /* of fields: values of before the step, or of another order */
} mps__twin;

typedef struct mps__twins {
    mps__device device;
    mps_device_info last; /* what the device did in the last step */
    bool step;            /* a step has begun, */
    bool open;            /* and loops may run on the device */
    int64_t listed;       /* the search whose lists have twins; -1: none */
    bool torn;            /* the host's lists are not those of the last search, or half of them */
    int64_t changes; /* those of the particles when a step ended; fields have their twins since */
    char gone
        [MPS__ERROR_SIZE]; /* not empty: why there is no state any more, as it was at the device alone */
    int32_t place;         /* of loops now */
    mps_parallel *parallel, host_parallel; /* of the handle; what it is on the host */
    mps__channels *channels;
    mps__particles *particles;
    mps__twin list[MPS__CHANNELS + MPS__FIELDS_MAX]; /* of channels, of fields */
    mps__twin block[MPS__BLOCKS];
    mps__twin scratch[MPS__SCRATCH]; /* of verbs */
    mps__twin order;                 /* of a permutation */
    mps__twin results;               /* sums and maxima that the host has not seen yet */
    mps__twin constants;             /* settings of models, viscosities, tensions, */
    double *constant;                /* as they were copied last */
    int64_t told;                    /* mps__models.changes when the log was told; -1: never */
    int64_t told_solution;           /* the same of the pressure equation */
} mps__twins;

void mps__twins_init(mps__twins *t, mps__channels *c, mps__particles *s, mps_parallel *parallel);
/* Steps run on a device from now on; NULL: on the host. Not during a step. */
mps_status mps__twins_attach(mps__twins *t, const mps_device_ops *ops);
/* Everything is on the host again, and nothing is held. */
void mps__twins_free(mps__twins *t);
/* A step begins, and its counts. */
void mps__twins_begin(mps__twins *t);
/* Loops run on the device until mps__twins_leave(), before there are calls: they see fields and the lists of the last search. MPS_E_NOMEM */
mps_status mps__twins_enter(mps__twins *t);
/* MPS_E_PLUGIN: a loop has failed. */
mps_status mps__twins_leave(mps__twins *t);
/* Its calls begin: room for all fields and for what its calls use. Fields that nothing has changed since the step before are on the device. MPS_E_NOMEM,
 * MPS_E_PLUGIN */
mps_status mps__twins_open(mps__twins *t, const mps__plan *p);
/* The array of a block in this step; `values`: it has some, on the host. Without a step on a device nothing is done. */
mps_status mps__twins_block(mps__twins *t, int32_t block, void *host, int64_t count, size_t number,
                            bool values);
/* The device of the step in progress; NULL: there is none. */
static inline mps__device *mps__twins_device(mps__twins *t)
{
    return t->open ? &t->device : NULL;
}
/* It is over, wherever it has ended. Fields and the lists of a search stay where they are. MPS_E_PLUGIN: the device has failed in it. */
mps_status mps__twins_close(mps__twins *t);

/* ---- fields and lists between steps: engine_fields.c ---- */

/* Whether the device of a step has all fields, or is going to get those that the host has: loops of a step that begins may run there. */
bool mps__twins_there(const mps__twins *t);
/* All fields are on the host, or one of them; the candidates of the last search, in the rows of any step since; the places of that search. They come now if they are newer at the device. MPS_E_PLUGIN: they do
 * not; what the host has must not be read. Outside of a step they may be asked for again. */
mps_status mps__twins_fetch(mps__twins *t);
mps_status mps__twins_fetch_field(mps__twins *t, const void *array);
mps_status mps__twins_fetch_lists(mps__twins *t);
mps_status mps__twins_fetch_searched(mps__twins *t);
/* The host has changed a field that it had. */
void mps__twins_changed(mps__twins *t, const void *array);
/* The host has changed this field alone; `changes`: those of the particles before. */
void mps__twins_changed_alone(mps__twins *t, const void *array, int64_t changes);
/* All fields have other values on the host: those that the device has, or has lost, are not wanted any more. */
void mps__twins_forget(mps__twins *t);
/* MPS_E_PLUGIN: the state was lost with a device. */
mps_status mps__twins_alive(const mps__twins *t);
/* Keep a field at the device for mps__twins_restore(), where the device has it alone; else `kept` is false. MPS_E_NOMEM, MPS_E_PLUGIN */
mps_status mps__twins_keep(mps__twins *t, int32_t field, bool *kept);
/* After a failed step: the field is as it was kept; if it was not, as the host has it now. */
void mps__twins_restore(mps__twins *t, int32_t field, bool kept);
/* All are. MPS_E_PLUGIN: not those at the device, so there is no state any more; `time`: that of the state. */
mps_status mps__twins_restored(mps__twins *t, double time);
/* Particles get an order, [n]; `there`: NULL, or the order at the device. What it has of the fields is made ready for it, and nothing has changed
 * yet. MPS_E_NOMEM, MPS_E_PLUGIN */
mps_status mps__twins_permute(mps__twins *t, const int32_t *order, const int32_t *there);
/* The particles of the host were put into it; `changes`: those of the particles before. */
void mps__twins_permuted(mps__twins *t, int64_t changes);
/* Fields that the host has no values of, [fields]. */
void mps__twins_old(mps__twins *t, bool *old);
/* Twins of the lists are those of no search any more. */
void mps__twins_rows_drop(mps__twins *t);
/* The same because the device has failed: the host may lack candidates then. */
void mps__twins_rows_lose(mps__twins *t);

/* ---- where loops run ---- */

/* Loops run at a place from now on; on the host unless a step is in progress. @return where they ran before */
int32_t mps__twins_go(mps__twins *t, int32_t place);
/* Address of an array of a field or block for loops at the present place, with its newest values; others as they are. */
void *mps__twins_seen(mps__twins *t, const void *array);
/* The same for loops that write it. `all`: they write all that is read afterwards. */
void *mps__twins_given(mps__twins *t, void *array, bool all);
/* Arrays of a view, likewise; with those of constants where loops see it. */
void mps__twins_view(mps__twins *t, mps_view *v);
void mps__twins_loop_view(mps__twins *t, int32_t model, mps_view *v);
/* An mps__results at the device. */
static inline void *mps__twins_results(const mps__twins *t)
{
    return t->results.data;
}
/* Block of scratch for a verb at the device, zeroed. NULL: no memory. */
void *mps__twins_scratch(mps__twins *t, int32_t block, size_t bytes);
/* The same not zeroed, for what lives until the next verb. */
void *mps__twins_room(mps__twins *t, int32_t block, size_t bytes);

/* ---- values ---- */

/* Channels as mps__channels_array() counts them; those that are missing or scalars are on the host.
 * Make the values at a place the newest ones. */
void mps__twins_ready(mps__twins *t, int32_t channel, int32_t place);
/* Exact rows of the last search on the host, in a step; without the near rows that are made from them. */
void mps__twins_rows_ready(mps__twins *t);
/* The same of all fields on the host, for what looks at the particles outside of calls; of the lists that calls wrote. */
void mps__twins_fields_ready(mps__twins *t);
void mps__twins_lists_ready(mps__twins *t);
/* The values at a place have changed. */
void mps__twins_written(mps__twins *t, int32_t channel, int32_t place);
/* What ghosts get of a channel, or of a field: the array at the place that has its newest values, where theirs are about to change. */
mps__shared mps__twins_shared(mps__twins *t, int32_t channel);
mps__shared mps__twins_shared_field(mps__twins *t, int32_t field);
/* The array at a place. */
void *mps__twins_array(mps__twins *t, int32_t channel, int32_t place);

#endif
