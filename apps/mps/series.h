/* SPDX-License-Identifier: BSD-3-Clause */
/* Several runs of one case, a folder each: shared by sweep, repeat and converge. */
#ifndef MPS_APPS_SERIES_H
#define MPS_APPS_SERIES_H

#include "cli.h"
#include <mps/series.h>

enum { SERIES_PATH = 1024, SERIES_VALUE = 256, SERIES_DP = 40 };

/* Folder of run number `index` from 0: "DIR/001". @return false: the name is too long */
bool series_folder(const char *folder, int64_t index, char out[SERIES_PATH]);
/* The folder that the user names, or the name of the case. */
void series_place(const choices *c, char out[SERIES_PATH]);
/* Do a run with its values as sets of `c`. A finished run is skipped, an interrupted one continues,
 * one of another case is refused.
 * @param busy  out: another process runs it
 * @return its exit code */
int series_run(const choices *c, const char *folder, bool *busy);
/* Rows of a finished run. @return NULL: it is unfinished, or cannot be read */
mps_table *series_table(const choices *c, const char *folder);
/* Text of a line "key: text" of a case as run; without quotes.
 * @return false: not found, or the buffer is too small */
bool series_key(const mps_case *tank, const char *key, char *out, size_t size);
/* Largest value of a column; nan if it has none. */
double series_most(const mps_table *rows, int32_t column);
/* Do runs with dp times factor[k], where `steps` is set with time steps times factor[k] too;
 * returns rows and dp as built [m] of each.
 * @return exit code: of the worst run */
int series_of_dp(const choices *c, int32_t count, const double *factor, bool steps,
                 mps_table **rows, double *dp);

#endif
