/* SPDX-License-Identifier: BSD-3-Clause */
/* Named arrays that go to a file and come back, or are refused.
 *
 * File: "mpsstate", version, byte order; then parts: name, bytes of an element, checksum, number of elements, the elements, zeros up to a
 * multiple of eight; the last part is called "end". Numbers are as they are in memory. */
#ifndef MPS_CORE_ARCHIVE_H
#define MPS_CORE_ARCHIVE_H

#include "base.h"
#include <stdio.h>

enum { MPS__PART_TITLE = 40 }; /* bytes of a part's name, with the 0 */

typedef struct mps__archive {
    mps__context *context;
    /* while it is written: */
    FILE *file;
    char *temporary; /* name of the file, until it takes that of the archive */
    int error;       /* errno of the first failure */
    /* when it was read: */
    unsigned char *data;
    int64_t size;
} mps__archive;

/* Begin a file beside `path`. */
mps_status mps__archive_create(mps__archive *a, const char *path);
/* Write a part. mps__archive_save() tells of a failure. */
void mps__archive_put(mps__archive *a, const char *name, const void *elements, size_t bytes,
                      int64_t count);
/* End the file and put it in the place of `path`. */
mps_status mps__archive_save(mps__archive *a, const char *path);
/* Read a file and check all of it. */
mps_status mps__archive_load(mps__archive *a, const char *path);
/* The elements of a part, and how many there are; NULL with the error set if it is not there or its elements have another size. */
const void *mps__archive_get(const mps__archive *a, const char *name, size_t bytes, int64_t *count);
/* Whether there is a part of this name. */
bool mps__archive_has(const mps__archive *a, const char *name);
void mps__archive_free(mps__archive *a);

/* CRC-32 (as in zlib) of a block, going on from that of what came before it; 0 at first. */
uint32_t mps__checksum(uint32_t before, const void *data, size_t bytes);

#endif
