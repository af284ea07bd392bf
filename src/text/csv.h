/* SPDX-License-Identifier: BSD-3-Clause */
/* Reads tables of numbers: a line of names, "time[s],roll[deg]", then lines of numbers.
 *
 * Columns are separated by tabs, else semicolons, else commas, else blanks: the first of these that
 * the line of names contains. A unit is in [] or (). A name in double quotes may contain
 * separators; "" in it is a quote. A line ends with LF, CR LF or CR. Empty lines, lines that begin
 * with #, a UTF-8 byte-order mark, and a separator at the end of a line are skipped. Numbers have a
 * decimal point. */
#ifndef MPS_TEXT_CSV_H
#define MPS_TEXT_CSV_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum mps__csv_error {
    CSV_OK,
    CSV_MISSING, /* the file does not exist */
    CSV_FILE,    /* it cannot be opened or read, or is no table: `why` */
    CSV_MEMORY
} mps__csv_error;

/* Flags. CSV_OWN: a table of libmps, to which a program may still be writing. An incomplete last
 * line is ignored, nan and inf are numbers, and units are in [] only: "P(1)" is a name. CSV_ROUND,
 * with CSV_OWN: perhaps of another program; "P(kPa)" has a unit, "P(1)" has none. */
enum { CSV_OWN = 1, CSV_ROUND = 2 };

typedef struct mps__csv {
    /* of the caller; folder: NULL, or the folder of the run of this file */
    const char *folder, *path;
    int32_t flags, columns;
    char **name, **unit; /* [columns] "" for none */
    bool *wanted;        /* [columns] set by the caller between open and read; initially all */
    int64_t rows;
    double **value; /* [columns][rows] as written; NULL where not wanted */
    int64_t *line;  /* [rows] line number in the file, from 1 */
    char why[400];
    struct mps__csv_lines *in;
} mps__csv;

/* Open a file and read its names. Free the table in any case. */
mps__csv_error mps__csv_open(mps__csv *t, const char *path, int32_t flags);
/* mps__csv_open() for a file of the folder of a run: a link that leaves the folder is CSV_FILE.
 * @param folder  NULL: any file */
mps__csv_error mps__csv_open_in(mps__csv *t, const char *folder, const char *path, int32_t flags);
/* Read the wanted columns; other columns may contain any text. */
mps__csv_error mps__csv_read(mps__csv *t);
void mps__csv_free(mps__csv *t);

/* Index of the column with this name; letter case counts only if two names differ in it alone. -1:
 * not found; -2: several. */
int32_t mps__csv_find(const mps__csv *t, const char *name);
/* List the names, "time, roll", as many as fit into `out`. */
void mps__csv_names(const mps__csv *t, char *out, size_t size);

#endif
