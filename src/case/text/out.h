/* SPDX-License-Identifier: BSD-3-Clause */
/* Formats text into a buffer of the caller as snprintf() does: what exceeds the buffer is
 * counted. */
#ifndef MPS_CASE_OUT_H
#define MPS_CASE_OUT_H

#include <stddef.h>

typedef struct mps__out {
    char *buffer;
    size_t size, length;
} mps__out;

/* Begin an empty text. @param buffer  [size], NULL: count only */
mps__out mps__out_begin(char *buffer, size_t size);
void mps__out_put(mps__out *o, const char *format, ...);

#endif
