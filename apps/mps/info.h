/* SPDX-License-Identifier: BSD-3-Clause */
/* Detects the type of a file from its contents. */
#ifndef MPS_APPS_INFO_H
#define MPS_APPS_INFO_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

enum { HEAD = 4096, TAIL = 4096 /* bytes that some programs append to the triangles */ };

/* The beginning of a file. */
typedef struct head {
    const char *path;
    FILE *file;
    long long size;
    size_t count;
    char text[HEAD + 1];
    char why[400]; /* why it is no table, although its first line has a separator */
} head;

/* Whether the beginning is text: no byte that only binary files have. */
bool is_text(const head *h);
/* Describe a surface of triangles (STL). @return false: it is another type */
bool info_surface(const head *h);

#endif
