/* SPDX-License-Identifier: BSD-3-Clause */
/* STL files. */
#ifndef MPS_CORE_STL_H
#define MPS_CORE_STL_H

#include "mesh.h"

/* Irregularities of a file. */
typedef struct mps__stl_notes {
    int64_t tail; /* bytes after the last triangle of a binary file */
    bool no_end;  /* an ASCII file without final "endsolid" */
} mps__stl_notes;

/* Read a binary or ASCII file into an empty mesh, three points per triangle; normals of the file
 * are not used. */
mps_status mps__stl_read(mps__mesh *m, const char *path, mps__stl_notes *notes);

#endif
