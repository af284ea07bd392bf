/* SPDX-License-Identifier: BSD-3-Clause */
/* Calls of a device: what they cost is counted, the first that fails is kept. Loops that are given its parallel-for run there. */
#ifndef MPS_CORE_DEVICE_H
#define MPS_CORE_DEVICE_H

#include "base.h"
#include <mps/device.h>

/* Blocks of mps__device_allocator() at a time. */
enum { MPS__DEVICE_BLOCKS = 128 };

/* Memory there that grows and is kept. */
typedef struct mps__device_block {
    void *data;
    size_t bytes;
} mps__device_block;

typedef struct mps__device {
    mps__context *context;
    mps_device_ops ops;    /* name NULL: there is none */
    mps_device_info info;  /* of the step in progress */
    mps_parallel parallel; /* while calls run on the device */
    const int64_t *unless; /* of launches from now on; NULL: each of them runs */
    bool failed;   /* a call has: no loop or copy is asked of the device until the next step */
    char why[301]; /* text of that failure */
    struct {
        void *room;
        size_t bytes;
    } block[MPS__DEVICE_BLOCKS];
} mps__device;

void mps__device_init(mps__device *d, mps__context *context);
/* Check the table of a device, open it and take it over. */
mps_status mps__device_set(mps__device *d, const mps_device_ops *ops);
/* It is not needed any more. */
void mps__device_end(mps__device *d);
/* Whether there is one. */
static inline bool mps__device_there(const mps__device *d)
{
    return d->ops.name != NULL;
}
/* Counts begin again, a failure is forgotten. */
void mps__device_begin(mps__device *d);
/* What loops need could not be made ready, as the error text says: the step fails. */
void mps__device_give_up(mps__device *d);
/* MPS_E_PLUGIN if a call has failed since. */
mps_status mps__device_status(const mps__device *d);

/* Memory; NULL with the error text set: there is none. */
void *mps__device_room(mps__device *d, size_t bytes);
void mps__device_give(mps__device *d, void *room, size_t bytes);
/* Room for so many bytes; what it held is gone if there were fewer. NULL as above, and the room is empty. */
void *mps__device_fit(mps__device *d, mps__device_block *room, size_t bytes);
void mps__device_leave(mps__device *d, mps__device_block *room);
/* The same as an allocator, which knows the bytes of its few blocks. */
mps_allocator mps__device_allocator(mps__device *d);
void mps__device_upload(mps__device *d, void *to, const void *from, size_t bytes);
void mps__device_download(mps__device *d, void *to, const void *from, size_t bytes);
void mps__device_clear(mps__device *d, void *to, size_t bytes);
void mps__device_copy(mps__device *d, void *to, const void *from, size_t bytes);
/* Until all work that was asked for is done. */
void mps__device_wait(mps__device *d);
/* These values, numbers of 1, 4 or 8 bytes, are not read any more, at either place. */
void mps__device_outdate(mps__device *d, void *array, size_t bytes, size_t number);
/* Rows, sums and maxima of a launch whose struct_size and file are set here; none if n is 0. */
void mps__device_launch(mps__device *d, mps_launch *launch, mps_exact *sums, double *maxima);
/* The same without waiting: sums, then maxima, go to memory there. */
void mps__device_gather(mps__device *d, mps_launch *launch, void *to);

/* The device whose parallel-for this is; NULL: loops run on the host. */
mps__device *mps__device_of(const mps_parallel *p);

#endif
