/* SPDX-License-Identifier: BSD-3-Clause */
/* Reads the folder of a run: summary.json, tables (*.csv) and the series of frames. */
#ifndef MPS_POST_PAGE_READ_H
#define MPS_POST_PAGE_READ_H

#include "csv.h"
#include "json.h"
#include <mps/status.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* Destination of the first error text. */
typedef struct page_errors {
    char *text; /* NULL: discarded */
    size_t size;
} page_errors;

/* What a column of probes.csv is, from summary.json; texts belong to the summary. */
typedef struct page_column {
    const char *name, *unit, *type, *about, *part; /* never NULL */
    double at[3], normal[3], diameter;
    bool has_place, has_normal;
    int32_t place; /* index in probes.csv; -1: missing */
} page_column;

/* A frame of the series. */
typedef struct page_stamp {
    double t;
    char *path;
    bool peak; /* from peaks.pvd */
} page_stamp;

typedef struct page_run {
    const char *folder;
    page_errors *errors;
    json_value *summary;
    mps__csv probes, steps, momentum; /* the last two may be empty */
    int32_t columns;
    page_column *column;
    int64_t frames;
    page_stamp *frame;                      /* [frames]; may be empty */
    char *text;                             /* case.yaml, or NULL */
    const struct mps_stats_config *impacts; /* constants for the page; NULL: those of the run */
} page_run;

/* Keep the text of an error. @return status */
mps_status mps__page_fail(page_errors *e, mps_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* "<folder>/<name>"; NULL: memory is exhausted. The caller frees it. */
char *mps__page_path(const char *folder, const char *name);
/* Open a file of the folder of a run. MPS_E_NAME without a text: the file does not exist; MPS_E_IO:
 * for instance a link out of the folder. */
mps_status mps__page_open(const page_run *r, const char *path, FILE **out);
/* Read a whole file with a terminating 0.
 * @param size  of the file, or NULL
 * @param most  largest size. MPS_E_NAME: the file does not exist. */
mps_status mps__page_file(const page_run *r, const char *path, int64_t most, char **out,
                          size_t *size);
/* Read a table; MPS_E_NAME without a text: the file does not exist. An incomplete last row is
 * ignored. */
mps_status mps__page_table_read(const page_run *r, const char *path, mps__csv *out);
/* Column by name, -1: none. */
int32_t mps__page_table_find(const mps__csv *t, const char *name);
/* Value of the last row; NAN where there is none. */
double mps__page_table_last(const mps__csv *t, int32_t column);

/* Read summary.json of r->folder alone. MPS_E_NAME without a text: it does not exist, as in a run
 * in progress. */
mps_status mps__page_summary_read(page_run *r);
/* Read the whole folder except the frames themselves. */
mps_status mps__page_run_read(page_run *r, const char *folder, page_errors *e);
/* Merge the frames about peaks into the others, in the order of time. */
mps_status mps__page_peaks_read(page_run *r);
void mps__page_run_free(page_run *r);

/* Whether each run has the column: an energy, the position of the tank. */
bool mps__is_common(const char *name);

/* Members of summary.json; NAN or "" if missing or of another kind. */
double mps__page_number(const page_run *r, const char *key);
const char *mps__page_string(const page_run *r, const char *key);
/* Value of an input of the case, as text; NULL: none. */
const char *mps__page_input(const page_run *r, const char *key);

#endif
