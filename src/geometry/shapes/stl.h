/* SPDX-License-Identifier: BSD-3-Clause */
/* STL files. */
#ifndef MPS_CORE_STL_H
#define MPS_CORE_STL_H

#include "mesh.h"

/* Read a binary or ASCII file into an empty mesh, three points a triangle; normals of the file are not used. */
mps_status mps__stl_read(mps__mesh *m, const char *path);

#endif
