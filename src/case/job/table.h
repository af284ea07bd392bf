/* SPDX-License-Identifier: BSD-3-Clause */
/* A CSV file written row by row. */
#ifndef MPS_CASE_TABLE_H
#define MPS_CASE_TABLE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

enum { TABLE_PATH = 640 };

/* Callback for a row. */
typedef void (*table_row_fn)(void *user, const double *row);

typedef struct table {
    int columns; /* the first is the time */
    FILE *file;
    /* why: the reason why it could not be opened or truncated */
    char path[TABLE_PATH], why[TABLE_PATH + 160];
    double interval;   /* rows at k * interval; 0: all appended rows */
    table_row_fn each; /* NULL, or called for each row that is sampled or read back */
    void *user;        /* argument of each() */
    int64_t next;      /* k of the next row */
    long end;          /* where a continued file is truncated */
    bool has_before;
    double *before; /* [columns] last sample, for interpolation */
    double *row;    /* [columns] workspace */
    bool failed;    /* memory is exhausted, or a write error */
    int error;      /* errno of the first failure */
} table;

/* Allocate a table of <folder>/<name>, which mps__table_begin() or mps__table_resume() opens.
 * @return false: `why` is the reason */
bool mps__table_create(table *t, const char *folder, const char *name, int columns,
                       double interval);
/* Open the file and write the header. @return false: `why` is the reason */
bool mps__table_begin(table *t, const char *header);
/* Open the existing file and read its rows up to this time, as if they had just been written. The
 * file is unchanged until mps__table_cut().
 * @return false: `why` is the reason: another header, other times of rows, or missing rows */
bool mps__table_resume(table *t, const char *header, double time);
/* Truncate the later rows. @return false: `why` is the reason */
bool mps__table_cut(table *t);
/* Append a row unchanged. */
void mps__table_append(table *t, const double *row);
/* Whether a row may be due before time + ahead, so that a sample is needed now. */
bool mps__table_wants(const table *t, double time, double ahead);
/* Pass a sample (row[0] is the time); rows at the exact output times in between are interpolated
 * linearly. */
void mps__table_sample(table *t, const double *row);
void mps__table_flush(table *t);
/* Flush the file to the disk. */
void mps__table_sync(table *t);
/* @return false: a write failed, see `error` */
bool mps__table_close(table *t);
void mps__table_free(table *t);

#endif
