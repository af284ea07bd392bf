/* SPDX-License-Identifier: BSD-3-Clause */
/* Plots of a run, plot_*.svg. */
#ifndef MPS_POST_PLOTS_H
#define MPS_POST_PLOTS_H

#include <stdbool.h>
#include <stdint.h>

enum { REPORT_ERROR = 640 };

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

/* What is known of a run. */
typedef struct report {
    const char *folder;
    int32_t dim;
    double t_end;
    report_table probes, momentum, steps;
    int columns, added, figures, references; /* added: those before the common ones */
    const report_column *column, *figure;
    const report_reference *reference;
} report;

/* Write them. @param error  [REPORT_ERROR] out @return false: not all could be written */
bool mps__report_save(const report *r, char *error);

#endif
