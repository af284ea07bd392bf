/* SPDX-License-Identifier: BSD-3-Clause */
/** @file version.h  Version of the headers and of the library linked at run time. */
#ifndef MPS_VERSION_H
#define MPS_VERSION_H

#include <mps/export.h>

/** Incremented if programs must be recompiled. */
#define MPS_VERSION_MAJOR 1
/** Incremented if functions are added. */
#define MPS_VERSION_MINOR 0
/** Incremented if errors are corrected. */
#define MPS_VERSION_PATCH 0
/** Version of these headers, "major.minor.patch". */
#define MPS_VERSION_STRING "1.0.0"

MPS_BEGIN_DECLS

/** Version of the library in use.
 *  @param major,minor,patch  out: the three numbers; each may be NULL
 *  @return "major.minor.patch", static text, never NULL; compare it with MPS_VERSION_STRING */
MPS_API const char *mps_version(int *major, int *minor, int *patch);

MPS_END_DECLS

#endif
