/* SPDX-License-Identifier: BSD-3-Clause */
/* Lines of mps check. */
#ifndef MPS_CASE_CHECK_H
#define MPS_CASE_CHECK_H

#include "body.h"
#include <stdio.h>

/* A growing text. */
typedef struct writer {
    char *text;
    size_t size;
    FILE *file;
} writer;

/* Begin a line with a topic, or "" for that of the line before. */
void mps__check_heading(const writer *w, const char *name);
/* Write a position, "(0.4, 0.1) m". */
void mps__check_place(const writer *w, const build *b, const double *x);
/* Write mass and period of each free degree of freedom alone, the others fixed. */
void mps__check_write_body(const writer *w, const build *b);
/* Write the prescribed motion: extremes, filter, start. */
void mps__check_write_motion(const writer *w, build *b);
void mps__check_write_start(const writer *w, build *b);

#endif
