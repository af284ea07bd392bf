/* SPDX-License-Identifier: BSD-3-Clause */
/* The reader of tables: a line of names, "time[s],roll[deg]", then lines of numbers.
 *
 * Columns are separated by tabs, else semicolons, else commas, else blanks: the first of these
 * that the line of names has. A unit is in [] or (). A name in double quotes may contain
 * separators; "" in it is a quote. A line ends with LF, CR LF or CR. Empty lines, lines that
 * begin with #, a mark of UTF-8 at the begin, and a separator at the end of a line are skipped.
 * Numbers have a point. */
#ifndef MPS_TEXT_CSV_H
#define MPS_TEXT_CSV_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum mps__csv_error {
    CSV_OK,
    CSV_MISSING, /* there is no such file */
    CSV_FILE,    /* it cannot be opened or read, or is no table: `why` */
    CSV_MEMORY
} mps__csv_error;

/* Flag: a table of libmps, which a program may still write. A last line without an end is left
 * out, nan and inf are numbers, and units are in [] only: "P(1)" is a name. */
enum { CSV_OWN = 1 };

typedef struct mps__csv {
    const char *folder,
        *path; /* of the caller; folder: NULL, or that of the run which the file is in */
    int32_t flags, columns;
    char **name, **unit; /* [columns] "" for none */
    bool *wanted;        /* [columns] set by the caller between open and read; all are at first */
    int64_t rows;
    double **value; /* [columns][rows] as written; NULL where not wanted */
    int64_t *line;  /* [rows] in the file, from 1 */
    char why[400];
    struct mps__csv_lines *in;
} mps__csv;

/* Open a file and read its names. Free the table in any case. */
mps__csv_error mps__csv_open(mps__csv *t, const char *path, int32_t flags);
/* Open a file in the folder of a run: a link out of the folder is CSV_FILE.
 * @param folder  NULL: a file anywhere */
mps__csv_error mps__csv_open_in(mps__csv *t, const char *folder, const char *path, int32_t flags);
/* Read the columns that are wanted, and close the file. In the other columns any text is
 * allowed. */
mps__csv_error mps__csv_read(mps__csv *t);
void mps__csv_free(mps__csv *t);

/* Number of a column with this name; capitals count only where two names differ by nothing
 * else. -1: there is none; -2: more than one. */
int32_t mps__csv_find(const mps__csv *t, const char *name);
/* All names, "time, roll", as many as `out` can hold. */
void mps__csv_names(const mps__csv *t, char *out, size_t size);

#endif
