/* SPDX-License-Identifier: BSD-3-Clause */
/* Reads frames as the library writes them: .vtp with appended raw data, and .pvtp, which lists the
 * pieces of ranks. */
#ifndef MPS_POST_PAGE_VTP_H
#define MPS_POST_PAGE_VTP_H

#include "page_read.h"

enum { VTP_ARRAYS = 64, VTP_NAME = 48 };

/* An array of a piece. */
typedef struct vtp_array {
    char name[VTP_NAME];
    char type; /* 'f', 'd' floating point; 'b' uint8, 'i' int32, 'l' int64 */
    int32_t width;
    int64_t offset; /* from the first byte of data */
} vtp_array;

typedef struct vtp_piece {
    char *path;
    int64_t points;
    long base; /* offset of the data in the file */
    int32_t arrays;
    vtp_array array[VTP_ARRAYS];
} vtp_piece;

typedef struct vtp_frame {
    const page_run *run;
    int64_t points; /* of all pieces */
    int32_t pieces;
    vtp_piece *piece;
    char *parts; /* names, each 0-terminated, and another 0; NULL: none */
} vtp_frame;

/* Read the header of a frame. */
mps_status mps__vtp_open(vtp_frame *f, const page_run *run, const char *path);
void mps__vtp_close(vtp_frame *f);
/* @return numbers per particle, 0: not all pieces have such an array */
int32_t mps__vtp_width(const vtp_frame *f, const char *name);
/* The numbers of all particles, [points*width]; integers up to 2^53 are exact. */
mps_status mps__vtp_read(const vtp_frame *f, const char *name, double *out);

#endif
