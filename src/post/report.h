/* SPDX-License-Identifier: BSD-3-Clause */
/* Plots of a run, and report.html. */
#ifndef MPS_POST_REPORT_H
#define MPS_POST_REPORT_H

#include <stdbool.h>
#include <stdint.h>

enum { REPORT_ROWS = 24, REPORT_PICTURES = 32, REPORT_ERROR = 640 };

/* Rows of a table in memory: element k of column c is rows[k * columns + c]; column 0 is the time. */
typedef struct report_table {
    const double *rows;
    int64_t count;
    int columns;
} report_table;

/* A column of probes.csv, or a figure: `about` begins with a title, which a colon may end. */
typedef struct report_column {
    const char *name, *unit, *about;
    double value; /* of a figure; NAN: not reached */
} report_column;

/* Known points of the plots of a unit. */
typedef struct report_reference {
    const char *label, *unit, *column;
    bool line;
    int64_t count;
    const double *t, *value;
} report_reference;

/* A line of a list of names and values. */
typedef struct report_row {
    const char *name;
    char value[REPORT_ERROR];
} report_row;

/* What is known of a run. */
typedef struct report {
    const char *folder, *name, *title;
    int32_t dim;
    double t_end;
    bool page;    /* write report.html */
    bool several; /* there are several phases */
    report_table probes, momentum, steps;
    int columns, added, figures, references; /* added: those before the common ones */
    const report_column *column, *figure;
    const report_reference *reference;
    int settings, results, pictures;
    report_row setting[REPORT_ROWS], result[REPORT_ROWS];
    char picture[REPORT_PICTURES][32];
    double picture_t[REPORT_PICTURES]; /* NAN: not known */
} report;

/* plot_*.svg, and report.html if it is wanted. @param error  [REPORT_ERROR] out @return false: not all could be written */
bool mps__report_save(const report *r, char *error);

#endif
