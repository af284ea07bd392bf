/* SPDX-License-Identifier: BSD-3-Clause */
/* Scenes on two ranks, threads of this program, each with its own device. */
#ifndef DEVICE_RANKS_H
#define DEVICE_RANKS_H

#include "opencl.h"

typedef struct ranks_run {
    const char *scene;
    opencl *device[2];
    mps_status status[2];
    int64_t launches[2]; /* of the last step */
} ranks_run;

void ranks_go(ranks_run *k);

#endif
