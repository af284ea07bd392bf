/* SPDX-License-Identifier: BSD-3-Clause */
/* Named arrays in a file that is read completely or refused.
 *
 * File: "mpsstate", version, byte order; then parts: name, bytes of an element, checksum, number of
 * elements, the elements, zeros up to a multiple of eight; the last part is called "end". Numbers
 * have their binary representation in memory. */
#ifndef MPS_CORE_ARCHIVE_H
#define MPS_CORE_ARCHIVE_H

#include "base.h"
#include <stdio.h>

enum { MPS__PART_TITLE = 40 }; /* bytes of a part's name, including the 0 */

typedef struct mps__archive {
    mps__context *context;
    /* while writing: */
    FILE *file;
    char *temporary; /* file name until it is renamed to that of the archive */
    int error;       /* errno of the first failure */
    /* after reading: */
    unsigned char *data;
    int64_t size;
} mps__archive;

/* Create a temporary file beside `path`. */
mps_status mps__archive_create(mps__archive *a, const char *path);
/* Write a part. mps__archive_save() reports failures. */
void mps__archive_put(mps__archive *a, const char *name, const void *elements, size_t bytes,
                      int64_t count);
/* Finish the file and rename it to `path`. */
mps_status mps__archive_save(mps__archive *a, const char *path);
/* Read a file and check it completely. */
mps_status mps__archive_load(mps__archive *a, const char *path);
/* Elements of a part and their number; NULL with the error set if the part is missing or has
 * another element size. */
const void *mps__archive_get(const mps__archive *a, const char *name, size_t bytes, int64_t *count);
/* Whether a part of this name exists. */
bool mps__archive_has(const mps__archive *a, const char *name);
void mps__archive_free(mps__archive *a);

/* CRC-32 (as in zlib) of a block; `before` is the checksum of the preceding data, 0 for the first
 * block. */
uint32_t mps__checksum(uint32_t before, const void *data, size_t bytes);

#endif
