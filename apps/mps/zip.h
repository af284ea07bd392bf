/* SPDX-License-Identifier: BSD-3-Clause */
/* Writes zip archives as FMUs need them: deflated files, no folders of their own, no dates; less
 * than 4 GB. The same files give the same bytes. */
#ifndef MPS_APPS_ZIP_H
#define MPS_APPS_ZIP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

enum { ZIP_FILES = 16 };

typedef struct zip {
    FILE *file;
    bool failed; /* a write failed, or memory is exhausted */
    int count;
    struct zip_entry {
        char name[160];
        unsigned long crc, packed, size, at;
    } entry[ZIP_FILES];
} zip;

void zip_add(zip *z, const char *name, const void *data, size_t size);
/* Write the central directory. */
void zip_end(zip *z);

#endif
