/* SPDX-License-Identifier: BSD-3-Clause */
/* Cases that the program carries. The table is made by CMake from cases/ and apps/mps/init. */
#ifndef MPS_APPS_STARTS_H
#define MPS_APPS_STARTS_H

typedef struct start {
    const char *name, *text; /* "surge", the whole file */
} start;

extern const start starts[]; /* ends with a NULL */

#endif
