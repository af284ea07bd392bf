/* SPDX-License-Identifier: BSD-3-Clause */
/* A CSV file that is written row by row. */
#ifndef MPS_CASE_TABLE_H
#define MPS_CASE_TABLE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

enum { TABLE_PATH = 640 };

/* What is done with a row. */
typedef void (*table_row_fn)(void *user, const double *row);

typedef struct table {
    int columns; /* the first is the time */
    FILE *file;
    char path[TABLE_PATH], why[TABLE_PATH + 160]; /* why: it could not be opened or cut */
    double interval;   /* rows at k * interval; 0: whatever is appended */
    table_row_fn each; /* NULL, or called for each row that is sampled or read back */
    void *user;        /* of each() */
    int64_t next;      /* k of the next row */
    long end;          /* where a file that goes on is cut */
    bool has_before;
    double *before; /* [columns] last sample, to interpolate from */
    double *row;    /* [columns] scratch */
    bool failed;    /* out of memory or disk */
    int error;      /* errno of the first failure */
} table;

/* Room for a table in <folder>/<name>, whose file mps__table_begin() or mps__table_resume() opens. @return false: `why` says why */
bool mps__table_create(table *t, const char *folder, const char *name, int columns,
                       double interval);
/* Open the file and write the header. @return false: `why` says why */
bool mps__table_begin(table *t, const char *header);
/* Open the file that is there and read its rows up to this time, as if they had just been written. Nothing is changed before mps__table_cut().
 * @return false: `why` says why: another header, other times of rows, or rows are missing */
bool mps__table_resume(table *t, const char *header, double time);
/* Drop the later rows. @return false: `why` says why */
bool mps__table_cut(table *t);
/* Write a row as it is. */
void mps__table_append(table *t, const double *row);
/* True if a row may fall before time + ahead, so that a sample is needed now. */
bool mps__table_wants(const table *t, double time, double ahead);
/* Give a sample (row[0] is the time); rows at the exact output times in between are interpolated linearly. */
void mps__table_sample(table *t, const double *row);
void mps__table_flush(table *t);
/* Flush it as far as the disk. */
void mps__table_sync(table *t);
/* @return false: something could not be written, see `error` */
bool mps__table_close(table *t);
void mps__table_free(table *t);

#endif
