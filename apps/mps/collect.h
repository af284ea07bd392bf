/* SPDX-License-Identifier: BSD-3-Clause */
/* Statistics of columns that a sweep collects from each run, "P1.max". */
#ifndef MPS_APPS_COLLECT_H
#define MPS_APPS_COLLECT_H

#include "series.h"
#include <mps/stats.h>
#include <stdio.h>

enum { COLLECT_SIZE = 4096, COLLECT_MOST = 64 };

/* An entry of `collect`: all columns of a sensor, or one column. */
typedef struct collect_entry {
    const char *sensor; /* "": all columns */
    int32_t statistic;
    int32_t runs, missing; /* values of finished runs; those that are nan */
} collect_entry;

typedef struct collect {
    const char *verb, *from;
    char text[COLLECT_SIZE];
    collect_entry entry[COLLECT_MOST];
    int32_t entries;
} collect;

/* Parse "[P1.max, F.last]" of the case; default: the largest value of each column.
 * @param name  of the verb
 * @param from  file of the case, for messages; it is valid while `s` is used
 * @return false: an entry is invalid, with a message */
bool collect_read(collect *s, const mps_case *tank, const char *name, const char *from);
/* Check that each entry has a column, with a unit that fits.
 * @return false: one has none, with a message */
bool collect_fits(const collect *s, const mps_table *rows);
/* Write the column names of the sweep's table, each after a comma. */
void collect_names(const collect *s, FILE *out, const mps_table *rows);
/* Write the values of a run. Columns are those of `first`; a column missing in the run is nan.
 * @param folder  of the run, for the constants of its statistics
 * @param rows  NULL: it has none */
void collect_values(collect *s, FILE *out, const mps_table *first, const char *folder,
                    const mps_table *rows);

/* Print which of the values written are nan, and why. */
void collect_print_missing(const collect *s);

/* Write a text as a field of a CSV file, after a comma. */
void collect_text(FILE *out, const char *text);
/* Open a temporary file of a table that several processes may write; it is renamed when closed.
 * @return NULL with errno */
FILE *collect_open(const char *path);
/* @return exit code; a failure is printed */
int collect_close(const char *name, FILE *out, const char *path);

#endif
