/* SPDX-License-Identifier: BSD-3-Clause */
/* STL files. */
#ifndef MPS_CORE_STL_H
#define MPS_CORE_STL_H

#include "mesh.h"

/* What is unusual in a file that was read. */
typedef struct mps__stl_notes {
    int64_t tail; /* bytes behind the last triangle of a binary file */
    bool no_end;  /* an ASCII file has no "endsolid" at its end */
} mps__stl_notes;

/* Read a binary or ASCII file into an empty mesh, three points a triangle; normals of the file are not used. */
mps_status mps__stl_read(mps__mesh *m, const char *path, mps__stl_notes *notes);

#endif
