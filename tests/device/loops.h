/* SPDX-License-Identifier: BSD-3-Clause */
/* Loops that a step runs on the host go to a device of OpenCL too: on copies of their arrays, which are compared, before they run as ever. The linker puts
 * these functions in front of those of loop.c and stage.c (--wrap). */
#ifndef LOOPS_H
#define LOOPS_H

#include "opencl.h"

/* From now on; NULL: no more. */
void loops_watch(opencl *device);

#endif
