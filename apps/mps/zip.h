/* SPDX-License-Identifier: BSD-3-Clause */
/* Archives as an FMU is one: deflated files, no folders of their own, no dates; less than 4 GB. The same files give the same bytes. */
#ifndef MPS_APPS_ZIP_H
#define MPS_APPS_ZIP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

enum { ZIP_FILES = 16 };

typedef struct zip {
    FILE *file;
    bool failed; /* a write, or memory was out */
    int count;
    struct zip_entry {
        char name[160];
        unsigned long crc, packed, size, at;
    } entry[ZIP_FILES];
} zip;

void zip_add(zip *z, const char *name, const void *data, size_t size);
/* The list of all files. */
void zip_end(zip *z);

#endif
