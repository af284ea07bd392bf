/* SPDX-License-Identifier: BSD-3-Clause */
/* Calls of a device: their costs are counted, the first failure is kept. Loops that get its
 * parallel-for run on the device. */
#ifndef MPS_CORE_DEVICE_H
#define MPS_CORE_DEVICE_H

#include "base.h"
#include <mps/device.h>

/* Maximum number of live blocks of mps__device.memory. */
enum { MPS__DEVICE_BLOCKS = 128 };

/* Device buffer that grows and is reused. */
typedef struct mps__device_block {
    void *data;
    size_t bytes;
} mps__device_block;

typedef struct mps__device {
    mps__context *context;
    mps_device_ops ops;    /* name NULL: no device */
    mps_device_info info;  /* of the step in progress */
    mps_parallel parallel; /* while calls run on the device */
    mps_allocator memory;  /* device memory, with the sizes of its few blocks */
    /* of further launches: the device cancels them while it points to a non-zero number; NULL: all
     * run */
    const int64_t *cancel;
    bool failed;   /* a call failed: no loops or copies until the next step */
    char why[301]; /* error text of that failure */
    struct {
        void *data;
        size_t bytes;
    } block[MPS__DEVICE_BLOCKS];
} mps__device;

void mps__device_init(mps__device *d, mps__context *context);
/* Check the table of a device, open the device and store the table. */
mps_status mps__device_set(mps__device *d, const mps_device_ops *ops);
/* Close the device. */
void mps__device_end(mps__device *d);
/* Whether a device is attached. */
static inline bool mps__device_present(const mps__device *d)
{
    return d->ops.name != NULL;
}
/* Reset the counters and the failure. */
void mps__device_begin(mps__device *d);
/* Preparations for loops failed, the error text is set: the step fails. */
void mps__device_fail(mps__device *d);
/* MPS_E_PLUGIN if a call failed since mps__device_begin(). */
mps_status mps__device_status(const mps__device *d);

/* Allocate device memory; NULL with the error text set: out of memory. */
void *mps__device_alloc(mps__device *d, size_t bytes);
void mps__device_free(mps__device *d, void *block, size_t bytes);
/* Resize a buffer to at least `bytes`; its values are lost if it grows. On failure NULL, and the
 * buffer is empty. */
void *mps__device_fit(mps__device *d, mps__device_block *block, size_t bytes);
void mps__device_release(mps__device *d, mps__device_block *block);
void mps__device_upload(mps__device *d, void *to, const void *from, size_t bytes);
void mps__device_download(mps__device *d, void *to, const void *from, size_t bytes);
void mps__device_clear(mps__device *d, void *to, size_t bytes);
void mps__device_copy(mps__device *d, void *to, const void *from, size_t bytes);
/* Wait until all submitted work is complete. */
void mps__device_wait(mps__device *d);
/* Invalidate values of 1, 4 or 8 bytes: they are not read any more, in either memory space. */
void mps__device_invalidate(mps__device *d, void *array, size_t bytes, size_t number);
/* Launch rows, sums and maxima. This function sets struct_size and file of the launch; n may be
 * 0. */
void mps__device_launch(mps__device *d, mps_launch *launch, mps_exact *sums, double *maxima);
/* Launch without waiting: sums, then maxima, are written to device memory. */
void mps__device_reduce_async(mps__device *d, mps_launch *launch, void *to);

/* Device of this parallel-for; NULL: loops run on the host. */
mps__device *mps__device_of(const mps_parallel *p);

#endif
