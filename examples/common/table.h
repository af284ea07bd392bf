/* SPDX-License-Identifier: BSD-3-Clause */
/* A CSV file that is written row by row, with a thinned copy in memory for the plots. */
#ifndef MPS_EXAMPLES_TABLE_H
#define MPS_EXAMPLES_TABLE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

typedef struct table {
    int columns; /* the first is the time */
    FILE *file;
    char path[512];
    double interval; /* rows at k * interval; 0: whatever is appended */
    int64_t next;    /* k of the next row */
    bool has_before;
    double *before; /* [columns] last sample, to interpolate from */
    double *row;    /* [columns] scratch */
    double *kept;   /* [count*columns] every stride-th row */
    int64_t count, seen, stride;
    bool failed; /* out of memory or disk */
} table;

/* Open the file and write the header. @return false with a message on stderr */
bool table_open(table *t, const char *folder, const char *name, const char *header, int columns, double interval);
/* Write a row as it is. */
void table_append(table *t, const double *row);
/* True if a row may fall before time + ahead, so that a sample is needed now. */
bool table_wants(const table *t, double time, double ahead);
/* Give a sample (row[0] is the time); rows at the exact output times in between are interpolated linearly. */
void table_sample(table *t, const double *row);
void table_flush(table *t);
/* @return false with a message on stderr if anything could not be written */
bool table_close(table *t);
void table_free(table *t);

#endif
