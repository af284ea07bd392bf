/* SPDX-License-Identifier: BSD-3-Clause */
/* Lines of mps check. */
#ifndef MPS_CASE_CHECK_H
#define MPS_CASE_CHECK_H

#include "body.h"
#include <stdio.h>

/* A text that grows. */
typedef struct writer {
    char *text;
    size_t size;
    FILE *file;
} writer;

/* Begin a line, of a topic or "" of the one before. */
void mps__check_heading(const writer *w, const char *name);
/* A place, "(0.4, 0.1) m". */
void mps__check_place(const writer *w, const build *b, const double *x);
/* Mass, and periods of each free degree alone, the others held. */
void mps__check_write_body(const writer *w, const build *b);
/* What is prescribed: extremes, filter, start. */
void mps__check_write_motion(const writer *w, build *b);
void mps__check_write_start(const writer *w, build *b);

#endif
