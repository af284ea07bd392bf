/* SPDX-License-Identifier: BSD-3-Clause */
/* Loops that a step runs on the host also run on an OpenCL device, on copies of their arrays, which
 * are compared, before they run normally. The linker inserts these functions before those of loop.c
 * and stage.c (--wrap). */
#ifndef LOOPS_H
#define LOOPS_H

#include "opencl.h"

/* From now on; NULL: no more. */
void loops_watch(opencl *device);

#endif
