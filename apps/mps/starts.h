/* SPDX-License-Identifier: BSD-3-Clause */
/* Cases built into the program. CMake generates the table from cases/ and apps/mps/init. */
#ifndef MPS_APPS_STARTS_H
#define MPS_APPS_STARTS_H

typedef struct start {
    const char *name, *text; /* "surge", the whole file */
} start;

extern const start starts[]; /* NULL-terminated */

#endif
