/* SPDX-License-Identifier: BSD-3-Clause */
/* The assembler includes the file into the library: as an array of C it would take a compiler
 * minutes. */
#include "rows.h"

__asm__(".section .rodata\n"
        ".global mps__cuda_rows\n"
        ".hidden mps__cuda_rows\n"
        "mps__cuda_rows:\n"
        ".incbin \"" MPS_CUDA_ROWS "\"\n"
        ".byte 0\n"
        ".previous\n");

typedef int mps__cuda_rows_is_above; /* a translation unit needs a declaration */
