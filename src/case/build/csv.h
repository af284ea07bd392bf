/* SPDX-License-Identifier: BSD-3-Clause */
/* Tables of numbers with a header: "time[s],roll[deg]". Also with blanks around names, units in (), semicolons or tabs, lines that begin with #. */
#ifndef MPS_CASE_CSV_H
#define MPS_CASE_CSV_H

#include "tree.h"

enum { CSV_COLUMNS = 64, CSV_NAME = 64 };

typedef struct csv {
    const char *path;
    int64_t rows;
    int32_t columns;
    char name[CSV_COLUMNS][CSV_NAME], unit[CSV_COLUMNS][CSV_NAME];
    double *value; /* [rows*columns] as written */
    int64_t *line; /* [rows] in the file */
} csv;

/* Read a file; where that fails there is a message at `at`. Free it in any case. */
bool mps__csv_read(mps_case *c, const tree_node *at, const char *path, csv *out);
void mps__csv_free(csv *t);
/* Number of a column; capitals do not count. -1: there is none. */
int32_t mps__csv_find(const csv *t, const char *name);
/* All names, "time, roll". */
void mps__csv_names(const csv *t, char *out, size_t size);
/* Factor to SI of a column whose unit must be of these kinds; NAN after a message. `unit` NULL: that of the header */
double mps__csv_factor(mps_case *c, const tree_node *at, const csv *t, int32_t column,
                       uint64_t kinds, const char *unit);

#endif
