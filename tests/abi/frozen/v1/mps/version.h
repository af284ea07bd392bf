/* SPDX-License-Identifier: BSD-3-Clause */
/** @file version.h  Version of the headers and of the library linked at run time. */
#ifndef MPS_VERSION_H
#define MPS_VERSION_H

#include <mps/export.h>

#define MPS_VERSION_MAJOR  1       /**< changes when programs must be compiled again */
#define MPS_VERSION_MINOR  0       /**< changes when something is added */
#define MPS_VERSION_PATCH  0       /**< changes when something is repaired */
#define MPS_VERSION_STRING "1.0.0" /**< the three of these headers, "major.minor.patch" */

MPS_BEGIN_DECLS

/** Version of the library in use, "major.minor.patch". Any output may be NULL.
 *  @param major,minor,patch  out: the three numbers
 *  @return static text, never NULL; compare with MPS_VERSION_STRING */
MPS_API const char *mps_version(int *major, int *minor, int *patch);

MPS_END_DECLS

#endif
